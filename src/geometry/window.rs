use super::{Point, Polygon, PolygonError, Ring};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A rectangle that is not one.
#[derive(Debug, Error, PartialEq)]
#[error(
    "the window [{x0}, {x1}] × [{y0}, {y1}] has no area: give X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1, all finite"
)]
pub struct WindowError {
    x0: f64,
    y0: f64,
    x1: f64,
    y1: f64,
}

/// An upright rectangle of positive area.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rectangle {
    x0: f64,
    y0: f64,
    x1: f64,
    y1: f64,
}

impl Rectangle {
    /// [x0, x1] × [y0, y1].
    ///
    /// # Errors
    /// If a side is not finite or not positive.
    pub fn new(x0: f64, y0: f64, x1: f64, y1: f64) -> Result<Self, WindowError> {
        let finite = [x0, y0, x1, y1].iter().all(|v| v.is_finite());
        let area = (x1 - x0) * (y1 - y0);
        if finite && x1 > x0 && y1 > y0 && area.is_normal() {
            Ok(Self { x0, y0, x1, y1 })
        } else {
            Err(WindowError { x0, y0, x1, y1 })
        }
    }

    /// Left edge.
    pub const fn x0(&self) -> f64 {
        self.x0
    }
    /// Upper edge.
    pub const fn y0(&self) -> f64 {
        self.y0
    }
    /// Right edge.
    pub const fn x1(&self) -> f64 {
        self.x1
    }
    /// Lower edge.
    pub const fn y1(&self) -> f64 {
        self.y1
    }
    /// Horizontal side.
    pub const fn width(&self) -> f64 {
        self.x1 - self.x0
    }
    /// Vertical side.
    pub const fn height(&self) -> f64 {
        self.y1 - self.y0
    }
    /// width × height.
    pub const fn area(&self) -> f64 {
        self.width() * self.height()
    }

    /// Inside or on the border.
    pub fn contains(&self, p: Point) -> bool {
        p.x >= self.x0 && p.x <= self.x1 && p.y >= self.y0 && p.y <= self.y1
    }

    /// Distance from a point inside to the nearest edge; negative outside.
    pub fn border_distance(&self, p: Point) -> f64 {
        let dx = (p.x - self.x0).min(self.x1 - p.x);
        let dy = (p.y - self.y0).min(self.y1 - p.y);
        dx.min(dy)
    }
}

/// Where points could have been seen. Statistics take their edge correction from it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Window {
    /// Nothing is known of what lies outside: an imaged field, a cropped picture.
    Rectangle(Rectangle),
    /// Opposite edges are the same place: what periodic samplers make. It has no border.
    Torus(Rectangle),
    /// Nothing is known of what lies outside the rings, nor within their holes: the imaged area of a montage, a region
    /// drawn by hand.
    Polygon(Polygon),
}

impl Window {
    /// [x0, x1] × [y0, y1], bounded.
    ///
    /// # Errors
    /// If a side is not finite or not positive.
    pub fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64) -> Result<Self, WindowError> {
        Rectangle::new(x0, y0, x1, y1).map(Self::Rectangle)
    }

    /// The area that `rings` enclose; see [`Polygon::new`]. Four corners of an upright rectangle make a rectangle.
    ///
    /// # Errors
    /// If they enclose no area, a corner is not finite, or edges cross.
    pub fn polygon(rings: Vec<Ring>) -> Result<Self, PolygonError> {
        Ok(Polygon::new(rings)?.into())
    }

    /// The bounded unit square.
    pub const fn unit_square() -> Self {
        Self::Rectangle(Rectangle { x0: 0., y0: 0., x1: 1., y1: 1. })
    }

    /// The unit square with opposite edges glued.
    pub const fn unit_torus() -> Self {
        Self::Torus(Rectangle { x0: 0., y0: 0., x1: 1., y1: 1. })
    }

    /// The window of a whole image of `width` × `height` px: [−.5, W−.5] × [−.5, H−.5], since pixel (0, 0) is
    /// the centre of the top-left pixel.
    ///
    /// # Errors
    /// If a side is 0.
    pub fn of_image(width: usize, height: usize) -> Result<Self, WindowError> {
        Self::rectangle(-0.5, -0.5, width as f64 - 0.5, height as f64 - 0.5)
    }

    /// The smallest upright rectangle around it.
    pub fn bounds(&self) -> Rectangle {
        match self {
            Self::Rectangle(r) | Self::Torus(r) => *r,
            Self::Polygon(polygon) => polygon.bounds(),
        }
    }

    /// Area, in squared units of the coordinates.
    pub fn area(&self) -> f64 {
        match self {
            Self::Rectangle(r) | Self::Torus(r) => r.area(),
            Self::Polygon(polygon) => polygon.area(),
        }
    }

    /// Length of the border, holes' included, in units of the coordinates; 0 on a torus, which has none.
    pub fn perimeter(&self) -> f64 {
        match self {
            Self::Rectangle(r) => 2. * (r.width() + r.height()),
            Self::Torus(_) => 0.,
            Self::Polygon(polygon) => {
                let around = |ring: &Ring| -> f64 {
                    ring.iter().zip(ring.iter().cycle().skip(1)).map(|(a, b)| a.distance(*b)).sum()
                };
                polygon.rings().iter().map(around).sum()
            }
        }
    }

    /// Whether opposite edges are glued.
    pub const fn is_torus(&self) -> bool {
        matches!(self, Self::Torus(_))
    }

    /// The rings that bound it, if it is a polygon.
    pub fn rings(&self) -> &[Ring] {
        match self {
            Self::Polygon(polygon) => polygon.rings(),
            Self::Rectangle(_) | Self::Torus(_) => &[],
        }
    }

    /// Inside or on the border.
    pub fn contains(&self, p: Point) -> bool {
        match self {
            Self::Rectangle(r) | Self::Torus(r) => r.contains(p),
            Self::Polygon(polygon) => polygon.contains(p),
        }
    }

    /// Distance to the border: negative outside, infinite on a torus.
    pub fn border_distance(&self, p: Point) -> f64 {
        match self {
            Self::Rectangle(r) => r.border_distance(p),
            Self::Torus(_) => f64::INFINITY,
            Self::Polygon(polygon) => polygon.border_distance(p),
        }
    }

    /// [`Self::border_distance`] of many points.
    pub fn border_distances(&self, points: &[Point]) -> Vec<f64> {
        match self {
            Self::Polygon(_) => points.par_iter().map(|&p| self.border_distance(p)).collect(),
            Self::Rectangle(_) | Self::Torus(_) => points.iter().map(|&p| self.border_distance(p)).collect(),
        }
    }

    /// The part of it inside `frame`, with a border; `None` if nothing is left.
    pub fn within(&self, frame: &Rectangle) -> Option<Self> {
        match self {
            Self::Rectangle(r) | Self::Torus(r) => {
                let (x0, y0) = (r.x0().max(frame.x0()), r.y0().max(frame.y0()));
                Self::rectangle(x0, y0, r.x1().min(frame.x1()), r.y1().min(frame.y1())).ok()
            }
            Self::Polygon(polygon) => polygon.within(frame).map(Self::from),
        }
    }

    /// All coordinates multiplied by `factor`: from px to µm.
    ///
    /// # Errors
    /// If the result is beyond the range of numbers.
    pub fn scaled(&self, factor: f64) -> Result<Self, PolygonError> {
        let rectangle = |r: &Rectangle| {
            let [x0, y0, x1, y1] = [r.x0(), r.y0(), r.x1(), r.y1()].map(|v| v * factor);
            Rectangle::new(x0, y0, x1, y1).map_err(|_| PolygonError::NoArea)
        };
        Ok(match self {
            Self::Rectangle(r) => Self::Rectangle(rectangle(r)?),
            Self::Torus(r) => Self::Torus(rectangle(r)?),
            Self::Polygon(polygon) => Self::Polygon(polygon.scaled(factor)?),
        })
    }

    /// Distance of two points of the window: the shortest way round on a torus.
    pub fn distance(&self, a: Point, b: Point) -> f64 {
        let [dx, dy] = self.displacement(a, b);
        dx.hypot(dy)
    }

    /// The way from `a` to `b` along x and y: the shortest way round on a torus.
    pub fn displacement(&self, a: Point, b: Point) -> [f64; 2] {
        let (dx, dy) = (b.x - a.x, b.y - a.y);
        match self {
            Self::Rectangle(_) | Self::Polygon(_) => [dx, dy],
            Self::Torus(r) => {
                let wrap = |d: f64, side: f64| d - side * (d / side).round();
                [wrap(dx, r.width()), wrap(dy, r.height())]
            }
        }
    }
}

impl From<Polygon> for Window {
    /// A rectangle, where the polygon is one.
    fn from(polygon: Polygon) -> Self {
        match polygon.as_rectangle() {
            Some(rectangle) => Self::Rectangle(rectangle),
            None => Self::Polygon(polygon),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn image_window_has_one_unit_of_area_per_pixel() {
        assert_eq!(Window::of_image(150, 100).unwrap().area(), 15_000.);
    }

    #[test]
    fn windows_without_area_are_refused() {
        for (x0, y0, x1, y1) in
            [(0., 0., 0., 1.), (1., 0., 0., 1.), (0., 0., f64::NAN, 1.), (0., 0., f64::INFINITY, 1.)]
        {
            assert!(Window::rectangle(x0, y0, x1, y1).is_err());
        }
        assert!(Window::of_image(0, 3).is_err());
    }

    #[test]
    fn torus_distance_takes_the_short_way_round() {
        let (a, b) = (Point::new(0.05, 0.5), Point::new(0.95, 0.5));
        assert!((Window::unit_torus().distance(a, b) - 0.1).abs() < 1e-12);
        assert!((Window::unit_square().distance(a, b) - 0.9).abs() < 1e-12);
        let [dx, dy] = Window::unit_torus().displacement(a, b);
        assert!((dx + 0.1).abs() < 1e-12 && dy == 0.);
    }
}
