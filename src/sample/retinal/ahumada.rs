//! Cone mosaic as discs packed outward from a centre, after Ahumada and Poirson (1987).
//!
//! 1. Put a disc of random radius in the centre, and another one that touches it.
//! 2. Keep a queue of pockets, the nearest to the centre first. A pocket is a position at which a
//!    further disc would touch two discs.
//! 3. Put the next disc into the first pocket if it fits there; otherwise drop the pocket. Repeat
//!    until the window is full.
//! 4. Displace the centres at random.

use super::outward::exactly;
use super::retina::{Retina, eccentricity};
use crate::geometry::Point;
use crate::geometry::index::{HashGrid, distance};
use crate::sample::normal_deviate::{displaced, truncated};
use crate::sample::{Configure, Frame, SampleError, Sampler, Settable, Setting};
use rand::{Rng, RngExt};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::f64::consts::TAU;

/// Largest deviation of a radius from the mean, in standard deviations. Radii beyond are drawn
/// again, so that all stay positive and bounded: at the largest `radius_sd`, 0.3, the smallest is
/// 0.1.
const DEVIATIONS: f64 = 3.;
/// Approximate number of discs per squared mean radius, as random discs cover about 84 % of the
/// plane.
const DENSITY: f64 = 0.84 / std::f64::consts::PI;
/// Distance beyond the window up to which discs are packed, in mean radii, so that the edge of the
/// packing does not show.
const BEYOND: f64 = 6.;

/// Model of Ahumada and Poirson (1987): discs of random radius, one per cone, packed tightly
/// outward from the centre.
///
/// The centres of the discs are then displaced.
///
/// **Published** (the paper's abstract): each cone has a circular disc of influence; the discs are
/// packed tightly outward from the centre; the parameters are the mean radius, its standard
/// deviation, and the standard deviation of the jitter after packing; all three may vary with
/// eccentricity, and were fitted to a macaque's fovea out to 1.6°.
///
/// **Not available, so chosen here**: the fitted values and their change with eccentricity; that
/// radii are normal; that the next disc goes to the position nearest to the centre at which it
/// touches two earlier ones; and that a position where it does not fit stays empty. The defaults, a
/// standard deviation of .1 mean radii and a jitter of .07 mean diameters, give a regularity index
/// of 10, within the range of real mosaics (8 to 12). The mean radius follows from n.
///
/// **Eccentricity**: if it is set, the middle of the window lies at that distance from the fovea
/// (in mm), with the fovea to the left. The mean radius then varies as the density of human cones
/// does (Curcio et al. 1990, mean of four meridians), and n determines the size of the window. Two
/// things are chosen here: the other two parameters stay the same shares of the mean radius, and
/// packing goes outward from the middle of the window, which is the fovea at 0 mm.
///
/// Exactly n points are made. Opposite edges of a torus do not fit together, as the model has a
/// centre.
///
/// Sources: Ahumada and Poirson (1987), <https://doi.org/10.1364/JOSAA.4.001493>; Curcio et al.
/// (1990), <https://doi.org/10.1002/cne.902920402>.
#[derive(Clone, Copy, Debug)]
pub struct Ahumada {
    /// Standard deviation of the discs' radii, in mean radii.
    pub radius_sd: f64,
    /// Standard deviation of each cone's displacement in x and y after packing, in mean diameters.
    pub jitter: f64,
    /// Distance between the fovea and the middle of the window, in mm, or `None` for the same mean
    /// radius everywhere.
    pub eccentricity: Option<f64>,
}

impl Ahumada {
    /// Default setting, chosen here; see [`Ahumada`] for the reason.
    pub const DEFAULT: Self = Self { radius_sd: 0.1, jitter: 0.07, eccentricity: None };
}

impl Sampler for Ahumada {
    fn name(&self) -> &'static str {
        "ahumada"
    }

    fn about(&self) -> &'static str {
        "discs of random radius packed outward from the centre, then displaced; exactly n; no torus \
         (Ahumada & Poirson 1987)"
    }

    fn exact(&self) -> bool {
        true
    }

    fn periodic(&self) -> bool {
        false
    }

    fn settable(&self) -> Option<&dyn Configure> {
        Some(self)
    }

    fn fill(&self, n: usize, frame: &Frame, rng: &mut dyn Rng) -> Result<Vec<Point>, SampleError> {
        let retina = Retina::around(self.eccentricity, DENSITY);
        exactly(n, frame, DENSITY, self.name(), |half| {
            let beyond = BEYOND * retina.largest(half);
            let discs = self.pack(half.map(|side| side + beyond), &retina, rng);
            let jitter = |centre| 2. * self.jitter * retina.size(centre);
            discs.into_iter().map(|disc| displaced(disc.centre, jitter(disc.centre), rng)).collect()
        })
    }
}

impl Settable for Ahumada {
    const SETTINGS: &'static [Setting<Self>] = &[
        Setting {
            name: "radius-sd",
            unit: "mean radii",
            range: (0., 0.3),
            whole: false,
            unset: "",
            meaning: "standard deviation of the discs' radii (chosen here)",
            get: |s| Some(s.radius_sd),
            set: |s, v| s.radius_sd = v,
        },
        Setting {
            name: "jitter",
            unit: "mean diameters",
            range: (0., 0.5),
            whole: false,
            unset: "",
            meaning: "standard deviation of each cone's displacement in x and y after packing (chosen here)",
            get: |s| Some(s.jitter),
            set: |s, v| s.jitter = v,
        },
        eccentricity(|s| s.eccentricity, |s, v| s.eccentricity = Some(v)),
    ];
}

#[derive(Clone, Copy)]
/// Disc of one cone; lengths are in mean radii in the middle of the window.
struct Disc {
    centre: [f64; 2],
    radius: f64,
}

/// Pocket between two discs that another disc could fill: distance from the centre, indices of the
/// two discs, and the side of the line between them, as the argument `left` of [`touching_both`]
/// gives it.
///
/// In a heap of pockets, the nearest to the centre comes first. The distance is kept as the bits of
/// a positive number, which sort as the numbers do.
type Pocket = Reverse<(u64, usize, usize, bool)>;

impl Ahumada {
    /// Draws the radius of a disc, in mean radii.
    fn radius(&self, rng: &mut dyn Rng) -> f64 {
        truncated(1., self.radius_sd, DEVIATIONS, rng)
    }

    /// Packs discs from the middle outward over |x| ≤ `half[0]` and |y| ≤ `half[1]`.
    ///
    /// The mean radius is 1 in the middle, and elsewhere follows `retina`.
    fn pack(&self, half: [f64; 2], retina: &Retina, rng: &mut dyn Rng) -> Vec<Disc> {
        let widest = (1. + DEVIATIONS * self.radius_sd) * retina.largest(half);
        let first = self.radius(rng);
        let mut radius = self.radius(rng);
        let (sine, cosine) = (TAU * rng.random::<f64>()).sin_cos();
        let touching = first + radius;
        let mut packing = Packing {
            discs: Vec::new(),
            // Two discs that a third can touch are at most four radii apart.
            grid: HashGrid::new(4. * widest),
            pockets: BinaryHeap::new(),
            retina,
        };
        packing.put(Disc { centre: [0., 0.], radius: first });
        packing.put(Disc { centre: [touching * cosine, touching * sine], radius });
        radius = self.radius(rng);
        while let Some(Reverse((_, a, b, side))) = packing.pockets.pop() {
            let (a, b) = (packing.discs[a], packing.discs[b]);
            // The mean radius at the pocket is taken as the average of the mean radii at the two
            // discs.
            let scaled = radius * (retina.size(a.centre) + retina.size(b.centre)) / 2.;
            let Some(centre) = touching_both(a, b, scaled, side) else {
                continue;
            };
            let inside = centre[0].abs() <= half[0] && centre[1].abs() <= half[1];
            if inside && packing.has_room(Disc { centre, radius: scaled }) {
                packing.put(Disc { centre, radius: scaled });
                radius = self.radius(rng);
            }
        }
        packing.discs
    }
}

/// Discs packed so far, and the pockets between them.
struct Packing<'a> {
    discs: Vec<Disc>,
    /// Centres of the discs, by their indices.
    grid: HashGrid,
    /// Pockets that were not tried yet, the nearest to the centre first.
    pockets: BinaryHeap<Pocket>,
    retina: &'a Retina,
}

impl Packing<'_> {
    /// Returns whether the disc overlaps no disc packed so far.
    fn has_room(&self, disc: Disc) -> bool {
        self.grid.near(disc.centre).all(|(k, centre)| {
            // The disc touches two others exactly, and rounding must not count that as overlap.
            distance(centre, disc.centre) >= (disc.radius + self.discs[k].radius) * (1. - 1e-9)
        })
    }

    /// Adds a disc, and queues its pockets with earlier discs: positions at which a third disc of
    /// the local mean radius would touch both.
    fn put(&mut self, disc: Disc) {
        let new = self.discs.len();
        let mean = self.retina.size(disc.centre);
        for (k, centre) in self.grid.near(disc.centre) {
            let other = Disc { centre, radius: self.discs[k].radius };
            for side in [false, true] {
                if let Some([x, y]) = touching_both(other, disc, mean, side) {
                    self.pockets.push(Reverse((x.hypot(y).to_bits(), k, new, side)));
                }
            }
        }
        self.discs.push(disc);
        self.grid.insert(new, disc.centre);
    }
}

/// Returns the centre of the disc of radius `radius` that touches both `a` and `b`, or `None` if no
/// such disc touches both.
///
/// There is one such disc on each side of the line from `a` to `b`; `left` chooses between them.
fn touching_both(a: Disc, b: Disc, radius: f64, left: bool) -> Option<[f64; 2]> {
    let (to_a, to_b, apart) = (a.radius + radius, b.radius + radius, distance(a.centre, b.centre));
    if apart <= 0. || apart >= to_a + to_b {
        return None;
    }
    let along = (apart * apart + to_a * to_a - to_b * to_b) / (2. * apart);
    let square = to_a * to_a - along * along;
    if square < 0. {
        return None;
    }
    let across = if left { square.sqrt() } else { -square.sqrt() };
    let [ux, uy] = [(b.centre[0] - a.centre[0]) / apart, (b.centre[1] - a.centre[1]) / apart];
    Some([a.centre[0] + along * ux - across * uy, a.centre[1] + along * uy + across * ux])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Window;
    use crate::stats::{Deviation, moments, nearest_neighbours};
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use std::sync::LazyLock;

    static EVEN: LazyLock<Retina> = LazyLock::new(|| Retina::around(None, DENSITY));

    #[test]
    fn discs_touch_two_others_and_overlap_none() {
        for radius_sd in [0., 0.05, 0.3] {
            let model = Ahumada { radius_sd, jitter: 0., eccentricity: None };
            let discs = model.pack([25., 15.], &EVEN, &mut ChaCha8Rng::seed_from_u64(1));
            for (i, a) in discs.iter().enumerate() {
                let gaps = (0..discs.len())
                    .filter(|&j| j != i)
                    .map(|j| distance(a.centre, discs[j].centre) - a.radius - discs[j].radius);
                let gaps: Vec<f64> = gaps.collect();
                assert!(gaps.iter().all(|&gap| gap > -1e-8));
                assert!(i < 2 || gaps.iter().filter(|gap| gap.abs() < 1e-8).count() >= 2);
            }
        }
    }

    #[test]
    fn packing_is_tight_and_equal_discs_make_the_triangular_lattice() {
        let covered = |radius_sd: f64| {
            let discs = Ahumada { radius_sd, jitter: 0., eccentricity: None }.pack(
                [46., 46.],
                &EVEN,
                &mut ChaCha8Rng::seed_from_u64(2),
            );
            let within = |d: &&Disc| d.centre[0].abs() <= 40. && d.centre[1].abs() <= 40.;
            let area: f64 = discs.iter().filter(within).map(|d| d.radius * d.radius / 2. * TAU).sum();
            area / 6400.
        };
        assert!((covered(0.) - 0.9069).abs() < 0.02, "{}", covered(0.));
        for radius_sd in [0.03, 0.06, 0.12, 0.3] {
            println!("radius sd {radius_sd}: {:.3} covered", covered(radius_sd));
            assert!((0.78..0.9).contains(&covered(radius_sd)), "{radius_sd}: {}", covered(radius_sd));
        }
    }

    #[test]
    fn regularity_is_that_of_real_mosaics_and_falls_with_either_deviation() {
        let window = Window::unit_square();
        let ri = |model: Ahumada| {
            let of = |seed: u64| {
                let points = model.sample(1024, &window, &mut ChaCha8Rng::seed_from_u64(seed)).unwrap();
                moments(&nearest_neighbours(&points, &window).distances, Deviation::Population).ri.unwrap()
            };
            (0..6).map(of).sum::<f64>() / 6.
        };
        let default = ri(Ahumada::DEFAULT);
        println!("{default}");
        assert!((8. ..12.).contains(&default), "{default}");
        assert!(ri(Ahumada { radius_sd: 0.2, ..Ahumada::DEFAULT }) < default);
        assert!(ri(Ahumada { jitter: 0.12, ..Ahumada::DEFAULT }) < default);
    }
}
