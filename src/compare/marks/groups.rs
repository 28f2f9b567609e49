use super::{Score, Summary, summarise};
use crate::compare::clusters;
use crate::numeric::mean;
use crate::stats::{Deviation, moments};
use serde::Serialize;

/// Summary of the scores of one group of images, such as the images of one subject.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct GroupSummary {
    /// Name of the group.
    pub group: String,
    /// Means over the group's images, and pooled rates.
    #[serde(flatten)]
    pub summary: Summary,
    /// Standard deviation of the Dice coefficients of the group's n images, with the divisor n − 1;
    /// `None` for a single image.
    pub dice_sd: Option<f64>,
}

/// Means over groups of images. Every group has the same weight, however many images it contains.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct MeanOverGroups {
    /// Number of groups averaged.
    pub groups: usize,
    /// Mean of the groups' mean sensitivities.
    pub sensitivity: f64,
    /// Mean of the groups' mean false discovery rates.
    pub fdr: f64,
    /// Mean of the groups' mean precisions.
    pub precision: f64,
    /// Mean of the groups' mean Dice coefficients.
    pub dice: f64,
    /// Standard deviation of the mean Dice coefficients of the n groups, with the divisor n − 1;
    /// `None` for a single group.
    pub dice_sd: Option<f64>,
}

/// Returns one summary per group, sorted by name of the group.
///
/// `names` contains the name of each image's group, and `scores` the score of each image. Images
/// without a group are left out.
pub fn by_group(names: &[Option<&str>], scores: &[Score]) -> Vec<GroupSummary> {
    let summary_of = |members: Vec<usize>| {
        let group = names[*members.first()?]?.to_owned();
        let scores: Vec<Score> = members.iter().filter_map(|&i| scores.get(i).copied()).collect();
        let dice: Vec<f64> = scores.iter().map(|s| s.rates.dice).collect();
        let dice_sd = moments(&dice, Deviation::Sample).sd;
        Some(GroupSummary { group, summary: summarise(&scores)?, dice_sd })
    };
    clusters(names).into_iter().filter_map(summary_of).collect()
}

/// Averages the summaries of groups; `None` without groups.
pub fn mean_over_groups(groups: &[GroupSummary]) -> Option<MeanOverGroups> {
    let values = |value: fn(&Summary) -> f64| groups.iter().map(|g| value(&g.summary)).collect::<Vec<_>>();
    Some(MeanOverGroups {
        groups: groups.len(),
        sensitivity: mean(&values(|s| s.sensitivity))?,
        fdr: mean(&values(|s| s.fdr))?,
        precision: mean(&values(|s| s.precision))?,
        dice: mean(&values(|s| s.dice))?,
        dice_sd: moments(&values(|s| s.dice), Deviation::Sample).sd,
    })
}
