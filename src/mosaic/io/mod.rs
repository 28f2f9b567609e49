//! Readers and writers of coordinate files, of tables of scales, groups and regions, and of
//! manifests.
//!
//! Whatever a file calls the first pixel, [`read_coordinates`] returns pixels that count from 0 at
//! the centre of the top-left pixel.

#[cfg_attr(not(feature = "archives"), path = "no_archives.rs")]
mod archives;
mod cells;
mod delimited;
mod error;
mod group_table;
mod header;
mod identifier;
mod imagej;
mod manifest;
mod origin;
mod outline;
mod read;
mod roi_table;
mod scale_table;
mod text;
mod webplotdigitizer;
mod write;

pub use error::{Place, ReadError, ReadFault, WriteError};
pub use group_table::GroupTable;
pub use manifest::{AmbiguousRow, Manifest, ManifestRow};
pub use origin::Origin;
pub use outline::{OutlineFile, read_outline};
pub use read::{CoordinateFile, Dialect, ReadOptions, Series, read_coordinates, read_from};
pub use roi_table::{Roi, RoiTable, RoiTableError};
pub use scale_table::{ScaleTable, ScaleTableError};
pub use write::{format_plain_points, format_points, write_plain_points, write_points};

use read::{Dataset, RawFile};
