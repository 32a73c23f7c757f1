//! The device thread: it owns a link and everything that may move a motor over it.
//!
//! The window asks ([`Request`]) and is told ([`Event`]); neither ever waits for the other. Between any two exchanges, and
//! while waiting for a reply, the thread looks at the Stop flag first. Motion needs arming, dies unless it is renewed, and
//! is ended on every way out of a job and of the thread itself.

mod channel;
pub mod controller;
mod described;
mod drive;
mod event;
mod family;
mod handle;
mod identity;
mod inquiry;
pub mod job;
mod job_context;
mod options;
mod outbox;
mod poll_rate;
pub mod readings;
mod request;
mod risk;
mod run;
mod signals;
mod status;
mod stop;

pub use channel::{Channel, ChannelDescription, Newest, PinSignal, Reading, Role, Sample};
pub use described::Described;
pub use drive::{ArmScope, Drive, DriveCommand};
pub use event::{DisarmReason, Event};
pub use family::AnyFamily;
pub use handle::{DeviceHandle, Kept, Stopper};
pub use identity::{Capabilities, Facts, Identity, UnitFacts};
pub use inquiry::{Heard, Inquiry, Leave};
pub use job::{Job, JobContext, JobEnding, JobHost, JobId, JobReport, JobTicket, QueuedJob};
pub use options::{AddressSet, Addresses, DeviceOptions};
pub use poll_rate::PollRate;
pub use readings::{NoReadings, Power, Readings};
pub use request::{Request, RequestRefused};
pub use risk::RiskAccepted;
pub use run::{DeviceLoop, DeviceThread, Step};
pub use signals::{Guard, MOTION_LIFE, OutsideAnswer};
pub use status::{Indicator, PlaceState, StatusPlace, StatusReport, status_row};
pub use stop::{StopBytes, StopReport, UnitStop};
