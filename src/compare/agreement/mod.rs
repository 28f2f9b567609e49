//! How far two series of values of the same things agree.

mod bland_altman;
mod bootstrap;
mod intraclass;
mod sign_flip;

pub use bland_altman::{Agreement, agreement};
pub use bootstrap::{Interval, RESAMPLES, bootstrap};
pub use intraclass::{Intraclass, intraclass};
pub use sign_flip::sign_flip_test;
