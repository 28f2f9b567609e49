//! Density of a simulated mosaic as a function of position, and patterns bent to have that density.
//!
//! All distortions go through cumulative densities: a point moves to the position up to which the
//! integral of the wanted density equals that of the pattern.

use super::{GradientShape, MosaicOptions};
use crate::geometry::Point;
use rand::{Rng, RngExt};
use std::f64::consts::{PI, TAU};

/// Area of a cell of a triangular lattice, in squared spacings: √3/2.
const CELL: f64 = 0.866_025_403_784_438_6;
/// Number of equal steps in which a density is integrated.
const SAMPLES: usize = 2048;
/// Angle between one point of Vogel's spiral and the next, in radians: 2π divided by the square of
/// the golden ratio. Points turned by this angle spread evenly over a disc.
///
/// Source: Vogel (1979), <https://doi.org/10.1016/0025-5564(79)90080-4>.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Upright rectangle from (`x0`, `y0`) to (`x1`, `y1`), in px.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rectangle {
    pub(super) x0: f64,
    pub(super) y0: f64,
    pub(super) x1: f64,
    pub(super) y1: f64,
}

/// Density of a mosaic as a function of position.
///
/// Positions are in the isotropic frame: the image, stretched until the mosaic has the same spacing
/// along x and y.
pub(super) struct Density {
    /// Width of the isotropic frame, in px.
    pub(super) width: f64,
    /// Height of the isotropic frame, in px.
    pub(super) height: f64,
    /// Factor from x in the image to x in the isotropic frame; y is divided by it.
    stretch: f64,
    /// Hexagonal spacing in px, see [`MosaicOptions::spacing`].
    spacing: f64,
    /// Ratio of the densities at the two ends of the gradient, see [`MosaicOptions::gradient`].
    gradient: f64,
    shape: GradientShape,
}

impl Density {
    pub(super) fn of(options: &MosaicOptions) -> Self {
        let stretch = options.anisotropy.sqrt();
        Self {
            width: options.width as f64 * stretch,
            height: options.height as f64 / stretch,
            stretch,
            spacing: options.spacing,
            gradient: options.gradient,
            shape: options.shape,
        }
    }

    /// Converts a point of the isotropic frame to the image.
    ///
    /// In the frame as in the image, the centre of pixel (0, 0) is half a pixel from the corner.
    pub(super) fn stretched(&self, p: Point) -> Point {
        if self.stretch == 1. {
            return p;
        }
        Point::new((p.x + 0.5) / self.stretch - 0.5, (p.y + 0.5) * self.stretch - 0.5)
    }

    /// Returns the local hexagonal spacing at `p`, in px.
    pub(super) fn spacing_at(&self, p: Point) -> f64 {
        match self.shape {
            GradientShape::Linear => self.spacing / self.relative_density(p.x).sqrt(),
            GradientShape::Radial => self.spacing_at_radius(p.distance(self.middle())),
        }
    }

    /// Returns the widest spacing in the image, in px.
    pub(super) fn widest(&self) -> f64 {
        match self.shape {
            GradientShape::Linear => {
                let at = |x: f64| self.spacing_at(Point::new(x, 0.));
                at(0.).max(at(self.width))
            }
            GradientShape::Radial => self.spacing * self.gradient.sqrt().max(1.),
        }
    }

    /// Returns the density of a linear gradient at x, relative to the mean density of the image.
    ///
    /// Beyond the image, the density at its edge is returned.
    fn relative_density(&self, x: f64) -> f64 {
        let log = self.gradient.ln();
        let t = ((x + 0.5) / self.width).clamp(0., 1.);
        // ∫₀¹ exp(log (½ − t)) dt = 2 sinh(log/2) / log, which tends to 1 as log tends to 0
        let mean = if log.abs() < 1e-9 { 1. } else { 2. * (log / 2.).sinh() / log };
        (log * (0.5 - t)).exp() / mean
    }

    /// Returns the middle of the isotropic frame, in px.
    fn middle(&self) -> Point {
        Point::new(0.5 * self.width - 0.5, 0.5 * self.height - 0.5)
    }

    /// Returns the spacing of a radial gradient at distance `radius` from the middle of the image,
    /// in px.
    ///
    /// It changes linearly up to half the longer side, where the density has changed by the factor
    /// `gradient`, and is constant beyond.
    fn spacing_at_radius(&self, radius: f64) -> f64 {
        let reach = 0.5 * self.width.max(self.height);
        self.spacing * (1. + (self.gradient.sqrt() - 1.) * (radius / reach).min(1.))
    }

    /// Returns points of this density that are spread evenly over the rectangle `bounds`.
    ///
    /// For a linear gradient, a low-discrepancy sequence with a random start is bent to the
    /// density. The sequence is the analogue, in the plane, of multiples of the golden ratio
    /// (Roberts 2018,
    /// <https://extremelearning.com.au/unreasonable-effectiveness-of-quasirandom-sequences/>). For
    /// a radial gradient, the radii of Vogel's spiral are chosen by the density.
    pub(super) fn evenly_spread(&self, bounds: &Rectangle, rng: &mut dyn Rng) -> Vec<Point> {
        // 1/ρ and 1/ρ², where ρ³ = ρ + 1
        const RATIO: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_3];
        let start: [f64; 2] = [rng.random(), rng.random()];
        let Rectangle { x0, y0, x1, y1 } = *bounds;
        match self.shape {
            GradientShape::Linear => {
                let (width, height) = (x1 - x0, y1 - y0);
                let share = Cumulative::new(1., |t| self.relative_density(x0 + width * t));
                let total = share.total();
                let n = (total * width * height / (CELL * self.spacing * self.spacing)).round() as usize;
                (0..n)
                    .map(|i| {
                        let u = (start[0] + i as f64 * RATIO[0]).fract() * total;
                        let y = y0 + height * (start[1] + i as f64 * RATIO[1]).fract();
                        Point::new(x0 + width * share.place(u), y)
                    })
                    .collect()
            }
            GradientShape::Radial => {
                let middle = self.middle();
                let farthest = middle.distance(Point::new(x0, y0));
                let within = self.within_radius(farthest);
                (0..within.total() as usize)
                    .map(|i| {
                        let radius = within.place(i as f64 + start[0]);
                        let (sin, cos) = (TAU * start[1] + i as f64 * GOLDEN_ANGLE).sin_cos();
                        Point::new(middle.x + radius * cos, middle.y + radius * sin)
                    })
                    .filter(|p| p.x >= x0 && p.x <= x1 && p.y >= y0 && p.y <= y1)
                    .collect()
            }
        }
    }

    /// Returns the number of cones within each distance from the middle, up to `farthest`.
    fn within_radius(&self, farthest: f64) -> Cumulative {
        Cumulative::new(farthest, |r| TAU * r / (CELL * self.spacing_at_radius(r).powi(2)))
    }

    /// Returns the rectangle that a pattern of uniform density must fill to become this mosaic, and
    /// its number of points.
    pub(super) fn flat(&self) -> (Rectangle, usize) {
        let cell = CELL * self.spacing * self.spacing;
        match self.shape {
            GradientShape::Linear => {
                let (x1, y1) = (self.width - 0.5, self.height - 0.5);
                (Rectangle { x0: -0.5, y0: -0.5, x1, y1 }, (self.width * self.height / cell).round() as usize)
            }
            GradientShape::Radial => {
                // At the density of the middle, a disc of radius `half` contains as many cones as
                // the mosaic does up to the corners of the image. The pattern fills the square
                // around that disc.
                let half = (cell * self.within_radius(self.corner()).total() / PI).sqrt();
                let square = Rectangle { x0: -half, y0: -half, x1: half, y1: half };
                (square, (4. * half * half / cell).round() as usize)
            }
        }
    }

    /// Returns the distance between the middle and a corner of the isotropic frame, in px.
    fn corner(&self) -> f64 {
        0.5 * self.width.hypot(self.height)
    }

    /// Moves the points of a uniform pattern to their positions in the mosaic.
    ///
    /// With a radial gradient, points that would lie farther out than the corners of the image are
    /// dropped.
    pub(super) fn bent(&self, points: &[Point]) -> Vec<Point> {
        match self.shape {
            GradientShape::Linear if self.gradient == 1. => points.to_vec(),
            GradientShape::Linear => {
                let share = Cumulative::new(1., |t| self.relative_density(self.width * t - 0.5));
                let x = |x: f64| self.width * share.place((x + 0.5) / self.width * share.total()) - 0.5;
                points.iter().map(|p| Point::new(x(p.x), p.y)).collect()
            }
            GradientShape::Radial => {
                let within = self.within_radius(self.corner());
                let middle = self.middle();
                let bent = |p: &Point| {
                    let flat = p.x.hypot(p.y);
                    let count = PI * flat * flat / (CELL * self.spacing * self.spacing);
                    let scale = if flat > 0. { within.place(count) / flat } else { 0. };
                    (count <= within.total())
                        .then(|| Point::new(middle.x + scale * p.x, middle.y + scale * p.y))
                };
                points.iter().filter_map(bent).collect()
            }
        }
    }
}

/// Integral of a density from 0, computed in [`SAMPLES`] equal steps.
struct Cumulative {
    /// Upper end of the range over which the density is integrated.
    length: f64,
    /// Integral up to the end of each step, from 0 to the total.
    sums: Vec<f64>,
}

impl Cumulative {
    fn new(length: f64, density: impl Fn(f64) -> f64) -> Self {
        let mut sums = vec![0.; SAMPLES + 1];
        for i in 0..SAMPLES {
            let at = length * (i as f64 + 0.5) / SAMPLES as f64;
            sums[i + 1] = sums[i] + density(at) * (length / SAMPLES as f64);
        }
        Self { length, sums }
    }

    fn total(&self) -> f64 {
        self.sums[SAMPLES]
    }

    /// Returns the position up to which the integral is `sum`.
    fn place(&self, sum: f64) -> f64 {
        let i = self.sums.partition_point(|&c| c <= sum).clamp(1, SAMPLES) - 1;
        let within = (sum - self.sums[i]) / (self.sums[i + 1] - self.sums[i]);
        self.length * (i as f64 + within) / SAMPLES as f64
    }
}
