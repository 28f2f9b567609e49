use crate::geometry::power::PowerDiagram;
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

/// A cell is regular if its spread (second moment over squared area) differs by less than this, on average, from that of its
/// neighbours. Equal for all cells of a crystal; between them about .004 apart where there is none.
const REGULAR: f64 = 2e-4;
/// Standard deviation of the shaking along each axis, in hexagonal spacings.
const SHAKE: f64 = 0.5;

/// Shakes points in regular places and their neighbours; whether there were any.
///
/// What counts as regular is the measure of de Goes et al. (2012, §4.4), the mean absolute difference of a cell's second moment
/// to those of its neighbours; threshold and shaking are chosen, since the paper leaves them to the user.
pub(super) fn shake(
    points: &mut [[f64; 2]],
    diagram: &PowerDiagram,
    spacing: f64,
    rng: &mut dyn Rng,
) -> bool {
    let cells = diagram.cells();
    let mut shaken = vec![false; cells.len()];
    for (i, cell) in cells.iter().enumerate() {
        let facets = diagram.facets(i);
        let difference = |site: u32| (cells[site as usize].spread - cell.spread).abs();
        let sum: f64 = facets.iter().map(|f| difference(f.site)).sum();
        if facets.len() == 6 && sum < REGULAR * facets.len() as f64 {
            shaken[i] = true;
            facets.iter().for_each(|f| shaken[f.site as usize] = true);
        }
    }
    for (point, _) in points.iter_mut().zip(&shaken).filter(|(_, shaken)| **shaken) {
        for coordinate in point {
            let deviate: f64 = StandardNormal.sample(rng);
            *coordinate += SHAKE * spacing * deviate;
        }
    }
    shaken.contains(&true)
}
