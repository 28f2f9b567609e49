//! Tiles of an image, each of which is searched with a single spacing.
//!
//! Tiles let a filter that is made for one spacing follow a spacing that varies, and they bound the
//! memory.

use super::spacing::SpacingMap;
use crate::geometry::Point;

/// Largest ratio of the spacings within a tile; an area with a larger ratio is cut, if it is large
/// enough.
///
/// Filters tolerate spacings that differ by this factor from the one they are set to.
const EVEN: f64 = 1.15;
/// Longest side of a tile in px; longer areas are always cut, to bound the memory.
const LONGEST: usize = 1024;
/// Smallest side, in spacings, of the halves of an area that is cut because its spacing varies.
///
/// A square tile of this side is already searched over four times its area, because of its margin
/// ([`MARGIN`]).
const SHORTEST: f64 = 10.;
/// Width, in spacings, of the margin around a tile that is searched with it.
///
/// The response of a filter and its normalisation depend little on pixels farther away.
const MARGIN: f64 = 5.;

/// A rectangle of pixels of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Area {
    /// Index of the first column.
    pub left: usize,
    /// Index of the first row.
    pub top: usize,
    /// Index of the last column plus one.
    pub right: usize,
    /// Index of the last row plus one.
    pub bottom: usize,
}

impl Area {
    /// Returns the number of columns.
    pub(super) const fn width(&self) -> usize {
        self.right - self.left
    }

    /// Returns the number of rows.
    pub(super) const fn height(&self) -> usize {
        self.bottom - self.top
    }

    /// Returns whether `p` lies in the area or less than `reach` px outside its outer edges.
    pub(super) fn contains(&self, p: Point, reach: f64) -> bool {
        let within =
            |v: f64, from: usize, to: usize| v >= from as f64 - 0.5 - reach && v < to as f64 - 0.5 + reach;
        within(p.x, self.left, self.right) && within(p.y, self.top, self.bottom)
    }
}

/// A part of an image that is searched with one spacing.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tile {
    /// Area whose cones the tile reports.
    pub core: Area,
    /// Area that is searched: the core and a margin around it.
    pub seen: Area,
    /// Spacing to search at, in px.
    pub spacing: f64,
}

/// Returns tiles whose cores cover an image of `width` × `height` px without overlap.
///
/// There is a single tile if the image is small enough and its spacing even enough.
pub(super) fn tiles(width: usize, height: usize, map: &SpacingMap) -> Vec<Tile> {
    let mut done = Vec::new();
    let mut open = vec![Area { left: 0, top: 0, right: width, bottom: height }];
    while let Some(core) = open.pop() {
        match cut(core, map) {
            Some((first, second)) => open.extend([second, first]),
            None => done.push(tile(core, width, height, map)),
        }
    }
    done
}

/// Returns the spacings (px) at 5 × 5 evenly spaced points of an area, row by row.
///
/// The outermost points lie on the edges of the area.
fn samples(area: Area, map: &SpacingMap) -> [[f64; 5]; 5] {
    let place = |k: usize, from: usize, to: usize| from as f64 - 0.5 + (to - from) as f64 * k as f64 / 4.;
    std::array::from_fn(|j| {
        let y = place(j, area.top, area.bottom);
        std::array::from_fn(|i| map.at(Point::new(place(i, area.left, area.right), y)))
    })
}

/// Returns the tile whose core is `core`, in an image of `width` × `height` px.
///
/// The spacing of the tile is the geometric mean over 5 × 5 points of the core.
fn tile(core: Area, width: usize, height: usize, map: &SpacingMap) -> Tile {
    let spacings = samples(core, map);
    let spacing = (spacings.iter().flatten().map(|s| s.ln()).sum::<f64>() / 25.).exp();
    let margin = (MARGIN * spacing).ceil() as usize;
    let seen = Area {
        left: core.left.saturating_sub(margin),
        top: core.top.saturating_sub(margin),
        right: (core.right + margin).min(width),
        bottom: (core.bottom + margin).min(height),
    };
    Tile { core, seen, spacing }
}

/// Returns the two halves of an area, or `None` if the area stays one tile.
///
/// An area with a side longer than [`LONGEST`] is cut across its longer side. Any other area is cut
/// if its spacings differ by more than the factor [`EVEN`] and at least one side is long enough for
/// two halves of [`SHORTEST`] times its largest spacing. Of the sides that are long enough, the one
/// along which the spacing changes more is halved.
fn cut(area: Area, map: &SpacingMap) -> Option<(Area, Area)> {
    let s = samples(area, map);
    let (low, high) =
        s.iter().flatten().fold((f64::INFINITY, 0f64), |(low, high), v| (low.min(*v), high.max(*v)));
    let room = 2. * SHORTEST * high;
    let (wide, tall) = (area.width() as f64 >= room, area.height() as f64 >= room);
    let too_large = area.width().max(area.height()) > LONGEST;
    if !(too_large || high / low > EVEN && (wide || tall)) {
        return None;
    }
    let change = |a: f64, b: f64| (a / b).ln().abs();
    let along_x: f64 = s.iter().map(|row| change(row[0], row[2]).max(change(row[2], row[4]))).sum();
    let along_y: f64 = (0..5).map(|i| change(s[0][i], s[2][i]).max(change(s[2][i], s[4][i]))).sum();
    let across =
        if too_large { area.width() >= area.height() } else { wide && (!tall || along_x >= along_y) };
    if across {
        let middle = area.left + area.width() / 2;
        Some((Area { right: middle, ..area }, Area { left: middle, ..area }))
    } else {
        let middle = area.top + area.height() / 2;
        Some((Area { bottom: middle, ..area }, Area { top: middle, ..area }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn one_spacing_needs_one_tile() {
        assert_eq!(tiles(1024, 700, &SpacingMap::constant(9.)).len(), 1);
    }

    proptest! {
        #[test]
        fn cores_cover_every_pixel_once(
            width in 24usize..3000,
            height in 24usize..3000,
            from in 4f64..40.,
            to in 4f64..40.,
        ) {
            let map = SpacingMap::ramp(width as f64, from, to);
            let all = tiles(width, height, &map);
            let area: usize = all.iter().map(|t| t.core.width() * t.core.height()).sum();
            prop_assert_eq!(area, width * height);
            for t in &all {
                prop_assert!(t.seen.left <= t.core.left && t.seen.right >= t.core.right && t.seen.right <= width);
                prop_assert!(t.core.width().max(t.core.height()) <= LONGEST);
            }
        }
    }
}
