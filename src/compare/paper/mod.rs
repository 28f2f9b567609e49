//! Tables of Lanaro et al. (2020), <https://doi.org/10.1088/2399-6528/ab8064>: the printed values,
//! and the values about samplers computed again with the samplers of this library.
//!
//! # Examples
//! ```
//! use conemosaic::compare::paper::printed_regularity;
//!
//! let table_1 = printed_regularity();
//! let bnot = table_1.iter().find(|row| row.name == "BNOT_1050").ok_or("no such row")?;
//! println!("regularity index of BNOT as printed: {:.1}", bnot.ri);
//! assert!(bnot.ri > 10.);
//! # Ok::<(), &str>(())
//! ```

mod printed;
mod remake;
mod triangle;

pub use printed::{PrintedDistances, PrintedRegularity, printed_distances, printed_regularity};
pub use remake::{
    DistanceBetween, MadeRow, Pattern, distance_between, made_row, pattern, peak, with_bandwidth,
};
pub use triangle::{PAIRS, Tightest, allowed, tightest};

/// Rows of Table 1 that describe samplers. Each entry has the name in the printed table, the name
/// of the sampler in this library, and the number of points.
pub const TABLE_1_SAMPLERS: [(&str, &str, usize); 7] = [
    ("GN_512", "green", 512),
    ("GN_1024", "green", 1024),
    ("PN_512", "pink", 512),
    ("PN_1024", "pink", 1024),
    ("BNOT_1050", "bnot", 1050),
    ("BNOT_2050", "bnot", 2050),
    ("BNOT_4050", "bnot", 4050),
];

/// Samplers of the three columns of Table 2, from left to right. Their patterns have 1024 points
/// each.
pub const TABLE_2_SAMPLERS: [&str; 3] = ["bnot", "dart-throwing", "jittered"];

/// Samplers shown in Figure 1, in the order of the panels.
pub const FIGURE_1_SAMPLERS: [&str; 6] = ["uniform", "green", "pink", "jittered", "dart-throwing", "bnot"];
