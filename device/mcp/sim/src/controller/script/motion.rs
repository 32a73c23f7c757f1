//! POWER, SPEED, DIST and MOVE as commands to the motion core, as packet serial's commands 52 to 54, 38 to 40, 44 to 46 and 65 to 67 give
//! them.
//!
//! Assumed: a script's commands act at all priority levels, as functions over CANopen do (MCP manual 1.9.4), since the levels name
//! serial, pulse and analog inputs only (command 139); the last command to a motor counts, whoever gave it. A source that times out stops
//! no motor whose last command came from a running script. A duty beyond full scale is full; a motor other than 0 and 1 is none.

use crate::motion::{Buffering, DistanceMove, MotionCommand, PositionMove, PositionTarget};
use brushwork_script::mcl::ast::Motion;
use brushwork_values::Motor;

/// What each motor is told.
pub fn commands(command: Motion, arguments: &[i32]) -> [Option<MotionCommand>; 2] {
    let at = |index: usize| arguments.get(index).copied().unwrap_or(0);
    match command {
        Motion::Power => one(at(0), power(at(1), at(2))),
        Motion::Power2 => [Some(power(at(0), at(1))), Some(power(at(2), at(3)))],
        Motion::Speed => one(at(0), speed(at(1), at(2))),
        Motion::Speed2 => [Some(speed(at(0), at(1))), Some(speed(at(2), at(3)))],
        Motion::Dist => one(at(0), distance([at(1), at(2), at(3)], at(4))),
        Motion::Dist2 => {
            [Some(distance([at(0), at(1), at(2)], at(6))), Some(distance([at(3), at(4), at(5)], at(6)))]
        }
        Motion::Move => one(at(0), position([at(1), at(2), at(3), at(4)], at(5))),
        Motion::Move2 => [
            Some(position([at(0), at(1), at(2), at(3)], at(8))),
            Some(position([at(4), at(5), at(6), at(7)], at(8))),
        ],
    }
}

fn one(motor: i32, command: MotionCommand) -> [Option<MotionCommand>; 2] {
    Motor::BOTH.map(|each| (usize::try_from(motor) == Ok(each.index())).then_some(command))
}

fn power(duty: i32, accel: i32) -> MotionCommand {
    let full = i32::from(i16::MAX);
    MotionCommand::Duty { duty_raw: duty.clamp(-full, full) as i16, acceleration_raw: Some(accel as u32) }
}

fn speed(speed_counts_per_s: i32, accel: i32) -> MotionCommand {
    MotionCommand::Speed { speed_counts_per_s, acceleration: Some(accel as u32) }
}

fn distance([speed, accel, distance]: [i32; 3], buffer: i32) -> MotionCommand {
    let to = DistanceMove {
        speed_counts_per_s: speed,
        acceleration: Some(accel as u32),
        distance_counts: distance as u32,
    };
    MotionCommand::Distance(to, buffering(buffer))
}

fn position([speed, accel, decel, target]: [i32; 4], buffer: i32) -> MotionCommand {
    let to = PositionMove {
        acceleration: Some(accel as u32),
        speed_counts_per_s: Some(speed.unsigned_abs()),
        deceleration: Some(decel as u32),
        target: PositionTarget::Counts(target),
    };
    MotionCommand::Position(to, buffering(buffer))
}

fn buffering(buffer: i32) -> Buffering {
    Buffering::from_wire(u8::from(buffer != 0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_taken_in_the_order_of_the_syntax_lines() {
        let duty = |duty_raw, accel| Some(MotionCommand::Duty { duty_raw, acceleration_raw: Some(accel) });
        assert_eq!(commands(Motion::Power, &[1, -100, 7]), [None, duty(-100, 7)]);
        assert_eq!(commands(Motion::Power, &[2, 100, 7]), [None, None]);
        assert_eq!(commands(Motion::Power2, &[1, 2, 99_999, 4]), [duty(1, 2), duty(32_767, 4)]);
        let [first, second] = commands(Motion::Move2, &[1, 2, 3, -4, 5, 6, 7, 8, 1]);
        let to = PositionMove {
            acceleration: Some(2),
            speed_counts_per_s: Some(1),
            deceleration: Some(3),
            target: PositionTarget::Counts(-4),
        };
        assert_eq!(first, Some(MotionCommand::Position(to, Buffering::Immediate)));
        let to = PositionMove {
            acceleration: Some(6),
            speed_counts_per_s: Some(5),
            deceleration: Some(7),
            target: PositionTarget::Counts(8),
        };
        assert_eq!(second, Some(MotionCommand::Position(to, Buffering::Immediate)));
        let to = DistanceMove { speed_counts_per_s: -5, acceleration: Some(6), distance_counts: 7 };
        assert_eq!(
            commands(Motion::Dist2, &[-5, 6, 7, -5, 6, 7, 0]),
            [Some(MotionCommand::Distance(to, Buffering::Queue)); 2]
        );
    }
}
