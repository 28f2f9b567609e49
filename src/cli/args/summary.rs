use anyhow::{Result, bail};
use clap::Args;
use conemosaic::batch::{GroupBy, Labels};
use conemosaic::mosaic::io::Manifest;
use conemosaic::report::MetricSelection;
use std::path::PathBuf;

/// Options for the columns of the summary and for grouping its rows.
#[derive(Args)]
#[command(next_help_heading = "Summary")]
pub struct SummaryArgs {
    /// Columns of summary.csv, by name or by group, separated by commas [default: all]
    ///
    /// Groups: about, density, nearest, samplers, detection, voronoi, regularity, recovery,
    /// orientation, fourier, evenness, expected. The columns chosen are printed on the screen, too.
    /// `conemosaic metrics` explains every column.
    #[arg(long, value_name = "A,B,…")]
    metrics: Option<MetricSelection>,
    /// CSV file with further columns for summary.csv, such as subject, eye or eccentricity
    ///
    /// It has a header, and its first column is an identifier. A row belongs to the files whose
    /// name contains its identifier; of several such rows the one with the longest identifier
    /// counts.
    ///
    /// If it has columns eccentricity_mm (or eccentricity_deg) and meridian (nasal, temporal,
    /// superior or inferior, on the retina), summary.csv lists the density of the average eye at
    /// that location (Curcio et al. 1990) beside the measured one.
    #[arg(long, value_name = "FILE")]
    manifest: Option<PathBuf>,
    /// Rule that groups the files, for groups.csv
    ///
    /// groups.csv holds mean, SD and number of values of every column for
    /// each group.
    ///
    /// column:NAME       by a column of the manifest; just NAME does, too
    /// column:NAME,NAME  by several columns of the manifest
    /// prefix:N          by the first N parts of the file name between
    ///                   underscores
    /// any other text    a regular expression: by its first group in the file
    ///                   name, or by all that it matches if it has no group
    #[arg(long, verbatim_doc_comment, value_name = "RULE")]
    group_by: Option<GroupBy>,
}

impl SummaryArgs {
    /// Returns the columns to be shown, by default all.
    pub fn metrics(&self) -> MetricSelection {
        self.metrics.clone().unwrap_or_default()
    }

    /// Returns the manifest and the rule of grouping, each `None` if its option is not set.
    ///
    /// # Errors
    /// Fails if the manifest cannot be read, or is missing though its columns are to group the
    /// files.
    pub fn labels(&self) -> Result<Labels> {
        let manifest = self.manifest.as_deref().map(Manifest::read).transpose()?;
        if manifest.is_none() && matches!(self.group_by, Some(GroupBy::Columns(_))) {
            bail!("--group-by column:NAME groups by a column of the manifest: give --manifest FILE as well");
        }
        let group_by = match (&self.group_by, &manifest) {
            (Some(rule), Some(manifest)) => Some(rule.clone().with(manifest)),
            (rule, _) => rule.clone(),
        };
        Ok(Labels { manifest, group_by })
    }
}
