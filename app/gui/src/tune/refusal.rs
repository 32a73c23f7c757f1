//! A refusal that teaches: what was seen, a drawing of what is likely wrong, what to do, and another try.

use brushwork_tuning::cause::{Cause, Whose};
use egui::{Button, Label, RichText, Ui};

use super::sketches::{Sketch, sketch_ui};
use super::{Loop, Run, TuneAction};
use crate::command::{Command, Commands};
use crate::model::{IndicatorState, Model, interruption};
use crate::tune::messages::RunMessage;

/// What to do where one method does not get on with a machine.
const OTHER_METHOD: [&str; 2] = [
    "Choose By fit: it needs no steady speed at two duties and no limit cycle.",
    "Or try about another duty, and allow more of it.",
];

/// What to do where nothing is counted, or the axis is held.
const LOOK_AT_ENCODER: &str =
    "Look at the encoder's plug, and turn the shaft by hand: the encoder figure at the top must change.";
const FREE_THE_AXIS: &str = "Take brakes and jams away, and move the axis off its end stop.";

/// What to do where answers came late.
fn against_lateness(whose: Whose) -> &'static [&'static str] {
    match whose {
        Whose::Computer => &["Close other programs that keep this computer busy, and try again."],
        Whose::Line => &[
            "Look at the link's figures for lost replies, and check the cable.",
            "Try without a radio, a network or an adapter on the way.",
        ],
    }
}

/// What to do, in the order in which it is best tried.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn steps(cause: Cause) -> &'static [&'static str] {
    match cause {
        Cause::EncoderReversed => &[
            "Swap the two motor leads at the controller, or the encoder's A and B. Not both.",
            "Or set the reverse option of the encoder under General Settings.",
            "On the PWM screen, a little positive duty must make the encoder count up.",
        ],
        Cause::NothingCounted => &[
            "Look at the encoder's plug at both ends, and turn the shaft by hand: the encoder figure at the top must change.",
            "Look at both motor leads and their screws, and take brakes and jams away.",
            "This controller reports no motor current, so the three cannot be told apart from here.",
        ],
        Cause::CountsStopped => &[LOOK_AT_ENCODER, FREE_THE_AXIS],
        Cause::CurrentUnclear => {
            &["Look at both motor leads and their screws.", LOOK_AT_ENCODER, FREE_THE_AXIS]
        }
        Cause::AnsweredLate { whose, .. } | Cause::TakenLate { whose, .. } => against_lateness(whose),
        Cause::OnlyFree
        | Cause::NoOpenLoop
        | Cause::NoRoomForStep
        | Cause::StepUnclear
        | Cause::NoLimitCycle
        | Cause::NoOwnTest
        | Cause::OwnTestOnSimulated
        | Cause::RuleUnstable
        | Cause::RuleLowered => &OTHER_METHOD,
        Cause::LineTooSlow { .. } => &[
            "Connect the controller by a cable: a radio, a network or an adapter that holds bytes back adds its latency to every reading.",
            "Or raise the baud rate.",
        ],
        Cause::OutsideTravel => &[
            "Move the axis by hand, or on the PWM screen with little duty, until its counts lie within the travel.",
            "Or give a travel around where it stands.",
        ],
        Cause::NarrowTravel => &[
            "Move the axis to the middle of its travel.",
            "Widen the travel if the mechanics allow it, or use an encoder with more counts.",
        ],
        Cause::LimitNotTaken => &[
            "Leave the highest current at 0: then the controller's own limit counts.",
            "Or set the current limit under General Settings before the run.",
        ],
        Cause::UnknownLaw => &[
            "Tune it by hand with the assistant below, which needs to know nothing of the loop's law.",
            "Save the report: it holds what the controller answered.",
        ],
        Cause::NoDirectLoop => {
            &["Choose the method PIV above and try again: it tunes the velocity loop under the position too."]
        }
        Cause::EncoderDead | Cause::EncoderLost => &[
            "Look at the encoder's plug at both ends, and at its 5 V supply.",
            "Turn the shaft by hand: the encoder figure at the top must change.",
            "Check that the encoder is on this motor's channel and of the type that is set.",
        ],
        Cause::EncoderFlipped => &[
            "Move the encoder's cable while the figure at the top is watched: it must not jump.",
            "Route it away from the motor leads, or use a shielded one.",
        ],
        Cause::MotorOpen | Cause::MotorOpened => &[
            "Look at both motor leads and their screws.",
            "Turn the shaft by hand against shorted leads: it must be heavier than with open ones.",
            "Check fuses and switches between controller and motor.",
        ],
        Cause::ShaftLocked | Cause::Stalled => &[
            "Release brakes and take jams away; turn the shaft by hand.",
            "If the axis stands at an end stop, move it to the middle and tune Within its travel.",
            "If it is only heavy, allow more duty or more current.",
        ],
        Cause::TravelLimit => &[
            "Move the axis to the middle of its travel.",
            "Widen the travel if the mechanics allow it.",
            "Lower the highest duty, so that it needs less room to stop.",
        ],
        Cause::BatteryLow => &[
            "Charge the battery or use a stronger supply.",
            "Lower the highest duty: a weak supply sags less then.",
        ],
        Cause::OverCurrent => {
            &["Allow more current above, or lower the highest duty.", "Take load off the motor."]
        }
        Cause::CurrentLimited => &[
            "Raise the current limit under General Settings, if the motor may have it.",
            "Take load off the motor.",
        ],
        Cause::LinkLost => &[
            "Check the cable to the controller and connect again.",
            "The controller's own time-out has stopped the motor. The old gains are put back when it answers again.",
        ],
        Cause::ControllerFault => &["See Device Status for the reason.", "Clear it there, then try again."],
        Cause::TimeLimit => {
            &["A very slow axis needs another way: lower the level of the run, or tune it by hand."]
        }
        Cause::TorqueMode => &[
            "Let the run clear L and R and put them back afterwards (the button below).",
            "Or set L or R to 0 under Velocity loop and apply it.",
        ],
        Cause::WrappingEncoder => &["Tune the position of this axis instead, on the Position screen."],
        Cause::TooCoarse => &[
            "Use an encoder with more counts per turn, or put it on the motor side of the gear.",
            "If the axis is slow only, allow more duty.",
        ],
        Cause::PoorFit => {
            &["Look for slipping couplings, belts and set screws.", "Check that nothing else moves the axis."]
        }
        Cause::Lopsided | Cause::Asymmetric | Cause::HeavyLoad => &[
            "Take the load that pulls one way off for the run, or balance it.",
            "Look for a jam in one direction.",
        ],
        Cause::NotVerified => &[
            "Lower the level and try again.",
            "Look for backlash in gears and for soft couplings: they oscillate with stiff gains.",
        ],
        Cause::Refused => &[
            "See the traffic panel for the command that was refused.",
            "Read the settings again and check the firmware's version.",
        ],
        _ => &[],
    }
}

/// Offers to clear L and R for the run, where that is what it was refused for.
fn clearing_ui(ui: &mut Ui, model: &Model, which: Loop, commands: &mut Commands) {
    let is_torque = |run: &Run| run.report.causes.contains(&Cause::TorqueMode);
    if model.front.tune.cleared_winding().is_some()
        || !model.front.tune.front(which).run().is_some_and(is_torque)
    {
        return;
    }
    let is_free = !model.front.is_guided() && !model.front.settings.is_busy();
    let clear = ui.add_enabled(is_free, Button::new("Clear L and R for the run"));
    let hint = "Writes 0 for both into the controller's RAM now and puts them back after the next run, whatever becomes of it";
    if clear.on_hover_text(hint).clicked() {
        commands.push(Command::Tune(TuneAction::ClearWinding));
    }
}

/// Says that L and R are cleared, with the way back.
pub fn cleared_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    let Some(motor) = model.front.tune.cleared_winding() else { return };
    IndicatorState::Warning.line_ui(ui, &RunMessage::Cleared { motor }.to_string());
    if ui.button("Put L and R back").on_hover_text("Now, without a run").clicked() {
        commands.push(Command::Tune(TuneAction::PutWindingBack));
    }
}

/// What was seen; of a run that was stopped, by what.
fn sentence(run: &Run, cause: Cause) -> String {
    match run.interrupted.filter(|_| cause == Cause::Stopped) {
        Some(by) => RunMessage::StoppedBy { by: interruption(by) }.to_string(),
        None => cause.sentence().into_owned(),
    }
}

pub fn refusal_ui(ui: &mut Ui, model: &Model, which: Loop, commands: &mut Commands) {
    let Some(run) = model.front.tune.front(which).run() else { return };
    let motor = model.front.tune.motor(which);
    let head = RunMessage::NotTuned { motor, number: run.number, seconds: run.report.seconds.1 }.to_string();
    IndicatorState::Error.line_ui(ui, &head);
    let is_armed = model.front.link.arming.is_armed_for(which.scope());
    ui.horizontal_wrapped(|ui| {
        let can_start = is_armed && !model.front.is_guided();
        let again = ui.add_enabled(can_start, Button::new("Try again"));
        if again.on_disabled_hover_text("Arm this screen first").clicked() {
            commands.push(Command::Tune(TuneAction::Start(motor)));
        }
        clearing_ui(ui, model, which, commands);
        if !is_armed {
            ui.label(RichText::new("Arm this screen to try again.").small().weak());
        }
    });
    for (index, cause) in run.report.causes.iter().enumerate() {
        ui.add(Label::new(sentence(run, *cause)).wrap());
        if let Some(sketch) = Sketch::of(*cause).filter(|_| index == 0) {
            sketch_ui(ui, &sketch);
        }
        let steps = model.front.family().remedies(*cause).unwrap_or_else(|| steps(*cause));
        for (number, step) in steps.iter().enumerate() {
            ui.add(Label::new(format!("{}. {step}", number + 1)).wrap());
        }
    }
    if !model.front.tune.is_owing() {
        ui.weak("The motors were stopped and the old gains are in force.");
    }
}
