use super::ring::{cut, signed_area};
use super::{Point, Ring, Window};

/// Returns the area of the part of the window that is nearer to `site` than to any of `neighbours`,
/// in squared units of the coordinates.
///
/// `neighbours` must contain all points whose Voronoi cells touch that of `site`. Each ring of the
/// window is cut by one half-plane after another (Sutherland & Hodgman 1974,
/// <https://doi.org/10.1145/360767.360802>). The pieces of a ring that falls apart stay joined by
/// edges that enclose nothing, so the sum is right for any polygon.
pub fn clipped_cell_area(window: &Window, site: Point, neighbours: &[Point]) -> f64 {
    // Coordinates are taken relative to the site, as areas far from the origin would lose digits to
    // cancellation.
    let relative = |p: &Point| Point::new(p.x - site.x, p.y - site.y);
    let area = |ring: Ring| {
        let cell = neighbours.iter().map(relative).fold(ring, |ring, to| {
            let middle = (to.x * to.x + to.y * to.y) / 2.;
            cut(&ring, |p| middle - (p.x * to.x + p.y * to.y), |p| p)
        });
        signed_area(&cell)
    };
    let bounds = window.bounds();
    let area = match window {
        Window::Polygon(polygon) => {
            polygon.rings().iter().map(|ring| area(ring.iter().map(relative).collect())).sum()
        }
        Window::Rectangle(_) | Window::Torus(_) => {
            let corners = [
                (bounds.x0(), bounds.y0()),
                (bounds.x1(), bounds.y0()),
                (bounds.x1(), bounds.y1()),
                (bounds.x0(), bounds.y1()),
            ];
            area(corners.iter().map(|&(x, y)| relative(&Point::new(x, y))).collect())
        }
    };
    f64::abs(area)
}
