//! Relaxation of points: the masses of the cells are made equal and the points moved to the
//! centroids, in turn. See [`Bnot`] for the steps.

use super::capacity::{Solved, solve};
use super::{Bnot, MOST_STEPS, Region, Watch, regularity};
use crate::geometry::power::{Domain, PowerDiagram, PowerSites};
use crate::sample::{SampleError, Sampler};
use rand::Rng;
use std::f64::consts::TAU;

/// Largest relative deviation of a cell's mass that is allowed between moves; the next move changes
/// the masses anyway.
const LOOSE: f64 = 1e-2;
/// Largest relative deviation of a cell's mass that is allowed in the final pattern.
const EXACT: f64 = 1e-6;
/// Number of steps that follow each break-up of crystals: enough to even out distances, too few for
/// new crystals to form.
const AFTER_BREAK: usize = 20;
/// Distance, in spacings, by which a point without a cell is moved. Such a point coincides with
/// another one, so a small distance parts them.
const NUDGE: f64 = 1e-3;
/// Largest number of times that points without a cell are moved, to give every point a cell.
const NUDGES: usize = 8;

impl Bnot {
    /// Relaxes the points `start` in `region`, and returns them with their cells.
    ///
    /// The points are returned in the order of `start`, the cells in another order. On a torus,
    /// points may lie beyond [0, width) × [0, height).
    ///
    /// # Errors
    /// Fails if the masses cannot be made equal within [`EXACT`].
    pub(super) fn relax(
        &self,
        start: &[[f64; 2]],
        region: &Region,
        rng: &mut dyn Rng,
        progress: &mut Watch<'_>,
    ) -> Result<(Vec<[f64; 2]>, Solved), SampleError> {
        let n = start.len();
        let spacing = region.spacing(n);
        // In this order, points that are close to each other are close in memory.
        let order = PowerSites::new(&region.domain, None, start).order();
        let points = order.iter().map(|&i| start[i as usize]).collect();
        let mut state =
            State { region, points, weights: vec![0.; n], target: 0., diagram: PowerDiagram::default() };
        state.begin(spacing);
        state.move_to_centroids();
        let first = self.steps.unwrap_or(MOST_STEPS);
        let all = first + self.breaks * AFTER_BREAK;
        for round in 0..=self.breaks {
            if round > 0 {
                state.solve(LOOSE);
                if !regularity::shake(&mut state.points, &state.diagram, region, spacing, rng) {
                    break;
                }
                state.weights.fill(0.);
                state.begin(spacing);
                state.move_to_centroids();
            }
            let (done, steps) =
                if round == 0 { (0, first) } else { (first + (round - 1) * AFTER_BREAK, AFTER_BREAK) };
            let mut moved = 1f64;
            for step in 0..steps {
                progress(done + step, all);
                state.solve(LOOSE.min(moved));
                moved = state.move_to_centroids() / spacing;
                if self.steps.is_none() && moved <= self.tolerance {
                    break;
                }
            }
        }
        let error = state.solve(EXACT);
        progress(all, all);
        if error > EXACT {
            return Err(SampleError::Unequal { sampler: self.name(), n, error });
        }
        let mut points = start.to_vec();
        for (&i, p) in order.iter().zip(&state.points) {
            points[i as usize] = *p;
        }
        Ok((points, Solved { diagram: state.diagram, error }))
    }
}

/// Points being relaxed, with their current weights and cells.
struct State<'a> {
    region: &'a Region,
    points: Vec<[f64; 2]>,
    weights: Vec<f64>,
    /// Mass that each cell is to get: the mean of all masses.
    target: f64,
    diagram: PowerDiagram,
}

impl State<'_> {
    fn sites(&self) -> PowerSites<'_> {
        PowerSites::new(&self.region.domain, self.region.density.as_ref(), &self.points)
    }

    /// Computes Voronoi cells and their mean mass, the target; points that have no cell are moved a
    /// little, at most [`NUDGES`] times, until they have one.
    fn begin(&mut self, spacing: f64) {
        for attempt in 0..NUDGES {
            self.diagram = self.sites().diagram(&self.weights, None);
            let cells = self.diagram.cells();
            self.target = cells.iter().map(|c| c.mass).sum::<f64>() / cells.len().max(1) as f64;
            let hidden: Vec<usize> = (0..cells.len()).filter(|&i| cells[i].mass <= 0.).collect();
            if hidden.is_empty() {
                return;
            }
            let centre = self.region.centre();
            for i in hidden {
                // Hidden points move inwards, each in a direction of its own, so that coincident
                // points part.
                let [dx, dy] = self.region.domain.towards(self.points[i], centre);
                let away = dx.hypot(dy).max(f64::MIN_POSITIVE);
                // multiples of the golden ratio are spread evenly round the circle
                let angle = TAU * 0.618_034 * (i * NUDGES + attempt) as f64;
                self.points[i][0] += NUDGE * spacing * (dx / away + 0.7 * angle.cos());
                self.points[i][1] += NUDGE * spacing * (dy / away + 0.7 * angle.sin());
            }
        }
    }

    /// Finds weights that make all masses equal within `tolerance`, and returns the largest
    /// relative deviation of a mass that is left.
    fn solve(&mut self, tolerance: f64) -> f64 {
        let mut weights = std::mem::take(&mut self.weights);
        let solved = solve(&mut self.sites(), &mut weights, &self.diagram, self.target, tolerance);
        self.weights = weights;
        self.diagram = solved.diagram;
        solved.error
    }

    /// Moves every point to the centroid of its cell, and returns the root mean square distance
    /// moved.
    fn move_to_centroids(&mut self) -> f64 {
        let domain: &Domain = &self.region.domain;
        let mut square = 0.;
        for (point, cell) in self.points.iter_mut().zip(self.diagram.cells()) {
            let [dx, dy] = domain.towards(domain.wrapped(*point), cell.centroid);
            square += dx * dx + dy * dy;
            *point = [point[0] + dx, point[1] + dy];
        }
        (square / self.points.len().max(1) as f64).sqrt()
    }
}
