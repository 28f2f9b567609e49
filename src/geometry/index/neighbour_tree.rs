use crate::geometry::{Point, Window};
use kiddo::kd_tree::ConstructionError;
use kiddo::{Chebyshev, ImmutableKdTree, SquaredEuclidean};
use std::num::NonZero;

/// k-d tree of points, for finding the points nearest to a position; on a torus, distances are
/// those of the short way round.
pub(crate) struct NeighbourTree {
    /// Tree of the points relative to `origin`.
    tree: ImmutableKdTree<f64, 2>,
    /// Upper left corner of the window's bounds, as periodic queries need coordinates that begin at
    /// 0.
    origin: [f64; 2],
    /// Sides of the torus, or `None` in the open plane.
    period: Option<[f64; 2]>,
}

impl NeighbourTree {
    /// Builds a tree of finite points in the open plane.
    ///
    /// # Errors
    /// Fails if there are more points than the tree can number.
    pub(crate) fn in_plane(points: &[Point]) -> Result<Self, ConstructionError> {
        Self::at([0.; 2], None, points)
    }

    /// Builds a tree of finite points in a window.
    ///
    /// # Errors
    /// Fails if there are more points than the tree can number.
    pub(crate) fn in_window(points: &[Point], window: &Window) -> Result<Self, ConstructionError> {
        let bounds = window.bounds();
        let period = window.is_torus().then(|| [bounds.width(), bounds.height()]);
        Self::at([bounds.x0(), bounds.y0()], period, points)
    }

    /// Builds a tree of points relative to `origin`.
    fn at(origin: [f64; 2], period: Option<[f64; 2]>, points: &[Point]) -> Result<Self, ConstructionError> {
        let places: Vec<[f64; 2]> = points.iter().map(|p| [p.x - origin[0], p.y - origin[1]]).collect();
        Ok(Self { tree: ImmutableKdTree::new_from_slice(&places)?, origin, period })
    }

    /// Returns the position of a point relative to `origin`.
    fn place(&self, p: Point) -> [f64; 2] {
        [p.x - self.origin[0], p.y - self.origin[1]]
    }

    /// Returns the indices and squared distances of the `n` points nearest to `place`, the nearest
    /// first.
    pub(crate) fn nearest(&self, place: Point, n: NonZero<usize>) -> impl Iterator<Item = (usize, f64)> {
        let at = self.place(place);
        let query = self.tree.query(&at);
        let found = match &self.period {
            Some(sides) => {
                query.periodic_boundary_condition(sides).nearest_n::<SquaredEuclidean<f64>>(n).execute()
            }
            None => query.nearest_n::<SquaredEuclidean<f64>>(n).execute(),
        };
        found.into_iter().map(|f| (f.item as usize, f.distance))
    }

    /// Returns the indices of the points nearest to `place`, at most `n` of them, whose squared
    /// distance is at most `limit`.
    ///
    /// The search does not go round a torus, so it is meant for the open plane.
    pub(crate) fn nearest_within(
        &self,
        place: Point,
        n: NonZero<usize>,
        limit: f64,
    ) -> impl Iterator<Item = usize> {
        let at = self.place(place);
        let found = self.tree.query(&at).nearest_n::<SquaredEuclidean<f64>>(n).within(limit).execute();
        found.into_iter().map(|f| f.item as usize)
    }

    /// Returns the indices of the points at most `half` away from `place` along x and along y, in
    /// no particular order.
    pub(crate) fn in_square(&self, place: Point, half: f64) -> impl Iterator<Item = usize> {
        let at = self.place(place);
        let query = self.tree.query(&at);
        let found = match &self.period {
            Some(sides) => {
                query.periodic_boundary_condition(sides).within::<Chebyshev<f64>>(half).unsorted().execute()
            }
            None => query.within::<Chebyshev<f64>>(half).unsorted().execute(),
        };
        found.into_iter().map(|f| f.item as usize)
    }
}
