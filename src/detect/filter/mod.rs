//! Filters whose local maxima are cones, one a modality. All take a plane and the cone spacing in px.

mod confocal;
mod histology;
mod split;

pub(super) use histology::blobs;

use crate::detect::calibration;
use crate::detect::search::Found;
use crate::detect::{Detection, Modality, Polarity, local_maxima, suppress};
use crate::image::{Plane, fill_rows};

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

/// The cones that the modality's filter finds in an image whose cones are about `spacing` px apart.
pub(super) fn cones(
    image: &Plane,
    modality: Modality,
    polarity: Polarity,
    spacing: f64,
    clarity: f64,
) -> Found {
    let (response, criterion) = response(image, modality, polarity, spacing, clarity);
    let maxima = suppress(local_maxima(&response, criterion.threshold), criterion.suppression * spacing);
    let least = criterion.least(&maxima);
    let (mut cones, mut rejected): (Vec<_>, Vec<_>) = maxima.into_iter().partition(|d| d.score > least);
    let probability = calibration::classical(modality, &cones, least);
    cones.iter_mut().chain(&mut rejected).for_each(|d| d.score = probability(d.score));
    Found { cones, rejected }
}

/// The response of the modality's classical filter at the given cone spacing (px), and what counts as a cone in it. The
/// filters are odd: the other polarity is the same with the sign turned. That of confocal images is wider where the `clarity` of
/// the image is low ([`RingProfile::clarity`](crate::detect::RingProfile::clarity)); infinity: a clear one.
pub fn response(
    image: &Plane,
    modality: Modality,
    polarity: Polarity,
    spacing: f64,
    clarity: f64,
) -> (Plane, Criterion) {
    let (mut response, criterion) = match modality {
        Modality::Confocal => confocal::response(image, spacing, clarity),
        Modality::Split => split::response(image, spacing),
        Modality::Histology => histology::response(image, spacing),
    };
    if polarity == Polarity::Negative {
        response.mapv_inplace(|v| -v);
    }
    (response, criterion)
}

/// −∇² by five points, the border mirrored.
fn negative_laplacian(plane: &Plane) -> Plane {
    let (h, w) = plane.dim();
    let plane = plane.as_standard_layout();
    let data = plane.as_slice().unwrap_or_default();
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
