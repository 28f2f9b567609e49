//! Tables and figures. Does not know how the numbers were made.
