use thiserror::Error;

/// Points that could not be made.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SampleError {
    /// No sampler has that name.
    #[error("there is no sampler “{name}”: did you mean {closest}? There are {names}")]
    Unknown {
        /// What was asked for.
        name: String,
        /// Every name there is.
        names: String,
        /// The name with the fewest different letters.
        closest: String,
    },
    /// More points than fit into memory.
    #[error("{n} points were asked for: at most {max} can be made")]
    TooMany {
        /// Asked for.
        n: usize,
        /// The most there can be.
        max: usize,
    },
    /// A window so long and thin that a pattern in it has no meaning.
    #[error("the window is {aspect:.3e} times as long as wide: at most {max:.0e} is possible")]
    TooThin {
        /// Longer side over shorter side.
        aspect: f64,
        /// The most it can be.
        max: f64,
    },
    /// Every attempt ran full before the last point was placed.
    #[error(
        "{sampler} found room for at most {placed} of {n} points in {attempts} attempts: use another n or a wider window"
    )]
    NoRoom {
        /// Name of the sampler.
        sampler: &'static str,
        /// Asked for.
        n: usize,
        /// The most points any attempt placed.
        placed: usize,
        /// How often it began anew.
        attempts: usize,
    },
}

impl SampleError {
    pub(super) fn unknown(name: &str, names: &[&str]) -> Self {
        let closest = names.iter().min_by_key(|n| edits(name, n)).copied().unwrap_or_default();
        Self::Unknown { name: name.to_owned(), names: names.join(", "), closest: closest.to_owned() }
    }
}

/// Insertions, deletions and substitutions that turn `a` into `b` (Levenshtein 1966).
fn edits(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &cb) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(ca != cb);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(row[j + 1] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_count_letters_changed() {
        assert_eq!(edits("kitten", "sitting"), 3);
        assert_eq!(edits("", "abc"), 3);
        assert_eq!(edits("same", "same"), 0);
    }
}
