use super::mosaic::{mosaic, verdict};
use super::{Held, cells};
use crate::compare::agreement;
use crate::geometry::{Point, Rectangle};
use crate::mosaic::LengthUnit;
use crate::report::tables::*;
use crate::report::{
    Cell, CoordinatesRecord, FindingRecord, LandmarkRecord, MosaicRecord, SamplerDistance, Subject, Summary,
    SummaryKind, VerdictRecord,
};
use crate::stats::{Deviation, Ellipse, RankCorrelation};
use std::collections::BTreeMap;

fn record() -> CoordinatesRecord {
    let (mosaic, measures) = mosaic();
    let distance = |sampler: &str, l_infinity| SamplerDistance { sampler: sampler.into(), l_infinity };
    let distances = vec![distance("dart-throwing", 0.75), distance("bnot", 0.5)];
    let mosaic = MosaicRecord::new(&mosaic, &measures, distances);
    let warnings = vec!["one".to_owned(), "two".to_owned()];
    CoordinatesRecord { file: "in/a.csv".into(), name: "a".into(), outside: 3, mosaic, warnings }
}

/// Checks the columns of the tables of records against the API.
pub fn records(held: &mut Held) {
    let record = record();
    let nearest = record.mosaic.stats.nearest;
    let [population, sample] =
        [Deviation::Population, Deviation::Sample].map(|d| nearest.with_divisor(Deviation::Sample, d));
    let um = |length: Option<f64>| Cell::from(length.map(|v| v * 0.5));
    let expected = vec![
        ("file", "in/a.csv".into()),
        ("unit", "px".into()),
        ("nn_mean", nearest.mean.into()),
        ("nn_sd_population", population.sd.into()),
        ("ri_population", population.ri.into()),
        ("nn_sd_sample", sample.sd.into()),
        ("ri_sample", sample.ri.into()),
        ("n", 360.into()),
        ("nn_mean_um", um(nearest.mean)),
        ("nn_sd_population_um", um(population.sd)),
        ("nn_sd_sample_um", um(sample.sd)),
    ];
    held.row(&REGULARITY, REGULARITY.csv([&record]).unwrap(), expected);
    let samplers = ["bnot".to_owned(), "dart-throwing".to_owned()];
    let layout = Layout { samplers: &samplers, parts: &[] };
    let expected = vec![
        ("file", "in/a.csv".into()),
        ("bnot", 0.5.into()),
        ("dart-throwing", 0.75.into()),
        ("closest_sampler", "bnot".into()),
        ("n", 360.into()),
        ("ri", nearest.ri.into()),
        ("sd_kind", "sample".into()),
        ("warnings", "one; two".into()),
    ];
    held.row(&L_INFINITY, L_INFINITY.csv_as(&layout, [&record]).unwrap(), expected);
    let (_, measures) = mosaic();
    let found = VerdictRecord::from(&verdict(measures.pcf.as_ref().unwrap(), "bnot", 0.));
    let expected = vec![
        ("file", "in/a.csv".into()),
        ("sampler", "bnot".into()),
        ("verdict", "differs".into()),
        ("p_envelope", 0.03.into()),
        ("outside_r_in_spacings", "0.5000–0.7500 1.2500–1.5000".into()),
        ("l_infinity_to_simulations", 0.41.into()),
        ("p_l_infinity", 0.02.into()),
        ("l_infinity_usual", 0.1.into()),
        ("l_infinity_95_percent", 0.2.into()),
        ("ri_mean", 6.5.into()),
        ("ri_sd", 0.625.into()),
        ("simulations", 99.into()),
        ("points_min", 310.into()),
        ("points_max", 330.into()),
    ];
    let row = VerdictRow { file: &record.file, verdict: &found };
    held.row(&VERDICTS, VERDICTS.csv([row]).unwrap(), expected);
    let correlation = Some(RankCorrelation { n: 19, rho: -0.7, p_value: 0.001 });
    let finding = FindingRecord { sampler: "bnot".into(), mosaics: 19, correlation };
    let expected = vec![
        ("sampler", "bnot".into()),
        ("mosaics", 19.into()),
        ("spearman_rho_of_ri_and_l_infinity", (-0.7).into()),
        ("p_value", 0.001.into()),
        ("in_words", finding.words().as_str().into()),
    ];
    held.row(&FINDING, FINDING.csv([&finding]).unwrap(), expected);
    landmarks(held);
}

fn landmarks(held: &mut Held) {
    let found = LandmarkRecord {
        file: "in/a.csv".into(),
        unit: LengthUnit::Pixel,
        um_per_unit: Some(0.5),
        window: "100 cells".into(),
        n: 360,
        whole: 200,
        peak: Some(0.03),
        peak_at: Some(Point::new(40., 41.)),
        centroid: Some(Point::new(42., 43.)),
        centroid_density: Some(0.02),
        isodensity: 0.8,
        isodensity_area: Some(900.),
        ellipse: Some(Ellipse { centre: Point::new(44., 45.), semi_major: 9., semi_minor: 7., degrees: 30. }),
        note: "cut".into(),
    };
    let expected = vec![
        ("file", "in/a.csv".into()),
        ("unit", "px".into()),
        ("um_per_unit", 0.5.into()),
        ("local_window", "100 cells".into()),
        ("n", 360.into()),
        ("n_whole", 200.into()),
        ("pcd", 0.03.into()),
        ("pcd_per_mm2", 120_000.0.into()),
        ("pcd_x", 40.0.into()),
        ("pcd_y", 41.0.into()),
        ("cdc_x", 42.0.into()),
        ("cdc_y", 43.0.into()),
        ("cdc_density", 0.02.into()),
        ("cdc_density_per_mm2", 80_000.0.into()),
        ("isodensity_share", 0.8.into()),
        ("isodensity_area", 900.0.into()),
        ("isodensity_area_mm2", (900. * 0.25 / 1e6).into()),
        ("ellipse_x", 44.0.into()),
        ("ellipse_y", 45.0.into()),
        ("ellipse_semi_major", 9.0.into()),
        ("ellipse_semi_minor", 7.0.into()),
        ("ellipse_degrees", 30.0.into()),
        ("note", "cut".into()),
    ];
    held.row(&LANDMARKS, LANDMARKS.csv([&found]).unwrap(), expected);
}

/// Checks the columns of the tables of regions, groups and failures against the API.
pub fn regions_groups_and_failures(held: &mut Held) {
    let summary = |metrics: &str| Summary::new(SummaryKind::Coordinates, &metrics.parse().unwrap(), &[], &[]);
    let record = record();
    let frame = Rectangle::new(1., 2., 30., 40.).unwrap();
    let region = RoiRow {
        file: "in/a.csv".into(),
        roi: "left".into(),
        frame,
        flag: "few".into(),
        record: Some(record.clone()),
    };
    let outside = RoiRow { roi: "far".into(), flag: "outside".into(), record: None, ..region.clone() };
    let both = |cell: Cell| vec![cell.clone(), cell];
    let expected = [
        ("file", both("in/a.csv".into())),
        ("roi", vec!["left".into(), "far".into()]),
        ("x0", both(1.0.into())),
        ("y0", both(2.0.into())),
        ("x1", both(30.0.into())),
        ("y1", both(40.0.into())),
        ("flag", vec!["few".into(), "outside".into()]),
        ("unit", vec!["px".into(), Cell::Missing]),
        ("n", vec![360.into(), Cell::Missing]),
        ("warnings", vec!["one; two".into(), Cell::Missing]),
        ("ri", vec![record.mosaic.stats.nearest.ri.into(), Cell::Missing]),
    ];
    held.table(&ROIS, rois_csv(&summary("ri"), &[region, outside]).unwrap(), &expected);

    // Regularity indices 2 and 6 of one subject and 10 of another: means 4 and 10. A fourth image
    // has none.
    let with = |ri: Option<f64>| {
        let mut record = record.clone();
        record.mosaic.stats.nearest.ri = ri;
        record
    };
    let images = [Some(2.), Some(6.), Some(10.), None].map(with);
    let people = ["s1", "s1", "s2", "s2"];
    let member =
        |(record, person)| GroupMember { record: Subject::Coordinates(record), person: Some(person) };
    let groups = BTreeMap::from([("healthy".to_owned(), images.iter().zip(people).map(member).collect())]);
    let [low, high] = agreement(&[4., 10.]).unwrap().bias_interval().unwrap();
    let expected = [
        ("group", both("healthy".into())),
        ("images", both(4.into())),
        ("column", vec!["n".into(), "ri".into()]),
        ("unit", vec!["count".into(), "ratio".into()]),
        ("n", vec![4.into(), 3.into()]),
        ("mean", cells([360., 6.])),
        ("sd", cells([0., 4.])),
        ("subjects", both(2.into())),
        ("mean_of_subjects", cells([360., 7.])),
        ("se", cells([0., 18f64.sqrt() / 2f64.sqrt()])),
        ("mean_low", cells([360., low])),
        ("mean_high", cells([360., high])),
    ];
    held.table(&GROUPS, groups_csv(&summary("ri"), &groups).unwrap(), &expected);

    let failure = Failure { file: "in/b.csv".into(), reason: "empty".into() };
    let expected = vec![("file", "in/b.csv".into()), ("reason", "empty".into())];
    held.row(&FAILURES, FAILURES.csv([&failure]).unwrap(), expected);
}
