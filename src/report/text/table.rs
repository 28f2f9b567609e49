use comfy_table::{CellAlignment, LineStyle, Table, TableStyle};

/// Lays out a table for a reader: headers, a rule, rows.
///
/// Columns of numbers are flush right, all others flush left. The text is plain, without colours or
/// escape codes, so that it may go to a terminal, a pipe or a log alike. Units belong in the
/// headers.
pub fn table(headers: &[&str], rows: &[Vec<String>]) -> String {
    let mut table = Table::new();
    table.load_style(TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─')));
    table.set_header(headers.iter().map(|text| printable(text)));
    table.add_rows(rows.iter().map(|row| row.iter().map(|text| printable(text)).collect::<Vec<_>>()));
    for column in 0..headers.len() {
        let mut cells =
            rows.iter().filter_map(|row| row.get(column)).filter(|text| !text.is_empty()).peekable();
        let numbers = cells.peek().is_some() && cells.all(|text| is_number(text));
        if let (true, Some(column)) = (numbers, table.column_mut(column)) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table.trim_fmt()
}

/// Replaces control characters, so that the name of a file cannot steer the terminal.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c }).collect()
}

/// Returns whether a cell is flush right, as numbers are.
fn is_number(text: &str) -> bool {
    let bare = text.trim().trim_end_matches(['%', ' ']).replace(['−', '±'], "");
    matches!(bare.as_str(), "–" | "∞") || bare.split_whitespace().all(|part| part.parse::<f64>().is_ok())
}

/// Writes `x` with `digits` significant digits, and always all digits before the decimal point.
///
/// At three digits 9.1537 becomes 9.15 and 61234.5 becomes 61234. Numbers beyond 10⁻⁴..10⁹ are in
/// scientific notation; NaN is “–”.
pub fn significant(x: f64, digits: usize) -> String {
    if x.is_nan() {
        return "–".to_owned();
    }
    if x.is_infinite() {
        return if x > 0. { "∞" } else { "−∞" }.to_owned();
    }
    let digits = digits.max(1);
    // The exponent is taken after rounding: 9.996 to three digits is 10.0, not 10.00.
    let scientific = format!("{x:.*e}", digits - 1);
    let exponent: i32 = scientific.rsplit_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    if x != 0. && !(-4..9).contains(&exponent) {
        return scientific;
    }
    let decimals = usize::try_from(digits as i32 - 1 - exponent).unwrap_or(0);
    format!("{x:.decimals$}")
}

/// Returns a count with its noun, in the plural unless it is 1: “1 image”, “2 images”.
pub fn counted(count: usize, one: &str) -> String {
    format!("{count} {one}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn significant_digits_are_kept_and_whole_digits_never_cut() {
        let shown: Vec<_> =
            [9.1537, 0.012345, 61234.5, 9.996, 0., -2.345678, 1e-7, 2.5e12].map(|x| significant(x, 3)).into();
        assert_eq!(shown, ["9.15", "0.0123", "61234", "10.0", "0.00", "-2.35", "1.00e-7", "2.50e12"]);
        assert_eq!([f64::NAN, f64::INFINITY].map(|x| significant(x, 3)), ["–", "∞"]);
    }

    #[test]
    fn numbers_stand_flush_right_and_names_flush_left() {
        let rows = vec![
            vec!["a.png".into(), "281".into(), "9.15".into()],
            vec!["longer.png".into(), "7".into(), String::new()],
        ];
        let text = table(&["file", "n", "RI"], &rows);
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines.len(), 4, "{text}");
        let end = |line: &str, cell: &str| line.find(cell).unwrap() + cell.len();
        assert_eq!(end(lines[2], "281"), end(lines[3], " 7"));
        assert_eq!(lines[2].find("a.png"), lines[3].find("longer.png"));
        assert!(!text.contains('\u{1b}'));
    }

    #[test]
    fn control_characters_of_names_do_not_reach_the_terminal() {
        let text = table(&["file"], &[vec!["a\u{1b}[31mb\nc".into()]]);
        assert!(!text.contains('\u{1b}'));
        assert_eq!(text.lines().count(), 3);
    }
}
