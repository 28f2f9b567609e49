use super::laplacian::Laplacian;
use super::multigrid::{Multigrid, centre};
use crate::geometry::power::{PowerDiagram, PowerSites};

/// Newton steps, and halvings of one, before a solve is given up.
const MOST_STEPS: usize = 60;
const MOST_HALVINGS: usize = 30;
/// Rounds of conjugate gradients in a step.
const MOST_ROUNDS: usize = 400;
/// How exactly a step is solved for, at least: relative remainder.
const STEP_TOLERANCE: f64 = 0.1;

/// Weights whose cells have masses near one value, and those cells.
pub(super) struct Solved {
    pub(super) diagram: PowerDiagram,
    /// Greatest relative deviation of a mass.
    pub(super) error: f64,
}

/// Finds weights for which every cell has the mass `target` within `tolerance` (relative), by damped Newton steps (de Goes
/// et al. 2012; damping of Kitagawa, Mérigot & Thibert 2019: a step is halved until no cell is smaller
/// than half the smallest one at the start and the deviation falls as it should, which makes convergence certain).
///
/// Starts from `weights`, or where they hide a site from a half, a quarter … and none of them. Ends early where rounding
/// lets no step succeed: [`Solved::error`] says how near it came.
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

/// Cells smaller than this, relative to what they should be, make Newton steps too short: weights begin anew.
const SMALLEST: f64 = 0.02;

struct State {
    diagram: PowerDiagram,
    least: f64,
    error: f64,
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
