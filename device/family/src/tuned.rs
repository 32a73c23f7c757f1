//! The loops of a family's units as jobs of the device thread tune them, and two families as one.

use crate::messages::{LoopActMessage, LoopRemedyMessage};
use brushwork_link::Failure;
use brushwork_link::Message;
use brushwork_link::Stream;
use brushwork_link::device::JobContext;
use brushwork_link::exchange::ExchangeError;
use brushwork_link::settings::SettingValue;
use brushwork_tuning::axis::{AxisError, EncoderClass};
use brushwork_tuning::joined::{Both, Joined, LawPart, LeadingLaw};
use brushwork_tuning::law::Law;
use brushwork_tuning::law_probe::LawProbe;
use brushwork_tuning::setup::{LoopAxis, Setup};
use brushwork_values::Motor;
use std::marker::PhantomData;
use std::time::Duration;

/// Whose axis a job tunes.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// The motor.
    pub motor: Motor,
    /// What its encoder is, as the user says; `None` for what the controller's settings say.
    pub encoder: Option<EncoderClass>,
    /// The stream that the port is wired to, where that is known: only then can its time-out be set.
    pub stream: Option<Stream>,
}

/// What the job after a run tells its owner.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Restored {
    /// The loop did not hold the motor still and was left without output.
    pub loop_left_off: bool,
}

/// The registers of a law.
pub type Registers<L> = <L as Law>::Registers;

/// A family whose loops can be tuned.
pub trait Tuned: 'static {
    /// Their law.
    type Law: Law;

    /// Whether the unit of a job is of this family.
    fn is_at(context: &JobContext<'_>) -> bool;

    /// The axis over a job's wire; `own_timeout` where the run may change the time-out of the port.
    fn axis<'a>(
        context: &'a mut JobContext<'_>,
        target: Target,
        own_timeout: bool,
    ) -> Box<dyn LoopAxis<Self::Law> + 'a>;

    /// Whether a run changes a setting, if only for a while.
    fn is_tried(motor: Motor, key: &str) -> bool;

    /// Whether a setting tells what an encoder is.
    fn tells_encoder(_key: &str) -> bool {
        false
    }

    /// What a motor's encoder is, as the settings say.
    fn encoder(_settings: &dyn Fn(&str) -> Option<SettingValue>, _motor: Motor) -> Option<EncoderClass> {
        None
    }

    /// Puts back what was held before, but for the registers that are kept, proves it by reading, and leaves a loop off where it is to be.
    ///
    /// # Errors
    /// What could not be put back.
    fn restore(
        context: &mut JobContext<'_>,
        target: Target,
        before: &Setup<Self::Law>,
        kept: &Registers<Self::Law>,
        leaves_off: bool,
    ) -> Result<Restored, Failure>;
}

/// A family that is joined to others.
pub trait OtherTuned: Tuned {
    /// Its law, or none.
    type Part: LawPart<Law = Self::Law>;
}

/// Two families as one.
#[derive(Clone, Copy, Debug)]
pub struct OneOf<A, B>(PhantomData<(A, B)>);

impl<A: Tuned<Law: LeadingLaw + LawProbe>, B: OtherTuned> Tuned for OneOf<A, B> {
    type Law = Both<A::Law, B::Part>;

    fn is_at(context: &JobContext<'_>) -> bool {
        A::is_at(context) || B::is_at(context)
    }

    fn axis<'a>(
        context: &'a mut JobContext<'_>,
        target: Target,
        own_timeout: bool,
    ) -> Box<dyn LoopAxis<Self::Law> + 'a> {
        if B::is_at(context) {
            Box::new(Joined::second(B::axis(context, target, own_timeout)))
        } else {
            Box::new(Joined::first(A::axis(context, target, own_timeout)))
        }
    }

    fn is_tried(motor: Motor, key: &str) -> bool {
        A::is_tried(motor, key) || B::is_tried(motor, key)
    }

    fn tells_encoder(key: &str) -> bool {
        A::tells_encoder(key) || B::tells_encoder(key)
    }

    fn encoder(settings: &dyn Fn(&str) -> Option<SettingValue>, motor: Motor) -> Option<EncoderClass> {
        A::encoder(settings, motor).or_else(|| B::encoder(settings, motor))
    }

    fn restore(
        context: &mut JobContext<'_>,
        target: Target,
        before: &Setup<Self::Law>,
        kept: &Registers<Self::Law>,
        leaves_off: bool,
    ) -> Result<Restored, Failure> {
        if B::is_at(context) {
            B::restore(context, target, &before.with_held(|held| held.second), &kept.second, leaves_off)
        } else {
            A::restore(context, target, &before.with_held(|held| held.first), &kept.first, leaves_off)
        }
    }
}

/// What a failed exchange means to the tuner.
#[must_use]
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn reported(error: &ExchangeError) -> AxisError {
    if error.interruption().is_some() {
        AxisError::Stopped
    } else if error.is_link_lost() {
        AxisError::LinkLost(error.to_string())
    } else {
        match error {
            ExchangeError::TimedOut { .. }
            | ExchangeError::BadCrc { .. }
            | ExchangeError::BadAcknowledgement { .. }
            | ExchangeError::Malformed { .. }
            | ExchangeError::NotUnderstood { .. } => AxisError::NoReply,
            // Whatever the tuner commands is absolute and at once, so that it may come twice.
            ExchangeError::MayHaveRun { cause } => reported(cause),
            other => AxisError::Refused(other.to_string()),
        }
    }
}

/// Calls up to three times, while nothing or nothing useful comes back.
///
/// # Errors
/// That of the last call.
pub fn thrice<T>(mut call: impl FnMut() -> Result<T, AxisError>) -> Result<T, AxisError> {
    for _ in 0..2 {
        match call() {
            Err(AxisError::NoReply | AxisError::Late) => {}
            other => return other,
        }
    }
    call()
}

/// What was tried on the loops of a unit and failed.
#[must_use]
pub fn failed(tried: LoopActMessage, place: &str, error: &AxisError) -> Failure {
    Failure::new(tried, place, Message::error(error.clone()), LoopRemedyMessage::CheckLink)
}

/// An exchange that took so much longer than the quickest of its kind had a retry in it, so that nobody can say when the unit did its work.
const LATE: Duration = Duration::from_millis(35);

/// The quickest exchange of a kind so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct Quickest(Option<Duration>);

impl Quickest {
    /// Takes note of one, and tells whether it took as long as one with a retry.
    pub fn is_vague(&mut self, took: Duration) -> bool {
        let least = self.0.map_or(took, |quickest| quickest.min(took));
        self.0 = Some(least);
        took > least + LATE
    }
}
