//! Recognition of marks whose coordinates are exchanged or count from another edge of the image.

use super::validation::at_reach;
use super::{MatchError, MatchOptions, STRICT_REACH};
use crate::geometry::Point;

/// Way in which the coordinates of marks may be turned over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turned {
    /// Exchange of x and y.
    Transposed,
    /// Counting of y from the lower edge of the image.
    UpsideDown,
    /// Counting of x from the right edge of the image.
    Mirrored,
    /// Counting of both coordinates from the opposite edges.
    HalfTurn,
}

/// Least gain in the strict Dice coefficient that is needed to call marks turned over. Between
/// points that have nothing to do with each other, the coefficient varies by less than 0.1 between
/// one turn and another; of right marks it exceeds that of turned ones by about 0.5.
const CLEAR: f64 = 0.2;

impl Turned {
    /// All ways, in the order in which they are tried.
    pub const ALL: [Self; 4] = [Self::Transposed, Self::UpsideDown, Self::Mirrored, Self::HalfTurn];

    /// Describes the coordinates of the marks, to follow “as if”.
    pub const fn words(self) -> &'static str {
        match self {
            Self::Transposed => "x and y were exchanged",
            Self::UpsideDown => "y counted from the lower edge",
            Self::Mirrored => "x counted from the right edge",
            Self::HalfTurn => "x and y counted from the right and lower edges",
        }
    }

    /// States what mends the marks, to follow “and”.
    pub const fn remedy(self) -> &'static str {
        match self {
            Self::Transposed => "exchange the columns x and y",
            Self::UpsideDown => "read them with y flipped",
            Self::Mirrored => "replace x by width − 1 − x (counted from 0)",
            Self::HalfTurn => "turn them by 180°",
        }
    }

    /// Moves a point in px of an image of `width` × `height` px to where it belongs.
    pub fn undo(self, p: Point, (width, height): (usize, usize)) -> Point {
        let (right, down) = (width as f64 - 1. - p.x, height as f64 - 1. - p.y);
        match self {
            Self::Transposed => Point::new(p.y, p.x),
            Self::UpsideDown => Point::new(p.x, down),
            Self::Mirrored => Point::new(right, p.y),
            Self::HalfTurn => Point::new(right, down),
        }
    }
}

/// Returns the way in which marks look turned over, with the strict Dice coefficient that they have
/// the right way round; `None` unless that exceeds `dice`, the coefficient as they are, clearly.
///
/// # Errors
/// Fails under the same conditions as [`match_points`](super::match_points).
pub fn turned(
    marks: &[Point],
    detections: &[Point],
    size: (usize, usize),
    options: &MatchOptions,
    dice: f64,
) -> Result<Option<(Turned, f64)>, MatchError> {
    let mut best = None;
    // three standard deviations of the difference of two such shares, at most √(½/n) each
    let n = marks.len().min(detections.len()).max(1) as f64;
    let mut least = dice + CLEAR.max(3. * (0.5 / n).sqrt());
    for way in Turned::ALL {
        let right: Vec<Point> = marks.iter().map(|&p| way.undo(p, size)).collect();
        let dice = at_reach(STRICT_REACH, &right, detections, size, options)?.dice;
        if dice > least {
            (best, least) = (Some((way, dice)), dice);
        }
    }
    Ok(best)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Returns 200 random points, which no turn of the image maps onto each other.
    fn scattered() -> Vec<Point> {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        (0..200).map(|_| Point::new(rng.random_range(0. ..99.), rng.random_range(0. ..99.))).collect()
    }

    #[test]
    fn turned_marks_are_recognised_and_right_ones_are_not() {
        let (found, size, options) = (scattered(), (100, 100), MatchOptions::default());
        for way in Turned::ALL {
            let marks: Vec<Point> = found.iter().map(|&p| way.undo(p, size)).collect();
            let dice = at_reach(STRICT_REACH, &marks, &found, size, &options).unwrap().dice;
            let seen = turned(&marks, &found, size, &options, dice).unwrap();
            assert_eq!(seen, Some((way, 1.)), "as given {dice}");
        }
        assert_eq!(turned(&found, &found, size, &options, 1.), Ok(None));
    }
}
