//! Patterns with a prescribed pair correlation function, and so with a prescribed radial spectrum.
//!
//! `curve.rs` contains the function to reach, `features.rs` and `waves.rs` measure how far a
//! pattern is from it, and `descent.rs` moves the points.

mod curve;
mod descent;
mod features;
mod green;
mod neighbours;
mod noise;
mod pink;
mod spline;
mod step;
mod waves;

pub use curve::TargetCurve;
pub use features::NearestTarget;
pub use green::GREEN;
pub use noise::Noise;
pub use pink::PINK;
pub use step::Step;

use self::features::Features;
use super::{Frame, SampleError, Sampler, Watch, nearest_in_number};
use crate::geometry::{Point, Window};
use rand::{Rng, RngExt};

/// Uniform points, moved as little as possible until their pair correlation function g is `curve`.
///
/// Öztireli and Gross (2012) and Heck et al. (2013) move points down the gradient of ∫ (g − g*)²,
/// where g* is the function to reach. Their method takes hundreds of steps, since many points must
/// move together to change g at large distances. Here the misses of g at all distances are removed
/// at once. Let e(x) be the misses at the positions x, and J their Jacobian. The shortest
/// displacement that removes e to first order is x ← x − Jᵀ (J Jᵀ + μ)⁻¹ e, with the damping μ
/// (Levenberg–Marquardt). J Jᵀ has only some sixty rows, one per distance, and each is a sum over
/// all points, so some of the points are enough to estimate it. Ten steps suffice for any n, and
/// the time of each is linear in n.
///
/// Pairs determine g, and so the spectrum, except for waves longer than the controlled distances of
/// pairs. If the spectrum is known, the power of these waves is controlled in the same way (the
/// longest 256 of them).
///
/// Distances are those of the torus in every window. They are controlled up to 6 spacings, or half
/// the shorter side of the window if that is less; a window narrower than a spacing gets uniform
/// points.
///
/// Sources: Öztireli and Gross (2012), <https://doi.org/10.1145/2366145.2366189>; Heck, Schlömer
/// and Deussen (2013), <https://doi.org/10.1145/2487228.2487233>.
#[derive(Clone, Debug, PartialEq)]
pub struct Shaped {
    /// Pair correlation function that the points are to get.
    pub curve: TargetCurve,
    /// Nearest-neighbour distances that the points are to get, or `None` to leave them free. The
    /// pair correlation function alone does not determine them.
    pub nearest: Option<NearestTarget>,
}

impl Sampler for Shaped {
    fn name(&self) -> &'static str {
        "shaped"
    }

    fn about(&self) -> &'static str {
        "uniform points moved until they have a given pair correlation function; exactly n"
    }

    fn exact(&self) -> bool {
        true
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        Ok(self.moved(n, frame, rng).into_iter().map(|[x, y]| frame.place(x, y)).collect())
    }

    fn sample_watched(
        &self,
        n: usize,
        window: &Window,
        rng: &mut dyn Rng,
        _progress: &mut Watch<'_>,
    ) -> Result<Vec<Point>, SampleError> {
        let Window::Polygon(polygon) = window else { return self.fill(n, &Frame::new(n, window)?, rng) };
        let bounds = polygon.bounds();
        let filled = (n as f64 * bounds.area() / polygon.area()).round() as usize;
        let frame = Frame::new(filled, &Window::Rectangle(bounds))?;
        let points = self.moved(filled, &frame, rng);
        // All positions on a torus are alike, so one pattern, turned round the torus at random,
        // serves all tries.
        nearest_in_number(n, CUTS, || {
            let turn = [rng.random::<f64>() * frame.width, rng.random::<f64>() * frame.height];
            let turned = points.iter().map(|p| {
                frame.place(
                    (p[0] + turn[0]).rem_euclid(frame.width),
                    (p[1] + turn[1]).rem_euclid(frame.height),
                )
            });
            Ok(turned.filter(|&p| polygon.contains(p)).collect())
        })
    }
}

/// Largest number of random positions on the pattern at which a polygon is tried, to bring the
/// number of points in it near n.
const CUTS: usize = 64;
/// Smallest width of a window, in spacings, for which points are moved; in narrower windows they
/// stay uniform, as distances are controlled only up to half the width.
const NARROWEST: f64 = 1.;

impl Shaped {
    /// Draws uniform points on [0, width) × [0, height) and moves them towards the target.
    fn moved(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Vec<[f64; 2]> {
        // lengths in units of the hexagonal spacing
        let scale = frame.spacing(n);
        let sides = [frame.width / scale, frame.height / scale];
        let mut points: Vec<[f64; 2]> =
            (0..n).map(|_| sides.map(|side| rng.random::<f64>() * side)).collect();
        let shorter = sides[0].min(sides[1]);
        if n >= 2 && shorter >= NARROWEST {
            let reach = (0.5 * shorter).min(self.curve.reach());
            let features = Features::new(&self.curve, self.nearest, n, sides, reach);
            descent::descend(&mut points, sides, &features, reach);
        }
        points.iter_mut().for_each(|p| *p = p.map(|v| v * scale));
        points
    }
}
