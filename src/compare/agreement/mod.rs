//! Agreement between two series of measurements of the same items: limits of agreement, intraclass
//! correlation, bootstrap intervals and permutation tests.

mod bland_altman;
mod bootstrap;
mod clustered;
mod clusters;
mod intraclass;
mod sign_flip;
mod subjects;

pub use bland_altman::{Agreement, agreement};
pub use bootstrap::{Interval, RESAMPLES, bootstrap};
pub use clustered::{ClusteredAgreement, agreement_of_clusters};
pub use clusters::clusters;
pub use intraclass::{Intraclass, intraclass};
pub use sign_flip::{least_p, sign_flip_test};
pub use subjects::{SubjectMean, mean_over_subjects};
