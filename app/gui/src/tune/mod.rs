//! Tuning in the window: a guided run for each loop of each motor, what its gains would do, and calibration by hand.
//!
//! State and screens stand together here; `brushwork_core::tune` has the jobs, `brushwork_tuning` the method.

pub mod asked;
pub mod by_hand;
pub mod calibration;
pub mod chart;
mod figures;
pub mod files;
pub mod guide;
mod held;
mod level;
mod limits;
pub mod looked_at;
pub mod measured;
pub mod messages;
pub mod model;
pub mod observe;
mod pace;
pub mod plots;
pub mod refusal;
pub mod registers;
pub mod remaining;
pub mod result;
pub mod run;
mod runs;
pub mod setup;
pub mod sketches;
mod stood;
pub mod which;
mod winding;

pub use model::{TuneAction, Tuning};
pub use which::Loop;

pub use asked::Asked;
pub use brushwork_core::tune::sequence::{Next, Origin, Sequence, Work};
pub use figures::{FIGURES, figure_ui, likely};
pub use looked_at::View;
pub use measured::Figures;
pub use run::Run;
