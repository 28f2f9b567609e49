use super::cell::{Clip, NO_SITE};
use crate::geometry::{Point, Polygon};

/// Area that a power diagram fills.
#[derive(Clone, Debug, PartialEq)]
pub enum Domain {
    /// Torus `[0, width) × [0, height)`, whose opposite edges are glued together.
    Torus {
        /// Width of the torus, in units of the coordinates.
        width: f64,
        /// Height of the torus, in units of the coordinates.
        height: f64,
    },
    /// Convex polygon, as the list of its corners in order.
    Convex(Vec<[f64; 2]>),
}

impl Domain {
    /// Returns the bounded rectangle `[0, width] × [0, height]`.
    pub fn rectangle(width: f64, height: f64) -> Self {
        Self::Convex(vec![[0., 0.], [width, 0.], [width, height], [0., height]])
    }

    /// Creates the domain of a convex polygon with one ring, or returns `None` for other polygons.
    ///
    /// The polygon is moved so that the upper left corner of its bounds is the origin.
    pub fn convex(polygon: &Polygon) -> Option<Self> {
        let [ring] = polygon.rings() else { return None };
        let bounds = polygon.bounds();
        let at = |k: usize| ring[k % ring.len()];
        let turns_right = |k: usize| {
            let (a, b, c) = (at(k), at(k + 1), at(k + 2));
            (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x) >= 0.
        };
        // a star may turn right at every corner, but goes round more than once
        let around: f64 = (0..ring.len()).map(|k| turn(at(k), at(k + 1), at(k + 2))).sum();
        let convex = (0..ring.len()).all(turns_right) && around < 1.5 * std::f64::consts::TAU;
        convex.then(|| Self::Convex(ring.iter().map(|p| [p.x - bounds.x0(), p.y - bounds.y0()]).collect()))
    }

    /// Returns the area, in squared units of the coordinates.
    pub fn area(&self) -> f64 {
        match self {
            Self::Torus { width, height } => width * height,
            Self::Convex(corners) => {
                let twice = |k: usize| {
                    let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
                    a[0] * b[1] - b[0] * a[1]
                };
                (0..corners.len()).map(twice).sum::<f64>().abs() / 2.
            }
        }
    }

    /// Returns the smallest and the largest coordinates.
    pub(super) fn bounds(&self) -> [[f64; 2]; 2] {
        match self {
            Self::Torus { width, height } => [[0., 0.], [*width, *height]],
            Self::Convex(corners) => {
                let low = |axis: usize| corners.iter().map(|c| c[axis]).fold(f64::INFINITY, f64::min);
                let high = |axis: usize| corners.iter().map(|c| c[axis]).fold(f64::NEG_INFINITY, f64::max);
                [[low(0), low(1)], [high(0), high(1)]]
            }
        }
    }

    /// Returns whether opposite edges are glued together.
    pub const fn is_torus(&self) -> bool {
        matches!(self, Self::Torus { .. })
    }

    /// Moves a point on a torus into `[0, width) × [0, height)`; in other domains, the point is
    /// returned unchanged.
    pub fn wrapped(&self, p: [f64; 2]) -> [f64; 2] {
        let wrap = |v: f64, side: f64| {
            let inside = v.rem_euclid(side);
            if inside < side { inside } else { 0. }
        };
        match self {
            Self::Torus { width, height } => [wrap(p[0], *width), wrap(p[1], *height)],
            Self::Convex(_) => p,
        }
    }

    /// Returns the vector from `from` to `to`, by the shortest way round a torus.
    #[inline]
    pub fn towards(&self, from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        match self {
            Self::Torus { width, height } => {
                [dx - width * (dx / width).round(), dy - height * (dy / height).round()]
            }
            Self::Convex(_) => [dx, dy],
        }
    }

    /// Starts the cell of `site` as the entire domain, relative to the site.
    ///
    /// On a torus, the cell starts as the rectangle of points that are nearer to the site than to
    /// the periodic images of the site.
    pub(super) fn begin(&self, site: [f64; 2], clip: &mut Clip) {
        match self {
            Self::Torus { width, height } => {
                let (w, h) = (width / 2., height / 2.);
                clip.begin([[-w, -h], [w, -h], [w, h], [-w, h]].into_iter(), NO_SITE);
            }
            Self::Convex(corners) => {
                clip.begin(corners.iter().map(|c| [c[0] - site[0], c[1] - site[1]]), NO_SITE);
            }
        }
    }
}

/// Returns the angle by which the path a → b → c turns, in radians, from −π to π.
fn turn(a: Point, b: Point, c: Point) -> f64 {
    let (ux, uy, vx, vy) = (b.x - a.x, b.y - a.y, c.x - b.x, c.y - b.y);
    (ux * vy - uy * vx).atan2(ux * vx + uy * vy)
}
