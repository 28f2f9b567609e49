use crate::mosaic::io::GroupTable;
use regex_lite::Regex;
use std::str::FromStr;

/// The rule that derives the group of an image from its name.
#[derive(Clone, Debug)]
pub enum Grouping {
    /// The group consists of this number of parts at the beginning of the name; underscores
    /// separate the parts. With 2 parts (`prefix:2`), the group of `AD_10253_790nm` is `AD_10253`.
    Prefix(usize),
    /// The group is the text that the first capture group of a regular expression matches; in an
    /// expression without capture groups, it is the entire match.
    Pattern(Regex),
    /// The group is looked up in a table of names and groups.
    Table(GroupTable),
}

impl FromStr for Grouping {
    type Err = String;

    /// Reads `prefix:N` or a regular expression.
    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(count) = text.strip_prefix("prefix:") {
            return match count.parse() {
                Ok(parts) if parts > 0 => Ok(Self::Prefix(parts)),
                _ => Err(format!("“{text}” is not a valid prefix: expected prefix:N, where N is 1 or more")),
            };
        }
        let pattern = Regex::new(text)
            .map_err(|e| format!("“{text}” is neither prefix:N nor a regular expression: {e}"))?;
        Ok(Self::Pattern(pattern))
    }
}

impl Grouping {
    /// Returns the group of the image `name`.
    ///
    /// # Errors
    /// Fails if the name does not match the regular expression or is not in the table. The error
    /// says what to do.
    pub fn group_of(&self, name: &str) -> Result<String, String> {
        match self {
            Self::Prefix(parts) => Ok(name.split('_').take(*parts).collect::<Vec<_>>().join("_")),
            Self::Pattern(pattern) => {
                let found = pattern.captures(name);
                let group = found.as_ref().and_then(|c| c.get(1).or_else(|| c.get(0)));
                group.map(|g| g.as_str().to_owned()).filter(|g| !g.is_empty()).ok_or_else(|| {
                    format!(
                        "the image “{name}” has no group, because its name does not match “{pattern}”: give \
                         a rule that fits every name, or a manifest with a column {pattern}"
                    )
                })
            }
            Self::Table(table) => table.group_of(name).map(str::to_owned).ok_or_else(|| {
                format!(
                    "the image “{name}” has no group, because no name in {} is the beginning of its name: \
                     add a row for it",
                    table.file()
                )
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn group(rule: &str, name: &str) -> Result<String, String> {
        rule.parse::<Grouping>()?.group_of(name)
    }

    #[test]
    fn groups_come_from_the_name() {
        let name = "AD_10253_790nm_OS_1";
        assert_eq!(group("prefix:2", name).unwrap(), "AD_10253");
        assert_eq!(group("prefix:9", name).unwrap(), name);
        assert_eq!(group(r"^[A-Z]+_(\d+)_", name).unwrap(), "10253");
        assert_eq!(group(r"O[DS]", name).unwrap(), "OS");
    }

    #[test]
    fn names_without_a_group_say_what_to_do() {
        assert!(group("prefix:0", "a").unwrap_err().contains("1 or more"));
        assert!(group("(", "a").unwrap_err().contains("regular expression"));
        assert!(group("x", "a").unwrap_err().contains("a rule that fits"));
    }
}
