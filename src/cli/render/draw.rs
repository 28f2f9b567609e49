use rand::{Rng, RngExt};
use std::str::FromStr;

/// A number, or a range from which each image draws its own number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Draw {
    /// Lower end of the range.
    low: f64,
    /// Upper end of the range, equal to `low` for a single number.
    high: f64,
}

impl Draw {
    /// Returns the number for one image, drawn from the uniform distribution over the range.
    pub fn value(self, rng: &mut dyn Rng) -> f64 {
        if self.low < self.high { rng.random_range(self.low..=self.high) } else { self.low }
    }
}

impl FromStr for Draw {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |part: &str| {
            let value: Option<f64> = part.trim().parse().ok();
            value.filter(|v| v.is_finite()).ok_or("expected a number, or a range such as 0.01..0.05")
        };
        let (low, high) = match text.split_once("..") {
            Some((low, high)) => (number(low)?, number(high)?),
            None => (number(text)?, number(text)?),
        };
        if low <= high {
            Ok(Self { low, high })
        } else {
            Err("the range must run from the smaller to the larger number".to_owned())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn a_range_is_drawn_from_and_a_number_is_itself() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        let range: Draw = "-1..2.5".parse().unwrap();
        let drawn: Vec<f64> = (0..100).map(|_| range.value(&mut rng)).collect();
        assert!(drawn.iter().all(|v| (-1. ..=2.5).contains(v)) && drawn[0] != drawn[1]);
        assert_eq!("0.3".parse::<Draw>().unwrap().value(&mut rng), 0.3);
        for wrong in ["", "a", "1..", "2..1", "1..inf"] {
            assert!(wrong.parse::<Draw>().is_err(), "{wrong}");
        }
    }
}
