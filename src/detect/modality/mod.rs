//! How an image was taken and which way round its contrast runs, decided from the image.
//!
//! A small network tells modalities apart; `scripts/train-modality` trains it on hand-marked and on simulated images, as they are and
//! with gamma ½ and 2, noise, blur, over- and underexposed, as negatives and as crops. A logistic regression by the same script says
//! which way round a split detector is. Once cut cells are found, their own contrast says which way round it runs ([`of_cells`]).

mod features;
mod network;

pub(super) use network::weights;

use super::spacing::RingProfile;
use super::spec::{PolarityCue, spec};
use super::{Modality, Polarity};
use crate::geometry::Point;
use crate::image::{Plane, gaussian};
use features::{DIRECTION, Features, MODALITY};

/// Widths of Gaussians, in spacings: within a cut cell, and beyond its walls.
const MIDDLE: f64 = 0.1;
const CELL: f64 = 0.5;

/// Pixels from which on an image may be larger than its flattened part.
const LARGE: usize = 512 * 512;

/// Dark on the left is how instruments are set up: odds of two to one, in logits.
const USUAL: f64 = 0.7;

/// What tells images apart, as `scripts/train-modality` reads it: numbers without units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModalityFeatures {
    /// What shows the modality: of slopes along x the excess over those along y and skewness, coarse and fine; skewness of blobs; of
    /// grey values skewness, kurtosis, shape and ends; scatter of the cones' heights; the spectrum around the ring.
    pub modality: [f64; MODALITY],
    /// What shows on which side a split detector has cones dark: skewness of its filter's response, of slopes along x, coarse and fine,
    /// and of blobs.
    pub direction: [f64; DIRECTION],
}

/// The modality, the probability, 0–1, that it is the true one, and the polarity of a flattened image, or of a part that stands for
/// all of it; what the user gave stays as given.
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

/// What [`decide`] looks at.
pub(super) fn features(flat: &Plane, ring: &RingProfile) -> ModalityFeatures {
    let features = features_of(flat, ring);
    ModalityFeatures { modality: features.of_modality(), direction: features.of_direction(flat) }
}

fn features_of(flat: &Plane, ring: &RingProfile) -> Features {
    // of a large image this is but a part: where cones are not equally dense everywhere, its ring is its own
    let own = (flat.len() >= LARGE).then(|| RingProfile::of(flat));
    Features::of(flat, own.as_ref().unwrap_or(ring))
}

/// The polarity of cut cells whose centres are known: whether they are brighter there than all around.
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
