//! Runs that are stopped, killed or meet another one.

use crate::common::Place;
use std::fs;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

const RUN: [&str; 8] = ["run", "in", "--out", "out", "--samplers", "none", "--threads", "1"];

/// Enough images that a run does not end before a signal reaches it.
fn many_images() -> Place {
    let place = Place::new();
    place.image_of("in/00.png", 150, 150, 1);
    (1..30).for_each(|k| place.copy("in/00.png", &format!("in/{k:02}.png")));
    place
}

/// Begins a run and returns when it has finished a few images.
fn begun(place: &Place) -> Child {
    let child = Command::new(env!("CARGO_BIN_EXE_conemosaic"))
        .current_dir(place.path(""))
        .args(RUN)
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let patience = Instant::now() + Duration::from_secs(120);
    while !place.path("out/images/02/metrics.json").exists() {
        assert!(Instant::now() < patience, "nothing is done");
        std::thread::sleep(Duration::from_millis(5));
    }
    child
}

fn send(child: &Child, signal: &str) {
    assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
}

#[test]
fn a_stopped_run_writes_tables_of_what_is_done_and_goes_on_later() {
    let place = many_images();
    for (signal, code) in [("-INT", 130), ("-TERM", 143)] {
        let child = begun(&place);
        send(&child, signal);
        let output = child.wait_with_output().unwrap();
        let said = String::from_utf8(output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(code), "{said}");
        assert!(said.contains("run the same command again to go on"), "{said}");
        let rows = place.table("out/summary.csv").len();
        assert!((3..30).contains(&rows), "{rows}");
        assert!(place.path("out/INCOMPLETE.txt").exists() && place.path("out/index.html").exists());
        fs::remove_dir_all(place.path("out/images/02")).unwrap();
    }
    place.ok(&RUN);
    assert!(!place.path("out/INCOMPLETE.txt").exists());
    assert_eq!(place.table("out/summary.csv").len(), 30);
}

#[test]
fn a_killed_run_ends_like_an_undisturbed_one_when_it_is_run_again() {
    let place = many_images();
    let mut child = begun(&place);
    // meanwhile nobody else writes there
    let complaint = place.refused(&[&RUN[..], &["-q"]].concat());
    assert!(complaint.contains("another run is writing") && complaint.contains("--out"), "{complaint}");
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(place.path("out/INCOMPLETE.txt").exists());
    // what a kill between two steps leaves
    place.write("out/.conemosaic-1-1.tmp", "half");
    place.write("out/images/.01.partial/points.csv", "half");
    fs::rename(place.path("out/images/00"), place.path("out/images/.00.old")).unwrap();
    place.ok(&RUN);
    let mut undisturbed = RUN;
    undisturbed[3] = "undisturbed";
    place.ok(&undisturbed);
    assert_eq!(place.results("out"), place.results("undisturbed"));
}
