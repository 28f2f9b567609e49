//! Options that remedy an error. The library describes remedies in neutral words; here the options
//! of this program replace them.

use conemosaic::batch::BatchError;

/// Phrases of the library, each with its replacement that names options.
///
/// Phrases are replaced in this order. Of two phrases that begin alike the longer one comes first,
/// because the shorter one would replace its beginning.
const PHRASES: &[(&str, &str)] = &[
    ("choose another folder for the results", "choose another --out folder"),
    (
        "give the folder of the images, or the window itself: its size WxH, its edges X0,Y0,X1,Y1, the unit square or a \
         file of corners",
        "give --images, or give --window WxH, X0,Y0,X1,Y1, unit or a file of corners",
    ),
    ("give the size of the images, or their folder", "give --size WxH or --images"),
    ("give the folder of the images", "give --images"),
    ("a torus needs a rectangular window", "--torus needs a rectangular window"),
    ("give a window WxH, or do not ask for a torus", "leave out --torus or give --window WxH"),
    ("the scale is not known: give one", "the scale is not known: give --um-per-px or --scale-table"),
    ("no scale is known: give one", "no scale is known: give --um-per-px or another scale option"),
    ("give a smaller side", "give a smaller --roi-side"),
    ("allow corrections to be replaced", "give --replace-corrections"),
    ("continue the earlier run", "leave out --fresh"),
    ("or let files without a row stay in pixels", "or give --unscaled to measure such files in pixels"),
    ("give a rule that fits every name", "give a --group-by that fits every name"),
    ("needs a manifest: give one", "needs a manifest: give --manifest FILE"),
    (
        "state the origin of the marks or of the detections",
        "state it with --origin (marks) or --detections-origin (detections)",
    ),
    ("group them by subject", "give --group-by or --group-table"),
    ("give a narrower border", "give a smaller --border"),
    ("read them with y flipped", "give --flip-y"),
    ("give the modality", "give --modality"),
    ("give the spacing if you know it", "give --spacing if you know it"),
];

/// Returns a text of the library in which neutral remedies are replaced by the options of this
/// program.
pub fn with_options(text: &str) -> String {
    PHRASES.iter().fold(text.to_owned(), |text, (neutral, options)| text.replace(neutral, options))
}

/// Returns the message of an error, with the options that remedy it.
pub fn words(error: &BatchError) -> String {
    with_options(&error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use conemosaic::batch::BatchError;
    use std::fs;
    use std::path::Path;
    use walkdir::WalkDir;

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

    #[test]
    fn every_neutral_phrase_still_stands_in_the_library() {
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
        let library: String = WalkDir::new(&source)
            .into_iter()
            .map(|entry| entry.unwrap().into_path())
            .filter(|path| path.extension().is_some_and(|e| e == "rs"))
            .filter(|path| !path.starts_with(source.join("cli")))
            .map(|path| fs::read_to_string(path).unwrap())
            .collect();
        // a string that goes on after a backslash at the end of a line has no break there
        let parts = library.split("\\\n").enumerate();
        let library: String = parts.map(|(i, part)| if i == 0 { part } else { part.trim_start() }).collect();
        let gone: Vec<&str> =
            PHRASES.iter().map(|(neutral, _)| *neutral).filter(|p| !library.contains(p)).collect();
        assert_eq!(gone, [""; 0], "reworded in the library: reword them here too");
    }
}
