//! Cone mosaic as a polar array with jitter and a minimal spacing, after Wang et al. (2001).

use super::outward::{exactly, ring};
use crate::geometry::Point;
use crate::geometry::index::{HashGrid, distance};
use crate::sample::normal_deviate::displaced;
use crate::sample::{Configure, Frame, SampleError, Sampler, Settable, Setting};
use rand::Rng;

/// Distance between successive rings, in spacings: √3/2, the distance between the rows of a
/// triangular lattice.
const RING: f64 = 0.866_025_403_784_438_6;
/// Number of cones per squared spacing: that of a triangular lattice.
const DENSITY: f64 = 1. / RING;
/// Largest number of displacements drawn for one cone; if none leaves the minimal spacing, the cone
/// is left out.
const DRAWS: usize = 100;
/// Distance beyond the window up to which rings are made, in spacings, so that the edge of the
/// array does not show.
const BEYOND: f64 = 3.;

/// Model of Wang et al. (2001): a polar array around the fovea, Gaussian jitter, and a minimal
/// spacing.
///
/// **Published** (the abstract, <https://www.osapublishing.org/abstract.cfm?uri=VSIA-2001-FB1>):
/// the constraints are the sampling properties of several human foveal mosaics, above all local
/// clusters rotated against each other and spectra like desert islands.
///
/// **As understood here**: the model consists of a polar array, a jitter and a minimal spacing.
///
/// **Not available, so chosen here**: rings are √3/2 spacings apart, and each has one cone per
/// spacing of its length, beginning at a random angle. A cone whose displacement brings it nearer
/// than the minimal spacing to one placed before is displaced anew, and left out after 100 draws.
/// The defaults, a jitter of .1 and a minimal spacing of .65 spacings of the array, give a
/// regularity index of 10, within the range of real mosaics (8 to 12).
///
/// **Eccentricity**: there is no such parameter. The model is one of the fovea, and no dependence
/// is known to have been published.
///
/// Exactly n points are made. No two are nearer than the minimal spacing, measured in spacings of
/// the array; the array is denser than the points made, because some cones are left out. Opposite
/// edges of a torus do not fit together, as the model has a centre.
#[derive(Clone, Copy, Debug)]
pub struct Wang {
    /// Standard deviation of each cone's displacement in x and y, in spacings of the array.
    pub jitter: f64,
    /// Smallest distance between two cones, in spacings of the array.
    pub minimum: f64,
}

impl Wang {
    /// Default setting, chosen here; see [`Wang`] for the reason.
    pub const DEFAULT: Self = Self { jitter: 0.1, minimum: 0.65 };
}

impl Sampler for Wang {
    fn name(&self) -> &'static str {
        "wang"
    }

    fn about(&self) -> &'static str {
        "rings of points around the centre, jittered, with a minimal spacing; exactly n; no torus (Wang et \
         al. 2001)"
    }

    fn exact(&self) -> bool {
        true
    }

    fn periodic(&self) -> bool {
        false
    }

    fn settable(&self) -> Option<&dyn Configure> {
        Some(self)
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        exactly(n, frame, DENSITY, self.name(), |half| self.array(half.map(|side| side + BEYOND), rng))
    }
}

impl Settable for Wang {
    const SETTINGS: &'static [Setting<Self>] = &[
        Setting {
            name: "jitter",
            unit: "spacings of the array",
            range: (0., 0.5),
            whole: false,
            unset: "",
            meaning: "standard deviation of each cone's displacement in x and y (chosen here)",
            get: |s| Some(s.jitter),
            set: |s, v| s.jitter = v,
        },
        Setting {
            name: "minimum",
            unit: "spacings of the array",
            range: (0., 0.8),
            whole: false,
            unset: "",
            meaning: "smallest distance between two cones (chosen here)",
            get: |s| Some(s.minimum),
            set: |s, v| s.minimum = v,
        },
    ];
}

impl Wang {
    /// Returns the displaced cones of an array of spacing 1 that covers |x| ≤ `half[0]` and |y| ≤
    /// `half[1]`.
    fn array(&self, half: [f64; 2], rng: &mut dyn Rng) -> Vec<[f64; 2]> {
        let rings = (half[0].hypot(half[1]) / RING) as usize;
        // A minimum of 0 needs no search, but the grid needs cells of some size.
        let mut grid = HashGrid::new(self.minimum.max(0.1));
        let mut cones: Vec<[f64; 2]> = Vec::new();
        for k in 0..=rings {
            let places = if k == 0 { vec![[0., 0.]] } else { ring(k as f64 * RING, 1., half, rng) };
            for place in places {
                let fits = |&cone: &[f64; 2]| grid.near(cone).all(|(_, c)| distance(c, cone) >= self.minimum);
                if let Some(cone) = (0..DRAWS).map(|_| displaced(place, self.jitter, rng)).find(fits) {
                    grid.insert(cones.len(), cone);
                    cones.push(cone);
                }
            }
        }
        cones
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Window;
    use crate::stats::{Deviation, moments, nearest_neighbours};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn no_two_cones_are_nearer_than_the_minimal_spacing() {
        for (jitter, minimum) in [(0.1, 0.65), (0.4, 0.8), (0., 0.8), (0.5, 0.)] {
            let model = Wang { jitter, minimum };
            let cones = model.array([15., 10.], &mut ChaCha8Rng::seed_from_u64(3));
            for (i, &a) in cones.iter().enumerate() {
                assert!(cones[..i].iter().all(|&b| distance(a, b) >= minimum));
            }
            // 30 × 20 spacings hold 693 cones
            println!("jitter {jitter}, minimum {minimum}: {} cones", cones.len());
            assert!(cones.len() > 560, "{}", cones.len());
        }
    }

    #[test]
    fn regularity_is_that_of_real_mosaics_and_falls_without_the_minimum() {
        let window = Window::unit_square();
        let ri = |model: Wang| {
            let of = |seed: u64| {
                let points = model.sample(1024, &window, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
                moments(&nearest_neighbours(&points, &window).distances, Deviation::Population).ri.unwrap()
            };
            (0..6).map(of).sum::<f64>() / 6.
        };
        let default = ri(Wang::DEFAULT);
        let without = ri(Wang { minimum: 0., ..Wang::DEFAULT });
        println!("{default}, {without}");
        assert!((8. ..12.).contains(&default), "{default}");
        assert!(without < default - 0.5, "{without}");
    }
}
