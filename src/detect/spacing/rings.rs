use super::SpacingMap;
use super::ring::{Power, RingProfile, SIZE, power_of};
use crate::detect::flatten;
use crate::image::{EmptyPixels, Plane, crop};
use rayon::prelude::*;

/// Largest factor by which the spacing of a tile may differ from that of the entire image; the
/// tile's other candidates are ignored.
const LOCAL: f64 = 2.;
/// Smallest fraction of a tile that must have been imaged for the tile to be measured.
const IMAGED: f64 = 0.5;

/// Yellott's ring in all parts of an image, measured in overlapping tiles of 512 px.
///
/// The power of the tiles is averaged for the ring of the entire image (Welch 1967,
/// <https://doi.org/10.1109/TAU.1967.1161901>).
pub(in crate::detect) struct Rings {
    /// Ring of the entire image, from the mean power of the measured tiles.
    whole: RingProfile,
    /// x of the leftmost pixels of each column of tiles.
    columns: Vec<usize>,
    /// y of the topmost pixels of each row of tiles.
    rows: Vec<usize>,
    /// Profile of each tile, row by row, or `None` if too little of the tile was imaged.
    tiles: Vec<Option<RingProfile>>,
    /// Flattened tile that stands for the image: the tile with the largest imaged part and, among
    /// equals, the one nearest to the middle of the image.
    sample: Plane,
    /// Height of the image in px.
    height: usize,
    /// Width of the image in px.
    width: usize,
}

impl Rings {
    /// Returns the rings of an image whose empty pixels are already filled in.
    pub(in crate::detect) fn of(image: &Plane, empty: Option<&EmptyPixels>) -> Self {
        let (height, width) = image.dim();
        let (columns, rows) = (tile_starts(width), tile_starts(height));
        let (tile_height, tile_width) = (height.min(SIZE), width.min(SIZE));
        let corners: Vec<(usize, usize)> =
            rows.iter().flat_map(|&y| columns.iter().map(move |&x| (y, x))).collect();
        let imaged =
            |(y, x): (usize, usize)| empty.map_or(1., |e| 1. - e.part(x, y, x + tile_width, y + tile_height));
        let flat_tile = |(y, x): (usize, usize)| flatten(&crop(image, y, x, tile_height, tile_width));
        let middle = |(y, x): (usize, usize)| {
            let off = |start: usize, side: usize, length: usize| {
                (start as f64 + 0.5 * side as f64 - 0.5 * length as f64).powi(2)
            };
            off(y, tile_height, height) + off(x, tile_width, width)
        };
        let best = corners
            .iter()
            .copied()
            .min_by(|a, b| imaged(*b).total_cmp(&imaged(*a)).then(middle(*a).total_cmp(&middle(*b))))
            .unwrap_or((0, 0));
        let sample = flat_tile(best);
        let power_at = |corner: &(usize, usize)| -> Option<Power> {
            if *corner == best {
                return Some(power_of(&sample));
            }
            (imaged(*corner) >= IMAGED).then(|| power_of(&flat_tile(*corner)))
        };
        let powers: Vec<Option<Power>> = if corners.len() == 1 {
            corners.iter().map(power_at).collect()
        } else {
            corners.par_iter().map(power_at).collect()
        };
        let whole = RingProfile::from_powers(powers.iter().flatten(), (tile_height, tile_width));
        let tiles = powers
            .iter()
            .map(|p| p.as_ref().map(|p| RingProfile::from_powers([p], (tile_height, tile_width))))
            .collect();
        Self { whole, columns, rows, tiles, sample, height, width }
    }

    /// Returns the ring of the entire image.
    pub(in crate::detect) const fn whole(&self) -> &RingProfile {
        &self.whole
    }

    /// Returns a flattened part of the image, at most 512 × 512 px, that stands for all of it.
    pub(in crate::detect) const fn sample(&self) -> &Plane {
        &self.sample
    }

    /// Returns the map of the spacing, smoothed.
    ///
    /// The spacing of a tile is the most probable one within a factor of two of the entire image's.
    pub(in crate::detect) fn map(&self) -> SpacingMap {
        let whole = self.whole.spacing().spacing;
        if self.tiles.len() == 1 {
            return SpacingMap::constant(whole);
        }
        let middles = |starts: &[usize], length: usize| -> Vec<f64> {
            starts.iter().map(|s| *s as f64 + 0.5 * length.min(SIZE) as f64 - 0.5).collect()
        };
        let (x, y) = (middles(&self.columns, self.width), middles(&self.rows, self.height));
        let spacing: Vec<Option<f64>> =
            self.tiles.iter().map(|tile| tile.as_ref().map(|t| t.spacing_near(whole, LOCAL))).collect();
        SpacingMap::on_grid(x, y, &spacing, whole).smoothed()
    }
}

/// Returns the first pixel of every tile along a side of `length` px.
///
/// A side of up to 512 px has one tile; the tiles of a longer side overlap by at least half.
fn tile_starts(length: usize) -> Vec<usize> {
    if length <= SIZE {
        return vec![0];
    }
    let count = (length - SIZE).div_ceil(SIZE / 2) + 1;
    (0..count).map(|k| k * (length - SIZE) / (count - 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_a_side_from_end_to_end() {
        for length in [1, 512, 513, 700, 2048] {
            let starts = tile_starts(length);
            assert_eq!(starts[0], 0);
            assert_eq!(starts[starts.len() - 1] + SIZE.min(length), length);
            assert!(starts.windows(2).all(|s| s[1] > s[0] && s[1] - s[0] <= SIZE / 2));
        }
    }
}
