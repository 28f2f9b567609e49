//! Cone mosaic as a compressed square array with jitter, after Curcio and Sloan (1992).

use crate::geometry::Point;
use crate::sample::lattice::Lattice;
use crate::sample::{Configure, Frame, SampleError, Sampler, Settable, Setting};
use rand::Rng;
use std::f64::consts::SQRT_2;

/// Compressed-jittered model of Curcio and Sloan (1992): a square array, compressed along one
/// diagonal.
///
/// The array is stretched along the other diagonal so that its density stays, and the points are
/// then displaced.
///
/// **Published** (the abstract): a compressed-jittered model was fitted at seven positions along
/// six meridians of a human retina; the mosaic is least compressed and jittered at the edge of the
/// foveal rod-free zone; spacing is 10–15 % less in one direction, and greater along meridians than
/// across them.
///
/// **As understood here**: the array is square, and the parameters are the ratio of compression and
/// the standard deviation of the jitter. With a ratio of 3^(−1/4) = .760 the compressed array is
/// the triangular lattice.
///
/// **Not available, so chosen here**: the fitted values. The defaults are .8 and .1, with the
/// jitter in sides of the uncompressed cell.
///
/// **Eccentricity**: there is no such parameter, as the abstract gives no numbers for the
/// dependence on eccentricity. Set `compression` and `jitter` for the eccentricity in question;
/// they apply to the entire window.
///
/// Rows lie along the compressed diagonal, which is along x, at a random offset. The number of
/// points is near n. On a torus rows and columns must close, which stretches the array by a few per
/// cent.
///
/// Source: Curcio and Sloan (1992), <https://doi.org/10.1017/S0952523800009639>.
#[derive(Clone, Copy, Debug)]
pub struct CurcioSloan {
    /// Length of one diagonal divided by its length before compression; the other diagonal grows by
    /// the same factor.
    pub compression: f64,
    /// Standard deviation of each point's displacement in x and y, in sides √(A/n) of the
    /// uncompressed square cell, where A is the area of the window.
    pub jitter: f64,
}

impl CurcioSloan {
    /// Default setting, chosen here; see [`CurcioSloan`] for the reason.
    pub const DEFAULT: Self = Self { compression: 0.8, jitter: 0.1 };
}

impl Sampler for CurcioSloan {
    fn name(&self) -> &'static str {
        "curcio-sloan"
    }

    fn about(&self) -> &'static str {
        "square lattice compressed along one diagonal, with jitter; as near n as the lattice allows \
         (Curcio & Sloan 1992)"
    }

    fn in_rows(&self) -> bool {
        true
    }

    fn settable(&self) -> Option<&dyn Configure> {
        Some(self)
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        let side = (frame.width * frame.height / n.max(1) as f64).sqrt();
        // Seen along a diagonal, a square array consists of rows whose points are one diagonal
        // apart; every other row is moved by half a diagonal.
        let (step, row_step) = (SQRT_2 * side * self.compression, side / (SQRT_2 * self.compression));
        Ok(Lattice { step, row_step, shift: 0.5, jitter: self.jitter * side }.fill(n, frame, rng))
    }
}

impl Settable for CurcioSloan {
    const SETTINGS: &'static [Setting<Self>] = &[
        Setting {
            name: "compression",
            unit: "",
            range: (0.5, 1.),
            whole: false,
            unset: "",
            meaning: "length of the compressed diagonal as a share of its length before (chosen here; 0.760 gives the triangular lattice)",
            get: |s| Some(s.compression),
            set: |s, v| s.compression = v,
        },
        Setting {
            name: "jitter",
            unit: "cell sides",
            range: (0., 0.5),
            whole: false,
            unset: "",
            meaning: "standard deviation of each point's displacement in x and y (chosen here)",
            get: |s| Some(s.jitter),
            set: |s, v| s.jitter = v,
        },
    ];
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Rectangle, Window};
    use crate::stats::{Deviation, moments, nearest_neighbours};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn without_jitter_neighbours_are_the_sides_and_the_diagonal_of_the_compressed_cell() {
        let model = CurcioSloan { compression: 0.7, jitter: 0. };
        let window = Window::Rectangle(Rectangle::new(0., 0., 30., 30.).unwrap());
        let points = model.sample(900, &window, &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
        assert!(points.len().abs_diff(900) <= 30);
        // for cells of side 1 the compressed diagonal is .7 √2 long, and the side √(.7² + .7⁻²)/√2
        let nearest = nearest_neighbours(&points, &window);
        let (diagonal, side) = (0.7 * SQRT_2, ((0.49 + 1. / 0.49) / 2f64).sqrt());
        assert!(diagonal < side && nearest.distances.iter().all(|d| (d - diagonal).abs() < 1e-9));
    }

    #[test]
    fn ratio_of_the_fourth_root_of_a_third_gives_the_triangular_lattice() {
        let model = CurcioSloan { compression: 3f64.powf(-0.25), jitter: 0. };
        let window = Window::unit_square();
        let points = model.sample(1000, &window, &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
        let spacing = crate::mosaic::hexagonal_spacing(1000, 1.).unwrap();
        let six = points
            .iter()
            .filter(|p| points.iter().filter(|q| (p.distance(**q) / spacing - 1.).abs() < 1e-9).count() == 6);
        assert!(six.count() > 800);
    }

    #[test]
    fn regularity_of_the_default_is_that_of_real_mosaics() {
        let window = Window::unit_square();
        let of = |seed: u64| {
            let points =
                CurcioSloan::DEFAULT.sample(1024, &window, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
            moments(&nearest_neighbours(&points, &window).distances, Deviation::Population).ri.unwrap()
        };
        let mean = (0..6).map(of).sum::<f64>() / 6.;
        println!("{mean}");
        assert!((8. ..12.).contains(&mean), "{mean}");
    }
}
