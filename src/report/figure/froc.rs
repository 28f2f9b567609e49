use super::canvas::{Anchor, Area, Canvas, INK, Ranges, Style, round_above};
use super::panels::{two_areas, two_panels};
use crate::compare::{Froc, FrocPoint, Summary};
use crate::report::significant;

/// Description of the figure for screen readers.
const DESCRIPTION: &str = "Left: FROC curve, sensitivity against false alarms per image, as the threshold of the score falls. \
    Right: precision against sensitivity. The dot marks the threshold with the highest mean Dice (F1), the cross the detections \
    as given.";

/// Colours of the curves (Okabe & Ito 2008).
const COLOURS: [&str; 2] = ["#0072B2", "#D55E00"];
/// Dashes of the curves, which tell them apart in grey as well.
const DASHES: [Option<&str>; 2] = [None, Some("5 1.6")];
/// Distance between two lines of the legend, in canvas units.
const LINE: f64 = 11.;
/// Length of the sample of a line in the legend, in canvas units.
const SWATCH: f64 = 15.;
/// Half the width of a cross, in canvas units.
const CROSS: f64 = 3.2;
/// Extent of the axes, as a multiple of the false alarms at the dot, and of what its rates lack to
/// 1.
///
/// The dot is the threshold with the highest mean Dice. An axis of a rate ends at 1; the axis of
/// false alarms begins at 0.
const SHOWN: f64 = 4.;
/// Smallest extent of an axis of a rate, so that a nearly perfect detector still has a readable
/// axis.
const LEAST_SHOWN: f64 = 0.02;
/// Largest number of corners of a drawn curve; nobody sees more.
const CORNERS: usize = 600;

/// The curve of one detector.
#[derive(Clone, Copy, Debug)]
pub struct FrocLine<'a> {
    /// Name of the detector, for the legend.
    pub name: &'a str,
    /// FROC curve of the detector.
    pub froc: &'a Froc,
    /// Scores of the detections themselves, without a change of the threshold; they are drawn as a
    /// cross.
    pub given: &'a Summary,
}

/// Draws the FROC curve (Bunch et al. 1978) and the precision–recall curve of one detector or two.
///
/// The figure is a self-contained SVG, 180 mm wide. The axes show the part around the threshold of
/// the highest mean Dice.
pub fn froc_figure(title: &str, lines: &[FrocLine]) -> String {
    let mut canvas = two_panels(title);
    let [left, right] = two_areas();
    let best = || lines.iter().filter_map(|l| l.froc.points.get(l.froc.best));
    let most = |value: fn(&FrocPoint) -> f64| best().map(value).fold(0., f64::max);
    let sensitivity = shown(most(|p| 1. - p.sensitivity));
    let precision = shown(most(|p| 1. - p.precision));
    let all = lines.iter().filter_map(|l| l.froc.points.last()).map(|p| 1.1 * p.false_alarms_per_image);
    let all = all.fold(0., f64::max);
    let alarms = match SHOWN * most(|p| p.false_alarms_per_image) {
        some if some > 0. => some.min(all),
        _ if all > 0. => all,
        _ => 1.,
    };

    let curve = |x: Value, y: Value| Plot { lines, x, y };
    let labels = ("false alarms per image", "sensitivity");
    let froc = curve(ALARMS, SENSITIVITY);
    froc.draw(&mut canvas, left, Ranges { x: (0., alarms), y: (sensitivity, 1.) }, labels);
    let labels = ("sensitivity (recall)", "precision (1 − FDR)");
    let recall = curve(SENSITIVITY, PRECISION);
    recall.draw(&mut canvas, right, Ranges { x: (sensitivity, 1.), y: (precision, 1.) }, labels);
    legend(&mut canvas, right, lines);
    canvas.into_svg(title, DESCRIPTION)
}

/// Returns the lower end of the axis of a rate, `missing` being 1 − rate at the dot.
fn shown(missing: f64) -> f64 {
    let span = (SHOWN * missing).clamp(LEAST_SHOWN, 1.);
    let step = round_above(span / 5.);
    1. - ((span / step).ceil() * step).min(1.)
}

/// Quantity along an axis.
///
/// `of` takes it at a threshold of the score; `given` takes it from the scores of the detections
/// themselves, without a change of the threshold.
#[derive(Clone, Copy)]
struct Value {
    of: fn(&FrocPoint) -> f64,
    given: fn(&Summary) -> f64,
}

/// False alarms per image, the x axis of the FROC curve.
const ALARMS: Value =
    Value { of: |p| p.false_alarms_per_image, given: |s| s.pooled.fp as f64 / s.images as f64 };
/// Sensitivity, which is also called recall.
const SENSITIVITY: Value = Value { of: |p| p.sensitivity, given: |s| s.pooled.sensitivity };
/// Precision, 1 − false discovery rate.
const PRECISION: Value = Value { of: |p| p.precision, given: |s| s.pooled.precision };

struct Plot<'a> {
    lines: &'a [FrocLine<'a>],
    x: Value,
    y: Value,
}

impl Plot<'_> {
    /// Draws the curve, the dot and the cross of every detector on common axes.
    fn draw(&self, canvas: &mut Canvas, area: Area, ranges: Ranges, labels: (&str, &str)) {
        let place = canvas.axes(area, ranges, labels, round_above((ranges.y.1 - ranges.y.0) / 5.));
        let inside = |p: &(f64, f64)| {
            (ranges.x.0..=ranges.x.1).contains(&p.0) && (ranges.y.0..=ranges.y.1).contains(&p.1)
        };
        for (k, line) in self.lines.iter().enumerate() {
            let (colour, dash) = (COLOURS[k % COLOURS.len()], DASHES[k % DASHES.len()]);
            let at = |p: &FrocPoint| ((self.x.of)(p), (self.y.of)(p));
            let shown: Vec<_> = line.froc.points.iter().map(at).filter(inside).collect();
            let step = shown.len().div_ceil(CORNERS).max(1);
            let corners = shown.iter().enumerate().filter(|(i, _)| i % step == 0 || i + 1 == shown.len());
            canvas.polyline(corners.map(|(_, p)| place(p.0, p.1)).collect(), colour, 1.6, dash);
            if let Some(best) = line.froc.points.get(line.froc.best).map(at).filter(inside) {
                canvas.coloured_dots(&[place(best.0, best.1)], 3.4, colour, None);
            }
            let given = ((self.x.given)(line.given), (self.y.given)(line.given));
            if inside(&given) {
                cross(canvas, place(given.0, given.1));
            }
        }
    }
}

fn cross(canvas: &mut Canvas, (x, y): (f64, f64)) {
    for tilt in [-CROSS, CROSS] {
        canvas.line((x - CROSS, y - tilt), (x + CROSS, y + tilt), INK, 1.2);
    }
}

/// Draws the legend at the lower left of precision over sensitivity, where no good curve passes.
fn legend(canvas: &mut Canvas, area: Area, lines: &[FrocLine]) {
    let words = |line: &FrocLine| {
        let best = line.froc.points.get(line.froc.best)?;
        let text = format!("Dice {:.4} at score ≥ {}", best.mean_dice, significant(best.threshold, 3));
        Some(if line.name.is_empty() { text } else { format!("{}: {text}", line.name) })
    };
    let texts: Vec<String> = lines.iter().filter_map(words).collect();
    let start = area.x + 6.;
    for (k, text) in texts.iter().enumerate() {
        let y = area.bottom() - 7. - (texts.len() - k) as f64 * LINE;
        let colour = COLOURS.get(k).copied().unwrap_or(INK);
        let ends = vec![(start, y - 3.), (start + SWATCH, y - 3.)];
        canvas.polyline(ends, colour, 1.6, DASHES[k % DASHES.len()]);
        canvas.coloured_dots(&[(start + SWATCH / 2., y - 3.)], 3., colour, None);
        canvas.text(start + SWATCH + 4., y, text, Style::Note, Anchor::Start);
    }
    let y = area.bottom() - 7.;
    cross(canvas, (start + SWATCH / 2., y - 3.));
    canvas.text(start + SWATCH + 4., y, "detections as given", Style::Note, Anchor::Start);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_of_rates_begin_on_a_tick_and_show_what_is_missing() {
        for (missing, from) in [(0.01, 0.96), (0.03, 0.85), (0.5, 0.), (0., 0.98)] {
            assert!((shown(missing) - from).abs() < 1e-9, "{missing}: {}", shown(missing));
        }
    }
}
