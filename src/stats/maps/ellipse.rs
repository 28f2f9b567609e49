//! Least-squares fit of an ellipse to a closed line (Fitzgibbon, Pilu & Fisher 1999; Halíř &
//! Flusser 1998).
//!
//! 1. Centre and scale the line, and weight each piece by its length.
//! 2. Eliminate the linear coefficients of the conic from its scatter matrices.
//! 3. Take the eigenvector of the remaining 3 × 3 matrix that satisfies the ellipse constraint.
//! 4. Convert the coefficients to centre, semi-axes and direction.

use super::Contour;
use crate::geometry::Point;
use crate::numeric::{eigenvalues, eigenvector, inverted};
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Ellipse in the plane, by centre, semi-axes and direction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ellipse {
    /// Centre of the ellipse, in units of the coordinates.
    pub centre: Point,
    /// Longer semi-axis, in units of the coordinates.
    pub semi_major: f64,
    /// Shorter semi-axis, in units of the coordinates.
    pub semi_minor: f64,
    /// Direction of the longer axis in degrees, 0 to 180, from the positive x axis towards the
    /// positive y axis.
    ///
    /// Because y points down, this is clockwise as seen in the picture, opposite in sense to the
    /// angles of [`Orientation`](super::super::Orientation).
    pub degrees: f64,
}

/// Fits the ellipse of least algebraic distance to a closed line, whose pieces are weighted by
/// their lengths.
///
/// Returns `None` if the line is not closed, has fewer than 6 points (5 points determine a conic,
/// so nothing would be fitted), or no ellipse fits it.
///
/// Sources: Fitzgibbon, Pilu & Fisher (1999), <https://doi.org/10.1109/34.765658>; solved by the
/// method of Halíř & Flusser (1998).
pub(super) fn fitted_ellipse(contour: &Contour) -> Option<Ellipse> {
    let length = contour.length();
    if !contour.closed || contour.places.len() < 6 || !(length.is_finite() && length > 0.) {
        return None;
    }
    // The midpoints of the pieces are taken relative to their centroid and scaled by the length of
    // the line, so that all numbers are near 1 and rounding does little harm.
    let next = contour.places.iter().cycle().skip(1);
    let pieces: Vec<(Point, f64)> = contour
        .places
        .iter()
        .zip(next)
        .map(|(a, b)| (Point::new((a.x + b.x) / 2., (a.y + b.y) / 2.), a.distance(*b) / length))
        .collect();
    let mean = |value: fn(&Point) -> f64| pieces.iter().map(|(p, w)| w * value(p)).sum::<f64>();
    let middle = Point::new(mean(|p| p.x), mean(|p| p.y));
    let size = length / TAU;
    let (mut s1, mut s2, mut s3) = ([[0.; 3]; 3], [[0.; 3]; 3], [[0.; 3]; 3]);
    for &(p, weight) in &pieces {
        let (x, y) = ((p.x - middle.x) / size, (p.y - middle.y) / size);
        let (quadratic, linear) = ([x * x, x * y, y * y], [x, y, 1.]);
        for i in 0..3 {
            for j in 0..3 {
                s1[i][j] += weight * quadratic[i] * quadratic[j];
                s2[i][j] += weight * quadratic[i] * linear[j];
                s3[i][j] += weight * linear[i] * linear[j];
            }
        }
    }
    // The linear part a₂ of the conic follows from its quadratic part a₁: a₂ = T a₁, T = −S₃⁻¹ S₂ᵀ.
    let inverse = inverted(s3)?;
    let t = std::array::from_fn(|i| {
        std::array::from_fn(|j| -(0..3).map(|k| inverse[i][k] * s2[j][k]).sum::<f64>())
    });
    let t: [[f64; 3]; 3] = t;
    let reduced: [[f64; 3]; 3] = std::array::from_fn(|i| {
        std::array::from_fn(|j| s1[i][j] + (0..3).map(|k| s2[i][k] * t[k][j]).sum::<f64>())
    });
    let m = [reduced[2].map(|v| v / 2.), reduced[1].map(|v| -v), reduced[0].map(|v| v / 2.)];
    // The ellipse constraint is 4ac − b² > 0; only one eigenvector satisfies it.
    let quadratic = eigenvalues(m)
        .into_iter()
        .filter_map(|value| eigenvector(m, value))
        .find(|a| 4. * a[0] * a[2] - a[1] * a[1] > 0.)?;
    let linear: [f64; 3] = std::array::from_fn(|i| (0..3).map(|k| t[i][k] * quadratic[k]).sum());
    let found = geometric(quadratic, linear)?;
    let centre = Point::new(middle.x + size * found.centre.x, middle.y + size * found.centre.y);
    Some(Ellipse {
        centre,
        semi_major: size * found.semi_major,
        semi_minor: size * found.semi_minor,
        degrees: found.degrees,
    })
}

/// Converts a x² + b xy + c y² + d x + e y + f = 0 to an ellipse.
///
/// Returns `None` if the equation does not describe an ellipse.
fn geometric([a, b, c]: [f64; 3], [d, e, f]: [f64; 3]) -> Option<Ellipse> {
    let determinant = 4. * a * c - b * b;
    let centre = Point::new((b * e - 2. * c * d) / determinant, (b * d - 2. * a * e) / determinant);
    let constant = f + (d * centre.x + e * centre.y) / 2.;
    let (mean, half) = ((a + c) / 2., ((a - c) / 2.).hypot(b / 2.));
    let axis = |curvature: f64| (-constant / curvature).sqrt();
    let (one, other) = (axis(mean + half), axis(mean - half));
    if !(one.is_finite() && other.is_finite() && one > 0. && other > 0.) {
        return None;
    }
    // `steep` is the direction of the greater eigenvalue of the quadratic form: the shorter axis if
    // the form is positive, the longer axis if it is negative.
    let steep = b.atan2(a - c) / 2.;
    let along = if one < other { steep + PI / 2. } else { steep };
    Some(Ellipse {
        centre,
        semi_major: one.max(other),
        semi_minor: one.min(other),
        degrees: along.to_degrees().rem_euclid(180.),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(centre: Point, a: f64, b: f64, degrees: f64, n: usize, wobble: f64) -> Contour {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let places = (0..n)
            .map(|k| {
                // Uneven spacing makes the weights matter.
                let t = TAU * (k as f64 / n as f64).powf(1.3);
                let scale = 1. + wobble * (7. * t).sin();
                let (u, v) = (a * scale * t.cos(), b * scale * t.sin());
                Point::new(centre.x + u * cos - v * sin, centre.y + u * sin + v * cos)
            })
            .collect();
        Contour { places, closed: true }
    }

    #[test]
    fn an_ellipse_is_found_again_wherever_it_lies() {
        for (degrees, a, b) in [(30., 5., 3.), (120., 50., 49.), (0., 7., 1.), (90., 2., 1.)] {
            let centre = Point::new(1000., -70.);
            let found = fitted_ellipse(&line(centre, a, b, degrees, 400, 0.)).unwrap();
            assert!(found.centre.distance(centre) < 1e-2 * b, "{found:?}");
            assert!((found.semi_major / a - 1.).abs() < 1e-2 && (found.semi_minor / b - 1.).abs() < 1e-2);
            if a / b > 1.1 {
                let off = (found.degrees - degrees + 90.).rem_euclid(180.) - 90.;
                assert!(off.abs() < 1., "{degrees}: {found:?}");
            }
        }
    }

    #[test]
    fn a_ragged_line_moves_the_middle_little() {
        let centre = Point::new(3., 4.);
        let found = fitted_ellipse(&line(centre, 5., 4., 20., 300, 0.05)).unwrap();
        assert!(found.centre.distance(centre) < 0.1, "{found:?}");
    }

    #[test]
    fn lines_without_an_ellipse_have_none() {
        let open = Contour { closed: false, ..line(Point::new(0., 0.), 2., 1., 0., 50, 0.) };
        assert_eq!(fitted_ellipse(&open), None);
        let straight =
            Contour { places: (0..9).map(|k| Point::new(f64::from(k), 1.)).collect(), closed: true };
        assert_eq!(fitted_ellipse(&straight), None);
        let place = Contour { places: vec![Point::new(1., 1.); 9], closed: true };
        assert_eq!(fitted_ellipse(&place), None);
    }
}
