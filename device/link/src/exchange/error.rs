//! Why an exchange with a controller gave no result. The link's own failures and the controller's refusals stay apart.

use super::watch::Interruption;
use crate::failure::Failure;
use crate::messages::RemedyMessage;
use crate::transport::TransportError;
use crate::unit::FirmwareGeneration;
use brushwork_values::{Message, Words, error_key};
use std::borrow::Cow;
use std::fmt;
use std::time::Duration;

/// Why a request has no reply that could be used.
#[derive(Clone, Debug, thiserror::Error)]
pub enum ExchangeError {
    /// No complete reply came in time.
    #[error("no answer within {} ms ({tries}){}", waited.as_millis(), Heard(*heard))]
    TimedOut {
        /// How long the last try waited.
        waited: Duration,
        /// Requests sent.
        tries: Tries,
        /// Bytes that did come in the last try.
        heard: usize,
    },
    /// The reply's checksum was wrong.
    #[error("the checksum of the reply was {got:04X} instead of {expected:04X} ({tries})")]
    BadCrc {
        /// CRC of what was received.
        expected: u16,
        /// CRC that was received.
        got: u16,
        /// Requests sent.
        tries: Tries,
    },
    /// Something else than 0xFF came where an acknowledgement was due.
    #[error("0x{got:02X} came back instead of the acknowledgement 0xFF ({tries})")]
    BadAcknowledgement {
        /// The byte received.
        got: u8,
        /// Requests sent.
        tries: Tries,
    },
    /// The reply has a form that this command does not have.
    #[error("the reply makes no sense: {what} ({tries})")]
    Malformed {
        /// What is wrong with it.
        what: String,
        /// Requests sent.
        tries: Tries,
    },
    /// The unit says that it does not know what it was asked.
    #[error("{what} ({tries})")]
    NotUnderstood {
        /// What it said, and to what.
        what: String,
        /// Requests sent.
        tries: Tries,
    },
    /// The request was sent once, was not confirmed, and must not be sent twice.
    #[error(
        "{cause}; the command may have been carried out, and was not sent again since that could do it twice"
    )]
    MayHaveRun {
        /// What went wrong.
        #[source]
        cause: Box<ExchangeError>,
    },
    /// Something more urgent came first.
    #[error("{cause}")]
    Interrupted {
        /// What it was.
        cause: Interruption,
    },
    /// The request can move a motor and nothing is armed that allows it.
    #[error("the motors are not armed for \"{command}\"")]
    NotArmed {
        /// The command's title.
        command: String,
    },
    /// The layout of the command is a guess, and guesses are sent to simulated controllers only.
    #[error("\"{command}\" is not sent to a real controller: {why}")]
    Unproven {
        /// The command's title.
        command: String,
        /// What is not known.
        why: String,
    },
    /// This firmware does not have the command.
    #[error("firmware of {generation} has no command {command}")]
    Unsupported {
        /// The command's number or title.
        command: String,
        /// The generation that was detected.
        generation: FirmwareGeneration,
    },
    /// The unit is known to lack the command, so that it was not asked.
    #[error("this firmware does not have it: it never answers \"{command}\", while it answers others")]
    Absent {
        /// The command's title.
        command: String,
    },
    /// The unit has it and reports it by no command.
    #[error("{what}")]
    Untold {
        /// What is known of it, as a clause.
        what: Message,
    },
    /// The controller understood and refused.
    #[error("the controller refused: {what}")]
    Refused {
        /// What it said.
        what: String,
        /// Whether it lacks what was asked for.
        is_absent: bool,
    },
    /// The controller cannot do what was asked.
    #[error("{what}")]
    Impossible {
        /// Why, as a clause: "it has one motor".
        what: Message,
    },
    /// The values do not fit the command.
    #[error("the values do not fit the command")]
    Encode {
        /// Which value and why.
        why: String,
    },
    /// The link is lost.
    #[error("the link is lost")]
    Transport {
        /// What the port said.
        #[from]
        source: TransportError,
    },
}

impl ExchangeError {
    /// Whether the link itself is gone, so that nothing more can be asked.
    #[must_use]
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn is_link_lost(&self) -> bool {
        match self {
            Self::Transport { .. } => true,
            Self::MayHaveRun { cause } => cause.is_link_lost(),
            _ => false,
        }
    }

    /// Whether the controller was asked and did not answer in time.
    #[must_use]
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn is_no_answer(&self) -> bool {
        match self {
            Self::TimedOut { .. } => true,
            Self::MayHaveRun { cause } => cause.is_no_answer(),
            _ => false,
        }
    }

    /// Whether the controller was asked and answered nothing or nothing that fits, as a unit does that lacks the command.
    #[must_use]
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn is_unusable_answer(&self) -> bool {
        match self {
            Self::TimedOut { .. }
            | Self::BadCrc { .. }
            | Self::BadAcknowledgement { .. }
            | Self::Malformed { .. }
            | Self::NotUnderstood { .. }
            | Self::Absent { .. }
            | Self::Untold { .. } => true,
            Self::Refused { is_absent, .. } => *is_absent,
            Self::MayHaveRun { cause } => cause.is_unusable_answer(),
            _ => false,
        }
    }

    /// The byte that came in place of an acknowledgement.
    #[must_use]
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn answered(&self) -> Option<u8> {
        match self {
            Self::BadAcknowledgement { got, .. } => Some(*got),
            Self::MayHaveRun { cause } => cause.answered(),
            _ => None,
        }
    }

    /// What came first, if the exchange was cut short.
    #[must_use]
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn interruption(&self) -> Option<Interruption> {
        match self {
            Self::Interrupted { cause } => Some(*cause),
            Self::MayHaveRun { cause } => cause.interruption(),
            _ => None,
        }
    }

    /// The error with its causes in one line.
    #[must_use]
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn full(&self) -> String {
        match self {
            Self::Transport { source } => format!("{self}: {}", source.full()),
            Self::Encode { why } => format!("{self}: {why}"),
            Self::MayHaveRun { cause } if cause.is_link_lost() => format!("{}; {MAY_HAVE_RUN}", cause.full()),
            _ => self.to_string(),
        }
    }

    /// What the user can do about it.
    #[must_use]
    pub fn remedy(&self) -> RemedyMessage {
        match self {
            Self::TimedOut { heard: 0, .. } => RemedyMessage::CheckWiring,
            Self::TimedOut { .. }
            | Self::BadCrc { .. }
            | Self::BadAcknowledgement { .. }
            | Self::Malformed { .. }
            | Self::NotUnderstood { .. } => RemedyMessage::CheckLine,
            Self::MayHaveRun { .. } => RemedyMessage::LookAtMotor,
            Self::Interrupted { .. } => RemedyMessage::TryWhenReady,
            Self::NotArmed { .. } => RemedyMessage::ArmFirst,
            Self::Unproven { .. } => RemedyMessage::TrySimulated,
            Self::Unsupported { .. } | Self::Absent { .. } => RemedyMessage::DoWithout,
            Self::Untold { .. } => RemedyMessage::WriteToKnow,
            Self::Refused { .. } => RemedyMessage::CheckValue,
            Self::Impossible { .. } => RemedyMessage::AskOtherwise,
            Self::Encode { .. } => RemedyMessage::StayInRange,
            Self::Transport { .. } => RemedyMessage::CheckCable,
        }
    }

    /// What the controller cannot do, and why.
    pub fn impossible(what: impl Into<Message>) -> Self {
        Self::Impossible { what: what.into() }
    }

    /// The failure for the user, with what was tried and on what.
    #[must_use]
    pub fn failure(&self, tried: impl Into<Message>, on: impl Into<String>) -> Failure {
        Failure::new(tried, on, self.message(), self.remedy())
    }

    /// The error with its causes as a message.
    #[must_use]
    pub fn message(&self) -> Message {
        WithCauses(self.clone()).into()
    }
}

#[derive(Debug)]
struct WithCauses(ExchangeError);

impl fmt::Display for WithCauses {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.full())
    }
}

impl Words for WithCauses {
    fn key(&self) -> Cow<'static, str> {
        error_key(&self.0).into()
    }
}

const MAY_HAVE_RUN: &str = "the command may have been carried out";

/// How often a request was sent; prints as "1 try" or "3 tries".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tries(pub u32);

impl fmt::Display for Tries {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.0, if self.0 == 1 { "try" } else { "tries" })
    }
}

/// What is said about bytes that were not enough for a reply.
struct Heard(usize);

impl fmt::Display for Heard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            0 => Ok(()),
            1 => f.write_str(", only one byte came"),
            count => write!(f, ", only {count} bytes came"),
        }
    }
}
