//! Small numerical tools that know nothing of points, cones or images.

mod cholesky;
mod damped_solve;
mod quantile;

pub(crate) use cholesky::Cholesky;
pub(crate) use damped_solve::solve;
pub(crate) use quantile::{linear_quantile, nearest_rank, stepped_quantile};
