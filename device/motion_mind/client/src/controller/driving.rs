//! What a drive is in commands of a Motion Mind: one for each mode that serial commands can move a motor in.

use crate::messages::MotionMindCauseMessage;
use brushwork_link::Message;
use brushwork_link::device::{Drive, DriveCommand};
use brushwork_link::exchange::ExchangeError;
use brushwork_motion_mind_wire::{Address, Command, Mode, Protocol, encode_frame, encode_line};

/// Full drive.
const FULL_DUTY: f64 = 1023.0;
/// One count per PID loop of 5 ms, in counts per second (Motion Mind manual 3.15).
pub const COUNTS_PER_S_PER_STEP: f64 = 200.0;

/// The command for a drive in a mode. Ramps and speeds of moves are settings of the controller (VELOCITYLIMIT, TIMER), so those
/// of the drive are not looked at.
pub fn command(mode: Mode, drive: &Drive) -> Result<Command, ExchangeError> {
    let (Some(wanted), None) = (drive.m1, drive.m2) else {
        return impossible(MotionMindCauseMessage::OneMotor);
    };
    match (wanted, mode) {
        (DriveCommand::Duty { duty, .. }, Mode::Serial) => {
            let steps = (duty * FULL_DUTY).round();
            if steps.abs() <= FULL_DUTY {
                Ok(Command::ChangeSpeed(steps as i16))
            } else {
                impossible(MotionMindCauseMessage::DutyOutside)
            }
        }
        (DriveCommand::Speed { speed_counts_per_s, .. }, Mode::SerialPid) => {
            let steps = (f64::from(speed_counts_per_s) / COUNTS_PER_S_PER_STEP).round();
            if steps.abs() <= f64::from(i16::MAX) {
                Ok(Command::MoveAtVelocity(steps as i16))
            } else {
                impossible(MotionMindCauseMessage::SpeedOutside)
            }
        }
        (DriveCommand::Position { position_counts, .. }, Mode::SerialPid | Mode::AnalogPid) => {
            Ok(Command::MoveToAbsolute(position_counts))
        }
        (
            DriveCommand::Distance { speed_counts_per_s, distance_counts, .. },
            Mode::SerialPid | Mode::AnalogPid,
        ) => match i32::try_from(distance_counts) {
            Ok(distance) if speed_counts_per_s < 0 => Ok(Command::MoveToRelative(-distance)),
            Ok(distance) => Ok(Command::MoveToRelative(distance)),
            Err(_) => impossible(MotionMindCauseMessage::DistanceOutside),
        },
        (_, mode) => impossible(MotionMindCauseMessage::Takes { mode, taken: taken(mode) }),
    }
}

/// What serial commands can do in a mode.
#[must_use]
pub fn taken(mode: Mode) -> &'static str {
    match mode {
        Mode::Serial => "duties and nothing else",
        Mode::SerialPid => "speeds and moves; duties take mode 3",
        Mode::AnalogPid => "moves and nothing else",
        Mode::RadioControl | Mode::Analog | Mode::Buttons | Mode::FactoryRestore | Mode::FactoryTest => {
            "no motion commands; modes 3, 4 and 5 do, by switches 2 to 4 at power-up"
        }
    }
}

/// Why a drive cannot be in a mode; `None` if it can.
#[must_use]
pub fn objection(mode: Mode, drive: &Drive) -> Option<Message> {
    command(mode, drive).err().map(Message::error)
}

/// The bytes of a drive, as they would be sent.
#[must_use]
pub fn preview(drive: &Drive, address: u8, mode: Mode, protocol: Protocol) -> Vec<Vec<u8>> {
    let Some(address) = Address::unit(address) else { return Vec::new() };
    let encode = |command: Command| match protocol {
        Protocol::Binary => encode_frame(address, &command).ok(),
        Protocol::Text => encode_line(address, &command).ok().map(String::into_bytes),
    };
    command(mode, drive).ok().and_then(encode).into_iter().collect()
}

fn impossible<T>(what: MotionMindCauseMessage) -> Result<T, ExchangeError> {
    Err(ExchangeError::impossible(what))
}
