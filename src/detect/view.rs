//! The resolution at which an image is searched for cones.
//!
//! An image is searched in its own pixels or, if its cones are farther apart than the filters are
//! made for, in coarser pixels, each of which is the mean over a square block.

use super::axis::Turn;
use super::search::Field;
use super::spacing::{PERIODS, Rings};
use super::{MIN_SIDE, SPACING_RANGE};
use crate::image::{EmptyPixels, Plane, block_means};
use std::borrow::Cow;

/// Sides, in px of the image, of the square blocks whose means serve as coarser pixels.
///
/// In them, cones up to 80 and 160 px apart are at most 40 coarse pixels apart, the widest spacing
/// of [`SPACING_RANGE`].
const BLOCKS: [usize; 2] = [2, 4];
/// Widest cone spacing that can be found, in px: 160.
pub const WIDEST_SPACING: f64 = BLOCKS[BLOCKS.len() - 1] as f64 * SPACING_RANGE.1;
/// Smallest length, in coarse pixels, of the shorter side of an image that is also searched in
/// coarse pixels: 100.
///
/// Coarse pixels serve only for spacings of more than 20 of them, since closer cones are found in
/// finer pixels. The shorter side must contain five such spacings for a ring to be measured
/// ([`PERIODS`]).
const ROOM: f64 = 0.5 * PERIODS * SPACING_RANGE.1;

/// An image at one resolution, with the pixels that were not imaged filled in, and the rings in its
/// spectrum.
pub(super) struct View<'a> {
    /// Grey values of the view, with the empty pixels filled in.
    image: Cow<'a, Plane>,
    /// Pixels of the view that were not imaged, or `None` if every pixel was imaged.
    empty: Option<EmptyPixels>,
    /// Yellott's rings in the spectra of the view, in px of the view.
    pub rings: Rings,
    /// Side, in px of the image, of one pixel of the view.
    pub block: usize,
}

impl<'a> View<'a> {
    /// Returns the view in which `image` is searched first.
    ///
    /// The view has the image's own pixels unless the user set a wide `spacing` (px). It then has
    /// the largest blocks for which the spacing is still more than 20 px of the view and the
    /// shorter side of the view at least [`MIN_SIDE`].
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

    /// Returns the view in coarser pixels whose ring has the highest confidence, or `None` if no
    /// ring has a confidence above `confidence` (0–1).
    ///
    /// A ring counts only if its spacing is too wide for the next finer pixels.
    pub(super) fn wider(&self, mut confidence: f64) -> Option<View<'static>> {
        let mut surest = None;
        for block in
            BLOCKS.into_iter().filter(|block| shorter_side(&self.image) as f64 >= ROOM * *block as f64)
        {
            let coarser = View::averaged(&self.image, self.empty.as_ref(), block);
            let ring = coarser.rings.whole().spacing();
            // closer cones are seen better in finer pixels
            if 2. * ring.spacing > SPACING_RANGE.1 && ring.confidence > confidence {
                confidence = ring.confidence;
                surest = Some(coarser);
            }
        }
        surest
    }

    /// Returns the view turned by `turn`, with the image around it mirrored.
    pub(super) fn turned(&self, turn: &Turn) -> View<'static> {
        let imaged = turn.mask(|x, y| self.empty.as_ref().is_none_or(|e| !e.contains(x, y)));
        let image = turn.of(&self.image);
        let empty = imaged.map(|mask| EmptyPixels::not(mask, image.nrows(), image.ncols()));
        View::new(Cow::Owned(image), empty, self.block)
    }

    fn new(image: Cow<'a, Plane>, empty: Option<EmptyPixels>, block: usize) -> Self {
        let rings = Rings::of(&image, empty.as_ref());
        Self { image, empty, rings, block }
    }

    /// Returns the view whose pixels are means over blocks of `block` × `block` px.
    ///
    /// A block that contains an empty pixel counts as empty.
    fn averaged(filled: &Plane, empty: Option<&EmptyPixels>, block: usize) -> View<'static> {
        View::new(Cow::Owned(block_means(filled, block)), empty.and_then(|e| e.in_blocks(block)), block)
    }

    /// Returns the pixels of the view, and the record of those that were not imaged.
    pub(super) fn field(&self) -> Field<'_> {
        Field { image: &self.image, empty: self.empty.as_ref() }
    }
}

/// Returns the length of the shorter side of an image, in px.
fn shorter_side(image: &Plane) -> usize {
    image.nrows().min(image.ncols())
}
