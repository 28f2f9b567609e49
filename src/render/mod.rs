//! Simulated retinal images in which the position of every cone is known.
//!
//! [`cone_mosaic`] makes positions of cones, [`render()`] draws an image of cones at these
//! positions, and [`simulate`] does both. The simulation covers what decides whether a detector
//! works: the size of a cone relative to the distance to its neighbours, scatter of brightness, dim
//! cones, structure that is not a cone, uneven illumination, blur and noise. Sizes follow the local
//! spacing, so cones are larger where they are sparser.
//!
//! Judging detectors by simulated cones at known positions follows Mariotti and Devaney (2015),
//! <https://doi.org/10.1364/JOSAA.32.000497>.

mod confocal;
mod density;
mod error;
mod field;
mod histology;
mod montage;
mod mosaic;
mod noise;
mod options;
mod presets;
mod psf;
mod rods;
mod spacing;
mod split;
mod vessels;
mod visibility;

pub use error::RenderError;
pub use mosaic::{GradientShape, MosaicOptions, Pattern, cone_mosaic};
pub use options::{PointSpread, RenderOptions};
pub use presets::{PRESETS, Preset};
pub use visibility::{ConeClass, Visibility};

use crate::geometry::Point;
use crate::image::Plane;
use crate::image::{Modality, Polarity};
use field::SlowField;
use montage::Montage;
use rand::Rng;
use spacing::CellSizes;

/// Simulated image, with the positions and the visibility of its cones.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// Image with grey values in [0, 1].
    pub image: Plane,
    /// Cones whose centre lies on a pixel that was imaged, in px, whether or not they can be seen.
    pub cones: Vec<Point>,
    /// Visibility of each of the `cones`, in the same order.
    pub visibility: Vec<Visibility>,
}

/// Makes a mosaic by [`cone_mosaic`] and an image of it.
///
/// Cones beyond the border shine into the image, as in a real image, but are not returned. The size
/// of the image is taken from `image`; the size in `mosaic` is not used.
///
/// # Errors
/// Fails if an option is out of its range.
///
/// # Examples
/// ```
/// use conemosaic::detect::Modality;
/// use conemosaic::render::{MosaicOptions, RenderOptions, simulate};
/// use rand::SeedableRng;
///
/// let confocal = RenderOptions::new(Modality::Confocal);
/// let image = RenderOptions { width: 96, height: 64, noise: 0.02, ..confocal };
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
    picture(&around, image, rng)
}

/// Draws the image of cones at `points`, with grey values in [0, 1].
///
/// Coordinates are in px; (0, 0) is the centre of the top-left pixel. Points beyond the border are
/// allowed: the light that they cast into the image is drawn.
///
/// 1. The size of each cone follows from the distances to its neighbours; its peak brightness is
///    drawn at random.
/// 2. The modality turns cones, and rods between them, into a signal.
/// 3. Contrast, brightness, uneven illumination, vessels and blur are applied.
/// 4. Noise is added, and values are clamped to [0, 1].
/// 5. If `options.montage` is at least 2, the image is seen through the tiles of a montage.
///
/// # Errors
/// Fails if an option is out of its range, a coordinate is not finite, or there are fewer than four
/// points and `options.spacing` is `None`.
///
/// # Examples
/// ```
/// use conemosaic::geometry::Point;
/// use conemosaic::render::{RenderOptions, render};
/// use rand::SeedableRng;
///
/// let size = RenderOptions { width: 32, height: 32, ..Default::default() };
/// let options = RenderOptions { spacing: Some(10.), noise: 0., ..size };
/// let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
/// let image = render(&[Point::new(20., 8.)], &options, &mut rng)?;
/// assert!(image[[8, 20]] > image[[24, 8]]);
/// # Ok::<(), conemosaic::render::RenderError>(())
/// ```
pub fn render(points: &[Point], options: &RenderOptions, rng: &mut dyn Rng) -> Result<Plane, RenderError> {
    Ok(picture(points, options, rng)?.image)
}

/// Draws the same image as [`render()`], and returns it with the visibility of each cone on an
/// imaged pixel.
///
/// # Errors
/// Fails if [`render()`] fails.
pub fn picture(
    points: &[Point],
    options: &RenderOptions,
    rng: &mut dyn Rng,
) -> Result<Simulation, RenderError> {
    options.validate()?;
    if let Some((index, p)) = points.iter().enumerate().find(|(_, p)| !p.is_finite()) {
        return Err(RenderError::NotFinite { index, x: p.x, y: p.y });
    }
    let cells = CellSizes::of(points, options)?;
    let heights = visibility::heights(points, &cells, options, rng);
    let rods = rods::between(points, &cells, options, rng);
    let mut contrasts = heights.clone();
    let signal = match options.modality {
        Modality::Confocal => confocal::signal(points, &cells, &heights, &rods, options, rng),
        Modality::Split => split::signal(points, &cells, &heights, &rods, options, rng),
        Modality::Histology => {
            let sizes = histology::section(points.len(), options, rng);
            contrasts.iter_mut().zip(&sizes).for_each(|(c, size)| *c *= size);
            histology::signal(points, &cells, &heights, &sizes, &rods, options, rng)
        }
    };
    let vessels = (options.vessels > 0).then(|| vessels::depth(options, cells.typical, rng));
    let mut image = expose(signal, vessels.as_ref(), &cells, options, rng);
    noise::add(&mut image, options, rng);
    image.mapv_inplace(|v| v.clamp(0., 1.));
    let montage = (options.montage > 1).then(|| Montage::new(options, rng));
    if let Some(montage) = &montage {
        image = montage.applied(&image);
    }
    let imaged = |p: Point| {
        mosaic::in_image(p, options.width, options.height)
            && montage.as_ref().is_none_or(|m| m.covers(p.x, p.y))
    };
    let light = |p: Point| {
        let pixel = |v: f64, side: usize| (v.round().max(0.) as usize).min(side - 1);
        let at = [pixel(p.y, options.height), pixel(p.x, options.width)];
        vessels.as_ref().map_or(1., |v| 1. - options.vessel_depth * f64::from(v[at]))
    };
    let seen = points.iter().zip(contrasts).filter(|(p, _)| imaged(**p));
    let (cones, visibility) = seen.map(|(&p, c)| (p, Visibility::of(c * light(p)))).unzip();
    Ok(Simulation { image, cones, visibility })
}

/// Turns the signal into grey values.
///
/// The signal is 0 where there is no cone, and 1 is the contrast of an average cone. The image is
/// unevenly lit, seen behind vessels, blurred, and inverted if the polarity is negative.
fn expose(
    mut signal: Plane,
    vessels: Option<&Plane>,
    cells: &CellSizes,
    options: &RenderOptions,
    rng: &mut dyn Rng,
) -> Plane {
    let relief = options.modality == Modality::Split;
    if let Some(vessels) = vessels.filter(|_| relief) {
        split::cover(&mut signal, vessels, options, cells.typical);
    }
    let mut image = signal.mapv_into(|v| options.brightness as f32 + options.contrast as f32 * v);
    illuminate(&mut image, options, cells.typical, rng);
    if let Some(vessels) = vessels.filter(|_| !relief) {
        let depth = options.vessel_depth as f32;
        image.zip_mut_with(vessels, |v, inside| *v *= 1. - depth * inside);
    }
    let mut image = field::smooth(&image, options.blur * cells.typical);
    if options.polarity == Polarity::Negative {
        image.mapv_inplace(|v| 1. - v);
    }
    image
}

/// Multiplies the image by an uneven illumination of mean 1.
///
/// Half of the variance of the illumination comes from a field that spans the image, like
/// vignetting or a tilt, and half from a field that spans a few cones, like the shadows of vessels
/// and of the layers above. `spacing` is the median spacing of the cones, in px.
fn illuminate(image: &mut Plane, options: &RenderOptions, spacing: f64, rng: &mut dyn Rng) {
    let (height, width) = image.dim();
    let mut field = |cell| SlowField::new(width, height, cell, rng).plane(width, height);
    let (wide, near) = (field(0.5 * width.max(height) as f64), field(1.5 * spacing));
    // each of the two fields gets half of the variance `drift`²
    let half = (options.drift * 0.5f64.sqrt()) as f32;
    // The factor stays above 0, as a bright field never turns dark, however large the `drift` is.
    ndarray::Zip::from(image).and(&wide).and(&near).for_each(|v, w, n| *v *= (1. + half * (w + n)).max(0.1));
}
