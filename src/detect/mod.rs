//! From an image to cone centres: flatten → spacing → filter → maxima → suppress → select → refine. Every stage can be called
//! alone; [`detect`] is their composition. Knows nothing of files or statistics.

mod filter;
mod flatten;
mod maxima;
mod modality;
mod options;
mod spacing;
mod suppress;
mod types;

pub use filter::{Criterion, RelativeThreshold, response};
pub use flatten::flatten;
pub use maxima::local_maxima;
pub use options::{DetectOptions, Detector};
pub use spacing::{BORDER, RingEstimate, RingProfile, SPACING_RANGE, refined};
pub use suppress::suppress;
pub use types::{Detection, Detections, Modality, Polarity};

use crate::image::Plane;
use thiserror::Error;

/// Shortest side of an image in px: below, there is no room for even a handful of cones at the closest spacing.
pub const MIN_SIDE: usize = 24;

/// At most this often the filter is run again at the spacing that its own detections show.
const PASSES: usize = 3;
/// Spacings that differ by less than this part are the same.
const SETTLED: f64 = 0.005;

/// Why an image has no cones to find.
#[derive(Debug, Error, PartialEq)]
pub enum DetectError {
    /// Too few pixels.
    #[error("the image is {width} × {height} px: both sides must be at least {MIN_SIDE} px")]
    TooSmall {
        /// Width in px.
        width: usize,
        /// Height in px.
        height: usize,
    },
    /// Every pixel is the same.
    #[error("every pixel of the image is {value}: there is nothing to find")]
    Constant {
        /// Their common value.
        value: f32,
    },
    /// A pixel is infinite or not a number.
    #[error("pixel ({x}, {y}) is {value}: pixels must be finite numbers")]
    NotFinite {
        /// Column of the pixel.
        x: usize,
        /// Row of the pixel.
        y: usize,
        /// Its value.
        value: f32,
    },
    /// A spacing outside the range.
    #[error("a spacing of {0} px is outside {low}–{high} px", low = SPACING_RANGE.0, high = SPACING_RANGE.1)]
    Spacing(f64),
}

/// The cones of an image, by the method that `options` leaves open decided from the image.
///
/// # Errors
/// If the image is too small, constant, or has pixels that are not numbers, or an option is out of range.
pub fn detect(image: &Plane, options: &DetectOptions) -> Result<Detections, DetectError> {
    options.validate()?;
    check(image)?;
    let flat = flatten(image);
    let ring = RingProfile::of(&flat);
    let (modality, polarity) = modality::decide(&flat, &ring, options.modality, options.polarity);
    let estimate = ring.spacing(modality);
    let start = options.spacing.unwrap_or(estimate.spacing);
    let mut spacing = start;
    let mut cones = Vec::new();
    for _ in 0..PASSES {
        let (response, criterion) = response(image, modality, polarity, spacing);
        let maxima = suppress(local_maxima(&response, criterion.threshold), criterion.suppression * spacing);
        cones = criterion.select(maxima);
        let centres: Vec<_> = cones.iter().map(|d| d.centre).collect();
        let next = refined(&centres, image.ncols(), image.nrows(), start);
        let settled = (next / spacing - 1.).abs() < SETTLED;
        spacing = next;
        if settled {
            break;
        }
    }
    Ok(Detections {
        cones,
        modality,
        polarity,
        ring_spacing: estimate.spacing,
        ring_strength: estimate.strength,
        spacing,
    })
}

fn check(image: &Plane) -> Result<(), DetectError> {
    let (height, width) = image.dim();
    if width < MIN_SIDE || height < MIN_SIDE {
        return Err(DetectError::TooSmall { width, height });
    }
    if let Some(((y, x), &value)) = image.indexed_iter().find(|(_, v)| !v.is_finite()) {
        return Err(DetectError::NotFinite { x, y, value });
    }
    let value = image[[0, 0]];
    if image.iter().all(|&v| v == value) { Err(DetectError::Constant { value }) } else { Ok(()) }
}
