//! From an image to cone centres: flatten → spacing → filter → maxima → suppress → select → refine. Every stage can be called
//! alone; [`detect`] is their composition. Knows nothing of files or statistics.

mod calibration;
mod filter;
mod flatten;
mod learned;
mod maxima;
mod modality;
mod options;
mod search;
mod spacing;
mod suppress;
mod tiles;
mod types;
mod view;

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
pub use types::{Detection, Detections, Modality, Polarity};
pub use view::WIDEST_SPACING;

use crate::image::{Plane, crop, imaged_part};
use search::regularity;
use spacing::Start;
use std::borrow::Cow;
use thiserror::Error;
use view::View;

/// Shortest side of an image in px: below, there is no room for even a handful of cones at the closest spacing.
pub const MIN_SIDE: usize = 24;

/// The weights compiled into the program: results depend on them.
pub const fn weights() -> [&'static [u8]; 5] {
    let [confocal, split, histology] = learned::weights();
    [confocal, split, histology, spacing::ring_weights(), modality::weights()]
}

/// Spacings that differ by less than this part are the same.
const SETTLED: f64 = 0.005;
/// The same for a network, which is trained at spacings off by up to 15 %.
const LEARNED_SETTLED: f64 = 0.03;

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

/// The image without a straight black margin, whose edges look like cones and which has a spectrum of its own; and where what is left
/// begins, px.
fn without_margin(image: &Plane) -> Result<(Cow<'_, Plane>, usize, usize), DetectError> {
    check(image)?;
    let part = imaged_part(image);
    if (part.height, part.width) == image.dim() {
        return Ok((Cow::Borrowed(image), 0, 0));
    }
    let imaged = crop(image, part.top, part.left, part.height, part.width);
    check(&imaged)?;
    Ok((Cow::Owned(imaged), part.left, part.top))
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
    let model = model_for(options, modality)?;
    let search = |start: &Start, model: Option<&learned::Model>| match model {
        None => field.until_settled(start, SETTLED, |part, spacing| {
            Ok(filter::cones(part, modality, polarity, spacing, clarity(spacing)))
        }),
        Some(model) => field.until_settled(start, LEARNED_SETTLED, |part, spacing| {
            model.cones(part, polarity, spacing, clarity(spacing)).map_err(|source| match &options.model {
                Some(own) => DetectError::Model { name: own.name().to_owned(), source },
                None => DetectError::Weights { modality, source },
            })
        }),
    };
    // waveguides and inner segments are counted well enough by the quick filter, which a network follows; that of discs counts rods
    // and gaps too, so that the program's network comes at once
    let users = options.model.as_ref().is_some_and(|m| m.for_modality(modality).is_some());
    let at_once = model.filter(|_| modality == Modality::Histology && !users);
    let (mut found, mut map) = search(&start, at_once)?;
    if given.is_none()
        && let Some(other) = start.contradicted_by(&found.centres(), field.image.dim(), field.empty)
    {
        // ring and density cannot both be right: the more regular mosaic is
        let searched = search(&other, at_once)?;
        let dim = field.image.dim();
        if regularity(&searched.0.centres(), dim) > regularity(&found.centres(), dim) {
            (found, map) = searched;
            start = other;
        }
    }
    if at_once.is_none() && model.is_some() {
        (found, map) = search(&Start { map, ..start }, model)?;
    }
    let spacing = map.typical();
    // it finds dark cells as well as bright ones, and cells tell better than gaps what they are
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
        detector: if model.is_some() { Detector::Learned } else { Detector::Classical },
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

/// The network to use, or none for the classical filters.
fn model_for(options: &DetectOptions, modality: Modality) -> Result<Option<&learned::Model>, DetectError> {
    if let Some(model) = options.model.as_ref().and_then(|m| m.for_modality(modality)) {
        return Ok(Some(model));
    }
    if options.detector == Detector::Classical {
        return Ok(None);
    }
    let model = learned::model(modality).map_err(|source| DetectError::Weights { modality, source })?;
    Ok((options.detector == Detector::Learned || model.better).then_some(model))
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
}
