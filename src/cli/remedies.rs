//! Which options help. The library says what is wrong and what helps in neutral words; here the
//! options of this program take their place.

use conemosaic::batch::BatchError;

/// Neutral words of the library, and the same with options. Of two that begin alike the longer one
/// comes first.
const PHRASES: &[(&str, &str)] = &[
    ("choose another folder for the results", "choose another --out folder"),
    (
        "give the folder of the images, or the window itself: its size WxH, its edges X0,Y0,X1,Y1, the unit square or a \
         file of corners",
        "give --images, or --window WxH, X0,Y0,X1,Y1, unit or a file of corners",
    ),
    ("give the size of the images, or their folder", "give --size WxH or --images"),
    ("give the folder of the images", "give --images"),
    ("a torus needs a rectangular window", "--torus needs a rectangular window"),
    ("give a window WxH, or do not ask for a torus", "leave out --torus or give --window WxH"),
    ("the scale is not known: give one", "the scale is not known: give --um-per-px or --scale-table"),
    ("no scale is known: give one", "no scale is known: give --um-per-px or another of the scale options"),
    ("give a smaller side", "give a smaller --roi-side"),
    ("allow corrections to be replaced", "give --replace-corrections"),
    ("continue the earlier run", "leave out --fresh"),
    ("or let files without a row stay in pixels", "or work in pixels (--unscaled)"),
    ("give a rule that fits every name", "give a --group-by that fits every name"),
    ("needs a manifest: give one", "needs a manifest: give --manifest FILE"),
    (
        "state the origin of the marks or of the detections",
        "say so with --origin (marks) or --detections-origin",
    ),
    ("group them by subject", "give --group-by or --group-table"),
    ("give the modality", "give --modality"),
    ("give the spacing if you know it", "give --spacing if you know it"),
];

/// Returns what the library says, with the options that help.
pub fn with_options(text: &str) -> String {
    PHRASES.iter().fold(text.to_owned(), |text, (neutral, options)| text.replace(neutral, options))
}

/// Returns an error in words, with the options that help.
pub fn words(error: &BatchError) -> String {
    with_options(&error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use conemosaic::batch::BatchError;

    #[test]
    fn an_error_names_the_options_that_help() {
        let error = BatchError::NoScale { what: "the crop", file: "a.csv".into() };
        assert_eq!(
            words(&error),
            "a.csv: the crop is in µm, but the scale is not known: give --um-per-px or --scale-table"
        );
        let error = BatchError::Corrected { path: "points.csv".into() };
        let text = words(&error);
        assert!(text.contains("--replace-corrections") && text.contains("--fresh") && text.contains("--out"));
    }
}
