//! Limits of agreement for differences that fall into clusters, such as the images of one eye.
//!
//! 1. Split the variance of the differences into a part between clusters and a part within
//!    clusters, by one-way analysis of variance.
//! 2. Take the limits of agreement from the sum of both parts (Bland & Altman 2007).
//! 3. Compute the confidence interval of the bias from the number of clusters, and those of the
//!    limits of agreement from the intervals of both parts (Zou 2013).

use super::{Agreement, Interval, agreement};
use statrs::distribution::{ChiSquared, ContinuousCDF, StudentsT};

/// Half-width of a two-sided 95 % interval, in standard deviations of a normal distribution,
/// rounded as Bland & Altman print it.
const Z: f64 = 1.96;

/// Agreement of two methods for measurements that fall into clusters, such as the images of one
/// eye.
///
/// Errors in images of one eye are alike, so ten images of one eye tell less than ten images of
/// different eyes. Treating all images as independent makes the confidence intervals too narrow,
/// and the limits of agreement as well if eyes have unequal numbers of images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClusteredAgreement {
    /// Number of clusters with at least one difference.
    pub clusters: usize,
    /// Bias (mean of all differences) and limits of agreement. Its field `sd` is the square root of
    /// the sum of the variance between clusters and the variance within clusters.
    pub agreement: Agreement,
    /// Standard deviation of the biases of the clusters: the square root of the variance component
    /// between clusters. `None` for fewer than two clusters.
    pub between_sd: Option<f64>,
    /// Standard deviation of the differences within a cluster; `None` if every cluster has a single
    /// difference, or for fewer than two clusters.
    pub within_sd: Option<f64>,
    /// 95 % confidence interval of the bias; `None` for fewer than two clusters.
    pub bias_interval: Option<Interval>,
    /// 95 % confidence intervals of the lower and the upper limit of agreement; `None` for fewer
    /// than two clusters.
    pub limit_intervals: Option<[Interval; 2]>,
}

/// Returns the bias and the limits of agreement of `differences` that fall into clusters.
///
/// Each entry of `clusters` holds the indices of the differences in one cluster. Returns `None` if
/// there are no differences or one of them is not finite.
///
/// The model gives every cluster a bias of its own and lets the true value of the measured quantity
/// differ from image to image. The variance components come from one-way analysis of variance, the
/// limits from their sum (Bland & Altman 2007, section 3, J Biopharm Stat 17:571,
/// <https://doi.org/10.1080/10543400701329422>).
///
/// The interval of the bias uses Student's t with one degree of freedom fewer than there are
/// clusters. The intervals of the limits combine the intervals of the two variance components
/// (“variance estimates recovery”; Zou 2013, Stat Methods Med Res 22:630,
/// <https://doi.org/10.1177/0962280211402548>).
///
/// If each cluster has a single difference, the result equals that of [`agreement`].
pub fn agreement_of_clusters(differences: &[f64], clusters: &[Vec<usize>]) -> Option<ClusteredAgreement> {
    let plain = agreement(differences)?;
    let groups: Vec<Vec<f64>> = clusters
        .iter()
        .map(|c| c.iter().filter_map(|&i| differences.get(i).copied()).collect::<Vec<f64>>())
        .filter(|group| !group.is_empty())
        .collect();
    if groups.iter().all(|g| g.len() == 1) {
        return Some(ClusteredAgreement {
            clusters: groups.len(),
            agreement: plain,
            between_sd: plain.sd,
            within_sd: None,
            bias_interval: plain.bias_interval(),
            limit_intervals: plain.limit_intervals(),
        });
    }
    let parts = Components::of(&groups, plain.bias);
    let sd = parts.map(|p| p.total().sqrt());
    let limits = sd.map(|sd| [plain.bias - Z * sd, plain.bias + Z * sd]);
    Some(ClusteredAgreement {
        clusters: groups.len(),
        agreement: Agreement { sd, limits, ..plain },
        between_sd: parts.map(|p| p.between.sqrt()),
        within_sd: parts.map(|p| p.within.sqrt()),
        bias_interval: parts.and_then(|p| p.bias_interval(plain.bias)),
        limit_intervals: parts.and_then(|p| p.limit_intervals(plain.bias)),
    })
}

/// Variance components of differences that fall into clusters.
#[derive(Clone, Copy)]
struct Components {
    /// Number of clusters, as a float.
    clusters: f64,
    /// Number of differences in all clusters.
    n: f64,
    /// Sum of the squared sizes of the clusters.
    squared_sizes: f64,
    /// Harmonic mean of the sizes of the clusters.
    harmonic_size: f64,
    /// Variance of the biases of the clusters (component between clusters).
    between: f64,
    /// Variance of the differences within a cluster (component within clusters).
    within: f64,
    /// Variance of the clusters' mean differences, with the divisor `clusters` − 1.
    of_means: f64,
}

impl Components {
    /// Estimates the variance components from the differences in each cluster (`groups`) and the
    /// mean of all differences (`bias`). Returns `None` for a single cluster. At least one cluster
    /// must have more than one difference.
    fn of(groups: &[Vec<f64>], bias: f64) -> Option<Self> {
        let clusters = groups.len() as f64;
        if groups.len() < 2 {
            return None;
        }
        let sizes = || groups.iter().map(|g| g.len() as f64);
        let (n, squared_sizes): (f64, f64) = (sizes().sum(), sizes().map(|m| m * m).sum());
        let means: Vec<f64> = groups.iter().map(|g| g.iter().sum::<f64>() / g.len() as f64).collect();
        let square = |v: f64| v * v;
        let between_squares: f64 = sizes().zip(&means).map(|(m, mean)| m * square(mean - bias)).sum();
        let within_squares: f64 =
            groups.iter().zip(&means).flat_map(|(g, mean)| g.iter().map(move |v| square(v - mean))).sum();
        let within = within_squares / (n - clusters);
        // effective size of a cluster; it equals the common size if all clusters are equally large
        let size = (n * n - squared_sizes) / ((clusters - 1.) * n);
        // an estimate below 0, which chance can give, counts as no variance between clusters
        let between = ((between_squares / (clusters - 1.) - within) / size).max(0.);
        let middle = means.iter().sum::<f64>() / clusters;
        let of_means = means.iter().map(|m| square(m - middle)).sum::<f64>() / (clusters - 1.);
        let harmonic_size = clusters / sizes().map(f64::recip).sum::<f64>();
        Some(Self { clusters, n, squared_sizes, harmonic_size, between, within, of_means })
    }

    /// Returns the sum of both components: the variance of a single difference.
    const fn total(&self) -> f64 {
        self.between + self.within
    }

    /// Returns the variance of the mean of all differences.
    fn of_bias(&self) -> f64 {
        (self.between * self.squared_sizes / self.n + self.within) / self.n
    }

    /// Returns the 95 % interval of the bias.
    fn bias_interval(&self, bias: f64) -> Option<Interval> {
        let t = StudentsT::new(0., 1., self.clusters - 1.).ok()?.inverse_cdf(0.975);
        let reach = t * self.of_bias().sqrt();
        Some([bias - reach, bias + reach])
    }

    /// Returns the 95 % intervals of the lower and the upper limit of agreement by the closed form
    /// of Zou (2013), equations 4–6.
    fn limit_intervals(&self, bias: f64) -> Option<[Interval; 2]> {
        // distances from a variance component to the lower and the upper end of its own interval
        let reach = |part: f64, freedom: f64| -> Option<[f64; 2]> {
            let chi = ChiSquared::new(freedom).ok()?;
            let ratio = |q: f64| freedom / chi.inverse_cdf(q);
            Some([part * (1. - ratio(0.975)), part * (ratio(0.025) - 1.)])
        };
        let of_means = reach(self.of_means, self.clusters - 1.)?;
        let inside = reach((1. - 1. / self.harmonic_size) * self.within, self.n - self.clusters)?;
        let [down, up] = [0, 1].map(|side: usize| of_means[side].hypot(inside[side]));
        let sd = self.total().sqrt();
        let [low, high] = [(self.total() - down).max(0.).sqrt(), (self.total() + up).sqrt()];
        let of_bias = Z * self.of_bias().sqrt();
        let [inner, outer] = [of_bias.hypot(Z * (sd - low)), of_bias.hypot(Z * (high - sd))];
        let limits = [bias - Z * sd, bias + Z * sd];
        Some([[limits[0] - outer, limits[0] + inner], [limits[1] - inner, limits[1] + outer]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    fn near(a: f64, b: f64) {
        assert!((a - b).abs() < 1e-9, "{a} instead of {b}");
    }

    /// The three clusters have the means 1, 4 and 7 (mean 4, variance 9). Each contains its mean −
    /// 1, its mean, and its mean + 1.
    ///
    /// The sum of squares between clusters is 54, with two degrees of freedom: the mean square is
    /// 27. The sum within clusters is 6, with six degrees of freedom: the mean square is 1. The
    /// variance component between clusters is (27 − 1)/3 = 26/3.
    #[test]
    fn components_are_those_counted_by_hand() {
        let differences = [0., 1., 2., 3., 4., 5., 6., 7., 8.];
        let clusters: Vec<Vec<usize>> = (0..3).map(|k| (3 * k..3 * k + 3).collect()).collect();
        let found = agreement_of_clusters(&differences, &clusters).unwrap();
        assert_eq!((found.clusters, found.agreement.n, found.agreement.bias), (3, 9, 4.));
        near(found.within_sd.unwrap(), 1.);
        near(found.between_sd.unwrap().powi(2), 26. / 3.);
        near(found.agreement.sd.unwrap().powi(2), 29. / 3.);
        near(found.agreement.limits.unwrap()[1], 4. + 1.96 * (29f64 / 3.).sqrt());
        // the clusters have equal sizes, so the interval is that of the three means; t with two
        // degrees of freedom is 4.302653
        near((found.bias_interval.unwrap()[1] - 4.) / 3f64.sqrt(), 4.302_652_729_696_142);
    }

    #[test]
    fn clusters_of_one_are_independent() {
        let differences = [1., 4., -2., 3., 0.5];
        let singles: Vec<Vec<usize>> = (0..5).map(|i| vec![i]).collect();
        let found = agreement_of_clusters(&differences, &singles).unwrap();
        let plain = agreement(&differences).unwrap();
        assert_eq!((found.agreement, found.bias_interval), (plain, plain.bias_interval()));
        assert_eq!(found.limit_intervals, plain.limit_intervals());
    }

    #[test]
    fn copies_of_an_image_add_no_certainty() {
        let eyes = [1., 4., -2., 3., 0.5];
        let copied: Vec<f64> = eyes.iter().flat_map(|d| [*d; 4]).collect();
        let clusters: Vec<Vec<usize>> = (0..5).map(|k| (4 * k..4 * k + 4).collect()).collect();
        let found = agreement_of_clusters(&copied, &clusters).unwrap();
        let plain = agreement(&eyes).unwrap();
        near(found.agreement.sd.unwrap(), plain.sd.unwrap());
        near(found.bias_interval.unwrap()[0], plain.bias_interval().unwrap()[0]);
        let [taken_as_independent, _] = agreement(&copied).unwrap().bias_interval().unwrap();
        assert!(found.bias_interval.unwrap()[0] < taken_as_independent - 1.);
    }

    #[test]
    fn intervals_hold_the_truth_in_nineteen_of_twenty() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let (between, within, bias) = (2., 1., 0.5);
        let truth = bias + Z * f64::hypot(between, within);
        let (mut of_bias, mut of_limit, trials) = (0, 0, 1000);
        for _ in 0..trials {
            let (mut differences, mut clusters) = (Vec::new(), Vec::new());
            for _ in 0..12 {
                let own: f64 = StandardNormal.sample(&mut rng);
                let first = differences.len();
                for _ in 0..rng.random_range(2..7) {
                    let error: f64 = StandardNormal.sample(&mut rng);
                    differences.push(bias + between * own + within * error);
                }
                clusters.push((first..differences.len()).collect());
            }
            let found = agreement_of_clusters(&differences, &clusters).unwrap();
            let holds = |[low, high]: Interval, value: f64| usize::from(low <= value && value <= high);
            of_bias += holds(found.bias_interval.unwrap(), bias);
            of_limit += holds(found.limit_intervals.unwrap()[1], truth);
        }
        // 950 of 1000 are expected; three standard errors are about 20
        for held in [of_bias, of_limit] {
            assert!((920..=980).contains(&held), "{of_bias} and {of_limit} of {trials}");
        }
    }

    #[test]
    fn one_cluster_has_a_bias_only() {
        let found = agreement_of_clusters(&[1., 2.], &[vec![0, 1]]).unwrap();
        assert_eq!((found.agreement.bias, found.agreement.sd, found.bias_interval), (1.5, None, None));
        assert_eq!(agreement_of_clusters(&[], &[]), None);
    }
}
