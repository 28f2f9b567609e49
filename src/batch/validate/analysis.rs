use super::{ValidationOptions, ValidationRow};
use crate::compare::{
    Difference, Froc, GroupSummary, Interval, JudgedImage, MeanOverGroups, Reliability, Score, Summary,
    Turned, Verdict, by_group, clusters, compare_scores, froc, intervals, mean_over_groups, reliability,
    summarise,
};
use crate::report::{
    TextTable, accuracy_table, agreement_table, comparison_table, group_table, threshold_table,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;

/// The results of a validation over all images.
#[derive(Clone, Debug)]
pub struct Analysis {
    /// Means over images, and rates computed from the counts of all images together.
    pub summary: Summary,
    /// 95 % confidence intervals of the values of `summary`, by the name of the value in
    /// `validation.json`.
    pub intervals: BTreeMap<&'static str, Interval>,
    /// Description of the method by which the intervals were computed.
    pub method: String,
    /// Summaries of the groups, one per group; empty without groups.
    pub groups: Vec<GroupSummary>,
    /// Means over the groups, in which every group counts once; `None` without groups.
    pub over_groups: Option<MeanOverGroups>,
    /// The FROC curve: sensitivity and false alarms at every threshold of the score. `None` unless
    /// all detections have a score.
    pub froc: Option<Froc>,
    /// Reliability of the scores as probabilities; `None` unless all scores lie between 0 and 1.
    pub reliability: Option<Reliability>,
    /// Mean number of false alarms per image: first the number expected from the scores, then the
    /// number observed. `None` unless all scores lie between 0 and 1.
    pub false_alarms: Option<(f64, f64)>,
    /// The comparison with a second detector or grader; `None` if there is no second one.
    pub comparison: Option<Comparison>,
    /// Remarks that are needed to understand the numbers, each a sentence.
    pub notes: Vec<String>,
}

/// The comparison of two detectors or graders on the same images.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Name of the first detector or grader.
    pub first: String,
    /// Name of the second detector or grader.
    pub second: String,
    /// Differences between the two in accuracy, count and density, paired by image.
    pub differences: Vec<Difference>,
    /// Summary of the second detector or grader, scored against the marks.
    pub summary: Summary,
    /// FROC curve of the second detector or grader; `None` unless all its detections have scores.
    pub froc: Option<Froc>,
    /// Summary of the first detector or grader, scored against the second one, whose points are
    /// taken as marks.
    pub between: Summary,
    /// 95 % confidence intervals of the values of `between`, by the name of the value in
    /// `validation.json`.
    pub between_intervals: BTreeMap<&'static str, Interval>,
}

/// Random stream for the intervals against the marks. Every computation has a stream of its own, so
/// that no interval depends on what else is computed.
const AGAINST_MARKS: u64 = 1;
/// Random stream for the comparison of two detectors or graders.
const OF_TWO: u64 = 2;

impl Analysis {
    /// Computes the results over all images; `None` without images.
    pub(super) fn of(rows: &[ValidationRow], options: &ValidationOptions) -> Option<Self> {
        let scores: Vec<Score> = rows.iter().map(|r| r.score).collect();
        let summary = summarise(&scores)?;
        let names: Vec<Option<&str>> = rows.iter().map(|r| r.group.as_deref()).collect();
        let clusters = clusters(&names);
        let rng = |stream: u64| {
            let mut rng = ChaCha8Rng::seed_from_u64(options.seed);
            rng.set_stream(stream);
            rng
        };
        let groups = by_group(&names, &scores);
        let judged: Option<Vec<JudgedImage>> = rows.iter().map(|r| r.judged.clone()).collect();
        let reliability = judged.as_ref().and_then(|images| reliability(&counted(images)));
        let false_alarms = reliability.as_ref().and_then(|_| {
            let expected = rows.iter().map(|r| r.expected_false_alarms).sum::<Option<f64>>()?;
            let n = rows.len() as f64;
            Some((expected / n, summary.pooled.fp as f64 / n))
        });
        let mut analysis = Self {
            intervals: intervals(&scores, &clusters, options.resamples, &mut rng(AGAINST_MARKS)),
            method: method(&groups, options.resamples),
            over_groups: mean_over_groups(&groups),
            groups,
            froc: judged.as_ref().and_then(|images| froc(images)),
            reliability,
            false_alarms,
            comparison: None,
            notes: Vec::new(),
            summary,
        };
        if let Some(versus) = &options.versus {
            let pick = |pick: fn(&super::VersusRow) -> Score| -> Vec<Score> {
                rows.iter().filter_map(|r| r.versus.as_ref()).map(pick).collect()
            };
            let (others, between) = (pick(|v| v.score), pick(|v| v.between));
            let judged: Option<Vec<JudgedImage>> =
                rows.iter().map(|r| r.versus.as_ref()?.judged.clone()).collect();
            analysis.comparison = Some(Comparison {
                first: options.detected.label(),
                second: versus.label(),
                differences: compare_scores(&scores, &others, &clusters, options.resamples, &rng(OF_TWO)),
                summary: summarise(&others)?,
                froc: judged.as_ref().and_then(|images| froc(images)),
                between: summarise(&between)?,
                between_intervals: intervals(&between, &clusters, options.resamples, &mut rng(OF_TWO)),
            });
        }
        analysis.notes = analysis.remarks(rows);
        Some(analysis)
    }

    /// Returns the remarks that are needed to understand the numbers, each a sentence.
    fn remarks(&self, rows: &[ValidationRow]) -> Vec<String> {
        let mut notes = Vec::new();
        // different programs put the origin half a pixel apart, by the same amount along both axes
        if let Some([x, y]) = self.summary.offset_px
            && x.abs().min(y.abs()) > 0.3
            && x * y > 0.
        {
            notes.push(format!(
                "on average, detections lie {x:+.2} px in x and {y:+.2} px in y from their marks, which \
                 adds to the localisation error and can lose hits: if the two use different pixel origins, \
                 state the origin of the marks or of the detections"
            ));
        }
        notes.extend(turned_over(rows));
        notes.extend(swallowed(rows));
        if self.groups.is_empty() {
            notes.push(
                "intervals treat images as independent, and are too narrow if a subject has several \
                 images: group them by subject"
                    .into(),
            );
        }
        // below 6 groups that differ, p is above .05 whatever the data: see `least_p`
        let least = self.comparison.iter().flat_map(|c| &c.differences).map(|d| d.least_p).reduce(f64::min);
        if let Some(least) = least.filter(|p| *p > 0.05 && *p < 1.) {
            let few = if self.groups.is_empty() { "images" } else { "groups" };
            notes.push(format!(
                "with so few {few}, the p-value of the comparison cannot fall below {least:.4}, however \
                 much the two differ: use the intervals instead. With six {few} that differ, p can reach 0.03"
            ));
        }
        let unscored = rows.iter().filter(|r| r.judged.is_none()).count();
        if unscored > 0 && unscored < rows.len() {
            notes.push(format!(
                "detections of {unscored} of {} images have no scores, so neither the FROC curve nor the \
                 reliability is computed: give scores for all images",
                rows.len()
            ));
        }
        if self.froc.is_some() && self.reliability.is_none() {
            notes.push(
                "no detection counts, or scores are not all between 0 and 1 and so no probabilities: no \
                 reliability is computed, and the FROC curve assumes that scores are comparable between \
                 images"
                    .into(),
            );
        }
        notes
    }

    /// Returns the tables for the terminal and the page, each with its heading.
    pub fn tables(&self) -> Vec<(&'static str, TextTable)> {
        let mut tables = vec![
            ("Accuracy", accuracy_table(&self.summary, &self.intervals)),
            (
                "Agreement with the marks",
                agreement_table("detections − marks", &self.summary, &self.intervals),
            ),
        ];
        if !self.groups.is_empty() {
            tables.push(("Groups", group_table(&self.groups, self.over_groups.as_ref())));
        }
        if let Some(froc) = &self.froc {
            let table = threshold_table(froc, self.reliability.as_ref(), self.false_alarms);
            tables.push(("Score", table));
        }
        if let Some(c) = &self.comparison {
            tables.push(("Comparison", comparison_table(&c.first, &c.second, &c.differences)));
            let between = agreement_table("first − second", &c.between, &c.between_intervals);
            tables.push(("Agreement of the two", between));
        }
        tables
    }
}

/// Returns a note for every way in which the marks of images look turned over.
fn turned_over(rows: &[ValidationRow]) -> Vec<String> {
    let mut notes = Vec::new();
    for way in Turned::ALL {
        let of = |r: &&ValidationRow| r.turned.is_some_and(|(w, _)| w == way);
        let these: Vec<&ValidationRow> = rows.iter().filter(of).collect();
        let Some(first) = these.first() else { continue };
        let n = these.len() as f64;
        let now = these.iter().map(|r| r.score.strict.dice).sum::<f64>() / n;
        let right = these.iter().filter_map(|r| r.turned).map(|(_, dice)| dice).sum::<f64>() / n;
        notes.push(format!(
            "the marks of {} of {} images ({}{}) look turned over, as if {}: their strict Dice coefficient is \
             {now:.2} as given and would be {right:.2} otherwise, so check the columns and the origin of the \
             marks and {}",
            these.len(),
            rows.len(),
            first.name,
            if these.len() > 1 { ", …" } else { "" },
            way.words(),
            way.remedy(),
        ));
    }
    notes
}

/// Returns a note if images have marks or detections, but none of one kind inside the border.
fn swallowed(rows: &[ValidationRow]) -> Option<String> {
    let none = |r: &&ValidationRow| r.score.n_marks > 0 && r.score.marks_inside == 0;
    let n = rows.iter().filter(none).count();
    (n > 0).then(|| {
        format!(
            "in {n} of {} images all marks lie in the border that is not counted, so their rates mean \
             nothing: give a narrower border",
            rows.len()
        )
    })
}

/// Returns the scores of all hits and false alarms, each with a flag that is `true` for a hit.
fn counted(images: &[JudgedImage]) -> Vec<(f64, bool)> {
    let all = images.iter().flat_map(|image| &image.judged);
    all.filter_map(|j| match j.verdict {
        Verdict::Hit => Some((j.score, true)),
        Verdict::FalseAlarm => Some((j.score, false)),
        Verdict::Excuse | Verdict::Nothing => None,
    })
    .collect()
}

/// Describes, for the report, the method by which the intervals were computed.
fn method(groups: &[GroupSummary], resamples: usize) -> String {
    if groups.is_empty() {
        format!(
            "95 % intervals: BCa bootstrap with {resamples} resamples of the images; those of bias and \
             limits of agreement from the t distribution (Bland & Altman 1999)"
        )
    } else {
        format!("95 % intervals: BCa bootstrap with {resamples} resamples of the {} groups", groups.len())
    }
}
