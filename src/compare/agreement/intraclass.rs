//! Intraclass correlations and repeatability from a two-way analysis of variance of a complete
//! table of items × raters.
//!
//! 1. Split the sum of squares into parts between items, between raters, and a rest (the error).
//! 2. Form ICC(2,1), absolute agreement, and ICC(3,1), consistency, from the mean squares (Shrout &
//!    Fleiss 1979, <https://doi.org/10.1037/0033-2909.86.2.420>).
//! 3. Compute the intervals of both from quantiles of the F distribution (McGraw & Wong 1996,
//!    <https://doi.org/10.1037/1082-989X.1.1.30>).

use super::Interval;
use serde::Serialize;
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// Reliability of measurements of the same items by several raters, sessions or programs. Every
/// rater measures every item once.
///
/// Computed by analysis of variance: Shrout & Fleiss (1979),
/// <https://doi.org/10.1037/0033-2909.86.2.420>; McGraw & Wong (1996),
/// <https://doi.org/10.1037/1082-989X.1.1.30>.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Intraclass {
    /// Number of items measured.
    pub items: usize,
    /// Number of raters, sessions or programs.
    pub raters: usize,
    /// Absolute agreement, ICC(2,1): reliability of a single measurement by a rater drawn at
    /// random. Differences between the raters' means lower it. `None` if all measurements are
    /// equal.
    pub agreement: Option<f64>,
    /// 95 % confidence interval of `agreement` (McGraw & Wong 1996, case 2A); `None` if it is
    /// undefined.
    pub agreement_interval: Option<Interval>,
    /// Consistency, ICC(3,1): reliability of a single measurement by one of exactly these raters.
    /// It does not depend on differences between the raters' means. `None` if all measurements are
    /// equal.
    pub consistency: Option<f64>,
    /// 95 % confidence interval of `consistency` (McGraw & Wong 1996, case 3C); `None` if it is
    /// undefined.
    pub consistency_interval: Option<Interval>,
    /// Within-item standard deviation: the standard deviation of repeated measurements of one item,
    /// in the unit of the measurements (Bland & Altman 1996, BMJ 313:744,
    /// <https://doi.org/10.1136/bmj.313.7059.744>).
    pub within_sd: f64,
    /// Repeatability coefficient, 1.96 √2 `within_sd`: for 95 % of pairs of measurements of one
    /// item, the two differ by less than this.
    pub repeatability: f64,
    /// Within-item coefficient of variation: `within_sd` in per cent of the mean of all
    /// measurements. `None` if the mean is 0.
    pub within_cv_percent: Option<f64>,
}

/// Computes intraclass correlations from a table with one row per item and one column per rater.
///
/// Returns `None` for fewer than two items or raters, for rows of different lengths, or if a value
/// is not finite.
pub fn intraclass(rows: &[Vec<f64>]) -> Option<Intraclass> {
    let (items, raters) = (rows.len(), rows.first()?.len());
    let sound = rows.iter().all(|r| r.len() == raters && r.iter().all(|v| v.is_finite()));
    if items < 2 || raters < 2 || !sound {
        return None;
    }
    let (n, k) = (items as f64, raters as f64);
    let mean = rows.iter().flatten().sum::<f64>() / (n * k);
    let squares =
        |values: &mut dyn Iterator<Item = f64>| values.map(|v| (v - mean) * (v - mean)).sum::<f64>();
    let total = squares(&mut rows.iter().flatten().copied());
    let between_items = k * squares(&mut rows.iter().map(|r| r.iter().sum::<f64>() / k));
    let rater = |j: usize| rows.iter().map(|r| r[j]).sum::<f64>() / n;
    let between_raters = n * squares(&mut (0..raters).map(rater));
    // rounding may leave a sum of squares slightly below 0
    let rest = (total - between_items - between_raters).max(0.);
    // mean squares, named as by McGraw & Wong: of rows (items), of columns (raters) and of the
    // error
    let (msr, msc, mse) = (between_items / (n - 1.), between_raters / (k - 1.), rest / ((n - 1.) * (k - 1.)));
    let within_sd = ((between_raters + rest) / (n * (k - 1.))).sqrt();
    // a sum of squares this small is rounding error: all measurements are equal
    let varies = total > 1e-24 * mean * mean * n * k;
    let agreement = (msr - mse) / (msr + (k - 1.) * mse + k * (msc - mse) / n);
    let consistency = (msr - mse) / (msr + (k - 1.) * mse);
    let defined = |icc: f64| Some(icc).filter(|v| varies && v.is_finite());
    let quantile =
        |a: f64, b: f64| Some(FisherSnedecor::new(a, b).ok()?.inverse_cdf(0.975)).filter(|f| f.is_finite());
    let freedom = (n - 1.) * (k - 1.);
    let consistency_interval = || -> Option<Interval> {
        let f = msr / mse;
        let (low, high) = (f / quantile(n - 1., freedom)?, f * quantile(freedom, n - 1.)?);
        let icc = |f: f64| (f - 1.) / (f + k - 1.);
        f.is_finite().then(|| [icc(low), icc(high)])
    };
    let agreement_interval = |icc: f64| -> Option<Interval> {
        let a = k * icc / (n * (1. - icc));
        let b = 1. + k * icc * (n - 1.) / (n * (1. - icc));
        let v = (a * msc + b * mse).powi(2) / ((a * msc).powi(2) / (k - 1.) + (b * mse).powi(2) / freedom);
        let others = k * msc + (k * n - k - n) * mse;
        let (low, high) = (quantile(n - 1., v)?, quantile(v, n - 1.)?);
        let interval = [
            n * (msr - low * mse) / (low * others + n * msr),
            n * (high * msr - mse) / (others + n * high * msr),
        ];
        interval.iter().all(|e| e.is_finite()).then_some(interval)
    };
    let agreement = defined(agreement);
    Some(Intraclass {
        items,
        raters,
        agreement,
        agreement_interval: agreement.and_then(agreement_interval),
        consistency: defined(consistency),
        consistency_interval: defined(consistency).and_then(|_| consistency_interval()),
        within_sd,
        repeatability: 1.96 * 2f64.sqrt() * within_sd,
        within_cv_percent: (mean != 0.).then(|| 100. * within_sd / mean.abs()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ratings of six targets by four judges (Shrout & Fleiss 1979, table 2).
    fn published() -> Vec<Vec<f64>> {
        [
            [9., 2., 5., 8.],
            [6., 1., 3., 2.],
            [8., 4., 6., 8.],
            [7., 1., 2., 6.],
            [10., 5., 6., 9.],
            [6., 2., 4., 7.],
        ]
        .map(|row| row.to_vec())
        .to_vec()
    }

    #[test]
    fn correlations_are_those_that_shrout_and_fleiss_print() {
        let found = intraclass(&published()).unwrap();
        let near = |a: f64, b: f64| assert!((a - b).abs() < 0.005, "{a} instead of {b}");
        near(found.agreement.unwrap(), 0.29);
        near(found.consistency.unwrap(), 0.71);
        // the paper also prints the mean square within items, 6.26
        near(found.within_sd.powi(2), 6.26);
        let [[a, b], [c, d]] = [found.agreement_interval.unwrap(), found.consistency_interval.unwrap()];
        assert!(a < 0.29 && 0.29 < b && b < 1. && c < 0.71 && 0.71 < d && d < 1.);
        println!("{found:?}");
    }

    #[test]
    fn a_constant_difference_is_consistent_but_no_agreement() {
        let rows: Vec<Vec<f64>> = (0..8).map(|i| vec![f64::from(i), f64::from(i) + 3.]).collect();
        let found = intraclass(&rows).unwrap();
        assert!((found.consistency.unwrap() - 1.).abs() < 1e-12 && found.agreement.unwrap() < 0.7);
        let same: Vec<Vec<f64>> = (0..8).map(|i| vec![f64::from(i); 3]).collect();
        let found = intraclass(&same).unwrap();
        assert!((found.agreement.unwrap() - 1.).abs() < 1e-12 && found.repeatability < 1e-6);
    }

    #[test]
    fn intervals_cover_what_they_should_in_nineteen_of_twenty() {
        use rand::{RngExt, SeedableRng};
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let mut normal = || (0..12).map(|_| rng.random::<f64>()).sum::<f64>() - 6.;
        let (mut agree, mut consistent) = (0, 0);
        for _ in 0..400 {
            // variances: 4 of items, 1 of raters, 1 of errors; so the true agreement is 4/6 and the
            // true consistency 4/5
            let raters: Vec<f64> = (0..4).map(|_| normal()).collect();
            let rows: Vec<Vec<f64>> = (0..15)
                .map(|_| {
                    let item = 2. * normal();
                    raters.iter().map(|r| item + r + normal()).collect()
                })
                .collect();
            let found = intraclass(&rows).unwrap();
            let covers = |i: Option<Interval>, truth: f64| i.is_some_and(|[a, b]| (a..=b).contains(&truth));
            agree += usize::from(covers(found.agreement_interval, 4. / 6.));
            consistent += usize::from(covers(found.consistency_interval, 4. / 5.));
        }
        println!("{agree} and {consistent} of 400");
        // 380 are expected, with a standard deviation of 4.4; the ranges are ± 4 and ± 3.4 of these
        assert!((362..=398).contains(&agree) && (365..=395).contains(&consistent), "{agree} {consistent}");
    }

    #[test]
    fn tables_that_are_none_have_none() {
        assert_eq!(intraclass(&[]), None);
        assert_eq!(intraclass(&[vec![1., 2.]]), None);
        assert_eq!(intraclass(&[vec![1.], vec![2.]]), None);
        assert_eq!(intraclass(&[vec![1., 2.], vec![3.]]), None);
        assert_eq!(intraclass(&[vec![1., f64::NAN], vec![3., 1.]]), None);
        let flat = intraclass(&[vec![2., 2.], vec![2., 2.]]).unwrap();
        assert_eq!((flat.agreement, flat.consistency, flat.within_sd), (None, None, 0.));
    }
}
