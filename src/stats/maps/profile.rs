//! Profiles of a mosaic by distance from its cone density centroid: averages over rings, and values
//! of maps along four meridians.

use super::surface::Surface;
use crate::geometry::{Point, Window};
use crate::mosaic::hexagonal_spacing;
use crate::stats::edge_weight::EdgeWeights;
use crate::stats::{NearestNeighbours, Voronoi};

/// Largest number of rings, and of steps along each meridian. Profiles end there, so that a tiny
/// step cannot fill the memory.
const MOST_ROWS: f64 = 10_000.;

/// Kind of a row of a profile: a ring about the centre, or a point on one of four meridians.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// Ring about the centre, over which values are averaged.
    Ring,
    /// Point on the meridian that runs from the centre towards greater x.
    Right,
    /// Point on the meridian that runs from the centre towards greater y, which is down in the
    /// picture.
    Down,
    /// Point on the meridian that runs from the centre towards smaller x.
    Left,
    /// Point on the meridian that runs from the centre towards smaller y, which is up in the
    /// picture.
    Up,
}

impl Along {
    /// Meridians in all four directions.
    pub const MERIDIANS: [Self; 4] = [Self::Right, Self::Down, Self::Left, Self::Up];

    /// Returns the name of the ring or meridian in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ring => "ring",
            Self::Right => "right",
            Self::Down => "down",
            Self::Left => "left",
            Self::Up => "up",
        }
    }

    /// Returns the unit vector along a meridian; the zero vector for rings.
    const fn direction(self) -> [f64; 2] {
        match self {
            Self::Ring => [0., 0.],
            Self::Right => [1., 0.],
            Self::Down => [0., 1.],
            Self::Left => [-1., 0.],
            Self::Up => [0., -1.],
        }
    }
}

/// Values of the mosaic at one distance from the cone density centroid.
///
/// Lengths are in units of the coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfileRow {
    /// Ring or meridian to which the row belongs.
    pub along: Along,
    /// Distance from the cone density centroid; for a ring, the radius of the circle midway between
    /// its inner and outer edge.
    pub r: f64,
    /// Number of bound cells (Voronoi cells strictly inside the window) whose cones lie in the
    /// ring; `None` on a meridian.
    pub bound: Option<usize>,
    /// Share of the circle through the middle of the ring that lies in the window; `None` on a
    /// meridian.
    pub share: Option<f64>,
    /// Density per squared unit of the coordinates.
    ///
    /// In a ring, this is the number of bound cells divided by their total area, or `None` without
    /// bound cells. On a meridian, it is the value of the density map.
    pub density: Option<f64>,
    /// Hexagonal spacing: the spacing of the triangular lattice that has the density of the row.
    pub spacing: Option<f64>,
    /// Inter-cell distance (ICD): the mean distance from a cone to its Delaunay neighbours.
    pub inter_cell: Option<f64>,
    /// Mean distance from a cone to its nearest neighbour.
    pub nearest: Option<f64>,
}

/// Returns the rows of rings of width `step` about `centre`, followed by the rows of the four
/// meridians.
///
/// Rings extend to the farthest bound cell (Voronoi cell strictly inside the window). Along each
/// meridian, the three `maps` (density, inter-cell distance and nearest-neighbour distance, one
/// value per cone) are read in steps of `step`; points at which the density is not defined are left
/// out.
pub(super) fn profile(
    (points, window): (&[Point], &Window),
    (cells, neighbours): (&Voronoi, &NearestNeighbours),
    surface: &Surface,
    maps: &[Vec<Option<f64>>; 3],
    centre: Point,
    step: f64,
) -> Vec<ProfileRow> {
    // For each ring: the number of bound cells, and the sums of their areas, inter-cell distances
    // and nearest-neighbour distances.
    let mut rings: Vec<(usize, [f64; 3])> = Vec::new();
    for (k, cell) in cells.cells.iter().enumerate().filter(|(_, cell)| cell.bound) {
        let at = (window.distance(centre, points[k]) / step).floor();
        let (Some(area), Some(inter_cell), Some(&nearest)) =
            (cell.area, cell.inter_cell, neighbours.distances.get(k))
        else {
            continue;
        };
        if at < MOST_ROWS {
            let at = at as usize;
            rings.resize(rings.len().max(at + 1), (0, [0.; 3]));
            let (n, [areas, inter_cells, nearests]) = &mut rings[at];
            *n += 1;
            *areas += area;
            *inter_cells += inter_cell;
            *nearests += nearest;
        }
    }
    let edges = EdgeWeights::new(window);
    let spacing = |density: Option<f64>| density.and_then(|d| hexagonal_spacing(1, 1. / d));
    let ring = |(k, &(n, sums)): (usize, &(usize, [f64; 3]))| {
        let r = (k as f64 + 0.5) * step;
        let [area, inter_cell, nearest] = sums.map(|sum| (n > 0).then(|| sum / n as f64));
        let density = area.map(f64::recip);
        ProfileRow {
            along: Along::Ring,
            r,
            bound: Some(n),
            share: Some(if window.is_torus() { 1. } else { edges.share_of_circle(centre, r) }),
            density,
            spacing: spacing(density),
            inter_cell,
            nearest,
        }
    };
    let mut rows: Vec<ProfileRow> = rings.iter().enumerate().map(ring).collect();
    let bounds = window.bounds();
    for along in Along::MERIDIANS {
        let [dx, dy] = along.direction();
        let count = (bounds.width().max(bounds.height()) / step).min(MOST_ROWS) as usize;
        for k in 0..=count {
            let r = k as f64 * step;
            let place = Point::new(centre.x + dx * r, centre.y + dy * r);
            let [density, inter_cell, nearest] =
                if bounds.contains(place) { surface.at(place, maps) } else { [None; 3] };
            if density.is_some() {
                let spacing = spacing(density);
                let row =
                    ProfileRow { along, r, bound: None, share: None, density, spacing, inter_cell, nearest };
                rows.push(row);
            }
        }
    }
    rows
}
