use anyhow::{Context, Result};
use clap::Args;
use clap::builder::PossibleValuesParser;
use conemosaic::detect::{DetectOptions, Detector, Modality, Polarity, UserModel};
use std::fs;
use std::path::{Path, PathBuf};
use strum::VariantNames;

/// What may be fixed about detection; the defaults decide everything from the image.
#[derive(Args)]
pub struct DetectArgs {
    /// How the images were taken
    #[arg(long, value_name = "M", default_value = "auto", value_parser = or_auto(Modality::VARIANTS))]
    modality: String,
    /// Contrast: positive is bright cones, in split detection dark left and bright right
    #[arg(long, value_name = "P", default_value = "auto", value_parser = or_auto(Polarity::VARIANTS))]
    polarity: String,
    /// Filters that find the cones
    #[arg(long, value_name = "D", default_value = "auto", value_parser = PossibleValuesParser::new(Detector::VARIANTS))]
    detector: String,
    /// Cone spacing in px (4–160) to start from [default: from Yellott's ring]
    #[arg(long, value_name = "PX")]
    spacing: Option<f64>,
    /// A network of your own: .safetensors or .onnx (see `conemosaic detect --help`)
    #[arg(long, value_name = "FILE")]
    model: Option<PathBuf>,
}

/// What a user's own network must look like.
pub const MODELS: &str = "\
A network of your own (--model FILE), for images of the modality it was made for:
  .safetensors  as scripts/train-detector writes it
  .onnx         in programs built with `--features onnx`. Input: float32, 1×1×H×W, H and W left open:
                the image resampled so that cones are 8 px apart, less its Gaussian mean (σ 8 px),
                over its Gaussian contrast (σ 12 px), bright cones positive, mirrored at its end.
                Output: float32, 1×1×H×W: how surely a cone's centre lies in each pixel.
                Metadata, all optional (onnx.helper.set_model_props):
                  spacing      px between cones in its input [8]
                  multiple     of which H and W are one, px; 1 if any size will do [32]
                  output       probability or logit [probability]
                  threshold    probability from which on a maximum is a cone [0.5]
                  suppression  shortest distance of two cones, in spacings [0.5]
                  modality     confocal, split or histology [every image]
";

fn read_model(path: &Path) -> Result<UserModel> {
    let name = path.display().to_string();
    let bytes = fs::read(path).with_context(|| format!("{name} cannot be read"))?;
    UserModel::new(&name, &bytes).context(name)
}

fn or_auto(names: &'static [&'static str]) -> PossibleValuesParser {
    PossibleValuesParser::new(["auto"].into_iter().chain(names.iter().copied()))
}

impl DetectArgs {
    /// Validated options.
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
