use crate::geometry::Point;
use serde::{Deserialize, Serialize};

/// A map of the cone spacing in px: a smooth function of position.
///
/// The map has values at the nodes of a grid. Between nodes, the logarithm of the spacing is
/// interpolated bilinearly; beyond the outermost nodes, it stays constant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpacingMap {
    /// Positions x of the columns of nodes in px, in rising order.
    x: Vec<f64>,
    /// Positions y of the rows of nodes in px, in rising order.
    y: Vec<f64>,
    /// Natural logarithms of the spacings in px at the nodes, row by row.
    log: Vec<f64>,
}

impl SpacingMap {
    /// Returns a map with the same `spacing`, in px, everywhere.
    pub fn constant(spacing: f64) -> Self {
        Self { x: vec![0.], y: vec![0.], log: vec![spacing.ln()] }
    }

    /// Returns the map whose spacings at the nodes `x` × `y` are `spacing` (px), row by row.
    ///
    /// `x` and `y` must be rising and not empty. A node without a spacing takes the mean logarithm
    /// of its neighbours; this is repeated, outwards from the known nodes, until every node has a
    /// spacing. If no node has a spacing, the map is constant at `otherwise` px.
    pub(in crate::detect) fn on_grid(
        x: Vec<f64>,
        y: Vec<f64>,
        spacing: &[Option<f64>],
        otherwise: f64,
    ) -> Self {
        let mut log: Vec<Option<f64>> = spacing.iter().map(|s| s.map(f64::ln)).collect();
        log.resize(x.len() * y.len(), None);
        if log.iter().all(Option::is_none) {
            return Self::constant(otherwise);
        }
        // each round fills the nodes next to known ones
        while log.contains(&None) {
            let known = log.clone();
            for (k, value) in log.iter_mut().enumerate().filter(|(_, v)| v.is_none()) {
                let (mut sum, mut count) = (0., 0);
                around(k, x.len(), y.len(), |other, _| {
                    if let Some(l) = known[other] {
                        sum += l;
                        count += 1;
                    }
                });
                *value = (count > 0).then(|| sum / f64::from(count));
            }
        }
        Self { x, y, log: log.into_iter().flatten().collect() }
    }

    /// Returns a map that rises from `from` px at x = 0 to `to` px at x = `width`.
    #[cfg(test)]
    pub(in crate::detect) fn ramp(width: f64, from: f64, to: f64) -> Self {
        Self::on_grid(vec![0., width], vec![0.], &[Some(from), Some(to)], from)
    }

    /// Returns the map with every node's logarithm averaged with those of its neighbours.
    ///
    /// The weights are 4 for the node itself, 2 for a neighbour along a side and 1 along a
    /// diagonal: the products of the weights 1, 2, 1 along x and along y.
    pub(super) fn smoothed(&self) -> Self {
        let (columns, rows) = (self.x.len(), self.y.len());
        let log = (0..self.log.len())
            .map(|k| {
                let (mut sum, mut total) = (4. * self.log[k], 4.);
                around(k, columns, rows, |other, is_diagonal| {
                    let weight = if is_diagonal { 1. } else { 2. };
                    sum += weight * self.log[other];
                    total += weight;
                });
                sum / total
            })
            .collect();
        Self { x: self.x.clone(), y: self.y.clone(), log }
    }

    /// Returns the spacing at the point `p`, in px.
    pub fn at(&self, p: Point) -> f64 {
        let ((i, s), (j, t)) = (between(&self.x, p.x), between(&self.y, p.y));
        let columns = self.x.len();
        let (right, lower) = ((i + 1).min(columns - 1), (j + 1).min(self.y.len() - 1));
        let along = |row: usize| {
            let (a, b) = (self.log[row * columns + i], self.log[row * columns + right]);
            a + s * (b - a)
        };
        let (upper, below) = (along(j), along(lower));
        (upper + t * (below - upper)).exp()
    }

    /// Returns the geometric mean of the spacings at the nodes, in px.
    pub fn typical(&self) -> f64 {
        (self.log.iter().sum::<f64>() / self.log.len() as f64).exp()
    }

    /// Returns the map multiplied by the factor nearest to 1 that brings the logarithm of its
    /// typical spacing to within `trust` of that of `spacing` px.
    pub(super) fn within(mut self, spacing: f64, trust: f64) -> Self {
        let off = (self.typical() / spacing).ln();
        let excess = off - off.clamp(-trust, trust);
        if excess != 0. {
            self.log.iter_mut().for_each(|log| *log -= excess);
        }
        self
    }

    /// Returns the smallest and the largest spacing, in px.
    pub fn range(&self) -> (f64, f64) {
        let (low, high) =
            self.log.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), l| (a.min(*l), b.max(*l)));
        (low.exp(), high.exp())
    }

    /// Returns whether the spacing is the same everywhere.
    pub fn is_constant(&self) -> bool {
        self.log.iter().all(|l| *l == self.log[0])
    }

    /// Shifts all nodes by `right` px in x and by `down` px in y.
    pub(in crate::detect) fn move_by(&mut self, right: f64, down: f64) {
        self.x.iter_mut().for_each(|x| *x += right);
        self.y.iter_mut().for_each(|y| *y += down);
    }

    /// Converts all positions and spacings to px of the image from px of a coarser image, whose
    /// pixels are means over blocks of `times` × `times` px.
    pub(in crate::detect) fn enlarge(&mut self, times: f64) {
        self.x.iter_mut().chain(&mut self.y).for_each(|x| *x = (*x + 0.5) * times - 0.5);
        self.log.iter_mut().for_each(|log| *log += times.ln());
    }

    /// Returns the largest absolute difference between the logarithms of this map and of the map
    /// `earlier`, at the nodes of this map.
    pub(in crate::detect) fn change_from(&self, earlier: &Self) -> f64 {
        let mut largest = 0f64;
        for (j, &y) in self.y.iter().enumerate() {
            for (i, &x) in self.x.iter().enumerate() {
                let before = earlier.at(Point::new(x, y)).ln();
                largest = largest.max((self.log[j * self.x.len() + i] - before).abs());
            }
        }
        largest
    }
}

/// Calls `visit(index, is_diagonal)` for each of the up to eight neighbours of node `k` in a grid
/// of `columns` × `rows`.
fn around(k: usize, columns: usize, rows: usize, mut visit: impl FnMut(usize, bool)) {
    let (i, j) = (k % columns, k / columns);
    for v in j.saturating_sub(1)..(j + 2).min(rows) {
        for u in i.saturating_sub(1)..(i + 2).min(columns) {
            if (u, v) != (i, j) {
                visit(v * columns + u, u != i && v != j);
            }
        }
    }
}

/// Returns the index of the last node at or before the position `place`, and the fraction (0–1) of
/// the way from that node to the next at which `place` lies.
///
/// Beyond either end of the nodes, the result is the outermost node and 0.
fn between(nodes: &[f64], place: f64) -> (usize, f64) {
    let after = nodes.partition_point(|n| *n <= place);
    match after {
        0 => (0, 0.),
        k if k == nodes.len() => (k - 1, 0.),
        k => (k - 1, (place - nodes[k - 1]) / (nodes[k] - nodes[k - 1])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_nodes_the_logarithm_is_linear() {
        let map = SpacingMap::on_grid(vec![0., 10.], vec![0.], &[Some(4.), Some(16.)], 1.);
        for (x, spacing) in [(-5., 4.), (0., 4.), (5., 8.), (10., 16.), (99., 16.)] {
            assert!((map.at(Point::new(x, 3.)) - spacing).abs() < 1e-12);
        }
        assert!((map.typical() - 8.).abs() < 1e-12);
    }

    #[test]
    fn nodes_without_a_value_take_their_neighbours() {
        let map = SpacingMap::on_grid(vec![0., 1., 2.], vec![0.], &[Some(9.), None, None], 1.);
        assert!(map.is_constant() && (map.typical() - 9.).abs() < 1e-12);
        assert_eq!(SpacingMap::on_grid(vec![0., 1.], vec![0.], &[None, None], 7.), SpacingMap::constant(7.));
    }
}
