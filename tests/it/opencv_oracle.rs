//! Detection, compared stage by stage with the same stages written with OpenCV
//! (`scripts/opencv_oracle.py`).

use crate::common::{python, run_script};
use conemosaic::detect::{
    Criterion, DetectOptions, Detection, Detections, Detector, detect, flatten, local_maxima, response,
    suppress,
};
use conemosaic::geometry::Point;
use conemosaic::image::{Plane, is_image_path, read};
use std::collections::HashSet;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

/// Largest difference between planes, as a fraction of their range. The two programs differ because
/// this one does not sum Gaussians of σ ≥ 8 px pixel by pixel.
const PLANE: f32 = 1e-3;
/// Largest prominence, as a fraction of the range, of a maximum that only one of the two programs
/// finds. Such a maximum counts as a tie.
///
/// The value is five times the measured effect of rounding to `f32`.
const TIE: f32 = 1e-4;
/// Largest fraction of the maxima that may be ties.
const TIES: f64 = 0.01;
/// Largest distance, in px, between cones of the two programs that count as the same cone.
const NEAR: f64 = 0.25;
/// Fraction of the cones that both programs must find.
const AGREEMENT: f64 = 0.995;
/// Largest distance, in px, between the positions that the two programs find for a maximum of the
/// same plane. It allows for the effect of rounding on the parabola.
const SAME: f64 = 1e-3;

struct Case {
    name: String,
    path: PathBuf,
    image: Plane,
    found: Detections,
}

fn cases() -> Vec<Case> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/images");
    let mut paths: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    paths.retain(|p| is_image_path(p));
    paths.sort();
    let case = |path: PathBuf| {
        let image = read(&path).unwrap();
        let classical = DetectOptions { detector: Detector::Classical, ..DetectOptions::default() };
        let found = detect(&image, &classical).unwrap();
        Case { name: path.file_stem().unwrap().to_string_lossy().into_owned(), path, image, found }
    };
    paths.into_iter().map(case).collect()
}

fn ask_oracle(python: &Path, cases: &[Case], out: &Path) {
    let mut jobs = String::from("name,path,modality,polarity,spacing\n");
    for Case { name, path, found, .. } in cases {
        let Detections { modality, polarity, spacing, .. } = found;
        writeln!(jobs, "{name},\"{}\",{modality},{},{spacing}", path.display(), polarity.name()).unwrap();
    }
    fs::write(out.join("jobs.csv"), jobs).unwrap();
    run_script(python, "opencv_oracle.py", &[out.join("jobs.csv").as_os_str(), out.as_os_str()]);
}

fn plane(path: PathBuf, like: &Plane) -> Plane {
    let bytes = fs::read(path).unwrap();
    let values = bytes.as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect();
    Plane::from_shape_vec(like.dim(), values).unwrap()
}

fn rows<const N: usize>(path: PathBuf) -> Vec<[f64; N]> {
    let text = fs::read_to_string(path).unwrap();
    let row = |line: &str| {
        let cells: Vec<f64> = line.split(',').map(|c| c.parse().unwrap()).collect();
        <[f64; N]>::try_from(cells).unwrap()
    };
    text.lines().skip(1).map(row).collect()
}

fn range(plane: &Plane) -> f32 {
    let (low, high) =
        plane.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
    high - low
}

/// Returns the largest difference between two planes as a fraction of the range of the oracle's
/// plane.
fn difference(ours: &Plane, oracle: &Plane) -> f32 {
    ours.iter().zip(oracle).map(|(a, b)| (a - b).abs()).fold(0., f32::max) / range(oracle)
}

/// Returns the prominence of a pixel: its height above its highest neighbour or above the
/// threshold, whichever is higher.
fn prominence(plane: &Plane, row: usize, column: usize, threshold: f32) -> f32 {
    let (h, w) = plane.dim();
    let neighbours = (row.saturating_sub(1)..(row + 2).min(h))
        .flat_map(|j| (column.saturating_sub(1)..(column + 2).min(w)).map(move |i| (j, i)))
        .filter(|&p| p != (row, column));
    plane[[row, column]] - neighbours.map(|p| plane[p]).fold(threshold, f32::max)
}

/// Returns the pixel of a maximum, whose centre lies at most half a pixel away.
fn pixel_of(d: &Detection, response: &Plane) -> (usize, usize) {
    let around = |v: f64| [v.floor().max(0.) as usize, v.ceil() as usize];
    around(d.centre.y)
        .into_iter()
        .flat_map(|row| around(d.centre.x).map(|column| (row, column)))
        .find(|&p| response.get(p).is_some_and(|&v| f64::from(v) == d.score))
        .expect("the score of a maximum is the response at its pixel")
}

/// One image with the results of both programs.
struct Compared {
    name: String,
    image: Plane,
    flat: Plane,
    response: Plane,
    criterion: Criterion,
    radius: f64,
    oracle_image: Plane,
    oracle_flat: Plane,
    oracle_response: Plane,
    /// Maxima as column, row, x, y and score.
    oracle_maxima: Vec<[f64; 5]>,
    /// Cones as x, y and score.
    oracle_cones: Vec<[f64; 3]>,
}

/// Returns all images in `fixtures/` with the results of both programs; the list is empty without
/// OpenCV.
fn compared() -> &'static [Compared] {
    // results of the script, which runs only once for all tests
    static COMPARED: LazyLock<Vec<Compared>> = LazyLock::new(|| {
        let Some(python) = python() else {
            println!("SKIPPED opencv oracle: no Python with OpenCV here, run scripts/test");
            return Vec::new();
        };
        let cases = cases();
        assert!(cases.len() >= 8, "only {} images in fixtures/images", cases.len());
        let out = tempfile::tempdir().unwrap();
        ask_oracle(&python, &cases, out.path());
        let compare = |Case { name, image, found, .. }: Case| {
            let file = |stage: &str| out.path().join(format!("{name}.{stage}"));
            let (response, criterion) =
                response(&image, found.modality, found.polarity, found.spacing, f64::INFINITY);
            Compared {
                flat: flatten(&image),
                response,
                criterion,
                radius: criterion.suppression * found.spacing,
                oracle_image: plane(file("image"), &image),
                oracle_flat: plane(file("flat"), &image),
                oracle_response: plane(file("response"), &image),
                oracle_maxima: rows(file("maxima.csv")),
                oracle_cones: rows(file("detections.csv")),
                name,
                image,
            }
        };
        cases.into_iter().map(compare).collect()
    });
    &COMPARED
}

#[test]
fn images_are_read_as_opencv_reads_them() {
    for c in compared() {
        assert_eq!(c.image, c.oracle_image, "{}", c.name);
    }
}

#[test]
fn flattened_images_agree_with_opencv() {
    for c in compared() {
        let off = difference(&c.flat, &c.oracle_flat);
        println!("{}: flattened image off by {off:.1e} of its range", c.name);
        assert!(off < PLANE, "{}: {off}", c.name);
    }
}

#[test]
fn responses_agree_with_opencv() {
    for c in compared() {
        let off = difference(&c.response, &c.oracle_response);
        println!("{}: response off by {off:.1e} of its range", c.name);
        assert!(off < PLANE, "{}: {off}", c.name);
    }
}

#[test]
fn one_response_has_the_same_maxima_by_opencv() {
    for c in compared() {
        let ours = local_maxima(&c.oracle_response, c.criterion.threshold);
        // of a plateau, this program takes the first pixel and dilation takes all pixels
        let plateaus = c.oracle_maxima.iter().filter(|m| {
            prominence(&c.oracle_response, m[1] as usize, m[0] as usize, c.criterion.threshold) == 0.
        });
        assert_eq!(plateaus.count(), 0, "{}: fixtures have no plateaus", c.name);
        assert_eq!(ours.len(), c.oracle_maxima.len(), "{}", c.name);
        // both lists are in reading order
        for (a, b) in ours.iter().zip(&c.oracle_maxima) {
            let distance = a.centre.distance(Point::new(b[2], b[3]));
            assert!(distance < SAME && a.score == b[4], "{}: {a:?}, OpenCV {b:?}", c.name);
        }
    }
}

#[test]
fn both_responses_have_the_same_maxima_up_to_ties() {
    for c in compared() {
        let threshold = c.criterion.threshold;
        let ours: HashSet<_> =
            local_maxima(&c.response, threshold).iter().map(|d| pixel_of(d, &c.response)).collect();
        let oracle: HashSet<_> = c.oracle_maxima.iter().map(|m| (m[1] as usize, m[0] as usize)).collect();
        let tie = TIE * range(&c.oracle_response);
        let mut ties = 0;
        for (lonely, plane) in
            [(ours.difference(&oracle), &c.response), (oracle.difference(&ours), &c.oracle_response)]
        {
            for &(row, column) in lonely {
                let above = prominence(plane, row, column, threshold);
                assert!(above <= tie, "{}: ({column}, {row}) stands out by {above}, a tie is {tie}", c.name);
                ties += 1;
            }
        }
        println!("{}: {} maxima, {ties} ties", c.name, oracle.len());
        assert!(
            f64::from(ties) <= TIES * oracle.len() as f64,
            "{}: {ties} of {} are ties",
            c.name,
            oracle.len()
        );
    }
}

#[test]
fn suppression_keeps_the_same_of_the_same_maxima() {
    for c in compared() {
        let maxima =
            c.oracle_maxima.iter().map(|&[_, _, x, y, score]| Detection { centre: Point::new(x, y), score });
        let ours = c.criterion.select(suppress(maxima.collect(), c.radius));
        assert_eq!(ours.len(), c.oracle_cones.len(), "{}", c.name);
        for (a, b) in ours.iter().zip(&c.oracle_cones) {
            assert_eq!([a.centre.x, a.centre.y, a.score], *b, "{}", c.name);
        }
    }
}

#[test]
fn cones_agree_with_opencv() {
    for c in compared() {
        let ours = c.criterion.select(suppress(local_maxima(&c.response, c.criterion.threshold), c.radius));
        let ours: Vec<Point> = ours.iter().map(|d| d.centre).collect();
        let oracle: Vec<Point> = c.oracle_cones.iter().map(|m| Point::new(m[0], m[1])).collect();
        // suppression keeps cones much farther apart than `NEAR`, so no cone is near two others
        let near = |p: &Point, others: &[Point]| others.iter().any(|q| p.distance(*q) <= NEAR);
        let agreeing = ours.iter().filter(|p| near(p, &oracle)).count()
            + oracle.iter().filter(|p| near(p, &ours)).count();
        let agreement = agreeing as f64 / (ours.len() + oracle.len()) as f64;
        println!(
            "{}: {} cones, OpenCV {}, {:.2} % agree",
            c.name,
            ours.len(),
            oracle.len(),
            100. * agreement
        );
        assert!(agreement >= AGREEMENT, "{}: {agreement}", c.name);
    }
}
