//! Stand-in for `archives.rs` that refuses every archive, for builds without the feature
//! `archives`.

use super::error::{Located, ReadFault};
use super::{RawFile, imagej};

/// Refuses a `RoiSet.zip` of ImageJ's ROI manager.
pub(super) fn read_set(_: &[u8], _: imagej::Wanted) -> Result<RawFile, Located> {
    Err(ReadFault::WithoutArchives { found: "a .zip" }.into())
}

/// Refuses a WebPlotDigitizer project in a `.tar` archive.
pub(super) fn read_tar(_: &[u8]) -> Result<RawFile, Located> {
    Err(ReadFault::WithoutArchives { found: "a .tar" }.into())
}
