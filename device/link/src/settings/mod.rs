//! The settings of a controller: one table, and everything that reads it.
//!
//! [`SettingsTable`] says for one controller which settings there are, in which unit and range, which command
//! carries each and what it means; nothing else repeats a range. [`SettingsImage`] holds values; [`Copies`]
//! tells RAM, EEPROM and profile apart. Motion, status and the script are not settings.

mod copies;
mod copy;
mod difference;
mod family;
mod image;
mod keep;
mod kind;
mod listing;
mod memory;
mod notation;
mod plan;
mod profile;
mod read;
mod row;
mod save_report;
mod step;
mod subject;
mod table;
mod value;
mod write;
mod write_report;

pub use copies::{Copies, Copy};
pub use copy::{CopiedMotor, copy_motor};
pub use difference::{Difference, changes, diff};
pub use family::{Argument, Conversion, FamilySettings, Fit, Lists, PlanContext, Planned};
pub use image::SettingsImage;
pub use keep::{
    Act, Aftermath, Ending, Entry, Held, Journal, JournalError, Keeper, Known, begin_command, begin_trial,
    defaults_kept, end_act, reload_kept, save_kept, write_kept, write_kept_knowing, write_watched,
};
pub use kind::{Coding, Kind};
pub use listing::{ListedSetting, list, list_text};
pub use memory::{DefaultsReport, answers, await_unit, reload, restore_defaults, save_eeprom};
pub use plan::{Plan, plan};
pub use profile::{
    FORMAT, Fitted, OpenedProfile, Problem, Profile, ProfileChanges, ProfileError, ProfileFileError, SCHEMA,
    Strictness,
};
pub use read::{ReadFailure, ReadReport, is_final, is_there, read_all, read_some, went_out};
pub use row::{Access, Bits, Bound, Carrier, Group, Instance, Place, Range, Row, Sink, Source};
pub use save_report::{SaveReport, SaveVerdict, stored, unknown};
pub use step::{Refusal, Stage, Step, WriteOptions};
pub use subject::Subject;
pub use table::SettingsTable;
pub use value::{SettingValue, Signed};
pub use write::{WriteError, write};
pub use write_report::{RowOutcome, RowState, WriteReport};
