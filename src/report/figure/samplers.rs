use super::Curve;
use super::canvas::{Anchor, Area, Canvas, FRAME, INK, PAGE_WIDTH, Ranges, Style, round_above, text_width};
use super::correlation::{runs, style};
use super::page::{AXIS_ROOM, LEFT_EDGE};
use crate::geometry::Point;
use crate::report::ReportError;

/// Description of the figure for screen readers.
const DESCRIPTION: &str = "Point samplers. Top row: one pattern of each in the unit square. Middle row: the plane of its power \
    spectrum, with frequency 0 in the middle. Bottom row: the mean pair correlation functions and the radial power spectra.";

/// Gap between two columns, in canvas units.
const GAP: f64 = 8.;
/// Room for the names of samplers above the first row, in canvas units.
const HEAD: f64 = 18.;
/// Gap between the patterns and their spectra, in canvas units.
const ROW_GAP: f64 = 8.;
/// Gap between the spectra and the plots below, in canvas units.
const PLOT_HEAD: f64 = 26.;
/// Height of the plots of curves, in canvas units.
const PLOT_HEIGHT: f64 = 190.;
/// Room for tick labels and the axis title below a plot, in canvas units.
const AXIS_DEPTH: f64 = 36.;
/// Radius of a point of a pattern, in canvas units; chosen by eye.
const DOT_RADIUS: f64 = 0.75;
/// Width of the curves, in canvas units.
const LINE_WIDTH: f64 = 1.2;
/// Distance between two lines of the legend, in canvas units.
const LEGEND_LINE: f64 = 11.;
/// Length of the sample of a line in the legend, in canvas units.
const SWATCH: f64 = 15.;

/// One sampler's column of the figure.
#[derive(Clone, Debug)]
pub struct SamplerPanel<'a> {
    /// Name of the sampler.
    pub name: &'a str,
    /// One pattern, in the unit square.
    pub points: &'a [Point],
    /// Plane of the pattern's power spectrum, as PNG.
    pub spectrum: &'a [u8],
    /// Mean pair correlation function; distances in hexagonal spacings.
    pub pcf: Curve<'a>,
    /// Radial power spectrum; frequencies in √n.
    pub radial: Curve<'a>,
}

/// Draws Figure 1 of Lanaro et al. (2020, <https://doi.org/10.1088/2399-6528/ab8064>): patterns,
/// spectra, and all curves on one plot each.
///
/// The figure is a self-contained SVG, 180 mm wide.
///
/// # Errors
/// Fails if a curve has unequal numbers of distances and values.
pub fn samplers_figure(title: &str, panels: &[SamplerPanel]) -> Result<String, ReportError> {
    for panel in panels {
        for curve in [panel.pcf, panel.radial] {
            if curve.r.len() != curve.g.len() {
                let (r, g) = (curve.r.len(), curve.g.len());
                return Err(ReportError::Curve { name: panel.name.to_owned(), r, g });
            }
        }
    }
    let columns = panels.len().max(1) as f64;
    let side = (PAGE_WIDTH - 2. * LEFT_EDGE - (columns - 1.) * GAP) / columns;
    let plots = HEAD + 2. * side + ROW_GAP + PLOT_HEAD;
    let mut canvas = Canvas::new(plots + PLOT_HEIGHT + AXIS_DEPTH);
    for (k, panel) in panels.iter().enumerate() {
        let x = LEFT_EDGE + k as f64 * (side + GAP);
        canvas.text(x + side / 2., HEAD - 6., panel.name, Style::Axis, Anchor::Middle);
        let upper = Area { x, y: HEAD, width: side, height: side };
        let place = |p: &Point| (upper.x + p.x * side, upper.y + p.y * side);
        canvas.dots(&panel.points.iter().map(place).collect::<Vec<_>>(), DOT_RADIUS);
        canvas.frame(upper);
        let lower = Area { y: HEAD + side + ROW_GAP, ..upper };
        canvas.picture(panel.spectrum, lower, lower);
        canvas.frame(lower);
    }
    let width = (PAGE_WIDTH - LEFT_EDGE - 10.) / 2. - AXIS_ROOM - 12.;
    let left = Area { x: LEFT_EDGE + AXIS_ROOM, y: plots, width, height: PLOT_HEIGHT };
    let right = Area { x: PAGE_WIDTH - 10. - width, ..left };
    curves(&mut canvas, left, panels, |p| p.pcf, ("r / hexagonal spacing", "g(r)"));
    curves(&mut canvas, right, panels, |p| p.radial, ("frequency / √n", "power"));
    Ok(canvas.into_svg(title, DESCRIPTION))
}

/// Draws one curve per sampler on common axes, with a legend; `of` takes the curve from a panel.
fn curves<'a>(
    canvas: &mut Canvas,
    area: Area,
    panels: &[SamplerPanel<'a>],
    of: impl Fn(&SamplerPanel<'a>) -> Curve<'a>,
    labels: (&str, &str),
) {
    let values = |pick: fn(&Curve<'a>) -> &'a [f64]| {
        let all: Vec<f64> = panels.iter().flat_map(|p| pick(&of(p)).iter().copied()).collect();
        all.into_iter().filter(|v| v.is_finite()).fold(0., f64::max)
    };
    let (x_max, y_max) = (values(|c| c.r), values(|c| c.g).max(1.) * 1.06);
    if x_max <= 0. {
        canvas.sentence(area, "There are no curves to show.");
        return;
    }
    let x_max = (x_max * 4.).ceil() / 4.;
    let ranges = Ranges { x: (0., x_max), y: (0., y_max) };
    let place = canvas.axes(area, ranges, labels, round_above(y_max / 5.));
    canvas.line(place(0., 1.), place(x_max, 1.), FRAME, 0.6);
    for (k, panel) in panels.iter().enumerate() {
        let (colour, dash) = style(k);
        for run in runs(of(panel), x_max, y_max) {
            let points = run.iter().map(|p| place(p.0, p.1)).collect();
            canvas.polyline(points, colour, LINE_WIDTH, dash);
        }
    }
    let names = panels.iter().map(|p| text_width(p.name, Style::Note)).fold(0., f64::max);
    let start = area.right() - names - SWATCH - 6.;
    for (k, panel) in panels.iter().enumerate() {
        let y = area.y + 8. + k as f64 * LEGEND_LINE;
        let (colour, dash) = style(k);
        canvas.polyline(vec![(start, y - 3.), (start + SWATCH, y - 3.)], colour, LINE_WIDTH + 0.2, dash);
        canvas.text(start + SWATCH + 4., y, panel.name, Style::Note, Anchor::Start);
    }
    canvas.line((area.x, area.bottom()), (area.right(), area.bottom()), INK, 0.7);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sampler_has_a_pattern_a_spectrum_and_two_curves() {
        let (r, g) = ([0.1, 0.5, 1.], [0., 2., 1.]);
        let curve = Curve { r: &r, g: &g };
        let points = [Point::new(0.5, 0.5)];
        let panel =
            |name| SamplerPanel { name, points: &points, spectrum: &[1, 2, 3], pcf: curve, radial: curve };
        let svg = samplers_figure("Samplers", &[panel("green"), panel("bnot")]).unwrap();
        // Each name stands above its column and in both legends.
        assert_eq!((svg.matches(">green<").count(), svg.matches(">bnot<").count()), (3, 3));
        assert_eq!(svg.matches("data:image/png").count(), 2);
        roxmltree::Document::parse(&svg).unwrap();
        let broken = SamplerPanel { radial: Curve { r: &r, g: &g[..1] }, ..panel("x") };
        assert!(samplers_figure("Samplers", &[broken]).is_err());
        assert!(samplers_figure("Samplers", &[]).unwrap().contains("no curves"));
    }
}
