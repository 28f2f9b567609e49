//! Minimisation of the misses of a pattern's features, by the method of Levenberg and Marquardt.
//!
//! A feature is a number measured on a pattern, and a miss is the weighted difference between a
//! feature and its goal.
//!
//! 1. Compute the misses e, and estimate J Jᵀ from some of the points, where J is the Jacobian of
//!    the misses.
//! 2. Displace the points by −Jᵀ (J Jᵀ + μ)⁻¹ e, the shortest displacement that removes e to first
//!    order. Shorten it if points would move too far.
//! 3. If the misses fall, keep the points, and lower the damping μ unless the step was shortened;
//!    otherwise raise μ tenfold and try again.

use super::features::Features;
use super::neighbours::NeighbourList;
use crate::numeric::solve;

/// Largest number of steps of the minimisation. Ten steps usually suffice.
const STEPS: usize = 30;
/// Largest number of tries, with ever more damping, to find a step that lowers the misses.
const TRIES: usize = 5;
/// Root mean square of the misses at which the minimisation ends, in units of the pair correlation
/// function.
const ENOUGH: f64 = 0.005;
/// Largest root mean square displacement of the points in a step, in spacings.
///
/// A single point moves at most three times as far. Farther away, the Jacobian would no longer
/// describe how the misses change.
const LONGEST: f64 = 0.2;
/// Number of points from which J Jᵀ is estimated, where J is the Jacobian of the misses. Each entry
/// is a sum over all points, so a part of them is enough.
const METRIC_POINTS: usize = 512;
/// Margin in spacings: pairs are listed up to the cut-off distance plus this margin.
///
/// The list is made anew once a point has moved by half of this margin.
const MARGIN: f64 = 0.4;
/// Initial and least damping μ, relative to the mean of the diagonal of J Jᵀ.
const DAMPING: [f64; 2] = [1e-3, 1e-6];

/// Moves points of a torus until their features are near their goals, or until no step brings them
/// nearer.
///
/// `points`, the `sides` of the torus and `reach` are in units of the hexagonal spacing. Only pairs
/// nearer than `reach` count. At most 30 steps are made.
pub(super) fn descend(points: &mut Vec<[f64; 2]>, sides: [f64; 2], features: &Features, reach: f64) {
    let mut list = NeighbourList::new(points, sides, reach, MARGIN.min(reach));
    let mut misses = features.misses(points, &list);
    let mut damping = DAMPING[0];
    for _ in 0..STEPS {
        if root_mean_square(&misses) <= ENOUGH {
            return;
        }
        list.follow(points);
        let gram = features.gram(points, &list, METRIC_POINTS);
        let mut improved = false;
        for _ in 0..TRIES {
            let Some(y) = solve(&gram, damping, &misses) else {
                damping *= 10.;
                continue;
            };
            list.follow(points);
            let pull = features.pull(points, &list, &y);
            let (moved, whole) = step(points, &pull, sides);
            list.follow(&moved);
            let after = features.misses(&moved, &list);
            if root_mean_square(&after) < root_mean_square(&misses) {
                *points = moved;
                misses = after;
                if whole {
                    damping = (0.3 * damping).max(DAMPING[1]);
                }
                improved = true;
                break;
            }
            damping *= 10.;
        }
        if !improved {
            return;
        }
    }
}

/// Returns the points moved by −`pull`, or by less if that is too far, and `false` if the entire
/// step was shortened.
fn step(points: &[[f64; 2]], pull: &[[f64; 2]], sides: [f64; 2]) -> (Vec<[f64; 2]>, bool) {
    let squares: f64 = pull.iter().map(|[x, y]| x * x + y * y).sum();
    let way = (squares / pull.len().max(1) as f64).sqrt();
    let shortened = if way > LONGEST { LONGEST / way } else { 1. };
    let moved = points.iter().zip(pull).map(|(p, [x, y])| {
        let own = shortened * x.hypot(*y);
        let share = if own > 3. * LONGEST { shortened * 3. * LONGEST / own } else { shortened };
        [(p[0] - share * x).rem_euclid(sides[0]), (p[1] - share * y).rem_euclid(sides[1])]
    });
    (moved.collect(), way <= LONGEST)
}

/// Returns the root mean square of the values.
fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
}
