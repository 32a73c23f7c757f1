//! Orders by the number of their letter and answers as named values: the words in which settings and shared code speak of any family.

use crate::family::Half;
use brushwork_motorvator_wire::host::{Direction, HostAnswer, HostOrder, StepperConfig};
use brushwork_values::{Field, Kind, Value, Values};

/// How a stepper is configured, in the order of ConfigStepper.
pub static STEPPER_FIELDS: [Field; 3] = [
    Field::new("min_wait", Kind::U8, "wait between steps at the highest speed"),
    Field::new("max_wait", Kind::U8, "wait between steps at the lowest speed"),
    Field::new("hold_current", Kind::U8, "percent of full power that holds a stepper at rest"),
];

static SPEED_FIELDS: [Field; 5] = [
    Field::new("motor_a", Kind::I16, "motor A, percent"),
    Field::new("motor_b", Kind::I16, "motor B, percent"),
    Field::new("motor_c", Kind::I16, "motor C, percent"),
    Field::new("motor_d", Kind::I16, "motor D, percent"),
    Field::new("flags", Kind::U8, "what the library tells besides"),
];

static DISPLAY_FIELDS: [Field; 3] = [
    Field::new("left", Kind::U8, "the left character of the display"),
    Field::new("right", Kind::U8, "the right character of the display"),
    Field::new("inputs_changed", Kind::U8, "on/off inputs that have changed, input 1 in bit 0"),
];

static OTHER_FIELDS: [Field; 4] = [
    Field::new("value_1", Kind::U8, "first value"),
    Field::new("value_2", Kind::U8, "second value"),
    Field::new("value_3", Kind::U8, "third value"),
    Field::new("value_4", Kind::U8, "fourth value"),
];

/// Tells how the stepper of the half is configured.
pub const CONFIGURATION: u8 = b'Q';
/// Configures it.
pub const CONFIGURE: u8 = b'C';

/// The order of a number with its values. Those that configure a stepper are for that of the half, those that drive name motor or stepper.
pub fn order_of(half: Half, number: u8, values: &[i64]) -> Option<HostOrder> {
    let byte = |value: &i64| u8::try_from(*value).ok();
    let direction = |value: &i64| if *value < 0 { Direction::Backward } else { Direction::Forward };
    Some(match (number, values) {
        (b'P', []) => HostOrder::Ping,
        (b'S', []) => HostOrder::State,
        (b'X', []) => HostOrder::Stop,
        (b'M', [motor, percent]) => HostOrder::Motor {
            motor: byte(motor).filter(|motor| (1..=4).contains(motor))?,
            direction: direction(percent),
            percent: u8::try_from(percent.unsigned_abs()).ok().filter(|percent| *percent <= 100)?,
        },
        (b'T', [steps]) => HostOrder::Steps {
            stepper: half.number(),
            direction: direction(steps),
            steps: u16::try_from(steps.unsigned_abs()).ok()?,
        },
        (b'V', [servo, angle]) => HostOrder::Servo {
            servo: byte(servo).filter(|servo| (1..=2).contains(servo))?,
            direction: direction(angle),
            angle: u8::try_from(angle.unsigned_abs()).ok()?,
        },
        (CONFIGURE, [least, most, hold]) => {
            let config = StepperConfig {
                least: byte(least).filter(|wait| *wait > 0)?,
                most: byte(most).filter(|wait| *wait > 0)?,
                hold_percent: byte(hold).filter(|percent| *percent <= 100)?,
            };
            HostOrder::Configure(half.number(), config)
        }
        (CONFIGURATION, []) => HostOrder::Configuration(half.number()),
        (b'D', []) => HostOrder::Display([0; 2]),
        (b'D', [left, right]) => HostOrder::Display([byte(left)?, byte(right)?]),
        (b'A', [first]) => HostOrder::Analog(byte(first)?),
        _ => return None,
    })
}

/// The numbers of an answer by name.
pub fn values_of(answer: &HostAnswer) -> Values {
    let of = |fields: &'static [Field], values: Vec<i64>| {
        Values::new(fields, values.into_iter().map(Value::Int).collect())
    };
    if let Some(speeds) = answer.speeds() {
        let speeds = speeds.iter().map(|speed| i64::from(*speed));
        return of(&SPEED_FIELDS, speeds.chain([i64::from(answer.flags)]).collect());
    }
    if let Some((_, StepperConfig { least, most, hold_percent })) = answer.stepper() {
        return of(&STEPPER_FIELDS, [least, most, hold_percent].map(i64::from).to_vec());
    }
    if let Some(([left, right], changed)) = answer.display() {
        return of(&DISPLAY_FIELDS, [left, right, changed].map(i64::from).to_vec());
    }
    of(&OTHER_FIELDS, answer.values.map(i64::from).to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_stands_for_its_order_with_values_that_it_takes() {
        let order = |number, values: &[i64]| order_of(Half::Second, number, values);
        let config = StepperConfig { least: 5, most: 9, hold_percent: 40 };
        assert_eq!(order(CONFIGURE, &[5, 9, 40]), Some(HostOrder::Configure(2, config)));
        assert_eq!(
            order(b'T', &[-300]),
            Some(HostOrder::Steps { stepper: 2, direction: Direction::Backward, steps: 300 })
        );
        for (number, values) in [
            (CONFIGURE, &[0, 9, 40][..]),
            (CONFIGURE, &[5, 9, 101]),
            (b'M', &[5, 10]),
            (b'T', &[70_000]),
            (b'Z', &[]),
        ] {
            assert_eq!(order(number, values), None, "{number} {values:?}");
        }
    }

    #[test]
    fn what_an_answer_says_has_names() {
        let values = |line: &[u8]| values_of(&HostAnswer::parse(line).unwrap());
        assert_eq!(values(b"073082081001002005009040000").try_int("max_wait"), Some(9));
        assert_eq!(values(b"073082083001060000228000000").try_int("motor_c"), Some(-100));
        assert_eq!(values(b"073082068001072050004000000").try_int("inputs_changed"), Some(4));
        assert_eq!(values(b"073082065001007008009010000").try_int("value_2"), Some(8));
    }
}
