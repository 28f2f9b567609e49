use anyhow::{Result, bail};
use clap::Args;
use conemosaic::batch::{GroupBy, Labels};
use conemosaic::mosaic::io::Manifest;
use conemosaic::report::MetricSelection;
use std::path::PathBuf;

/// Which columns a summary has, and what is known of its rows.
#[derive(Args)]
#[command(next_help_heading = "Summary")]
pub struct SummaryArgs {
    /// Columns of summary.csv: groups (about, density, nearest, samplers, detection, voronoi, regularity, recovery,
    /// orientation, fourier, evenness, expected) or names, separated by commas; they are shown on the screen, too.
    /// `conemosaic metrics` lists them [default: all]
    #[arg(long, value_name = "A,B,…")]
    metrics: Option<MetricSelection>,
    /// What is known of the files: CSV whose header names an identifier (a part of the file name; the longest one counts) and
    /// further columns, which are added to summary.csv. eccentricity_mm (or eccentricity_deg) and meridian (nasal, temporal,
    /// superior, inferior, of the retina) bring the density of Curcio et al. (1990) at that place beside the measured one
    #[arg(long, value_name = "FILE")]
    manifest: Option<PathBuf>,
    /// Also write groups.csv, mean, SD and number of every column by group: a column of the manifest
    /// (NAME or column:NAME[,NAME]), prefix:N (the
    /// first N parts of the name between underscores) or a regular expression on the name
    #[arg(long, value_name = "RULE")]
    group_by: Option<GroupBy>,
}

impl SummaryArgs {
    pub fn metrics(&self) -> MetricSelection {
        self.metrics.clone().unwrap_or_default()
    }

    pub fn labels(&self) -> Result<Labels> {
        let manifest = self.manifest.as_deref().map(Manifest::read).transpose()?;
        if manifest.is_none() && matches!(self.group_by, Some(GroupBy::Columns(_))) {
            bail!("--group-by column:NAME needs --manifest FILE");
        }
        let group_by = match (&self.group_by, &manifest) {
            (Some(rule), Some(manifest)) => Some(rule.clone().with(manifest)),
            (rule, _) => rule.clone(),
        };
        Ok(Labels { manifest, group_by })
    }
}
