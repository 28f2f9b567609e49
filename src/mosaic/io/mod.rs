//! Readers and writers of coordinate files, of tables of scales, groups and regions, and of
//! manifests.
//!
//! Files count pixels from 0, from 0.5 or from 1. [`read_coordinates`] always returns pixel
//! coordinates that count from 0 at the centre of the top-left pixel.
//!
//! # Examples
//! ```
//! use conemosaic::mosaic::io::{Origin, ReadOptions, read_from};
//!
//! // marks made in MATLAB count pixels from 1
//! let options = ReadOptions { origin: Some(Origin::One), ..ReadOptions::default() };
//! let file = read_from("marks.csv", b"x,y\n1,1\n11.5,21\n", &options)?;
//! assert_eq!((file.points[1].x, file.points[1].y), (10.5, 20.));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

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
