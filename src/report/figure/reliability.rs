use super::canvas::{Anchor, Area, Canvas, FRAME, Ranges, Style, round_above};
use super::panels::{two_areas, two_panels};
use crate::compare::{Reliability, ReliabilityBin};
use crate::report::significant;

/// Description of the figure for screen readers.
const DESCRIPTION: &str = "Left: share of the detections that are hits in each bin of the score, with its 95 % interval. On the \
    diagonal the score equals the probability of a hit. Bars show the number of detections in each bin. Right: observed false \
    alarms against those expected from the scores, one dot per image.";

/// Colour of the bars, a light grey behind lines and dots.
const BARS: &str = "#d9d9d9";
/// Colour of the dots (blue of Okabe & Ito 2008).
const DOTS: &str = "#0072B2";
/// Opacity of the dots of images, chosen by eye so that overlapping dots show as darker.
const DOT_OPACITY: f64 = 0.45;
/// Height of the highest bar, as a share of the height of the plot.
const BAR_HEIGHT: f64 = 0.3;

/// The content of the figure of reliability.
#[derive(Clone, Copy, Debug)]
pub struct ReliabilityFigure<'a> {
    /// Title above the panels.
    pub title: &'a str,
    /// Reliability of the scores, bin by bin.
    pub reliability: &'a Reliability,
    /// Numbers of false alarms of every image: expected, then observed.
    pub alarms: &'a [(f64, f64)],
}

/// Draws the reliability diagram and the expected against the observed false alarms.
///
/// The figure is a self-contained SVG, 180 mm wide. Source of the diagram: DeGroot and Fienberg
/// (1983), <https://doi.org/10.2307/2987588>.
pub fn reliability_figure(figure: &ReliabilityFigure) -> String {
    let mut canvas = two_panels(figure.title);
    let [left, right] = two_areas();
    diagram(&mut canvas, left, figure.reliability);
    alarms(&mut canvas, right, figure.alarms);
    canvas.into_svg(figure.title, DESCRIPTION)
}

/// Draws the share of hits against the score, bin by bin.
fn diagram(canvas: &mut Canvas, area: Area, reliability: &Reliability) {
    let unit = (0., 1.);
    let place =
        canvas.axes(area, Ranges { x: unit, y: unit }, ("score", "share of detections that are hits"), 0.2);
    let most = reliability.bins.iter().map(|b| b.n).max().unwrap_or(0).max(1);
    for bin in reliability.bins.iter().filter(|b| b.n > 0) {
        let height = BAR_HEIGHT * bin.n as f64 / most as f64;
        let ((left, top), (right, bottom)) = (place(bin.from, height), place(bin.to, 0.));
        canvas.bar(Area { x: left, y: top, width: right - left, height: bottom - top }, BARS);
    }
    canvas.polyline(vec![place(0., 0.), place(1., 1.)], FRAME, 0.8, Some("4 3"));
    for bin in &reliability.bins {
        if let (Some(score), Some(hits), Some([low, high])) = (bin.mean_score, bin.hits, bin.hits_interval) {
            canvas.line(place(score, low), place(score, high), DOTS, 1.2);
            canvas.coloured_dots(&[place(score, hits)], 3., DOTS, None);
        }
    }
    let notes = [
        format!("calibration error {}", significant(reliability.expected_calibration_error, 2)),
        format!("Brier score {}", significant(reliability.brier, 2)),
        format!("largest bar: {most} of {} detections", reliability.n),
    ];
    // Where scores are too low, dots stand above the diagonal, and the notes go below it, over the
    // bars. A surplus of hits above 5 % of the detections counts as such.
    let gap = |b: &ReliabilityBin| Some(b.n as f64 * (b.hits? - b.mean_score?));
    let above = reliability.bins.iter().filter_map(gap).sum::<f64>() > 0.05 * reliability.n as f64;
    let (x, y, anchor) = if above {
        (area.right() - 6., area.y + 0.52 * area.height, Anchor::End)
    } else {
        (area.x + 6., area.y + 9., Anchor::Start)
    };
    for (k, note) in notes.iter().enumerate() {
        canvas.text(x, y + 11. * k as f64, note, Style::Note, anchor);
    }
}

/// Draws the observed against the expected false alarms, one dot per image.
fn alarms(canvas: &mut Canvas, area: Area, alarms: &[(f64, f64)]) {
    let most = alarms.iter().flat_map(|a| [a.0, a.1]).filter(|v| v.is_finite()).fold(1., f64::max) * 1.06;
    let ranges = Ranges { x: (0., most), y: (0., most) };
    let labels = ("expected false alarms, Σ (1 − score)", "observed false alarms");
    let place = canvas.axes(area, ranges, labels, round_above((most / 5.).max(1.)));
    canvas.polyline(vec![place(0., 0.), place(most, most)], FRAME, 0.8, Some("4 3"));
    let finite = alarms.iter().filter(|a| a.0.is_finite() && a.1.is_finite());
    let centres: Vec<_> = finite.map(|a| place(a.0, a.1)).collect();
    canvas.coloured_dots(&centres, 2.2, DOTS, Some(DOT_OPACITY));
    let n = alarms.len().max(1) as f64;
    let mean = |value: fn(&(f64, f64)) -> f64| significant(alarms.iter().map(value).sum::<f64>() / n, 3);
    let note = format!("mean per image: {} expected, {} observed", mean(|a| a.0), mean(|a| a.1));
    canvas.text(area.x + 6., area.y + 9., &note, Style::Note, Anchor::Start);
}
