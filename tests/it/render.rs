//! The picture and its truth agree, and the same seed makes the same picture.

use conemosaic::detect::{Modality, Polarity};
use conemosaic::geometry::Point;
use conemosaic::image::{BitDepth, Plane, read, write_grey};
use conemosaic::mosaic::hexagonal_spacing;
use conemosaic::render::{
    ConeClass, GradientShape, MosaicOptions, PRESETS, Pattern, RenderError, RenderOptions, Simulation,
    cone_mosaic, render, simulate,
};
use conemosaic::sample::sampler;
use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use strum::VariantArray;

/// Cone spacing of the simulated images, in px.
const SPACING: f64 = 12.;

fn rng(seed: u64) -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(seed)
}

fn picture(options: &RenderOptions, seed: u64) -> Simulation {
    let mosaic = MosaicOptions { spacing: SPACING, ..Default::default() };
    simulate(&mosaic, options, &mut rng(seed)).unwrap()
}

fn options(modality: Modality) -> RenderOptions {
    RenderOptions { width: 180, height: 160, ..RenderOptions::new(modality) }
}

/// Returns the mean of the pixels within `radius` of (x, y).
fn mean_around(image: &Plane, x: f64, y: f64, radius: f64) -> f64 {
    let within = image.indexed_iter().filter(|((j, i), _)| (*i as f64 - x).hypot(*j as f64 - y) <= radius);
    let (sum, n) = within.fold((0., 0.), |(sum, n), (_, &v)| (sum + f64::from(v), n + 1.));
    sum / n
}

/// Returns the cones that lie so far from the border that the picture shows all of them.
fn inner(simulation: &Simulation) -> Vec<Point> {
    let (height, width) = simulation.image.dim();
    let inside = |v: f64, side: usize| v > SPACING && v < side as f64 - SPACING;
    simulation.cones.iter().copied().filter(|p| inside(p.x, width) && inside(p.y, height)).collect()
}

fn fraction(of: &[Point], is: impl Fn(&Point) -> bool) -> f64 {
    of.iter().filter(|p| is(p)).count() as f64 / of.len() as f64
}

#[test]
fn confocal_cones_are_brighter_than_the_ring_around_them() {
    for (polarity, sign) in [(Polarity::Positive, 1.), (Polarity::Negative, -1.)] {
        let made = picture(&RenderOptions { polarity, ..options(Modality::Confocal) }, 1);
        let brighter = fraction(&inner(&made), |p| {
            let centre = mean_around(&made.image, p.x, p.y, 0.15 * SPACING);
            let wide = mean_around(&made.image, p.x, p.y, 0.45 * SPACING);
            sign * (centre - wide) > 0.
        });
        assert!(brighter > 0.93, "{brighter}");
    }
}

#[test]
fn the_brightest_pixel_near_a_confocal_cone_is_its_centre() {
    let clean = RenderOptions { noise: 0., texture: 0., dim: 0., ..options(Modality::Confocal) };
    let made = picture(&clean, 2);
    let near = fraction(&inner(&made), |p| {
        let window = made
            .image
            .indexed_iter()
            .filter(|((j, i), _)| (*i as f64 - p.x).hypot(*j as f64 - p.y) <= 0.35 * SPACING);
        let ((j, i), _) = window.max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
        (i as f64 - p.x).hypot(j as f64 - p.y) <= 1.5
    });
    assert!(near > 0.9, "{near}");
}

#[test]
fn split_cones_are_dark_on_the_left_and_bright_on_the_right() {
    for (polarity, sign) in [(Polarity::Positive, 1.), (Polarity::Negative, -1.)] {
        let made = picture(&RenderOptions { polarity, ..options(Modality::Split) }, 3);
        let shaded = fraction(&inner(&made), |p| {
            let side = |d: f64| mean_around(&made.image, p.x + d * SPACING, p.y, 0.15 * SPACING);
            sign * (side(0.25) - side(-0.25)) > 0.
        });
        assert!(shaded > 0.95, "{shaded}");
    }
}

#[test]
fn histology_discs_differ_from_what_lies_between_them() {
    for (polarity, sign) in [(Polarity::Positive, 1.), (Polarity::Negative, -1.)] {
        let made = picture(&RenderOptions { polarity, ..options(Modality::Histology) }, 4);
        let (mut inside, mut between) = ((0., 0.), (0., 0.));
        for ((j, i), &v) in made.image.indexed_iter() {
            let distance = |p: &Point| (p.x - i as f64).hypot(p.y - j as f64);
            let nearest = made.cones.iter().map(distance).fold(f64::INFINITY, f64::min);
            // edges and outlines of cones count neither as inside nor as between
            let bin = match nearest / SPACING {
                d if d < 0.3 => &mut inside,
                d if d > 0.48 => &mut between,
                _ => continue,
            };
            *bin = (bin.0 + f64::from(v), bin.1 + 1.);
        }
        let difference = sign * (inside.0 / inside.1 - between.0 / between.1);
        assert!(difference > 0.25, "{difference}");
    }
}

#[test]
fn the_same_seed_makes_the_same_picture_and_another_one_another() {
    for &modality in Modality::VARIANTS {
        let o = options(modality);
        let first = picture(&o, 5);
        assert_eq!(first, picture(&o, 5));
        let other = picture(&o, 6);
        assert_ne!(first.image, other.image);
        assert_ne!(first.cones, other.cones);
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let three = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    let o = options(Modality::Confocal);
    assert_eq!(one.install(|| picture(&o, 7)), three.install(|| picture(&o, 7)));
}

#[test]
fn a_mosaic_is_as_dense_and_as_regular_as_a_real_one() {
    let options = MosaicOptions { width: 400, height: 400, spacing: 10., ..Default::default() };
    for seed in 0..3 {
        let points = cone_mosaic(&options, &mut rng(seed)).unwrap();
        let s = hexagonal_spacing(points.len(), 160_000.).unwrap();
        assert!((s / 10. - 1.).abs() < 0.02, "spacing {s}");
        let nearest: Vec<f64> = points
            .iter()
            .filter(|p| p.x > 10. && p.y > 10. && p.x < 389. && p.y < 389.)
            .map(|p| points.iter().filter(|q| *q != p).map(|q| p.distance(*q)).fold(f64::INFINITY, f64::min))
            .collect();
        let n = nearest.len() as f64;
        let mean = nearest.iter().sum::<f64>() / n;
        let sd = (nearest.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (n - 1.)).sqrt();
        assert!((0.80..0.87).contains(&(mean / s)), "mean distance {} s", mean / s);
        assert!((8.0..11.5).contains(&(mean / sd)), "regularity {}", mean / sd);
    }
}

#[test]
fn a_mosaic_is_not_a_single_crystal() {
    // in a single crystal all directions to neighbours are equal modulo 60°, so that the order of
    // the entire mosaic equals the local order
    let options = MosaicOptions { width: 500, height: 500, spacing: 10., jitter: 0., ..Default::default() };
    let points = cone_mosaic(&options, &mut rng(1)).unwrap();
    let (mut sum, mut local, mut cells) = ((0., 0.), 0., 0.);
    for p in points.iter().filter(|p| p.x > 15. && p.y > 15. && p.x < 485. && p.y < 485.) {
        let ring: Vec<f64> = points
            .iter()
            .filter(|q| *q != p && p.distance(**q) < 13.5)
            .map(|q| 6. * (q.y - p.y).atan2(q.x - p.x))
            .collect();
        let mean = |f: fn(f64) -> f64| ring.iter().map(|&a| f(a)).sum::<f64>() / ring.len().max(1) as f64;
        let (re, im) = (mean(f64::cos), mean(f64::sin));
        sum = (sum.0 + re, sum.1 + im);
        local += re.hypot(im);
        cells += 1.;
    }
    let (local, global) = (local / cells, sum.0.hypot(sum.1) / cells);
    assert!(local > 0.5 && global < 0.3, "local {local}, global {global}");
}

#[test]
fn a_gradient_makes_one_side_denser_and_its_cones_smaller() {
    let mosaic = MosaicOptions { spacing: 9., gradient: 4., ..Default::default() };
    let o = RenderOptions { width: 400, height: 300, ..RenderOptions::new(Modality::Histology) };
    let made = simulate(&mosaic, &o, &mut rng(8)).unwrap();
    let count = |from: f64, to: f64| made.cones.iter().filter(|p| p.x >= from && p.x < to).count() as f64;
    let ratio = count(-0.5, 39.5) / count(359.5, 399.5);
    // the middles of the first and the last tenth are 0.9 of the width apart, so their densities
    // differ by a factor of 4^0.9
    assert!((ratio / 4f64.powf(0.9) - 1.).abs() < 0.25, "{ratio}");
    let expected = 400. * 300. / (0.75f64.sqrt() * 81.);
    assert!((made.cones.len() as f64 / expected - 1.).abs() < 0.05, "{} of {expected}", made.cones.len());
}

#[test]
fn noise_blur_and_contrast_do_what_they_say() {
    let deviation = |o: &RenderOptions| {
        let image = picture(o, 9).image;
        let mean = image.mean().unwrap();
        image.mapv(|v| (v - mean).powi(2)).mean().unwrap().sqrt()
    };
    for &modality in Modality::VARIANTS {
        let o = RenderOptions { noise: 0., ..options(modality) };
        assert!(deviation(&RenderOptions { contrast: 0.5 * o.contrast, ..o.clone() }) < 0.9 * deviation(&o));
        assert!(deviation(&RenderOptions { blur: 0.3, ..o.clone() }) < 0.8 * deviation(&o));
        // noise is added last, so the same seed makes the same picture beneath the noise
        let noisy = picture(&RenderOptions { noise: 0.05, ..o.clone() }, 9).image;
        let difference = (noisy - picture(&o, 9).image).mapv(|v| v * v).mean().unwrap().sqrt();
        assert!((0.03..0.055).contains(&difference), "{difference}");
    }
}

#[test]
fn options_out_of_range_are_errors_that_say_the_range() {
    let bad = RenderOptions { noise: 0.7, ..Default::default() };
    let message = simulate(&MosaicOptions::default(), &bad, &mut rng(1)).unwrap_err().to_string();
    assert_eq!(message, "noise is 0.7: it must be from 0 to 0.5 of the full range of grey");
    for (mosaic, says) in [
        (
            MosaicOptions { spacing: 0.5, ..Default::default() },
            "spacing is 0.5: it must be from 2 to 1000 px",
        ),
        (MosaicOptions { gradient: 0., ..Default::default() }, "gradient is 0: it must be from 0.05 to 20"),
        (MosaicOptions { jitter: f64::NAN, ..Default::default() }, "jitter is NaN: it must be from 0 to 0.5"),
        (MosaicOptions { width: 0, ..Default::default() }, "width is 0: it must be from 1 to 16384 px"),
    ] {
        let message = cone_mosaic(&mosaic, &mut rng(1)).unwrap_err().to_string();
        assert!(message.starts_with(says), "{message}");
    }
}

#[test]
fn points_that_cannot_be_pictured_are_errors() {
    let o = RenderOptions::default();
    let few = [Point::new(1., 1.), Point::new(9., 9.)];
    assert_eq!(render(&few, &o, &mut rng(1)), Err(RenderError::SpacingUnknown { found: 2 }));
    let bad = [Point::new(f64::NAN, 1.); 5];
    assert!(matches!(render(&bad, &o, &mut rng(1)), Err(RenderError::NotFinite { index: 0, .. })));
    let empty = RenderOptions { spacing: Some(9.), ..o };
    assert_eq!(render(&[], &empty, &mut rng(1)).unwrap().dim(), (150, 150));
}

#[test]
fn a_picture_survives_a_16_bit_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("split.tif");
    let made = picture(&options(Modality::Split), 10);
    write_grey(&path, &made.image, BitDepth::Sixteen).unwrap();
    let worst = read(&path).unwrap().iter().zip(&made.image).map(|(a, b)| (a - b).abs()).fold(0., f32::max);
    // half a grey value, and the rounding of its last digit
    assert!(worst <= 0.51 / 65535., "{worst}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn any_points_and_sizes_make_a_picture_within_black_and_white(
        places in proptest::collection::vec((-1e3..1e3f64, -1e3..1e3f64), 4..60),
        far in any::<f64>().prop_filter("finite", |v| v.is_finite()),
        (width, height) in (1..40usize, 1..40usize),
        modality in 0..3usize,
        seed in any::<u64>(),
    ) {
        let mut points: Vec<Point> = places.iter().map(|&(x, y)| Point::new(x, y)).collect();
        points.push(Point::new(far, -far));
        points.push(points[0]);
        let o = RenderOptions { width, height, ..RenderOptions::new(Modality::VARIANTS[modality]) };
        let image = render(&points, &o, &mut rng(seed)).unwrap();
        prop_assert_eq!(image.dim(), (height, width));
        prop_assert!(image.iter().all(|v| (0. ..=1.).contains(v)));
    }
}

fn marks(made: &Simulation, class: ConeClass) -> Vec<Point> {
    let all = made.cones.iter().zip(&made.visibility);
    all.filter(|(_, v)| v.class == class).map(|(p, _)| *p).collect()
}

#[test]
fn the_truth_says_which_cones_are_dim_and_which_are_not_there() {
    let o = RenderOptions {
        missing: 0.2,
        dim: 0.2,
        scatter: 0.1,
        texture: 0.,
        noise: 0.,
        drift: 0.,
        ..options(Modality::Confocal)
    };
    let made = picture(&o, 11);
    let (missing, dim) = (marks(&made, ConeClass::Missing), marks(&made, ConeClass::Dim));
    let part = |of: &[Point]| of.len() as f64 / made.cones.len() as f64;
    assert!((part(&missing) - 0.2).abs() < 0.06, "{}", part(&missing));
    assert!((part(&dim) - 0.16).abs() < 0.06, "{}", part(&dim));
    let grey = |of: &[Point]| {
        of.iter().map(|p| mean_around(&made.image, p.x, p.y, 1.)).sum::<f64>() / of.len() as f64
    };
    let (missing, dim, seen) = (grey(&missing), grey(&dim), grey(&marks(&made, ConeClass::Cone)));
    assert!(missing < dim && dim < 0.5 * seen, "{missing} {dim} {seen}");
}

#[test]
fn a_radial_gradient_is_densest_in_the_middle_at_the_spacing_asked_for() {
    for gradient in [3., 6.] {
        let mosaic = MosaicOptions {
            width: 400,
            height: 400,
            spacing: 5.,
            gradient,
            shape: GradientShape::Radial,
            ..MosaicOptions::default()
        };
        let points = cone_mosaic(&mosaic, &mut rng(12)).unwrap();
        // the density in a ring around the middle, expressed as a spacing
        let spacing = |from: f64, to: f64| {
            let within = |p: &&Point| (from..to).contains(&p.distance(Point::new(199.5, 199.5)));
            let area = std::f64::consts::PI * (to * to - from * from);
            hexagonal_spacing(points.iter().filter(within).count(), area).unwrap()
        };
        let expected = |r: f64| 5. * (1. + (gradient.sqrt() - 1.) * r / 200.);
        for (from, to) in [(0., 40.), (90., 110.), (170., 190.)] {
            // the mean distance of the points of a disc from its centre is 2/3 of its radius
            let r = if from == 0. { to * 2. / 3. } else { 0.5 * (from + to) };
            let found = spacing(from, to);
            assert!((found / expected(r) - 1.).abs() < 0.06, "{gradient} at {r}: {found}, {}", expected(r));
        }
    }
}

#[test]
fn an_anisotropic_mosaic_is_as_dense_and_longer_along_y() {
    let mosaic =
        MosaicOptions { width: 400, height: 400, spacing: 10., anisotropy: 1.5, ..MosaicOptions::default() };
    let points = cone_mosaic(&mosaic, &mut rng(13)).unwrap();
    let s = hexagonal_spacing(points.len(), 160_000.).unwrap();
    assert!((s / 10. - 1.).abs() < 0.03, "{s}");
    // counts pairs of cones in a direction: up to 0.8 spacings apart along it, and up to 0.2
    // spacings to its side. Cones keep a distance of about 0.6 spacings along x and 0.9 along y, so
    // there are many such pairs along x and few along y
    let pairs = |along: fn(f64, f64) -> (f64, f64)| {
        let in_strip = |p: &Point, q: &Point| {
            let (forth, aside) = along(q.x - p.x, q.y - p.y);
            forth > 0. && forth < 8. && aside.abs() < 2.
        };
        points.iter().map(|p| points.iter().filter(|q| in_strip(p, q)).count()).sum::<usize>()
    };
    let (along_x, along_y) = (pairs(|dx, dy| (dx, dy)), pairs(|dx, dy| (dy, dx)));
    assert!(along_x > 200 && 10 * along_y < along_x, "{along_x} {along_y}");
}

#[test]
fn a_samplers_pattern_bends_to_the_gradient() {
    for shape in [GradientShape::Linear, GradientShape::Radial] {
        let mosaic = MosaicOptions {
            width: 300,
            height: 300,
            spacing: 6.,
            gradient: 4.,
            shape,
            jitter: 0.,
            ..MosaicOptions::default()
        };
        let pattern = Pattern::new(&mosaic).unwrap();
        let sampled = sampler("dart-throwing")
            .unwrap()
            .sample(pattern.count(), pattern.window(), &mut rng(14))
            .unwrap();
        let points = pattern.bent(&sampled, &mut rng(15));
        let own = cone_mosaic(&mosaic, &mut rng(16)).unwrap();
        assert!((points.len() as f64 / own.len() as f64 - 1.).abs() < 0.04, "{shape:?}");
        let near = |all: &[Point]| match shape {
            GradientShape::Linear => all.iter().filter(|p| p.x < 75.).count() as f64,
            GradientShape::Radial => {
                all.iter().filter(|p| p.distance(Point::new(149.5, 149.5)) < 75.).count() as f64
            }
        };
        assert!((near(&points) / near(&own) - 1.).abs() < 0.06, "{shape:?}");
    }
}

#[test]
fn rods_light_up_the_room_between_cones_and_are_no_cones() {
    let without =
        RenderOptions { noise: 0., texture: 0., drift: 0., diameter: 0.4, ..options(Modality::Confocal) };
    let with = RenderOptions { rods: 6., rod_contrast: 0.6, ..without.clone() };
    let mosaic = MosaicOptions { spacing: 24., ..MosaicOptions::default() };
    let picture = |o: &RenderOptions| simulate(&mosaic, o, &mut rng(17)).unwrap();
    let (without, with) = (picture(&without), picture(&with));
    assert_eq!(without.cones, with.cones);
    let between = |made: &Simulation| {
        let far =
            |(j, i): (usize, usize)| made.cones.iter().all(|p| (p.x - i as f64).hypot(p.y - j as f64) > 10.);
        let greys: Vec<f64> =
            made.image.indexed_iter().filter(|(at, _)| far(*at)).map(|(_, v)| f64::from(*v)).collect();
        greys.iter().sum::<f64>() / greys.len() as f64
    };
    assert!(between(&with) > 1.5 * between(&without), "{} {}", between(&with), between(&without));
}

#[test]
fn vessels_take_light_and_what_lies_behind_them_is_dim() {
    let o = RenderOptions {
        vessels: 3,
        vessel_depth: 0.9,
        scatter: 0.1,
        dim: 0.,
        drift: 0.,
        ..options(Modality::Confocal)
    };
    let made = picture(&o, 18);
    let dim = marks(&made, ConeClass::Dim).len();
    assert!(dim > 10, "{dim} cones behind vessels");
    let clear = picture(&RenderOptions { vessels: 0, ..o }, 18);
    assert_eq!(made.cones, clear.cones);
    assert!(made.image.mean().unwrap() < 0.97 * clear.image.mean().unwrap());
}

#[test]
fn a_montage_is_black_where_nothing_was_imaged_and_has_no_cones_there() {
    for (width, height) in [(400, 400), (500, 300)] {
        let o = RenderOptions { montage: 4, width, height, ..RenderOptions::new(Modality::Confocal) };
        let made = picture(&o, 19);
        let black = made.image.iter().filter(|v| **v == 0.).count() as f64 / made.image.len() as f64;
        assert!((0.02..0.4).contains(&black), "{black}");
        assert!(made.image.iter().all(|&v| v == 0. || v >= 1. / 255.));
        let on_black = |p: &Point| {
            let pixel = |v: f64, side: usize| (v.round().max(0.) as usize).min(side - 1);
            made.image[[pixel(p.y, height), pixel(p.x, width)]] == 0.
        };
        assert!(!made.cones.iter().any(on_black));
        // the imaged part is in one piece, so the middle is imaged
        assert!(made.image[[height / 2, width / 2]] > 0.);
    }
}

#[test]
fn a_split_detector_may_look_along_any_direction() {
    let o = RenderOptions { orientation: 90., noise: 0., texture: 0., ..options(Modality::Split) };
    let made = picture(&o, 20);
    let shaded = fraction(&inner(&made), |p| {
        let side = |d: f64| mean_around(&made.image, p.x, p.y + d * SPACING, 0.15 * SPACING);
        side(0.25) > side(-0.25)
    });
    assert!(shaded > 0.95, "{shaded}");
}

#[test]
fn a_section_above_the_equator_leaves_discs_of_different_size() {
    let area = |section: f64| {
        let o = RenderOptions { section, noise: 0., texture: 0., drift: 0., ..options(Modality::Histology) };
        let image = picture(&o, 21).image;
        image.iter().filter(|v| **v > 0.45).count() as f64
    };
    let ratio = area(0.6) / area(0.);
    // a disc that cuts a unit sphere at height z has 1 − z² of the area
    assert!((ratio / 0.64 - 1.).abs() < 0.15, "{ratio}");
}

#[test]
fn every_preset_makes_a_picture_with_cones() {
    for preset in &PRESETS {
        let (mosaic, image) = preset.options();
        let made = simulate(&mosaic, &image, &mut rng(22)).unwrap();
        assert_eq!(made.image.dim(), (image.height, image.width), "{}", preset.name);
        assert!(marks(&made, ConeClass::Cone).len() > 60, "{}", preset.name);
    }
}
