use super::{Configure, Density, Frame, Parameter, SampleError};
use crate::geometry::{Point, Polygon, Window};
use rand::Rng;
use std::fmt;

/// Method that places about n points at random in a window.
pub trait Sampler: fmt::Debug + Send + Sync {
    /// Returns the name that users type: lower case, words joined by hyphens.
    fn name(&self) -> &'static str;

    /// Describes the pattern, the parameters and the source in one line.
    fn about(&self) -> &'static str;

    /// Places about `n` points in `frame` and returns them in the window's coordinates.
    ///
    /// No point lies on the right or lower edge. The number is exactly `n` if [`Sampler::exact`]
    /// returns `true`. The same state of `rng` gives the same points.
    ///
    /// # Errors
    /// Fails if `n` is out of the method's range, or the method finds no room for `n` points.
    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError>;

    /// Returns whether [`Sampler::fill`] always makes exactly `n` points; `false` by default.
    ///
    /// Without this, the number of points is the nearest possible one or is left to chance. In a
    /// polygon, the number is exact only if the sampler fills the polygon directly instead of
    /// cutting it out of a larger pattern.
    fn exact(&self) -> bool {
        false
    }

    /// Returns whether the pattern on a torus has no visible seam; `true` by default.
    fn periodic(&self) -> bool {
        true
    }

    /// Returns whether points stand in rows along the sides of the window, so that the orientation
    /// of the window matters; `false` by default.
    fn in_rows(&self) -> bool {
        false
    }

    /// Returns access to the parameters, or `None` if the sampler has no parameters.
    ///
    /// Samplers that are [`Settable`](super::Settable) return `Some(self)`.
    fn settable(&self) -> Option<&dyn Configure> {
        None
    }

    /// Returns the parameters that [`Sampler::configure`] can set.
    fn parameters(&self) -> Vec<Parameter> {
        self.settable().map_or(Vec::new(), Configure::described)
    }

    /// Returns the same method with other parameters; each setting is a pair of name and value.
    ///
    /// # Errors
    /// Fails if a name belongs to no parameter, or a value is out of its range.
    fn configure(&self, settings: &[(&str, &str)]) -> Result<Box<dyn Sampler>, SampleError> {
        let name = settings.first().map_or("", |(name, _)| name);
        let none = || Err(SampleError::unknown_parameter(self.name(), name, &[]));
        self.settable().map_or_else(none, |sampler| sampler.configured(settings))
    }

    /// Returns the same method for points of relative density `density`, or `None` if the method
    /// cannot vary the density.
    fn with_density(&self, _density: &Density) -> Option<Box<dyn Sampler>> {
        None
    }

    /// Returns whether mosaics are compared with this sampler if the user names no samplers.
    ///
    /// The default samplers are those that retinas come close to, and independent points as a
    /// reference. Mean curves of the default samplers come with the program
    /// (`scripts/make-curves`).
    fn by_default(&self) -> bool {
        false
    }

    /// Returns the sampler in the setting with which mosaics are compared, or `None` if that is the
    /// default setting.
    fn as_reference(&self) -> Option<&'static dyn Sampler> {
        None
    }

    /// Does the work of [`Sampler::fill`] and reports progress, for methods that take long.
    ///
    /// `progress` is called with the number of steps done and the largest possible number of steps.
    /// The default implementation reports nothing.
    ///
    /// # Errors
    /// Fails if [`Sampler::fill`] fails.
    fn fill_watched(
        &self,
        n: usize,
        frame: &Frame,
        rng: &mut dyn Rng,
        _progress: &mut Watch<'_>,
    ) -> Result<Vec<Point>, SampleError> {
        self.fill(n, frame, rng)
    }

    /// Returns the points of [`Sampler::sample_watched`] without reporting progress.
    ///
    /// # Errors
    /// Fails if [`Sampler::sample_watched`] fails.
    fn sample(&self, n: usize, window: &Window, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        self.sample_watched(n, window, rng, &mut |_, _| ())
    }

    /// Returns about `n` random points in `window`, and reports progress as
    /// [`Sampler::fill_watched`] does.
    ///
    /// A rectangle or torus is filled as by [`Sampler::fill`]. A polygon is cut out of a pattern of
    /// the same density in its bounds, so the number of points inside the polygon is left to
    /// chance. Patterns are therefore drawn until the number is within .5 % of `n`, at most 32
    /// times, and the one with the nearest number is used.
    ///
    /// # Errors
    /// Fails if `n` or the window is out of the method's range, or the method finds no room for the
    /// points.
    fn sample_watched(
        &self,
        n: usize,
        window: &Window,
        rng: &mut dyn Rng,
        progress: &mut Watch<'_>,
    ) -> Result<Vec<Point>, SampleError> {
        match window {
            Window::Polygon(polygon) => {
                cut(n, polygon, polygon.area() / polygon.bounds().area(), |n, frame| {
                    self.fill_watched(n, frame, rng, progress)
                })
            }
            Window::Rectangle(_) | Window::Torus(_) => {
                self.fill_watched(n, &Frame::new(n, window)?, rng, progress)
            }
        }
    }
}

/// Callback for a sampler's progress, called with the number of steps done and the largest possible
/// number of steps.
pub type Watch<'a> = dyn FnMut(usize, usize) + 'a;

/// Fills the bounds of a polygon several times and returns the cut-out whose number of points is
/// nearest to `n`.
///
/// `share` is the expected fraction of the points in the bounds that lie inside the polygon.
pub(super) fn cut(
    n: usize,
    polygon: &Polygon,
    share: f64,
    mut fill: impl FnMut(usize, &Frame) -> Result<Vec<Point>, SampleError>,
) -> Result<Vec<Point>, SampleError> {
    let bounds = polygon.bounds();
    let filled = (n as f64 / share).round() as usize;
    let frame = Frame::new(filled, &Window::Rectangle(bounds))?;
    nearest_in_number(n, CUTS, || {
        let mut points = fill(filled, &frame)?;
        points.retain(|&p| polygon.contains(p));
        Ok(points)
    })
}

/// Draws up to `tries` patterns and returns the one whose number of points is nearest to `n`.
///
/// The search ends early at a pattern whose number of points differs from `n` by at most [`CLOSE`]
/// × `n`.
pub(super) fn nearest_in_number(
    n: usize,
    tries: usize,
    mut pattern: impl FnMut() -> Result<Vec<Point>, SampleError>,
) -> Result<Vec<Point>, SampleError> {
    let mut best: Option<(usize, Vec<Point>)> = None;
    for _ in 0..tries {
        let points = pattern()?;
        let miss = points.len().abs_diff(n);
        if best.as_ref().is_none_or(|(least, _)| miss < *least) {
            best = Some((miss, points));
        }
        if miss as f64 <= CLOSE * n as f64 {
            break;
        }
    }
    Ok(best.map(|(_, points)| points).unwrap_or_default())
}

/// Largest number of patterns that are drawn to cut a polygon out of; the best of them is used.
const CUTS: usize = 32;
/// Relative deviation from `n` at which the number of points counts as close enough, so that no
/// further pattern is drawn.
const CLOSE: f64 = 0.005;
