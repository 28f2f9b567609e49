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
    /// Distance between neighbouring cones, in px (4–160)
    ///
    /// The density of the cones found may move it by at most 10 %. [default: measured in the image,
    /// from Yellott's ring in its power spectrum and the density of the cones found]
    #[arg(long, value_name = "PX")]
    spacing: Option<f64>,
    /// First estimate of that distance, in px (4–160), which the cones found may change more
    ///
    /// It takes the place of Yellott's ring only.
    #[arg(long, value_name = "PX", conflicts_with = "spacing")]
    spacing_from: Option<f64>,
    /// Direction of the derivative in split-detector images
    ///
    /// An angle in degrees, counter-clockwise as seen: 0 if cones are dark on the
    /// left and bright on the right or the reverse, 90 if they are bright on top
    /// or below.
    /// auto  found in each image
    #[arg(long, verbatim_doc_comment, value_name = "DEG", default_value = "auto", value_parser = angle_or_auto)]
    split_angle: Angle,
    /// Network of your own to use instead of the built-in one: .safetensors or .onnx
    ///
    /// The end of `conemosaic detect --help` describes both formats.
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
}

/// Description of the files that `--model` accepts, for the end of a command's help.
pub const MODELS: &str = include_str!("../help/models.txt").trim_ascii_end();

/// Angle in degrees, or `None` for `auto`.
#[derive(Clone, Copy)]
struct Angle(Option<f64>);

/// Reads an angle in degrees or `auto`.
fn angle_or_auto(text: &str) -> Result<Angle, String> {
    match text {
        "auto" => Ok(Angle(None)),
        _ => match text.parse::<f64>() {
            Ok(angle) if angle.is_finite() => Ok(Angle(Some(angle))),
            _ => Err("expected an angle in degrees, or auto".into()),
        },
    }
}

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
            spacing_from: self.spacing_from,
            split_angle: self.split_angle.0,
            model: self.model.as_deref().map(read_model).transpose()?,
        };
        options.validate()?;
        Ok(options)
    }
}
