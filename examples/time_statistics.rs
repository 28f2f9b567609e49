//! Times statistics of a point pattern, without the time for reading files. `scripts/bench-stats`
//! compares the times with those of other programs.
//!
//!     time_statistics POINTS.csv ROUNDS THREADS R_MAX ROWS
//!
//! POINTS.csv has the columns x and y, in the unit square. K, g and the other functions are
//! computed at ROWS distances up to R_MAX. Prints CSV: statistic, round, seconds.

use conemosaic::geometry::{Point, Window};
use conemosaic::mosaic::{LengthUnit, Mosaic};
use conemosaic::stats::{
    EdgeCorrection, FunctionOptions, MeasureOptions, PcfOptions, functions, measure, nearest_neighbours, pcf,
    ripley_k,
};
use std::hint::black_box;
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, rounds, threads, r_max, rows] = &arguments[..] else {
        return Err("usage: time_statistics POINTS.csv ROUNDS THREADS R_MAX ROWS".into());
    };
    let (r_max, rows): (f64, usize) = (r_max.parse()?, rows.parse()?);
    rayon::ThreadPoolBuilder::new().num_threads(threads.parse()?).build_global()?;
    let points = std::fs::read_to_string(file)?
        .lines()
        .skip(1)
        .map(|line| {
            let (x, y) = line.split_once(',').ok_or("expected x,y")?;
            Ok(Point::new(x.parse()?, y.parse()?))
        })
        .collect::<Result<Vec<Point>, Failure>>()?;
    let window = Window::unit_square();
    let (mosaic, _) = Mosaic::new(points.clone(), window.clone(), LengthUnit::Unit, None)?;
    let r_step = r_max / (rows.max(2) - 1) as f64;
    let distances = FunctionOptions { r_step: Some(r_step), r_max: Some(r_max) };
    let spacing = mosaic.hexagonal_spacing().ok_or("no points")?;
    let smoothed = |edge| PcfOptions { r_max: r_max / spacing, bins: rows, edge, ..PcfOptions::default() };
    for round in 0..rounds.parse()? {
        let timed = |statistic: &str, work: &dyn Fn() -> Result<(), Failure>| -> Result<(), Failure> {
            let started = Instant::now();
            work()?;
            println!("\"{statistic}\",{round},{}", started.elapsed().as_secs_f64());
            Ok(())
        };
        timed("K", &|| {
            black_box(ripley_k(&points, &window, &distances)?);
            Ok(())
        })?;
        timed("g", &|| {
            for edge in [EdgeCorrection::Translation, EdgeCorrection::Isotropic] {
                black_box(pcf(&points, &window, &smoothed(edge))?);
            }
            Ok(())
        })?;
        timed("G, F, J, K, g", &|| {
            let nearest = nearest_neighbours(&points, &window);
            black_box(functions(&points, &window, &nearest, &distances)?.columns());
            Ok(())
        })?;
        timed("everything", &|| {
            let measures = measure(&mosaic, &MeasureOptions::default());
            let found = functions(&points, &window, &measures.neighbours, &FunctionOptions::default())?;
            black_box((measures.borders.len(), found.columns()));
            Ok(())
        })?;
    }
    Ok(())
}
