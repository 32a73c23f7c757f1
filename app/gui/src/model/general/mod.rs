//! The General Settings screen's state: what is being looked at, compared, calibrated. The settings themselves are those of the
//! unit, which [`GeneralView`] borrows.

mod calibrate;
mod calibration;
mod clamp;
mod compare;
mod list;
mod pins;
mod profile;
mod screen;
mod section;
mod sheet;
mod unfinished;
mod view;

pub use calibrate::Run as CalibrationRun;
pub use calibration::CalibrationStage;
pub use clamp::{ClampTest, Verdict};
pub use compare::{Comparing, Comparison, Side, Take};
pub use profile::{Profiles, Purpose, Reported};
pub use screen::General;
pub use section::{Section, sections};
pub use sheet::Sheet;
pub use view::GeneralView;
