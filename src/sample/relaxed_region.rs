//! Regions in which the relaxing samplers ([`Lloyd`](super::Lloyd), [`Bnot`](super::Bnot)) move
//! points.

use super::{Density, Frame, SampleError, Sampler, Watch, cut};
use crate::geometry::power::{Domain, Raster};
use crate::geometry::{Point, Polygon, Window};
use rand::{Rng, RngExt};

/// Number of random positions tried for one point; if all miss the region, the search fails for
/// lack of room.
const MOST_TRIES: usize = 1_000_000;

/// Region in which points are relaxed, with the density that the points are to have.
///
/// The region is a rectangle, a torus or a convex polygon, moved so that the upper left corner of
/// its bounds is the origin.
pub(super) struct Region {
    pub(super) domain: Domain,
    pub(super) density: Option<Raster>,
    /// Bounds of the region as a frame, which converts positions to points of the window.
    frame: Frame,
    /// Polygon in the window's coordinates, or `None` for a rectangle or torus.
    polygon: Option<Polygon>,
    /// Cumulative sums of the density's values, cell by cell: entry i includes cell i. Empty for an
    /// even density.
    cumulated: Vec<f64>,
}

impl Region {
    /// Creates the region that fills a frame.
    pub(super) fn new(frame: &Frame, density: Option<&Density>) -> Self {
        let domain = match frame.torus {
            true => Domain::Torus { width: frame.width, height: frame.height },
            false => Domain::rectangle(frame.width, frame.height),
        };
        Self::of(*frame, domain, None, density)
    }

    /// Creates the region of a polygon, or `None` if the polygon is not convex.
    ///
    /// # Errors
    /// Fails if [`Frame::new`] fails.
    pub(super) fn convex(
        n: usize,
        polygon: &Polygon,
        density: Option<&Density>,
    ) -> Result<Option<Self>, SampleError> {
        let frame = Frame::new(n, &Window::Rectangle(polygon.bounds()))?;
        let domain = Domain::convex(polygon);
        Ok(domain.map(|domain| Self::of(frame, domain, Some(polygon.clone()), density)))
    }

    fn of(frame: Frame, domain: Domain, polygon: Option<Polygon>, density: Option<&Density>) -> Self {
        let density = density.and_then(|d| d.over(&domain));
        let cumulated = density.as_ref().map_or(Vec::new(), |raster| {
            let mut sum = 0.;
            let add = |value: &f64| {
                sum += value;
                sum
            };
            raster.values().iter().map(add).collect()
        });
        Self { domain, density, frame, polygon, cumulated }
    }

    /// Draws `n` independent points whose distribution follows the density.
    ///
    /// # Errors
    /// Fails if [`MOST_TRIES`] positions in the bounds all miss the region.
    pub(super) fn scatter(
        &self,
        sampler: &'static str,
        n: usize,
        rng: &mut dyn Rng,
    ) -> Result<Vec<[f64; 2]>, SampleError> {
        let one = |placed: usize, rng: &mut dyn Rng| {
            let found = (0..MOST_TRIES).map(|_| self.draw(rng)).find(|p| self.contains(*p));
            found.ok_or(SampleError::NoRoom { sampler, n, placed, attempts: MOST_TRIES })
        };
        (0..n).map(|placed| one(placed, rng)).collect()
    }

    /// Returns whether a position lies inside the region; on a torus, every position does.
    pub(super) fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let within = |polygon: &Polygon| polygon.contains_strictly(self.frame.place(x, y));
        let bounds = (0. ..self.frame.width).contains(&x) && (0. ..self.frame.height).contains(&y);
        self.frame.torus || (bounds && self.polygon.as_ref().is_none_or(within))
    }

    /// Draws a position in the bounds of the region; its distribution follows the density.
    fn draw(&self, rng: &mut dyn Rng) -> [f64; 2] {
        let (u, v): (f64, f64) = (rng.random(), rng.random());
        let (Some(raster), Some(whole)) = (&self.density, self.cumulated.last()) else {
            return [u * self.frame.width, v * self.frame.height];
        };
        let at = rng.random::<f64>() * whole;
        let cell = self.cumulated.partition_point(|sum| *sum <= at).min(self.cumulated.len() - 1);
        let (columns, rows) = raster.shape();
        let within = |i: usize, share: f64, count: usize, side: f64| (i as f64 + share) / count as f64 * side;
        [
            within(cell % columns, u, columns, self.frame.width),
            within(cell / columns, v, rows, self.frame.height),
        ]
    }

    /// Returns the distance between neighbours in a triangular lattice of `n` points in the region.
    pub(super) fn spacing(&self, n: usize) -> f64 {
        crate::mosaic::hexagonal_spacing(n, self.domain.area()).unwrap_or(1.)
    }

    /// Returns the middle of the region's bounds.
    pub(super) fn centre(&self) -> [f64; 2] {
        [self.frame.width / 2., self.frame.height / 2.]
    }

    /// Converts positions in the region to points of the window; on a torus, positions beyond an
    /// edge are wrapped round.
    pub(super) fn place(&self, points: &[[f64; 2]]) -> Vec<Point> {
        let wrapped = points.iter().map(|p| self.domain.wrapped(*p));
        wrapped.map(|[x, y]| self.frame.place(x, y)).collect()
    }
}

/// Sampler that moves points in a [`Region`] until they are regular.
pub(super) trait Relaxes: Sampler {
    /// Returns the density that the points are to have, or `None` for an even density.
    fn density(&self) -> Option<&Density>;

    /// Returns `n` random points of `region` after relaxation, in the window's coordinates.
    fn relax_in(
        &self,
        n: usize,
        region: &Region,
        rng: &mut dyn Rng,
        progress: &mut Watch<'_>,
    ) -> Result<Vec<Point>, SampleError>;

    /// Does the work of [`Sampler::sample_watched`].
    ///
    /// Convex polygons are filled directly; other polygons are cut out of their filled bounds.
    fn relax_window(
        &self,
        n: usize,
        window: &Window,
        rng: &mut dyn Rng,
        progress: &mut Watch<'_>,
    ) -> Result<Vec<Point>, SampleError> {
        let Window::Polygon(polygon) = window else {
            let region = Region::new(&Frame::new(n, window)?, self.density());
            return self.relax_in(n, &region, rng, progress);
        };
        if let Some(region) = Region::convex(n, polygon, self.density())? {
            return self.relax_in(n, &region, rng, progress);
        }
        let share = self.density().map_or(polygon.area() / polygon.bounds().area(), |d| d.share(polygon));
        cut(n, polygon, share, |n, frame| {
            self.relax_in(n, &Region::new(frame, self.density()), rng, progress)
        })
    }
}
