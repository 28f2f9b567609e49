use anyhow::{Context, Result};
use clap::Args;
use clap::builder::PossibleValuesParser;
use conemosaic::detect::{DetectOptions, Detector, Modality, Polarity, UserModel};
use std::fs;
use std::path::{Path, PathBuf};
use strum::VariantNames;

/// Options of detection; by default everything is estimated from the image.
#[derive(Args)]
pub struct DetectArgs {
    /// Type of the images
    ///
    /// confocal   confocal adaptive-optics ophthalmoscopy: a cone is a bright
    ///            spot
    /// split      split-detector adaptive-optics ophthalmoscopy: an inner
    ///            segment has a dark and a bright side
    /// histology  micrographs of flat-mounted retina: an inner segment is a
    ///            disc
    /// auto       decided for each image from the image itself
    #[arg(long, verbatim_doc_comment, value_name = "M", default_value = "auto", value_parser = or_auto(Modality::VARIANTS))]
    modality: String,
    /// Contrast of the cones
    ///
    /// positive  cones are brighter than their surround; in split-detector
    ///           images they are dark on the left and bright on the right
    /// negative  the reverse
    /// auto      decided for each image from the image itself
    #[arg(long, verbatim_doc_comment, value_name = "P", default_value = "auto", value_parser = or_auto(Polarity::VARIANTS))]
    polarity: String,
    /// Method that finds the cones
    ///
    /// classical  a band-pass filter designed for the type of image
    /// learned    a small convolutional network trained for it
    /// auto       whichever of the two scored better on hand-marked images of
    ///            the type
    #[arg(long, verbatim_doc_comment, value_name = "D", default_value = "auto", value_parser = PossibleValuesParser::new(Detector::VARIANTS))]
    detector: String,
    /// First estimate of the distance between neighbouring cones, in px (4–160)
    ///
    /// Detection refines it. [default: measured from Yellott's ring in the power spectrum of the
    /// image]
    #[arg(long, value_name = "PX")]
    spacing: Option<f64>,
    /// Network of your own to use instead of the built-in one: .safetensors or .onnx
    ///
    /// The end of `conemosaic detect --help` describes both formats.
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
}

/// Description of the files that `--model` accepts, for the end of a command's help.
pub const MODELS: &str = include_str!("../help/models.txt").trim_ascii_end();

/// Reads the network of a file.
fn read_model(path: &Path) -> Result<UserModel> {
    let name = path.display().to_string();
    let bytes = fs::read(path).with_context(|| format!("{name} cannot be read"))?;
    UserModel::new(&name, &bytes).context(name)
}

/// Returns a parser that accepts `auto` and every one of `names`.
fn or_auto(names: &'static [&'static str]) -> PossibleValuesParser {
    PossibleValuesParser::new(["auto"].into_iter().chain(names.iter().copied()))
}

impl DetectArgs {
    /// Returns the options of detection after checking them.
    ///
    /// # Errors
    /// Fails if the spacing is out of its range, or the network cannot be read or does not fit the
    /// other options.
    pub fn options(&self) -> Result<DetectOptions> {
        let given = |text: &str| (text != "auto").then(|| text.to_owned());
        let options = DetectOptions {
            modality: given(&self.modality)
                .map(|m| m.parse::<Modality>())
                .transpose()
                .map_err(anyhow::Error::msg)?,
            polarity: given(&self.polarity)
                .map(|p| p.parse::<Polarity>())
                .transpose()
                .map_err(anyhow::Error::msg)?,
            detector: self.detector.parse::<Detector>().map_err(anyhow::Error::msg)?,
            spacing: self.spacing,
            model: self.model.as_deref().map(read_model).transpose()?,
        };
        options.validate()?;
        Ok(options)
    }
}
