//! Output of a batch: the locked result folder, in which files appear only when complete and are
//! listed with their hashes, and the loop over the files of a batch.

mod ending;
mod failures;
mod figures;
mod folder;
mod for_each;
mod ledger;
mod progress;
mod results;

pub use ending::Ending;
pub use failures::Failure;
pub use ledger::Leftovers;
pub use progress::{Progress, Silent};

pub(super) use failures::write_failures;
pub(super) use figures::write_figure;
pub(super) use folder::OutputFolder;
pub(super) use for_each::{Worked, for_each};
pub(super) use ledger::{Standing, hex};
pub(super) use results::ResultFolder;
