//! The settings of a Motion Mind: its writable registers, with the bits of FUNCTION and FUNCTION2 as rows of their own.
//!
//! Ranges, defaults and widths are those of the protocol's register table. POSITION can be written too and is no setting: it is where
//! the motor is. What is measured is no setting either.

use crate::family::NAME;
use brushwork_motion_mind_wire::{
    Bit, FUNCTION_BITS, FUNCTION2_BITS, Register, numbers, register, register_number as number,
};
use brushwork_values::Unit;

use brushwork_link::settings::SettingValue;
use brushwork_link::settings::{Access, Bits, Bound, Carrier, Group, Place, Range, Row, Sink, Source};
use brushwork_link::settings::{Coding, Kind};

/// How one register is shown.
struct Shown {
    register: u8,
    key: &'static str,
    label: &'static str,
    group: Group,
    form: Form,
    help: &'static str,
}

const LOOP: Group = Group::new(170, "loop", "PID");
const FUNCTIONS: Group = Group::new(180, "functions", "FUNCTION");
const FUNCTIONS_2: Group = Group::new(190, "functions2", "FUNCTION2");

/// What its number looks like.
#[derive(Clone, Copy)]
enum Form {
    /// As it stands in the register.
    Raw(Unit),
    /// In a unit, with so many decimals.
    Scaled(Unit, usize),
}

const COUNTS: Form = Form::Raw(Unit::Counts);
const PLAIN: Form = Form::Raw(Unit::None);
const MILLISECONDS: Form = Form::Scaled(Unit::Milliseconds, 3);

macro_rules! shown {
    ($($number:ident $key:literal $label:literal $group:expr, $form:expr; $help:literal;)*) => {
        static SHOWN: &[Shown] = &[$(Shown {
            register: number::$number, key: $key, label: $label, group: $group, form: $form, help: $help,
        }),*];
    };
}

shown! {
    ADDRESS "register.address" "Address" Group::UNIT, PLAIN;
        "What the unit answers to, 1 to 98, when several share a bus. From 99 on it hears all and never \
         answers. Motion Mind manual 6.2, register 7.";
    AMPSLIMIT "register.ampslimit" "Current limit" Group::CURRENT_LIMITS, Form::Scaled(Unit::Amps, 2);
        "Above this current the drive is reduced by the excess; 0 switches the limit off. Motion Mind \
         manual 3.10, register 28.";
    PWMLIMIT "register.pwmlimit" "Drive limit" Group::CURRENT_LIMITS, Form::Scaled(Unit::Percent, 1);
        "The most drive that the motor gets in either direction. Motion Mind manual 3.10, register 25.";
    VELOCITYLIMIT "register.velocitylimit" "Velocity limit" Group::VELOCITY, PLAIN;
        "Modes 0 to 3: the most by which the drive (of 1023) changes in one TIMER. Mode 4 with VELLIMIT: \
         the speed of moves in counts per PID loop of 5 ms. Motion Mind manual 6.2, register 1.";
    TIMER "register.timer" "Timer" Group::VELOCITY, Form::Scaled(Unit::Seconds, 3);
        "Time between two changes of the drive in the open-loop modes, and how long a button or limit input \
         must be steady. Motion Mind manual 6.2, register 9.";
    VELOCITYFF "register.velocityff" "Velocity feed-forward" Group::VELOCITY, PLAIN;
        "This over 255, times the commanded velocity in counts per loop, is added to the drive (of 1023). \
         Motion Mind manual 3.15, register 2.";
    PTERM "register.pterm" "P" LOOP, PLAIN;
        "Proportional gain of the PID. Motion Mind manual 3.13, register 4.";
    ITERM "register.iterm" "I" LOOP, PLAIN;
        "Integral gain of the PID, for the sum of errors of all loops. Motion Mind manual 3.13, register \
         5.";
    DTERM "register.dterm" "D" LOOP, PLAIN;
        "Derivative gain of the PID, for the change of the error in one loop. Motion Mind manual 3.13, \
         register 6.";
    PIDSCALAR "register.pidscalar" "PID scalar" LOOP, PLAIN;
        "The sum of the three terms is divided by 2 to this power: one more halves all gains. Motion Mind \
         manual 3.13, register 8.";
    DEADBAND "register.deadband" "Dead band" LOOP, PLAIN;
        "With ENABLEDB: no drive within so many counts of the setpoint. Mode 1: steps of 4.88 mV around 2.5 \
         V that stop the motor. Motion Mind manual 6.2, register 26.";
    VNLIMIT "register.vnlimit" "Negative virtual limit" Group::POSITION, COUNTS;
        "With VIRTLIMIT: at this position the motor stops on its way down. Motion Mind manual 6.2, register \
         23.";
    VPLIMIT "register.vplimit" "Positive virtual limit" Group::POSITION, COUNTS;
        "With VIRTLIMIT: at this position the motor stops on its way up. Motion Mind manual 6.2, register \
         24.";
    RCMAX "register.rcmax" "R/C maximum" Group::PINS, MILLISECONDS;
        "Width of the pulse that is full speed forward. Motion Mind manual 4.3, register 10.";
    RCMIN "register.rcmin" "R/C minimum" Group::PINS, MILLISECONDS;
        "Width of the pulse that is full speed reverse. Motion Mind manual 4.3, register 11.";
    RCBAND "register.rcband" "R/C dead band" Group::PINS, MILLISECONDS;
        "Pulses this near to 1.5 ms stop the motor. Motion Mind manual 4.3, register 12.";
}

/// Every row, in screen order.
pub fn rows() -> Vec<Row> {
    let registers = SHOWN.iter().filter_map(row_of);
    let function = bit_rows(number::FUNCTION, "function.{bit}", FUNCTIONS, FUNCTION_BITS);
    let function2 = bit_rows(number::FUNCTION2, "function2.{bit}", FUNCTIONS_2, FUNCTION2_BITS);
    let mut rows: Vec<Row> = registers.chain(function).chain(function2).chain(unused_bits()).collect();
    rows.sort_by_key(|row| row.group);
    rows
}

fn row_of(shown: &Shown) -> Option<Row> {
    let register = register(shown.register)?;
    let (kind, unit, coding) = match shown.form {
        Form::Raw(unit) => (Kind::Int, unit, Coding::Plain),
        Form::Scaled(unit, decimals) => {
            (Kind::Fixed { decimals }, unit, Coding::PerUnit(1.0 / register.scale))
        }
    };
    let physical = |raw: i64| coding.to_physical(raw);
    let (mut min, max) = (*register.range.start(), *register.range.end());
    // From 99 on nobody answers, and 0 is no address that text and scans have.
    let max = if shown.register == number::ADDRESS { 98 } else { max };
    min = if shown.register == number::ADDRESS { 1 } else { min };
    Some(Row {
        key: shown.key.to_owned(),
        pattern: shown.key,
        label: shown.label,
        group: shown.group,
        instance: None,
        kind,
        unit,
        coding,
        range: Range { min: physical(min), max: physical(max), bound: Bound::Field },
        default: coding.decode(kind, register.default.unwrap_or_default()),
        default_assumed: false,
        carrier: carrier(register, None),
        access: Access::ReadWrite,
        help: shown.help,
        model: NAME,
        register: Some(register.number),
    })
}

fn bit_rows(
    number: u8,
    pattern: &'static str,
    group: Group,
    bits: &'static [Bit],
) -> impl Iterator<Item = Row> {
    bits.iter().filter_map(move |bit| {
        let register = register(number)?;
        Some(Row {
            key: pattern.replace("{bit}", &key_of(bit)),
            pattern,
            label: bit.name,
            group,
            instance: None,
            kind: Kind::Bool,
            unit: Unit::None,
            coding: Coding::Plain,
            range: Range::UNBOUNDED,
            default: SettingValue::Bool(false),
            default_assumed: false,
            carrier: carrier(register, Some(Bits { shift: bit.number, width: 1 })),
            access: Access::ReadWrite,
            help: bit.set_means,
            model: NAME,
            register: Some(register.number),
        })
    })
}

/// "posprwup", "rcpos_encfdbck", "freq_2".
fn key_of(bit: &Bit) -> String {
    bit.name.to_ascii_lowercase().replace(['/', '-'], "_")
}

/// Bits 14 and 15 of FUNCTION2 mean nothing. As a row they are kept as they are when others change.
fn unused_bits() -> Option<Row> {
    let register = register(number::FUNCTION2)?;
    Some(Row {
        key: "function2.unused".to_owned(),
        pattern: "function2.unused",
        label: "Unused bits",
        group: FUNCTIONS_2,
        instance: None,
        kind: Kind::Int,
        unit: Unit::None,
        coding: Coding::Plain,
        range: Range { min: 0.0, max: 3.0, bound: Bound::Field },
        default: SettingValue::Int(0),
        default_assumed: false,
        carrier: carrier(register, Some(Bits { shift: 14, width: 2 })),
        access: Access::ReadWrite,
        help: "Bits 14 and 15 of FUNCTION2, to which the manual gives no meaning.",
        model: NAME,
        register: Some(register.number),
    })
}

fn carrier(register: &'static Register, bits: Option<Bits>) -> Carrier {
    let place = Place { field: register.name, bits };
    Carrier::Wire {
        read: Source::Reply { command: numbers::READ, place, record: None },
        write: Some(Sink { command: numbers::WRITE, place, index: Some(register.number) }),
    }
}

#[cfg(test)]
mod tests {
    use super::super::register_of;
    use super::*;
    use brushwork_motion_mind_wire::REGISTERS;

    #[test]
    fn every_writable_register_is_a_row_or_has_a_reason_and_every_bit_is_one() {
        let rows = rows();
        for register in REGISTERS.iter().filter(|register| register.is_writable()) {
            let of_it: Vec<_> = rows
                .iter()
                .filter(|row| register_of(row).is_some_and(|found| found.number == register.number))
                .collect();
            let expected = match register.name {
                "FUNCTION" => FUNCTION_BITS.len(),
                "FUNCTION2" => FUNCTION2_BITS.len() + 1,
                "POSITION" => 0,
                _ => 1,
            };
            assert_eq!(of_it.len(), expected, "{}", register.name);
        }
        let bits: u32 = rows
            .iter()
            .filter(|row| register_of(row).is_some_and(|register| register.number == number::FUNCTION2))
            .filter_map(|row| row.sink()?.place.bits)
            .fold(0, |all, bits| all | ((1 << bits.width) - 1) << bits.shift);
        assert_eq!(bits, 0xFFFF, "no bit of FUNCTION2 is lost when another is written");
    }

    #[test]
    fn every_default_comes_back_as_its_raw_value_and_keys_are_their_own() {
        let rows = rows();
        for row in &rows {
            let register = register_of(row).unwrap();
            if row.sink().unwrap().place.bits.is_none() {
                assert_eq!(row.encode(row.default), register.default, "{}", row.key);
                for raw in [*register.range.start(), *register.range.end()] {
                    assert_eq!(row.encode(row.decode(raw)), Some(raw), "{}", row.key);
                }
            }
        }
        let mut keys: Vec<_> = rows.iter().map(|row| &row.key).collect();
        keys.sort();
        keys.dedup();
        assert_eq!(keys.len(), rows.len());
    }
}
