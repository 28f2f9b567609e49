use serde::Deserialize;
use serde::de::DeserializeOwned;

/// Table 1 of the paper as CSV.
const TABLE_1: &str = include_str!("../../../fixtures/paper/table1.csv");
/// Table 2 of the paper as CSV.
const TABLE_2: &str = include_str!("../../../fixtures/paper/table2.csv");

/// Row of Table 1 of Lanaro et al. (2020): nearest-neighbour distances of a mosaic, in µm, or of a
/// sampler's points in the unit square.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct PrintedRegularity {
    /// Name of the mosaic or of the sampler's point set, as printed.
    #[serde(rename = "mosaic")]
    pub name: String,
    /// Mean of the nearest-neighbour distances: in µm for a mosaic, in sides of the unit square for
    /// a sampler.
    pub mean: f64,
    /// Population standard deviation (divisor n) of the nearest-neighbour distances, in the unit of
    /// `mean`.
    pub sd: f64,
    /// Regularity index: `mean` divided by `sd`, as printed.
    pub ri: f64,
}

/// Row of Table 2 of Lanaro et al. (2020): l-infinity distances between the pair correlation
/// function of a mosaic and those of three samplers. The samplers' patterns have 1024 points each.
#[derive(Clone, Debug, PartialEq)]
pub struct PrintedDistances {
    /// Name of the mosaic.
    pub name: String,
    /// l-infinity distance from the mosaic to each of [`super::TABLE_2_SAMPLERS`].
    pub l_infinity: [f64; 3],
}

/// Returns Table 1 as printed: 19 mosaics and 7 point sets of samplers.
pub fn printed_regularity() -> Vec<PrintedRegularity> {
    rows(TABLE_1)
}

/// Returns Table 2 as printed: 20 mosaics.
pub fn printed_distances() -> Vec<PrintedDistances> {
    let rows: Vec<(String, f64, f64, f64)> = rows(TABLE_2);
    rows.into_iter().map(|(name, b, d, j)| PrintedDistances { name, l_infinity: [b, d, j] }).collect()
}

/// Parses the rows of a table that is compiled into the program. Rows that cannot be parsed are
/// dropped; a test checks that no row is.
fn rows<T: DeserializeOwned>(text: &str) -> Vec<T> {
    csv::Reader::from_reader(text.as_bytes()).deserialize().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::paper::TABLE_1_SAMPLERS;
    use crate::stats::rank_correlation;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn tables_are_complete_and_their_indexes_are_mean_over_deviation() {
        let regularity = printed_regularity();
        assert_eq!((regularity.len(), printed_distances().len()), (26, 20));
        for row in &regularity {
            // the printed deviation has few digits, so the quotient is only this exact
            assert!((row.mean / row.sd / row.ri - 1.).abs() < 1e-4, "{row:?}");
        }
        for (name, ..) in TABLE_1_SAMPLERS {
            assert!(regularity.iter().any(|row| row.name == name), "{name}");
        }
    }

    /// The paper's main finding holds in its own printed tables: the more regular a mosaic is, the
    /// nearer it is to BNOT and the farther from dart throwing.
    #[test]
    fn the_more_regular_printed_mosaics_are_nearer_to_bnot_and_farther_from_dart_throwing() {
        let regularity = printed_regularity();
        let pairs = |column: usize| -> Vec<(f64, f64)> {
            let both = printed_distances().into_iter().filter_map(|d| {
                let row = regularity.iter().find(|r| r.name == d.name)?;
                Some((row.ri, d.l_infinity[column]))
            });
            both.collect()
        };
        let of = |column| rank_correlation(&pairs(column), &mut ChaCha8Rng::seed_from_u64(1)).unwrap();
        assert_eq!(of(0).n, 19);
        assert!(of(0).rho < -0.6 && of(0).p_value < 0.01, "{:?}", of(0));
        assert!(of(1).rho > 0.6 && of(1).p_value < 0.01, "{:?}", of(1));
    }
}
