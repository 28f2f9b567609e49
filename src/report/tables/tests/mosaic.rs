use super::{Held, cells};
use crate::compare::{Envelope, ReferenceCurve, SamplerVerdict};
use crate::detect::{FourierMapOptions, fourier_map, fourier_spacing};
use crate::geometry::{Point, Rectangle, Window};
use crate::mosaic::io::format_points;
use crate::mosaic::{LengthUnit, Mosaic, Scale};
use crate::report::Cell;
use crate::report::tables::*;
use crate::stats::{
    FunctionOptions, LocalWindow, MapOptions, Measures, Moments, Pcf, SpectrumOptions, functions, maps,
    measure, spectrum,
};
use rand::{RngExt, SeedableRng};

/// Returns a mosaic whose density rises to the left, with its measures.
pub fn mosaic() -> (Mosaic, Measures) {
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

/// Checks the columns of the tables of points and of detected cones against the API.
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

/// Returns the curve moved up by `by`, which makes a curve of its own.
fn moved(pcf: &Pcf, by: f64) -> Vec<f64> {
    pcf.g.iter().map(|g| g + by).collect()
}

/// Returns a verdict whose values differ from one another.
pub fn verdict(pcf: &Pcf, sampler: &str, by: f64) -> SamplerVerdict {
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

/// Checks the columns of the tables of functions of distance against the API.
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
        shipped: false,
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
    // The statistics name the values themselves, so that no two can be exchanged here.
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

/// Checks the columns of the tables of maps and profiles against the API.
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

/// Checks the columns of the table of spacings from tiles against the API.
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
