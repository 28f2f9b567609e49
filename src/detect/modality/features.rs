//! Features that tell images of one modality and polarity from those of another.
//!
//! 1. Slopes: differences of neighbouring pixels along x and along y, after fine and coarse
//!    smoothing.
//! 2. Blobs: the response of a filter as wide as a cone, its skewness and the scatter of its
//!    maxima.
//! 3. Grey values: the shape of their distribution around the local mean.
//! 4. The power spectrum around Yellott's ring.

use crate::detect::spacing::{AROUND as AROUND_RING, RingProfile};
use crate::detect::{Modality, Polarity, filter, flatten::normalise, local_maxima, suppress};
use crate::image::{Plane, gaussian, values};

/// Standard deviation, in spacings, of the Gaussian that smooths an image before fine slopes are
/// taken.
const FINE: f64 = 0.1;
/// Standard deviation, in spacings, of the Gaussian that smooths an image before coarse slopes are
/// taken.
const COARSE: f64 = 0.2;
/// Standard deviation, in spacings, of the Gaussian that smooths an image before grey values are
/// compared.
///
/// Without it, noise would blur the distribution of grey values.
const GREY: f64 = 0.08;
/// Standard deviation, in spacings, of the Gaussian neighbourhood whose mean and scatter serve as
/// reference for grey values.
const AROUND: f64 = 1.5;
/// Smallest range of grey values that other values are divided by, in local standard deviations.
///
/// Without this floor, the range could be 0: more than half of an image may be a single grey value.
const LEAST_RANGE: f64 = 1e-2;
/// Smallest height of a maximum that counts as a cone, as a fraction of the median height of all
/// maxima.
const CONE: f64 = 0.3;

/// Number of features that tell modalities apart: eleven of slopes, blobs and grey values, and the
/// spectrum around the ring.
pub(super) const MODALITY: usize = 11 + AROUND_RING;
/// Number of features that tell whether cones in a split-detector image are dark on the left or on
/// the right.
pub(super) const DIRECTION: usize = 4;

/// Features by which the modality and the polarity of an image are recognised.
pub(super) struct Features {
    /// Cone spacing estimated from Yellott's ring, in px.
    spacing: f64,
    /// Response of a filter as wide as a cone.
    blobs: Plane,
    /// Skewness of `blobs`, the response of a filter as wide as a cone.
    pub blobs_skewness: f64,
    /// Logarithm of the ratio of the variance of fine slopes along x to that along y.
    ///
    /// It is high for split-detector images, because they show the derivative along x.
    directed: f64,
    /// Skewness of the slopes along x after fine smoothing.
    ///
    /// A cone is steeper between its dark and its bright side than the ground between cones is.
    fine_slopes: f64,
    /// Skewness of the slopes along x after coarse smoothing.
    coarse_slopes: f64,
    /// Logarithm of the power at frequencies around the ring, see [`RingProfile::around`].
    ///
    /// Round soft spots have little power above the ring's frequency, discs have more because of
    /// their edges, and uneven brightness has much below it.
    spectrum: [f64; AROUND_RING],
    /// Distribution of grey values around their local mean, with its signs chosen as if cones were
    /// bright.
    greys: Greys,
}

impl Features {
    /// Returns the features of the flattened image `flat`, in whose spectrum `ring` was found.
    pub(super) fn of(flat: &Plane, ring: &RingProfile) -> Self {
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

    /// Returns the features that show the modality; they have no unit.
    ///
    /// They are the same for an image, its negative and its mirror image.
    pub(super) fn of_modality(&self) -> [f64; MODALITY] {
        let greys = &self.greys;
        let [fine, coarse] = [self.fine_slopes, self.coarse_slopes];
        let mut features = [0.; MODALITY];
        let (own, spectrum) = features.split_at_mut(MODALITY - AROUND_RING);
        own.copy_from_slice(&[
            self.directed,
            coarse.abs(),
            fine * coarse.signum(),
            self.blobs_skewness.abs(),
            greys.skewness,
            greys.kurtosis.ln(),
            greys.boxiness,
            greys.asymmetry,
            greys.bright_end,
            greys.dark_end,
            self.scatter_of_heights(),
        ]);
        spectrum.copy_from_slice(&self.spectrum);
        features
    }

    /// Returns the features that tell whether cones in a split-detector image are dark on the left
    /// or on the right.
    ///
    /// The negative of an image has the same features with the opposite sign.
    pub(super) fn of_direction(&self, flat: &Plane) -> [f64; DIRECTION] {
        let (response, _) =
            filter::response(flat, Modality::Split, Polarity::Positive, self.spacing, f64::INFINITY);
        let response = Moments::of(response.iter()).skewness();
        [response, self.coarse_slopes, self.fine_slopes, self.blobs_skewness]
    }

    /// Returns the coefficient of variation of the cones' heights in `blobs`.
    ///
    /// The heights of waveguides (confocal) scatter more than those of cut discs (histology).
    fn scatter_of_heights(&self) -> f64 {
        let upright = if self.blobs_skewness < 0. { self.blobs.mapv(|v| -v) } else { self.blobs.clone() };
        // of two maxima closer than this, one is no cone: the confocal filter has the same limit
        let maxima = suppress(local_maxima(&upright, 0.), 0.55 * self.spacing);
        let median = maxima.get(maxima.len() / 2).map_or(0., |d| d.score);
        let heights: Vec<f32> =
            maxima.iter().map(|d| d.score).filter(|h| *h > CONE * median).map(|h| h as f32).collect();
        let moments = Moments::of(heights.iter());
        if moments.mean > 0. { moments.variance().sqrt() / moments.mean } else { 0. }
    }
}

/// Moments of the differences of neighbouring pixels, along x and along y.
struct Slopes {
    along_x: Moments,
    along_y: Moments,
}

impl Slopes {
    fn of(plane: &Plane) -> Self {
        let (width, data) = (plane.ncols(), values(plane));
        let along_x: Vec<f32> =
            data.chunks_exact(width.max(1)).flat_map(|row| row.windows(2).map(|p| p[1] - p[0])).collect();
        let along_y: Vec<f32> =
            data.iter().skip(width).zip(&*data).map(|(below, here)| below - here).collect();
        Self { along_x: Moments::of(along_x.iter()), along_y: Moments::of(along_y.iter()) }
    }
}

/// Distribution of grey values around their local mean, in local standard deviations.
struct Greys {
    /// Third standardised moment, with its sign switched if cones are dark, as if they were bright.
    skewness: f64,
    /// Fourth standardised moment, which is at least 1.
    kurtosis: f64,
    /// Interquartile range, divided by the range from the 5 % to the 95 % quantile.
    ///
    /// It is large where most pixels belong either to a disc or to the ground.
    boxiness: f64,
    /// Distance of the bright end from the median less that of the dark end, divided by the
    /// distance between the ends.
    ///
    /// The ends are the 5 % and the 95 % quantile, and cones are on the bright side.
    asymmetry: f64,
    /// Distance between the outermost hundredth and the outermost twentieth of the grey values on
    /// the side of the cones, divided by the range from the 5 % to the 95 % quantile.
    ///
    /// It is close to 0 where grey values are cut off there: bright cones in an overexposed image.
    bright_end: f64,
    /// Distance between the outermost hundredth and the outermost twentieth of the grey values on
    /// the side of the ground, divided by the range from the 5 % to the 95 % quantile.
    ///
    /// It is close to 0 where grey values are cut off there: dark ground where the zero of a camera
    /// was set too high.
    dark_end: f64,
}

impl Greys {
    /// Returns the distribution of grey values in a flattened image; `negative` is `true` if cones
    /// are darker than the ground.
    fn of(flat: &Plane, spacing: f64, negative: bool) -> Self {
        let smooth = gaussian(flat, GREY * spacing);
        let local = normalise(&(&smooth - &gaussian(&smooth, AROUND * spacing)), AROUND * spacing);
        let moments = Moments::of(local.iter());
        let mut values: Vec<f32> = local.into_iter().collect();
        let mut quantile = |part: f64| {
            let rank = (part * (values.len() - 1) as f64) as usize;
            f64::from(*values.select_nth_unstable_by(rank, f32::total_cmp).1)
        };
        let [lowest, low, lower, median, upper, high, highest] =
            [0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99].map(&mut quantile);
        let range = (high - low).max(LEAST_RANGE);
        let sign = if negative { -1. } else { 1. };
        let (above, below) = ((highest - high) / range, (low - lowest) / range);
        let (bright_end, dark_end) = if negative { (below, above) } else { (above, below) };
        Self {
            skewness: sign * moments.skewness(),
            kurtosis: moments.kurtosis(),
            boxiness: (upper - lower) / range,
            asymmetry: sign * (high + low - 2. * median) / range,
            bright_end,
            dark_end,
        }
    }
}

/// Mean and central moments of a set of values; every sum is divided by the number of values.
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

    /// Returns the third standardised moment; 0 for a constant.
    fn skewness(&self) -> f64 {
        self.third / self.second.max(f64::MIN_POSITIVE).powf(1.5)
    }

    /// Returns the fourth standardised moment, which is at least 1.
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
    fn slopes_along_x_outweigh_those_along_y_in_stripes() {
        let stripes =
            Plane::from_shape_fn((40, 50), |(y, x)| (0.7 * x as f32).sin() + (0.1 * y as f32).sin());
        let slopes = Slopes::of(&stripes);
        assert!(slopes.along_x.variance() > 20. * slopes.along_y.variance());
    }
}
