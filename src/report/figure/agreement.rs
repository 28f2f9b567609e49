use super::canvas::{Anchor, Area, Canvas, FRAME, INK, Ranges, Style, round_above};
use super::panels::{two_areas, two_panels};
use crate::compare::Interval;
use crate::report::significant;

/// Description of the figure for screen readers.
const DESCRIPTION: &str = "Bland–Altman plots: the difference of two measurements of each image against their mean. The solid \
    line is the mean difference (bias), the dashed lines are the 95 % limits of agreement, and the bands are the 95 % \
    confidence intervals of these lines.";

/// Colour of the dots, one per image (blue of Okabe & Ito 2008).
const DOTS: &str = "#0072B2";
/// Colour of the limits of agreement (vermilion of Okabe & Ito 2008).
const LIMITS: &str = "#D55E00";
/// Opacity of the bands of confidence intervals, chosen by eye so that dots show through.
const BAND_OPACITY: f64 = 0.15;
/// Opacity of the dots, chosen by eye so that overlapping dots show as darker.
const DOT_OPACITY: f64 = 0.45;

/// A horizontal line of a Bland–Altman plot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AgreementLine {
    /// Position of the line along y.
    pub value: f64,
    /// 95 % confidence interval of the value.
    pub interval: Option<Interval>,
}

/// The content of one Bland–Altman plot.
#[derive(Clone, Copy, Debug)]
pub struct AgreementPanel<'a> {
    /// Label of the x axis, with its unit.
    pub mean_label: &'a str,
    /// Label of the y axis, with its unit.
    pub difference_label: &'a str,
    /// Mean of both measurements and their difference, for every image.
    pub pairs: &'a [(f64, f64)],
    /// Mean difference, the bias.
    pub bias: Option<AgreementLine>,
    /// Lower and upper limit of agreement.
    pub limits: Option<[AgreementLine; 2]>,
}

/// Draws one or two Bland–Altman plots side by side, as a self-contained SVG, 180 mm wide.
///
/// Source: Bland and Altman (1986), <https://doi.org/10.1016/S0140-6736(86)90837-8>.
pub fn agreement_figure(title: &str, panels: &[AgreementPanel]) -> String {
    let mut canvas = two_panels(title);
    for (panel, area) in panels.iter().zip(two_areas()) {
        draw(&mut canvas, area, panel);
    }
    canvas.into_svg(title, DESCRIPTION)
}

fn draw(canvas: &mut Canvas, area: Area, panel: &AgreementPanel) {
    let lines: Vec<AgreementLine> =
        panel.bias.into_iter().chain(panel.limits.into_iter().flatten()).collect();
    let pairs: Vec<(f64, f64)> =
        panel.pairs.iter().copied().filter(|p| p.0.is_finite() && p.1.is_finite()).collect();
    if pairs.is_empty() {
        canvas.sentence(area, "No image has both measurements.");
        return;
    }
    let ends = lines.iter().flat_map(|l| [Some(l.value), l.interval.map(|i| i[0]), l.interval.map(|i| i[1])]);
    let y = with_margin(pairs.iter().map(|p| p.1).chain(ends.flatten()).chain([0.]));
    let x = with_margin(pairs.iter().map(|p| p.0));
    // A quantity that is never negative needs no axis below 0.
    let x = if pairs.iter().all(|p| p.0 >= 0.) { (x.0.max(0.), x.1) } else { x };
    let step = round_above((y.1 - y.0) / 6.);
    let place = canvas.axes(area, Ranges { x, y }, (panel.mean_label, panel.difference_label), step);
    for (k, line) in lines.iter().enumerate() {
        let colour = if k == 0 { INK } else { LIMITS };
        if let Some([low, high]) = line.interval {
            let (top, bottom) = (place(x.0, high).1, place(x.0, low).1);
            let band = Area { x: area.x, y: top, width: area.width, height: bottom - top };
            canvas.band(band, colour, BAND_OPACITY);
        }
    }
    canvas.polyline(vec![place(x.0, 0.), place(x.1, 0.)], FRAME, 0.6, None);
    let centres: Vec<_> = pairs.iter().map(|p| place(p.0, p.1)).collect();
    canvas.coloured_dots(&centres, 2.2, DOTS, Some(DOT_OPACITY));
    for (k, line) in lines.iter().enumerate() {
        let (colour, dash) = if k == 0 { (INK, None) } else { (LIMITS, Some("5 2.5")) };
        let y = line.value;
        canvas.polyline(vec![place(x.0, y), place(x.1, y)], colour, 1.2, dash);
        let name = ["bias", "−1.96 SD", "+1.96 SD"].get(k).copied().unwrap_or_default();
        // The text goes below the lower limit and above the other lines, where it rarely meets
        // dots.
        let down = if k == 1 { 10. } else { -4. };
        let text = format!("{name} {}", signed(y));
        canvas.text(area.right() - 3., place(x.1, y).1 + down, &text, Style::Note, Anchor::End);
    }
}

/// Writes three significant digits with a sign, whose minus is as wide as the plus.
fn signed(value: f64) -> String {
    let number = significant(value.abs(), 3);
    if value < 0. { format!("−{number}") } else { format!("+{number}") }
}

/// Returns the smallest and the largest value, each moved outwards by a margin.
///
/// The margin is 12 % of the range. Without a range it is a tenth of the value, and at least 1.
fn with_margin(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    let margin = if high > low { 0.12 * (high - low) } else { (0.1 * low.abs()).max(1.) };
    (low - margin, high + margin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_hold_every_value_with_room_beyond() {
        let (low, high) = with_margin([3., -1., 2.].into_iter());
        assert!(low < -1. && high > 3.);
        assert_eq!(with_margin([5.].into_iter()), (4., 6.));
    }

    #[test]
    fn differences_are_signed() {
        assert_eq!([1.234, -0.5, 0.].map(signed), ["+1.23", "−0.500", "+0.00"]);
    }
}
