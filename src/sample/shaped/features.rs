//! Features of a pattern that are brought to target values, and the derivatives of the features
//! with respect to the positions of the points.
//!
//! The features are the numbers of pairs by distance, smoothed by a spline; the mean and the mean
//! square of the nearest-neighbour distances; and the power of long waves.

use super::curve::TargetCurve;
use super::neighbours::NeighbourList;
use super::spline;
use super::waves::LongWaves;
use std::f64::consts::TAU;

/// Distance between neighbouring nodes of the spline along r, in spacings.
const NODE: f64 = 0.1;
/// Distance, in spacings, below which pairs are weighted as if they were at this distance.
///
/// The weight of an excess of pairs is one over their distance. At shorter distances there are too
/// few pairs for such large weights.
const NEAR: f64 = 0.15;

/// Mean and standard deviation of nearest-neighbour distances, in hexagonal spacings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestTarget {
    /// Mean nearest-neighbour distance, in hexagonal spacings.
    pub mean: f64,
    /// Population standard deviation of the nearest-neighbour distances, in hexagonal spacings.
    pub sd: f64,
}

/// Goals for the features of a pattern, with one weight per feature.
///
/// The weights convert all features to about the unit of the pair correlation function g, so that a
/// miss of .01 means the same for each feature. Slot 0 of `goal` and `weight` belongs to the
/// spline's node at −[`NODE`], and slot k + 1 to node k; slots of nodes that are not controlled
/// have weight 0. The mean and the mean square of the nearest-neighbour distances follow, and then
/// the annuli of waves.
pub(super) struct Features {
    /// Value that each feature is to get.
    goal: Vec<f64>,
    /// Factor by which the difference between a feature and its goal is multiplied.
    weight: Vec<f64>,
    /// Number of slots of the spline's nodes.
    nodes: usize,
    /// `true` if the nearest-neighbour distances are controlled.
    nearest: bool,
    waves: LongWaves,
}

/// Nearest neighbour of a point, with the vector and the squared distance to the neighbour.
#[derive(Clone, Copy)]
struct Nearest {
    /// Index of the neighbour.
    partner: usize,
    /// Vector from the point to the neighbour.
    way: [f64; 2],
    /// Squared distance to the neighbour.
    square: f64,
}

impl Features {
    /// Creates the goals for `n` points on a torus with the sides `sides`, in hexagonal spacings.
    ///
    /// Only pairs nearer than `reach` are controlled.
    pub(super) fn new(
        target: &TargetCurve,
        nearest: Option<NearestTarget>,
        n: usize,
        sides: [f64; 2],
        reach: f64,
    ) -> Self {
        let waves = LongWaves::new(target, sides);
        let controlled = ((reach / NODE) as usize).saturating_sub(2);
        // a spline extends two nodes to either side of its own
        let nodes = controlled + 4;
        let n = n as f64;
        let area = n * 0.75f64.sqrt();
        let slots = nodes + 2 + waves.annuli();
        let (mut goal, mut weight) = (vec![0.; slots], vec![0.; slots]);
        for node in 0..controlled {
            let r = node as f64 * NODE;
            let density = pairs_per_length(target, r);
            goal[node + 1] = density * NODE * n * (n - 1.) / (2. * area);
            weight[node + 1] = 2. * area / (n * n * TAU * r.max(NEAR) * NODE);
        }
        if let Some(NearestTarget { mean, sd }) = nearest {
            goal[nodes] = mean;
            goal[nodes + 1] = mean * mean + sd * sd;
            weight[nodes..nodes + 2].fill(NEAREST_WEIGHT);
        }
        for a in 0..waves.annuli() {
            goal[nodes + 2 + a] = waves.goal(a);
            weight[nodes + 2 + a] = WAVE_WEIGHT;
        }
        Self { goal, weight, nodes, nearest: nearest.is_some(), waves }
    }

    /// Returns the weighted difference between each feature and its goal.
    pub(super) fn misses(&self, points: &[[f64; 2]], list: &NeighbourList) -> Vec<f64> {
        let mut value = vec![0.; self.goal.len()];
        let pairs = &mut value[..self.nodes];
        list.visit(points, |_, _, _, _, square| {
            let (first, u) = place(square.sqrt());
            if let Some(near) = pairs.get_mut(first..first + 4) {
                near.iter_mut().zip(spline::weights(u)).for_each(|(v, w)| *v += w);
            }
        });
        if self.nearest {
            let n = points.len() as f64;
            for near in nearest(points, list) {
                value[self.nodes] += near.square.sqrt() / n;
                value[self.nodes + 1] += near.square / n;
            }
        }
        value[self.nodes + 2..].copy_from_slice(&self.waves.power(points));
        value.iter().zip(&self.goal).zip(&self.weight).map(|((v, g), w)| (v - g) * w).collect()
    }

    /// Computes J Jᵀ, row by row, where J is the Jacobian of the misses with respect to the
    /// coordinates.
    ///
    /// The matrix is computed from the first `some` points and scaled up to all points.
    pub(super) fn gram(&self, points: &[[f64; 2]], list: &NeighbourList, some: usize) -> Vec<f64> {
        let size = self.goal.len();
        let some = some.min(points.len());
        // one row per coordinate: x and y of point 0, x and y of point 1, …
        let mut rows = vec![0.; 2 * some * size];
        self.derive(points, list, |i, first, slopes, way| {
            if i < some {
                for (axis, along) in way.into_iter().enumerate() {
                    let begin = (2 * i + axis) * size + first;
                    rows[begin..begin + slopes.len()]
                        .iter_mut()
                        .zip(slopes)
                        .for_each(|(r, s)| *r += s * along);
                }
            }
        });
        let mut gram = vec![0.; size * size];
        for row in rows.chunks_exact(size) {
            for (a, &v) in row.iter().enumerate() {
                gram[a * size..=a * size + a].iter_mut().zip(row).for_each(|(g, w)| *g += v * w);
            }
        }
        let scale = points.len() as f64 / some.max(1) as f64;
        for a in 0..size {
            for b in 0..=a {
                let value = gram[a * size + b] * scale * self.weight[a] * self.weight[b];
                gram[a * size + b] = value;
                gram[b * size + a] = value;
            }
        }
        gram
    }

    /// Computes Jᵀ y, one vector per point, where J is the Jacobian of the misses with respect to
    /// the coordinates.
    pub(super) fn pull(&self, points: &[[f64; 2]], list: &NeighbourList, y: &[f64]) -> Vec<[f64; 2]> {
        let y: Vec<f64> = y.iter().zip(&self.weight).map(|(y, w)| y * w).collect();
        let mut pull = vec![[0.; 2]; points.len()];
        self.derive(points, list, |i, first, slopes, way| {
            let sum: f64 = y[first..].iter().zip(slopes).map(|(y, s)| y * s).sum();
            pull[i][0] += sum * way[0];
            pull[i][1] += sum * way[1];
        });
        pull
    }

    /// Calls `add(i, slot, derivatives, direction)` for each group of features that depends on the
    /// position of point `i`.
    ///
    /// If point `i` moves by a small vector, the features from `slot` on change by `derivatives`
    /// times the scalar product of the vector and `direction`.
    #[inline]
    fn derive(
        &self,
        points: &[[f64; 2]],
        list: &NeighbourList,
        mut add: impl FnMut(usize, usize, &[f64], [f64; 2]),
    ) {
        list.visit(points, |i, j, dx, dy, square| {
            let d = square.sqrt();
            let (first, u) = place(d);
            // The direction between coincident points is not defined.
            if d > 0. && first + 4 <= self.nodes {
                let slopes = spline::slopes(u).map(|s| s / NODE);
                let (x, y) = (dx / d, dy / d);
                add(i, first, &slopes, [-x, -y]);
                add(j, first, &slopes, [x, y]);
            }
        });
        if self.nearest {
            let n = points.len() as f64;
            for (i, near) in nearest(points, list).into_iter().enumerate() {
                let d = near.square.sqrt();
                if d > 0. {
                    let slopes = [1. / n, 2. * d / n];
                    let [x, y] = near.way.map(|w| w / d);
                    add(i, self.nodes, &slopes, [-x, -y]);
                    add(near.partner, self.nodes, &slopes, [x, y]);
                }
            }
        }
        self.waves.derive(points, |i, annulus, gradient| add(i, self.nodes + 2 + annulus, &[1.], gradient));
    }
}

/// Weight of a miss of the nearest-neighbour moments, relative to a miss of g at one node.
const NEAREST_WEIGHT: f64 = 2.;

/// Weight of a miss of the power of an annulus, relative to a miss of g.
///
/// It is small, as the power of an annulus scatters by 1/√(number of waves).
const WAVE_WEIGHT: f64 = 0.1;

/// Returns the first of the four slots in which a pair at distance `d` counts, and the position of
/// `d` between the nodes.
///
/// The position is the distance from the second slot's node to `d`, as a share of [`NODE`].
#[inline]
fn place(d: f64) -> (usize, f64) {
    let at = d / NODE;
    let node = at as usize;
    (node, at - node as f64)
}

/// Computes ∫ 2πd g(d) B((d − r)/h) dd / h, where B is the spline and h = [`NODE`].
///
/// The result is the number of pairs per length that the spline at r counts if the density of
/// points is 1.
fn pairs_per_length(target: &TargetCurve, r: f64) -> f64 {
    // number of equal parts in which the spline's range is integrated
    const PARTS: usize = 64;
    (0..PARTS)
        .map(|k| -2. + 4. * (k as f64 + 0.5) / PARTS as f64)
        .map(|t| (t, r + t * NODE))
        .filter(|&(_, d)| d > 0.)
        .map(|(t, d)| TAU * d * target.at(d) * spline::at(t) * 4. / PARTS as f64)
        .sum()
}

/// Returns the nearest neighbour of every point.
///
/// A point that is in no listed pair is its own neighbour, at distance 0.
fn nearest(points: &[[f64; 2]], list: &NeighbourList) -> Vec<Nearest> {
    let alone = |i| Nearest { partner: i, way: [0.; 2], square: f64::INFINITY };
    let mut nearest: Vec<Nearest> = (0..points.len()).map(alone).collect();
    list.visit(points, |i, j, dx, dy, square| {
        if square < nearest[i].square {
            nearest[i] = Nearest { partner: j, way: [dx, dy], square };
        }
        if square < nearest[j].square {
            nearest[j] = Nearest { partner: i, way: [-dx, -dy], square };
        }
    });
    nearest.iter_mut().filter(|n| n.square.is_infinite()).for_each(|n| n.square = 0.);
    nearest
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    const SIDES: [f64; 2] = [12., 14.];

    fn setup() -> (Vec<[f64; 2]>, NeighbourList, Features) {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let n = 190;
        let points: Vec<[f64; 2]> = (0..n).map(|_| SIDES.map(|side| rng.random::<f64>() * side)).collect();
        let target = TargetCurve::from_spectrum(&[[0., 0.5], [0.7, 1.5]]).unwrap();
        let nearest = NearestTarget { mean: 0.5, sd: 0.2 };
        let list = NeighbourList::new(&points, SIDES, 6., 0.5);
        (points, list, Features::new(&target, Some(nearest), n, SIDES, 6.))
    }

    #[test]
    fn pull_is_the_gradient_of_the_misses() {
        let (mut points, list, features) = setup();
        let y: Vec<f64> = (0..features.goal.len()).map(|k| (k as f64 * 1.7).sin()).collect();
        let pull = features.pull(&points, &list, &y);
        let sum = |points: &[[f64; 2]]| -> f64 {
            features.misses(points, &list).iter().zip(&y).map(|(m, y)| m * y).sum()
        };
        for i in [0, 17, 100] {
            for axis in 0..2 {
                let at = points[i][axis];
                let [high, low] = [1e-6, -1e-6].map(|step| {
                    points[i][axis] = at + step;
                    sum(&points)
                });
                points[i][axis] = at;
                let difference = (high - low) / 2e-6;
                assert!((pull[i][axis] - difference).abs() < 1e-5 * (1. + difference.abs()), "{i} {axis}");
            }
        }
    }

    #[test]
    fn gram_of_all_points_is_that_of_the_pulls() {
        let (points, list, features) = setup();
        let size = features.goal.len();
        let gram = features.gram(&points, &list, points.len());
        let unit = |k: usize| (0..size).map(|i| f64::from(u8::from(i == k))).collect::<Vec<f64>>();
        for (a, b) in [
            (5, 5),
            (5, 6),
            (20, 3),
            (size - 1, size - 2),
            (size - 1, 4),
            (features.nodes, features.nodes + 1),
        ] {
            let (p, q) = (features.pull(&points, &list, &unit(a)), features.pull(&points, &list, &unit(b)));
            let product: f64 = p.iter().zip(&q).map(|(p, q)| p[0] * q[0] + p[1] * q[1]).sum();
            assert!((gram[a * size + b] - product).abs() < 1e-9 * (1. + product.abs()), "{a} {b}");
        }
    }
}
