//! Greedy non-maximum suppression: of detections close to each other only the highest stays.
//!
//! A grid of buckets holds the detections kept so far, so that each new one is compared only with
//! those nearby.

use super::Detection;
use crate::geometry::Point;
use crate::geometry::index::BucketGrid;

/// Drops every detection that lies within `radius` (px) of a kept one of higher rank.
///
/// Detections rank from the highest score to the lowest, those of equal score in reading order. The
/// result is in the same order. Only kept detections suppress others. A radius of 0 keeps all.
pub fn suppress(mut detections: Vec<Detection>, radius: f64) -> Vec<Detection> {
    detections.sort_by(by_score);
    suppress_sorted(detections, |d| d.centre, radius, |_| radius)
}

/// Compares detections for an order from the highest score to the lowest; equal scores in reading
/// order.
pub(super) fn by_score(a: &Detection, b: &Detection) -> std::cmp::Ordering {
    let reading = || a.centre.y.total_cmp(&b.centre.y).then(a.centre.x.total_cmp(&b.centre.x));
    b.score.total_cmp(&a.score).then_with(reading)
}

/// Keeps each item unless a kept item of higher rank lies within `radius(its position)`.
///
/// `items` must be sorted by rank, the highest first. `place` returns the position of an item in
/// px. `widest` is the largest radius that occurs, in px; if it is 0, all items stay.
pub(super) fn suppress_sorted<T>(
    items: Vec<T>,
    place: impl Fn(&T) -> Point,
    widest: f64,
    radius: impl Fn(Point) -> f64,
) -> Vec<T> {
    if widest <= 0. {
        return items;
    }
    let Some(mut kept) = grid_over(items.iter().map(&place), widest) else { return items };
    for item in items {
        let here = place(&item);
        let radius = radius(here);
        let close = |other: Point| (other.x - here.x).powi(2) + (other.y - here.y).powi(2) <= radius * radius;
        if !kept.near(here).any(|item| close(place(item))) {
            kept.insert(here, item);
        }
    }
    kept.into_things()
}

/// Returns an empty grid over all positions `places`, with cells about as wide as `radius`, or
/// `None` if there are no positions.
fn grid_over<T>(places: impl ExactSizeIterator<Item = Point> + Clone, radius: f64) -> Option<BucketGrid<T>> {
    let range = |value: fn(Point) -> f64| {
        let values = places.clone().map(value);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)))
    };
    let ((left, right), (top, bottom)) = (range(|p| p.x), range(|p| p.y));
    if !(right >= left && bottom >= top) {
        return None;
    }
    // however small the radius, the grid has about four cells per position at most and a million
    // along a side: otherwise it would outgrow memory
    let least = ((right - left) * (bottom - top) / (4 * places.len()) as f64).sqrt();
    let side = radius.max(least).max((right - left).max(bottom - top) / 1e6);
    let count = |length: f64| (length / side) as usize + 1;
    Some(BucketGrid::new([left, top], side, [count(right - left), count(bottom - top)]))
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
