//! Point processes behind one trait.
