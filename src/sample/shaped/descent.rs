use super::features::Features;
use super::neighbours::NeighbourList;
use crate::numeric::solve;

/// Most steps, and most tries to shorten one that raises the misses.
const STEPS: usize = 30;
const TRIES: usize = 5;
/// Good enough: root mean square miss of g.
const ENOUGH: f64 = 0.005;
/// Root mean square way of a step at most, and of a point three times that, in spacings: beyond it J has changed.
const LONGEST: f64 = 0.2;
/// Points that J Jᵀ is taken from.
const METRIC_POINTS: usize = 512;
/// How far points may move before their neighbours are looked for again, in spacings.
const MARGIN: f64 = 0.4;
/// Damping μ over the mean of the diagonal of J Jᵀ: at first, and at least.
const DAMPING: [f64; 2] = [1e-3, 1e-6];

/// Moves points of the torus with these sides, of hexagonal spacing 1, until their features, of pairs nearer than `reach`, are as
/// wanted, or no step comes nearer to that.
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

/// The points moved against `pull`, and whether by all of it.
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

fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
}
