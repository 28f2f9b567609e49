//! Common part of the models that grow outward from a centre.
//!
//! Such a model knows neither a window nor a number of points; [`exactly`] fits its pattern to
//! both.

use crate::geometry::Point;
use crate::sample::{Frame, SampleError};
use rand::{Rng, RngExt};
use std::f64::consts::{PI, TAU};

/// Factors for the sides of the grown pattern. The first is the excess, in the first attempt, over
/// the window that should contain n points; the second is the growth in each further attempt.
const BEYOND: [f64; 2] = [1.1, 1.3];
/// Largest number of attempts before the pattern counts as too small.
const ATTEMPTS: usize = 12;

/// Returns exactly `n` points of a pattern around the middle of the frame.
///
/// `grow` makes the pattern in its own unit of length, with about `density` points per squared
/// unit. Its argument `half` is half of the two sides, and the pattern must be complete where |x| ≤
/// `half[0]` and |y| ≤ `half[1]`. The window is the rectangle around the centre, with the frame's
/// proportions, that contains n points; it is scaled to the frame.
///
/// # Errors
/// Fails if the pattern of the last attempt still has too few points.
pub(super) fn exactly(
    n: usize,
    frame: &Frame,
    density: f64,
    sampler: &'static str,
    mut grow: impl FnMut([f64; 2]) -> Vec<[f64; 2]>,
) -> Result<Vec<Point>, SampleError> {
    if n == 0 {
        return Ok(Vec::new());
    }
    let unit = (n as f64 / density / (frame.width * frame.height)).sqrt() / 2.;
    // A few points more than n are needed, which is a larger share where n is small.
    let mut beyond = BEYOND[0] * (1. + 2. / (n as f64).sqrt());
    let mut placed = 0;
    for _ in 0..ATTEMPTS {
        let half = [frame.width, frame.height].map(|side| beyond * unit * side);
        let points = grow(half);
        // size of the smallest rectangle around the centre that contains the point, as a fraction
        // of the half sides
        let out = |&[x, y]: &[f64; 2]| (x.abs() / half[0]).max(y.abs() / half[1]);
        let mut order: Vec<(f64, usize)> = points.iter().map(out).zip(0..).filter(|o| o.0 <= 1.).collect();
        placed = placed.max(order.len());
        if order.len() > n {
            let (inner, next, _) =
                order.select_nth_unstable_by(n, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let last = inner.iter().map(|o| o.0).fold(0., f64::max);
            // The edge of the window lies halfway between the last point kept and the next one.
            let edge = (last + next.0) / 2.;
            let mut kept: Vec<usize> = inner.iter().map(|o| o.1).collect();
            kept.sort_unstable();
            let across = |v: f64, half: f64, side: f64| (v / (edge * half) + 1.) / 2. * side;
            return Ok(kept
                .into_iter()
                .map(|k| points[k])
                .map(|[x, y]| frame.place(across(x, half[0], frame.width), across(y, half[1], frame.height)))
                .collect());
        }
        beyond *= BEYOND[1];
    }
    Err(SampleError::NoRoom { sampler, n, placed, attempts: ATTEMPTS })
}

/// Returns positions on the circle of radius `radius` around the centre, about `step` apart.
///
/// The positions are at equal distances and begin at a random angle. Positions with |x| > `half[0]`
/// or |y| > `half[1]` are left out.
pub(super) fn ring(radius: f64, step: f64, half: [f64; 2], rng: &mut dyn Rng) -> Vec<[f64; 2]> {
    let number = (TAU * radius / step).round().max(1.);
    let turn = TAU / number;
    let first = rng.random::<f64>() * turn;
    // in each quadrant, the angles between which |x| ≤ `half[0]` and |y| ≤ `half[1]` on the circle
    let low = (half[0] / radius).min(1.).acos();
    let high = (half[1] / radius).min(1.).asin();
    let mut places = Vec::new();
    for (from, to) in [(low, high), (PI - high, PI - low), (PI + low, PI + high), (TAU - high, TAU - low)] {
        // half-open intervals, so that a position on an axis counts once
        let (mut k, end) = (((from - first) / turn).ceil(), (to - first) / turn);
        while k < end {
            let angle = first + k * turn;
            places.push([radius * angle.cos(), radius * angle.sin()]);
            k += 1.;
        }
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Window;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn lattice([a, b]: [f64; 2]) -> Vec<[f64; 2]> {
        let (a, b) = (a.floor() as i32, b.floor() as i32);
        (-a..=a).flat_map(|x| (-b..=b).map(move |y| [f64::from(x), f64::from(y)])).collect()
    }

    #[test]
    fn exactly_n_points_are_kept_even_where_several_are_equally_far_out() {
        for n in [1, 2, 3, 8, 9, 10, 500] {
            for (width, height) in [(1., 1.), (50., 0.5), (3., 7.)] {
                let window = Window::rectangle(0., 0., width, height).unwrap();
                let frame = Frame::new(n, &window).unwrap();
                let points = exactly(n, &frame, 1., "lattice", lattice).unwrap();
                assert_eq!(points.len(), n);
                assert!(points.iter().all(|&p| window.contains(p)));
            }
        }
    }

    #[test]
    fn a_pattern_that_does_not_grow_is_an_error() {
        let frame = Frame::new(9, &Window::unit_square()).unwrap();
        let lone = exactly(9, &frame, 1., "lone", |_| vec![[0., 0.]]);
        assert!(matches!(lone, Err(SampleError::NoRoom { placed: 1, .. })));
    }

    #[test]
    fn rings_are_whole_in_wide_windows_and_cut_by_narrow_ones() {
        for seed in 0..50 {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            assert_eq!(ring(10., 1., [10., 10.], &mut rng).len(), 63);
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let whole = ring(10., 1., [11., 11.], &mut rng);
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let half = [9., 4.];
            let inside = |p: &&[f64; 2]| p[0].abs() <= half[0] && p[1].abs() <= half[1];
            let expected = whole.iter().filter(inside).count();
            assert_eq!(ring(10., 1., half, &mut rng).len(), expected);
        }
    }
}
