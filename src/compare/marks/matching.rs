//! Pairing of hand marks with detections, by the rule of Cunefare et al. (2017),
//! <https://doi.org/10.1038/s41598-017-07103-0>.
//!
//! 1. The reach is a fraction of the median nearest-neighbour distance of the marks.
//! 2. Marks are paired with detections within reach ([`Assignment`]).
//! 3. Pairs and single points are counted, except in a border along the edges of the image.

use super::assignment::assign;
use crate::choice::UnknownChoice;
use crate::geometry::Point;
use crate::geometry::index::NeighbourTree;
use serde::{Deserialize, Serialize};
use std::num::NonZero;
use strum::{Display, EnumString, IntoStaticStr, VariantArray, VariantNames};
use thiserror::Error;

/// Rule by which marks and detections are paired where several are within reach of each other.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Hash,
    Serialize,
    Deserialize,
    Display,
    EnumString,
    IntoStaticStr,
    VariantArray,
    VariantNames,
)]
#[serde(rename_all = "snake_case")]
#[strum(
    serialize_all = "kebab-case",
    parse_err_ty = UnknownChoice,
    parse_err_fn = UnknownChoice::among::<Assignment>
)]
pub enum Assignment {
    /// Every mark claims its nearest detection; of several claims on one detection, the nearest is
    /// granted. The other marks are misses even if a second detection is near (Cunefare et al.
    /// 2017).
    #[default]
    Nearest,
    /// Largest possible number of pairs; among all such sets of pairs, that of least total distance
    /// (“Hungarian” assignment). Each mark is offered its 64 nearest detections.
    Optimal,
}

impl Assignment {
    /// Returns the name used in options and tables.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// Options of the pairing; the defaults are the rule of Cunefare et al. (2017).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MatchOptions {
    /// Width, in px, of the border in which nothing is counted; 0 or more. Default: 7.
    pub border: f64,
    /// Reach of a mark as a positive fraction of the median nearest-neighbour distance of the
    /// marks. Default: 0.75.
    pub fraction: f64,
    /// Rule by which marks and detections are paired. Default: nearest.
    pub assignment: Assignment,
}

impl Default for MatchOptions {
    fn default() -> Self {
        Self { border: 7., fraction: 0.75, assignment: Assignment::Nearest }
    }
}

impl MatchOptions {
    /// Checks that every option is in its range.
    ///
    /// # Errors
    /// Returns the first option that is out of its range.
    pub fn validate(&self) -> Result<(), MatchError> {
        if !(self.border.is_finite() && self.border >= 0.) {
            return Err(MatchError::Border(self.border));
        }
        if !(self.fraction.is_finite() && self.fraction > 0.) {
            return Err(MatchError::Fraction(self.fraction));
        }
        Ok(())
    }
}

/// Largest coordinate, in px, at which distances are still exact enough to compare.
const LARGEST: f64 = 1e9;

/// Options, marks or detections that cannot be paired.
#[derive(Debug, Error, PartialEq)]
pub enum MatchError {
    /// Border width that is negative or not finite.
    #[error("the border is {0} px: expected 0 or more")]
    Border(f64),
    /// Reach that is not a positive number.
    #[error("the reach is {0} × the nearest-neighbour distance: expected more than 0")]
    Fraction(f64),
    /// Coordinate that is no place in an image.
    #[error(
        "{what} {index} (counted from 0) is at ({x}, {y}): expected coordinates in px between −1e9 and 1e9"
    )]
    Coordinate {
        /// Kind of point, “mark” or “detection”.
        what: &'static str,
        /// 0-based index of the point.
        index: usize,
        /// Horizontal coordinate in px.
        x: f64,
        /// Vertical coordinate in px.
        y: f64,
    },
    /// More points than the spatial index can number.
    #[error("{0} points are too many: expected fewer than 4,294,967,295")]
    TooMany(usize),
}

/// Mark and the detection that belongs to it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pair {
    /// 0-based index of the mark.
    pub mark: usize,
    /// 0-based index of the detection.
    pub detection: usize,
    /// Distance between the two in px.
    pub distance: f64,
    /// `true` if neither of them lies in the border, so that the pair is a hit.
    pub counted: bool,
}

/// Pairs of marks and detections, and the points left single.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Matching {
    /// All pairs, sorted by index of the mark.
    pub pairs: Vec<Pair>,
    /// Marks outside the border without a detection: indices in ascending order.
    pub misses: Vec<usize>,
    /// Detections outside the border without a mark: indices in ascending order.
    pub false_alarms: Vec<usize>,
    /// One flag per mark: `true` if it lies in the border.
    pub marks_in_border: Vec<bool>,
    /// One flag per detection: `true` if it lies in the border.
    pub detections_in_border: Vec<bool>,
    /// Largest distance allowed in a pair, in px.
    pub limit: f64,
    /// Rule by which the points were paired.
    pub assignment: Assignment,
}

impl Matching {
    /// Returns the number of hits: pairs outside the border.
    pub fn true_positives(&self) -> usize {
        self.pairs.iter().filter(|p| p.counted).count()
    }

    /// Returns the number of misses: marks outside the border without a detection.
    pub fn false_negatives(&self) -> usize {
        self.misses.len()
    }

    /// Returns the number of false alarms: detections outside the border without a mark.
    pub fn false_positives(&self) -> usize {
        self.false_alarms.len()
    }
}

/// Pairs hand marks with detections in an image of `width` × `height` px (Cunefare et al. 2017,
/// Scientific Reports 7:6620, <https://doi.org/10.1038/s41598-017-07103-0>).
///
/// The members of a pair are at most `fraction` × the median nearest-neighbour distance of the
/// marks apart. Fewer than two marks have no nearest neighbours: then the distance of the
/// detections is used, and if there are fewer than two of those as well, the width of the border.
///
/// Pairs with a member in the border are neither hits nor errors, and single points there are no
/// errors. A point is in the border if it is at most `border` − ½ px from the centre of an
/// outermost row or column, so the border covers `border` whole pixels.
///
/// # Errors
/// Fails if an option is out of its range, a coordinate is no place in an image, or there are too
/// many points for the spatial index.
pub fn match_points(
    marks: &[Point],
    detections: &[Point],
    width: usize,
    height: usize,
    options: &MatchOptions,
) -> Result<Matching, MatchError> {
    options.validate()?;
    check("mark", marks)?;
    check("detection", detections)?;
    let limit = reach(marks, detections, options)?;
    let partners = match (Index::new(detections)?, options.assignment) {
        (None, _) => vec![None; marks.len()],
        (Some(found), Assignment::Nearest) => nearest(marks, &found, limit),
        (Some(found), Assignment::Optimal) => {
            let candidates: Vec<_> = marks.iter().map(|&m| found.within(m, limit, MOST_CANDIDATES)).collect();
            assign(&candidates, detections.len(), limit)
        }
    };

    let field = Field::new(width, height, options.border);
    let marks_in_border: Vec<bool> = marks.iter().map(|p| field.is_border(p)).collect();
    let detections_in_border: Vec<bool> = detections.iter().map(|p| field.is_border(p)).collect();

    let mut pairs = Vec::with_capacity(marks.len());
    let mut misses = Vec::new();
    let mut taken = vec![false; detections.len()];
    for (mark, partner) in partners.into_iter().enumerate() {
        match partner {
            Some((detection, distance)) => {
                taken[detection] = true;
                let counted = !marks_in_border[mark] && !detections_in_border[detection];
                pairs.push(Pair { mark, detection, distance, counted });
            }
            None if !marks_in_border[mark] => misses.push(mark),
            None => {}
        }
    }
    let alone = |&d: &usize| !taken[d] && !detections_in_border[d];
    let false_alarms = (0..detections.len()).filter(alone).collect();
    let assignment = options.assignment;
    Ok(Matching { pairs, misses, false_alarms, marks_in_border, detections_in_border, limit, assignment })
}

/// Returns the largest distance allowed in a pair, in px.
pub(super) fn reach(
    marks: &[Point],
    detections: &[Point],
    options: &MatchOptions,
) -> Result<f64, MatchError> {
    Ok(match (Index::new(marks)?, Index::new(detections)?) {
        (Some(marks), _) if marks.points.len() > 1 => options.fraction * marks.median_neighbour_distance(),
        (_, Some(found)) if found.points.len() > 1 => options.fraction * found.median_neighbour_distance(),
        _ => options.border,
    })
}

/// Image with a border that does not count; all in px.
#[derive(Clone, Copy)]
pub(super) struct Field {
    width: f64,
    height: f64,
    border: f64,
}

impl Field {
    pub(super) const fn new(width: usize, height: usize, border: f64) -> Self {
        Self { width: width as f64, height: height as f64, border }
    }

    /// Returns whether a point lies in the border.
    pub(super) fn is_border(&self, p: &Point) -> bool {
        let Self { width: w, height: h, border: b } = *self;
        p.x <= b - 0.5 || p.x >= w - b - 0.5 || p.y <= b - 0.5 || p.y >= h - b - 0.5
    }

    /// Returns the area inside the border, in px².
    pub(super) fn area(&self) -> f64 {
        let side = |pixels: f64| (pixels - 2. * self.border).max(0.);
        side(self.width) * side(self.height)
    }
}

/// Checks that the coordinates of all points are finite and within ±[`LARGEST`].
pub(super) fn check(what: &'static str, points: &[Point]) -> Result<(), MatchError> {
    let is_place = |v: f64| v.abs() <= LARGEST;
    match points.iter().enumerate().find(|(_, p)| !(is_place(p.x) && is_place(p.y))) {
        Some((index, p)) => Err(MatchError::Coordinate { what, index, x: p.x, y: p.y }),
        None => Ok(()),
    }
}

/// Returns, for every mark, the index and distance of its detection, if it gets one.
fn nearest(marks: &[Point], detections: &Index, limit: f64) -> Vec<Option<(usize, f64)>> {
    let mut claims: Vec<Option<(usize, f64)>> =
        marks.iter().map(|&m| detections.nearest(m, 2).first().copied().filter(|c| c.1 <= limit)).collect();
    let mut granted: Vec<Option<(usize, f64)>> = vec![None; detections.points.len()];
    for (mark, claim) in claims.iter().enumerate() {
        if let Some((detection, distance)) = *claim
            && granted[detection].is_none_or(|(_, best)| distance < best)
        {
            granted[detection] = Some((mark, distance));
        }
    }
    for (mark, claim) in claims.iter_mut().enumerate() {
        *claim = claim.filter(|(detection, _)| granted[*detection].is_some_and(|(winner, _)| winner == mark));
    }
    claims
}

/// Points that can be searched by distance.
pub(super) struct Index<'a> {
    points: &'a [Point],
    tree: NeighbourTree,
}

/// Largest number of detections that a mark is offered. If more are within reach, the detections
/// are no cones.
pub(super) const MOST_CANDIDATES: usize = 64;

impl<'a> Index<'a> {
    /// Builds the index; `None` without points.
    pub(super) fn new(points: &'a [Point]) -> Result<Option<Self>, MatchError> {
        if points.is_empty() {
            return Ok(None);
        }
        let tree = NeighbourTree::in_plane(points).map_err(|_| MatchError::TooMany(points.len()))?;
        Ok(Some(Self { points, tree }))
    }

    /// Returns the indices and distances of the `count` points nearest to `p`, the nearest first,
    /// ties by index.
    fn nearest(&self, p: Point, count: usize) -> Vec<(usize, f64)> {
        self.within(p, f64::INFINITY, count)
    }

    /// Returns the same for points at most `limit` away.
    pub(super) fn within(&self, p: Point, limit: f64, count: usize) -> Vec<(usize, f64)> {
        let count = NonZero::new(count).unwrap_or(NonZero::<usize>::MIN);
        // Search slightly farther, so that rounding of the squares does not cut off points at the
        // limit.
        let radius = limit * limit * (1. + 1e-9) + f64::MIN_POSITIVE;
        let mut found = self.sorted(p, self.tree.nearest_within(p, count, radius));
        found.retain(|(_, distance)| *distance <= limit);
        found
    }

    /// Returns the indices and distances of `items`, the nearest to `p` first, ties by index.
    fn sorted(&self, p: Point, items: impl Iterator<Item = usize>) -> Vec<(usize, f64)> {
        let mut found: Vec<(usize, f64)> =
            items.filter_map(|i| self.points.get(i).map(|q| (i, distance(p, *q)))).collect();
        found.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        found
    }

    /// Returns the median over the points of the distance to the nearest other point. There must be
    /// two points.
    fn median_neighbour_distance(&self) -> f64 {
        let nearest_other = |(i, &p): (usize, &Point)| {
            // Where several points coincide, the point itself need not be among the first two
            // found.
            self.nearest(p, 2).into_iter().find(|(other, _)| *other != i).map_or(0., |(_, d)| d)
        };
        let mut distances: Vec<f64> = self.points.iter().enumerate().map(nearest_other).collect();
        crate::numeric::median(&mut distances).unwrap_or(0.)
    }
}

/// Returns the distance computed as SciPy does, so that comparisons with the limit fall on the same
/// side.
fn distance(a: Point, b: Point) -> f64 {
    let (dx, dy) = (a.x - b.x, a.y - b.y);
    (dx * dx + dy * dy).sqrt()
}
