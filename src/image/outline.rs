//! The imaged area of an image as a window: all of the image, a rectangle, or polygons.
//!
//! 1. The mask of imaged pixels is eroded by 1 px, because ragged edges are mixed with black.
//! 2. The outlines of the mask are followed along the edges of its pixels.
//! 3. Oblique lines, which run in steps along pixel edges, are straightened.
//! 4. The outlines are simplified (Douglas and Peucker 1973,
//!    <https://doi.org/10.3138/FM57-6770-U75U-7727>).

use super::imaged::part_of;
use super::{Plane, imaged_mask};
use crate::geometry::{Point, PolygonError, Ring, Window, WindowError};
use image::GrayImage;
use imageproc::distance_transform::Norm;
use imageproc::morphology::erode_mut;

/// Width, in px, of the margin that is removed next to pixels that were not imaged.
///
/// At ragged edges, registration has mixed pixels with black. Nothing is removed if the imaged area
/// is an upright rectangle.
const MARGIN: u8 = 1;
/// Smallest area of an island of imaged pixels that is kept, as a fraction of the image.
///
/// Smaller islands are specks and letters rather than parts of a mosaic. They are kept only if no
/// island is larger.
const SMALLEST_ISLAND: f64 = 0.001;
/// Smallest length, in px, of a straight run of pixel edges that stays an edge of the outline.
///
/// Shorter runs may be steps of an oblique line, which is levelled.
const LONG_RUN: f64 = 16.;
/// Largest distance, in px, between an omitted corner and the simplified outline.
const TOLERANCE: f64 = 0.5;

/// Returns the part of an image that was imaged ([`imaged_mask`]) as a window in px.
///
/// The window is all of the image, a rectangle, or polygons. Polygons follow the edges of the
/// pixels that lie at least 1 px within the mask; at the border of the image itself there is no
/// such margin. The steps of oblique lines are levelled, and the result is simplified to 0.5 px
/// (Douglas and Peucker 1973, <https://doi.org/10.3138/FM57-6770-U75U-7727>).
///
/// # Errors
/// Fails if the image has no pixels.
pub fn imaged_area(plane: &Plane) -> Result<Window, WindowError> {
    let (height, width) = plane.dim();
    let whole = || Window::of_image(width, height);
    let Some(mut mask) = imaged_mask(plane) else { return whole() };
    let Some(part) = part_of(&mask, width) else { return whole() };
    let (left, top) = (part.left as f64 - 0.5, part.top as f64 - 0.5);
    let bounds = Window::rectangle(left, top, left + part.width as f64, top + part.height as f64)?;
    if mask.iter().filter(|v| **v).count() == part.width * part.height {
        return Ok(bounds);
    }
    erode(&mut mask, width, MARGIN);
    let mut rings = rings(&mask, width);
    let area = |ring: &Ring| {
        let next = ring.iter().cycle().skip(1);
        ring.iter().zip(next).map(|(a, b)| a.x * b.y - b.x * a.y).sum::<f64>().abs() / 2.
    };
    let largest = rings.iter().map(area).fold(0., f64::max);
    let least = largest.min(SMALLEST_ISLAND * plane.len() as f64);
    rings.retain(|ring| area(ring) >= least);
    let levelled: Vec<Ring> = rings.iter().map(|ring| levelled(ring)).collect();
    let simplified = levelled.iter().map(|ring| simplified(ring, TOLERANCE)).collect();
    match Window::polygon(simplified) {
        // simplification can make two parts of the outline cross where they run within a pixel of
        // each other
        Err(PolygonError::Crosses { .. }) => Ok(Window::polygon(levelled).unwrap_or(bounds)),
        outline => Ok(outline.unwrap_or(bounds)),
    }
}

/// Removes from a mask all pixels that are at most `margin` px along x and along y away from a
/// pixel outside the mask.
///
/// Each row of the mask has `width` pixels.
fn erode(mask: &mut [bool], width: usize, margin: u8) {
    let height = mask.len() / width;
    let (Ok(w), Ok(h)) = (u32::try_from(width), u32::try_from(height)) else { return };
    let inside = mask.iter().map(|v| if *v { u8::MAX } else { 0 }).collect();
    if let Some(mut picture) = GrayImage::from_raw(w, h, inside) {
        erode_mut(&mut picture, Norm::LInf, margin);
        mask.iter_mut().zip(picture.as_raw()).for_each(|(v, inside)| *v = *inside > 0);
    }
}

/// Returns the outlines of a mask along the edges of its pixels, as corners in px.
///
/// An outline runs with the inside on its right. Pixels that touch only at a corner are separate.
fn rings(mask: &[bool], width: usize) -> Vec<Ring> {
    /// Steps to the right, down, left and up.
    const STEPS: [(isize, isize); 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];
    /// Pixel on the left of the way ahead, relative to the current corner, for each of the steps.
    const AHEAD_LEFT: [(isize, isize); 4] = [(0, -1), (0, 0), (-1, 0), (-1, -1)];
    /// Pixel on the right of the way ahead, relative to the current corner, for each of the steps.
    const AHEAD_RIGHT: [(isize, isize); 4] = [(0, 0), (-1, 0), (-1, -1), (0, -1)];
    let height = mask.len() / width;
    let inside = |x: isize, y: isize| {
        let within = x >= 0 && y >= 0 && x < width as isize && y < height as isize;
        within && mask[y as usize * width + x as usize]
    };
    let mut rings = Vec::new();
    // pixels whose upper edge an outline has followed: none of them starts another outline
    let mut followed = vec![false; mask.len()];
    for start in 0..mask.len() {
        let (x0, y0) = ((start % width) as isize, (start / width) as isize);
        if !mask[start] || followed[start] || inside(x0, y0 - 1) {
            continue;
        }
        let (mut x, mut y, mut heading) = (x0, y0, 0);
        let mut ring = Ring::new();
        loop {
            ring.push(Point::new(x as f64 - 0.5, y as f64 - 0.5));
            loop {
                if heading == 0 {
                    followed[y as usize * width + x as usize] = true;
                }
                (x, y) = (x + STEPS[heading].0, y + STEPS[heading].1);
                let side =
                    |offsets: [(isize, isize); 4]| inside(x + offsets[heading].0, y + offsets[heading].1);
                if !side(AHEAD_RIGHT) {
                    heading = (heading + 1) % 4;
                    break;
                }
                if side(AHEAD_LEFT) {
                    heading = (heading + 3) % 4;
                    break;
                }
            }
            if (x, y, heading) == (x0, y0, 0) {
                break;
            }
        }
        rings.push(ring);
    }
    rings
}

/// Returns a ring along pixel edges with its steps of 1 px levelled.
///
/// Along a digital straight line, every second run of edges is 1 px long, and the middles of the
/// runs lie on the line. These middles replace the corners of such steps.
fn levelled(ring: &[Point]) -> Ring {
    let n = ring.len();
    let next = |k: usize| ring[(k + 1) % n];
    let lengths: Vec<f64> = (0..n).map(|k| ring[k].distance(next(k))).collect();
    // lengths are whole numbers of px, so a run below 1.5 px is one of 1 px
    let is_step = |k: usize| lengths[(k + n - 1) % n] < 1.5 || lengths[k % n] < 1.5;
    let mut level = Ring::with_capacity(n);
    for k in 0..n {
        let (from, to, length) = (ring[k], next(k), lengths[k]);
        let at = |t: f64| Point::new(from.x + t * (to.x - from.x), from.y + t * (to.y - from.y));
        let (starts, ends) = (is_step(k), is_step(k + 1));
        if !starts {
            level.push(from);
        }
        if length < LONG_RUN {
            if starts || ends {
                level.push(at(0.5));
            }
            continue;
        }
        // a long run stays an edge of the outline; only its last pixel next to a step is levelled
        if starts {
            level.push(at(1. / length));
        }
        if ends {
            level.push(at(1. - 1. / length));
        }
    }
    level
}

/// Returns the ring with fewer corners, so that no omitted corner is farther than `tolerance` px
/// from the result.
///
/// The method is that of Douglas and Peucker (1973).
fn simplified(ring: &[Point], tolerance: f64) -> Ring {
    let Some(&first) = ring.first() else { return Ring::new() };
    let far = (0..ring.len()).max_by(|&a, &b| ring[a].distance(first).total_cmp(&ring[b].distance(first)));
    let far = far.unwrap_or(0);
    let at = |k: usize| ring[k % ring.len()];
    let mut kept = vec![false; ring.len()];
    let mut open = vec![(0, far), (far, ring.len())];
    while let Some((from, to)) = open.pop() {
        kept[from] = true;
        let (a, b) = (at(from), at(to));
        let length = a.distance(b);
        let away = |k: usize| {
            let p = at(k);
            if length == 0. {
                return p.distance(a);
            }
            ((b.x - a.x) * (p.y - a.y) - (p.x - a.x) * (b.y - a.y)).abs() / length
        };
        let farthest = (from + 1..to).map(|k| (away(k), k)).max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((distance, k)) = farthest
            && distance > tolerance
        {
            open.push((from, k));
            open.push((k, to));
        }
    }
    ring.iter().zip(kept).filter_map(|(p, keep)| keep.then_some(*p)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Rectangle;

    fn imaged(width: usize, height: usize, inside: impl Fn(f64, f64) -> bool) -> Plane {
        Plane::from_shape_fn((height, width), |(y, x)| f32::from(u8::from(inside(x as f64, y as f64))))
    }

    #[test]
    fn straight_margins_leave_rectangles_to_the_pixel() {
        let whole = imaged_area(&imaged(60, 40, |_, _| true)).unwrap();
        assert_eq!(whole, Window::of_image(60, 40).unwrap());
        let framed = imaged_area(&imaged(100, 80, |x, y| x > 9. && y < 70.)).unwrap();
        assert_eq!(framed, Window::rectangle(9.5, -0.5, 99.5, 69.5).unwrap());
        let black = imaged_area(&Plane::zeros((30, 40))).unwrap();
        assert_eq!(black, Window::of_image(40, 30).unwrap());
        assert!(imaged_area(&Plane::zeros((0, 0))).is_err());
    }

    #[test]
    fn overlapping_tiles_leave_their_outline_one_pixel_within() {
        let plane = imaged(200, 150, |x, y| (x < 120. && y < 90.) || (x >= 60. && y >= 50. && x < 180.));
        let window = imaged_area(&plane).unwrap();
        // one ring of eight corners: the image's own border costs no margin
        let corners = [
            (-0.5, -0.5),
            (118.5, -0.5),
            (118.5, 50.5),
            (178.5, 50.5),
            (178.5, 149.5),
            (60.5, 149.5),
            (60.5, 88.5),
            (-0.5, 88.5),
        ];
        let expected =
            Window::polygon(vec![corners.iter().map(|&(x, y)| Point::new(x, y)).collect()]).unwrap();
        assert_eq!(window, expected);
    }

    #[test]
    fn oblique_edges_become_few_corners_within_a_pixel() {
        // a square turned by 20°, as a registered tile is
        let (sin, cos) = 20f64.to_radians().sin_cos();
        let turned = |x: f64, y: f64| (cos * x + sin * y, cos * y - sin * x);
        let plane = imaged(400, 400, |x, y| {
            let (u, v) = turned(x - 200., y - 200.);
            u.abs() <= 130. && v.abs() <= 130.
        });
        let window = imaged_area(&plane).unwrap();
        let corners: usize = window.rings().iter().map(Vec::len).sum();
        assert!(corners <= 40, "{corners}");
        // 1 px of margin along x and y is .64 to 1.28 px across an edge of 20°
        let side = 2. * (130. - f64::midpoint(0.64, 1.28));
        assert!((window.area() / (side * side) - 1.).abs() < 0.004, "{} {}", window.area(), side * side);
        for ring in window.rings() {
            for p in ring {
                let (u, v) = turned(p.x - 200., p.y - 200.);
                let beyond = u.abs().max(v.abs()) - 130.;
                assert!((-3. ..0.).contains(&beyond), "{p:?}: {beyond}");
            }
        }
    }

    #[test]
    fn specks_are_no_part_of_the_area_and_separate_tiles_are() {
        let tile = |x: f64, y: f64| (x < 80. && y < 80.) || (x > 120. && y > 120.);
        let plane = imaged(200, 200, |x, y| tile(x, y) || (x == 150. && y == 20.));
        let window = imaged_area(&plane).unwrap();
        assert_eq!(window.rings().len(), 2);
        assert_eq!(window.area(), 79. * 79. + 78. * 78.);
        assert!(!window.contains(Point::new(150., 20.)));
    }

    #[test]
    fn rough_outlines_keep_their_area_within_half_a_pixel_of_their_length() {
        for seed in 0..20 {
            let wave = |a: f64, k: u32| (a * f64::from(k) + f64::from(seed)).sin() * 6. / f64::from(k);
            let plane = imaged(150, 150, |x, y| {
                let (u, v) = (x - 75., y - 75.);
                let angle = v.atan2(u);
                u.hypot(v) < 45. + wave(angle, 3) + wave(angle, 11) + wave(angle, 40)
            });
            let mut mask = imaged_mask(&plane).unwrap();
            erode(&mut mask, 150, MARGIN);
            let pixels = mask.iter().filter(|v| **v).count() as f64;
            let area = imaged_area(&plane).unwrap().area();
            assert!((area / pixels - 1.).abs() < 0.015, "{seed}: {area} {pixels}");
        }
    }

    #[test]
    fn erosion_takes_a_square_neighbourhood_but_nothing_at_the_border() {
        let mut mask = vec![true; 49];
        mask[24] = false;
        erode(&mut mask, 7, 2);
        assert_eq!(mask.iter().filter(|v| !**v).count(), 25);
        let frame = Rectangle::new(0.5, 0.5, 5.5, 5.5).unwrap();
        for (k, &kept) in mask.iter().enumerate() {
            assert_eq!(kept, !frame.contains(Point::new((k % 7) as f64, (k / 7) as f64)), "{k}");
        }
    }
}
