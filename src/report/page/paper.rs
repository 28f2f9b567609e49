//! What the re-making of the paper says, in words.

use crate::compare::paper::{DistanceBetween, MadeRow, PAIRS, allowed, peak};
use crate::report::paper::{PaperResults, pair};
use crate::report::{Document, FindingRecord, Headline, Section, TextTable, significant};
use crate::stats::Pcf;

/// A curve that stays below this has no peak: the mean of ten patterns scatters by .03.
const NO_PEAK: f64 = 1.1;

/// With its sign, a true minus.
fn signed(value: f64, decimals: usize) -> String {
    format!("{value:+.decimals$}").replace('-', "−")
}

fn plus_minus(value: Option<f64>, deviation: Option<f64>, decimals: usize) -> String {
    let number = |v: Option<f64>| v.map_or("–".into(), |v| format!("{v:.decimals$}"));
    format!("{} ± {}", number(value), number(deviation))
}

impl PaperResults {
    /// The page. `figure` is Figure 1, as SVG, `made` how and when it was made.
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
            title: "Lanaro et al.: the samplers of its tables and of Figure 1, re-made".into(),
            lead: format!(
                "Every number of ours is the mean of {} patterns with the standard deviation of a single one. The paper gives one \
                 pattern of each sampler, so a printed number agrees if it could be one of ours: within two standard deviations.",
                self.patterns
            ),
            headlines: vec![
                headline(agree, self.rows.len(), "regularity indexes of Table 1's samplers agree"),
                headline(within, PAIRS.len(), "distances between samplers lie where Table 2 allows them"),
                headline(
                    holds,
                    self.tightest.len(),
                    "rows of Table 2 satisfy the triangle inequalities with them",
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

    fn is_allowed(&self, columns: [usize; 2], distance: &DistanceBetween) -> bool {
        let [low, high] = allowed(&self.printed, columns);
        (low..=high).contains(&distance.l_infinity)
    }

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
            "All indexes agree.".to_owned()
        } else {
            let names: Vec<&str> = marked.iter().map(|&k| self.rows[k].printed.name.as_str()).collect();
            format!("Not within two standard deviations: {}.", names.join(", "))
        }];
        let other: Vec<String> = self
            .rows
            .iter()
            .filter(|r| !r.mean_agrees())
            .filter_map(|r| Some((r, r.points_by_mean_distance()?)))
            .map(|(r, (points, _))| format!("{} fits {points:.0} points", r.printed.name))
            .collect();
        after.push(
            "Mean and deviation are lengths, they go with 1/√n; the index has no unit. “Points by mean” is the number of points at \
             which our patterns would have the printed mean distance."
                .into(),
        );
        if !other.is_empty() {
            after.push(format!(
                "Printed means that one of our patterns of that many points would not have: {}. Where a set does not hold \
                 exactly the number of points that it is called by, as the sets of noise from the tables of Ahmed et al. (2015) that \
                 the paper used, its lengths differ and its index does not.",
                other.join(", ")
            ));
        }
        after.push(
            "How ours are made: green and pink noise by moving points until they have the pair correlation function of such noise; \
             BNOT (de Goes et al. 2012) stopped after 20 steps. Where it stops decides its index: run to convergence, \
             as “conemosaic sample bnot” does, it is above 25."
                .into(),
        );
        Section {
            heading: "Table 1: regularity of the samplers".into(),
            before: vec![
                "Distance of every point to its nearest neighbour in the unit square: mean, standard deviation (population) and \
                 their ratio, the regularity index RI. All points count, those at the border too."
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
                "From left to right: no order; clusters (green and pink noise); one point a cell; points that keep a distance; points \
                 whose cells are all of one area. The more regular a sampler, the darker the middle of its spectrum and the higher \
                 the first peak of g(r) near one spacing."
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
                    "Above: 1024 points of each sampler. Middle: power spectrum of 4096 points on the torus; black is 0, white three \
                     times the power of independent points, the side 5 √n. Below: mean pair correlation function of {} patterns of \
                     1024 points (Gaussian kernel of 0.1 spacings), and the radial mean of the spectra.",
                    self.patterns
                ),
            )),
            files: vec!["figure1.svg", "pcf.csv", "spectra.csv"],
            ..Section::default()
        }
    }

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
            heading: "Table 2: distances between its samplers".into(),
            before: vec![
                "l-infinity is the greatest difference of two pair correlation functions. The paper prints how far each mosaic is from \
                 three samplers, not how far these are from each other. But for every mosaic, whichever it was, the distance \
                 between two samplers is at least the difference and at most the sum of the mosaic's distances to them: so the \
                 printed rows fence in three numbers that they do not show."
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

    fn bandwidths_in_words(&self) -> String {
        let of = self.printed.len();
        let scan: Vec<String> =
            self.bandwidths.iter().map(|b| format!("{:.2}: {}", b.bandwidth, b.holds)).collect();
        format!(
            "The first fence is narrow, and the distances move with the kernel's bandwidth, which the paper does not state in \
             spacings. Rows of Table 2, of {of}, that hold at other bandwidths: {}. Details: bandwidths.csv.",
            scan.join("; ")
        )
    }

    fn triangle_section(&self) -> Section {
        let rows = self.printed.iter().zip(&self.tightest).map(|(row, t)| {
            let [b, d, j] = row.l_infinity.map(|v| format!("{v:.3}"));
            vec![row.name.clone(), b, d, j, signed(t.room, 3), pair(t.between)]
        });
        let broken: Vec<usize> = (0..self.tightest.len()).filter(|&k| self.tightest[k].room < 0.).collect();
        let after = if broken.is_empty() {
            "Every row holds: the printed table and our samplers can be measured in one space.".to_owned()
        } else {
            format!(
                "{} of {} rows are broken, by as much as their room is negative.",
                broken.len(),
                self.tightest.len()
            )
        };
        Section {
            heading: "All rows of Table 2, with our samplers".into(),
            before: vec![
                "The printed distances of each mosaic, and the room that the tightest of its triangle inequalities leaves; negative \
                 room is a contradiction."
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

    fn finding_section(&self) -> Section {
        let row = |f: &FindingRecord| {
            let number = |v: Option<f64>| v.map_or("–".into(), |v| signed(v, 2));
            let p = f.correlation.map_or("–".into(), |c| significant(c.p_value, 2));
            vec![f.sampler.clone(), f.mosaics.to_string(), number(f.correlation.map(|c| c.rho)), p]
        };
        Section {
            heading: "The main finding, on the printed numbers".into(),
            before: vec![
                "Rank correlation (Spearman) of the regularity index of Table 1 with the distances of Table 2, for the mosaics that both \
                 tables have, and its p-value by permutation. The same test runs on your own mosaics: conemosaic compare."
                    .into(),
            ],
            table: Some(TextTable {
                header: ["distance to", "mosaics", "ρ", "p"].map(str::to_owned).into(),
                rows: self.findings.iter().map(row).collect(),
            }),
            after: vec![
                "The paper finds that the more regular a mosaic is, the more it resembles BNOT and the less dart throwing. On its own \
                 numbers that is so if ρ is clearly negative in the first row and clearly positive in the second."
                    .into(),
            ],
            files: vec!["finding.csv"],
            ..Section::default()
        }
    }
}
