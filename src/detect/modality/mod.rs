//! Modality and polarity of an image, decided from the image.
//!
//! A small network tells modalities apart. `scripts/train-modality` trains it on hand-marked and on
//! simulated images: as they are, with gamma ½ and 2, with noise, blurred, over- and underexposed,
//! as negatives and as crops. A logistic regression by the same script tells whether cones in a
//! split-detector image are dark on the left or on the right. Once cut cells are detected, their
//! own contrast gives the polarity ([`of_cells`]).

mod features;
mod network;

pub(super) use network::weights;

use super::axis::{self, CLEAR_AXIS, Turn};
use super::spacing::RingProfile;
use super::spec::{PolarityCue, spec};
use super::{DetectOptions, Modality, Polarity};
use crate::geometry::Point;
use crate::image::{Plane, gaussian};
use features::{DIRECTION, Features, MODALITY};

/// Standard deviation, in spacings, of the Gaussian that averages the brightness in the middle of a
/// cut cell.
const MIDDLE: f64 = 0.1;
/// Standard deviation, in spacings, of the Gaussian that averages the brightness of a cut cell and
/// of its surroundings beyond the walls.
const CELL: f64 = 0.5;

/// Smallest confidence (0–1) of the modality with which an image that is turned counts as a
/// split-detector image.
const SURELY_SPLIT: f64 = 0.9;
/// Confidence (0–1) of the modality of an image as it is from which it is not turned.
const SURE: f64 = 0.8;

/// Number of pixels of a flattened image from which on it is taken for one tile of a larger image,
/// so that the ring of the tile itself is measured.
///
/// The tiles of a large image are 512 × 512 px.
const LARGE: usize = 512 * 512;

/// Prior evidence, in logits, that cones in a split-detector image are dark on the left.
///
/// Instruments are usually set up that way: odds of two to one.
const USUAL: f64 = 0.7;

/// Features by which the modality and the polarity of an image are decided. They have no unit.
///
/// `scripts/train-modality` reads them, too.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModalityFeatures {
    /// Features that show the modality.
    ///
    /// They are the excess of slopes along x over those along y, the skewness of slopes along x
    /// (coarse, then fine), the skewness of the response of a filter for blobs, the skewness,
    /// kurtosis, shape and ends of the grey values, the scatter of the cones' heights, and the
    /// spectrum around the ring.
    pub modality: [f64; MODALITY],
    /// Features that tell whether cones in a split-detector image are dark on the left or on the
    /// right.
    ///
    /// They are the skewness of the split-detector filter's response, that of slopes along x
    /// (coarse, then fine), and that of the response of a filter for blobs.
    pub direction: [f64; DIRECTION],
}

/// Decides the modality and the polarity of a flattened image, or of a part that stands for all of
/// it.
///
/// Returns the modality, the probability (0–1) that it is right, and the polarity. A `modality` or
/// a `polarity` set by the user is returned as it is. If the user set the modality, its probability
/// is 1.
pub(super) fn decide(
    flat: &Plane,
    ring: &RingProfile,
    modality: Option<Modality>,
    polarity: Option<Polarity>,
) -> (Modality, f64, Polarity) {
    if let (Some(modality), Some(polarity)) = (modality, polarity) {
        return (modality, 1., polarity);
    }
    let features = features_of(flat, ring);
    let (modality, confidence) =
        modality.map_or_else(|| network::most_probable(&features.of_modality()), |given| (given, 1.));
    let evidence = || match spec(modality).polarity {
        PolarityCue::DarkSide => network::dark_left(&features.of_direction(flat)) + USUAL,
        PolarityCue::Blobs => features.blobs_skewness,
    };
    let polarity =
        polarity.unwrap_or_else(|| if evidence() >= 0. { Polarity::Positive } else { Polarity::Negative });
    (modality, confidence, polarity)
}

/// Returns the direction in which the image has to be searched for cones, and the confidence of the
/// modality if that is why it is a split-detector image.
///
/// The direction is 0 (along x) unless the image is a split-detector image whose axis is clearly
/// another. An image that does not look like one along x counts as one only if it certainly does
/// along its axis.
pub(super) fn direction(flat: &Plane, ring: &RingProfile, options: &DetectOptions) -> (f64, Option<f64>) {
    let upright = (0., None);
    if options.modality.is_some_and(|m| m != Modality::Split) {
        return upright;
    }
    let angle = match options.split_angle {
        Some(angle) => axis::wrapped(angle),
        None => {
            let (angle, strength) = axis::axis(flat, ring.spacing().spacing);
            if strength < CLEAR_AXIS { 0. } else { axis::snapped(angle) }
        }
    };
    if angle == 0. || options.modality.is_some() {
        return (angle, None);
    }
    // streaks and lines out of place give confocal images an axis, too; a split-detector image that
    // is not along x looks like histology
    let (as_it_is, sure, _) = decide(flat, ring, None, None);
    if as_it_is == Modality::Confocal && sure >= SURE {
        return upright;
    }
    let turned = Turn::inside(angle, flat.dim()).of(flat);
    let (modality, confidence, _) = decide(&turned, ring, None, None);
    if modality == Modality::Split && confidence >= SURELY_SPLIT {
        (angle, Some(confidence))
    } else {
        upright
    }
}

/// Returns the features by which [`decide`] recognises the modality and the polarity.
pub(super) fn features(flat: &Plane, ring: &RingProfile) -> ModalityFeatures {
    let features = features_of(flat, ring);
    ModalityFeatures { modality: features.of_modality(), direction: features.of_direction(flat) }
}

/// Returns the features of a flattened image, or of a part that stands for all of it.
fn features_of(flat: &Plane, ring: &RingProfile) -> Features {
    // a large `flat` may be only a part of the image: where density is uneven, its ring differs
    // from that of the entire image
    let own = (flat.len() >= LARGE).then(|| RingProfile::of(flat));
    Features::of(flat, own.as_ref().unwrap_or(ring))
}

/// Returns the polarity of the cut cells at `centres`, whose spacing is `spacing` px.
///
/// It is positive if the cells are, on average, brighter in the middle than all around.
pub(super) fn of_cells(image: &Plane, centres: &[Point], spacing: f64) -> Polarity {
    let [middle, around] = [MIDDLE, CELL].map(|width| gaussian(image, width * spacing));
    let (height, width) = image.dim();
    let pixel = |place: f64, length: usize| (place.round().max(0.) as usize).min(length - 1);
    let height_at = |p: &Point| {
        let at = [pixel(p.y, height), pixel(p.x, width)];
        f64::from(middle[at] - around[at])
    };
    if centres.iter().map(height_at).sum::<f64>() >= 0. { Polarity::Positive } else { Polarity::Negative }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detect::flatten;
    use strum::VariantArray;

    #[test]
    fn what_is_given_is_beyond_doubt_and_the_rest_is_not() {
        let flat = flatten(&Plane::from_shape_fn((90, 100), |(y, x)| {
            (0.7 * x as f32).sin() * (0.75 * y as f32).cos() + 0.1 * ((x * 31 + y * 17) % 11) as f32
        }));
        let ring = RingProfile::of(&flat);
        for &modality in Modality::VARIANTS {
            let (taken, confidence, _) = decide(&flat, &ring, Some(modality), None);
            assert_eq!((taken, confidence), (modality, 1.));
        }
        let (_, confidence, _) = decide(&flat, &ring, None, None);
        assert!((1. / 3. ..1.).contains(&confidence), "{confidence}");
    }

    #[test]
    fn cells_are_bright_or_dark_against_what_lies_around_them_whatever_the_rest() {
        let centres = [Point::new(20., 20.), Point::new(40., 22.)];
        let off = |p: &Point, y: usize, x: usize| (x as f64 - p.x).hypot(y as f64 - p.y);
        // dark cells in bright walls, on a ground as dark as they are
        let dark = Plane::from_shape_fn((60, 60), |(y, x)| {
            if centres.iter().any(|p| (5. ..8.).contains(&off(p, y, x))) { 1. } else { 0. }
        });
        assert_eq!(of_cells(&dark, &centres, 20.), Polarity::Negative);
        assert_eq!(of_cells(&-dark, &centres, 20.), Polarity::Positive);
    }
}
