use super::read::{png, tiff};
use super::{BitDepth, ImageError, Plane, write_png, write_tiff};
use std::path::Path;

/// A format of image files.
#[derive(Debug)]
pub struct Format {
    /// Name of the format in messages.
    pub name: &'static str,
    /// Extensions of the format's files in lower case, without the dot; the first is the usual one.
    pub extensions: &'static [&'static str],
    /// Possible beginnings of a file of the format; every file begins with one of these byte
    /// strings.
    pub signatures: &'static [&'static [u8]],
    /// Function that decodes the bytes of a file; its second argument is the name of the file for
    /// error messages.
    pub(super) decode: fn(&[u8], &str) -> Result<Plane, ImageError>,
    /// Function that writes a plane with values from 0 to 1.
    pub(super) write: fn(&Path, &Plane, BitDepth) -> Result<(), ImageError>,
}

/// Formats that are read and written.
pub static FORMATS: [Format; 2] = [
    Format {
        name: "PNG",
        extensions: &["png"],
        signatures: &[b"\x89PNG\r\n\x1a\n"],
        decode: png::decode,
        write: write_png,
    },
    Format {
        name: "TIFF",
        extensions: &["tif", "tiff"],
        // TIFF and BigTIFF, in both byte orders
        signatures: &[b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"],
        decode: tiff::decode,
        write: write_tiff,
    },
];

impl Format {
    /// Returns the format that the first bytes of a file show, or `None` if they show none of
    /// [`FORMATS`].
    pub(super) fn of_bytes(bytes: &[u8]) -> Option<&'static Self> {
        FORMATS.iter().find(|format| format.signatures.iter().any(|s| bytes.starts_with(s)))
    }

    /// Returns the format that the extension of a file names, in upper or lower case, or `None` if
    /// it names none of [`FORMATS`].
    pub(super) fn of_path(path: &Path) -> Option<&'static Self> {
        let extension = path.extension()?.to_str()?;
        FORMATS.iter().find(|format| format.extensions.iter().any(|e| extension.eq_ignore_ascii_case(e)))
    }
}

/// Returns whether the extension of a file is that of an image format, in upper or lower case.
pub fn is_image_path(path: &Path) -> bool {
    Format::of_path(path).is_some()
}

/// Returns the extensions of all formats in lower case, without the dot.
pub fn extensions() -> impl Iterator<Item = &'static str> {
    FORMATS.iter().flat_map(|format| format.extensions).copied()
}

/// Returns the names of the formats in words: “PNG or TIFF”.
pub fn formats_in_words() -> String {
    in_words(FORMATS.iter().map(|format| format.name.to_owned()).collect())
}

/// Returns the extensions of the formats in words: “.png, .tif or .tiff”.
pub fn extensions_in_words() -> String {
    in_words(extensions().map(|e| format!(".{e}")).collect())
}

/// Joins words by commas and a last “or”.
fn in_words(mut words: Vec<String>) -> String {
    match (words.pop(), words.is_empty()) {
        (Some(last), false) => format!("{} or {last}", words.join(", ")),
        (last, _) => last.unwrap_or_default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_and_extensions_read_as_prose() {
        assert_eq!(formats_in_words(), "PNG or TIFF");
        assert_eq!(extensions_in_words(), ".png, .tif or .tiff");
    }

    #[test]
    fn names_of_images_end_in_an_extension_of_theirs_in_any_case() {
        for name in ["a.png", "b.PNG", "c.Tif", "d.tiff"] {
            assert!(is_image_path(Path::new(name)), "{name}");
        }
        for name in ["png", "a.csv", ".tif", "a.png.txt"] {
            assert!(!is_image_path(Path::new(name)), "{name}");
        }
    }
}
