use super::{Held, cells};
use crate::compare::paper::{DistanceBetween, MadeRow, PrintedDistances, PrintedRegularity, Tightest};
use crate::report::PaperResults;
use crate::report::tables::*;
use crate::stats::Moments;

fn results() -> PaperResults {
    let over = |mean, sd| Moments { n: 20, mean: Some(mean), sd: Some(sd), ri: None };
    let printed = PrintedRegularity { name: "jitter_256".into(), mean: 0.05, sd: 0.012, ri: 4.2 };
    let row = MadeRow {
        printed,
        sampler: "jittered".into(),
        n: 256,
        patterns: 20,
        mean: over(0.051, 0.001),
        sd: over(0.0125, 0.0005),
        ri: over(4.1, 0.2),
    };
    let distance = |l_infinity, error| DistanceBetween { l_infinity, error };
    PaperResults {
        rows: vec![row],
        distances: [distance(1.01, 0.01), distance(1.38, 0.02), distance(0.73, 0.03)],
        printed: vec![PrintedDistances { name: "macaque".into(), l_infinity: [0.6, 0.5, 0.9] }],
        tightest: vec![Tightest { mosaic: "macaque".into(), between: [0, 2], room: 0.125 }],
        findings: Vec::new(),
        bandwidths: vec![BandwidthRow { bandwidth: 0.07, distances: [1.1, 1.2, 1.3], holds: 5 }],
        curves: Vec::new(),
        patterns: 20,
        seed: 1,
    }
}

/// Checks the columns of the tables of the paper against the API.
pub fn tables(held: &mut Held) {
    let results = results();
    let made = &results.rows[0];
    let (points, points_sd) = made.points_by_mean_distance().unwrap();
    let [table_1, table_2, triangle, bandwidths] = results.tables().unwrap().map(|(_, bytes)| bytes);
    let expected = vec![
        ("printed_as", "jitter_256".into()),
        ("sampler", "jittered".into()),
        ("n", 256.into()),
        ("patterns", 20.into()),
        ("mean_printed", 0.05.into()),
        ("mean", 0.051.into()),
        ("mean_sd", 0.001.into()),
        ("sd_printed", 0.012.into()),
        ("sd", 0.0125.into()),
        ("sd_sd", 0.0005.into()),
        ("ri_printed", 4.2.into()),
        ("ri", 4.1.into()),
        ("ri_sd", 0.2.into()),
        ("deviations", made.deviations().into()),
        ("agrees", "yes".into()),
        ("points_by_printed_mean", points.into()),
        ("points_sd", points_sd.into()),
    ];
    held.row(&PAPER_TABLE_1, table_1, expected);
    held.table(
        &PAPER_TABLE_2,
        table_2,
        &[
            ("first", cells(["bnot", "bnot", "dart-throwing"])),
            ("second", cells(["dart-throwing", "jittered", "jittered"])),
            ("l_infinity", cells([1.01, 1.38, 0.73])),
            ("standard_error", cells([0.01, 0.02, 0.03])),
            // Lower and upper bound: |a − b| and a + b of the printed 0.6, 0.5, 0.9.
            ("least_allowed_by_table_2", cells([0.6 - 0.5, 0.9 - 0.6, 0.9 - 0.5])),
            ("most_allowed_by_table_2", cells([0.6 + 0.5, 0.6 + 0.9, 0.5 + 0.9])),
        ],
    );
    let expected = vec![
        ("mosaic", "macaque".into()),
        ("bnot_1024", 0.6.into()),
        ("dart_throwing_1024", 0.5.into()),
        ("jitter_1024", 0.9.into()),
        ("room", 0.125.into()),
        ("tightest_between", "bnot – jittered".into()),
        ("holds", "yes".into()),
    ];
    held.row(&PAPER_TRIANGLE, triangle, expected);
    let expected = vec![
        ("bandwidth_in_spacings", 0.07.into()),
        ("bnot_dart_throwing", 1.1.into()),
        ("bnot_jittered", 1.2.into()),
        ("dart_throwing_jittered", 1.3.into()),
        ("rows_that_hold", 5.into()),
    ];
    held.row(&PAPER_BANDWIDTHS, bandwidths, expected);
    let curve = |sampler: &str, x, y| SamplerCurve { sampler: sampler.into(), x, y };
    let curves = [curve("bnot", &[0.5][..], &[1.5][..]), curve("dart_throwing", &[0.5, 1.], &[2.5, 3.5])];
    let [first, second] = [vec![1.5.into(), crate::report::Cell::Missing], cells([2.5, 3.5])];
    for (table, x) in [(&PAPER_PCF, "r_in_hexagonal_spacings"), (&PAPER_SPECTRA, "frequency_in_sqrt_n")] {
        let columns = [(x, cells([0.5, 1.])), ("bnot", first.clone()), ("dart_throwing", second.clone())];
        held.table(table, curves_csv(table, &curves).unwrap(), &columns);
    }
}
