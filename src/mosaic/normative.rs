//! Cone density to expect at a location in the average eye, for comparison with a measured density.
//!
//! The values are those of Curcio, Sloan, Kalina & Hendrickson (1990),
//! <https://doi.org/10.1002/cne.902920402>, along four meridians. Between two eccentricities the
//! logarithm of the density is interpolated linearly.

use serde::{Deserialize, Serialize};
use std::str::FromStr;
use strum::{Display, IntoStaticStr, VariantArray};

/// Cone density towards the nose: pairs of eccentricity (mm of retina) and cones per mm².
///
/// As on the other meridians, the values are read off the published curves, which are means over
/// the eyes. There is no value at 4 mm, where the optic disc is.
const NASAL: &[(f64, f64)] = &[
    (0., 196_000.),
    (0.05, 154_000.),
    (0.1, 115_000.),
    (0.15, 93_000.),
    (0.2, 73_000.),
    (0.3, 53_000.),
    (0.4, 42_000.),
    (0.5, 36_000.),
    (0.6, 31_000.),
    (0.7, 26_000.),
    (0.8, 23_000.),
    (0.9, 22_000.),
    (1., 21_000.),
    (2., 12_400.),
    (3., 8_700.),
    (5., 7_100.),
    (6., 6_600.),
    (7., 6_300.),
    (8., 6_200.),
    (9., 5_900.),
    (10., 5_500.),
    (11., 5_400.),
    (12., 5_100.),
    (13., 5_000.),
    (14., 4_900.),
    (15., 4_800.),
    (16., 4_800.),
    (17., 4_800.),
    (18., 4_800.),
    (19., 4_900.),
    (20., 5_300.),
    (21., 5_000.),
    (22., 5_200.),
];

/// Cone density towards the temple: pairs of eccentricity (mm of retina) and cones per mm².
const TEMPORAL: &[(f64, f64)] = &[
    (0., 196_000.),
    (0.05, 161_000.),
    (0.1, 121_000.),
    (0.15, 98_000.),
    (0.2, 79_000.),
    (0.3, 58_000.),
    (0.4, 45_000.),
    (0.5, 38_000.),
    (0.6, 34_000.),
    (0.7, 29_000.),
    (0.8, 24_000.),
    (0.9, 22_000.),
    (1., 21_000.),
    (2., 11_600.),
    (3., 9_000.),
    (4., 6_900.),
    (5., 5_700.),
    (6., 5_100.),
    (7., 4_800.),
    (8., 4_400.),
    (9., 4_200.),
    (10., 3_900.),
    (11., 3_700.),
    (12., 3_600.),
    (13., 3_400.),
    (14., 3_400.),
    (15., 3_400.),
    (16., 3_200.),
    (17., 3_100.),
    (18., 3_400.),
];

/// Cone density upwards on the retina: pairs of eccentricity (mm of retina) and cones per mm².
const SUPERIOR: &[(f64, f64)] = &[
    (0., 198_000.),
    (0.05, 141_000.),
    (0.1, 106_000.),
    (0.15, 84_000.),
    (0.2, 66_000.),
    (0.3, 47_000.),
    (0.4, 36_000.),
    (0.5, 28_000.),
    (0.6, 24_000.),
    (0.7, 21_000.),
    (0.8, 19_000.),
    (0.9, 17_000.),
    (1., 16_000.),
    (2., 10_100.),
    (3., 7_600.),
    (4., 6_000.),
    (5., 5_300.),
    (6., 4_900.),
    (7., 4_700.),
    (8., 4_500.),
    (9., 4_300.),
    (10., 4_300.),
    (11., 4_200.),
    (12., 4_000.),
    (13., 4_000.),
    (14., 3_900.),
    (15., 3_900.),
    (16., 3_800.),
    (17., 3_900.),
    (18., 3_900.),
    (19., 4_100.),
    (20., 3_300.),
];

/// Cone density downwards on the retina: pairs of eccentricity (mm of retina) and cones per mm².
const INFERIOR: &[(f64, f64)] = &[
    (0., 198_000.),
    (0.05, 147_000.),
    (0.1, 108_000.),
    (0.15, 86_000.),
    (0.2, 69_000.),
    (0.3, 51_000.),
    (0.4, 40_000.),
    (0.5, 33_000.),
    (0.6, 28_000.),
    (0.7, 24_000.),
    (0.8, 21_000.),
    (0.9, 19_000.),
    (1., 17_000.),
    (2., 10_400.),
    (3., 7_600.),
    (4., 6_200.),
    (5., 5_500.),
    (6., 5_100.),
    (7., 4_800.),
    (8., 4_500.),
    (9., 4_300.),
    (10., 4_100.),
    (11., 3_900.),
    (12., 3_800.),
    (13., 3_700.),
    (14., 3_700.),
    (15., 3_800.),
    (16., 3_800.),
    (17., 3_900.),
    (18., 3_900.),
    (19., 4_700.),
];

/// Direction from the fovea on the retina, which is opposite to the direction in the visual field.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Serialize,
    Deserialize,
    Display,
    IntoStaticStr,
    VariantArray,
    strum::VariantNames,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "kebab-case")]
pub enum Meridian {
    /// Direction towards the nose and the optic disc.
    Nasal,
    /// Direction towards the temple.
    Temporal,
    /// Direction upwards on the retina.
    Superior,
    /// Direction downwards on the retina.
    Inferior,
}

impl Meridian {
    /// Returns the word for the meridian in options and tables.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Returns pairs of eccentricity (mm of retina) and cones per mm², in rising order of
    /// eccentricity.
    const fn densities(self) -> &'static [(f64, f64)] {
        match self {
            Self::Nasal => NASAL,
            Self::Temporal => TEMPORAL,
            Self::Superior => SUPERIOR,
            Self::Inferior => INFERIOR,
        }
    }

    /// Returns the largest eccentricity, in mm, at which the density on this meridian is known.
    pub fn farthest(self) -> f64 {
        self.densities().last().map_or(0., |(at, _)| *at)
    }

    /// Returns the cones per mm² at `eccentricity_mm`, the distance from the fovea in mm of retina.
    ///
    /// The logarithm of the density is interpolated between the known values. `None` beyond the
    /// last known value, and if the eccentricity is negative or not a number.
    pub fn cones_per_mm2(self, eccentricity_mm: f64) -> Option<f64> {
        let known = self.densities();
        let after = known.partition_point(|(at, _)| *at < eccentricity_mm);
        let (to, b) = *known.get(after)?;
        let (from, a) = *known.get(after.saturating_sub(1))?;
        if !(0. ..=to).contains(&eccentricity_mm) {
            return None;
        }
        let share = if to > from { (eccentricity_mm - from) / (to - from) } else { 0. };
        Some(a * (b / a).powf(share))
    }
}

impl FromStr for Meridian {
    type Err = String;

    /// Reads the name of a meridian or its first letter, in upper or lower case.
    ///
    /// # Errors
    /// Fails if the text is neither; the message lists the four names.
    fn from_str(text: &str) -> Result<Self, String> {
        let text = text.trim().to_lowercase();
        let fits = |m: &Self| text == m.name() || text == m.name()[..1];
        Self::VARIANTS.iter().copied().find(fits).ok_or_else(|| {
            format!(
                "“{text}” is not a meridian: expected nasal, temporal, superior or inferior (of the retina)"
            )
        })
    }
}

/// Location on the retina, as far as it is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RetinalPlace {
    /// Distance from the fovea along the retina, in mm.
    pub eccentricity_mm: f64,
    /// Direction from the fovea; `None` if it is not known.
    pub meridian: Option<Meridian>,
}

impl RetinalPlace {
    /// Returns the cones per mm² at this location in the average eye.
    ///
    /// This is the value on the meridian or, if that is not known, the mean of all four (Curcio et
    /// al. 1990, <https://doi.org/10.1002/cne.902920402>). `None` beyond the published values,
    /// which end at 18 mm (temporal, and the mean) to 22 mm (nasal).
    pub fn expected_cones_per_mm2(&self) -> Option<f64> {
        match self.meridian {
            Some(meridian) => meridian.cones_per_mm2(self.eccentricity_mm),
            None => {
                let all = Meridian::VARIANTS.iter().map(|m| m.cones_per_mm2(self.eccentricity_mm));
                let known: Option<Vec<f64>> = all.into_iter().collect();
                known.map(|known| known.iter().sum::<f64>() / known.len() as f64)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_values_are_given_back_and_those_between_lie_between() {
        let at = |m: Meridian, mm: f64| m.cones_per_mm2(mm);
        for &meridian in Meridian::VARIANTS {
            for &(mm, density) in meridian.densities() {
                assert!((at(meridian, mm).unwrap() / density - 1.).abs() < 1e-12, "{meridian} {mm}");
            }
            for pair in meridian.densities().windows(2) {
                let ((from, a), (to, b)) = (pair[0], pair[1]);
                assert!(from < to);
                let between = at(meridian, (from + to) / 2.).unwrap();
                assert!((between - (a * b).sqrt()).abs() < 1e-6 * between);
            }
        }
        assert_eq!(at(Meridian::Temporal, 18.).unwrap().round(), 3_400.);
        let mean = RetinalPlace { eccentricity_mm: 1., meridian: None }.expected_cones_per_mm2().unwrap();
        assert!((mean - (21_000. + 21_000. + 16_000. + 17_000.) / 4.).abs() < 1e-9);
    }

    #[test]
    fn nothing_is_expected_where_nothing_was_counted() {
        assert_eq!(Meridian::Temporal.cones_per_mm2(18.1), None);
        assert_eq!(Meridian::Nasal.cones_per_mm2(-0.1), None);
        assert_eq!(Meridian::Nasal.cones_per_mm2(f64::NAN), None);
        assert_eq!(RetinalPlace { eccentricity_mm: 18.5, meridian: None }.expected_cones_per_mm2(), None);
        assert!(
            RetinalPlace { eccentricity_mm: 21., meridian: Some(Meridian::Nasal) }
                .expected_cones_per_mm2()
                .is_some()
        );
    }

    #[test]
    fn meridians_are_read_by_name_and_letter() {
        for &meridian in Meridian::VARIANTS {
            assert_eq!(meridian.name().parse(), Ok(meridian));
            assert_eq!(meridian.name()[..1].to_uppercase().parse(), Ok(meridian));
        }
        assert!("N-T".parse::<Meridian>().unwrap_err().contains("nasal"));
    }
}
