//! Voronoi cells of a pattern and the statistics of their areas, sides and neighbours.
//!
//! 1. Triangulate the points (Delaunay); on a torus, together with their periodic images around the
//!    window.
//! 2. Collect each cell's corners from the circumcentres around its point, merging those that
//!    coincide.
//! 3. Compute area, number of sides and neighbours; clip the cells that extend beyond the window.

use super::delaunay::{Delaunay, delaunay};
use super::{Deviation, Moments, moments};
use crate::geometry::{Point, Window, clipped_cell_area};
use crate::mosaic::hexagonal_spacing;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use spade::handles::{VertexHandle, VoronoiVertex};
use spade::{Point2, Triangulation};

/// Distance, in hexagonal spacings, below which two Voronoi vertices are merged, because a side
/// without length is no side. The side between them is only rounding error, as in a square lattice.
const SAME_VERTEX: f64 = 1e-7;
/// Smallest number of points for which cells are computed on all threads.
const SPREAD_FROM: usize = 8192;
/// Width of the margin around a torus, in hexagonal spacings, in which the pattern is first
/// repeated. If the margin turns out to be too narrow for a cell, the entire pattern is repeated.
const MARGIN: f64 = 5.;

/// Vertex of the triangulation, which is a point of the pattern.
type Vertex<'a> = VertexHandle<'a, Point2<f64>, (), (), ()>;

/// Voronoi cell: the part of the plane nearer to one point than to any other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cell {
    /// Area in squared units of the coordinates, not clipped to the window.
    ///
    /// `None` if the cell is infinite, if the point is not finite, or if it coincides with an
    /// earlier point, to which the cell then belongs.
    pub area: Option<f64>,
    /// Number of sides of positive length; 0 if `area` is `None`.
    pub sides: usize,
    /// `true` if the cell is bound: it is finite and all its vertices lie strictly inside the
    /// window. On a torus, every cell is bound.
    ///
    /// Source: Cooper et al. (2016), <https://doi.org/10.1167/iovs.16-19072>.
    pub bound: bool,
    /// Area of the part of the cell inside the window, in squared units of the coordinates
    /// (Dirichlet area in spatstat).
    ///
    /// Infinite cells have a clipped area too. `None` for a point that is not finite or coincides
    /// with an earlier point.
    pub clipped_area: Option<f64>,
    /// Inter-cell distance: mean distance from the point to its Delaunay neighbours, the points
    /// beyond the sides of its cell, in units of the coordinates. `None` without neighbours.
    pub inter_cell: Option<f64>,
    /// Distance to the farthest Delaunay neighbour, in units of the coordinates; `None` without
    /// neighbours.
    pub furthest: Option<f64>,
    /// Bond-orientational order ψ6: mean of exp(6iθ) over the directions θ to the Delaunay
    /// neighbours, as real and imaginary part. Directions are measured from +x towards +y. `None`
    /// without neighbours.
    ///
    /// Source: Nelson & Halperin (1979), <https://doi.org/10.1103/PhysRevB.19.2457>.
    pub psi6: Option<[f64; 2]>,
    /// Second moments of the vectors (dx, dy) to the Delaunay neighbours: means of dx², dx·dy and
    /// dy², in squared units of the coordinates. `None` without neighbours.
    pub second_moments: Option<[f64; 3]>,
    /// Distances by which the cell extends from its point to the left, up, to the right and down,
    /// in units of the coordinates.
    ///
    /// `None` if `area` is `None`.
    pub extent: Option<[f64; 4]>,
}

/// Voronoi cells of a pattern.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Voronoi {
    /// One cell per point, in the order of the points.
    pub cells: Vec<Cell>,
}

/// Summary of the Voronoi cells of a pattern.
///
/// A cell is bound if it lies strictly inside the window ([`Cell::bound`]). Without bound cells,
/// `density`, `area_cv` and all values of ψ6 are `None`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct VoronoiSummary {
    /// Number of all cells, which equals the number of points.
    pub n: usize,
    /// Number of bound cells.
    pub bound: usize,
    /// Percentage of the bound cells that have six sides; `None` without bound cells.
    pub six_sided_percent: Option<f64>,
    /// Moments of the areas of the bound cells, in squared units of the coordinates.
    pub area: Moments,
    /// Coefficient of variation of the areas of the bound cells: standard deviation divided by
    /// mean.
    pub area_cv: Option<f64>,
    /// Moments of the numbers of sides of the bound cells.
    pub sides: Moments,
    /// Number of bound cells divided by their total area, in points per squared unit of the
    /// coordinates.
    pub density: Option<f64>,
    /// Moments of the inter-cell distances of the bound cells, in units of the coordinates.
    ///
    /// The inter-cell distance of a cell is the mean distance from its point to its Delaunay
    /// neighbours.
    pub inter_cell: Moments,
    /// Moments of the distances from the points of bound cells to their farthest Delaunay
    /// neighbours, in units of the coordinates.
    pub furthest: Moments,
    /// Moments of the inter-cell distances of all cells, in units of the coordinates.
    ///
    /// At the border, these distances include points along the convex hull that are not true
    /// neighbours.
    pub inter_cell_all: Moments,
    /// Moments of the distances from all points to their farthest Delaunay neighbours, in units of
    /// the coordinates.
    pub furthest_all: Moments,
    /// Mean modulus of the bond-orientational order ψ6 over the bound cells: 1 if every cell is a
    /// regular hexagon.
    pub psi6_mean: Option<f64>,
    /// Modulus of the mean of the bond-orientational order ψ6 over the bound cells: 1 if all cells
    /// are regular hexagons with the same orientation.
    pub psi6_global: Option<f64>,
}

impl Voronoi {
    /// Summarises the bound cells; standard deviations have the divisor n − 1.
    pub fn summary(&self) -> VoronoiSummary {
        let bound: Vec<&Cell> = self.cells.iter().filter(|c| c.bound).collect();
        let areas: Vec<f64> = bound.iter().filter_map(|c| c.area).collect();
        let sides: Vec<f64> = bound.iter().map(|c| c.sides as f64).collect();
        let six = bound.iter().filter(|c| c.sides == 6).count();
        let area = moments(&areas, Deviation::Sample);
        let of = |cells: &mut dyn Iterator<Item = &Cell>, value: fn(&Cell) -> Option<f64>| {
            moments(&cells.filter_map(value).collect::<Vec<f64>>(), Deviation::Sample)
        };
        let psi6: Vec<[f64; 2]> = bound.iter().filter_map(|c| c.psi6).collect();
        let count = psi6.len() as f64;
        let mean = |part: fn(&[f64; 2]) -> f64| psi6.iter().map(part).sum::<f64>() / count;
        VoronoiSummary {
            n: self.cells.len(),
            bound: bound.len(),
            six_sided_percent: (!bound.is_empty()).then(|| 100. * six as f64 / bound.len() as f64),
            area,
            area_cv: area.sd.zip(area.mean).map(|(sd, mean)| sd / mean),
            sides: moments(&sides, Deviation::Sample),
            density: area.mean.map(f64::recip),
            inter_cell: of(&mut bound.iter().copied(), |c| c.inter_cell),
            furthest: of(&mut bound.iter().copied(), |c| c.furthest),
            inter_cell_all: of(&mut self.cells.iter(), |c| c.inter_cell),
            furthest_all: of(&mut self.cells.iter(), |c| c.furthest),
            psi6_mean: (count > 0.).then(|| mean(|p| p[0].hypot(p[1]))),
            psi6_global: (count > 0.).then(|| mean(|p| p[0]).hypot(mean(|p| p[1]))),
        }
    }
}

/// Computes the Voronoi cells of a pattern from its Delaunay triangulation.
///
/// A cell is bound if it lies strictly inside the window ([`Cell::bound`]). On a torus, the pattern
/// is repeated around the window, and every cell is bound. Points that are not finite have no cell.
/// If all points lie on a line, every cell is infinite.
///
/// # Examples
/// ```
/// use conemosaic::prelude::*;
/// use conemosaic::stats::voronoi;
///
/// let window = Window::rectangle(0., 0., 5., 5.)?;
/// let place = |i: usize| Point::new((i % 5) as f64 + 0.5, (i / 5) as f64 + 0.5);
/// let points: Vec<Point> = (0..25).map(place).collect();
/// let summary = voronoi(&points, &window).summary();
/// assert_eq!(summary.bound, 9); // the cells at the border are left out
/// assert!((summary.area.mean.ok_or("no bound cells")? - 1.).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn voronoi(points: &[Point], window: &Window) -> Voronoi {
    let bounds = window.bounds();
    let Some(spacing) = hexagonal_spacing(points.len(), window.area()) else {
        return Voronoi { cells: Vec::new() };
    };
    if !window.is_torus() {
        let (cells, _) = cells(points, points.len(), window, spacing);
        return Voronoi { cells };
    }
    let (w, h) = (bounds.width(), bounds.height());
    let repeated_to = |margin: f64| {
        let mut repeated = points.to_vec();
        for (i, j) in (-1..=1).flat_map(|i| (-1..=1).map(move |j| (i, j))).filter(|&turn| turn != (0, 0)) {
            let (dx, dy) = (f64::from(i) * w, f64::from(j) * h);
            repeated.extend(
                points
                    .iter()
                    .map(|p| Point::new(p.x + dx, p.y + dy))
                    .filter(|&p| bounds.border_distance(p) >= -margin),
            );
        }
        cells(&repeated, points.len(), window, spacing)
    };
    // An image beyond the margin cannot change a cell whose vertices are all within half the margin
    // of its point.
    let margin = MARGIN * spacing;
    let (cells, farthest) = repeated_to(margin);
    if 2. * farthest <= margin {
        return Voronoi { cells };
    }
    // The pattern and its eight shifted copies always suffice. A cell lies in the w × h rectangle
    // around its point, because everything beyond is nearer to the point's own images, and the same
    // holds for the cell of a neighbour.
    Voronoi { cells: repeated_to(f64::INFINITY).0 }
}

/// Returns the cells of the first `n` points and the largest distance from a point to a vertex of
/// its cell, which is infinite if one of the cells is infinite.
///
/// `points` may continue with periodic images of these points. `spacing` is the hexagonal spacing,
/// in units of the coordinates.
fn cells(points: &[Point], n: usize, window: &Window, spacing: f64) -> (Vec<Cell>, f64) {
    /// Cell of a point that has none.
    const NONE: Cell = Cell {
        area: None,
        sides: 0,
        bound: false,
        clipped_area: None,
        inter_cell: None,
        furthest: None,
        psi6: None,
        second_moments: None,
        extent: None,
    };
    let mut cells = vec![NONE; n];
    let bounds = window.bounds();
    let side = bounds.width().max(bounds.height());
    let Some(Delaunay { sites, triangulation }) = delaunay(points, &bounds) else {
        return (cells, 0.);
    };
    let same = SAME_VERTEX * spacing / side;
    // Computes the cell of a point, and the distance from the point to its farthest corner.
    // `adjacent` are all points with an edge of the triangulation to it, `beyond_sides` only those
    // beyond a side of positive length.
    let cell_of = |(index, site): &(usize, [f64; 2]), vertex: Vertex| {
        let mut corners: Vec<[f64; 2]> = Vec::with_capacity(8);
        let mut finite = true;
        let at = points[*index];
        let mut adjacent: Vec<Point> = Vec::with_capacity(8);
        let mut beyond_sides: Vec<Point> = Vec::with_capacity(8);
        for edge in vertex.as_voronoi_face().adjacent_edges() {
            let ends = edge.as_delaunay_edge();
            let other = if ends.from() == vertex { ends.to() } else { ends.from() };
            let other = points[sites[other.index()].0];
            adjacent.push(other);
            let side_length = match (edge.from().position(), edge.to().position()) {
                (Some(a), Some(b)) => apart([a.x, a.y], [b.x, b.y]),
                _ => f64::INFINITY,
            };
            if side_length > same {
                beyond_sides.push(other);
            }
            match edge.from() {
                VoronoiVertex::Inner(face) => {
                    let c = face.circumcenter();
                    let at = [c.x, c.y];
                    if !corners.last().is_some_and(|&last| apart(last, at) <= same) {
                        corners.push(at);
                    }
                }
                VoronoiVertex::Outer(_) => finite = false,
            }
        }
        while corners.len() > 1 && apart(corners[0], corners[corners.len() - 1]) <= same {
            corners.pop();
        }
        let mut cell = NONE;
        describe_neighbours(&mut cell, at, &beyond_sides);
        if !finite || corners.len() < 3 {
            cell.clipped_area = (!window.is_torus()).then(|| clipped_cell_area(window, at, &adjacent));
            return (cell, f64::INFINITY);
        }
        let reach = corners.iter().map(|&c| apart(c, *site)).fold(0., f64::max);
        let twice: f64 = (0..corners.len())
            .map(|i| {
                let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
                // Coordinates relative to the point avoid cancellation in windows far from the
                // origin.
                (a[0] - site[0]) * (b[1] - site[1]) - (b[0] - site[0]) * (a[1] - site[1])
            })
            .sum();
        let (right, bottom) = (bounds.width() / side, bounds.height() / side);
        let inside = match window {
            Window::Polygon(polygon) => corners.iter().all(|c| {
                polygon.contains_strictly(Point::new(bounds.x0() + c[0] * side, bounds.y0() + c[1] * side))
            }),
            Window::Rectangle(_) | Window::Torus(_) => {
                corners.iter().all(|c| c[0] > 0. && c[0] < right && c[1] > 0. && c[1] < bottom)
            }
        };
        let area = twice.abs() / 2. * side * side;
        cell.area = Some(area);
        cell.sides = corners.len();
        cell.extent = Some(corners.iter().fold([0.; 4], |[left, up, right, down], c| {
            let [dx, dy] = [(c[0] - site[0]) * side, (c[1] - site[1]) * side];
            [f64::max(left, -dx), f64::max(up, -dy), f64::max(right, dx), f64::max(down, dy)]
        }));
        cell.bound = inside || window.is_torus();
        let whole = window.is_torus() || window.border_distance(at) >= reach * side;
        cell.clipped_area = Some(if whole { area } else { clipped_cell_area(window, at, &adjacent) });
        (cell, reach * side)
    };
    // The sites keep the order of the points, so the sites of the first n points come first.
    let wanted = sites.partition_point(|(i, _)| *i < n);
    let (sites, vertices) = (&sites[..wanted], &triangulation.vertices().take(wanted).collect::<Vec<_>>());
    let found: Vec<(Cell, f64)> = if wanted < SPREAD_FROM {
        sites.iter().zip(vertices).map(|(site, vertex)| cell_of(site, *vertex)).collect()
    } else {
        sites.par_iter().zip(vertices).map(|(site, vertex)| cell_of(site, *vertex)).collect()
    };
    let mut farthest = 0f64;
    for ((index, _), (cell, reach)) in sites.iter().zip(found) {
        cells[*index] = cell;
        farthest = farthest.max(reach);
    }
    (cells, farthest)
}

/// Fills in the fields of `cell` that depend on the distances and directions from its point to the
/// points beyond its sides.
fn describe_neighbours(cell: &mut Cell, at: Point, neighbours: &[Point]) {
    if neighbours.is_empty() {
        return;
    }
    let n = neighbours.len() as f64;
    let (mut sum, mut furthest, mut psi, mut second) = (0., 0f64, [0.; 2], [0.; 3]);
    for p in neighbours {
        let d = at.distance(*p);
        sum += d;
        furthest = furthest.max(d);
        let (dx, dy) = (p.x - at.x, p.y - at.y);
        let (sin, cos) = (6. * dy.atan2(dx)).sin_cos();
        psi = [psi[0] + cos, psi[1] + sin];
        second = [second[0] + dx * dx, second[1] + dx * dy, second[2] + dy * dy];
    }
    cell.inter_cell = Some(sum / n);
    cell.furthest = Some(furthest);
    cell.psi6 = Some(psi.map(|v| v / n));
    cell.second_moments = Some(second.map(|v| v / n));
}

/// Returns the distance between two positions.
fn apart(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Polygon, Rectangle};
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};

    fn uniform(n: usize, seed: u64) -> Vec<Point> {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        (0..n).map(|_| Point::new(rng.random(), rng.random())).collect()
    }

    #[test]
    fn triangular_lattice_has_six_sided_cells_of_equal_area() {
        let points: Vec<Point> = (0..12)
            .flat_map(|j| (0..12).map(move |i| (i, j)))
            .map(|(i, j)| Point::new(f64::from(i) + 0.5 * f64::from(j % 2), f64::from(j) * 3f64.sqrt() / 2.))
            .collect();
        let window = Window::rectangle(-0.25, -0.5, 11.75, 10.).unwrap();
        let summary = voronoi(&points, &window).summary();
        assert!(summary.bound >= 90, "{}", summary.bound);
        assert_eq!(summary.six_sided_percent, Some(100.));
        assert!((summary.area.mean.unwrap() - 3f64.sqrt() / 2.).abs() < 1e-9);
        assert!(summary.area_cv.unwrap() < 1e-9);
        assert_eq!(summary.sides.ri, None);
    }

    #[test]
    fn cells_of_a_polygon_are_bound_if_every_vertex_is_strictly_inside() {
        let points = uniform(500, 8);
        let square = [(0., 0.), (1., 0.), (1., 1.), (0., 1.)].map(|(x, y)| Point::new(x, y)).to_vec();
        let as_polygon = Window::Polygon(Polygon::new(vec![square.clone()]).unwrap());
        assert_eq!(voronoi(&points, &as_polygon), voronoi(&points, &Window::unit_square()));
        let hole = [(0.4, 0.4), (0.6, 0.4), (0.6, 0.6), (0.4, 0.6)].map(|(x, y)| Point::new(x, y)).to_vec();
        let frame = Window::polygon(vec![square, hole]).unwrap();
        let outside: Vec<Point> = points.into_iter().filter(|&p| frame.contains(p)).collect();
        let (whole, framed) = (voronoi(&outside, &Window::unit_square()), voronoi(&outside, &frame));
        let lost: Vec<Point> = (0..outside.len())
            .filter(|&i| whole.cells[i].bound && !framed.cells[i].bound)
            .map(|i| outside[i])
            .collect();
        assert!(lost.len() > 10 && whole.cells.iter().zip(&framed.cells).all(|(a, b)| a.area == b.area));
        // Only cells next to the hole extend into it.
        assert!(lost.iter().all(|&p| frame.border_distance(p) < 0.15), "{lost:?}");
    }

    #[test]
    fn square_lattice_has_four_sides_since_sides_without_length_do_not_count() {
        let points: Vec<Point> =
            (0..100).map(|i| Point::new(f64::from(i % 10) + 0.5, f64::from(i / 10) + 0.5)).collect();
        let window = Window::rectangle(0., 0., 10., 10.).unwrap();
        let cells = voronoi(&points, &window).cells;
        assert_eq!(cells.iter().filter(|c| c.bound).count(), 64);
        assert!(
            cells.iter().filter(|c| c.bound).all(|c| c.sides == 4 && (c.area.unwrap() - 1.).abs() < 1e-9)
        );
    }

    #[test]
    fn cells_of_a_torus_fill_it_and_have_six_sides_on_average() {
        for n in [1, 2, 3, 10, 300] {
            for bounds in [(0., 0., 1., 1.), (5., -3., 6., 0.)] {
                let bounds = Rectangle::new(bounds.0, bounds.1, bounds.2, bounds.3).unwrap();
                let points: Vec<Point> = uniform(n, n as u64)
                    .iter()
                    .map(|p| {
                        Point::new(bounds.x0() + p.x * bounds.width(), bounds.y0() + p.y * bounds.height())
                    })
                    .collect();
                let cells = voronoi(&points, &Window::Torus(bounds)).cells;
                assert!(cells.iter().all(|c| c.bound));
                let area: f64 = cells.iter().filter_map(|c| c.area).sum();
                assert!((area / bounds.area() - 1.).abs() < 1e-9, "{n}: {area}");
                let sides: usize = cells.iter().map(|c| c.sides).sum();
                // The cell of a single point is the rectangle between its own images.
                assert_eq!(sides, if n == 1 { 4 } else { 6 * n });
            }
        }
    }

    #[test]
    fn clustered_points_on_a_torus_still_fill_it() {
        let points: Vec<Point> =
            uniform(400, 1).iter().map(|p| Point::new(0.02 * p.x + 0.4, 0.02 * p.y)).collect();
        let cells = voronoi(&points, &Window::unit_torus()).cells;
        let area: f64 = cells.iter().filter_map(|c| c.area).sum();
        assert!((area - 1.).abs() < 1e-6, "{area}");
    }

    #[test]
    fn points_on_a_line_or_fewer_than_three_have_no_finite_cell() {
        let line: Vec<Point> = (0..9).map(|i| Point::new(0.1 * f64::from(i), 0.05 * f64::from(i))).collect();
        for points in [&line[..], &line[..2], &line[..1], &[]] {
            let voronoi = voronoi(points, &Window::unit_square());
            assert_eq!(voronoi.cells.len(), points.len());
            assert!(voronoi.cells.iter().all(|c| !c.bound && c.area.is_none()));
            assert_eq!(voronoi.summary().six_sided_percent, None);
        }
    }

    #[test]
    fn a_point_that_coincides_with_another_leaves_the_cells_as_they_were() {
        let mut points = uniform(80, 2);
        let before = voronoi(&points, &Window::unit_square()).cells;
        points.insert(40, points[7]);
        let mut after = voronoi(&points, &Window::unit_square()).cells;
        let none = after.remove(40);
        assert_eq!((none.area, none.clipped_area, none.sides, none.bound), (None, None, 0, false));
        for (a, b) in before.iter().zip(&after) {
            assert_eq!((a.sides, a.bound), (b.sides, b.bound));
        }
    }

    proptest! {
        #[test]
        fn any_small_pattern_has_a_cell_per_point_and_bound_cells_fit_the_window(
            raw in prop::collection::vec((0..7u8, 0..7u8), 0..40), torus: bool, stretch in 1e-6..1e6f64,
        ) {
            let bounds = Rectangle::new(0., 0., 6. * stretch, 6.).unwrap();
            let window = if torus { Window::Torus(bounds) } else { Window::Rectangle(bounds) };
            let points: Vec<Point> =
                raw.iter().map(|&(x, y)| Point::new(f64::from(x) * stretch, f64::from(y))).collect();
            let cells = voronoi(&points, &window).cells;
            prop_assert_eq!(cells.len(), points.len());
            let total: f64 = cells.iter().filter(|c| c.bound).filter_map(|c| c.area).sum();
            prop_assert!(torus || total <= bounds.area() * (1. + 1e-6), "{} of {}", total, bounds.area());
        }
    }
}
