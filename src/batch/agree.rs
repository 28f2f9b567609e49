use super::BatchError;
use super::input::{Readings, chosen_columns};
use super::output::{OutputFolder, ResultFolder};
use crate::compare::{Agreement, Intraclass, agreement, intraclass};
use crate::report::tables::{AGREEMENT, AgreementRow, DIFFERENCES, DifferenceRow, UNPAIRED, UnpairedRow};
use crate::report::{AgreementLine, AgreementPanel, agreement_figure};
use std::path::{Path, PathBuf};

/// How two graders agree in one column.
#[derive(Clone, Debug)]
pub struct ColumnAgreement {
    /// The column.
    pub column: String,
    /// Who is held against whom.
    pub graders: [String; 2],
    /// Of every image that both have: its name and both values.
    pub pairs: Vec<(String, [f64; 2])>,
    /// Bias and limits of agreement.
    pub agreement: Agreement,
    /// Intraclass correlation of the two.
    pub intraclass: Option<Intraclass>,
}

/// What came of comparing graders.
#[derive(Clone, Debug)]
pub struct AgreementOutcome {
    /// One a column and pair of graders.
    pub columns: Vec<ColumnAgreement>,
    /// Correlations over all graders, where there are more than two, by column.
    pub overall: Vec<(String, Intraclass)>,
    /// Images that not all graders have, and those who lack them.
    pub unpaired: Vec<(String, String)>,
}

/// What figures show, the first of each row that there is.
const SHOWN: [&[&str]; 2] =
    [&["density_per_mm2", "density_per_px2", "density", "n"], &["nn_mean_um", "nn_mean_px", "nn_mean", "ri"]];

/// Holds the numbers of graders, sessions or programs against each other, image by image: paired differences, limits of agreement and
/// intraclass correlation of every column of numbers that all of them have, or of `columns`.
///
/// Writes `agreement.csv` (one row a column and pair of graders; with more than two a row over all), `differences.csv` (one row an
/// image), `unpaired.csv` (images that somebody lacks) and `agreement.svg`.
///
/// # Errors
/// If there are fewer than two tables, one cannot be read or has no column that names images, an image stands in it twice, a column
/// asked for is missing, nothing can be paired, or `out` cannot be written to.
pub fn agree_files(
    files: &[PathBuf],
    columns: &[String],
    out: &Path,
) -> Result<AgreementOutcome, BatchError> {
    if files.len() < 2 {
        return Err(BatchError::Tables(
            "agreement needs two tables or more: give those of each grader".into(),
        ));
    }
    let mut readings: Vec<Readings> = files.iter().map(|f| Readings::read(f)).collect::<Result<_, _>>()?;
    for k in 0..readings.len() {
        if readings[..k].iter().any(|r| r.label == readings[k].label) {
            readings[k].label = files[k].display().to_string();
        }
    }
    let chosen = chosen_columns(&readings, columns)?;
    let out = ResultFolder::open(out)?;
    let mut items: Vec<&String> = readings.iter().flat_map(|r| r.items.keys()).collect();
    items.sort_unstable();
    items.dedup();
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
                let Some(agreement) = agreement(&differences) else { continue };
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
            "no image has numbers in the tables of {}: images are paired by file name without folder and extension",
            labels.join(" and ")
        )));
    }
    let outcome = AgreementOutcome { columns: found, overall, unpaired };
    write(&out, &outcome)?;
    out.close(0)?;
    Ok(outcome)
}

fn write(out: &OutputFolder, outcome: &AgreementOutcome) -> Result<(), BatchError> {
    let means = |c: &ColumnAgreement| -> [f64; 2] {
        [0, 1].map(|k| c.pairs.iter().map(|(_, v)| v[k]).sum::<f64>() / c.pairs.len() as f64)
    };
    let pairs = outcome.columns.iter().map(|c| AgreementRow {
        column: &c.column,
        graders: c.graders.each_ref().map(String::as_str),
        n: c.agreement.n,
        means: Some(means(c)),
        agreement: Some(c.agreement),
        intraclass: c.intraclass,
    });
    let overall = outcome.overall.iter().map(|(column, icc)| AgreementRow {
        column,
        graders: ["all", "all"],
        n: icc.items,
        means: None,
        agreement: None,
        intraclass: Some(*icc),
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
    out.write("agreement.svg", figure(outcome).as_bytes())
}

/// Bland–Altman plots of the first two graders.
fn figure(outcome: &AgreementOutcome) -> String {
    let Some(first) = outcome.columns.first() else { return agreement_figure("", &[]) };
    let of_pair: Vec<&ColumnAgreement> =
        outcome.columns.iter().filter(|c| c.graders == first.graders).collect();
    let mut shown: Vec<&ColumnAgreement> = SHOWN
        .iter()
        .filter_map(|names| names.iter().find_map(|n| of_pair.iter().find(|c| c.column == *n)).copied())
        .collect();
    if shown.is_empty() {
        shown = of_pair.into_iter().take(2).collect();
    }
    let points: Vec<Vec<(f64, f64)>> =
        shown.iter().map(|c| c.pairs.iter().map(|(_, [a, b])| ((a + b) / 2., a - b)).collect()).collect();
    let labels: Vec<[String; 2]> =
        shown.iter().map(|c| [format!("mean {}", c.column), format!("difference of {}", c.column)]).collect();
    let panels: Vec<AgreementPanel> = shown
        .iter()
        .zip(&points)
        .zip(&labels)
        .map(|((c, pairs), [mean, difference])| {
            let line = |value: f64, interval| AgreementLine { value, interval };
            let intervals = c.agreement.limit_intervals();
            AgreementPanel {
                mean_label: mean,
                difference_label: difference,
                pairs,
                bias: Some(line(c.agreement.bias, c.agreement.bias_interval())),
                limits: c
                    .agreement
                    .limits
                    .map(|l| [line(l[0], intervals.map(|i| i[0])), line(l[1], intervals.map(|i| i[1]))]),
            }
        })
        .collect();
    agreement_figure(&format!("{} − {}", first.graders[0], first.graders[1]), &panels)
}
