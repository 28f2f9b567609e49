//! Results of re-making the tables and figures of Lanaro et al. (2020,
//! <https://doi.org/10.1088/2399-6528/ab8064>).

use super::FindingRecord;
use super::tables::BandwidthRow;
use crate::compare::paper::{DistanceBetween, MadeRow, PrintedDistances, TABLE_2_SAMPLERS, Tightest};
use crate::stats::Pcf;

/// All parts of the paper that were re-made.
#[derive(Clone, Debug)]
pub struct PaperResults {
    /// Rows of Table 1 that are samplers.
    pub rows: Vec<MadeRow>,
    /// Distances between the samplers of Table 2, for the pairs of columns (0, 1), (0, 2), (1, 2).
    pub distances: [DistanceBetween; 3],
    /// Rows of Table 2, as printed.
    pub printed: Vec<PrintedDistances>,
    /// Triangle inequality that is nearest to being violated, for each row of Table 2.
    pub tightest: Vec<Tightest>,
    /// The main finding on the printed tables: correlation of regularity with the distance to each
    /// sampler of Table 2.
    pub findings: Vec<FindingRecord>,
    /// Distances between the samplers at other bandwidths of the kernel, in spacings, each with the
    /// number of rows of Table 2 that satisfy the triangle inequality.
    pub bandwidths: Vec<BandwidthRow>,
    /// Mean pair correlation functions of the samplers of Figure 1.
    pub curves: Vec<(String, Pcf)>,
    /// Number of patterns per sampler.
    pub patterns: usize,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Returns the names of two samplers of Table 2, by the indices of their columns.
pub(super) fn pair(columns: [usize; 2]) -> String {
    columns.map(|c| TABLE_2_SAMPLERS[c]).join(" – ")
}
