use super::Detection;
use crate::geometry::Point;
use crate::image::Plane;

/// Local maxima of `response` over 3 × 3 px that exceed `threshold`, moved to the top of a parabola through their
/// neighbours along x and along y (at most half a pixel), score = response at the pixel. A plateau counts once: its
/// first pixel in reading order.
pub fn local_maxima(response: &Plane, threshold: f32) -> Vec<Detection> {
    let (h, w) = response.dim();
    let mut found = Vec::new();
    for y in 0..h {
        for x in 0..w {
            let value = response[[y, x]];
            if value > threshold && is_maximum(response, y, x) {
                let offset_x = if x > 0 && x + 1 < w {
                    parabola_top(response[[y, x - 1]], value, response[[y, x + 1]])
                } else {
                    0.
                };
                let offset_y = if y > 0 && y + 1 < h {
                    parabola_top(response[[y - 1, x]], value, response[[y + 1, x]])
                } else {
                    0.
                };
                found.push(Detection {
                    centre: Point::new(x as f64 + offset_x, y as f64 + offset_y),
                    score: f64::from(value),
                });
            }
        }
    }
    found
}

/// Above all earlier neighbours and not below any later one.
fn is_maximum(plane: &Plane, y: usize, x: usize) -> bool {
    let (h, w) = plane.dim();
    let value = plane[[y, x]];
    for j in y.saturating_sub(1)..(y + 2).min(h) {
        for i in x.saturating_sub(1)..(x + 2).min(w) {
            let other = plane[[j, i]];
            let earlier = (j, i) < (y, x);
            if (j, i) != (y, x) && (other > value || (earlier && other == value)) {
                return false;
            }
        }
    }
    true
}

/// Where the parabola through (−1, a), (0, b), (1, c) has its top, within half a sample.
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
    fn the_threshold_is_exclusive() {
        let mut plane = Plane::zeros((3, 3));
        plane[[1, 1]] = 0.5;
        assert!(local_maxima(&plane, 0.5).is_empty());
    }
}
