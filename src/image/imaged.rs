//! Mask of the pixels that were imaged, without margins, gaps of montages and page furniture.
//!
//! 1. Runs of pixels of one value are joined to 4-connected regions in one pass over the rows.
//! 2. A region counts as not imaged if it is large enough, is not porous like the ground between
//!    bright cones, and, unless it is very large, ends abruptly.

mod quiet;

use super::Plane;
use std::collections::BTreeMap;

/// Smallest size of a black region that can count as not imaged, as a fraction of the image.
///
/// Smaller regions are dark parts of the picture.
const SMALLEST: f64 = 0.005;

/// Size, as a fraction of the image, below which a black region must end abruptly to count as not
/// imaged.
///
/// A region that fades to black is a dark part of a picture of few grey levels.
const SMALL: f64 = 0.05;
/// Smallest brightness around a black region that ends abruptly, as a fraction of the mean
/// brightness of all pixels that are not black.
const ABRUPT: f64 = 0.5;

/// Smallest number of runs per row of a porous region, such as the ground between cones.
///
/// The cones interrupt that ground in every row. A run is an unbroken stretch of black pixels in a
/// row.
const POROUS_RUNS: usize = 4;
/// Largest mean length, in px, of the runs of a porous region.
///
/// Where cones are at most 40 px apart, they cut the ground between them into runs that are shorter
/// on average.
const POROUS_LENGTH: usize = 64;

/// Smallest share of the image that other values must fill for a constant to be left out.
///
/// Otherwise the constant is the picture itself, as in a drawn mask.
const PICTURE: f64 = 0.02;

/// Shortest run, in px, of one value that makes the value a candidate for page furniture.
const LONG_RUN: usize = 8;
/// Largest number of values, other than black, whose regions are looked at.
const VALUES: usize = 8;
/// Smallest area, in px, of an upright rectangle that counts as not imaged whatever its share.
///
/// Such rectangles are scale bars and labels.
const RECTANGLE: usize = 64;
/// Half the side, in px, of the square that must fit into a constant region wherever it counts.
const LEAK: usize = 2;
/// Shortest side, in px, of such a rectangle.
const RECTANGLE_SIDE: usize = 3;

/// Smallest upright rectangle of an image that contains everything that was imaged, in px.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImagedPart {
    /// Index of the first row.
    pub top: usize,
    /// Index of the first column.
    pub left: usize,
    /// Height: the number of rows.
    pub height: usize,
    /// Width: the number of columns.
    pub width: usize,
}

/// Returns the part that was imaged: the bounds of the [`imaged_mask`], or all of the image if
/// nothing was imaged.
pub fn imaged_part(plane: &Plane) -> ImagedPart {
    let (height, width) = plane.dim();
    let whole = ImagedPart { top: 0, left: 0, height, width };
    imaged_mask(plane).and_then(|mask| part_of(&mask, width)).unwrap_or(whole)
}

/// Returns the bounds of a mask with rows of `width` pixels, or `None` if no pixel of the mask is
/// `true`.
pub(super) fn part_of(mask: &[bool], width: usize) -> Option<ImagedPart> {
    let imaged = |row: &&[bool]| row.contains(&true);
    let rows = || mask.chunks_exact(width.max(1));
    let top = rows().position(|row| imaged(&row))?;
    let bottom = rows().rposition(|row| imaged(&row))?;
    let (mut left, mut right) = (width, 0);
    for row in rows().skip(top).take(bottom - top + 1) {
        left = row[..left].iter().position(|&v| v).unwrap_or(left);
        right = row[right..].iter().rposition(|&v| v).map_or(right, |k| right + k);
    }
    Some(ImagedPart { top, left, height: bottom - top + 1, width: right - left + 1 })
}

/// Returns a mask, row by row, that is `true` for pixels that were imaged, or `None` if all were.
///
/// Three kinds of pixels count as not imaged: constant regions (margins, gaps of montages, labels
/// and bars), quiet margins of noise without structure, and the letters and lines that these
/// surround. A constant region is 4-connected and at least 0.5 % of the image or an upright
/// rectangle. Regions count as imaged nevertheless if they are porous (the dark ground between
/// bright cones) or if the picture fades into them; exactly black regions from 5 % of the image on
/// may fade. Labelling takes one pass over the pixels per value, the mask one byte per pixel.
pub fn imaged_mask(plane: &Plane) -> Option<Vec<bool>> {
    let mut mask = vec![true; plane.len()];
    let black = black_is_suspicious(plane) && leave_out(&mut mask, plane, 0.);
    let mut furniture = false;
    for value in long_constants(plane) {
        furniture |= leave_out(&mut mask, plane, value);
    }
    furniture |= quiet::leave_out(&mut mask, plane);
    if furniture {
        quiet::leave_out_islands(&mut mask, plane.ncols());
    }
    ((black || furniture) && mask.contains(&true)).then_some(mask)
}

/// Returns the share (0–1) of the image that was not imaged and is not exactly black.
pub fn furniture_share(plane: &Plane) -> f64 {
    let Some(mask) = imaged_mask(plane) else { return 0. };
    let left_out = plane.iter().zip(mask).filter(|(v, imaged)| !imaged && **v != 0.).count();
    left_out as f64 / plane.len() as f64
}

/// Returns whether enough pixels are exactly black for a region that was not imaged.
fn black_is_suspicious(plane: &Plane) -> bool {
    let black = match plane.as_slice() {
        Some(values) => values.iter().map(|&v| usize::from(v == 0.)).sum::<usize>(),
        None => plane.iter().filter(|&&v| v == 0.).count(),
    };
    black > 0 && black as f64 >= SMALLEST * plane.len() as f64
}

/// Returns the values other than black that fill long runs of a row, the commonest first.
fn long_constants(plane: &Plane) -> Vec<f32> {
    let mut lengths: BTreeMap<u32, usize> = BTreeMap::new();
    for row in plane.rows() {
        let (mut value, mut length) = (0f32, 0usize);
        let mut note = |value: f32, length: usize| {
            if length >= LONG_RUN && value != 0. && value.is_finite() {
                *lengths.entry(value.to_bits()).or_default() += length;
            }
        };
        for &v in row {
            if v == value {
                length += 1;
            } else {
                note(value, length);
                (value, length) = (v, 1);
            }
        }
        note(value, length);
    }
    let mut common: Vec<(usize, u32)> =
        lengths.into_iter().filter(|(_, n)| *n >= RECTANGLE).map(|(bits, n)| (n, bits)).collect();
    common.sort_unstable_by(|a, b| b.cmp(a));
    common.truncate(VALUES);
    common.into_iter().map(|(_, bits)| f32::from_bits(bits)).collect()
}

/// Removes regions of the constant `value` from the mask if they were not imaged, and returns
/// whether there are any.
fn leave_out(mask: &mut [bool], plane: &Plane, value: f32) -> bool {
    let width = plane.ncols();
    let least = SMALLEST * plane.len() as f64;
    let mut regions = Regions::default();
    for row in plane.rows() {
        regions.add_row(row.iter().map(|&v| v == value));
    }
    let mut shapes = vec![Region::default(); regions.runs.len()];
    for k in 0..regions.runs.len() {
        let (run, root) = (regions.runs[k], regions.root(k));
        let region = &mut shapes[root];
        if region.runs == 0 {
            (region.left, region.right) = (run.first, run.end);
        }
        region.rows += usize::from(region.runs == 0 || region.last_row != run.row);
        region.last_row = run.row;
        region.size += run.end - run.first;
        region.runs += 1;
        (region.left, region.right) = (region.left.min(run.first), region.right.max(run.end));
    }
    let large = |region: &Region| region.size as f64 >= least || region.is_rectangle();
    for k in 0..regions.runs.len() {
        let (run, root) = (regions.runs[k], regions.root(k));
        if large(&shapes[root]) {
            let away = run.neighbours(plane).filter(|&v| v != value).map(|v| (v - value).abs());
            shapes[root].rim.extend(away);
        }
    }
    let mut all_imaged = Mean::default();
    all_imaged.extend(
        plane.iter().zip(&*mask).filter(|(v, m)| **m && **v != value).map(|(v, _)| (*v - value).abs()),
    );
    // without it nothing would be left: the picture itself has this value, as a drawn mask has
    if value != 0. && (all_imaged.count as f64) < PICTURE * plane.len() as f64 {
        return false;
    }
    let small = SMALL * plane.len() as f64;
    let is_hole = |region: &Region| {
        let abrupt = region.rim.count > 0 && region.rim.value() >= ABRUPT * all_imaged.value();
        let vast = value == 0. && region.size as f64 >= small;
        large(region) && !region.is_porous() && (abrupt || vast)
    };
    let mut any = false;
    // a pixel of the picture beside a margin may have its value by chance; black keeps such pixels,
    // as registration leaves them
    let mut ragged = vec![false; if value == 0. { 0 } else { plane.len() }];
    for k in 0..regions.runs.len() {
        let (run, root) = (regions.runs[k], regions.root(k));
        if is_hole(&shapes[root]) {
            let pixels = run.row * width + run.first..run.row * width + run.end;
            if value == 0. || shapes[root].is_rectangle() {
                mask[pixels].fill(false);
                any = true;
            } else {
                ragged[pixels].fill(true);
            }
        }
    }
    if ragged.contains(&true) {
        for (imaged, broad) in mask.iter_mut().zip(quiet::opened(&ragged, width, LEAK)) {
            any |= broad;
            *imaged &= !broad;
        }
    }
    any
}

/// Mean of values that arrive one after the other.
#[derive(Clone, Copy, Default)]
struct Mean {
    sum: f64,
    count: usize,
}

impl Mean {
    fn extend(&mut self, values: impl Iterator<Item = f32>) {
        for v in values {
            self.sum += f64::from(v);
            self.count += 1;
        }
    }

    fn value(self) -> f64 {
        self.sum / self.count.max(1) as f64
    }
}

/// A horizontal run of pixels: the columns `first..end` of `row`.
#[derive(Clone, Copy)]
struct Run {
    row: usize,
    first: usize,
    end: usize,
}

impl Run {
    /// Returns the values of the pixels above and below the run and of those at both ends.
    fn neighbours(self, plane: &Plane) -> impl Iterator<Item = f32> + '_ {
        let ends = [self.first.wrapping_sub(1), self.end].into_iter().map(move |x| (self.row, x));
        let sides = [self.row.wrapping_sub(1), self.row + 1];
        let sides = sides.into_iter().flat_map(move |y| (self.first..self.end).map(move |x| (y, x)));
        ends.chain(sides).filter_map(|place| plane.get(place).copied())
    }
}

/// A connected region, described by a few numbers.
#[derive(Clone, Copy, Default)]
struct Region {
    /// Number of pixels in the region.
    size: usize,
    /// Number of runs in the region.
    runs: usize,
    /// Number of rows in which the region has a run.
    rows: usize,
    /// Last row in which the region has a run.
    last_row: usize,
    /// First column of the region.
    left: usize,
    /// Column after the last one of the region.
    right: usize,
    /// Mean distance, in grey values, of the pixels around the region from its value.
    rim: Mean,
}

impl Region {
    /// Returns whether the region is an upright rectangle without holes, large enough for a label.
    fn is_rectangle(&self) -> bool {
        let (width, height) = (self.right - self.left, self.rows);
        self.size >= RECTANGLE && width.min(height) >= RECTANGLE_SIDE && self.size == width * height
    }

    /// Returns whether other pixels keep interrupting the region, so that it has many short runs
    /// per row.
    fn is_porous(&self) -> bool {
        self.runs >= POROUS_RUNS * self.rows && self.size <= POROUS_LENGTH * self.runs
    }
}

/// Connected black regions, stored as runs of pixels row by row; each run points to an earlier run
/// of its region.
///
/// `connected_components` of imageproc would keep two words and a label for every pixel and panics
/// from 2³² pixels on. That is too much for a montage, whose margins are few runs.
#[derive(Default)]
struct Regions {
    /// Runs of all rows so far.
    runs: Vec<Run>,
    /// Index, for each run, of an earlier run of the same region, or of the run itself.
    parents: Vec<usize>,
    /// Number of rows so far.
    rows: usize,
    /// Index of the first run of the row that was added last.
    before: usize,
}

impl Regions {
    /// Returns the first run of the region of run `k`, and shortens the chain of runs that leads to
    /// it.
    fn root(&mut self, mut k: usize) -> usize {
        while self.parents[k] != k {
            self.parents[k] = self.parents[self.parents[k]];
            k = self.parents[k];
        }
        k
    }

    /// Adds a row and joins its runs with those above; `black` says of each pixel whether it is
    /// black.
    fn add_row(&mut self, black: impl Iterator<Item = bool>) {
        let (begin, row) = (self.runs.len(), self.rows);
        let mut inside = false;
        for (x, black) in black.enumerate() {
            if black && !inside {
                self.runs.push(Run { row, first: x, end: x });
                self.parents.push(self.parents.len());
            }
            if black && let Some(run) = self.runs.last_mut() {
                run.end = x + 1;
            }
            inside = black;
        }
        let mut above = self.before;
        for k in begin..self.runs.len() {
            let run = self.runs[k];
            while above < begin && self.runs[above].end <= run.first {
                above += 1;
            }
            let mut other = above;
            while other < begin && self.runs[other].first < run.end {
                let (a, b) = (self.root(k), self.root(other));
                self.parents[a.max(b)] = a.min(b);
                other += 1;
            }
        }
        self.before = begin;
        self.rows += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_black_margin_is_empty_and_a_dark_spot_is_not() {
        let plane = Plane::from_shape_fn((100, 100), |(y, x)| {
            let spot = (40..46).contains(&x) && (40..46).contains(&y);
            if x < 20 || spot { 0. } else { 0.5 + 0.001 * (x + y) as f32 }
        });
        let mask = imaged_mask(&plane).unwrap();
        assert_eq!(mask.iter().filter(|v| !**v).count(), 2000);
        assert_eq!(imaged_part(&plane), ImagedPart { top: 0, left: 20, height: 100, width: 80 });
    }

    #[test]
    fn an_image_without_margin_has_no_empty_part() {
        let plane = Plane::from_shape_fn((50, 50), |(y, x)| ((7 * x + 11 * y) % 251) as f32);
        assert_eq!(imaged_mask(&plane), None);
    }

    #[test]
    fn a_black_image_has_no_part_that_stands_out() {
        let part = imaged_part(&Plane::zeros((30, 40)));
        assert_eq!(part, ImagedPart { top: 0, left: 0, height: 30, width: 40 });
    }

    #[test]
    fn arms_that_meet_below_are_one_region() {
        // a comb: three black teeth of .37 % each, too small alone, that join in a black bar
        let plane = Plane::from_shape_fn((100, 100), |(y, x)| {
            let tooth = x % 30 == 10 && (60..97).contains(&y);
            if y >= 97 || tooth { 0. } else { 1. }
        });
        let empty = imaged_mask(&plane).unwrap().iter().filter(|v| !**v).count();
        assert_eq!(empty, 300 + 3 * 37);
    }

    #[test]
    fn a_gap_between_tiles_is_empty_and_the_ground_between_bright_cones_is_not() {
        let gap = Plane::from_shape_fn((100, 100), |(y, x)| {
            f32::from(u8::from(!((30..50).contains(&x) && (40..60).contains(&y))))
        });
        assert_eq!(imaged_mask(&gap).unwrap().iter().filter(|v| !**v).count(), 400);
        for spacing in [5., 8., 20., 40.] {
            let cones = Plane::from_shape_fn((300, 400), |(y, x)| {
                let from_centre = |v: usize| (v as f64 / spacing).fract() - 0.5;
                f32::from(u8::from(from_centre(x).hypot(from_centre(y)) < 0.3))
            });
            assert_eq!(imaged_mask(&cones), None, "{spacing}");
        }
    }

    #[test]
    fn a_dark_place_that_grey_levels_end_in_is_imaged() {
        let fading = |levels: f64| {
            Plane::from_shape_fn((200, 200), |(y, x)| {
                let from_centre = (x as f64 - 100.).hypot(y as f64 - 100.);
                ((levels * (from_centre / 100.).powi(2)).round() / levels) as f32
            })
        };
        let black = fading(40.).iter().filter(|v| **v == 0.).count();
        assert!(black > 300, "{black}");
        assert_eq!(imaged_mask(&fading(40.)), None);
    }

    #[test]
    fn margins_of_constants_and_noise_and_boxes_are_empty() {
        let noise = |y: usize, x: usize| {
            let mut v = (y * 7919 + x).wrapping_mul(0x9E37_79B9_7F4A_7C15);
            v = (v ^ (v >> 31)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            (v >> 40) % 3
        };
        let wave = |k: usize| (0.8 * k as f32 + 0.3).sin();
        let cones = |y: usize, x: usize| 0.5 + 0.4 * wave(x) * wave(y);
        let framed = |margin: &dyn Fn(usize, usize) -> f32| {
            Plane::from_shape_fn((200, 200), |(y, x)| {
                if (50..150).contains(&x) && (50..150).contains(&y) { cones(y, x) } else { margin(y, x) }
            })
        };
        let part = ImagedPart { top: 50, left: 50, height: 100, width: 100 };
        for value in [0., 1. / 255., 0.25, 1.] {
            assert_eq!(imaged_part(&framed(&|_, _| value)), part, "{value}");
        }
        let plane = framed(&|y, x| noise(y, x) as f32 / 255.);
        assert_eq!(imaged_part(&plane), part);
        assert!((furniture_share(&plane) - 0.5).abs() < 0.1, "two thirds of 75 % are not black");
        let boxed = Plane::from_shape_fn((100, 100), |(y, x)| {
            if (10..20).contains(&y) && (30..60).contains(&x) { 1. } else { cones(y, x) }
        });
        assert_eq!(imaged_mask(&boxed).unwrap().iter().filter(|v| !**v).count(), 300);
        let clipped = Plane::from_shape_fn((200, 200), |(y, x)| (2. * cones(y, x)).min(1.));
        assert_eq!(imaged_mask(&clipped), None);
    }

    #[test]
    fn many_small_black_regions_are_dark_places() {
        let plane = Plane::from_shape_fn((100, 100), |(y, x)| f32::from(u8::from((x / 3 + y / 3) % 2 == 0)));
        assert_eq!(imaged_mask(&plane), None);
    }
}
