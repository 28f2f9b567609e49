//! The option `--model`: detection with a network of the user's own.

use crate::common::Place;
use std::fs;

/// Path of the weights of the program's own network for confocal images.
const CONFOCAL: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/src/detect/learned/confocal.safetensors");

/// Makes a folder with an image and a copy of the program's own weights.
fn place() -> Place {
    let place = Place::new();
    place.image("in/a.png", 1);
    place.write("own.safetensors", fs::read(CONFOCAL).unwrap());
    place
}

/// Returns the program's weights with a lower threshold in their header.
fn lenient() -> Vec<u8> {
    let mut bytes = fs::read(CONFOCAL).unwrap();
    let key = br#""threshold": "-"#;
    let digit = bytes.windows(key.len()).position(|w| w == key).unwrap() + key.len();
    bytes[digit] = b'4';
    bytes
}

#[test]
fn the_programs_weights_as_a_file_find_the_same_cones() {
    let place = place();
    place.ok(&["detect", "in", "--out", "with", "--modality", "confocal", "--model", "own.safetensors"]);
    place.ok(&["detect", "in", "--out", "without", "--modality", "confocal"]);
    assert_eq!(place.files("with"), place.files("without"));
    place.write("own.safetensors", lenient());
    place.ok(&["detect", "in", "--out", "lenient", "--modality", "confocal", "--model", "own.safetensors"]);
    assert!(place.table("lenient/a.csv").len() > place.table("with/a.csv").len());
}

#[test]
fn results_are_kept_as_long_as_the_models_bytes_are_the_same() {
    let place = place();
    let run = |model: &str| {
        let arguments = ["run", "in", "--out", "out", "--samplers", "jittered", "--resume", "--model", model];
        place.ok(&arguments).stdout.contains("1 kept from an earlier run")
    };
    assert!(!run("own.safetensors"));
    place.copy("own.safetensors", "moved.safetensors");
    assert!(run("moved.safetensors"));
    place.write("own.safetensors", lenient());
    assert!(!run("own.safetensors"));
}

#[test]
fn models_that_cannot_be_used_are_refused_by_name() {
    let place = place();
    place.write("notes.txt", "a model?");
    place.write("cut.safetensors", &fs::read(CONFOCAL).unwrap()[..900]);
    place.write("own.onnx", [8, 8, 18, 0]);
    let refused = |more: &[&str]| place.refused(&[&["detect", "in", "--out", "out"], more].concat());
    for file in ["missing.onnx", "notes.txt", "cut.safetensors", "own.onnx"] {
        let said = refused(&["--model", file]);
        assert!(said.contains(file), "{said}");
    }
    if !cfg!(feature = "onnx") {
        assert!(refused(&["--model", "own.onnx"]).contains("--features onnx"));
    }
    assert!(refused(&["--model", "own.safetensors", "--detector", "classical"]).contains("classical"));
    let said = refused(&["--model", "own.safetensors", "--modality", "split"]);
    assert!(said.contains("own.safetensors") && said.contains("confocal"), "{said}");
    assert!(!place.path("out").exists());
}
