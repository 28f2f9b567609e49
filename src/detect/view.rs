//! The pixels that an image is searched on: its own, or means of blocks of them where cones are farther apart than the filters are made
//! for.

use super::search::Field;
use super::spacing::{PERIODS, Rings};
use super::{MIN_SIDE, SPACING_RANGE};
use crate::image::{EmptyPixels, Plane, block_means};
use std::borrow::Cow;

/// Sides of the blocks, in px.
const BLOCKS: [usize; 2] = [2, 4];
/// The widest spacing that is found, in px.
pub const WIDEST_SPACING: f64 = BLOCKS[BLOCKS.len() - 1] as f64 * SPACING_RANGE.1;
/// So many pixels each side must have for a ring wider than pixels half their size can show.
const ROOM: f64 = 0.5 * PERIODS * SPACING_RANGE.1;

/// An image, what was not imaged filled in, and its rings.
pub(super) struct View<'a> {
    image: Cow<'a, Plane>,
    empty: Option<EmptyPixels>,
    pub rings: Rings,
    /// Pixels of the image along the side of one of these.
    pub block: usize,
}

impl<'a> View<'a> {
    /// The image's own pixels, or those that suit the `spacing`, px, if it is given.
    pub(super) fn suitable(image: &'a Plane, spacing: Option<f64>) -> Self {
        let empty = EmptyPixels::of(image);
        let filled = empty.as_ref().map_or(Cow::Borrowed(image), |e| Cow::Owned(e.filled(image)));
        let suits = |block: &usize| {
            let wide = spacing.is_some_and(|s| s > 0.5 * SPACING_RANGE.1 * *block as f64);
            wide && shorter_side(image) >= block * MIN_SIDE
        };
        match BLOCKS.into_iter().rfind(suits) {
            Some(block) => View::averaged(&filled, empty.as_ref(), block),
            None => Self::new(filled, empty, 1),
        }
    }

    /// Coarser pixels that show a ring too wide for these, and surer than `confidence` (0–1).
    pub(super) fn wider(&self, mut confidence: f64) -> Option<View<'static>> {
        let mut surest = None;
        for block in
            BLOCKS.into_iter().filter(|block| shorter_side(&self.image) as f64 >= ROOM * *block as f64)
        {
            let coarser = View::averaged(&self.image, self.empty.as_ref(), block);
            let ring = coarser.rings.whole().spacing();
            // closer cones are seen better by finer pixels
            if 2. * ring.spacing > SPACING_RANGE.1 && ring.confidence > confidence {
                confidence = ring.confidence;
                surest = Some(coarser);
            }
        }
        surest
    }

    fn new(image: Cow<'a, Plane>, empty: Option<EmptyPixels>, block: usize) -> Self {
        let rings = Rings::of(&image, empty.as_ref());
        Self { image, empty, rings, block }
    }

    /// In means of blocks; a block with an empty pixel is empty.
    fn averaged(filled: &Plane, empty: Option<&EmptyPixels>, block: usize) -> View<'static> {
        View::new(Cow::Owned(block_means(filled, block)), empty.and_then(|e| e.in_blocks(block)), block)
    }

    pub(super) fn field(&self) -> Field<'_> {
        Field { image: &self.image, empty: self.empty.as_ref() }
    }
}

/// In px.
fn shorter_side(image: &Plane) -> usize {
    image.nrows().min(image.ncols())
}
