//! Noise of photons and of the detector, correlated between pixels as the registration of frames
//! correlates it.

use super::RenderOptions;
use super::field::{normal, smooth, smoothed_deviation};
use crate::image::Plane;
use rand::Rng;
use rand_distr::{Distribution, Poisson};

/// Smallest mean number of photons for which a normal deviate replaces the Poisson deviate, which
/// is slower to draw. The skewness of the Poisson distribution is then at most 0.1.
const MANY_PHOTONS: f64 = 100.;

/// Adds photon and detector noise, smoothed as registration smooths it.
///
/// Let q be `options.photons`, the share of photon noise in the variance `options.noise`² at
/// mid-grey (v = ½). One photon makes p = 2 q noise² of the full range of grey, so a pixel of grey
/// value v gets Poisson(v/p) · p. The variance of that is p v, which is q noise² at mid-grey.
pub(super) fn add(image: &mut Plane, options: &RenderOptions, rng: &mut dyn Rng) {
    if options.noise == 0. {
        return;
    }
    let photon = 2. * options.photons * options.noise * options.noise;
    let detector = options.noise * (1. - options.photons).sqrt();
    let noise = image.mapv(|value| {
        let value = f64::from(value).max(0.);
        let photons = if photon > 0. { photon * deviation_of_photons(value / photon, rng) } else { 0. };
        (photons + detector * normal(rng)) as f32
    });
    let noise = smooth(&noise, options.grain);
    let gain = 1. / smoothed_deviation(options.grain) as f32;
    image.zip_mut_with(&noise, |value, &n| *value += gain * n);
}

/// Draws a Poisson deviate of mean `mean` and returns its difference from the mean.
fn deviation_of_photons(mean: f64, rng: &mut dyn Rng) -> f64 {
    if mean >= MANY_PHOTONS {
        return mean.sqrt() * normal(rng);
    }
    match Poisson::new(mean) {
        Ok(poisson) => poisson.sample(rng) - mean,
        // The distribution needs a positive mean: without light there are no photons.
        Err(_) => 0.,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn deviation(grey: f32, options: &RenderOptions) -> f64 {
        let mut image = Plane::from_elem((200, 200), grey);
        add(&mut image, options, &mut ChaCha8Rng::seed_from_u64(1));
        let mean = image.iter().map(|&v| f64::from(v)).sum::<f64>() / image.len() as f64;
        assert!((mean - f64::from(grey)).abs() < 0.01, "{mean}");
        (image.iter().map(|&v| (f64::from(v) - mean).powi(2)).sum::<f64>() / image.len() as f64).sqrt()
    }

    #[test]
    fn noise_at_mid_grey_is_what_the_option_says_whatever_its_grain() {
        for grain in [0., 0.8, 2.] {
            for noise in [0.01, 0.2] {
                let options = RenderOptions { noise, grain, ..RenderOptions::default() };
                let found = deviation(0.5, &options);
                assert!((found / noise - 1.).abs() < 0.06, "grain {grain}: {found} for {noise}");
            }
        }
    }

    #[test]
    fn brighter_pixels_have_more_noise() {
        let options = RenderOptions { noise: 0.05, grain: 0., ..RenderOptions::default() };
        let variance = |grey| (deviation(grey, &options) / 0.05).powi(2);
        assert!((variance(0.) - 0.5).abs() < 0.05);
        assert!((variance(1.) - 1.5).abs() < 0.1);
    }
}
