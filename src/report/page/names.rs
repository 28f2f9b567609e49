use maud::{Markup, html};
use std::collections::HashMap;

/// Characters in a name after which a line may break.
const BREAKS: [char; 3] = ['_', '-', '.'];
/// Length in bytes of the shortest part of a name that an ellipsis replaces on narrow screens.
const WORTH: usize = 8;

/// Names of images in the form in which a page shows them.
///
/// Names are shown in full where there is room, with positions at which a line may break. On narrow
/// screens an ellipsis replaces the parts that all names with the same beginning share. The ends
/// are never cut off, as names usually differ there.
pub(super) struct Names<'a> {
    /// Continuations of the names, by their beginning up to a break.
    ///
    /// Each is the number of names with this beginning, and the next part if all of them share it.
    next: HashMap<&'a str, (usize, Option<&'a str>)>,
}

impl<'a> Names<'a> {
    /// Collects all names of a page.
    pub fn new(names: impl IntoIterator<Item = &'a str>) -> Self {
        let mut next: HashMap<&str, (usize, Option<&str>)> = HashMap::new();
        for name in names {
            let mut at = 0;
            for part in name.split_inclusive(BREAKS) {
                let (count, same) = next.entry(&name[..at]).or_insert((0, Some(part)));
                *count += 1;
                *same = same.filter(|other| *other == part);
                at += part.len();
            }
        }
        Self { next }
    }

    /// Returns a name as HTML, with positions at which lines may break and parts that narrow
    /// screens hide.
    pub fn show(&self, name: &str) -> Markup {
        let stretches = self.stretches(name);
        let parts = |text: &str| html! { @for part in text.split_inclusive(BREAKS) { (part) wbr; } };
        html! {
            @for (text, shared) in stretches {
                @if shared && text.len() >= WORTH { span.dots { "…" wbr; } span.same { (parts(text)) } }
                @else { (parts(text)) }
            }
        }
    }

    /// Splits a name into alternating parts, each with true if it may be hidden.
    ///
    /// A part may be hidden if it is not the beginning of the name and if all names that agree up
    /// to it share it.
    fn stretches<'n>(&self, name: &'n str) -> Vec<(&'n str, bool)> {
        let mut stretches: Vec<(usize, bool)> = Vec::new();
        let mut at = 0;
        for part in name.split_inclusive(BREAKS) {
            let known = self.next.get(&name[..at]);
            let shared = at > 0 && known.is_some_and(|(count, same)| *count > 1 && same.is_some());
            at += part.len();
            match stretches.last_mut() {
                Some((end, before)) if *before == shared => *end = at,
                _ => stretches.push((at, shared)),
            }
        }
        let mut from = 0;
        let cut = |(end, shared)| {
            let stretch = (&name[from..end], shared);
            from = end;
            stretch
        };
        stretches.into_iter().map(cut).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_names_may_break_but_keep_every_letter() {
        let name = Names::new(["AD_10253-790nm.png"]).show("AD_10253-790nm.png").into_string();
        assert_eq!(name, "AD_<wbr>10253-<wbr>790nm.<wbr>png<wbr>");
    }

    #[test]
    fn what_tells_names_apart_is_never_left_out() {
        let names = ["AD_10253_790nm_OD_1", "AD_10253_790nm_OD_2", "AD_10253_790nm_OS_1", "other"];
        let shown = Names::new(names);
        let narrow: Vec<String> = names
            .iter()
            .map(|name| {
                let left =
                    |(text, shared): (&str, bool)| if shared { "…".to_owned() } else { text.to_owned() };
                shown.stretches(name).into_iter().map(left).collect()
            })
            .collect();
        assert_eq!(narrow, ["AD_…OD_1", "AD_…OD_2", "AD_…OS_1", "other"]);
        let text = shown.show(names[0]).into_string();
        assert!(text.contains("<span class=\"same\">10253_<wbr>790nm_<wbr></span>OD_<wbr>1"), "{text}");
    }
}
