use crate::choice::UnknownChoice;
use crate::geometry::{NearestNeighbours, Point, Window};
use serde::{Deserialize, Serialize};
use strum::{Display, EnumString, IntoStaticStr, VariantArray, VariantNames};

/// Returns, for each point, whether it is interior: at least as far from the border as from its
/// nearest neighbour.
///
/// No point beyond the border can be nearer to an interior point than the neighbour that was found.
/// On a torus all points are interior.
pub fn interior(points: &[Point], window: &Window, nearest: &NearestNeighbours) -> Vec<bool> {
    interior_by(&window.border_distances(points), nearest).collect()
}

/// Returns the same flags as [`interior`]; `borders` contains the distance of every point to the
/// border.
pub(super) fn interior_by(borders: &[f64], nearest: &NearestNeighbours) -> impl Iterator<Item = bool> {
    borders.iter().zip(&nearest.distances).map(|(b, d)| b >= d)
}

/// Divisor for the variance of n values: n − 1 or n.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    Display,
    EnumString,
    IntoStaticStr,
    VariantArray,
    VariantNames,
)]
#[serde(rename_all = "snake_case")]
#[strum(
    serialize_all = "kebab-case",
    parse_err_ty = UnknownChoice,
    parse_err_fn = UnknownChoice::among::<Deviation>
)]
pub enum Deviation {
    /// Divisor n − 1, for the variance of a sample.
    #[default]
    Sample,
    /// Divisor n, for the variance of an entire population, as in the tables of Lanaro et al.
    /// (2020), <https://doi.org/10.1088/2399-6528/ab8064>.
    Population,
}

impl Deviation {
    /// Returns the name of the divisor in options and tables.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// Mean and standard deviation of a set of values, and their ratio.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Moments {
    /// Number of values, including any that are not finite.
    pub n: usize,
    /// Mean μ; `None` if there are no values or one of them is not finite.
    pub mean: Option<f64>,
    /// Standard deviation σ; `None` if there is no mean, or if the divisor n − 1 is 0.
    pub sd: Option<f64>,
    /// Ratio μ/σ: for nearest-neighbour distances, the regularity (conformity) index.
    ///
    /// Sources: Wässle & Riemann (1978), <https://doi.org/10.1098/rspb.1978.0026>; Cook (1996).
    ///
    /// `None` if there is no σ, or if σ is at most 10⁻¹² |μ|. In the latter case all values are
    /// equal and σ is only rounding error, as in a perfect lattice, whose index is not defined.
    pub ri: Option<f64>,
}

impl Moments {
    /// Converts the moments from the divisor `from`, with which they were computed, to the divisor
    /// `to`.
    ///
    /// `sd` and `ri` become `None` if either divisor is not positive.
    pub fn with_divisor(self, from: Deviation, to: Deviation) -> Self {
        let divisor = |d: Deviation| match d {
            Deviation::Sample => self.n.saturating_sub(1) as f64,
            Deviation::Population => self.n as f64,
        };
        let factor = (divisor(from) / divisor(to)).sqrt();
        let factor = Some(factor).filter(|f| f.is_finite() && *f > 0.);
        let sd = self.sd.zip(factor).map(|(sd, f)| sd * f);
        Self { sd, ri: self.ri.zip(factor).map(|(ri, f)| ri / f), ..self }
    }
}

/// Largest ratio of the standard deviation to the mean for which all values count as equal, because
/// their differences are only rounding error.
const ROUNDING: f64 = 1e-12;

/// Computes the number, mean, standard deviation and mean/SD ratio of `values`.
///
/// `n` is always set. The other fields are `None` if there are no values or one of them is not
/// finite.
pub fn moments(values: &[f64], deviation: Deviation) -> Moments {
    let n = values.len();
    if n == 0 || values.iter().any(|v| !v.is_finite()) {
        return Moments { n, ..Moments::default() };
    }
    let mean = values.iter().sum::<f64>() / n as f64;
    let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    let divisor = match deviation {
        Deviation::Sample => n - 1,
        Deviation::Population => n,
    };
    let sd = (divisor > 0).then(|| (squares / divisor as f64).sqrt());
    let ri = sd.filter(|&sd| sd > ROUNDING * mean.abs()).map(|sd| mean / sd);
    Moments { n, mean: Some(mean), sd, ri }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::nearest_neighbours;

    #[test]
    fn moments_of_one_to_five() {
        let values = [1., 2., 3., 4., 5.];
        let sample = moments(&values, Deviation::Sample);
        assert_eq!((sample.n, sample.mean, sample.sd), (5, Some(3.), Some(2.5f64.sqrt())));
        assert_eq!(sample.ri, Some(3. / 2.5f64.sqrt()));
        assert_eq!(moments(&values, Deviation::Population).sd, Some(2f64.sqrt()));
    }

    #[test]
    fn divisors_convert_into_each_other() {
        let values = [1., 2., 3., 4., 5.];
        let [sample, population] = [Deviation::Sample, Deviation::Population].map(|d| moments(&values, d));
        let found = sample.with_divisor(Deviation::Sample, Deviation::Population);
        assert!((found.sd.unwrap() - population.sd.unwrap()).abs() < 1e-15);
        assert!((found.ri.unwrap() - population.ri.unwrap()).abs() < 1e-15);
        assert_eq!(
            moments(&[2.], Deviation::Population).with_divisor(Deviation::Population, Deviation::Sample).sd,
            None
        );
    }

    #[test]
    fn what_is_not_defined_is_none() {
        assert_eq!(moments(&[], Deviation::Sample), Moments::default());
        let one = moments(&[2.], Deviation::Sample);
        assert_eq!((one.mean, one.sd, one.ri), (Some(2.), None, None));
        let equal = moments(&[2.; 4], Deviation::Sample);
        assert_eq!((equal.sd, equal.ri), (Some(0.), None));
        assert_eq!(moments(&[1., f64::NAN], Deviation::Sample).mean, None);
    }

    #[test]
    fn interior_points_are_farther_from_the_border_than_from_their_neighbour() {
        let points = [Point::new(0.5, 0.5), Point::new(0.5, 0.6), Point::new(0.95, 0.5)];
        let window = Window::unit_square();
        assert_eq!(interior(&points, &window, &nearest_neighbours(&points, &window)), [true, true, false]);
        let torus = Window::unit_torus();
        assert_eq!(interior(&points, &torus, &nearest_neighbours(&points, &torus)), [true; 3]);
    }
}
