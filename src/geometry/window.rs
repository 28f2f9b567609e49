use super::{Point, Polygon, PolygonError, Ring};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Bounds that do not make a rectangle, because a side is not finite or not positive.
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

/// Upright rectangle of positive area.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rectangle {
    x0: f64,
    y0: f64,
    x1: f64,
    y1: f64,
}

impl Rectangle {
    /// Creates the rectangle `[x0, x1] × [y0, y1]`.
    ///
    /// # Errors
    /// Fails if a side is not finite or not positive.
    pub fn new(x0: f64, y0: f64, x1: f64, y1: f64) -> Result<Self, WindowError> {
        let finite = [x0, y0, x1, y1].iter().all(|v| v.is_finite());
        let area = (x1 - x0) * (y1 - y0);
        if finite && x1 > x0 && y1 > y0 && area.is_normal() {
            Ok(Self { x0, y0, x1, y1 })
        } else {
            Err(WindowError { x0, y0, x1, y1 })
        }
    }

    /// Returns x of the left edge.
    pub const fn x0(&self) -> f64 {
        self.x0
    }
    /// Returns y of the upper edge.
    pub const fn y0(&self) -> f64 {
        self.y0
    }
    /// Returns x of the right edge.
    pub const fn x1(&self) -> f64 {
        self.x1
    }
    /// Returns y of the lower edge.
    pub const fn y1(&self) -> f64 {
        self.y1
    }
    /// Returns the width, x1 − x0.
    pub const fn width(&self) -> f64 {
        self.x1 - self.x0
    }
    /// Returns the height, y1 − y0.
    pub const fn height(&self) -> f64 {
        self.y1 - self.y0
    }
    /// Returns the area, width × height.
    pub const fn area(&self) -> f64 {
        self.width() * self.height()
    }

    /// Returns whether a point lies inside or on the border.
    pub fn contains(&self, p: Point) -> bool {
        p.x >= self.x0 && p.x <= self.x1 && p.y >= self.y0 && p.y <= self.y1
    }

    /// Returns the distance from a point to the nearest edge; negative if the point lies outside.
    pub fn border_distance(&self, p: Point) -> f64 {
        let dx = (p.x - self.x0).min(self.x1 - p.x);
        let dy = (p.y - self.y0).min(self.y1 - p.y);
        dx.min(dy)
    }
}

/// Region in which points could have been observed, which decides the edge correction of
/// statistics.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Window {
    /// Upright rectangle outside which nothing is known: an imaged field, a cropped picture.
    Rectangle(Rectangle),
    /// Rectangle without a border, whose opposite edges are glued together; patterns from periodic
    /// samplers have such a window.
    Torus(Rectangle),
    /// Polygon: nothing is known outside it or in its holes. It is the imaged area of a montage, or
    /// a region drawn by hand.
    Polygon(Polygon),
}

impl Window {
    /// Creates the bounded rectangle `[x0, x1] × [y0, y1]`.
    ///
    /// # Errors
    /// Fails if a side is not finite or not positive.
    pub fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64) -> Result<Self, WindowError> {
        Rectangle::new(x0, y0, x1, y1).map(Self::Rectangle)
    }

    /// Creates the window that `rings` enclose; see [`Polygon::new`].
    ///
    /// If the rings are a single upright rectangle, the window is a [`Window::Rectangle`].
    ///
    /// # Errors
    /// Fails if the rings enclose no area, a corner is not finite, or edges cross.
    pub fn polygon(rings: Vec<Ring>) -> Result<Self, PolygonError> {
        Ok(Polygon::new(rings)?.into())
    }

    /// Returns the bounded unit square.
    pub const fn unit_square() -> Self {
        Self::Rectangle(Rectangle { x0: 0., y0: 0., x1: 1., y1: 1. })
    }

    /// Returns the unit square with opposite edges glued together.
    pub const fn unit_torus() -> Self {
        Self::Torus(Rectangle { x0: 0., y0: 0., x1: 1., y1: 1. })
    }

    /// Creates the window of an entire image of `width` × `height` px.
    ///
    /// It is `[−.5, width − .5] × [−.5, height − .5]`, since (0, 0) is the centre of the top-left
    /// pixel.
    ///
    /// # Errors
    /// Fails if a side is 0.
    pub fn of_image(width: usize, height: usize) -> Result<Self, WindowError> {
        Self::rectangle(-0.5, -0.5, width as f64 - 0.5, height as f64 - 0.5)
    }

    /// Returns the smallest upright rectangle around the window.
    pub fn bounds(&self) -> Rectangle {
        match self {
            Self::Rectangle(r) | Self::Torus(r) => *r,
            Self::Polygon(polygon) => polygon.bounds(),
        }
    }

    /// Returns the area, in squared units of the coordinates.
    pub fn area(&self) -> f64 {
        match self {
            Self::Rectangle(r) | Self::Torus(r) => r.area(),
            Self::Polygon(polygon) => polygon.area(),
        }
    }

    /// Returns the length of the border, including the borders of holes, in units of the
    /// coordinates.
    ///
    /// The result is 0 on a torus, which has no border.
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

    /// Returns whether opposite edges are glued together.
    pub const fn is_torus(&self) -> bool {
        matches!(self, Self::Torus(_))
    }

    /// Returns the rings that bound a polygon, or no rings for a rectangle or torus.
    pub fn rings(&self) -> &[Ring] {
        match self {
            Self::Polygon(polygon) => polygon.rings(),
            Self::Rectangle(_) | Self::Torus(_) => &[],
        }
    }

    /// Returns whether a point lies inside or on the border.
    pub fn contains(&self, p: Point) -> bool {
        match self {
            Self::Rectangle(r) | Self::Torus(r) => r.contains(p),
            Self::Polygon(polygon) => polygon.contains(p),
        }
    }

    /// Returns the distance from a point to the border: negative if the point lies outside,
    /// infinite on a torus.
    pub fn border_distance(&self, p: Point) -> f64 {
        match self {
            Self::Rectangle(r) => r.border_distance(p),
            Self::Torus(_) => f64::INFINITY,
            Self::Polygon(polygon) => polygon.border_distance(p),
        }
    }

    /// Returns the distance from each point to the border, see [`Self::border_distance`].
    pub fn border_distances(&self, points: &[Point]) -> Vec<f64> {
        match self {
            Self::Polygon(_) => points.par_iter().map(|&p| self.border_distance(p)).collect(),
            Self::Rectangle(_) | Self::Torus(_) => points.iter().map(|&p| self.border_distance(p)).collect(),
        }
    }

    /// Returns the part of the window inside `frame`, as a window with a border, or `None` if
    /// nothing is left.
    pub fn within(&self, frame: &Rectangle) -> Option<Self> {
        match self {
            Self::Rectangle(r) | Self::Torus(r) => {
                let (x0, y0) = (r.x0().max(frame.x0()), r.y0().max(frame.y0()));
                Self::rectangle(x0, y0, r.x1().min(frame.x1()), r.y1().min(frame.y1())).ok()
            }
            Self::Polygon(polygon) => polygon.within(frame).map(Self::from),
        }
    }

    /// Multiplies all coordinates by `factor`, for instance to convert px to µm.
    ///
    /// # Errors
    /// Fails if a coordinate or the area of the result is too large or too small for an `f64`.
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

    /// Returns the distance between two points of the window, by the shortest way round on a torus.
    pub fn distance(&self, a: Point, b: Point) -> f64 {
        let [dx, dy] = self.displacement(a, b);
        dx.hypot(dy)
    }

    /// Returns the displacement from `a` to `b` along x and y, by the shortest way round on a
    /// torus.
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
    /// Makes a [`Window::Rectangle`] if the polygon is an upright rectangle.
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
