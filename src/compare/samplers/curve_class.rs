use crate::geometry::{Polygon, Rectangle, Window};

/// Ratio of successive classes of n and of aspect. Mean curves at 250, 275, 300 and 330 points
/// differ by no more (.002–.011 of seven samplers) than the noise that a mean over 58 realisations
/// leaves (.006–.02).
const RATIO: f64 = 1.2;
/// Points drawn for one curve, over all realisations.
const POINTS_PER_CURVE: f64 = 16_000.;
/// Bounds on the number of realisations, below [`LARGE`] points.
const REALISATIONS: (usize, usize) = (4, 60);
/// From here on 2 realisations, from five times as many on 1: large patterns scatter little and
/// cost much.
const LARGE: usize = 20_000;

/// Mosaics that share a curve: what it depends on of n and the window. Numbers are powers of 1.2.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Class {
    pub(super) n: i32,
    pub(super) shape: Shape,
}

/// Shapes of windows: rectangles by their proportions (width over height), polygons each for
/// itself.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Shape {
    Rectangle { aspect: i32, torus: bool },
    Polygon(Polygon),
}

impl Class {
    pub(super) fn of(n: usize, window: &Window) -> Self {
        let shape = match window {
            Window::Rectangle(bounds) | Window::Torus(bounds) => {
                Shape::rectangle(bounds.width() / bounds.height(), window.is_torus())
            }
            Window::Polygon(polygon) => Shape::Polygon(polygon.clone()),
        };
        Self { n: nearest(n as f64), shape }
    }

    /// The class whose curve serves for this one with samplers that do not stand in rows: for a
    /// polygon without holes that is not longer than a 2.1 : 1 rectangle, the rectangle whose
    /// border is as long for its area.
    ///
    /// Measured on seven polygons (squares turned by 3 and 30°, a turned 2 : 1 rectangle, a slanted
    /// side, a parallelogram, a cut corner, a circle) at 60, 300 and 1500 points as mean l-infinity
    /// between a polygon's own curve and that of its rectangle, beside that between curves of two
    /// seeds: uniform .072, .033, .030 beside .071, .032, .032; jittered .045, .025, .019 beside
    /// .034, .018, .014; Bridson .039, .012, .014 beside .034, .011, .013; dart throwing .035,
    /// .014, .012 beside .036, .014, .011; BNOT .046, .014, .015 beside .038, .014, .012. Not so
    /// for lattices: .29, .15, .05 beside less than .006. In longer shapes BNOT of few points
    /// differs, by .2 in a triangle and .09 in an L at 60.
    pub(super) fn stand_in(&self) -> Self {
        let shape = match &self.shape {
            Shape::Polygon(polygon) => Shape::like(polygon).unwrap_or_else(|| self.shape.clone()),
            Shape::Rectangle { .. } => self.shape.clone(),
        };
        Self { n: self.n, shape }
    }

    /// Points asked of a sampler: the middle of the class.
    pub(super) fn points(&self) -> usize {
        (RATIO.powi(self.n).round() as usize).max(2)
    }

    /// A rectangle of area 1, or the polygon; `None` if the proportions are beyond numbers.
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

    /// What tells the generators of its realisations from those of other shapes.
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

    /// Patterns that a curve is the mean of.
    pub(super) fn realisations(&self) -> usize {
        let n = self.points();
        match n {
            _ if n >= 5 * LARGE => 1,
            _ if n >= LARGE => 2,
            _ => ((POINTS_PER_CURVE / n as f64).round() as usize).clamp(REALISATIONS.0, REALISATIONS.1),
        }
    }
}

/// Squared length of the border over the area, of a rectangle of 2.13 : 1.
const LONGEST: f64 = 18.5;

impl Shape {
    /// The rectangle like a polygon, if there is one. With longer over shorter side a, P²/A = 4 (a
    /// + 1/a) + 8.
    fn like(polygon: &Polygon) -> Option<Self> {
        let [_] = polygon.rings() else { return None };
        let perimeter = Window::Polygon(polygon.clone()).perimeter();
        let roundness = perimeter * perimeter / polygon.area();
        // below 16, rounder than a square
        let half = (roundness / 8. - 1.).max(1.);
        let aspect = half + (half * half - 1.).sqrt();
        let bounds = polygon.bounds();
        let aspect = if bounds.width() >= bounds.height() { aspect } else { 1. / aspect };
        (roundness <= LONGEST).then(|| Self::rectangle(aspect, false))
    }

    fn rectangle(aspect: f64, torus: bool) -> Self {
        Self::Rectangle { aspect: nearest(aspect), torus }
    }
}

fn nearest(value: f64) -> i32 {
    (value.ln() / RATIO.ln()).round() as i32
}
