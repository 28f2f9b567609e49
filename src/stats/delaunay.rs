//! Delaunay triangulation that accepts any points, including points that coincide, have extreme
//! coordinates or are not finite.

use crate::geometry::{Point, Rectangle};
use spade::{DelaunayTriangulation, Point2};

/// Delaunay triangulation in scaled coordinates, in which the window begins at (0, 0) and its
/// longer side has length 1.
pub(super) struct Delaunay {
    /// Index of the point at each vertex, and its position in the scaled coordinates.
    pub(super) sites: Vec<(usize, [f64; 2])>,
    /// Triangulation whose vertices are `sites`, in the same order.
    pub(super) triangulation: DelaunayTriangulation<Point2<f64>>,
}

/// Triangulates the points, except those that are not finite or coincide with an earlier point.
///
/// Returns `None` if the library that triangulates refuses the points.
pub(super) fn delaunay(points: &[Point], bounds: &Rectangle) -> Option<Delaunay> {
    let side = bounds.width().max(bounds.height());
    // The library accepts only 0 and numbers whose absolute value is neither too small nor too
    // large. So the window is scaled into the unit square, numbers nearer to 0 than 10⁻³⁰ become 0,
    // and points beyond 10³⁰ are left out.
    let unit = |v: f64, low: f64| {
        let t = (v - low) / side;
        if t.abs() < 1e-30 { 0. } else { t }
    };
    let mut sites: Vec<(usize, [f64; 2])> = points
        .iter()
        .enumerate()
        .filter(|(_, p)| p.is_finite())
        .map(|(i, p)| (i, [unit(p.x, bounds.x0()), unit(p.y, bounds.y0())]))
        .filter(|(_, [x, y])| x.abs() < 1e30 && y.abs() < 1e30)
        .collect();
    sites.sort_by(|(i, a), (j, b)| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])).then(i.cmp(j)));
    sites.dedup_by(|later, kept| later.1 == kept.1);
    sites.sort_unstable_by_key(|(i, _)| *i);
    let vertices = sites.iter().map(|(_, [x, y])| Point2::new(*x, *y)).collect();
    let triangulation = DelaunayTriangulation::<Point2<f64>>::bulk_load_stable(vertices).ok()?;
    Some(Delaunay { sites, triangulation })
}
