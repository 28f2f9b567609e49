use rand::{Rng, RngExt};
use rand_distr::StandardNormal;

/// Draws a normal deviate of mean `mean` and standard deviation `sd`.
///
/// Deviates more than `most` standard deviations from the mean are drawn again.
pub(super) fn truncated(mean: f64, sd: f64, most: f64, rng: &mut dyn Rng) -> f64 {
    loop {
        let deviate: f64 = rng.sample(StandardNormal);
        if deviate.abs() <= most {
            return mean + sd * deviate;
        }
    }
}

/// Returns the position (x, y), displaced in x and in y by normal deviates of standard deviation
/// `sd`.
pub(super) fn displaced([x, y]: [f64; 2], sd: f64, rng: &mut dyn Rng) -> [f64; 2] {
    let (dx, dy): (f64, f64) = (rng.sample(StandardNormal), rng.sample(StandardNormal));
    [x + sd * dx, y + sd * dy]
}
