//! Spacing from the ring that cones leave in the spectrum of an image, without detecting cones.
//!
//! The method follows Cooper, Aguirre and Morgan (2019, “Fully automated estimation of spacing and
//! density for retinal mosaics”), <https://doi.org/10.1167/tvst.8.5.26>:
//!
//! 1. The logarithm of power is averaged over all angles, or over the 90° around either axis.
//! 2. The modal frequency is where that profile rises farthest above a smooth background.
//!
//! Two things differ from the paper:
//!
//! - The background is a cubic polynomial over log-frequency, fitted together with the ring by
//!   least squares. In the paper it is two exponentials, fitted by descent from a guess, followed
//!   by a walk to the next peak.
//! - The confidence is the fraction of the variance left by the background that the ring explains.
//!   In the paper it is the height of the peak relative to the range of the residual.
//!
//! The method does not depend on the modality. The degree of the background, the width of the ring
//! and the lowest frequency were chosen among nine combinations on every third or fourth of the
//! marked images and on simulated ones. The accuracies stated for [`fourier_spacing`] are therefore
//! those of the best combination, not of images never seen.

mod map;
mod profile;
mod ring_fit;

pub use map::{FourierMap, FourierMapOptions, fourier_map};
pub use profile::Sector;

use super::SPACING_RANGE;
use crate::detect::{DetectError, check};
use crate::image::{EmptyPixels, Plane};
use profile::{Polar, Profile};
use rayon::prelude::*;
use ring_fit::RingFit;
use serde::{Deserialize, Serialize};

/// Longest side of a tile in px.
const LONGEST: usize = 512;
/// Largest number of pixels of an image whose tiles overlap.
///
/// A larger image has at least 16 tiles, whose mean is steady without overlap.
const LARGE: usize = 16 * LONGEST * LONGEST;
/// Smallest fraction of a tile that must have been imaged for the tile to be measured.
const IMAGED: f64 = 0.5;

/// Modal spacing of an image or of a part of it: the period of the waves at which its spectrum has
/// a ring.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FourierSpacing {
    /// Modal spacing 1/f in px, with f the modal frequency: the distance between neighbouring rows
    /// of a triangular lattice.
    pub row_spacing: f64,
    /// Distance, in px, between neighbouring cones in a triangular lattice whose rows are
    /// `row_spacing` apart: 2/√3 of `row_spacing`.
    ///
    /// Such a lattice has 2/(√3 spacing²) cones per px². Mosaics less regular than a lattice are
    /// denser than that.
    pub spacing: f64,
    /// Confidence, 0–1: the fraction of the profile's variance about its background that the ring
    /// explains.
    ///
    /// The amount that a ring would explain in mere noise, at three standard deviations, is
    /// subtracted first, so noise has a confidence of 0.
    pub confidence: f64,
}

/// Modal spacing of an image, measured from waves in all directions and in two sectors of
/// directions.
///
/// If a mosaic is not stretched, the three spacings agree, since the first peaks of a lattice lie
/// on one circle, whatever its orientation. In the confocal images on which [`fourier_spacing`] was
/// measured, the spacings sideways are 6.5 % wider than those up and down. The ellipse of the
/// marks' neighbours ([`crate::stats::NeighbourEllipse`]) is stretched in the same way, by 8.4 %.
///
/// A split detector shows cones by their slope in one direction; in such images, the two sectors
/// say nothing about a stretch.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FourierEstimate {
    /// Side, px, of the tiles whose spectra are averaged.
    pub side: usize,
    /// Spacing from waves in all directions, or `None` if their profile has no ring.
    pub all: Option<FourierSpacing>,
    /// Spacing from waves within 45° of the y axis, or `None` if their profile has no ring.
    pub row: Option<FourierSpacing>,
    /// Spacing from waves within 45° of the x axis, or `None` if their profile has no ring.
    pub cell: Option<FourierSpacing>,
}

/// Returns the modal spacing of an image, from the spectra of square tiles.
///
/// The spacing lies between 4 and 40 px; the row spacing is at most a fifth of the shorter side.
/// Tiles are as large as the image allows, up to 512 px, and overlap by half; beyond 4 megapixels
/// they only touch. Pixels that were not imaged are filled in. Tiles of which less than half was
/// imaged are left out, unless this is true of all tiles.
///
/// A mosaic has a ring because its patches of lattice are turned every way. A single perfect
/// lattice has six points instead. The mean of logarithms hardly shows them, so such a lattice may
/// be missed.
///
/// The accuracy is measured by `tests/it/fourier_spacing.rs` against the spacing of the lattice
/// with the density of the marks:
///
/// - Of 200 confocal images all are within 15 %, on average 3.5 % too wide (standard deviation 1.6
///   %). The ring of the marks themselves ([`modal_spacing`](crate::stats::modal_spacing)) is 3.0 %
///   too wide (1.9 %), because mosaics are no lattices.
/// - Of 184 split-detector images 84 % are within 15 % (on average −2.9 %, standard deviation 5.5
///   %), as many as by the ring of the marks.
///
/// # Errors
/// Fails if a side is below [`MIN_SIDE`](crate::detect::MIN_SIDE), if all pixels are the same, or
/// if a pixel is not a finite number.
pub fn fourier_spacing(image: &Plane) -> Result<FourierEstimate, DetectError> {
    check(image)?;
    let empty = EmptyPixels::of(image);
    let filled = empty.as_ref().map(|e| e.filled(image));
    Ok(estimate(filled.as_ref().unwrap_or(image), empty.as_ref()))
}

/// Returns the modal spacing of an image whose `empty` pixels are already filled in.
fn estimate(image: &Plane, empty: Option<&EmptyPixels>) -> FourierEstimate {
    let (height, width) = image.dim();
    let side = height.min(width).min(LONGEST);
    let polar = Polar::new(side);
    let per_side = if width * height > LARGE { 1 } else { 2 };
    let (columns, rows) = (starts(width, side, per_side), starts(height, side, per_side));
    let mut profiles = profiles(image, &polar, empty, &columns, &rows);
    if profiles.iter().all(Option::is_none) {
        profiles = self::profiles(image, &polar, None, &columns, &rows);
    }
    let known: Vec<Profile> = profiles.into_iter().flatten().collect();
    let fit = RingFit::new(side, polar.size);
    let mean = profile::mean(&known);
    let [all, row, cell] = Sector::ALL.map(|sector| {
        let (low, high) = SPACING_RANGE;
        let part = known.len() as f64 * sector.part();
        mean.as_ref().and_then(|m| fit.ring(&m[sector as usize], part, low..=high))
    });
    FourierEstimate { side, all, row, cell }
}

/// Returns the profiles of the tiles whose first pixels lie in `columns` and `rows`, row by row.
///
/// The profile of a tile is `None` if too little of the tile was imaged.
fn profiles(
    image: &Plane,
    polar: &Polar,
    empty: Option<&EmptyPixels>,
    columns: &[usize],
    rows: &[usize],
) -> Vec<Option<Profile>> {
    let side = polar.side;
    let corners: Vec<(usize, usize)> =
        rows.iter().flat_map(|&y| columns.iter().map(move |&x| (y, x))).collect();
    let profile = |&(y, x): &(usize, usize)| {
        let imaged = empty.map_or(1., |e| 1. - e.part(x, y, x + side, y + side));
        (imaged >= IMAGED).then(|| polar.profile(image, y, x))
    };
    corners.par_iter().map(profile).collect()
}

/// Returns the first pixels of tiles of `side` px that cover a length from end to end.
///
/// Neighbouring tiles begin at most `side`/`per_side` px apart.
fn starts(length: usize, side: usize, per_side: usize) -> Vec<usize> {
    let room = length.saturating_sub(side);
    let steps = room.div_ceil((side / per_side).max(1));
    (0..=steps).map(|k| k * room / steps.max(1)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::detect::Modality;
    use crate::render::{MosaicOptions, RenderOptions, simulate};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    pub(super) fn picture(mosaic: &MosaicOptions, width: usize, height: usize) -> Plane {
        let options = RenderOptions { width, height, ..RenderOptions::new(Modality::Confocal) };
        simulate(mosaic, &options, &mut ChaCha8Rng::seed_from_u64(7)).unwrap().image
    }

    #[test]
    fn the_spacing_of_an_even_mosaic_is_found_in_every_sector() {
        for spacing in [6., 9.5, 14.] {
            let mosaic = MosaicOptions { spacing, ..MosaicOptions::default() };
            let found = fourier_spacing(&picture(&mosaic, 200, 200)).unwrap();
            println!("{spacing} {found:?}");
            for ring in [found.all, found.row, found.cell].map(Option::unwrap) {
                assert!((ring.spacing / spacing - 1.).abs() < 0.1, "{spacing}: {found:?}");
                assert!((ring.row_spacing / ring.spacing - 0.75f64.sqrt()).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_stretched_mosaic_is_wider_along_its_stretch() {
        let ratio = |anisotropy: f64| {
            let found = fourier_spacing(&picture(
                &MosaicOptions { anisotropy, spacing: 9., ..MosaicOptions::default() },
                300,
                300,
            ));
            let found = found.unwrap();
            found.row.unwrap().spacing / found.cell.unwrap().spacing
        };
        let (even, tall) = (ratio(1.), ratio(1.3));
        println!("{even} {tall}");
        assert!((even - 1.).abs() < 0.04, "{even}");
        assert!(tall > 1.08 && tall < 1.3, "{tall}");
    }

    #[test]
    fn noise_has_no_ring_to_be_confident_in() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let noise = Plane::from_shape_fn((200, 200), |_| rng.random());
        let found = fourier_spacing(&noise).unwrap();
        let mosaic = fourier_spacing(&picture(&MosaicOptions::default(), 200, 200)).unwrap();
        println!("{found:?} {mosaic:?}");
        assert!(found.all.is_none_or(|r| r.confidence < 0.2), "{found:?}");
        assert!(mosaic.all.unwrap().confidence > 0.5, "{mosaic:?}");
    }

    #[test]
    fn images_of_any_shape_have_a_spacing_and_images_of_nothing_an_error() {
        for (width, height) in [(24, 24), (40, 300), (700, 90)] {
            let image = picture(&MosaicOptions { spacing: 5., ..MosaicOptions::default() }, width, height);
            let found = fourier_spacing(&image).unwrap();
            assert_eq!(found.side, width.min(height).min(512));
            if width > 24 {
                assert!((found.all.unwrap().spacing / 5. - 1.).abs() < 0.12, "{width} × {height}: {found:?}");
            }
        }
        assert!(matches!(fourier_spacing(&Plane::zeros((23, 50))), Err(DetectError::TooSmall { .. })));
        assert!(matches!(fourier_spacing(&Plane::zeros((0, 0))), Err(DetectError::TooSmall { .. })));
        assert!(matches!(fourier_spacing(&Plane::zeros((50, 50))), Err(DetectError::Constant { .. })));
        let mut broken = picture(&MosaicOptions::default(), 50, 50);
        broken[[3, 4]] = f32::NAN;
        assert!(matches!(fourier_spacing(&broken), Err(DetectError::NotFinite { x: 4, y: 3, .. })));
        // squares of such values are close to the limits of single precision
        for factor in [1e-15, 1e15] {
            let scaled = picture(&MosaicOptions::default(), 100, 100).mapv(|v| v * factor);
            assert!((fourier_spacing(&scaled).unwrap().all.unwrap().spacing / 9. - 1.).abs() < 0.15);
        }
    }

    #[test]
    fn a_black_margin_does_not_change_what_is_found() {
        let image = picture(&MosaicOptions::default(), 150, 150).mapv(|v| v.max(0.01));
        let mut framed = Plane::zeros((260, 300));
        image.indexed_iter().for_each(|((y, x), v)| framed[[y + 60, x + 120]] = *v);
        let [a, b] = [&image, &framed].map(|i| fourier_spacing(i).unwrap().all.unwrap().spacing);
        assert!((a / b - 1.).abs() < 0.04, "{a} {b}");
    }

    #[test]
    fn tiles_cover_a_side_from_end_to_end() {
        for (length, side) in [(100, 100), (101, 100), (512, 512), (1000, 130), (5, 5), (24, 24)] {
            let starts = starts(length, side, 4);
            assert_eq!((starts[0], starts[starts.len() - 1] + side), (0, length));
            assert!(starts.windows(2).all(|s| s[1] > s[0] && s[1] - s[0] <= (side / 4).max(1)));
        }
    }
}
