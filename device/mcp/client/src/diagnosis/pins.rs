//! What the input pins do to the motors: actions at the ends of their ranges (MCP manual 1.9.8), and inputs that hold the
//! motors at a higher priority level.

use crate::diagnosis::evidence::Evidence;
use crate::diagnosis::finding::Hindrance::{BlocksAll, BlocksSome};
use crate::diagnosis::finding::{Finding, finding};
use crate::diagnosis::pin_end::PinEnd;
use crate::messages::{CureMessage, FindingMessage};
use brushwork_link::Message;
use brushwork_link::settings::{SettingValue, SettingsImage};

/// Whether any input pin that is in use has an action, so that it can stop a motor.
#[must_use]
pub fn has_actions(settings: &SettingsImage) -> bool {
    let acts = |pin, side| choice(settings, pin, side).is_some_and(|action| action != "none");
    (0..)
        .take_while(|pin| choice(settings, *pin, "type").is_some())
        .any(|pin| is_used(settings, pin) && (acts(pin, "min_action") || acts(pin, "max_action")))
}

/// Whether motor 1 and motor 2 are homed or at a limit switch by the actions of their pins: what M1HM and M2HM show where
/// the status word has no such bit (MCP manual 1.2.5).
#[must_use]
pub fn homed(settings: &SettingsImage, ends: &[PinEnd]) -> [bool; 2] {
    let mut homed = [false; 2];
    for action in at_work(settings, ends) {
        if matches!(action.effect, "safe_stop" | "off" | "forward_limit" | "backward_limit" | "load_home") {
            for motor in action.motors {
                homed[motor - 1] = true;
            }
        }
    }
    homed
}

/// An action that a pin triggers now.
struct Action {
    pin: usize,
    end: PinEnd,
    /// Counted from 1.
    motors: &'static [usize],
    effect: &'static str,
}

/// What the pins keep the motors from.
pub fn findings(evidence: &Evidence<'_>) -> Vec<Finding> {
    let Some(settings) = evidence.settings else { return Vec::new() };
    let actions = at_work(settings, evidence.pins.unwrap_or_default());
    let mut findings: Vec<Finding> =
        actions.into_iter().filter_map(|action| of_action(&action, evidence)).collect();
    findings.extend(held_by_others(settings, evidence));
    findings
}

fn of_action(action: &Action, evidence: &Evidence<'_>) -> Option<Finding> {
    let end: Message = match action.end {
        PinEnd::Lowest => FindingMessage::Minimum.into(),
        PinEnd::Between | PinEnd::Highest => FindingMessage::Maximum.into(),
    };
    let pin = evidence.pin_name(action.pin);
    let motors = match action.motors {
        [one] => FindingMessage::OneMotor { motor: *one }.into(),
        _ => FindingMessage::BothMotors.into(),
    };
    let hindrance = if action.motors.len() > 1 { BlocksAll } else { BlocksSome };
    let cure = CureMessage::LeaveEnd { end: end.clone() };
    Some(match action.effect {
        "safe_stop" => finding(hindrance, FindingMessage::PinStops { pin, end, motors }, cure),
        "off" => finding(hindrance, FindingMessage::PinLetsCoast { pin, end, motors }, cure),
        "forward_limit" => {
            let what = FindingMessage::ForwardLimit { pin, end, motors };
            finding(BlocksSome, what, CureMessage::DriveBackwards)
        }
        "backward_limit" => {
            let what = FindingMessage::BackwardLimit { pin, end, motors };
            finding(BlocksSome, what, CureMessage::DriveForwards)
        }
        "e_stop" => finding(BlocksAll, FindingMessage::PinEStops { pin, end }, cure),
        _ => return None,
    })
}

fn at_work(settings: &SettingsImage, ends: &[PinEnd]) -> Vec<Action> {
    let mut actions = Vec::new();
    for (pin, end) in ends.iter().copied().enumerate() {
        let side = match end {
            PinEnd::Between => continue,
            PinEnd::Lowest => "min",
            PinEnd::Highest => "max",
        };
        if !is_used(settings, pin) {
            continue;
        }
        let Some((motors, effect)) = choice(settings, pin, &format!("{side}_action")).map(split) else {
            continue;
        };
        actions.push(Action { pin, end, motors, effect });
    }
    actions
}

/// The motors and the effect that an action's key names.
fn split(key: &'static str) -> (&'static [usize], &'static str) {
    let prefixed: [(&str, &[usize]); 3] = [("m1_", &[1]), ("m2_", &[2]), ("both_", &[1, 2])];
    prefixed
        .into_iter()
        .find_map(|(prefix, motors)| Some((motors, key.strip_prefix(prefix)?)))
        .unwrap_or((&[1, 2], key))
}

/// Inputs that command a motor from a priority level above Serial's (MCP manual 1.2.10, command 139).
fn held_by_others(settings: &SettingsImage, evidence: &Evidence<'_>) -> Vec<Finding> {
    let level = |level| settings.get(&format!("priority.{level}"))?.choice();
    let levels = [1, 2, 3].map(|number: u8| level(number).unwrap_or(""));
    let Some(serial) = levels.iter().position(|level| *level == "serial") else { return Vec::new() };
    let above = levels[..serial].iter().enumerate();
    above.filter_map(|(level, kind)| held_by(settings, evidence, level + 1, kind, serial + 1)).collect()
}

/// The inputs of one kind that command a motor at a level above Serial's.
fn held_by(
    settings: &SettingsImage,
    evidence: &Evidence<'_>,
    level: usize,
    kind: &str,
    serial: usize,
) -> Option<Finding> {
    let drives = |pin: &usize| {
        choice(settings, *pin, "type") == Some(kind)
            && choice(settings, *pin, "target").is_some_and(|target| target != "none")
    };
    let pins: Vec<usize> =
        (0..).take_while(|pin| choice(settings, *pin, "type").is_some()).filter(drives).collect();
    let first = pins.first()?;
    let names = pins.iter().map(|pin| evidence.pin_name(*pin)).collect::<Vec<_>>().join(", ");
    let cure = CureMessage::RaiseSerial { kind: kind.to_owned(), pin: evidence.pin_name(*first) };
    Some(match kind {
        "analog" => finding(BlocksAll, FindingMessage::AnalogCommands { names, level, serial }, cure),
        "pulse" => {
            let for_ever = pins.iter().any(|pin| int(settings, *pin, "timeout") == Some(0));
            let what = if for_ever {
                FindingMessage::PulsesForGood { names, level, serial }
            } else {
                FindingMessage::PulsesMeanwhile { names, level, serial }
            };
            finding(BlocksSome, what, cure)
        }
        _ => return None,
    })
}

/// A pin without a type that is not digital does nothing.
fn is_used(settings: &SettingsImage, pin: usize) -> bool {
    let digital = settings.get(&key(pin, "digital")) == Some(SettingValue::Bool(true));
    digital || choice(settings, pin, "type").is_some_and(|kind| kind != "none")
}

fn choice(settings: &SettingsImage, pin: usize, what: &str) -> Option<&'static str> {
    settings.get(&key(pin, what))?.choice()
}

fn int(settings: &SettingsImage, pin: usize, what: &str) -> Option<i64> {
    settings.get(&key(pin, what))?.int()
}

fn key(pin: usize, what: &str) -> String {
    format!("pin.{}.{what}", pin + 1)
}
