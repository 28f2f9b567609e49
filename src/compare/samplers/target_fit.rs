//! Comparison of the pair correlation function of a point pattern with the target function for
//! which the pattern was made.

use crate::geometry::{Point, Window};
use crate::stats::{PcfOptions, StatsError, pcf};

/// Difference between the pair correlation function of points and their target function.
#[derive(Clone, Debug, PartialEq)]
pub struct TargetFit {
    /// Distances at which the two functions are compared, in hexagonal spacings.
    pub r: Vec<f64>,
    /// Values of the target function at the distances `r`, interpolated linearly between the rows
    /// of the target.
    pub wanted: Vec<f64>,
    /// Pair correlation function of the points at the distances `r`, estimated in their window with
    /// default options.
    pub reached: Vec<f64>,
    /// Largest absolute difference between the two functions.
    pub l_infinity: f64,
    /// Distance at which the largest difference occurs, in hexagonal spacings.
    pub worst_r: f64,
}

impl TargetFit {
    /// Returns whether the largest difference lies in the last 0.4 hexagonal spacings of the
    /// distances compared, provided that these end below 5.6 spacings.
    ///
    /// Such a difference says little about the fit. Pairs of points that are farther apart than the
    /// end of the target are left to chance, and they disturb the pair correlation function shortly
    /// before the end.
    pub fn at_the_end(&self) -> bool {
        self.r.last().is_some_and(|last| *last < MOST - END && self.worst_r > last - END)
    }
}

/// Length of the last part of the target, in hexagonal spacings, in which a difference is put down
/// to pairs beyond its end. The difference measured for a target that ends early lay 0.27 spacings
/// before the end (see [`target_fit`]).
const END: f64 = 0.4;

/// Largest l-infinity distance of a good fit; a larger distance is reported as poor. Lanaro et al.
/// (2020), <https://doi.org/10.1088/2399-6528/ab8064>, take two distributions with a smaller
/// distance for the same.
pub const POOR_FIT: f64 = 0.1;

/// Compares the pair correlation function of `points` with the target function for which they were
/// made.
///
/// Each of `rows` contains a distance r in hexagonal spacings and the target's g(r); r must rise.
/// The functions are compared at the distances that both have, up to 6 spacings and up to half the
/// shorter side of the window. Beyond these limits, [`crate::sample::Shaped`] does not control the
/// pattern. If the target ends before .15 spacings, where estimates of g begin, the functions are
/// compared only at .15 spacings. Without rows the differences are NaN.
///
/// Differences that were measured with the mean g of 20 patterns of dart throwing as target: if the
/// target reaches 6 spacings, patterns of 300 to 3000 points miss it by .065–.073, at the edge of
/// the hard core. If the target ends at 2.49 spacings, they miss it by about .1, at 2.22 spacings,
/// because the last quarter of a spacing is not controlled ([`TargetFit::at_the_end`]).
///
/// # Errors
/// Fails if the pair correlation function of the points cannot be estimated, as for fewer than two
/// points.
pub fn target_fit(points: &[Point], window: &Window, rows: &[[f64; 2]]) -> Result<TargetFit, StatsError> {
    let usual = PcfOptions::default();
    let ends = rows.first().zip(rows.last()).map_or([0., 0.], |(first, last)| [first[0], last[0]]);
    let bounds = window.bounds();
    let spacing = crate::mosaic::hexagonal_spacing(points.len(), window.area()).unwrap_or(f64::INFINITY);
    let farthest = 0.5 * bounds.width().min(bounds.height()) / spacing;
    let step = (usual.r_max - usual.r_min) / usual.bins as f64;
    let r_min = ends[0].max(usual.r_min);
    // distances are the left edges of bins, so one more bin is needed to include the last row; 1e-6
    // makes up for rounding
    let bins = ((ends[1].min(MOST).min(farthest) - r_min) / step + 1e-6).floor() + 1.;
    let bins = bins.max(1.);
    let options = PcfOptions { r_min, r_max: r_min + bins * step, bins: bins as usize, ..usual };
    let reached = pcf(points, window, &options)?;
    let wanted: Vec<f64> = reached.r.iter().map(|&r| at(rows, r)).collect();
    let misses = wanted.iter().zip(&reached.g).map(|(a, b)| (a - b).abs());
    let worst = misses.zip(&reached.r).max_by(|a, b| a.0.total_cmp(&b.0));
    let (l_infinity, worst_r) = worst.map_or((f64::NAN, f64::NAN), |(miss, r)| (miss, *r));
    Ok(TargetFit { r: reached.r, wanted, reached: reached.g, l_infinity, worst_r })
}

/// Largest distance at which functions are compared, in hexagonal spacings.
/// [`crate::sample::Shaped`] does not control pairs of points that are farther apart.
const MOST: f64 = 6.;

/// Interpolates `rows` (distance and g) linearly at the distance `r`. Before the first row and
/// after the last row, the value is constant; without rows it is NaN.
fn at(rows: &[[f64; 2]], r: f64) -> f64 {
    let after = rows.partition_point(|row| row[0] <= r);
    match (after.checked_sub(1).and_then(|i| rows.get(i)), rows.get(after)) {
        (Some(&[a, g]), Some(&[b, h])) => g + (h - g) * (r - a) / (b - a),
        (Some(&[_, g]), None) | (None, Some(&[_, g])) => g,
        (None, None) => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::{Sampler, Shaped, TargetCurve, sampler};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn pattern(name: &str, n: usize) -> Vec<Point> {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        sampler(name).unwrap().sample(n, &Window::unit_square(), &mut rng).unwrap()
    }

    fn rows(points: &[Point]) -> Vec<[f64; 2]> {
        let g = pcf(points, &Window::unit_square(), &PcfOptions::default()).unwrap();
        g.r.iter().zip(&g.g).map(|(r, g)| [*r, *g]).collect()
    }

    #[test]
    fn points_fit_their_own_function_on_its_own_distances() {
        let points = pattern("bridson", 500);
        let rows = rows(&points);
        let fit = target_fit(&points, &Window::unit_square(), &rows).unwrap();
        assert_eq!(fit.r.len(), rows.len());
        assert!(fit.l_infinity < 1e-9, "{}", fit.l_infinity);
    }

    #[test]
    fn points_made_for_a_function_come_near_it_and_others_do_not() {
        let rows = rows(&pattern("dart-throwing", 1000));
        let shaped = Shaped { curve: TargetCurve::from_pcf(&rows).unwrap(), nearest: None };
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let made = shaped.sample(1000, &Window::unit_square(), &mut rng).unwrap();
        let near = target_fit(&made, &Window::unit_square(), &rows).unwrap();
        assert!(near.l_infinity < POOR_FIT, "{} at {}", near.l_infinity, near.worst_r);
        let far = target_fit(&pattern("uniform", 1000), &Window::unit_square(), &rows).unwrap();
        assert!(far.l_infinity > 0.5 && far.worst_r < 0.8, "{} at {}", far.l_infinity, far.worst_r);
    }

    #[test]
    fn only_distances_that_the_target_and_the_window_have_count() {
        let points = pattern("uniform", 300);
        let fit = target_fit(&points, &Window::unit_square(), &[[0.5, 1.], [1.2, 1.]]).unwrap();
        assert!((fit.r[0] - 0.5).abs() < 1e-12 && *fit.r.last().unwrap() <= 1.2);
        assert!(target_fit(&points[..1], &Window::unit_square(), &[[0.5, 1.], [1.2, 1.]]).is_err());
    }
}
