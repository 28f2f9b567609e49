//! Statistics of point patterns.
