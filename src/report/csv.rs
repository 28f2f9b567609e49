use super::ReportError;
use serde::Serialize;
use std::io::Write;

/// Writes rows as CSV under `header`.
///
/// Numbers have the fewest digits that read back to the same value. `None` is an empty cell. The
/// header is written even without rows. `header` names the cells of a row in the order of its
/// fields; a field that is a `Vec` makes one cell per element.
///
/// # Errors
/// Fails if a row has more or fewer cells than the header, does not fit in a
/// row (a map), or cannot be written.
pub fn write_csv<T: Serialize>(writer: impl Write, header: &[&str], rows: &[T]) -> Result<(), ReportError> {
    let mut writer = ::csv::WriterBuilder::new().has_headers(false).from_writer(writer);
    writer.write_record(header)?;
    for row in rows {
        writer.serialize(row)?;
    }
    writer.flush().map_err(|error| ReportError::Csv(error.into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize)]
    struct Row {
        file: &'static str,
        n: usize,
        ri: Option<f64>,
        l_infinity: Vec<Option<f64>>,
    }

    fn text(header: &[&str], rows: &[Row]) -> String {
        let mut bytes = Vec::new();
        write_csv(&mut bytes, header, rows).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    const HEADER: [&str; 5] = ["file", "n", "ri", "uniform", "jittered"];

    #[test]
    fn header_stands_without_rows() {
        assert_eq!(text(&HEADER, &[]), "file,n,ri,uniform,jittered\n");
    }

    #[test]
    fn missing_values_are_empty_cells() {
        let row = Row { file: "a,b.png", n: 1, ri: None, l_infinity: vec![Some(0.25), None] };
        assert_eq!(text(&HEADER, &[row]).lines().nth(1).unwrap(), "\"a,b.png\",1,,0.25,");
    }

    #[test]
    fn numbers_read_back_to_the_same_bits() {
        for value in [0.1 + 0.2, 1. / 3., 9.156_789_123_4, 1e-7, 6.02e23, f64::MIN_POSITIVE] {
            let row = Row { file: "a", n: 1, ri: Some(value), l_infinity: vec![None, None] };
            let text = text(&HEADER, &[row]);
            let cell = text.lines().nth(1).unwrap().split(',').nth(2).unwrap();
            assert_eq!(cell.parse::<f64>().unwrap().to_bits(), value.to_bits(), "{cell}");
        }
        let row = Row { file: "a", n: 1, ri: Some(0.1), l_infinity: vec![None, None] };
        assert!(text(&HEADER, &[row]).contains(",0.1,"));
    }

    #[test]
    fn rows_that_do_not_fit_the_header_are_refused() {
        let row = Row { file: "a", n: 1, ri: None, l_infinity: vec![] };
        assert!(matches!(write_csv(Vec::new(), &HEADER, &[row]), Err(ReportError::Csv(_))));
    }
}
