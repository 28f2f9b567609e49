//! Cone mosaic by the minimal-spacing rule: random positions, refused near earlier cells.

use super::retina::{FARTHEST, cones_per_mm2};
use crate::geometry::Point;
use crate::geometry::index::TorusCells;
use crate::mosaic::hexagonal_spacing;
use crate::sample::normal_deviate::truncated;
use crate::sample::{Configure, Frame, SampleError, Sampler, Settable, Setting};
use rand::{Rng, RngExt};

/// Largest deviation of a minimal distance from the mean, in standard deviations. Larger deviations
/// are drawn again, so that the distance is bounded and neighbours can be sought in a grid.
const DEVIATIONS: f64 = 4.;
/// Smallest distance between human cones in the periphery, in mm: the middle of the 6–8 µm of
/// Curcio and Sloan (1992).
const PERIPHERAL: f64 = 0.007;
/// Number of random positions tried for one cell before the window counts as full.
const TRIALS: usize = 100_000;

/// Minimal-spacing rule (d_min, exclusion zone): cells are placed at random, one after the other.
///
/// A position is refused if an earlier cell is nearer than d_min, which is a normal deviate.
///
/// **Published**: the rule, and that d_min ~ N(μ, σ).
///
/// **Chosen here**: d_min is in hexagonal spacings, that is, in units of the distance between
/// neighbours that the n cells would have in a perfect triangular lattice, so that one value serves
/// any density. It is drawn anew for each position tried, not once per cell; values that are
/// negative or beyond four standard deviations are drawn again. Distances are those of the torus.
/// Values fitted to mosaics were not at hand. With a fixed d_min above .777, random placement finds
/// no room for n cells; μ = .7 is somewhat below that, and σ is a tenth of μ.
///
/// **Eccentricity**: no dependence was published with the rule. Curcio and Sloan (1992) found the
/// least distance between human cones constant, 6–8 µm, across the peripheral retina, while the
/// spacing of the cones grows. If an eccentricity is set (distance from the fovea in mm), μ is 7 µm
/// divided by the hexagonal spacing of human cones there (Curcio et al. 1990, mean of four
/// meridians), but at most .7. The limit of .7 applies within some 2 mm of the fovea.
///
/// Exactly n points are made. No two points are nearer than μ − 4σ.
///
/// Sources: Wässle and Riemann (1978), <https://doi.org/10.1098/rspb.1978.0026>; Galli-Resta et al.
/// (1999), <https://doi.org/10.1046/j.1460-9568.1999.00555.x>; Curcio and Sloan (1992),
/// <https://doi.org/10.1017/S0952523800009639>; Curcio et al. (1990),
/// <https://doi.org/10.1002/cne.902920402>.
#[derive(Clone, Copy, Debug)]
pub struct MinimalSpacing {
    /// Mean of the minimal distance d_min, in hexagonal spacings.
    pub mean: f64,
    /// Standard deviation of the minimal distance d_min, in hexagonal spacings.
    pub sd: f64,
}

impl MinimalSpacing {
    /// Default setting, chosen here; see [`MinimalSpacing`] for the reason.
    pub const DEFAULT: Self = Self { mean: 0.7, sd: 0.07 };

    /// Returns the mean of d_min for human cones at `eccentricity` mm from the fovea, in hexagonal
    /// spacings.
    ///
    /// The mean is 7 µm, converted to spacings at that eccentricity, but at most .7 spacings.
    pub fn mean_at(eccentricity: f64) -> f64 {
        let most = Self::DEFAULT.mean;
        // The number of cones of a square metre is large enough to be rounded to an integer without
        // harm.
        let spacing = hexagonal_spacing((1e6 * cones_per_mm2(eccentricity)) as usize, 1e6);
        spacing.map_or(most, |mm| (PERIPHERAL / mm).min(most))
    }
}

impl Sampler for MinimalSpacing {
    fn name(&self) -> &'static str {
        "minimal-spacing"
    }

    fn about(&self) -> &'static str {
        "random positions, refused if an earlier cell is nearer than a normally distributed minimum on the \
         torus; exactly n (Wässle & Riemann 1978, Galli-Resta et al. 1999)"
    }

    fn exact(&self) -> bool {
        true
    }

    fn settable(&self) -> Option<&dyn Configure> {
        Some(self)
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        let spacing = frame.spacing(n);
        // If d_min is 0 no neighbour is sought, but the grid needs cells of some size.
        let reach = spacing * (self.mean + DEVIATIONS * self.sd).max(0.1);
        let mut cells = TorusCells::new([frame.width, frame.height], reach, n);
        let mut points = Vec::with_capacity(n);
        while points.len() < n {
            let place = (0..TRIALS).find_map(|_| {
                let place = [rng.random::<f64>() * frame.width, rng.random::<f64>() * frame.height];
                (!cells.any_nearer(place, spacing * self.distance(rng))).then_some(place)
            });
            let Some([x, y]) = place else {
                return Err(SampleError::NoRoom {
                    sampler: self.name(),
                    n,
                    placed: points.len(),
                    attempts: TRIALS,
                });
            };
            cells.insert([x, y]);
            points.push(frame.place(x, y));
        }
        Ok(points)
    }
}

impl Settable for MinimalSpacing {
    const SETTINGS: &'static [Setting<Self>] = &[
        Setting {
            name: "eccentricity",
            unit: "mm",
            range: (0., FARTHEST),
            whole: false,
            unset: "not used: `mean` applies",
            meaning: "distance from the fovea; unless `mean` is set, it becomes 7 µm there (Curcio & Sloan 1992), but at most 0.7 spacings",
            get: |_| None,
            set: |s, v| s.mean = Self::mean_at(v),
        },
        Setting {
            name: "mean",
            unit: "spacings",
            range: (0., 0.9),
            whole: false,
            unset: "",
            meaning: "mean of the minimal distance (chosen here)",
            get: |s| Some(s.mean),
            set: |s, v| s.mean = v,
        },
        Setting {
            name: "sd",
            unit: "spacings",
            range: (0., 0.3),
            whole: false,
            unset: "",
            meaning: "standard deviation of the minimal distance (chosen here: a tenth of the mean)",
            get: |s| Some(s.sd),
            set: |s, v| s.sd = v,
        },
    ];
}

impl MinimalSpacing {
    /// Draws a minimal distance of 0 or more, in hexagonal spacings.
    fn distance(&self, rng: &mut dyn Rng) -> f64 {
        loop {
            let distance = truncated(self.mean, self.sd, DEVIATIONS, rng);
            if distance >= 0. {
                return distance;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Rectangle, Window};
    use crate::mosaic::hexagonal_spacing;
    use crate::stats::{Deviation, moments, nearest_neighbours};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn torus(height: f64) -> Window {
        Window::Torus(Rectangle::new(0., 0., 1., height).unwrap())
    }

    #[test]
    fn exactly_n_points_none_nearer_than_the_mean_less_four_deviations() {
        for (n, height) in [(1, 1.), (2, 1.), (3, 0.01), (50, 0.05), (2000, 1.), (300, 7.)] {
            let window = torus(height);
            let points =
                MinimalSpacing::DEFAULT.sample(n, &window, &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
            assert_eq!(points.len(), n);
            let least = 0.42 * hexagonal_spacing(n, window.area()).unwrap();
            assert!(nearest_neighbours(&points, &window).distances.iter().all(|&d| d >= least * (1. - 1e-9)));
        }
    }

    #[test]
    fn without_deviation_the_distance_is_a_hard_core_and_too_much_of_it_an_error() {
        let hard = MinimalSpacing { mean: 0.72, sd: 0. };
        let points = hard.sample(800, &torus(1.), &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
        let least = 0.72 * hexagonal_spacing(800, 1.).unwrap();
        let nearest = nearest_neighbours(&points, &torus(1.));
        assert!(nearest.distances.iter().all(|&d| d >= least * (1. - 1e-9)));
        let full =
            MinimalSpacing { mean: 0.9, sd: 0. }.sample(800, &torus(1.), &mut ChaCha8Rng::seed_from_u64(1));
        // darts find no more room at (.777/.9)² of the number
        assert!(matches!(full, Err(SampleError::NoRoom { placed: 520..=600, .. })), "{full:?}");
    }

    #[test]
    fn regularity_grows_with_the_mean() {
        let window = Window::unit_square();
        let ri = |mean: f64, sd: f64| {
            let model = MinimalSpacing { mean, sd };
            let points = model.sample(1024, &window, &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
            moments(&nearest_neighbours(&points, &window).distances, Deviation::Population).ri.unwrap()
        };
        let found = [(0., 0.), (0.3, 0.03), (0.5, 0.05), (0.7, 0.07)].map(|(mean, sd)| ri(mean, sd));
        println!("{found:?}");
        assert!(found.is_sorted() && (1.7..2.).contains(&found[0]), "{found:?}");
    }

    #[test]
    fn peripheral_cones_keep_seven_micrometres_apart() {
        assert!([0., 0.5, 1.5].iter().all(|&mm| MinimalSpacing::mean_at(mm) == 0.7));
        // at 10 mm the spacing of 4450 cones per mm² is 16.1 µm
        assert!((MinimalSpacing::mean_at(10.) - 7. / 16.109).abs() < 1e-4);
        let at = MinimalSpacing::DEFAULT.configure(&[("eccentricity", "10")]).unwrap();
        let set = MinimalSpacing { mean: MinimalSpacing::mean_at(10.), ..MinimalSpacing::DEFAULT };
        let sample =
            |model: &dyn Sampler| model.sample(99, &torus(1.), &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
        assert_eq!(sample(&*at), sample(&set));
    }
}
