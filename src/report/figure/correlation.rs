use super::canvas::{Area, Canvas, FRAME, INK, Ranges, headroom, round_above};
use super::labels::{self, Label};
use super::{Curve, MosaicFigure, ReferenceLine};

/// Colours of the samplers, which colour-blind readers can tell apart (Okabe & Ito 2008).
///
/// Of their eight colours, black is the colour of the mosaic, and yellow is too pale for a line.
const COLOURS: [&str; 6] = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00"];
/// Colours of the labels of samplers: those of `COLOURS`, dark enough to read words on white.
const DARK: [&str; 6] = ["#0072B2", "#8A5F00", "#007A59", "#A3457A", "#1F7CB0", "#B84F00"];
/// Dashes of lines, which tell them apart in grey print and beyond the sixth line, where colours
/// repeat.
const DASHES: [Option<&str>; 3] = [None, Some("5 1.6"), Some("1.6 1.2")];
/// Number of samplers drawn, those nearest to the mosaic; more curves would hide each other.
const NEAREST: usize = 3;
/// Name of the sampler of independent points, which is drawn in grey as a scale for reading the
/// other curves.
const SCALE: &str = "uniform";
/// Colour of the curve and label of independent points, a grey dark enough to read on white.
const GREY: &str = "#767676";
/// Line width of a sampler, in canvas units; chosen by eye, thinner than the mosaic.
const SAMPLER_WIDTH: f64 = 1.1;
/// Line width of the mosaic, in canvas units; chosen by eye.
const MOSAIC_WIDTH: f64 = 2.2;
/// Limit to which the curve of a sampler may stretch the axis, as a multiple of the highest value
/// of the mosaic.
///
/// Without a limit, a spike of a sampler would flatten the curve of the mosaic.
const SPIKE_FACTOR: f64 = 1.5;
/// Value of g that stands for the highest value of the mosaic if the mosaic stays below it.
const SPIKE_FLOOR: f64 = 3.;
/// Distance in hexagonal spacings from the rightmost peak to the labels on its right.
///
/// It is beyond the flank of the widest peak.
const BESIDE_PEAK: f64 = 0.3;
/// Value of g that a curve must exceed for its label to point to its peak.
///
/// The label of a flatter curve points to the curve where the labels begin.
const FLAT: f64 = 1.15;

/// Returns the colour and the dashes of the curve with this index.
pub(super) fn style(index: usize) -> (&'static str, Option<&'static str>) {
    (COLOURS[index % COLOURS.len()], DASHES[(index + index / COLOURS.len()) % DASHES.len()])
}

/// A curve of the panel with its colours.
struct Line<'a> {
    name: &'a str,
    l_infinity: Option<f64>,
    curve: Curve<'a>,
    colour: &'static str,
    /// Colour of the label.
    dark: &'static str,
    width: f64,
}

impl Line<'_> {
    /// Returns the text of the label: “bnot, ℓ∞ 0.31”.
    fn text(&self) -> String {
        match self.l_infinity {
            Some(distance) => format!("{}, ℓ∞ {distance:.2}", self.name),
            None => self.name.to_owned(),
        }
    }

    /// Returns the highest point between two distances, lowered to `g_max` if the curve is cut at
    /// that value.
    fn peak(&self, from: f64, to: f64, g_max: f64) -> Option<(f64, f64)> {
        let within = finite(self.curve).filter(|p| p.0 >= from && p.0 <= to);
        within.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(r, g)| (r, g.min(g_max)))
    }
}

/// Returns the curves to draw, the mosaic's last.
///
/// Before it come independent points, as a scale, and the three samplers nearest to the mosaic.
/// More curves would hide each other; the distances to all samplers are in the tables.
fn lines<'a>(figure: &MosaicFigure<'a>, mosaic: Curve<'a>) -> Vec<Line<'a>> {
    let line = |l: &ReferenceLine<'a>, colour, dark| Line {
        name: l.name,
        l_infinity: l.l_infinity,
        curve: Curve { r: l.r, g: l.g },
        colour,
        dark,
        width: SAMPLER_WIDTH,
    };
    let mut others: Vec<_> = figure.references.iter().filter(|l| l.name != SCALE).enumerate().collect();
    // Samplers without a distance come after those that have one.
    others.sort_by(|(_, a), (_, b)| {
        let of = |l: &ReferenceLine| l.l_infinity.unwrap_or(f64::INFINITY);
        of(a).total_cmp(&of(b))
    });
    let scale = figure.references.iter().filter(|l| l.name == SCALE).map(|l| line(l, GREY, GREY));
    // A sampler has the same colour in the figures of all mosaics, unless a nearer one has taken
    // it.
    let mut free: Vec<usize> = (0..COLOURS.len()).collect();
    let nearest = others.into_iter().take(NEAREST).map(|(k, l)| {
        let at = free.iter().position(|c| *c == k % COLOURS.len()).unwrap_or(0);
        let colour = free.remove(at);
        line(l, COLOURS[colour], DARK[colour])
    });
    let nearest: Vec<_> = nearest.collect();
    let own =
        Line { name: "mosaic", l_infinity: None, curve: mosaic, colour: INK, dark: INK, width: MOSAIC_WIDTH };
    scale.chain(nearest).chain([own]).collect()
}

/// Draws the mosaic's PCF over those of the nearest samplers, every curve labelled with its name
/// and ℓ∞.
pub(super) fn draw(canvas: &mut Canvas, area: Area, figure: &MosaicFigure) {
    let Some(mosaic) = figure.pcf.filter(|curve| finite(*curve).next().is_some()) else {
        let sentence = match figure.points.len() {
            0 => "No pair correlation function: the mosaic has no points.",
            1 => "No pair correlation function: the mosaic has a single point.",
            _ => "The pair correlation function was not computed.",
        };
        canvas.sentence(area, sentence);
        return;
    };
    let lines = lines(figure, mosaic);
    let x = (0., axis_end(finite(mosaic).map(|p| p.0).fold(0., f64::max)));
    // The curve of a sampler has spikes if there are few points or r extends beyond the window;
    // they must not flatten the curve of the mosaic.
    let tallest = finite(mosaic).map(|p| p.1).fold(SPIKE_FLOOR, f64::max) * SPIKE_FACTOR;
    let peak_of = |line: &Line| line.peak(x.0, x.1, tallest);
    let peak = lines.iter().filter_map(peak_of).map(|p| p.1).fold(1., f64::max);

    let texts = |place: &dyn Fn(f64, f64) -> (f64, f64), beside: f64| -> Vec<Label> {
        lines
            .iter()
            .filter_map(|line| {
                let (r, g) = peak_of(line)?;
                let target = if g < FLAT { line.peak(beside - 0.1, beside, tallest)? } else { (r, g) };
                Some(Label {
                    text: line.text(),
                    target: place(target.0, target.1),
                    colour: line.colour,
                    dark: line.dark,
                })
            })
            .collect()
    };
    // Labels begin right of all peaks, but far enough left to end within the plot.
    let wide = labels::width(&texts(&|r, g| (r, g), x.1)) / area.width * x.1;
    let peaks = lines.iter().filter_map(peak_of).filter(|p| p.1 >= FLAT).map(|p| p.0).fold(0.7, f64::max);
    let beside = (peaks + BESIDE_PEAK).min(x.1 - wide).max(0.1);
    let under = lines.iter().filter_map(|l| l.peak(beside, beside + wide, tallest));
    let under = under.map(|p| p.1).fold(1., f64::max);
    let y_max = headroom(peak, under, labels::height(lines.len()), area.height);

    let place = canvas.axes(
        area,
        Ranges { x, y: (0., y_max) },
        ("r / hexagonal spacing", "g(r)"),
        round_above(y_max / 5.),
    );
    canvas.line(place(x.0, 1.), place(x.1, 1.), FRAME, 0.6);
    for line in &lines {
        for run in runs(line.curve, x.1, y_max) {
            let points = run.iter().map(|p| place(p.0, p.1)).collect();
            canvas.polyline(points, line.colour, line.width, None);
        }
    }
    let (left, floor) = place(beside, under);
    labels::draw(canvas, area, left, floor, texts(&place, beside));
}

/// Returns the points of a curve whose distance and value are both finite.
fn finite(curve: Curve<'_>) -> impl Iterator<Item = (f64, f64)> {
    curve.r.iter().copied().zip(curve.g.iter().copied()).filter(|p| p.0.is_finite() && p.1.is_finite())
}

/// Returns the end of the r axis: the next multiple of half a spacing if that is within 3 %, else
/// `r_max`.
///
/// Bins are named by their left edges, so that the last bin usually stands just before a tick.
pub(super) fn axis_end(r_max: f64) -> f64 {
    let tick = (r_max * 2.).ceil() / 2.;
    if tick - r_max < 0.03 * r_max { tick } else { r_max }
}

/// Returns the stretches of a curve up to `r_max`, split at gaps and cut where they leave
/// 0..`g_max`.
pub(super) fn runs(curve: Curve, r_max: f64, g_max: f64) -> Vec<Vec<(f64, f64)>> {
    let mut runs = vec![vec![]];
    let points: Vec<_> = curve.r.iter().copied().zip(curve.g.iter().copied()).collect();
    for pair in points.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let drawn = [from.0, from.1, to.0, to.1].iter().all(|v| v.is_finite()) && to.0 <= r_max;
        let inside = if drawn { cut(from, to, g_max) } else { None };
        if let (Some((start, end)), Some(run)) = (inside, runs.last_mut()) {
            if run.is_empty() {
                run.push(start);
            }
            run.push(end);
            if end == to {
                continue;
            }
        }
        runs.push(vec![]);
    }
    runs.retain(|run| run.len() > 1);
    runs
}

/// Returns the part of a segment that lies in 0 ≤ g ≤ `g_max`, if any.
fn cut(from: (f64, f64), to: (f64, f64), g_max: f64) -> Option<((f64, f64), (f64, f64))> {
    let at = |g: f64| (from.0 + (to.0 - from.0) * (g - from.1) / (to.1 - from.1), g);
    let end =
        |this: (f64, f64)| if (0. ..=g_max).contains(&this.1) { this } else { at(this.1.clamp(0., g_max)) };
    let outside = from.1.max(to.1) < 0. || from.1.min(to.1) > g_max;
    (!outside).then(|| (end(from), end(to)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Window;
    use crate::mosaic::LengthUnit;
    use std::collections::HashSet;

    #[test]
    fn eighteen_samplers_look_different() {
        assert_eq!((0..18).map(style).collect::<HashSet<_>>().len(), 18);
    }

    #[test]
    fn the_three_nearest_samplers_are_drawn_and_independent_points_in_grey() {
        let r = [0.5, 1., 1.5];
        let curve = Curve { r: &r, g: &[0., 2., 1.] };
        let reference = |name, l_infinity| ReferenceLine { name, r: &r, g: &[0., 1.5, 1.], l_infinity };
        let references = [
            reference("pink", Some(3.)),
            reference("bnot", Some(0.2)),
            reference("uniform", Some(0.9)),
            reference("jittered", None),
            reference("bridson", Some(0.1)),
            reference("triangular", Some(0.4)),
        ];
        let window = Window::unit_square();
        let drawn = lines(&MosaicFigure { references: &references, ..empty(&window) }, curve);
        let shown: Vec<_> = drawn.iter().map(|l| (l.text(), l.colour)).collect();
        let expected = [
            ("uniform, ℓ∞ 0.90", GREY),
            ("bridson, ℓ∞ 0.10", COLOURS[3]),
            ("bnot, ℓ∞ 0.20", COLOURS[1]),
            ("triangular, ℓ∞ 0.40", COLOURS[4]),
            ("mosaic", INK),
        ];
        assert_eq!(shown, expected.map(|(text, colour)| (text.to_owned(), colour)));
    }

    fn empty(window: &Window) -> MosaicFigure<'_> {
        MosaicFigure {
            title: "",
            picture: None,
            points: &[],
            window,
            unit: LengthUnit::Unit,
            um_per_unit: None,
            nn: &[],
            nn_mean: None,
            nn_sd: None,
            ri: None,
            histogram_edges: &[],
            histogram_counts: &[],
            pcf: None,
            references: &[],
        }
    }

    #[test]
    fn axis_ends_on_a_tick_that_is_near() {
        assert_eq!([2.488, 2.5, 2.3].map(axis_end), [2.5, 2.5, 2.3]);
    }

    #[test]
    fn gaps_split_a_curve() {
        let r = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6];
        let g = [1., 2., f64::NAN, 3., 4., 5.];
        let lengths: Vec<_> = runs(Curve { r: &r, g: &g }, 0.55, 9.).iter().map(Vec::len).collect();
        assert_eq!(lengths, [2, 2]);
    }

    #[test]
    fn curves_are_cut_where_they_leave_the_axes() {
        let r = [0., 1., 2., 3.];
        let runs = runs(Curve { r: &r, g: &[1., -1., 1., 9.] }, 3., 5.);
        assert_eq!(runs, [vec![(0., 1.), (0.5, 0.)], vec![(1.5, 0.), (2., 1.), (2.5, 5.)]]);
    }
}
