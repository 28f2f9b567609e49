//! Small numerical tools that do not depend on points, cones or images.

mod average;
mod cholesky;
mod damped_solve;
mod quantile;
mod three_by_three;

pub(crate) use average::{mean, median};
pub(crate) use cholesky::Cholesky;
pub(crate) use damped_solve::solve;
pub(crate) use quantile::{linear_quantile, nearest_rank, stepped_quantile};
pub(crate) use three_by_three::{eigenvalues, eigenvector, inverted};
