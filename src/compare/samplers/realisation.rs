//! Single simulated patterns (realisations) of a sampler for a class of mosaics, and the mean curve
//! over them.

use super::curve_class::Class;
use super::{CompareError, ReferenceCurve, curve, draw, mean_curve};
use crate::mosaic::hexagonal_spacing;
use crate::sample::{SampleError, Sampler};
use crate::stats::{Deviation, Pcf, PcfOptions, moments, nearest_neighbours};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use sha2::{Digest, Sha256};

/// Pair correlation function and regularity index of one pattern of a sampler.
pub(super) struct Realisation {
    /// Pair correlation function; `None` for fewer than two points.
    pcf: Option<Pcf>,
    /// Regularity index; `None` if it is undefined or the pattern has fewer than two points.
    ri: Option<f64>,
}

/// Draws and measures pattern number `k` of a sampler for a class of mosaics.
///
/// The random generator is seeded by a hash of `seed`, the sampler's name, the class and `k`, so
/// the result does not depend on threads.
pub(super) fn realise(
    sampler: &dyn Sampler,
    class: &Class,
    k: usize,
    options: &PcfOptions,
    seed: u64,
) -> Result<Realisation, CompareError> {
    let too_thin = || CompareError::Sample {
        sampler: sampler.name().to_owned(),
        source: SampleError::TooThin { aspect: f64::INFINITY, max: f64::MAX },
    };
    let window = class.window().ok_or_else(too_thin)?;
    let mut hash = Sha256::new();
    hash.update(seed.to_le_bytes());
    // the length keeps the end of the name from being taken for the start of the next part
    hash.update((sampler.name().len() as u64).to_le_bytes());
    hash.update(sampler.name());
    hash.update(class.n.to_le_bytes());
    hash.update(class.seed());
    hash.update((k as u64).to_le_bytes());
    let mut rng = ChaCha8Rng::from_seed(hash.finalize().into());
    let points = draw(sampler, class.points(), &window, &mut rng)?;
    if points.len() < 2 {
        return Ok(Realisation { pcf: None, ri: None });
    }
    let pcf = curve(sampler, &points, &window, options)?;
    let nearest = nearest_neighbours(&points, &window);
    Ok(Realisation { pcf: Some(pcf), ri: moments(&nearest.distances, Deviation::Sample).ri })
}

/// Averages the patterns of a sampler into its reference curve. In `patterns`, `None` stands for a
/// pattern whose computation panicked. Patterns of fewer than two points are left out.
///
/// # Errors
/// Fails if the computation of any pattern failed or panicked, or if every pattern has fewer than
/// two points.
pub(super) fn average(
    sampler: &dyn Sampler,
    class: &Class,
    patterns: &[Option<Result<Realisation, CompareError>>],
) -> Result<ReferenceCurve, CompareError> {
    let interrupted = || CompareError::Interrupted { sampler: sampler.name().to_owned() };
    let whole = |pattern: &Option<Result<Realisation, CompareError>>| match pattern {
        Some(Ok(_)) => Ok(()),
        Some(Err(error)) => Err(error.clone()),
        None => Err(interrupted()),
    };
    patterns.iter().try_for_each(whole)?;
    let made: Vec<&Realisation> = patterns.iter().flatten().flatten().collect();
    let pcfs: Vec<&Pcf> = made.iter().filter_map(|p| p.pcf.as_ref()).collect();
    let n = class.points();
    let none = || CompareError::NoPattern { sampler: sampler.name().to_owned(), n };
    let mean = mean_curve(&pcfs).ok_or_else(none)?;
    let indexes: Vec<f64> = made.iter().filter_map(|p| p.ri).collect();
    Ok(ReferenceCurve {
        sampler: sampler.name().to_owned(),
        pcf: Pcf { spacing: hexagonal_spacing(n, 1.).unwrap_or(mean.spacing), ..mean },
        n,
        realisations: pcfs.len(),
        ri: moments(&indexes, Deviation::Sample).mean,
        shipped: false,
    })
}
