//! How an image was taken and which way round its contrast runs, decided from the image.

use super::flatten::normalise;
use super::spacing::RingProfile;
use super::{Detection, Modality, Polarity, filter, local_maxima, suppress};
use crate::geometry::{Window, nearest_neighbours};
use crate::image::{Plane, gaussian};

/// Anisotropy of the ring above which an image shows a derivative along x. Hand-marked images: confocal at most .06,
/// split at least .24, whatever gamma, noise or polarity is applied to them; simulated discs reach .17.
const DIRECTED: f64 = 0.2;

/// Kurtosis of the band-passed image above which cones are spots rather than discs. Hand-marked confocal images: at
/// least 4.4, with gamma 0.35 still 3.1; discs with sharp edges have two grey values and stay near 2.
const SPOTTED: f64 = 3.;

/// Width of the band in which grey values are judged, in spacings: finer is noise, coarser is illumination.
const BAND: (f64, f64) = (0.13, 1.);
/// Neighbourhood over which that contrast is normalised, in spacings.
const NEIGHBOURHOOD: f64 = 2.;

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
    if ring.anisotropy(ring.spacing(Modality::Split).spacing) > DIRECTED {
        return Modality::Split;
    }
    let spacing = ring.spacing(Modality::Confocal).spacing;
    let band = &gaussian(flat, BAND.0 * spacing) - &gaussian(flat, BAND.1 * spacing);
    let (_, kurtosis) = skewness_and_kurtosis(&normalise(&band, NEIGHBOURHOOD * spacing));
    if kurtosis > SPOTTED { Modality::Confocal } else { Modality::Histology }
}

/// Cones make high, well-spaced maxima of the filter; what lies between them makes shallow minima. So the response is
/// skewed towards the cones, and its extrema on their side are the more regular ones.
fn decide_polarity(flat: &Plane, modality: Modality, spacing: f64) -> Polarity {
    let (response, criterion) = filter::response(flat, modality, Polarity::Positive, spacing);
    let (skewness, _) = skewness_and_kurtosis(&response);
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
    let distances = nearest_neighbours(&points, &window).distances;
    let n = distances.len() as f64;
    let mean = distances.iter().sum::<f64>() / n;
    let variance = distances.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (n - 1.);
    if variance > 0. { mean / variance.sqrt() } else { 0. }
}

/// Third and fourth standardised moments.
fn skewness_and_kurtosis(plane: &Plane) -> (f64, f64) {
    let n = plane.len().max(1) as f64;
    let mean = plane.iter().map(|&v| f64::from(v)).sum::<f64>() / n;
    let (mut second, mut third, mut fourth) = (0., 0., 0.);
    for &v in plane {
        let d = f64::from(v) - mean;
        second += d * d;
        third += d * d * d;
        fourth += d * d * d * d;
    }
    let variance = (second / n).max(f64::MIN_POSITIVE);
    (third / n / variance.powf(1.5), fourth / n / (variance * variance))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_of_a_coin_are_known() {
        let coin = Plane::from_shape_fn((10, 10), |(y, _)| if y < 5 { -1. } else { 1. });
        let (skewness, kurtosis) = skewness_and_kurtosis(&coin);
        assert!(skewness.abs() < 1e-12 && (kurtosis - 1.).abs() < 1e-12);
    }
}
