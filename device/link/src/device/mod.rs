//! The device thread: it owns a link and everything that may move a motor over it.
//!
//! The window asks ([`Request`]) and is told ([`Event`]); neither ever waits for the other. Between any two exchanges, and
//! while waiting for a reply, the thread looks at the Stop flag first. Motion needs arming, dies unless it is renewed, and
//! is ended on every way out of a job and of the thread itself.

pub mod can;
mod channel;
pub mod controller;
mod described;
mod drive;
mod event;
mod family;
mod family_choice;
mod handle;
mod identity;
pub mod job;
mod job_context;
mod mcp;
pub mod motion_mind;
mod options;
mod outbox;
mod poll_rate;
mod request;
mod run;
mod signals;
mod status;
mod stop;

pub use brushwork_mcp_wire::packet_serial::status::{Condition, Conditions, Lamp, Severity};
pub use channel::{Channel, PinSignal, Sample};
pub use described::Described;
pub use drive::{ArmScope, Drive, DriveCommand};
pub use event::{DisarmReason, Event};
pub use family::AnyFamily;
pub use family_choice::FamilyChoice;
pub use handle::{DeviceHandle, Stopper};
pub use identity::{Capabilities, Identity};
pub use job::{Job, JobContext, JobEnding, JobId, JobReport, JobTicket, QueuedJob};
pub use mcp::{PacketSerial, describe_sent, preview};
pub use motion_mind::{MotionMindFacts, SIGNS as MOTION_MIND_SIGNS};
pub use options::{AddressSet, Addresses, DeviceOptions};
pub use poll_rate::PollRate;
pub use request::{Request, RequestRefused};
pub use run::{DeviceLoop, DeviceThread, Step};
pub use signals::MOTION_LIFE;
pub use status::{Sign, StatusReport};
pub use stop::{StopBytes, StopReport, UnitStop};
