//! Which options help against an error. The library says what is wrong in neutral words.

use conemosaic::batch::BatchError;

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

fn options_for(error: &BatchError) -> Option<&'static str> {
    Some(match error {
        BatchError::Output { .. }
        | BatchError::ForeignFolder { .. }
        | BatchError::Busy { .. }
        | BatchError::Overlap { .. } => "--out",
        BatchError::NoImage { .. } => "--window, --images",
        BatchError::Nowhere { .. } | BatchError::NothingCropped { .. } | BatchError::CropUnit { .. } => {
            "--window, --crop"
        }
        BatchError::NoTorus { .. } => "--torus, --window",
        BatchError::NoScale { .. } | BatchError::ShrinkageWithoutScale { .. } => {
            "--um-per-px, --scale-table, --px-per-degree, --field-um or --field-degrees"
        }
        BatchError::Foreign { .. } => "--replace-corrections, --out",
        BatchError::Corrected { .. } => "leave out --fresh, or --replace-corrections, or another --out",
        BatchError::NoRoi { .. } => "--roi-side",
        BatchError::ScaleTable(_) => "--scale-table, --unscaled",
        BatchError::Group(_) => "--group-by, --manifest",
        BatchError::Pairing { problem, .. } if problem.contains("folder of the images") => "--images, --size",
        _ => return None,
    })
}
