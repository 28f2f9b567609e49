//! Tables that are written as CSV beside `summary.csv`.
//!
//! A table is a list of columns; each has a name, a unit, an edge rule, a definition, a source and
//! a value. Header, rows and the data dictionary are all made from that list, so that a new column
//! is one [`column()`] in the list of its table.
//!
//! # Examples
//! ```
//! use conemosaic::report::Failure;
//! use conemosaic::report::tables::FAILURES;
//!
//! let failure = Failure { file: "a.png".into(), reason: "it is empty".into() };
//! assert_eq!(FAILURES.csv([&failure])?, b"file,reason\na.png,it is empty\n");
//! # Ok::<(), conemosaic::report::ReportError>(())
//! ```

mod agreement;
mod column;
mod comparison;
mod correlation;
mod failures;
mod functions;
mod groups;
mod landmarks;
mod maps;
mod pairs;
mod paper;
mod points;
mod rois;
mod table;
#[cfg(test)]
mod tests;
mod validation;

pub use agreement::{AGREEMENT, AgreementRow, DIFFERENCES, DifferenceRow, UNPAIRED, UnpairedRow};
pub use column::{Column, ColumnWords, EdgeRule, Part, Row, Value, column};
pub use comparison::{FINDING, L_INFINITY, REGULARITY, VERDICTS, VerdictRow};
pub use correlation::{ENVELOPE, EnvelopeRow, PCF, PcfRow, envelope_csv, pcf_csv};
pub use failures::{FAILURES, Failure};
pub use functions::{
    AnnulusRow, DENSITY_RECOVERY, FUNCTIONS, FrequencyRow, FunctionsRow, SPECTRUM, density_recovery_csv,
    functions_csv, spectrum_csv,
};
pub use groups::{GROUPS, GroupMember, GroupRow, groups_csv};
pub use landmarks::LANDMARKS;
pub use maps::{
    DistanceRow, FOURIER_MAP, FourierRow, MAPS, MapRow, PROFILES, fourier_map_csv, maps_csv, profiles_csv,
};
pub use pairs::{ChannelPair, PAIRED_CONES, PAIRS, PairedCone};
pub use paper::{
    BandwidthRow, CurveRow, PAPER_BANDWIDTHS, PAPER_PCF, PAPER_SPECTRA, PAPER_TABLE_1, PAPER_TABLE_2,
    PAPER_TRIANGLE, PaperDistance, SamplerCurve, TriangleRow, curves_csv,
};
pub use points::{DETECTIONS, DetectedCone, POINTS, PointRow, points_csv};
pub use rois::{ROIS, RoiRow, rois_csv};
pub(super) use table::sheet;
pub use table::{Described, Layout, Table, TableWords};
pub use validation::{
    COMPARISON, FROC, RELIABILITY, SUBJECT_GROUPS, VALIDATION, ValidationRow, VersusRow, froc_csv,
    validation_csv,
};

/// All tables, in the order in which a user meets them.
pub static TABLES: [&dyn Described; 34] = [
    &DETECTIONS,
    &PCF,
    &POINTS,
    &FUNCTIONS,
    &DENSITY_RECOVERY,
    &SPECTRUM,
    &MAPS,
    &PROFILES,
    &FOURIER_MAP,
    &LANDMARKS,
    &ROIS,
    &GROUPS,
    &FAILURES,
    &VERDICTS,
    &ENVELOPE,
    &REGULARITY,
    &L_INFINITY,
    &FINDING,
    &VALIDATION,
    &SUBJECT_GROUPS,
    &FROC,
    &RELIABILITY,
    &PAIRS,
    &PAIRED_CONES,
    &COMPARISON,
    &AGREEMENT,
    &DIFFERENCES,
    &UNPAIRED,
    &PAPER_TABLE_1,
    &PAPER_TABLE_2,
    &PAPER_TRIANGLE,
    &PAPER_BANDWIDTHS,
    &PAPER_PCF,
    &PAPER_SPECTRA,
];
