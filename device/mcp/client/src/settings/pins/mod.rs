//! Input pins: their modes, what they are wired to do, and what contradicts what.
//! Everything here is a pure function of settings; reading and writing them is the business of its neighbours.

mod conflicts;
mod function;
mod mode;
mod shape;
mod values;

pub use conflicts::{Conflict, ConflictKind, conflicts};
pub use function::function_text;
pub use mode::{PinMode, change_mode, modes, open_range};
pub use shape::{Behind, SignalShape};
pub(super) use values::{Lookup, choice};
