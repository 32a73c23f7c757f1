//! Why a run ended without a result, or what its result must be taken with.

use serde::{Deserialize, Serialize};
use std::borrow::Cow;

/// Who let an answer come late.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Whose {
    /// This computer: it came late to ask, or to read what was there.
    #[default]
    Computer,
    /// The line, or the controller behind it: it was asked in time.
    Line,
}

impl Whose {
    #[allow(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
    fn is_computer(&self) -> bool {
        *self == Self::Computer
    }
}

macro_rules! causes {
    ($($(#[$what:meta])* $cause:ident $sentence:literal;)*) => {
        /// What ended a run, or what its reader must know.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        #[non_exhaustive]
        pub enum Cause {
            $($(#[$what])* $cause,)*
            /// What was seen says nothing about the machine, since the answers came too late.
            AnsweredLate {
                /// The longest time between two answers, ms.
                longest_gap_ms: u32,
                /// When in the run it ended, ms.
                #[serde(default)]
                at_ms: u32,
                /// Who was late.
                #[serde(default, skip_serializing_if = "Whose::is_computer")]
                whose: Whose,
            },
            /// Figures were taken although answers came late.
            TakenLate {
                /// The longest time between two answers, ms.
                longest_gap_ms: u32,
                /// When in the run it ended, ms.
                at_ms: u32,
                /// Who was late.
                #[serde(default, skip_serializing_if = "Whose::is_computer")]
                whose: Whose,
            },
            /// A reading takes so long that a motor could not be switched off in time after a lost one.
            LineTooSlow {
                /// The shortest time from one reading to the next, ms.
                reading_ms: u32,
            },
        }

        impl Cause {
            /// One sentence or two: what was seen and what to do.
            #[must_use]
            pub fn sentence(self) -> Cow<'static, str> {
                match self {
                    $(Self::$cause => $sentence.into(),)*
                    Self::AnsweredLate { longest_gap_ms, at_ms, whose } => {
                        answered_late(longest_gap_ms, at_ms, whose).into()
                    }
                    Self::TakenLate { longest_gap_ms, at_ms, whose } => taken_late(longest_gap_ms, at_ms, whose).into(),
                    Self::LineTooSlow { reading_ms } => line_too_slow(reading_ms).into(),
                }
            }
        }
    };
}

causes! {
    /// Counts go down while duty goes up.
    EncoderReversed "The encoder counts down while the motor is driven up. Swap the encoder's A and B, or the motor leads, or set \
        the encoder's reverse option.";
    /// The motor draws a running current, but nothing is counted.
    EncoderDead "The motor draws the current of a turning motor, but the encoder counts nothing. Check the encoder's plug, supply \
        and input.";
    /// No current flows, nothing moves.
    MotorOpen "No current flows and nothing moves. Check the motor leads and the bridge; if this controller measures no currents, \
        the shaft and the encoder too.";
    /// Nothing moves, and the controller reports no current.
    NothingCounted "Nothing was counted while the motor was driven, and the controller reports no current that would say why. Check \
        the encoder, the motor leads and whether the shaft is free.";
    /// Current as of a motor that stands, nothing moves.
    ShaftLocked "The motor draws the current of a standing motor and nothing is counted. Free the shaft, or release its brake.";
    /// Counts stopped in mid-run while the motor went on.
    EncoderLost "The encoder stopped counting while the motor went on. Check its plug and cable.";
    /// The motor stopped in mid-run with its current high.
    Stalled "The motor was stopped by something: an end stop or a jam. Look there, then set the travel.";
    /// The current stopped in mid-run.
    MotorOpened "The motor current stopped in mid-run. Check the motor leads.";
    /// Counts turned their sign in mid-run.
    EncoderFlipped "The encoder changed its direction in mid-run. Check its wiring for a loose lead.";
    /// The travel window would have been left.
    TravelLimit "The axis came to the end of its travel window. Start nearer to the middle, or widen the window.";
    /// The main battery is low.
    BatteryLow "The main battery is low. Charge it, or use a stronger supply.";
    /// The controller reports a fault.
    ControllerFault "The controller reports a fault. Read its status, clear it, and try again.";
    /// The current went beyond the highest that the run was allowed.
    OverCurrent "The current went beyond the highest that was allowed. Allow more, or lower the highest duty.";
    /// The counts began at 0 again.
    WasReset "The controller was reset in mid-run: its counts began at 0 again, and its gains and time-out are those of its EEPROM. Look at the \
        supply and its plugs, then try again.";
    /// No replies.
    LinkLost "The controller stopped answering. Check the cable; the controller stops the motor by itself, by its time-out or at the \
        limits of the run.";
    /// The user, the window or the device thread stopped it.
    Stopped "The run was stopped.";
    /// The run took too long.
    TimeLimit "The run took longer than it may. A very slow axis needs a higher time limit.";
    /// The controller did not take the current limit of the run.
    LimitNotTaken "The controller did not take the current limit of the run, so the motor was not driven. Leave the limit out, or \
        set it in the settings.";
    /// The axis does not stand inside its travel window.
    OutsideTravel "The axis stands outside its travel window. Move it inside, or give a window around where it stands.";
    /// The travel window is too narrow for the encoder, or the axis stands too near to its end.
    NarrowTravel "The axis stands too near to an end of its travel window, or the window is too narrow. Move it to the middle, or \
        widen the window.";
    /// The controller does not take a command of the run.
    Refused "The controller did not take a command. See the log for which.";
    /// Inductance and resistance are set, so that duty is a current.
    TorqueMode "Motor inductance and resistance are both set, which turns duty into current. Have them cleared for the run; they are \
        put back after it.";
    /// An absolute encoder that wraps gives no speed.
    WrappingEncoder "An absolute encoder that wraps has no speed that a loop could use. Tune the position instead.";
    /// The encoder is too coarse, or the axis too slow, for the polls.
    TooCoarse "The encoder gives too few counts for this axis. A finer one is needed.";
    /// The longest moves that the controller takes tell too little.
    MovesTooShort "The longest move that this controller takes at once (its following error, SM) is over too soon to measure the motor: the encoder \
        is too fine for it. A coarser encoder, or one behind the gear, makes the moves longer.";
    /// The model does not explain the record.
    PoorFit "The motion does not follow the model of a motor. Look for slipping parts, a loose encoder or noise.";
    /// The two directions differ by more than a quarter.
    Lopsided "The two directions differ by more than a quarter. Look for a load that pulls, or a jam.";
    /// More than half of the record is held by the current limit.
    CurrentLimited "The current limit held the motor back for most of the run. Raise it, or lower the load.";
    /// The verification found the loop worse than predicted, at the lowest gains too.
    NotVerified "The loop was worse than predicted, at low gains too. The old gains are back in force.";
    /// The lag of the loop could not be measured; the gains assume the usual one.
    LagUnknown "The lag of the controller's loop could not be measured; the gains assume the usual one.";
    /// What was measured does not show that the loop keeps the margin that it should.
    MarginUnsure "What was measured does not show that the loop keeps its margin: its maximum sensitivity may be above 1.8. Try it under load; \
        a softer level keeps more distance.";
    /// The gains were lowered since the measured loop was rougher than predicted.
    BackedOff "The gains were lowered, since the measured loop was rougher than predicted.";
    /// The two directions differ by more than 5 %.
    Asymmetric "The two directions differ by more than 5 %.";
    /// A constant load is stronger than the friction: the axis does not stay where it is without drive.
    HeavyLoad "A constant load, a weight or a spring, pulls harder than friction holds: without drive the axis moves. Balance it, or \
        tune the position as PIV, whose integral carries the load.";
    /// The controller's loop follows no law that is known.
    UnknownLaw "The law of the controller's loop could not be measured, so gains cannot be computed for it.";
    /// A position loop alone drives nothing.
    NoDirectLoop "This controller adds nothing of the speed setpoint to the duty, so a position loop without a velocity loop under it gives no duty. Tune the \
        position as PIV, which has one.";
    /// Nothing said what law the loop follows.
    LawAssumed "No duty was read under a speed command, so the law of the controller's loop could not be measured; the gains assume the usual one.";
    /// Nothing said what the derivative of a position multiplies.
    DerivativeUnknown "What D of the position loop multiplies could not be measured; the gains assume that it is counted as I is.";
    /// Nothing said how often the controller's loop computes.
    RateUnknown "How often in a second the controller's loop computes could not be measured; the gains assume the usual rate.";
    /// The controller is not in the mode in which it can be tuned.
    WrongMode "The Motion Mind is not in mode 4 with an encoder, the only mode that takes both a duty and a position over the wire. \
        Set its switches to mode 4, clear PULSEFB, and switch it off and on.";
    /// The controller has no loop of this kind.
    NoSuchLoop "This controller has no velocity loop under its position loop. Tune the position as PD or PID.";
    /// Bits of the controller are set that make another loop of its gains, or none.
    OtherLoop "NEWVELMODE, FASTPID, PULSEFB or DISABLEPID is set, which makes another loop of these gains, or none. Clear the bit: \
        the gains are those of the loop that computes every 5 ms from the encoder's position.";
    /// A limit or brake input of the controller is at ground.
    LimitInput "A limit input or the brake input of the controller is at ground, which takes the motor's drive away. Move the axis \
        off its limit switch, or release the brake; on an axis with switches give the travel between them.";
    /// The position lagged further behind than the controller allows.
    FollowingError "The position lagged further behind than the controller allows, so that it switched the motor off (SM is its limit). Look for \
        a jam; if the axis is free, allow more, or give a shorter travel.";
    /// A limit switch ended a move.
    LimitSwitch "A limit switch ended a move. Start farther from the switches, and give the travel between them.";
    /// The gains of the controller have steps that are too large.
    GainSteps "The gains of this controller are whole numbers, and one step of them is more than the margin of this loop allows: the smallest \
        that moves the motor is too much, or none between them is right. A coarser encoder, or a gear behind it, makes the steps smaller.";
    /// The loop of the controller was left switched off at the end of a run that found something wrong with the machine.
    LoopOff "The controller's loop was left switched off (DISABLEPID in FUNCTION, or MF, in RAM), since with this it could drive the motor \
        away. When the fault is remedied, arm or drive again: that switches the loop on where the motor stands.";
    /// The controller's own test was asked for a loop that it does not tune.
    OnlyFree "The controller's own test is for the velocity loop of a motor that may turn freely, and for PD and PID of a position. Choose one of these, or fit, step or relay.";
    /// Its loop always has the motor.
    NoOpenLoop "This controller takes no duty, so that neither a step nor a relay can be made. Choose the method fit.";
    /// Between the starting duty and the highest there is no room.
    NoRoomForStep "Between the duty at which the motor starts and the highest that is allowed there is no room for a step. Allow more \
        duty, or choose the method fit.";
    /// The two speeds of a step or relay do not tell a gain.
    StepUnclear "What was measured does not tell how much speed a duty makes: the two speeds lie too near to each other for their noise, or \
        the motor turns unevenly. Try about another duty, or choose the method fit.";
    /// A relay did not bring the motor into a limit cycle.
    NoLimitCycle "The relay did not bring the motor into a steady limit cycle that is larger than the noise of its speed: the motor is too \
        quick for the samples, too slow, or its encoder too coarse. Choose the method fit.";
    /// The controller has no relay test of its own.
    NoOwnTest "This controller did not take the commands of a relay test of its own (84 to 89 of an MCP or RoboClaw; other families have none). \
        Choose the method relay, which is this program's own.";
    /// The controller's own relay test is for simulated ones.
    OwnTestOnSimulated "The controller's own relay test (commands 84 to 89) is sent to simulated controllers only: no manual says how it drives the motor, how it ends \
        and in which unit its result is, and with wrong wiring it can lock the controller up (MCP manual 2.4.5). Choose the method relay, \
        which is this program's own and watches the motor.";
    /// Nothing was counted any more in the controller's own test of a position.
    CountsStopped "The counts stopped in the controller's own test. Either something holds the axis, or its encoder stopped counting: it turns too slowly in this \
        test for its current to tell which.";
    /// The rule of the method has no gains for this loop.
    RuleUnstable "The rule of this method has no gains with which this loop would keep its margin. Choose the method fit.";
    /// The gains of a rule were lowered.
    RuleLowered "The gains of the rule were lowered until the loop kept its margin and its noise on the model.";
    /// Nothing moves, and the current cannot be distinguished from its own noise.
    CurrentUnclear "The motor was driven and not seen to move, and its current is no higher than the noise of its readings, so it \
        does not say why. Check the motor leads, the encoder's plug, and whether the shaft is free or at an end stop.";
}

impl Cause {
    /// Whether it says that motor, encoder or mechanics are not as a loop needs them.
    #[must_use]
    pub fn is_of_machine(self) -> bool {
        matches!(
            self,
            Self::EncoderReversed
                | Self::EncoderDead
                | Self::MotorOpen
                | Self::NothingCounted
                | Self::ShaftLocked
                | Self::EncoderLost
                | Self::Stalled
                | Self::MotorOpened
                | Self::EncoderFlipped
                | Self::ControllerFault
                | Self::OverCurrent
                | Self::NotVerified
        )
    }

    /// Whether it is concluded from how the motor moved, or did not, between the polls.
    #[must_use]
    pub(crate) fn is_of_motion(self) -> bool {
        matches!(
            self,
            Self::EncoderReversed
                | Self::EncoderDead
                | Self::MotorOpen
                | Self::NothingCounted
                | Self::ShaftLocked
                | Self::EncoderLost
                | Self::Stalled
                | Self::MotorOpened
                | Self::EncoderFlipped
                | Self::TravelLimit
                | Self::NarrowTravel
                | Self::TooCoarse
                | Self::MovesTooShort
                | Self::StepUnclear
                | Self::NoLimitCycle
                | Self::PoorFit
                | Self::Lopsided
                | Self::CurrentLimited
                | Self::NotVerified
                | Self::UnknownLaw
                | Self::NoDirectLoop
                | Self::TimeLimit
                | Self::Refused
        )
    }

    /// The same fault, had it been there before the run; of a cause that says that something struck in mid-run.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub(crate) fn at_the_start(self) -> Option<Self> {
        match self {
            Self::EncoderLost => Some(Self::EncoderDead),
            Self::Stalled => Some(Self::ShaftLocked),
            Self::MotorOpened => Some(Self::MotorOpen),
            Self::EncoderFlipped => Some(Self::EncoderReversed),
            _ => None,
        }
    }

    /// Whether it is distinguished from others by the motor's current.
    #[must_use]
    pub(crate) fn is_by_current(self) -> bool {
        matches!(
            self,
            Self::EncoderDead
                | Self::MotorOpen
                | Self::ShaftLocked
                | Self::EncoderLost
                | Self::Stalled
                | Self::MotorOpened
        )
    }
}

/// When in a run something was.
fn at(at_ms: u32) -> String {
    format!("at {:.1} s of the run", 1e-3 * f64::from(at_ms))
}

fn line_too_slow(reading_ms: u32) -> String {
    format!(
        "This line takes {reading_ms} ms from one reading to the next, so a motor could not be switched off within 250 ms of the last good one when \
         replies are lost. Use a cable, a higher baud rate, or a line with less latency."
    )
}

/// Who was late is told by the times at which the computer asked and read.
fn answered_late(longest_gap_ms: u32, at_ms: u32, whose: Whose) -> String {
    let at = at(at_ms);
    match whose {
        Whose::Computer => format!(
            "This computer answered late: {longest_gap_ms} ms between two samples {at}, so the run says nothing about the machine. Try again \
             with fewer programs running."
        ),
        Whose::Line => format!(
            "Replies came late: {longest_gap_ms} ms between two samples {at}, though this computer asked in time, so the run says nothing \
             about the machine. Look at the line for lost replies, a radio or a network on the way, or an adapter that holds bytes back."
        ),
    }
}

/// The mark of figures that may be worse than their intervals say.
fn taken_late(longest_gap_ms: u32, at_ms: u32, whose: Whose) -> String {
    let at = at(at_ms);
    match whose {
        Whose::Computer => format!(
            "These figures were taken while this computer answered late: {longest_gap_ms} ms between two samples {at}. Run it again with \
             fewer programs running before you rely on them."
        ),
        Whose::Line => format!(
            "These figures were taken while replies came late: {longest_gap_ms} ms between two samples {at}, though this computer asked in \
             time. Run it again over a better line before you rely on them."
        ),
    }
}
