//! The pixels that an image is searched on: its own, or means of blocks of them where cones are farther apart than the filters are made
//! for.

use super::search::Field;
use super::spacing::Rings;
use super::{MIN_SIDE, SPACING_RANGE};
use crate::image::{EmptyPixels, Plane, block_means};
use std::borrow::Cow;

/// Sides of the blocks, in px.
const BLOCKS: [usize; 2] = [2, 4];
/// The widest spacing that is found, in px.
pub const WIDEST_SPACING: f64 = 4. * SPACING_RANGE.1;
/// So many px each side of an image must have for a ring wider than its finer pixels can show.
const ROOM: usize = 100;

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
        let own = Self::own(image);
        let suits = |block: &usize| {
            let wide = spacing.is_some_and(|s| s > 0.5 * SPACING_RANGE.1 * *block as f64);
            wide && own.side() >= block * MIN_SIDE
        };
        match BLOCKS.into_iter().rfind(suits) {
            Some(block) => own.averaged(block),
            None => own,
        }
    }

    /// Coarser pixels that show a ring too wide for these, and surer than `confidence` (0–1).
    pub(super) fn wider(&self, mut confidence: f64) -> Option<View<'static>> {
        let mut surest = None;
        for block in BLOCKS.into_iter().filter(|block| self.side() >= block * ROOM) {
            let coarser = self.averaged(block);
            let ring = coarser.rings.whole().spacing();
            // closer cones are seen better by finer pixels
            if 2. * ring.spacing > SPACING_RANGE.1 && ring.confidence > confidence {
                confidence = ring.confidence;
                surest = Some(coarser);
            }
        }
        surest
    }

    /// The shorter one, px.
    fn side(&self) -> usize {
        self.image.nrows().min(self.image.ncols())
    }

    fn own(image: &'a Plane) -> Self {
        let empty = EmptyPixels::of(image);
        let image = empty.as_ref().map_or(Cow::Borrowed(image), |e| Cow::Owned(e.filled(image)));
        let rings = Rings::of(&image, empty.as_ref());
        Self { image, empty, rings, block: 1 }
    }

    /// In means of blocks; a block with an empty pixel is empty.
    fn averaged(&self, block: usize) -> View<'static> {
        let image = block_means(&self.image, block);
        let empty = self.empty.as_ref().and_then(|e| e.in_blocks(block));
        let rings = Rings::of(&image, empty.as_ref());
        View { image: Cow::Owned(image), empty, rings, block }
    }

    pub(super) fn field(&self) -> Field<'_> {
        Field { image: &self.image, empty: self.empty.as_ref() }
    }
}
