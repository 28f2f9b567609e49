//! How an image was taken and which way round its contrast runs, decided from the image.
//!
//! Each decision is a sum of evidence whose sign decides: weights are those of a logistic regression, fitted on hand-marked and on
//! simulated images, as they are and with gamma ½ and 2, noise, blur, as negatives and as crops. So evidence is in logits. The
//! constant of the waveguides was then moved until no hand-marked image but a few disturbed ones was taken for histology. Once cut cells
//! are found, their own contrast says which way round it runs ([`of_cells`]).

use super::spacing::{AROUND as AROUND_RING, RingProfile};
use super::{Modality, Polarity, filter, flatten::normalise, local_maxima, suppress};
use crate::geometry::Point;
use crate::image::{Plane, gaussian};

/// Widths of Gaussians, in spacings: of slopes, fine and coarse, and of grey values that noise must not blur.
const FINE: f64 = 0.1;
const COARSE: f64 = 0.2;
const GREY: f64 = 0.08;
/// Neighbourhood, in spacings, in which grey values are compared.
const AROUND: f64 = 1.5;
/// Widths of Gaussians, in spacings: within a cut cell, and beyond its walls.
const MIDDLE: f64 = 0.1;
const CELL: f64 = 0.5;
/// Maxima lower than this part of their median are not cones.
const CONE: f64 = 0.3;

/// Pixels from which on an image may be larger than its flattened part.
const LARGE: usize = 512 * 512;
/// Dark on the left is how instruments are set up: odds of two to one, in logits.
const USUAL: f64 = 0.7;

/// Weights, per unit, of the spectrum around the ring ([`RingProfile::around`]) as evidence of waveguides: round soft spots have
/// little power above the ring, and an uneven brightness much below it; discs have edges.
const SPOTS_SPECTRUM: [f64; AROUND_RING] =
    [-1.52, 1.62, 0.28, 0.33, 0.61, 1.15, -0.6, -1.13, -0.72, -0.53, -0.96, -0.17, 0.65, 0.44, -0.3];

/// The modality and polarity of a flattened image, or of a part that stands for all of it; what the user gave stays as given.
pub(super) fn decide(
    flat: &Plane,
    ring: &RingProfile,
    modality: Option<Modality>,
    polarity: Option<Polarity>,
) -> (Modality, Polarity) {
    if let (Some(modality), Some(polarity)) = (modality, polarity) {
        return (modality, polarity);
    }
    // of a large image this is but a part: where cones are not equally dense everywhere, its ring is its own
    let own = (flat.len() >= LARGE).then(|| RingProfile::of(flat));
    let features = Features::of(flat, own.as_ref().unwrap_or(ring));
    let modality = modality.unwrap_or_else(|| features.modality());
    let evidence = || match modality {
        Modality::Split => features.dark_left(flat),
        // cones make high maxima, what lies between them shallow minima
        Modality::Confocal | Modality::Histology => features.blobs_skewness,
    };
    let polarity =
        polarity.unwrap_or_else(|| if evidence() >= 0. { Polarity::Positive } else { Polarity::Negative });
    (modality, polarity)
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

/// What tells images apart.
struct Features {
    /// Spacing by the ring, px.
    spacing: f64,
    /// Response of a filter as wide as a cone, and its skewness.
    blobs: Plane,
    blobs_skewness: f64,
    /// Logarithm of the variance of slopes along x over that along y: a split detector shows the derivative along x.
    directed: f64,
    /// Skewness of the slopes along x, fine and coarse: a cone between its dark and its bright side is steeper than what lies
    /// between cones.
    fine_slopes: f64,
    coarse_slopes: f64,
    /// The spectrum around the ring of discs.
    spectrum: [f64; AROUND_RING],
    /// Of local grey values, the brighter side that of the cones.
    greys: Greys,
}

impl Features {
    fn of(flat: &Plane, ring: &RingProfile) -> Self {
        let spacing = ring.spacing().spacing;
        let blobs = filter::blobs(flat, spacing);
        let blobs_skewness = Moments::of(blobs.iter()).skewness();
        let fine = Slopes::of(&gaussian(flat, FINE * spacing));
        let coarse = Slopes::of(&gaussian(flat, COARSE * spacing));
        let directed = (fine.along_x.variance() / fine.along_y.variance().max(f64::MIN_POSITIVE)).ln();
        Self {
            spacing,
            spectrum: ring.around(spacing),
            greys: Greys::of(flat, spacing, blobs_skewness < 0.),
            blobs,
            blobs_skewness,
            directed,
            fine_slopes: fine.along_x.skewness(),
            coarse_slopes: coarse.along_x.skewness(),
        }
    }

    fn modality(&self) -> Modality {
        let split = 16.38 * self.directed - 1.45 * self.greys.skewness + 11.66 * self.coarse_slopes.abs()
            - 3.19 * self.blobs_skewness.abs()
            - 1.93;
        if split > 0. {
            Modality::Split
        } else if self.waveguides() > 0. {
            Modality::Confocal
        } else {
            Modality::Histology
        }
    }

    /// Evidence that cones are waveguides seen end-on rather than cut discs.
    fn waveguides(&self) -> f64 {
        let spectrum: f64 = SPOTS_SPECTRUM.iter().zip(&self.spectrum).map(|(w, p)| w * p).sum();
        6.98 * self.greys.kurtosis.ln() - 13.3 * self.greys.boxiness + 2.53 * self.greys.skewness
            - 12.39 * self.greys.asymmetry
            + 8.8 * self.scatter_of_heights()
            + spectrum
            - 5.
    }

    /// Coefficient of variation of the cones' heights: waveguides scatter more than cut discs.
    fn scatter_of_heights(&self) -> f64 {
        let upright = if self.blobs_skewness < 0. { self.blobs.mapv(|v| -v) } else { self.blobs.clone() };
        let maxima = suppress(local_maxima(&upright, 0.), 0.55 * self.spacing);
        let median = maxima.get(maxima.len() / 2).map_or(0., |d| d.score);
        let heights: Vec<f32> =
            maxima.iter().map(|d| d.score).filter(|h| *h > CONE * median).map(|h| h as f32).collect();
        let moments = Moments::of(heights.iter());
        if moments.mean > 0. { moments.variance().sqrt() / moments.mean } else { 0. }
    }

    /// Evidence that a split detector shows cones dark on the left.
    fn dark_left(&self, flat: &Plane) -> f64 {
        let (response, _) =
            filter::response(flat, Modality::Split, Polarity::Positive, self.spacing, f64::INFINITY);
        let response = Moments::of(response.iter()).skewness();
        26.8 * response + 3. * self.coarse_slopes - 10. * self.fine_slopes + 4.6 * self.blobs_skewness + USUAL
    }
}

/// Differences of neighbouring pixels.
struct Slopes {
    along_x: Moments,
    along_y: Moments,
}

impl Slopes {
    fn of(plane: &Plane) -> Self {
        let (width, plane) = (plane.ncols(), plane.as_standard_layout());
        let data = plane.as_slice().unwrap_or_default();
        let along_x: Vec<f32> =
            data.chunks_exact(width.max(1)).flat_map(|row| row.windows(2).map(|p| p[1] - p[0])).collect();
        let along_y: Vec<f32> = data.iter().skip(width).zip(data).map(|(below, here)| below - here).collect();
        Self { along_x: Moments::of(along_x.iter()), along_y: Moments::of(along_y.iter()) }
    }
}

/// How grey values are distributed around their local mean, in local standard deviations.
struct Greys {
    skewness: f64,
    kurtosis: f64,
    /// Interquartile range over the range from 5 % to 95 %: large where most pixels are either disc or ground.
    boxiness: f64,
    /// How much further the bright end lies from the median than the dark end, in parts of the range from 5 % to 95 %.
    asymmetry: f64,
}

impl Greys {
    fn of(flat: &Plane, spacing: f64, negative: bool) -> Self {
        let smooth = gaussian(flat, GREY * spacing);
        let local = normalise(&(&smooth - &gaussian(&smooth, AROUND * spacing)), AROUND * spacing);
        let moments = Moments::of(local.iter());
        let mut values: Vec<f32> = local.into_iter().collect();
        let mut quantile = |part: f64| {
            let rank = (part * (values.len() - 1) as f64) as usize;
            f64::from(*values.select_nth_unstable_by(rank, f32::total_cmp).1)
        };
        let [low, lower, median, upper, high] = [0.05, 0.25, 0.5, 0.75, 0.95].map(&mut quantile);
        let range = (high - low).max(f64::MIN_POSITIVE);
        let sign = if negative { -1. } else { 1. };
        Self {
            skewness: sign * moments.skewness(),
            kurtosis: moments.kurtosis(),
            boxiness: (upper - lower) / range,
            asymmetry: sign * (high + low - 2. * median) / range,
        }
    }
}

/// Mean and central moments, per value.
struct Moments {
    mean: f64,
    second: f64,
    third: f64,
    fourth: f64,
}

impl Moments {
    fn of<'a>(values: impl ExactSizeIterator<Item = &'a f32> + Clone) -> Self {
        let n = values.len().max(1) as f64;
        let mean = values.clone().map(|&v| f64::from(v)).sum::<f64>() / n;
        let (mut second, mut third, mut fourth) = (0., 0., 0.);
        for &v in values {
            let d = f64::from(v) - mean;
            second += d * d;
            third += d * d * d;
            fourth += d * d * d * d;
        }
        Self { mean, second: second / n, third: third / n, fourth: fourth / n }
    }

    const fn variance(&self) -> f64 {
        self.second
    }

    /// Third standardised moment; 0 for a constant.
    fn skewness(&self) -> f64 {
        self.third / self.second.max(f64::MIN_POSITIVE).powf(1.5)
    }

    /// Fourth standardised moment; at least 1.
    fn kurtosis(&self) -> f64 {
        (self.fourth / self.second.max(f64::MIN_POSITIVE).powi(2)).max(1.)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_coin_is_symmetric_and_rare_heights_are_not() {
        let coin = Moments::of([-1., 1., -1., 1.].iter());
        assert_eq!((coin.skewness(), coin.kurtosis()), (0., 1.));
        let rare: Vec<f32> = (0..100).map(|i| if i == 5 { 1. } else { 0. }).collect();
        let rare = Moments::of(rare.iter());
        assert!(rare.skewness() > 9. && rare.kurtosis() > 90.);
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

    #[test]
    fn slopes_along_x_outweigh_those_along_y_in_stripes() {
        let stripes =
            Plane::from_shape_fn((40, 50), |(y, x)| (0.7 * x as f32).sin() + (0.1 * y as f32).sin());
        let slopes = Slopes::of(&stripes);
        assert!(slopes.along_x.variance() > 20. * slopes.along_y.variance());
    }
}
