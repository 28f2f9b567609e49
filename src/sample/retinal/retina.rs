//! Sizes of cones on the human retina as a function of position, for the models that follow them.

use crate::mosaic::RetinalPlace;
use crate::sample::Setting;

/// Largest eccentricity at which the density of cones is known, in mm.
pub(super) const FARTHEST: f64 = 18.;

/// Returns the parameter `eccentricity` of the models in which cells follow the density of the
/// retina.
pub(super) const fn eccentricity<S>(get: fn(&S) -> Option<f64>, set: fn(&mut S, f64)) -> Setting<S> {
    Setting {
        name: "eccentricity",
        unit: "mm",
        range: (0., FARTHEST),
        whole: false,
        unset: "not used: one mean size everywhere",
        meaning: "distance of the window's middle from the fovea; sizes then follow the cone density of Curcio et al. (1990)",
        get,
        set,
    }
}

/// Returns the number of cones per mm² at `eccentricity` mm from the fovea, as the mean of the four
/// meridians.
///
/// Beyond [`FARTHEST`], the density at [`FARTHEST`] is returned.
pub(super) fn cones_per_mm2(eccentricity: f64) -> f64 {
    let at = |eccentricity_mm| RetinalPlace { eccentricity_mm, meridian: None }.expected_cones_per_mm2();
    at(eccentricity.min(FARTHEST)).unwrap_or(f64::NAN)
}

/// Sizes of cells as a function of position on the retina, relative to the size in the middle of
/// the window.
///
/// Lengths are in the unit of a model, in which cells in the middle have size 1. The fovea lies to
/// the left of the middle, or in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Retina {
    /// Eccentricity of the window's middle in mm, and the model's unit of length in mm.
    ///
    /// The field is `None` if cells have the same size everywhere.
    place: Option<(f64, f64)>,
}

impl Retina {
    /// Creates the sizes around a point at `eccentricity` mm from the fovea, or equal sizes for
    /// `None`.
    ///
    /// `density` is the number of cells of size 1 that the model makes per squared unit of length.
    pub(super) fn around(eccentricity: Option<f64>, density: f64) -> Self {
        Self { place: eccentricity.map(|mm| (mm, (density / cones_per_mm2(mm)).sqrt())) }
    }

    /// Returns the distance between the fovea, which lies to the left, and the middle of the
    /// window.
    pub(super) fn fovea(&self) -> f64 {
        self.place.map_or(0., |(mm, unit)| mm / unit)
    }

    /// Returns the size of a cell at a position relative to the middle of the window.
    pub(super) fn size(&self, [x, y]: [f64; 2]) -> f64 {
        let Some((mm, unit)) = self.place else { return 1. };
        (cones_per_mm2(mm) / cones_per_mm2((mm + x * unit).hypot(y * unit))).sqrt()
    }

    /// Returns an upper bound for the size of the cells with |x| ≤ `half[0]` and |y| ≤ `half[1]`.
    pub(super) fn largest(&self, half: [f64; 2]) -> f64 {
        // Densities rise again by a few per cent in the far periphery, so the corner need not have
        // the largest cell. The factor covers this.
        const RISE: f64 = 1.02;
        if self.place.is_some() { RISE * self.size(half) } else { 1. }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Window;
    use rand::SeedableRng;

    #[test]
    fn density_is_the_published_one_and_falls_from_the_fovea_to_the_periphery() {
        assert!((cones_per_mm2(0.) - 197_000.).abs() < 1e-6 && (cones_per_mm2(99.) - 4_000.).abs() < 1e-6);
        assert!((cones_per_mm2(1.) - 18_750.).abs() < 1e-6);
        let known: Vec<f64> = (0..1400).map(|k| cones_per_mm2(0.01 * f64::from(k))).collect();
        assert!(known.windows(2).all(|pair| pair[1] <= pair[0] + 1e-6));
    }

    #[test]
    fn cells_are_of_size_1_in_the_middle_and_the_smaller_the_nearer_to_the_fovea() {
        for mm in [0., 0.2, 3.] {
            let retina = Retina::around(Some(mm), 1.);
            assert!((retina.size([0., 0.]) - 1.).abs() < 1e-12);
            let fovea = [-retina.fovea(), 0.];
            assert!((retina.size(fovea) - (cones_per_mm2(mm) / 197_000.).sqrt()).abs() < 1e-9);
            for place in [[5., 3.], [-7., 20.], [20., -20.]] {
                assert!(retina.size(place) <= retina.largest([20., 20.]));
            }
        }
        let even = Retina::around(None, 1.);
        assert_eq!((even.size([9., 9.]), even.largest([9., 9.]), even.fovea()), (1., 1., 0.));
    }

    /// Returns the number of cones in the square of side 2 × `half` whose middle lies at
    /// `eccentricity`.
    ///
    /// All lengths are in mm.
    fn cones(eccentricity: f64, half: f64) -> f64 {
        let step = half / 100.;
        let along = |k: i32| (f64::from(k) + 0.5) * step;
        let places = (-100..100).flat_map(|i| (-100..100).map(move |j| (along(i), along(j))));
        places.map(|(x, y)| cones_per_mm2((eccentricity + x).hypot(y)) * step * step).sum()
    }

    #[test]
    fn models_of_a_place_on_the_retina_have_its_gradient_of_density() {
        let n = 4000;
        for model in ["ahumada", "deering"].map(|name| crate::sample::sampler(name).unwrap()) {
            for mm in [0., 0.15, 1.] {
                let model = model.configure(&[("eccentricity", &mm.to_string())]).unwrap();
                let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
                let points = model.sample(n, &Window::unit_square(), &mut rng).unwrap();
                assert_eq!(points.len(), n);
                // half side of the square that holds n cones
                let (mut low, mut high) = (0., 9.);
                while high - low > 1e-6 {
                    let half = (low + high) / 2.;
                    if cones(mm, half) < n as f64 { low = half } else { high = half }
                }
                let inner = points.iter().filter(|p| (p.x - 0.5).abs().max((p.y - 0.5).abs()) < 0.25).count();
                let expected = cones(mm, low / 2.);
                println!("{} {mm} mm: {inner} in the inner quarter, {expected:.0} expected", model.name());
                assert!((inner as f64 / expected - 1.).abs() < 0.04);
                let left = points.iter().filter(|p| p.x < 0.5).count() as f64 / n as f64;
                assert!(if mm == 0. { (left - 0.5).abs() < 0.02 } else { left > 0.51 }, "{mm}: {left}");
            }
        }
    }
}
