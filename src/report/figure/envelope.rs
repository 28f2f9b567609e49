use super::canvas::{self, Anchor, Area, Canvas, FRAME, INK, Ranges, Style, round_above, text_width};
use super::correlation::axis_end;
use super::page::{LEFT_EDGE, TITLE_BASELINE};
use super::{Curve, ReportError};

/// Description of the figure for screen readers.
const DESCRIPTION: &str = "The pair correlation function of a mosaic (black), one panel per sampler. The band is the global \
    95 % envelope of simulations of the sampler, the thin blue line their mean. Where the mosaic's curve leaves the band it is \
    drawn in red.";

/// Number of panels in a row of the page.
const COLUMNS: usize = 3;
/// Width and height of the axes of a panel, in canvas units; three panels with their axes fit in
/// the width of the page.
const PANEL: (f64, f64) = (184., 118.);
/// Room for tick labels and the axis title left of a panel, in canvas units.
const AXIS_ROOM: f64 = 44.;
/// Room for the names of samplers above a row of panels, in canvas units.
const ROW_HEAD: f64 = 30.;
/// Room for tick labels and the axis title below a panel, in canvas units.
const AXIS_DEPTH: f64 = 36.;
/// Colour of the envelope, a light blue behind all lines.
const BAND: &str = "#9ecae1";
/// Colour of the mean of the simulations (blue of Okabe & Ito 2008).
const MEAN: &str = "#0072B2";
/// Colour of the curve of the mosaic outside the envelope (vermilion of Okabe & Ito 2008).
const OUTSIDE: &str = "#D55E00";
/// Line width of the mosaic, in canvas units; chosen by eye like the other widths.
const OWN_WIDTH: f64 = 1.6;
/// Line width of the mean of the simulations, in canvas units.
const MEAN_WIDTH: f64 = 1.1;
/// Line width of the parts outside the envelope, in canvas units; the widest of the three.
const OUTSIDE_WIDTH: f64 = 2.2;
/// Height of the key, a line of text below the title, in canvas units.
const KEY_DEPTH: f64 = 16.;
/// Length of the sample of a line in the key, in canvas units.
const SWATCH: f64 = 18.;

/// The panel of one sampler.
///
/// All its curves have one value for each distance of the mosaic's curve.
#[derive(Clone, Copy, Debug)]
pub struct EnvelopePanel<'a> {
    /// Name of the sampler.
    pub name: &'a str,
    /// Note behind the name above the panel: the p-value, “p = 0.3”.
    pub note: &'a str,
    /// Mean of the simulations.
    pub mean: &'a [f64],
    /// Lower edge of the envelope.
    pub low: &'a [f64],
    /// Upper edge of the envelope.
    pub high: &'a [f64],
}

/// Draws the mosaic's pair correlation function in the envelope of each sampler, as a
/// self-contained SVG, 180 mm wide.
///
/// # Errors
/// Fails if curves differ in length.
pub fn envelope_figure(title: &str, mosaic: Curve, panels: &[EnvelopePanel]) -> Result<String, ReportError> {
    let bins = mosaic.r.len();
    for (name, curve) in [("the mosaic", mosaic.g)]
        .into_iter()
        .chain(panels.iter().flat_map(|p| [p.mean, p.low, p.high].map(|curve| (p.name, curve))))
    {
        if curve.len() != bins {
            return Err(ReportError::Curve { name: name.to_owned(), r: bins, g: curve.len() });
        }
    }
    let rows = panels.len().div_ceil(COLUMNS).max(1);
    let row_height = ROW_HEAD + PANEL.1 + AXIS_DEPTH;
    let head = TITLE_BASELINE + 4. + KEY_DEPTH;
    let mut canvas = Canvas::new(head + rows as f64 * row_height);
    let fitted = canvas::fit(title, Style::Title, canvas::PAGE_WIDTH - 2. * LEFT_EDGE);
    canvas.text(LEFT_EDGE, TITLE_BASELINE, &fitted, Style::Title, Anchor::Start);
    key(&mut canvas, TITLE_BASELINE + KEY_DEPTH);
    let highest = panels.iter().flat_map(|p| p.high).chain(mosaic.g).copied().filter(|v| v.is_finite());
    let highest = highest.fold(1., f64::max) * 1.05;
    let x = (0., axis_end(mosaic.r.last().copied().unwrap_or(1.)));
    for (k, panel) in panels.iter().enumerate() {
        let area = Area {
            x: AXIS_ROOM + (k % COLUMNS) as f64 * (PANEL.0 + AXIS_ROOM + 6.),
            y: head + ROW_HEAD + (k / COLUMNS) as f64 * row_height,
            width: PANEL.0,
            height: PANEL.1,
        };
        let heading = format!("{}, {}", panel.name, panel.note);
        canvas.text(area.x, area.y - 7., &heading, Style::Axis, Anchor::Start);
        draw(&mut canvas, area, Ranges { x, y: (0., highest) }, mosaic, panel);
    }
    Ok(canvas.into_svg(title, DESCRIPTION))
}

/// Draws the key that says which line is which, from left to right.
fn key(canvas: &mut Canvas, baseline: f64) {
    let middle = baseline - 3.;
    let mut x = LEFT_EDGE;
    for (words, colour, width) in [
        ("g of the mosaic", INK, OWN_WIDTH),
        ("mean of the simulations", MEAN, MEAN_WIDTH),
        ("95 % global envelope of the simulations", BAND, 0.),
        ("g outside the envelope", OUTSIDE, OUTSIDE_WIDTH),
    ] {
        if width > 0. {
            canvas.line((x, middle), (x + SWATCH, middle), colour, width);
        } else {
            canvas.band(Area { x, y: middle - 4., width: SWATCH, height: 8. }, colour, 1.);
        }
        canvas.text(x + SWATCH + 4., baseline, words, Style::Note, Anchor::Start);
        x += SWATCH + 4. + text_width(words, Style::Note) + 16.;
    }
}

/// Draws one panel: the envelope, the mean and, in another colour where it leaves the envelope, the
/// mosaic.
fn draw(canvas: &mut Canvas, area: Area, ranges: Ranges, mosaic: Curve, panel: &EnvelopePanel) {
    let step = round_above(ranges.y.1 / 4.);
    let place = canvas.axes(area, ranges, ("r / hexagonal spacing", "g(r)"), step);
    let along = |values: &[f64]| -> Vec<(f64, f64)> {
        mosaic.r.iter().zip(values).map(|(&r, &g)| place(r, g)).collect()
    };
    let band: Vec<_> = along(panel.low).into_iter().chain(along(panel.high).into_iter().rev()).collect();
    canvas.polygon(&band, BAND);
    canvas.line(place(ranges.x.0, 1.), place(ranges.x.1, 1.), FRAME, 0.6);
    canvas.polyline(along(panel.mean), MEAN, MEAN_WIDTH, None);
    canvas.polyline(along(mosaic.g), INK, OWN_WIDTH, None);
    // The edges of the envelope are rounded to three decimals, but this g is not: 6e-4 is just
    // above the rounding error.
    let within = |bin: usize| (panel.low[bin] - 6e-4..=panel.high[bin] + 6e-4).contains(&mosaic.g[bin]);
    let mut bin = 0;
    while bin < mosaic.r.len() {
        let run = (bin..mosaic.r.len()).take_while(|&b| !within(b)).count();
        if run > 0 {
            // One more bin on either side makes a single bin visible.
            let span = bin.saturating_sub(1)..(bin + run + 1).min(mosaic.r.len());
            let points = span.map(|b| place(mosaic.r[b], mosaic.g[b])).collect();
            canvas.polyline(points, OUTSIDE, OUTSIDE_WIDTH, None);
        }
        bin += run + 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panel_a_sampler_and_red_only_where_the_curve_leaves_the_band() {
        let r: Vec<f64> = (0..20).map(|k| 0.15 + 0.1 * f64::from(k)).collect();
        let (low, mean, high) = (vec![0.8; 20], vec![1.; 20], vec![1.2; 20]);
        let panel = EnvelopePanel { name: "bnot", note: "p = 0.3", mean: &mean, low: &low, high: &high };
        let drawn = |g: &[f64], panels: &[EnvelopePanel]| {
            envelope_figure("a", Curve { r: &r, g }, panels).unwrap().to_uppercase()
        };
        let inside = drawn(&mean, &[panel; 4]);
        assert_eq!(inside.matches("BNOT, P = 0.3").count(), 4);
        // the key knows all colours, once each
        let times = |svg: &str, colour: &str| svg.matches(&colour.to_uppercase()).count();
        assert_eq!((times(&inside, OUTSIDE), times(&inside, BAND)), (1, 5));
        let mut g = mean.clone();
        g[7] = 2.;
        assert_eq!(times(&drawn(&g, &[panel]), OUTSIDE), 2);
        let svg = envelope_figure("a", Curve { r: &r, g: &g }, &[panel]).unwrap();
        roxmltree::Document::parse(&svg).unwrap();
        for words in ["g of the mosaic", "mean of the simulations", "95 % global envelope"] {
            assert!(svg.contains(words), "{words} is not in the key");
        }
        assert!(envelope_figure("a", Curve { r: &r, g: &[1.] }, &[panel]).is_err());
    }
}
