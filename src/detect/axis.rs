//! Direction in which a split-detector image shows the derivative, and images turned so that this
//! direction runs along x.
//!
//! 1. The structure tensor of the smoothed image gives the direction of the steepest slopes: the
//!    power of a derivative along an axis goes with cos² of the angle to that axis.
//! 2. A direction close to x or y counts as x or y. The marked images all have x, and their
//!    estimates scatter around it.
//! 3. Filters and networks expect the axis along x, so the image is turned for them. Turns by
//!    multiples of 90° move pixels and change none; others interpolate (Lanczos with three lobes).

use super::{Detection, Detections, SpacingMap};
use crate::geometry::Point;
use crate::image::{Plane, fill_rows, gaussian, mirror};

/// Standard deviation, in spacings, of the Gaussian that smooths an image before slopes are taken.
const SMOOTH: f64 = 0.15;
/// Smallest strength (0–1) of an axis that is believed; that of a perfect derivative of an
/// isotropic mosaic is .5.
pub(super) const CLEAR_AXIS: f64 = 0.15;
/// Largest angle, in degrees, to x or y of an axis that counts as x or y.
const SNAP: f64 = 20.;
/// Number of pixels on either side of a place that its interpolated value depends on.
const LOBES: isize = 3;

/// Returns the direction of the steepest slopes of the flattened image `flat`, whose cones are
/// `spacing` px apart, and its strength.
///
/// The direction is in degrees counter-clockwise as seen, from x, 0 to below 180. The strength is
/// the difference of the eigenvalues of the structure tensor over their sum: 0 without a direction,
/// 1 for stripes.
pub(super) fn axis(flat: &Plane, spacing: f64) -> (f64, f64) {
    let smooth = gaussian(flat, SMOOTH * spacing);
    let (height, width) = smooth.dim();
    let (mut xx, mut xy, mut yy) = (0., 0., 0.);
    for y in 1..height.saturating_sub(1) {
        for x in 1..width.saturating_sub(1) {
            let along_x = f64::from(smooth[[y, x + 1]] - smooth[[y, x - 1]]);
            let along_y = f64::from(smooth[[y + 1, x]] - smooth[[y - 1, x]]);
            xx += along_x * along_x;
            xy += along_x * along_y;
            yy += along_y * along_y;
        }
    }
    // y points down, the angle is counted upwards
    let angle = (0.5 * (-2. * xy).atan2(xx - yy)).to_degrees();
    let strength = (xx - yy).hypot(2. * xy) / (xx + yy).max(f64::MIN_POSITIVE);
    (wrapped(angle), strength)
}

/// Returns the same direction in degrees from 0 to below 180.
pub(super) fn wrapped(angle: f64) -> f64 {
    let angle = angle.rem_euclid(180.);
    if angle < 180. { angle } else { 0. }
}

/// Returns 0 or 90 for an angle (degrees, 0–180) close to x or y, and any other angle as it is.
pub(super) fn snapped(angle: f64) -> f64 {
    let quarters = (angle / 90.).round();
    if (angle - 90. * quarters).abs() <= SNAP { wrapped(90. * quarters) } else { angle }
}

/// A turn of an image by which the direction at an angle comes to run along x.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// Cosine of the angle; exact for multiples of 90°.
    cos: f64,
    /// Sine of the angle; exact for multiples of 90°.
    sin: f64,
    /// Width and height of the image in px.
    size: [usize; 2],
    /// Width and height of the turned image in px.
    turned: [usize; 2],
}

impl Turn {
    /// Returns the turn of an image of `height` × `width` px by `angle`, in degrees
    /// counter-clockwise as seen; the turned image holds all of the image.
    pub(super) fn whole(angle: f64, (height, width): (usize, usize)) -> Self {
        let [cos, sin] = cos_sin(angle);
        let (w, h) = (width as f64, height as f64);
        let side = |length: f64| (length - 1e-9).ceil().max(1.) as usize;
        let turned = [side(w * cos.abs() + h * sin.abs()), side(w * sin.abs() + h * cos.abs())];
        Self { cos, sin, size: [width, height], turned }
    }

    /// Returns the turn as [`Turn::whole`] of which only a rectangle in the middle is kept, all of
    /// it inside the image.
    pub(super) fn inside(angle: f64, (height, width): (usize, usize)) -> Self {
        let whole = Self::whole(angle, (height, width));
        let [w, h] = whole.turned.map(|v| v as f64);
        let scale = (width as f64 / w.max(1.)).min(height as f64 / h.max(1.)).min(1.);
        let [cos, sin] = [whole.cos, whole.sin];
        if cos * sin == 0. {
            return whole;
        }
        let part = |length: f64| ((length * scale) as usize).max(1);
        // the rectangle has the shape of the image, so that its corners reach the edges together
        let turned = [part(width as f64), part(height as f64)];
        Self { turned, ..whole }
    }

    /// Returns the same turn for an image of `times` as many pixels along each side.
    pub(super) fn scaled(&self, times: usize) -> Self {
        Self { size: self.size.map(|v| v * times), turned: self.turned.map(|v| v * times), ..*self }
    }

    /// Returns the place in the image of a place in the turned image, in px.
    fn back(&self, p: Point) -> Point {
        let [x, y] = [p.x - 0.5 * (self.turned[0] as f64 - 1.), p.y - 0.5 * (self.turned[1] as f64 - 1.)];
        Point::new(
            x * self.cos + y * self.sin + 0.5 * (self.size[0] as f64 - 1.),
            -x * self.sin + y * self.cos + 0.5 * (self.size[1] as f64 - 1.),
        )
    }

    /// Returns the place in the turned image of a place in the image, in px.
    fn there(&self, p: Point) -> Point {
        let [x, y] = [p.x - 0.5 * (self.size[0] as f64 - 1.), p.y - 0.5 * (self.size[1] as f64 - 1.)];
        Point::new(
            x * self.cos - y * self.sin + 0.5 * (self.turned[0] as f64 - 1.),
            x * self.sin + y * self.cos + 0.5 * (self.turned[1] as f64 - 1.),
        )
    }

    /// Returns whether a place in px lies in the image.
    fn holds(&self, p: Point) -> bool {
        let within = |v: f64, length: usize| v > -0.5 && v < length as f64 - 0.5;
        within(p.x, self.size[0]) && within(p.y, self.size[1])
    }

    /// Returns the turned image, mirrored beyond the edges of the image.
    pub(super) fn of(&self, image: &Plane) -> Plane {
        let (height, width) = image.dim();
        let [columns, rows] = self.turned;
        fill_rows(rows, columns, |y, out| {
            for (x, o) in out.iter_mut().enumerate() {
                let p = self.back(Point::new(x as f64, y as f64));
                let ((i, wx), (j, wy)) = (weights(p.x), weights(p.y));
                if wx[2] == 1. && wy[2] == 1. {
                    *o = image[[mirror(j + 2, height), mirror(i + 2, width)]];
                    continue;
                }
                let columns: [usize; 6] = std::array::from_fn(|k| mirror(i + k as isize, width));
                *o = (0..6)
                    .map(|k| {
                        let row = mirror(j + k as isize, height);
                        wy[k] * (0..6).map(|l| wx[l] * image[[row, columns[l]]]).sum::<f32>()
                    })
                    .sum();
            }
        })
    }

    /// Returns a mask of the turned image, row by row: `true` where it shows a pixel for which
    /// `imaged(column, row)` is true; `None` if it is true everywhere.
    pub(super) fn mask(&self, imaged: impl Fn(usize, usize) -> bool) -> Option<Vec<bool>> {
        let [columns, rows] = self.turned;
        let mask: Vec<bool> = (0..columns * rows)
            .map(|k| {
                let p = self.back(Point::new((k % columns) as f64, (k / columns) as f64));
                self.holds(p) && imaged((p.x + 0.5) as usize, (p.y + 0.5) as usize)
            })
            .collect();
        mask.contains(&false).then_some(mask)
    }

    /// Turns detections in the turned image back; those outside the image are dropped.
    pub(super) fn restore(&self, found: &mut Detections) {
        let back = |all: &mut Vec<Detection>| {
            all.iter_mut().for_each(|d| d.centre = self.back(d.centre));
            all.retain(|d| self.holds(d.centre));
        };
        back(&mut found.cones);
        back(&mut found.rejected);
        if found.spacing_map.is_constant() {
            return;
        }
        let nodes = |length: usize| -> Vec<f64> {
            let count = ((length as f64 / (4. * found.spacing)).round() as usize).max(2);
            (0..count).map(|k| (k as f64 + 0.5) * length as f64 / count as f64 - 0.5).collect()
        };
        let (x, y) = (nodes(self.size[0]), nodes(self.size[1]));
        let at = |x: f64, y: f64| Some(found.spacing_map.at(self.there(Point::new(x, y))));
        let spacing: Vec<_> = y.iter().flat_map(|&y| x.iter().map(move |&x| at(x, y))).collect();
        found.spacing_map = SpacingMap::on_grid(x, y, &spacing, found.spacing);
        found.spacing = found.spacing_map.typical();
    }
}

/// Returns cosine and sine of an angle in degrees; they are exact for multiples of 90°.
fn cos_sin(angle: f64) -> [f64; 2] {
    match angle.rem_euclid(360.) {
        0. => [1., 0.],
        90. => [0., 1.],
        180. => [-1., 0.],
        270. => [0., -1.],
        angle => [angle.to_radians().cos(), angle.to_radians().sin()],
    }
}

/// Returns the first of six pixels around `place`, and their weights in the interpolation; the
/// weights are exactly 0 and 1 on a pixel.
fn weights(place: f64) -> (isize, [f32; 6]) {
    let below = place.floor();
    let part = place - below;
    let first = below as isize - LOBES + 1;
    if part == 0. {
        return (first, [0., 0., 1., 0., 0., 0.]);
    }
    let sinc = |x: f64| if x == 0. { 1. } else { x.sin() / x };
    let weight: [f64; 6] = std::array::from_fn(|k| {
        let x = std::f64::consts::PI * (k as f64 - 2. - part);
        sinc(x) * sinc(x / LOBES as f64)
    });
    let sum: f64 = weight.iter().sum();
    (first, weight.map(|w| (w / sum) as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn waves(angle: f64) -> Plane {
        let (s, c) = angle.to_radians().sin_cos();
        Plane::from_shape_fn((80, 100), |(y, x)| {
            let along = x as f64 * c - y as f64 * s;
            let across = x as f64 * s + y as f64 * c;
            ((0.8 * along).sin() + 0.4 * (0.8 * across).sin()) as f32
        })
    }

    #[test]
    fn the_axis_is_the_direction_of_the_steepest_slopes() {
        for angle in [0., 30., 75., 90., 120., 165.] {
            let (found, strength) = axis(&waves(angle), 8.);
            let off = (found - angle + 90.).rem_euclid(180.) - 90.;
            assert!(off.abs() < 3. && strength > 0.5, "{found} for {angle}, {strength}");
        }
    }

    #[test]
    fn quarter_turns_move_pixels_and_points_go_back_to_where_they_were() {
        let image = waves(20.);
        let turned = Turn::whole(90., image.dim()).of(&image);
        assert_eq!(turned.dim(), (100, 80));
        for ((y, x), value) in turned.indexed_iter() {
            assert_eq!(*value, image[[79 - x, y]]);
        }
        for angle in [0., 30., 90., 123.] {
            let turn = Turn::whole(angle, image.dim());
            let p = Point::new(12.3, 45.6);
            assert!(turn.back(turn.there(p)).distance(p) < 1e-9);
        }
    }
}
