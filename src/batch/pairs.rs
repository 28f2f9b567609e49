//! Registered pairs: images of the same field by two channels, found by their names.

use crate::image::Modality;
use std::path::Path;
use std::str::FromStr;

/// Names of the images of two channels: each a modality and a pattern with one `*`.
///
/// Images whose names match the two patterns and share what the `*` stands for are a pair. A
/// pattern is compared with the file name, and with the file name without its extension.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChannelPatterns([(Modality, String, String); 2]);

impl FromStr for ChannelPatterns {
    type Err = String;

    /// Reads the patterns from `MODALITY=PATTERN,MODALITY=PATTERN`.
    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = |why: String| format!("{why}: expected, for example, confocal=confocal_*,split=split_*");
        let channel = |part: &str| {
            let (modality, pattern) =
                part.split_once('=').ok_or_else(|| wrong(format!("“{part}” has no =")))?;
            let modality: Modality = modality.trim().parse().map_err(|e| wrong(format!("{e}")))?;
            match pattern.trim().split_once('*') {
                Some((before, after)) if !after.contains('*') => {
                    Ok((modality, before.to_owned(), after.to_owned()))
                }
                _ => Err(wrong(format!("“{pattern}” does not have one *"))),
            }
        };
        let Some((first, second)) = text.split_once(',') else {
            return Err(wrong(format!("“{text}” names one channel")));
        };
        let (first, second) = (channel(first)?, channel(second)?);
        if first.0 == second.0 {
            return Err(wrong(format!("both channels are {}", first.0)));
        }
        if (&first.1, &first.2) == (&second.1, &second.2) {
            return Err(wrong("both patterns are the same".into()));
        }
        Ok(Self([first, second]))
    }
}

impl ChannelPatterns {
    /// Returns the modality of an image and what the `*` stands for in its name; `None` if it
    /// matches neither pattern. Of two patterns that match, the longer one counts.
    pub fn of(&self, path: &Path) -> Option<(Modality, String)> {
        let [name, stem] =
            [path.file_name(), path.file_stem()].map(|n| n.unwrap_or_default().to_string_lossy());
        let matched = |(modality, before, after): &(Modality, String, String)| {
            let rest = |name: &str| Some(name.strip_prefix(&**before)?.strip_suffix(&**after)?.to_owned());
            let rest = rest(&stem).or_else(|| rest(&name))?;
            Some((before.len() + after.len(), *modality, rest))
        };
        let best = self.0.iter().filter_map(matched).max_by_key(|(length, ..)| *length);
        best.map(|(_, modality, rest)| (modality, rest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_name_the_channel_and_the_rest() {
        let patterns: ChannelPatterns = "confocal=confocal_*,split=split_det_*.tif".parse().unwrap();
        let of = |name: &str| patterns.of(Path::new(name));
        assert_eq!(of("x/confocal_0070.tif"), Some((Modality::Confocal, "0070".into())));
        assert_eq!(of("split_det_0070.tif"), Some((Modality::Split, "0070".into())));
        assert_eq!(of("avg_0070.tif"), None);
        let both: ChannelPatterns = "confocal=*,split=*_split".parse().unwrap();
        assert_eq!(both.of(Path::new("a_split.png")), Some((Modality::Split, "a".into())));
        for wrong in ["confocal=a*", "confocal=a*,confocal=b*", "confocal=a,split=b*", "x=a*,split=b*", "a,b"]
        {
            assert!(wrong.parse::<ChannelPatterns>().is_err(), "{wrong}");
        }
    }
}
