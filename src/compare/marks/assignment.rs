//! Optimal one-to-one assignment on a sparse bipartite graph.
//!
//! 1. The graph is split into its connected components, each of which is solved alone. For marks
//!    and detections these are many and small.
//! 2. Within a component, rows are added one at a time by successive shortest augmenting paths with
//!    potentials (Jonker & Volgenant 1987, <https://doi.org/10.1007/BF02278710>, on sparse graphs):
//!    Dijkstra's search over reduced costs finds the cheapest way to assign the new row,
//!    reassigning other rows if needed.
//! 3. Every row also has a private column, which no other row can take and which stands for
//!    “unassigned”. The private column costs more than any rearrangement of the component can save,
//!    so a row stays unassigned only if it must.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Computes the one-to-one assignment with the most pairs along candidate edges; among several such
/// assignments, one of least total cost.
///
/// `candidates[row]` contains the columns that `row` may take, each with its cost, between 0 and
/// `limit`. `columns` is the number of columns. Returns the column and cost of every row, or `None`
/// for a row that gets no column.
pub(super) fn assign(
    candidates: &[Vec<(usize, f64)>],
    columns: usize,
    limit: f64,
) -> Vec<Option<(usize, f64)>> {
    let mut result = vec![None; candidates.len()];
    // index of each column within its component; a column belongs to one component only, so the
    // list serves all components
    let mut local = vec![usize::MAX; columns];
    for rows in components(candidates, columns) {
        // without a competitor, a row gets its cheapest column
        if let [row] = rows.as_slice() {
            let cheapest = candidates[*row].iter().min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
            result[*row] = cheapest.copied();
            continue;
        }
        // columns of the component, in the order of their indices within it
        let mut names = Vec::new();
        for &(column, _) in rows.iter().flat_map(|&row| &candidates[row]) {
            if local[column] == usize::MAX {
                local[column] = names.len();
                names.push(column);
            }
        }
        let edges: Vec<Vec<(usize, f64)>> = rows
            .iter()
            .map(|&row| candidates[row].iter().map(|&(c, cost)| (local[c], cost)).collect())
            .collect();
        for (i, column) in Component::new(&edges, names.len(), limit).solve().into_iter().enumerate() {
            let Some(&column) = names.get(column) else { continue };
            let row = rows[i];
            result[row] = candidates[row].iter().find(|(c, _)| *c == column).copied();
        }
    }
    result
}

/// Groups the rows that have candidates into connected components, and returns the rows of each.
/// Two rows belong together if they share a candidate column, directly or through other rows.
fn components(candidates: &[Vec<(usize, f64)>], columns: usize) -> Vec<Vec<usize>> {
    let mut rows_of = vec![Vec::new(); columns];
    for (row, edges) in candidates.iter().enumerate() {
        for &(column, _) in edges {
            rows_of[column].push(row);
        }
    }
    let mut seen = vec![false; candidates.len()];
    let mut components = Vec::new();
    for start in 0..candidates.len() {
        if seen[start] || candidates[start].is_empty() {
            continue;
        }
        seen[start] = true;
        let mut rows = vec![start];
        let mut next = 0;
        while let Some(&row) = rows.get(next) {
            next += 1;
            for &(column, _) in &candidates[row] {
                // a column is visited once: its list of rows is empty afterwards
                for other in std::mem::take(&mut rows_of[column]) {
                    if !std::mem::replace(&mut seen[other], true) {
                        rows.push(other);
                    }
                }
            }
        }
        rows.sort_unstable();
        components.push(rows);
    }
    components
}

/// Connected component of the graph. Its columns 0 to `real` − 1 are columns of the graph; column
/// `real + row` is the private column of `row`.
struct Component<'a> {
    /// Candidates of each row: column and cost.
    edges: &'a [Vec<(usize, f64)>],
    /// Number of columns that are not private to a row.
    real: usize,
    /// Cost of a private column, and thus of leaving a row unassigned.
    unassigned: f64,
    /// Dual variable of each row.
    row_potential: Vec<f64>,
    /// Dual variable of each column.
    column_potential: Vec<f64>,
    /// Column assigned to each row; `usize::MAX` before the row is added.
    column_of: Vec<usize>,
    /// Row to which each column is assigned.
    row_of: Vec<Option<usize>>,
}

impl<'a> Component<'a> {
    /// Prepares a component. `edges` contains the candidates of each row, numbered within the
    /// component; `limit` is the largest cost of a candidate.
    fn new(edges: &'a [Vec<(usize, f64)>], real: usize, limit: f64) -> Self {
        let rows = edges.len();
        Self {
            edges,
            real,
            // Assigning one more row can raise the cost of each other row by at most `limit`. The
            // smallest positive number keeps the cost above 0 if `limit` is 0.
            unassigned: (limit + f64::MIN_POSITIVE) * (rows + 1) as f64,
            row_potential: vec![0.; rows],
            column_potential: vec![0.; real + rows],
            column_of: vec![usize::MAX; rows],
            row_of: vec![None; real + rows],
        }
    }

    /// Returns the column of every row. A column of `real` or more is private and means that the
    /// row stays unassigned.
    fn solve(mut self) -> Vec<usize> {
        let columns = self.real + self.edges.len();
        let mut search = Search {
            distance: vec![f64::INFINITY; columns],
            via: vec![0; columns],
            done: vec![false; columns],
            touched: Vec::new(),
            heap: BinaryHeap::new(),
        };
        for row in 0..self.edges.len() {
            self.place(row, &mut search);
            search.clear();
        }
        self.column_of
    }

    /// Adds the row `start` by the cheapest augmenting path and updates the potentials.
    fn place(&mut self, start: usize, search: &mut Search) {
        // one step of Dijkstra's search per pass: offer the columns of `row`, then settle the
        // nearest column; `reached` is the distance to the last column settled
        let mut row = start;
        let mut reached = 0.;
        let mut settled = Vec::new();
        let sink = loop {
            let private = (self.real + row, self.unassigned);
            for &(column, cost) in self.edges[row].iter().chain(std::iter::once(&private)) {
                // rounding may turn a reduced cost of 0 into a tiny negative one
                let reduced = (cost - self.row_potential[row] - self.column_potential[column]).max(0.);
                search.offer(column, reached + reduced, row);
            }
            // the private column of `start` is free, so there is always a next column
            let Some(column) = search.next() else { return };
            reached = search.distance[column];
            settled.push(column);
            match self.row_of[column] {
                None => break column,
                Some(owner) => row = owner,
            }
        };
        self.row_potential[start] += reached;
        for &column in &settled {
            let slack = reached - search.distance[column];
            if let Some(owner) = self.row_of[column] {
                self.row_potential[owner] += slack;
            }
            self.column_potential[column] -= slack;
        }
        // walks back along the path: every row on it takes the column by which it was reached, and
        // its old column passes to the row before
        let mut column = sink;
        loop {
            let row = search.via[column];
            self.row_of[column] = Some(row);
            std::mem::swap(&mut self.column_of[row], &mut column);
            if row == start {
                return;
            }
        }
    }
}

/// State of Dijkstra's search over columns. One instance serves all searches, to save allocations.
struct Search {
    /// Smallest sum of reduced costs found so far along a path to each column; infinite if no path
    /// is known yet.
    distance: Vec<f64>,
    /// Last row on the cheapest path known to each column.
    via: Vec<usize>,
    /// Flag per column: `true` once its distance is final.
    done: Vec<bool>,
    /// Columns whose state must be reset before the next search.
    touched: Vec<usize>,
    /// Queue of the columns to settle. A column may be in the queue more than once.
    heap: BinaryHeap<Waiting>,
}

impl Search {
    /// Puts a column into the queue if `distance` is shorter than the shortest path to it known so
    /// far.
    fn offer(&mut self, column: usize, distance: f64, via: usize) {
        if !self.done[column] && distance < self.distance[column] {
            self.distance[column] = distance;
            self.via[column] = via;
            self.touched.push(column);
            self.heap.push(Waiting { distance, column });
        }
    }

    /// Takes the nearest column that is not yet done out of the queue, and marks it as done.
    fn next(&mut self) -> Option<usize> {
        while let Some(Waiting { column, .. }) = self.heap.pop() {
            if !std::mem::replace(&mut self.done[column], true) {
                return Some(column);
            }
        }
        None
    }

    /// Resets the state for the next search.
    fn clear(&mut self) {
        for column in self.touched.drain(..) {
            self.distance[column] = f64::INFINITY;
            self.done[column] = false;
        }
        self.heap.clear();
    }
}

/// Column in the queue, with its distance. The nearest column compares as the largest, because
/// `BinaryHeap` takes out the largest item first; among equally near columns, the lowest index
/// comes first.
struct Waiting {
    distance: f64,
    column: usize,
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        other.distance.total_cmp(&self.distance).then(other.column.cmp(&self.column))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Waiting {}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Returns the number of rows assigned and the total cost of the best assignment of the rows
    /// from `row` on, found by trying all assignments. Bit c of `taken` is set if column c is taken
    /// already.
    fn best(candidates: &[Vec<(usize, f64)>], row: usize, taken: u32) -> (usize, f64) {
        let Some(edges) = candidates.get(row) else { return (0, 0.) };
        let mut best_so_far = best(candidates, row + 1, taken);
        for &(column, cost) in edges.iter().filter(|(c, _)| taken & (1 << c) == 0) {
            let (n, sum) = best(candidates, row + 1, taken | (1 << column));
            if n + 1 > best_so_far.0 || (n + 1 == best_so_far.0 && sum + cost < best_so_far.1) {
                best_so_far = (n + 1, sum + cost);
            }
        }
        best_so_far
    }

    proptest! {
        #[test]
        fn no_other_assignment_is_larger_or_as_large_and_cheaper(
            costs in prop::collection::vec(prop::collection::vec(prop::option::of(0..40u8), 6), 0..7),
        ) {
            let candidates: Vec<Vec<(usize, f64)>> = costs.iter().map(|row| {
                let edges = row.iter().enumerate();
                edges.filter_map(|(c, cost)| cost.map(|v| (c, f64::from(v) / 8.))).collect()
            }).collect();
            let result = assign(&candidates, 6, 5.);
            let mut taken: Vec<usize> = result.iter().flatten().map(|r| r.0).collect();
            let sum: f64 = result.iter().flatten().map(|r| r.1).sum();
            let (n, least) = best(&candidates, 0, 0);
            prop_assert_eq!(taken.len(), n);
            prop_assert!((sum - least).abs() < 1e-9, "{} instead of {}", sum, least);
            taken.sort_unstable();
            taken.dedup();
            prop_assert_eq!(taken.len(), n);
        }
    }
}
