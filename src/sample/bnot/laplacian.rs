//! Graph Laplacians: products, Gauss–Seidel sweeps, and coarser graphs of grouped nodes.

use crate::geometry::power::PowerDiagram;
use rayon::prelude::*;

/// Smallest number of rows that are given to one thread. With fewer, handing them over would take
/// longer than computing them.
const ROWS: usize = 8192;

/// Weighted Laplacian L of a graph: row i is Σ_j c_ij (x_i − x_j), with c_ij = c_ji > 0 for
/// neighbours.
///
/// L is symmetric and positive, except that it maps constants to 0.
#[derive(Default)]
pub(super) struct Laplacian {
    /// Index in `neighbours` at which each node's row ends.
    ends: Vec<u32>,
    /// Neighbour j and coefficient c_ij, row by row.
    neighbours: Vec<(u32, f64)>,
    /// Sum Σ_j c_ij of each row i.
    diagonal: Vec<f64>,
}

impl Laplacian {
    /// Returns the Laplacian that tells how the masses of cells change with the weights.
    ///
    /// c_ij is the length of the edge that two cells share, divided by twice the distance between
    /// their sites.
    ///
    /// Sources: de Goes et al. (2012), <https://doi.org/10.1145/2366145.2366190>; Kitagawa et al.
    /// (2019), <https://doi.org/10.4171/JEMS/889>.
    pub(super) fn of(diagram: &PowerDiagram) -> Self {
        let n = diagram.cells().len();
        // A cell has six neighbours on average; 7 leaves some room.
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

    /// Ends the current row, whose neighbours have been appended, and computes its diagonal entry.
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

    /// Computes Σ_j c_ij x_j for row `i`.
    #[inline]
    fn gathered(&self, i: usize, x: &[f64]) -> f64 {
        self.row(i).iter().map(|&(j, c)| c * x[j as usize]).sum()
    }

    /// Writes L x to `out`; the result is the same for any number of threads.
    pub(super) fn apply(&self, x: &[f64], out: &mut [f64]) {
        let row = |(i, out): (usize, &mut f64)| *out = self.diagonal[i] * x[i] - self.gathered(i, x);
        if out.len() < 2 * ROWS {
            out.iter_mut().enumerate().for_each(row);
        } else {
            out.par_iter_mut().with_min_len(ROWS).enumerate().for_each(row);
        }
    }

    /// Solves row `i` of L x = b for x_i and leaves all other x as they are.
    #[inline]
    fn relax(&self, i: usize, b: &[f64], x: &mut [f64]) {
        let diagonal = self.diagonal[i];
        if diagonal > 0. {
            x[i] = (b[i] + self.gathered(i, x)) / diagonal;
        }
    }

    /// Runs one Gauss–Seidel sweep from the first row to the last.
    pub(super) fn sweep_down(&self, b: &[f64], x: &mut [f64]) {
        (0..self.len()).for_each(|i| self.relax(i, b, x));
    }

    /// Runs one Gauss–Seidel sweep from the last row to the first.
    pub(super) fn sweep_up(&self, b: &[f64], x: &mut [f64]) {
        (0..self.len()).rev().for_each(|i| self.relax(i, b, x));
    }

    /// Returns the group of each node, and the number of groups.
    ///
    /// A node and all its neighbours form a group if none of them belongs to a group yet; every
    /// other node joins the group of its most strongly connected neighbour.
    ///
    /// Source: Vaněk, Mandel and Brezina (1996), <https://doi.org/10.1007/BF02238511>.
    pub(super) fn groups(&self) -> (Vec<u32>, usize) {
        // marks a node that belongs to no group yet
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

    /// Returns the Laplacian of the graph whose nodes are the groups.
    ///
    /// The coefficient c between two groups is the sum of the coefficients between their nodes.
    pub(super) fn grouped(&self, groups: &[u32], count: usize) -> Self {
        let mut members: Vec<u32> = (0..self.len() as u32).collect();
        members.sort_by_key(|&i| groups[i as usize]);
        let mut new = Self::with_room(count, 7 * count);
        // index of each group's entry in `new.neighbours`; indices before `begin` belong to earlier
        // rows
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
