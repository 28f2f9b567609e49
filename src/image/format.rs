use super::read::{png, tiff};
use super::{BitDepth, ImageError, Plane, write_png, write_tiff};
use std::path::Path;

/// A format of image files.
#[derive(Debug)]
pub struct Format {
    /// Name in messages.
    pub name: &'static str,
    /// Extensions of its files in lower case, without the dot; the first is the usual one.
    pub extensions: &'static [&'static str],
    /// First bytes of its files: one of these.
    pub signatures: &'static [&'static [u8]],
    /// Decodes the bytes of a file, whose name serves for errors.
    pub(super) decode: fn(&[u8], &str) -> Result<Plane, ImageError>,
    /// Writes a plane in [0, 1].
    pub(super) write: fn(&Path, &Plane, BitDepth) -> Result<(), ImageError>,
}

/// The formats that are read and written.
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
        // TIFF and BigTIFF of either byte order
        signatures: &[b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"],
        decode: tiff::decode,
        write: write_tiff,
    },
];

impl Format {
    /// Returns the format that the first bytes of a file tell.
    pub(super) fn of_bytes(bytes: &[u8]) -> Option<&'static Self> {
        FORMATS.iter().find(|format| format.signatures.iter().any(|s| bytes.starts_with(s)))
    }

    /// Returns the format that the extension of a file tells, in any case of letters.
    pub(super) fn of_path(path: &Path) -> Option<&'static Self> {
        let extension = path.extension()?.to_str()?;
        FORMATS.iter().find(|format| format.extensions.iter().any(|e| extension.eq_ignore_ascii_case(e)))
    }
}

/// Returns whether the extension of a file is that of an image format, in any case of letters.
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
