//! The rows: what ConfigStepper sets.

use crate::controller::values::{CONFIGURATION, CONFIGURE, STEPPER_FIELDS};
use crate::family::NAME;
use brushwork_link::settings::{
    Access, Bound, Carrier, Coding, Group, Kind, Place, Range, Row, SettingValue, Sink, Source,
};
use brushwork_motorvator_wire::host::STEPPER_DEFAULT;
use brushwork_values::Unit;

const STEPPER: Group = Group::new(140, "stepper", "Stepper");

/// The keys, in the order of ConfigStepper.
pub const KEYS: [&str; 3] = ["stepper.min_wait", "stepper.max_wait", "stepper.hold_current"];
/// A hold current above this warms a motor.
pub const WARM_PERCENT: i64 = 50;

/// Label, unit, lowest and highest value, default and help of each.
type Shown = (&'static str, Unit, [f64; 2], i64, &'static str);

/// Every row, in screen order.
pub fn rows() -> Vec<Row> {
    let shown: [Shown; 3] = [
        (
            "MinWait",
            Unit::None,
            [1.0, 255.0],
            STEPPER_DEFAULT.least.into(),
            "Wait between steps at the highest speed, in 1/1024 s (the unit is assumed). As small as loses no steps. MotorVator manual, ConfigStepper.",
        ),
        (
            "MaxWait",
            Unit::None,
            [1.0, 255.0],
            STEPPER_DEFAULT.most.into(),
            "Wait between steps when a move begins and ends, in 1/1024 s (the unit is assumed). As small as loses no steps. MotorVator manual, ConfigStepper.",
        ),
        (
            "HoldCurrent",
            Unit::Percent,
            [0.0, 100.0],
            STEPPER_DEFAULT.hold_percent.into(),
            "Part of full power that holds the stepper while it stands. MotorVator manual, ConfigStepper.",
        ),
    ];
    KEYS.iter()
        .zip(&STEPPER_FIELDS)
        .zip(shown)
        .map(|((key, field), shown)| row(key, field.name, shown))
        .collect()
}

fn row(key: &'static str, field: &'static str, (label, unit, [min, max], default, help): Shown) -> Row {
    let place = Place { field, bits: None };
    Row {
        key: key.to_owned(),
        pattern: key,
        label,
        group: STEPPER,
        instance: None,
        kind: Kind::Int,
        unit,
        coding: Coding::Plain,
        range: Range { min, max, bound: Bound::Field },
        default: SettingValue::Int(default),
        default_assumed: true,
        carrier: Carrier::Wire {
            read: Source::Reply { command: CONFIGURATION, place, record: None },
            write: Some(Sink { command: CONFIGURE, place, index: None }),
        },
        access: Access::ReadWrite,
        help,
        model: NAME,
        register: None,
    }
}
