//! Units on a scripted line: what goes out for each act, byte by byte.

use crate::controller::borrowed::Ramp;
use crate::controller::driving::command;
use crate::controller::stopping::broadcast;
use brushwork_link::device::{Drive, DriveCommand};
use brushwork_motion_mind_wire::{Command, Mode, Protocol};
use brushwork_values::Motor;
use std::time::Duration;

fn one(wanted: DriveCommand) -> Drive {
    Drive::one(Motor::M1, wanted)
}

#[test]
fn a_drive_is_the_command_of_its_mode_or_a_sentence() {
    let half = one(DriveCommand::duty(-0.5));
    // -0.5 of 1023 steps.
    assert_eq!(command(Mode::Serial, &half).unwrap(), Command::ChangeSpeed(-512));
    let speed = one(DriveCommand::Speed { speed_counts_per_s: 24_200, accel_counts_per_s2: None });
    // 24,200 counts/s in loops of 5 ms.
    assert_eq!(command(Mode::SerialPid, &speed).unwrap(), Command::MoveAtVelocity(121));
    let back = one(DriveCommand::Distance {
        speed_counts_per_s: -1,
        accel_counts_per_s2: None,
        distance_counts: 300,
        queued: false,
    });
    assert_eq!(command(Mode::AnalogPid, &back).unwrap(), Command::MoveToRelative(-300));
    for (mode, drive, clause) in [
        (Mode::SerialPid, half, "duties take mode 3"),
        (Mode::Serial, speed, "duties and nothing else"),
        (Mode::Buttons, half, "no motion commands"),
        (Mode::Serial, Drive::both(DriveCommand::duty(0.0)), "one motor"),
        (Mode::Serial, one(DriveCommand::duty(1.5)), "-100 % to 100 %"),
    ] {
        let said = command(mode, &drive).unwrap_err().to_string();
        assert!(said.contains(clause), "{said}");
    }
}

#[test]
fn a_broadcast_stop_is_one_frame_for_each_way_of_moving() {
    let stop = broadcast(&[Mode::Serial, Mode::Serial, Mode::SerialPid], Protocol::Binary);
    // CHANGE_SPEED 0 to 99: 14 63 00 00, sum 77. MOVEAT_VELOCITY 0: 17 63 00 00, sum 7A.
    assert_eq!(stop.writes(), [vec![0x14, 0x63, 0, 0, 0x77], vec![0x17, 0x63, 0, 0, 0x7A]]);
    assert!(stop.gap > Duration::from_millis(5), "5 ms of silence end a frame");
    let text = broadcast(&[Mode::Serial, Mode::SerialPid], Protocol::Text);
    assert_eq!(text.concat(), b"C99 0\r\nV99 0\r\n");
}

#[test]
fn the_time_of_a_ramp_is_that_of_the_manual() {
    // Motion Mind manual 4.6: steps of 10 every 50 ms take about 5 s.
    let ramp = Ramp { step: Some(10), timer: Some(10) };
    assert_eq!(ramp.time_to_zero(), Some(Duration::from_millis(5_150)));
    assert_eq!(Ramp { step: Some(1023), timer: Some(10) }.time_to_zero(), Some(Duration::from_millis(50)));
    assert_eq!(Ramp::default().time_to_zero(), None);
}
