use super::canvas::{Anchor, Area, Canvas, FRAME, INK, PAGE_WIDTH, Style, fit, round_above, text_width};
use super::field::{Projection, draw_outline, scale_bar};
use super::page::{LEFT_EDGE, LETTER_RISE, TITLE_BASELINE};
use super::{shown_unit, with_unit};
use crate::mosaic::Mosaic;
use crate::report::picture::png;
use crate::report::{ReportError, significant};
use crate::stats::{LocalValues, LocalWindow, MapGrid, Maps};
use image::ExtendedColorType;
use kuva::plot::ColorMap;

/// Colour map of all maps: perceptually uniform, and readable in grey and for colour-blind readers.
const COLOURS: ColorMap = ColorMap::Viridis;
/// Number of samples of a map along the longer side of the window; each becomes one pixel.
const SAMPLES: usize = 192;
/// Share of white in the colours of local windows that extend beyond the mosaic.
const PALE: f64 = 0.65;

/// Width over height of a field above which fields stand in two columns.
const WIDE: f64 = 1.9;
/// Width over height of a field above which fields stand in one column.
const VERY_WIDE: f64 = 4.;
/// Gap between two fields of a row, in canvas units.
const GAP: f64 = 12.;
/// Room for a colour bar and its labels beside a field, in canvas units.
const BAR_ROOM: f64 = 56.;
/// Gap between a field and its colour bar, in canvas units.
const BAR_GAP: f64 = 6.;
/// Width of a colour bar, in canvas units.
const BAR_WIDTH: f64 = 9.;
/// Smallest height of a colour bar, in canvas units.
const LEAST_HEIGHT: f64 = 60.;
/// Largest height of a field, in canvas units.
const MOST_HEIGHT: f64 = 330.;
/// Room for the title and the letters above the first row, in canvas units.
const HEAD: f64 = 36.;
/// Room for the scale bar below a row and the titles above the next, in canvas units.
const ROW_ROOM: f64 = 40.;
/// Room for the legend below the last row, in canvas units.
const FOOT: f64 = 34.;
/// Radius of the marks of peak and centroid, in canvas units.
const MARK: f64 = 4.5;
/// Colour of the border around marks and contours, which sets them off from dark colours of a map.
const HALO: &str = "#ffffff";

/// Description of the figure for screen readers.
const DESCRIPTION: &str = "Maps of one cone mosaic. Each value is taken over a square window around a cone; between cones it is \
    interpolated linearly. PCD: peak of the density map. CDC: density-weighted centroid of the outlined region, in which the \
    density is above a share of the peak.";

/// One map of the figure.
struct Panel {
    /// Title above the map, without the unit.
    title: &'static str,
    /// Unit of the labels of the colour bar; empty for numbers without one.
    unit: String,
    /// Factor from values of the map to this unit.
    factor: f64,
    /// Function that takes the value of the map from the local values of a cone.
    value: fn(&LocalValues) -> Option<f64>,
}

/// Returns the six maps with the units in which they are shown.
fn panels(mosaic: &Mosaic) -> [Panel; 6] {
    let (factor, unit) = shown_unit(mosaic.micrometres_per_unit(), mosaic.unit());
    let density = match (mosaic.micrometres_per_unit(), unit) {
        (Some(um), _) => ("cones/mm²".to_owned(), 1e6 / (um * um)),
        (None, "") => ("cones per unit area".to_owned(), 1.),
        (None, unit) => (format!("cones/{unit}²"), 1.),
    };
    let panel = |title, unit: &str, factor, value| Panel { title, unit: unit.to_owned(), factor, value };
    [
        panel("density", &density.0, density.1, |v| v.density),
        panel("inter-cell distance", unit, factor, |v| v.inter_cell),
        panel("nearest neighbour", unit, factor, |v| v.nearest),
        panel("regularity index", "", 1., |v| v.nearest_ri),
        panel("|ψ6|", "", 1., |v| v.psi6),
        panel("six-sided cells", "%", 1., |v| v.six_sided_percent),
    ]
}

/// Arrangement of the fields on the page; lengths are in canvas units.
struct Layout {
    /// Number of fields in a row.
    columns: usize,
    /// Width of a column: a field with its colour bar.
    cell: f64,
    /// Width of a field.
    width: f64,
    /// Height of a field.
    height: f64,
    /// Height of a colour bar, which is also the height of a row.
    bar: f64,
}

impl Layout {
    /// Arranges fields whose width over height is `aspect`.
    fn of(aspect: f64) -> Self {
        let columns = if aspect <= WIDE {
            3
        } else if aspect <= VERY_WIDE {
            2
        } else {
            1
        };
        let cell = (PAGE_WIDTH - 2. * LEFT_EDGE - (columns - 1) as f64 * GAP) / columns as f64;
        let widest = cell - BAR_ROOM;
        let height = f64::min(widest / aspect, MOST_HEIGHT);
        Self { columns, cell, width: height * aspect, height, bar: height.max(LEAST_HEIGHT) }
    }

    /// Returns the area of field `k`, counted from 0 in rows from the top left.
    fn field(&self, k: usize) -> Area {
        let (row, column) = (k / self.columns, k % self.columns);
        Area {
            x: LEFT_EDGE + column as f64 * (self.cell + GAP),
            y: HEAD + row as f64 * (self.bar + ROW_ROOM),
            width: self.width,
            height: self.height,
        }
    }

    fn page_height(&self, panels: usize) -> f64 {
        HEAD + panels.div_ceil(self.columns) as f64 * (self.bar + ROW_ROOM) - ROW_ROOM + FOOT
    }
}

/// Draws six maps of a mosaic, as a self-contained SVG, 180 mm wide.
///
/// The maps show local density, inter-cell distance, nearest-neighbour distance, its regularity
/// index, |ψ6| and the share of six-sided cells. Each has a colour bar, from the smallest to the
/// largest value of local windows that lie inside the window of the mosaic. Local windows that
/// extend beyond it are pale. Peak (PCD) and centroid (CDC) are marked. Equal input makes equal
/// bytes.
///
/// # Errors
/// Fails if a picture cannot be encoded.
pub fn maps_figure(title: &str, mosaic: &Mosaic, maps: &Maps) -> Result<String, ReportError> {
    let bounds = mosaic.window().bounds();
    let layout = Layout::of(bounds.width() / bounds.height());
    let panels = panels(mosaic);
    let mut canvas = Canvas::new(layout.page_height(panels.len()));
    let heading = fit(title, Style::Title, PAGE_WIDTH - 2. * LEFT_EDGE);
    canvas.text(LEFT_EDGE, TITLE_BASELINE, &heading, Style::Title, Anchor::Start);
    for (k, (panel, letter)) in panels.iter().zip(["a", "b", "c", "d", "e", "f"]).enumerate() {
        let area = layout.field(k);
        canvas.text(area.x, area.y - LETTER_RISE, letter, Style::Letter, Anchor::Start);
        let unit = if panel.unit.is_empty() { String::new() } else { format!(" ({})", panel.unit) };
        let name = format!("{}{unit}", panel.title);
        canvas.text(area.x + 14., area.y - LETTER_RISE, &name, Style::Axis, Anchor::Start);
        let grid = maps.grid(mosaic, panel.value, SAMPLES);
        let Some(range) = range(&grid) else {
            canvas.sentence(area, "Not defined in any window: see the column “flag” in the table of maps.");
            continue;
        };
        let projection = Projection::new(area, bounds);
        let side = grid.step * projection.scale;
        let place = Area { width: grid.columns as f64 * side, height: grid.rows as f64 * side, ..area };
        let (columns, rows) = (grid.columns as u32, grid.rows as u32);
        let pixels = coloured(&grid, range);
        canvas.picture(&png(&pixels, columns, rows, ExtendedColorType::Rgba8)?, place, area);
        match mosaic.window().rings() {
            [] => canvas.frame(area),
            _ => draw_outline(&mut canvas, &projection, mosaic.window(), FRAME),
        }
        if k == 0 {
            for contour in &maps.landmarks.contours {
                let back = contour.places.first().filter(|_| contour.closed);
                let line: Vec<_> = contour.places.iter().chain(back).map(|&p| projection.place(p)).collect();
                with_halo(&mut canvas, &line, 0.7);
            }
        }
        if let Some(at) = maps.landmarks.peak_at {
            draw_peak(&mut canvas, projection.place(at));
        }
        if let Some(at) = maps.landmarks.centroid {
            draw_centroid(&mut canvas, projection.place(at));
        }
        let bar = Area { x: area.right() + BAR_GAP, y: area.y, width: BAR_WIDTH, height: layout.bar };
        draw_bar(&mut canvas, bar, range, panel.factor)?;
        if k == 0 {
            let (factor, unit) = shown_unit(mosaic.micrometres_per_unit(), mosaic.unit());
            scale_bar(&mut canvas, area, bounds.width() * factor, unit);
        }
    }
    legend(&mut canvas, layout.page_height(panels.len()) - 6., maps, mosaic);
    Ok(canvas.into_svg(title, DESCRIPTION))
}

/// Returns the smallest and the largest value of a map.
///
/// Only local windows inside the window of the mosaic count (`grid.whole`), or all local windows if
/// there are none inside.
fn range(grid: &MapGrid) -> Option<(f64, f64)> {
    let of = |whole: bool| {
        let values = grid.values.iter().zip(&grid.whole).filter(|(v, w)| v.is_finite() && (**w || !whole));
        values.map(|(v, _)| (*v, *v)).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
    };
    let (low, high) = of(true).or_else(|| of(false))?;
    // Values that are equal up to rounding get one colour, and a bar around it.
    let least = (low.abs().max(high.abs()) * 1e-3).max(f64::MIN_POSITIVE);
    if high - low >= least { Some((low, high)) } else { Some((low - least, high + least)) }
}

/// Returns red, green and blue at a share (0–1) of the colour map.
fn colour(share: f64) -> [u8; 3] {
    let (red, green, blue) = COLOURS.map_rgb(share.clamp(0., 1.)).unwrap_or((128, 128, 128));
    [red, green, blue]
}

/// Returns red, green, blue and opacity of every sample.
///
/// The range `low`..`high` spans the colour map. Samples at which the map is not defined are
/// transparent.
fn coloured(grid: &MapGrid, (low, high): (f64, f64)) -> Vec<u8> {
    let pixel = |(&value, &whole): (&f64, &bool)| {
        if !value.is_finite() {
            return [255, 255, 255, 0];
        }
        let rgb = colour((value - low) / (high - low));
        let pale = |c: u8| if whole { c } else { (f64::from(c) * (1. - PALE) + 255. * PALE).round() as u8 };
        let [red, green, blue] = rgb.map(pale);
        [red, green, blue, 255]
    };
    grid.values.iter().zip(&grid.whole).flat_map(pixel).collect()
}

/// Draws the colour bar from low (bottom) to high, with labels at round values.
fn draw_bar(canvas: &mut Canvas, bar: Area, range: (f64, f64), factor: f64) -> Result<(), ReportError> {
    const STEPS: u32 = 128;
    let pixels: Vec<u8> = (0..STEPS)
        .flat_map(|row| [colour(1. - f64::from(row) / f64::from(STEPS - 1)); 2].into_iter().flatten())
        .collect();
    canvas.picture(&png(&pixels, 2, STEPS, ExtendedColorType::Rgb8)?, bar, bar);
    canvas.frame(bar);
    let (low, high) = (range.0 * factor, range.1 * factor);
    let mut step = round_above((high - low) / (bar.height / 26.).clamp(2., 5.));
    if (high / step).floor() - (low / step).ceil() < 1. {
        // One label makes no scale, so the step becomes the next smaller of 1, 2, 5 × 10ᵏ.
        step = round_above(0.4 * step);
    }
    let decimals = (-step.log10().floor()).max(0.) as usize;
    let mut tick = (low / step).ceil();
    while tick * step <= high && step > 0. {
        let value = tick * step;
        let y = bar.bottom() - (value - low) / (high - low) * bar.height;
        let x = bar.right();
        canvas.line((x, y), (x + 3., y), FRAME, 0.7);
        let label = if decimals > 5 || value.abs() >= 1e7 {
            significant(value, 3)
        } else {
            format!("{value:.decimals$}")
        };
        canvas.text(x + 5., y + 3., &label, Style::Note, Anchor::Start);
        tick += 1.;
    }
    Ok(())
}

/// Draws a black line on a wider white one, so that it is seen on every colour of a map.
fn with_halo(canvas: &mut Canvas, line: &[(f64, f64)], width: f64) {
    canvas.polyline(line.to_vec(), HALO, width + 1.3, None);
    canvas.polyline(line.to_vec(), INK, width, None);
}

/// Draws a plus sign, the mark of the peak density.
fn draw_peak(canvas: &mut Canvas, (x, y): (f64, f64)) {
    let arms = [[(x - MARK, y), (x + MARK, y)], [(x, y - MARK), (x, y + MARK)]];
    for (colour, width) in [(HALO, 2.8), (INK, 1.2)] {
        arms.iter().for_each(|arm| canvas.line(arm[0], arm[1], colour, width));
    }
}

/// Draws a circle, the mark of the cone density centroid.
fn draw_centroid(canvas: &mut Canvas, (x, y): (f64, f64)) {
    let corner = |k: i32| {
        let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 32.).sin_cos();
        (x + MARK * cos, y + MARK * sin)
    };
    let ring: Vec<_> = (0..=32).map(corner).collect();
    with_halo(canvas, &ring, 1.2);
}

/// Function that draws a mark centred at a position of the page.
type Mark = fn(&mut Canvas, (f64, f64));

/// Draws the legend: the meaning of the marks, and the window.
fn legend(canvas: &mut Canvas, y: f64, maps: &Maps, mosaic: &Mosaic) {
    let (factor, unit) = shown_unit(mosaic.micrometres_per_unit(), mosaic.unit());
    let window = match maps.options.window {
        LocalWindow::Cells(n) => format!("windows of {n} bound cells"),
        LocalWindow::Side(side) => {
            format!("windows {} wide", with_unit(&significant(side * factor, 3), unit))
        }
    };
    let share = 100. * maps.options.isodensity;
    let mut x = LEFT_EDGE + MARK;
    let mut note = |canvas: &mut Canvas, mark: Option<Mark>, text: &str| {
        if let Some(mark) = mark {
            mark(canvas, (x, y - 3.));
            x += MARK + 5.;
        }
        canvas.text(x, y, text, Style::Note, Anchor::Start);
        x += text_width(text, Style::Note) + 18.;
    };
    note(canvas, Some(draw_peak), "peak (PCD)");
    note(canvas, Some(draw_centroid), "centroid (CDC)");
    let line =
        |canvas: &mut Canvas, (x, y): (f64, f64)| with_halo(canvas, &[(x - MARK, y), (x + MARK, y)], 0.7);
    note(canvas, Some(line), &format!("{} % of the peak", significant(share, 2)));
    note(canvas, None, &format!("{window}; pale: windows that reach beyond the mosaic"));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_stay_on_the_page_and_apart() {
        for aspect in [0.02, 0.3, 1., 1.5, 1.95, 3.9, 4.1, 60.] {
            let layout = Layout::of(aspect);
            for k in 0..6 {
                let area = layout.field(k);
                assert!(area.right() + BAR_ROOM <= PAGE_WIDTH, "{aspect}: {area:?}");
                assert!(area.y + layout.bar + FOOT <= layout.page_height(6) + 1e-9);
                assert!((area.width / area.height / aspect - 1.).abs() < 1e-9);
            }
            assert!(layout.field(1).x >= layout.field(0).right() || layout.columns == 1);
        }
    }

    #[test]
    fn colours_span_whole_windows_and_others_are_pale() {
        let grid = MapGrid {
            columns: 4,
            rows: 1,
            step: 1.,
            values: vec![f64::NAN, 1., 2., 9.],
            whole: vec![false, true, true, false],
        };
        assert_eq!(range(&grid), Some((1., 2.)));
        let pixels = coloured(&grid, (1., 2.));
        assert_eq!((pixels[3], pixels[7]), (0, 255));
        assert_eq!([pixels[4], pixels[5], pixels[6]], colour(0.));
        assert_eq!([pixels[8], pixels[9], pixels[10]], colour(1.));
        assert!(pixels[12] > pixels[8] && pixels[14] > pixels[10], "{pixels:?}");
        // The luminance of the colours rises with the value.
        let light = |share: f64| {
            let [r, g, b] = colour(share).map(f64::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        };
        assert!((0..20).all(|k| light(f64::from(k) / 20.) < light(f64::from(k + 1) / 20.)));
    }

    #[test]
    fn equal_values_have_a_range_and_none_has_none() {
        let grid =
            |value: f64| MapGrid { columns: 1, rows: 1, step: 1., values: vec![value], whole: vec![true] };
        let (low, high) = range(&grid(7.)).unwrap();
        assert!(low < 7. && high > 7.);
        assert!(range(&grid(0.)).is_some_and(|(low, high)| high > low));
        assert_eq!(range(&grid(f64::NAN)), None);
    }
}
