use super::Detection;
use crate::geometry::Point;

/// Greedy non-maximum suppression: from the highest score down, a detection stays unless one that stayed lies within
/// `radius` (px). Equal scores go by reading order. The result runs from the highest score to the lowest.
pub fn suppress(mut detections: Vec<Detection>, radius: f64) -> Vec<Detection> {
    detections.sort_by(|a, b| {
        b.score
            .total_cmp(&a.score)
            .then(a.centre.y.total_cmp(&b.centre.y))
            .then(a.centre.x.total_cmp(&b.centre.x))
    });
    if radius <= 0. {
        return detections;
    }
    let Some(grid) = Grid::around(&detections, radius) else { return detections };
    let mut taken: Vec<u32> = vec![NONE; grid.cells()];
    // cells are a radius wide: several that stayed may share one, chained from the last to the first
    let mut before: Vec<u32> = Vec::new();
    let mut kept: Vec<Detection> = Vec::new();
    for d in detections {
        let near = |mut k: u32| {
            while k != NONE {
                if kept[k as usize].centre.distance(d.centre) <= radius {
                    return true;
                }
                k = before[k as usize];
            }
            false
        };
        if !grid.around_cell(d.centre).any(|cell| near(taken[cell])) {
            let cell = grid.cell(d.centre);
            before.push(taken[cell]);
            taken[cell] = kept.len() as u32;
            kept.push(d);
        }
    }
    kept
}

const NONE: u32 = u32::MAX;

/// Cells of one radius over all detections.
struct Grid {
    left: f64,
    top: f64,
    side: f64,
    columns: usize,
    rows: usize,
}

impl Grid {
    /// `None` if there is nothing to lay it over.
    fn around(detections: &[Detection], radius: f64) -> Option<Self> {
        let range = |value: fn(&Detection) -> f64| {
            let values = detections.iter().map(value);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
        };
        let ((left, right), (top, bottom)) = (range(|d| d.centre.x), range(|d| d.centre.y));
        if !(right >= left && bottom >= top) {
            return None;
        }
        // never many more cells than detections, however small the radius
        let least = ((right - left) * (bottom - top) / (4 * detections.len()) as f64).sqrt();
        let side = radius.max(least).max((right - left).max(bottom - top) / 1e6);
        let count = |length: f64| (length / side) as usize + 1;
        Some(Self { left, top, side, columns: count(right - left), rows: count(bottom - top) })
    }

    const fn cells(&self) -> usize {
        self.columns * self.rows
    }

    fn place(&self, p: Point) -> (usize, usize) {
        let column = ((p.x - self.left) / self.side) as usize;
        let row = ((p.y - self.top) / self.side) as usize;
        (column.min(self.columns - 1), row.min(self.rows - 1))
    }

    fn cell(&self, p: Point) -> usize {
        let (column, row) = self.place(p);
        row * self.columns + column
    }

    /// The cell of a place and its neighbours.
    fn around_cell(&self, p: Point) -> impl Iterator<Item = usize> {
        let (column, row) = self.place(p);
        let columns = column.saturating_sub(1)..(column + 2).min(self.columns);
        (row.saturating_sub(1)..(row + 2).min(self.rows))
            .flat_map(move |j| columns.clone().map(move |i| j * self.columns + i))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, score: f64) -> Detection {
        Detection { centre: Point::new(x, 0.), score }
    }

    #[test]
    fn the_higher_of_two_neighbours_stays() {
        let kept = suppress(vec![at(0., 1.), at(0.9, 2.), at(1.8, 1.5), at(3., 0.5)], 1.);
        let places: Vec<f64> = kept.iter().map(|d| d.centre.x).collect();
        assert_eq!(places, [0.9, 3.]);
    }

    #[test]
    fn no_two_that_stay_are_within_the_radius() {
        let many = (0..400).map(|k| {
            let k = f64::from(k);
            Detection { centre: Point::new((k * 7.31) % 20., (k * 3.77) % 20.), score: (k * 0.618) % 1. }
        });
        let kept = suppress(many.collect(), 1.5);
        for (i, a) in kept.iter().enumerate() {
            assert!(kept[..i].iter().all(|b| a.centre.distance(b.centre) > 1.5));
        }
    }
}
