use super::RenderError;
use super::error::check;
use super::field::normal;
use super::options::validate_size;
use crate::geometry::Point;
use rand::{Rng, RngExt};
use rayon::prelude::*;

/// Relaxation steps. More make larger crystals and a higher regularity.
const STEPS: usize = 30;
/// Cones closer than this many spacings push each other away.
const REACH: f64 = 1.25;
/// How far a cone moves in a step for a unit of push, in spacings.
const STIFFNESS: f64 = 0.3;
/// How far beyond the image cones are made, in spacings, so that the walls that hold them in are not felt inside.
const MARGIN: f64 = 4.;
/// How far beyond the image a cone still shines into it, in spacings.
const SURROUNDINGS: f64 = 2.;

/// A mosaic as regular as a real one.
#[derive(Clone, Debug, PartialEq)]
pub struct MosaicOptions {
    /// Width of the image, 1 to 16384 px.
    pub width: usize,
    /// Height of the image, 1 to 16384 px.
    pub height: usize,
    /// Hexagonal spacing of the mean density, 2 to 1000 px.
    pub spacing: f64,
    /// Density at the left edge over that at the right edge, 1/20 to 20; 1 is uniform. Its logarithm is linear in x.
    pub gradient: f64,
    /// Standard deviation of the final displacement in x and in y, 0 to 0.5 local spacings. 0.085 gives the regularity index of
    /// real mosaics.
    pub jitter: f64,
}

impl Default for MosaicOptions {
    fn default() -> Self {
        Self { width: 150, height: 150, spacing: 9., gradient: 1., jitter: 0.085 }
    }
}

impl MosaicOptions {
    /// Whether every field is in its range.
    ///
    /// # Errors
    /// The first field that is not, with its range.
    pub fn validate(&self) -> Result<(), RenderError> {
        validate_size(self.width, self.height)?;
        check("spacing", self.spacing, (2., 1000.), "px")?;
        check("gradient", self.gradient, (0.05, 20.), "(density left over right)")?;
        check("jitter", self.jitter, (0., 0.5), "spacings")
    }

    /// Density at x relative to the mean of the image; beyond the image, that of its edge.
    fn relative_density(&self, x: f64) -> f64 {
        let log = self.gradient.ln();
        let t = ((x + 0.5) / self.width as f64).clamp(0., 1.);
        // ∫₀¹ exp(log (½ − t)) dt = 2 sinh(log/2) / log
        let mean = if log.abs() < 1e-9 { 1. } else { 2. * (log / 2.).sinh() / log };
        (log * (0.5 - t)).exp() / mean
    }

    fn local_spacing(&self, x: f64) -> f64 {
        self.spacing / self.relative_density(x).sqrt()
    }

    /// Widest spacing of the image.
    fn widest(&self) -> f64 {
        self.local_spacing(0.).max(self.local_spacing(self.width as f64))
    }
}

/// Whether a point lies on a pixel of the image.
pub(super) fn in_image(p: Point, width: usize, height: usize) -> bool {
    let on = |v: f64, side: usize| v >= -0.5 && v < side as f64 - 0.5;
    on(p.x, width) && on(p.y, height)
}

/// Places of cones in an image, px (pixel (0, 0) is the centre of the top-left pixel): patches of triangular lattice in
/// every direction with defects between, as repelling discs freeze when they are not given the time to crystallise.
///
/// Steps: evenly spread points of the density wanted → a few steps of soft repulsion within the local spacing → jitter.
/// Uniform density at the default jitter: mean nearest-neighbour distance .83 s, regularity index 9 to 10, as in real
/// confocal images; at jitter 0.11: .79 s and 8, as in real split-detector images.
///
/// # Errors
/// If an option is out of its range.
pub fn cone_mosaic(options: &MosaicOptions, rng: &mut dyn Rng) -> Result<Vec<Point>, RenderError> {
    let mut points = with_surroundings(options, rng)?;
    points.retain(|&p| in_image(p, options.width, options.height));
    Ok(points)
}

/// As [`cone_mosaic`], with the cones beyond the border that shine into the image.
pub(super) fn with_surroundings(
    options: &MosaicOptions,
    rng: &mut dyn Rng,
) -> Result<Vec<Point>, RenderError> {
    options.validate()?;
    let field = Field::around(options);
    let mut points = field.evenly_spread(options, rng);
    for _ in 0..STEPS {
        points = field.repelled(&points, options);
    }
    for p in &mut points {
        let sd = options.jitter * options.local_spacing(p.x);
        *p = Point::new(p.x + sd * normal(rng), p.y + sd * normal(rng));
    }
    let reach = SURROUNDINGS * options.widest();
    points.retain(|p| {
        let near = |v: f64, side: usize| v > -reach && v < side as f64 + reach;
        near(p.x, options.width) && near(p.y, options.height)
    });
    Ok(points)
}

/// The image with a margin around it.
struct Field {
    x0: f64,
    y0: f64,
    x1: f64,
    y1: f64,
    /// Side of the squares in which neighbours are sought, px.
    cell: f64,
}

impl Field {
    fn around(options: &MosaicOptions) -> Self {
        let widest = options.widest();
        let margin = MARGIN * widest;
        Self {
            x0: -0.5 - margin,
            y0: -0.5 - margin,
            x1: options.width as f64 - 0.5 + margin,
            y1: options.height as f64 - 0.5 + margin,
            cell: REACH * widest,
        }
    }

    /// A low-discrepancy sequence (Roberts 2018, the plane's analogue of the golden ratio) from a random start, bent to
    /// the density wanted and displaced until its own order is forgotten.
    fn evenly_spread(&self, options: &MosaicOptions, rng: &mut dyn Rng) -> Vec<Point> {
        const RATIO: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_3];
        const COLUMNS: usize = 2048;
        let width = self.x1 - self.x0;
        let mut cumulative = vec![0.; COLUMNS + 1];
        for i in 0..COLUMNS {
            let x = self.x0 + width * (i as f64 + 0.5) / COLUMNS as f64;
            cumulative[i + 1] = cumulative[i] + options.relative_density(x) / COLUMNS as f64;
        }
        let total = cumulative[COLUMNS];
        let cell_area = 0.75f64.sqrt() * options.spacing * options.spacing;
        let n = (total * width * (self.y1 - self.y0) / cell_area).round() as usize;
        let start: [f64; 2] = [rng.random(), rng.random()];
        (0..n)
            .map(|i| {
                let u = (start[0] + i as f64 * RATIO[0]).fract() * total;
                let column = cumulative.partition_point(|&c| c <= u).clamp(1, COLUMNS) - 1;
                let within = (u - cumulative[column]) / (cumulative[column + 1] - cumulative[column]);
                let x = self.x0 + width * (column as f64 + within) / COLUMNS as f64;
                let y = self.y0 + (self.y1 - self.y0) * (start[1] + i as f64 * RATIO[1]).fract();
                let sd = 0.3 * options.local_spacing(x);
                self.held(Point::new(x + sd * normal(rng), y + sd * normal(rng)))
            })
            .collect()
    }

    fn held(&self, p: Point) -> Point {
        Point::new(p.x.clamp(self.x0, self.x1), p.y.clamp(self.y0, self.y1))
    }

    /// Every point moved away from those within `REACH`, all at once.
    fn repelled(&self, points: &[Point], options: &MosaicOptions) -> Vec<Point> {
        let columns = ((self.x1 - self.x0) / self.cell) as usize + 1;
        let rows = ((self.y1 - self.y0) / self.cell) as usize + 1;
        let place =
            |p: Point| (((p.x - self.x0) / self.cell) as usize, ((p.y - self.y0) / self.cell) as usize);
        // Counting sort: the points of cell c are order[first[c]..first[c + 1]].
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
        let spacing: Vec<f64> = points.iter().map(|p| options.local_spacing(p.x)).collect();
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
