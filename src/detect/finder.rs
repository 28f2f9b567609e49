//! The common interface of everything that finds cones: filters, built-in networks and users'
//! networks.

use super::Detection;
use super::learned::WeightsError;
use crate::geometry::Point;
use crate::image::{Plane, Polarity};

/// Properties of the cones that a finder is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sought {
    /// Sign of the cones' contrast.
    pub polarity: Polarity,
    /// Cone spacing in px.
    pub spacing: f64,
    /// Clarity of the image: the natural logarithm of the ratio of the power around the ring of
    /// this cone spacing to the power of detail finer than any cone.
    ///
    /// See [`RingProfile::clarity`](super::RingProfile::clarity). Infinity stands for a clear
    /// image.
    pub clarity: f64,
}

/// A method that finds cones in an image at one spacing.
pub(super) trait ConeFinder: Sync {
    /// Returns the cones of `image` and the candidates that were too faint, each from the best to
    /// the worst.
    ///
    /// Scores are probabilities (0–1).
    fn find(&self, image: &Plane, sought: Sought) -> Result<Found, WeightsError>;

    /// Returns the relative change of the spacing below which a new search would find the same
    /// cones.
    fn settled(&self) -> f64;
}

/// Cones, and candidates that were too faint. Their scores are probabilities (0–1).
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Found {
    /// Candidates that are taken for cones.
    pub cones: Vec<Detection>,
    /// Candidates that were too faint.
    pub rejected: Vec<Detection>,
}

impl Found {
    /// Returns the centres of the cones in px.
    pub(super) fn centres(&self) -> Vec<Point> {
        self.cones.iter().map(|d| d.centre).collect()
    }

    /// Applies `change` to every cone and every rejected candidate.
    pub(super) fn each(&mut self, change: impl Fn(&mut Detection)) {
        self.cones.iter_mut().chain(&mut self.rejected).for_each(change);
    }

    /// Keeps the cones and the rejected candidates for which `keep` holds.
    pub(super) fn retain(&mut self, keep: impl Fn(&Detection) -> bool) {
        self.cones.retain(&keep);
        self.rejected.retain(&keep);
    }

    /// Returns the same detections, moved `left` px to the right and `top` px down.
    pub(super) fn moved(mut self, left: usize, top: usize) -> Self {
        self.each(|d| d.centre = Point::new(d.centre.x + left as f64, d.centre.y + top as f64));
        self
    }
}
