//! The results of re-making the paper.

use super::FindingRecord;
use super::tables::BandwidthRow;
use crate::compare::paper::{DistanceBetween, MadeRow, PrintedDistances, TABLE_2_SAMPLERS, Tightest};
use crate::stats::Pcf;

/// Everything that was re-made.
#[derive(Clone, Debug)]
pub struct PaperResults {
    /// Table 1's sampler rows.
    pub rows: Vec<MadeRow>,
    /// Distances between the samplers of Table 2: columns (0, 1), (0, 2), (1, 2).
    pub distances: [DistanceBetween; 3],
    /// Table 2, as printed.
    pub printed: Vec<PrintedDistances>,
    /// Of each of its rows the triangle inequality with least room.
    pub tightest: Vec<Tightest>,
    /// The main finding on the printed tables: regularity against the distance to each sampler of
    /// Table 2.
    pub findings: Vec<FindingRecord>,
    /// The same distances at other bandwidths of the kernel, in spacings, and how many rows of Table 2 hold with them.
    pub bandwidths: Vec<BandwidthRow>,
    /// Mean pair correlation functions of the samplers of Figure 1.
    pub curves: Vec<(String, Pcf)>,
    /// Patterns of each.
    pub patterns: usize,
    /// Seed.
    pub seed: u64,
}

pub(super) fn pair(columns: [usize; 2]) -> String {
    columns.map(|c| TABLE_2_SAMPLERS[c]).join(" – ")
}
