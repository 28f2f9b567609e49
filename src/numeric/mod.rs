//! Small numerical tools that know nothing of points, cones or images.

mod damped_solve;

pub(crate) use damped_solve::solve;
