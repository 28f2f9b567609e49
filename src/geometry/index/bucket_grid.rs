use crate::geometry::Point;

/// Marker of the end of a chain, in place of the index of an item.
const NONE: u32 = u32::MAX;

/// Grid of square cells to which items can be added between queries for items nearby.
///
/// The items of a cell form a chain. A position outside the grid belongs to the nearest outermost
/// cell.
pub(crate) struct BucketGrid<T> {
    /// Upper left corner of the first cell.
    origin: [f64; 2],
    /// Side of a cell.
    side: f64,
    columns: usize,
    rows: usize,
    /// Index of the item that was added last to each cell, or [`NONE`] for an empty cell.
    last: Vec<u32>,
    /// Index of the item that was added to the same cell before each item, or [`NONE`] for the
    /// first item.
    before: Vec<u32>,
    /// Items in the order in which they were added.
    things: Vec<T>,
}

impl<T> BucketGrid<T> {
    /// Creates an empty grid of `columns` × `rows` square cells (at least 1 × 1) of side `side`.
    ///
    /// `origin` is the upper left corner of the first cell.
    pub(crate) fn new(origin: [f64; 2], side: f64, [columns, rows]: [usize; 2]) -> Self {
        let last = vec![NONE; columns * rows];
        Self { origin, side, columns, rows, last, before: Vec::new(), things: Vec::new() }
    }

    /// Returns the column and row of the cell to which a position belongs.
    fn cell(&self, p: Point) -> (usize, usize) {
        let column = ((p.x - self.origin[0]) / self.side) as usize;
        let row = ((p.y - self.origin[1]) / self.side) as usize;
        (column.min(self.columns - 1), row.min(self.rows - 1))
    }

    /// Adds an item at `place`; the grid must contain fewer than 2³² − 1 items.
    pub(crate) fn insert(&mut self, place: Point, thing: T) {
        let (column, row) = self.cell(place);
        let last = &mut self.last[row * self.columns + column];
        self.before.push(*last);
        *last = self.things.len() as u32;
        self.things.push(thing);
    }

    /// Returns all items in the cell to which `place` belongs and in the eight cells around it.
    pub(crate) fn near(&self, place: Point) -> impl Iterator<Item = &T> {
        let (column, row) = self.cell(place);
        let first = (column.saturating_sub(1), row.saturating_sub(1));
        self.block(first, ((column + 1).min(self.columns - 1), (row + 1).min(self.rows - 1)))
    }

    /// Returns all items in the cells that the upright rectangle between two corners touches.
    pub(crate) fn touching(&self, low: Point, high: Point) -> impl Iterator<Item = &T> {
        self.block(self.cell(low), self.cell(high))
    }

    /// Returns all items in the rectangle of cells from (column, row) `first` to `last`, both
    /// included.
    fn block(&self, first: (usize, usize), last: (usize, usize)) -> impl Iterator<Item = &T> {
        let cells = (first.1..=last.1)
            .flat_map(move |row| &self.last[row * self.columns + first.0..=row * self.columns + last.0]);
        cells.flat_map(move |&last| {
            let known = |k: u32| (k != NONE).then_some(k as usize);
            std::iter::successors(known(last), move |&k| known(self.before[k])).map(|k| &self.things[k])
        })
    }

    /// Returns all items in the order in which they were added.
    pub(crate) fn into_things(self) -> Vec<T> {
        self.things
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_within_a_side_is_near_also_beyond_the_edges() {
        let mut grid = BucketGrid::new([0., 0.], 2., [5, 4]);
        let places: Vec<Point> = (0..400)
            .map(|k| Point::new(f64::from(k) * 7.31 % 14. - 2., f64::from(k) * 3.77 % 12. - 2.))
            .collect();
        places.iter().for_each(|&p| grid.insert(p, p));
        for here in &places {
            let near = grid.near(*here).filter(|p| p.distance(*here) < 2.).count();
            assert_eq!(near, places.iter().filter(|p| p.distance(*here) < 2.).count());
        }
        let (low, high) = (Point::new(1., 1.5), Point::new(6.5, 4.));
        let inside = |p: &&Point| p.x >= low.x && p.x < high.x && p.y >= low.y && p.y < high.y;
        let found = grid.touching(low, high).filter(inside).count();
        assert_eq!(found, places.iter().filter(inside).count());
        assert_eq!(grid.into_things(), places);
    }
}
