//! Smooth marks: a pixel takes ink by its distance from the middle of the stroke.
//!
//! 1. The distance from the pixel's centre to the stroke is computed exactly.
//! 2. The coverage is half the thickness plus ½ px less that distance, clamped to 0..1.

/// The form of a stroke or a spot, in px of the image it is drawn on.
///
/// Pixel (0, 0) is centred at (0, 0). The circles and lines of imageproc have whole-pixel centres,
/// which would shift a mark by up to half a pixel.
#[derive(Clone, Copy, Debug)]
pub(in crate::report) enum Shape {
    /// A disc that is filled.
    Disc,
    /// The outline of a circle.
    Ring,
    /// A plus sign of two strokes.
    Plus,
    /// A cross of two diagonal strokes.
    Cross,
}

impl Shape {
    /// Returns the distance from (dx, dy), measured from the centre, to the line.
    ///
    /// For a disc it is the distance to its edge, negative inside.
    fn distance(self, dx: f64, dy: f64, radius: f64) -> f64 {
        let arm = |along: f64, across: f64| {
            let beyond = (along.abs() - radius).max(0.);
            (beyond * beyond + across * across).sqrt()
        };
        match self {
            Self::Disc => (dx * dx + dy * dy).sqrt() - radius,
            Self::Ring => ((dx * dx + dy * dy).sqrt() - radius).abs(),
            Self::Plus => arm(dx, dy).min(arm(dy, dx)),
            Self::Cross => {
                let (u, v) = (
                    (dx + dy) * std::f64::consts::FRAC_1_SQRT_2,
                    (dx - dy) * std::f64::consts::FRAC_1_SQRT_2,
                );
                arm(u, v).min(arm(v, u))
            }
        }
    }

    /// Calls `paint(x, y, coverage)` for every pixel of a `width` × `height` image that a line of
    /// `thickness` px touches.
    ///
    /// `coverage` is in (0, 1]. The thickness of a disc is 0.
    pub(in crate::report) fn cover(
        self,
        (width, height): (u32, u32),
        (x, y): (f64, f64),
        radius: f64,
        thickness: f64,
        mut paint: impl FnMut(u32, u32, f64),
    ) {
        let reach = radius + thickness / 2. + 1.;
        let span = |centre: f64, size: u32| {
            let first = (centre - reach).ceil().max(0.);
            let last = (centre + reach).floor().min(f64::from(size) - 1.);
            if first <= last { first as u32..last as u32 + 1 } else { 0..0 }
        };
        for row in span(y, height) {
            for column in span(x, width) {
                let away = self.distance(f64::from(column) - x, f64::from(row) - y, radius);
                let coverage = (thickness / 2. + 0.5 - away).clamp(0., 1.);
                if coverage > 0. {
                    paint(column, row, coverage);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(shape: Shape, centre: (f64, f64), radius: f64, thickness: f64) -> f64 {
        let mut sum = 0.;
        shape.cover((64, 64), centre, radius, thickness, |_, _, coverage| sum += coverage);
        sum
    }

    #[test]
    fn coverage_sums_to_the_area_wherever_the_centre_lies() {
        for centre in [(32., 32.), (31.3, 32.8), (32.5, 32.5)] {
            let disc = area(Shape::Disc, centre, 5., 0.);
            let ring = area(Shape::Ring, centre, 8., 1.5);
            assert!((disc / (25. * std::f64::consts::PI) - 1.).abs() < 0.03, "{disc}");
            assert!((ring / (2. * std::f64::consts::PI * 8. * 1.5) - 1.).abs() < 0.03, "{ring}");
        }
    }

    #[test]
    fn marks_beyond_the_border_are_cut_not_wrapped() {
        assert_eq!(area(Shape::Disc, (-20., 10.), 3., 0.), 0.);
        assert_eq!(area(Shape::Disc, (1e9, f64::NAN), 3., 0.), 0.);
        assert!(area(Shape::Plus, (0., 0.), 6., 1.) < area(Shape::Plus, (32., 32.), 6., 1.) * 0.7);
    }
}
