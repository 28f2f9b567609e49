//! Pictures of power spectra: the plane of wave vectors, one pixel per wave vector.
//!
//! 1. Large planes are divided into square blocks about the middle one.
//! 2. The power of a block is the mean over its wave vectors, except frequency 0.
//! 3. Power becomes grey on a linear or a decibel scale.

use super::grey::png;
use crate::report::ReportError;
use crate::stats::PowerSpectrum;
use image::ExtendedColorType;

/// Number of pixels along a side above which pictures are reduced by an integer factor.
const LARGEST: usize = 1024;

/// The scale by which power becomes grey.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PowerScale {
    /// Black at 0, white at 3 times the power of independent points.
    #[default]
    Linear,
    /// Black at −20 dB, white at +10 dB of the power of independent points.
    Decibel,
}

impl PowerScale {
    /// Returns the grey value of a power, where independent points have power 1.
    fn grey(self, power: f64) -> u8 {
        let share = match self {
            Self::Linear => power / 3.,
            Self::Decibel => (10. * power.log10() + 20.) / 30.,
        };
        (share.clamp(0., 1.) * 255.).round() as u8
    }
}

/// Picture of the plane of wave vectors.
pub(in crate::report) struct Plane {
    /// Grey picture, as PNG.
    pub png: Vec<u8>,
    /// Distance from the middle to the edges along x and y, in cycles per 1/√density.
    pub reach: [f64; 2],
}

/// Returns the plane of wave vectors as grey PNG, frequency 0 in the middle and black.
///
/// x points to the right and y down, with one pixel per wave vector. In large planes a pixel is the
/// mean of a square of them, so that no side has more than 1024.
///
/// # Errors
/// Fails if the encoder refuses the picture.
pub fn spectrum_plane(spectrum: &PowerSpectrum, scale: PowerScale) -> Result<Vec<u8>, ReportError> {
    plane(spectrum, scale).map(|plane| plane.png)
}

/// Returns the picture of [`spectrum_plane`] with the distances to its edges.
pub(in crate::report) fn plane(spectrum: &PowerSpectrum, scale: PowerScale) -> Result<Plane, ReportError> {
    let [columns, rows] = spectrum.highest().map(|k| k as isize);
    let block = ((2 * columns.max(rows) + 1) as usize).div_ceil(LARGEST) as isize;
    // Blocks lie symmetrically about the middle one.
    let half = |highest: isize| (2 * highest + 1 - block).max(0) / (2 * block);
    let (half_width, half_height) = (half(columns), half(rows));
    let side = (block - 1) / 2;
    let mut pixels = Vec::new();
    for y in -half_height..=half_height {
        for x in -half_width..=half_width {
            let (mut sum, mut waves) = (0., 0.);
            for ky in y * block - side..y * block - side + block {
                for kx in x * block - side..x * block - side + block {
                    if let (Some(power), false) = (spectrum.at(kx, ky), kx == 0 && ky == 0) {
                        sum += power;
                        waves += 1.;
                    }
                }
            }
            pixels.push(scale.grey(if waves > 0. { sum / waves } else { 0. }));
        }
    }
    let size = |half: isize| (2 * half + 1) as u32;
    let png = png(&pixels, size(half_width), size(half_height), ExtendedColorType::L8)?;
    let [across, down] = spectrum.wave_step();
    let reach = |half: isize, step: f64| (half as f64 + 0.5) * block as f64 * step;
    Ok(Plane { png, reach: [reach(half_width, across), reach(half_height, down)] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Window;
    use crate::sample::sampler;
    use crate::stats::{SpectrumOptions, spectrum};
    use rand::SeedableRng;

    fn picture(n: usize, name: &str, scale: PowerScale) -> image::GrayImage {
        let window = Window::unit_torus();
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let points = sampler(name).unwrap().sample(n, &window, &mut rng).unwrap();
        let power = spectrum(&points, &window, &SpectrumOptions::default()).unwrap();
        image::load_from_memory(&spectrum_plane(&power, scale).unwrap()).unwrap().to_luma8()
    }

    #[test]
    fn blue_noise_is_dark_in_the_middle_only() {
        for scale in [PowerScale::Linear, PowerScale::Decibel] {
            let picture = picture(900, "dart-throwing", scale);
            let middle = picture.width() / 2;
            assert_eq!(picture.get_pixel(middle, middle)[0], 0);
            let mean = |far: bool| {
                let chosen: Vec<f64> = picture
                    .enumerate_pixels()
                    .filter(|(x, y, _)| (x.abs_diff(middle).max(y.abs_diff(middle)) > 12) == far)
                    .map(|(_, _, p)| f64::from(p[0]))
                    .collect();
                chosen.iter().sum::<f64>() / chosen.len() as f64
            };
            assert!(mean(true) > 2. * mean(false), "{} {}", mean(true), mean(false));
        }
    }

    #[test]
    fn large_planes_are_made_smaller() {
        let picture = picture(30_000, "uniform", PowerScale::Linear);
        assert!((600..=1024).contains(&picture.width()) && picture.width() == picture.height());
    }
}
