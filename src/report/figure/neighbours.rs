use super::canvas::{Anchor, Area, Canvas, Ranges, Style, headroom, round_above, text_width};
use super::{MosaicFigure, shown_unit, with_unit};
use crate::report::significant;

/// Colour of the bars of the histogram, a grey behind the Gaussian.
const BARS: &str = "#b8b8b8";
/// Colour of the Gaussian (vermilion of Okabe & Ito 2008).
const GAUSSIAN: &str = "#D55E00";
/// Number of standard deviations to which the Gaussian is drawn, on either side of the mean;
/// farther out its height is below 1 % of the peak.
const REACH: f64 = 3.2;
/// Number of straight segments that make up the curve of the Gaussian.
const CORNERS: usize = 120;
/// Distance between two lines of the notes, in canvas units.
const LINE: f64 = 11.;

/// Gaussian density N(mean, sd), scaled to the area of the histogram.
struct Gaussian {
    mean: f64,
    sd: f64,
    /// Area of the histogram: number of points × width of a bin.
    scale: f64,
}

impl Gaussian {
    /// Returns the height of the curve at distance `x`.
    fn at(&self, x: f64) -> f64 {
        let z = (x - self.mean) / self.sd;
        self.scale / (self.sd * (2. * std::f64::consts::PI).sqrt()) * (-z * z / 2.).exp()
    }
}

/// Draws the histogram of nearest-neighbour distances and the Gaussian of the same mean and
/// standard deviation.
pub(super) fn draw(canvas: &mut Canvas, area: Area, figure: &MosaicFigure) {
    let n = figure.points.len();
    let (&[first, .., last], false) = (figure.histogram_edges, figure.nn.is_empty()) else {
        let sentence = match n {
            0 => "No nearest-neighbour distances: the mosaic has no points.",
            1 => "No nearest-neighbour distances: the mosaic has a single point.",
            _ => "Nearest-neighbour distances were not measured.",
        };
        canvas.sentence(area, sentence);
        return;
    };
    let (factor, unit) = shown_unit(figure.um_per_unit, figure.unit);
    let edges: Vec<f64> = figure.histogram_edges.iter().map(|e| e * factor).collect();
    let counts: Vec<f64> = figure.histogram_counts.iter().map(|&c| c as f64).collect();
    let (mean, sd) = (figure.nn_mean.map(|m| m * factor), figure.nn_sd.map(|s| s * factor));
    let gaussian = match (mean, sd) {
        (Some(mean), Some(sd)) if mean.is_finite() && sd.is_finite() && sd > 0. => {
            let bin = (last - first) * factor / counts.len() as f64;
            Some(Gaussian { mean, sd, scale: figure.nn.len() as f64 * bin })
        }
        _ => None,
    };
    let mut x = (first * factor, last * factor);
    if let Some(g) = &gaussian {
        x = (x.0.min((g.mean - REACH * g.sd).max(0.)), x.1.max(g.mean + REACH * g.sd));
    }
    let number = |label: &str, value: Option<f64>, unit: &str| {
        value.map(|v| format!("{label} = {}", with_unit(&significant(v, 3), unit)))
    };
    let notes: Vec<String> = [
        number("RI", figure.ri, ""),
        number("mean", mean, unit),
        number("SD", sd, unit),
        Some(format!("n = {n}")),
    ]
    .into_iter()
    .flatten()
    .collect();

    // The notes stand on the side where the bars are lower; the axis then leaves them room.
    let notes_width = notes.iter().map(|note| text_width(note, Style::Note)).fold(0., f64::max);
    let notes_height = notes.len() as f64 * LINE + 4.;
    let covered = (notes_width + 12.) / area.width * (x.1 - x.0);
    let highest = |from: f64, to: f64| {
        let bars = edges.windows(2).zip(&counts).filter(|(e, _)| e[1] > from && e[0] < to).map(|(_, &c)| c);
        let curve = gaussian.iter().map(|g| g.at(g.mean.clamp(from, to)));
        bars.chain(curve).fold(0., f64::max)
    };
    let peak = highest(x.0, x.1).max(1.);
    let top = |under: f64| headroom(peak, under, notes_height, area.height);
    let (left, right) = (top(highest(x.0, x.0 + covered)), top(highest(x.1 - covered, x.1)));
    let y_max = left.min(right);

    let label = if unit.is_empty() {
        "nearest neighbour distance".to_owned()
    } else {
        format!("nearest neighbour ({unit})")
    };
    // Counts are whole numbers, so a step between ticks below 1 would be pointless.
    let step = round_above((y_max / 4.).max(1.));
    let place = canvas.axes(area, Ranges { x, y: (0., y_max) }, (&label, "cones"), step);
    for (edge, &count) in edges.windows(2).zip(&counts).filter(|(_, c)| **c > 0.) {
        let ((left, top), (right, bottom)) = (place(edge[0], count), place(edge[1], 0.));
        canvas.bar(Area { x: left, y: top, width: right - left, height: bottom - top }, BARS);
    }
    if let Some(g) = &gaussian {
        let (from, to) = ((g.mean - REACH * g.sd).max(x.0), (g.mean + REACH * g.sd).min(x.1));
        let corner = |i: usize| from + (to - from) * i as f64 / CORNERS as f64;
        let curve = (0..=CORNERS).map(|i| place(corner(i), g.at(corner(i)))).collect();
        canvas.polyline(curve, GAUSSIAN, 1.4, None);
    }
    let start = if left <= right { area.x + 6. } else { area.right() - notes_width };
    for (i, note) in notes.iter().enumerate() {
        canvas.text(start, area.y + 7. + i as f64 * LINE, note, Style::Note, Anchor::Start);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaussian_has_the_area_of_the_histogram() {
        let g = Gaussian { mean: 8., sd: 1., scale: 281. * 0.25 };
        let area: f64 = (0..4000).map(|i| g.at(f64::from(i) * 0.004) * 0.004).sum();
        assert!((area - 281. * 0.25).abs() < 1e-6, "{area}");
    }
}
