//! Distances and positions: commands 41 to 46, 51, 65 to 67, 119 to 127.

use super::super::answer::{Answer, Arguments, Handlers, On};
use super::super::firmware::Firmware;
use crate::motion::{Buffering, DistanceMove, MotionCommand, PositionMove, PositionTarget};
use brushwork_mcp_wire::packet_serial::commands;
use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_values::Motor::{M1, M2};

pub(super) const HANDLERS: Handlers = &[
    &On(commands::SPEED_DISTANCE_M1, |unit, args| unit.drive(M1, distance(args, SPEED, None, DISTANCE))),
    &On(commands::SPEED_DISTANCE_M2, |unit, args| unit.drive(M2, distance(args, SPEED, None, DISTANCE))),
    &On(commands::SPEED_DISTANCE_BOTH, |unit, args| distances(unit, args, [None, None])),
    &On(commands::SPEED_ACCEL_DISTANCE_M1, |unit, args| {
        unit.drive(M1, distance(args, SPEED, Some(args.u32(ACCEL)), DISTANCE))
    }),
    &On(commands::SPEED_ACCEL_DISTANCE_M2, |unit, args| {
        unit.drive(M2, distance(args, SPEED, Some(args.u32(ACCEL)), DISTANCE))
    }),
    &On(commands::SPEED_ACCEL_DISTANCE_BOTH, |unit, args| distances(unit, args, [Some(args.u32(ACCEL)); 2])),
    &On(commands::SPEED_ACCEL_DISTANCE_EACH, |unit, args| {
        distances(unit, args, [args.u32(ACCEL_M1), args.u32(ACCEL_M2)].map(Some))
    }),
    &On(commands::POSITION_PROFILE_M1, |unit, args| {
        unit.drive(M1, profile(args, ACCEL, SPEED, DECEL, POSITION))
    }),
    &On(commands::POSITION_PROFILE_M2, |unit, args| {
        unit.drive(M2, profile(args, ACCEL, SPEED, DECEL, POSITION))
    }),
    &On(commands::POSITION_PROFILE_BOTH, |unit, args| {
        unit.drive_both([
            profile(args, ACCEL_M1, SPEED_M1, DECEL_M1, POSITION_M1),
            profile(args, ACCEL_M2, SPEED_M2, DECEL_M2, POSITION_M2),
        ])
    }),
    &On(commands::POSITION_M1, |unit, args| unit.drive(M1, go(args, to(args.i32(POSITION))))),
    &On(commands::POSITION_M2, |unit, args| unit.drive(M2, go(args, to(args.i32(POSITION))))),
    &On(commands::POSITION_BOTH, |unit, args| {
        unit.drive_both([go(args, to(args.i32(POSITION_M1))), go(args, to(args.i32(POSITION_M2)))])
    }),
    &On(commands::SPEED_POSITION_M1, |unit, args| unit.drive(M1, go(args, at(args, SPEED, POSITION)))),
    &On(commands::SPEED_POSITION_M2, |unit, args| unit.drive(M2, go(args, at(args, SPEED, POSITION)))),
    &On(commands::SPEED_POSITION_BOTH, |unit, args| {
        unit.drive_both([
            go(args, at(args, SPEED_M1, POSITION_M1)),
            go(args, at(args, SPEED_M2, POSITION_M2)),
        ])
    }),
    &On(commands::PERCENT_POSITION_M1, |unit, args| unit.drive(M1, go(args, share(args.i16(POSITION))))),
    &On(commands::PERCENT_POSITION_M2, |unit, args| unit.drive(M2, go(args, share(args.i16(POSITION))))),
    &On(commands::PERCENT_POSITION_BOTH, |unit, args| {
        unit.drive_both([go(args, share(args.i16(POSITION_M1))), go(args, share(args.i16(POSITION_M2)))])
    }),
];

fn distances<const L: u8>(
    unit: &mut Firmware,
    args: &Arguments<'_, L>,
    [m1, m2]: [Option<u32>; 2],
) -> Answer<L> {
    unit.drive_both([distance(args, SPEED_M1, m1, DISTANCE_M1), distance(args, SPEED_M2, m2, DISTANCE_M2)])
}

fn distance<const L: u8>(
    args: &Arguments<'_, L>,
    speed: impl Name,
    acceleration: Option<u32>,
    distance: impl Name,
) -> MotionCommand {
    let (speed_counts_per_s, distance_counts) = (args.i32(speed), args.u32(distance));
    MotionCommand::Distance(
        DistanceMove { speed_counts_per_s, acceleration, distance_counts },
        buffering(args),
    )
}

fn go<const L: u8>(args: &Arguments<'_, L>, to: PositionMove) -> MotionCommand {
    MotionCommand::Position(to, buffering(args))
}

fn profile<const L: u8>(
    args: &Arguments<'_, L>,
    accel: impl Name,
    speed: impl Name,
    decel: impl Name,
    position: impl Name,
) -> MotionCommand {
    let (acceleration, deceleration) = (Some(args.u32(accel)), Some(args.u32(decel)));
    go(args, PositionMove { acceleration, deceleration, ..at(args, speed, position) })
}

/// The field carries speeds of either sign; the position decides the direction.
fn at<const L: u8>(args: &Arguments<'_, L>, speed: impl Name, position: impl Name) -> PositionMove {
    PositionMove { speed_counts_per_s: Some(args.i32(speed).unsigned_abs()), ..to(args.i32(position)) }
}

fn to(counts: i32) -> PositionMove {
    let target = PositionTarget::Counts(counts);
    PositionMove { acceleration: None, speed_counts_per_s: None, deceleration: None, target }
}

/// A share of the range.
fn share(percent_raw: i16) -> PositionMove {
    PositionMove { target: PositionTarget::Percent(percent_raw), ..to(0) }
}

fn buffering<const L: u8>(args: &Arguments<'_, L>) -> Buffering {
    Buffering::from_wire(args.u8(BUFFER))
}
