use crate::sample::SampleError;
use crate::stats::{EdgeCorrection, Pcf, StatsError};
use thiserror::Error;

/// Reason why a comparison with samplers is impossible or would be meaningless.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum CompareError {
    /// Two curves that were estimated with different options.
    #[error(
        "the pair correlation functions differ in {what} ({first} and {second}): estimate both with the same options"
    )]
    NotComparable {
        /// Name of the property in which the curves differ.
        what: &'static str,
        /// Value of the property in the first curve.
        first: String,
        /// Value of the property in the second curve.
        second: String,
    },
    /// Mosaic with too few points to compare.
    #[error("a comparison needs at least 2 points, found {found}: use a larger window")]
    TooFewPoints {
        /// Number of points found.
        found: usize,
    },
    /// Sampler that failed to make a pattern.
    #[error("sampler {sampler}: {source}")]
    Sample {
        /// Name of the sampler.
        sampler: String,
        /// Reason of the failure.
        source: SampleError,
    },
    /// Sampler for whose pattern a statistic, such as the pair correlation function, could not be
    /// computed.
    #[error("sampler {sampler}: {source}")]
    Stats {
        /// Name of the sampler.
        sampler: String,
        /// Reason of the failure.
        source: StatsError,
    },
    /// Sampler that made fewer than 2 points in every pattern, because the window is too narrow for
    /// it.
    #[error("sampler {sampler} placed fewer than 2 of {n} points: the window is too narrow for it")]
    NoPattern {
        /// Name of the sampler.
        sampler: String,
        /// Number of points asked for.
        n: usize,
    },
    /// Number of simulations or significance level that is out of its range.
    #[error(
        "the number of simulations of a verdict is {found}: expected 39 to 9999 (and a level between 0 and \
         0.5)"
    )]
    Simulations {
        /// Number of simulations asked for.
        found: usize,
    },
    /// Sampler that stopped without a result, because its code panicked.
    #[error("sampler {sampler} stopped without a result: please report it with the command you ran")]
    Interrupted {
        /// Name of the sampler.
        sampler: String,
    },
}

/// Computes the l-infinity distance of two pair correlation functions: the maximum over the bins of
/// |g₁ − g₂| (Öztireli & Gross 2012, <https://doi.org/10.1145/2366145.2366189>).
///
/// Distances r are in hexagonal spacings, so patterns of different densities and units can be
/// compared. Set covariance, translation, isotropic and torus corrections estimate the same
/// function (on average they agree within .01 at 300 points) and may be mixed. An uncorrected curve
/// can only be compared with another uncorrected one.
///
/// # Errors
/// Fails if the curves have no or different distances, differ in kernel or bandwidth, or if only
/// one of the two is corrected for edges.
pub fn l_infinity(a: &Pcf, b: &Pcf) -> Result<f64, CompareError> {
    let differ =
        |what, first: String, second: String| Err(CompareError::NotComparable { what, first, second });
    let grid = |p: &Pcf| match (p.r.first(), p.r.last()) {
        (Some(first), Some(last)) => format!("{} bins from {first} to {last}", p.r.len()),
        _ => "no bins".to_owned(),
    };
    let equal = |x: f64, y: f64| (x - y).abs() <= 1e-9 * x.abs().max(y.abs());
    let same_grid = a.r.len() == b.r.len()
        && a.g.len() == a.r.len()
        && b.g.len() == b.r.len()
        && a.r.iter().zip(&b.r).all(|(&x, &y)| equal(x, y));
    if !same_grid || a.r.is_empty() {
        return differ("their distances", grid(a), grid(b));
    }
    if a.options.kernel != b.options.kernel {
        return differ("kernel", format!("{:?}", a.options.kernel), format!("{:?}", b.options.kernel));
    }
    if !equal(a.options.bandwidth, b.options.bandwidth) {
        return differ("bandwidth", a.options.bandwidth.to_string(), b.options.bandwidth.to_string());
    }
    let uncorrected = |p: &Pcf| p.options.edge == EdgeCorrection::None;
    if uncorrected(a) != uncorrected(b) {
        return differ("edge correction", format!("{:?}", a.options.edge), format!("{:?}", b.options.edge));
    }
    Ok(a.g.iter().zip(&b.g).map(|(x, y)| (x - y).abs()).fold(0., f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point, Window};
    use crate::stats::{Kernel, PcfOptions, pcf};

    fn curve(options: PcfOptions, shift: f64) -> Pcf {
        let points: Vec<Point> = (0..60)
            .map(|i| Point::new((f64::from(i) * 0.618 + shift).fract(), (f64::from(i) + 0.5) / 60.))
            .collect();
        pcf(&points, &Window::unit_square(), &options).unwrap()
    }

    #[test]
    fn distance_is_that_of_the_worst_bin_and_symmetric() {
        let default = PcfOptions::default();
        let a = curve(default, 0.);
        let mut b = a.clone();
        assert_eq!(l_infinity(&a, &b), Ok(0.));
        b.g[77] += 0.25;
        b.g[78] -= 0.125;
        assert!((l_infinity(&a, &b).unwrap() - 0.25).abs() < 1e-12);
        assert_eq!(l_infinity(&a, &b), l_infinity(&b, &a));
    }

    #[test]
    fn curves_made_differently_are_refused_by_the_difference() {
        let default = PcfOptions::default();
        let a = curve(default, 0.);
        for (options, part) in [
            (PcfOptions { bins: 100, ..default }, "distances"),
            (PcfOptions { r_max: 3., ..default }, "distances"),
            (PcfOptions { kernel: Kernel::Box, ..default }, "kernel"),
            (PcfOptions { bandwidth: 0.09, ..default }, "bandwidth"),
            (PcfOptions { edge: EdgeCorrection::None, ..default }, "edge correction"),
        ] {
            let message = l_infinity(&a, &curve(options, 0.)).unwrap_err().to_string();
            assert!(message.contains(part), "{message}");
        }
    }

    #[test]
    fn corrections_that_estimate_the_same_function_compare() {
        let default = PcfOptions::default();
        let translation = PcfOptions { edge: EdgeCorrection::Translation, ..default };
        assert!(l_infinity(&curve(default, 0.), &curve(translation, 0.)).is_ok());
    }
}
