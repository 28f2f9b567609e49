//! From an image to cone centres: flatten → spacing → filter → maxima → suppress → select → refine. Every stage can be called
//! alone; [`detect`] is their composition. Knows nothing of files or statistics.

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
use finder::{ConeFinder, Sought};
use search::regularity;
use spacing::Start;
use spec::{ModalitySpec, SPECS, spec};
use std::borrow::Cow;
use strum::VariantArray;
use thiserror::Error;
use view::View;

/// Shortest side of an image in px: below, there is no room for even a handful of cones at the closest spacing.
pub const MIN_SIDE: usize = 24;

/// Number of files of weights: of a network per modality, of the spacing and of the modality.
const FILES: usize = Modality::VARIANTS.len() + 2;

/// Returns the weights compiled into the program: results depend on them.
pub fn weights() -> [&'static [u8]; FILES] {
    let others = [spacing::ring_weights(), modality::weights()];
    let mut all = SPECS.iter().map(|spec| spec.network.weights()).chain(others);
    std::array::from_fn(|_| all.next().unwrap_or_default())
}

/// Images whose largest grey value is at most 2 to this power, or as far below 1, are filtered as they are.
const USUAL_EXPONENT: f64 = 20.;

/// A spacing of more confidence than this is not doubted.
const SURE: f64 = 0.9;
/// Nothing speaks for a spacing of less confidence than this.
const HOPELESS: f64 = 0.1;

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
    /// Too few pixels that are not a black margin.
    #[error(
        "only {imaged_width} × {imaged_height} px of the {width} × {height} px of the image are not black: at least {MIN_SIDE} × {MIN_SIDE} px must be imaged"
    )]
    TooLittleImaged {
        /// Width in px.
        width: usize,
        /// Height in px.
        height: usize,
        /// Width in px of what is not a margin.
        imaged_width: usize,
        /// Height in px of what is not a margin.
        imaged_height: usize,
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
    #[error("a spacing of {0} px is outside {low}–{high} px", low = SPACING_RANGE.0, high = WIDEST_SPACING)]
    Spacing(f64),
    /// A side of tiles outside its range.
    #[error("tiles of {0} spacings cannot be mapped: give a side of 6 to 60 spacings")]
    TileSide(f64),
    /// The spectrum shows no ring.
    #[error("the spectrum of the image has no ring between {low} and {high} px: it shows no regular mosaic", low = SPACING_RANGE.0, high = SPACING_RANGE.1)]
    NoRing,
    /// A model that would not be used.
    #[error("the classical detector uses no model: leave out the one or the other")]
    Unused,
    /// A model for other images than these.
    #[error("{name} is a model of {own} images: it is not used on {given} ones")]
    OtherModality {
        /// The model, as it was given.
        name: String,
        /// What it was made for.
        own: Modality,
        /// What the images are said to be.
        given: Modality,
    },
    /// The user's model fails.
    #[error("{name}: {source}")]
    Model {
        /// As it was given.
        name: String,
        /// What is wrong with it.
        source: WeightsError,
    },
    /// The weights in the program are damaged.
    #[error("the learned detector of {modality} images cannot be read: {source}")]
    Weights {
        /// Which weights.
        modality: Modality,
        /// What is wrong with them.
        source: WeightsError,
    },
}

/// The cones of an image, by the method that `options` leaves open decided from the image.
///
/// # Errors
/// If the image is too small, constant, or has pixels that are not numbers, or an option is out of range.
pub fn detect(image: &Plane, options: &DetectOptions) -> Result<Detections, DetectError> {
    options.validate()?;
    let (imaged, left, top) = without_margin(image)?;
    let mut found = detect_imaged(&imaged, options)?;
    found.move_by(left, top);
    Ok(found)
}

/// Returns the image without a straight black margin, whose edges look like cones and which has a spectrum of its own; and where
/// what is left begins, px.
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

/// Brings grey values whose squares or sums single precision cannot hold into its range, by a power of two, which changes nothing
/// else. Integers of 64 bits that use but a few of them are that small.
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

/// What the modality and the polarity of an image are decided by.
///
/// # Errors
/// If the image is too small, constant, or has pixels that are not numbers.
pub fn modality_features(image: &Plane) -> Result<ModalityFeatures, DetectError> {
    let (imaged, ..) = without_margin(image)?;
    let rings = View::suitable(&imaged, None).rings;
    Ok(modality::features(rings.sample(), rings.whole()))
}

/// The cones of an image without a straight margin.
fn detect_imaged(image: &Plane, options: &DetectOptions) -> Result<Detections, DetectError> {
    let view = View::suitable(image, options.spacing);
    let mut found = detect_in(&view, options)?;
    if options.spacing.is_none()
        && found.spacing_confidence < SURE
        && let Some(wider) = view.wider(found.spacing_confidence)
    {
        let other = detect_in(&wider, options)?;
        // two spacings are in doubt: the more regular mosaic is right, unless nothing speaks for the closer one
        let regularity = |found: &Detections| regularity(&found.centres(), image.dim());
        let surer = other.spacing_confidence > found.spacing_confidence;
        if found.spacing_confidence < HOPELESS && surer || regularity(&other) > regularity(&found) {
            found = other;
        }
    }
    Ok(found)
}

/// The cones of a view, in px of the image.
fn detect_in(view: &View<'_>, options: &DetectOptions) -> Result<Detections, DetectError> {
    let (field, rings) = (view.field(), &view.rings);
    let (modality, modality_confidence, mut polarity) =
        modality::decide(rings.sample(), rings.whole(), options.modality, options.polarity);
    let ring = rings.whole().spacing();
    let given = options.spacing.map(|s| s / view.block as f64);
    let mut start = match given {
        None => Start { map: rings.map(), least: ring.least },
        Some(spacing) => Start { map: SpacingMap::constant(spacing), least: 0. },
    };
    let clarity = |spacing: f64| rings.whole().clarity(spacing);
    let spec = spec(modality);
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
    let at_once = network.filter(|_| spec.starts_with_network && own.is_none());
    let first: &dyn ConeFinder = at_once.map_or(&spec.filter, |network| network);
    let (mut found, mut map) = search(&start, first)?;
    if given.is_none()
        && let Some(other) = start.contradicted_by(&found.centres(), field.image.dim(), field.empty)
    {
        // ring and density cannot both be right: the more regular mosaic is
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
    // a network that runs first finds dark cells as well as bright ones, and cells tell their polarity more surely than the image
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
    };
    if view.block > 1 {
        detections.enlarge(view.block as f64);
    }
    Ok(detections)
}

/// Returns the network to use, the user's `own` before that of the program, or none for the classical filter.
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

const fn is_too_small(width: usize, height: usize) -> bool {
    width < MIN_SIDE || height < MIN_SIDE
}

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
        assert!(error.starts_with("only 2 × 2 px of the 150 × 150 px"), "{error}");
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
