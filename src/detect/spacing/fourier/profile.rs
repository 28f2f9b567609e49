//! Radial profile of the power spectrum of a square tile.
//!
//! 1. Subtract the mean of the tile, multiply by a Hann window along both axes, and pad with zeros.
//! 2. Average the logarithm of the power of the transform over angle, in sectors.
//!
//! The logarithm comes before the mean, so that a few strong terms do not dominate it.

use crate::image::{Plane, Spectrum, crop, fast_length, signed_frequency};

/// Factor by which tiles are padded with zeros: the side of the transform is at least this multiple
/// of the side of the tile.
///
/// The spectrum is thereby also computed halfway between the tile's own frequencies.
const PADDING: usize = 2;
/// Power to which lower values are raised, as a fraction of the mean power of all terms, because a
/// power of 0 has no logarithm.
const FLOOR: f32 = 1e-12;

/// Directions of the spectrum over which the power is averaged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sector {
    /// All directions of the spectrum.
    #[default]
    All,
    /// Directions within 45° of the y axis: waves that run up and down, from row to row of cones.
    Row,
    /// Directions within 45° of the x axis: waves that run sideways, from cell to cell of a row.
    Cell,
}

impl Sector {
    /// All sectors, in the order in which profiles are stored.
    pub(super) const ALL: [Self; 3] = [Self::All, Self::Row, Self::Cell];

    /// Returns the fraction of all directions that the sector covers.
    pub(super) const fn part(self) -> f64 {
        match self {
            Self::All => 1.,
            Self::Row | Self::Cell => 0.5,
        }
    }
}

/// Mean decimal logarithms of the power in each of the three sectors, at radii of 0, 1, 2 … cycles
/// per side of the transform.
pub(super) type Profile = [Vec<f64>; 3];

/// One term of the Fourier transform, and how it is shared among radii and sectors.
struct Term {
    /// Index in the transform's order of storage.
    index: u32,
    /// Lower of the two radii that share the term.
    radius: u16,
    /// Fraction (0–1) of the term that the upper of the two radii receives.
    upper_share: f32,
    /// `true` if the term belongs to [`Sector::Row`], `false` if it belongs to [`Sector::Cell`].
    row: bool,
    /// Number of terms of the full spectrum that this term stands for: 2 if its mirror image is not
    /// stored, otherwise 1.
    weight: f32,
}

/// Prepared transform of square tiles of one size to spectra in polar coordinates.
pub(super) struct Polar {
    /// Side of a tile in px.
    pub side: usize,
    /// Side of the transform in px.
    pub size: usize,
    /// Hann window along a side of the tile.
    taper: Vec<f32>,
    /// Terms of the transform with a frequency below half a cycle per px; the higher frequencies in
    /// the corners of the spectrum are left out.
    terms: Vec<Term>,
    /// Weights of the terms, summed at each radius and in each sector; sums of logarithms are
    /// divided by them to give means.
    weights: Profile,
}

impl Polar {
    /// Prepares the transform of tiles of `side` px.
    pub fn new(side: usize) -> Self {
        let size = fast_length(PADDING * side);
        let radii = size / 2 + 1;
        let mut terms = Vec::new();
        for kx in 0..=size / 2 {
            for ky in 0..size {
                let fy = f64::from(signed_frequency(ky, size)) * size as f64;
                // the frequency in cycles per side of the transform
                let radius = fy.hypot(kx as f64);
                if radius + 1. >= radii as f64 {
                    continue;
                }
                // a radius between two whole numbers is shared by both; the cast keeps the lower
                // one
                terms.push(Term {
                    index: (kx * size + ky) as u32,
                    radius: radius as u16,
                    upper_share: radius.fract() as f32,
                    row: fy.abs() > kx as f64,
                    // the half with fx < 0 is not stored: it mirrors this one
                    weight: if kx == 0 || 2 * kx == size { 1. } else { 2. },
                });
            }
        }
        let weights = summed(&terms, radii, |_| 1.);
        // a Hann window without the zeros at its ends
        let step = std::f64::consts::TAU / (side + 1) as f64;
        let taper = (1..=side).map(|k| (0.5 - 0.5 * (step * k as f64).cos()) as f32).collect();
        Self { side, size, taper, terms, weights }
    }

    /// Returns the profile of the tile of `image` that begins in column `left` and row `top`.
    pub fn profile(&self, image: &Plane, top: usize, left: usize) -> Profile {
        let mut tile = crop(image, top, left, self.side, self.side);
        let mean = (tile.iter().map(|v| f64::from(*v)).sum::<f64>() / tile.len() as f64) as f32;
        for (mut row, down) in tile.rows_mut().into_iter().zip(&self.taper) {
            row.iter_mut().zip(&self.taper).for_each(|(v, across)| *v = (*v - mean) * down * across);
        }
        let power: Vec<f32> = Spectrum::forward(&tile, self.size, self.size).power().collect();
        let floor = (FLOOR * power.iter().sum::<f32>() / power.len() as f32).max(f32::MIN_POSITIVE);
        let mut profile =
            summed(&self.terms, self.size / 2 + 1, |t| power[t.index as usize].max(floor).log10());
        for (sums, weights) in profile.iter_mut().zip(&self.weights) {
            // if a sector has no term near a radius, its sum and its weight are 0: the mean is then
            // 0, not 0 / 0
            sums.iter_mut().zip(weights).for_each(|(sum, weight)| *sum /= weight.max(1e-9));
        }
        profile
    }
}

/// Returns the sums of `value` over the terms, by radius and sector.
fn summed(terms: &[Term], radii: usize, value: impl Fn(&Term) -> f32) -> Profile {
    let mut sums = [vec![0.; radii], vec![0.; radii], vec![0.; radii]];
    for term in terms {
        let sector = if term.row { Sector::Row } else { Sector::Cell };
        let value = value(term) * term.weight;
        let (below, upper) = (usize::from(term.radius), f64::from(value * term.upper_share));
        for kind in [Sector::All, sector] {
            sums[kind as usize][below] += f64::from(value) - upper;
            sums[kind as usize][below + 1] += upper;
        }
    }
    sums
}

/// Returns the mean of `profiles`, or `None` if `profiles` is empty.
pub(super) fn mean(profiles: &[Profile]) -> Option<Profile> {
    let (first, others) = profiles.split_first()?;
    let mut mean = first.clone();
    for other in others {
        mean.iter_mut().flatten().zip(other.iter().flatten()).for_each(|(sum, value)| *sum += value);
    }
    mean.iter_mut().flatten().for_each(|v| *v /= profiles.len() as f64);
    Some(mean)
}
