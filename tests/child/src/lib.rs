//! The programs that tests start: each has an owner that ends it, and no wait for one is without a limit.
//!
//! A crate of its own because the tests of `app` need it too and cannot use `brushwork-tests`, which is above them.

mod ahead;
mod owned;
mod program;

pub use ahead::ahead;
pub use owned::Child;
pub use program::{Ending, Program};
