//! Duty and speed: commands 32 to 40, 50, 52 to 54.

use super::super::answer::{Answer, Handlers, On};
use super::super::firmware::Firmware;
use crate::motion::MotionCommand;
use brushwork_mcp_wire::packet_serial::commands;
use brushwork_mcp_wire::packet_serial::name::*;
use brushwork_values::Motor;
use brushwork_values::Motor::{M1, M2};

pub(super) const HANDLERS: Handlers = &[
    &On(commands::DUTY_M1, |unit, args| unit.drive(M1, duty(args.i16(DUTY), None))),
    &On(commands::DUTY_M2, |unit, args| unit.drive(M2, duty(args.i16(DUTY), None))),
    &On(commands::DUTY_BOTH, |unit, args| {
        unit.drive_both([duty(args.i16(DUTY_M1), None), duty(args.i16(DUTY_M2), None)])
    }),
    &On(commands::SPEED_M1, |unit, args| unit.drive(M1, speed(args.i32(SPEED), None))),
    &On(commands::SPEED_M2, |unit, args| unit.drive(M2, speed(args.i32(SPEED), None))),
    &On(commands::SPEED_BOTH, |unit, args| {
        unit.drive_both([speed(args.i32(SPEED_M1), None), speed(args.i32(SPEED_M2), None)])
    }),
    &On(commands::SPEED_ACCEL_M1, |unit, args| unit.drive(M1, speed(args.i32(SPEED), Some(args.u32(ACCEL))))),
    &On(commands::SPEED_ACCEL_M2, |unit, args| unit.drive(M2, speed(args.i32(SPEED), Some(args.u32(ACCEL))))),
    &On(commands::SPEED_ACCEL_BOTH, |unit, args| {
        unit.drive_both([
            speed(args.i32(SPEED_M1), Some(args.u32(ACCEL))),
            speed(args.i32(SPEED_M2), Some(args.u32(ACCEL))),
        ])
    }),
    &On(commands::SPEED_ACCEL_EACH, |unit, args| {
        unit.drive_both([
            speed(args.i32(SPEED_M1), Some(args.u32(ACCEL_M1))),
            speed(args.i32(SPEED_M2), Some(args.u32(ACCEL_M2))),
        ])
    }),
    &On(commands::DUTY_ACCEL_M1, |unit, args| unit.drive(M1, duty(args.i16(DUTY), Some(args.u32(ACCEL))))),
    &On(commands::DUTY_ACCEL_M2, |unit, args| unit.drive(M2, duty(args.i16(DUTY), Some(args.u32(ACCEL))))),
    &On(commands::DUTY_ACCEL_BOTH, |unit, args| {
        unit.drive_both([
            duty(args.i16(DUTY_M1), Some(args.u32(ACCEL_M1))),
            duty(args.i16(DUTY_M2), Some(args.u32(ACCEL_M2))),
        ])
    }),
];

impl Firmware {
    /// A motion command for one motor. Assumed: bridged, a command for motor 2 alone is refused by silence.
    pub(super) fn drive<const L: u8>(&mut self, motor: Motor, command: MotionCommand) -> Answer<L> {
        if self.is_bridged() && motor == M2 {
            return Answer::Silence;
        }
        if self.serial_commands() {
            self.command(motor, command);
        }
        Answer::Ack
    }

    /// A motion command for both motors. Assumed: bridged, motor 1's half drives the one motor.
    pub(super) fn drive_both<const L: u8>(&mut self, commands: [MotionCommand; 2]) -> Answer<L> {
        if self.serial_commands() {
            for (motor, command) in Motor::BOTH.into_iter().zip(commands) {
                self.command(motor, command);
            }
        }
        Answer::Ack
    }
}

fn duty(duty_raw: i16, acceleration_raw: Option<u32>) -> MotionCommand {
    MotionCommand::Duty { duty_raw, acceleration_raw }
}

fn speed(speed_counts_per_s: i32, acceleration: Option<u32>) -> MotionCommand {
    MotionCommand::Speed { speed_counts_per_s, acceleration }
}
