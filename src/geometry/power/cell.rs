/// Label of an edge on the border of the domain, in place of the index of a site.
pub(super) const NO_SITE: u32 = u32::MAX;

/// Smallest depth of a cut that is made, as a fraction of the cell's radius. Shallower cuts would
/// change nothing, and rounding would repeat them again and again.
const ROUNDING: f64 = 1e-14;

/// Corner of a cell relative to the cell's site, with a label for the edge from this corner to the
/// next.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    pub(super) x: f64,
    pub(super) y: f64,
    /// Label of the edge: the index of the other site, whose bisector with the cell's site contains
    /// the edge, or [`NO_SITE`].
    pub(super) site: u32,
    /// Distance from the cell's site to `site` or, on a torus, to the image of `site` that makes
    /// the edge.
    pub(super) distance: f64,
}

/// Convex polygon from which half-planes are cut off one at a time.
#[derive(Default)]
pub(super) struct Clip {
    /// Corners of the polygon in order; empty if nothing is left.
    corners: Vec<Corner>,
    /// Buffer for the corners after a cut, kept to save allocations.
    spare: Vec<Corner>,
    /// Buffer for the position of each corner relative to a cut: positive if it is cut off.
    sides: Vec<f64>,
    /// Squared distance from the site to the farthest corner.
    radius2: f64,
}

impl Clip {
    /// Starts a cell from the corners of the domain, relative to the site; their edges get the
    /// label `site`.
    pub(super) fn begin(&mut self, corners: impl Iterator<Item = [f64; 2]>, site: u32) {
        self.corners.clear();
        self.corners.extend(corners.map(|[x, y]| Corner { x, y, site, distance: 0. }));
        self.measure();
    }

    pub(super) fn corners(&self) -> &[Corner] {
        &self.corners
    }

    /// Returns the squared distance from the site to the farthest corner, or 0 if nothing is left.
    #[inline]
    pub(super) fn radius2(&self) -> f64 {
        self.radius2
    }

    pub(super) fn is_empty(&self) -> bool {
        self.corners.is_empty()
    }

    pub(super) fn clear(&mut self) {
        self.corners.clear();
        self.radius2 = 0.;
    }

    /// Computes the distance of the farthest corner anew.
    fn measure(&mut self) {
        self.radius2 = self.corners.iter().map(|c| c.x * c.x + c.y * c.y).fold(0., f64::max);
    }

    /// Cuts off the part of the cell that belongs to another site, because its power distance to
    /// that site is less than to the cell's own site.
    ///
    /// The other site is at (dx, dy), relative to the cell's own site, and its index is `site`.
    /// `excess` is the weight of the own site minus the weight of the other. Each corner is judged
    /// by itself, so rounding may leave a corner too many but never lose the cell.
    pub(super) fn cut(&mut self, dx: f64, dy: f64, excess: f64, site: u32) {
        let square = dx * dx + dy * dy;
        let distance = square.sqrt();
        let offset = (square + excess) / 2.;
        let outside = ROUNDING * distance * self.radius2.sqrt();
        self.sides.clear();
        self.sides.extend(self.corners.iter().map(|c| dx * c.x + dy * c.y - offset));
        if !self.sides.iter().any(|&s| s > outside) {
            return;
        }
        self.spare.clear();
        let (mut from, mut side) = match (self.corners.last(), self.sides.last()) {
            (Some(&corner), Some(&side)) => (corner, side),
            _ => return,
        };
        for (&to, &next) in self.corners.iter().zip(&self.sides) {
            if (side > outside) != (next > outside) {
                let t = (side / (side - next)).clamp(0., 1.);
                let (x, y) = (from.x + t * (to.x - from.x), from.y + t * (to.y - from.y));
                // where the outline leaves the remaining cell, the bisector begins; where the
                // outline enters it again, the old edge goes on
                self.spare.push(if next > outside {
                    Corner { x, y, site, distance }
                } else {
                    Corner { x, y, ..from }
                });
            }
            if next <= outside {
                self.spare.push(to);
            }
            (from, side) = (to, next);
        }
        std::mem::swap(&mut self.corners, &mut self.spare);
        if self.corners.len() < 3 {
            self.corners.clear();
        }
        self.measure();
    }

    /// Returns the area, the centroid and the spread of the cell, or `None` if the cell has no
    /// area.
    ///
    /// The centroid is relative to the site. The spread is the second moment of the area about the
    /// centroid, divided by the square of the area.
    pub(super) fn area(&self) -> Option<(f64, [f64; 2], f64)> {
        let mut from = self.corners.last()?;
        let (mut twice, mut x, mut y, mut square) = (0., 0., 0., 0.);
        for to in &self.corners {
            let cross = from.x * to.y - to.x * from.y;
            let (sx, sy) = (from.x + to.x, from.y + to.y);
            twice += cross;
            x += cross * sx;
            y += cross * sy;
            square += cross * (sx * sx + sy * sy - from.x * to.x - from.y * to.y);
            from = to;
        }
        let area = twice / 2.;
        let (x, y) = (x / (6. * area), y / (6. * area));
        let spread = (square / 12. / area - x * x - y * y) / area;
        (area > 0.).then_some((area, [x, y], spread))
    }
}
