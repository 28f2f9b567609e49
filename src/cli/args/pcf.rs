use anyhow::Result;
use clap::Args;
use clap::builder::PossibleValuesParser;
use conemosaic::stats::{EdgeCorrection, Kernel, PcfOptions};
use strum::VariantNames;

/// Options for the estimate of the pair correlation function g(r).
///
/// Distances are in hexagonal spacings of the mosaic, √(2/(√3 density)).
#[derive(Args)]
#[command(
    next_help_heading = "Pair correlation function (hexagonal spacing: that of a triangular lattice of the same density)"
)]
pub struct PcfArgs {
    /// Edge correction, for neighbours hidden beyond the border of the window
    ///
    /// set-covariance  g(r) is divided by the isotropised set covariance of
    ///                 the window
    /// translation     each pair is weighted by the inverse of the overlap of
    ///                 the window with its shifted copy (Ohser & Stoyan 1981)
    /// isotropic       each pair is weighted by the inverse of the share of a
    ///                 circle, about one point through the other, that lies
    ///                 inside the window (Ripley 1976)
    /// torus           distances go across opposite edges; needs --torus
    /// none            no correction: g(r) falls with r
    #[arg(long, verbatim_doc_comment, value_name = "E", default_value = "set-covariance", value_parser = PossibleValuesParser::new(EdgeCorrection::VARIANTS))]
    edge: String,
    /// Shape of the kernel that smooths g(r)
    ///
    /// The numbers of Lanaro et al. (2020) were made with a Gaussian.
    #[arg(long, value_name = "K", default_value = "gaussian", value_parser = PossibleValuesParser::new(Kernel::VARIANTS))]
    kernel: String,
    /// Standard deviation of the smoothing kernel, in hexagonal spacings (0.005–1)
    #[arg(long, value_name = "S", default_value_t = PcfOptions::default().bandwidth)]
    bandwidth: f64,
    /// Start of the first bin, in hexagonal spacings (at least 1.5 bandwidths)
    ///
    /// Nearer to 0 the kernel would extend to negative distances.
    #[arg(long, value_name = "S", default_value_t = PcfOptions::default().r_min)]
    r_min: f64,
    /// End of the last bin, in hexagonal spacings (at most 50) [default: 2.5]
    ///
    /// Without --functions: the end of the bins of g(r), in hexagonal spacings. With --functions:
    /// the last distance of G, F, J, K, L and g, in the unit of the coordinates [default: a quarter
    /// of the shorter side of the window, at most the radius within which 1000 points are
    /// expected]; the bins of g(r) then always end at 2.5 hexagonal spacings.
    #[arg(long, value_name = "S")]
    pub r_max: Option<f64>,
    /// Number of bins between --r-min and --r-max (1–2000)
    #[arg(long, value_name = "N", default_value_t = PcfOptions::default().bins)]
    bins: usize,
}

impl PcfArgs {
    /// Returns the options after checking them.
    ///
    /// `r_max` is the end of the last bin in hexagonal spacings, by default 2.5. It is passed apart
    /// from `self` because with `--functions` the option has another meaning.
    ///
    /// # Errors
    /// Fails if a value is out of its range.
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
