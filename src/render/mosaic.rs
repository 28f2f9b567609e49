//! Simulated cone mosaics: patches of triangular lattice with defects between them.
//!
//! 1. Spread points of the wanted density evenly, and displace them at random so that no trace of
//!    the even arrangement is left.
//! 2. In 30 steps, let points that are nearer than 1.25 local spacings push each other away.
//! 3. Displace each point at random.

use super::RenderError;
use super::density::{Density, Rectangle};
use super::error::check;
use super::field::normal;
use super::options::validate_size;
use crate::geometry::{Point, Window};
use rand::Rng;
use rayon::prelude::*;
use serde::Serialize;

/// Number of steps in which points push each other away; more steps make larger crystals and a
/// higher regularity.
///
/// With 30 steps, the regularity is that of real mosaics, see [`cone_mosaic`].
const STEPS: usize = 30;
/// Distance, in local spacings, below which cones push each other away. In a triangular lattice
/// only the six nearest neighbours, at distance 1, are nearer; the next ones are 1.73 away.
const REACH: f64 = 1.25;
/// Displacement of a cone per step and per unit of push, in local spacings. The push of a neighbour
/// falls linearly from 1 at distance 0 to 0 at distance [`REACH`].
const STIFFNESS: f64 = 0.3;
/// Standard deviation of the random displacement, in local spacings, after which no trace of the
/// even arrangement is left.
const FORGET: f64 = 0.3;
/// Width of the margin around the image in which cones are made too, in spacings.
///
/// Cones at the outer bounds of the margin are pressed against them. The margin keeps this away
/// from the image.
const MARGIN: f64 = 4.;
/// Distance from the image, in spacings, within which cones are kept because their light still
/// falls into it.
const SURROUNDINGS: f64 = 2.;

/// Direction in which the density of a mosaic changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum GradientShape {
    /// Density that changes from the left edge to the right edge; its logarithm is linear in x.
    #[default]
    Linear,
    /// Density that changes from the middle of the image outwards, as around the fovea.
    ///
    /// The spacing changes linearly with the distance from the middle, up to half the longer side
    /// of the image, and is constant beyond.
    Radial,
}

/// Options for a mosaic as regular as a real one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MosaicOptions {
    /// Width of the image, 1 to 16384 px.
    #[serde(skip)]
    pub width: usize,
    /// Height of the image, 1 to 16384 px.
    #[serde(skip)]
    pub height: usize,
    /// Hexagonal spacing of the cones, 2 to 1000 px: at the mean density or, with a radial
    /// gradient, in the middle of the image.
    pub spacing: f64,
    /// Ratio of the densities at the two ends of the gradient, 1/20 to 20; 1 gives a uniform
    /// density.
    ///
    /// With a linear gradient, it is the density at the left edge divided by the density at the
    /// right edge. With a radial gradient, it is the density in the middle divided by the density
    /// at half the longer side away from the middle.
    pub gradient: f64,
    /// Shape of the gradient, which tells in which direction the density changes.
    #[serde(rename = "gradient_shape")]
    pub shape: GradientShape,
    /// Ratio of the spacing along y to the spacing along x, 0.5 to 2; the density stays the same.
    pub anisotropy: f64,
    /// Standard deviation of the final displacement in x and in y, 0 to 0.5 local spacings.
    ///
    /// 0.085 gives the regularity index of real mosaics.
    pub jitter: f64,
}

impl Default for MosaicOptions {
    fn default() -> Self {
        Self {
            width: 150,
            height: 150,
            spacing: 9.,
            gradient: 1.,
            shape: GradientShape::Linear,
            anisotropy: 1.,
            jitter: 0.085,
        }
    }
}

impl MosaicOptions {
    /// Checks that every field is in its range.
    ///
    /// # Errors
    /// Fails if a field is out of its range; the error names the first such field and its range.
    pub fn validate(&self) -> Result<(), RenderError> {
        validate_size(self.width, self.height)?;
        check("spacing", self.spacing, (2., 1000.), "px")?;
        check(
            "gradient",
            self.gradient,
            (0.05, 20.),
            "(density at the left divided by that at the right, or in the middle divided by that around it)",
        )?;
        check("anisotropy", self.anisotropy, (0.5, 2.), "(spacing along y divided by spacing along x)")?;
        check("jitter", self.jitter, (0., 0.5), "spacings")
    }
}

/// Returns whether a point lies on a pixel of an image of `width` × `height` px.
pub(super) fn in_image(p: Point, width: usize, height: usize) -> bool {
    let on = |v: f64, side: usize| v >= -0.5 && v < side as f64 - 0.5;
    on(p.x, width) && on(p.y, height)
}

/// Makes the positions of cones in an image, in px, where (0, 0) is the centre of the top-left
/// pixel.
///
/// The cones form patches of triangular lattice, turned in all directions, with defects between
/// them, as repelling discs do when they freeze without time to crystallise. The steps are evenly
/// spread points, soft repulsion over about the local spacing, and jitter.
///
/// With uniform density and the default jitter, the mean nearest-neighbour distance is .83
/// hexagonal spacings and the regularity index is 9 to 10, as in real confocal images. With a
/// jitter of 0.11, these values are .79 and 8, as in real split-detector images.
///
/// # Errors
/// Fails if an option is out of its range.
pub fn cone_mosaic(options: &MosaicOptions, rng: &mut dyn Rng) -> Result<Vec<Point>, RenderError> {
    let mut points = with_surroundings(options, rng)?;
    points.retain(|&p| in_image(p, options.width, options.height));
    Ok(points)
}

/// Makes the positions of [`cone_mosaic`], and also those of cones beyond the border whose light
/// falls into the image.
pub(super) fn with_surroundings(
    options: &MosaicOptions,
    rng: &mut dyn Rng,
) -> Result<Vec<Point>, RenderError> {
    options.validate()?;
    let density = Density::of(options);
    let field = Field::around(&density);
    let mut points = density.evenly_spread(&field.bounds, rng);
    for p in &mut points {
        let sd = FORGET * density.spacing_at(*p);
        *p = field.held(Point::new(p.x + sd * normal(rng), p.y + sd * normal(rng)));
    }
    for _ in 0..STEPS {
        points = field.repelled(&points, &density);
    }
    jitter(&mut points, &density, options, rng);
    let reach = SURROUNDINGS * density.widest();
    points.retain(|p| {
        let near = |v: f64, side: usize| v > -reach && v < side as f64 + reach;
        near(p.x, options.width) && near(p.y, options.height)
    });
    Ok(points)
}

/// Displaces cones at random, and converts them from the isotropic frame of [`Density`] to the
/// image.
fn jitter(points: &mut [Point], density: &Density, options: &MosaicOptions, rng: &mut dyn Rng) {
    for p in points {
        if options.jitter > 0. {
            let sd = options.jitter * density.spacing_at(*p);
            *p = Point::new(p.x + sd * normal(rng), p.y + sd * normal(rng));
        }
        *p = density.stretched(*p);
    }
}

/// Conversion of a pattern of uniform density, such as a sampler makes, into a mosaic as
/// [`MosaicOptions`] describe it.
pub struct Pattern {
    density: Density,
    options: MosaicOptions,
    window: Window,
    count: usize,
}

impl Pattern {
    /// Creates the conversion for the mosaic that `options` describe.
    ///
    /// # Errors
    /// Fails if an option is out of its range.
    pub fn new(options: &MosaicOptions) -> Result<Self, RenderError> {
        options.validate()?;
        let density = Density::of(options);
        let (sides, count) = density.flat();
        let window = Window::rectangle(sides.x0, sides.y0, sides.x1, sides.y1)?;
        Ok(Self { density, options: options.clone(), window, count })
    }

    /// Returns the number of points that the uniform pattern must have.
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Returns the window that the uniform pattern must fill.
    pub const fn window(&self) -> &Window {
        &self.window
    }

    /// Converts a uniform pattern into the mosaic, and returns its points that lie in the image, in
    /// px.
    ///
    /// `points` must fill [`Pattern::window`]. Where the density changes, the cells of the pattern
    /// come out longer along the gradient or across it.
    pub fn bent(&self, points: &[Point], rng: &mut dyn Rng) -> Vec<Point> {
        let mut points = self.density.bent(points);
        jitter(&mut points, &self.density, &self.options, rng);
        points.retain(|p| in_image(*p, self.options.width, self.options.height));
        points
    }
}

/// Image with a margin around it, in the isotropic frame of [`Density`].
struct Field {
    /// Rectangle in which cones are made: the isotropic frame with the margin around it.
    bounds: Rectangle,
    /// Side of the squares in which neighbours are sought, in px; at least the distance over which
    /// cones push each other.
    cell: f64,
}

impl Field {
    fn around(density: &Density) -> Self {
        let widest = density.widest();
        let margin = MARGIN * widest;
        let bounds = Rectangle {
            x0: -0.5 - margin,
            y0: -0.5 - margin,
            x1: density.width - 0.5 + margin,
            y1: density.height - 0.5 + margin,
        };
        Self { bounds, cell: REACH * widest }
    }

    /// Returns the point, moved to the nearest point of the bounds if it lies outside.
    fn held(&self, p: Point) -> Point {
        let Rectangle { x0, y0, x1, y1 } = self.bounds;
        Point::new(p.x.clamp(x0, x1), p.y.clamp(y0, y1))
    }

    /// Moves every point away from the points that are nearer than [`REACH`], all at the same time.
    fn repelled(&self, points: &[Point], density: &Density) -> Vec<Point> {
        let Rectangle { x0, y0, x1, y1 } = self.bounds;
        let columns = ((x1 - x0) / self.cell) as usize + 1;
        let rows = ((y1 - y0) / self.cell) as usize + 1;
        let place = |p: Point| (((p.x - x0) / self.cell) as usize, ((p.y - y0) / self.cell) as usize);
        // Counting sort: the points of square c are order[first[c]..first[c + 1]].
        let mut first = vec![0usize; columns * rows + 1];
        for &p in points {
            let (i, j) = place(p);
            first[j * columns + i + 1] += 1;
        }
        for c in 0..columns * rows {
            first[c + 1] += first[c];
        }
        let mut next = first.clone();
        let mut order = vec![0usize; points.len()];
        for (index, &p) in points.iter().enumerate() {
            let (i, j) = place(p);
            let slot = &mut next[j * columns + i];
            order[*slot] = index;
            *slot += 1;
        }
        let spacing: Vec<f64> = points.iter().map(|p| density.spacing_at(*p)).collect();
        let moved = |index: usize| {
            let (p, own) = (points[index], spacing[index]);
            let (i, j) = place(p);
            let (mut dx, mut dy) = (0., 0.);
            for row in j.saturating_sub(1)..(j + 2).min(rows) {
                let from = first[row * columns + i.saturating_sub(1)];
                let to = first[row * columns + (i + 2).min(columns)];
                for &other in &order[from..to] {
                    let (x, y) = (p.x - points[other].x, p.y - points[other].y);
                    let reach = REACH * 0.5 * (own + spacing[other]);
                    let square = x * x + y * y;
                    if square < reach * reach && square > 0. {
                        let push = 1. / square.sqrt() - 1. / reach;
                        dx += push * x;
                        dy += push * y;
                    }
                }
            }
            self.held(Point::new(p.x + STIFFNESS * own * dx, p.y + STIFFNESS * own * dy))
        };
        (0..points.len()).into_par_iter().map(moved).collect()
    }
}
