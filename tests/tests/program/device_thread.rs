//! The device thread over a real pseudo-terminal in real time: what it must do when the window or the line dies.
//!
//! Exact timing and every branch are tested in virtual time beside the device thread; here the whole chain runs once: thread,
//! serial port, pseudo-terminal, server, simulated controller, motors.
#![cfg(unix)]
#![expect(clippy::print_stdout, reason = "measured times belong into the record of a test run")]

use std::time::{Duration, Instant};

use brushwork_link::device::{
    Addresses, ArmScope, DeviceHandle, DeviceOptions, DeviceThread, DisarmReason, Drive, DriveCommand, Event,
    PollRate, Request,
};
use brushwork_link::transport::ConnectTarget;
use brushwork_link::{Stream, SystemClock};
use brushwork_mcp_sim::controller::Controller;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_plant::world::WorldAction;
use brushwork_tests::simulated::{Off, OnPty, is_at_rest, is_driven};
use brushwork_tests::wait::LIMIT;
use brushwork_values::Motor;

/// How often a busy machine may keep the window from renewing its motion before the test gives up.
const TRIES: usize = 20;

/// A link as a window would hold it.
struct Window {
    handle: DeviceHandle,
}

impl Window {
    fn connect(controller: &OnPty, poll: PollRate) -> Self {
        brushwork::install();
        // On a busy machine it is late.
        let target: ConnectTarget = controller.target().parse().expect("a target");
        let transport = target.open().expect("the terminal is there");
        let options = DeviceOptions {
            addresses: Addresses::Only(0x80),
            stream: Some(Stream::Usb),
            poll,
            ..DeviceOptions::default()
        };
        let handle = DeviceThread::spawn(transport, SystemClock::shared(), options)
            .expect("the system gives a thread");
        let window = Self { handle };
        window.wait_for("a selected unit", |event| matches!(event, Event::Selected { .. }));
        window
    }

    /// Takes events until one of them is it.
    fn wait_for(&self, what: &str, is_it: impl Fn(&Event) -> bool) -> Event {
        let end = Instant::now() + LIMIT;
        loop {
            self.handle.renew();
            match self.handle.events().recv_timeout(Duration::from_millis(20)) {
                Ok(event) if is_it(&event) => return event,
                Ok(Event::ArmRefused { reasons, .. }) => panic!("arming was refused: {reasons:?}"),
                Ok(_) => {}
                Err(error) if error.is_timeout() && Instant::now() < end => {}
                Err(error) => panic!("no {what}: {error}"),
            }
            assert!(Instant::now() < end, "no {what} within {LIMIT:?}");
        }
    }

    fn request(&self, request: Request) {
        self.handle.request(request).expect("the queue has room");
    }

    /// Arms, drives both motors, and keeps the motion alive for a second.
    fn drive(&self, controller: &OnPty) {
        let driven = (0..TRIES).any(|_| self.drives_for_a_second(controller));
        assert!(driven, "the motors run for as long as the motion is renewed");
    }

    fn drives_for_a_second(&self, controller: &OnPty) -> bool {
        self.request(Request::Arm(ArmScope::Pwm));
        self.wait_for("permission to move", |event| matches!(event, Event::Armed { .. }));
        let half = |sign: f64| Some(DriveCommand::Duty { duty: 0.5 * sign, accel_duty_per_s: None });
        self.request(Request::Drive(Drive { m1: half(1.0), m2: half(-1.0) }));
        let end = controller.look(Controller::now) + Duration::from_secs(1);
        while controller.look(Controller::now) < end {
            self.handle.renew();
            self.handle.events().try_iter().for_each(drop);
            std::thread::sleep(Duration::from_millis(20));
        }
        controller.look(both_are_driven)
    }
}

fn both_are_driven(controller: &Controller) -> bool {
    Motor::BOTH
        .into_iter()
        .all(|motor| controller.unit().is_some_and(|unit| unit.channel(motor).duty_raw() != 0))
}

fn off(controller: &OnPty, what: &str) -> Off {
    let off = controller.wait_until_off();
    println!("{what}: {off:?}");
    controller.wait_until("shafts at rest", is_at_rest);
    off
}

#[test]
fn a_frozen_window_stops_both_motors_within_the_life_of_a_motion() {
    let controller = OnPty::patient(Generation::Gen1);
    let window = Window::connect(&controller, PollRate::DEFAULT);
    window.drive(&controller);
    // From here on the window neither renews nor reads, while the thread polls on and feeds the controller's own time-out.
    off(&controller, "frozen window").assert_by_command();
    let is_dead_man = |event: &Event| matches!(event, Event::Disarmed(DisarmReason::DeadMan));
    window.wait_for("a word about it", is_dead_man);
}

#[test]
fn stop_all_overtakes_polling_at_full_speed() {
    let controller = OnPty::patient(Generation::Gen4);
    let window = Window::connect(&controller, PollRate::Fastest);
    window.drive(&controller);
    window.handle.stop_all();
    off(&controller, "stop all").assert_by_command();
    let Event::Stopped(report) = window.wait_for("a report", |event| matches!(event, Event::Stopped(_)))
    else {
        unreachable!("it was waited for")
    };
    println!("stop bytes on the wire after {:?}", report.latency());
    assert!(report.confirmed(), "{report:?}");
}

#[test]
fn closing_the_window_stops_both_motors_first() {
    let controller = OnPty::patient(Generation::Gen2);
    let window = Window::connect(&controller, PollRate::DEFAULT);
    window.drive(&controller);
    drop(window); // returns when the stop is confirmed; the duty then falls at the highest acceleration
    off(&controller, "closed window").assert_by_command();
}

#[test]
fn a_pulled_plug_is_told_and_the_controllers_own_time_out_stops_both_motors() {
    let controller = OnPty::start(Generation::Gen3);
    let window = Window::connect(&controller, PollRate::DEFAULT);
    window.drive(&controller);
    controller.apply(WorldAction::Unplug { unplugged: true });
    let factory_time_out = Duration::from_secs(1);
    off(&controller, "pulled plug").assert_by_time_out(factory_time_out);
    let Event::Lost(failure) = window.wait_for("the loss", |event| matches!(event, Event::Lost(_))) else {
        unreachable!("it was waited for")
    };
    println!("{failure}");
}

#[test]
fn connecting_and_polling_never_moves_a_motor() {
    let controller = OnPty::start(Generation::Gen1);
    let before = controller.look(|unit| unit.view().axes.map(|axis| axis.encoder_counts));
    let window = Window::connect(&controller, PollRate::Fastest);
    for _ in 0..100 {
        assert!(!controller.look(is_driven), "a bridge was driven");
        window.handle.events().try_iter().for_each(drop);
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(before, controller.look(|unit| unit.view().axes.map(|axis| axis.encoder_counts)));
}
