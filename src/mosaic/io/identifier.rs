//! The rule by which scales, manifests and regions find the row of a table that belongs to a file.

/// Returns a file name without the folders before it.
pub(super) fn without_folder(file_name: &str) -> &str {
    file_name.rsplit(['/', '\\']).next().unwrap_or(file_name)
}

/// Returns the rows whose identifier fits a name best.
///
/// An identifier fits if it is part of the name. The longest identifier wins; of equally long ones,
/// the one with which the name begins. Several rows are returned if they fit equally well, and none
/// if no identifier fits.
pub(super) fn best_fits<'a, T>(rows: &'a [T], name: &str, identifier: impl Fn(&T) -> &str) -> Vec<&'a T> {
    let rank = |row: &T| (identifier(row).len(), name.starts_with(identifier(row)));
    let fitting: Vec<&T> = rows.iter().filter(|row| name.contains(identifier(row))).collect();
    let best = fitting.iter().map(|row| rank(row)).max();
    fitting.into_iter().filter(|row| Some(rank(row)) == best).collect()
}
