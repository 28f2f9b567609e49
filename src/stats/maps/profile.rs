use super::surface::Surface;
use crate::geometry::{Point, Window};
use crate::mosaic::hexagonal_spacing;
use crate::stats::edge_weight::EdgeWeights;
use crate::stats::{NearestNeighbours, Voronoi};

/// No more rows than this in one direction.
const MOST_ROWS: f64 = 10_000.;

/// What a row of a profile runs along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Along {
    /// Rings about the centre.
    Ring,
    /// The meridian towards greater x.
    Right,
    /// Towards greater y.
    Down,
    /// Towards smaller x.
    Left,
    /// Towards smaller y.
    Up,
}

impl Along {
    /// The four meridians.
    pub const MERIDIANS: [Self; 4] = [Self::Right, Self::Down, Self::Left, Self::Up];

    /// As it is written in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ring => "ring",
            Self::Right => "right",
            Self::Down => "down",
            Self::Left => "left",
            Self::Up => "up",
        }
    }

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

/// The mosaic at a distance from the cone density centroid. Lengths are in units of the coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfileRow {
    /// A ring or a meridian.
    pub along: Along,
    /// Distance: of a ring the middle of its width.
    pub r: f64,
    /// Of a ring: the bound cells whose cones lie in it.
    pub bound: Option<usize>,
    /// Of a ring: the share of the circle through its middle that lies in the window.
    pub share: Option<f64>,
    /// Of a ring the bound cells over their area; on a meridian the map. Per squared unit of the coordinates.
    pub density: Option<f64>,
    /// Hexagonal spacing of that density.
    pub spacing: Option<f64>,
    /// Mean distance to the Delaunay neighbours (ICD).
    pub inter_cell: Option<f64>,
    /// Mean distance to the nearest neighbour.
    pub nearest: Option<f64>,
}

/// Rings of width `step` about the centre, as far as there are bound cells, then the maps of density, inter-cell distance
/// and nearest neighbour along the four meridians, as far as they are defined.
pub(super) fn profile(
    (points, window): (&[Point], &Window),
    (cells, neighbours): (&Voronoi, &NearestNeighbours),
    surface: &Surface,
    maps: &[Vec<Option<f64>>; 3],
    centre: Point,
    step: f64,
) -> Vec<ProfileRow> {
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
