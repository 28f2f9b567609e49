//! Classes of mosaics that share the reference curves of samplers. A mean curve depends on the
//! mosaic only through its number of points and the shape of its window, and slowly on both, so
//! each is rounded to a power of 1.2.

use crate::geometry::{Polygon, Rectangle, Window};

/// Ratio between neighbouring classes of n and of aspect.
///
/// Mean curves at 250, 275, 300 and 330 points differ by .002–.011 (seven samplers), which is no
/// more than the noise of a mean over 58 realisations (.006–.02).
const RATIO: f64 = 1.2;
/// Number of points drawn for one curve, over all realisations.
const POINTS_PER_CURVE: f64 = 16_000.;
/// Least and greatest number of realisations below [`LARGE`] points.
const REALISATIONS: (usize, usize) = (4, 60);
/// Number of points from which on a curve has 2 realisations, and from five times as many on 1:
/// large patterns scatter little and cost much.
const LARGE: usize = 20_000;

/// Class of mosaics that share a curve: number of points and shape of the window, where numbers are
/// exponents of powers of 1.2.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Class {
    pub(super) n: i32,
    pub(super) shape: Shape,
}

/// Shape of a window: rectangles are classed by their aspect (width over height), every polygon is
/// a shape of its own.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Shape {
    Rectangle { aspect: i32, torus: bool },
    Polygon(Polygon),
}

impl Class {
    /// Returns the class of a mosaic of `n` points in `window`.
    pub(super) fn of(n: usize, window: &Window) -> Self {
        let shape = match window {
            Window::Rectangle(bounds) | Window::Torus(bounds) => {
                Shape::rectangle(bounds.width() / bounds.height(), window.is_torus())
            }
            Window::Polygon(polygon) => Shape::Polygon(polygon.clone()),
        };
        Self { n: nearest(n as f64), shape }
    }

    /// Returns the class whose curve serves for this one with samplers that do not stand in rows.
    ///
    /// For a polygon without holes that is not longer than a 2.16 : 1 rectangle, this is the class
    /// of the rectangle with the same perimeter² / area; every other class serves itself.
    ///
    /// Measured on seven polygons (squares turned by 3 and 30°, a turned 2 : 1 rectangle, a slanted
    /// side, a parallelogram, a cut corner, a circle) at 60, 300 and 1500 points: mean l-infinity
    /// between a polygon's own curve and that of its rectangle, beside that between the curves of
    /// two seeds.
    ///
    /// | sampler | polygon to rectangle | seed to seed |
    /// |---|---|---|
    /// | uniform | .072, .033, .030 | .071, .032, .032 |
    /// | jittered | .045, .025, .019 | .034, .018, .014 |
    /// | Bridson | .039, .012, .014 | .034, .011, .013 |
    /// | dart throwing | .035, .014, .012 | .036, .014, .011 |
    /// | BNOT | .046, .014, .015 | .038, .014, .012 |
    ///
    /// Lattices do differ: .29, .15, .05 beside less than .006. In longer shapes BNOT of few points
    /// differs too: by .2 in a triangle and by .09 in an L, at 60 points.
    pub(super) fn stand_in(&self) -> Self {
        let shape = match &self.shape {
            Shape::Polygon(polygon) => Shape::like(polygon).unwrap_or_else(|| self.shape.clone()),
            Shape::Rectangle { .. } => self.shape.clone(),
        };
        Self { n: self.n, shape }
    }

    /// Returns the number of points asked of a sampler: the middle of the class.
    pub(super) fn points(&self) -> usize {
        (RATIO.powi(self.n).round() as usize).max(2)
    }

    /// Returns a rectangle of area 1, or the polygon; `None` if the aspect is too extreme for a
    /// number.
    pub(super) fn window(&self) -> Option<Window> {
        match &self.shape {
            Shape::Rectangle { aspect, torus } => {
                let width = RATIO.powi(*aspect).sqrt();
                let bounds = Rectangle::new(0., 0., width, 1. / width).ok()?;
                Some(if *torus { Window::Torus(bounds) } else { Window::Rectangle(bounds) })
            }
            Shape::Polygon(polygon) => Some(Window::Polygon(polygon.clone())),
        }
    }

    /// Returns bytes that distinguish the random generators of this shape from those of other
    /// shapes.
    pub(super) fn seed(&self) -> Vec<u8> {
        match &self.shape {
            Shape::Rectangle { aspect, torus } => {
                let mut bytes = aspect.to_le_bytes().to_vec();
                bytes.push(u8::from(*torus));
                bytes
            }
            Shape::Polygon(polygon) => polygon.bytes(),
        }
    }

    /// Returns the number of patterns over which a curve is averaged.
    pub(super) fn realisations(&self) -> usize {
        let n = self.points();
        match n {
            _ if n >= 5 * LARGE => 1,
            _ if n >= LARGE => 2,
            _ => ((POINTS_PER_CURVE / n as f64).round() as usize).clamp(REALISATIONS.0, REALISATIONS.1),
        }
    }
}

/// Largest ratio of squared perimeter to area for which a rectangle stands in for a polygon: that
/// of a 2.16 : 1 rectangle.
const LONGEST: f64 = 18.5;

impl Shape {
    /// Returns the rectangle that has the same perimeter² / area as a polygon; `None` for polygons
    /// with holes and for longer ones.
    ///
    /// For a rectangle whose longer side is a times the shorter one, P²/A = 4 (a + 1/a) + 8.
    fn like(polygon: &Polygon) -> Option<Self> {
        let [_] = polygon.rings() else { return None };
        let perimeter = Window::Polygon(polygon.clone()).perimeter();
        let roundness = perimeter * perimeter / polygon.area();
        // a ratio below 16 is rounder than a square, the roundest rectangle
        let half = (roundness / 8. - 1.).max(1.);
        let aspect = half + (half * half - 1.).sqrt();
        let bounds = polygon.bounds();
        let aspect = if bounds.width() >= bounds.height() { aspect } else { 1. / aspect };
        (roundness <= LONGEST).then(|| Self::rectangle(aspect, false))
    }

    /// Returns the shape of a rectangle of this aspect, rounded to a class.
    fn rectangle(aspect: f64, torus: bool) -> Self {
        Self::Rectangle { aspect: nearest(aspect), torus }
    }
}

/// Returns the exponent of the power of 1.2 that is nearest to `value`.
fn nearest(value: f64) -> i32 {
    (value.ln() / RATIO.ln()).round() as i32
}
