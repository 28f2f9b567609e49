//! Check of Table 2 of the paper by the triangle inequality.
//!
//! l-infinity is a metric. The printed distances d₁ and d₂ from one mosaic to two samplers
//! therefore limit the distance D between the two samplers: |d₁ − d₂| ≤ D ≤ d₁ + d₂.

use super::printed::PrintedDistances;

/// Pair of samplers for which the triangle inequality of a row of Table 2 is closest to being
/// violated, or violated most.
#[derive(Clone, Debug, PartialEq)]
pub struct Tightest {
    /// Name of the mosaic.
    pub mosaic: String,
    /// Pair of samplers, as indices of columns of Table 2.
    pub between: [usize; 2],
    /// Amount by which the distance between the two samplers may still change before the triangle
    /// inequality is violated; negative if it is violated.
    pub room: f64,
}

/// Returns the pair of samplers whose distance is closest to violating the triangle inequality of
/// `row`, or violates it most.
///
/// `between` contains the measured distances between the samplers, in the order of [`PAIRS`].
pub fn tightest(row: &PrintedDistances, between: &[f64; 3]) -> Tightest {
    let rooms = PAIRS.into_iter().zip(between).map(|([a, b], &distance)| {
        let [low, high] = limits(row, [a, b]);
        Tightest { mosaic: row.name.clone(), between: [a, b], room: (distance - low).min(high - distance) }
    });
    let none = Tightest { mosaic: row.name.clone(), between: PAIRS[0], room: f64::INFINITY };
    rooms.fold(none, |least, next| if next.room < least.room { next } else { least })
}

/// Returns the range of distances between the samplers of a `pair` of columns that the triangle
/// inequalities of all rows allow: lower and upper end. The lower end exceeds the upper one if the
/// rows contradict each other.
pub fn allowed(rows: &[PrintedDistances], pair: [usize; 2]) -> [f64; 2] {
    rows.iter()
        .map(|row| limits(row, pair))
        .fold([0., f64::INFINITY], |[low, high], next| [low.max(next[0]), high.min(next[1])])
}

/// Pairs of columns of Table 2 whose samplers are compared. Lists of three distances between
/// samplers have this order.
pub const PAIRS: [[usize; 2]; 3] = [[0, 1], [0, 2], [1, 2]];

/// Returns the range of distances between the samplers of columns `a` and `b` that the triangle
/// inequality of one row allows: lower and upper end.
fn limits(row: &PrintedDistances, [a, b]: [usize; 2]) -> [f64; 2] {
    let (a, b) = (row.l_infinity[a], row.l_infinity[b]);
    [(a - b).abs(), a + b]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::paper::printed_distances;

    #[test]
    fn every_printed_row_allows_the_distances_measured_between_our_samplers() {
        for row in printed_distances() {
            let least = tightest(&row, &[1.01, 1.38, 0.73]);
            assert!(least.room > 0., "{least:?}");
        }
        let of_bnot = allowed(&printed_distances(), [0, 1]);
        assert!(
            (of_bnot[0] - 0.753_856).abs() < 1e-9 && (of_bnot[1] - 1.026_518).abs() < 1e-9,
            "{of_bnot:?}"
        );
    }

    #[test]
    fn a_distance_beyond_a_row_is_told_by_how_much() {
        let row = PrintedDistances { name: "a".into(), l_infinity: [0.5, 0.4, 0.9] };
        let found = tightest(&row, &[1., 1., 1.]);
        assert_eq!(found.between, [0, 1]);
        assert!((found.room + 0.1).abs() < 1e-12);
    }
}
