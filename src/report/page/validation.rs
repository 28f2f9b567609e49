use super::names::Names;
use super::skeleton::{in_url, skeleton};
use crate::report::{MarkKind, TextTable, counted};
use maud::{Markup, html};

/// Number of the worst images whose overlays are shown on the page; the others are linked.
const SHOWN: usize = 12;

/// Style that only this page needs, added to that of all pages.
const MORE_STYLE: &str = "
.overlays { display: grid; grid-template-columns: repeat(auto-fill, minmax(22rem, 1fr)); gap: 1rem; }
.overlays img { image-rendering: auto; } figcaption { font-size: .8rem; overflow-wrap: anywhere; }
.key { display: inline-block; width: .8em; height: .8em; border-radius: 50%; margin: 0 .3em 0 1em; vertical-align: -.05em; }
";

/// Image that was scored against marks, as a row of the page.
#[derive(Clone, Debug)]
pub struct ScoredImage {
    /// Name of the image.
    pub name: String,
    /// Cells of the row, after the name.
    pub cells: Vec<String>,
    /// Name of the file of the overlay, beside the page; `None` without one.
    pub overlay: Option<String>,
}

/// Contents of the page of a validation; all files are in the folder of the page.
#[derive(Clone, Debug, Default)]
pub struct ValidationPage<'a> {
    /// Paragraph below the title.
    pub lead: String,
    /// Warnings that a reader must know, one sentence each.
    pub notes: &'a [String],
    /// Tables, each with its heading.
    pub tables: &'a [(&'a str, TextTable)],
    /// Figures, each with its file name and a description.
    pub figures: &'a [(&'a str, String)],
    /// Other files, each with its name and a description.
    pub files: &'a [(&'a str, &'a str)],
    /// Headers of the table of images, after that of the name.
    pub header: &'a [&'a str],
    /// Images, the worst first.
    pub images: &'a [ScoredImage],
    /// Files of marks that could not be scored, each with the reason.
    pub failures: &'a [(&'a str, &'a str)],
}

/// Returns the HTML page of a validation.
///
/// It shows accuracy, agreement and curves, and then the images from the worst to the best.
pub fn validation_page(page: &ValidationPage) -> String {
    let body = html! {
        h1 { "Validation of cone detections" }
        p.lead { (page.lead) }
        @if !page.images.is_empty() { nav { a href="#images" { "Images, the worst first" } } }
        @for note in page.notes { p.warning { "⚠ " (note) } }
        @if !page.failures.is_empty() {
            h2.warning { (counted(page.failures.len(), "file")) " of marks could not be scored" }
            ul { @for (file, reason) in page.failures { li title=(file) { (reason) } } }
        }
        @for (heading, table) in page.tables { h2 { (heading) } div.scroll { (table_of(table)) } }
        @for (file, words) in page.figures {
            figure { img src=(in_url(file)) alt=(words); figcaption { (words) } }
        }
        @if !page.images.is_empty() { (images(page)) }
        p {
            "Files: "
            @for (k, (file, words)) in page.files.iter().enumerate() {
                @if k > 0 { "; " } a href=(in_url(file)) { (file) } ", " (words)
            }
            "."
        }
    };
    skeleton("Validation of cone detections", &style(), &body)
}

/// Entries of the key to the overlays: kind of mark, CSS class and words.
const KEY: [(MarkKind, &str, &str); 4] = [
    (MarkKind::Hit, "hit", "hit (ring)"),
    (MarkKind::Miss, "miss", "miss (plus)"),
    (MarkKind::FalseAlarm, "alarm", "false alarm (cross)"),
    (MarkKind::Uncounted, "uncounted", "in the dark border (not counted)"),
];

/// Returns the style of this page, including the colours of the key.
fn style() -> String {
    let colour = |(kind, class, _): &(MarkKind, &str, &str)| {
        format!(".key.{class} {{ background: {}; }}\n", hex(kind.colour()))
    };
    KEY.iter().fold(MORE_STYLE.to_owned(), |style, entry| style + &colour(entry))
}

/// Returns a table as HTML.
fn table_of(table: &TextTable) -> Markup {
    html! {
        table {
            thead { tr { @for cell in &table.header { th { (cell) } } } }
            tbody { @for row in &table.rows { tr { @for cell in row { td { (cell) } } } } }
        }
    }
}

/// Returns the overlays of the worst images, and the table of all images.
fn images(page: &ValidationPage) -> Markup {
    let shown = page.images.iter().take(SHOWN).filter_map(|i| i.overlay.as_ref().map(|o| (i, o)));
    let shown: Vec<_> = shown.collect();
    let names = Names::new(page.images.iter().map(|i| i.name.as_str()));
    html! {
        h2 id="images" { "Images, the worst first" }
        @if !shown.is_empty() {
            p {
                @for (_, class, words) in KEY { span class={ "key " (class) } {} (words) }
            }
            div.overlays {
                @for (image, overlay) in shown {
                    figure {
                        a href=(in_url(overlay)) { img loading="lazy" src=(in_url(overlay)) alt=(format!("Overlay of {}", image.name)); }
                        figcaption { (image.name) }
                    }
                }
            }
        }
        div.scroll {
            table {
                thead { tr { th { "image" } @for cell in page.header { th { (cell) } } } }
                tbody { @for image in page.images { tr {
                    td title=(image.name) {
                        @if let Some(overlay) = &image.overlay { a href=(in_url(overlay)) { (names.show(&image.name)) } } @else { (names.show(&image.name)) }
                    }
                    @for cell in &image.cells { td { (cell) } }
                } } }
            }
        }
    }
}

/// Returns a colour in the notation of CSS, `#rrggbb`.
fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_others_are_text_and_not_markup() {
        let images =
            [ScoredImage { name: "<b>".into(), cells: vec!["1".into()], overlay: Some("a b#.png".into()) }];
        let text = validation_page(&ValidationPage {
            header: &["Dice"],
            images: &images,
            failures: &[("a", "it is <broken>")],
            ..ValidationPage::default()
        });
        assert!(text.starts_with("<!DOCTYPE html>") && text.contains("it is &lt;broken&gt;"));
        assert!(text.contains("&lt;b&gt;") && text.contains("a%20b%23.png"));
    }
}
