//! The interface that detection sees of whatever finds cones: filters, networks and users' networks.

use super::Detection;
use super::learned::WeightsError;
use crate::geometry::Point;
use crate::image::{Plane, Polarity};

/// Properties of the cones that a finder is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sought {
    /// Sign of their contrast.
    pub polarity: Polarity,
    /// Their distance in px.
    pub spacing: f64,
    /// Clarity of the image's ring at that spacing ([`RingProfile::clarity`](super::RingProfile::clarity)); infinity: clear.
    pub clarity: f64,
}

/// Finds cones in an image at one spacing.
pub(super) trait ConeFinder: Sync {
    /// Returns the cones of `image`, and the candidates that were too faint, best first. Scores are probabilities.
    ///
    /// # Errors
    /// If a network cannot be run.
    fn find(&self, image: &Plane, sought: Sought) -> Result<Found, WeightsError>;

    /// Returns the relative change of the spacing below which finding again would find the same.
    fn settled(&self) -> f64;
}

/// Cones, and candidates that were too faint; scores are probabilities.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Found {
    pub cones: Vec<Detection>,
    pub rejected: Vec<Detection>,
}

impl Found {
    pub(super) fn centres(&self) -> Vec<Point> {
        self.cones.iter().map(|d| d.centre).collect()
    }

    pub(super) fn each(&mut self, change: impl Fn(&mut Detection)) {
        self.cones.iter_mut().chain(&mut self.rejected).for_each(change);
    }

    pub(super) fn retain(&mut self, keep: impl Fn(&Detection) -> bool) {
        self.cones.retain(&keep);
        self.rejected.retain(&keep);
    }

    /// Returns the same, moved `left` px to the right and `top` px down.
    pub(super) fn moved(mut self, left: usize, top: usize) -> Self {
        self.each(|d| d.centre = Point::new(d.centre.x + left as f64, d.centre.y + top as f64));
        self
    }
}
