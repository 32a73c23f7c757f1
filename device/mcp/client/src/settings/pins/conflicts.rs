//! Settings that contradict each other: each one is allowed alone, together they do not do what they look like.

use brushwork_mcp_wire::codes::{ENCODER_PIN_NONE, STREAMS};
use brushwork_mcp_wire::models::{Family, Pin};
use serde::Serialize;

use crate::model_of;
use crate::settings::pins::mode::PinMode;
use crate::settings::pins::shape::SignalShape;
use crate::settings::pins::values::{Lookup, PinValues, choice};
use brushwork_link::settings::SettingValue;
use brushwork_link::settings::SettingsTable;

/// One contradiction.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Conflict {
    /// Which kind.
    pub kind: ConflictKind,
    /// The rows that contradict each other; the first is the one to look at.
    pub keys: Vec<String>,
    /// What is wrong and its remedy.
    pub sentence: String,
}

/// The kinds of contradiction that are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ConflictKind {
    /// A pin is given two functions.
    TwoFunctions,
    /// A pin is given a function that it does not have.
    NoSuchFunction,
    /// A serial port in use holds a pin that is set as an input.
    PortHoldsPin,
    /// One line of an encoder is an encoder input and the other is not.
    HalfAnEncoder,
    /// A motor takes its encoder from a pin that measures nothing.
    EncoderUnread,
    /// A minimum or maximum action that nothing can trigger, or that has nothing to act on.
    ActionNeverFires,
    /// Minimum, center, maximum and deadband leave no range.
    NoRange,
    /// An input commands a motor, but its kind is at no priority level.
    NeverCommands,
    /// Two inputs of the same kind command the same motor.
    TwoCommanders,
    /// A bus is set to a rate that it does not have.
    NoSuchRate,
}

/// Every contradiction among the settings that are known, pin by pin.
pub fn conflicts(table: &SettingsTable, get: Lookup<'_>) -> Vec<Conflict> {
    let subject = table.subject();
    if model_of(subject).is_none_or(|model| model.family != Family::Mcp) {
        return Vec::new();
    }
    let pins: Vec<Judged<'_>> =
        (1..=subject.pins).filter_map(|number| Judged::new(table, get, number)).collect();
    let mut found = Vec::new();
    for pin in &pins {
        found.extend(pin.two_functions());
        found.extend(pin.no_such_function());
        found.extend(pin.held_by_port());
        found.extend(pin.half_an_encoder(&pins));
        found.extend(pin.no_range());
        found.extend(pin.never_commands());
        found.extend(["min_action", "max_action"].iter().filter_map(|end| pin.never_fires(end)));
    }
    found.extend((1..=2).filter_map(|motor| encoder_unread(get, &pins, motor)));
    found.extend((1..=2).flat_map(|motor| two_commanders(&pins, motor)));
    found.extend(BUS_RATES.iter().filter_map(|(key, name, rates)| no_such_rate(get, key, name, rates)));
    found
}

/// The bit rates of the buses (MCP manual 1.9.4, 1.9.6; the fifth of CAN is printed with a digit too many).
const BUS_RATES: [(&str, &str, &[i64]); 2] = [
    (
        "can.rate",
        "CANopen",
        &[1_000_000, 800_000, 500_000, 250_000, 125_000, 100_000, 50_000, 20_000, 10_000],
    ),
    ("i2c.rate", "I2C", &[100_000, 400_000, 1_000_000]),
];

fn no_such_rate(get: Lookup<'_>, key: &str, name: &str, rates: &[i64]) -> Option<Conflict> {
    let Some(SettingValue::Int(rate)) = get(key) else { return None };
    let listed: Vec<String> = rates.iter().map(ToString::to_string).collect();
    (!rates.contains(&rate)).then(|| Conflict {
        kind: ConflictKind::NoSuchRate,
        keys: vec![key.to_owned()],
        sentence: format!("{name} has no rate of {rate} bit/s. It has {}.", listed.join(", ")),
    })
}

/// A pin with what is known of it.
struct Judged<'a> {
    get: Lookup<'a>,
    values: PinValues<'a>,
    number: usize,
    name: String,
    label: Option<Pin>,
    mode: PinMode,
}

impl<'a> Judged<'a> {
    fn new(table: &SettingsTable, get: Lookup<'a>, number: usize) -> Option<Self> {
        let subject = table.subject();
        Some(Self {
            get,
            values: PinValues::new(get, number),
            number,
            name: subject.pin_name(number - 1),
            label: model_of(subject).and_then(|model| model.pins.get(number - 1)).copied(),
            mode: PinMode::of(get, number)?,
        })
    }

    fn conflict(&self, kind: ConflictKind, fields: &[&str], sentence: String) -> Conflict {
        Conflict { kind, keys: fields.iter().map(|field| self.values.key(field)).collect(), sentence }
    }

    fn is_used(&self) -> bool {
        self.mode != PinMode::None
    }

    /// The name of the port that holds the pin, with its key, while that port is in use (MCP manual 1.9.7).
    fn holder(&self) -> Option<(&'static str, String)> {
        let uart = usize::from(self.label?.uart()?);
        let stream = STREAMS.get(uart + 1)?;
        let key = format!("stream.{}.type", stream.key);
        (choice(self.get, &key)? != "disabled").then_some((stream.label, key))
    }

    fn two_functions(&self) -> Option<Conflict> {
        let is_both = self.values.is_on("digital") && !matches!(self.mode, PinMode::Digital | PinMode::None);
        is_both.then(|| {
            let sentence = format!(
                "{} is set as a digital input and as {} at once. Choose one mode for it.",
                self.name,
                self.mode.label().to_lowercase()
            );
            self.conflict(ConflictKind::TwoFunctions, &["type", "digital"], sentence)
        })
    }

    fn no_such_function(&self) -> Option<Conflict> {
        let label = self.label?;
        (!self.mode.is_on(label)).then(|| {
            let sentence = format!(
                "{} is set to {}, which this pin cannot measure. Choose one of the modes in its name.",
                self.name,
                self.mode.label().to_lowercase()
            );
            self.conflict(ConflictKind::NoSuchFunction, &["type"], sentence)
        })
    }

    fn held_by_port(&self) -> Option<Conflict> {
        let (port, key) = self.holder().filter(|_| self.is_used())?;
        let sentence = format!(
            "{} is set to {}, but {port} is in use and holds the pin. Disable {port}, or set the pin to None.",
            self.name,
            self.mode.label().to_lowercase()
        );
        let mut conflict = self.conflict(ConflictKind::PortHoldsPin, &["type"], sentence);
        conflict.keys.push(key);
        Some(conflict)
    }

    fn half_an_encoder(&self, pins: &[Self]) -> Option<Conflict> {
        let (encoder, phase) = self.label?.encoder_channel().filter(|_| self.mode == PinMode::Encoder)?;
        let is_other = |pin: &&Self| {
            let channel = pin.label.and_then(Pin::encoder_channel);
            channel.is_some_and(|(number, other)| number == encoder && other != phase)
        };
        let other = pins.iter().find(is_other).filter(|other| other.mode != PinMode::Encoder)?;
        let sentence = format!(
            "{} is one line of encoder {encoder}, but {} is not set to encoder. Set both or none: the lines of an \
             encoder count in pairs.",
            self.name, other.name
        );
        let mut conflict = self.conflict(ConflictKind::HalfAnEncoder, &["type"], sentence);
        conflict.keys.push(other.values.key("type"));
        Some(conflict)
    }

    fn never_fires(&self, end: &str) -> Option<Conflict> {
        let action = self.values.choice(end).filter(|action| *action != "none")?;
        let why = self.never_reached(end).or_else(|| self.nothing_to_act_on(action))?;
        let what = if end == "min_action" { "minimum" } else { "maximum" };
        let sentence = format!("The {what} action of {} never acts: {why}", self.name);
        Some(self.conflict(ConflictKind::ActionNeverFires, &[end], sentence))
    }

    /// Why the input never gets to the end that triggers the action.
    fn never_reached(&self, end: &str) -> Option<String> {
        if !self.is_used() {
            return Some("the pin measures nothing. Choose its mode.".to_owned());
        }
        if let Some((port, _)) = self.holder() {
            return Some(format!("{port} is in use and holds the pin. Disable {port}."));
        }
        let (lowest, highest) = self.mode.reach()?;
        let at = |value: f64| format!("{value} {}", self.mode.unit()).trim_end().to_owned();
        match (end, self.values.number(end.trim_end_matches("_action"))?) {
            ("min_action", min) if min < lowest => {
                Some(format!("the input never goes down to {}. Raise the minimum.", at(min)))
            }
            ("max_action", max) if max > highest => {
                Some(format!("the input never goes up to {}. Lower the maximum.", at(max)))
            }
            _ => None,
        }
    }

    /// Why the action changes nothing even when it is triggered.
    fn nothing_to_act_on(&self, action: &str) -> Option<String> {
        let has_no_encoder = |motor: usize| {
            let number = (self.get)(&format!("motor{motor}.encoder.pin"));
            number == Some(SettingValue::Int(ENCODER_PIN_NONE))
        };
        let is_bridged = (self.get)("unit.bridge_channels") == Some(SettingValue::Bool(true));
        match action {
            "m1_load_home" if has_no_encoder(1) => {
                Some("motor 1 has no encoder whose count it could set.".to_owned())
            }
            "m2_load_home" if has_no_encoder(2) => {
                Some("motor 2 has no encoder whose count it could set.".to_owned())
            }
            action if is_bridged && action.starts_with("m2_") => {
                Some("the channels are bridged, so there is no motor 2.".to_owned())
            }
            _ => None,
        }
    }

    fn no_range(&self) -> Option<Conflict> {
        let shape = SignalShape::of(self.get, self.number)?;
        let (min, center, max, deadband) = (shape.min, shape.center, shape.max, shape.deadband);
        if !self.is_used() {
            return None;
        }
        let (fields, why): (&[&str], String) = if min >= max {
            (&["min", "max"], format!("its minimum {min} is not below its maximum {max}"))
        } else if !(min..=max).contains(&center) {
            (&["center", "min", "max"], format!("its center {center} is not between {min} and {max}"))
        } else if deadband >= center - min && deadband >= max - center {
            (&["deadband"], format!("its deadband {deadband} covers the whole range"))
        } else {
            return None;
        };
        let sentence = format!("{} gives no usable command: {why}.", self.name);
        Some(self.conflict(ConflictKind::NoRange, fields, sentence))
    }

    fn never_commands(&self) -> Option<Conflict> {
        self.values.choice("target").filter(|target| *target != "none")?;
        let levels = ["priority.1", "priority.2", "priority.3"].map(|level| choice(self.get, level));
        let kind = self.mode.priority()?;
        (levels.iter().all(Option::is_some) && !levels.contains(&Some(kind))).then(|| {
            let sentence = format!(
                "{} is set to control a motor, but {kind} inputs are at no priority level, so it never does. Put \
                 {kind} at a level, or set the pin to control none.",
                self.name
            );
            let mut conflict = self.conflict(ConflictKind::NeverCommands, &["target"], sentence);
            conflict.keys.push("priority.3".to_owned());
            conflict
        })
    }

    /// Whether the pin commands a motor, as what.
    fn commands(&self, motor: usize) -> Option<&'static str> {
        let target = self.values.choice("target")?;
        (target == "both" || target == format!("motor{motor}")).then(|| self.mode.priority()).flatten()
    }
}

fn encoder_unread(get: Lookup<'_>, pins: &[Judged<'_>], motor: usize) -> Option<Conflict> {
    let key = format!("motor{motor}.encoder.pin");
    let Some(SettingValue::Int(number)) = get(&key) else { return None };
    let pin = pins.iter().find(|pin| pin.number as i64 == number + 1)?;
    let why = match pin.holder() {
        _ if pin.mode == PinMode::None => "which measures nothing. Set that pin's mode".to_owned(),
        _ if pin.mode == PinMode::Digital => "which is a digital input. Set that pin's mode".to_owned(),
        Some((port, _)) => format!("which {port} holds. Disable {port}"),
        None => return None,
    };
    let sentence =
        format!("Motor {motor} takes its encoder from {}, {why}, or choose another input.", pin.name);
    let keys = vec![key, pin.values.key("type")];
    Some(Conflict { kind: ConflictKind::EncoderUnread, keys, sentence })
}

fn two_commanders(pins: &[Judged<'_>], motor: usize) -> Vec<Conflict> {
    let kinds = ["pulse", "analog"].into_iter();
    let of_kind = |kind: &str| -> Vec<&Judged<'_>> {
        pins.iter().filter(|pin| pin.commands(motor) == Some(kind)).collect()
    };
    let reported = |kind: &'static str| {
        let commanders = of_kind(kind);
        let [first, .., last] = commanders.as_slice() else { return None };
        let sentence = format!(
            "{} and {} both control motor {motor} as {kind} inputs, and only one of them can. Let the other control \
             none.",
            first.name, last.name
        );
        let keys = commanders.iter().rev().map(|pin| pin.values.key("target")).collect();
        Some(Conflict { kind: ConflictKind::TwoCommanders, keys, sentence })
    };
    kinds.filter_map(reported).collect()
}
