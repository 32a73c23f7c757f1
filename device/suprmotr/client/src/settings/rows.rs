//! The rows: what UD stores, and the address.

use crate::controller::values::{FOLLOWING_ERROR, SWITCHES};
use crate::family::NAME;
use brushwork_link::settings::{
    Access, Bits, Bound, Carrier, Coding, Group, Kind, Place, Range, Row, SettingValue, Sink, Source,
};
use brushwork_suprmotr_wire::Mnemonic;
use brushwork_values::Unit;

const MOTION: Group = Group::new(85, "motion", "Motion");
const LOOP: Group = Group::new(170, "loop", "PID");
const LINE: Group = Group::new(135, "line", "Serial line");

/// The key of the address.
pub const ADDRESS: &str = "unit.address";
/// The key of the limit of the following error.
pub const FOLLOWING_ERROR_KEY: &str = "limits.following_error";
/// The keys of the limit switches.
pub const LIMITS_ON: &str = "limits.enabled";
pub const LIMITS_HIGH: &str = "limits.active_high";

/// A setting that is a number.
struct Shown {
    key: &'static str,
    label: &'static str,
    group: Group,
    write: Mnemonic,
    /// The command that tells it; `None` for what nothing tells.
    read: Option<Mnemonic>,
    /// The factory's value (SuprMotr manual, "Factory Settings").
    factory: i64,
    help: &'static str,
}

macro_rules! shown {
    ($($key:literal $label:literal $group:expr, $write:ident $read:expr, $factory:literal, $help:literal;)*) => {
        static SHOWN: &[Shown] = &[$(Shown {
            key: $key, label: $label, group: $group, write: Mnemonic::$write, read: $read, factory: $factory, help: $help,
        }),*];
    };
}

shown! {
    "unit.address" "Address" Group::UNIT, DB Some(Mnemonic::TB), 0,
        "What the unit is selected by, 0 to 15, on the wire 0 to F; kept in EEPROM at once. SuprMotr manual, Address Selection.";
    "motion.velocity" "Velocity" MOTION, DV Some(Mnemonic::GV), 20_000,
        "The greatest velocity of a move. SuprMotr manual, Define Velocity.";
    "motion.acceleration" "Acceleration" MOTION, DA Some(Mnemonic::GA), 200_000,
        "How fast a move gathers and loses velocity. SuprMotr manual, Define Acceleration.";
    "limits.following_error" "Following error limit" Group::ERROR_LIMITS, SM None, 10_000,
        "The most that the position may lag behind the trajectory. No command tells it: it is known once it was set here. SuprMotr manual, Set Maximum Following Error.";
    "loop.p" "P" LOOP, DP Some(Mnemonic::GP), 75,
        "Proportional gain: drive for the distance from the trajectory. SuprMotr manual, Define P-Term.";
    "loop.i" "I" LOOP, DI Some(Mnemonic::GI), 0,
        "Integral gain, which overcomes friction; without effect while the integral limit is 0. SuprMotr manual, Define I-Term.";
    "loop.d" "D" LOOP, DD Some(Mnemonic::GD), 0,
        "Derivative gain: drive against a change of the error. SuprMotr manual, Command Short Form.";
    "loop.integral_limit" "Integral limit" LOOP, DL Some(Mnemonic::GL), 100,
        "The most that the integral term can come to; 0 switches it off. SuprMotr manual, Define Integral Limit.";
}

/// A setting of two values.
struct Shift {
    key: &'static str,
    label: &'static str,
    group: Group,
    factory: bool,
    help: &'static str,
}

/// In the order of [`SWITCHES`].
static SHIFTS: [Shift; 3] = [
    Shift {
        key: LIMITS_ON,
        label: "Limit switches",
        group: Group::HOMING,
        factory: true,
        help: "A limit switch that is on stops the motor in its direction. SuprMotr manual, LN and LF.",
    },
    Shift {
        key: LIMITS_HIGH,
        label: "Limit switches active high",
        group: Group::HOMING,
        factory: false,
        help: "A limit switch is on while its input is high, else while it is low. SuprMotr manual, LH and LL.",
    },
    Shift {
        key: "line.echo",
        label: "Echo",
        group: LINE,
        factory: true,
        help: "Every received character comes back. SuprMotr manual, EN and EF.",
    },
];

/// Every row, in screen order.
pub fn rows() -> Vec<Row> {
    let switches = SHIFTS.iter().zip(&SWITCHES).map(|(shift, switch)| {
        let (field, mask) = switch.told_by;
        let bits = u8::try_from(mask.trailing_zeros()).ok().map(|shift| Bits { shift, width: 1 });
        row(
            (shift.key, shift.label, shift.group, shift.help),
            (Kind::Bool, Unit::None, Range::UNBOUNDED, SettingValue::Bool(shift.factory)),
            Source::Reply { command: Mnemonic::TS.number(), place: Place { field, bits }, record: None },
            Sink { command: switch.number, place: Place { field: switch.name, bits: None }, index: None },
        )
    });
    let mut rows: Vec<Row> = SHOWN.iter().filter_map(numbered).chain(switches).collect();
    rows.sort_by_key(|row| row.group);
    rows
}

fn numbered(shown: &Shown) -> Option<Row> {
    let takes = shown.write.row().takes?;
    let range = Range { min: takes.low.into(), max: takes.high.into(), bound: Bound::Field };
    let (command, field) = match shown.read {
        Some(read) => (read.number(), read.name()),
        None => (FOLLOWING_ERROR, shown.write.name()),
    };
    Some(row(
        (shown.key, shown.label, shown.group, shown.help),
        (Kind::Int, takes.unit, range, SettingValue::Int(shown.factory)),
        Source::Reply { command, place: Place { field, bits: None }, record: None },
        Sink { command: shown.write.number(), place: Place { field: takes.name, bits: None }, index: None },
    ))
}

fn row(
    (key, label, group, help): (&'static str, &'static str, Group, &'static str),
    (kind, unit, range, default): (Kind, Unit, Range, SettingValue),
    read: Source,
    write: Sink,
) -> Row {
    Row {
        key: key.to_owned(),
        pattern: key,
        label,
        group,
        instance: None,
        kind,
        unit,
        coding: Coding::Plain,
        range,
        default,
        default_assumed: key == ADDRESS,
        carrier: Carrier::Wire { read, write: Some(write) },
        access: Access::ReadWrite,
        help,
        model: NAME,
        register: None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::values::command_of;
    use brushwork_suprmotr_wire::{COMMANDS, Effect};

    #[test]
    fn every_parameter_of_the_manual_is_a_row_or_has_a_reason() {
        // Written under another name, or not a setting that a program changes: numbers are read as they come.
        let others = ["SV", "SA", "DM", "HM"];
        let rows = rows();
        let written: Vec<_> = rows
            .iter()
            .flat_map(|row| {
                let sink = row.sink().unwrap();
                [0, 1]
                    .into_iter()
                    .filter_map(move |value| command_of(sink.command, &[value]))
                    .map(|command| command.mnemonic.name())
            })
            .collect();
        for command in COMMANDS.iter().filter(|row| row.effect == Effect::Setting) {
            assert!(written.contains(&command.name) || others.contains(&command.name), "{}", command.name);
        }
    }

    #[test]
    fn every_factory_value_is_that_of_the_manual_and_within_its_range() {
        let rows = rows();
        let factory = |key: &str| {
            let row = rows.iter().find(|row| row.key == key).unwrap();
            row.encode(row.default).unwrap()
        };
        let numbers = [
            "motion.velocity",
            "motion.acceleration",
            "loop.p",
            "loop.i",
            "loop.d",
            "loop.integral_limit",
            FOLLOWING_ERROR_KEY,
        ];
        assert_eq!(numbers.map(factory), [20_000, 200_000, 75, 0, 0, 100, 10_000]);
        assert_eq!([LIMITS_ON, LIMITS_HIGH, "line.echo"].map(factory), [1, 0, 1], "LN, LL and EN");
        let mut keys: Vec<_> = rows.iter().map(|row| &row.key).collect();
        keys.sort();
        keys.dedup();
        assert_eq!(keys.len(), rows.len());
    }
}
