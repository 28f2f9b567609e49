use super::error::ReadFault;

/// Decodes the text of a file and turns every kind of line end into `\n`.
///
/// The text may be UTF-8 with or without a byte order mark, or UTF-16 with one. Any other text is
/// read as Latin-1, in which old spreadsheets write `µ`.
///
/// # Errors
/// Fails if the file contains control characters or broken UTF-16, and so is not text.
pub(super) fn decode(bytes: &[u8]) -> Result<String, ReadFault> {
    let text = match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => utf8_or_latin1(rest),
        [0xff, 0xfe, rest @ ..] => utf16(rest, u16::from_le_bytes).ok_or_else(|| binary(bytes))?,
        [0xfe, 0xff, rest @ ..] => utf16(rest, u16::from_be_bytes).ok_or_else(|| binary(bytes))?,
        _ => utf8_or_latin1(bytes),
    };
    // Old DOS editors end a text with Ctrl-Z.
    let text = text.strip_suffix('\u{1a}').unwrap_or(&text);
    if text.chars().any(|c| c.is_ascii_control() && !matches!(c, '\t' | '\n' | '\r' | '\u{c}')) {
        return Err(binary(bytes));
    }
    Ok(if text.contains('\r') { text.replace("\r\n", "\n").replace('\r', "\n") } else { text.to_owned() })
}

/// Returns the lines that are neither blank nor start with `#`, with their numbers from 1.
pub(super) fn content_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.split('\n').enumerate().map(|(i, line)| (i + 1, line)).filter(|(_, line)| {
        let line = line.trim();
        !line.is_empty() && !line.starts_with('#')
    })
}

/// Decodes UTF-8 or, if the bytes are not valid UTF-8, Latin-1.
fn utf8_or_latin1(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    }
}

/// Decodes UTF-16, or returns `None` if the bytes are not valid; `unit` sets the order of the two
/// bytes.
fn utf16(bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Option<String> {
    let (pairs, rest) = bytes.as_chunks::<2>();
    if !rest.is_empty() {
        return None;
    }
    char::decode_utf16(pairs.iter().map(|&pair| unit(pair))).collect::<Result<_, _>>().ok()
}

/// Returns the error for a file that is not text, with its first eight bytes.
fn binary(bytes: &[u8]) -> ReadFault {
    let start: Vec<String> = bytes.iter().take(8).map(|b| format!("{b:02x}")).collect();
    ReadFault::NotCoordinates { found: format!("binary data that begins with bytes {}", start.join(" ")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_encoding_of_a_spreadsheet_gives_the_same_text() {
        let expected = "x_µm;y\n1,5;2\n";
        let dos = expected.replace('\n', "\r\n");
        let utf16 = |unit: fn(u16) -> [u8; 2], mark: [u8; 2]| {
            mark.into_iter().chain(dos.encode_utf16().flat_map(unit)).collect::<Vec<u8>>()
        };
        let latin1: Vec<u8> = dos.chars().map(|c| c as u8).collect();
        let marked: Vec<u8> = [0xef, 0xbb, 0xbf].into_iter().chain(dos.bytes()).collect();
        for bytes in [
            dos.clone().into_bytes(),
            expected.replace('\n', "\r").into_bytes(),
            latin1,
            marked,
            utf16(u16::to_le_bytes, [0xff, 0xfe]),
            utf16(u16::to_be_bytes, [0xfe, 0xff]),
        ] {
            assert_eq!(decode(&bytes).unwrap(), expected);
        }
    }

    #[test]
    fn control_characters_mean_binary() {
        for bytes in [&b"1,2\0"[..], b"\x01\x02\x03", b"\xff\xfe1", b"\xff\xfe\x00\xd8"] {
            assert!(matches!(decode(bytes), Err(ReadFault::NotCoordinates { .. })), "{bytes:?}");
        }
    }

    #[test]
    fn line_numbers_count_blank_and_comment_lines() {
        let lines: Vec<_> = content_lines("# made by hand\n\n x,y\n  # a note\n1,2").collect();
        assert_eq!(lines, [(3, " x,y"), (5, "1,2")]);
    }
}
