//! Spacing from the ring that cones leave in the spectrum of an image, without looking for cones, after Cooper, Aguirre & Morgan
//! (2019, "Fully automated estimation of spacing and density for retinal mosaics").
//!
//! As there, the logarithm of power is averaged over angle, over all of them or over 90° around either axis, and the modal frequency
//! is where it rises farthest above a smooth background. Different are the background, a cubic over log-frequency fitted
//! together with the ring by least squares (there two exponentials, by descent from a guess, then a walk to the next peak), and
//! the confidence, the share of what the background leaves that the ring explains (there the height of the peak in the range of the
//! residual). It does not depend on the modality. The degree of the background, the width of the ring and the lowest frequency were
//! chosen among nine combinations by looking at every third or fourth of the marked images and at simulated ones, so that the accuracies
//! below are those of the chosen, not of images never seen.

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

/// Longest side of a tile, px.
const LONGEST: usize = 512;
/// Images of more pixels are covered by tiles that do not overlap: the mean of so many (at least 16) is steady without.
const LARGE: usize = 16 * LONGEST * LONGEST;
/// Of a tile, at least this part must have been imaged.
const IMAGED: f64 = 0.5;

/// The modal spacing of an image, or of a part of it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FourierSpacing {
    /// Modal spacing 1/f, px, with f the modal frequency: from row to row of a triangular lattice.
    pub row_spacing: f64,
    /// From cone to cone of the triangular lattice with these rows, px: 2/√3 times as much. Such a lattice has
    /// 2/(√3 spacing²) cones per px². Mosaics less regular than a lattice are denser than that.
    pub spacing: f64,
    /// Share, 0–1, of the variance of the profile about its background that the ring explains, less what it explains of
    /// noise by three standard deviations: 0 of noise.
    pub confidence: f64,
}

/// The modal spacing of an image by the direction of the waves. In a mosaic that is not stretched the three agree, since the first
/// peaks of a lattice lie on one circle, whatever its orientation. In the confocal images below, those sideways are 6.5 % wider than
/// those up and down, and so is the ellipse of the marks' neighbours ([`crate::stats::NeighbourEllipse`]), 8.4 %. A split detector shows cones by
/// their slope in one direction: there the two say nothing of a stretch.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FourierEstimate {
    /// Side of the tiles that the spectrum is a mean over, px.
    pub side: usize,
    /// All directions; `None`, here and below, where the profile has no ring.
    pub all: Option<FourierSpacing>,
    /// Waves within 45° of the y axis.
    pub row: Option<FourierSpacing>,
    /// Waves within 45° of the x axis.
    pub cell: Option<FourierSpacing>,
}

/// Modal spacing of an image between 4 and 40 px (but at most a fifth of its shorter side from row to row), from the spectra of
/// half-overlapping square tiles that are as large as the image allows, up to 512 px (beyond 4 megapixels they only touch). Pixels that were not imaged are filled in, and
/// tiles of which more than half was not are left out unless all are.
///
/// A mosaic has a ring because its patches of lattice are turned every way. A single perfect lattice has six points instead,
/// which the mean of logarithms hardly sees: it may be missed.
///
/// Against the spacing of the lattice with the density of the marks (`tests/it/fourier_spacing.rs` measures it): of 200 confocal images
/// all are within 15 %, on average 3.5 % wider, standard deviation 1.6 %, and the ring of the marks themselves
/// ([`modal_spacing`](crate::stats::modal_spacing)) is 3.0 % wider, 1.9 %: mosaics are no lattices. Of 184 split-detector images 84 % are within 15 %
/// (−2.9 %, 5.5 %), by the ring of the marks as many.
///
/// # Errors
/// If a side is below [`MIN_SIDE`](crate::detect::MIN_SIDE), all pixels are the same, or one is not a number.
pub fn fourier_spacing(image: &Plane) -> Result<FourierEstimate, DetectError> {
    check(image)?;
    let empty = EmptyPixels::of(image);
    let filled = empty.as_ref().map(|e| e.filled(image));
    Ok(estimate(filled.as_ref().unwrap_or(image), empty.as_ref()))
}

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

/// Profiles of the tiles with their first pixels in these columns and rows, row by row; none where too little was imaged.
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

/// First pixels of tiles of `side` px that cover a length from end to end, one at least every `side`/`per_side` px.
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
        // the logarithm of the power of huge and tiny values
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
