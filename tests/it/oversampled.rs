//! Images with so many pixels that the cones are farther apart, in px, than filters and networks
//! are made for.

use crate::common;
use conemosaic::detect::{DetectOptions, Detections, Detector, detect};
use conemosaic::geometry::Point;
use conemosaic::image::{Plane, crop};
use image::imageops::{FilterType, resize};
use image::{ImageBuffer, Luma};

/// Length, in px, of the black triangle in the upper left corner along the two sides of the image.
const CORNER: usize = 200;

/// Returns the image with `times` as many pixels along each side, by bilinear interpolation.
fn enlarged(image: &Plane, times: usize) -> Plane {
    let (h, w) = image.dim();
    let buffer = ImageBuffer::<Luma<f32>, _>::from_fn(w as u32, h as u32, |x, y| {
        Luma([image[[y as usize, x as usize]]])
    });
    let large = resize(&buffer, (w * times) as u32, (h * times) as u32, FilterType::Triangle);
    Plane::from_shape_vec((h * times, w * times), large.into_raw()).unwrap()
}

/// Returns the agreement, as a Dice coefficient, between the cones found in an image and in its
/// enlargement by the factor `times`.
fn shared(small: &Detections, large: &Detections, times: f64) -> f64 {
    let reach = 0.3 * large.spacing;
    let there = |p: &Point| {
        let p = Point::new((p.x + 0.5) * times - 0.5, (p.y + 0.5) * times - 0.5);
        large.cones.iter().any(|d| d.centre.distance(p) < reach)
    };
    let imaged = |p: &&Point| times * (p.x + p.y) > CORNER as f64 + 2. * reach;
    let both = small.centres().iter().filter(imaged).filter(|p| there(p)).count();
    let small = small.centres().iter().filter(imaged).count();
    let large = large.centres().iter().filter(|p| p.x + p.y > CORNER as f64 + 2. * reach).count();
    2. * both as f64 / (small + large) as f64
}

#[test]
#[ignore = "slow: images of a million pixels"]
fn cones_far_apart_are_found_as_those_of_fewer_pixels_are() {
    for (preset, times) in [("parafovea", 5), ("split", 6), ("histology", 4)] {
        let (image, true_spacing) = common::of_preset(preset, 3, |options| {
            (options.width, options.height) = (200, 180);
        });
        let mut large = enlarged(&image, times);
        // a corner is black, as if it was not imaged, and the sides of the image are no multiples
        // of the side of the blocks that detection averages
        let cut = (large.nrows() - 3, large.ncols() - 1);
        large = crop(&large, 0, 0, cut.0, cut.1);
        large.indexed_iter_mut().filter(|((y, x), _)| x + y < CORNER).for_each(|(_, v)| *v = 0.);
        let times = times as f64;
        for detector in [Detector::Classical, Detector::Auto] {
            let options = DetectOptions { detector, ..DetectOptions::default() };
            let (small, found) = (detect(&image, &options).unwrap(), detect(&large, &options).unwrap());
            let (same, off) = (shared(&small, &found, times), found.spacing / (times * true_spacing));
            println!(
                "{preset} × {times}, {detector:?}: {:.1} px, × {off:.3}, {same:.3} the same",
                found.spacing
            );
            assert_eq!((small.modality, small.polarity), (found.modality, found.polarity));
            assert!((0.9..1.1).contains(&off), "{preset} × {times}: {off}");
            assert!(same > 0.95, "{preset} × {times}, {detector:?}: {same}");
            let given = DetectOptions { spacing: Some(times * true_spacing), ..options };
            let same = shared(&small, &detect(&large, &given).unwrap(), times);
            assert!(same > 0.95, "{preset} × {times}, {detector:?}, spacing given: {same}");
        }
    }
}
