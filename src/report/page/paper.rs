//! The page of the command `paper`, which compares reproduced values with those that Lanaro et al.
//! (2020) print.

use crate::compare::paper::{DistanceBetween, MadeRow, PAIRS, allowed, peak};
use crate::report::paper::{PaperResults, pair};
use crate::report::{Document, FindingRecord, Headline, Section, TextTable, significant};
use crate::stats::Pcf;

/// Value that the maximum of a mean g(r) must reach to be called a peak.
///
/// The mean of ten patterns scatters by .03.
const NO_PEAK: f64 = 1.1;

/// Returns a number with its sign, with the minus sign U+2212 instead of a hyphen.
fn signed(value: f64, decimals: usize) -> String {
    format!("{value:+.decimals$}").replace('-', "−")
}

/// Returns a value and its standard deviation with `decimals` decimals, with a dash for what is
/// missing.
fn plus_minus(value: Option<f64>, deviation: Option<f64>, decimals: usize) -> String {
    let number = |v: Option<f64>| v.map_or("–".into(), |v| format!("{v:.decimals$}"));
    format!("{} ± {}", number(value), number(deviation))
}

impl PaperResults {
    /// Returns the page as a document.
    ///
    /// `figure` is Figure 1 as SVG; `made` says how and when the page was made.
    pub fn document(&self, figure: String, made: String) -> Document {
        let agree = self.rows.iter().filter(|r| r.agrees()).count();
        let holds = self.tightest.iter().filter(|t| t.room >= 0.).count();
        let within =
            PAIRS.iter().zip(&self.distances).filter(|(columns, d)| self.is_allowed(**columns, d)).count();
        let headline = |found: usize, of: usize, words: &str| Headline {
            number: format!("{found} of {of}"),
            words: words.to_owned(),
            good: found == of,
        };
        Document {
            title: "Samplers in Lanaro et al. (2020): Tables 1 and 2 and Figure 1 reproduced".into(),
            lead: format!(
                "Numbers called “ours” were computed by this program: each is the mean over {} patterns, with the standard deviation of \
                 a single pattern. The paper gives one pattern of each sampler, so a printed number agrees with ours if it is within \
                 two standard deviations of our mean.",
                self.patterns
            ),
            headlines: vec![
                headline(agree, self.rows.len(), "regularity indexes of the samplers in Table 1 agree"),
                headline(
                    within,
                    PAIRS.len(),
                    "distances between samplers are in the range that Table 2 allows",
                ),
                headline(
                    holds,
                    self.tightest.len(),
                    "rows of Table 2 satisfy the triangle inequalities with these distances",
                ),
            ],
            sections: vec![
                self.table1_section(),
                self.figure_section(figure),
                self.table2_section(),
                self.triangle_section(),
                self.finding_section(),
            ],
            colophon: made,
        }
    }

    /// Returns whether a distance between two samplers is in the range that the printed rows allow.
    fn is_allowed(&self, columns: [usize; 2], distance: &DistanceBetween) -> bool {
        let [low, high] = allowed(&self.printed, columns);
        (low..=high).contains(&distance.l_infinity)
    }

    /// Returns the section on the regularity of the samplers.
    fn table1_section(&self) -> Section {
        let header = [
            "printed as",
            "sampler, n",
            "mean, printed",
            "mean, ours",
            "SD, printed",
            "SD, ours",
            "RI, printed",
            "RI, ours",
            "off by",
            "points by mean",
        ];
        let row = |r: &MadeRow| {
            vec![
                r.printed.name.clone(),
                format!("{}, {}", r.sampler, r.n),
                format!("{:.5}", r.printed.mean),
                plus_minus(r.mean.mean, r.mean.sd, 5),
                format!("{:.5}", r.printed.sd),
                plus_minus(r.sd.mean, r.sd.sd, 5),
                format!("{:.3}", r.printed.ri),
                plus_minus(r.ri.mean, r.ri.sd, 3),
                r.deviations().map_or("–".into(), |z| signed(z, 1) + " SD"),
                r.points_by_mean_distance().map_or("–".into(), |(n, sd)| format!("{n:.0} ± {sd:.0}")),
            ]
        };
        let marked: Vec<usize> = (0..self.rows.len()).filter(|&k| !self.rows[k].agrees()).collect();
        let mut after = vec![if marked.is_empty() {
            "All printed regularity indexes agree with ours.".to_owned()
        } else {
            let names: Vec<&str> = marked.iter().map(|&k| self.rows[k].printed.name.as_str()).collect();
            format!(
                "Printed regularity indexes that are more than two standard deviations from our mean: {}.",
                names.join(", ")
            )
        }];
        let other: Vec<String> = self
            .rows
            .iter()
            .filter(|r| !r.mean_agrees())
            .filter_map(|r| Some((r, r.points_by_mean_distance()?)))
            .map(|(r, (points, _))| format!("{} ({points:.0} points)", r.printed.name))
            .collect();
        after.push(
            "The mean and the standard deviation (SD) are lengths and are proportional to 1/√n; the index has no unit. “Points by \
             mean” is the number of points at which our patterns would have the printed mean distance."
                .into(),
        );
        if !other.is_empty() {
            after.push(format!(
                "Printed means that differ from ours by more than two standard deviations, with the number of points that they \
                 suggest: {}. Such a difference arises if a set does not have exactly the number of points in its name, for example \
                 the sets of noise that the paper took from the tables of Ahmed et al. (2015). Then the lengths differ, but the \
                 index does not.",
                other.join(", ")
            ));
        }
        after.push(
            "How our patterns are made: for green and pink noise, points are moved until they have the pair correlation function of \
             such noise. BNOT (de Goes et al. 2012) is stopped after 20 steps. Its index depends on the number of steps: if it is run \
             to convergence, as “conemosaic sample bnot” does, the index is above 25."
                .into(),
        );
        Section {
            heading: "Table 1: regularity of the samplers".into(),
            before: vec![
                "Distance from each point to its nearest neighbour in the unit square: mean, standard deviation (population) and \
                 their ratio, the regularity index RI. All points count, including those at the border."
                    .into(),
            ],
            table: Some(TextTable {
                header: header.map(str::to_owned).into(),
                rows: self.rows.iter().map(row).collect(),
            }),
            marked,
            after,
            files: vec!["table1.csv"],
            ..Section::default()
        }
    }

    /// Returns the section with Figure 1 and the peaks of the curves in it.
    fn figure_section(&self, figure: String) -> Section {
        let row = |(name, curve): &(String, Pcf)| {
            let (g, r) = peak(curve).unwrap_or((f64::NAN, f64::NAN));
            if g < NO_PEAK {
                return vec![name.clone(), "none".into(), String::new()];
            }
            let at_start = curve.r.first().is_some_and(|&first| r <= first + 1e-9);
            let place = if at_start { format!("{r:.2} (first bin)") } else { format!("{r:.2}") };
            vec![name.clone(), significant(g, 3), place]
        };
        Section {
            heading: "Figure 1: six samplers".into(),
            before: vec![
                "From left to right: points without order; clustered points (green and pink noise); one point in each cell of a grid; \
                 points that keep a minimum distance; points whose cells all have the same area. The more regular a sampler is, the \
                 darker is the centre of its spectrum and the higher is the first peak of g(r), near one spacing."
                    .into(),
            ],
            table: Some(TextTable {
                header: ["sampler", "peak of g", "at r / spacing"].map(str::to_owned).into(),
                rows: self.curves.iter().map(row).collect(),
            }),
            figure: Some((
                figure,
                "figure1.svg",
                format!(
                    "Top: 1024 points of each sampler. Middle: power spectrum of 4096 points on the torus; black is 0, white is three \
                     times the power of independent points, and the side is 5 √n. Bottom: mean pair correlation function of {} patterns \
                     of 1024 points (Gaussian kernel with a standard deviation of 0.1 spacings), and radial mean of the spectra.",
                    self.patterns
                ),
            )),
            files: vec!["figure1.svg", "pcf.csv", "spectra.csv"],
            ..Section::default()
        }
    }

    /// Returns the section on the distances between the samplers of Table 2.
    fn table2_section(&self) -> Section {
        let rows = PAIRS.iter().zip(&self.distances).map(|(&columns, d)| {
            let [low, high] = allowed(&self.printed, columns);
            vec![
                pair(columns),
                plus_minus(Some(d.l_infinity), Some(d.error), 3),
                format!("{low:.3} to {high:.3}"),
                if self.is_allowed(columns, d) { "yes" } else { "no" }.to_owned(),
            ]
        });
        let marked = (0..PAIRS.len()).filter(|&k| !self.is_allowed(PAIRS[k], &self.distances[k])).collect();
        Section {
            heading: "Table 2: distances between the samplers".into(),
            before: vec![
                "l-infinity is the largest difference between two pair correlation functions. The paper prints the distance from each \
                 mosaic to three samplers, but not the distances between these samplers. By the triangle inequality, however, the \
                 distance between two samplers is at least the difference and at most the sum of the distances from any mosaic to \
                 them. The printed rows therefore restrict the three distances between samplers to the ranges below."
                    .into(),
            ],
            table: Some(TextTable {
                header: ["between", "l-infinity, ours ± standard error", "allowed by the printed rows", "within"]
                    .map(str::to_owned)
                    .into(),
                rows: rows.collect(),
            }),
            marked,
            after: vec![self.bandwidths_in_words()],
            files: vec!["table2_samplers.csv", "bandwidths.csv"],
            ..Section::default()
        }
    }

    /// Returns a paragraph on how many rows of Table 2 satisfy the triangle inequality, by the
    /// bandwidth of the kernel.
    fn bandwidths_in_words(&self) -> String {
        let of = self.printed.len();
        let scan: Vec<String> =
            self.bandwidths.iter().map(|b| format!("{:.2}: {}", b.bandwidth, b.holds)).collect();
        format!(
            "The first range is narrow, and the distances depend on the bandwidth of the kernel, which the paper does not state in \
             spacings. Number of rows of Table 2 (of {of}) that satisfy the triangle inequalities, by bandwidth in spacings: {}. \
             For details see bandwidths.csv.",
            scan.join("; ")
        )
    }

    /// Returns the section on the triangle inequalities of all rows of Table 2.
    fn triangle_section(&self) -> Section {
        let rows = self.printed.iter().zip(&self.tightest).map(|(row, t)| {
            let [b, d, j] = row.l_infinity.map(|v| format!("{v:.3}"));
            vec![row.name.clone(), b, d, j, signed(t.room, 3), pair(t.between)]
        });
        let broken: Vec<usize> = (0..self.tightest.len()).filter(|&k| self.tightest[k].room < 0.).collect();
        let after = if broken.is_empty() {
            "All rows satisfy the inequalities: the printed distances are compatible with the recomputed distances between the samplers.".to_owned()
        } else {
            format!(
                "{} of {} rows violate an inequality; the negative room says by how much.",
                broken.len(),
                self.tightest.len()
            )
        };
        Section {
            heading: "All rows of Table 2, with recomputed distances between the samplers".into(),
            before: vec![
                "Printed distances from each mosaic to the samplers, and how far they are from violating a triangle inequality \
                 with the distances between the samplers that this program computes. Negative room means that the inequality \
                 is violated."
                    .into(),
            ],
            table: Some(TextTable {
                header: ["mosaic", "to BNOT", "to dart throwing", "to jittered", "room", "tightest between"]
                    .map(str::to_owned)
                    .into(),
                rows: rows.collect(),
            }),
            marked: broken,
            after: vec![after],
            files: vec!["triangle.csv"],
            ..Section::default()
        }
    }

    /// Returns the section on the main finding of the paper.
    fn finding_section(&self) -> Section {
        let row = |f: &FindingRecord| {
            let number = |v: Option<f64>| v.map_or("–".into(), |v| signed(v, 2));
            let p = f.correlation.map_or("–".into(), |c| significant(c.p_value, 2));
            vec![f.sampler.clone(), f.mosaics.to_string(), number(f.correlation.map(|c| c.rho)), p]
        };
        Section {
            heading: "The main finding, tested on the printed numbers".into(),
            before: vec![
                "Rank correlation (Spearman) between the regularity index in Table 1 and the distances in Table 2, over the mosaics \
                 in both tables, with its p-value by permutation. The command “conemosaic compare” runs the same test on your own \
                 mosaics."
                    .into(),
            ],
            table: Some(TextTable {
                header: ["distance to", "mosaics", "ρ", "p"].map(str::to_owned).into(),
                rows: self.findings.iter().map(row).collect(),
            }),
            after: vec![
                "The paper finds that the more regular a mosaic is, the more it resembles BNOT and the less it resembles dart throwing. \
                 Its printed numbers support this if ρ is clearly negative in the first row and clearly positive in the second."
                    .into(),
            ],
            files: vec!["finding.csv"],
            ..Section::default()
        }
    }
}
