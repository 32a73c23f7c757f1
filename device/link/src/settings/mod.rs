//! The settings of a controller: one table, and everything that reads it.
//!
//! [`SettingsTable`] says for one controller which settings there are, in which unit and range, which command
//! carries each and what it means; nothing else repeats a range. [`SettingsImage`] holds values; [`Copies`]
//! tells RAM, EEPROM and profile apart. Motion, status and the script are not settings.

mod check;
mod copies;
mod copy;
mod difference;
mod image;
mod keep;
mod kind;
mod listing;
mod mcp;
mod memory;
mod motion_mind;
mod notation;
mod pins;
mod plan;
mod profile;
mod read;
mod reference;
mod row;
mod save_report;
mod step;
mod subject;
mod table;
mod template;
mod value;
mod write;

pub use check::{BRIDGE_WARNING, SHORTEST_AUTORUN_MS};
pub use copies::{Copies, Copy};
pub use copy::{CopiedMotor, copy_motor};
pub use difference::{Difference, changes, diff};
pub use image::SettingsImage;
pub use keep::{
    Act, Aftermath, Ending, Entry, Held, Journal, JournalError, Keeper, Known, begin_command, begin_trial,
    defaults_kept, end_act, reload_kept, save_kept, write_kept, write_kept_knowing,
};
pub use kind::{Coding, Kind};
pub use listing::{ListedSetting, list, list_text};
pub use memory::{DefaultsReport, reload, restore_defaults, save_eeprom};
pub use pins::{
    Behind, Calibrated, Calibration, CalibrationStage, Conflict, ConflictKind, PinMode, SignalShape,
    change_mode, conflicts, function_text, modes, open_range,
};
pub use plan::{Plan, WriteOptions, plan};
pub use profile::{
    FORMAT, Fitted, OpenedProfile, Problem, Profile, ProfileChanges, ProfileError, ProfileFileError, SCHEMA,
    Strictness, replace_file,
};
pub use read::{ReadFailure, ReadReport, read_all, read_some};
pub use reference::{ReferenceForm, ReferenceRow, reference, reference_text};
pub use row::{Access, Bits, Bound, Carrier, Group, Instance, Place, Range, Row, Sink, Source};
pub use save_report::{SaveReport, SaveVerdict};
pub use step::{Refusal, Stage, Step};
pub use subject::Subject;
pub use table::SettingsTable;
pub use value::SettingValue;
pub use write::{RowOutcome, RowState, WriteError, WriteReport, write};

#[cfg(test)]
mod tests;
