use crate::geometry::power::PowerDiagram;
use crate::sample::relaxed_region::Region;
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

/// A six-sided cell is regular if its spread (second moment over squared area) differs by less than this, on average, from
/// that of its neighbours. Measured at n = 2000 on the torus: so do less than 1 % of six-sided cells after 20 steps and
/// a quarter of them at rest.
const REGULAR: f64 = 5e-4;
/// Standard deviation of the shaking along each axis, in hexagonal spacings.
const SHAKE: f64 = 0.5;

/// Shakes points in regular places and their neighbours, but for those that would leave the region; whether there were any.
///
/// What counts as regular is the measure of de Goes et al. (2012), the mean absolute difference of a cell's second moment
/// to those of its neighbours; threshold and shaking are chosen here.
pub(super) fn shake(
    points: &mut [[f64; 2]],
    diagram: &PowerDiagram,
    region: &Region,
    spacing: f64,
    rng: &mut dyn Rng,
) -> bool {
    let mut shaken = vec![false; points.len()];
    for i in regular(diagram) {
        shaken[i] = true;
        diagram.facets(i).iter().for_each(|f| shaken[f.site as usize] = true);
    }
    for (point, _) in points.iter_mut().zip(&shaken).filter(|(_, shaken)| **shaken) {
        let mut deviate = || -> f64 {
            SHAKE * spacing * <StandardNormal as Distribution<f64>>::sample(&StandardNormal, rng)
        };
        let to = [point[0] + deviate(), point[1] + deviate()];
        if region.contains(to) {
            *point = to;
        }
    }
    shaken.contains(&true)
}

/// Sites whose cells are regular.
pub(super) fn regular(diagram: &PowerDiagram) -> Vec<usize> {
    let cells = diagram.cells();
    let is_regular = |i: &usize| {
        let facets = diagram.facets(*i);
        let difference = |site: u32| (cells[site as usize].spread - cells[*i].spread).abs();
        let sum: f64 = facets.iter().map(|f| difference(f.site)).sum();
        facets.len() == 6 && sum < REGULAR * facets.len() as f64
    };
    (0..cells.len()).filter(is_regular).collect()
}
