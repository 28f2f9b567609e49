use super::canvas::{Anchor, Area, Canvas, FRAME, INK, Ranges, Style, headroom, round_above, text_width};
use super::{Curve, MosaicFigure};

/// Okabe & Ito (2008), told apart by colour-blind readers; black is the mosaic's, their yellow is too pale for a line.
const COLOURS: [&str; 6] = ["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#56B4E9", "#D55E00"];
/// Dashes tell lines apart in grey, and beyond the sixth where colours repeat.
const DASHES: [Option<&str>; 3] = [None, Some("5 1.6"), Some("1.6 1.2")];
const SAMPLER_WIDTH: f64 = 1.1;
const MOSAIC_WIDTH: f64 = 2.2;
/// No sampler stretches the axis beyond this multiple of the mosaic's highest value, or of the floor if that is lower.
const SPIKE_FACTOR: f64 = 1.5;
const SPIKE_FLOOR: f64 = 3.;
const LINE: f64 = 11.;
const SWATCH: f64 = 15.;

pub(super) fn style(index: usize) -> (&'static str, Option<&'static str>) {
    (COLOURS[index % COLOURS.len()], DASHES[(index + index / COLOURS.len()) % DASHES.len()])
}

/// A line of the legend, from left to right.
struct Entry<'a> {
    name: &'a str,
    value: String,
}

/// The mosaic's PCF over the samplers', with the l-infinity to each.
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
    let references: Vec<Curve> = figure.references.iter().map(|l| Curve { r: l.r, g: l.g }).collect();
    let curves = || references.iter().copied().chain([mosaic]);
    let x = (0., axis_end(finite(mosaic).map(|p| p.0).fold(0., f64::max)));
    // A sampler's spike (few points, r beyond the window) may not flatten the mosaic's own curve.
    let tallest = finite(mosaic).map(|p| p.1).fold(SPIKE_FLOOR, f64::max) * SPIKE_FACTOR;
    let highest = |from: f64, to: f64| {
        let within = curves().flat_map(finite).filter(|p| p.0 >= from && p.0 <= to);
        within.map(|p| p.1).fold(1., f64::max).min(tallest)
    };

    let with_distances = figure.references.iter().any(|l| l.l_infinity.is_some());
    let head = Entry { name: "mosaic", value: if with_distances { "ℓ∞" } else { "" }.to_owned() };
    let samplers = figure
        .references
        .iter()
        .map(|l| Entry { name: l.name, value: l.l_infinity.map_or_else(String::new, |d| format!("{d:.2}")) });
    let entries: Vec<Entry> = [head].into_iter().chain(samplers).collect();
    let width_of = |text: &str| text_width(text, Style::Note);
    let names = entries.iter().map(|e| width_of(e.name)).fold(0., f64::max);
    let values = entries.iter().map(|e| width_of(&e.value)).fold(0., f64::max);
    let width = SWATCH + 4. + names + if with_distances { 6. + values } else { 0. };
    let height = entries.len() as f64 * LINE + 3.;
    let covered = (width + 5.) / area.width * x.1;
    let peak = highest(0., x.1);
    let top = |under: f64| headroom(peak, under, height, area.height);
    let (left, right) = (top(highest(0., covered)), top(highest(x.1 - covered, x.1)));
    let y_max = left.min(right);

    let place = canvas.axes(
        area,
        Ranges { x, y: (0., y_max) },
        ("r / hexagonal spacing", "g(r)"),
        round_above(y_max / 5.),
    );
    canvas.line(place(x.0, 1.), place(x.1, 1.), FRAME, 0.6);
    for (index, curve) in references.iter().enumerate() {
        let (colour, dash) = style(index);
        for run in runs(*curve, x.1, y_max) {
            canvas.polyline(run.iter().map(|p| place(p.0, p.1)).collect(), colour, SAMPLER_WIDTH, dash);
        }
    }
    for run in runs(mosaic, x.1, y_max) {
        canvas.polyline(run.iter().map(|p| place(p.0, p.1)).collect(), INK, MOSAIC_WIDTH, None);
    }

    let start = if right <= left { area.right() - width } else { area.x + 5. };
    for (i, entry) in entries.iter().enumerate() {
        let y = area.y + 7. + i as f64 * LINE;
        let (colour, dash, thickness) = match i.checked_sub(1) {
            None => (INK, None, MOSAIC_WIDTH),
            Some(index) => (style(index).0, style(index).1, SAMPLER_WIDTH + 0.3),
        };
        canvas.polyline(vec![(start, y - 3.), (start + SWATCH, y - 3.)], colour, thickness, dash);
        canvas.text(start + SWATCH + 4., y, entry.name, Style::Note, Anchor::Start);
        canvas.text(start + width, y, &entry.value, Style::Note, Anchor::End);
    }
}

fn finite(curve: Curve<'_>) -> impl Iterator<Item = (f64, f64)> {
    curve.r.iter().copied().zip(curve.g.iter().copied()).filter(|p| p.0.is_finite() && p.1.is_finite())
}

/// Up to the next half spacing where that is near: bins named by their left edges end a hair before a tick.
pub(super) fn axis_end(r_max: f64) -> f64 {
    let tick = (r_max * 2.).ceil() / 2.;
    if tick - r_max < 0.03 * r_max { tick } else { r_max }
}

/// The stretches of a curve without gaps, up to `r_max` and cut where they leave 0..`g_max`.
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

/// The part of a segment that lies in 0 ≤ g ≤ `g_max`.
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
    use std::collections::HashSet;

    #[test]
    fn eighteen_samplers_look_different() {
        assert_eq!((0..18).map(style).collect::<HashSet<_>>().len(), 18);
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
