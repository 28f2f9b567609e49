use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};
use sha2::{Digest, Sha256};

/// Style sheet of all pages, for light and dark screens, wide and narrow screens, and paper.
///
/// A wide table scrolls inside its own box while its first column stays visible.
const STYLE: &str = "
:root { color-scheme: light dark; --line: #8884; --soft: #8882; --warn: light-dark(#a03c00, #f2a65a); }
* { box-sizing: border-box; }
body { font: 15px/1.5 system-ui, sans-serif; max-width: 1320px; margin: 2rem auto; padding: 0 1.2rem; }
h1 { font-size: 1.5rem; margin-bottom: .2rem; } h2 { font-size: 1.1rem; margin: 2.6rem 0 .4rem; overflow-wrap: anywhere; }
p, li, summary { max-width: 56rem; overflow-wrap: anywhere; } p.lead { margin-top: 0; opacity: .75; }
.scroll { overflow-x: auto; }
table { border-collapse: separate; border-spacing: 0; font-variant-numeric: tabular-nums; font-size: .85rem; }
th, td { padding: .3rem .55rem; border-bottom: 1px solid var(--line); text-align: right; white-space: nowrap; }
th { vertical-align: bottom; white-space: normal; } th small { display: block; font-weight: normal; opacity: .75; white-space: nowrap; }
th:first-child, td:first-child, .word { text-align: left; }
th:first-child, td:first-child { position: sticky; left: 0; background: Canvas; }
td:first-child { white-space: normal; overflow-wrap: anywhere; min-width: 8rem; max-width: 19rem; }
tbody tr:hover td { background-image: linear-gradient(var(--soft), var(--soft)); }
.warning { color: var(--warn); } .dots { display: none; }
figure { margin: .6rem 0; overflow-x: auto; } img { width: 100%; max-width: 1060px; background: #fff; border-radius: 4px; }
nav { display: flex; flex-wrap: wrap; gap: .2rem 1rem; font-size: .9rem; }
@media (max-width: 640px) {
  body { margin: 1rem auto; padding: 0 .8rem; } td:first-child { min-width: 6.5rem; max-width: 9rem; }
  .same { display: none; } .dots { display: inline; }
  figure img { min-width: 680px; } nav a { padding: .3rem 0; }
}
@media print { section { break-inside: avoid; } nav { display: none; } figure, .scroll { overflow: visible; } }
";

/// Returns a complete HTML page; `style` is appended to the style sheet of all pages.
///
/// The page uses neither scripts nor anything from other sites, and its content security policy
/// forbids both. The policy allows the only style sheet by its hash, so that the page can also be
/// served under a strict policy.
pub(super) fn skeleton(title: &str, style: &str, body: &Markup) -> String {
    let style = format!("{STYLE}{style}");
    let hash = BASE64_STANDARD.encode(Sha256::digest(&style));
    let policy = format!("default-src 'none'; style-src 'sha256-{hash}'; img-src 'self' file: data:");
    html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(policy);
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(style)) }
            }
            body { (body) }
        }
    }
    .into_string()
}

/// Returns a file name with all special characters escaped for use in a URL.
pub(super) fn in_url(name: &str) -> String {
    name.bytes()
        .map(|b| match b {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'_' | b'.' | b'~' => char::from(b).to_string(),
            _ => format!("%{b:02X}"),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_urls() {
        assert_eq!(in_url("a b#1_0.5"), "a%20b%231_0.5");
    }

    #[test]
    fn the_policy_allows_the_style_that_stands_on_the_page_and_no_other() {
        let text = skeleton("A", ".x { color: red; }", &html! { p { "b" } });
        let style = text.split("<style>").nth(1).and_then(|s| s.split("</style>").next()).unwrap();
        assert!(style.contains(".x { color: red; }"));
        let hash = BASE64_STANDARD.encode(Sha256::digest(style));
        assert!(text.contains(&format!("style-src 'sha256-{hash}'")), "{text}");
        assert!(!text.contains("<script") && !text.contains(" style="));
    }
}
