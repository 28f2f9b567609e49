use super::LocalWindow;
use crate::geometry::index::NeighbourTree;
use crate::geometry::{NearestNeighbours, Point, Rectangle, Window};
use crate::stats::{Deviation, Voronoi, moments};
use rayon::prelude::*;

/// How much wider a window is looked for where the one before held too few cells.
const WIDER: f64 = 1.4;
/// Share of its area by which a square within a polygon may differ from one that is cut: rounding.
const ROUNDING: f64 = 1e-9;

/// Whether a local window is what was asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LocalFlag {
    /// It lies in the mosaic's window.
    Whole,
    /// It reaches beyond the mosaic's window before it holds its cells: they lie to one side of the cone.
    Edge,
    /// The mosaic holds fewer bound cells than asked for, or none, or the window is wider than a torus: there are no values.
    Few,
}

impl LocalFlag {
    /// As it is written in tables: empty for a whole window.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Whole => "",
            Self::Edge => "edge",
            Self::Few => "few",
        }
    }
}

/// The mosaic in the square window around one cone. Values are means over the bound cells that lie wholly in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalValues {
    /// Side of the window, in units of the coordinates: of the least that holds the cells asked for.
    pub side: Option<f64>,
    /// Bound cells in it: more than asked for where several enter at once; without a window those of the mosaic.
    pub bound: usize,
    /// Whether the window is what was asked for.
    pub flag: LocalFlag,
    /// Cells over their total area, per squared unit of the coordinates.
    pub density: Option<f64>,
    /// Mean distance to the Delaunay neighbours (ICD), in units of the coordinates.
    pub inter_cell: Option<f64>,
    /// Mean distance to the nearest neighbour, in units of the coordinates.
    pub nearest: Option<f64>,
    /// Regularity index of these: mean over standard deviation.
    pub nearest_ri: Option<f64>,
    /// Mean modulus of ψ6.
    pub psi6: Option<f64>,
    /// Per cent of the cells that have six sides.
    pub six_sided_percent: Option<f64>,
}

/// A bound cell.
struct Member {
    at: Point,
    /// To the left, up, to the right, down.
    extent: [f64; 4],
    area: f64,
    inter_cell: f64,
    nearest: f64,
    psi6: f64,
    six: bool,
}

/// Local values at every cone, in the order of the points; the same for any number of threads.
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

/// Bound cells by place.
struct Finder<'a> {
    members: &'a [Member],
    tree: NeighbourTree,
    window: &'a Window,
    sides: [f64; 2],
}

impl<'a> Finder<'a> {
    fn new(members: &'a [Member], window: &'a Window) -> Option<Self> {
        if members.is_empty() {
            return None;
        }
        let bounds = window.bounds();
        let places: Vec<Point> = members.iter().map(|m| m.at).collect();
        let tree = NeighbourTree::in_window(&places, window).ok()?;
        Some(Self { members, tree, window, sides: [bounds.width(), bounds.height()] })
    }

    /// Half the side of a window that a torus can hold.
    fn widest(&self) -> f64 {
        if self.window.is_torus() { self.sides[0].min(self.sides[1]) / 2. } else { f64::INFINITY }
    }

    /// For every cell whose point lies within `half` along both axes half the side of the square around `at` that just
    /// holds the cell, and the cell. Since the window is a square, a cell lies in it as soon as its extent does.
    fn near(&self, at: Point, half: f64) -> Vec<(f64, usize)> {
        let reach = |k: usize| {
            let member = &self.members[k];
            let [left, up, right, down] = member.extent;
            let [dx, dy] = self.offset(at, member.at);
            (left - dx).max(right + dx).max(up - dy).max(down + dy)
        };
        self.tree.in_square(at, half).map(|k| (reach(k), k)).collect()
    }

    fn offset(&self, from: Point, to: Point) -> [f64; 2] {
        let [dx, dy] = [to.x - from.x, to.y - from.y];
        if !self.window.is_torus() {
            return [dx, dy];
        }
        [dx - self.sides[0] * (dx / self.sides[0]).round(), dy - self.sides[1] * (dy / self.sides[1]).round()]
    }

    /// Half the side of the least window that holds `n` cells, and the cells in order; `None` if none does.
    fn grown(&self, at: Point, n: usize) -> Option<(f64, Vec<usize>)> {
        if self.members.len() < n || n == 0 {
            return None;
        }
        let mean_area = self.window.area() / self.members.len() as f64;
        let mut half = 0.7 * (n as f64 * mean_area).sqrt();
        loop {
            half = half.min(self.widest());
            let mut near = self.near(at, half);
            // a cell farther than this may be held by a window no wider than that of a nearer one
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

    /// The cells strictly within a window of this side.
    fn of_side(&self, at: Point, side: f64) -> Option<(f64, Vec<usize>)> {
        let half = side / 2.;
        (half <= self.widest())
            .then(|| (half, in_order(self.near(at, half).into_iter().filter(|&(reach, _)| reach < half))))
    }
}

/// Sums must not depend on the order in which a tree is walked.
fn in_order(found: impl Iterator<Item = (f64, usize)>) -> Vec<usize> {
    let mut indices: Vec<usize> = found.map(|(_, k)| k).collect();
    indices.sort_unstable();
    indices
}

/// Whether the square around `at` lies in the window.
fn fits(window: &Window, at: Point, half: f64) -> bool {
    let room = window.border_distance(at);
    match window {
        Window::Rectangle(_) | Window::Torus(_) => room >= half,
        // the border is nearer than the square's sides, or farther than its corners
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
