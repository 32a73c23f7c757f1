//! What the device thread tells: one closed list.

use super::channel::Sample;
use super::drive::{ArmScope, Drive};
use super::identity::Identity;
use super::job::{JobId, JobReport};
use super::status::StatusReport;
use super::stop::StopReport;
use crate::capability::CapabilityMap;
use crate::exchange::{LinkStatistics, Traffic};
use crate::failure::Failure;
use crate::transport::Stream;
use brushwork_values::{Message, Values};
use std::fmt;
use std::time::Duration;

/// Something that happened on a link.
#[derive(Debug)]
pub enum Event {
    /// A unit answered and was identified. One for each unit of the link, then [`Event::Selected`].
    Connected(Identity),
    /// A unit has been given another address: it is no longer at the old one, and [`Event::Connected`] follows with the new one.
    Moved {
        /// The old address.
        from: u8,
    },
    /// Units are looked for, which takes a while: so many of so many places are done.
    Searching {
        /// Places that were asked.
        done: usize,
        /// Places in all.
        of: usize,
        /// What is asked now.
        what: String,
    },
    /// The unit that requests speak of from now on.
    Selected {
        /// Its address.
        address: u8,
        /// Which of its streams the port is, where that is known; else the user must be asked before arming.
        stream: Option<Stream>,
    },
    /// One sweep's readings, or, with another address than the selected one, a reading of another unit of the bus, which has no number. When nobody takes events, the oldest waiting samples go first and are counted in
    /// [`LinkStatistics::dropped_samples`].
    Sample(Box<Sample>),
    /// The status word: when it changed, and once a second.
    Status(StatusReport),
    /// Motors may be moved.
    Armed {
        /// The unit.
        address: u8,
        /// What was armed.
        scope: ArmScope,
        /// After how much silence the controller stops the motors by itself.
        controller_timeout: Option<Duration>,
        /// What else can drive a motor: input pins and scripts, each as a sentence.
        warnings: Vec<Message>,
    },
    /// A motion command was confirmed by the controller.
    Driven {
        /// The unit.
        address: u8,
        /// When its first byte was on the way.
        sent_at: Duration,
        /// What the motors were told.
        drive: Drive,
    },
    /// Motors may no longer be moved; they are being stopped.
    Disarmed(DisarmReason),
    /// Arming was refused: every reason, each with its cure.
    ArmRefused {
        /// What was asked.
        scope: ArmScope,
        /// At least one.
        reasons: Vec<Failure>,
    },
    /// A stop was carried out, and this is what became of it.
    Stopped(StopReport),
    /// The answer to [`Request::Transact`](super::Request::Transact).
    Transacted {
        /// The request's.
        id: u64,
        /// The values, or why there are none.
        result: Result<Values, Failure>,
    },
    /// The answer to [`Request::Raw`](super::Request::Raw): what came back, nothing where the unit is silent, or why it was not sent.
    RawReply {
        /// The request's.
        id: u64,
        /// The bytes.
        result: Result<Vec<u8>, Failure>,
    },
    /// The program in a unit's memory was started; who answers now was told before.
    ProgramStarted {
        /// The unit's address.
        address: u8,
    },
    /// The unit is in its firmware loader, or on its way there. The link ends with this.
    LoaderEntered,
    /// A job began.
    JobStarted {
        /// Which.
        id: JobId,
        /// Its name, for people.
        name: Message,
    },
    /// A job tells how far it is.
    JobProgress {
        /// Which.
        id: JobId,
        /// 0 to 1, where the job can tell.
        fraction: Option<f32>,
        /// What it does at the moment.
        text: String,
    },
    /// A job ended.
    JobEnded(JobReport),
    /// What a unit's firmware is known to answer: at first, and when more was learned.
    Capabilities {
        /// The unit.
        address: u8,
        /// Its commands.
        map: CapabilityMap,
    },
    /// The link's figures, twice a second.
    Link(LinkStatistics),
    /// What went over the wire, while that was asked for.
    Traffic {
        /// The bytes.
        traffic: Traffic,
        /// What they mean.
        text: String,
        /// Whether they are a request, or the whole and undamaged reply to the last one.
        sound: bool,
    },
    /// Something did not work; the link goes on.
    Failure(Failure),
    /// The link is gone. Nothing follows; only the user connects again.
    Lost(Failure),
    /// The link was closed as asked. Nothing follows.
    Closed,
}

/// Why motors may no longer be moved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DisarmReason {
    /// It was asked for.
    Asked,
    /// Stop was pressed.
    Stop,
    /// Another program has asked for a stop.
    StopFromOutside,
    /// Nobody renewed the motion in time.
    DeadMan,
    /// The controller reports faults, the titles of their indicators.
    Fault(Vec<&'static str>),
    /// Another screen was armed.
    ScopeChange,
    /// Another unit was selected.
    Selection,
    /// A setting that arming was based on was changed.
    SettingsChanged,
    /// The controller has started anew, so that it may have forgotten what arming was based on.
    Restarted,
    /// A command went unconfirmed, so that nobody knows what the motors do.
    NoAnswer,
    /// One of several units that move together did not take a command that others have taken.
    NotTogether,
    /// The job that moved the motors ended.
    JobEnded,
    /// The link was lost.
    LinkLost,
    /// The link is being closed.
    Closing,
}

impl Event {
    /// The one unit that it is of, where it is of one.
    #[must_use]
    pub fn address(&self) -> Option<u8> {
        match self {
            Self::Sample(sample) => Some(sample.address),
            Self::Status(status) => Some(status.address),
            Self::Connected(identity) => Some(identity.address),
            Self::Selected { address, .. }
            | Self::Armed { address, .. }
            | Self::Driven { address, .. }
            | Self::ProgramStarted { address }
            | Self::Capabilities { address, .. } => Some(*address),
            Self::Moved { .. }
            | Self::Searching { .. }
            | Self::Disarmed(_)
            | Self::ArmRefused { .. }
            | Self::Stopped(_)
            | Self::Transacted { .. }
            | Self::RawReply { .. }
            | Self::LoaderEntered
            | Self::JobStarted { .. }
            | Self::JobProgress { .. }
            | Self::JobEnded(_)
            | Self::Link(_)
            | Self::Traffic { .. }
            | Self::Failure(_)
            | Self::Lost(_)
            | Self::Closed => None,
        }
    }

    /// The job that it is about.
    #[must_use]
    pub fn job(&self) -> Option<JobId> {
        match self {
            Self::JobStarted { id, .. } | Self::JobProgress { id, .. } => Some(*id),
            Self::JobEnded(report) => Some(report.id),
            Self::Connected(_)
            | Self::Moved { .. }
            | Self::Searching { .. }
            | Self::Selected { .. }
            | Self::Sample(_)
            | Self::Status(_)
            | Self::Armed { .. }
            | Self::Driven { .. }
            | Self::Disarmed(_)
            | Self::ArmRefused { .. }
            | Self::Stopped(_)
            | Self::Transacted { .. }
            | Self::RawReply { .. }
            | Self::ProgramStarted { .. }
            | Self::LoaderEntered
            | Self::Capabilities { .. }
            | Self::Link(_)
            | Self::Traffic { .. }
            | Self::Failure(_)
            | Self::Lost(_)
            | Self::Closed => None,
        }
    }
}

impl DisarmReason {
    /// What went wrong, as a clause; `None` where somebody disarmed or something else was to be done.
    #[must_use]
    pub fn trouble(&self) -> Option<String> {
        let clause = match self {
            Self::DeadMan => {
                "this computer answered late: the program did not renew the motion within 250 ms"
            }
            Self::Fault(faults) => return Some(format!("the controller reports {}", faults.join(", "))),
            Self::Restarted => "the controller has restarted",
            Self::NoAnswer => {
                "no answer came in time: check the controller's power, its cable and the line, and whether this computer is too busy"
            }
            Self::NotTogether => "one of the controllers that move together did not take the command",
            Self::Asked
            | Self::Stop
            | Self::StopFromOutside
            | Self::ScopeChange
            | Self::Selection
            | Self::SettingsChanged
            | Self::JobEnded
            | Self::LinkLost
            | Self::Closing => return None,
        };
        Some(clause.to_owned())
    }
}

impl fmt::Display for DisarmReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(trouble) = self.trouble() {
            return write!(f, "Disarmed: {trouble}");
        }
        f.write_str(match self {
            Self::Stop => "Disarmed: Stop was pressed",
            Self::StopFromOutside => "Stopped by `brushwork stop`, from another program",
            Self::ScopeChange => "Disarmed: another screen was opened",
            Self::Selection => "Disarmed: another unit was selected",
            Self::SettingsChanged => "Disarmed: a time-out, stream, priority or address was changed",
            Self::JobEnded => "Disarmed: the job that moved the motors has ended",
            Self::LinkLost => "Disarmed: the link was lost",
            Self::Closing => "Disarmed: the link is being closed",
            Self::Asked
            | Self::DeadMan
            | Self::Fault(_)
            | Self::Restarted
            | Self::NoAnswer
            | Self::NotTogether => "Disarmed",
        })
    }
}
