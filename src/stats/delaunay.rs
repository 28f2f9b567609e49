use crate::geometry::{Point, Rectangle};
use spade::{DelaunayTriangulation, Point2};

/// A Delaunay triangulation, in coordinates in which the longer side of the window is 1.
pub(super) struct Delaunay {
    /// Index and place of the point that each vertex is.
    pub(super) sites: Vec<(usize, [f64; 2])>,
    pub(super) triangulation: DelaunayTriangulation<Point2<f64>>,
}

/// Triangulates points, less those that are not finite or coincide with an earlier one. `None` where the points are
/// beyond what can be triangulated.
pub(super) fn delaunay(points: &[Point], bounds: &Rectangle) -> Option<Delaunay> {
    let side = bounds.width().max(bounds.height());
    // The triangulation takes a limited range of numbers only: the window becomes the unit square, subnormal 0.
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
