//! Comparison of the cones of one field of the retina that two channels show.

use super::matching::{MatchOptions, check, reach};
use super::{MatchError, Rates, STRICT_REACH};
use crate::geometry::Point;
use crate::geometry::index::NeighbourTree;
use std::collections::HashSet;
use std::num::NonZero;

/// Largest shift between two channels along each axis, in px, that is tried.
pub const LARGEST_SHIFT: i32 = 8;
/// Number of nearest candidates of a cone that are considered: more cones than these do not fit
/// within the reach.
const CANDIDATES: NonZero<usize> = NonZero::<usize>::MIN.saturating_add(7);
/// Number of times that the shift is refined by the mean displacement of the pairs.
const REFINEMENTS: usize = 4;

/// Cones of one field that two registered channels show, and which of them are the same.
#[derive(Clone, Debug, PartialEq)]
pub struct Registration {
    /// Shift in px, to the right and down, that brings the first channel onto the second.
    pub shift: [f64; 2],
    /// `true` if the best shift lies at the limit of those tried.
    pub at_limit: bool,
    /// Greatest distance in px of the two cones of a pair.
    pub limit_px: f64,
    /// Pairs: index of a cone in the first channel and in the second. No cone is in two pairs.
    pub pairs: Vec<(usize, usize)>,
    /// One flag per cone of the first channel: `true` if it counts, because it lies far enough
    /// inside the field.
    pub first_counts: Vec<bool>,
    /// One flag per cone of the second channel: `true` if it counts.
    pub second_counts: Vec<bool>,
    /// Agreement of the channels: `tp` cones in both, `fn` in the second alone, `fp` in the first
    /// alone. `sensitivity` is the share of the second's cones that the first has too, `precision`
    /// that of the first's, and `dice` the F1 of both. A pair counts if its cone in the second
    /// channel does.
    pub rates: Rates,
}

/// Finds the cones that two channels have in common, `first` and `second`, in a field of `width` ×
/// `height` px, both in px.
///
/// The first channel is shifted by whole pixels, up to [`LARGEST_SHIFT`] along each axis, to where
/// most cones of the second have a cone of the first within 0.4 of the second's median
/// nearest-neighbour distance, and then by the mean displacement of the pairs. Pairs are formed
/// one-to-one, the closest first. Cones nearer to the edge of the field than one such distance do
/// not count, because the other channel may miss them there.
///
/// # Errors
/// Fails if a coordinate is not finite or beyond ±10⁹ px, or there are 4,294,967,295 points or
/// more.
pub fn register(
    first: &[Point],
    second: &[Point],
    (width, height): (usize, usize),
) -> Result<Registration, MatchError> {
    check("cone", first)?;
    check("cone", second)?;
    let options = MatchOptions { fraction: STRICT_REACH, ..MatchOptions::default() };
    let limit = reach(second, first, &options)?;
    let margin = limit / STRICT_REACH;
    let tree = NeighbourTree::in_plane(second).map_err(|_| MatchError::TooMany(second.len()))?;
    let counts = |p: Point| {
        let within = |v: f64, side: usize| v > margin && v < side as f64 - 1. - margin;
        within(p.x, width) && within(p.y, height)
    };
    let moved = |[x, y]: [f64; 2]| first.iter().map(move |p| Point::new(p.x + x, p.y + y));
    // the tree gives squared distances
    let met = |shift: [f64; 2]| -> usize {
        let nearest = |p: Point| tree.nearest(p, NonZero::<usize>::MIN).next();
        let near =
            moved(shift).filter(|&p| counts(p)).filter_map(nearest).filter(|(_, d)| *d <= limit * limit);
        near.map(|(k, _)| k).collect::<HashSet<_>>().len()
    };
    let steps = || -LARGEST_SHIFT..=LARGEST_SHIFT;
    let whole = steps().flat_map(|y| steps().map(move |x| (x, y)));
    // of equally good shifts, the smallest
    let best = whole.max_by_key(|&(x, y)| (met([x.into(), y.into()]), -(x * x + y * y), x, y));
    let (x, y) = best.unwrap_or((0, 0));
    let at_limit = x.abs().max(y.abs()) == LARGEST_SHIFT;
    let pair_up = |shift: [f64; 2]| -> Vec<(usize, usize)> {
        let mut candidates: Vec<(f64, usize, usize)> = Vec::new();
        for (k, p) in moved(shift).enumerate() {
            let near = tree.nearest(p, CANDIDATES).filter(|(_, d)| *d <= limit * limit);
            candidates.extend(near.map(|(other, d)| (d, k, other)));
        }
        candidates.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        let mut taken = (vec![false; first.len()], vec![false; second.len()]);
        let mut pairs = Vec::new();
        for (_, a, b) in candidates {
            if !taken.0[a] && !taken.1[b] {
                (taken.0[a], taken.1[b]) = (true, true);
                pairs.push((a, b));
            }
        }
        pairs.sort_unstable();
        pairs
    };
    let mut shift = [f64::from(x), f64::from(y)];
    let mut pairs = pair_up(shift);
    for _ in 0..REFINEMENTS {
        let n = pairs.len().max(1) as f64;
        let sum = |axis: fn(Point) -> f64| {
            pairs.iter().map(|&(a, b)| axis(second[b]) - axis(first[a])).sum::<f64>() / n
        };
        if pairs.is_empty() {
            break;
        }
        shift = [sum(|p| p.x), sum(|p| p.y)];
        pairs = pair_up(shift);
    }
    let first_counts: Vec<bool> = moved(shift).map(counts).collect();
    let second_counts: Vec<bool> = second.iter().map(|&p| counts(p)).collect();
    let mut alone = (first_counts.clone(), second_counts.clone());
    for &(a, b) in &pairs {
        (alone.0[a], alone.1[b]) = (false, false);
    }
    let both = pairs.iter().filter(|(_, b)| second_counts[*b]).count();
    let number = |flags: &[bool]| flags.iter().filter(|f| **f).count();
    let rates = Rates::new(both, number(&alone.1), number(&alone.0));
    Ok(Registration { shift, at_limit, limit_px: limit, pairs, first_counts, second_counts, rates })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Returns 225 random points, at least 12 px from the edge so that all count wherever they are
    /// shifted.
    fn field() -> Vec<Point> {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        (0..225).map(|_| Point::new(rng.random_range(20. ..130.), rng.random_range(20. ..130.))).collect()
    }

    #[test]
    fn a_shift_is_found_and_cones_of_one_channel_stay_alone() {
        let second = field();
        let mut first: Vec<Point> = second.iter().map(|p| Point::new(p.x - 3.25, p.y + 5.5)).collect();
        first.remove(112);
        let found = register(&first, &second, (150, 150)).unwrap();
        assert!((found.shift[0] - 3.25).abs() < 1e-9 && (found.shift[1] + 5.5).abs() < 1e-9);
        assert_eq!((found.pairs.len(), found.rates.fn_, found.rates.fp, found.at_limit), (224, 1, 0, false));
        let far: Vec<Point> = second.iter().map(|p| Point::new(p.x - 8.25, p.y)).collect();
        assert!(register(&far, &second, (150, 150)).unwrap().at_limit);
    }

    #[test]
    fn no_cones_at_all_are_no_error() {
        assert_eq!(register(&[], &field(), (150, 150)).unwrap().pairs, []);
        assert_eq!(register(&field(), &[], (150, 150)).unwrap().pairs, []);
    }
}
