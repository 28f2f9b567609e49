use super::skeleton::{in_url, skeleton};
use crate::report::TextTable;
use maud::{Markup, PreEscaped, html};
use std::fmt::Write;

const MORE_STYLE: &str = "
body { max-width: 1080px; } .text { max-width: 46rem; }
.summary { display: grid; grid-template-columns: repeat(auto-fit, minmax(15rem, 1fr)); gap: .8rem; margin: 1.4rem 0; }
.summary div { border: 1px solid var(--line); border-left: 4px solid #009E73; border-radius: 4px; padding: .6rem .9rem; }
.summary div.no { border-left-color: var(--warn); } .summary b { display: block; font-size: 1.25rem; }
.drawing { background: #fff; border-radius: 4px; padding: .8rem; margin: 1rem 0; } .drawing svg { width: 100%; height: auto; display: block; }
figcaption { font-size: .85rem; opacity: .8; max-width: 46rem; }
tr.no td { color: var(--warn); }
";

/// One result in large letters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Headline {
    /// “7 of 7”.
    pub number: String,
    /// What that counts.
    pub words: String,
    /// Whether it is as it should be.
    pub good: bool,
}

/// A part of a document: text, table, figure, in this order.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Its heading.
    pub heading: String,
    /// Paragraphs above the table.
    pub before: Vec<String>,
    /// A table; rows whose index is in `marked` do not agree.
    pub table: Option<TextTable>,
    /// Rows that stand out.
    pub marked: Vec<usize>,
    /// Paragraphs below the table.
    pub after: Vec<String>,
    /// An SVG, the file it is also in, and its caption.
    pub figure: Option<(String, &'static str, String)>,
    /// Files beside the page with the same in full precision.
    pub files: Vec<&'static str>,
}

/// A report to be read: as one self-contained HTML page and as Markdown.
#[derive(Clone, Debug, Default)]
pub struct Document {
    /// Its title.
    pub title: String,
    /// Below the title.
    pub lead: String,
    /// The results in large letters.
    pub headlines: Vec<Headline>,
    /// Its parts.
    pub sections: Vec<Section>,
    /// Below a rule at the end: how it was made.
    pub colophon: String,
}

impl Document {
    /// Returns one page that needs no other file; figures are in it.
    pub fn to_html(&self) -> String {
        let body = html! {
            h1 { (self.title) }
            p.lead { (self.lead) }
            div.summary { @for h in &self.headlines {
                div.no[!h.good] { b { (h.number) } (h.words) }
            } }
            @for section in &self.sections { (section.to_html()) }
            hr;
            p.lead { (self.colophon) }
        };
        skeleton(&self.title, MORE_STYLE, &body)
    }

    /// Returns the same as Markdown; figures are links to their files.
    pub fn to_markdown(&self) -> String {
        let mut text = format!("# {}\n\n{}\n\n", self.title, self.lead);
        for h in &self.headlines {
            let _ = writeln!(text, "- **{}** {}", h.number, h.words);
        }
        for section in &self.sections {
            section.write_markdown(&mut text);
        }
        let _ = write!(text, "\n---\n\n{}\n", self.colophon);
        text
    }
}

impl Section {
    fn to_html(&self) -> Markup {
        html! {
            section {
                h2 { (self.heading) }
                @for paragraph in &self.before { p.text { (paragraph) } }
                @if let Some(table) = &self.table { div.scroll { table {
                    thead { tr { @for cell in &table.header { th { (cell) } } } }
                    tbody { @for (k, row) in table.rows.iter().enumerate() {
                        tr.no[self.marked.contains(&k)] { @for cell in row { td { (cell) } } }
                    } }
                } } }
                @for paragraph in &self.after { p.text { (paragraph) } }
                @if let Some((svg, _, caption)) = &self.figure {
                    figure { div.drawing { (PreEscaped(svg)) } figcaption { (caption) } }
                }
                @if !self.files.is_empty() {
                    nav { @for file in &self.files { a href=(in_url(file)) { (file) } } }
                }
            }
        }
    }

    fn write_markdown(&self, text: &mut String) {
        let _ = write!(text, "\n## {}\n\n", self.heading);
        self.before.iter().for_each(|p| text.push_str(&format!("{p}\n\n")));
        if let Some(table) = &self.table {
            let line = |cells: &[String]| {
                let cells: Vec<String> = cells.iter().map(|c| c.replace('|', "\\|")).collect();
                format!("| {} |\n", cells.join(" | "))
            };
            text.push_str(&line(&table.header));
            text.push_str(&line(&vec!["---".to_owned(); table.header.len()]));
            table.rows.iter().for_each(|row| text.push_str(&line(row)));
            text.push('\n');
        }
        self.after.iter().for_each(|p| text.push_str(&format!("{p}\n\n")));
        if let Some((_, file, caption)) = &self.figure {
            let _ = write!(text, "![{caption}]({file})\n\n");
        }
        if !self.files.is_empty() {
            let links: Vec<String> = self.files.iter().map(|f| format!("[{f}]({f})")).collect();
            let _ = writeln!(text, "{}", links.join(", "));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn page_and_markdown_hold_the_same_table() {
        let table =
            TextTable { header: vec!["a".into(), "b".into()], rows: vec![vec!["1|2".into(), "<x>".into()]] };
        let section = Section {
            heading: "Part".into(),
            table: Some(table),
            marked: vec![0],
            figure: Some(("<svg/>".into(), "f.svg", "caption".into())),
            ..Section::default()
        };
        let document = Document { title: "T & T".into(), sections: vec![section], ..Document::default() };
        let (page, markdown) = (document.to_html(), document.to_markdown());
        assert!(page.contains("T &amp; T") && page.contains("&lt;x&gt;") && page.contains("<svg/>"));
        assert!(page.contains("<tr class=\"no\">"), "{page}");
        assert!(markdown.contains("| 1\\|2 | <x> |") && markdown.contains("![caption](f.svg)"));
    }
}
