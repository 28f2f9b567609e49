use super::Interval;
use crate::stats::{Deviation, moments};
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Two-sided 95 % point of the normal distribution, as Bland & Altman print it.
const Z: f64 = 1.96;

/// Agreement of two methods that measure the same (Bland & Altman 1986, Lancet 327:307): the differences first − second.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Agreement {
    /// Number of pairs of values.
    pub n: usize,
    /// Mean difference.
    pub bias: f64,
    /// Standard deviation (n − 1) of the differences; `None` of a single one.
    pub sd: Option<f64>,
    /// Limits of agreement, bias ± 1.96 standard deviations: between them lie 95 % of normal differences.
    pub limits: Option<Interval>,
}

/// Bias and limits of agreement of `differences`; `None` without any, or if one is not finite.
pub fn agreement(differences: &[f64]) -> Option<Agreement> {
    let found = moments(differences, Deviation::Sample);
    let bias = found.mean?;
    let limits = found.sd.map(|sd| [bias - Z * sd, bias + Z * sd]);
    Some(Agreement { n: found.n, bias, sd: found.sd, limits })
}

impl Agreement {
    /// 95 % confidence interval of the bias, bias ± t(n − 1) s/√n, taking the pairs as independent.
    pub fn bias_interval(&self) -> Option<Interval> {
        self.interval(self.bias, 1.)
    }

    /// 95 % confidence intervals of the lower and the upper limit: limit ± t(n − 1) s √(1/n + 1.96²/(2(n − 1)))
    /// (Bland & Altman 1999, Statistical Methods in Medical Research 8:135, section 2.2), taking the pairs as
    /// independent.
    pub fn limit_intervals(&self) -> Option<[Interval; 2]> {
        let [low, high] = self.limits?;
        let n = self.n as f64;
        let factor = 1. + Z * Z * n / (2. * (n - 1.));
        Some([self.interval(low, factor)?, self.interval(high, factor)?])
    }

    /// centre ± t s √(factor/n).
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

    /// Peak expiratory flow by two meters, 17 subjects, first measurements (Bland & Altman 1986, table 1): printed are a
    /// mean difference of −2.1 l/min, a standard deviation of 38.8, limits −79.7 and 75.5, and 95 % intervals of
    /// −22.0 to 17.8 for the bias, and (with a standard error of √(3 s²/n) = 16.3) −114.3 to −45.1 for the lower limit.
    const FIRST: [f64; 17] = [
        494., 395., 516., 434., 476., 557., 413., 442., 650., 433., 417., 656., 267., 478., 178., 423., 427.,
    ];
    const SECOND: [f64; 17] = [
        512., 430., 520., 428., 500., 600., 364., 380., 658., 445., 432., 626., 260., 477., 259., 350., 451.,
    ];

    #[test]
    fn limits_of_agreement_are_those_that_bland_and_altman_print() {
        let differences: Vec<f64> = FIRST.iter().zip(SECOND).map(|(a, b)| a - b).collect();
        let found = agreement(&differences).unwrap();
        near(found.bias, -2.1, 0.05);
        near(found.sd.unwrap(), 38.8, 0.05);
        // they double the standard deviation where 1.96 belongs: −2.1 ± 76
        let [low, high] = found.limits.unwrap();
        near(low, -2.12 - 1.96 * 38.77, 0.02);
        near(high, -2.12 + 1.96 * 38.77, 0.02);
        let [from, to] = found.bias_interval().unwrap();
        near(from, -22., 0.1);
        near(to, 17.8, 0.1);
        // 1 + 1.96²/2 · n/(n − 1) is 3.04, where they round to 3
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
