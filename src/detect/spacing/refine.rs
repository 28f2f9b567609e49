use crate::geometry::Point;
use crate::mosaic::hexagonal_spacing;

/// Cones nearer to the border than this, in px, are left out of the count: filters see half of them.
pub const BORDER: f64 = 7.;

/// Detections may move the spacing this far from the ring's, as a factor e^±0.35: beyond, they are not to be trusted.
const TRUST: f64 = 0.35;

/// Spacing by the density of `centres` in an image of `width` × `height` px: s = √(2A/(√3 n)), n and A inside the
/// 7 px border, held within e^±0.35 of the ring's spacing.
pub fn refined(centres: &[Point], width: usize, height: usize, ring_spacing: f64) -> f64 {
    let border = BORDER.min(width.min(height) as f64 / 4.);
    let (right, lower) = (width as f64 - 0.5 - border, height as f64 - 0.5 - border);
    let near = border - 0.5;
    let inside = centres.iter().filter(|p| p.x > near && p.x < right && p.y > near && p.y < lower).count();
    let area = (width as f64 - 2. * border) * (height as f64 - 2. * border);
    let by_density = hexagonal_spacing(inside.max(1), area).unwrap_or(ring_spacing);
    ring_spacing * (by_density / ring_spacing).ln().clamp(-TRUST, TRUST).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lattice(step: f64, side: usize) -> Vec<Point> {
        let cells = (side as f64 / step) as usize;
        (0..cells * cells)
            .map(|k| Point::new(((k % cells) as f64 + 0.5) * step, ((k / cells) as f64 + 0.5) * step))
            .collect()
    }

    #[test]
    fn density_corrects_a_ring_that_is_a_little_off() {
        let square_lattice = lattice(10., 300);
        let expected = 10. * (2. / 3f64.sqrt()).sqrt();
        assert!((refined(&square_lattice, 300, 300, 12.) / expected - 1.).abs() < 0.03);
    }

    #[test]
    fn detections_cannot_carry_the_spacing_far_from_the_ring() {
        assert!((refined(&[], 100, 100, 10.) - 10. * 0.35f64.exp()).abs() < 1e-9);
        assert!((refined(&lattice(2., 100), 100, 100, 10.) - 10. * (-0.35f64).exp()).abs() < 1e-9);
    }
}
