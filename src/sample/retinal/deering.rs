//! Cone mosaic of cells that attract and repel each other, after Deering (2005).
//!
//! 1. Add a ring of cells of random size around the existing cells.
//! 2. Move the cells of the last rings by the forces between neighbours, for some rounds.
//! 3. Repeat until the window is covered.

use super::outward::{exactly, ring};
use super::retina::{Retina, eccentricity};
use crate::geometry::Point;
use crate::geometry::index::{HashGrid, distance};
use crate::sample::normal_deviate::truncated;
use crate::sample::{Configure, Frame, SampleError, Sampler, Settable, Setting};
use rand::Rng;
use std::collections::VecDeque;

/// Distance between successive rings, in mean diameters: √3/2, the distance between the rows of a
/// triangular lattice.
const RING: f64 = 0.866_025_403_784_438_6;
/// Number of cells per squared mean diameter: that of a triangular lattice.
const DENSITY: f64 = 1. / RING;
/// Number of outermost rings whose cells still move; cells farther in have found their position.
const MOBILE: usize = 5;
/// Largest deviation of a radius from the mean, in standard deviations; radii beyond are drawn
/// again, so that all stay positive.
const DEVIATIONS: f64 = 3.;
/// Distance at which the attraction of two cells ends, in units of the distance at which they
/// touch.
const ATTRACTION_ENDS: f64 = 1.5;
/// Strongest attraction, as a share of the repulsion between coincident cells.
const ATTRACTION: f64 = 0.1;
/// Displacement of a cell in one round, as a share of the force times the distance at which two
/// cells touch.
const RATE: f64 = 0.3;
/// Margin beyond the range of the forces within which cells count as neighbours, in mean diameters.
///
/// Neighbours are found once per ring, so two cells may approach each other by this much before a
/// force is missed.
const SLACK: f64 = 0.5;
/// Distance beyond the window up to which cells are grown, in mean diameters, so that the edge of
/// the pattern does not show.
const BEYOND: f64 = 4.;

/// Model of Deering (2005): cells of random target size, added in rings around the fovea.
///
/// The cells push and pull one another into place.
///
/// **Published** (the author's slides): cones are added in concentric rings outward, with target
/// sizes that vary; an equation gives the forces between them; the borders of the cells are formed
/// anew, and there is a final touch-up; most densities by eccentricity and meridian are from Curcio
/// et al. (1990).
///
/// **As understood here**: target radii are perturbed at random; cells repel each other if they are
/// nearer than the sum of their radii and attract each other if they are somewhat farther apart;
/// only cells near the growing edge move.
///
/// **Not available, so chosen here**: the equation. Two cells at u times the distance at which they
/// touch repel each other by 1 − u for u < 1, and attract each other by 1.6 (u − 1)(1.5 − u) for u
/// from 1 to 1.5. A cell moves by .3 of the sum, in `rounds` rounds per ring; the last five rings
/// move. The paper re-forms the cells' borders as polygons and repairs gaps; here centres interact
/// by their distance alone. The deviation of radii gives a regularity index of 10, within the range
/// of real mosaics (8 to 12).
///
/// **Eccentricity**: without it, the mean radius is the same all over the window. If it is set, the
/// middle of the window lies at that distance from the fovea (in mm), with the fovea to the left.
/// The mean radius then follows the density of human cones (Curcio et al. 1990; the mean of the
/// four meridians, where the original distinguishes them), and n determines the size of the window.
/// The rings are around the fovea.
///
/// Exactly n points are made. Opposite edges of a torus do not fit together, as the model has a
/// centre.
///
/// Sources: Deering (2005), <https://doi.org/10.1145/1073204.1073243>; for the densities, Curcio et
/// al. (1990), <https://doi.org/10.1002/cne.902920402>.
#[derive(Clone, Copy, Debug)]
pub struct Deering {
    /// Standard deviation of the cells' radii, in mean radii.
    pub radius_sd: f64,
    /// Number of rounds of pushing and pulling after each ring.
    pub rounds: usize,
    /// Distance between the fovea and the middle of the window, in mm, or `None` for the same mean
    /// radius everywhere.
    pub eccentricity: Option<f64>,
}

impl Deering {
    /// Default setting, chosen here; see [`Deering`] for the reason.
    pub const DEFAULT: Self = Self { radius_sd: 0.15, rounds: 8, eccentricity: None };
}

impl Sampler for Deering {
    fn name(&self) -> &'static str {
        "deering"
    }

    fn about(&self) -> &'static str {
        "rings of cells of random size that push and pull each other into place; exactly n; no torus \
         (Deering 2005)"
    }

    fn exact(&self) -> bool {
        true
    }

    fn periodic(&self) -> bool {
        false
    }

    fn settable(&self) -> Option<&dyn Configure> {
        Some(self)
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        let retina = Retina::around(self.eccentricity, DENSITY);
        exactly(n, frame, DENSITY, self.name(), |half| {
            let beyond = BEYOND * retina.largest(half);
            self.grow(half.map(|side| side + beyond), &retina, rng)
        })
    }
}

impl Settable for Deering {
    const SETTINGS: &'static [Setting<Self>] = &[
        Setting {
            name: "radius-sd",
            unit: "mean radii",
            range: (0., 0.3),
            whole: false,
            unset: "",
            meaning: "standard deviation of the cells' radii (chosen here)",
            get: |s| Some(s.radius_sd),
            set: |s, v| s.radius_sd = v,
        },
        Setting {
            name: "rounds",
            unit: "",
            range: (0., 100.),
            whole: true,
            unset: "",
            meaning: "rounds of pushing and pulling after each ring (chosen here)",
            get: |s| Some(s.rounds as f64),
            set: |s, v| s.rounds = v as usize,
        },
        eccentricity(|s| s.eccentricity, |s, v| s.eccentricity = Some(v)),
    ];
}

#[derive(Clone, Copy)]
/// Cell of one cone; lengths are in mean diameters in the middle of the window.
struct Cell {
    centre: [f64; 2],
    radius: f64,
}

impl Deering {
    /// Grows cells from the fovea outward and returns their centres.
    ///
    /// The cells cover |x| ≤ `half[0]` and |y| ≤ `half[1]` around the middle of the window, where
    /// the mean diameter is 1.
    fn grow(&self, half: [f64; 2], retina: &Retina, rng: &mut dyn Rng) -> Vec<[f64; 2]> {
        // The rings are around the fovea, in the window or beside it; all positions are relative to
        // the window's middle.
        let fovea = retina.fovea();
        let seen = |[x, y]: [f64; 2]| [x - fovea, y];
        let wide = [half[0] + fovea, half[1]];
        let last = wide[0].hypot(wide[1]);
        let mut radius = (fovea - half[0]).max(0.);
        let mut done = Vec::new();
        // The last `MOBILE` rings of the queue still move; the earlier rings of the queue are fixed
        // and support them.
        let mut edge: VecDeque<Vec<Cell>> = VecDeque::new();
        while radius <= last {
            let step = retina.size(seen([radius, 0.]));
            let places = if radius == 0. { vec![[0., 0.]] } else { ring(radius, step, wide, rng) };
            radius += RING * step;
            let inside = places.into_iter().map(seen).filter(|place| place[0] >= -half[0]);
            let new = inside.map(|centre| {
                let radius = truncated(0.5, 0.5 * self.radius_sd, DEVIATIONS, rng) * retina.size(centre);
                Cell { centre, radius }
            });
            edge.push_back(new.collect());
            if edge.len() > MOBILE + 2 {
                done.extend(edge.pop_front().into_iter().flatten().map(|cell| cell.centre));
            }
            let still = edge.len().saturating_sub(MOBILE);
            let fixed = edge.iter().take(still).map(Vec::len).sum();
            let mut cells: Vec<Cell> = edge.iter().flatten().copied().collect();
            self.settle(&mut cells, fixed, retina.largest(half));
            let mut settled = cells.into_iter();
            edge.iter_mut().flatten().zip(&mut settled).for_each(|(cell, new)| *cell = new);
        }
        done.extend(edge.into_iter().flatten().map(|cell| cell.centre));
        done
    }

    /// Moves all cells except the first `fixed` by the forces between neighbours.
    ///
    /// `largest` is the largest mean diameter of the cells.
    fn settle(&self, cells: &mut [Cell], fixed: usize, largest: f64) {
        let reach = largest * (ATTRACTION_ENDS * (1. + DEVIATIONS * self.radius_sd) + SLACK);
        let mut grid = HashGrid::new(reach);
        cells.iter().enumerate().for_each(|(k, cell)| grid.insert(k, cell.centre));
        // cells that may come within the range of the forces during these rounds
        let neighbours: Vec<Vec<usize>> = cells[fixed..]
            .iter()
            .zip(fixed..)
            .map(|(cell, i)| {
                let near = grid.near(cell.centre);
                near.filter(|&(j, p)| j != i && distance(p, cell.centre) < reach).map(|(j, _)| j).collect()
            })
            .collect();
        for _ in 0..self.rounds {
            for (i, near) in (fixed..).zip(&neighbours) {
                let cell = cells[i];
                let mut moved = [0.; 2];
                for &j in near {
                    let touching = cell.radius + cells[j].radius;
                    let apart = distance(cell.centre, cells[j].centre);
                    if apart > 0. {
                        let push = force(apart / touching) * touching / apart;
                        moved[0] += push * (cell.centre[0] - cells[j].centre[0]);
                        moved[1] += push * (cell.centre[1] - cells[j].centre[1]);
                    }
                }
                cells[i].centre = [cell.centre[0] + RATE * moved[0], cell.centre[1] + RATE * moved[1]];
            }
        }
    }
}

/// Returns the force between two cells at `u` times the distance at which they touch.
///
/// Repulsion is positive, attraction negative.
fn force(u: f64) -> f64 {
    if u < 1. {
        1. - u
    } else if u < ATTRACTION_ENDS {
        let half = (ATTRACTION_ENDS - 1.) / 2.;
        -ATTRACTION * (u - 1.) * (ATTRACTION_ENDS - u) / (half * half)
    } else {
        0.
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Window;
    use crate::stats::{Deviation, moments, nearest_neighbours};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn force_repels_within_touching_attracts_beyond_and_ends() {
        assert_eq!((force(0.), force(1.), force(1.5), force(9.)), (1., 0., 0., 0.));
        assert!(force(0.9) > 0. && (force(1.25) + ATTRACTION).abs() < 1e-12);
    }

    #[test]
    fn cells_that_overlap_or_are_a_little_apart_settle_where_they_touch() {
        for (apart, settled) in [(0.3, 1.1), (1.3, 1.1), (2., 2.)] {
            let cell = |x: f64, radius: f64| Cell { centre: [x, 0.], radius };
            let mut cells = [cell(0., 0.5), cell(apart, 0.6)];
            Deering { rounds: 300, ..Deering::DEFAULT }.settle(&mut cells, 1, 1.);
            assert_eq!(cells[0].centre, [0., 0.], "the first is fixed");
            assert!((cells[1].centre[0] - settled).abs() < 1e-6, "{apart}: {:?}", cells[1].centre);
        }
    }

    #[test]
    fn regularity_is_that_of_real_mosaics_and_falls_with_the_scatter_of_sizes() {
        let window = Window::unit_square();
        let ri = |model: Deering| {
            let of = |seed: u64| {
                let points = model.sample(1024, &window, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
                moments(&nearest_neighbours(&points, &window).distances, Deviation::Population).ri.unwrap()
            };
            (0..6).map(of).sum::<f64>() / 6.
        };
        let default = ri(Deering::DEFAULT);
        let wide = ri(Deering { radius_sd: 0.25, ..Deering::DEFAULT });
        let equal = ri(Deering { radius_sd: 0., ..Deering::DEFAULT });
        println!("default {default}, equal {equal}, of many sizes {wide}");
        assert!((8. ..12.).contains(&default), "{default}");
        assert!(equal > default && default > wide);
    }
}
