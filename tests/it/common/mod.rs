//! Helpers that several modules of tests share.

use assert_cmd::Command;
use conemosaic::compare::{MatchOptions, validate};
use conemosaic::detect::Detections;
use conemosaic::geometry::Point;
use conemosaic::image::Plane;
use conemosaic::mosaic::hexagonal_spacing;
use conemosaic::render::{PRESETS, RenderOptions, simulate};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// The exit code and the output of a run of the program.
pub struct Outcome {
    pub code: i32,
    pub stdout: String,
    pub stderr: String,
}

/// A temporary folder in which the program is run; it is removed when the test ends.
pub struct Place(TempDir);

impl Place {
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    pub fn read_bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    pub fn copy(&self, from: &str, to: &str) {
        self.write(to, fs::read(self.path(from)).unwrap());
    }

    /// Runs the program in the folder with these arguments.
    pub fn run(&self, arguments: &[&str]) -> Outcome {
        let output = Command::new(env!("CARGO_BIN_EXE_conemosaic"))
            .current_dir(self.0.path())
            .args(arguments)
            .output()
            .unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Outcome {
            code: output.status.code().expect("killed by a signal"),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        }
    }

    /// Runs the program and checks that it succeeds.
    pub fn ok(&self, arguments: &[&str]) -> Outcome {
        let outcome = self.run(arguments);
        assert_eq!(outcome.code, 0, "{arguments:?}\n{}{}", outcome.stdout, outcome.stderr);
        outcome
    }

    /// Runs the program, checks that it exits with code 1 and one line on standard error, and
    /// returns that line.
    pub fn refused(&self, arguments: &[&str]) -> String {
        let outcome = self.run(arguments);
        assert_eq!(outcome.code, 1, "{arguments:?}\n{}{}", outcome.stdout, outcome.stderr);
        assert_eq!(outcome.stderr.lines().count(), 1, "{arguments:?}\n{}", outcome.stderr);
        assert!(outcome.stderr.starts_with("error: "), "{}", outcome.stderr);
        assert_eq!(outcome.stdout, "", "{arguments:?}");
        outcome.stderr
    }

    /// Renders a small image.
    pub fn image(&self, name: &str, seed: u32) {
        self.image_of(name, 64, 56, seed);
    }

    /// Renders an image of this size in px.
    pub fn image_of(&self, name: &str, width: u32, height: u32, seed: u32) {
        fs::create_dir_all(self.path(name).parent().unwrap()).unwrap();
        let (path, seed) = (self.path(name), seed.to_string());
        let (path, width, height) = (path.to_str().unwrap(), width.to_string(), height.to_string());
        self.ok(&["render", "--width", &width, "--height", &height, "--seed", &seed, "--out", path, "-q"]);
    }

    /// Returns the content of every file below a folder, by its path inside the folder. The ledger
    /// is left out.
    pub fn files(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let mut found = BTreeMap::new();
        collect(&self.path(folder), &self.path(folder), &mut found);
        found
    }

    /// Returns the results of a run: all files but the record of the run itself, which contains
    /// times.
    pub fn results(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let mut files = self.files(folder);
        files.remove("run.json");
        files
    }

    /// Returns the paths of the files below a folder.
    pub fn names(&self, folder: &str) -> Vec<String> {
        self.files(folder).into_keys().collect()
    }

    /// Returns the rows of a CSV, each by its column names.
    pub fn table(&self, name: &str) -> Vec<BTreeMap<String, String>> {
        table(&self.path(name))
    }

    /// Returns the column names of a CSV.
    pub fn header(&self, name: &str) -> Vec<String> {
        let mut reader = csv::Reader::from_path(self.path(name)).unwrap();
        reader.headers().unwrap().iter().map(str::to_owned).collect()
    }

    pub fn json(&self, name: &str) -> serde_json::Value {
        serde_json::from_str(&self.read(name)).unwrap()
    }
}

pub fn table(path: &Path) -> Vec<BTreeMap<String, String>> {
    let mut reader = csv::Reader::from_path(path).unwrap();
    reader.deserialize().map(Result::unwrap).collect()
}

fn collect(root: &Path, folder: &Path, found: &mut BTreeMap<String, Vec<u8>>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries {
        let path = entry.unwrap().path();
        // the ledger of a result folder is the program's own business
        if path.ends_with(".conemosaic") {
            continue;
        }
        if path.is_dir() {
            collect(root, &path, found);
        } else {
            let name = path.strip_prefix(root).unwrap().to_string_lossy().into_owned();
            found.insert(name, fs::read(&path).unwrap());
        }
    }
}

/// Patterns that are hard for statistics: of too few points, or of collinear, coincident or border
/// points. Each is a list of rows x,y in a window of 10 × 10.
pub const FEW_POINTS: [&str; 7] = [
    "",
    "5,5\n",
    "5,5\n9,9\n",
    "5,5\n9,9\n3,1\n",
    "1,1\n2,2\n3,3\n4,4\n",
    "5,5\n5,5\n5,5\n5,5\n",
    "0,0\n10,0\n0,10\n",
];

/// Returns the path of a folder of the shared data. If the folder is missing, prints that the test
/// is skipped and returns `None`.
pub fn shared(folder: &str, what: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared").join(folder);
    if path.is_dir() {
        return Some(path);
    }
    println!("SKIPPED {what}: ../shared is not here");
    None
}

/// Returns the path of a Python with OpenCV, which runs scripts; `None` if there is none. The
/// Python that the environment variable CONEMOSAIC_PYTHON names must exist.
pub fn python() -> Option<PathBuf> {
    if let Some(python) = std::env::var_os("CONEMOSAIC_PYTHON").filter(|p| !p.is_empty()) {
        return Some(python.into());
    }
    let usual = Path::new(env!("CARGO_MANIFEST_DIR")).join(".venv/bin/python");
    usual.exists().then_some(usual)
}

/// Runs one of the project's scripts to its end.
pub fn run_script(python: &Path, script: &str, arguments: &[&std::ffi::OsStr]) {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts").join(script);
    let done = Command::new(python).arg(script).args(arguments).output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

/// Returns the Dice coefficient of detections in an image against marks.
pub fn dice(found: &Detections, marks: &[Point], image: &Plane) -> f64 {
    validate(marks, &found.centres(), image.ncols(), image.nrows(), &MatchOptions::default())
        .unwrap()
        .0
        .rates
        .dice
}

pub fn number(row: &BTreeMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap_or_else(|_| panic!("{column}: {:?}", row.get(column)))
}

/// Returns a simulated image of a preset whose options `change` has altered, and the hexagonal
/// spacing of all its cones in px.
pub fn of_preset(preset: &str, seed: u64, change: impl FnOnce(&mut RenderOptions)) -> (Plane, f64) {
    let (mosaic, mut options) = PRESETS.iter().find(|p| p.name == preset).unwrap().options();
    change(&mut options);
    let simulated = simulate(&mosaic, &options, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
    let true_spacing = hexagonal_spacing(simulated.cones.len(), simulated.image.len() as f64).unwrap();
    (simulated.image, true_spacing)
}

/// Returns the image badly exposed: the darkest pixels (the fraction `black` of all) are made
/// black, and the brightest (the fraction `white`) are made white.
pub fn exposed(image: &Plane, black: f64, white: f64) -> Plane {
    let mut values: Vec<f32> = image.iter().copied().collect();
    values.sort_by(f32::total_cmp);
    let at = |part: f64| values[(part * (values.len() - 1) as f64) as usize];
    let (low, high) = (if black > 0. { at(black) } else { 0. }, at(1. - white));
    image.mapv(|v| ((v - low) / (high - low)).clamp(0., 1.))
}
