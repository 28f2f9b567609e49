//! Tests that every column of the summaries has the value of the record that its name promises.
//!
//! All numbers of the record differ, so that a test fails if the values of two columns are
//! exchanged.

use super::{MetricGroup, MetricSelection, Quantity, Subject, Summary, SummaryKind, metrics};
use crate::detect::{Detector, FourierEstimate, FourierSpacing, Modality, Polarity};
use crate::geometry::{Point, Rectangle, Window};
use crate::mosaic::{LengthUnit, Meridian, Mosaic, RetinalPlace, Scale};
use crate::report::{
    Cell, ConesFrom, CoordinatesRecord, DetectionRecord, ImageRecord, MosaicRecord, SamplerDistance,
};
use crate::stats::measure;
use rand::{RngExt, SeedableRng};
use serde_json::Value;
use std::collections::{BTreeMap, HashSet};

/// Columns in the unit of the image or without a unit, with the location of their value in
/// `metrics.json`.
const COLUMNS: [(&str, &str); 78] = [
    ("width_px", "/width_px"),
    ("height_px", "/height_px"),
    ("um_per_px", "/mosaic/um_per_unit"),
    ("um_per_degree", "/mosaic/um_per_degree"),
    ("n", "/mosaic/n"),
    ("density_per_px2", "/mosaic/density"),
    ("density_bound_per_px2", "/mosaic/voronoi/density"),
    ("window_area_px2", "/mosaic/window_area"),
    ("spacing_ring_px", "/detection/ring_spacing_px"),
    ("spacing_density_px", "/mosaic/spacing"),
    ("nn_mean_px", "/mosaic/nearest/mean"),
    ("nn_sd_px", "/mosaic/nearest/sd"),
    ("ri", "/mosaic/nearest/ri"),
    ("ri_interior", "/mosaic/nearest_interior/ri"),
    ("n_interior", "/mosaic/nearest_interior/n"),
    ("nn_bound_mean_px", "/mosaic/nearest_bound/mean"),
    ("nn_bound_ri", "/mosaic/nearest_bound/ri"),
    ("sd_kind", "/mosaic/deviation"),
    ("l_infinity_bnot", "/mosaic/l_infinity/1/l_infinity"),
    ("l_infinity_dart_throwing", "/mosaic/l_infinity/0/l_infinity"),
    ("closest_sampler", "/mosaic/l_infinity/0/sampler"),
    ("cones_from", "/cones_from"),
    ("detector", "/detection/detector"),
    ("modality", "/detection/modality"),
    ("modality_confidence", "/detection/modality_confidence"),
    ("polarity", "/detection/polarity"),
    ("split_angle", "/detection/split_angle"),
    ("expected_false_alarms", "/detection/expected_false_alarms"),
    ("expected_misses", "/detection/expected_misses"),
    ("spacing_confidence", "/detection/spacing_confidence"),
    ("spacing_min_px", "/detection/spacing_range_px/0"),
    ("spacing_max_px", "/detection/spacing_range_px/1"),
    ("n_bound", "/mosaic/voronoi/bound"),
    ("icd_bound_mean_px", "/mosaic/voronoi/inter_cell/mean"),
    ("icd_bound_ri", "/mosaic/voronoi/inter_cell/ri"),
    ("furthest_bound_mean_px", "/mosaic/voronoi/furthest/mean"),
    ("furthest_bound_ri", "/mosaic/voronoi/furthest/ri"),
    ("icd_all_mean_px", "/mosaic/voronoi/inter_cell_all/mean"),
    ("furthest_all_mean_px", "/mosaic/voronoi/furthest_all/mean"),
    ("voronoi_area_mean_px2", "/mosaic/voronoi/area/mean"),
    ("voronoi_area_cv", "/mosaic/voronoi/area_cv"),
    ("voronoi_area_ri", "/mosaic/voronoi/area/ri"),
    ("voronoi_sides_ri", "/mosaic/voronoi/sides/ri"),
    ("six_sided_percent", "/mosaic/voronoi/six_sided_percent"),
    ("psi6_mean", "/mosaic/voronoi/psi6_mean"),
    ("psi6_global", "/mosaic/voronoi/psi6_global"),
    ("clark_evans_naive", "/mosaic/clark_evans/naive"),
    ("clark_evans_donnelly", "/mosaic/clark_evans/donnelly"),
    ("clark_evans_cdf", "/mosaic/clark_evans/cdf"),
    ("recovery_effective_radius_px", "/mosaic/density_recovery/effective_radius"),
    ("recovery_packing", "/mosaic/density_recovery/packing"),
    ("recovery_reliability", "/mosaic/density_recovery/reliability"),
    ("recovery_bin_width_px", "/mosaic/density_recovery/bin_width"),
    ("nn_axes", "/mosaic/orientation/axes"),
    ("nn_axis_resultant", "/mosaic/orientation/resultant"),
    ("nn_axis_deg", "/mosaic/orientation/direction"),
    ("nn_axis_p", "/mosaic/orientation/p_value"),
    ("anisotropy", "/mosaic/orientation/ellipse/anisotropy"),
    ("anisotropy_axis_deg", "/mosaic/orientation/ellipse/direction"),
    ("neighbour_ellipse_major_px", "/mosaic/orientation/ellipse/major"),
    ("neighbour_ellipse_minor_px", "/mosaic/orientation/ellipse/minor"),
    ("hexagon_axis_deg", "/mosaic/orientation/hexagon_direction"),
    ("modal_spacing_px", "/mosaic/modal/spacing"),
    ("modal_row_spacing_px", "/mosaic/modal/row_spacing"),
    ("modal_power", "/mosaic/modal/power"),
    ("fourier_spacing_px", "/fourier/all/spacing"),
    ("fourier_spacing_row_px", "/fourier/row/spacing"),
    ("fourier_spacing_cell_px", "/fourier/cell/spacing"),
    ("fourier_confidence", "/fourier/all/confidence"),
    ("trend_p", "/mosaic/trend/p_value"),
    ("density_variation", "/mosaic/trend/variation"),
    ("density_variation_low", "/mosaic/trend/variation_interval/0"),
    ("density_variation_high", "/mosaic/trend/variation_interval/1"),
    ("density_ratio", "/mosaic/trend/density_ratio"),
    ("file", "/file"),
    ("name", "/name"),
    ("unit", "/mosaic/unit"),
    ("meridian", "/mosaic/place/meridian"),
];

/// Replaces every number in a value by the next unused one; whole numbers stay whole.
fn numbered(value: &mut Value, next: &mut u64) {
    match value {
        Value::Number(number) => {
            *next += 1;
            *value = if number.is_u64() { (*next).into() } else { (*next as f64 + 0.5).into() };
        }
        Value::Array(values) => values.iter_mut().for_each(|v| numbered(v, next)),
        Value::Object(fields) => fields.values_mut().for_each(|v| numbered(v, next)),
        Value::Null | Value::Bool(_) | Value::String(_) => {}
    }
}

/// Returns a record in which all numbers differ and nothing is missing.
fn record() -> ImageRecord {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(3);
    let mut place = |k: usize| (k as f64 + rng.random_range(0.2..0.8)) * 6.;
    let points = (0..400).map(|k| Point::new(place(k % 20), place(k / 20))).collect();
    let window = Window::Rectangle(Rectangle::new(0., 0., 120., 120.).unwrap());
    let (mosaic, _) = Mosaic::new(points, window, LengthUnit::Pixel, Scale::new(0.5, 290.).ok()).unwrap();
    let measures = measure(&mosaic, &Default::default());
    let distance = |sampler: &str| SamplerDistance { sampler: sampler.into(), l_infinity: 0.5 };
    let mut mosaic = MosaicRecord::new(&mosaic, &measures, vec![distance("dart-throwing"), distance("bnot")]);
    mosaic.place = Some(RetinalPlace { eccentricity_mm: 2., meridian: Some(Meridian::Nasal) });
    mosaic.stats.voronoi.sides.ri.get_or_insert(1.5);
    let ring = Some(FourierSpacing { row_spacing: 0.5, spacing: 0.5, confidence: 0.5 });
    let record = ImageRecord {
        file: "in/a.png".into(),
        name: "a".into(),
        sha256: String::new(),
        options_sha256: String::new(),
        width_px: 1,
        height_px: 1,
        cones_from: ConesFrom::Corrected,
        odd_one_out: false,
        outside: 0,
        detection: Some(DetectionRecord {
            detector: Detector::Learned,
            modality: Modality::Split,
            modality_confidence: 0.5,
            polarity: Polarity::Negative,
            split_angle: Some(0.5),
            n: 1,
            ring_spacing_px: 0.5,
            ring_confidence: 0.5,
            clarity: 0.5,
            density_spacing_px: 0.5,
            spacing_confidence: 0.5,
            spacing_range_px: [0.5; 2],
            expected_false_alarms: 0.5,
            expected_misses: 0.5,
        }),
        fourier: Some(FourierEstimate { side: 1, all: ring, row: ring, cell: ring }),
        mosaic,
        warnings: vec!["one".into(), "two".into()],
    };
    let mut json = serde_json::to_value(&record).unwrap();
    numbered(&mut json, &mut 1000);
    let mut record: ImageRecord = serde_json::from_value(json).unwrap();
    // A location for which an expected density is known.
    record.mosaic.place = Some(RetinalPlace { eccentricity_mm: 2., meridian: Some(Meridian::Nasal) });
    record
}

/// Returns the expected cell of every column in the unit of the image or without a unit.
fn expected(record: &ImageRecord) -> BTreeMap<&'static str, Cell> {
    let json = serde_json::to_value(record).unwrap();
    let cell = |pointer: &str| match json.pointer(pointer) {
        Some(Value::Number(n)) if n.is_u64() => Cell::Count(n.as_u64().unwrap() as usize),
        Some(Value::Number(n)) => n.as_f64().into(),
        Some(Value::String(text)) => text.as_str().into(),
        other => panic!("{pointer}: {other:?}"),
    };
    let mosaic = &record.mosaic;
    let cones = mosaic.expected_cones_per_mm2().unwrap();
    let found = record.detection.as_ref().unwrap();
    let errors = found.expected_false_alarms + found.expected_misses;
    let found_or_missed = found.n as f64 + found.expected_misses;
    let mut all: BTreeMap<&str, Cell> = COLUMNS.iter().map(|(name, at)| (*name, cell(at))).collect();
    all.extend([
        ("warnings", "one; two".into()),
        ("expected_error_rate", (errors / found_or_missed).into()),
        ("eccentricity_mm", 2.0.into()),
        ("density_expected_per_mm2", cones.into()),
        ("spacing_expected_um", mosaic.expected_spacing_um().into()),
        ("density_of_expected_percent", (100. * mosaic.density_per_mm2().unwrap() / cones).into()),
    ]);
    all
}

fn row_of(kind: SummaryKind, subject: &Subject) -> BTreeMap<String, Cell> {
    let samplers = ["bnot".to_owned(), "dart-throwing".to_owned()];
    let summary = Summary::new(kind, &MetricSelection::default(), &samplers, &[]);
    summary.header().into_iter().zip(summary.row(subject)).collect()
}

#[test]
fn every_column_of_an_image_is_the_number_of_its_record() {
    let record = record();
    let expected = expected(&record);
    for (name, cell) in &expected {
        let alike = expected.iter().find(|(other, value)| *other != name && *value == cell);
        assert_eq!(alike, None, "{name} could be exchanged unnoticed");
    }
    let mut row = row_of(SummaryKind::Images, &Subject::Image(&record));
    for (name, cell) in &expected {
        assert_eq!(row.remove(*name).as_ref(), Some(cell), "{name}");
    }
    let (um, degree) = (record.mosaic.um_per_unit.unwrap(), record.mosaic.um_per_degree.unwrap());
    let of_unit = [("um", "mm2", um, um / 1e3), ("deg", "deg2", um / degree, um / degree)];
    let of_unit = of_unit.into_iter().chain([("arcmin", "arcmin2", 60. * um / degree, 60. * um / degree)]);
    for (length, square, per_length, per_square) in of_unit {
        for metric in metrics().filter(|m| m.quantity != Quantity::Plain) {
            let base = metric.column.words.name;
            let (px, suffix, factor) = match metric.quantity {
                Quantity::Length => ("px", length.to_owned(), per_length),
                Quantity::Area => ("px2", square.to_owned(), per_square * per_square),
                _ => ("per_px2", format!("per_{square}"), 1. / (per_square * per_square)),
            };
            let (Cell::Number(in_px), Some(Cell::Number(found))) =
                (&expected[&*format!("{base}_{px}")], row.remove(&format!("{base}_{suffix}")))
            else {
                panic!("{base}_{suffix} is no number")
            };
            assert!((found / (in_px * factor) - 1.).abs() < 1e-12, "{base}_{suffix}: {found}");
        }
    }
    assert_eq!(row.keys().collect::<Vec<_>>(), Vec::<&String>::new(), "not held to anything");
}

#[test]
fn coordinates_have_the_columns_of_images_and_each_in_their_own_unit_too() {
    let image = record();
    let expected = expected(&image);
    let coordinates = CoordinatesRecord {
        file: image.file.clone(),
        name: image.name.clone(),
        outside: 77,
        mosaic: image.mosaic.clone(),
        warnings: image.warnings.clone(),
    };
    let subject = Subject::Coordinates(&coordinates);
    let row = row_of(SummaryKind::Coordinates, &subject);
    assert_eq!((&row["outside_window"], &row["um_per_unit"]), (&77.into(), &image.mosaic.um_per_unit.into()));
    for metric in metrics().filter(|m| m.is_of(SummaryKind::Coordinates)) {
        let base = metric.column.words.name;
        let in_px = match metric.quantity {
            Quantity::Plain if matches!(base, "outside_window" | "um_per_unit") => continue,
            // These have one column per sampler.
            Quantity::Plain if base.ends_with("_SAMPLER") => continue,
            Quantity::Plain => base.to_owned(),
            Quantity::Length => format!("{base}_px"),
            Quantity::Area => format!("{base}_px2"),
            Quantity::Density => format!("{base}_per_px2"),
        };
        assert_eq!(row[&in_px], expected[&*in_px], "{in_px}");
        assert_eq!(row[base], expected[&*in_px], "{base}");
    }
    let mut in_um = coordinates.clone();
    in_um.mosaic.unit = LengthUnit::Micrometre;
    (in_um.mosaic.um_per_unit, in_um.mosaic.um_per_image_px) = (Some(1.), Some(0.25));
    let row = row_of(SummaryKind::Coordinates, &Subject::Coordinates(&in_um));
    let Cell::Number(mean) = row["nn_mean"] else { panic!() };
    assert_eq!((&row["nn_mean_um"], &row["nn_mean_px"]), (&mean.into(), &(mean * 4.).into()));
    in_um.mosaic.um_per_image_px = None;
    let row = row_of(SummaryKind::Coordinates, &Subject::Coordinates(&in_um));
    assert_eq!((&row["nn_mean_px"], &row["um_per_px"]), (&Cell::Missing, &Cell::Missing));
}

#[test]
fn every_metric_has_its_own_name_a_definition_and_stands_with_its_group() {
    let mut names = HashSet::new();
    let mut groups = Vec::new();
    for metric in metrics() {
        assert!(names.insert(metric.column.words.name), "{} twice", metric.column.words.name);
        assert!(
            metric.column.words.definition.ends_with('.'),
            "{}: {}",
            metric.column.words.name,
            metric.column.words.definition
        );
        if groups.last() != Some(&metric.group) {
            groups.push(metric.group);
        }
    }
    assert_eq!(groups, MetricGroup::ALL);
}
