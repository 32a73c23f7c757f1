//! The board with its motors, as a server drives it.

use crate::{DrivenMotorvator, Motorvator};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::presets::presets;
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_script::debug::{Breakpoint, Request, Wanted};
use brushwork_script::mecc::compile;
use std::time::Duration;

fn driven(text: &str) -> DrivenMotorvator {
    let board = Motorvator::new(compile(text).program);
    DrivenMotorvator::new(board, &presets()[0], 0).expect("a sound preset")
}

fn seconds(machine: &mut DrivenMotorvator, seconds: f64) {
    let to = machine.now() + Duration::from_secs_f64(seconds);
    machine.advance(to);
}

/// Radians per second of motors A, B, C and D.
fn speeds(machine: &DrivenMotorvator) -> Vec<f64> {
    let views = machine.views();
    views
        .iter()
        .flat_map(|view| view.axes.each_ref().map(|axis| axis.truth.motor_radians_per_second))
        .collect()
}

const DRIVE: &str = "Begin Program\nSetMotor 1, \"F\", 60\nSetMotor 2, \"B\", 30\nSetMotor 4, \"F\", 60\nWait 256\nStopMotors\nEnd Program\n";

#[test]
fn motors_turn_as_the_program_says_and_not_before_it_is_started() {
    let mut machine = driven(DRIVE);
    seconds(&mut machine, 0.5);
    assert!(speeds(&machine).iter().all(|speed| speed.abs() < 1e-9));
    machine.receive(StreamIndex::Usb, b"G\r");
    seconds(&mut machine, 1.9);
    let [a, b, c, d] = speeds(&machine)[..] else { panic!("four motors") };
    assert!(a > 1.0 && b < -0.5 && c.abs() < 1e-9, "{a} {b} {c} {d}");
    assert!((a - d).abs() < a * 0.01, "{a} {d}");
    // It coasts when it is stopped.
    seconds(&mut machine, 20.0);
    assert!(speeds(&machine)[0].abs() < a * 0.2);
}

#[test]
fn a_switch_to_ground_raises_the_event_of_its_input() {
    let text = "Declare EventHandler h()\nDisplayChars \"O\", \"3\"\nEnd EventHandler\nBegin Program\nSetEvent OnOff3Event, h\nEnable Events\nLoop\nEnd Loop\nEnd Program\n";
    let mut machine = driven(text);
    machine.receive(StreamIndex::Usb, b"G\r");
    seconds(&mut machine, 0.5);
    assert_eq!(machine.board().display(), *b"  ");
    machine.apply(0, &WorldAction::SetPin { pin: 2, signal: PinSignal::Volts { volts: 0.0 } });
    seconds(&mut machine, 0.01);
    assert_eq!(machine.board().display(), *b"O3");
}

#[test]
fn without_power_nothing_runs_and_with_it_the_board_waits_for_g() {
    let mut machine = driven(DRIVE);
    machine.receive(StreamIndex::Usb, b"G\r");
    seconds(&mut machine, 0.5);
    machine.apply(0, &WorldAction::Power { on: false });
    seconds(&mut machine, 0.5);
    assert_eq!(machine.board().motors(), [0; 4]);
    machine.apply(0, &WorldAction::Power { on: true });
    seconds(&mut machine, 0.5);
    assert!(!machine.board().is_running() && machine.board().motors() == [0; 4]);
    machine.receive(StreamIndex::Usb, b"G\r");
    seconds(&mut machine, 0.5);
    assert_eq!(machine.board().motors(), [60, -30, 0, 60]);
}

#[test]
fn what_comes_over_one_stream_is_answered_there() {
    let mut machine = driven(DRIVE);
    machine.receive(StreamIndex::Usb, b"H\r");
    seconds(&mut machine, 0.5);
    assert!(machine.take_output(StreamIndex::Usb).is_some_and(|bytes| bytes.starts_with(b"MotorVator")));
}

/// Steps lost in 200, with these waits and this hold current.
fn lost(least: u32, most: u32, hold: u32) -> i64 {
    let text = format!(
        "Begin Program\nConfigStepper 1, {least}, {most}, {hold}\nSetStepper 1, \"F\", 200\nLoop\nEnd Loop\nEnd Program\n"
    );
    let mut machine = driven(&text);
    machine.receive(StreamIndex::Usb, b"G\r");
    seconds(&mut machine, 8.0);
    assert_eq!(machine.board().steps(), [200, 0]);
    machine.lost_steps()[0]
}

#[test]
fn waits_that_are_too_short_lose_steps_and_a_ramp_saves_them() {
    assert_eq!(lost(20, 20, 50), 0);
    assert_ne!(lost(1, 1, 50), 0);
    // What cannot be started at can be reached.
    let reached = (1..20).find(|least| lost(*least, 20, 50) == 0).expect("some wait is long enough");
    let started = (1..=20).find(|wait| lost(*wait, *wait, 50) == 0).expect("some wait is long enough");
    assert!(reached <= started, "{reached} {started}");
}

#[test]
fn a_frozen_board_stands_still_while_the_line_goes_on_and_goes_on_where_it_stood() {
    let mut machine = driven(DRIVE);
    let attached = vec![Request::Attach(true), Request::FreezeWorld(true)];
    machine.debug(attached, &Wanted::default());
    machine.receive(StreamIndex::Usb, b"G\r");
    machine.debug(vec![Request::Breakpoints(vec![Breakpoint::at(5)])], &Wanted::default());
    seconds(&mut machine, 0.5);
    let view = machine.debug(Vec::new(), &Wanted::default());
    assert!(view.is_paused, "{view:?}");
    let (before, frozen_at) = (speeds(&machine), view.now);
    seconds(&mut machine, 3.0);
    let view = machine.debug(Vec::new(), &Wanted::default());
    assert_eq!((speeds(&machine), view.now), (before, frozen_at), "motors and clock stand");
    assert!(machine.now() >= Duration::from_secs(3), "the line's time goes on");
    machine.debug(vec![Request::Continue], &Wanted::default());
    seconds(&mut machine, 1.0);
    assert!(speeds(&machine)[0] > 1.0);
    // Two seconds of its own time after the start it stops the motors.
    seconds(&mut machine, 1.5);
    assert_eq!(machine.board().motors(), [0; 4]);
}
