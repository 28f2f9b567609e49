//! Filters whose local maxima are cones, one a modality. All take a plane and the cone spacing in px.

mod confocal;
mod histology;
mod split;

pub(super) use histology::{blobs, evened};

use crate::detect::{Detection, Modality, Polarity};
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
        // highest first: the upper quartile stands a quarter of the way down
        if let (Some(relative), Some(quartile)) = (self.relative, maxima.get(maxima.len() / 4)) {
            let least = relative.slope * quartile.score + relative.offset;
            maxima.retain(|d| d.score > least);
        }
        maxima
    }
}

/// The response of the modality's classical filter at the given cone spacing (px), and what counts as a cone in it. The
/// filters are odd: the other polarity is the same with the sign turned.
pub fn response(image: &Plane, modality: Modality, polarity: Polarity, spacing: f64) -> (Plane, Criterion) {
    let (mut response, criterion) = match modality {
        Modality::Confocal => confocal::response(image, spacing),
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
