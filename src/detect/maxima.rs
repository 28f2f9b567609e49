//! Local maxima of a filter's response, located to a fraction of a pixel.
//!
//! 1. A test without branches skips blocks of 16 px that contain no maximum, as most blocks do.
//! 2. Every pixel of the other blocks is compared with its eight neighbours.
//! 3. A maximum is moved to the top of a parabola through its neighbours along x and along y.

use super::Detection;
use crate::geometry::Point;
use crate::image::{PARALLEL_PIXELS, Plane, values};
use rayon::prelude::*;

/// Returns the local maxima of `response` over 3 × 3 px that exceed `threshold`, in reading order.
///
/// Each maximum is moved by at most half a pixel, to the top of a parabola through its neighbours
/// along x and along y; its score is the response at the pixel. A plateau counts once, at its first
/// pixel in reading order.
pub fn local_maxima(response: &Plane, threshold: f32) -> Vec<Detection> {
    let (h, w) = response.dim();
    let data = values(response);
    let in_row = |y: usize| {
        let row = |y: usize| &data[y * w..(y + 1) * w];
        let (above, here, below) = ((y > 0).then(|| row(y - 1)), row(y), (y + 1 < h).then(|| row(y + 1)));
        let maximum = |x: usize| {
            let value = here[x];
            // a maximum is above all earlier neighbours and not below any later one, so that a
            // plateau counts once; the row itself is checked first because most pixels fail there
            if !(value > threshold && (x == 0 || here[x - 1] < value) && (x + 1 == w || here[x + 1] <= value))
            {
                return None;
            }
            let columns = x.saturating_sub(1)..(x + 2).min(w);
            let is_maximum = above.is_none_or(|r| r[columns.clone()].iter().all(|v| *v < value))
                && below.is_none_or(|r| r[columns].iter().all(|v| *v <= value));
            is_maximum.then(|| {
                let along_x = (x > 0 && x + 1 < w).then(|| parabola_top(here[x - 1], value, here[x + 1]));
                let along_y = above.zip(below).map(|(a, b)| parabola_top(a[x], value, b[x]));
                let top = |offset: Option<f64>| offset.unwrap_or(0.);
                Detection {
                    centre: Point::new(x as f64 + top(along_x), y as f64 + top(along_y)),
                    score: f64::from(value),
                }
            })
        };
        let rows = above.zip(below);
        let worth_a_look = |x: &usize| rows.is_none_or(|(above, below)| any_on_top(*x, above, here, below));
        let blocks = (0..w).step_by(BLOCK).filter(worth_a_look);
        blocks.flat_map(|x| x..(x + BLOCK).min(w)).filter_map(maximum).collect::<Vec<_>>()
    };
    if data.len() >= PARALLEL_PIXELS {
        (0..h).into_par_iter().flat_map_iter(in_row).collect()
    } else {
        (0..h).flat_map(in_row).collect()
    }
}

/// Number of neighbouring pixels of a row that [`any_on_top`] compares with their neighbours at
/// once.
const BLOCK: usize = 16;

/// Returns whether any pixel of the block that begins at column `x` may be a maximum.
///
/// A pixel may be a maximum if it is higher than its upper and its left neighbour and not lower
/// than its right and its lower one. There are no branches, so that all pixels of a block are
/// compared at once. Blocks at either end of a row are not examined; the result for them is `true`.
fn any_on_top(x: usize, above: &[f32], here: &[f32], below: &[f32]) -> bool {
    fn block(row: &[f32], from: usize) -> Option<&[f32; BLOCK]> {
        row.get(from..from + BLOCK)?.try_into().ok()
    }
    let (Some(left), Some(middle), Some(right), Some(up), Some(down)) = (
        x.checked_sub(1).and_then(|x| block(here, x)),
        block(here, x),
        block(here, x + 1),
        block(above, x),
        block(below, x),
    ) else {
        return true;
    };
    (0..BLOCK).fold(false, |any, k| {
        let v = middle[k];
        any | ((v > left[k]) & (v >= right[k]) & (v > up[k]) & (v >= down[k]))
    })
}

/// Returns the position of the top of the parabola through (−1, a), (0, b), (1, c), clamped to −½
/// to ½.
///
/// The position is 0 if the parabola has no top.
fn parabola_top(a: f32, b: f32, c: f32) -> f64 {
    let curvature = f64::from(a) - 2. * f64::from(b) + f64::from(c);
    if curvature < 0. { (0.5 * f64::from(a - c) / curvature).clamp(-0.5, 0.5) } else { 0. }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_paraboloid_is_found_at_its_top() {
        let (cx, cy) = (4.3, 6.8);
        let plane = Plane::from_shape_fn((12, 10), |(y, x)| {
            (9. - 0.1 * ((x as f64 - cx).powi(2) + 2. * (y as f64 - cy).powi(2))) as f32
        });
        let found = local_maxima(&plane, 0.);
        assert_eq!(found.len(), 1);
        assert!(found[0].centre.distance(Point::new(cx, cy)) < 1e-5);
    }

    #[test]
    fn a_plateau_counts_once() {
        let mut plane = Plane::zeros((5, 5));
        plane[[2, 2]] = 1.;
        plane[[2, 3]] = 1.;
        let found = local_maxima(&plane, 0.5);
        assert_eq!(found.len(), 1);
    }

    #[test]
    fn maxima_are_those_of_a_plain_search() {
        // grey levels are so few that there are plateaus
        let plane =
            Plane::from_shape_fn((37, 53), |(y, x)| ((x * 7919 + y * 104_729 + x * y * 31) % 7) as f32);
        let at = |y: isize, x: isize| plane.get((y as usize, x as usize)).copied();
        let mut expected = Vec::new();
        for (y, x) in (0..37).flat_map(|y| (0..53).map(move |x| (y, x))) {
            let value = at(y, x).unwrap();
            let around = (-1..=1).flat_map(|j| (-1..=1).map(move |i| (j, i))).filter(|o| *o != (0, 0));
            let top = around.clone().all(|o| {
                at(y + o.0, x + o.1)
                    .is_none_or(|other| if o < (0, 0) { other < value } else { other <= value })
            });
            if value > 2. && top {
                expected.push((x as f64, y as f64));
            }
        }
        let found = local_maxima(&plane, 2.);
        assert!(expected.len() > 50);
        assert_eq!(found.len(), expected.len());
        for (found, (x, y)) in found.iter().zip(expected) {
            assert!((found.centre.x - x).abs() <= 0.5 && (found.centre.y - y).abs() <= 0.5);
        }
    }

    #[test]
    fn the_threshold_is_exclusive() {
        let mut plane = Plane::zeros((3, 3));
        plane[[1, 1]] = 0.5;
        assert!(local_maxima(&plane, 0.5).is_empty());
    }
}
