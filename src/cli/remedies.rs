//! Which options help against an error. The library says what is wrong in neutral words.

use conemosaic::batch::BatchError;
use conemosaic::mosaic::io::ScaleTableError;

/// Returns an error in words, with the options that help.
pub fn words(error: &BatchError) -> String {
    if let BatchError::Outdated { source, folder } = error {
        return format!("{}; its earlier results stay in {folder}", words(source));
    }
    match options_for(error) {
        Some(options) => format!("{error} ({options})"),
        None => error.to_string(),
    }
}

const fn options_for(error: &BatchError) -> Option<&'static str> {
    Some(match error {
        BatchError::Output { .. }
        | BatchError::ForeignFolder { .. }
        | BatchError::Busy { .. }
        | BatchError::Overlap { .. } => "--out",
        BatchError::NoImage { .. } => "--window, --images",
        BatchError::Nowhere { .. } | BatchError::NothingCropped { .. } | BatchError::CropUnit { .. } => {
            "--window, --crop"
        }
        BatchError::NoTorus { .. } => "--torus, --window WxH",
        BatchError::NoScale { .. } | BatchError::ShrinkageWithoutScale { .. } => {
            "--um-per-px, --scale-table, --px-per-degree, --field-um or --field-degrees"
        }
        BatchError::Foreign { .. } => "--replace-corrections, --out",
        BatchError::Corrected { .. } => "leave out --fresh, or --replace-corrections, or another --out",
        BatchError::NoRoi { .. } => "--roi-side",
        BatchError::NoPicture { .. } => "--images, --size WxH",
        BatchError::ScaleTable(ScaleTableError::Missing { .. }) => "--unscaled",
        _ => return None,
    })
}
