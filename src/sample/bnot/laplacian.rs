use crate::geometry::power::PowerDiagram;
use rayon::prelude::*;

/// Rows that one thread takes at least: fewer are done sooner than handed over.
const ROWS: usize = 8192;

/// The weighted Laplacian of a graph: row i is Σ_j c_ij (x_i − x_j), with c_ij = c_ji > 0 for neighbours. Symmetric, and
/// positive but for constants, of which it knows nothing.
#[derive(Default)]
pub(super) struct Laplacian {
    /// Where the row of each node ends.
    ends: Vec<u32>,
    neighbours: Vec<(u32, f64)>,
    /// Σ_j c_ij.
    diagonal: Vec<f64>,
}

impl Laplacian {
    /// By how much masses of cells fall with weights: c_ij is the length of the shared edge over twice the distance of
    /// the sites (de Goes et al. 2012; Kitagawa et al. 2019).
    pub(super) fn of(diagram: &PowerDiagram) -> Self {
        let n = diagram.cells().len();
        let mut new = Self::with_room(n, 7 * n);
        for site in 0..n {
            for facet in diagram.facets(site).iter().filter(|f| f.distance > 0.) {
                new.neighbours.push((facet.site, facet.length / (2. * facet.distance)));
            }
            new.end_row();
        }
        new
    }

    fn with_room(rows: usize, neighbours: usize) -> Self {
        Self {
            ends: Vec::with_capacity(rows),
            neighbours: Vec::with_capacity(neighbours),
            diagonal: Vec::with_capacity(rows),
        }
    }

    fn end_row(&mut self) {
        let begin = self.ends.last().map_or(0, |&end| end as usize);
        self.diagonal.push(self.neighbours[begin..].iter().map(|(_, c)| c).sum());
        self.ends.push(self.neighbours.len() as u32);
    }

    pub(super) fn len(&self) -> usize {
        self.diagonal.len()
    }

    fn row(&self, i: usize) -> &[(u32, f64)] {
        let begin = if i == 0 { 0 } else { self.ends[i - 1] as usize };
        &self.neighbours[begin..self.ends[i] as usize]
    }

    /// Σ_j c_ij x_j.
    #[inline]
    fn gathered(&self, i: usize, x: &[f64]) -> f64 {
        self.row(i).iter().map(|&(j, c)| c * x[j as usize]).sum()
    }

    /// out = L x, the same for any number of threads.
    pub(super) fn apply(&self, x: &[f64], out: &mut [f64]) {
        let row = |(i, out): (usize, &mut f64)| *out = self.diagonal[i] * x[i] - self.gathered(i, x);
        if out.len() < 2 * ROWS {
            out.iter_mut().enumerate().for_each(row);
        } else {
            out.par_iter_mut().with_min_len(ROWS).enumerate().for_each(row);
        }
    }

    /// Solves row i for x_i, the others as they are.
    #[inline]
    fn relax(&self, i: usize, b: &[f64], x: &mut [f64]) {
        let diagonal = self.diagonal[i];
        if diagonal > 0. {
            x[i] = (b[i] + self.gathered(i, x)) / diagonal;
        }
    }

    /// One sweep of Gauss and Seidel from the first row to the last.
    pub(super) fn sweep_down(&self, b: &[f64], x: &mut [f64]) {
        (0..self.len()).for_each(|i| self.relax(i, b, x));
    }

    /// One sweep from the last row to the first.
    pub(super) fn sweep_up(&self, b: &[f64], x: &mut [f64]) {
        (0..self.len()).rev().for_each(|i| self.relax(i, b, x));
    }

    /// A group for each node, and how many there are: a node with all its neighbours where none of them has one yet
    /// (Vaněk et al. 1996); the others join a neighbour's.
    pub(super) fn groups(&self) -> (Vec<u32>, usize) {
        const NONE: u32 = u32::MAX;
        let mut groups = vec![NONE; self.len()];
        let mut count = 0;
        for i in 0..self.len() {
            let free = |j: usize| groups[j] == NONE;
            if free(i) && self.row(i).iter().all(|&(j, _)| free(j as usize)) {
                groups[i] = count;
                self.row(i).iter().for_each(|&(j, _)| groups[j as usize] = count);
                count += 1;
            }
        }
        let first = groups.clone();
        for (i, group) in groups.iter_mut().enumerate().filter(|(_, group)| **group == NONE) {
            let grouped = self.row(i).iter().filter(|(j, _)| first[*j as usize] != NONE);
            let closest = grouped.max_by(|a, b| a.1.total_cmp(&b.1));
            *group = closest.map_or(count, |(j, _)| first[*j as usize]);
            count += u32::from(closest.is_none());
        }
        (groups, count as usize)
    }

    /// The Laplacian of the graph of groups: c between two groups is the sum over their nodes.
    pub(super) fn grouped(&self, groups: &[u32], count: usize) -> Self {
        let mut members: Vec<u32> = (0..self.len() as u32).collect();
        members.sort_by_key(|&i| groups[i as usize]);
        let mut new = Self::with_room(count, 7 * count);
        let mut at = vec![usize::MAX; count];
        let mut member = members.iter().peekable();
        for group in 0..count as u32 {
            let begin = new.neighbours.len();
            while let Some(&i) = member.next_if(|i| groups[**i as usize] == group) {
                for &(j, c) in self.row(i as usize) {
                    let other = groups[j as usize];
                    if other == group {
                        continue;
                    }
                    let place = &mut at[other as usize];
                    if *place == usize::MAX || *place < begin {
                        *place = new.neighbours.len();
                        new.neighbours.push((other, c));
                    } else {
                        new.neighbours[*place].1 += c;
                    }
                }
            }
            new.end_row();
        }
        new
    }
}
