use super::input::{Readings, chosen_columns};
use super::output::{OutputFolder, ResultFolder, write_figure};
use super::{BatchError, Grouping};
use crate::compare::{ClusteredAgreement, Intraclass, agreement_of_clusters, clusters, intraclass};
use crate::report::tables::{AGREEMENT, AgreementRow, DIFFERENCES, DifferenceRow, UNPAIRED, UnpairedRow};
use crate::report::{AgreementLine, AgreementPanel, FigureFormat, agreement_figure, column_in_words};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Options of [`agree_files`], which compares graders, sessions or programs.
#[derive(Clone, Debug, Default)]
pub struct AgreementOptions {
    /// Names of the columns to compare. If the list is empty, every column that has numbers in all
    /// tables is compared.
    pub columns: Vec<String>,
    /// Rule by which images form groups, such as the images of one subject. Images of one group do
    /// not count as independent. `None` if every image counts as independent.
    pub grouping: Option<Grouping>,
    /// Formats of the figure besides SVG.
    pub figures: Vec<FigureFormat>,
}

/// Agreement of two graders in one column of their tables.
#[derive(Clone, Debug)]
pub struct ColumnAgreement {
    /// Name of the column.
    pub column: String,
    /// Names of the two graders. Differences are the value of the first grader minus that of the
    /// second.
    pub graders: [String; 2],
    /// Name of each image that both graders have measured, with the values of the first and the
    /// second grader.
    pub pairs: Vec<(String, [f64; 2])>,
    /// Bias and limits of agreement of the differences, with their confidence intervals.
    pub agreement: ClusteredAgreement,
    /// Intraclass correlation of the two graders; its interval treats images as independent, even
    /// if they are grouped. `None` if it cannot be computed.
    pub intraclass: Option<Intraclass>,
}

/// Results of comparing graders by [`agree_files`].
#[derive(Clone, Debug)]
pub struct AgreementOutcome {
    /// Agreements, one per column and pair of graders.
    pub columns: Vec<ColumnAgreement>,
    /// Intraclass correlation over all graders, with the name of the column; empty if there are
    /// only two graders.
    pub overall: Vec<(String, Intraclass)>,
    /// Images that are missing from some tables: name of the image, and names of the graders who
    /// lack it, separated by commas.
    pub unpaired: Vec<(String, String)>,
    /// `true` if images were grouped, so that the images of one group did not count as independent.
    pub grouped: bool,
}

impl AgreementOutcome {
    /// Describes, for the report, how the intervals treat several images of one subject. Returns an
    /// empty text if nothing was compared.
    pub fn method(&self) -> String {
        let Some(first) = self.columns.first() else { return String::new() };
        let (images, groups) = (first.agreement.agreement.n, first.agreement.clusters);
        if !self.grouped {
            return "Intervals treat images as independent, and are too narrow if a subject has several images: group the images by subject."
                .to_owned();
        }
        format!(
            "{images} images of {groups} groups: bias and limits of agreement allow for correlated errors \
             of images of the same group (Bland & Altman 2007; intervals of the limits: Zou 2013). \
             Intervals of intraclass correlations are left out, since they would treat images as \
             independent."
        )
    }
}

/// Columns that the two panels of the figure can show, one list per panel. A panel shows the first
/// column of its list that was compared.
const SHOWN: [&[&str]; 2] =
    [&["density_per_mm2", "density_per_px2", "density", "n"], &["nn_mean_um", "nn_mean_px", "nn_mean", "ri"]];

/// Compares the numbers of graders, sessions or programs image by image.
///
/// Computes paired differences, limits of agreement and intraclass correlations, either for the
/// columns that `options` name or for every column that has numbers in all tables.
///
/// Writes `agreement.csv` (one row per column and pair of graders; with more than two graders also
/// one row per column over all of them), `differences.csv` (one row per column, pair of graders and
/// image), `unpaired.csv` (images that are missing from some tables) and `agreement.svg`.
///
/// # Errors
/// Fails if there are fewer than two tables, a table cannot be read or has no column that names
/// images, a table has two rows for one image, an image has no group, a column asked for is
/// missing, no image has values in two tables, or `out` cannot be written to.
pub fn agree_files(
    files: &[PathBuf],
    options: &AgreementOptions,
    out: &Path,
) -> Result<AgreementOutcome, BatchError> {
    if files.len() < 2 {
        return Err(BatchError::Tables("agreement needs at least two tables: give one per grader".into()));
    }
    let mut readings: Vec<Readings> = files.iter().map(|f| Readings::read(f)).collect::<Result<_, _>>()?;
    // tables of the same name are told apart by their paths
    for k in 0..readings.len() {
        if readings[..k].iter().any(|r| r.label == readings[k].label) {
            readings[k].label = files[k].display().to_string();
        }
    }
    let chosen = chosen_columns(&readings, &options.columns)?;
    let out = ResultFolder::open(out)?;
    let mut items: Vec<&String> = readings.iter().flat_map(|r| r.items.keys()).collect();
    items.sort_unstable();
    items.dedup();
    let groups = groups_of(&items, options.grouping.as_ref())?;
    let unpaired: Vec<(String, String)> = items
        .iter()
        .filter_map(|item| {
            let lacking = readings.iter().filter(|r| !r.items.contains_key(*item));
            let lacking: Vec<&str> = lacking.map(|r| r.label.as_str()).collect();
            (!lacking.is_empty()).then(|| ((*item).clone(), lacking.join(", ")))
        })
        .collect();
    let (mut found, mut overall) = (Vec::new(), Vec::new());
    for column in &chosen {
        let named: Vec<(&Readings, &String)> = readings.iter().zip(&column.named).collect();
        for (k, (first, first_name)) in named.iter().enumerate() {
            for (second, second_name) in &named[k + 1..] {
                let both = |item: &&String| {
                    let values = [first.value(item, first_name)?, second.value(item, second_name)?];
                    Some(((*item).clone(), values))
                };
                let pairs: Vec<(String, [f64; 2])> = items.iter().filter_map(both).collect();
                let differences: Vec<f64> = pairs.iter().map(|(_, [a, b])| a - b).collect();
                let of_pairs: Vec<Option<&str>> =
                    pairs.iter().map(|(item, _)| groups.get(item.as_str()).map(String::as_str)).collect();
                let Some(agreement) = agreement_of_clusters(&differences, &clusters(&of_pairs)) else {
                    continue;
                };
                let rows: Vec<Vec<f64>> = pairs.iter().map(|(_, values)| values.to_vec()).collect();
                found.push(ColumnAgreement {
                    column: column.name.clone(),
                    graders: [first.label.clone(), second.label.clone()],
                    pairs,
                    agreement,
                    intraclass: intraclass(&rows),
                });
            }
        }
        if readings.len() > 2 {
            let row = |item: &&String| {
                named.iter().map(|(r, name)| r.value(item, name)).collect::<Option<Vec<f64>>>()
            };
            let rows: Vec<Vec<f64>> = items.iter().filter_map(row).collect();
            overall.extend(intraclass(&rows).map(|icc| (column.name.clone(), icc)));
        }
    }
    if found.is_empty() {
        let labels: Vec<&str> = readings.iter().map(|r| r.label.as_str()).collect();
        return Err(BatchError::Tables(format!(
            "the tables of {} have no numbers for the same image: images are paired by file name without \
             folder and extension, so make the names agree",
            labels.join(" and ")
        )));
    }
    let outcome = AgreementOutcome { columns: found, overall, unpaired, grouped: options.grouping.is_some() };
    write(&out, &outcome, &options.figures)?;
    out.close(0)?;
    Ok(outcome)
}

/// Returns the name of each image's group, with the image's name as key. The map is empty if images
/// are not to be grouped.
fn groups_of<'a>(
    items: &[&'a String],
    grouping: Option<&Grouping>,
) -> Result<BTreeMap<&'a str, String>, BatchError> {
    let Some(grouping) = grouping else { return Ok(BTreeMap::new()) };
    let group = |item: &&'a String| Ok((item.as_str(), grouping.group_of(item).map_err(BatchError::Tables)?));
    items.iter().map(group).collect()
}

/// Writes the tables and the figure of a comparison.
fn write(out: &OutputFolder, outcome: &AgreementOutcome, figures: &[FigureFormat]) -> Result<(), BatchError> {
    let means = |c: &ColumnAgreement| -> [f64; 2] {
        [0, 1].map(|k| c.pairs.iter().map(|(_, v)| v[k]).sum::<f64>() / c.pairs.len() as f64)
    };
    let pairs = outcome.columns.iter().map(|c| AgreementRow {
        column: &c.column,
        graders: c.graders.each_ref().map(String::as_str),
        n: c.agreement.agreement.n,
        means: Some(means(c)),
        agreement: Some(c.agreement),
        intraclass: c.intraclass,
        grouped: outcome.grouped,
    });
    let overall = outcome.overall.iter().map(|(column, icc)| AgreementRow {
        column,
        graders: ["all", "all"],
        n: icc.items,
        means: None,
        agreement: None,
        intraclass: Some(*icc),
        grouped: outcome.grouped,
    });
    out.write(AGREEMENT.file, &AGREEMENT.csv(pairs.chain(overall))?)?;
    let differences = outcome.columns.iter().flat_map(|c| {
        c.pairs.iter().map(|(image, values)| DifferenceRow {
            image,
            column: &c.column,
            graders: c.graders.each_ref().map(String::as_str),
            values: *values,
        })
    });
    out.write(DIFFERENCES.file, &DIFFERENCES.csv(differences)?)?;
    let unpaired = outcome.unpaired.iter().map(|(image, missing_from)| UnpairedRow { image, missing_from });
    out.write(UNPAIRED.file, &UNPAIRED.csv(unpaired)?)?;
    write_figure(out, "agreement", &figure(outcome), figures)
}

/// Draws Bland–Altman plots of the first two graders, for two of the columns.
fn figure(outcome: &AgreementOutcome) -> String {
    let Some(first) = outcome.columns.first() else { return agreement_figure("", &[]) };
    let of_pair: Vec<&ColumnAgreement> =
        outcome.columns.iter().filter(|c| c.graders == first.graders).collect();
    let mut shown: Vec<&ColumnAgreement> = SHOWN
        .iter()
        .filter_map(|names| names.iter().find_map(|n| of_pair.iter().find(|c| c.column == *n)).copied())
        .collect();
    if shown.is_empty() {
        // no column of `SHOWN` was compared: the first two columns that were
        shown = of_pair.into_iter().take(2).collect();
    }
    let points: Vec<Vec<(f64, f64)>> =
        shown.iter().map(|c| c.pairs.iter().map(|(_, [a, b])| ((a + b) / 2., a - b)).collect()).collect();
    let labels: Vec<[String; 2]> = shown
        .iter()
        .map(|c| {
            let (quantity, unit) = column_in_words(&c.column);
            [format!("mean of {quantity}"), "difference".to_owned()]
                .map(|label| if unit.is_empty() { label } else { format!("{label} ({unit})") })
        })
        .collect();
    let panels: Vec<AgreementPanel> = shown
        .iter()
        .zip(&points)
        .zip(&labels)
        .map(|((c, pairs), [mean, difference])| {
            let line = |value: f64, interval| AgreementLine { value, interval };
            let (found, intervals) = (&c.agreement.agreement, c.agreement.limit_intervals);
            AgreementPanel {
                mean_label: mean,
                difference_label: difference,
                pairs,
                bias: Some(line(found.bias, c.agreement.bias_interval)),
                limits: found
                    .limits
                    .map(|l| [line(l[0], intervals.map(|i| i[0])), line(l[1], intervals.map(|i| i[1]))]),
            }
        })
        .collect();
    let graders = format!("{} − {}", first.graders[0], first.graders[1]);
    let title = if outcome.grouped {
        let clusters = first.agreement.clusters;
        format!("{graders}; limits of agreement from {clusters} groups of images")
    } else {
        graders
    };
    agreement_figure(&title, &panels)
}
