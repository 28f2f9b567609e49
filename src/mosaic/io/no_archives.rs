//! What a build without the feature `archives` says of an archive.

use super::error::{Located, ReadFault};
use super::{RawFile, imagej};

/// Refuses a `RoiSet.zip` of the ROI manager.
pub(super) fn read_set(_: &[u8], _: imagej::Wanted) -> Result<RawFile, Located> {
    Err(ReadFault::WithoutArchives { found: "a .zip" }.into())
}

/// Refuses a project as `.tar`.
pub(super) fn read_tar(_: &[u8]) -> Result<RawFile, Located> {
    Err(ReadFault::WithoutArchives { found: "a .tar" }.into())
}
