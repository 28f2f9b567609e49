//! Which row of a table belongs to a file: one rule for scales, manifests and regions.

/// A file name without the folders before it.
pub(super) fn without_folder(file_name: &str) -> &str {
    file_name.rsplit(['/', '\\']).next().unwrap_or(file_name)
}

/// The rows whose identifier is the longest part of a name; of equally long ones, those that the name begins with. Several, where they
/// fit equally well.
pub(super) fn best_fits<'a, T>(rows: &'a [T], name: &str, identifier: impl Fn(&T) -> &str) -> Vec<&'a T> {
    let rank = |row: &T| (identifier(row).len(), name.starts_with(identifier(row)));
    let fitting: Vec<&T> = rows.iter().filter(|row| name.contains(identifier(row))).collect();
    let best = fitting.iter().map(|row| rank(row)).max();
    fitting.into_iter().filter(|row| Some(rank(row)) == best).collect()
}
