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
    /// See [`RingProfile::clarity`](super::RingProfile::clarity). Infinity stands for an image
    /// without noise: no filter is widened and no threshold raised.
    pub clarity: f64,
}

/// A method that finds cones in an image at one spacing.
pub(super) trait ConeFinder: Sync {
    /// Returns the cones of `image` and the candidates below the threshold for cones, each from the
    /// best to the worst.
    ///
    /// Scores are probabilities (0–1).
    fn find(&self, image: &Plane, sought: Sought) -> Result<Found, WeightsError>;

    /// Returns the largest change of the spacing for which a new search is not worth while, because
    /// it would find nearly the same cones.
    ///
    /// The change is measured as the absolute logarithm of the ratio of the new spacing to the old
    /// one.
    fn settled(&self) -> f64;
}

/// Cones, and candidates below the threshold for cones. Their scores are probabilities (0–1).
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Found {
    /// Candidates above the threshold, which are taken for cones.
    pub cones: Vec<Detection>,
    /// Candidates below the threshold.
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

    /// Keeps the cones and the rejected candidates for which `keep` returns `true`.
    pub(super) fn retain(&mut self, keep: impl Fn(&Detection) -> bool) {
        self.cones.retain(&keep);
        self.rejected.retain(&keep);
    }

    /// Returns the same detections, shifted by `left` px in x and by `top` px in y.
    pub(super) fn moved(mut self, left: usize, top: usize) -> Self {
        self.each(|d| d.centre = Point::new(d.centre.x + left as f64, d.centre.y + top as f64));
        self
    }
}
