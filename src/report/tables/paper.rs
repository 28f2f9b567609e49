use super::{Layout, Row, Table, column};
use crate::compare::paper::{
    DistanceBetween, MadeRow, PAIRS, PrintedDistances, TABLE_2_SAMPLERS, Tightest, allowed,
};
use crate::report::{Cell, PaperResults, ReportError};

fn yes(holds: bool) -> Cell {
    if holds { "yes" } else { "no" }.into()
}

impl Row for MadeRow {
    type Of<'a> = &'a Self;
}

/// The table of the sampler rows of Table 1 of Lanaro et al. (2020,
/// <https://doi.org/10.1088/2399-6528/ab8064>), printed and re-made.
pub static PAPER_TABLE_1: Table<MadeRow> = Table {
    file: "table1.csv",
    commands: "paper",
    about: "One row per sampler in Table 1 of Lanaro et al. 2020. Lengths are in the unit square; \
            standard deviations of means are over patterns.",
    columns: &[
        column("printed_as", "text", "Name of the sampler in the paper.")
            .of(|r| r.printed.name.as_str().into()),
        column("sampler", "text", "Name of the sampler in this program.").of(|r| r.sampler.as_str().into()),
        column("n", "count", "Number of points asked for.").of(|r| r.n.into()),
        column("patterns", "count", "Number of patterns made.").of(|r| r.patterns.into()),
        column("mean_printed", "unit", "Mean nearest-neighbour distance, as printed.")
            .of(|r| r.printed.mean.into()),
        column("mean", "unit", "Mean over patterns of the mean nearest-neighbour distance.")
            .of(|r| r.mean.mean.into()),
        column("mean_sd", "unit", "Standard deviation, over patterns, of the mean distance.")
            .of(|r| r.mean.sd.into()),
        column(
            "sd_printed",
            "unit",
            "Standard deviation (n) of the nearest-neighbour distances, as printed.",
        )
        .of(|r| r.printed.sd.into()),
        column("sd", "unit", "Mean over patterns of the standard deviation (n) of the distances.")
            .of(|r| r.sd.mean.into()),
        column(
            "sd_sd",
            "unit",
            "Standard deviation, over patterns, of the standard deviation of the distances.",
        )
        .of(|r| r.sd.sd.into()),
        column("ri_printed", "ratio", "Regularity index, as printed.").of(|r| r.printed.ri.into()),
        column("ri", "ratio", "Mean over patterns of the regularity index.").of(|r| r.ri.mean.into()),
        column("ri_sd", "ratio", "Standard deviation, over patterns, of the regularity index.")
            .of(|r| r.ri.sd.into()),
        column("deviations", "ratio", "ri_printed − ri, in units of ri_sd.").of(|r| r.deviations().into()),
        column("agrees", "yes or no", "yes if deviations is between −2 and 2.").of(|r| yes(r.agrees())),
        column(
            "points_by_printed_mean",
            "count",
            "Number of points at which the sampler would have \
                                                   the mean distance mean_printed.",
        )
        .of(|r| r.points_by_mean_distance().map(|p| p.0).into()),
        column("points_sd", "count", "Standard deviation of points_by_printed_mean.")
            .of(|r| r.points_by_mean_distance().map(|p| p.1).into()),
    ],
};

/// The distance between two samplers of Table 2.
#[derive(Clone, Copy, Debug)]
pub struct PaperDistance {
    between: [&'static str; 2],
    found: DistanceBetween,
    allowed: [f64; 2],
}

impl Row for PaperDistance {
    type Of<'a> = Self;
}

/// The table of distances between the samplers of Table 2.
pub static PAPER_TABLE_2: Table<PaperDistance> = Table {
    file: "table2_samplers.csv",
    commands: "paper",
    about: "One row per pair of the samplers of Table 2 of Lanaro et al. 2020.",
    columns: &[
        column("first", "text", "The first sampler.").of(|d| d.between[0].into()),
        column("second", "text", "The second sampler.").of(|d| d.between[1].into()),
        column(
            "l_infinity",
            "ratio",
            "Greatest difference between the mean pair correlation \
                                       functions of the two samplers.",
        )
        .of(|d| d.found.l_infinity.into()),
        column("standard_error", "ratio", "Standard error of l_infinity.").of(|d| d.found.error.into()),
        column(
            "least_allowed_by_table_2",
            "ratio",
            "Smallest distance that is compatible with all \
                                                     rows printed in Table 2.",
        )
        .of(|d| d.allowed[0].into()),
        column(
            "most_allowed_by_table_2",
            "ratio",
            "Largest distance that is compatible with all rows printed in Table 2.",
        )
        .of(|d| d.allowed[1].into()),
    ],
};

/// A row of Table 2 and its triangle inequality with the least slack.
#[derive(Clone, Copy, Debug)]
pub struct TriangleRow<'a> {
    printed: &'a PrintedDistances,
    tightest: &'a Tightest,
}

impl Row for TriangleRow<'static> {
    type Of<'a> = TriangleRow<'a>;
}

/// The table that checks the rows of Table 2 by the triangle inequality.
pub static PAPER_TRIANGLE: Table<TriangleRow> = Table {
    file: "triangle.csv",
    commands: "paper",
    about: "One row per mosaic of Table 2 of Lanaro et al. 2020: its printed distances to samplers must \
            satisfy the triangle inequality with the distances between the samplers.",
    columns: &[
        column("mosaic", "text", "Name of the mosaic.").of(|t| t.printed.name.as_str().into()),
        column("bnot_1024", "ratio", "Printed distance to BNOT.").of(|t| t.printed.l_infinity[0].into()),
        column("dart_throwing_1024", "ratio", "Printed distance to dart throwing.")
            .of(|t| t.printed.l_infinity[1].into()),
        column("jitter_1024", "ratio", "Printed distance to jittered sampling.")
            .of(|t| t.printed.l_infinity[2].into()),
        column("room", "ratio", "Slack of the tightest triangle inequality; negative if it is violated.")
            .of(|t| t.tightest.room.into()),
        column("tightest_between", "text", "The pair of samplers in that inequality.")
            .of(|t| t.tightest.between.map(|c| TABLE_2_SAMPLERS[c]).join(" – ").as_str().into()),
        column("holds", "yes or no", "yes if room is not negative.").of(|t| yes(t.tightest.room >= 0.)),
    ],
};

/// The distances between the samplers of Table 2 at one bandwidth.
#[derive(Clone, Copy, Debug)]
pub struct BandwidthRow {
    /// Bandwidth of the kernel, in spacings.
    pub bandwidth: f64,
    /// Distances of the pairs of columns (0, 1), (0, 2), (1, 2).
    pub distances: [f64; 3],
    /// Number of rows of Table 2 that satisfy the triangle inequality with these distances.
    pub holds: usize,
}

impl Row for BandwidthRow {
    type Of<'a> = Self;
}

/// The table of distances between the samplers of Table 2 at other bandwidths.
pub static PAPER_BANDWIDTHS: Table<BandwidthRow> = Table {
    file: "bandwidths.csv",
    commands: "paper",
    about: "One row per bandwidth of the kernel with which pair correlation functions are estimated.",
    columns: &[
        column("bandwidth_in_spacings", "spacings", "Standard deviation of the kernel.")
            .of(|b| b.bandwidth.into()),
        column("bnot_dart_throwing", "ratio", "Distance between BNOT and dart throwing.")
            .of(|b| b.distances[0].into()),
        column("bnot_jittered", "ratio", "Distance between BNOT and jittered sampling.")
            .of(|b| b.distances[1].into()),
        column("dart_throwing_jittered", "ratio", "Distance between dart throwing and jittered sampling.")
            .of(|b| b.distances[2].into()),
        column("rows_that_hold", "count", "Number of rows of Table 2 that satisfy the triangle inequality.")
            .of(|b| b.holds.into()),
    ],
};

/// The curve of one sampler.
#[derive(Clone, Debug)]
pub struct SamplerCurve<'a> {
    /// Name of the sampler as a column name: with underscores.
    pub sampler: String,
    /// Abscissae of the curve.
    pub x: &'a [f64],
    /// Values of the curve.
    pub y: &'a [f64],
}

/// One abscissa that several curves share.
#[derive(Clone, Copy, Debug)]
pub struct CurveRow<'a> {
    index: usize,
    x: f64,
    curves: &'a [SamplerCurve<'a>],
}

impl Row for CurveRow<'static> {
    type Of<'a> = CurveRow<'a>;
}

impl CurveRow<'_> {
    fn of_sampler(&self, sampler: &str) -> Option<f64> {
        self.curves.iter().find(|c| c.sampler == sampler)?.y.get(self.index).copied()
    }
}

/// The table of mean pair correlation functions of Figure 1.
pub static PAPER_PCF: Table<CurveRow> = Table {
    file: "pcf.csv",
    commands: "paper",
    about: "One row per distance, one column per sampler in Figure 1 of Lanaro et al. 2020.",
    columns: &[
        column("r_in_hexagonal_spacings", "spacings", "Left edge of the bin.").of(|c| c.x.into()),
        column("SAMPLER", "ratio", "Mean pair correlation function of the sampler.")
            .per_sampler(|c, s| c.of_sampler(s).into()),
    ],
};

/// The table of mean radial spectra of Figure 1.
pub static PAPER_SPECTRA: Table<CurveRow> = Table {
    file: "spectra.csv",
    commands: "paper",
    about: "One row per ring of frequencies, one column per sampler in Figure 1 of Lanaro et al. 2020.",
    columns: &[
        column("frequency_in_sqrt_n", "√n", "Frequency of the middle of the ring.").of(|c| c.x.into()),
        column("SAMPLER", "ratio", "Mean power of the sampler in the ring.")
            .per_sampler(|c, s| c.of_sampler(s).into()),
    ],
};

/// Returns curves as CSV on the longest of their abscissae; a curve that ends earlier leaves empty
/// cells.
///
/// # Errors
/// Fails if the table cannot be written as CSV.
pub fn curves_csv(table: &Table<CurveRow>, curves: &[SamplerCurve]) -> Result<Vec<u8>, ReportError> {
    let samplers: Vec<String> = curves.iter().map(|c| c.sampler.clone()).collect();
    let longest = curves.iter().map(|c| c.x).max_by_key(|x| x.len()).unwrap_or_default();
    let rows = longest.iter().enumerate().map(|(index, &x)| CurveRow { index, x, curves });
    table.csv_as(&Layout { samplers: &samplers, parts: &[] }, rows)
}

impl PaperResults {
    /// Returns `table1.csv`, `table2_samplers.csv`, `triangle.csv` and `bandwidths.csv`, each with
    /// its name.
    ///
    /// # Errors
    /// Fails if one of them cannot be written as CSV.
    pub fn tables(&self) -> Result<[(&'static str, Vec<u8>); 4], ReportError> {
        let distances = PAIRS.iter().zip(&self.distances).map(|(&columns, &found)| PaperDistance {
            between: columns.map(|c| TABLE_2_SAMPLERS[c]),
            found,
            allowed: allowed(&self.printed, columns),
        });
        let triangles = self.printed.iter().zip(&self.tightest);
        let triangles = triangles.map(|(printed, tightest)| TriangleRow { printed, tightest });
        Ok([
            (PAPER_TABLE_1.file, PAPER_TABLE_1.csv(&self.rows)?),
            (PAPER_TABLE_2.file, PAPER_TABLE_2.csv(distances)?),
            (PAPER_TRIANGLE.file, PAPER_TRIANGLE.csv(triangles)?),
            (PAPER_BANDWIDTHS.file, PAPER_BANDWIDTHS.csv(self.bandwidths.iter().copied())?),
        ])
    }
}
