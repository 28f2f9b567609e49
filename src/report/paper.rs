//! What was re-made of the paper, as tables.

use super::{Cell, FindingRecord};
use crate::compare::paper::{
    DistanceBetween, MadeRow, PAIRS, PrintedDistances, TABLE_2_SAMPLERS, Tightest, allowed,
};
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
    /// The same distances at other bandwidths of the kernel, in spacings, and how many rows of
    /// Table 2 hold with them.
    pub bandwidths: Vec<(f64, [f64; 3], usize)>,
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

impl PaperResults {
    /// Rows of `table1.csv` under their header.
    pub fn table1(&self) -> (Vec<String>, Vec<Vec<Cell>>) {
        let header = [
            "printed_as",
            "sampler",
            "n",
            "patterns",
            "mean_printed",
            "mean",
            "mean_sd",
            "sd_printed",
            "sd",
            "sd_sd",
            "ri_printed",
            "ri",
            "ri_sd",
            "deviations",
            "agrees",
            "points_by_printed_mean",
            "points_sd",
        ];
        let row = |r: &MadeRow| {
            vec![
                r.printed.name.as_str().into(),
                r.sampler.as_str().into(),
                r.n.into(),
                r.patterns.into(),
                r.printed.mean.into(),
                r.mean.mean.into(),
                r.mean.sd.into(),
                r.printed.sd.into(),
                r.sd.mean.into(),
                r.sd.sd.into(),
                r.printed.ri.into(),
                r.ri.mean.into(),
                r.ri.sd.into(),
                r.deviations().into(),
                if r.agrees() { "yes" } else { "no" }.into(),
                r.points_by_mean_distance().map(|p| p.0).into(),
                r.points_by_mean_distance().map(|p| p.1).into(),
            ]
        };
        (header.map(str::to_owned).into(), self.rows.iter().map(row).collect())
    }

    /// Rows of `table2_samplers.csv` under their header.
    pub fn table2(&self) -> (Vec<String>, Vec<Vec<Cell>>) {
        let header = [
            "first",
            "second",
            "l_infinity",
            "standard_error",
            "least_allowed_by_table_2",
            "most_allowed_by_table_2",
        ];
        let rows = PAIRS.iter().zip(&self.distances).map(|(&columns, d)| {
            let [low, high] = allowed(&self.printed, columns);
            let [a, b] = columns.map(|c| TABLE_2_SAMPLERS[c]);
            vec![a.into(), b.into(), d.l_infinity.into(), d.error.into(), low.into(), high.into()]
        });
        (header.map(str::to_owned).into(), rows.collect())
    }

    /// Rows of `triangle.csv` under their header.
    pub fn triangles(&self) -> (Vec<String>, Vec<Vec<Cell>>) {
        let header =
            ["mosaic", "bnot_1024", "dart_throwing_1024", "jitter_1024", "room", "tightest_between", "holds"];
        let rows = self.printed.iter().zip(&self.tightest).map(|(row, t)| {
            let holds = if t.room >= 0. { "yes" } else { "no" };
            [row.name.as_str().into()]
                .into_iter()
                .chain(row.l_infinity.map(Cell::from))
                .chain([t.room.into(), pair(t.between).as_str().into(), holds.into()])
                .collect()
        });
        (header.map(str::to_owned).into(), rows.collect())
    }

    /// Rows of `bandwidths.csv` under their header.
    pub fn bandwidth_table(&self) -> (Vec<String>, Vec<Vec<Cell>>) {
        let header = [
            "bandwidth_in_spacings",
            "bnot_dart_throwing",
            "bnot_jittered",
            "dart_throwing_jittered",
            "rows_that_hold",
        ];
        let row = |(width, distances, holds): &(f64, [f64; 3], usize)| {
            [Cell::from(*width)]
                .into_iter()
                .chain(distances.map(Cell::from))
                .chain([(*holds).into()])
                .collect()
        };
        (header.map(str::to_owned).into(), self.bandwidths.iter().map(row).collect())
    }
}
