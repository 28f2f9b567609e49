//! Reference curves that come with the program.
//!
//! The table has curves of the default samplers, with the default options and seed, for the classes
//! of mosaics that are usual for images. `scripts/make-curves` computes `curves.bin` again.

use super::curve_class::{Class, Shape};
use super::shipped_codec::{self as codec, Entry, Key};
use super::{CompareError, ReferenceCurve, References};
use crate::mosaic::hexagonal_spacing;
use crate::sample::{Sampler, as_reference, sampler, samplers_by_default};
use crate::stats::{Pcf, PcfOptions};
use sha2::{Digest, Sha256};
use std::collections::HashMap;
use std::ops::RangeInclusive;
use std::sync::LazyLock;

/// Seed with which the shipped curves were made. It is also the default seed of the program.
const SEED: u64 = 1;
/// Numbers of points that the table covers, as exponents of 1.2: from 18 to 22 645 points.
const SIZES: RangeInclusive<i8> = 16..=55;
/// Aspect ratios (width / height) that the table covers, as exponents of 1.2: from 1 : 2.07 to 2.07
/// : 1.
const ASPECTS: RangeInclusive<i8> = -4..=4;

/// Content of the file `curves.bin`, compiled into the program.
static BYTES: &[u8] = include_bytes!("curves.bin");

/// Table of shipped curves. It is empty if the file was made with other samplers, options or
/// classes than the program has now.
static TABLE: LazyLock<HashMap<Key, Entry>> =
    LazyLock::new(|| codec::read(BYTES, &fingerprint(), PcfOptions::default().bins).unwrap_or_default());

/// Returns the shipped curve of a sampler for `class`; `None` if the table has none, or if
/// `options`, `seed` or the sampler's parameters are not the defaults.
pub(super) fn find(
    sampler: &dyn Sampler,
    class: &Class,
    options: &PcfOptions,
    seed: u64,
) -> Option<ReferenceCurve> {
    if seed != SEED || *options != PcfOptions::default() || !is_usual(sampler) {
        return None;
    }
    let Shape::Rectangle { aspect, torus: false } = class.shape else { return None };
    let place = samplers_by_default().iter().position(|s| s.name() == sampler.name())?;
    let key = Key { n: class.n.try_into().ok()?, aspect: aspect.try_into().ok()?, sampler: place as u8 };
    let entry = TABLE.get(&key)?;
    let n = class.points();
    let spacing = hexagonal_spacing(n, 1.)?;
    Some(ReferenceCurve {
        sampler: sampler.name().to_owned(),
        pcf: Pcf { r: options.radii(), g: entry.g.clone(), spacing, options: *options },
        n,
        realisations: usize::from(entry.realisations),
        ri: entry.ri,
        shipped: true,
    })
}

/// Returns whether a sampler is the sampler of that name in this library and has the same
/// parameters. A sampler of the user's own may have the same name.
fn is_usual(of: &dyn Sampler) -> bool {
    sampler(of.name()).is_ok_and(|usual| format!("{:?}", as_reference(usual)) == format!("{of:?}"))
}

/// Returns a hash of the settings with which the shipped curves are made: classes, seed, options,
/// and the default samplers with their parameters.
///
/// A change in the code of a sampler does not change the hash.
fn fingerprint() -> [u8; 32] {
    let (options, samplers) = (PcfOptions::default(), samplers_by_default());
    Sha256::digest(format!("{SIZES:?} {ASPECTS:?} {SEED} {options:?} {samplers:?}")).into()
}

/// Computes the table of shipped curves and returns it in the format of `curves.bin`, for
/// `scripts/make-curves`.
///
/// `progress` is called before each class with the number of classes done and the total number of
/// classes.
///
/// # Errors
/// Fails if a sampler has no curve for a class.
#[doc(hidden)]
pub fn make_table(mut progress: impl FnMut(usize, usize)) -> Result<Vec<u8>, CompareError> {
    let samplers = samplers_by_default();
    let references = References::new(samplers.clone(), PcfOptions::default(), SEED);
    let classes: Vec<(i8, i8)> = SIZES.flat_map(|n| ASPECTS.map(move |aspect| (n, aspect))).collect();
    let mut entries = Vec::new();
    for (done, &(n, aspect)) in classes.iter().enumerate() {
        progress(done, classes.len());
        let class = Class { n: n.into(), shape: Shape::Rectangle { aspect: aspect.into(), torus: false } };
        for (place, curve) in references.make(samplers.clone(), &class).into_iter().enumerate() {
            let curve = curve?;
            let entry = Entry { realisations: curve.realisations as u8, ri: curve.ri, g: curve.pcf.g };
            entries.push((Key { n, aspect, sampler: place as u8 }, entry));
        }
    }
    Ok(codec::write(&entries, &fingerprint()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::l_infinity;
    use crate::geometry::Window;
    use crate::sample::Bnot;

    fn usual() -> References {
        References::new(samplers_by_default(), PcfOptions::default(), SEED)
    }

    #[test]
    fn every_class_of_the_table_is_there_for_every_default_sampler() {
        let missing = "curves.bin is of other options or samplers: scripts/make-curves makes it anew";
        let classes = SIZES.count() * ASPECTS.count();
        assert_eq!(TABLE.len(), classes * samplers_by_default().len(), "{missing}");
    }

    #[test]
    fn shipped_curves_are_those_that_would_be_made_up_to_rounding() {
        for (n, width) in [(20, 1.), (317, 1.5), (1024, 1.), (2900, 0.6)] {
            let window = Window::rectangle(0., 0., width, 1.).unwrap();
            let class = Class::of(n, &window);
            for made in usual().make(samplers_by_default(), &class) {
                let made = made.unwrap();
                let shipped = usual().curves(n, &window);
                let shipped = shipped.curves.iter().find(|c| c.sampler == made.sampler).unwrap();
                assert!(shipped.shipped && !made.shipped, "scripts/make-curves makes the table anew");
                let off = l_infinity(&shipped.pcf, &made.pcf).unwrap();
                assert!(off <= 0.5001 * codec::STEP, "{} at {n}: {off}", made.sampler);
                assert_eq!(
                    (shipped.n, shipped.realisations, shipped.ri),
                    (made.n, made.realisations, made.ri)
                );
                assert_eq!(shipped.pcf.r, made.pcf.r);
            }
        }
    }

    #[test]
    fn what_the_table_is_not_of_is_made() {
        let square = Window::unit_square();
        let shipped =
            |references: References, window: &Window| references.curves(60, window).curves[0].shipped;
        let jittered = || vec![sampler("jittered").unwrap()];
        let options = PcfOptions::default();
        assert!(shipped(References::new(jittered(), options, SEED), &square));
        assert!(!shipped(References::new(jittered(), options, 2), &square));
        let finer = PcfOptions { bins: 100, ..options };
        assert!(!shipped(References::new(jittered(), finer, SEED), &square));
        assert!(!shipped(References::new(jittered(), options, SEED), &Window::unit_torus()));
        let thin = Window::rectangle(0., 0., 5., 1.).unwrap();
        assert!(!shipped(References::new(jittered(), options, SEED), &thin));
        static THREE: Bnot = Bnot { steps: Some(3), ..Bnot::CONVERGED };
        assert!(!shipped(References::new(vec![&THREE], options, SEED), &square));
        assert!(shipped(References::new(vec![&Bnot::PAPER], options, SEED), &square));
    }
}
