use anyhow::Result;
use clap::Args;
use clap::builder::PossibleValuesParser;
use conemosaic::stats::{EdgeCorrection, Kernel, PcfOptions};
use strum::VariantNames;

/// How the pair correlation function is estimated. The unit s is the hexagonal spacing of the mosaic.
#[derive(Args)]
#[command(next_help_heading = "Pair correlation function (s: hexagonal spacing)")]
pub struct PcfArgs {
    /// What makes up for pairs hidden by the border; torus needs --torus
    #[arg(long, value_name = "E", default_value = "set-covariance", value_parser = PossibleValuesParser::new(EdgeCorrection::VARIANTS))]
    edge: String,
    /// Shape of the smoothing kernel
    #[arg(long, value_name = "K", default_value = "gaussian", value_parser = PossibleValuesParser::new(Kernel::VARIANTS))]
    kernel: String,
    /// Standard deviation of the kernel in s (0.005–1)
    #[arg(long, value_name = "S", default_value_t = PcfOptions::default().bandwidth)]
    bandwidth: f64,
    /// First bin in s (at least 1.5 bandwidths)
    #[arg(long, value_name = "S", default_value_t = PcfOptions::default().r_min)]
    r_min: f64,
    /// End of the last bin in s (at most 50; default 2.5); with measure --functions it is their last distance instead, in
    /// the unit of the coordinates
    #[arg(long, value_name = "S")]
    pub r_max: Option<f64>,
    /// Number of bins (1–2000)
    #[arg(long, value_name = "N", default_value_t = PcfOptions::default().bins)]
    bins: usize,
}

impl PcfArgs {
    /// Returns the validated options; `r_max` in s.
    pub fn options(&self, r_max: Option<f64>) -> Result<PcfOptions> {
        let options = PcfOptions {
            kernel: self.kernel.parse()?,
            bandwidth: self.bandwidth,
            r_min: self.r_min,
            r_max: r_max.unwrap_or(PcfOptions::default().r_max),
            bins: self.bins,
            edge: self.edge.parse()?,
        };
        options.validate()?;
        Ok(options)
    }
}
