//! Coordinate files in the formats that laboratories use, and damaged files.

use conemosaic::geometry::Point;
use conemosaic::mosaic::LengthUnit;
use conemosaic::mosaic::io::{
    CoordinateFile, Dialect, Origin, Place, ReadError, ReadFault, ReadOptions, Series, read_coordinates,
    read_from,
};
use proptest::prelude::*;
use std::io::{Cursor, Write};
use std::path::Path;

fn read(bytes: impl AsRef<[u8]>) -> Result<CoordinateFile, ReadError> {
    read_from("marks", bytes.as_ref(), &ReadOptions::default())
}

fn points(bytes: impl AsRef<[u8]>) -> Vec<[f64; 2]> {
    read(bytes).unwrap().points.iter().map(|p| p.coordinates()).collect()
}

fn with(options: ReadOptions, bytes: impl AsRef<[u8]>) -> Vec<[f64; 2]> {
    read_from("marks", bytes.as_ref(), &options).unwrap().points.iter().map(|p| p.coordinates()).collect()
}

fn origin(origin: Origin) -> ReadOptions {
    ReadOptions { origin: Some(origin), ..ReadOptions::default() }
}

/// Returns the error message of a file that cannot be read, and checks that it is one short line
/// that begins with the name of the file.
fn failure(bytes: impl AsRef<[u8]>) -> String {
    let message = read(bytes).unwrap_err().to_string();
    assert!(message.starts_with("marks"), "{message}");
    assert!(!message.chars().any(char::is_control), "{message}");
    assert!(message.chars().count() < 400, "{message}");
    message
}

/// Points that the files of several tests contain.
const EXPECTED: [[f64; 2]; 2] = [[1.5, 2.25], [-3., 40.]];

#[test]
fn columns_are_read_whatever_separates_them() {
    for text in [
        "x,y\n1.5,2.25\n-3,40\n",
        "1.5,2.25\n-3,40",
        "1.5, 2.25\r\n-3, 40\r\n",
        "X;Y\r\n1,5;2,25\r\n-3;40\r\n",
        "x\ty\n1,5\t2,25\n-3\t40\n",
        "  1.5   2.25\n -3 40\n\n",
        "# marked by hand\n\n\"x\",\"y\"\n\"1.5\",\"2.25\"\n# again\n-3e0,+40.\n",
        "\u{feff}x_px,y_px\n1.5,2.25\n-3,40\n",
        "1.5,2.25,0.9,a note\n-3,40,0.8,\n,,,\n",
        "id,y,x\nA,2.25,1.5\nB,40,-3\n",
        " ,Area,Mean,X,Y\n1,0,113,1.5,2.25\n2,0,98,-3,40\n",
        " \tLabel\tXM\tYM\n1\tmosaic.tif\t1.5\t2.25\n2\tmosaic.tif\t-3\t40\n",
    ] {
        let file = read(text).unwrap_or_else(|e| panic!("{e} in {text:?}"));
        assert_eq!(file.points.iter().map(|p| p.coordinates()).collect::<Vec<_>>(), EXPECTED, "{text:?}");
        assert_eq!(file.dialect, Dialect::Delimited);
    }
}

#[test]
fn text_of_every_encoding_is_read() {
    let text = "x (µm);y (µm)\r\n1,5;2,25\r\n-3;40\r\n";
    let utf16: Vec<u8> =
        [0xff, 0xfe].into_iter().chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect();
    let latin1: Vec<u8> = text.chars().map(|c| c as u8).collect();
    for bytes in [utf16, latin1, text.as_bytes().to_vec()] {
        let file = read(bytes).unwrap();
        assert_eq!(file.unit, Some(LengthUnit::Micrometre));
        assert_eq!(file.points[0], Point::new(1.5, 2.25));
    }
}

#[test]
fn scores_are_kept_and_pixels_preferred_to_micrometres() {
    let file = read("x_px,y_px,score,x_um,y_um\n1,2,0.5,10,20\n3,4,-1e-3,30,40\n").unwrap();
    assert_eq!(file.scores, Some(vec![0.5, -1e-3]));
    assert_eq!(file.unit, Some(LengthUnit::Pixel));
    assert_eq!(file.points, [Point::new(1., 2.), Point::new(3., 4.)]);
    assert_eq!(read("x,y\n1,2\n").unwrap().scores, None);
}

#[test]
fn a_header_alone_means_no_points() {
    for text in ["x,y\n", "x_px,y_px,score", "Dataset 1,,Dataset 2,\nX,Y,X,Y\n", "{\"datasetColl\":[]}"] {
        assert!(points(text).is_empty(), "{text:?}");
    }
}

#[test]
fn the_origin_is_taken_off_and_upward_y_turned_round() {
    assert_eq!(with(origin(Origin::One), "1,1\n13.25,24.25\n"), [[0., 0.], [12.25, 23.25]]);
    assert_eq!(with(origin(Origin::Half), "0.5,0.5\n"), [[0., 0.]]);
    // the image has 100 rows, counted upwards from the bottom; the numbers are the y of the centre
    // of the top row in each convention
    for (o, top) in [(Origin::Zero, 99.), (Origin::Half, 99.5), (Origin::One, 100.)] {
        let options = ReadOptions { flip_y: Some(100.), ..origin(o) };
        assert_eq!(with(options, format!("{},{top}\n", o.value())), [[0., 0.]]);
    }
    let flip = ReadOptions { flip_y: Some(1.), ..ReadOptions::default() };
    assert_eq!(with(flip, "x_unit,y_unit\n0.25,0.25\n"), [[0.25, 0.75]]);
    let message = read_from("marks", b"x_um,y_um\n1,2\n", &origin(Origin::One)).unwrap_err().to_string();
    assert!(message.contains("origin is 1") && message.contains("um"), "{message}");
    for height in [0., f64::NAN] {
        let options = ReadOptions { flip_y: Some(height), ..ReadOptions::default() };
        assert!(read_from("marks", b"1,2", &options).is_err());
    }
}

/// Project of WebPlotDigitizer 4, with two data sets.
const PROJECT_4: &str = r#"{"version":[4,2],"axesColl":[{"name":"Image","type":"ImageAxes"}],
  "datasetColl":[
    {"name":"cones","axesName":"Image","metadataKeys":[],"data":[{"x":0.5,"y":0.5,"value":[0.5,0.5]},{"x":10.25,"y":3,"value":[1,2]}]},
    {"name":"rods","data":[{"x":7.5,"y":8.5}]}],
  "measurementColl":[]}"#;
/// Project of WebPlotDigitizer 3, with one data set.
const PROJECT_3: &str = r#"{"wpd":{"version":[3,8],"axesType":"ImageAxes","calibration":[],
  "dataSeries":[{"name":"Default Dataset","data":[{"x":0.5,"y":1.5,"value":[0.5,1.5]}],"metadataKeys":[]}]}}"#;

#[test]
fn webplotdigitizer_projects_count_from_the_corner() {
    let file = read(PROJECT_4).unwrap();
    assert_eq!(file.dialect, Dialect::WebPlotDigitizerProject);
    assert_eq!(file.points, [Point::new(0., 0.), Point::new(9.75, 2.5), Point::new(7., 8.)]);
    let series = |name: &str, len| Series { name: name.into(), len };
    assert_eq!(file.series, [series("cones", 2), series("rods", 1)]);
    assert_eq!(points(PROJECT_3), [[0., 1.]]);
    assert_eq!(points(format!("\u{feff}{PROJECT_3}\r\n")), [[0., 1.]]);
    assert_eq!(with(origin(Origin::Zero), PROJECT_3), [[0.5, 1.5]]);
}

#[test]
fn one_dataset_can_be_asked_for() {
    let only = |name: &str| ReadOptions { dataset: Some(name.into()), ..ReadOptions::default() };
    assert_eq!(with(only("rods"), PROJECT_4), [[7., 8.]]);
    let error = read_from("marks", PROJECT_4.as_bytes(), &only("rod")).unwrap_err().to_string();
    assert!(error.contains("“rod”") && error.contains("“cones”, “rods”"), "{error}");
}

#[test]
fn webplotdigitizer_csv_of_all_datasets_is_read_without_its_padding() {
    for text in [
        "cones,,rods,\nX,Y,X,Y\n1, 2,5, 6\n3,4,,\n",
        "cones;;rods;\nX;Y;X;Y\n1,0;2;5;6\n3;4;;\n",
        "20,,30,\nX,Y,X,Y\n1,2,5,6\n3,4,,\n",
    ] {
        let file = read(text).unwrap();
        assert_eq!(file.dialect, Dialect::WebPlotDigitizerCsv);
        assert_eq!(file.points, [[1., 2.], [3., 4.], [5., 6.]].map(Point::from));
        assert_eq!(file.series.iter().map(|s| s.len).collect::<Vec<_>>(), [2, 1]);
    }
    assert_eq!(points("Default Dataset,\nX,Y\n1,2\n"), [[1., 2.]]);
    assert!(
        failure("a,,b,\nX,Y,X,Y\n1,2,3,\n").contains("line 3: expected a number for y, found an empty cell")
    );
}

/// Returns a tar archive as WebPlotDigitizer saves it.
fn tar(members: &[(&str, &[u8])]) -> Vec<u8> {
    let mut builder = tar::Builder::new(Vec::new());
    for (name, data) in members {
        let mut header = tar::Header::new_ustar();
        header.set_size(data.len() as u64);
        header.set_mode(0o644);
        builder.append_data(&mut header, name, *data).unwrap();
    }
    builder.into_inner().unwrap()
}

#[test]
fn webplotdigitizer_tar_is_opened() {
    let members = [
        ("wpd_project/info.json", &b"{\"version\":[4,0]}"[..]),
        ("wpd_project/image.png", b"\x89PNG not really"),
        ("wpd_project/wpd.json", PROJECT_4.as_bytes()),
    ];
    let bytes = tar(&members);
    assert_eq!(points(&bytes), points(PROJECT_4));
    assert!(
        failure(tar(&members[..2]))
            .contains("expected wpd.json in the archive, found “wpd_project/info.json”")
    );
    let json_ends = bytes.windows(15).rposition(|w| w == b"measurementColl").unwrap();
    assert!(failure(&bytes[..json_ends]).contains("wpd.json"));
    assert!(failure(tar(&[("wpd.json", b"{\"wpd\":1}")])).contains("member “wpd.json”"));
}

/// Returns an ImageJ point ROI in the layout of `ij.io.RoiEncoder`.
fn roi(version: u16, points: &[[f32; 2]], sub_pixel: bool) -> Vec<u8> {
    let (left, top) = (3i16, 5i16);
    let mut bytes = vec![0; 64];
    bytes[..4].copy_from_slice(b"Iout");
    bytes[4..6].copy_from_slice(&version.to_be_bytes());
    bytes[6] = 10;
    bytes[8..10].copy_from_slice(&top.to_be_bytes());
    bytes[10..12].copy_from_slice(&left.to_be_bytes());
    match u16::try_from(points.len()) {
        Ok(n) => bytes[16..18].copy_from_slice(&n.to_be_bytes()),
        Err(_) => bytes[18..22].copy_from_slice(&(points.len() as u32).to_be_bytes()),
    }
    bytes[50..52].copy_from_slice(&(if sub_pixel { 128u16 } else { 0 }).to_be_bytes());
    for (axis, offset) in [(0, left), (1, top)] {
        bytes.extend(points.iter().flat_map(|p| (p[axis] as i16 - offset).to_be_bytes()));
    }
    if sub_pixel {
        for axis in [0, 1] {
            bytes.extend(points.iter().flat_map(|p| p[axis].to_be_bytes()));
        }
    }
    // the second header contains nothing that is needed here
    bytes.extend([0; 64]);
    bytes
}

#[test]
fn imagej_points_count_from_where_their_version_does() {
    let marks = [[10., 20.], [3., 5.], [40.25, 7.75]];
    let whole = [[10., 20.], [3., 5.], [40., 7.]];
    assert_eq!(points(roi(217, &marks, false)), whole);
    assert_eq!(points(roi(228, &marks, false)), whole);
    // since version 1.52t the centres of pixels have integer coordinates; before, their coordinates
    // ended in .5
    assert_eq!(points(roi(228, &marks, true)), [[10., 20.], [3., 5.], [40.25, 7.75]]);
    assert_eq!(points(roi(227, &marks, true)), [[9.5, 19.5], [2.5, 4.5], [39.75, 7.25]]);
    assert_eq!(with(origin(Origin::Zero), roi(227, &marks[..1], true)), [[10., 20.]]);
    assert!(points(roi(228, &[], true)).is_empty());
}

#[test]
fn imagej_points_may_be_more_than_16_bits_count() {
    let many: Vec<[f32; 2]> = (0..70_000).map(|i| [(i % 300) as f32 + 3., (i / 300) as f32 + 5.]).collect();
    assert_eq!(points(roi(228, &many, false)).len(), 70_000);
}

fn zip(members: &[(&str, &[u8])]) -> Vec<u8> {
    let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, data) in members {
        writer.start_file(*name, zip::write::SimpleFileOptions::default()).unwrap();
        writer.write_all(data).unwrap();
    }
    writer.finish().unwrap().into_inner()
}

#[test]
fn imagej_roi_sets_are_opened() {
    let (first, second) = (roi(228, &[[10., 20.]], false), roi(227, &[[7.5, 8.5], [9.5, 10.5]], true));
    let set = zip(&[("0001-0020.roi", &first), ("__MACOSX/._a.roi", b"?"), ("cones.roi", &second)]);
    let file = read(&set).unwrap();
    assert_eq!(file.points, [[10., 20.], [7., 8.], [9., 10.]].map(Point::from));
    assert_eq!(file.series[1], Series { name: "cones".into(), len: 2 });
    assert!(failure(&set[..set.len() / 2]).contains("damaged archive"));
    assert!(failure(zip(&[])).contains("found none"));
    assert!(failure(zip(&[("xl/workbook.xml", b"<workbook/>")])).contains("save it as CSV"));
    let mut polygon = first.clone();
    polygon[6] = 0;
    assert!(failure(zip(&[("a.roi", &first), ("b.roi", &polygon)])).contains("member “b.roi”"));
}

#[test]
fn archives_that_unpack_to_far_more_than_they_are_do_not_fill_memory() {
    let bomb = zip(&[("a.roi", &vec![0; 50 << 20])]);
    assert!(bomb.len() < 1 << 20);
    assert!(failure(bomb).contains("larger than 48 MiB"));
}

#[test]
fn counts_that_a_roi_does_not_hold_are_refused() {
    let whole = roi(228, &[[10., 20.], [3., 5.]], true);
    for length in [4, 63, 64, 64 + 23] {
        assert!(failure(&whole[..length]).contains("expected an ImageJ ROI of at least"), "{length}");
    }
    let mut claims = roi(228, &[], true);
    claims[18..22].fill(0xff);
    assert!(failure(claims).contains("for 4294967295 points"));
    let mut not_a_number = whole.clone();
    not_a_number[72..76].copy_from_slice(&f32::NAN.to_be_bytes());
    assert!(failure(not_a_number).contains("finite"));
    let mut composite = whole;
    composite[39] = 1;
    assert!(failure(composite).contains("composite"));
}

#[test]
fn every_failure_says_where_and_what_to_do() {
    for (text, parts) in [
        ("", &["expected two columns", "empty file", "export it again"][..]),
        ("# only\n\n  \n,,\n", &["empty file"]),
        ("x,y\n1,2\n3,four\n", &["line 3", "number for y", "“four”", "correct or delete the row"]),
        ("1,2\n\n# note\nnan,4\n", &["line 4", "finite number for x", "“nan”"]),
        ("x,y\n1,inf\n", &["line 2", "finite", "“inf”"]),
        ("1e999,2\n", &["line 1", "finite"]),
        ("1\n2\n", &["line 1", "two columns", "“1”"]),
        ("x\n1\n", &["line 1", "two columns"]),
        ("x,y\n1,2\n3\n", &["line 3", "2 cells", "found 1", "“3”"]),
        ("1,2\n3,4,5\n", &["line 2", "found 3"]),
        ("1,5 2,5\n", &["line 1", "“5 2”", "semicolons"]),
        ("row,column\n1,2\n", &["line 1", "x and y", "“row,column”"]),
        ("x,y,x,y\n1,2,3,4\n", &["line 1", "found two"]),
        ("x,y,score\n1,2,\n", &["line 2", "score", "empty cell"]),
        ("x,y\n\"1,2\n", &["line 2", "quotation"]),
        ("A,1,2\n", &["line 1", "“A”", "header"]),
        ("{\"points\":[[1,2]]}", &["WebPlotDigitizer project"]),
        ("{\"datasetColl\":[{\"data\":[{\"x\":1,\"y\":\"2\"}]}]}", &["JSON", "line 1"]),
        ("{\"datasetColl\":[{\"data\":[{\"x\":1e999,\"y\":2}]}]}", &["JSON"]),
        ("{\"datasetColl\":[{\"data\"", &["JSON"]),
        ("[1, 2]", &["JSON"]),
        ("1,2\0", &["binary data", "31 2c 32 00", "export"]),
        ("\u{1b}[31mred,\u{1b}[0m\n", &["binary"]),
        ("%PDF-1.7\n", &["a PDF"]),
        ("MATLAB 5.0 MAT-file", &["MATLAB workspace", "as CSV"]),
    ] {
        let message = failure(text);
        for part in parts {
            assert!(message.contains(part), "no “{part}” in “{message}” for {text:?}");
        }
    }
    assert!(failure(b"\x89PNG\r\n\x1a\n\0\0").contains("a PNG image"));
    assert!(failure(format!("1,2\n3,{}\n", "long ".repeat(10_000))).contains('…'));
}

#[test]
fn faults_carry_their_place_for_programs() {
    let error = read("1,2\n3,x\n").unwrap_err();
    assert_eq!(error.place, Some(Place::Line(2)));
    assert!(matches!(error.fault, ReadFault::NotANumber { .. }));
}

#[test]
fn files_that_are_not_there_are_named() {
    let folder = tempfile::tempdir().unwrap();
    for path in [folder.path().join("none.csv"), folder.path().to_path_buf()] {
        let error = read_coordinates(&path, &ReadOptions::default()).unwrap_err();
        assert!(matches!(error.fault, ReadFault::Io(_)));
        assert!(error.to_string().starts_with(&path.display().to_string()));
    }
}

#[test]
fn all_marks_of_the_reference_data_are_read() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/aoslo");
    let mut files = 0;
    for folder in ["confocal", "split"] {
        let Ok(entries) = std::fs::read_dir(root.join(folder)) else {
            println!("SKIPPED marks of the reference data: ../shared is not here");
            return;
        };
        for path in entries.map(|e| e.unwrap().path()) {
            if path.to_string_lossy().ends_with("_coords.csv") {
                let file = read_coordinates(&path, &origin(Origin::One)).unwrap();
                let lines = std::fs::read_to_string(&path).unwrap().lines().count();
                assert_eq!(file.points.len(), lines, "{}", path.display());
                assert!(file.points.iter().all(|p| p.x > -1. && p.x < 250. && p.y > -1. && p.y < 250.));
                files += 1;
            }
        }
    }
    assert_eq!(files, 384);
}

#[test]
fn a_hundred_thousand_rows_are_read_at_once() {
    let text: String = (0..100_000).map(|i| format!("{}.5,{}.25\n", i % 977, i / 977)).collect();
    assert_eq!(points(text).len(), 100_000);
}

/// Returns one valid file of every dialect, for a test that damages them.
fn seeds() -> Vec<Vec<u8>> {
    let marks = roi(227, &[[10., 20.], [3., 5.]], true);
    vec![
        b"x_px,y_px,score\n1.5,2.25,3\n\"4\",5,6\n".to_vec(),
        b"a;;b;\nX;Y;X;Y\n1,5;2;3;4\n5;6;;\n".to_vec(),
        b"\xff\xfe1\0,\x002\0\n\0".to_vec(),
        PROJECT_4.into(),
        PROJECT_3.into(),
        tar(&[("p/wpd.json", PROJECT_3.as_bytes())]),
        marks.clone(),
        zip(&[("a.roi", &marks), ("b.roi", &marks)]),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn no_bytes_make_it_panic(bytes in prop::collection::vec(any::<u8>(), 0..300)) {
        let _ = read(bytes);
    }

    #[test]
    fn no_text_makes_it_panic(text in "[0-9xyXY,;\t .\"#\r\n{}\\[\\]:eE+-]{0,120}") {
        if let Ok(file) = read(&text) {
            prop_assert!(file.points.iter().all(|p| p.is_finite()));
        }
    }

    #[test]
    fn no_damage_makes_it_panic(
        seed in 0..8usize,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut bytes = seeds().swap_remove(seed);
        for (at, value) in changes {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        match read(&bytes) {
            Ok(file) => prop_assert!(file.points.iter().all(|p| p.is_finite())),
            Err(error) => prop_assert!(!error.to_string().chars().any(char::is_control)),
        }
    }

    #[test]
    fn any_finite_number_survives_text(x in any::<f64>(), y in any::<f64>()) {
        prop_assume!(x.is_finite() && y.is_finite());
        prop_assert_eq!(points(format!("x,y\n{x},{y}\n")), [[x, y]]);
    }
}
