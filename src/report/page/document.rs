use super::skeleton::{in_url, skeleton};
use crate::report::TextTable;
use maud::{Markup, PreEscaped, html};
use std::fmt::Write;

/// Style that only this kind of page needs, added to that of all pages.
const MORE_STYLE: &str = "
body { max-width: 1080px; } .text { max-width: 46rem; }
.summary { display: grid; grid-template-columns: repeat(auto-fit, minmax(15rem, 1fr)); gap: .8rem; margin: 1.4rem 0; }
.summary div { border: 1px solid var(--line); border-left: 4px solid #009E73; border-radius: 4px; padding: .6rem .9rem; }
.summary div.no { border-left-color: var(--warn); } .summary b { display: block; font-size: 1.25rem; }
.drawing { background: #fff; border-radius: 4px; padding: .8rem; margin: 1rem 0; } .drawing svg { width: 100%; height: auto; display: block; }
figcaption { font-size: .85rem; opacity: .8; max-width: 46rem; }
tr.no td { color: var(--warn); }
";

/// Result that is shown in large letters at the top of a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Headline {
    /// Number in large letters, such as “7 of 7”.
    pub number: String,
    /// Words below the number, which say what it counts.
    pub words: String,
    /// `true` if the result is as expected; otherwise it is coloured as a warning.
    pub good: bool,
}

/// Part of a document: text, then a table, more text and a figure.
#[derive(Clone, Debug, Default)]
pub struct Section {
    /// Heading of the section.
    pub heading: String,
    /// Paragraphs above the table.
    pub before: Vec<String>,
    /// Table of the section, if it has one.
    pub table: Option<TextTable>,
    /// Indices, from 0, of the rows that are coloured as a warning.
    pub marked: Vec<usize>,
    /// Paragraphs below the table.
    pub after: Vec<String>,
    /// Figure as SVG text, the name of the file with the same figure, and its caption.
    pub figure: Option<(String, &'static str, String)>,
    /// Names of the files beside the page that have the same numbers in full precision.
    pub files: Vec<&'static str>,
}

/// Report that can be written as one self-contained HTML page and as Markdown.
#[derive(Clone, Debug, Default)]
pub struct Document {
    /// Title of the document.
    pub title: String,
    /// Paragraph below the title.
    pub lead: String,
    /// Results in large letters.
    pub headlines: Vec<Headline>,
    /// Sections in the order of the document.
    pub sections: Vec<Section>,
    /// Paragraph below a line at the end, which says how the document was made.
    pub colophon: String,
}

impl Document {
    /// Returns an HTML page that needs no other file, as it contains its figures.
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

    /// Returns the document as Markdown, with links to the files of the figures.
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
    /// Returns the section as an HTML element.
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

    /// Appends the section as Markdown to `text`.
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
