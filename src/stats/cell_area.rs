use crate::geometry::{Point, Window};

/// Area of the part of the window that is nearer to `site` than to any of `neighbours` (which must hold all points whose
/// cells touch), in squared units of the coordinates. Rings are cut by one half plane after the other (Sutherland & Hodgman
/// 1974); the edges along which a ring in pieces is joined enclose nothing, so that the sum is right for any polygon.
pub(super) fn clipped_area(window: &Window, site: Point, neighbours: &[Point]) -> f64 {
    let cut = |ring: Vec<[f64; 2]>| {
        let mut ring = ring;
        let mut kept = Vec::with_capacity(ring.len() + 4);
        for p in neighbours {
            let towards = [p.x - site.x, p.y - site.y];
            let middle = (towards[0] * towards[0] + towards[1] * towards[1]) / 2.;
            let beyond = |q: &[f64; 2]| q[0] * towards[0] + q[1] * towards[1] - middle;
            kept.clear();
            for (i, a) in ring.iter().enumerate() {
                let b = &ring[(i + 1) % ring.len()];
                let (at_a, at_b) = (beyond(a), beyond(b));
                if at_a <= 0. {
                    kept.push(*a);
                }
                if (at_a < 0. && at_b > 0.) || (at_a > 0. && at_b < 0.) {
                    let t = at_a / (at_a - at_b);
                    kept.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
                }
            }
            std::mem::swap(&mut ring, &mut kept);
        }
        let twice = |i: usize| {
            let (a, b) = (ring[i], ring[(i + 1) % ring.len()]);
            a[0] * b[1] - b[0] * a[1]
        };
        (0..ring.len()).map(twice).sum::<f64>() / 2.
    };
    // Relative to the site, so that far windows do not cancel.
    let relative = |x: f64, y: f64| [x - site.x, y - site.y];
    match window {
        Window::Polygon(polygon) => {
            let rings = polygon.rings().iter();
            rings.map(|ring| cut(ring.iter().map(|p| relative(p.x, p.y)).collect())).sum::<f64>().abs()
        }
        Window::Rectangle(b) | Window::Torus(b) => cut(vec![
            relative(b.x0(), b.y0()),
            relative(b.x1(), b.y0()),
            relative(b.x1(), b.y1()),
            relative(b.x0(), b.y1()),
        ])
        .abs(),
    }
}
