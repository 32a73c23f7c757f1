//! What every family of controllers shares between a port and a typed controller: transports, requests with deadlines, the device thread, and the
//! settings engine. It knows no family: each is an object behind [`driver::Driver`].
//!
//! Units stand in names; times are durations since the epoch of the [`Clock`] in use. There is no window here
//! and no simulator. See `ARCHITECTURE.md`.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

pub mod bounded;
pub mod capability;
pub mod clock;
pub mod device;
pub mod driver;
pub mod exchange;
pub mod failure;
pub mod family;
pub mod files;
pub mod guardian;
pub mod loader;
pub mod loan;
pub mod messages;
pub mod settings;
pub mod transport;
pub mod unit;
pub mod wire;
pub mod work;

pub use brushwork_values::Message;
pub use clock::{Clock, SystemClock, VirtualClock};
pub use device::{
    Addresses, ArmScope, Channel, DeviceHandle, Drive, DriveCommand, Event, Identity, Job, JobEnding,
    JobTicket, PollRate, QueuedJob, Request, Sample, StatusReport,
};
pub use driver::{Driver, install, register};
pub use exchange::{ExchangeError, Interruption, LinkStatistics};
pub use failure::Failure;
pub use family::{FamilyChoice, FamilyRef, families};
pub use settings::{
    Keeper, Profile, ReadReport, SettingValue, SettingsImage, SettingsTable, Subject, WriteOptions,
};
pub use transport::{ConnectTarget, PortInfo, Stream, Transport, TransportError};
pub use unit::{FirmwareGeneration, UnitAddress};
pub use wire::{HiddenSettings, Wire};
