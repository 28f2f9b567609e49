//! Classical filters whose local maxima are cones, one per modality.
//!
//! All filters take a plane and the cone spacing in px.

pub(super) mod confocal;
pub(super) mod histology;
pub(super) mod split;

pub(super) use histology::blobs;

use crate::detect::calibration::{Logistic, Reference};
use crate::detect::finder::{ConeFinder, Found, Sought};
use crate::detect::learned::WeightsError;
use crate::detect::spec::spec;
use crate::detect::{Detection, Modality, Polarity, local_maxima, suppress};
use crate::image::{Plane, fill_rows, values};

/// Criterion by which the maxima of a filter's response are taken for cones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criterion {
    /// Height, in the unit of the response, that maxima must exceed.
    pub threshold: f32,
    /// Distance, in spacings, below which only the higher of two maxima stays.
    pub suppression: f64,
    /// Threshold that replaces `threshold` once suppression has dropped the lower of close maxima,
    /// or `None` if the threshold does not depend on the image.
    pub relative: Option<RelativeThreshold>,
}

/// Threshold that depends on the image: `slope` × the upper quartile of the heights of the maxima +
/// `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelativeThreshold {
    /// Factor by which the upper quartile of the maxima is multiplied.
    pub slope: f64,
    /// Constant that is added to the threshold, in the unit of the response.
    pub offset: f64,
}

impl Criterion {
    /// Returns the cones among the maxima that suppression has left, the highest first.
    pub fn select(&self, mut maxima: Vec<Detection>) -> Vec<Detection> {
        let least = self.least(&maxima);
        maxima.retain(|d| d.score > least);
        maxima
    }

    /// Returns the height that a cone must exceed; `maxima` are sorted, the highest first.
    fn least(&self, maxima: &[Detection]) -> f64 {
        // with the highest first, the upper quartile stands a quarter of the way down
        match (self.relative, maxima.get(maxima.len() / 4)) {
            (Some(relative), Some(quartile)) => relative.slope * quartile.score + relative.offset,
            _ => f64::from(self.threshold),
        }
    }
}

/// A classical filter, and the calibration of its maxima as probabilities.
pub(super) struct Filter {
    /// Function that returns the response to an image, and the criterion for its cones.
    ///
    /// Its arguments are the image, in which cones have positive polarity, the cone spacing in px,
    /// and the clarity of the image.
    pub response: fn(&Plane, f64, f64) -> (Plane, Criterion),
    /// Logistic function from the height of a maximum, measured against `reference`, to the
    /// probability that it is a cone.
    pub probability: Logistic,
    /// Height against which the height of a maximum is measured.
    pub reference: Reference,
}

impl Filter {
    /// Returns the response for cones of the sought polarity, and the criterion for cones.
    ///
    /// All filters are odd, filter(−image) = −filter(image): for negative polarity, the response to
    /// the image only has to change its sign.
    fn respond(&self, image: &Plane, sought: Sought) -> (Plane, Criterion) {
        let (mut response, criterion) = (self.response)(image, sought.spacing, sought.clarity);
        if sought.polarity == Polarity::Negative {
            response.mapv_inplace(|v| -v);
        }
        (response, criterion)
    }
}

impl ConeFinder for Filter {
    fn find(&self, image: &Plane, sought: Sought) -> Result<Found, WeightsError> {
        let (response, criterion) = self.respond(image, sought);
        let maxima =
            suppress(local_maxima(&response, criterion.threshold), criterion.suppression * sought.spacing);
        let least = criterion.least(&maxima);
        let (cones, rejected): (Vec<_>, Vec<_>) = maxima.into_iter().partition(|d| d.score > least);
        let height = self.reference.against(&cones, least);
        let mut found = Found { cones, rejected };
        found.each(|d| d.score = self.probability.at(height(d.score)));
        Ok(found)
    }

    /// Returns .005 (.5 %): the response of a filter follows the spacing closely, so even a small
    /// change of the spacing matters.
    fn settled(&self) -> f64 {
        0.005
    }
}

/// Returns the response of a modality's classical filter to an image whose cones are `spacing` px
/// apart, and the criterion for cones in the response.
///
/// The filter of confocal images is wider where the `clarity` of the image is low
/// ([`RingProfile::clarity`](crate::detect::RingProfile::clarity)). A clarity of infinity stands
/// for an image without noise and leaves the filter at its narrowest.
pub fn response(
    image: &Plane,
    modality: Modality,
    polarity: Polarity,
    spacing: f64,
    clarity: f64,
) -> (Plane, Criterion) {
    spec(modality).filter.respond(image, Sought { polarity, spacing, clarity })
}

/// Returns −∇² of a plane by the five-point difference; beyond its border, the plane continues as
/// its mirror image.
fn negative_laplacian(plane: &Plane) -> Plane {
    let (h, w) = plane.dim();
    let data = values(plane);
    let row = |y: usize| &data[y * w..(y + 1) * w];
    fill_rows(h, w, |y, out| {
        let (here, up, down) = (row(y), row(y.saturating_sub(1)), row((y + 1).min(h - 1)));
        for (x, o) in out.iter_mut().enumerate() {
            *o = 4. * here[x] - up[x] - down[x];
        }
        for (o, left) in out[1..].iter_mut().zip(here) {
            *o -= left;
        }
        for (o, right) in out.iter_mut().zip(&here[1..]) {
            *o -= right;
        }
        // beyond the border lies the edge pixel itself, since mirroring repeats it
        out[0] -= here[0];
        out[w - 1] -= here[w - 1];
    })
}
