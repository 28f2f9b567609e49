//! Montages: an image seen through overlapping tiles, each turned by a small angle and with a
//! brightness of its own.

use super::RenderOptions;
use super::field::normal;
use crate::image::{Plane, fill_rows};
use rand::{Rng, RngExt};

/// Side of a tile divided by the distance between neighbouring tiles on the grid. That distance is
/// called the pitch.
const OVERLAP: f64 = 1.3;
/// Standard deviation of a tile's displacement from its grid point along each axis, in pitches.
const STRAY: f64 = 0.06;
/// Largest rotation of a tile, in radians: 5°.
const TURN: f64 = 0.087;
/// Standard deviation of the logarithm of the factor by which a tile's brightness differs.
const GAIN: f64 = 0.08;
/// Probability that a tile is left out, for those grid points at the border of the montage whose
/// tile may be missing.
const GAPS: f64 = 0.3;
/// Darkest value of an imaged pixel: one grey level of an 8-bit file, so that black always means a
/// pixel that was not imaged.
const DARKEST: f32 = 1. / 255.;

/// One of the overlapping frames of a montage.
struct Tile {
    /// Position of the tile's centre along x, in px.
    x: f64,
    /// Position of the tile's centre along y, in px.
    y: f64,
    /// Cosine of the angle by which the tile is turned.
    cos: f64,
    /// Sine of the angle by which the tile is turned.
    sin: f64,
    /// Half of the tile's side, in px.
    half: f64,
    /// Factor by which the tile multiplies the brightness.
    gain: f32,
}

impl Tile {
    /// Returns whether the tile covers (x, y), in px.
    fn covers(&self, x: f64, y: f64) -> bool {
        let (dx, dy) = (x - self.x, y - self.y);
        (self.cos * dx + self.sin * dy).abs() <= self.half
            && (self.cos * dy - self.sin * dx).abs() <= self.half
    }
}

/// Tiles of a montage, laid on a grid; later tiles lie on top of earlier ones.
pub(super) struct Montage {
    tiles: Vec<Tile>,
    /// Centre along x of the first column of the grid, in px.
    x0: f64,
    /// Centre along y of the first row of the grid, in px.
    y0: f64,
    /// Distance between neighbouring grid points, in px.
    pitch: f64,
    columns: usize,
    rows: usize,
    /// Index of the tile at each grid point, row by row, or `None` if the tile is left out.
    at: Vec<Option<usize>>,
}

impl Montage {
    /// Lays tiles on a grid that fills the image, and leaves out some of the outermost ones.
    pub(super) fn new(options: &RenderOptions, rng: &mut dyn Rng) -> Self {
        let (w, h) = (options.width as f64, options.height as f64);
        // The outer edges of the outermost tiles lie on the border of the image, before the tiles
        // stray.
        let pitch = w.max(h) / (options.montage as f64 + OVERLAP - 1.);
        let count = |side: f64| ((side / pitch - OVERLAP + 1.).round() as usize).max(1);
        let (columns, rows) = (count(w), count(h));
        let first = |side: f64, count: usize| 0.5 * side - 0.5 * pitch * (count - 1) as f64 - 0.5;
        let (x0, y0) = (first(w, columns), first(h, rows));
        let mut at = vec![None; columns * rows];
        let mut tiles = Vec::new();
        for (k, place) in at.iter_mut().enumerate() {
            let (i, j) = (k % columns, k / columns);
            let outermost = |i: usize, count: usize| count > 2 && (i == 0 || i + 1 == count);
            let (across, down) = (outermost(i, columns), outermost(j, rows));
            // Every other tile along a side stays, so that the montage does not fall apart.
            let may_miss = (across && (down || j % 2 == 1)) || (down && i % 2 == 1);
            let missing = rng.random::<f64>() < GAPS;
            let (stray_x, stray_y) = (STRAY * normal(rng), STRAY * normal(rng));
            let (sin, cos) = rng.random_range(-TURN..TURN).sin_cos();
            let gain = (GAIN * normal(rng)).exp() as f32;
            if may_miss && missing {
                continue;
            }
            *place = Some(tiles.len());
            let (x, y) = (x0 + pitch * (i as f64 + stray_x), y0 + pitch * (j as f64 + stray_y));
            tiles.push(Tile { x, y, cos, sin, half: 0.5 * OVERLAP * pitch, gain });
        }
        Self { tiles, x0, y0, pitch, columns, rows, at }
    }

    /// Returns the uppermost tile at (x, y), or `None` if no tile covers that point.
    fn tile(&self, x: f64, y: f64) -> Option<&Tile> {
        // The corners of a tile are .92 pitches from its centre, and tiles stray by .06 pitches
        // (standard deviation), so only tiles within two grid points can cover (x, y).
        let near = |v: f64, from: f64, count: usize| {
            let place = (v - from) / self.pitch;
            let low = (place - 2.).floor().clamp(0., count as f64) as usize;
            let high = (place + 3.).ceil().clamp(0., count as f64) as usize;
            low..high.max(low)
        };
        let columns = near(x, self.x0, self.columns);
        near(y, self.y0, self.rows)
            .rev()
            .flat_map(|j| columns.clone().rev().map(move |i| (i, j)))
            .filter_map(|(i, j)| self.at[j * self.columns + i].and_then(|t| self.tiles.get(t)))
            .find(|tile| tile.covers(x, y))
    }

    /// Returns whether a tile covers the pixel nearest to (x, y), in px.
    pub(super) fn covers(&self, x: f64, y: f64) -> bool {
        self.tile(x.round(), y.round()).is_some()
    }

    /// Returns the image as the montage shows it; pixels outside all tiles are 0.
    pub(super) fn applied(&self, image: &Plane) -> Plane {
        let (height, width) = image.dim();
        fill_rows(height, width, |y, row| {
            for (x, out) in row.iter_mut().enumerate() {
                let tile = self.tile(x as f64, y as f64);
                *out = tile.map_or(0., |t| (t.gain * image[[y, x]]).clamp(DARKEST, 1.));
            }
        })
    }
}
