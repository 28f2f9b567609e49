//! Peak brightness of the cones in a simulated image, and the visibility of each cone.

use super::RenderOptions;
use super::field::{SlowField, normal};
use super::spacing::CellSizes;
use crate::geometry::Point;
use rand::{Rng, RngExt};
use serde::Serialize;

/// Contrast, relative to the average cone, below which a cone counts as dim; dim cones are drawn
/// with less than this.
pub(super) const DIM: f64 = 0.3;

/// Class of a cone by how well an observer could see it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ConeClass {
    /// Cone that stands out from its surround.
    Cone,
    /// Cone with less than 0.3 of the average contrast: drawn dim, behind a vessel, or cut near its
    /// tip.
    Dim,
    /// Cone without contrast, such as a cone that is not drawn at all.
    Missing,
}

impl ConeClass {
    /// Returns the name that is written in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Cone => "cone",
            Self::Dim => "dim",
            Self::Missing => "missing",
        }
    }
}

/// Contrast of a cone, and the class that follows from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Visibility {
    /// Contrast of the cone, relative to that of the average cone.
    pub contrast: f64,
    /// Class that follows from the contrast.
    pub class: ConeClass,
}

impl Visibility {
    /// Returns the visibility of a cone of contrast `contrast`, relative to the average cone; a
    /// cone without contrast is missing.
    pub(super) fn of(contrast: f64) -> Self {
        let class = match contrast {
            c if c <= 0. => ConeClass::Missing,
            c if c < DIM => ConeClass::Dim,
            _ => ConeClass::Cone,
        };
        Self { contrast, class }
    }
}

/// Draws the peaks of the cones over their surround at random: log-normal, with mean 1.
///
/// Three quarters of the variance of the logarithm are the cone's own, and one quarter is shared
/// with neighbouring cones. Then dim cones lose most of their peak, and missing cones all of it.
pub(super) fn heights(
    points: &[Point],
    cells: &CellSizes,
    options: &RenderOptions,
    rng: &mut dyn Rng,
) -> Vec<f64> {
    let sd = (1. + options.scatter * options.scatter).ln().sqrt();
    let shared = SlowField::new(options.width, options.height, 2. * cells.typical, rng);
    let mut heights: Vec<f64> = points
        .iter()
        .map(|p| {
            // the mean of exp(sd · N(0, 1)) is exp(sd²/2)
            let log = sd * (0.75f64.sqrt() * normal(rng) + 0.5 * shared.at(p.x, p.y)) - sd * sd / 2.;
            let dim = if rng.random::<f64>() < options.dim { rng.random_range(0. ..DIM) } else { 1. };
            dim * log.exp()
        })
        .collect();
    if options.missing > 0. {
        for height in &mut heights {
            if rng.random::<f64>() < options.missing {
                *height = 0.;
            }
        }
    }
    heights
}
