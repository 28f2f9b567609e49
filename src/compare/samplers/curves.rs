use super::CompareError;
use crate::geometry::{Point, Window};
use crate::sample::Sampler;
use crate::stats::{Pcf, PcfOptions, StatsError, pcf_on_one_thread};
use rand::Rng;

/// About `n` points of a sampler, or an error that names it.
pub(crate) fn draw(
    sampler: &dyn Sampler,
    n: usize,
    window: &Window,
    rng: &mut dyn Rng,
) -> Result<Vec<Point>, CompareError> {
    let named = |source| CompareError::Sample { sampler: sampler.name().to_owned(), source };
    sampler.sample(n, window, rng).map_err(named)
}

/// The pair correlation function of a sampler's points, on this thread, or an error that names it.
pub(crate) fn curve(
    sampler: &dyn Sampler,
    points: &[Point],
    window: &Window,
    options: &PcfOptions,
) -> Result<Pcf, CompareError> {
    pcf_on_one_thread(points, window, options).map_err(of_sampler(sampler.name()))
}

/// The error of a statistic, with the name of the sampler whose points it is of.
pub(crate) fn of_sampler(name: &str) -> impl Fn(StatsError) -> CompareError {
    move |source| CompareError::Stats { sampler: name.to_owned(), source }
}

/// Mean of curves on one grid; `None` without curves.
pub fn mean_curve(curves: &[&Pcf]) -> Option<Pcf> {
    let first = *curves.first()?;
    let mean = |bin: usize| curves.iter().filter_map(|c| c.g.get(bin)).sum::<f64>() / curves.len() as f64;
    Some(Pcf { g: (0..first.g.len()).map(mean).collect(), ..first.clone() })
}
