//! Search for cones at a spacing that may vary across the image.
//!
//! 1. Cut the image into tiles, so that a single spacing is good enough for each tile.
//! 2. Run a finder on every tile and merge the results, so that each cone counts once.
//! 3. Derive the spacing from the density of the detections, and search again until it settles.

use super::finder::Found;
use super::spacing::{SpacingMap, Start, refined_map};
use super::suppress::{by_score, suppress_sorted};
use super::tiles::{Area, Tile, tiles};
use super::{DetectError, Detection};
use crate::geometry::{Point, Window, nearest_neighbours};
use crate::image::{EmptyPixels, Plane, crop};
use rayon::prelude::*;
use std::collections::HashMap;

/// Largest number of searches of one image by one finder, the first one included; a spacing that
/// has not settled by then is used as it is.
const PASSES: usize = 5;
/// Change of the spacing below which a spacing map has settled, as the absolute logarithm of the
/// ratio of new to old; every node of the map must change by less.
///
/// The limit is wider than for a constant spacing, because a local count of cones scatters more
/// than the count over an entire image.
const MAP_SETTLED: f64 = 0.08;
/// Distance, in spacings, up to which a tile also reports cones beyond its edges.
///
/// Without this overlap, a cone on the edge between two tiles could be missed by both.
const OVERLAP: f64 = 0.5;
/// Distance, in spacings, below which detections of neighbouring tiles are taken for the same cone.
///
/// The detection with the lower score is dropped. Filters and networks, too, keep only one of two
/// maxima closer than about this distance.
const SAME: f64 = 0.5;

/// Returns the regularity index of cones in an image of `height` × `width` px, less its standard
/// error.
///
/// The index is the mean over the standard deviation of the distances to the nearest neighbour.
/// With few points the index is high by chance; its standard error, a fraction of 1 / √(2n) of it
/// for n points, is therefore subtracted. Returns 0 if the index is not defined.
pub(super) fn regularity(centres: &[Point], (height, width): (usize, usize)) -> f64 {
    let Ok(window) = Window::of_image(width, height) else { return 0. };
    let distances = nearest_neighbours(centres, &window).distances;
    let n = distances.len() as f64;
    let mean = distances.iter().sum::<f64>() / n;
    let deviation = (distances.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (n - 1.)).sqrt();
    if deviation > 0. { mean / deviation * (1. - 1. / (2. * n).sqrt()) } else { 0. }
}

/// Function that finds the cones in a part of an image; its arguments are the part and the cone
/// spacing in px.
pub(super) trait Find: Fn(&Plane, f64) -> Result<Found, DetectError> {}

impl<F: Fn(&Plane, f64) -> Result<Found, DetectError>> Find for F {}

/// Areas that were searched, each with its spacing in that search (px) and the detections in it.
type Searched = HashMap<Area, (f64, Found)>;

/// An image whose empty pixels are filled in, and a record of which pixels those are.
#[derive(Clone, Copy)]
pub(super) struct Field<'a> {
    /// Image with its empty pixels filled in.
    pub image: &'a Plane,
    /// Pixels that were not imaged, or `None` if every pixel was imaged.
    pub empty: Option<&'a EmptyPixels>,
}

impl Field<'_> {
    /// Runs `find` on every tile of the image, at the spacing that `map` gives for the tile, and
    /// merges the results.
    ///
    /// Detections on pixels that were not imaged are dropped. `searched` contains the results of
    /// the last search: a tile is not searched again if the logarithm of its spacing has changed
    /// since by less than `settled`. An image of a single tile is always searched anew.
    fn search(
        &self,
        map: &SpacingMap,
        settled: f64,
        searched: &mut Searched,
        find: &(impl Find + Sync),
    ) -> Result<Found, DetectError> {
        let (height, width) = self.image.dim();
        let tiles = tiles(width, height, map);
        let mut found = match &tiles[..] {
            [tile] => find(self.image, tile.spacing)?,
            _ => {
                let part = |tile: &Tile| match searched.get(&tile.core) {
                    Some((spacing, found)) if (tile.spacing / spacing).ln().abs() < settled => {
                        Ok((tile.core, (*spacing, found.clone())))
                    }
                    _ => Ok((tile.core, (tile.spacing, self.search_tile(tile, find)?))),
                };
                let parts: Vec<_> = tiles.par_iter().map(part).collect::<Result<_, _>>()?;
                let found = merged(parts.iter().map(|(_, (_, found))| found), map);
                *searched = parts.into_iter().collect();
                found
            }
        };
        if let Some(empty) = self.empty {
            found.retain(|d| !empty.contains((d.centre.x + 0.5) as usize, (d.centre.y + 0.5) as usize));
        }
        Ok(found)
    }

    /// Runs `find` on a tile with its margin, and keeps the detections in the core of the tile or
    /// at most [`OVERLAP`] spacings outside it.
    fn search_tile(&self, tile: &Tile, find: &impl Find) -> Result<Found, DetectError> {
        let seen = tile.seen;
        let core = tile.core;
        if self.empty.is_some_and(|e| e.part(core.left, core.top, core.right, core.bottom) == 1.) {
            return Ok(Found::default());
        }
        let part = crop(self.image, seen.top, seen.left, seen.height(), seen.width());
        let mut found = find(&part, tile.spacing)?.moved(seen.left, seen.top);
        found.retain(|d| core.contains(d.centre, OVERLAP * tile.spacing));
        Ok(found)
    }

    /// Searches at the spacing `start`, then again at the spacing that the density of the
    /// detections shows, until the logarithm of the spacing changes by less than `settled`.
    ///
    /// Returns the detections of the last search and the spacing that their density shows. If the
    /// spacing is a map that is not constant, [`MAP_SETTLED`] replaces `settled`. The image is
    /// searched at most [`PASSES`] times.
    pub(super) fn until_settled(
        &self,
        start: &Start,
        settled: f64,
        find: impl Find + Sync,
    ) -> Result<(Found, SpacingMap), DetectError> {
        let (height, width) = self.image.dim();
        let mut map = start.map.clone();
        let mut found = Found::default();
        let mut searched = Searched::new();
        for _ in 0..PASSES {
            found = self.search(&map, settled, &mut searched, &find)?;
            let next = refined_map(&found.centres(), width, height, self.empty, start);
            let enough = if next.is_constant() { settled } else { MAP_SETTLED };
            let done = next.change_from(&map) < enough;
            map = next;
            if done {
                break;
            }
        }
        Ok((found, map))
    }
}

/// Merges the detections of all tiles so that each cone counts once.
///
/// A cone on the edge between two tiles is detected in both. Of detections of the same cone, a cone
/// is kept before a rejected candidate, and otherwise the one with the higher score.
fn merged<'a>(parts: impl Iterator<Item = &'a Found>, map: &SpacingMap) -> Found {
    let (mut cones, mut rejected) = (Vec::new(), Vec::new());
    for part in parts {
        cones.extend_from_slice(&part.cones);
        rejected.extend_from_slice(&part.rejected);
    }
    cones.sort_by(by_score);
    rejected.sort_by(by_score);
    let all = cones.into_iter().map(|d| (d, true)).chain(rejected.into_iter().map(|d| (d, false))).collect();
    let widest = SAME * map.range().1;
    let once = suppress_sorted(all, |(d, _)| d.centre, widest, |p| SAME * map.at(p));
    let (cones, rejected): (Vec<_>, Vec<_>) = once.into_iter().partition(|(_, is_cone)| *is_cone);
    let only = |found: Vec<(Detection, bool)>| found.into_iter().map(|(d, _)| d).collect();
    Found { cones: only(cones), rejected: only(rejected) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn tiles_are_searched_again_only_where_the_spacing_changed() {
        let image = Plane::zeros((600, 600));
        let field = Field { image: &image, empty: None };
        // 6 px on the left; on the right as given
        let map =
            |right: f64| SpacingMap::on_grid(vec![200., 400.], vec![300.], &[Some(6.), Some(right)], 6.);
        let calls = AtomicUsize::new(0);
        let find = |part: &Plane, spacing: f64| {
            calls.fetch_add(1, Ordering::Relaxed);
            let centre = Point::new(0.5 * part.ncols() as f64, 0.5 * part.nrows() as f64);
            Ok(Found { cones: vec![Detection { centre, score: 1. / spacing }], rejected: vec![] })
        };
        let mut searched = Searched::new();
        let mut search = |right: f64| {
            let before = calls.load(Ordering::Relaxed);
            let found = field.search(&map(right), 0.03, &mut searched, &find).unwrap();
            (found, calls.load(Ordering::Relaxed) - before)
        };
        let (first, all) = search(12.);
        assert!(all > 4 && !first.cones.is_empty());
        assert_eq!(search(12.), (first.clone(), 0));
        assert_eq!(search(12.1), (first, 0));
        let (_, some) = search(13.);
        assert!((1..all).contains(&some), "{some} of {all}");
    }
}
