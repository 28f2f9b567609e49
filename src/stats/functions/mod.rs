//! Functions of distance: the distance distributions G and F, their ratio J, Ripley's K and L, and
//! the pair correlation function g.
//!
//! Edge corrections and binning are those of spatstat 3.0 (Baddeley, Rubak & Turner 2015,
//! <https://doi.org/10.1201/b19708>), so that values can be compared digit by digit.
//!
//! In a polygon spatstat approximates some quantities by pixels:
//!
//! - F: spatstat takes the distance to the nearest pixel outside the window instead of the distance
//!   to the border. Its F therefore differs from ours by up to .004, measured on one outline.
//! - Translation weights: both programs take them from a table of the set covariance; K is then
//!   within .2 % of the exact value.
//! - Hanisch's estimates: both programs count the area of an eroded mask of pixels; our estimates
//!   of F and G are then within 1 % of spatstat's.

mod empty_space;
mod first_distance;
mod kernel_pcf;
mod ripley;

pub use first_distance::FirstDistance;

use super::StatsError;
use super::error::all_inside;
use crate::geometry::{NearestNeighbours, Point, Window};
use empty_space::empty_space;
use ripley::Ripley;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Largest number of distances at which functions are evaluated. Requests for more are refused with
/// the advice to choose a larger step.
const MAX_ROWS: f64 = 100_000.;
/// Number of steps from 0 to `r_max` if the step is not set.
const DEFAULT_ROWS: f64 = 128.;

/// Distances at which functions are evaluated: 0, `r_step`, 2 `r_step`, … up to `r_max`.
///
/// All lengths are in the unit of the coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FunctionOptions {
    /// Step between successive distances; `None` gives 128 steps up to `r_max`.
    pub r_step: Option<f64>,
    /// Largest distance at which functions are evaluated.
    ///
    /// `None` gives a quarter of the shorter side of the window (Ripley's rule), but, as in
    /// spatstat, at most √(1000/(πλ)), the radius of a disk in which 1000 points are expected at
    /// the density λ.
    pub r_max: Option<f64>,
}

impl FunctionOptions {
    /// Returns the distances for a pattern of `points` points, in the unit of the coordinates.
    ///
    /// # Errors
    /// Fails if a length is not positive or there would be more than 100 000 distances.
    pub fn distances(&self, points: usize, window: &Window) -> Result<Vec<f64>, StatsError> {
        let positive = |option, value: f64| {
            let ok = value.is_finite() && value > 0.;
            if ok { Ok(value) } else { Err(StatsError::Option { option, value, range: "a positive length" }) }
        };
        let bounds = window.bounds();
        let rule = (bounds.width().min(bounds.height()) / 4.)
            .min((1000. * window.area() / (PI * points.max(1) as f64)).sqrt());
        let r_max = positive("r_max", self.r_max.unwrap_or(rule))?;
        let step = positive("r_step", self.r_step.unwrap_or(r_max / DEFAULT_ROWS))?;
        // Rounding must not drop the last distance if `step` divides `r_max` exactly.
        let rows = (r_max / step * (1. + 1e-12)).floor() + 1.;
        if rows > MAX_ROWS {
            let range = "at most 100000, so choose a larger step";
            return Err(StatsError::Option { option: "number of rows of the functions", value: rows, range });
        }
        Ok((0..rows as usize).map(|k| k as f64 * step).collect())
    }
}

/// Functions of distance of one pattern, all evaluated at the same distances.
///
/// A value that is not defined is NaN, for example g at r = 0 or an estimate to which no point
/// contributes.
#[derive(Clone, Debug)]
pub struct Functions {
    /// Distances r, in the unit of the coordinates.
    pub r: Vec<f64>,
    /// Distribution G of the distance from a point to its nearest neighbour; `None` for fewer than
    /// two points.
    pub g: Option<FirstDistance>,
    /// Distribution F of the distance from an arbitrary location in the window to the nearest
    /// point; `None` without points.
    pub f: Option<FirstDistance>,
    /// Values of G and F for independent points of the same density: 1 − exp(−λπr²).
    pub poisson: Vec<f64>,
    /// Ripley's K and the pair correlation function g with their edge corrections; `None` for fewer
    /// than two points.
    ripley: Option<Ripley>,
}

/// Computes all functions of a pattern; `nearest` contains the nearest neighbour of every point.
///
/// On a torus no pair is hidden by a border, so all corrections agree.
///
/// # Errors
/// Fails if the distances are out of range or a point is not inside the window.
pub fn functions(
    points: &[Point],
    window: &Window,
    nearest: &NearestNeighbours,
    options: &FunctionOptions,
) -> Result<Functions, StatsError> {
    let r = options.distances(points.len(), window)?;
    all_inside(points, window)?;
    let density = points.len() as f64 / window.area();
    let empty = empty_space(points, window);
    let borders = window.border_distances(points);
    let g = (!nearest.distances.is_empty())
        .then(|| FirstDistance::new(&nearest.distances, &borders, &r, |r| empty.eroded(window, r)));
    let f = (!points.is_empty())
        .then(|| FirstDistance::new(&empty.distances, &empty.borders, &r, |r| empty.eroded(window, r)));
    Ok(Functions {
        poisson: r.iter().map(|r| -(-density * PI * r * r).exp_m1()).collect(),
        ripley: (points.len() > 1).then(|| Ripley::new(points, &borders, window, &r, true)),
        g,
        f,
        r,
    })
}

impl Functions {
    /// Returns the names and values of all columns, in the order of a table.
    ///
    /// A name consists of the function and spatstat's name of the estimate, for example `G_km` for
    /// the Kaplan–Meier estimate of G. Distances and L are in the unit of the coordinates, K is in
    /// squared units, and the other columns are pure numbers.
    pub fn columns(&self) -> Vec<(&'static str, Vec<f64>)> {
        let nan = || vec![f64::NAN; self.r.len()];
        let of = |d: &Option<FirstDistance>, pick: fn(&FirstDistance) -> &Vec<f64>| {
            d.as_ref().map_or_else(nan, |d| pick(d).clone())
        };
        let j = |pick: fn(&FirstDistance) -> &Vec<f64>| match (&self.g, &self.f) {
            (Some(g), Some(f)) => pick(g)
                .iter()
                .zip(pick(f))
                // J = (1 − G)/(1 − F), where F < 1 (van Lieshout & Baddeley 1996,
                // <https://doi.org/10.1111/j.1467-9574.1996.tb01501.x>).
                .map(|(g, f)| if 1. - f > 1e-12 { (1. - g) / (1. - f) } else { f64::NAN })
                .collect(),
            _ => nan(),
        };
        let k = |pick: fn(&Ripley) -> &Vec<f64>| self.ripley.as_ref().map_or_else(nan, |k| pick(k).clone());
        let l = |pick: fn(&Ripley) -> &Vec<f64>| k(pick).iter().map(|k| (k / PI).sqrt()).collect();
        vec![
            ("r", self.r.clone()),
            ("G_none", of(&self.g, |d| &d.none)),
            ("G_rs", of(&self.g, |d| &d.reduced_sample)),
            ("G_km", of(&self.g, |d| &d.kaplan_meier)),
            ("G_han", of(&self.g, |d| &d.hanisch)),
            ("G_theo", self.poisson.clone()),
            ("F_none", of(&self.f, |d| &d.none)),
            ("F_rs", of(&self.f, |d| &d.reduced_sample)),
            ("F_km", of(&self.f, |d| &d.kaplan_meier)),
            ("F_han", of(&self.f, |d| &d.hanisch)),
            ("J_none", j(|d| &d.none)),
            ("J_rs", j(|d| &d.reduced_sample)),
            ("J_km", j(|d| &d.kaplan_meier)),
            ("J_han", j(|d| &d.hanisch)),
            ("K_none", k(|k| &k.none)),
            ("K_border", k(|k| &k.border)),
            ("K_iso", k(|k| &k.isotropic)),
            ("K_trans", k(|k| &k.translation)),
            ("K_theo", self.r.iter().map(|r| PI * r * r).collect()),
            ("L_none", l(|k| &k.none)),
            ("L_border", l(|k| &k.border)),
            ("L_iso", l(|k| &k.isotropic)),
            ("L_trans", l(|k| &k.translation)),
            ("pcf_trans_divr", k(|k| &k.g_translation.by_r)),
            ("pcf_iso_divr", k(|k| &k.g_isotropic.by_r)),
            ("pcf_trans_divd", k(|k| &k.g_translation.by_d)),
            ("pcf_iso_divd", k(|k| &k.g_isotropic.by_d)),
        ]
    }
}

/// Ripley's K with its edge corrections, in squared units of the coordinates.
#[derive(Clone, Debug)]
pub struct RipleyK {
    /// Distances r, in the unit of the coordinates.
    pub r: Vec<f64>,
    /// K without edge correction.
    pub none: Vec<f64>,
    /// K with the border correction: only points at least r from the border count as first points
    /// of pairs. NaN where there is no such point.
    pub border: Vec<f64>,
    /// K with the translation correction (Ohser & Stoyan 1981,
    /// <https://doi.org/10.1002/bimj.4710230602>).
    pub translation: Vec<f64>,
    /// K with the isotropic correction (Ripley 1976, <https://doi.org/10.2307/3212829>).
    pub isotropic: Vec<f64>,
}

/// Computes only Ripley's K, with the same values as [`functions`].
///
/// # Errors
/// Fails if the distances are out of range, a point is not inside the window, or there are fewer
/// than two points.
pub fn ripley_k(points: &[Point], window: &Window, options: &FunctionOptions) -> Result<RipleyK, StatsError> {
    let r = options.distances(points.len(), window)?;
    all_inside(points, window)?;
    if points.len() < 2 {
        return Err(StatsError::TooFewPoints { statistic: "Ripley's K", needed: 2, found: points.len() });
    }
    let found = Ripley::new(points, &window.border_distances(points), window, &r, false);
    let Ripley { none, border, translation, isotropic, .. } = found;
    Ok(RipleyK { r, none, border, translation, isotropic })
}

/// Returns the index of the first entry of `r` that is at least `d`, or the length of `r` if there
/// is none.
///
/// `r` must begin with 0 and be evenly spaced.
fn first_at_least(r: &[f64], d: f64) -> usize {
    let step = r.get(1).copied().unwrap_or(f64::INFINITY);
    settle(r, (d / step) as usize, d)
}

/// Returns the same index as [`first_at_least`], by a search that starts at the index `near`.
///
/// `near` is a computed index, which rounding may have moved away from the result.
#[inline]
fn settle(r: &[f64], near: usize, d: f64) -> usize {
    let mut k = near.min(r.len());
    while k > 0 && r[k - 1] >= d {
        k -= 1;
    }
    while k < r.len() && r[k] < d {
        k += 1;
    }
    k
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::nearest_neighbours;
    use proptest::prelude::*;

    fn of(points: &[Point], window: &Window, options: &FunctionOptions) -> Result<Functions, StatsError> {
        functions(points, window, &nearest_neighbours(points, window), options)
    }

    fn column(functions: &Functions, name: &str) -> Vec<f64> {
        functions.columns().into_iter().find(|(n, _)| *n == name).unwrap().1
    }

    #[test]
    fn the_square_lattice_on_a_torus_in_closed_form() {
        let points: Vec<Point> =
            (0..100).map(|i| Point::new(f64::from(i % 10) + 0.5, f64::from(i / 10) + 0.5)).collect();
        let window = Window::Torus(crate::geometry::Rectangle::new(0., 0., 10., 10.).unwrap());
        let options = FunctionOptions { r_step: Some(0.1), r_max: Some(1.5) };
        let found = of(&points, &window, &options).unwrap();
        for name in ["G_none", "G_rs", "G_km", "G_han"] {
            let g = column(&found, name);
            assert!((g[9], g[11]) == (0., 1.), "{name} {} {}", g[9], g[11]);
        }
        // Each point has 4 neighbours at 1 and 4 at √2, among 99 others on an area of 100.
        for name in ["K_none", "K_border", "K_iso", "K_trans"] {
            let k = column(&found, name);
            let lambda = if name == "K_border" { 1. } else { 0.99 };
            assert!((k[12] - 4. / lambda).abs() < 1e-9 && (k[15] - 8. / lambda).abs() < 1e-9, "{name} {k:?}");
        }
        let f = column(&found, "F_km");
        assert!((f[4] - PI * 0.16).abs() < 0.02 && f[8] == 1., "{f:?}");
    }

    #[test]
    fn what_is_not_defined_is_not_a_number_and_the_rest_is() {
        let window = Window::rectangle(0., 0., 4., 3.).unwrap();
        let options = FunctionOptions::default();
        for n in 0..4 {
            let points: Vec<Point> = (0..n).map(|i| Point::new(f64::from(i), 1.)).collect();
            let found = of(&points, &window, &options).unwrap();
            assert_eq!(column(&found, "F_none")[5].is_nan(), n == 0);
            assert_eq!(column(&found, "G_none")[5].is_nan(), n < 2);
            assert_eq!(column(&found, "K_iso")[5].is_nan(), n < 2);
            assert_eq!(column(&found, "pcf_iso_divd")[5].is_nan(), n < 2);
        }
        let bad = FunctionOptions { r_step: Some(0.), r_max: None };
        assert!(of(&[], &window, &bad).is_err());
        let fine = FunctionOptions { r_step: Some(1e-9), r_max: None };
        assert!(of(&[], &window, &fine).is_err());
    }

    proptest! {
        #[test]
        fn any_small_pattern_has_distributions_between_0_and_1(
            raw in prop::collection::vec((0..7u8, 0..7u8), 0..30), torus: bool,
        ) {
            let bounds = crate::geometry::Rectangle::new(0., 0., 6., 6.).unwrap();
            let window = if torus { Window::Torus(bounds) } else { Window::Rectangle(bounds) };
            let points: Vec<Point> =
                raw.iter().map(|&(x, y)| Point::new(f64::from(x), f64::from(y))).collect();
            let options = FunctionOptions { r_step: None, r_max: Some(5.) };
            for (name, values) in of(&points, &window, &options).unwrap().columns() {
                let ok = |v: &f64| match name.as_bytes()[0] {
                    b'G' | b'F' => v.is_nan() || (-1e-12..=1. + 1e-12).contains(v),
                    _ => v.is_nan() || (*v >= 0. && v.is_finite()),
                };
                prop_assert!(values.iter().all(ok), "{name} {values:?}");
            }
        }
    }
}
