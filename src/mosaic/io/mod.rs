//! Reading and writing coordinate files in every dialect a lab has.
