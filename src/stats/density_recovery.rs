//! Density recovery profile: the density of other points around the average point, by distance
//! (Rodieck 1991, <https://doi.org/10.1017/S095252380001049X>).
//!
//! 1. Count the pairs of points by distance, in annuli of equal width.
//! 2. Divide each count by the area of its annuli that lies in the window.
//! 3. Sum the points that are missing, compared with the mean density, up to the first annulus that
//!    is denser than the mean. The effective radius is the radius of an empty disk that lacks as
//!    many points.

use super::StatsError;
use super::edge_weight::{EdgeWeights, MAX_WEIGHT};
use super::error::all_inside;
use super::pairs::PairGrid;
use crate::geometry::{Point, Window};
use crate::mosaic::hexagonal_spacing;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Largest number of annuli; requests for more are refused, because each annulus would contain
/// almost no points.
const MOST_BINS: f64 = 100_000.;
/// Smallest number of points for which the rows of the search grid are processed in parallel.
const PARALLEL_FROM: usize = 8192;

/// Rule for the width of the annuli of a density recovery profile.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BinWidth {
    /// Width w that makes Rodieck's reliability factor k = D·w·√(πA) equal to this number, .1–1000.
    /// D is the mean density and A the area of the window.
    ///
    /// For independent points, the first annuli around all points together contain k² other points
    /// on average. The program Metricks uses k = 4.
    Reliability(f64),
    /// Width set directly, in the unit of the coordinates; it must be positive.
    Length(f64),
}

/// Options of a density recovery profile.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DensityRecoveryOptions {
    /// Width of the annuli. The default is a reliability factor of 4, as in the program Metricks,
    /// which gives a width of 2.1/√n hexagonal spacings for n points.
    pub bin_width: BinWidth,
    /// Largest distance of the profile, in hexagonal spacings of the pattern: .5–50, default 4.
    pub r_max: f64,
}

impl Default for DensityRecoveryOptions {
    fn default() -> Self {
        Self { bin_width: BinWidth::Reliability(4.), r_max: 4. }
    }
}

impl DensityRecoveryOptions {
    /// Checks that every option is in its range.
    ///
    /// # Errors
    /// Fails if an option is out of its range; the error names the permitted range.
    pub fn validate(&self) -> Result<(), StatsError> {
        let check = |ok: bool, option, value, range| {
            if ok { Ok(()) } else { Err(StatsError::Option { option, value, range }) }
        };
        match self.bin_width {
            BinWidth::Reliability(k) => {
                check((0.1..=1000.).contains(&k), "reliability of the density recovery", k, ".1 to 1000")?;
            }
            BinWidth::Length(w) => {
                check(w > 0. && w.is_finite(), "bin width of the density recovery", w, "above 0")?;
            }
        }
        check(
            (0.5..=50.).contains(&self.r_max),
            "r_max of the density recovery",
            self.r_max,
            ".5 to 50 spacings",
        )
    }
}

/// Density recovery profile: the density around the average point as a function of distance, and
/// measures of its dip near distance 0.
///
/// Lengths are in the unit of the coordinates.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DensityRecovery {
    /// Width w of the annuli: annulus i contains distances from iw up to but excluding (i + 1)w.
    pub bin_width: f64,
    /// Radius in the middle of each annulus.
    pub r: Vec<f64>,
    /// Density in each annulus, in points per squared unit, corrected for the part of the annuli
    /// that lies outside the window.
    pub density: Vec<f64>,
    /// Mean density D = n/A of the n points in a window of area A; the profile returns to it at
    /// large distances.
    pub mean_density: f64,
    /// Effective radius √(V/(πD)): the radius of an empty disk that lacks as many points V as the
    /// dip of the profile near distance 0.
    ///
    /// V is the number of points that are missing, compared with the mean density D, in all annuli
    /// before the first one that exceeds D. `None` if no annulus exceeds D.
    pub effective_radius: Option<f64>,
    /// Largest possible effective radius at the mean density D: √(√(4/3)/D), the spacing of the
    /// triangular lattice.
    pub maximum_radius: f64,
    /// Packing factor (effective radius / maximum radius)²: 0 for independent points, 1 for the
    /// triangular lattice. `None` without an effective radius.
    pub packing: Option<f64>,
    /// Reliability factor k = D·w·√(πA), with D the mean density, w the width of the annuli and A
    /// the area of the window.
    pub reliability: f64,
}

/// Computes the density recovery profile of Rodieck (1991).
///
/// For each distance, the number of other points in the annuli around all points is divided by the
/// area of these annuli that lies in the window. This area is the full area of the annuli times the
/// isotropised set covariance of the window at the middle radius r: the share of the window that
/// overlaps with a copy shifted by r, averaged over directions. In a w × h rectangle, the
/// covariance is given by Rodieck's equation, 1 − 2r(w+h)/(πwh) + r²/(πwh); in a polygon, it is
/// computed from the outline; on a torus, it is 1.
///
/// The profile ends at `r_max` or earlier: in a rectangle or torus, at its shorter side, beyond
/// which the equation is not valid; in a polygon, where the covariance falls to .01, so that hardly
/// any pair fits. With few points, so few annuli may remain that none exceeds the mean density;
/// then there is no effective radius. Points that coincide are at distance 0, in the first annulus.
///
/// The time is linear in n, since pairs are counted up to the end of the profile only.
///
/// # Errors
/// Fails if an option is out of its range or asks for more than 10⁵ annuli, if there are fewer than
/// two points, or if a point is not inside the window.
pub fn density_recovery(
    points: &[Point],
    window: &Window,
    options: &DensityRecoveryOptions,
) -> Result<DensityRecovery, StatsError> {
    options.validate()?;
    let (n, area) = (points.len(), window.area());
    let spacing = match hexagonal_spacing(n, area) {
        Some(spacing) if n > 1 => spacing,
        _ => {
            let statistic = "the density recovery profile";
            return Err(StatsError::TooFewPoints { statistic, needed: 2, found: n });
        }
    };
    all_inside(points, window)?;
    let mean_density = n as f64 / area;
    let per_width = mean_density * (PI * area).sqrt();
    let width = match options.bin_width {
        BinWidth::Reliability(k) => k / per_width,
        BinWidth::Length(w) => w,
    };
    let weights = EdgeWeights::new(window);
    let wanted = (options.r_max * spacing / width).ceil();
    if wanted > MOST_BINS {
        let range = "at most 1e5, so choose a larger bin width";
        let option = "number of bins of the density recovery";
        return Err(StatsError::Option { option, value: wanted, range });
    }
    let covariance = |r: f64| if window.is_torus() { 1. } else { weights.covariance(r) };
    let r: Vec<f64> = (0..wanted as usize)
        .map(|bin| (bin as f64 + 0.5) * width)
        .take_while(|&r| r <= weights.covariance_reach() && covariance(r) > 1. / MAX_WEIGHT)
        .collect();

    // Every pair was visited once but counts from both of its ends, hence the factor 2 below.
    let counts = counts(points, window, width, r.len());
    let annulus = |bin: usize| PI * width * width * (2 * bin + 1) as f64;
    let density: Vec<f64> = r
        .iter()
        .zip(&counts)
        .enumerate()
        .map(|(bin, (&r, &count))| 2. * count as f64 / (n as f64 * annulus(bin) * covariance(r)))
        .collect();
    let recovered = density.iter().position(|&d| d > mean_density);
    let effective_radius = recovered.map(|end| {
        let missing = |bin: usize| (mean_density - density[bin]) * annulus(bin);
        let volume: f64 = (0..end).map(missing).sum();
        (volume / (PI * mean_density)).sqrt()
    });
    let maximum_radius = ((4f64 / 3.).sqrt() / mean_density).sqrt();
    Ok(DensityRecovery {
        bin_width: width,
        r,
        density,
        mean_density,
        effective_radius,
        maximum_radius,
        packing: effective_radius.map(|radius| (radius / maximum_radius).powi(2)),
        reliability: per_width * width,
    })
}

/// Counts the pairs of points in each of the first `bins` annuli.
fn counts(points: &[Point], window: &Window, width: f64, bins: usize) -> Vec<u64> {
    let none = || vec![0u64; bins];
    if bins == 0 {
        return none();
    }
    let grid = PairGrid::new(points, window, window.is_torus(), width * bins as f64);
    let of_rows = |rows: std::ops::Range<usize>| {
        let mut counts = none();
        grid.visit(rows, |_, _, dx, dy| {
            if let Some(count) = counts.get_mut(((dx * dx + dy * dy).sqrt() / width) as usize) {
                *count += 1;
            }
        });
        counts
    };
    if points.len() < PARALLEL_FROM {
        return of_rows(0..grid.rows());
    }
    // Counts are integers, so their sum is the same in any order.
    (0..grid.rows()).into_par_iter().map(|row| of_rows(row..row + 1)).reduce(none, |mut sum, part| {
        sum.iter_mut().zip(part).for_each(|(s, p)| *s += p);
        sum
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Polygon, Rectangle};
    use crate::sample::sampler;
    use proptest::prelude::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn pattern(name: &str, n: usize, window: &Window, seed: u64) -> Vec<Point> {
        sampler(name).unwrap().sample(n, window, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap()
    }

    fn of_width(width: f64, r_max: f64) -> DensityRecoveryOptions {
        DensityRecoveryOptions { bin_width: BinWidth::Length(width), r_max }
    }

    /// Returns a triangular lattice of spacing 1 on a torus that it fills: 24 rows of 20 points.
    fn triangular() -> (Vec<Point>, Window) {
        let row = 0.75f64.sqrt();
        let points = (0..480)
            .map(|k| (k % 20, k / 20))
            .map(|(i, j)| Point::new(f64::from(i) + 0.5 * f64::from(j % 2), f64::from(j) * row))
            .collect();
        (points, Window::Torus(Rectangle::new(0., 0., 20., 24. * row).unwrap()))
    }

    #[test]
    fn around_points_of_the_triangular_lattice_nothing_is_nearer_than_the_spacing() {
        let (points, window) = triangular();
        for width in [0.003, 0.03, 0.3] {
            let found = density_recovery(&points, &window, &of_width(width, 1.5)).unwrap();
            // Exactly the annuli that end before the spacing are empty.
            let empty = (1. / width).floor() * width;
            assert!((found.effective_radius.unwrap() - empty).abs() < 1e-9, "{width}: {found:?}");
            assert!((found.maximum_radius - 1.).abs() < 1e-12);
            assert!((found.packing.unwrap() - empty * empty).abs() < 1e-9);
        }
    }

    #[test]
    fn independent_points_have_the_mean_density_everywhere_whatever_the_window() {
        let l = [(0., 0.), (2., 0.), (2., 0.8), (0.9, 0.8), (0.9, 1.5), (0., 1.5)];
        let l = Window::polygon(vec![l.map(|(x, y)| Point::new(x, y)).to_vec()]).unwrap();
        let long = Window::rectangle(3., -1., 7., 0.).unwrap();
        for (k, window) in [l, long, Window::unit_square(), Window::unit_torus()].iter().enumerate() {
            let bounds = window.bounds();
            let mut points = pattern("uniform", 12_000, &Window::Rectangle(bounds), k as u64);
            points.retain(|&p| window.contains(p));
            // The profile extends to .6 of the shorter side or more, where half of each annulus is
            // hidden.
            let options = DensityRecoveryOptions { bin_width: BinWidth::Reliability(200.), r_max: 45. };
            let found = density_recovery(&points, window, &options).unwrap();
            assert!(found.r.len() > 20, "{}", found.r.len());
            for (r, density) in found.r.iter().zip(&found.density) {
                let off = density / found.mean_density - 1.;
                assert!(off.abs() < 0.02, "window {k}, {r}: {off}");
            }
        }
    }

    #[test]
    fn a_rectangle_given_as_a_polygon_has_the_profile_of_a_rectangle() {
        let rectangle = Window::rectangle(10., 0., 13., 2.).unwrap();
        let corners = [(10., 0.), (13., 0.), (13., 2.), (10., 2.)].map(|(x, y)| Point::new(x, y));
        let polygon = Window::Polygon(Polygon::new(vec![corners.to_vec()]).unwrap());
        let points = pattern("poisson-disk", 400, &rectangle, 3);
        let options = DensityRecoveryOptions { r_max: 50., ..DensityRecoveryOptions::default() };
        let [a, b] = [&rectangle, &polygon].map(|w| density_recovery(&points, w, &options).unwrap());
        assert!(a.r.len() > 100 && a.r.last().unwrap() > &1.9);
        assert!(b.r.len() > a.r.len());
        for (k, (a, b)) in a.density.iter().zip(&b.density).enumerate() {
            assert!((a - b).abs() <= 2e-4 * b, "{k}: {a} {b}");
        }
        assert!((a.effective_radius.unwrap() / b.effective_radius.unwrap() - 1.).abs() < 1e-4);
    }

    #[test]
    fn the_default_width_has_reliability_four_and_another_moves_the_radius_by_less_than_itself() {
        let window = Window::unit_square();
        let points = pattern("poisson-disk", 1000, &window, 5);
        let by_default = density_recovery(&points, &window, &DensityRecoveryOptions::default()).unwrap();
        assert!((by_default.reliability - 4.).abs() < 1e-12);
        let spacing = by_default.maximum_radius;
        assert!((by_default.bin_width / spacing * 1000f64.sqrt() - 2.1).abs() < 0.01);
        for factor in [0.5, 2., 4.] {
            let other = of_width(by_default.bin_width * factor, 4.);
            let other = density_recovery(&points, &window, &other).unwrap();
            // The radius ends with the last empty annulus, so it is known to the width of one
            // annulus.
            let off = other.effective_radius.unwrap() - by_default.effective_radius.unwrap();
            assert!(off.abs() <= by_default.bin_width.max(other.bin_width), "{factor}: {off}");
        }
    }

    #[test]
    fn what_has_no_profile_is_refused_and_what_has_no_radius_says_so() {
        let window = Window::unit_square();
        let options = DensityRecoveryOptions::default();
        let p = Point::new(0.5, 0.5);
        for few in [&[][..], &[p]] {
            let found = density_recovery(few, &window, &options);
            assert!(matches!(found, Err(StatsError::TooFewPoints { needed: 2, .. })));
        }
        let outside = [p, Point::new(2., 0.)];
        assert!(matches!(density_recovery(&outside, &window, &options), Err(StatsError::Outside { .. })));
        for bad in [of_width(0., 4.), of_width(f64::NAN, 4.), of_width(0.1, f64::NAN), of_width(1e-9, 4.)] {
            assert!(matches!(density_recovery(&[p, p], &window, &bad), Err(StatsError::Option { .. })));
        }
        // Two points at opposite corners are so far apart that all annuli are empty, and none
        // exceeds the mean density.
        let apart = [Point::new(0., 0.), Point::new(1., 1.)];
        let found = density_recovery(&apart, &window, &of_width(0.1, 1.)).unwrap();
        assert_eq!((found.effective_radius, found.packing), (None, None));
        // For coinciding points the first annulus exceeds the mean density, and nothing is missing
        // before it.
        let found = density_recovery(&[p; 3], &window, &of_width(0.1, 1.)).unwrap();
        assert_eq!((found.effective_radius, found.packing), (Some(0.), Some(0.)));
    }

    #[test]
    fn threads_make_no_difference() {
        let window = Window::unit_square();
        let points = pattern("uniform", 9000, &window, 4);
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| density_recovery(&points, &window, &DensityRecoveryOptions::default()).unwrap())
        };
        assert_eq!(on(1), on(3));
    }

    proptest! {
        #[test]
        fn counts_are_those_of_all_pairs(
            // Coordinates on a coarse lattice make points coincide, lie on a line and lie on the
            // border.
            raw in prop::collection::vec((0..12u8, 0..12u8), 2..40), torus: bool, scale in -12..12i32,
        ) {
            let scale = 10f64.powi(scale);
            let bounds = Rectangle::new(0., 0., 11. * scale, 11. * scale).unwrap();
            let window = if torus { Window::Torus(bounds) } else { Window::Rectangle(bounds) };
            let points: Vec<Point> =
                raw.iter().map(|&(x, y)| Point::new(f64::from(x) * scale, f64::from(y) * scale)).collect();
            let width = 1.37 * scale;
            let found = density_recovery(&points, &window, &of_width(width, 2.)).unwrap();
            let turns: &[f64] = if torus { &[-11., 0., 11.] } else { &[0.] };
            let mut counts = vec![0.; found.r.len()];
            for (i, a) in points.iter().enumerate() {
                for (j, b) in points.iter().enumerate().filter(|(j, _)| *j != i) {
                    let _ = j;
                    for (u, v) in turns.iter().flat_map(|&u| turns.iter().map(move |&v| (u, v))) {
                        let d = (a.x - b.x + u * scale).hypot(a.y - b.y + v * scale);
                        if let Some(count) = counts.get_mut((d / width) as usize) {
                            *count += 1.;
                        }
                    }
                }
            }
            let a = (11. * scale) * (11. * scale);
            for (k, (&r, count)) in found.r.iter().zip(&counts).enumerate() {
                let seen = if torus { 1. } else { 1. - (44. * scale - r) * r / (PI * a) };
                let annulus = PI * width * width * (2 * k + 1) as f64;
                let expected = count / (points.len() as f64 * annulus * seen);
                prop_assert!((found.density[k] - expected).abs() <= 1e-9 * expected, "{} {}", k, r);
            }
        }
    }
}
