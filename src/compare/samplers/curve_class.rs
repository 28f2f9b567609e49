//! Classes of mosaics that share one reference curve per sampler.
//!
//! A mean curve depends on the mosaic only through the number of points and the shape of the
//! window, and changes slowly with both. Number of points and aspect ratio are therefore rounded to
//! powers of 1.2.

use crate::geometry::{Polygon, Rectangle, Window};

/// Ratio between neighbouring classes of the number of points, and of the aspect ratio.
///
/// The mean curves for 250, 275, 300 and 330 points differ by .002–.011 (seven samplers), which is
/// no more than the noise of a mean over 58 patterns (.006–.02).
const RATIO: f64 = 1.2;
/// Number of points of all patterns of one curve together: a curve of n points is the mean of 16
/// 000/n patterns, within the limits of [`REALISATIONS`]. Patterns of few points scatter more, so
/// more of them are averaged.
const POINTS_PER_CURVE: f64 = 16_000.;
/// Smallest and largest number of patterns per curve, for fewer than [`LARGE`] points.
const REALISATIONS: (usize, usize) = (4, 60);
/// Number of points from which on a curve is the mean of only 2 patterns; from five times as many
/// points on, it is the curve of a single pattern. Large patterns vary little and take long.
const LARGE: usize = 20_000;

/// Class of mosaics that share a reference curve: number of points and shape of the window, both
/// rounded.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Class {
    /// Number of points, rounded to a power of 1.2 and stored as the exponent.
    pub(super) n: i32,
    /// Shape of the window.
    pub(super) shape: Shape,
}

/// Shape of a window. Every polygon is a class of its own.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Shape {
    /// Rectangle with this aspect ratio (width / height), rounded to a power of 1.2 and stored as
    /// the exponent. `torus` is `true` if its opposite edges are joined.
    Rectangle { aspect: i32, torus: bool },
    /// Polygon with exactly these corners.
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

    /// Returns the class whose curve stands for the curve of this class, for samplers that do not
    /// place points in rows along the sides of the window.
    ///
    /// For a polygon without holes that is at most as elongated as a 2.16 : 1 rectangle, this is
    /// the class of the rectangle with the same perimeter² / area. Every other class is returned
    /// unchanged.
    ///
    /// Measured on seven polygons (squares turned by 3 and 30°, a turned 2 : 1 rectangle, a slanted
    /// side, a parallelogram, a cut corner, a circle) at 60, 300 and 1500 points. Each cell of the
    /// table has three numbers, for 60, 300 and 1500 points. They are mean l-infinity distances: in
    /// the second column between a polygon's own curve and the curve of its rectangle, in the third
    /// between two curves that differ only in the seed.
    ///
    /// | sampler | polygon to rectangle | seed to seed |
    /// |---|---|---|
    /// | uniform | .072, .033, .030 | .071, .032, .032 |
    /// | jittered | .045, .025, .019 | .034, .018, .014 |
    /// | Bridson | .039, .012, .014 | .034, .011, .013 |
    /// | dart throwing | .035, .014, .012 | .036, .014, .011 |
    /// | BNOT | .046, .014, .015 | .038, .014, .012 |
    ///
    /// For lattices, the curves of polygon and rectangle differ clearly, by .29, .15 and .05,
    /// whereas two seeds differ by less than .006. In more elongated shapes, the curves of BNOT
    /// differ too if there are few points: by .2 in a triangle and by .09 in an L, at 60 points.
    pub(super) fn stand_in(&self) -> Self {
        let shape = match &self.shape {
            Shape::Polygon(polygon) => Shape::like(polygon).unwrap_or_else(|| self.shape.clone()),
            Shape::Rectangle { .. } => self.shape.clone(),
        };
        Self { n: self.n, shape }
    }

    /// Returns the number of points to draw for the class: its power of 1.2 as an integer, and at
    /// least 2.
    pub(super) fn points(&self) -> usize {
        (RATIO.powi(self.n).round() as usize).max(2)
    }

    /// Returns the window in which patterns are drawn: a rectangle of area 1, or the polygon of the
    /// class. `None` if the aspect ratio is too extreme for a rectangle with floating-point sides.
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

    /// Returns bytes that identify the shape, as part of the seed of the random generators.
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

    /// Returns the number of patterns over which the curve of this class is averaged.
    pub(super) fn realisations(&self) -> usize {
        let n = self.points();
        match n {
            _ if n >= 5 * LARGE => 1,
            _ if n >= LARGE => 2,
            _ => ((POINTS_PER_CURVE / n as f64).round() as usize).clamp(REALISATIONS.0, REALISATIONS.1),
        }
    }
}

/// Largest ratio of squared perimeter to area for which a polygon uses the curve of a rectangle. It
/// is the ratio of a 2.16 : 1 rectangle. In more elongated polygons the curves of some samplers
/// differ (see [`Class::stand_in`]).
const LONGEST: f64 = 18.5;

impl Shape {
    /// Returns the class of the rectangle with the same perimeter² / area as a polygon; `None` for
    /// polygons with holes, and for polygons more elongated than [`LONGEST`] allows.
    ///
    /// For a rectangle with perimeter P, area A and aspect ratio a, P²/A = 4 (a + 1/a) + 8.
    fn like(polygon: &Polygon) -> Option<Self> {
        let [_] = polygon.rings() else { return None };
        let perimeter = Window::Polygon(polygon.clone()).perimeter();
        let roundness = perimeter * perimeter / polygon.area();
        // a ratio below 16, that of a square, is rounder than any rectangle: the square stands for
        // it
        let half = (roundness / 8. - 1.).max(1.);
        let aspect = half + (half * half - 1.).sqrt();
        let bounds = polygon.bounds();
        let aspect = if bounds.width() >= bounds.height() { aspect } else { 1. / aspect };
        (roundness <= LONGEST).then(|| Self::rectangle(aspect, false))
    }

    /// Returns the shape class of a rectangle with the aspect ratio `aspect`.
    fn rectangle(aspect: f64, torus: bool) -> Self {
        Self::Rectangle { aspect: nearest(aspect), torus }
    }
}

/// Returns the exponent of the power of 1.2 that is nearest to `value`, on a logarithmic scale.
fn nearest(value: f64) -> i32 {
    (value.ln() / RATIO.ln()).round() as i32
}
