//! Margins of faint noise without structure, and islands that furniture surrounds.
//!
//! 1. Square blocks whose standard deviation is tiny against the picture's are quiet.
//! 2. Quiet blocks that form broad areas at the border are a margin if neighbouring pixels in them
//!    are uncorrelated, as in noise and unlike in a dark or blurred part of the retina.
//! 3. The margin is continued to the pixel by the range of its grey values.

use super::Regions;
use crate::image::Plane;

/// Side of the blocks in px.
const BLOCK: usize = 8;
/// Largest standard deviation in a quiet block, as a fraction of that of the picture.
const QUIET: f64 = 0.12;
/// Largest correlation of neighbouring pixels in a margin of noise.
const UNCORRELATED: f64 = 0.2;
/// Smallest share of the image that a quiet margin takes.
const SMALLEST: f64 = 0.02;
/// Percentile (0–1) of the blocks' standard deviations that stands for the picture.
const PICTURE: f64 = 0.9;
/// Smallest area of an island of imaged pixels that is kept, as a fraction of the largest one.
const ISLAND: f64 = 0.02;

/// Sums over the pixels of one block.
#[derive(Clone, Copy, Default)]
struct Block {
    /// Sum of squared distances from the mean of the block.
    power: f64,
    /// Sum of products of such distances of horizontal neighbours, scaled to the count of `power`.
    product: f64,
    /// Smallest and largest grey value.
    range: (f32, f32),
}

fn block_of(plane: &Plane, top: usize, left: usize) -> Block {
    let (mut sum, mut range) = (0f64, (f32::INFINITY, f32::NEG_INFINITY));
    let row = |y: usize| (left..left + BLOCK).map(move |x| plane[[y, x]]);
    for v in (top..top + BLOCK).flat_map(row) {
        sum += f64::from(v);
        range = (range.0.min(v), range.1.max(v));
    }
    let mean = sum / (BLOCK * BLOCK) as f64;
    let mut block = Block { range, ..Block::default() };
    for y in top..top + BLOCK {
        let mut before = 0.;
        for v in row(y) {
            let away = f64::from(v) - mean;
            block.power += away * away;
            block.product += before * away;
            before = away;
        }
    }
    block.product *= BLOCK as f64 / (BLOCK - 1) as f64;
    block
}

/// Removes quiet margins from the mask, and returns whether there are any.
pub(super) fn leave_out(mask: &mut [bool], plane: &Plane) -> bool {
    let (height, width) = plane.dim();
    let (rows, columns) = (height / BLOCK, width / BLOCK);
    if rows < 3 || columns < 3 {
        return false;
    }
    // the last block of a row or column ends at the border and may overlap the one before it
    let at = |k: usize, side: usize| (k * BLOCK).min(side - BLOCK);
    let (rows, columns) = (rows + usize::from(height % BLOCK > 0), columns + usize::from(width % BLOCK > 0));
    let blocks: Vec<Block> = (0..rows * columns)
        .map(|k| block_of(plane, at(k / columns, height), at(k % columns, width)))
        .collect();
    let mut powers: Vec<f64> = blocks.iter().map(|b| b.power).filter(|p| *p > 0.).collect();
    if powers.is_empty() {
        return false;
    }
    let rank = (PICTURE * (powers.len() - 1) as f64) as usize;
    let typical = *powers.select_nth_unstable_by(rank, f64::total_cmp).1;
    let quiet: Vec<bool> = blocks.iter().map(|b| b.power < QUIET * QUIET * typical).collect();
    if (quiet.iter().filter(|q| **q).count() as f64) < SMALLEST * quiet.len() as f64 {
        return false;
    }
    let broad = opened(&quiet, columns, 1);
    let mut any = false;
    for region in components(&broad, columns) {
        let border = region.iter().any(|&k| {
            let (y, x) = (k / columns, k % columns);
            y == 0 || x == 0 || y + 1 == rows || x + 1 == columns
        });
        // what was left out before for another reason tells nothing of the noise
        let fresh: Vec<usize> = region
            .into_iter()
            .filter(|&k| mask[at(k / columns, height) * width + at(k % columns, width)])
            .collect();
        let power: f64 = fresh.iter().map(|&k| blocks[k].power).sum();
        let product: f64 = fresh.iter().map(|&k| blocks[k].product).sum();
        let enough = fresh.len() as f64 >= SMALLEST * blocks.len() as f64;
        // a constant is no noise
        if border && enough && power > 0. && product <= UNCORRELATED * power {
            continue_to_pixels(mask, width, plane, &fresh, (&blocks, columns));
            any = true;
        }
    }
    any
}

/// Removes from the mask the blocks of a margin, and the pixels of the blocks around them that
/// have grey values of the margin and lie in broad areas of such values.
fn continue_to_pixels(
    mask: &mut [bool],
    width: usize,
    plane: &Plane,
    margin: &[usize],
    (blocks, columns): (&[Block], usize),
) {
    let height = mask.len() / width;
    let range =
        |(low, high): (f32, f32), k: &usize| (low.min(blocks[*k].range.0), high.max(blocks[*k].range.1));
    let (low, high) = margin.iter().fold((f32::INFINITY, f32::NEG_INFINITY), range);
    let mut near = vec![false; mask.len()];
    for &k in margin {
        let (top, left) =
            ((k / columns * BLOCK).min(height - BLOCK), (k % columns * BLOCK).min(width - BLOCK));
        for y in top.saturating_sub(2 * BLOCK)..(top + 3 * BLOCK).min(height) {
            near[y * width + left.saturating_sub(2 * BLOCK)..y * width + (left + 3 * BLOCK).min(width)]
                .fill(true);
        }
    }
    for (near, v) in near.iter_mut().zip(plane) {
        *near &= (low..=high).contains(v);
    }
    for (k, broad) in opened(&near, width, 3).into_iter().enumerate() {
        mask[k] &= !broad;
    }
}

/// Removes islands of imaged pixels that are small against the largest one: letters and lines.
pub(super) fn leave_out_islands(mask: &mut [bool], width: usize) {
    let islands = components(mask, width);
    let largest = islands.iter().map(Vec::len).max().unwrap_or(0);
    for island in islands.iter().filter(|i| (i.len() as f64) < ISLAND * largest as f64) {
        for &k in island {
            mask[k] = false;
        }
    }
}

/// Returns the 4-connected components of a mask, each as the indexes of its pixels.
fn components(mask: &[bool], width: usize) -> Vec<Vec<usize>> {
    let mut regions = Regions::default();
    for row in mask.chunks_exact(width.max(1)) {
        regions.add_row(row.iter().copied());
    }
    let mut found: Vec<Vec<usize>> = vec![Vec::new(); regions.runs.len()];
    for k in 0..regions.runs.len() {
        let (run, root) = (regions.runs[k], regions.root(k));
        found[root].extend((run.first..run.end).map(|x| run.row * width + x));
    }
    found.retain(|region| !region.is_empty());
    found
}

/// Returns a mask opened by a square of side 2 · `reach` + 1; beyond its border it is continued.
pub(super) fn opened(mask: &[bool], width: usize, reach: usize) -> Vec<bool> {
    let eroded = spread(mask, width, reach, false);
    spread(&eroded, width, reach, true)
}

/// Returns a mask in which every pixel of value `value` has spread by `reach` along x and y.
fn spread(mask: &[bool], width: usize, reach: usize, value: bool) -> Vec<bool> {
    let height = mask.len() / width;
    let mut along_x = vec![!value; mask.len()];
    for (row, out) in mask.chunks_exact(width).zip(along_x.chunks_exact_mut(width)) {
        for x in (0..width).filter(|&x| row[x] == value) {
            out[x.saturating_sub(reach)..(x + reach + 1).min(width)].fill(value);
        }
    }
    let mut both = vec![!value; mask.len()];
    for y in 0..height {
        for other in y.saturating_sub(reach)..(y + reach + 1).min(height) {
            for x in 0..width {
                if along_x[other * width + x] == value {
                    both[y * width + x] = value;
                }
            }
        }
    }
    both
}
