//! Seconds that statistics of a point pattern take, without files: `scripts/bench-stats` holds them against other programs.
//!
//!     time_statistics POINTS.csv ROUNDS THREADS
//!
//! POINTS.csv has the columns x and y, in the unit square. Prints CSV: statistic, round, seconds. `nice` work first: one round is
//! not counted by the script.

use conemosaic::geometry::{Point, Window};
use conemosaic::mosaic::{LengthUnit, Mosaic};
use conemosaic::stats::{
    FunctionOptions, MeasureOptions, PcfOptions, functions, measure, nearest_neighbours, pcf,
};
use std::hint::black_box;
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [file, rounds, threads] = &arguments[..] else {
        return Err("usage: time_statistics POINTS.csv ROUNDS THREADS".into());
    };
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
    let distances = FunctionOptions::default();
    println!("statistic,round,seconds");
    for round in 0..rounds.parse()? {
        let timed = |statistic: &str, work: &dyn Fn() -> Result<(), Failure>| -> Result<(), Failure> {
            let started = Instant::now();
            work()?;
            println!("{statistic},{round},{}", started.elapsed().as_secs_f64());
            Ok(())
        };
        timed("pcf", &|| {
            black_box(pcf(&points, &window, &PcfOptions::default())?);
            Ok(())
        })?;
        timed("functions", &|| {
            let nearest = nearest_neighbours(&points, &window);
            black_box(functions(&points, &window, &nearest, &distances)?);
            Ok(())
        })?;
        timed("measure", &|| {
            black_box(measure(&mosaic, &MeasureOptions::default()));
            Ok(())
        })?;
        timed("all", &|| {
            let measures = measure(&mosaic, &MeasureOptions::default());
            black_box(functions(&points, &window, &measures.neighbours, &distances)?);
            Ok(())
        })?;
    }
    Ok(())
}
