//! Detection of cones in an image: flatten → spacing → filter → maxima → suppress → select →
//! refine.
//!
//! Every stage can be called alone; [`detect`] is their composition. Only the spacing and the
//! modality are estimated from the flattened image: filters get the image itself. The module knows
//! nothing of files or statistics.
//!
//! # Examples
//! ```
//! use conemosaic::detect::{local_maxima, response, suppress};
//! use conemosaic::prelude::*;
//!
//! let image = read("fixtures/images/confocal_dense.png".as_ref())?;
//!
//! // everything decided by the program
//! let found = detect(&image, &DetectOptions::default())?;
//! assert_eq!(found.modality, Modality::Confocal);
//! println!("{} cones, {:.1} px apart", found.cones.len(), found.spacing);
//!
//! // or stage by stage, for cones 7.5 px apart
//! let (modality, polarity) = (Modality::Confocal, Polarity::Positive);
//! let clear = f64::INFINITY; // filters widen only in images of low clarity
//! let (filtered, criterion) = response(&image, modality, polarity, 7.5, clear);
//! let maxima = local_maxima(&filtered, criterion.threshold);
//! let cones = criterion.select(suppress(maxima, criterion.suppression * 7.5));
//! assert!(cones.len() > 300);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod axis;
mod calibration;
mod filter;
mod finder;
mod flatten;
mod learned;
mod maxima;
mod modality;
mod options;
mod search;
mod spacing;
mod spec;
mod suppress;
mod tiles;
mod types;
mod view;

pub use crate::image::{Modality, Polarity};
pub use filter::{Criterion, RelativeThreshold, response};
pub use flatten::flatten;
pub use learned::{UserModel, WeightsError};
pub use maxima::local_maxima;
pub use modality::ModalityFeatures;
pub use options::{DetectOptions, Detector};
pub use spacing::{
    BORDER, FourierEstimate, FourierMap, FourierMapOptions, FourierSpacing, RingEstimate, RingProfile,
    SPACING_RANGE, Sector, SpacingMap, fourier_map, fourier_spacing,
};
pub use suppress::suppress;
pub use types::{Detection, Detections};
pub use view::WIDEST_SPACING;

use crate::image::{Plane, crop, imaged_part};
use axis::Turn;
use finder::{ConeFinder, Sought};
use search::regularity;
use spacing::Start;
use spec::{ModalitySpec, SPECS, spec};
use std::borrow::Cow;
use strum::VariantArray;
use thiserror::Error;
use view::View;

/// Smallest width and height, in px, of an image in which cones are looked for.
///
/// Smaller images are refused: even at the closest spacing, 4 px, such a side has room for fewer
/// than six cones in a row.
pub const MIN_SIDE: usize = 24;

/// Number of weight files: one per modality for the network that finds cones, one for the network
/// that estimates the spacing, and one for the network that recognises the modality.
const FILES: usize = Modality::VARIANTS.len() + 2;

/// Returns the weight files that are compiled into the program; its results depend on them.
///
/// First come the networks that find cones, one per modality in the order of [`Modality`], then the
/// network that estimates the spacing, and last the network that recognises the modality.
pub fn weights() -> [&'static [u8]; FILES] {
    let others = [spacing::ring_weights(), modality::weights()];
    let mut all = SPECS.iter().map(|spec| spec.network.weights()).chain(others);
    std::array::from_fn(|_| all.next().unwrap_or_default())
}

/// Largest absolute binary exponent of grey values that are filtered without rescaling.
///
/// An image is rescaled if its largest absolute grey value is below 2^−20 or at least 2^21. Between
/// these limits, squares and sums of grey values stay far inside the range of single precision.
const USUAL_EXPONENT: f64 = 20.;

/// Smallest confidence (0–1) of a spacing at which no wider spacing is tried.
const SURE: f64 = 0.9;
/// Confidence (0–1) below which a spacing is given up for any wider spacing of higher confidence,
/// even if the mosaic found with that one is less regular.
const HOPELESS: f64 = 0.1;

/// Reasons why cones cannot be looked for in an image.
#[derive(Debug, Error, PartialEq)]
pub enum DetectError {
    /// Image with a side shorter than [`MIN_SIDE`].
    #[error(
        "the image is {width} × {height} px: expected at least {MIN_SIDE} × {MIN_SIDE} px, so leave it out or \
         use a larger part"
    )]
    TooSmall {
        /// Width of the image in px.
        width: usize,
        /// Height of the image in px.
        height: usize,
    },
    /// Image whose part inside the black margin has a side shorter than [`MIN_SIDE`].
    #[error(
        "only {imaged_width} × {imaged_height} px of the image ({width} × {height} px) are not black: \
         expected an imaged area of at least {MIN_SIDE} × {MIN_SIDE} px"
    )]
    TooLittleImaged {
        /// Width of the image in px.
        width: usize,
        /// Height of the image in px.
        height: usize,
        /// Width in px of the part of the image inside its black margin.
        imaged_width: usize,
        /// Height in px of the part of the image inside its black margin.
        imaged_height: usize,
    },
    /// Image in which all pixels have the same value.
    #[error(
        "every pixel of the image has the value {value}, so no cones can be found: export the image again"
    )]
    Constant {
        /// Value of every pixel.
        value: f32,
    },
    /// Pixel that is infinite or not a number.
    #[error("pixel ({x}, {y}) is {value}: expected finite numbers only")]
    NotFinite {
        /// Column of the pixel, from 0.
        x: usize,
        /// Row of the pixel, from 0.
        y: usize,
        /// Value of the pixel.
        value: f32,
    },
    /// Cone spacing in the options, in px, that is outside the range 4–160 px.
    #[error("the spacing is {0} px: expected {low} to {high} px", low = SPACING_RANGE.0, high = WIDEST_SPACING)]
    Spacing(f64),
    /// Direction of the derivative in the options, in degrees, that is not a finite number.
    #[error("the angle of the split detector is {0}: expected a finite number of degrees")]
    SplitAngle(f64),
    /// Side of the tiles of a spacing map, in spacings, that is outside the range 6–60.
    #[error("the side of the tiles is {0} spacings: expected 6 to 60 spacings")]
    TileSide(f64),
    /// Spectrum without a ring at spacings of 4–40 px: the image shows no regular mosaic.
    #[error(
        "the spectrum of the image has no ring at spacings of {low} to {high} px, so no regular mosaic can \
         be seen: choose a part of the image in which cones are visible",
        low = SPACING_RANGE.0, high = SPACING_RANGE.1
    )]
    NoRing,
    /// Model set together with the classical detector, although that detector uses no model.
    #[error("the classical detector uses no model: leave out the model, or choose another detector")]
    Unused,
    /// Model made for another modality than the one that the user set for the images.
    #[error(
        "{name} is a model for {own} images and cannot be used on {given} images: leave out the model, or \
         give the right modality"
    )]
    OtherModality {
        /// Name of the model, as passed to [`UserModel::new`].
        name: String,
        /// Modality that the model was made for.
        own: Modality,
        /// Modality set in the options.
        given: Modality,
    },
    /// User's model that cannot be run.
    #[error("{name}: {source}")]
    Model {
        /// Name of the model, as passed to [`UserModel::new`].
        name: String,
        /// Fault of the model.
        source: WeightsError,
    },
    /// Damaged weights among those compiled into the program.
    #[error("the built-in network for {modality} images is damaged ({source}): install the program again")]
    Weights {
        /// Modality whose weights are damaged.
        modality: Modality,
        /// Fault of the weights.
        source: WeightsError,
    },
}

/// Detects the cones in `image`.
///
/// Whatever `options` leaves as `None` is estimated from the image. Positions and spacings are in
/// px of `image`.
///
/// # Errors
/// Fails if the image is too small, is constant, or has pixels that are not finite numbers. Fails
/// also if the options are out of range or contradict each other, or if a model cannot be run.
///
/// # Examples
/// ```
/// use conemosaic::prelude::*;
///
/// let image = read("fixtures/images/split_sparse.png".as_ref())?;
/// let options = DetectOptions { modality: Some(Modality::Split), ..DetectOptions::default() };
/// let found = detect(&image, &options)?;
/// let first = &found.cones[0];
/// println!("x {:.1} px, y {:.1} px, score {:.2}", first.centre.x, first.centre.y, first.score);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn detect(image: &Plane, options: &DetectOptions) -> Result<Detections, DetectError> {
    options.validate()?;
    let (imaged, left, top) = without_margin(image)?;
    let mut found = detect_imaged(&imaged, options)?;
    found.move_by(left, top);
    Ok(found)
}

/// Returns the part of the image inside its black margins, and the first column and row of that
/// part.
///
/// The edges of a margin look like cones, and the spectrum of a margin would be added to that of
/// the mosaic. The grey values of the part are rescaled if [`in_range`] finds them extremely small
/// or large.
fn without_margin(image: &Plane) -> Result<(Cow<'_, Plane>, usize, usize), DetectError> {
    check(image)?;
    let part = imaged_part(image);
    let (height, width) = image.dim();
    if (part.height, part.width) == (height, width) {
        return Ok((in_range(Cow::Borrowed(image)), 0, 0));
    }
    if is_too_small(part.width, part.height) {
        let (imaged_width, imaged_height) = (part.width, part.height);
        return Err(DetectError::TooLittleImaged { width, height, imaged_width, imaged_height });
    }
    let imaged = crop(image, part.top, part.left, part.height, part.width);
    check(&imaged)?;
    Ok((in_range(Cow::Owned(imaged)), part.left, part.top))
}

/// Multiplies grey values by a power of two if they are so small or large that their squares or
/// sums might underflow or overflow in single precision.
///
/// Nothing else changes, because a power of two only changes the exponents. Extremely small values
/// come, for example, from 64-bit integers of which only the lowest few bits are used.
fn in_range(image: Cow<'_, Plane>) -> Cow<'_, Plane> {
    let largest = f64::from(image.iter().fold(0f32, |top, v| top.max(v.abs())));
    let exponent = largest.log2().floor();
    if exponent.abs() <= USUAL_EXPONENT {
        return image;
    }
    let factor = (-exponent).exp2();
    let mut image = image.into_owned();
    image.mapv_inplace(|v| (f64::from(v) * factor) as f32);
    Cow::Owned(image)
}

/// Returns the features by which the modality and the polarity of an image are decided.
///
/// # Errors
/// Fails if the image, without its black margin, is too small or constant, or if a pixel is not a
/// finite number.
pub fn modality_features(image: &Plane) -> Result<ModalityFeatures, DetectError> {
    let (imaged, ..) = without_margin(image)?;
    let rings = View::suitable(&imaged, None).rings;
    Ok(modality::features(rings.sample(), rings.whole()))
}

/// Detects the cones in an image without a black margin.
///
/// A split-detector image whose derivative runs in another direction than x is turned first.
fn detect_imaged(image: &Plane, options: &DetectOptions) -> Result<Detections, DetectError> {
    let view = View::suitable(image, options.spacing_start());
    let (angle, confidence) = modality::direction(view.rings.sample(), view.rings.whole(), options);
    if angle != 0. {
        // filters and networks expect the derivative along x
        let turn = Turn::whole(angle, view.field().image.dim());
        let options = &DetectOptions { modality: Some(Modality::Split), ..options.clone() };
        let mut found = detect_upright(&view.turned(&turn), options)?;
        turn.scaled(view.block).restore(&mut found);
        found.split_angle = Some(angle);
        found.modality_confidence = confidence.unwrap_or(1.);
        return Ok(found);
    }
    detect_upright(&view, options)
}

/// Detects the cones in an image whose derivative, if it shows one, runs along x.
///
/// If the user set no spacing and the spacing found has a confidence below [`SURE`], coarser pixels
/// are tried: if they show a ring of higher confidence, the image is searched once more in them,
/// and the better of the two results is kept.
fn detect_upright(view: &View<'_>, options: &DetectOptions) -> Result<Detections, DetectError> {
    let (height, width) = view.field().image.dim();
    let dim = (height * view.block, width * view.block);
    let mut found = detect_in(view, options)?;
    if options.spacing_start().is_none()
        && found.spacing_confidence < SURE
        && let Some(wider) = view.wider(found.spacing_confidence)
    {
        let other = detect_in(&wider, options)?;
        // the more regular mosaic is taken; if the spacing found first is hopeless, a wider one of
        // higher confidence is taken even if its mosaic is less regular
        let regularity = |found: &Detections| regularity(&found.centres(), dim);
        let surer = other.spacing_confidence > found.spacing_confidence;
        if found.spacing_confidence < HOPELESS && surer || regularity(&other) > regularity(&found) {
            found = other;
        }
    }
    Ok(found)
}

/// Detects the cones in `view`, the image at one resolution, and returns them in px of the image.
fn detect_in(view: &View<'_>, options: &DetectOptions) -> Result<Detections, DetectError> {
    let (field, rings) = (view.field(), &view.rings);
    let (modality, modality_confidence, mut polarity) =
        modality::decide(rings.sample(), rings.whole(), options.modality, options.polarity);
    let ring = rings.whole().spacing();
    // until `enlarge` at the end, lengths are in px of the view
    let given = options.spacing_start().map(|s| s / view.block as f64);
    let mut start = match given {
        None => Start { least: ring.least, ..Start::at(rings.map()) },
        Some(spacing) => Start::at(SpacingMap::constant(spacing)),
    };
    if options.spacing.is_some() {
        start = start.kept();
    }
    let clarity = |spacing: f64| rings.whole().clarity(spacing);
    let spec = spec(modality);
    // the user's model and its network, unless it is for another modality
    let own = options.model.as_ref().and_then(|own| Some((own, own.for_modality(modality)?)));
    let network = network_for(options, spec, own.map(|(_, model)| model))?;
    let search = |start: &Start, finder: &dyn ConeFinder| {
        field.until_settled(start, finder.settled(), |part, spacing| {
            let sought = Sought { polarity, spacing, clarity: clarity(spacing) };
            finder.find(part, sought).map_err(|source| match own {
                Some((own, _)) => DetectError::Model { name: own.name().to_owned(), source },
                None => DetectError::Weights { modality, source },
            })
        })
    };
    // the built-in network if this modality is searched with it alone; a user's network always
    // follows the classical filter
    let at_once = network.filter(|_| spec.starts_with_network && own.is_none());
    let first: &dyn ConeFinder = at_once.map_or(&spec.filter, |network| network);
    let (mut found, mut map) = search(&start, first)?;
    if given.is_none()
        && let Some(other) = start.contradicted_by(&found.centres(), field.image.dim(), field.empty)
    {
        // the density of the detections contradicts the ring: of the two starts, the one that leads
        // to the more regular mosaic is taken
        let searched = search(&other, first)?;
        let dim = field.image.dim();
        if regularity(&searched.0.centres(), dim) > regularity(&found.centres(), dim) {
            (found, map) = searched;
            start = other;
        }
    }
    if let (None, Some(network)) = (at_once, network) {
        (found, map) = search(&Start { map, ..start }, network)?;
    }
    let spacing = map.typical();
    // a network that runs first detects both polarities, and the detected cells show their polarity
    // more reliably than the image as a whole
    if at_once.is_some() && options.polarity.is_none() && !found.cones.is_empty() {
        polarity = modality::of_cells(field.image, &found.centres(), spacing);
    }
    let moved = (spacing / ring.spacing).ln().abs();
    let clarity = clarity(spacing);
    let mut detections = Detections {
        cones: found.cones,
        rejected: found.rejected,
        modality,
        modality_confidence,
        polarity,
        detector: if network.is_some() { Detector::Learned } else { Detector::Classical },
        ring_spacing: ring.spacing,
        ring_confidence: ring.confidence,
        clarity,
        spacing_confidence: calibration::spacing(ring.confidence, moved, clarity),
        spacing,
        spacing_map: map,
        split_angle: (modality == Modality::Split).then_some(0.),
    };
    if view.block > 1 {
        detections.enlarge(view.block as f64);
    }
    Ok(detections)
}

/// Returns the network to use, or `None` for the classical filter.
///
/// The user's network, `own`, takes precedence. The built-in network is used if the options ask for
/// it or if it was measured to be better than the filter.
fn network_for<'a>(
    options: &DetectOptions,
    spec: &'a ModalitySpec,
    own: Option<&'a learned::Model>,
) -> Result<Option<&'a learned::Model>, DetectError> {
    if own.is_some() || options.detector == Detector::Classical {
        return Ok(own);
    }
    let model =
        spec.network.model().map_err(|source| DetectError::Weights { modality: spec.modality, source })?;
    Ok((options.detector == Detector::Learned || model.better).then_some(model))
}

/// Returns whether the width or the height, in px, is less than [`MIN_SIDE`].
const fn is_too_small(width: usize, height: usize) -> bool {
    width < MIN_SIDE || height < MIN_SIDE
}

/// Refuses images that are too small, are constant or have a pixel that is not a finite number.
fn check(image: &Plane) -> Result<(), DetectError> {
    let (height, width) = image.dim();
    if is_too_small(width, height) {
        return Err(DetectError::TooSmall { width, height });
    }
    if let Some(((y, x), &value)) = image.indexed_iter().find(|(_, v)| !v.is_finite()) {
        return Err(DetectError::NotFinite { x, y, value });
    }
    let value = image[[0, 0]];
    if image.iter().all(|&v| v == value) { Err(DetectError::Constant { value }) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::{MosaicOptions, RenderOptions, simulate};
    use rand::SeedableRng;

    #[test]
    fn all_weights_together_are_small() {
        assert!(weights().map(<[u8]>::len).iter().sum::<usize>() <= 400_000);
    }

    #[test]
    fn a_black_margin_moves_the_cones_and_changes_nothing_else() {
        let options = RenderOptions { width: 90, height: 80, ..RenderOptions::new(Modality::Confocal) };
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let image = simulate(&MosaicOptions::default(), &options, &mut rng).unwrap().image;
        let image = image.mapv(|v| v.max(0.01));
        let mut framed = Plane::zeros((120, 150));
        image.indexed_iter().for_each(|((y, x), v)| framed[[y + 15, x + 40]] = *v);
        let found = detect(&image, &DetectOptions::default()).unwrap();
        let within = detect(&framed, &DetectOptions::default()).unwrap();
        assert_eq!(found.spacing, within.spacing);
        assert_eq!(found.cones.len(), within.cones.len());
        for (a, b) in found.cones.iter().zip(&within.cones) {
            assert!(
                (a.centre.x + 40. - b.centre.x).abs() < 1e-9 && (a.centre.y + 15. - b.centre.y).abs() < 1e-9
            );
        }
    }

    fn waves(height: usize, width: usize) -> Plane {
        Plane::from_shape_fn((height, width), |(y, x)| {
            1. + (0.7 * x as f32).sin() * (0.75 * y as f32).cos() + 0.1 * ((x * 31 + y * 17) % 11) as f32
        })
    }

    #[test]
    fn the_unit_of_grey_values_changes_nothing_however_small_or_large() {
        let image = waves(90, 100);
        let found = detect(&image, &DetectOptions::default()).unwrap();
        assert!(!found.cones.is_empty());
        for exponent in [-120, -56, 60, 120] {
            let scaled = image.mapv(|v| v * 2f32.powi(exponent));
            let cones = detect(&scaled, &DetectOptions::default()).unwrap().cones;
            assert_eq!(cones.len(), found.cones.len());
            for (a, b) in cones.iter().zip(&found.cones) {
                assert!(a.centre.distance(b.centre) < 1e-3, "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn an_image_of_which_little_was_imaged_is_said_to_be_that() {
        let mut image = Plane::zeros((150, 150));
        image[[70, 80]] = 0.5;
        image[[71, 81]] = 0.7;
        let error = detect(&image, &DetectOptions::default()).unwrap_err().to_string();
        assert!(error.starts_with("only 2 × 2 px of the image (150 × 150 px) are not black"), "{error}");
    }

    #[test]
    fn detections_become_a_mosaic_in_the_window_of_their_image() {
        let image = waves(90, 100);
        let found = detect(&image, &DetectOptions::default()).unwrap();
        let mosaic = found.mosaic(&image, None).unwrap();
        assert_eq!(mosaic.points(), found.centres());
        assert_eq!(mosaic.window().area(), 9000.);
    }
}
