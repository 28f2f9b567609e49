//! Figures as files: well-formed, complete, deterministic and small.

use conemosaic::geometry::{Point, Window};
use conemosaic::image::Plane;
use conemosaic::mosaic::LengthUnit;
use conemosaic::report::{Curve, MosaicFigure, ReferenceLine, ReportError, mosaic_figure};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// The data of a figure, which the figure borrows.
struct Data {
    title: String,
    picture: Option<Plane>,
    points: Vec<Point>,
    window: Window,
    nn: Vec<f64>,
    edges: Vec<f64>,
    counts: Vec<usize>,
    r: Vec<f64>,
    g: Vec<f64>,
}

impl Data {
    /// Makes a picture of noise, `width` × `height` px, and scatters `n` points over it.
    fn new(n: usize, width: usize, height: usize) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(7);
        let picture = Plane::from_shape_simple_fn((height, width), || rng.random::<f32>());
        let (w, h) = (width as f64, height as f64);
        let points: Vec<_> = (0..n)
            .map(|_| Point::new(rng.random::<f64>() * w - 0.5, rng.random::<f64>() * h - 0.5))
            .collect();
        let nn: Vec<f64> = if n > 1 { (0..n).map(|i| 8. + (i % 17) as f64 * 0.1).collect() } else { vec![] };
        let edges: Vec<f64> =
            if n > 1 { (0..=10).map(|i| 8. + f64::from(i) * 0.17).collect() } else { vec![] };
        let counts = if n > 1 { vec![n / 10; 10] } else { vec![] };
        let r: Vec<f64> = (0..200).map(|i| 0.15 + f64::from(i) * 2.35 / 200.).collect();
        let g = r.iter().map(|r| 1. - (-r * r).exp() * (6. * r).cos()).collect();
        Self {
            title: "NC_0001.png".to_owned(),
            picture: Some(picture),
            points,
            window: Window::of_image(width, height).unwrap(),
            nn,
            edges,
            counts,
            r,
            g,
        }
    }

    fn references(&self) -> Vec<ReferenceLine<'_>> {
        [("uniform", Some(0.98)), ("dart-throwing", Some(0.31)), ("bridson", None)]
            .into_iter()
            .map(|(name, l_infinity)| ReferenceLine { name, r: &self.r, g: &self.g, l_infinity })
            .collect()
    }

    fn figure<'a>(&'a self, references: &'a [ReferenceLine<'a>]) -> MosaicFigure<'a> {
        let measured = !self.nn.is_empty();
        MosaicFigure {
            title: &self.title,
            picture: self.picture.as_ref(),
            points: &self.points,
            window: &self.window,
            unit: LengthUnit::Pixel,
            um_per_unit: None,
            nn: &self.nn,
            nn_mean: measured.then_some(8.8),
            nn_sd: measured.then_some(0.5),
            ri: measured.then_some(17.6),
            histogram_edges: &self.edges,
            histogram_counts: &self.counts,
            pcf: measured.then_some(Curve { r: &self.r, g: &self.g }),
            references,
        }
    }

    fn svg(&self) -> String {
        mosaic_figure(&self.figure(&self.references())).unwrap()
    }
}

fn texts(svg: &str) -> Vec<String> {
    let document = roxmltree::Document::parse(svg).expect("a figure is well-formed XML");
    let texts = document.descendants().filter(|node| node.has_tag_name("text"));
    texts.filter_map(|node| node.text().map(str::to_owned)).collect()
}

fn has(texts: &[String], text: &str) -> bool {
    texts.iter().any(|t| t == text)
}

#[test]
fn figure_says_what_it_shows() {
    let texts = texts(&Data::new(300, 150, 150).svg());
    for text in [
        "NC_0001.png",
        "a",
        "b",
        "c",
        "d",
        "RI = 17.6",
        "mean = 8.80 px",
        "SD = 0.500 px",
        "n = 300",
        "nearest neighbour (px)",
        "r / hexagonal spacing",
        "g(r)",
        "mosaic",
        "uniform, ℓ∞ 0.98",
        "dart-throwing, ℓ∞ 0.31",
        "bridson",
        "50 px",
    ] {
        assert!(has(&texts, text), "“{text}” is not in {texts:?}");
    }
}

#[test]
fn lengths_are_in_micrometres_where_the_scale_is_known() {
    let data = Data::new(300, 150, 150);
    let references = data.references();
    let figure = MosaicFigure { um_per_unit: Some(0.5), ..data.figure(&references) };
    let texts = texts(&mosaic_figure(&figure).unwrap());
    for text in ["mean = 4.40 µm", "SD = 0.250 µm", "nearest neighbour (µm)", "20 µm"] {
        assert!(has(&texts, text), "“{text}” is not in {texts:?}");
    }
    assert!(!texts.iter().any(|t| t.contains("px")));
}

#[test]
fn unit_square_has_lengths_without_a_unit() {
    let mut data = Data::new(50, 1, 1);
    data.window = Window::unit_torus();
    data.picture = None;
    let figure = MosaicFigure { unit: LengthUnit::Unit, ..data.figure(&[]) };
    let texts = texts(&mosaic_figure(&figure).unwrap());
    for text in ["0.2", "nearest neighbour distance", "mean = 8.80"] {
        assert!(has(&texts, text), "“{text}” is not in {texts:?}");
    }
    assert!(
        !has(&texts, "d") && !texts.iter().any(|t| t.contains("ℓ∞")),
        "three panels, no sampler: {texts:?}"
    );
}

#[test]
fn empty_panels_say_why() {
    for (n, why) in [(0, "has no points."), (1, "has a single point.")] {
        let joined = texts(&Data::new(n, 150, 150).svg()).join(" ");
        assert!(joined.contains(why) && joined.contains("No pair correlation function"), "{joined}");
    }
    let data = Data::new(300, 150, 150);
    let figure = MosaicFigure { pcf: None, ..data.figure(&[]) };
    let joined = texts(&mosaic_figure(&figure).unwrap()).join(" ");
    assert!(joined.contains("was not computed"), "{joined}");
}

#[test]
fn any_file_name_makes_a_well_formed_figure() {
    let mut data = Data::new(10, 40, 40);
    for title in ["<a> & \"b\" 'c'", "$x$ costs $5", "bell\u{7}\u{1b}\u{fffe}", "]]>", "ⅷ眼.tif", "a\\$b$"]
    {
        data.title = title.to_owned();
        let shown = &texts(&data.svg())[0];
        let expected: String =
            title.chars().map(|c| if c.is_control() || c == '\u{fffe}' { '\u{fffd}' } else { c }).collect();
        assert_eq!(shown, &expected);
    }
}

#[test]
fn long_titles_stay_on_the_page() {
    let mut data = Data::new(10, 40, 40);
    data.title = format!("{}.png", "very_long_name_".repeat(200));
    let shown = &texts(&data.svg())[0];
    assert!(shown.chars().count() < 160 && shown.contains('…') && shown.ends_with(".png"), "{shown}");
}

#[test]
fn equal_input_makes_equal_bytes_in_any_thread() {
    let data = Data::new(300, 150, 150);
    let first = data.svg();
    let others: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(|| data.svg())).collect();
        threads.into_iter().map(|t| t.join().unwrap()).collect()
    });
    assert!(others.iter().all(|other| *other == first));
}

#[test]
fn hundred_thousand_points_over_noise_stay_under_two_megabytes() {
    let data = Data::new(100_000, 3000, 3000);
    let svg = data.svg();
    texts(&svg);
    assert!(svg.len() < 2_000_000, "{} bytes", svg.len());
    let mut without_picture = data;
    without_picture.picture = None;
    assert!(without_picture.svg().len() < 2_000_000);
}

#[test]
fn four_thousand_points_are_drawn_as_circles_and_more_as_a_picture() {
    let count = |n| {
        let svg = Data::new(n, 150, 150).svg();
        (svg.matches("<circle").count(), svg.matches("<image").count())
    };
    assert_eq!(count(4000), (4000, 1));
    assert_eq!(count(4001), (0, 2));
}

#[test]
fn picture_shows_the_window_and_nothing_else() {
    let mut data = Data::new(100, 150, 100);
    data.window = Window::rectangle(9.5, 19.5, 39.5, 79.5).unwrap();
    let svg = data.svg();
    let start = svg.find("base64,").unwrap() + 7;
    let encoded = &svg[start..start + svg[start..].find('"').unwrap()];
    let png = base64::Engine::decode(&base64::prelude::BASE64_STANDARD, encoded).unwrap();
    let picture = image::load_from_memory(&png).unwrap();
    assert_eq!((picture.width(), picture.height()), (30, 60));

    data.window = Window::rectangle(500., 500., 600., 600.).unwrap();
    assert!(texts(&data.svg()).join(" ").contains("No part of the picture lies inside the window."));
}

#[test]
fn every_shape_of_field_keeps_all_marks_on_the_page() {
    for (width, height) in [(400, 150), (150, 400), (1200, 60), (60, 1200), (3, 3), (2000, 10)] {
        let svg = Data::new(200, width, height).svg();
        let document = roxmltree::Document::parse(&svg).unwrap();
        let view: Vec<f64> = document
            .root_element()
            .attribute("viewBox")
            .unwrap()
            .split(' ')
            .map(|v| v.parse().unwrap())
            .collect();
        let number = |node: roxmltree::Node, name| node.attribute(name).and_then(|v| v.parse::<f64>().ok());
        for node in document.descendants() {
            for (name, end) in [("x", view[2]), ("cx", view[2]), ("y", view[3]), ("cy", view[3])] {
                if let Some(value) = number(node, name) {
                    assert!((0. ..=end).contains(&value), "{width} × {height}: {name} = {value} in {node:?}");
                }
            }
        }
    }
}

#[test]
fn values_that_are_not_finite_leave_gaps() {
    let mut data = Data::new(300, 150, 150);
    data.g[50] = f64::NAN;
    data.g[51] = f64::INFINITY;
    let references = data.references();
    let figure = MosaicFigure {
        nn_sd: Some(0.),
        ri: Some(f64::INFINITY),
        nn_mean: Some(f64::NAN),
        ..data.figure(&references)
    };
    let svg = mosaic_figure(&figure).unwrap();
    assert!(has(&texts(&svg), "RI = ∞"));
    assert!(!svg.contains("NaN") && !svg.contains("inf\""));
}

#[test]
fn data_that_do_not_belong_together_are_refused() {
    let data = Data::new(300, 150, 150);
    let figure = data.figure(&[]);
    let histogram = MosaicFigure { histogram_edges: &data.edges[1..], ..figure };
    assert!(matches!(mosaic_figure(&histogram), Err(ReportError::Histogram { edges: 10, counts: 10 })));
    let curve = MosaicFigure { pcf: Some(Curve { r: &data.r[1..], g: &data.g }), ..figure };
    let message = mosaic_figure(&curve).unwrap_err().to_string();
    assert!(message.contains("199 distances and 200 values"), "{message}");
}
