//! Figures of mosaics, samplers and validations, as self-contained SVG.
//!
//! [`mosaic_figure`] draws the row of panels that Lanaro et al. (2020,
//! <https://doi.org/10.1088/2399-6528/ab8064>, figures 2–6) show for one mosaic: picture, points,
//! nearest neighbours, pair correlation function.

mod agreement;
mod canvas;
mod correlation;
mod envelope;
mod field;
mod froc;
mod labels;
mod maps;
mod neighbours;
mod page;
mod panels;
mod reliability;
mod samplers;
mod spectrum;

use super::ReportError;
use crate::geometry::{Point, Window};
use crate::image::Plane;
use crate::mosaic::LengthUnit;
pub use agreement::{AgreementLine, AgreementPanel, agreement_figure};
use canvas::{Anchor, Canvas, Style};
pub use envelope::{EnvelopePanel, envelope_figure};
pub use froc::{FrocLine, froc_figure};
pub use maps::maps_figure;
use page::Page;
pub use reliability::{ReliabilityFigure, reliability_figure};
pub use samplers::{SamplerPanel, samplers_figure};
pub use spectrum::{spectrum_figure, spectrum_png};

/// Description of the figure for screen readers; it also explains ℓ∞.
const DESCRIPTION: &str = "One cone mosaic: its picture, its points, its nearest-neighbour distances with the Gaussian \
    of the same mean and standard deviation (RI, regularity index: mean over standard deviation), and its pair correlation \
    function with those of the three nearest point samplers and of independent points (ℓ∞, l-infinity: the largest difference \
    between the functions of sampler and mosaic).";

/// A sampled function of distance, with one value per distance.
#[derive(Clone, Copy, Debug)]
pub struct Curve<'a> {
    /// Distances in hexagonal spacings.
    pub r: &'a [f64],
    /// Values at these distances; a value that is not finite leaves a gap.
    pub g: &'a [f64],
}

/// Mean pair correlation function (PCF) of a sampler, and its distance from the PCF of the mosaic.
#[derive(Clone, Copy, Debug)]
pub struct ReferenceLine<'a> {
    /// Name of the sampler.
    pub name: &'a str,
    /// Distances in hexagonal spacings.
    pub r: &'a [f64],
    /// Mean PCF of the sampler at these distances.
    pub g: &'a [f64],
    /// Largest difference from the mosaic's PCF, if it was computed.
    pub l_infinity: Option<f64>,
}

/// The content of the figure of one mosaic.
///
/// Lengths are in the unit of the mosaic; the figure shows them in µm if `um_per_unit` is known.
#[derive(Clone, Copy, Debug)]
pub struct MosaicFigure<'a> {
    /// Title above the panels, usually the name of the file.
    ///
    /// Its middle is cut out where it is too long for the page.
    pub title: &'a str,
    /// Image of the mosaic; without one the figure has no picture panel.
    ///
    /// For a mosaic in px the part inside the window is shown; in another unit the image is taken
    /// to fill the window.
    pub picture: Option<&'a Plane>,
    /// Centres of the cones; those outside the window are not drawn.
    pub points: &'a [Point],
    /// Window in which points could have been seen.
    pub window: &'a Window,
    /// Unit of points, window and distances.
    pub unit: LengthUnit,
    /// Micrometres per unit, if known.
    pub um_per_unit: Option<f64>,
    /// Nearest-neighbour distance of every point.
    pub nn: &'a [f64],
    /// Mean of the distances `nn`.
    pub nn_mean: Option<f64>,
    /// Standard deviation of the distances `nn`.
    pub nn_sd: Option<f64>,
    /// Regularity index: mean over standard deviation.
    pub ri: Option<f64>,
    /// Rising edges of the histogram of `nn`, one more than counts; both empty without a histogram.
    pub histogram_edges: &'a [f64],
    /// Number of points in each bin of the histogram.
    pub histogram_counts: &'a [usize],
    /// Pair correlation function of the mosaic.
    pub pcf: Option<Curve<'a>>,
    /// Samplers that the mosaic is compared with.
    ///
    /// Only the three nearest are drawn, and `uniform` for scale.
    pub references: &'a [ReferenceLine<'a>],
}

impl MosaicFigure<'_> {
    /// Checks that histogram and curves have matching lengths.
    fn validate(&self) -> Result<(), ReportError> {
        let (edges, counts) = (self.histogram_edges, self.histogram_counts);
        let matching = edges.len() == counts.len() + 1 || (edges.is_empty() && counts.is_empty());
        let rising = edges.iter().all(|e| e.is_finite()) && edges.windows(2).all(|e| e[0] < e[1]);
        if !(matching && rising) {
            return Err(ReportError::Histogram { edges: edges.len(), counts: counts.len() });
        }
        let mosaic = self.pcf.iter().map(|c| ("the mosaic", c.r, c.g));
        for (name, r, g) in mosaic.chain(self.references.iter().map(|l| (l.name, l.r, l.g))) {
            if r.len() != g.len() {
                return Err(ReportError::Curve { name: name.to_owned(), r: r.len(), g: g.len() });
            }
        }
        Ok(())
    }
}

/// Returns the factor from lengths of the mosaic to shown lengths, and the unit of the shown
/// lengths (“” in the unit square).
fn shown_unit(um_per_unit: Option<f64>, unit: LengthUnit) -> (f64, &'static str) {
    match (um_per_unit, unit) {
        (Some(factor), _) => (factor, "µm"),
        (None, LengthUnit::Pixel) => (1., "px"),
        (None, LengthUnit::Micrometre) => (1., "µm"),
        (None, LengthUnit::Unit) => (1., ""),
    }
}

/// Returns the number with its unit: “3.2 µm”, or “0.07” for a length without a unit.
fn with_unit(number: &str, unit: &str) -> String {
    if unit.is_empty() { number.to_owned() } else { format!("{number} {unit}") }
}

/// Draws the figure of one mosaic, as a self-contained SVG, 180 mm wide.
///
/// Its panels are (a) the picture, (b) the points in their window, (c) the histogram of
/// nearest-neighbour distances with the Gaussian of the same mean and standard deviation, (d) the
/// pair correlation function over those of samplers. Fields much wider than high are stacked beside
/// or above the plots. A panel without data says why in a sentence. Equal input makes equal bytes.
///
/// # Errors
/// Fails if the histogram has not one edge more than counts or its edges do not rise
/// ([`ReportError::Histogram`]), if a curve has unequal numbers of distances and values
/// ([`ReportError::Curve`]), or if a picture cannot be encoded ([`ReportError::Png`]).
pub fn mosaic_figure(figure: &MosaicFigure) -> Result<String, ReportError> {
    figure.validate()?;
    let bounds = figure.window.bounds();
    let page = Page::arrange(bounds.width() / bounds.height(), figure.picture.is_some());
    let mut canvas = Canvas::new(page.height);
    let title = canvas::fit(figure.title, Style::Title, canvas::PAGE_WIDTH - 2. * page::LEFT_EDGE);
    canvas.text(page::LEFT_EDGE, page::TITLE_BASELINE, &title, Style::Title, Anchor::Start);
    let mut letters = ["a", "b", "c", "d"].into_iter();
    let mut letter = |canvas: &mut Canvas, x: f64, top: f64| {
        let letter = letters.next().unwrap_or_default();
        canvas.text(x, top - page::LETTER_RISE, letter, Style::Letter, Anchor::Start);
    };
    if let (Some(area), Some(picture)) = (page.picture, figure.picture) {
        letter(&mut canvas, area.x, area.y);
        field::draw_picture(&mut canvas, area, figure, picture)?;
    }
    letter(&mut canvas, page.points.x, page.points.y);
    field::draw_points(&mut canvas, page.points, figure)?;
    letter(&mut canvas, page.neighbours.x - page::AXIS_ROOM, page.neighbours.y);
    neighbours::draw(&mut canvas, page.neighbours, figure);
    letter(&mut canvas, page.correlation.x - page::AXIS_ROOM, page.correlation.y);
    correlation::draw(&mut canvas, page.correlation, figure);
    Ok(canvas.into_svg(figure.title, DESCRIPTION))
}
