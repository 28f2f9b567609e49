use super::Plane;

/// Smaller regions, as a part of the image, are dark places rather than places that were not imaged.
const SMALLEST: f64 = 0.005;

/// Smaller regions than this part of the image end abruptly if they were not imaged: around them it is at least this part as
/// bright as everywhere. What fades to black is a dark place, in a picture of few grey levels.
const SMALL: f64 = 0.05;
const ABRUPT: f64 = 0.5;

/// A region of at least so many runs of pixels a row, on average no longer than this, is the ground between cones.
const POROUS_RUNS: usize = 4;
const POROUS_LENGTH: usize = 64;

/// The smallest upright rectangle of an image that holds all that was imaged, in px.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImagedPart {
    /// First row.
    pub top: usize,
    /// First column.
    pub left: usize,
    /// Number of rows.
    pub height: usize,
    /// Number of columns.
    pub width: usize,
}

/// Finds the imaged part: the bounds of the [`imaged_mask`]. All of the image if nothing of it was imaged.
pub fn imaged_part(plane: &Plane) -> ImagedPart {
    let (height, width) = plane.dim();
    let whole = ImagedPart { top: 0, left: 0, height, width };
    imaged_mask(plane).and_then(|mask| part_of(&mask, width)).unwrap_or(whole)
}

/// The bounds of a mask, row by row, of rows of `width`; `None` if it is empty.
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

/// For every pixel, row by row, whether it was imaged; `None` if all were.
///
/// What was not imaged are exactly black regions (4-connected) that cover at least 0.5 % of the image each, as montages and
/// registered averages leave them: margins, and gaps between tiles. Porous regions are imaged: the dark ground between
/// bright cones; and so are small ones that the image fades into. One pass over the pixels, and one byte a pixel.
pub fn imaged_mask(plane: &Plane) -> Option<Vec<bool>> {
    let width = plane.ncols();
    let least = SMALLEST * plane.len() as f64;
    // the commonest case, an image without margin, needs no labelling
    let black = match plane.as_slice() {
        Some(values) => values.iter().map(|&v| usize::from(v == 0.)).sum::<usize>(),
        None => plane.iter().filter(|&&v| v == 0.).count(),
    };
    if black == 0 || (black as f64) < least {
        return None;
    }
    let mut regions = Regions::default();
    for row in plane.rows() {
        regions.add_row(row.iter().map(|&v| v == 0.));
    }
    let mut shapes = vec![Region::default(); regions.runs.len()];
    for k in 0..regions.runs.len() {
        let (run, root) = (regions.runs[k], regions.root(k));
        let region = &mut shapes[root];
        region.rows += usize::from(region.runs == 0 || region.last_row != run.row);
        region.last_row = run.row;
        region.size += run.end - run.first;
        region.runs += 1;
    }
    for k in 0..regions.runs.len() {
        let (run, root) = (regions.runs[k], regions.root(k));
        if shapes[root].size as f64 >= least {
            shapes[root].rim.extend(run.neighbours(plane).filter(|&v| v != 0.));
        }
    }
    let mut all_imaged = Mean::default();
    all_imaged.extend(plane.iter().copied().filter(|&v| v != 0.));
    let small = SMALL * plane.len() as f64;
    let is_hole = |region: &Region| {
        let abrupt = region.rim.value() >= ABRUPT * all_imaged.value();
        region.size as f64 >= least && !region.is_porous() && (abrupt || region.size as f64 >= small)
    };
    let mut mask = vec![true; plane.len()];
    let mut all = true;
    for k in 0..regions.runs.len() {
        let (run, root) = (regions.runs[k], regions.root(k));
        if is_hole(&shapes[root]) {
            mask[run.row * width + run.first..run.row * width + run.end].fill(false);
            all = false;
        }
    }
    (!all).then_some(mask)
}

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

/// A horizontal run of pixels: columns `first..end` of `row`.
#[derive(Clone, Copy)]
struct Run {
    row: usize,
    first: usize,
    end: usize,
}

impl Run {
    /// The pixels above, below and at both ends.
    fn neighbours(self, plane: &Plane) -> impl Iterator<Item = f32> + '_ {
        let ends = [self.first.wrapping_sub(1), self.end].into_iter().map(move |x| (self.row, x));
        let sides = [self.row.wrapping_sub(1), self.row + 1];
        let sides = sides.into_iter().flat_map(move |y| (self.first..self.end).map(move |x| (y, x)));
        ends.chain(sides).filter_map(|place| plane.get(place).copied())
    }
}

/// A connected region in numbers.
#[derive(Clone, Copy, Default)]
struct Region {
    size: usize,
    runs: usize,
    /// Rows in which it has a run; the last of them.
    rows: usize,
    last_row: usize,
    /// What surrounds it.
    rim: Mean,
}

impl Region {
    /// Whether something keeps interrupting it: many runs a row, and short ones.
    fn is_porous(&self) -> bool {
        self.runs >= POROUS_RUNS * self.rows && self.size <= POROUS_LENGTH * self.runs
    }
}

/// Connected regions as runs, row by row, each of which points to an earlier run of its region.
///
/// imageproc's `connected_components` would keep two words and a label for every pixel and panics from 2³² pixels on: too
/// much for a montage, whose margins are few runs.
#[derive(Default)]
struct Regions {
    runs: Vec<Run>,
    parents: Vec<usize>,
    rows: usize,
    /// Where the runs of the row before begin.
    before: usize,
}

impl Regions {
    fn root(&mut self, mut k: usize) -> usize {
        while self.parents[k] != k {
            self.parents[k] = self.parents[self.parents[k]];
            k = self.parents[k];
        }
        k
    }

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
    fn many_small_black_regions_are_dark_places() {
        let plane = Plane::from_shape_fn((100, 100), |(y, x)| f32::from(u8::from((x / 3 + y / 3) % 2 == 0)));
        assert_eq!(imaged_mask(&plane), None);
    }
}
