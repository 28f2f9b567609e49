//! Arguments that several commands share; each group is turned into options of the library.

mod common;
mod coordinates;
mod detect;
mod maps;
mod pcf;
mod plan;
mod progress;
mod rois;
mod scale;
mod summary;
mod target;

pub use common::Common;
pub use coordinates::CoordinateArgs;
pub use detect::{DetectArgs, MODELS};
pub use plan::{Defaults, PlanArgs};
pub use scale::ScaleArgs;
pub use target::{TargetArgs, fit_in_words, write_fit};
