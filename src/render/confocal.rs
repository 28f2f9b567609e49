//! Confocal images: cones and rods as spots of light that interfere in part.
//!
//! 1. Each cone or rod makes a spot of light: the point-spread function, with a random phase.
//! 2. The spots are added up twice: as intensities, as if no light interfered, and as complex
//!    amplitudes, as if all of it did. The signal is a mixture of both sums.
//! 3. Haze, which is light that comes from no cone, is added.
//!
//! Intensities are relative to the peak of an average cone.

use super::field::{normal, smooth, texture};
use super::psf::{AIRY_CUT, airy_amplitude};
use super::rods::Rod;
use super::spacing::CellSizes;
use super::{PointSpread, RenderOptions};
use crate::geometry::Point;
use crate::image::Plane;
use rand::{Rng, RngExt};
use std::f64::consts::TAU;
use std::ops::Range;

/// Fraction of the light of neighbouring spots that interferes; the intensities of the remaining
/// light add up.
const COHERENCE: f64 = 0.35;
/// Full width at half maximum of a Gaussian divided by its standard deviation: 2 √(2 ln 2).
const WIDTH_PER_SIGMA: f64 = 2.354_820_045;
/// Distance at which a Gaussian spot is cut off, in standard deviations of its intensity. The
/// intensity there is e⁻⁸, 0.03 % of the peak.
const CUT: f64 = 4.;
/// Full width at half maximum of a rod's spot, divided by the typical distance between rods.
const ROD: f64 = 0.6;
/// Full width at half maximum of each small peak of a multimodal cone, in widths of an ordinary
/// cone's spot.
const PEAK: f64 = 0.45;
/// Distance between the small peaks of a multimodal cone and its centre, in widths of an ordinary
/// cone's spot. It is multiplied by a random factor from 0.6 to 1.2.
const PEAK_OFFSET: f64 = 0.4;

/// Draws cones and rods as waveguides that send light back through a point-spread function.
///
/// The result is 0 where there is no light, and 1 is the peak of an average cone. `heights` are the
/// peaks of the cones. Light of neighbours interferes in part, with random phases, which joins or
/// separates their spots.
pub(super) fn signal(
    points: &[Point],
    cells: &CellSizes,
    heights: &[f64],
    rods: &[Rod],
    options: &RenderOptions,
    rng: &mut dyn Rng,
) -> Plane {
    let mut light = Light::dark(options);
    for ((&p, &spacing), &peak) in points.iter().zip(&cells.spacing).zip(heights) {
        let cv = options.size_scatter;
        // At the default scatter of 0.06, sizes stay from 0.7 to 1.3 times the mean. Even at the
        // largest scatter no size falls below 0.3, as a width must be positive.
        let scatter = (1. + cv * normal(rng)).clamp((1. - 5. * cv).max(0.3), 1. + 5. * cv);
        let width = options.diameter * spacing * scatter;
        let phase = rng.random_range(0. ..TAU);
        if options.multimodal > 0. && rng.random::<f64>() < options.multimodal {
            light.add_peaks(p, width, peak, rng);
        } else {
            light.add_spot(p, width, peak, phase);
        }
    }
    for rod in rods {
        light.add_spot(rod.centre, ROD * rod.pitch, rod.height, rng.random_range(0. ..TAU));
    }
    let mut intensity = light.seen();
    if options.texture > 0. {
        // A square is never negative, as haze can only add light.
        let haze = texture(options.width, options.height, 0.2 * cells.typical, rng);
        let haze = smooth(&haze.mapv(|v| v * v), 0.15 * cells.typical);
        let strength = options.texture as f32;
        intensity.zip_mut_with(&haze, |sum, &v| *sum += strength * v);
    }
    intensity
}

/// Light of many spots, added up as intensity and as complex amplitude.
struct Light {
    psf: PointSpread,
    /// Sum of the intensities, in peaks of an average cone.
    intensity: Plane,
    /// Real part of the sum of the amplitudes.
    real: Plane,
    /// Imaginary part of the sum of the amplitudes.
    imaginary: Plane,
}

impl Light {
    fn dark(options: &RenderOptions) -> Self {
        let plane = || Plane::zeros((options.height, options.width));
        Self { psf: options.psf, intensity: plane(), real: plane(), imaginary: plane() }
    }

    /// Adds a spot at `p` with a full width at half maximum of `width` px and the peak intensity
    /// `peak`.
    ///
    /// `phase` is the phase of the spot's light, in radians.
    fn add_spot(&mut self, p: Point, width: f64, peak: f64, phase: f64) {
        let (sin, cos) = phase.sin_cos();
        let amplitude = peak.sqrt();
        let reach = match self.psf {
            PointSpread::Gaussian => CUT * width / WIDTH_PER_SIGMA,
            PointSpread::Airy => AIRY_CUT * width,
        };
        let (rows_in_all, columns_in_all) = self.intensity.dim();
        let (Some(columns), Some(rows)) = (span(p.x, reach, columns_in_all), span(p.y, reach, rows_in_all))
        else {
            return;
        };
        let mut add = |y: usize, x: usize, a: f64| {
            self.intensity[[y, x]] += (a * a) as f32;
            self.real[[y, x]] += (a * cos) as f32;
            self.imaginary[[y, x]] += (a * sin) as f32;
        };
        match self.psf {
            PointSpread::Gaussian => {
                let sigma = width / WIDTH_PER_SIGMA;
                // The amplitude of a spot is the square root of its intensity, so its variance is
                // twice as large.
                let profile = |range: Range<usize>, centre: f64| -> Vec<f64> {
                    range.map(|i| (-((i as f64 - centre) / sigma).powi(2) / 4.).exp()).collect()
                };
                let (across, down) = (profile(columns.clone(), p.x), profile(rows.clone(), p.y));
                for (y, v) in rows.zip(&down) {
                    for (x, u) in columns.clone().zip(&across) {
                        add(y, x, amplitude * u * v);
                    }
                }
            }
            PointSpread::Airy => {
                for y in rows {
                    for x in columns.clone() {
                        let distance = (x as f64 - p.x).hypot(y as f64 - p.y) / width;
                        add(y, x, amplitude * airy_amplitude(distance));
                    }
                }
            }
        }
    }

    /// Adds two to four small peaks within a cone instead of one spot, as wide cones guide several
    /// modes.
    ///
    /// `width` and `peak` are those of the spot that an ordinary cone would have.
    fn add_peaks(&mut self, p: Point, width: f64, peak: f64, rng: &mut dyn Rng) {
        let count = rng.random_range(2..=4);
        let turn = rng.random_range(0. ..TAU);
        for k in 0..count {
            // The peaks lie in roughly equal directions from each other; angles, distances and
            // peaks scatter.
            let angle = turn + TAU * f64::from(k) / f64::from(count) + 0.3 * normal(rng);
            let offset = PEAK_OFFSET * width * rng.random_range(0.6..1.2);
            let at = Point::new(p.x + offset * angle.cos(), p.y + offset * angle.sin());
            let part = rng.random_range(0.4..1.2);
            self.add_spot(at, PEAK * width, part * peak, rng.random_range(0. ..TAU));
        }
    }

    /// Returns the intensity that a detector sees: a mixture of the summed intensities and the
    /// squared modulus of the summed amplitudes.
    fn seen(mut self) -> Plane {
        let coherence = COHERENCE as f32;
        let (real, imaginary) = (&self.real, &self.imaginary);
        ndarray::Zip::from(&mut self.intensity).and(real).and(imaginary).for_each(|sum, &re, &im| {
            *sum = (1. - coherence) * *sum + coherence * (re * re + im * im);
        });
        self.intensity
    }
}

/// Returns the pixels along an axis that are at most `reach` px from `centre`, or `None` if there
/// are none.
///
/// `side` is the number of pixels along the axis.
pub(super) fn span(centre: f64, reach: f64, side: usize) -> Option<Range<usize>> {
    let first = (centre - reach).ceil().max(0.);
    let last = (centre + reach).floor().min(side as f64 - 1.);
    (first <= last).then(|| first as usize..last as usize + 1)
}
