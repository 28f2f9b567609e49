//! How an image was taken and which way round its contrast runs, decided from the image.

use super::spacing::RingProfile;
use super::{Detection, Modality, Polarity, filter, local_maxima, suppress};
use crate::geometry::{Window, nearest_neighbours};
use crate::image::Plane;

/// Anisotropy of the ring above which an image shows a derivative along x. Hand-marked images: confocal at most .06,
/// split at least .24, whatever gamma, noise or polarity is applied to them; simulated discs reach .17.
const DIRECTED: f64 = 0.2;
/// With fewer cones than this, the spectrum's own scatter passes for a direction: then it takes more.
const ENOUGH_CONES: f64 = 100.;

/// Scatter of the cones' heights, as a coefficient of variation, above which they are waveguides seen end-on (confocal)
/// rather than cut discs (histology). Hand-marked confocal images: at least .43, with gamma 0.5 still .35; simulated
/// histology: at most .35, its median .23.
const WAVEGUIDES: f64 = 0.35;
/// Maxima lower than this part of their median are not cones.
const CONE: f64 = 0.3;

/// Weight of the difference in regularity beside the skewness in the polarity of a split-detector image.
const REGULARITY_WEIGHT: f64 = 0.1;
/// Dark on the left is how instruments are set up: it takes this much evidence to believe in the reverse.
const REVERSED: f64 = -0.05;

/// The modality and polarity of a flattened image; what the user gave stays as given.
pub(super) fn decide(
    flat: &Plane,
    ring: &RingProfile,
    modality: Option<Modality>,
    polarity: Option<Polarity>,
) -> (Modality, Polarity) {
    let modality = modality.unwrap_or_else(|| decide_modality(flat, ring));
    let polarity =
        polarity.unwrap_or_else(|| decide_polarity(flat, modality, ring.spacing(modality).spacing));
    (modality, polarity)
}

fn decide_modality(flat: &Plane, ring: &RingProfile) -> Modality {
    let spacing = ring.spacing(Modality::Split).spacing;
    let cones = flat.len() as f64 / (0.75f64.sqrt() * spacing * spacing);
    if ring.anisotropy(spacing) > DIRECTED * (ENOUGH_CONES / cones).sqrt().max(1.) {
        return Modality::Split;
    }
    let spacing = ring.spacing(Modality::Histology).spacing;
    if scatter_of_heights(flat, spacing) > WAVEGUIDES { Modality::Confocal } else { Modality::Histology }
}

/// Coefficient of variation of the cones' heights: the maxima of a filter as wide as a cone.
fn scatter_of_heights(flat: &Plane, spacing: f64) -> f64 {
    let (mut blobs, suppression) = filter::blobs(flat, spacing);
    if skewness(&filter::evened(&blobs, spacing)) < 0. {
        blobs.mapv_inplace(|v| -v);
    }
    let maxima = suppress(local_maxima(&blobs, 0.), suppression * spacing);
    let median = maxima.get(maxima.len() / 2).map_or(0., |d| d.score);
    let heights: Vec<f64> = maxima.iter().map(|d| d.score).filter(|h| *h > CONE * median).collect();
    let (mean, sd) = mean_and_deviation(&heights);
    if mean > 0. { sd / mean } else { 0. }
}

/// Cones make high, well-spaced maxima of the filter; what lies between them makes shallow minima. So the response is
/// skewed towards the cones, and its extrema on their side are the more regular ones.
fn decide_polarity(flat: &Plane, modality: Modality, spacing: f64) -> Polarity {
    let (response, criterion) = filter::response(flat, modality, Polarity::Positive, spacing);
    let skewness = skewness(&response);
    let evidence = match modality {
        Modality::Confocal | Modality::Histology => skewness,
        Modality::Split => {
            let regularity = |response: &Plane| {
                let maxima = suppress(local_maxima(response, 0.), criterion.suppression * spacing);
                regularity_index(&maxima, response.dim())
            };
            let difference = regularity(&response) - regularity(&response.mapv(|v| -v));
            skewness + REGULARITY_WEIGHT * difference - REVERSED
        }
    };
    if evidence >= 0. { Polarity::Positive } else { Polarity::Negative }
}

/// Mean over standard deviation of the maxima's nearest-neighbour distances; 0 where it is not defined.
fn regularity_index(maxima: &[Detection], (height, width): (usize, usize)) -> f64 {
    let points: Vec<_> = maxima.iter().map(|d| d.centre).collect();
    let Ok(window) = Window::of_image(width, height) else { return 0. };
    let (mean, sd) = mean_and_deviation(&nearest_neighbours(&points, &window).distances);
    if sd > 0. { mean / sd } else { 0. }
}

/// Mean and sample standard deviation; 0 where they are not defined.
fn mean_and_deviation(values: &[f64]) -> (f64, f64) {
    if values.len() < 2 {
        return (values.first().copied().unwrap_or(0.), 0.);
    }
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.);
    (mean, variance.sqrt())
}

/// Third standardised moment.
fn skewness(plane: &Plane) -> f64 {
    let n = plane.len().max(1) as f64;
    let mean = plane.iter().map(|&v| f64::from(v)).sum::<f64>() / n;
    let (mut second, mut third) = (0., 0.);
    for &v in plane {
        let d = f64::from(v) - mean;
        second += d * d;
        third += d * d * d;
    }
    let variance = (second / n).max(f64::MIN_POSITIVE);
    third / n / variance.powf(1.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coin_is_symmetric_and_rare_heights_are_not() {
        let coin = Plane::from_shape_fn((10, 10), |(y, _)| if y < 5 { -1. } else { 1. });
        assert!(skewness(&coin).abs() < 1e-12);
        let rare = Plane::from_shape_fn((10, 10), |(y, x)| if (y, x) == (5, 5) { 1. } else { 0. });
        assert!(skewness(&rare) > 9.);
    }
}
