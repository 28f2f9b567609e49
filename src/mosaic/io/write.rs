use super::WriteError;
use crate::files::write_atomically;
use crate::geometry::Point;
use crate::mosaic::Scale;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

/// Writes points in pixels as CSV; the file appears complete or not at all.
///
/// The columns are `x_px,y_px`, then `score` if there are scores, then `x_um,y_um` if the scale is
/// known. Each number has the fewest digits from which the same value is read back.
///
/// # Errors
/// Fails if a number is not finite, the number of scores is not that of the points, or the file
/// cannot be written.
pub fn write_points(
    path: &Path,
    points: &[Point],
    scores: Option<&[f64]>,
    scale: Option<Scale>,
) -> Result<(), WriteError> {
    check(path, points, scores)?;
    let text = format_points(points, scores, scale);
    write_text(path, &text)
}

/// Writes points without a unit as CSV with columns `x,y`; the file appears complete or not at all.
///
/// # Errors
/// Fails if a coordinate is not finite or the file cannot be written.
pub fn write_plain_points(path: &Path, points: &[Point]) -> Result<(), WriteError> {
    check(path, points, None)?;
    let text = format_plain_points(points);
    write_text(path, &text)
}

fn write_text(path: &Path, text: &str) -> Result<(), WriteError> {
    write_atomically(path, |writer| writer.write_all(text.as_bytes()))
        .map_err(|source| WriteError::Io { file: path.to_owned(), source })
}

/// Returns the text that [`write_points`] writes; missing scores become empty cells.
pub fn format_points(points: &[Point], scores: Option<&[f64]>, scale: Option<Scale>) -> String {
    let um_per_px = scale.map(|s| s.micrometres_per_pixel());
    let mut text = String::with_capacity(32 + points.len() * 64);
    text.push_str("x_px,y_px");
    text.push_str(if scores.is_some() { ",score" } else { "" });
    text.push_str(if scale.is_some() { ",x_um,y_um\n" } else { "\n" });
    for (i, p) in points.iter().enumerate() {
        // Writing to a String cannot fail.
        let _ = write!(text, "{},{}", p.x, p.y);
        if let Some(scores) = scores {
            text.push(',');
            if let Some(score) = scores.get(i) {
                let _ = write!(text, "{score}");
            }
        }
        if let Some(um) = um_per_px {
            let _ = write!(text, ",{},{}", p.x * um, p.y * um);
        }
        text.push('\n');
    }
    text
}

/// Returns the text that [`write_plain_points`] writes.
pub fn format_plain_points(points: &[Point]) -> String {
    let mut text = String::with_capacity(8 + points.len() * 40);
    text.push_str("x,y\n");
    for p in points {
        let _ = writeln!(text, "{},{}", p.x, p.y);
    }
    text
}

/// Checks that all numbers are finite and that there is one score per point.
fn check(path: &Path, points: &[Point], scores: Option<&[f64]>) -> Result<(), WriteError> {
    if let Some(scores) = scores.filter(|s| s.len() != points.len()) {
        let (points, scores) = (points.len(), scores.len());
        return Err(WriteError::Scores { file: path.to_owned(), points, scores });
    }
    let bad_point = points.iter().position(|p| !p.is_finite());
    let bad_score = scores.and_then(|s| s.iter().position(|score| !score.is_finite()));
    match bad_point.or(bad_score) {
        Some(index) => Err(WriteError::NotFinite { file: path.to_owned(), index }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::{ReadOptions, read_coordinates};
    use super::*;

    #[test]
    fn what_is_written_reads_back_bit_for_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.csv");
        let points = [Point::new(0.1 + 0.2, -1. / 3.), Point::new(1e-310, 149.49999999999997)];
        let scores = [0.1, f64::MAX];
        let scale = Scale::new(0.3936, 288.).ok();
        write_points(&path, &points, Some(&scores), scale).unwrap();
        let back = read_coordinates(&path, &ReadOptions::default()).unwrap();
        assert_eq!((back.points.as_slice(), back.scores.as_deref()), (&points[..], Some(&scores[..])));
        let text = std::fs::read_to_string(&path).unwrap();
        assert_eq!(text.lines().next(), Some("x_px,y_px,score,x_um,y_um"));
    }

    #[test]
    fn what_no_reader_takes_is_not_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.csv");
        let points = [Point::new(0., f64::NAN)];
        assert!(matches!(write_plain_points(&path, &points), Err(WriteError::NotFinite { index: 0, .. })));
        let points = [Point::new(0., 0.)];
        assert!(matches!(write_points(&path, &points, Some(&[]), None), Err(WriteError::Scores { .. })));
        assert!(!path.exists());
    }
}
