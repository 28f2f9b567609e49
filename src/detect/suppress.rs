use super::Detection;
use std::collections::HashMap;

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
    let cell = |v: f64| (v / radius).floor() as i64;
    let mut kept: Vec<Detection> = Vec::new();
    let mut grid: HashMap<(i64, i64), Vec<usize>> = HashMap::new();
    for d in detections {
        let (cx, cy) = (cell(d.centre.x), cell(d.centre.y));
        let taken = (cy - 1..=cy + 1).any(|j| {
            (cx - 1..=cx + 1).any(|i| {
                grid.get(&(i, j))
                    .is_some_and(|near| near.iter().any(|&k| kept[k].centre.distance(d.centre) <= radius))
            })
        });
        if !taken {
            grid.entry((cx, cy)).or_default().push(kept.len());
            kept.push(d);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;

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
