//! Local values of a mosaic: averages over the bound cells in a square window around each cone. A
//! bound cell is a Voronoi cell strictly inside the window of the mosaic.
//!
//! 1. Collect the bound cells near the cone, and for each of them the half-side of the smallest
//!    square around the cone that contains the cell.
//! 2. Take the `n` cells with the smallest half-sides, or all cells inside a square whose side is
//!    set. If fewer than `n` cells are found, widen the search.
//! 3. Average area, distances, ψ6 and numbers of sides over these cells.

use super::LocalWindow;
use crate::geometry::index::NeighbourTree;
use crate::geometry::{NearestNeighbours, Point, Rectangle, Window};
use crate::stats::{Deviation, Voronoi, moments};
use rayon::prelude::*;

/// Factor by which the half-side of the search is enlarged if the previous square contained too few
/// cells.
///
/// It doubles the area, because 1.4² is about 2.
const WIDER: f64 = 1.4;
/// Largest share of the area of a square that may lie outside a polygon for the square to count as
/// inside. So small a share is only rounding error.
const ROUNDING: f64 = 1e-9;

/// State of the local window around a cone: entirely inside the window of the mosaic, extending
/// beyond it, or missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LocalFlag {
    /// The local window lies entirely inside the window of the mosaic.
    Whole,
    /// The local window extends beyond the window of the mosaic, so the cells in it lie mainly on
    /// one side of the cone.
    Edge,
    /// Missing local window: the mosaic has fewer bound cells than requested or none at all, or the
    /// local window would be wider than the torus.
    Few,
}

impl LocalFlag {
    /// Returns the name of the flag in tables, which is empty for [`Self::Whole`].
    pub const fn name(self) -> &'static str {
        match self {
            Self::Whole => "",
            Self::Edge => "edge",
            Self::Few => "few",
        }
    }
}

/// Local values of a mosaic in the square window around one cone.
///
/// The values are means over the bound cells (Voronoi cells strictly inside the window of the
/// mosaic) that lie entirely in the local window. They are `None` if there is no such cell or no
/// local window ([`LocalFlag::Few`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalValues {
    /// Side of the local window, in units of the coordinates: the requested side, or the smallest
    /// side with which the window contains the requested number of bound cells.
    ///
    /// `None` if there is no local window.
    pub side: Option<f64>,
    /// Number of bound cells in the local window, or in the entire mosaic if there is no local
    /// window.
    ///
    /// The number exceeds the requested one if several cells enter the growing window at the same
    /// size.
    pub bound: usize,
    /// State of the local window: entirely inside the window of the mosaic, extending beyond it, or
    /// missing.
    pub flag: LocalFlag,
    /// Density: the number of bound cells divided by their total area, per squared unit of the
    /// coordinates.
    pub density: Option<f64>,
    /// Inter-cell distance (ICD): the mean distance from a cone to its Delaunay neighbours, in
    /// units of the coordinates.
    pub inter_cell: Option<f64>,
    /// Mean distance from a cone to its nearest neighbour, in units of the coordinates.
    pub nearest: Option<f64>,
    /// Regularity index of the nearest-neighbour distances: mean divided by standard deviation.
    /// `None` also if the standard deviation is 0 or not defined.
    pub nearest_ri: Option<f64>,
    /// Mean modulus of ψ6, the bond-orientational order.
    pub psi6: Option<f64>,
    /// Percentage of the bound cells that have six sides.
    pub six_sided_percent: Option<f64>,
}

/// Bound cell (Voronoi cell strictly inside the window of the mosaic) with the values that are
/// averaged over local windows.
struct Member {
    /// Position of the cone.
    at: Point,
    /// Distances by which the cell extends from its point to the left, up, to the right and down.
    extent: [f64; 4],
    /// Area of the cell, in squared units of the coordinates.
    area: f64,
    /// Mean distance to the Delaunay neighbours.
    inter_cell: f64,
    /// Distance to the nearest neighbour.
    nearest: f64,
    /// Modulus of ψ6, the bond-orientational order.
    psi6: f64,
    /// `true` if the cell has six sides.
    six: bool,
}

/// Computes the local values at every cone, in the order of the points.
///
/// The result is the same for any number of threads.
pub(super) fn local_values(
    points: &[Point],
    window: &Window,
    cells: &Voronoi,
    neighbours: &NearestNeighbours,
    size: LocalWindow,
    deviation: Deviation,
) -> Vec<LocalValues> {
    let members: Vec<Member> = points
        .iter()
        .zip(&cells.cells)
        .zip(&neighbours.distances)
        .filter(|((_, cell), _)| cell.bound)
        .filter_map(|((&at, cell), &nearest)| {
            let psi6 = cell.psi6?;
            Some(Member {
                at,
                extent: cell.extent?,
                area: cell.area?,
                inter_cell: cell.inter_cell?,
                nearest,
                psi6: psi6[0].hypot(psi6[1]),
                six: cell.sides == 6,
            })
        })
        .collect();
    let none = few(members.len());
    let Some(finder) = Finder::new(&members, window) else { return vec![none; points.len()] };
    let found = |&at: &Point| {
        let within = match size {
            LocalWindow::Cells(n) => finder.grown(at, n),
            LocalWindow::Side(side) => finder.of_side(at, side),
        };
        within.map_or(none, |(half, chosen)| {
            let flag = if fits(window, at, half) { LocalFlag::Whole } else { LocalFlag::Edge };
            values(&members, &chosen, 2. * half, flag, deviation)
        })
    };
    points.par_iter().map(found).collect()
}

/// Returns the values of a cone without a local window; `bound` is the number of bound cells of the
/// entire mosaic.
const fn few(bound: usize) -> LocalValues {
    LocalValues {
        side: None,
        bound,
        flag: LocalFlag::Few,
        density: None,
        inter_cell: None,
        nearest: None,
        nearest_ri: None,
        psi6: None,
        six_sided_percent: None,
    }
}

/// Averages the values of the members with the indices `chosen`, which are the cells in a local
/// window of side `side`.
fn values(
    members: &[Member],
    chosen: &[usize],
    side: f64,
    flag: LocalFlag,
    deviation: Deviation,
) -> LocalValues {
    let n = chosen.len() as f64;
    let mean = |value: fn(&Member) -> f64| {
        (n > 0.).then(|| chosen.iter().map(|&k| value(&members[k])).sum::<f64>() / n)
    };
    let nearest: Vec<f64> = chosen.iter().map(|&k| members[k].nearest).collect();
    let nearest = moments(&nearest, deviation);
    LocalValues {
        side: Some(side),
        bound: chosen.len(),
        flag,
        density: mean(|m| m.area).map(f64::recip),
        inter_cell: mean(|m| m.inter_cell),
        nearest: nearest.mean,
        nearest_ri: nearest.ri,
        psi6: mean(|m| m.psi6),
        six_sided_percent: mean(|m| if m.six { 100. } else { 0. }),
    }
}

/// Spatial index of the bound cells.
struct Finder<'a> {
    /// Bound cells, in the order of their points.
    members: &'a [Member],
    /// Index of the points of the members.
    tree: NeighbourTree,
    window: &'a Window,
    /// Width and height of the window's bounds.
    sides: [f64; 2],
}

impl<'a> Finder<'a> {
    /// Builds the index; returns `None` if there are no bound cells.
    fn new(members: &'a [Member], window: &'a Window) -> Option<Self> {
        if members.is_empty() {
            return None;
        }
        let bounds = window.bounds();
        let places: Vec<Point> = members.iter().map(|m| m.at).collect();
        let tree = NeighbourTree::in_window(&places, window).ok()?;
        Some(Self { members, tree, window, sides: [bounds.width(), bounds.height()] })
    }

    /// Returns half the side of the largest square that fits on a torus; infinity if the window is
    /// no torus.
    fn widest(&self) -> f64 {
        if self.window.is_torus() { self.sides[0].min(self.sides[1]) / 2. } else { f64::INFINITY }
    }

    /// Returns every cell whose point is at most `half` away from `at` along x and along y, as its
    /// half-side and its index.
    ///
    /// The half-side is half the side of the smallest square centred on `at` that contains the
    /// cell. A square contains a cell if and only if it contains the cell's bounding box, so
    /// `extent` suffices.
    fn near(&self, at: Point, half: f64) -> Vec<(f64, usize)> {
        let reach = |k: usize| {
            let member = &self.members[k];
            let [left, up, right, down] = member.extent;
            let [dx, dy] = self.offset(at, member.at);
            (left - dx).max(right + dx).max(up - dy).max(down + dy)
        };
        self.tree.in_square(at, half).map(|k| (reach(k), k)).collect()
    }

    /// Returns the vector between two points, along the shortest way on a torus.
    fn offset(&self, from: Point, to: Point) -> [f64; 2] {
        let [dx, dy] = [to.x - from.x, to.y - from.y];
        if !self.window.is_torus() {
            return [dx, dy];
        }
        [dx - self.sides[0] * (dx / self.sides[0]).round(), dy - self.sides[1] * (dy / self.sides[1]).round()]
    }

    /// Returns half the side of the smallest square around `at` that contains `n` cells, and the
    /// indices of the cells in it in rising order.
    ///
    /// Returns `None` if no square contains `n` cells. On a torus, only squares that fit on it are
    /// tried.
    fn grown(&self, at: Point, n: usize) -> Option<(f64, Vec<usize>)> {
        if self.members.len() < n || n == 0 {
            return None;
        }
        let mean_area = self.window.area() / self.members.len() as f64;
        // The first square has about twice the area of `n` average cells, because cells that are
        // cut by its sides do not count.
        let mut half = 0.7 * (n as f64 * mean_area).sqrt();
        loop {
            half = half.min(self.widest());
            let mut near = self.near(at, half);
            // Cells whose points are farther than `half` were not searched. A cell in the list may
            // need a larger square than a cell that was not searched, so the list is complete only
            // for half-sides up to `half`.
            near.retain(|&(reach, _)| reach <= half);
            if near.len() >= n {
                let (_, &mut (least, _), _) = near.select_nth_unstable_by(n - 1, |a, b| a.0.total_cmp(&b.0));
                return Some((least, in_order(near.into_iter().filter(|&(reach, _)| reach <= least))));
            }
            if half >= self.widest() || !half.is_finite() {
                return None;
            }
            half *= WIDER;
        }
    }

    /// Returns `side` / 2, and the indices of the cells strictly inside the square of side `side`
    /// around `at` in rising order.
    ///
    /// Returns `None` if the square is wider than the torus.
    fn of_side(&self, at: Point, side: f64) -> Option<(f64, Vec<usize>)> {
        let half = side / 2.;
        (half <= self.widest())
            .then(|| (half, in_order(self.near(at, half).into_iter().filter(|&(reach, _)| reach < half))))
    }
}

/// Returns the indices of the found cells, which come as (half-side, index), in rising order.
///
/// Sums over the cells then do not depend on the order in which the tree is walked.
fn in_order(found: impl Iterator<Item = (f64, usize)>) -> Vec<usize> {
    let mut indices: Vec<usize> = found.map(|(_, k)| k).collect();
    indices.sort_unstable();
    indices
}

/// Returns whether the square of half-side `half` around `at` lies in the window.
fn fits(window: &Window, at: Point, half: f64) -> bool {
    let room = window.border_distance(at);
    match window {
        Window::Rectangle(_) | Window::Torus(_) => room >= half,
        // Two cases are cheap to decide: the border is nearer than the square's sides, or farther
        // than its corners.
        _ if room < half => false,
        _ if room >= half * std::f64::consts::SQRT_2 => true,
        Window::Polygon(polygon) => {
            let square = Rectangle::new(at.x - half, at.y - half, at.x + half, at.y + half);
            square.is_ok_and(|square| {
                let seen = polygon.within(&square).map_or(0., |part| part.area());
                seen >= square.area() * (1. - ROUNDING)
            })
        }
    }
}
