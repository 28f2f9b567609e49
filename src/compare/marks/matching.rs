use super::assignment::assign;
use crate::choice::UnknownChoice;
use crate::geometry::Point;
use crate::geometry::index::NeighbourTree;
use serde::{Deserialize, Serialize};
use std::num::NonZero;
use strum::{Display, EnumString, IntoStaticStr, VariantArray, VariantNames};
use thiserror::Error;

/// Who gets whom where several marks and detections are within reach of each other.
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
    /// Every mark claims its nearest detection, and of several claims the nearest is granted; the others are
    /// misses even if a second detection is near (Cunefare et al. 2017).
    #[default]
    Nearest,
    /// As many pairs as possible, and of all such sets of pairs the one of least total distance (the "Hungarian"
    /// assignment). Each mark is offered its 64 nearest detections.
    Optimal,
}

impl Assignment {
    /// Returns the word for it in options and tables.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// How marks and detections are paired. The defaults are the rule of Cunefare et al. (2017).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MatchOptions {
    /// Width, in px, of the border in which nothing is counted; 0 and more. Default: 7.
    pub border: f64,
    /// Reach of a mark as a fraction of the median nearest-neighbour distance of the marks; above 0. Default: 0.75.
    pub fraction: f64,
    /// Who gets whom. Default: nearest.
    pub assignment: Assignment,
}

impl Default for MatchOptions {
    fn default() -> Self {
        Self { border: 7., fraction: 0.75, assignment: Assignment::Nearest }
    }
}

impl MatchOptions {
    /// # Errors
    /// If a value is out of its range.
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

/// Largest coordinate, in px, whose distances are still exact enough to compare.
const LARGEST: f64 = 1e9;

/// Marks and detections that cannot be paired.
#[derive(Debug, Error, PartialEq)]
pub enum MatchError {
    /// A border that is none.
    #[error("the border is {0} px: it must be 0 or more")]
    Border(f64),
    /// A reach that is none.
    #[error("the reach is {0} × the nearest-neighbour distance: it must be more than 0")]
    Fraction(f64),
    /// A coordinate that is not a place in an image.
    #[error("{what} {index} is ({x}, {y}): expected pixels between −1e9 and 1e9")]
    Coordinate {
        /// Mark or detection.
        what: &'static str,
        /// Its 0-based index.
        index: usize,
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
    },
    /// More points than the spatial index can number.
    #[error("{0} points are too many: expected fewer than 4,294,967,295")]
    TooMany(usize),
}

/// A mark and the detection that belongs to it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pair {
    /// 0-based index of the mark.
    pub mark: usize,
    /// 0-based index of the detection.
    pub detection: usize,
    /// Their distance in px.
    pub distance: f64,
    /// Neither of them lies in the border: the pair is a hit.
    pub counted: bool,
}

/// Which detection belongs to which mark.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Matching {
    /// All pairs, by index of the mark.
    pub pairs: Vec<Pair>,
    /// Marks without detection, outside the border: indexes in ascending order.
    pub misses: Vec<usize>,
    /// Detections without mark, outside the border: indexes in ascending order.
    pub false_alarms: Vec<usize>,
    /// For every mark, whether it lies in the border.
    pub marks_in_border: Vec<bool>,
    /// For every detection, whether it lies in the border.
    pub detections_in_border: Vec<bool>,
    /// Largest distance of a pair, in px.
    pub limit: f64,
    /// Who got whom.
    pub assignment: Assignment,
}

impl Matching {
    /// Hits: pairs outside the border.
    pub fn true_positives(&self) -> usize {
        self.pairs.iter().filter(|p| p.counted).count()
    }

    /// Misses: marks without detection, outside the border.
    pub fn false_negatives(&self) -> usize {
        self.misses.len()
    }

    /// False alarms: detections without mark, outside the border.
    pub fn false_positives(&self) -> usize {
        self.false_alarms.len()
    }
}

/// Pairs hand marks with detections in an image of `width` × `height` px (Cunefare et al. 2017, Scientific Reports
/// 7:6620).
///
/// A pair is at most `fraction` × the median nearest-neighbour distance of the marks apart. Pairs with a member in
/// the border are neither hits nor errors, and single points there are no errors. A point is in the border if it is
/// at most `border` − ½ px from the centre of an outermost row or column, so that `border` whole pixels are.
///
/// Fewer than two marks have no nearest neighbours: then the detections' distance serves, and if there are fewer
/// than two of those as well, the width of the border does.
///
/// # Errors
/// If an option is out of its range or a coordinate is no place in an image.
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

/// Largest distance of a pair, in px.
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

/// An image and the border in it that does not count; all in px.
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

    pub(super) fn is_border(&self, p: &Point) -> bool {
        let Self { width: w, height: h, border: b } = *self;
        p.x <= b - 0.5 || p.x >= w - b - 0.5 || p.y <= b - 0.5 || p.y >= h - b - 0.5
    }

    /// Area that counts, in px².
    pub(super) fn area(&self) -> f64 {
        let side = |pixels: f64| (pixels - 2. * self.border).max(0.);
        side(self.width) * side(self.height)
    }
}

pub(super) fn check(what: &'static str, points: &[Point]) -> Result<(), MatchError> {
    let is_place = |v: f64| v.abs() <= LARGEST;
    match points.iter().enumerate().find(|(_, p)| !(is_place(p.x) && is_place(p.y))) {
        Some((index, p)) => Err(MatchError::Coordinate { what, index, x: p.x, y: p.y }),
        None => Ok(()),
    }
}

/// For every mark the index and distance of its detection, if it gets one.
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

/// Most detections that a mark is offered: more within reach means that the detections are not cones.
pub(super) const MOST_CANDIDATES: usize = 64;

impl<'a> Index<'a> {
    /// `None` without points.
    pub(super) fn new(points: &'a [Point]) -> Result<Option<Self>, MatchError> {
        if points.is_empty() {
            return Ok(None);
        }
        let tree = NeighbourTree::in_plane(points).map_err(|_| MatchError::TooMany(points.len()))?;
        Ok(Some(Self { points, tree }))
    }

    /// Indexes and distances of the `count` points nearest to `p`, nearest first and ties by index.
    fn nearest(&self, p: Point, count: usize) -> Vec<(usize, f64)> {
        self.within(p, f64::INFINITY, count)
    }

    /// The same, up to `limit` away.
    pub(super) fn within(&self, p: Point, limit: f64, count: usize) -> Vec<(usize, f64)> {
        let count = NonZero::new(count).unwrap_or(NonZero::<usize>::MIN);
        // A little further, lest the rounding of squares cuts off what lies at the limit.
        let radius = limit * limit * (1. + 1e-9) + f64::MIN_POSITIVE;
        let mut found = self.sorted(p, self.tree.nearest_within(p, count, radius));
        found.retain(|(_, distance)| *distance <= limit);
        found
    }

    fn sorted(&self, p: Point, items: impl Iterator<Item = usize>) -> Vec<(usize, f64)> {
        let mut found: Vec<(usize, f64)> =
            items.filter_map(|i| self.points.get(i).map(|q| (i, distance(p, *q)))).collect();
        found.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        found
    }

    /// Median over the points of the distance to the nearest other one; there must be two points.
    fn median_neighbour_distance(&self) -> f64 {
        let nearest_other = |(i, &p): (usize, &Point)| {
            // Of several points in one place the point itself need not be among the first two.
            self.nearest(p, 2).into_iter().find(|(other, _)| *other != i).map_or(0., |(_, d)| d)
        };
        let mut distances: Vec<f64> = self.points.iter().enumerate().map(nearest_other).collect();
        crate::numeric::median(&mut distances).unwrap_or(0.)
    }
}

/// As SciPy computes it, so that comparisons with the limit fall on the same side.
fn distance(a: Point, b: Point) -> f64 {
    let (dx, dy) = (a.x - b.x, a.y - b.y);
    (dx * dx + dy * dy).sqrt()
}
