//! The resolution at which an image is searched: its own pixels, or means over blocks of them where
//! cones are farther apart than the filters are made for.

use super::search::Field;
use super::spacing::{PERIODS, Rings};
use super::{MIN_SIDE, SPACING_RANGE};
use crate::image::{EmptyPixels, Plane, block_means};
use std::borrow::Cow;

/// Sides of the blocks whose means serve as coarser pixels, in px.
const BLOCKS: [usize; 2] = [2, 4];
/// Widest spacing that can be found, in px.
pub const WIDEST_SPACING: f64 = BLOCKS[BLOCKS.len() - 1] as f64 * SPACING_RANGE.1;
/// Minimum side, in coarse pixels, for a ring too wide for the next finer resolution to be
/// measurable.
const ROOM: f64 = 0.5 * PERIODS * SPACING_RANGE.1;

/// An image at one resolution, the pixels that were not imaged filled in, and its rings.
pub(super) struct View<'a> {
    image: Cow<'a, Plane>,
    empty: Option<EmptyPixels>,
    /// Rings in the spectrum of the image, in px of the view.
    pub rings: Rings,
    /// Side, in px of the image, of one pixel of the view.
    pub block: usize,
}

impl<'a> View<'a> {
    /// Returns the view in the image's own pixels or, if a wide `spacing` (px) is given, in the
    /// largest blocks that suit it.
    ///
    /// In blocks of a suitable size, that spacing is more than 20 px of the view.
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

    /// Returns the view in coarser pixels whose ring has the highest confidence, if that is above
    /// `confidence` (0–1).
    ///
    /// Only rings too wide for the next finer pixels count. `None` if there is no such view.
    pub(super) fn wider(&self, mut confidence: f64) -> Option<View<'static>> {
        let mut surest = None;
        for block in
            BLOCKS.into_iter().filter(|block| shorter_side(&self.image) as f64 >= ROOM * *block as f64)
        {
            let coarser = View::averaged(&self.image, self.empty.as_ref(), block);
            let ring = coarser.rings.whole().spacing();
            // finer pixels show closer cones better
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

    /// Returns the view in means over blocks; a block with an empty pixel is empty.
    fn averaged(filled: &Plane, empty: Option<&EmptyPixels>, block: usize) -> View<'static> {
        View::new(Cow::Owned(block_means(filled, block)), empty.and_then(|e| e.in_blocks(block)), block)
    }

    /// Returns the pixels to search, with those that are empty.
    pub(super) fn field(&self) -> Field<'_> {
        Field { image: &self.image, empty: self.empty.as_ref() }
    }
}

/// Returns the length of the shorter side of an image, in px.
fn shorter_side(image: &Plane) -> usize {
    image.nrows().min(image.ncols())
}
