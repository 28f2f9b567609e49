use crate::image::{Plane, Spectrum, crop, fast_length, signed_frequency};

/// Terms of the transform per term that a tile has of its own: zeros behind the tile interpolate the spectrum.
const PADDING: usize = 2;
/// Power below this part of the mean counts as this part: a term without any has no logarithm.
const FLOOR: f32 = 1e-12;

/// Which directions of the spectrum are averaged over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sector {
    /// All of them.
    #[default]
    All,
    /// The upper and lower 90°: waves that run up and down, from row to row of cones.
    Row,
    /// The left and right 90°: waves that run sideways, from cell to cell of a row.
    Cell,
}

impl Sector {
    /// Every sector, in the order in which profiles are stored.
    pub(super) const ALL: [Self; 3] = [Self::All, Self::Row, Self::Cell];

    /// Which part of all directions it is.
    pub(super) const fn part(self) -> f64 {
        match self {
            Self::All => 1.,
            Self::Row | Self::Cell => 0.5,
        }
    }
}

/// Mean decimal logarithm of power at every radius, a cycle per `size` px apart, in the three sectors.
pub(super) type Profile = [Vec<f64>; 3];

/// One term of the transform: where it lies, which two radii share it and how, and whether it is of the row sector.
struct Term {
    index: u32,
    radius: u16,
    upper_share: f32,
    row: bool,
    weight: f32,
}

/// The spectrum of square tiles of one size in polar coordinates.
pub(super) struct Polar {
    pub side: usize,
    /// Side of the transform, px.
    pub size: usize,
    taper: Vec<f32>,
    terms: Vec<Term>,
    /// Weight of each radius in each sector.
    weights: Profile,
}

impl Polar {
    /// For tiles of `side` px.
    pub fn new(side: usize) -> Self {
        let size = fast_length(PADDING * side);
        let radii = size / 2 + 1;
        let mut terms = Vec::new();
        for kx in 0..=size / 2 {
            for ky in 0..size {
                let fy = f64::from(signed_frequency(ky, size)) * size as f64;
                let radius = fy.hypot(kx as f64);
                if radius + 1. >= radii as f64 {
                    continue;
                }
                terms.push(Term {
                    index: (kx * size + ky) as u32,
                    radius: radius as u16,
                    upper_share: radius.fract() as f32,
                    row: fy.abs() > kx as f64,
                    // the half with fx < 0 mirrors this one
                    weight: if kx == 0 || 2 * kx == size { 1. } else { 2. },
                });
            }
        }
        let weights = summed(&terms, radii, |_| 1.);
        let step = std::f64::consts::TAU / (side + 1) as f64;
        let taper = (1..=side).map(|k| (0.5 - 0.5 * (step * k as f64).cos()) as f32).collect();
        Self { side, size, taper, terms, weights }
    }

    /// The profile of the tile of an image whose first pixel is (`left`, `top`): less its mean, under a Hann window along either
    /// axis, continued by zeros to twice its size. The logarithm is taken before the mean, so that a few strong terms do not
    /// rule it.
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
            // radii of a sector between whose terms it has none
            sums.iter_mut().zip(weights).for_each(|(sum, weight)| *sum /= weight.max(1e-9));
        }
        profile
    }
}

/// Sums over terms, by radius and sector.
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

/// The mean of profiles; `None` without any.
pub(super) fn mean(profiles: &[Profile]) -> Option<Profile> {
    let (first, others) = profiles.split_first()?;
    let mut mean = first.clone();
    for other in others {
        mean.iter_mut().flatten().zip(other.iter().flatten()).for_each(|(sum, value)| *sum += value);
    }
    mean.iter_mut().flatten().for_each(|v| *v /= profiles.len() as f64);
    Some(mean)
}
