//! The density recovery profile, compared with that of another program for the points in
//! `../shared/oracle/metrics`.

use conemosaic::geometry::{Point, Window};
use conemosaic::stats::{BinWidth, DensityRecoveryOptions, density_recovery};
use std::path::PathBuf;

fn points(name: &str) -> Option<Vec<Point>> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/oracle/metrics").join(name);
    if !path.exists() {
        println!("SKIPPED {name}: ../shared is not here");
        return None;
    }
    let mut reader = csv::Reader::from_path(path).unwrap();
    let points: Vec<(f64, f64)> = reader.deserialize().map(Result::unwrap).collect();
    Some(points.into_iter().map(|(x, y)| Point::new(x, y)).collect())
}

#[test]
fn radius_packing_and_reliability_have_every_printed_digit() {
    let expected = [
        ("m1_confocal", ["7.754853", "0.520808", "2.685268"]),
        ("m3_confocal", ["6.201489", "0.577304", "4.654464"]),
    ];
    for (mosaic, expected) in expected {
        let Some(points) = points(&format!("{mosaic}.points.csv")) else { return };
        let window = Window::rectangle(0.5, 0.5, 150.5, 150.5).unwrap();
        let options = DensityRecoveryOptions { bin_width: BinWidth::Length(1.01), ..Default::default() };
        let found = density_recovery(&points, &window, &options).unwrap();
        let printed = [found.effective_radius.unwrap(), found.packing.unwrap(), found.reliability];
        assert_eq!(printed.map(|v| format!("{v:.6}")), expected, "{mosaic}");
    }
}
