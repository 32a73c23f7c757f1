//! Settings that contradict each other: each one is allowed alone, together they do not do what they look like.

use brushwork_mcp_wire::codes::{ENCODER_PIN_NONE, STREAMS};
use brushwork_mcp_wire::models::Pin;
use serde::Serialize;

use crate::messages::ConflictMessage;
use crate::model_of;
use crate::settings::pins::mode::PinMode;
use crate::settings::pins::shape::SignalShape;
use crate::settings::pins::values::{Lookup, PinValues, choice};
use brushwork_link::Message;
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
    pub sentence: Message,
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
    /// A setting takes the place of others.
    Overruled,
}

/// Every contradiction among the settings of an MCP that are known, pin by pin.
pub fn conflicts(table: &SettingsTable, get: Lookup<'_>) -> Vec<Conflict> {
    let subject = table.subject();
    if model_of(subject).is_none() {
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

fn no_such_rate(get: Lookup<'_>, key: &str, bus: &'static str, rates: &[i64]) -> Option<Conflict> {
    let Some(SettingValue::Int(rate)) = get(key) else { return None };
    let listed: Vec<String> = rates.iter().map(ToString::to_string).collect();
    (!rates.contains(&rate)).then(|| Conflict {
        kind: ConflictKind::NoSuchRate,
        keys: vec![key.to_owned()],
        sentence: ConflictMessage::NoSuchRate { bus, rate, listed: listed.join(", ") }.into(),
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

    fn conflict(&self, kind: ConflictKind, fields: &[&str], sentence: ConflictMessage) -> Conflict {
        let keys = fields.iter().map(|field| self.values.key(field)).collect();
        Conflict { kind, keys, sentence: sentence.into() }
    }

    /// The pin and what it is set to, for sentences.
    fn pin_and_mode(&self) -> (String, String) {
        (self.name.clone(), self.mode.label().to_lowercase())
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
            let (pin, mode) = self.pin_and_mode();
            let sentence = ConflictMessage::TwoFunctions { pin, mode };
            self.conflict(ConflictKind::TwoFunctions, &["type", "digital"], sentence)
        })
    }

    fn no_such_function(&self) -> Option<Conflict> {
        let label = self.label?;
        (!self.mode.is_on(label)).then(|| {
            let (pin, mode) = self.pin_and_mode();
            let sentence = ConflictMessage::NoSuchFunction { pin, mode };
            self.conflict(ConflictKind::NoSuchFunction, &["type"], sentence)
        })
    }

    fn held_by_port(&self) -> Option<Conflict> {
        let (port, key) = self.holder().filter(|_| self.is_used())?;
        let (pin, mode) = self.pin_and_mode();
        let sentence = ConflictMessage::PortHoldsPin { pin, mode, port };
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
        let (pin, other_pin) = (self.name.clone(), other.name.clone());
        let sentence = ConflictMessage::HalfAnEncoder { pin, encoder, other: other_pin };
        let mut conflict = self.conflict(ConflictKind::HalfAnEncoder, &["type"], sentence);
        conflict.keys.push(other.values.key("type"));
        Some(conflict)
    }

    fn never_fires(&self, end: &str) -> Option<Conflict> {
        let action = self.values.choice(end).filter(|action| *action != "none")?;
        let why = self.never_reached(end).or_else(|| self.nothing_to_act_on(action))?;
        let (pin, why) = (self.name.clone(), why.into());
        let sentence = match end {
            "min_action" => ConflictMessage::MinimumNeverActs { pin, why },
            _ => ConflictMessage::MaximumNeverActs { pin, why },
        };
        Some(self.conflict(ConflictKind::ActionNeverFires, &[end], sentence))
    }

    /// Why the input never gets to the end that triggers the action.
    fn never_reached(&self, end: &str) -> Option<ConflictMessage> {
        if !self.is_used() {
            return Some(ConflictMessage::MeasuresNothing);
        }
        if let Some((port, _)) = self.holder() {
            return Some(ConflictMessage::Held { port });
        }
        let (lowest, highest) = self.mode.reach()?;
        let at = |value: f64| format!("{value} {}", self.mode.unit()).trim_end().to_owned();
        match (end, self.values.number(end.trim_end_matches("_action"))?) {
            ("min_action", min) if min < lowest => Some(ConflictMessage::NeverDown { to: at(min) }),
            ("max_action", max) if max > highest => Some(ConflictMessage::NeverUp { to: at(max) }),
            _ => None,
        }
    }

    /// Why the action changes nothing even when it is triggered.
    fn nothing_to_act_on(&self, action: &str) -> Option<ConflictMessage> {
        let has_no_encoder = |motor: usize| {
            let number = (self.get)(&format!("motor{motor}.encoder.pin"));
            number == Some(SettingValue::Int(ENCODER_PIN_NONE))
        };
        let is_bridged = (self.get)("unit.bridge_channels") == Some(SettingValue::Bool(true));
        match action {
            "m1_load_home" if has_no_encoder(1) => Some(ConflictMessage::NoEncoder { motor: 1 }),
            "m2_load_home" if has_no_encoder(2) => Some(ConflictMessage::NoEncoder { motor: 2 }),
            action if is_bridged && action.starts_with("m2_") => Some(ConflictMessage::NoSecondMotor),
            _ => None,
        }
    }

    fn no_range(&self) -> Option<Conflict> {
        let shape = SignalShape::of(self.get, self.number)?;
        let (min, center, max, deadband) = (shape.min, shape.center, shape.max, shape.deadband);
        if !self.is_used() {
            return None;
        }
        let (fields, why): (&[&str], _) = if min >= max {
            (&["min", "max"], ConflictMessage::MinimumNotBelow { min, max })
        } else if !(min..=max).contains(&center) {
            (&["center", "min", "max"], ConflictMessage::CenterOutside { center, min, max })
        } else if deadband >= center - min && deadband >= max - center {
            (&["deadband"], ConflictMessage::DeadbandCoversAll { deadband })
        } else {
            return None;
        };
        let sentence = ConflictMessage::NoCommand { pin: self.name.clone(), why: why.into() };
        Some(self.conflict(ConflictKind::NoRange, fields, sentence))
    }

    fn never_commands(&self) -> Option<Conflict> {
        self.values.choice("target").filter(|target| *target != "none")?;
        let levels = ["priority.1", "priority.2", "priority.3"].map(|level| choice(self.get, level));
        let kind = self.mode.priority()?;
        (levels.iter().all(Option::is_some) && !levels.contains(&Some(kind))).then(|| {
            let sentence = ConflictMessage::NeverCommands { pin: self.name.clone(), kind };
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
    let (name, keys) = (pin.name.clone(), vec![key, pin.values.key("type")]);
    let sentence = match pin.holder() {
        _ if pin.mode == PinMode::None => ConflictMessage::EncoderMeasuresNothing { motor, pin: name },
        _ if pin.mode == PinMode::Digital => ConflictMessage::EncoderIsDigital { motor, pin: name },
        Some((port, _)) => ConflictMessage::EncoderHeld { motor, pin: name, port },
        None => return None,
    };
    Some(Conflict { kind: ConflictKind::EncoderUnread, keys, sentence: sentence.into() })
}

fn two_commanders(pins: &[Judged<'_>], motor: usize) -> Vec<Conflict> {
    let kinds = ["pulse", "analog"].into_iter();
    let of_kind = |kind: &str| -> Vec<&Judged<'_>> {
        pins.iter().filter(|pin| pin.commands(motor) == Some(kind)).collect()
    };
    let reported = |kind: &'static str| {
        let commanders = of_kind(kind);
        let [first, .., last] = commanders.as_slice() else { return None };
        let (first, last) = (first.name.clone(), last.name.clone());
        let sentence = ConflictMessage::TwoCommanders { first, last, motor, kind }.into();
        let keys = commanders.iter().rev().map(|pin| pin.values.key("target")).collect();
        Some(Conflict { kind: ConflictKind::TwoCommanders, keys, sentence })
    };
    kinds.filter_map(reported).collect()
}
