use super::{NearestNeighbours, Voronoi};
use crate::geometry::{Point, Window};
use serde::{Deserialize, Serialize};

/// Width of the bins of [`NearestAxes::counts`], degrees.
pub const AXIS_BIN: f64 = 10.;
const AXIS_BINS: usize = 18;
/// Fewest groups of points that a p-value is given for: with fewer its distribution is not that of a p-value.
const FEWEST_GROUPS: usize = 10;
/// Below this part of what they are means of, differences and sums of directions are nothing but rounding.
const ROUNDING: f64 = 1e-9;

/// In which directions a mosaic is ordered, and in which it is stretched.
///
/// All angles are in degrees, counter-clockwise from the positive x axis (to the right) as a reader of the picture sees it:
/// although y points down in coordinates, 90° is up. Axes have no sense, so that 0° and 180° are the same.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Orientation {
    /// Directions of the nearest neighbours.
    pub nearest: NearestAxes,
    /// Ellipse of the ways to the neighbours; `None` without bound cells.
    pub ellipse: Option<NeighbourEllipse>,
    /// For every point the orientation of its hexagon: phase of ψ6 over 6, 0–60°, the direction of a neighbour where they stand
    /// regularly around. `None` where the cell is not bound or ψ6 is 0, as in a square.
    pub hexagons: Vec<Option<f64>>,
    /// The same of the mean ψ6 of the bound cells, whose modulus ([`super::VoronoiSummary::psi6_global`]) says how far they agree.
    pub hexagon_direction: Option<f64>,
}

/// The axes from points to their nearest neighbours.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NearestAxes {
    /// For every point the direction of its nearest neighbour as an axis, 0–180°. `None` where there is no neighbour or it
    /// coincides with the point. Of several that are equally near it is one, so that in a perfect lattice these numbers say nothing.
    pub degrees: Vec<Option<f64>>,
    /// Axes in the numbers below: of interior points only (at least as far from the border as from their neighbour), since near the
    /// border neighbours beyond it are missed, and more of them in one direction than in others.
    pub n: usize,
    /// How many of these point in 0–10°, 10–20° … 170–180°.
    pub counts: [usize; AXIS_BINS],
    /// Length of the mean of exp(2iθ): 0 for axes spread evenly, 1 for parallel ones (Mardia & Jupp 2000, ch. 9). Of n independent
    /// axes it is about .9/√n by chance. `None` without axes.
    pub resultant: Option<f64>,
    /// The mean axis, 0–180°; `None` where the resultant is 0.
    pub direction: Option<f64>,
    /// Chance of such a resultant where all directions are alike, by Rayleigh's test with the variance of groups: points that are
    /// linked through nearest neighbours share axes (each other's nearest neighbours the same one) and count as one. For
    /// axes that are not linked it is that test itself. Uniform for independent points; in a regular mosaic the axes of a whole
    /// patch of lattice agree, and of 200 simulated ones without direction, of some 320 cones, 18 % were below .05. `None` for
    /// fewer than 10 groups.
    pub p_value: Option<f64>,
}

/// The ellipse with the second moments of the ways from cells to their neighbours, those beyond the sides of their Voronoi cells;
/// mean over the bound cells. A bound cell may still miss a neighbour beyond the border.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NeighbourEllipse {
    /// Cells that it is a mean of.
    pub cells: usize,
    /// Longer half axis, in the unit of the coordinates: √2 times the root mean square along it. Both half axes of a triangular
    /// lattice are its spacing.
    pub major: f64,
    /// Shorter half axis.
    pub minor: f64,
    /// Longer over shorter half axis, at least 1. Of a triangular lattice stretched by up to √3 (beyond, it has other
    /// neighbours) it is that stretch. By chance it is 1.02 (median) to 1.045 (95 %) in simulated mosaics of 320 cones without
    /// direction, and nearer to 1 as 1/√n.
    pub anisotropy: f64,
    /// Direction of the longer half axis, 0–180°; `None` where both are equal.
    pub direction: Option<f64>,
}

/// Orientation and anisotropy of a mosaic (Curcio & Sloan 1992; Cooper et al. 2016), from its nearest neighbours, which of
/// its points are [`interior`](super::interior), and its cells. Linear in n; never fails: what is not defined is `None`.
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

/// Phase over `fold` of a sum of exp(i·fold·θ), as an angle counter-clockwise, 0 to 360°/fold; `None` if its modulus is not above
/// `least`.
fn phase([re, im]: [f64; 2], fold: f64, least: f64) -> Option<f64> {
    let turn = 360. / fold;
    // y points down, angles of coordinates run clockwise
    let angle = (-im.atan2(re).to_degrees() / fold).rem_euclid(turn);
    // of a tiny negative angle the remainder may round to the whole turn
    (re.hypot(im) > least).then_some(if angle < turn { angle } else { 0. })
}

fn nearest_axes(
    points: &[Point],
    window: &Window,
    nearest: &NearestNeighbours,
    interior: &[bool],
) -> NearestAxes {
    // exp(2iθ), θ clockwise as in coordinates
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
    let linked = of_group.iter().flatten().count();
    let variance: f64 = of_group.into_iter().flatten().map(squared).sum();
    NearestAxes {
        degrees,
        n,
        counts,
        resultant: (n > 0).then(|| squared(sum).sqrt() / n as f64),
        direction: phase(sum, 2., ROUNDING * n as f64),
        p_value: (linked >= FEWEST_GROUPS && variance > 0.)
            .then(|| rayleigh(linked as f64, squared(sum) / variance)),
    }
}

/// Chance that n independent unit vectors without direction have a sum whose square is n·z or more (Wilkie 1983).
fn rayleigh(n: f64, z: f64) -> f64 {
    ((1. + 4. * n + 4. * n * (n - z).max(0.)).sqrt() - (1. + 2. * n)).exp().min(1.)
}

fn ellipse(cells: &Voronoi) -> Option<NeighbourEllipse> {
    let bound = || cells.cells.iter().filter(|c| c.bound).filter_map(|c| c.second_moments);
    let count = bound().count();
    let sum = bound().fold([0.; 3], |sum, m| std::array::from_fn(|k| sum[k] + m[k]));
    let [xx, xy, yy] = sum.map(|v| v / count as f64);
    let (mean, half) = ((xx + yy) / 2., ((xx - yy) / 2.).hypot(xy));
    let [major, minor] = [mean + half, mean - half].map(|v| (2. * v).sqrt());
    (count > 0 && minor > 0.).then(|| NeighbourEllipse {
        cells: count,
        major,
        minor,
        anisotropy: major / minor,
        direction: phase([(xx - yy) / 2., xy], 2., ROUNDING * mean),
    })
}

/// Which points are linked.
struct Groups(Vec<usize>);

impl Groups {
    fn new(n: usize) -> Self {
        Self((0..n).collect())
    }

    fn of(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }

    fn join(&mut self, i: usize, j: usize) {
        let (a, b) = (self.of(i), self.of(j));
        // the lower index stands for the group, so that it does not depend on the order of links
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

    /// A triangular lattice of spacing 1 with rows at `rows` degrees, stretched by `stretch` along the axis at `axis` degrees (both
    /// counter-clockwise in the picture), in a 24 × 18 window and around it, so that cells at its border are those of the lattice.
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
            // up is down in coordinates
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
        // up to the right, half of them the other way round, once across the edge of a torus
        let mut points: Vec<Point> = (0..20).map(|k| Point::new(10. + 19. * f64::from(k), 20.)).collect();
        points.extend(points.clone().iter().map(|p| Point::new(p.x + 3f64.sqrt(), p.y - 1.)));
        let found = of(&points, &window).nearest;
        assert_eq!((found.n, found.counts[2] + found.counts[3]), (40, 40));
        assert!((found.resultant.unwrap() - 1.).abs() < 1e-9);
        assert!((found.direction.unwrap() - 30.).abs() < 1e-9, "{found:?}");
        // 20 groups, not 40
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
                // Kolmogorov and Smirnov's distance is above 1.63/√600 = .067 once in a hundred times
                assert!(worst < 0.067, "window {k}, {n} points: {worst}");
                let rare = p.iter().filter(|&&p| p < 0.05).count();
                assert!((15..=45).contains(&rare), "window {k}, {n} points: {rare} of 600 below .05");
            }
        }
    }

    #[test]
    fn independent_points_that_are_pulled_apart_along_one_axis_are_told() {
        // a minimal distance along x: neighbours stand above each other
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
        // a square has no hexagon
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
