use super::CompareError;
use crate::geometry::{Point, Window};
use crate::sample::Sampler;
use crate::stats::{Pcf, PcfOptions, StatsError, pcf_on_one_thread};
use rand::Rng;

/// Draws about `n` points of a sampler in `window`. An error names the sampler.
pub(crate) fn draw(
    sampler: &dyn Sampler,
    n: usize,
    window: &Window,
    rng: &mut dyn Rng,
) -> Result<Vec<Point>, CompareError> {
    let named = |source| CompareError::Sample { sampler: sampler.name().to_owned(), source };
    sampler.sample(n, window, rng).map_err(named)
}

/// Computes the pair correlation function of a sampler's points on the calling thread only. An
/// error names the sampler.
pub(crate) fn curve(
    sampler: &dyn Sampler,
    points: &[Point],
    window: &Window,
    options: &PcfOptions,
) -> Result<Pcf, CompareError> {
    pcf_on_one_thread(points, window, options).map_err(of_sampler(sampler.name()))
}

/// Returns a function that adds the sampler's name to the error of a statistic.
pub(crate) fn of_sampler(name: &str) -> impl Fn(StatsError) -> CompareError {
    move |source| CompareError::Stats { sampler: name.to_owned(), source }
}

/// Averages curves that have the same distances, bin by bin. The result is `None` without curves.
pub fn mean_curve(curves: &[&Pcf]) -> Option<Pcf> {
    let first = *curves.first()?;
    let mean = |bin: usize| curves.iter().filter_map(|c| c.g.get(bin)).sum::<f64>() / curves.len() as f64;
    Some(Pcf { g: (0..first.g.len()).map(mean).collect(), ..first.clone() })
}
