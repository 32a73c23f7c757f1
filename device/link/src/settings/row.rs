//! One setting of one controller: where it stands, what it may be, what it means.
//!
//! Rows are made by [`SettingsTable`](super::SettingsTable) from templates; this file is what everybody else
//! reads.

use brushwork_values::{Message, Unit};
use serde::{Serialize, Serializer};

use super::kind::{Coding, Kind};
use super::notation::Notation;
use super::value::{SettingValue, Signed};
use crate::messages::ValueMessage;

/// One setting of one controller.
#[derive(Clone, Debug)]
pub struct Row {
    /// Stable dotted name: "motor1.velocity.p", "pin.3.deadband".
    pub key: String,
    /// The key before its numbers are filled in: "motor{n}.velocity.p"; the same for all rows of a repeated
    /// group.
    pub pattern: &'static str,
    /// Name within its group: "Velocity P".
    pub label: &'static str,
    /// The part of the settings it belongs to.
    pub group: Group,
    /// Which motor, pin, stream or output it belongs to, if any.
    pub instance: Option<Instance>,
    /// What its value looks like.
    pub kind: Kind,
    /// The unit of its value.
    pub unit: Unit,
    /// How the value stands in its wire field.
    pub coding: Coding,
    /// The lowest and highest value allowed. Unbounded for yes or no and for choices, but for a choice that takes other numbers
    /// than those of its names.
    pub range: Range,
    /// The value after "restore defaults".
    pub default: SettingValue,
    /// Whether the default is our assumption rather than a statement of the manual.
    pub default_assumed: bool,
    /// The commands and fields that carry it, or why there are none.
    pub carrier: Carrier,
    /// Whether, and where, it may be written.
    pub access: Access,
    /// A sentence or two for a newcomer, with the manual section.
    pub help: &'static str,
    /// The printed name of the model the row was made for.
    pub model: &'static str,
    /// The number of the register that holds it, in a family whose settings are known by such numbers.
    pub register: Option<u8>,
}

/// A part of the settings: where it stands among the others, its name in files and its heading. Those here may be any family's; a family
/// adds one of its own by [`Group::new`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Group {
    order: u8,
    key: &'static str,
    label: &'static str,
}

impl Group {
    /// Address, mixing, E-Stop, PWM mode.
    pub const UNIT: Self = Self::new(10, "unit", "Unit settings");
    /// Battery voltage windows.
    pub const VOLTAGE_LIMITS: Self = Self::new(20, "voltage_limits", "Voltage limits");
    /// Current limits per motor.
    pub const CURRENT_LIMITS: Self = Self::new(30, "current_limits", "Current limits");
    /// Which input commands the motors.
    pub const PRIORITY_LEVELS: Self = Self::new(40, "priority_levels", "Priority levels");
    /// Running a script after power-up.
    pub const SCRIPTING: Self = Self::new(50, "scripting", "Scripting");
    /// Which pin is the encoder of a motor.
    pub const ENCODERS: Self = Self::new(60, "encoders", "Encoders");
    /// Inductance, resistance, acceleration and idle behaviour of a motor.
    pub const MOTOR: Self = Self::new(70, "motor", "Motor");
    /// Velocity gains and top speed.
    pub const VELOCITY: Self = Self::new(80, "velocity", "Velocity");
    /// Position gains and travel.
    pub const POSITION: Self = Self::new(90, "position", "Position");
    /// Speed and position error limits.
    pub const ERROR_LIMITS: Self = Self::new(100, "error_limits", "Error limits");
    /// Homing.
    pub const HOMING: Self = Self::new(110, "homing", "Homing");
    /// Input pins.
    pub const PINS: Self = Self::new(120, "pins", "Pins");
    /// Serial ports.
    pub const STREAMS: Self = Self::new(130, "streams", "Serial ports");
    /// CAN and I2C buses.
    pub const BUSES: Self = Self::new(140, "buses", "CAN and I2C");
    /// Digital outputs.
    pub const OUTPUTS: Self = Self::new(150, "outputs", "Digital outputs");

    /// A part with its place among the others, its name in files and its heading. Screens show the lower `order` first; those of this list end at 150.
    pub const fn new(order: u8, key: &'static str, label: &'static str) -> Self {
        Self { order, key, label }
    }

    /// The group's heading.
    pub const fn label(self) -> &'static str {
        self.label
    }
}

impl Serialize for Group {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.key)
    }
}

/// Which of several alike things a row belongs to.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Instance {
    /// Counted from 1; also the number in the key where the key has one.
    pub number: usize,
    /// What to call it: "Motor 1", "DIN3/AN3/P3", "TTL UART1", "DOUT2".
    pub name: String,
}

/// The lowest and highest value of a row, in its unit, both allowed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Range {
    /// Lowest value.
    pub min: f64,
    /// Highest value.
    pub max: f64,
    /// Where the bounds come from.
    pub bound: Bound,
}

/// Where the bounds of a range come from; refusals name it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Bound {
    /// The ratings of the connected model.
    Model,
    /// The manual, or the width of the wire field.
    Field,
    /// There are no bounds.
    Unbounded,
}

impl Range {
    /// No bounds: yes or no, and choices.
    pub const UNBOUNDED: Self = Self { min: f64::NEG_INFINITY, max: f64::INFINITY, bound: Bound::Unbounded };
}

/// What carries a setting between client and controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carrier {
    /// Commands of its family's protocol.
    Wire {
        /// Where it is read.
        read: Source,
        /// Where it is written.
        write: Option<Sink>,
    },
    /// Nothing public. A simulated controller still has it, under the row's key.
    NoWireForm {
        /// Why, as a sentence.
        reason: &'static str,
    },
}

/// Where a setting is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A field of a command's reply.
    Reply {
        /// Command number.
        command: u8,
        /// The field, or its bits.
        place: Place,
        /// Which record of a counted reply, from 0.
        record: Option<usize>,
    },
    /// The address the link speaks to; generation 1 has no command that returns it.
    LinkAddress,
}

/// Where a setting is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sink {
    /// Command number.
    pub command: u8,
    /// The field, or its bits.
    pub place: Place,
    /// The value of the request's first field when the command names a pin, stream or output by index.
    pub index: Option<u8>,
}

/// A field of a request or reply, by its name in the protocol table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Field name.
    pub field: &'static str,
    /// The bits of the field, when it shares the field with others.
    pub bits: Option<Bits>,
}

/// Some neighbouring bits of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bits {
    /// The lowest bit, from 0.
    pub shift: u8,
    /// How many bits.
    pub width: u8,
}

impl Bits {
    /// The bits' own number within `word`.
    pub fn extract(self, word: i64) -> i64 {
        (word >> self.shift) & self.low_mask()
    }

    /// `word` with these bits set to `value`.
    pub fn insert(self, word: i64, value: i64) -> i64 {
        (word & !(self.low_mask() << self.shift)) | ((value & self.low_mask()) << self.shift)
    }

    fn low_mask(self) -> i64 {
        (1 << self.width) - 1
    }
}

/// Whether a row may be written, and where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// On every controller that has the row.
    ReadWrite,
    /// Nowhere.
    ReadOnly {
        /// Why, as a sentence.
        reason: &'static str,
    },
    /// On simulated controllers only, since the wire form, or the meaning of its numbers, is a guess.
    SimulatedOnly {
        /// Why, as a sentence.
        reason: &'static str,
    },
}

impl Row {
    /// The row's full name: "Motor 1 velocity P", "DIN3/AN3/P3 deadband".
    pub fn title(&self) -> String {
        match &self.instance {
            Some(instance) => format!("{}: {}", instance.name, lower_first(self.label)),
            None => self.label.to_owned(),
        }
    }

    /// Why the row cannot be written on this controller; `None` when it can.
    pub fn locked(&self, simulated: bool) -> Option<&'static str> {
        match self.access {
            Access::ReadWrite => None,
            Access::SimulatedOnly { .. } if simulated => None,
            Access::ReadOnly { reason } | Access::SimulatedOnly { reason } => Some(reason),
        }
    }

    /// Whether a command carries the row.
    pub fn has_wire_form(&self) -> bool {
        matches!(self.carrier, Carrier::Wire { .. })
    }

    /// The command and field that write the row, if any.
    pub fn sink(&self) -> Option<Sink> {
        match self.carrier {
            Carrier::Wire { write, .. } => write,
            Carrier::NoWireForm { .. } => None,
        }
    }

    /// The value as text with its unit: "24.0 V".
    pub fn format(&self, value: SettingValue) -> String {
        self.notation().format(value)
    }

    /// The value as text without its unit: "24.0".
    pub fn format_bare(&self, value: SettingValue) -> String {
        self.notation().format_bare(value)
    }

    /// The value that `text` stands for, rounded to the row's step. Refuses, in a sentence, what is no such
    /// value or out of range.
    pub fn parse(&self, text: &str) -> Result<SettingValue, Message> {
        let value = self.parse_any(text).map_err(|why| ValueMessage::OfRow { title: self.title(), why })?;
        self.check(value)?;
        Ok(value)
    }

    /// As [`Row::parse`], in range or not, for what a controller may hold.
    pub fn parse_any(&self, text: &str) -> Result<SettingValue, Message> {
        self.notation().parse(text)
    }

    /// Refuses, in a sentence, a value of another kind or outside the row's range.
    pub fn check(&self, value: SettingValue) -> Result<(), Message> {
        let title = self.title();
        if let SettingValue::UnknownCode(raw) = value {
            if self.takes_number(raw) {
                return Ok(());
            }
            return Err(ValueMessage::UnknownCode { title, raw }.into());
        }
        if self.coding.encode(self.kind, value).is_none() {
            let (value, kind) = (self.format(value), self.kind.name());
            return Err(ValueMessage::OtherKind { title, value, kind }.into());
        }
        let Some((side, bound)) = self.crossed_bound(value) else { return Ok(()) };
        let (value, bound, model) = (self.format(value), self.format(self.numeric(bound)), self.model);
        Err(match (self.range.bound, side) {
            (Bound::Model, Side::Above) => ValueMessage::AboveModel { title, value, model, bound },
            (Bound::Model, Side::Below) => ValueMessage::BelowModel { title, value, model, bound },
            (_, Side::Above) => ValueMessage::AboveHighest { title, value, bound },
            (_, Side::Below) => ValueMessage::BelowLowest { title, value, bound },
        }
        .into())
    }

    /// Whether a number that none of its names stands for may be chosen.
    fn takes_number(&self, raw: i64) -> bool {
        self.notation().is_open && (self.range.min..=self.range.max).contains(&(raw as f64))
    }

    /// What to know before a value that a unit held once is written as it was: that it is out of range, or a number without a
    /// name. Refuses, in a sentence, what no unit can hold in this row.
    pub fn check_as_read(&self, value: SettingValue) -> Result<Option<Message>, Message> {
        let Err(why) = self.check(value) else { return Ok(None) };
        match (self.encode(value), value) {
            (None, _) => Err(why),
            (Some(_), SettingValue::UnknownCode(raw)) => {
                Ok(Some(ValueMessage::UnknownCodeAsRead { title: self.title(), raw }.into()))
            }
            (Some(_), _) => Ok(Some(ValueMessage::AsRead { why }.into())),
        }
    }

    /// The value rounded to the row's step and moved into its range, with a sentence for each thing that had
    /// to change. A value of another kind becomes the default.
    pub fn repair(&self, value: SettingValue) -> (SettingValue, Option<Message>) {
        match self.check(value) {
            Ok(()) => (self.settle(value), None),
            Err(why) => {
                let repaired = match self.crossed_bound(value) {
                    Some((_, bound)) => self.numeric(bound),
                    None => self.default,
                };
                (repaired, Some(ValueMessage::Repaired { why, value: self.format(repaired) }.into()))
            }
        }
    }

    /// The value rounded to the row's step.
    pub fn settle(&self, value: SettingValue) -> SettingValue {
        match (value, self.coding.encode(self.kind, value)) {
            (SettingValue::Signed(_), Some(_)) | (_, None) => value,
            (_, Some(raw)) => self.coding.decode(self.kind, raw),
        }
    }

    /// What stands in the row's register, no bit of it lost.
    pub fn decode(&self, raw: i64) -> SettingValue {
        self.coding.decode_register(self.kind, raw)
    }

    /// The number by which a value is written; `None` when it is of another kind.
    pub fn encode(&self, value: SettingValue) -> Option<i64> {
        self.coding.encode(self.kind, value)
    }

    /// The number that stood in the register where the value was read from one, else that by which it is written.
    pub fn register_of(&self, value: SettingValue) -> Option<i64> {
        match value {
            SettingValue::Signed(signed) => Some(signed.raw),
            SettingValue::Bool(_)
            | SettingValue::Int(_)
            | SettingValue::Number(_)
            | SettingValue::Choice(_)
            | SettingValue::UnknownCode(_) => self.encode(value),
        }
    }

    /// Two values as texts with their units, "-" for none; with their registers where those alone differ.
    pub fn format_both(&self, values: [Option<SettingValue>; 2]) -> [String; 2] {
        let texts = values.map(|value| value.map_or_else(|| "-".to_owned(), |value| self.format(value)));
        match values {
            [Some(left), Some(right)] if left != right && texts[0] == texts[1] => {
                [left, right].map(|value| match self.register_of(value) {
                    Some(raw) => format!("{} (register {raw})", self.format(value)),
                    None => self.format(value),
                })
            }
            _ => texts,
        }
    }

    /// The row's range as text: "10.0 V to 60.0 V"; empty for yes or no and for choices.
    pub fn range_text(&self) -> String {
        if self.range.bound == Bound::Unbounded || self.notation().is_open {
            return String::new();
        }
        let (min, max) = (self.numeric(self.range.min), self.numeric(self.range.max));
        format!("{} to {}", self.format(min), self.format(max))
    }

    pub(super) fn notation(&self) -> Notation {
        let is_open = matches!(self.kind, Kind::Choice(_)) && self.range.bound != Bound::Unbounded;
        Notation { kind: self.kind, coding: self.coding, unit: self.unit, is_open }
    }

    fn crossed_bound(&self, value: SettingValue) -> Option<(Side, f64)> {
        let number = match (self.kind, value) {
            (Kind::Int, SettingValue::Int(number)) => number as f64,
            // Compared by step, so that a bound written as 60.0 and a reading of 60.00 agree.
            (
                Kind::Fixed { .. },
                SettingValue::Number(number) | SettingValue::Signed(Signed { number, .. }),
            ) => self.coding.to_physical(self.coding.to_raw(number)),
            _ => return None,
        };
        if number > self.range.max {
            Some((Side::Above, self.range.max))
        } else if number < self.range.min {
            Some((Side::Below, self.range.min))
        } else {
            None
        }
    }

    fn numeric(&self, number: f64) -> SettingValue {
        match self.kind {
            Kind::Int => SettingValue::Int(number as i64),
            Kind::Bool | Kind::Fixed { .. } | Kind::Choice(_) => self.settle(SettingValue::Number(number)),
        }
    }
}

#[derive(Clone, Copy)]
enum Side {
    Above,
    Below,
}

/// "Velocity P" within a sentence; "QPPS" and "L" keep their capitals.
fn lower_first(label: &str) -> String {
    let mut letters = label.chars();
    match (letters.next(), letters.next()) {
        (Some(first), Some(second)) if second.is_lowercase() => {
            first.to_lowercase().chain(label.chars().skip(1)).collect()
        }
        _ => label.to_owned(),
    }
}
