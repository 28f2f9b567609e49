use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use kuva::backend::svg::SvgBackend;
use kuva::render::axis::add_axes_and_grid;
use kuva::render::layout::{ComputedLayout, Layout};
use kuva::render::render::{PathData, Primitive, Scene, TextAnchor};
use std::fmt::Write;

/// Width of the page, in canvas units.
///
/// A unit is a quarter of a millimetre, so that the page prints 180 mm wide and a text of size 10
/// in 7 pt.
pub(super) const PAGE_WIDTH: f64 = 720.;
/// Canvas units per millimetre of the printed page.
const UNITS_PER_MM: f64 = 4.;
/// Fonts of all texts, in order of preference: the letters of the first three have equal widths.
const FONTS: &str = "Helvetica, Arial, 'Liberation Sans', sans-serif";

/// Colour of frames and of lines that are not data.
pub(super) const FRAME: &str = "#8c8c8c";
/// Colour of texts and of the curve or points of the mosaic.
pub(super) const INK: &str = "#000000";

/// An upright rectangle on the page, in canvas units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Area {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Area {
    /// Returns the x coordinate of the right edge.
    pub(super) const fn right(&self) -> f64 {
        self.x + self.width
    }
    /// Returns the y coordinate of the lower edge.
    pub(super) const fn bottom(&self) -> f64 {
        self.y + self.height
    }
}

/// The purpose of a text, which sets its size and weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Style {
    /// Title of the page.
    Title,
    /// Bold letter that names a panel: a, b, c.
    Letter,
    /// Title of an axis, or name of a panel.
    Axis,
    /// Small text: tick labels, legends and notes.
    Note,
}

impl Style {
    /// Returns the size of the font in canvas units.
    const fn size(self) -> u32 {
        match self {
            Self::Title | Self::Axis => 10,
            Self::Letter => 13,
            Self::Note => 9,
        }
    }
}

/// Part of a text that lies at the position at which the text is drawn.
#[derive(Clone, Copy, Debug)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl From<Anchor> for TextAnchor {
    fn from(anchor: Anchor) -> Self {
        match anchor {
            Anchor::Start => Self::Start,
            Anchor::Middle => Self::Middle,
            Anchor::End => Self::End,
        }
    }
}

/// The data ranges of a plot along x and y, each from and to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ranges {
    pub(super) x: (f64, f64),
    pub(super) y: (f64, f64),
}

/// Returns the approximate width of a text in canvas units.
///
/// Letters are put into five classes of width, with the widths of Helvetica. That is near enough
/// for placing texts.
pub(super) fn text_width(text: &str, style: Style) -> f64 {
    let advance = |c: char| match c {
        'i' | 'j' | 'l' | '\'' => 0.24,
        ' ' | '.' | ',' | ':' | ';' | 'f' | 't' | 'I' | '|' | '/' | '(' | ')' | '-' | 'r' => 0.31,
        'm' | 'M' | 'w' | 'W' | '%' | '@' | '∞' => 0.86,
        'A'..='Z' => 0.7,
        _ => 0.556,
    };
    text.chars().map(advance).sum::<f64>() * f64::from(style.size())
}

/// Returns the text, with its middle cut out if it is wider than `width`.
pub(super) fn fit(text: &str, style: Style, width: f64) -> String {
    if text_width(text, style) <= width {
        return text.to_owned();
    }
    let letters: Vec<char> = text.chars().collect();
    let mut kept = letters.len();
    loop {
        let (head, tail) = (kept.div_ceil(2), letters.len() - kept / 2);
        let short: String = letters[..head].iter().chain(&['…']).chain(&letters[tail..]).collect();
        if kept == 0 || text_width(&short, style) <= width {
            return short;
        }
        // Halving comes first, for speed: a title may be a megabyte long.
        kept = if kept > 400 { kept / 2 } else { kept - 1 };
    }
}

/// The page being drawn.
///
/// kuva draws axes and vector elements. It has no element for pictures, so these lie beneath as
/// embedded PNG.
pub(super) struct Canvas {
    /// Everything else on the page, drawn above the pictures.
    scene: Scene,
    /// SVG elements of the pictures, in the order in which they are drawn.
    pictures: String,
}

impl Canvas {
    /// Makes an empty page of `height` canvas units.
    pub(super) fn new(height: f64) -> Self {
        Self { scene: Scene::new(PAGE_WIDTH, height).with_background(None), pictures: String::new() }
    }

    pub(super) fn text(&mut self, x: f64, y: f64, text: &str, style: Style, anchor: Anchor) {
        self.coloured_text(x, y, text, style, anchor, INK);
    }

    pub(super) fn coloured_text(
        &mut self,
        x: f64,
        y: f64,
        text: &str,
        style: Style,
        anchor: Anchor,
        colour: &str,
    ) {
        self.scene.add(Primitive::Text {
            x,
            y,
            content: plain(text),
            size: style.size(),
            anchor: anchor.into(),
            rotate: None,
            bold: style == Style::Letter,
            // The page's own colour is black, which needs no attribute.
            color: (colour != INK).then(|| colour.into()),
        });
    }

    pub(super) fn line(&mut self, from: (f64, f64), to: (f64, f64), colour: &str, width: f64) {
        self.polyline(vec![from, to], colour, width, None);
    }

    /// Draws a line through `points`; `dash` is a dash pattern of SVG, and `None` draws a solid
    /// line.
    pub(super) fn polyline(&mut self, points: Vec<(f64, f64)>, colour: &str, width: f64, dash: Option<&str>) {
        self.scene.add(Primitive::PolyLine {
            points,
            stroke: colour.into(),
            stroke_width: width,
            stroke_dasharray: dash.map(str::to_owned),
        });
    }

    /// Draws a filled outline without stroke.
    pub(super) fn polygon(&mut self, corners: &[(f64, f64)], colour: &str) {
        let mut d = String::with_capacity(16 * corners.len());
        for (k, (x, y)) in corners.iter().enumerate() {
            let _ = write!(d, "{}{x:.2} {y:.2} ", if k == 0 { 'M' } else { 'L' });
        }
        d.push('Z');
        self.scene.add(Primitive::Path(Box::new(PathData {
            d,
            fill: Some(colour.into()),
            stroke: "none".into(),
            stroke_width: 0.,
            opacity: None,
            stroke_dasharray: None,
        })));
    }

    /// Draws a filled rectangle with a thin white border, which separates neighbouring bars.
    pub(super) fn bar(&mut self, area: Area, colour: &str) {
        self.scene.add(Primitive::Rect {
            x: area.x,
            y: area.y,
            width: area.width,
            height: area.height,
            fill: colour.into(),
            stroke: Some("#ffffff".into()),
            stroke_width: Some(0.4),
            opacity: None,
        });
    }

    /// Draws the outline of a rectangle in the colour of frames.
    pub(super) fn frame(&mut self, area: Area) {
        self.scene.add(Primitive::Rect {
            x: area.x,
            y: area.y,
            width: area.width,
            height: area.height,
            fill: "none".into(),
            stroke: Some(FRAME.into()),
            stroke_width: Some(0.6),
            opacity: None,
        });
    }

    /// Draws a coloured strip without outline, which shines through where `opacity` is below 1.
    pub(super) fn band(&mut self, area: Area, colour: &str, opacity: f64) {
        self.scene.add(Primitive::Rect {
            x: area.x,
            y: area.y,
            width: area.width,
            height: area.height,
            fill: colour.into(),
            stroke: None,
            stroke_width: None,
            opacity: Some(opacity),
        });
    }

    pub(super) fn dots(&mut self, centres: &[(f64, f64)], radius: f64) {
        self.coloured_dots(centres, radius, INK, None);
    }

    pub(super) fn coloured_dots(
        &mut self,
        centres: &[(f64, f64)],
        radius: f64,
        colour: &str,
        opacity: Option<f64>,
    ) {
        self.scene.add(Primitive::CircleBatch {
            cx: centres.iter().map(|c| c.0).collect(),
            cy: centres.iter().map(|c| c.1).collect(),
            r: radius,
            fill: colour.into(),
            fill_opacity: opacity,
            stroke: None,
            stroke_width: None,
        });
    }

    /// Draws a PNG stretched over the area `place`; what lies outside the area `view` is cut off.
    pub(super) fn picture(&mut self, png: &[u8], place: Area, view: Area) {
        // A nested <svg> clips without an id. Ids would clash where several figures share a page.
        let _ = write!(
            self.pictures,
            r#"<svg x="{:.2}" y="{:.2}" width="{:.2}" height="{:.2}"><image x="{:.3}" y="{:.3}" width="{:.3}" height="{:.3}" preserveAspectRatio="none" href="data:image/png;base64,"#,
            view.x,
            view.y,
            view.width,
            view.height,
            place.x - view.x,
            place.y - view.y,
            place.width,
            place.height,
        );
        BASE64_STANDARD.encode_string(png, &mut self.pictures);
        self.pictures.push_str("\"/></svg>");
    }

    /// Draws labelled axes with ticks, and returns the map from data to the page.
    ///
    /// Ticks along y stand at the multiples of `y_step`.
    pub(super) fn axes(
        &mut self,
        area: Area,
        ranges: Ranges,
        labels: (&str, &str),
        y_step: f64,
    ) -> impl Fn(f64, f64) -> (f64, f64) + use<> {
        let layout = Layout::new(ranges.x, ranges.y)
            .with_width(PAGE_WIDTH)
            .with_height(self.scene.height)
            .with_force_margins(area.x, PAGE_WIDTH - area.right())
            .with_force_margins_y(area.y, self.scene.height - area.bottom())
            .with_x_axis_min(ranges.x.0)
            .with_x_axis_max(ranges.x.1)
            .with_y_axis_min(ranges.y.0)
            .with_y_axis_max(ranges.y.1)
            .with_ticks(5)
            .with_y_tick_step(y_step)
            .with_show_grid(false)
            .with_tick_size(Style::Note.size())
            .with_axis_line_width(0.7)
            .with_tick_width(0.7)
            .with_tick_length(3.);
        let computed = ComputedLayout::from_layout(&layout);
        add_axes_and_grid(&mut self.scene, &computed, &layout);
        let middle = area.x + area.width / 2.;
        self.text(middle, area.bottom() + 26., labels.0, Style::Axis, Anchor::Middle);
        // Ticks are multiples of the step with equal numbers of decimals, so the lowest or the
        // highest one has the widest label.
        let decimals = (-y_step.log10().floor()).max(0.) as usize;
        let width = |tick: f64| text_width(&format!("{:.decimals$}", tick * y_step), Style::Note);
        let ticks = width((ranges.y.1 / y_step).floor()).max(width((ranges.y.0 / y_step).ceil()));
        self.scene.add(Primitive::Text {
            x: area.x - ticks - 12.,
            y: area.y + area.height / 2.,
            content: plain(labels.1),
            size: Style::Axis.size(),
            anchor: TextAnchor::Middle,
            rotate: Some(-90.),
            bold: false,
            color: None,
        });
        move |x, y| (computed.map_x(x), computed.map_y(y))
    }

    /// Draws an empty panel with a sentence that says why it is empty.
    pub(super) fn sentence(&mut self, area: Area, sentence: &str) {
        self.frame(area);
        let line_height = 12.;
        let lines = wrap(sentence, Style::Note, area.width - 16.);
        let first = area.y + area.height / 2. - line_height * (lines.len() as f64 - 1.) / 2. + 3.;
        for (i, line) in lines.iter().enumerate() {
            let y = first + i as f64 * line_height;
            self.text(area.x + area.width / 2., y, line, Style::Note, Anchor::Middle);
        }
    }

    /// Returns the SVG; `title` is its accessible name, and screen readers read `description`.
    pub(super) fn into_svg(self, title: &str, description: &str) -> String {
        let height = self.scene.height;
        let drawn = SvgBackend::new().render_scene(&self.scene);
        // The opening tag of kuva gives the size in px; it is replaced by one in millimetres.
        let body = drawn.split_once('>').map_or("", |(_, body)| body);
        let mut svg = String::with_capacity(drawn.len() + self.pictures.len() + 512);
        let _ = write!(
            svg,
            r##"<svg xmlns="http://www.w3.org/2000/svg" width="{:.2}mm" height="{:.2}mm" viewBox="0 0 {PAGE_WIDTH} {height:.2}" font-family="{FONTS}" fill="{INK}"><title>{}</title><desc>{}</desc><rect width="{PAGE_WIDTH}" height="{height:.2}" fill="#ffffff"/>"##,
            PAGE_WIDTH / UNITS_PER_MM,
            height / UNITS_PER_MM,
            escaped(title),
            escaped(description),
        );
        svg.push_str(&self.pictures);
        svg.push_str(body);
        svg.push('\n');
        svg
    }
}

/// Returns text that kuva draws literally.
///
/// A dollar sign does not begin a formula, and characters that XML forbids become replacement
/// characters.
fn plain(text: &str) -> String {
    allowed(text).replace('$', "\\$")
}

/// Replaces the characters that XML forbids.
fn allowed(text: &str) -> String {
    let forbidden = |c: char| c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}');
    text.chars().map(|c| if forbidden(c) { char::REPLACEMENT_CHARACTER } else { c }).collect()
}

/// Returns text that XML reads literally.
fn escaped(text: &str) -> String {
    allowed(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Breaks a text at blanks into lines of at most `width` canvas units, as far as its words allow.
fn wrap(text: &str, style: Style, width: f64) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let Some(line) = lines.last_mut() else { break };
        if line.is_empty() {
            line.push_str(word);
        } else if text_width(line, style) + text_width(word, style) + 3. <= width {
            line.push(' ');
            line.push_str(word);
        } else {
            lines.push(word.to_owned());
        }
    }
    lines
}

/// Returns the upper end of a y axis that leaves room for a block of text at the top of the plot.
///
/// `peak` is the highest value of all curves; the upper end lies above it. `peak_under` is the
/// highest value of the curves where they pass beneath the block; the block covers none of them.
/// The block is `block` canvas units high, the plot `height` canvas units.
pub(super) fn headroom(peak: f64, peak_under: f64, block: f64, height: f64) -> f64 {
    let free = (1. - block / height).max(0.1);
    (peak * 1.06).max(peak_under * 1.02 / free)
}

/// Returns the smallest of 1, 2, 5 × 10ᵏ that is not below `x`, as the step between ticks.
pub(super) fn round_above(x: f64) -> f64 {
    let decade = 10f64.powf(x.log10().floor());
    [1., 2., 5.].into_iter().map(|step| step * decade).find(|&step| step >= x).unwrap_or(10. * decade)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tick_steps_are_round() {
        let steps = [0.7, 1., 1.1, 4., 17., 60., 999.].map(round_above);
        assert_eq!(steps, [1., 1., 2., 5., 20., 100., 1000.]);
    }

    #[test]
    fn long_titles_lose_their_middle() {
        let title = format!("start_{}_end.png", "x".repeat(10_000));
        let short = fit(&title, Style::Title, 700.);
        assert!(short.starts_with("start_") && short.ends_with("_end.png") && short.contains('…'));
        assert!(text_width(&short, Style::Title) <= 700.);
        assert_eq!(fit("short", Style::Title, 700.), "short");
    }

    #[test]
    fn sentences_break_between_words() {
        let lines = wrap("one two three four five six", Style::Note, 60.);
        assert!(lines.len() > 1);
        assert_eq!(lines.join(" "), "one two three four five six");
        assert!(lines.iter().all(|l| text_width(l, Style::Note) <= 60.));
    }

    #[test]
    fn block_never_covers_what_passes_beneath() {
        let top = headroom(3., 2.5, 80., 150.);
        assert!(2.5 / top * 150. < 150. - 80.);
        assert_eq!(headroom(3., 0.1, 80., 150.), 3. * 1.06);
    }
}
