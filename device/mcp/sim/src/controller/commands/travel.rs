//! Distances and positions: commands 41 to 46, 51, 65 to 67, 119 to 127.

use super::super::answer::{Answer, Arguments, Handlers};
use super::super::firmware::Firmware;
use crate::motion::{Buffering, DistanceMove, MotionCommand, PositionMove, PositionTarget};
use brushwork_mcp_wire::packet_serial::number;
use brushwork_values::Motor::{M1, M2};

pub(super) const HANDLERS: Handlers = &[
    (number::SPEED_DISTANCE_M1, |unit, args| unit.drive(M1, distance(args, "", None))),
    (number::SPEED_DISTANCE_M2, |unit, args| unit.drive(M2, distance(args, "", None))),
    (number::SPEED_DISTANCE_BOTH, |unit, args| distances(unit, args, [None, None])),
    (number::SPEED_ACCEL_DISTANCE_M1, |unit, args| unit.drive(M1, distance(args, "", Some("accel")))),
    (number::SPEED_ACCEL_DISTANCE_M2, |unit, args| unit.drive(M2, distance(args, "", Some("accel")))),
    (number::SPEED_ACCEL_DISTANCE_BOTH, |unit, args| distances(unit, args, [Some("accel"), Some("accel")])),
    (number::SPEED_ACCEL_DISTANCE_EACH, |unit, args| {
        distances(unit, args, [Some("accel_m1"), Some("accel_m2")])
    }),
    (number::POSITION_PROFILE_M1, |unit, args| unit.drive(M1, position(args, "", Ramps::Profile))),
    (number::POSITION_PROFILE_M2, |unit, args| unit.drive(M2, position(args, "", Ramps::Profile))),
    (number::POSITION_PROFILE_BOTH, |unit, args| positions(unit, args, Ramps::Profile)),
    (number::POSITION_M1, |unit, args| unit.drive(M1, position(args, "", Ramps::None))),
    (number::POSITION_M2, |unit, args| unit.drive(M2, position(args, "", Ramps::None))),
    (number::POSITION_BOTH, |unit, args| positions(unit, args, Ramps::None)),
    (number::SPEED_POSITION_M1, |unit, args| unit.drive(M1, position(args, "", Ramps::Speed))),
    (number::SPEED_POSITION_M2, |unit, args| unit.drive(M2, position(args, "", Ramps::Speed))),
    (number::SPEED_POSITION_BOTH, |unit, args| positions(unit, args, Ramps::Speed)),
    (number::PERCENT_POSITION_M1, |unit, args| unit.drive(M1, position(args, "", Ramps::Percent))),
    (number::PERCENT_POSITION_M2, |unit, args| unit.drive(M2, position(args, "", Ramps::Percent))),
    (number::PERCENT_POSITION_BOTH, |unit, args| positions(unit, args, Ramps::Percent)),
];

/// What a position command carries besides its target.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ramps {
    None,
    Speed,
    Profile,
    /// Nothing, and the target is a share of the range.
    Percent,
}

/// The fields of one motor end in this.
const SUFFIXES: [&str; 2] = ["_m1", "_m2"];

fn distances(unit: &mut Firmware, args: &Arguments<'_>, accels: [Option<&str>; 2]) -> Answer {
    unit.drive_both([distance(args, SUFFIXES[0], accels[0]), distance(args, SUFFIXES[1], accels[1])])
}

fn positions(unit: &mut Firmware, args: &Arguments<'_>, ramps: Ramps) -> Answer {
    unit.drive_both(SUFFIXES.map(|suffix| position(args, suffix, ramps)))
}

fn distance(args: &Arguments<'_>, suffix: &str, accel: Option<&str>) -> MotionCommand {
    let to = DistanceMove {
        speed_counts_per_s: args.i32(&format!("speed{suffix}")),
        acceleration: accel.map(|accel| args.u32(accel)),
        distance_counts: args.u32(&format!("distance{suffix}")),
    };
    MotionCommand::Distance(to, buffering(args))
}

fn position(args: &Arguments<'_>, suffix: &str, ramps: Ramps) -> MotionCommand {
    let position = args.i32(&format!("position{suffix}"));
    let has_speed = matches!(ramps, Ramps::Speed | Ramps::Profile);
    let ramp = |name: &str| (ramps == Ramps::Profile).then(|| args.u32(&format!("{name}{suffix}")));
    let to = PositionMove {
        acceleration: ramp("accel"),
        // The field carries speeds of either sign; the position decides the direction.
        speed_counts_per_s: has_speed.then(|| args.i32(&format!("speed{suffix}")).unsigned_abs()),
        deceleration: ramp("decel"),
        target: match ramps {
            Ramps::Percent => PositionTarget::Percent(position as i16),
            _ => PositionTarget::Counts(position),
        },
    };
    MotionCommand::Position(to, buffering(args))
}

fn buffering(args: &Arguments<'_>) -> Buffering {
    Buffering::from_wire(args.u8("buffer"))
}
