use super::Point;

/// Number of edges in a leaf of the tree, which are tested one by one.
const LEAF: usize = 4;

/// Straight piece of an outline, from one corner to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Edge {
    pub(super) from: Point,
    pub(super) to: Point,
}

impl Edge {
    /// Returns the squared distance from `p` to the nearest point of the edge.
    fn distance2(&self, p: Point) -> f64 {
        let (dx, dy) = (self.to.x - self.from.x, self.to.y - self.from.y);
        let (px, py) = (p.x - self.from.x, p.y - self.from.y);
        let along = ((px * dx + py * dy) / (dx * dx + dy * dy)).clamp(0., 1.);
        let (ex, ey) = (px - along * dx, py - along * dy);
        ex * ex + ey * ey
    }

    /// Returns twice the signed area of the triangle formed by the edge and `p`; the sign tells the
    /// side on which `p` lies.
    pub(super) fn side(&self, p: Point) -> f64 {
        (self.to.x - self.from.x) * (p.y - self.from.y) - (p.x - self.from.x) * (self.to.y - self.from.y)
    }
}

/// Upright bounding box of edges, from (`x0`, `y0`) to (`x1`, `y1`).
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    pub(super) x0: f64,
    pub(super) y0: f64,
    pub(super) x1: f64,
    pub(super) y1: f64,
}

impl Extent {
    /// Box that contains nothing and leaves any other box unchanged in a union.
    const EMPTY: Self =
        Self { x0: f64::INFINITY, y0: f64::INFINITY, x1: f64::NEG_INFINITY, y1: f64::NEG_INFINITY };

    pub(super) fn of(edge: &Edge) -> Self {
        let (a, b) = (edge.from, edge.to);
        Self { x0: a.x.min(b.x), y0: a.y.min(b.y), x1: a.x.max(b.x), y1: a.y.max(b.y) }
    }

    pub(super) fn union(self, other: Self) -> Self {
        Self {
            x0: self.x0.min(other.x0),
            y0: self.y0.min(other.y0),
            x1: self.x1.max(other.x1),
            y1: self.y1.max(other.y1),
        }
    }

    pub(super) fn touches(&self, other: &Self) -> bool {
        self.x0 <= other.x1 && other.x0 <= self.x1 && self.y0 <= other.y1 && other.y0 <= self.y1
    }

    fn distance2(&self, p: Point) -> f64 {
        let dx = (self.x0 - p.x).max(p.x - self.x1).max(0.);
        let dy = (self.y0 - p.y).max(p.y - self.y1).max(0.);
        dx * dx + dy * dy
    }

    /// Returns the squared distance from `p` to the farthest point of the box.
    fn farthest2(&self, p: Point) -> f64 {
        let dx = (p.x - self.x0).abs().max((p.x - self.x1).abs());
        let dy = (p.y - self.y0).abs().max((p.y - self.y1).abs());
        dx * dx + dy * dy
    }
}

/// Edges in a binary tree of bounding boxes, for fast queries by position.
///
/// Edges that follow each other along an outline lie near each other, so the tree halves their
/// sequence and no sorting is needed. A query at one position takes time logarithmic in the number
/// of edges, plus the time for the edges that the query concerns.
#[derive(Debug)]
pub(super) struct EdgeTree {
    edges: Vec<Edge>,
    /// Box of every node. Node k has the children 2k + 1 and 2k + 2; the last `leaves` nodes are
    /// leaves.
    boxes: Vec<Extent>,
    leaves: usize,
}

impl EdgeTree {
    pub(super) fn new(edges: Vec<Edge>) -> Self {
        let leaves = edges.len().div_ceil(LEAF).next_power_of_two();
        let mut boxes = vec![Extent::EMPTY; 2 * leaves - 1];
        for (leaf, chunk) in edges.chunks(LEAF).enumerate() {
            boxes[leaves - 1 + leaf] = chunk.iter().map(Extent::of).fold(Extent::EMPTY, Extent::union);
        }
        for k in (0..leaves - 1).rev() {
            boxes[k] = boxes[2 * k + 1].union(boxes[2 * k + 2]);
        }
        Self { edges, boxes, leaves }
    }

    pub(super) fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// Calls `visit(index, edge)` for all edges of the leaves whose boxes, and all boxes above
    /// them, `wanted` accepts.
    ///
    /// The search ends as soon as `visit` returns `false`.
    pub(super) fn visit(
        &self,
        wanted: impl Fn(&Extent) -> bool,
        mut visit: impl FnMut(usize, &Edge) -> bool,
    ) {
        // A descent leaves at most one sibling per level to be visited later, so 64 entries are
        // enough.
        let mut stack = [0usize; 64];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let node = stack[height];
            if !wanted(&self.boxes[node]) {
                continue;
            }
            if let Some(leaf) = (node + 1).checked_sub(self.leaves) {
                let first = leaf * LEAF;
                let last = (first + LEAF).min(self.edges.len());
                for k in first..last {
                    if !visit(k, &self.edges[k]) {
                        return;
                    }
                }
            } else {
                stack[height] = 2 * node + 2;
                stack[height + 1] = 2 * node + 1;
                height += 2;
            }
        }
    }

    /// Returns the distance from `p` to the nearest edge, or infinity if there are no edges.
    pub(super) fn distance(&self, p: Point) -> f64 {
        let mut best = f64::INFINITY;
        let mut stack = [(0usize, 0f64); 64];
        let mut height = 1;
        while height > 0 {
            height -= 1;
            let (node, distance2) = stack[height];
            if distance2 >= best {
                continue;
            }
            if let Some(leaf) = (node + 1).checked_sub(self.leaves) {
                let first = leaf * LEAF;
                for edge in self.edges.iter().skip(first).take(LEAF) {
                    best = best.min(edge.distance2(p));
                }
            } else {
                let child = |k: usize| (k, self.boxes[k].distance2(p));
                let (a, b) = (child(2 * node + 1), child(2 * node + 2));
                let (near, far) = if a.1 <= b.1 { (a, b) } else { (b, a) };
                stack[height] = far;
                stack[height + 1] = near;
                height += 2;
            }
        }
        best.sqrt()
    }

    /// Visits every edge that a circle of radius `d` around `p` may cross.
    pub(super) fn visit_circle(&self, p: Point, d: f64, mut visit: impl FnMut(&Edge)) {
        let d2 = d * d;
        let wanted = |b: &Extent| b.distance2(p) <= d2 && b.farthest2(p) >= d2;
        self.visit(wanted, |_, edge| {
            visit(edge);
            true
        });
    }
}
