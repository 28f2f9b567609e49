//! Local spacing at each cone, which determines the size of the cone.

use super::{RenderError, RenderOptions};
use crate::geometry::Point;
use crate::geometry::index::NeighbourTree;
use std::num::NonZero;

/// Ratio of the hexagonal spacing to the mean distance of the three nearest neighbours in a cone
/// mosaic.
const SPACING_PER_NEIGHBOUR_DISTANCE: f64 = 1.09;
/// Smallest spacing that is assigned to a cone, in px, so that cones at one position have a size.
const MIN_SPACING: f64 = 1.;
/// Largest spacing that is assigned to a cone, in px, so that cones far from all others have a
/// finite size.
const MAX_SPACING: f64 = 1000.;
/// Number of points over which a cone's spacing is averaged: the cone and its ring of six
/// neighbours.
const RING: NonZero<usize> = NonZero::<usize>::MIN.saturating_add(6);

/// Local spacing and nearest-neighbour distance of each cone, from which its size follows.
pub(super) struct CellSizes {
    /// Local hexagonal spacing at each cone, in px.
    pub(super) spacing: Vec<f64>,
    /// Distance between each cone and its nearest neighbour, in px; infinite if there is no other
    /// cone.
    pub(super) nearest: Vec<f64>,
    /// Median of `spacing`, in px: the unit of everything that is not a cone.
    pub(super) typical: f64,
}

impl CellSizes {
    /// Creates the sizes of the cones at `points`.
    ///
    /// The spacing is `options.spacing` at every cone or, if that is `None`, follows from the
    /// distances to the neighbours.
    pub(super) fn of(points: &[Point], options: &RenderOptions) -> Result<Self, RenderError> {
        let neighbours = nearest_neighbours(points)?;
        let nearest = neighbours.iter().map(|n| n.get(1).map_or(f64::INFINITY, |n| n.1)).collect();
        let spacing = match options.spacing {
            Some(spacing) => vec![spacing; points.len()],
            None if points.len() < 4 => return Err(RenderError::SpacingUnknown { found: points.len() }),
            None => local_spacing(&neighbours),
        };
        let mut sorted = spacing.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        let typical = sorted.get(sorted.len() / 2).copied().or(options.spacing).unwrap_or(1.);
        Ok(Self { spacing, nearest, typical })
    }
}

/// Returns, for each point, the indices and distances of the [`RING`] nearest points, the point
/// itself first.
fn nearest_neighbours(points: &[Point]) -> Result<Vec<Vec<(usize, f64)>>, RenderError> {
    if points.is_empty() {
        return Ok(Vec::new());
    }
    let tree = NeighbourTree::in_plane(points)
        .map_err(|e| RenderError::Neighbours { points: points.len(), reason: e.to_string() })?;
    let neighbours = points.iter().enumerate().map(|(own, &place)| {
        let mut found: Vec<(usize, f64)> =
            tree.nearest(place, RING).map(|(k, squared)| (k, squared.sqrt())).collect();
        // Among points at the same position, the tree may name another one first.
        found.sort_by(|a, b| a.1.total_cmp(&b.1).then((a.0 != own).cmp(&(b.0 != own))).then(a.0.cmp(&b.0)));
        found
    });
    Ok(neighbours.collect())
}

/// Returns the local spacing at each point from the distances to its neighbours.
///
/// Unlike a density, the mean distance to the three nearest neighbours is as good at the border of
/// a mosaic as inside. Averaging it over the point and its ring of neighbours removes irregularity
/// and keeps a gradient.
fn local_spacing(neighbours: &[Vec<(usize, f64)>]) -> Vec<f64> {
    let own: Vec<f64> = neighbours
        .iter()
        .map(|ring| {
            let nearest = ring.iter().skip(1).take(3);
            let mean = nearest.clone().map(|n| n.1).sum::<f64>() / nearest.count().max(1) as f64;
            (SPACING_PER_NEIGHBOUR_DISTANCE * mean).clamp(MIN_SPACING, MAX_SPACING)
        })
        .collect();
    neighbours
        .iter()
        .map(|ring| ring.iter().map(|&(i, _)| own[i]).sum::<f64>() / ring.len().max(1) as f64)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::render::{MosaicOptions, cone_mosaic};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn local_spacing_is_that_of_the_density_also_at_the_border() {
        let options = MosaicOptions { width: 300, height: 300, spacing: 10., ..Default::default() };
        let points = cone_mosaic(&options, &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
        let cells = CellSizes::of(&points, &RenderOptions::default()).unwrap();
        let mean = |at: &dyn Fn(Point) -> bool| {
            let chosen = points.iter().zip(&cells.spacing).filter(|(p, _)| at(**p)).map(|(_, s)| *s);
            chosen.clone().sum::<f64>() / chosen.count() as f64
        };
        let border = |p: Point| p.x < 5. || p.y < 5. || p.x > 294. || p.y > 294.;
        let (inside, outside) = (mean(&|p| !border(p)), mean(&border));
        assert!((inside / 10. - 1.).abs() < 0.03, "{inside}");
        assert!((outside / 10. - 1.).abs() < 0.1, "{outside}");
    }

    #[test]
    fn cones_at_one_place_and_cones_far_away_have_a_finite_spacing() {
        let mut points = vec![Point::new(3., 3.); 40];
        points.push(Point::new(1e300, -1e300));
        let cells = CellSizes::of(&points, &RenderOptions::default()).unwrap();
        assert!(cells.spacing.iter().all(|s| (MIN_SPACING..=MAX_SPACING).contains(s)));
    }
}
