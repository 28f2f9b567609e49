use super::cell::{Clip, NO_SITE};
use super::grid::Grid;
use super::{Domain, Raster};
use rayon::prelude::*;

/// Number of sites whose cells are computed as one task of a thread.
const CHUNK: usize = 512;

/// Mass, centroid and spread of the cell of one site.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerCell {
    /// Area of the cell in squared units of the coordinates, or the integral of the density over
    /// the cell; 0 if the site has no cell.
    pub mass: f64,
    /// Centre of mass of the cell, or the site itself if the site has no cell.
    ///
    /// On a torus, the cell is measured in one piece around its site, so its centre may lie beyond
    /// the edges.
    pub centroid: [f64; 2],
    /// Second moment of the cell's area about its own centroid, divided by the square of the area,
    /// whatever the density.
    ///
    /// The value is .1604 for a regular hexagon and .1667 for a square; it is 0 if the site has no
    /// cell.
    pub spread: f64,
}

/// Edge that the cell of one site shares with the cell of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// Index of the neighbouring site.
    pub site: u32,
    /// Length of the edge, or the integral of the density along it.
    pub length: f64,
    /// Distance between the two sites or, on a torus, to the image of the neighbour that makes this
    /// edge.
    pub distance: f64,
}

/// Power diagram: the cells of all sites, in the order of the sites, which together fill the
/// domain.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PowerDiagram {
    cells: Vec<PowerCell>,
    facets: Vec<Facet>,
    /// Index in `facets` at which the facets of each cell end.
    ends: Vec<u32>,
}

impl PowerDiagram {
    /// Returns the cells, one per site.
    pub fn cells(&self) -> &[PowerCell] {
        &self.cells
    }

    /// Returns the edges that the cell of a site shares with other cells.
    ///
    /// On a torus with few sites, the same neighbour may occur more than once.
    pub fn facets(&self, site: usize) -> &[Facet] {
        let begin = if site == 0 { 0 } else { self.ends[site - 1] as usize };
        &self.facets[begin..self.ends[site] as usize]
    }
}

/// Sites at fixed positions, for power diagrams with one set of weights after another.
pub struct PowerSites<'a> {
    domain: &'a Domain,
    density: Option<&'a Raster>,
    sites: Vec<[f64; 2]>,
    grid: Grid,
}

impl<'a> PowerSites<'a> {
    /// Prepares sites in a domain; on a torus, the sites may lie anywhere in the plane.
    ///
    /// If `density` is `None`, the mass of a cell is its area.
    pub fn new(domain: &'a Domain, density: Option<&'a Raster>, sites: &[[f64; 2]]) -> Self {
        let sites: Vec<[f64; 2]> = sites.iter().map(|s| domain.wrapped(*s)).collect();
        let grid = Grid::new(domain, &sites);
        Self { domain, density, sites, grid }
    }

    /// Returns the sites; those of a torus are moved into `[0, width) × [0, height)`.
    pub fn sites(&self) -> &[[f64; 2]] {
        &self.sites
    }

    /// Returns the indices of the sites in the order of a grid, row by row.
    ///
    /// In this order, neighbouring sites are near each other in memory. Sites with a coordinate
    /// that is not finite are missing.
    pub fn order(&self) -> Vec<u32> {
        self.grid.order().collect()
    }

    /// Computes the cells for `weights`, one weight per site, in squared units of the coordinates.
    ///
    /// `before` may be the diagram of the same sites with other weights, or of sites nearby in the
    /// same order. The neighbours in `before` are tried first, which saves time and changes the
    /// result by rounding only.
    ///
    /// If sites of equal weight coincide, the first one gets the cell and the others get none. The
    /// result is the same for any number of threads.
    pub fn diagram(&mut self, weights: &[f64], before: Option<&PowerDiagram>) -> PowerDiagram {
        self.grid.weigh(weights);
        let greatest = weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let sites = &*self;
        let parts: Vec<PowerDiagram> = (0..self.sites.len().div_ceil(CHUNK))
            .into_par_iter()
            .map_init(Clip::default, |clip, chunk| {
                let range = chunk * CHUNK..(self.sites.len()).min((chunk + 1) * CHUNK);
                let mut part = PowerDiagram {
                    cells: Vec::with_capacity(range.len()),
                    facets: Vec::with_capacity(7 * range.len()),
                    ends: Vec::with_capacity(range.len()),
                };
                for site in range {
                    let hints = before.map_or(&[][..], |b| b.facets(site));
                    sites.clip(site, weights, greatest, hints, clip);
                    sites.measure(site, clip, &mut part);
                }
                part
            })
            .collect();
        let mut parts = parts.into_iter();
        let mut whole = parts.next().unwrap_or_default();
        for part in parts {
            let before = whole.facets.len() as u32;
            whole.cells.extend(part.cells);
            whole.facets.extend(part.facets);
            whole.ends.extend(part.ends.iter().map(|end| end + before));
        }
        whole
    }

    /// Computes the cell of site `i` in `clip`, by cutting down the domain.
    ///
    /// `greatest` is the largest weight of a site. `hints` are the facets of a similar cell, whose
    /// sites are tried first.
    fn clip(&self, i: usize, weights: &[f64], greatest: f64, hints: &[Facet], clip: &mut Clip) {
        let site = self.sites[i];
        let [x, y] = site;
        let weight = weights[i];
        if !(x.is_finite() && y.is_finite() && weight.is_finite()) {
            return clip.clear();
        }
        self.domain.begin(site, clip);
        for hint in hints {
            let j = hint.site as usize;
            let [dx, dy] = self.domain.towards(site, self.sites[j]);
            if dx != 0. || dy != 0. {
                clip.cut(dx, dy, weight - weights[j], hint.site);
            }
        }
        // With R the distance of the farthest corner, a site at distance d > R takes nothing from
        // the cell if (d − R)² − w ≥ R² − `weight`, where w is the weight of that site.
        let needed = |clip: &Clip| {
            let r2 = clip.radius2();
            r2.sqrt() + (r2 - weight + greatest).max(0.).sqrt()
        };
        let mut most = if hints.is_empty() { self.grid.step() } else { f64::INFINITY };
        while !clip.is_empty() {
            let reach = needed(clip).min(most);
            self.grid.visit(x, y, reach, |entries, shift_x, shift_y| {
                for e in entries {
                    let (dx, dy) = (e.x + shift_x - x, e.y + shift_y - y);
                    let square = dx * dx + dy * dy;
                    let excess = weight - e.weight;
                    // twice the distance of the bisector, times the distance of the site
                    let twice = square + excess;
                    if (twice >= 0. && twice * twice >= 4. * square * clip.radius2()) || e.site as usize == i
                    {
                        if square > 0. || e.site as usize == i {
                            continue;
                        }
                        // coincident sites: one of them takes all
                        if excess < 0. || (excess == 0. && (e.site as usize) < i) {
                            clip.clear();
                        }
                        continue;
                    }
                    if square == 0. {
                        clip.clear();
                        continue;
                    }
                    clip.cut(dx, dy, excess, e.site);
                }
            });
            if reach >= needed(clip) {
                break;
            }
            most *= 2.;
        }
    }

    /// Appends the mass, centroid, spread and facets of the finished cell of site `i` to `into`.
    fn measure(&self, i: usize, clip: &Clip, into: &mut PowerDiagram) {
        let site = self.sites[i];
        let corners = clip.corners();
        let mut from = corners.last();
        let mut add = |from: &super::cell::Corner, length: f64| {
            if from.site != NO_SITE && length > 0. {
                into.facets.push(Facet { site: from.site, length, distance: from.distance });
            }
        };
        let area = clip.area();
        let whole = if let Some(density) = self.density {
            let mut sums = density.sums(site);
            for to in corners {
                if let Some(from) = from {
                    add(from, sums.edge([from.x, from.y], [to.x, to.y]));
                }
                from = Some(to);
            }
            sums.mass_and_centroid()
        } else {
            for to in corners {
                if let Some(from) = from {
                    add(from, (to.x - from.x).hypot(to.y - from.y));
                }
                from = Some(to);
            }
            area.map(|(area, centroid, _)| (area, centroid))
        };
        let (mass, [x, y]) = whole.unwrap_or((0., [0.; 2]));
        let spread = area.map_or(0., |(_, _, spread)| spread);
        into.cells.push(PowerCell { mass, centroid: [site[0] + x, site[1] + y], spread });
        into.ends.push(into.facets.len() as u32);
    }
}
