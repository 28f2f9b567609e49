use super::{Configure, Density, Frame, Parameter, SampleError};
use crate::geometry::{Point, Polygon, Window};
use rand::Rng;
use std::fmt;

/// A way to put n points into a window.
pub trait Sampler: fmt::Debug + Send + Sync {
    /// The name users type: lower case, words joined by hyphens.
    fn name(&self) -> &'static str;

    /// One line: what it makes, its parameters, its source.
    fn about(&self) -> &'static str;

    /// About `n` points of `frame` (exactly `n` where [`Sampler::exact`] says so), in the half-open
    /// ranges of its bounds. The same generator state gives the same points.
    ///
    /// # Errors
    /// If `n` is out of the method's range, or it found no room for `n` points.
    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError>;

    /// Returns whether exactly the n points asked for are made, instead of the nearest number or
    /// one left to chance; `false` unless a sampler says so. A polygon is cut out of a pattern, so
    /// that none is exact there but those that fill it.
    fn exact(&self) -> bool {
        false
    }

    /// Returns whether nothing tells the seam of a torus; `true` unless a sampler says otherwise.
    fn periodic(&self) -> bool {
        true
    }

    /// Returns whether points stand in rows along the sides of the window, so that how the window
    /// lies matters to them; `false` unless a sampler says so.
    fn in_rows(&self) -> bool {
        false
    }

    /// Returns the sampler as one with parameters: `Some(self)` for those that are [`Settable`](super::Settable).
    fn settable(&self) -> Option<&dyn Configure> {
        None
    }

    /// Returns what can be set by [`Sampler::configure`].
    fn parameters(&self) -> Vec<Parameter> {
        self.settable().map_or(Vec::new(), Configure::described)
    }

    /// Returns the same method with other parameters, given as (name, value).
    ///
    /// # Errors
    /// If there is no such parameter or the value is out of its range.
    fn configure(&self, settings: &[(&str, &str)]) -> Result<Box<dyn Sampler>, SampleError> {
        let name = settings.first().map_or("", |(name, _)| name);
        let none = || Err(SampleError::unknown_parameter(self.name(), name, &[]));
        self.settable().map_or_else(none, |sampler| sampler.configured(settings))
    }

    /// The same method for points as dense as `density` says, if it can; otherwise `None`.
    fn with_density(&self, _density: &Density) -> Option<Box<dyn Sampler>> {
        None
    }

    /// Returns whether mosaics are compared with it unless others are named: samplers that retinas
    /// come near to, and independent points for scale. Their mean curves come with the program
    /// (`scripts/make-curves`).
    fn by_default(&self) -> bool {
        false
    }

    /// The setting of it that mosaics are compared with, where that is not the default one.
    fn as_reference(&self) -> Option<&'static dyn Sampler> {
        None
    }

    /// [`Sampler::fill`] for methods that take long: `progress` hears of steps done, of how many at
    /// most.
    ///
    /// # Errors
    /// As [`Sampler::fill`].
    fn fill_watched(
        &self,
        n: usize,
        frame: &Frame,
        rng: &mut dyn Rng,
        _progress: &mut Watch<'_>,
    ) -> Result<Vec<Point>, SampleError> {
        self.fill(n, frame, rng)
    }

    /// [`Sampler::sample_watched`] without a listener.
    ///
    /// # Errors
    /// As there.
    fn sample(&self, n: usize, window: &Window, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        self.sample_watched(n, window, rng, &mut |_, _| ())
    }

    /// About `n` points of `window`, by [`Sampler::fill`]: the bounds of a rectangle or torus are
    /// filled.
    ///
    /// A polygon is cut out of a pattern of the same density in its bounds. How many points it
    /// holds is left to chance; patterns are drawn until their number is within .5 % of `n`, at
    /// most 32, and the nearest is taken.
    ///
    /// # Errors
    /// If `n` or the window is out of the method's range, or it found no room for the points.
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

/// What hears of a sampler's progress: steps done, and of how many at most.
pub type Watch<'a> = dyn FnMut(usize, usize) + 'a;

/// The pattern nearest to `n` points in number that a polygon cuts out of fillings of its bounds,
/// of whose points it holds about `share`.
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

/// Of at most `tries` patterns the one whose number of points is nearest to `n`; one that is near
/// enough ends the search.
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

/// Most patterns drawn to cut a polygon out of, and how near, as a share of n, a number must come
/// to end the search.
const CUTS: usize = 32;
const CLOSE: f64 = 0.005;
