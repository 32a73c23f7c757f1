//! Drive commands as packets (MCP manual 2.4.9).

use crate::messages::McpCauseMessage;
use brushwork_link::device::{Drive, DriveCommand};
use brushwork_link::exchange::ExchangeError;
use brushwork_mcp_wire::packet_serial::{Address, Generation, Request, number, scale};
use brushwork_values::Motor;

/// A command number and its raw values.
pub type Packet = (u8, Vec<i64>);

/// The packets of a drive: one for both motors where the protocol has one, else one for each.
pub fn packets(drive: &Drive) -> Result<Vec<Packet>, ExchangeError> {
    if let (Some(first), Some(second)) = (drive.m1, drive.m2)
        && let Some(packet) = for_both(&first, &second)?
    {
        return Ok(vec![packet]);
    }
    let commands = Motor::BOTH.into_iter().filter_map(|motor| Some((motor, drive.of(motor)?)));
    commands.map(|(motor, command)| for_one(motor, &command)).collect()
}

/// The bytes of a drive, packet by packet, as they would be sent.
#[must_use]
pub fn preview(drive: &Drive, address: Address, generation: Generation) -> Vec<Vec<u8>> {
    let packets = packets(drive).unwrap_or_default().into_iter();
    let encode = |(command, values): Packet| Request::new(address, command, &values).encode(generation).ok();
    packets.filter_map(encode).collect()
}

fn for_one(motor: Motor, command: &DriveCommand) -> Result<Packet, ExchangeError> {
    let index = motor.index();
    Ok(match *command {
        DriveCommand::Duty { duty, accel_duty_per_s: None } => {
            ([number::DUTY_M1, number::DUTY_M2][index], vec![raw_duty(duty)?])
        }
        DriveCommand::Duty { duty, accel_duty_per_s: Some(accel) } => {
            ([number::DUTY_ACCEL_M1, number::DUTY_ACCEL_M2][index], vec![raw_duty(duty)?, raw_accel(accel)?])
        }
        DriveCommand::Speed { speed_counts_per_s: speed, accel_counts_per_s2: None } => {
            ([number::SPEED_M1, number::SPEED_M2][index], vec![speed.into()])
        }
        DriveCommand::Speed { speed_counts_per_s: speed, accel_counts_per_s2: Some(accel) } => {
            ([number::SPEED_ACCEL_M1, number::SPEED_ACCEL_M2][index], vec![accel.into(), speed.into()])
        }
        DriveCommand::Distance { accel_counts_per_s2: None, queued, .. } => {
            let [speed, distance] = travel(command);
            let numbers = [number::SPEED_DISTANCE_M1, number::SPEED_DISTANCE_M2];
            (numbers[index], vec![speed, distance, buffer(queued)])
        }
        DriveCommand::Distance { accel_counts_per_s2: Some(accel), queued, .. } => {
            let [speed, distance] = travel(command);
            let numbers = [number::SPEED_ACCEL_DISTANCE_M1, number::SPEED_ACCEL_DISTANCE_M2];
            (numbers[index], vec![accel.into(), speed, distance, buffer(queued)])
        }
        DriveCommand::Position { queued, .. } => {
            let mut values = profile(command).to_vec();
            values.push(buffer(queued));
            ([number::POSITION_PROFILE_M1, number::POSITION_PROFILE_M2][index], values)
        }
    })
}

/// The packet that carries both, if there is one.
fn for_both(first: &DriveCommand, second: &DriveCommand) -> Result<Option<Packet>, ExchangeError> {
    use DriveCommand::{Distance, Duty, Position, Speed};
    Ok(Some(match (*first, *second) {
        (Duty { duty: one, accel_duty_per_s: None }, Duty { duty: two, accel_duty_per_s: None }) => {
            (number::DUTY_BOTH, vec![raw_duty(one)?, raw_duty(two)?])
        }
        (
            Duty { duty: one, accel_duty_per_s: Some(accel_one) },
            Duty { duty: two, accel_duty_per_s: Some(accel_two) },
        ) => {
            let values = vec![raw_duty(one)?, raw_accel(accel_one)?, raw_duty(two)?, raw_accel(accel_two)?];
            (number::DUTY_ACCEL_BOTH, values)
        }
        (
            Speed { speed_counts_per_s: one, accel_counts_per_s2: None },
            Speed { speed_counts_per_s: two, accel_counts_per_s2: None },
        ) => (number::SPEED_BOTH, vec![one.into(), two.into()]),
        (
            Speed { speed_counts_per_s: one, accel_counts_per_s2: Some(accel_one) },
            Speed { speed_counts_per_s: two, accel_counts_per_s2: Some(accel_two) },
        ) => (number::SPEED_ACCEL_EACH, vec![accel_one.into(), one.into(), accel_two.into(), two.into()]),
        (
            Distance { accel_counts_per_s2: None, queued: queued_one, .. },
            Distance { accel_counts_per_s2: None, queued: queued_two, .. },
        ) if queued_one == queued_two => {
            let values = [&travel(first)[..], &travel(second), &[buffer(queued_one)]].concat();
            (number::SPEED_DISTANCE_BOTH, values)
        }
        (
            Distance { accel_counts_per_s2: Some(accel_one), queued: queued_one, .. },
            Distance { accel_counts_per_s2: Some(accel_two), queued: queued_two, .. },
        ) if queued_one == queued_two => {
            let (one, two) = (travel(first), travel(second));
            let values =
                [&[accel_one.into()], &one[..], &[accel_two.into()], &two, &[buffer(queued_one)]].concat();
            (number::SPEED_ACCEL_DISTANCE_EACH, values)
        }
        (Position { queued: queued_one, .. }, Position { queued: queued_two, .. })
            if queued_one == queued_two =>
        {
            let values = [&profile(first)[..], &profile(second), &[buffer(queued_one)]].concat();
            (number::POSITION_PROFILE_BOTH, values)
        }
        _ => return Ok(None),
    }))
}

/// Speed and distance of a distance command.
fn travel(command: &DriveCommand) -> [i64; 2] {
    match *command {
        DriveCommand::Distance { speed_counts_per_s, distance_counts, .. } => {
            [speed_counts_per_s.into(), distance_counts.into()]
        }
        DriveCommand::Duty { .. } | DriveCommand::Speed { .. } | DriveCommand::Position { .. } => [0, 0],
    }
}

/// Acceleration, speed, deceleration and position of a position command.
fn profile(command: &DriveCommand) -> [i64; 4] {
    match *command {
        DriveCommand::Position {
            position_counts,
            speed_counts_per_s,
            accel_counts_per_s2,
            decel_counts_per_s2,
            ..
        } => [
            accel_counts_per_s2.into(),
            speed_counts_per_s.into(),
            decel_counts_per_s2.into(),
            position_counts.into(),
        ],
        DriveCommand::Duty { .. } | DriveCommand::Speed { .. } | DriveCommand::Distance { .. } => [0; 4],
    }
}

/// 1 drops what runs and waits; 0 queues (MCP manual 2.4.9, command 41).
fn buffer(queued: bool) -> i64 {
    i64::from(!queued)
}

fn raw_duty(duty: f64) -> Result<i64, ExchangeError> {
    if !(-1.0..=1.0).contains(&duty) {
        return Err(ExchangeError::impossible(McpCauseMessage::DutyOutside { duty }));
    }
    Ok((duty * scale::FULL_DUTY_RAW as f64).round() as i64)
}

fn raw_accel(accel_duty_per_s: f64) -> Result<i64, ExchangeError> {
    let raw = (accel_duty_per_s * scale::DUTY_ACCEL_RAW_PER_SECOND).round();
    if !(0.0..=scale::MAX_DUTY_ACCEL_RAW as f64).contains(&raw) {
        let highest = scale::MAX_DUTY_ACCEL_RAW as f64 / scale::DUTY_ACCEL_RAW_PER_SECOND;
        let what = McpCauseMessage::DutyChangeOutside { accel_duty_per_s, highest };
        return Err(ExchangeError::impossible(what));
    }
    Ok(raw as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn both(command: DriveCommand) -> Vec<Packet> {
        packets(&Drive::both(command)).unwrap()
    }

    fn one(motor: Motor, command: DriveCommand) -> Vec<Packet> {
        packets(&Drive::one(motor, command)).unwrap()
    }

    #[test]
    fn duty_is_scaled_to_the_wire_and_sent_in_one_packet_for_both() {
        assert_eq!(both(DriveCommand::duty(-1.0)), [(34, vec![-32_767, -32_767])]);
        assert_eq!(one(Motor::M2, DriveCommand::duty(0.5)), [(33, vec![16_384])]);
        let ramp = DriveCommand::Duty { duty: 0.1, accel_duty_per_s: Some(1.0) };
        assert_eq!(one(Motor::M1, ramp), [(52, vec![3_277, 32_768])]);
        assert_eq!(both(ramp), [(54, vec![3_277, 32_768, 3_277, 32_768])]);
    }

    #[test]
    fn speeds_and_moves_use_the_number_of_their_form() {
        let speed = |accel| DriveCommand::Speed { speed_counts_per_s: -500, accel_counts_per_s2: accel };
        assert_eq!(one(Motor::M1, speed(None)), [(35, vec![-500])]);
        assert_eq!(one(Motor::M2, speed(Some(7))), [(39, vec![7, -500])]);
        assert_eq!(both(speed(None)), [(37, vec![-500, -500])]);
        assert_eq!(both(speed(Some(7))), [(50, vec![7, -500, 7, -500])]);
        let distance = |accel, queued| DriveCommand::Distance {
            speed_counts_per_s: 100,
            accel_counts_per_s2: accel,
            distance_counts: 2_000,
            queued,
        };
        assert_eq!(one(Motor::M1, distance(None, true)), [(41, vec![100, 2_000, 0])]);
        assert_eq!(one(Motor::M2, distance(Some(9), false)), [(45, vec![9, 100, 2_000, 1])]);
        assert_eq!(both(distance(None, false)), [(43, vec![100, 2_000, 100, 2_000, 1])]);
        assert_eq!(both(distance(Some(9), true)), [(51, vec![9, 100, 2_000, 9, 100, 2_000, 0])]);
        let position = DriveCommand::Position {
            position_counts: -40,
            speed_counts_per_s: 3,
            accel_counts_per_s2: 1,
            decel_counts_per_s2: 2,
            queued: false,
        };
        assert_eq!(one(Motor::M2, position), [(66, vec![1, 3, 2, -40, 1])]);
        assert_eq!(both(position), [(67, vec![1, 3, 2, -40, 1, 3, 2, -40, 1])]);
    }

    #[test]
    fn two_motors_with_different_commands_take_a_packet_each() {
        let drive = Drive {
            m1: Some(DriveCommand::duty(0.0)),
            m2: Some(DriveCommand::Speed { speed_counts_per_s: 1, accel_counts_per_s2: None }),
        };
        assert_eq!(packets(&drive).unwrap(), [(32, vec![0]), (36, vec![1])]);
        assert_eq!(packets(&Drive::default()).unwrap(), []);
    }

    #[test]
    fn what_is_no_duty_is_refused() {
        for duty in [1.01, -2.0, f64::NAN, f64::INFINITY] {
            let error = packets(&Drive::both(DriveCommand::duty(duty))).unwrap_err();
            assert!(matches!(error, ExchangeError::Impossible { .. }), "{duty}");
        }
        for accel in [-1.0, 21.0, f64::NAN] {
            let ramp = DriveCommand::Duty { duty: 0.0, accel_duty_per_s: Some(accel) };
            assert!(packets(&Drive::both(ramp)).is_err(), "{accel}");
        }
    }
}
