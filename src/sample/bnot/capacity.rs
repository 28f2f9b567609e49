//! Weights for which all power cells have the same mass, by a damped Newton method.
//!
//! 1. Solve a linear system, with the Laplacian of the cells, for the change of weights that brings
//!    all masses to the target.
//! 2. Halve this step until no cell becomes too small and the masses deviate less from the target.
//! 3. Repeat until all masses are within the tolerance.
//!
//! Sources: de Goes et al. (2012), <https://doi.org/10.1145/2366145.2366190>; Kitagawa, Mérigot and
//! Thibert (2019), <https://doi.org/10.4171/JEMS/889>.

use super::laplacian::Laplacian;
use super::multigrid::{Multigrid, centre};
use crate::geometry::power::{PowerDiagram, PowerSites};

/// Largest number of Newton steps in one solve, so that it ends.
const MOST_STEPS: usize = 60;
/// Largest number of times that one Newton step is halved. If no step succeeds, rounding stands in
/// the way, and the solve ends.
const MOST_HALVINGS: usize = 30;
/// Largest number of rounds of conjugate gradients in one Newton step.
const MOST_ROUNDS: usize = 400;
/// Largest residual that the linear system of a Newton step may be left with, relative to its
/// right-hand side. A more exact step would cost more rounds.
const STEP_TOLERANCE: f64 = 0.1;

/// Power diagram whose cells have nearly equal masses.
pub(super) struct Solved {
    pub(super) diagram: PowerDiagram,
    /// Largest relative deviation of a cell's mass from the target.
    pub(super) error: f64,
}

/// Finds weights for which every cell has the mass `target` within the relative deviation
/// `tolerance`.
///
/// A Newton step is halved until no cell is smaller than half the smallest one at the start and the
/// deviation falls in proportion to the step. This is the damping of Kitagawa, Mérigot and Thibert
/// (2019), for which convergence is proved.
///
/// The search starts from `weights`. If a cell is nearly empty with them, the search starts from a
/// half, a quarter or an eighth of the weights, and at last from zero. The search ends early if
/// rounding lets no step succeed; [`Solved::error`] is then the deviation that is left. `hints` is
/// a diagram of nearby sites or other weights, which saves time.
pub(super) fn solve(
    sites: &mut PowerSites<'_>,
    weights: &mut Vec<f64>,
    hints: &PowerDiagram,
    target: f64,
    tolerance: f64,
) -> Solved {
    let mut state = State::of(sites.diagram(weights, Some(hints)), target);
    let mut shrunk = 1f64;
    while state.least < SMALLEST * target && weights.iter().any(|w| *w != 0.) {
        shrunk /= 2.;
        let factor = if shrunk < 0.1 { 0. } else { 0.5 };
        weights.iter_mut().for_each(|w| *w *= factor);
        state = State::of(sites.diagram(weights, Some(&state.diagram)), target);
    }
    let floor = state.least.min(target) / 2.;
    let mut step = Vec::new();
    let mut tried = weights.clone();
    for _ in 0..MOST_STEPS {
        if state.error <= tolerance {
            break;
        }
        let mut missing: Vec<f64> = state.diagram.cells().iter().map(|c| target - c.mass).collect();
        centre(&mut missing);
        // With a residual of 0.3 of the tolerance, a full step can end within the tolerance; a
        // smaller residual would be wasted effort.
        let exactness = STEP_TOLERANCE.min((0.3 * tolerance / state.error).max(1e-3));
        Multigrid::new(Laplacian::of(&state.diagram)).solve(&missing, &mut step, exactness, MOST_ROUNDS);
        let mut length = 1.;
        let found = (0..MOST_HALVINGS).find_map(|_| {
            for ((tried, weight), step) in tried.iter_mut().zip(&*weights).zip(&step) {
                *tried = weight + length * step;
            }
            let next = State::of(sites.diagram(&tried, Some(&state.diagram)), target);
            let falls = next.norm <= (1. - (1. - exactness) * length / 2.) * state.norm;
            let better = next.least >= floor && falls;
            length /= 2.;
            better.then_some(next)
        });
        match found {
            Some(next) => {
                weights.clone_from(&tried);
                state = next;
            }
            None => break,
        }
    }
    Solved { diagram: state.diagram, error: state.error }
}

/// Smallest mass of a cell, as a fraction of the target, with which the Newton steps start.
///
/// With a smaller cell the steps would be too short, so the weights are shrunk first.
const SMALLEST: f64 = 0.02;

/// Power diagram for one choice of the weights, with the deviations of its masses from the target.
struct State {
    diagram: PowerDiagram,
    /// Smallest mass of a cell.
    least: f64,
    error: f64,
    /// Square root of the summed squares of the deviations from the target.
    norm: f64,
}

impl State {
    fn of(diagram: PowerDiagram, target: f64) -> Self {
        let (mut least, mut error, mut square) = (f64::INFINITY, 0f64, 0.);
        for cell in diagram.cells() {
            least = least.min(cell.mass);
            error = error.max((cell.mass - target).abs());
            square += (cell.mass - target).powi(2);
        }
        Self { diagram, least, error: error / target, norm: f64::sqrt(square) }
    }
}
