use super::maps::MapArgs;
use super::pcf::PcfArgs;
use super::rois::RoiArgs;
use super::scale::ScaleArgs;
use super::summary::SummaryArgs;
use anyhow::Result;
use clap::Args;
use clap::builder::PossibleValuesParser;
use conemosaic::batch::Plan;
use conemosaic::compare::VerdictOptions;
use conemosaic::mosaic::io::ReadOptions;
use conemosaic::report::{FigureFormat, PowerScale};
use conemosaic::sample::samplers_named;
use conemosaic::stats::{Deviation, FunctionOptions, MeasureOptions, SpectrumOptions};
use strum::VariantNames;

/// What is computed of every mosaic and written about it: the same for images and coordinate files.
#[derive(Args)]
pub struct PlanArgs {
    /// Samplers to compare with, separated by commas; “all” is every one, slow ones included; “none” is none
    /// [default of run and compare: those marked * by `conemosaic sample --list`; of measure: none]
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', help_heading = "Comparison with samplers")]
    samplers: Vec<String>,
    /// Standard deviation: sample (n − 1) or population (n, as in the tables of Lanaro et al.)
    #[arg(long, value_name = "SD", default_value = "sample", value_parser = PossibleValuesParser::new(Deviation::VARIANTS))]
    sd: String,
    #[command(flatten)]
    summary: SummaryArgs,
    #[command(flatten)]
    pcf: PcfArgs,
    /// Also write the power spectrum of the points; its picture linear (white: 3 times the power of independent
    /// points) or in dB (−20 to +10): --spectrum, --spectrum=db
    #[arg(long, value_name = "SCALE", num_args = 0..=1, require_equals = true, default_missing_value = "linear", value_parser = ["linear", "db"], help_heading = "Power spectrum")]
    spectrum: Option<String>,
    /// Highest frequency of the spectrum in √density (0.1–20)
    #[arg(long, value_name = "F", default_value_t = SpectrumOptions::default().max_frequency, requires = "spectrum", help_heading = "Power spectrum")]
    max_frequency: f64,
    /// Also write G, F, J, K, L and g of every mosaic, with each edge correction, and a table of its points
    #[arg(long, help_heading = "Functions of distance")]
    functions: bool,
    /// Distance between their rows, in the unit of the coordinates [default: 1/128 of --r-max]
    #[arg(long, value_name = "STEP", requires = "functions", help_heading = "Functions of distance")]
    r_step: Option<f64>,
    #[command(flatten)]
    maps: MapArgs,
    #[command(flatten)]
    rois: RoiArgs,
    /// Formats of the figures, separated by commas: svg (always), pdf, png (300 dpi)
    #[arg(long, value_name = "F,…", value_delimiter = ',', default_value = "svg")]
    figures: Vec<FigureFormat>,
    #[command(flatten)]
    scale: ScaleArgs,
}

/// The command's own answers where nothing is said.
pub struct Defaults {
    /// Compare with the default samplers.
    pub compare: bool,
    /// The simulations asked for, if any are.
    pub verdict: Option<VerdictOptions>,
    /// Seed of everything random.
    pub seed: u64,
}

impl PlanArgs {
    /// Tells whether maps are asked for.
    pub const fn maps_asked(&self) -> bool {
        self.maps.asked()
    }

    /// Returns the plan; `read`: how the coordinates of regions are to be understood.
    pub fn plan(&self, read: &ReadOptions, defaults: Defaults) -> Result<Plan> {
        let functions =
            self.functions.then_some(FunctionOptions { r_step: self.r_step, r_max: self.pcf.r_max });
        // with functions, the largest distance is theirs, in the unit of the coordinates
        let r_max = self.pcf.r_max.filter(|_| !self.functions);
        let deviation: Deviation = self.sd.parse()?;
        let compared = defaults.compare || defaults.verdict.is_some() || !self.samplers.is_empty();
        let spectrum = self.spectrum.as_ref().map(|scale| {
            let options = SpectrumOptions { max_frequency: self.max_frequency };
            (options, if scale == "db" { PowerScale::Decibel } else { PowerScale::Linear })
        });
        if let Some((options, _)) = &spectrum {
            options.validate()?;
        }
        Ok(Plan {
            measure: MeasureOptions { deviation, pcf: self.pcf.options(r_max)? },
            samplers: if compared { samplers_named(&self.samplers)? } else { Vec::new() },
            verdict: defaults.verdict,
            seed: defaults.seed,
            functions,
            spectrum,
            maps: self.maps.request()?,
            rois: self.rois.request(read)?,
            scales: self.scale.source()?,
            labels: self.summary.labels()?,
            metrics: self.summary.metrics(),
            figures: self.figures.clone(),
        })
    }
}
