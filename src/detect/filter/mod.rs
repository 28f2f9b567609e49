//! Filters whose local maxima are cones, one a modality. All take a plane and the cone spacing in px.

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

/// What counts as a cone in a filter's response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Criterion {
    /// Maxima must be higher than this.
    pub threshold: f32,
    /// Of two maxima nearer to each other than this, in units of the spacing, the lower one goes.
    pub suppression: f64,
    /// How high those that remain must be for this image, if that depends on the image.
    pub relative: Option<RelativeThreshold>,
}

/// A threshold that follows the image: slope × upper quartile of the maxima + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelativeThreshold {
    /// Weight of the upper quartile.
    pub slope: f64,
    /// In the unit of the response.
    pub offset: f64,
}

impl Criterion {
    /// The cones among maxima that suppression has left, highest first.
    pub fn select(&self, mut maxima: Vec<Detection>) -> Vec<Detection> {
        let least = self.least(&maxima);
        maxima.retain(|d| d.score > least);
        maxima
    }

    /// How high a cone must be among `maxima`, the highest first.
    fn least(&self, maxima: &[Detection]) -> f64 {
        // highest first: the upper quartile stands a quarter of the way down
        match (self.relative, maxima.get(maxima.len() / 4)) {
            (Some(relative), Some(quartile)) => relative.slope * quartile.score + relative.offset,
            _ => f64::from(self.threshold),
        }
    }
}

/// A classical filter, and the probability that its maxima are cones.
pub(super) struct Filter {
    /// Returns the response of an image whose cones are so many px apart, of positive polarity, and what counts as a cone in it; the
    /// last argument is the clarity of the image.
    pub response: fn(&Plane, f64, f64) -> (Plane, Criterion),
    /// Probability of a cone by the height of its maximum,
    pub probability: Logistic,
    /// measured against this.
    pub reference: Reference,
}

impl Filter {
    /// Returns the response in either polarity. The filters are odd: the other polarity is the same with the sign turned.
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

    /// A filter follows the spacing closely.
    fn settled(&self) -> f64 {
        0.005
    }
}

/// The response of the modality's classical filter at the given cone spacing (px), and what counts as a cone in it. That of confocal images is wider where the `clarity` of
/// the image is low ([`RingProfile::clarity`](crate::detect::RingProfile::clarity)); infinity: a clear one.
pub fn response(
    image: &Plane,
    modality: Modality,
    polarity: Polarity,
    spacing: f64,
    clarity: f64,
) -> (Plane, Criterion) {
    spec(modality).filter.respond(image, Sought { polarity, spacing, clarity })
}

/// −∇² by five points, the border mirrored.
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
        // beyond the border lies the edge pixel itself
        out[0] -= here[0];
        out[w - 1] -= here[w - 1];
    })
}
