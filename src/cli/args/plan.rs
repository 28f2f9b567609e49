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

/// Options for what is computed and written for each mosaic, of an image or a coordinate file.
#[derive(Args)]
pub struct PlanArgs {
    /// Samplers (models that draw point patterns) to compare with, separated by commas
    ///
    /// `conemosaic sample --list` lists them. all: every sampler, including the slow ones; none: no
    /// comparison. [default: run and compare take the samplers marked * in that list; measure takes
    /// none, or those marked * with --verdict]
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', help_heading = "Comparison with samplers")]
    samplers: Vec<String>,
    /// Definition of the standard deviation
    ///
    /// sample      divided by n − 1
    /// population  divided by n, as in the tables of Lanaro et al. (2020)
    ///
    /// The regularity index, mean over standard deviation, depends on it too.
    #[arg(long, verbatim_doc_comment, help_heading = None, value_name = "SD", default_value = "sample", value_parser = PossibleValuesParser::new(Deviation::VARIANTS))]
    sd: String,
    #[command(flatten)]
    summary: SummaryArgs,
    #[command(flatten)]
    pcf: PcfArgs,
    /// Also write the power spectrum of the points, as a table and as a picture
    ///
    /// The picture is linear (--spectrum; white in it is 3 times the power of independent points)
    /// or in dB (--spectrum=db; from −20 to +10 dB).
    #[arg(long, value_name = "SCALE", num_args = 0..=1, require_equals = true, default_missing_value = "linear", value_parser = ["linear", "db"], help_heading = "Power spectrum")]
    spectrum: Option<String>,
    /// Highest frequency of the spectrum, in units of √density (0.1–20)
    ///
    /// The unit is √n cycles per side for n points in a unit square.
    #[arg(long, value_name = "F", default_value_t = SpectrumOptions::default().max_frequency, requires = "spectrum", help_heading = "Power spectrum")]
    max_frequency: f64,
    /// Also write functions of distance and a table of the points
    ///
    /// G  distribution of nearest-neighbour distances
    /// F  distribution of distances from locations in the window to the
    ///    nearest point
    /// J  (1 − G)/(1 − F)
    /// K  Ripley's K
    /// L  √(K/π)
    /// g  pair correlation function
    ///
    /// Each is computed with several edge corrections. The table of points
    /// holds the nearest neighbour and the Voronoi cell of each point.
    #[arg(long, verbatim_doc_comment, help_heading = "Functions of distance")]
    functions: bool,
    /// Distance between the rows of these functions [default: 1/128 of the last distance]
    ///
    /// The unit is that of the coordinates. --r-max sets the last distance.
    #[arg(long, value_name = "STEP", requires = "functions", help_heading = "Functions of distance")]
    r_step: Option<f64>,
    #[command(flatten)]
    maps: MapArgs,
    #[command(flatten)]
    rois: RoiArgs,
    /// Formats of the figures, separated by commas: svg, pdf, png (300 dpi)
    ///
    /// SVG files are always written.
    #[arg(long, value_name = "F,…", value_delimiter = ',', default_value = "svg", help_heading = "Figures")]
    figures: Vec<FigureFormat>,
    #[command(flatten)]
    scale: ScaleArgs,
}

/// Settings that differ between the commands that make a plan.
pub struct Defaults {
    /// `true` to compare with the default samplers if `--samplers` is not set.
    pub compare: bool,
    /// Settings of the simulations of each sampler, or `None` to simulate nothing.
    pub verdict: Option<VerdictOptions>,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl PlanArgs {
    /// Returns whether `--maps` is set.
    pub const fn maps_asked(&self) -> bool {
        self.maps.asked()
    }

    /// Returns the plan.
    ///
    /// `read` has the options for reading the coordinates of regions of interest; `defaults` has
    /// the settings of the command.
    ///
    /// # Errors
    /// Fails if a value is out of its range, a sampler is unknown, or a table cannot be read.
    pub fn plan(&self, read: &ReadOptions, defaults: Defaults) -> Result<Plan> {
        let functions =
            self.functions.then_some(FunctionOptions { r_step: self.r_step, r_max: self.pcf.r_max });
        // with --functions, --r-max is in the unit of the coordinates and not for g(r) in spacings
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
