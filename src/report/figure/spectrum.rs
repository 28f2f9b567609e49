use super::canvas::{Anchor, Area, Canvas, FRAME, Ranges, Style, round_above};
use super::page::{LEFT_EDGE, TITLE_BASELINE};
use crate::report::picture::{Plane, PowerScale, plane, png};
use crate::report::{FigureFormat, ReportError, convert};
use crate::stats::PowerSpectrum;
use image::ExtendedColorType;

/// Title above the plane of the spectrum.
const TITLE: &str = "Power spectrum of the points (independent points have power 1 at every frequency)";
/// Description of the figure for screen readers.
const DESCRIPTION: &str = "The plane of the power spectrum of a point pattern, with frequency 0 in the middle; the lighter a \
    wave vector, the higher its power. x points to the right, y upwards.";

/// Upper left corner of the plane, in canvas units.
const CORNER: (f64, f64) = (64., 38.);
/// Side of the plane, in canvas units; it leaves room for the bar of grey values on the right.
const SIDE: f64 = 560.;
/// Room for tick labels and the axis title below the plane, in canvas units.
const AXIS_DEPTH: f64 = 36.;
/// Gap between the plane and the bar of grey values, in canvas units.
const BAR_GAP: f64 = 22.;
/// Width of the bar of grey values, in canvas units.
const BAR_WIDTH: f64 = 14.;
/// Number of grey values of the bar, one per row of pixels.
const STEPS: u32 = 128;

/// Draws the plane of a power spectrum with its axes and a bar of its grey values.
///
/// The figure is a self-contained SVG, 180 mm wide. Frequencies are in cycles per 1/√density.
///
/// # Errors
/// Fails if the picture cannot be encoded.
pub fn spectrum_figure(spectrum: &PowerSpectrum, scale: PowerScale) -> Result<String, ReportError> {
    let Plane { png, reach } = plane(spectrum, scale)?;
    let mut canvas = Canvas::new(CORNER.1 + SIDE + AXIS_DEPTH);
    canvas.text(LEFT_EDGE, TITLE_BASELINE, TITLE, Style::Title, Anchor::Start);
    let area = Area { x: CORNER.0, y: CORNER.1, width: SIDE, height: SIDE };
    canvas.picture(&png, area, area);
    let ranges = Ranges { x: (-reach[0], reach[0]), y: (-reach[1], reach[1]) };
    let labels = ["x", "y"].map(|axis| format!("frequency along {axis} (cycles per 1/√density)"));
    let _ = canvas.axes(area, ranges, (&labels[0], &labels[1]), round_above(reach[1] / 5.));
    canvas.frame(area);
    let x = area.right() + BAR_GAP;
    draw_bar(&mut canvas, Area { x, width: BAR_WIDTH, ..area }, scale)?;
    Ok(canvas.into_svg("Power spectrum", DESCRIPTION))
}

/// Draws the bar of grey values with the powers that they stand for.
fn draw_bar(canvas: &mut Canvas, bar: Area, scale: PowerScale) -> Result<(), ReportError> {
    let greys: Vec<u8> = (0..STEPS).rev().flat_map(|k| [(k * 255 / (STEPS - 1)) as u8; 2]).collect();
    canvas.picture(&png(&greys, 2, STEPS, ExtendedColorType::L8)?, bar, bar);
    canvas.frame(bar);
    let (name, ticks): (_, [&str; 4]) = match scale {
        PowerScale::Linear => ("power", ["0", "1", "2", "≥ 3"]),
        PowerScale::Decibel => ("power, dB", ["≤ −20", "−10", "0", "≥ 10"]),
    };
    for (k, tick) in ticks.into_iter().enumerate() {
        let y = bar.bottom() - bar.height * k as f64 / (ticks.len() - 1) as f64;
        canvas.line((bar.right(), y), (bar.right() + 3., y), FRAME, 0.7);
        canvas.text(bar.right() + 6., y + 3., tick, Style::Note, Anchor::Start);
    }
    canvas.text(bar.x, bar.y - 8., name, Style::Axis, Anchor::Start);
    Ok(())
}

/// Returns [`spectrum_figure`] as PNG, at 300 dpi.
///
/// # Errors
/// Fails if a picture cannot be encoded.
pub fn spectrum_png(spectrum: &PowerSpectrum, scale: PowerScale) -> Result<Vec<u8>, ReportError> {
    convert(&spectrum_figure(spectrum, scale)?, FigureFormat::Png)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point, Window};
    use crate::stats::{SpectrumOptions, spectrum};

    fn lattice() -> PowerSpectrum {
        let points: Vec<Point> =
            (0..400).map(|i| Point::new(f64::from(i % 20) + 0.5, f64::from(i / 20) + 0.5)).collect();
        let window = Window::rectangle(0., 0., 20., 20.).unwrap();
        spectrum(&points, &window, &SpectrumOptions { max_frequency: 2.5 }).unwrap()
    }

    #[test]
    fn axes_have_ticks_and_units_and_the_bar_its_numbers() {
        for (scale, ticks) in [
            (PowerScale::Linear, ["power", "≥ 3", "2"]),
            (PowerScale::Decibel, ["power, dB", "≤ −20", "≥ 10"]),
        ] {
            let svg = spectrum_figure(&lattice(), scale).unwrap();
            let document = roxmltree::Document::parse(&svg).unwrap();
            let texts: Vec<_> =
                document.descendants().filter(|n| n.has_tag_name("text")).filter_map(|n| n.text()).collect();
            let along =
                ["frequency along x (cycles per 1/√density)", "frequency along y (cycles per 1/√density)"];
            for text in along.into_iter().chain(ticks).chain(["0", "-2"]) {
                assert!(texts.contains(&text), "“{text}” is not in {texts:?}");
            }
        }
    }

    #[test]
    fn a_lattice_has_its_peaks_at_one_cycle_per_spacing() {
        let Plane { png, reach } = plane(&lattice(), PowerScale::Linear).unwrap();
        let picture = image::load_from_memory(&png).unwrap().to_luma8();
        let at = |along: f64, side: u32| ((along / reach[0] + 1.) / 2. * f64::from(side)) as u32;
        for (x, y) in [(1., 0.), (0., 1.), (-1., -1.)] {
            let pixel = picture.get_pixel(at(x, picture.width()), at(y, picture.height()))[0];
            assert_eq!(pixel, 255, "{x}, {y}");
        }
        assert_eq!(
            picture.pixels().filter(|p| p[0] > 0).count(),
            24,
            "peaks at whole cycles only, none at 0"
        );
    }
}
