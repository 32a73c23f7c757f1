//! Duty and speed: commands 32 to 40, 50, 52 to 54.

use super::super::answer::{Answer, Arguments, Handlers};
use super::super::firmware::Firmware;
use crate::motion::MotionCommand;
use brushwork_mcp_wire::packet_serial::number;
use brushwork_values::Motor;
use brushwork_values::Motor::{M1, M2};

pub(super) const HANDLERS: Handlers = &[
    (number::DUTY_M1, |unit, args| unit.drive(M1, duty(args, "duty", None))),
    (number::DUTY_M2, |unit, args| unit.drive(M2, duty(args, "duty", None))),
    (number::DUTY_BOTH, |unit, args| {
        unit.drive_both([duty(args, "duty_m1", None), duty(args, "duty_m2", None)])
    }),
    (number::SPEED_M1, |unit, args| unit.drive(M1, speed(args, "speed", None))),
    (number::SPEED_M2, |unit, args| unit.drive(M2, speed(args, "speed", None))),
    (number::SPEED_BOTH, |unit, args| {
        unit.drive_both([speed(args, "speed_m1", None), speed(args, "speed_m2", None)])
    }),
    (number::SPEED_ACCEL_M1, |unit, args| unit.drive(M1, speed(args, "speed", Some("accel")))),
    (number::SPEED_ACCEL_M2, |unit, args| unit.drive(M2, speed(args, "speed", Some("accel")))),
    (number::SPEED_ACCEL_BOTH, |unit, args| {
        unit.drive_both([speed(args, "speed_m1", Some("accel")), speed(args, "speed_m2", Some("accel"))])
    }),
    (number::SPEED_ACCEL_EACH, |unit, args| {
        unit.drive_both([
            speed(args, "speed_m1", Some("accel_m1")),
            speed(args, "speed_m2", Some("accel_m2")),
        ])
    }),
    (number::DUTY_ACCEL_M1, |unit, args| unit.drive(M1, duty(args, "duty", Some("accel")))),
    (number::DUTY_ACCEL_M2, |unit, args| unit.drive(M2, duty(args, "duty", Some("accel")))),
    (number::DUTY_ACCEL_BOTH, |unit, args| {
        unit.drive_both([duty(args, "duty_m1", Some("accel_m1")), duty(args, "duty_m2", Some("accel_m2"))])
    }),
];

impl Firmware {
    /// A motion command for one motor. Assumed: bridged, a command for motor 2 alone is refused by silence.
    pub(super) fn drive(&mut self, motor: Motor, command: MotionCommand) -> Answer {
        if self.is_bridged() && motor == M2 {
            return Answer::Silence;
        }
        if self.serial_commands() {
            self.command(motor, command);
        }
        Answer::Ack
    }

    /// A motion command for both motors. Assumed: bridged, motor 1's half drives the one motor.
    pub(super) fn drive_both(&mut self, commands: [MotionCommand; 2]) -> Answer {
        if self.serial_commands() {
            for (motor, command) in Motor::BOTH.into_iter().zip(commands) {
                self.command(motor, command);
            }
        }
        Answer::Ack
    }
}

fn duty(args: &Arguments<'_>, name: &str, accel: Option<&str>) -> MotionCommand {
    MotionCommand::Duty { duty_raw: args.i16(name), acceleration_raw: accel.map(|accel| args.u32(accel)) }
}

fn speed(args: &Arguments<'_>, name: &str, accel: Option<&str>) -> MotionCommand {
    MotionCommand::Speed {
        speed_counts_per_s: args.i32(name),
        acceleration: accel.map(|accel| args.u32(accel)),
    }
}
