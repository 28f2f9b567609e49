use super::{Held, cells};
use crate::compare::{Envelope, ReferenceCurve, SamplerVerdict, agreement};
use crate::detect::{FourierMapOptions, fourier_map, fourier_spacing};
use crate::geometry::{Point, Rectangle, Window};
use crate::mosaic::io::format_points;
use crate::mosaic::{LengthUnit, Mosaic, Scale};
use crate::report::tables::*;
use crate::report::{
    Cell, CoordinatesRecord, FindingRecord, LandmarkRecord, MosaicRecord, SamplerDistance, Subject, Summary,
    SummaryKind, VerdictRecord,
};
use crate::stats::{
    Deviation, Ellipse, FunctionOptions, LocalWindow, MapOptions, Measures, Moments, Pcf, RankCorrelation,
    SpectrumOptions, functions, maps, measure, spectrum,
};
use rand::{RngExt, SeedableRng};
use std::collections::BTreeMap;

/// A mosaic whose density rises to the left, and its scale.
fn mosaic() -> (Mosaic, Measures) {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(7);
    let mut place = |k: usize, n: usize| (k as f64 + rng.random_range(0.2..0.8)) / n as f64;
    let mut points = Vec::new();
    for k in 0..360 {
        points.push(Point::new(120. * place(k % 20, 20).powf(1.7), 100. * place(k / 20, 18)));
    }
    let window = Window::Rectangle(Rectangle::new(0., 0., 120., 100.).unwrap());
    let scale = Scale::new(0.5, 290.).ok();
    let (mosaic, _) = Mosaic::new(points, window, LengthUnit::Pixel, scale).unwrap();
    let measures = measure(&mosaic, &Default::default());
    assert!(measures.inhomogeneous.is_some());
    (mosaic, measures)
}

pub fn points_and_cones(held: &mut Held) {
    let (mosaic, m) = mosaic();
    let cell = |value: fn(&crate::stats::Cell) -> Cell| m.cells.cells.iter().map(value).collect::<Vec<_>>();
    held.table(
        &POINTS,
        points_csv(&mosaic, &m).unwrap(),
        &[
            ("x", cells(mosaic.points().iter().map(|p| p.x))),
            ("y", cells(mosaic.points().iter().map(|p| p.y))),
            ("nndist", cells(m.neighbours.distances.iter().copied())),
            ("nnwhich", cells(m.neighbours.indices.iter().map(|j| j + 1))),
            ("bdist", cells(mosaic.window().border_distances(mosaic.points()))),
            ("dirichlet_area", cell(|c| c.clipped_area.into())),
            ("cell_area", cell(|c| c.area.into())),
            ("sides", cell(|c| c.sides.into())),
            ("bound", cell(|c| usize::from(c.bound).into())),
            ("icd", cell(|c| c.inter_cell.into())),
            ("furthest", cell(|c| c.furthest.into())),
            ("psi6", cell(|c| c.psi6.map(|[re, im]| re.hypot(im)).into())),
            ("nn_direction_deg", cells(m.orientation.nearest.degrees.iter().copied())),
            ("hexagon_direction_deg", cells(m.orientation.hexagons.iter().copied())),
        ],
    );
    let cone = DetectedCone { centre: Point::new(3.5, 7.25), score: 0.875, um_per_px: Some(0.5) };
    let layout = Layout { samplers: &[], parts: &[Part::Scaled] };
    let file = DETECTIONS.csv_as(&layout, [cone]).unwrap();
    let written = format_points(&[cone.centre], Some(&[cone.score]), Scale::new(0.5, 290.).ok());
    assert_eq!(String::from_utf8(file.clone()).unwrap(), written);
    let expected = [("x_px", 3.5), ("y_px", 7.25), ("score", 0.875), ("x_um", 1.75), ("y_um", 3.625)];
    held.row(&DETECTIONS, file, expected.map(|(name, value)| (name, value.into())).to_vec());
}

/// A curve of its own: g moved up.
fn moved(pcf: &Pcf, by: f64) -> Vec<f64> {
    pcf.g.iter().map(|g| g + by).collect()
}

fn verdict(pcf: &Pcf, sampler: &str, by: f64) -> SamplerVerdict {
    SamplerVerdict {
        sampler: sampler.into(),
        simulations: 99,
        points: (310, 330),
        l_infinity: 0.41,
        l_infinity_usual: 0.1,
        l_infinity_most: 0.2,
        p_l_infinity: 0.02,
        p_envelope: 0.03,
        level: 0.05,
        outside: vec![(0.5, 0.75), (1.25, 1.5)],
        ri: Moments { n: 99, mean: Some(6.5), sd: Some(0.625), ri: None },
        envelope: Envelope {
            r: pcf.r.clone(),
            mean: moved(pcf, by),
            low: moved(pcf, by - 1.),
            high: moved(pcf, by + 1.),
        },
    }
}

pub fn functions_of_distance(held: &mut Held) {
    let (mosaic, m) = mosaic();
    let pcf = m.pcf.as_ref().unwrap();
    let varying = m.inhomogeneous.as_ref().unwrap();
    let curve = |sampler: &str, by| ReferenceCurve {
        sampler: sampler.into(),
        pcf: Pcf { g: moved(pcf, by), ..pcf.clone() },
        n: 360,
        realisations: 1,
        ri: None,
    };
    let curves = [curve("bnot", 0.25), curve("dart-throwing", 0.5)];
    let numbers = |values: &[f64]| cells(values.iter().copied());
    held.table(
        &PCF,
        pcf_csv(&m, &curves).unwrap(),
        &[
            ("r", numbers(&pcf.r)),
            ("g", numbers(&pcf.g)),
            ("g_inhomogeneous", numbers(&varying.g)),
            ("g_locally_scaled", numbers(&varying.g_scaled)),
            ("k_inhomogeneous", numbers(&varying.k)),
            ("g_bnot", numbers(&curves[0].pcf.g)),
            ("g_dart_throwing", numbers(&curves[1].pcf.g)),
        ],
    );
    let verdicts = [verdict(pcf, "bnot", 0.1), verdict(pcf, "dart-throwing", 0.2)];
    held.table(
        &ENVELOPE,
        envelope_csv(&m, &verdicts).unwrap(),
        &[
            ("r", numbers(&pcf.r)),
            ("g", numbers(&pcf.g)),
            ("mean_bnot", numbers(&verdicts[0].envelope.mean)),
            ("low_bnot", numbers(&verdicts[0].envelope.low)),
            ("high_bnot", numbers(&verdicts[0].envelope.high)),
            ("mean_dart_throwing", numbers(&verdicts[1].envelope.mean)),
            ("low_dart_throwing", numbers(&verdicts[1].envelope.low)),
            ("high_dart_throwing", numbers(&verdicts[1].envelope.high)),
        ],
    );
    let found =
        functions(mosaic.points(), mosaic.window(), &m.neighbours, &FunctionOptions::default()).unwrap();
    // values stand under the names that the statistics give them, so that two cannot be exchanged
    let series = found.columns();
    let expected: Vec<_> = series.iter().map(|(name, values)| (*name, numbers(values))).collect();
    held.table(&FUNCTIONS, functions_csv(&found).unwrap(), &expected);
    let profile = m.density_recovery.as_ref().unwrap();
    held.table(
        &DENSITY_RECOVERY,
        density_recovery_csv(Some(profile)).unwrap(),
        &[
            ("r", numbers(&profile.r)),
            ("density", numbers(&profile.density)),
            ("relative_density", cells(profile.density.iter().map(|d| d / profile.mean_density))),
        ],
    );
    let power = spectrum(mosaic.points(), mosaic.window(), &SpectrumOptions::default()).unwrap();
    held.table(
        &SPECTRUM,
        spectrum_csv(&power).unwrap(),
        &[
            ("frequency", numbers(&power.frequency)),
            ("power", numbers(&power.power)),
            ("anisotropy_db", cells(power.anisotropy_db.iter().copied())),
        ],
    );
}

pub fn maps_and_profiles(held: &mut Held) {
    let (mosaic, m) = mosaic();
    let options = MapOptions { window: LocalWindow::Cells(20), ..MapOptions::default() };
    let found = maps(&mosaic, &m, &options).unwrap();
    let um = 0.5;
    let mm2 = |d: Option<f64>| d.map(|d| d * 1e6 / (um * um));
    let local = |value: &dyn Fn(&crate::stats::LocalValues) -> Cell| found.local.iter().map(value).collect();
    held.table(
        &MAPS,
        maps_csv(&mosaic, &found).unwrap(),
        &[
            ("x", cells(mosaic.points().iter().map(|p| p.x))),
            ("y", cells(mosaic.points().iter().map(|p| p.y))),
            ("side", local(&|v| v.side.into())),
            ("bound", local(&|v| v.bound.into())),
            ("flag", local(&|v| v.flag.name().into())),
            ("density", local(&|v| v.density.into())),
            ("icd", local(&|v| v.inter_cell.into())),
            ("nnd", local(&|v| v.nearest.into())),
            ("ri", local(&|v| v.nearest_ri.into())),
            ("psi6", local(&|v| v.psi6.into())),
            ("six_sided_percent", local(&|v| v.six_sided_percent.into())),
            ("density_per_mm2", local(&|v| mm2(v.density).into())),
            ("icd_um", local(&|v| v.inter_cell.map(|d| d * um).into())),
            ("nnd_um", local(&|v| v.nearest.map(|d| d * um).into())),
        ],
    );
    let row = |value: &dyn Fn(&crate::stats::ProfileRow) -> Cell| found.profile.iter().map(value).collect();
    held.table(
        &PROFILES,
        profiles_csv(&mosaic, &found).unwrap(),
        &[
            ("along", row(&|p| p.along.name().into())),
            ("r", row(&|p| p.r.into())),
            ("bound", row(&|p| p.bound.into())),
            ("share", row(&|p| p.share.into())),
            ("density", row(&|p| p.density.into())),
            ("spacing", row(&|p| p.spacing.into())),
            ("icd", row(&|p| p.inter_cell.into())),
            ("nnd", row(&|p| p.nearest.into())),
            ("r_um", row(&|p| (p.r * um).into())),
            ("density_per_mm2", row(&|p| mm2(p.density).into())),
            ("spacing_um", row(&|p| p.spacing.map(|s| s * um).into())),
        ],
    );
}

pub fn spectra_of_tiles(held: &mut Held) {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures/images/confocal_dense.png");
    let image = crate::image::read(std::path::Path::new(file)).unwrap();
    let whole = fourier_spacing(&image).unwrap();
    let map = fourier_map(&image, &whole, &FourierMapOptions::default()).unwrap();
    let places: Vec<Point> =
        map.y.iter().flat_map(|&y| map.x.iter().map(move |&x| Point::new(x, y))).collect();
    held.table(
        &FOURIER_MAP,
        fourier_map_csv(Some(&map), Some(0.5)).unwrap(),
        &[
            ("x_px", cells(places.iter().map(|p| p.x))),
            ("y_px", cells(places.iter().map(|p| p.y))),
            ("spacing_px", cells(places.iter().map(|&p| map.spacing.at(p)))),
            ("spacing_um", cells(places.iter().map(|&p| map.spacing.at(p) * 0.5))),
            ("confidence", cells(map.confidence.iter().copied())),
        ],
    );
}

fn record() -> CoordinatesRecord {
    let (mosaic, measures) = mosaic();
    let distance = |sampler: &str, l_infinity| SamplerDistance { sampler: sampler.into(), l_infinity };
    let distances = vec![distance("dart-throwing", 0.75), distance("bnot", 0.5)];
    let mosaic = MosaicRecord::new(&mosaic, &measures, distances);
    let warnings = vec!["one".to_owned(), "two".to_owned()];
    CoordinatesRecord { file: "in/a.csv".into(), name: "a".into(), outside: 3, mosaic, warnings }
}

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
        ("l_infinity", 0.41.into()),
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

    // indexes 2, 6 of one subject and 10 of another: means 4 and 10; a fourth image has none
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
