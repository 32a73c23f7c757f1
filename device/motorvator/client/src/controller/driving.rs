//! What a drive is in orders to the library: a duty in whole percent.

use crate::controller::unit::Board;
use crate::family::Half;
use crate::messages::MotorvatorCauseMessage;
use brushwork_link::Message;
use brushwork_link::device::controller::Line;
use brushwork_link::device::{Drive, DriveCommand};
use brushwork_link::exchange::ExchangeError;
use brushwork_motorvator_wire::host::{Direction, HostOrder};
use brushwork_values::Motor;

/// The orders of a drive, one for each motor that it speaks of.
fn orders(half: Half, drive: &Drive) -> Result<Vec<HostOrder>, MotorvatorCauseMessage> {
    let wanted = Motor::BOTH.into_iter().filter_map(|motor| Some((motor, drive.of(motor)?)));
    wanted
        .map(|(motor, command)| {
            let duty = match command {
                DriveCommand::Duty { duty, accel_duty_per_s: None } => duty,
                DriveCommand::Duty { .. } => return Err(MotorvatorCauseMessage::NoRamp),
                DriveCommand::Speed { .. }
                | DriveCommand::Distance { .. }
                | DriveCommand::Position { .. } => {
                    return Err(MotorvatorCauseMessage::DutiesAlone);
                }
            };
            let percent = duty * 100.0;
            if !(-100.0..=100.0).contains(&percent) {
                return Err(MotorvatorCauseMessage::DutyOutside { percent });
            }
            let direction = if percent < 0.0 { Direction::Backward } else { Direction::Forward };
            // Within 0 to 100 by the line above.
            let percent = percent.abs().round() as u8;
            Ok(HostOrder::Motor { motor: half.motor(motor), direction, percent })
        })
        .collect()
}

/// Turns the motors.
pub fn drive(board: &mut Board, line: &mut Line<'_>, drive: &Drive) -> Result<(), ExchangeError> {
    for order in orders(board.half, drive).map_err(ExchangeError::impossible)? {
        board.speaker.ask(line, &order)?;
    }
    Ok(())
}

/// Why a drive cannot be; `None` if it can.
pub fn objection(drive: &Drive) -> Option<Message> {
    orders(Half::First, drive).err().map(Message::from)
}

/// The bytes of a drive, with the number 0 in place of those that count up.
pub fn preview(drive: &Drive, address: u8) -> Vec<Vec<u8>> {
    let orders = Half::of(address).and_then(|half| orders(half, drive).ok()).unwrap_or_default();
    orders.iter().map(|order| order.line(0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_duty_is_an_order_to_each_motor_of_the_half() {
        let both = Drive { m1: Some(DriveCommand::duty(0.604)), m2: Some(DriveCommand::duty(-1.0)) };
        assert_eq!(preview(&both, 1), [b"I077000001070060\r".to_vec(), b"I077000002066100\r".to_vec()]);
        assert_eq!(preview(&both, 2), [b"I077000003070060\r".to_vec(), b"I077000004066100\r".to_vec()]);
        assert_eq!(objection(&both), None);
    }

    #[test]
    fn what_is_no_duty_is_refused_with_the_reason() {
        let speed = DriveCommand::Speed { speed_counts_per_s: 1, accel_counts_per_s2: None };
        let ramp = DriveCommand::Duty { duty: 0.5, accel_duty_per_s: Some(1.0) };
        for (command, clause) in [
            (speed, "duties"),
            (ramp, "at once"),
            (DriveCommand::duty(1.01), "101.0 %"),
            (DriveCommand::duty(f64::NAN), "not a duty"),
        ] {
            let said = objection(&Drive::both(command)).unwrap().to_string();
            assert!(said.contains(clause), "{said}");
        }
    }
}
