use super::{Interval, agreement, clusters};

/// Mean of a quantity over subjects, some of whom have several images.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SubjectMean {
    /// Number of subjects; `None` if no value has the name of a subject, so that every value counts
    /// as a subject of its own.
    pub subjects: Option<usize>,
    /// Mean of the subjects' means; `None` without values.
    pub mean: Option<f64>,
    /// Standard error of `mean`, for n subjects: the standard deviation of their means (divisor n −
    /// 1) divided by √n. `None` for fewer than two subjects.
    pub standard_error: Option<f64>,
    /// 95 % confidence interval of `mean`: mean ± t(n − 1) × standard error, for n subjects. `None`
    /// for fewer than two subjects.
    pub interval: Option<Interval>,
}

/// Averages values over subjects. Each value comes with the name of its subject, and must be
/// finite.
///
/// Values of one subject are not independent, so every subject counts once, with the mean of its
/// values. A value without a name counts as a subject of its own.
pub fn mean_over_subjects(values: &[(Option<&str>, f64)]) -> SubjectMean {
    let names: Vec<Option<&str>> = values.iter().map(|(name, _)| *name).collect();
    let of_subject = |images: &Vec<usize>| {
        images.iter().filter_map(|&i| values.get(i)).map(|(_, value)| value).sum::<f64>()
            / images.len() as f64
    };
    let means: Vec<f64> = clusters(&names).iter().map(of_subject).collect();
    let subjects = names.iter().any(Option::is_some).then_some(means.len());
    // the mean of n numbers and its interval are the bias of n differences and its interval
    let Some(found) = agreement(&means) else { return SubjectMean { subjects, ..SubjectMean::default() } };
    SubjectMean {
        subjects,
        mean: Some(found.bias),
        standard_error: found.sd.map(|sd| sd / (found.n as f64).sqrt()),
        interval: found.bias_interval(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_of_one_subject_count_as_one() {
        let named = [(Some("a"), 1.), (Some("a"), 3.), (Some("b"), 6.), (Some("c"), 10.)];
        let found = mean_over_subjects(&named);
        // the subjects' means are 2, 6 and 10, with a standard deviation of 4; t(2) = 4.3027
        assert_eq!((found.subjects, found.mean), (Some(3), Some(6.)));
        let error = found.standard_error.unwrap();
        assert!((error - 4. / 3f64.sqrt()).abs() < 1e-12, "{error}");
        let [low, high] = found.interval.unwrap();
        assert!((low - (6. - 4.302_652_7 * error)).abs() < 1e-5 && (low + high - 12.).abs() < 1e-9);
    }

    #[test]
    fn without_names_every_image_stands_alone() {
        let found = mean_over_subjects(&[(None, 1.), (None, 3.)]);
        assert_eq!((found.subjects, found.mean, found.standard_error), (None, Some(2.), Some(1.)));
        assert_eq!(mean_over_subjects(&[]), SubjectMean::default());
        let one = mean_over_subjects(&[(Some("a"), 1.), (Some("a"), 3.)]);
        assert_eq!((one.subjects, one.mean, one.standard_error), (Some(1), Some(2.), None));
    }
}
