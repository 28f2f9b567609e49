//! Orientation and anisotropy of a mosaic: directions of nearest neighbours, the ellipse of the
//! vectors to neighbouring cells, and the orientation of hexagons.
//!
//! 1. Take the axis from each interior point to its nearest neighbour, and the mean of exp(2iθ).
//! 2. Test the mean with Rayleigh's test. Points that are linked through nearest neighbours share
//!    axes, so they form one group.
//! 3. Average the second moments of the vectors from bound cells to their neighbours, and convert
//!    them to an ellipse.
//! 4. Take the phase of ψ6 of each bound cell, and the phase of the mean of ψ6, as the orientation
//!    of hexagons.

use super::{NearestNeighbours, Voronoi};
use crate::geometry::{Point, Window};
use serde::{Deserialize, Serialize};

/// Width of the bins of [`NearestAxes::counts`], in degrees; it divides 180° evenly.
pub const AXIS_BIN: f64 = 10.;
/// Number of bins of width [`AXIS_BIN`] that cover 180°.
const AXIS_BINS: usize = 18;
/// Smallest number of groups of linked points for which a p-value is computed. With fewer groups,
/// the p-value would not be uniform for independent points.
const FEWEST_GROUPS: usize = 10;
/// Relative size below which sums and differences of direction vectors count as 0, because they are
/// only rounding error.
const ROUNDING: f64 = 1e-9;

/// Directions in which a mosaic is ordered and in which it is stretched.
///
/// All angles are in degrees, counter-clockwise from the positive x axis (to the right) as seen in
/// the picture: although y points down in coordinates, 90° is up. This sense is opposite to that of
/// [`Ellipse::degrees`](super::Ellipse::degrees). An axis points both ways, so 0° and 180° are the
/// same.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Orientation {
    /// Axes from points to their nearest neighbours.
    pub nearest: NearestAxes,
    /// Ellipse that describes the vectors from cells to their neighbours; it is elongated in the
    /// direction in which the mosaic is stretched.
    ///
    /// `None` without bound cells, which are Voronoi cells strictly inside the window.
    pub ellipse: Option<NeighbourEllipse>,
    /// Orientation of the hexagon around each point: the phase of ψ6 divided by 6, 0–60°.
    ///
    /// If the neighbours form a regular hexagon, it is the direction of one of them. `None` if the
    /// Voronoi cell of the point does not lie strictly inside the window, or if ψ6 is 0, as in a
    /// square lattice.
    pub hexagons: Vec<Option<f64>>,
    /// Orientation of the mean ψ6 over the cells strictly inside the window, 0–60°.
    ///
    /// The modulus of this mean ([`super::VoronoiSummary::psi6_global`]) tells how well the
    /// orientations of the cells agree. `None` if the mean is 0 or there is no such cell.
    pub hexagon_direction: Option<f64>,
}

/// Axes from points to their nearest neighbours.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NearestAxes {
    /// Axis from every point to its nearest neighbour, 0–180°.
    ///
    /// `None` if there is no neighbour or the neighbour coincides with the point. If several
    /// neighbours are equally near, one of them is taken; in a perfect lattice the axes are
    /// therefore arbitrary.
    pub degrees: Vec<Option<f64>>,
    /// Number of axes from interior points. All other fields except `degrees` are computed from
    /// these axes only.
    ///
    /// An interior point is at least as far from the border as from its nearest neighbour. Points
    /// nearer to the border are left out: their true nearest neighbour may lie beyond it, so axes
    /// towards the border would be missing.
    pub n: usize,
    /// Numbers of axes from interior points in 0–10°, 10–20° … 170–180°.
    pub counts: [usize; AXIS_BINS],
    /// Length of the mean of exp(2iθ) over the axes θ from interior points: 0 for evenly spread
    /// axes, 1 for parallel ones.
    ///
    /// For n independent axes it is about .9/√n by chance. `None` without axes. Source: Mardia &
    /// Jupp (2000), chapter 9, <https://doi.org/10.1002/9780470316979>.
    pub resultant: Option<f64>,
    /// Mean axis from interior points to their nearest neighbours, 0–180°; `None` if `resultant` is
    /// 0 or `None`.
    pub direction: Option<f64>,
    /// Probability, if no direction is preferred, of a mean of exp(2iθ) at least as long as
    /// `resultant`.
    ///
    /// The p-value is that of Rayleigh's test, with the variance taken from groups of points.
    /// Points that are linked through nearest neighbours share axes (mutual nearest neighbours even
    /// have the same axis), so all points that are linked form one group. If every axis were a
    /// group of its own, this would be Rayleigh's test itself.
    ///
    /// The p-value is uniform for independent points. In a regular mosaic it is too often small,
    /// because the axes in an entire patch of lattice agree: in 200 simulated mosaics of some 320
    /// cones without preferred direction, 18 % of the p-values were below .05. `None` for fewer
    /// than 10 groups.
    pub p_value: Option<f64>,
}

/// Ellipse that describes the vectors from cells to their neighbours.
///
/// The second moments of a cell are the means of dx², dx·dy and dy² over the vectors (dx, dy) to
/// its neighbours, which are the points beyond the sides of its Voronoi cell. They are averaged
/// over the bound cells, which are Voronoi cells strictly inside the window. The axes of the
/// ellipse are the directions in which the averaged moment is largest and smallest. A bound cell
/// may still miss a neighbour beyond the border.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NeighbourEllipse {
    /// Number of bound cells over which the second moments are averaged.
    pub cells: usize,
    /// Longer semi-axis, in the unit of the coordinates: √2 times the root mean square of the
    /// vectors' components along it.
    ///
    /// For a triangular lattice both semi-axes are its spacing.
    pub major: f64,
    /// Shorter semi-axis, in the unit of the coordinates.
    pub minor: f64,
    /// Ratio of the longer to the shorter semi-axis, at least 1.
    ///
    /// For a triangular lattice that is stretched by a factor of up to √3, the ratio is this
    /// factor; beyond √3, the neighbours change. By chance the ratio exceeds 1: in simulated
    /// mosaics of 320 cones without preferred direction, its median is 1.02 and its 95th percentile
    /// 1.045. It approaches 1 as 1/√n.
    pub anisotropy: f64,
    /// Direction of the longer semi-axis, 0–180°, counter-clockwise from the positive x axis as
    /// seen in the picture; `None` if both semi-axes are equal.
    pub direction: Option<f64>,
}

/// Computes the orientation and anisotropy of a mosaic.
///
/// `nearest` contains the nearest neighbours of the points, `interior` the flags from
/// [`interior`](super::interior), and `cells` the Voronoi cells. The time is linear in n. The
/// function never fails: values that are not defined are `None`.
///
/// Sources: Curcio & Sloan (1992), <https://doi.org/10.1017/S0952523800009639>; Cooper et al.
/// (2016), <https://doi.org/10.1167/iovs.16-19072>.
pub fn orientation(
    points: &[Point],
    window: &Window,
    nearest: &NearestNeighbours,
    interior: &[bool],
    cells: &Voronoi,
) -> Orientation {
    let bound_psi6 = || cells.cells.iter().map(|c| c.psi6.filter(|_| c.bound));
    let sum = bound_psi6().flatten().fold([0.; 2], |sum, psi| [sum[0] + psi[0], sum[1] + psi[1]]);
    let count = bound_psi6().flatten().count() as f64;
    Orientation {
        nearest: nearest_axes(points, window, nearest, interior),
        ellipse: ellipse(cells),
        hexagons: bound_psi6().map(|psi| psi.and_then(|p| phase(p, 6., ROUNDING))).collect(),
        hexagon_direction: phase(sum, 6., ROUNDING * count),
    }
}

/// Returns the phase of a sum of exp(i·`fold`·θ), divided by `fold`, in degrees: the mean
/// direction, counter-clockwise as seen in the picture.
///
/// The sum is passed as real and imaginary part, with directions θ measured from +x towards +y. The
/// result is from 0 to 360°/`fold`, or `None` if the modulus of the sum is not above `least`.
fn phase([re, im]: [f64; 2], fold: f64, least: f64) -> Option<f64> {
    let turn = 360. / fold;
    // In coordinates y points down and angles run clockwise, hence the minus sign.
    let angle = (-im.atan2(re).to_degrees() / fold).rem_euclid(turn);
    // The remainder of a tiny negative angle may round up to a full turn.
    (re.hypot(im) > least).then_some(if angle < turn { angle } else { 0. })
}

/// Measures the axes to nearest neighbours and tests whether they prefer a direction.
fn nearest_axes(
    points: &[Point],
    window: &Window,
    nearest: &NearestNeighbours,
    interior: &[bool],
) -> NearestAxes {
    // exp(2iθ), with θ from +x towards +y as in coordinates, that is clockwise in the picture.
    let axis = |i: usize| {
        let &j = nearest.indices.get(i)?;
        let [dx, dy] = window.displacement(points[i], *points.get(j)?);
        let length = dx.hypot(dy);
        let (cos, sin) = (dx / length, dy / length);
        (length > 0.).then_some([cos * cos - sin * sin, 2. * sin * cos])
    };
    let axes: Vec<Option<[f64; 2]>> = (0..points.len()).map(axis).collect();
    let degrees: Vec<Option<f64>> = axes.iter().map(|a| a.and_then(|a| phase(a, 2., 0.))).collect();
    let mut groups = Groups::new(points.len());
    for (i, &j) in nearest.indices.iter().enumerate() {
        groups.join(i, j);
    }
    let (mut n, mut counts, mut sum) = (0, [0; AXIS_BINS], [0.; 2]);
    let mut of_group: Vec<Option<[f64; 2]>> = vec![None; points.len()];
    for (i, &inside) in interior.iter().enumerate() {
        let (true, Some([re, im]), Some(angle)) = (inside, axes[i], degrees[i]) else { continue };
        n += 1;
        counts[((angle / AXIS_BIN) as usize).min(AXIS_BINS - 1)] += 1;
        sum = [sum[0] + re, sum[1] + im];
        let group = of_group[groups.of(i)].get_or_insert([0.; 2]);
        *group = [group[0] + re, group[1] + im];
    }
    let squared = |[re, im]: [f64; 2]| re * re + im * im;
    // `linked` is the number of groups. `variance` is the expected squared length of `sum` if no
    // direction is preferred.
    let linked = of_group.iter().flatten().count();
    let variance: f64 = of_group.into_iter().flatten().map(squared).sum();
    NearestAxes {
        degrees,
        n,
        counts,
        resultant: (n > 0).then(|| squared(sum).sqrt() / n as f64),
        direction: phase(sum, 2., ROUNDING * n as f64),
        // If every axis were a group of its own, z would be the usual |sum|²/n.
        p_value: (linked >= FEWEST_GROUPS && variance > 0.)
            .then(|| rayleigh(linked as f64, squared(sum) / variance)),
    }
}

/// Returns the probability that the sum of n independent unit vectors without preferred direction
/// has a squared length of at least n·z (Wilkie 1983).
fn rayleigh(n: f64, z: f64) -> f64 {
    ((1. + 4. * n + 4. * n * (n - z).max(0.)).sqrt() - (1. + 2. * n)).exp().min(1.)
}

/// Averages the second moments of the bound cells (Voronoi cells strictly inside the window) and
/// converts them to an ellipse; `None` without bound cells.
fn ellipse(cells: &Voronoi) -> Option<NeighbourEllipse> {
    let bound = || cells.cells.iter().filter(|c| c.bound).filter_map(|c| c.second_moments);
    let count = bound().count();
    let sum = bound().fold([0.; 3], |sum, m| std::array::from_fn(|k| sum[k] + m[k]));
    let [xx, xy, yy] = sum.map(|v| v / count as f64);
    let (mean, half) = ((xx + yy) / 2., ((xx - yy) / 2.).hypot(xy));
    // In a triangular lattice of spacing 1 both eigenvalues are ½, so the factor 2 makes both
    // semi-axes equal to the spacing.
    let [major, minor] = [mean + half, mean - half].map(|v| (2. * v).sqrt());
    (count > 0 && minor > 0.).then(|| NeighbourEllipse {
        cells: count,
        major,
        minor,
        anisotropy: major / minor,
        direction: phase([(xx - yy) / 2., xy], 2., ROUNDING * mean),
    })
}

/// Disjoint sets of linked points (union–find).
///
/// Each entry is the index of a point in the same set: a lower index, or its own for the
/// representative of the set.
struct Groups(Vec<usize>);

impl Groups {
    /// Puts each of `n` points into a set of its own.
    fn new(n: usize) -> Self {
        Self((0..n).collect())
    }

    /// Returns the representative of the set of point `i`, shortening the path to it.
    fn of(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }

    /// Joins the sets of two points.
    fn join(&mut self, i: usize, j: usize) {
        let (a, b) = (self.of(i), self.of(j));
        // The lowest index represents the group, so the result does not depend on the order of
        // links.
        self.0[a.max(b)] = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Rectangle, nearest_neighbours};
    use crate::sample::sampler;
    use crate::stats::{interior, voronoi};
    use proptest::prelude::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn of(points: &[Point], window: &Window) -> Orientation {
        let nearest = nearest_neighbours(points, window);
        let interior = interior(points, window, &nearest);
        orientation(points, window, &nearest, &interior, &voronoi(points, window))
    }

    /// Returns a triangular lattice of spacing 1, stretched along an axis, in a 24 × 18 window and
    /// around it.
    ///
    /// The rows are at `rows` degrees and the stretch is `stretch` along the axis at `axis`
    /// degrees, both counter-clockwise in the picture. The lattice continues beyond the window, so
    /// that cells at the border are cells of the complete lattice.
    fn lattice(rows: f64, stretch: f64, axis: f64) -> (Vec<Point>, Window) {
        let turned = |[x, y]: [f64; 2], by: f64| {
            let (sin, cos) = by.to_radians().sin_cos();
            [x * cos - y * sin, x * sin + y * cos]
        };
        let window = Window::rectangle(-12.03, -9.02, 12.03, 9.02).unwrap();
        let around = Rectangle::new(-16., -13., 16., 13.).unwrap();
        let places = (-40..=40).flat_map(|j| (-60..=60).map(move |i| (f64::from(i), f64::from(j))));
        let points = places
            .map(|(i, j)| [i + 0.5 * j, j * 0.75f64.sqrt()])
            .map(|p| turned(turned(p, rows), -axis))
            .map(|[x, y]| turned([x * stretch, y], axis))
            // Up in the picture is down in coordinates.
            .map(|[x, y]| Point::new(x, -y))
            .filter(|&p| around.contains(p))
            .collect();
        (points, window)
    }

    fn apart(a: f64, b: f64, turn: f64) -> f64 {
        let d = (a - b).rem_euclid(turn);
        d.min(turn - d)
    }

    #[test]
    fn a_stretched_lattice_has_its_stretch_and_its_axis() {
        for (rows, stretch, axis) in [(0., 1.2, 0.), (11., 1.1, 30.), (47., 1.4, 100.), (5., 1.02, 171.)] {
            let (points, window) = lattice(rows, stretch, axis);
            let ellipse = of(&points, &window).ellipse.unwrap();
            assert!(ellipse.cells > 200);
            assert!((ellipse.anisotropy - stretch).abs() < 1e-9, "{rows} {stretch} {axis}: {ellipse:?}");
            assert!((ellipse.major - stretch).abs() < 1e-9 && (ellipse.minor - 1.).abs() < 1e-9);
            assert!(apart(ellipse.direction.unwrap(), axis, 180.) < 1e-6, "{axis}: {ellipse:?}");
        }
    }

    #[test]
    fn an_even_lattice_has_no_axis_but_the_direction_of_its_rows() {
        for rows in [0., 17., 30., 59.] {
            let (points, window) = lattice(rows, 1., 0.);
            let found = of(&points, &window);
            let ellipse = found.ellipse.unwrap();
            assert!((ellipse.anisotropy - 1.).abs() < 1e-9 && ellipse.direction.is_none(), "{ellipse:?}");
            assert!(found.hexagons.iter().flatten().all(|&d| apart(d, rows, 60.) < 1e-6));
            assert_eq!(found.hexagons.iter().flatten().count(), ellipse.cells);
            assert!(apart(found.hexagon_direction.unwrap(), rows, 60.) < 1e-6);
        }
    }

    #[test]
    fn pairs_in_one_direction_have_that_axis() {
        let window = Window::rectangle(0., 0., 400., 40.).unwrap();
        // The axes of all pairs point up to the right; one further pair lies across the edge of a
        // torus.
        let mut points: Vec<Point> = (0..20).map(|k| Point::new(10. + 19. * f64::from(k), 20.)).collect();
        points.extend(points.clone().iter().map(|p| Point::new(p.x + 3f64.sqrt(), p.y - 1.)));
        let found = of(&points, &window).nearest;
        assert_eq!((found.n, found.counts[2] + found.counts[3]), (40, 40));
        assert!((found.resultant.unwrap() - 1.).abs() < 1e-9);
        assert!((found.direction.unwrap() - 30.).abs() < 1e-9, "{found:?}");
        // Mutual neighbours are linked, so there are 20 groups, not 40.
        assert!((found.p_value.unwrap() / rayleigh(20., 20.) - 1.).abs() < 1e-6);
        let torus = Window::Torus(Rectangle::new(0., 0., 400., 40.).unwrap());
        let across = [Point::new(399., 20.), Point::new(0., 19.)];
        assert!((of(&across, &torus).nearest.degrees[0].unwrap() - 45.).abs() < 1e-9);
    }

    #[test]
    fn p_values_of_independent_points_are_uniform_in_any_window() {
        let corners = [(0., 0.), (3., 0.), (3., 1.), (1., 1.)].map(|(x, y)| Point::new(x, y));
        let windows = [
            Window::unit_torus(),
            Window::rectangle(0., 0., 3., 1.).unwrap(),
            Window::polygon(vec![corners.to_vec()]).unwrap(),
        ];
        for (k, window) in windows.iter().enumerate() {
            for n in [60, 250] {
                let mut p: Vec<f64> = (0..600)
                    .map(|seed| {
                        let rng = &mut ChaCha8Rng::seed_from_u64(1000 * n as u64 + seed);
                        let points = sampler("uniform").unwrap().sample(n, window, rng).unwrap();
                        let nearest = nearest_neighbours(&points, window);
                        nearest_axes(&points, window, &nearest, &interior(&points, window, &nearest))
                            .p_value
                            .unwrap()
                    })
                    .collect();
                p.sort_by(f64::total_cmp);
                let worst = (0..600).map(|i| (p[i] - (i as f64 + 0.5) / 600.).abs()).fold(0., f64::max);
                // The Kolmogorov–Smirnov distance exceeds 1.63/√600 = .067 once in a hundred times.
                assert!(worst < 0.067, "window {k}, {n} points: {worst}");
                let rare = p.iter().filter(|&&p| p < 0.05).count();
                assert!((15..=45).contains(&rare), "window {k}, {n} points: {rare} of 600 below .05");
            }
        }
    }

    #[test]
    fn independent_points_that_are_pulled_apart_along_one_axis_are_told() {
        // A minimal distance along x leaves nearest neighbours above or below each other.
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let points: Vec<Point> = (0..400)
            .map(|k| Point::new(f64::from(k % 20) + 0.2 * rng.random::<f64>(), 20. * rng.random::<f64>()))
            .collect();
        let found = of(&points, &Window::rectangle(-0.5, 0., 20.5, 20.).unwrap()).nearest;
        assert!(
            found.p_value.unwrap() < 1e-6 && apart(found.direction.unwrap(), 90., 180.) < 8.,
            "{found:?}"
        );
        let doubled = found.degrees.iter().flatten().map(|d| (2. * d.to_radians()).cos()).sum::<f64>();
        assert!(doubled < 0.);
    }

    #[test]
    fn what_is_not_defined_is_none() {
        let window = Window::unit_square();
        let p = Point::new(0.5, 0.5);
        for few in [&[][..], &[p], &[p, p], &[p; 3]] {
            let found = of(few, &window);
            assert_eq!((found.nearest.n, found.nearest.resultant, found.nearest.p_value), (0, None, None));
            assert_eq!((found.ellipse, found.hexagon_direction), (None, None));
            assert_eq!(found.hexagons, vec![None; few.len()]);
            assert!(found.nearest.degrees.iter().all(Option::is_none));
        }
        let line: Vec<Point> = (1..9).map(|i| Point::new(0.1 * f64::from(i), 0.5)).collect();
        let found = of(&line, &window);
        assert_eq!((found.nearest.direction, found.ellipse), (Some(0.), None));
        // For a square ψ6 is 0, so there is no hexagon.
        let square: Vec<Point> = (0..25).map(|i| Point::new(f64::from(i % 5), f64::from(i / 5))).collect();
        let found = of(&square, &Window::rectangle(-0.5, -0.5, 4.5, 4.5).unwrap());
        assert!(found.ellipse.is_some_and(|e| e.direction.is_none()));
        assert!(found.hexagons.iter().all(Option::is_none) && found.hexagon_direction.is_none());
    }

    proptest! {
        #[test]
        fn any_small_pattern_has_angles_in_their_range(
            raw in prop::collection::vec((0..7u8, 0..7u8), 0..40), torus: bool, stretch in 1e-6..1e6f64,
        ) {
            let bounds = Rectangle::new(0., 0., 6. * stretch, 6.).unwrap();
            let window = if torus { Window::Torus(bounds) } else { Window::Rectangle(bounds) };
            let points: Vec<Point> =
                raw.iter().map(|&(x, y)| Point::new(f64::from(x) * stretch, f64::from(y))).collect();
            let found = of(&points, &window);
            let within = |v: Option<f64>, most: f64| v.is_none_or(|v| (0. ..most).contains(&v));
            prop_assert!(found.nearest.degrees.iter().all(|&d| within(d, 180.)));
            prop_assert!(found.hexagons.iter().all(|&d| within(d, 60.)));
            prop_assert!(within(found.nearest.direction, 180.) && within(found.hexagon_direction, 60.));
            prop_assert!(found.nearest.resultant.is_none_or(|r| (0. ..=1. + 1e-9).contains(&r)));
            prop_assert!(found.nearest.p_value.is_none_or(|p| (0. ..=1.).contains(&p)));
            prop_assert_eq!(found.nearest.counts.iter().sum::<usize>(), found.nearest.n);
            prop_assert!(found.ellipse.is_none_or(|e| e.anisotropy >= 1. && e.anisotropy.is_finite()));
        }
    }
}
