//! Limits of agreement of two methods that measure the same quantity. If their differences are
//! normally distributed, 95 % of the differences lie between the limits.
//!
//! 1. The bias is the mean difference; the limits are bias ± 1.96 standard deviations (Bland &
//!    Altman 1986, Lancet 327:307, <https://doi.org/10.1016/S0140-6736(86)90837-8>).
//! 2. Confidence intervals of the bias and of the limits follow from Student's t distribution
//!    (Bland & Altman 1999, Statistical Methods in Medical Research 8:135, section 2.2,
//!    <https://doi.org/10.1177/096228029900800204>).

use super::Interval;
use crate::stats::{Deviation, moments};
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Half-width of a two-sided 95 % interval, in standard deviations of a normal distribution,
/// rounded as Bland & Altman print it.
const Z: f64 = 1.96;

/// Agreement of two methods that measure the same quantity, computed from the differences first −
/// second.
///
/// Source: Bland & Altman (1986), <https://doi.org/10.1016/S0140-6736(86)90837-8>.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Agreement {
    /// Number of pairs of values.
    pub n: usize,
    /// Mean of the differences first − second.
    pub bias: f64,
    /// Standard deviation of the differences, with the divisor n − 1; `None` for a single
    /// difference.
    pub sd: Option<f64>,
    /// Limits of agreement, bias ± 1.96 standard deviations: 95 % of normally distributed
    /// differences lie between these limits. `None` for a single difference.
    pub limits: Option<Interval>,
}

/// Returns the bias and the limits of agreement of `differences`.
///
/// Returns `None` if there are no differences or one of them is not finite.
///
/// # Examples
/// ```
/// use conemosaic::compare::agreement;
///
/// let [first, second] = [[102., 97., 110., 95.], [100., 99., 107., 96.]]; // cones, two graders
/// let differences: Vec<f64> = first.iter().zip(second).map(|(a, b)| a - b).collect();
/// let found = agreement(&differences).ok_or("no differences")?;
/// assert_eq!(found.bias, 0.5);
/// let [low, high] = found.limits.ok_or("only one difference")?;
/// assert!(low < -2. && high > 3.);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn agreement(differences: &[f64]) -> Option<Agreement> {
    let found = moments(differences, Deviation::Sample);
    let bias = found.mean?;
    let limits = found.sd.map(|sd| [bias - Z * sd, bias + Z * sd]);
    Some(Agreement { n: found.n, bias, sd: found.sd, limits })
}

impl Agreement {
    /// Returns the 95 % confidence interval of the bias: bias ± t(n − 1) s/√n, where s is the
    /// standard deviation of the n differences.
    ///
    /// The pairs are taken as independent. Returns `None` for a single difference.
    pub fn bias_interval(&self) -> Option<Interval> {
        self.interval(self.bias, 1.)
    }

    /// Returns the 95 % confidence intervals of the lower and the upper limit of agreement.
    ///
    /// Each interval is limit ± t(n − 1) s √(1/n + 1.96²/(2(n − 1))), where s is the standard
    /// deviation of the n differences (Bland & Altman 1999, section 2.2,
    /// <https://doi.org/10.1177/096228029900800204>). The pairs are taken as independent. Returns
    /// `None` for a single difference.
    pub fn limit_intervals(&self) -> Option<[Interval; 2]> {
        let [low, high] = self.limits?;
        let n = self.n as f64;
        // the formula above with 1/n taken out of the root: √(1/n + 1.96²/(2(n − 1))) = √(factor/n)
        let factor = 1. + Z * Z * n / (2. * (n - 1.));
        Some([self.interval(low, factor)?, self.interval(high, factor)?])
    }

    /// Returns the interval `centre` ± t(n − 1) s √(`factor`/n), where s is the standard deviation
    /// of the n differences and t(n − 1) the 97.5 % quantile of Student's t distribution with n − 1
    /// degrees of freedom. Returns `None` for a single difference.
    fn interval(&self, centre: f64, factor: f64) -> Option<Interval> {
        let freedom = self.n.checked_sub(1).filter(|f| *f > 0)? as f64;
        let t = StudentsT::new(0., 1., freedom).ok()?.inverse_cdf(0.975);
        let reach = t * self.sd? * (factor / self.n as f64).sqrt();
        Some([centre - reach, centre + reach])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() < tolerance, "{a} instead of {b}");
    }

    /// Peak expiratory flow of 17 subjects by the first of two meters, in l/min: first measurements
    /// of table 1 of Bland & Altman (1986). [`SECOND`] has those by the second meter.
    ///
    /// The paper prints a mean difference of −2.1, a standard deviation of 38.8, limits of −79.7
    /// and 75.5, and 95 % intervals of −22.0 to 17.8 for the bias and of −114.3 to −45.1 for the
    /// lower limit, the latter with a standard error of √(3 s²/n) = 16.3.
    const FIRST: [f64; 17] = [
        494., 395., 516., 434., 476., 557., 413., 442., 650., 433., 417., 656., 267., 478., 178., 423., 427.,
    ];
    /// Peak expiratory flow of the same 17 subjects by the second meter, in l/min.
    const SECOND: [f64; 17] = [
        512., 430., 520., 428., 500., 600., 364., 380., 658., 445., 432., 626., 260., 477., 259., 350., 451.,
    ];

    #[test]
    fn limits_of_agreement_are_those_that_bland_and_altman_print() {
        let differences: Vec<f64> = FIRST.iter().zip(SECOND).map(|(a, b)| a - b).collect();
        let found = agreement(&differences).unwrap();
        near(found.bias, -2.1, 0.05);
        near(found.sd.unwrap(), 38.8, 0.05);
        // the paper's limits are −2.1 ± 76, because it doubles the standard deviation instead of
        // multiplying it by 1.96
        let [low, high] = found.limits.unwrap();
        near(low, -2.12 - 1.96 * 38.77, 0.02);
        near(high, -2.12 + 1.96 * 38.77, 0.02);
        let [from, to] = found.bias_interval().unwrap();
        near(from, -22., 0.1);
        near(to, 17.8, 0.1);
        // 1 + 1.96²/2 · n/(n − 1) is 3.04, which the paper rounds to 3
        let [[from, to], _] = found.limit_intervals().unwrap();
        near((to - from) / 2., 2.1199 * 38.77 * (3.041 / 17f64).sqrt(), 0.05);
        near((from + to) / 2., low, 1e-9);
    }

    #[test]
    fn few_differences_have_few_statistics() {
        assert_eq!(agreement(&[]), None);
        assert_eq!(agreement(&[1., f64::NAN]), None);
        let single = agreement(&[3.]).unwrap();
        assert_eq!((single.bias, single.sd, single.bias_interval()), (3., None, None));
        // t of one degree of freedom is tan(0.475 π) = 12.706
        let two = agreement(&[-1., 1.]).unwrap();
        near(two.bias_interval().unwrap()[1], (0.475 * std::f64::consts::PI).tan(), 1e-9);
    }

    #[test]
    fn equal_differences_have_limits_of_no_width() {
        let found = agreement(&[2.; 5]).unwrap();
        assert_eq!((found.limits, found.bias_interval()), (Some([2.; 2]), Some([2.; 2])));
        assert_eq!(found.limit_intervals(), Some([[2.; 2]; 2]));
    }
}
