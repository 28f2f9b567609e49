//! Pairing of hand marks with detections, by the rule of Cunefare et al. (2017),
//! <https://doi.org/10.1038/s41598-017-07103-0>.
//!
//! 1. The cut-off distance of a pair is a fraction of the median nearest-neighbour distance of the
//!    marks.
//! 2. Marks are paired with detections within the cut-off distance ([`Assignment`]).
//! 3. Pairs and unpaired points are counted, except in a border strip along the edges of the image.

use super::assignment::assign;
use crate::choice::UnknownChoice;
use crate::geometry::Point;
use crate::geometry::index::NeighbourTree;
use serde::{Deserialize, Serialize};
use std::num::NonZero;
use strum::{Display, EnumString, IntoStaticStr, VariantArray, VariantNames};
use thiserror::Error;

/// Rule that decides between several possible partners of a mark or a detection.
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
    /// Each mark may pair only with its nearest detection. If several marks share a nearest
    /// detection, the closest of them gets it; the other marks are misses even if a second
    /// detection is near (Cunefare et al. 2017).
    #[default]
    Nearest,
    /// Largest possible number of pairs and, among all such sets of pairs, the smallest total
    /// distance (“Hungarian” assignment). Only the 64 nearest detections of each mark are
    /// considered.
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
    /// Width, in px, of the border along the edges of the image in which points are not counted; 0
    /// or more. Default: 7.
    pub border: f64,
    /// Largest distance allowed in a pair, as a positive fraction of the median nearest-neighbour
    /// distance of the marks. Default: 0.75.
    pub fraction: f64,
    /// Rule that decides between several possible partners of a mark or a detection. Default:
    /// [`Assignment::Nearest`].
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
    /// Fails if an option is out of its range. The error names the first such option.
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

/// Largest absolute coordinate that is accepted, in px. At this value, an `f64` is still exact to
/// about 10⁻⁷ px, so that distances can be compared.
const LARGEST: f64 = 1e9;

/// Reason why marks and detections cannot be paired.
#[derive(Debug, Error, PartialEq)]
pub enum MatchError {
    /// Border width that is negative or not finite.
    #[error("the border is {0} px: expected 0 or more")]
    Border(f64),
    /// Option `fraction` that is not a positive number.
    #[error("the reach is {0} × the nearest-neighbour distance: expected more than 0")]
    Fraction(f64),
    /// Point with a coordinate that is not finite or larger than 10⁹ px.
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
    /// Number of points that is too large for the spatial index.
    #[error("{0} points are too many: expected fewer than 4,294,967,295")]
    TooMany(usize),
}

/// Mark paired with a detection.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Pair {
    /// 0-based index of the mark.
    pub mark: usize,
    /// 0-based index of the detection.
    pub detection: usize,
    /// Distance between mark and detection in px.
    pub distance: f64,
    /// `true` if the pair counts as a hit: neither mark nor detection lies in the border of the
    /// image.
    pub counted: bool,
}

/// Pairs of marks and detections, and the points without a partner.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Matching {
    /// All pairs, sorted by index of the mark.
    pub pairs: Vec<Pair>,
    /// Indices of the marks outside the border strip of the image that have no detection, in
    /// ascending order.
    pub misses: Vec<usize>,
    /// Indices of the detections outside the border strip of the image that have no mark, in
    /// ascending order.
    pub false_alarms: Vec<usize>,
    /// One flag per mark: `true` if the mark lies in the border strip of the image.
    pub marks_in_border: Vec<bool>,
    /// One flag per detection: `true` if the detection lies in the border strip of the image.
    pub detections_in_border: Vec<bool>,
    /// Largest distance allowed in a pair, in px.
    pub limit: f64,
    /// Rule that decided between several possible partners of a mark or a detection.
    pub assignment: Assignment,
}

impl Matching {
    /// Returns the number of hits: pairs with mark and detection outside the border strip of the
    /// image.
    pub fn true_positives(&self) -> usize {
        self.pairs.iter().filter(|p| p.counted).count()
    }

    /// Returns the number of misses: marks outside the border strip of the image that have no
    /// detection.
    pub fn false_negatives(&self) -> usize {
        self.misses.len()
    }

    /// Returns the number of false alarms: detections outside the border strip of the image that
    /// have no mark.
    pub fn false_positives(&self) -> usize {
        self.false_alarms.len()
    }
}

/// Pairs hand marks with detections in an image of `width` × `height` px (Cunefare et al. 2017,
/// Scientific Reports 7:6620, <https://doi.org/10.1038/s41598-017-07103-0>).
///
/// The distance between mark and detection in a pair is at most `fraction` × the median
/// nearest-neighbour distance of the marks. With fewer than two marks, the median nearest-neighbour
/// distance of the detections is used instead; with fewer than two detections as well, the limit is
/// `border` px.
///
/// A pair is neither a hit nor an error if its mark or its detection lies in the border strip, and
/// an unpaired point in the border strip is no error. A point is in the border strip if it is at
/// most `border` − ½ px from the centre of an outermost row or column of pixels, so the strip is
/// `border` px wide.
///
/// # Errors
/// Fails if an option is out of its range, a coordinate is not finite or beyond ±10⁹ px, or there
/// are 4,294,967,295 points or more.
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
///
/// It is `fraction` × the median nearest-neighbour distance of the marks. With fewer than two marks
/// it is `fraction` × that of the detections, and with fewer than two detections as well, the width
/// of the border strip.
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

/// Size of an image and width of the border strip in which points do not count, all in px.
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

    /// Returns whether a point lies in the border strip of the image.
    pub(super) fn is_border(&self, p: &Point) -> bool {
        let Self { width: w, height: h, border: b } = *self;
        p.x <= b - 0.5 || p.x >= w - b - 0.5 || p.y <= b - 0.5 || p.y >= h - b - 0.5
    }

    /// Returns the area of the image without its border, in px².
    pub(super) fn area(&self) -> f64 {
        let side = |pixels: f64| (pixels - 2. * self.border).max(0.);
        side(self.width) * side(self.height)
    }
}

/// Checks that the coordinates of all points are finite and within ±[`LARGEST`]. `what` is the name
/// of the points in the error message.
pub(super) fn check(what: &'static str, points: &[Point]) -> Result<(), MatchError> {
    let is_place = |v: f64| v.abs() <= LARGEST;
    match points.iter().enumerate().find(|(_, p)| !(is_place(p.x) && is_place(p.y))) {
        Some((index, p)) => Err(MatchError::Coordinate { what, index, x: p.x, y: p.y }),
        None => Ok(()),
    }
}

/// Pairs marks with detections by [`Assignment::Nearest`]: returns, for every mark, the index and
/// distance of its detection, or `None` if the mark gets no detection.
fn nearest(marks: &[Point], detections: &Index, limit: f64) -> Vec<Option<(usize, f64)>> {
    // each mark claims its nearest detection; the closest of the marks that claim a detection gets
    // it, the first of them if several are equally close
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

/// Points with a spatial index for searches by distance.
pub(super) struct Index<'a> {
    points: &'a [Point],
    tree: NeighbourTree,
}

/// Largest number of candidates per point that the pairing considers, the nearest ones. The default
/// cut-off distance is shorter than the distance between neighbouring cones, so 64 points within it
/// cannot all be cones.
pub(super) const MOST_CANDIDATES: usize = 64;

impl<'a> Index<'a> {
    /// Builds the index; returns `None` if there are no points.
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

    /// Returns the indices and distances of the `count` points nearest to `p` among those at most
    /// `limit` away, the nearest first, ties by index.
    pub(super) fn within(&self, p: Point, limit: f64, count: usize) -> Vec<(usize, f64)> {
        let count = NonZero::new(count).unwrap_or(NonZero::<usize>::MIN);
        // the tree takes a squared distance; it is searched slightly farther, so that rounding of
        // the squares does not cut off points at the limit
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

    /// Returns the median distance from a point to its nearest neighbour. There must be at least
    /// two points.
    fn median_neighbour_distance(&self) -> f64 {
        let nearest_other = |(i, &p): (usize, &Point)| {
            // where several points coincide, the point itself need not be among the first two found
            self.nearest(p, 2).into_iter().find(|(other, _)| *other != i).map_or(0., |(_, d)| d)
        };
        let mut distances: Vec<f64> = self.points.iter().enumerate().map(nearest_other).collect();
        crate::numeric::median(&mut distances).unwrap_or(0.)
    }
}

/// Returns the distance between two points, with the same order of operations as in SciPy. A
/// distance that equals the limit up to rounding thus falls on the same side of the limit as in
/// programs that use SciPy.
fn distance(a: Point, b: Point) -> f64 {
    let (dx, dy) = (a.x - b.x, a.y - b.y);
    (dx * dx + dy * dy).sqrt()
}
