//! Labels of curves, placed beside a plot so that they never overlap.
//!
//! 1. Labels are sorted by the height of the point that they name.
//! 2. From the lowest up, each goes to its own height, or one line above the label below it.
//! 3. Labels that would leave the plot at the top are pushed down again.

use super::canvas::{Anchor, Area, Canvas, Style, text_width};

/// Distance between the baselines of two labels, in canvas units.
const LINE: f64 = 11.;
/// Height of the middle of a text above its baseline, in canvas units.
const MIDDLE: f64 = 3.;
/// Room above the baseline of the uppermost text, in canvas units.
const ASCENT: f64 = 8.;
/// Room below the baseline of the lowest text, in canvas units.
const DESCENT: f64 = 5.;
/// Gap between a leader and its text, in canvas units.
const GAP: f64 = 3.;

/// Name of a curve, and the point of the curve to which a leader (a thin line) leads.
pub(super) struct Label<'a> {
    /// Text of the label.
    pub text: String,
    /// Point on the page from which a leader goes to the text.
    pub target: (f64, f64),
    /// Colour of the leader: that of the curve.
    pub colour: &'a str,
    /// Colour of the text.
    pub dark: &'a str,
}

/// Returns the width of the widest text, with the gap to its leader.
pub(super) fn width(labels: &[Label]) -> f64 {
    labels.iter().map(|l| text_width(&l.text, Style::Note)).fold(0., f64::max) + GAP
}

/// Returns the height of `count` labels, in canvas units.
pub(super) fn height(count: usize) -> f64 {
    if count == 0 { 0. } else { (count - 1) as f64 * LINE + ASCENT + DESCENT }
}

/// Draws every label at the height of its target where possible, and above `floor`, a y coordinate
/// of the page, if there is room.
///
/// Labels keep their order from top to bottom and never overlap. Texts begin at `left`.
pub(super) fn draw(canvas: &mut Canvas, area: Area, left: f64, floor: f64, mut labels: Vec<Label>) {
    labels.sort_by(|a, b| a.target.1.total_cmp(&b.target.1));
    let wanted: Vec<f64> = labels.iter().map(|l| l.target.1 + MIDDLE).collect();
    for (label, baseline) in labels.iter().zip(spread(&wanted, area.y + ASCENT, floor - DESCENT)) {
        let end = (left - GAP / 2., baseline - MIDDLE);
        canvas.line(label.target, end, label.colour, 0.6);
        canvas.coloured_text(left + GAP / 2., baseline, &label.text, Style::Note, Anchor::Start, label.dark);
    }
}

/// Returns baselines at least a line apart, as near to the rising ones `wanted` as `top` and
/// `bottom` allow.
///
/// With too little room they begin at `top` and go beyond `bottom`.
fn spread(wanted: &[f64], top: f64, bottom: f64) -> Vec<f64> {
    let mut below = bottom + LINE;
    let mut baselines: Vec<f64> = wanted
        .iter()
        .rev()
        .map(|&y| {
            below = y.min(below - LINE);
            below
        })
        .collect();
    baselines.reverse();
    // Labels that would leave the plot at the top are pushed down again.
    let mut above = top - LINE;
    for y in &mut baselines {
        *y = y.max(above + LINE);
        above = *y;
    }
    baselines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_never_overlap_and_stay_where_they_can() {
        assert_eq!(spread(&[20., 60.], 8., 100.), [20., 60.]);
        assert_eq!(spread(&[20., 22., 95.], 8., 100.), [11., 22., 95.]);
        assert_eq!(spread(&[90., 95., 99.], 8., 80.), [58., 69., 80.]);
        // With too little room they stand below each other from the top.
        assert_eq!(spread(&[5., 6., 7.], 8., 10.), [8., 19., 30.]);
    }

    #[test]
    fn room_is_counted_in_lines() {
        assert_eq!((height(0), height(1), height(3)), (0., 13., 35.));
    }
}
