//! A mosaic becomes a simulated retinal image with known truth.
//!
//! [`cone_mosaic`] makes places for cones, [`render`] takes a picture of places from anywhere, [`simulate`]
//! does both. What is simulated is what decides whether a detector works: the size of a cone relative to its
//! neighbours' distance, scatter of brightness, dim cones, structure that is not a cone, uneven illumination,
//! blur and noise. Sizes follow the local spacing, so a density gradient looks like one.
//!
//! Simulated cones with known places, to judge detectors, follow Mariotti & Devaney (2015).

mod confocal;
mod error;
mod field;
mod histology;
mod mosaic;
mod noise;
mod options;
mod spacing;
mod split;

pub use error::RenderError;
pub use mosaic::{MosaicOptions, cone_mosaic};
pub use options::RenderOptions;

use crate::detect::{Modality, Polarity};
use crate::geometry::Point;
use crate::image::Plane;
use field::SlowField;
use rand::Rng;
use spacing::CellSizes;

/// A simulated image and the cones in it.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// Grey values in [0, 1].
    pub image: Plane,
    /// The cones whose centre lies in the image, in px, whether or not they can be seen.
    pub cones: Vec<Point>,
}

/// A mosaic made by [`cone_mosaic`], and its picture. Cones beyond the border shine into the picture, as they do in a
/// real one, but are not among those returned. The size is that of `image`; that of `mosaic` is not used.
///
/// # Errors
/// If an option is out of its range.
///
/// # Examples
/// ```
/// use conemosaic::detect::Modality;
/// use conemosaic::render::{MosaicOptions, RenderOptions, simulate};
/// use rand::SeedableRng;
///
/// let image = RenderOptions { width: 96, height: 64, noise: 0.02, ..RenderOptions::new(Modality::Confocal) };
/// let mosaic = MosaicOptions { spacing: 8., ..MosaicOptions::default() };
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
/// let simulation = simulate(&mosaic, &image, &mut rng)?;
///
/// assert_eq!(simulation.image.dim(), (64, 96));
/// // A hexagonal cell has √3/2 · spacing² px².
/// let expected = 96. * 64. / (0.75f64.sqrt() * 64.);
/// assert!((simulation.cones.len() as f64 / expected - 1.).abs() < 0.1);
/// # Ok::<(), conemosaic::render::RenderError>(())
/// ```
pub fn simulate(
    mosaic: &MosaicOptions,
    image: &RenderOptions,
    rng: &mut dyn Rng,
) -> Result<Simulation, RenderError> {
    image.validate()?;
    let sized = MosaicOptions { width: image.width, height: image.height, ..mosaic.clone() };
    let around = mosaic::with_surroundings(&sized, rng)?;
    let picture = render(&around, image, rng)?;
    let cones = around.into_iter().filter(|&p| mosaic::in_image(p, image.width, image.height)).collect();
    Ok(Simulation { image: picture, cones })
}

/// The picture of cones at `points` (px, pixel (0, 0) is the centre of the top-left pixel), in [0, 1].
///
/// Steps: the size of each cone from its neighbours → the signal of the modality → contrast and brightness → uneven
/// illumination → blur → noise → cut to [0, 1]. Points beyond the border are welcome: what they shine into the picture
/// is drawn.
///
/// # Errors
/// If an option is out of its range, a coordinate is not finite, or there are fewer than four points and the
/// options name no spacing.
///
/// # Examples
/// ```
/// use conemosaic::geometry::Point;
/// use conemosaic::render::{RenderOptions, render};
/// use rand::SeedableRng;
///
/// let options = RenderOptions { width: 32, height: 32, spacing: Some(10.), noise: 0., ..Default::default() };
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
/// let image = render(&[Point::new(20., 8.)], &options, &mut rng)?;
/// assert!(image[[8, 20]] > image[[24, 8]]);
/// # Ok::<(), conemosaic::render::RenderError>(())
/// ```
pub fn render(points: &[Point], options: &RenderOptions, rng: &mut dyn Rng) -> Result<Plane, RenderError> {
    options.validate()?;
    if let Some((index, p)) = points.iter().enumerate().find(|(_, p)| !p.is_finite()) {
        return Err(RenderError::NotFinite { index, x: p.x, y: p.y });
    }
    let cells = CellSizes::of(points, options)?;
    let signal = match options.modality {
        Modality::Confocal => confocal::signal(points, &cells, options, rng),
        Modality::Split => split::signal(points, &cells, options, rng),
        Modality::Histology => histology::signal(points, &cells, options, rng),
    };
    let mut image = signal.mapv_into(|v| options.brightness as f32 + options.contrast as f32 * v);
    illuminate(&mut image, options, cells.typical, rng);
    let mut image = field::smooth(&image, options.blur * cells.typical);
    if options.polarity == Polarity::Negative {
        image.mapv_inplace(|v| 1. - v);
    }
    noise::add(&mut image, options, rng);
    image.mapv_inplace(|v| v.clamp(0., 1.));
    Ok(image)
}

/// Multiplies by 1 + drift: half its variance spans the picture (vignetting, tilt), half a few cones (vessels and
/// the layers above).
fn illuminate(image: &mut Plane, options: &RenderOptions, spacing: f64, rng: &mut dyn Rng) {
    let (height, width) = image.dim();
    let mut field = |cell| SlowField::new(width, height, cell, rng).plane(width, height);
    let (wide, near) = (field(0.5 * width.max(height) as f64), field(1.5 * spacing));
    let half = (options.drift * 0.5f64.sqrt()) as f32;
    // A bright field never turns dark side up, however large a drift is asked for.
    ndarray::Zip::from(image).and(&wide).and(&near).for_each(|v, w, n| *v *= (1. + half * (w + n)).max(0.1));
}
