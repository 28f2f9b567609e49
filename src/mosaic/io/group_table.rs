use super::cells::Table;
use super::error::{Located, ReadFault, shortened};
use super::read::read_file;
use super::{ReadError, text};
use std::collections::HashMap;
use std::path::Path;

/// Groups of images, read from a CSV table with the columns `name,group`.
///
/// The table may have that header or none; further columns are ignored.
#[derive(Clone, Debug)]
pub struct GroupTable {
    file: String,
    /// Beginning of the names of images, and the group of these images.
    entries: Vec<(String, String)>,
}

impl GroupTable {
    /// Reads a table of groups.
    ///
    /// # Errors
    /// Fails if the file cannot be read, a row lacks its name or group, or two rows give the same
    /// name different groups.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let file = path.display().to_string();
        let entries = read_file(path).map_err(Located::from).and_then(|bytes| entries(&bytes));
        entries.map(|entries| Self { file: file.clone(), entries }).map_err(|located| located.in_file(&file))
    }

    /// Returns the path of the table, as passed to [`Self::read`].
    pub fn file(&self) -> &str {
        &self.file
    }

    /// Returns the group of the image called `name`, or `None` if no row fits.
    ///
    /// A row fits if the name of the image begins with the name in the row. Of several such rows,
    /// the row with the longest name wins.
    pub fn group_of(&self, name: &str) -> Option<&str> {
        let fits = self.entries.iter().filter(|(start, _)| name.starts_with(start.as_str()));
        fits.max_by_key(|(start, _)| start.len()).map(|(_, group)| group.as_str())
    }
}

/// Returns the rows of a table of groups, without its header and without repeated rows.
fn entries(bytes: &[u8]) -> Result<Vec<(String, String)>, Located> {
    const EXPECTED: &str = "rows of name,group";
    let text = text::decode(bytes)?;
    let table = Table::new(&text, EXPECTED)?;
    let mut seen: HashMap<&str, (&str, usize)> = HashMap::new();
    let mut entries = Vec::with_capacity(table.rows.len());
    for (k, row) in table.rows.iter().enumerate() {
        let (name, group) = match row.cells.as_slice() {
            [name, group, ..] if !name.is_empty() && !group.is_empty() => (name.as_ref(), group.as_ref()),
            _ => {
                let fault = ReadFault::NoGroup { line: shortened(row.text) };
                return Err(Located::line(row.line, fault));
            }
        };
        if k == 0 && name.eq_ignore_ascii_case("name") {
            continue;
        }
        match seen.get(name) {
            None => {
                seen.insert(name, (group, row.line));
                entries.push((name.to_owned(), group.to_owned()));
            }
            Some((earlier, _)) if *earlier == group => {}
            Some(&(_, first_line)) => {
                let fault = ReadFault::TwoGroups { name: shortened(name), first_line };
                return Err(Located::line(row.line, fault));
            }
        }
    }
    if entries.is_empty() {
        return Err(ReadFault::Empty { expected: EXPECTED }.into());
    }
    Ok(entries)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(text: &str) -> Result<GroupTable, Located> {
        Ok(GroupTable { file: "groups.csv".into(), entries: entries(text.as_bytes())? })
    }

    #[test]
    fn the_longest_name_that_an_image_begins_with_counts() {
        let table = table("name;group\r\nAD;left\r\nAD_10253;subject 1\r\n").unwrap();
        assert_eq!(table.group_of("AD_10253_OS"), Some("subject 1"));
        assert_eq!(table.group_of("AD_2"), Some("left"));
        assert_eq!(table.group_of("JC_AD"), None);
    }

    #[test]
    fn broken_rows_say_their_line() {
        for (text, line, part) in [
            ("a,1\n\nb\n", 3, "cells"),
            ("a,1\n# note\na,2\n", 3, "line 1"),
            ("a,1\n,2\n", 2, "a name and its group"),
            ("a\n", 1, "a name and its group"),
        ] {
            let error = table(text).unwrap_err().in_file("groups.csv").to_string();
            assert!(
                error.starts_with(&format!("groups.csv, line {line}: ")) && error.contains(part),
                "{error}"
            );
        }
        assert!(table("name,group\n").is_err());
        assert_eq!(table("a,1\na,1\n").unwrap().entries.len(), 1);
    }
}
