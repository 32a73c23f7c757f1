//! Who may move motors, and for how long: arming, its refusals, what disarms, and the dead-man.

use crate::tests::link::harness::{DUTY_ZERO, Link};
use crate::tests::testing::ms;
use crate::tests::testing::unit::{Bus, SharedBus};
use brushwork_link::clock::Clock;
use brushwork_link::device::DeviceOptions;
use brushwork_link::device::PollRate;
use brushwork_link::device::Request;
use brushwork_link::device::StopBytes;
use brushwork_link::device::{ArmScope, Drive, DriveCommand};
use brushwork_link::device::{DisarmReason, Event};
use brushwork_link::guardian::{Guardian, LineGuard};
use brushwork_link::transport::{SecondWay, Stream};
use brushwork_mcp_wire::packet_serial::number;
use brushwork_values::{Motor, Value};
use std::collections::BTreeSet;
use std::io;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Asks for arming on a link to `bus` and returns the sentences of the refusal.
fn refusal(bus: SharedBus, stream: Option<Stream>) -> Vec<String> {
    let mut link = Link::with(bus, DeviceOptions { stream, ..DeviceOptions::default() });
    link.run_for(ms(1_500));
    link.forget();
    link.ask(Request::Arm(ArmScope::Pwm));
    link.run_for(ms(1_500));
    assert!(!link.has(|event| matches!(event, Event::Armed { .. })), "it was armed");
    link.drive(0.5);
    link.run_for(ms(300));
    assert!(!moved(&link), "an unarmed motor was driven");
    link.events.retain(|(_, event)| matches!(event, Event::ArmRefused { .. }));
    link.sentences()
}

fn moved(link: &Link) -> bool {
    !link.taken(number::DUTY_BOTH).is_empty()
}

#[test]
fn a_controller_that_would_stop_by_itself_is_armed_and_its_time_is_told() {
    let link = Link::armed();
    let armed = link.events.iter().find_map(|(_, event)| match event {
        Event::Armed { address, scope, controller_timeout, warnings } => {
            Some((*address, *scope, *controller_timeout, warnings.clone()))
        }
        _ => None,
    });
    assert_eq!(armed, Some((0x80, ArmScope::Pwm, Some(ms(1_000)), Vec::new())));
}

#[test]
fn arming_is_refused_when_the_ports_time_out_is_zero() {
    let bus = Bus::shared();
    bus.lock().unwrap().set_streams(&[1000, 1000, 0, 1000, 1000]);
    assert_eq!(
        refusal(bus, Some(Stream::Ttl1)),
        [
            "Could not arm the motors on 0x80 at /dev/test: the time-out of TTL UART1 is 0, so the motors would run on if this \
          program died. Set the priority time-out of TTL UART1 in General Settings, to 1000 ms for example."
        ]
    );
}

#[test]
fn a_time_out_of_zero_elsewhere_does_not_matter_when_the_port_is_known() {
    let bus = Bus::shared();
    bus.lock().unwrap().set_streams(&[500, 0, 0, 0, 0]);
    let mut link = Link::with(bus, DeviceOptions { stream: Some(Stream::Usb), ..DeviceOptions::default() });
    link.run_for(ms(1_500));
    link.ask(Request::Arm(ArmScope::Pwm));
    link.run_for(ms(100));
    assert!(link.has(
        |event| matches!(event, Event::Armed { controller_timeout: Some(timeout), .. } if *timeout == ms(500))
    ));
}

#[test]
fn an_unknown_port_is_armed_only_if_every_one_it_could_be_has_a_time_out() {
    let bus = Bus::shared();
    bus.lock().unwrap().set_streams(&[1000, 0, 1000, 1000, 1000]);
    assert_eq!(
        refusal(bus, None),
        [
            "Could not arm the motors on 0x80 at /dev/test: it was not said which connector of the controller this port is, and \
          RS232 UART0 has no time-out. Choose the connector, or give it with the port: \",stream=usb\"."
        ]
    );
    let mut link = Link::with(Bus::shared(), DeviceOptions::default());
    link.run_for(ms(1_500));
    link.ask(Request::Arm(ArmScope::Pwm));
    link.run_for(ms(100));
    assert!(link.has(|event| matches!(event, Event::Armed { .. })), "all five have one");
}

#[test]
fn naming_the_port_afterwards_lets_it_be_armed() {
    let bus = Bus::shared();
    bus.lock().unwrap().set_streams(&[1000, 0, 0, 0, 0]);
    let mut link = Link::with(bus, DeviceOptions::default());
    link.run_for(ms(1_500));
    link.ask(Request::Arm(ArmScope::Pwm));
    link.ask(Request::SetStream(Stream::Usb));
    link.ask(Request::Arm(ArmScope::Pwm));
    link.run_for(ms(100));
    assert!(link.has(|event| matches!(event, Event::ArmRefused { .. })));
    assert!(link.has(|event| matches!(event, Event::Armed { .. })));
}

#[test]
fn arming_is_refused_when_serial_is_in_no_priority_level() {
    let bus = Bus::shared();
    bus.lock().unwrap().set(number::READ_PRIORITIES, &[2, 3, 0]);
    assert_eq!(
        refusal(bus, Some(Stream::Usb)),
        [
            "Could not arm the motors on 0x80 at /dev/test: Serial is in none of the three priority levels, so the controller \
          does not take its motion from this port. Set priority level 1 to Serial in General Settings."
        ]
    );
}

#[test]
fn arming_is_refused_when_the_controller_does_not_tell_its_time_out() {
    let bus = Bus::shared();
    bus.lock().unwrap().mute = BTreeSet::from([number::READ_STREAMS, number::READ_SERIAL_TIMEOUT]);
    assert_eq!(
        refusal(bus, Some(Stream::Usb)),
        [
            "Could not arm the motors on 0x80 at /dev/test: the controller does not tell its serial time-out, so it is not known \
          whether the motors would stop if this program died. Drive this controller with another program that you can watch."
        ]
    );
}

#[test]
fn a_roboclaw_is_judged_by_its_one_serial_time_out() {
    // What 99 tells of the control mode: packet serial is 3, R/C 0 and analog 1.
    for (raw, config, timeout) in [
        (0, 0x63, None),
        (5, 0x63, Some(ms(500))),
        (5, 0x60, None),
        (5, 0x61, None),
        (5, 0x62, Some(ms(500))),
    ] {
        let bus = Bus::shared();
        crate::tests::testing::unit::of_generation(&bus, brushwork_mcp_wire::packet_serial::Generation::Gen3);
        bus.lock().unwrap().mute = BTreeSet::from([number::READ_STREAMS, number::READ_PRIORITIES]);
        bus.lock().unwrap().set(number::READ_SERIAL_TIMEOUT, &[raw]);
        bus.lock().unwrap().set(number::READ_CONFIG, &[config]);
        let mut link = Link::with(bus, DeviceOptions::default());
        link.run_for(ms(1_500));
        link.ask(Request::Arm(ArmScope::Pwm));
        link.run_for(ms(1_500));
        let armed = link.events.iter().find_map(|(_, event)| match event {
            Event::Armed { controller_timeout, .. } => *controller_timeout,
            _ => None,
        });
        assert_eq!(armed, timeout);
        link.events.retain(|(_, event)| matches!(event, Event::ArmRefused { .. }));
        let sentences = link.sentences();
        assert_eq!(sentences.is_empty(), timeout.is_some(), "{sentences:?}");
        let is_of_mode = sentences.iter().any(|sentence| {
            sentence.contains("S1 and S2 command the motors") && sentence.contains("mode=packet_serial")
        });
        assert_eq!(is_of_mode, config & 0b10 == 0, "{sentences:?}");
    }
}

#[test]
fn arming_is_refused_while_the_controller_reports_a_fault_and_every_reason_is_given() {
    let bus = Bus::shared();
    // Bit 2 in generation 1: E-stop.
    bus.lock().unwrap().set(number::READ_STATUS, &[0x0004]);
    bus.lock().unwrap().set_streams(&[0; 5]);
    let sentences = refusal(bus, Some(Stream::Usb));
    assert_eq!(sentences.len(), 2, "{sentences:?}");
    assert!(sentences[0].contains("time-out of USB is 0"), "{sentences:?}");
    assert!(
        sentences[1].contains("the controller reports") && sentences[1].contains("Stop"),
        "{sentences:?}"
    );
}

#[test]
fn pins_that_can_drive_a_motor_are_told_at_arming() {
    let bus = Bus::shared();
    {
        let mut bus = bus.lock().unwrap();
        bus.set(number::READ_PRIORITIES, &[1, 3, 0]);
        // Type analog, target motor 2, everything else 0; then a pin that is aimed at nothing.
        let pin = |target| [vec![1, 0, target, 0, 0], vec![0; 10]].concat();
        bus.values.insert(number::READ_SIGNALS, vec![Value::Records(vec![pin(2), pin(0)])]);
    }
    let mut link = Link::with(bus, DeviceOptions { stream: Some(Stream::Usb), ..DeviceOptions::default() });
    link.run_for(ms(1_500));
    link.ask(Request::Arm(ArmScope::Pwm));
    link.run_for(ms(100));
    let warnings = link.events.iter().find_map(|(_, event)| match event {
        Event::Armed { warnings, .. } => Some(warnings.clone()),
        _ => None,
    });
    assert_eq!(warnings.unwrap(), ["The analog input DIN1 can drive motor 2."]);
}

#[test]
fn torque_control_is_told_at_arming_since_stop_brakes_nothing_there() {
    let bus = Bus::shared();
    bus.lock().unwrap().set(number::READ_INDUCTANCE_RESISTANCE_M2, &[1_000, 2_000]);
    let mut link = Link::with(bus, DeviceOptions { stream: Some(Stream::Usb), ..DeviceOptions::default() });
    link.run_for(ms(1_500));
    link.ask(Request::Arm(ArmScope::Pwm));
    link.run_for(ms(100));
    let warnings = link.events.iter().find_map(|(_, event)| match event {
        Event::Armed { warnings, .. } => Some(warnings.clone()),
        _ => None,
    });
    assert_eq!(warnings.unwrap(), ["M2 is in torque control: Stop lets it coast instead of braking it."]);
}

#[test]
fn nothing_moves_before_arming_and_the_failure_says_what_to_do() {
    let mut link = Link::connected();
    link.drive(0.5);
    link.ask(Request::Transact { id: 7, command: number::SPEED_M1, values: vec![Value::Int(100)] });
    link.ask(Request::StartScript);
    link.run_for(ms(100));
    let commands = link.bus().commands();
    for command in [number::DUTY_BOTH, number::SPEED_M1, number::START_SCRIPT] {
        assert!(!commands.contains(&command), "{command} went out");
    }
    assert_eq!(
        link.sentences()[0],
        "Could not move the motors on 0x80 at /dev/test: the motors are not armed for \"duty\". Arm the motors on this \
         screen first."
    );
    assert_eq!(link.sentences().len(), 3);
}

#[test]
fn an_armed_screen_drives_and_its_setpoint_is_in_the_sample() {
    let mut link = Link::armed();
    link.drive(0.25);
    link.run_for(ms(300));
    assert_eq!(link.taken(number::DUTY_BOTH)[0].values, [8_192, 8_192]);
    use brushwork_link::device::Channel;
    assert!(link.has(
        |event| matches!(event, Event::Sample(sample) if sample.get(Channel::M1_SETPOINT) == Some(25.0))
    ));
}

#[test]
fn a_script_starts_only_from_its_own_screen_and_that_screen_drives_nothing() {
    let mut link = Link::armed();
    link.ask(Request::StartScript);
    link.run_for(ms(100));
    assert_eq!(link.bus().count(number::START_SCRIPT), 0);
    link.ask(Request::Arm(ArmScope::Script));
    link.ask(Request::StartScript);
    link.run_for(ms(100));
    link.drive(0.5);
    link.run_for(ms(100));
    assert_eq!(link.bus().count(number::START_SCRIPT), 1);
    assert!(!moved(&link));
    link.forget();
    link.ask(Request::Disarm);
    link.run_for(ms(200));
    assert!(link.bus().count(number::STOP_SCRIPT) >= 1, "leaving the screen ends the script");
}

#[test]
fn motion_dies_250_ms_after_the_last_renewal_to_the_millisecond() {
    for rate in [PollRate::Off, PollRate::DEFAULT, PollRate::Fastest] {
        let mut link = Link::armed();
        link.ask(Request::Poll(rate));
        link.drive(0.5);
        link.run_for(ms(1_000));
        assert!(link.disarm_reasons().is_empty(), "a living window keeps motion alive");
        link.handle.renew();
        let renewed_at = link.clock.now();
        link.window_alive = false;
        link.forget();
        link.run_for(ms(1_000));
        let stop = &link.taken(number::DUTY_ACCEL_BOTH)[0];
        assert_eq!(stop.at - renewed_at, ms(250), "while reading {rate:?}");
        assert_eq!(stop.values, DUTY_ZERO);
        assert_eq!(link.disarm_reasons(), [DisarmReason::DeadMan]);
        assert!(link.stops()[0].confirmed());
    }
}

#[test]
fn the_dead_man_does_not_wait_for_a_reply_that_takes_long() {
    let mut link = Link::armed();
    link.bus().slow.insert(number::READ_SIGNALS, ms(45));
    link.drive(0.5);
    link.run_for(ms(100));
    link.handle.renew();
    let renewed_at = link.clock.now();
    link.window_alive = false;
    link.run_until(renewed_at + ms(240));
    link.ask(Request::Transact { id: 1, command: number::READ_SIGNALS, values: Vec::new() });
    link.forget();
    link.run_for(ms(200));
    let stop = &link.taken(number::DUTY_ACCEL_BOTH)[0];
    assert_eq!(stop.at - renewed_at, ms(250));
}

#[test]
fn a_drive_that_waited_too_long_is_not_sent() {
    let mut link = Link::armed();
    link.drive(0.5);
    link.clock.advance(ms(251));
    link.run_for(ms(50));
    assert!(!moved(&link));
    assert!(
        link.sentences()[0].contains("waited for longer than a motion may live"),
        "{:?}",
        link.sentences()
    );
}

#[test]
fn of_duties_that_wait_only_the_last_is_sent_and_moves_are_all_sent() {
    let mut link = Link::armed();
    for step in 1..=5 {
        link.drive(f64::from(step) / 10.0);
    }
    link.run_for(ms(100));
    let duties = link.taken(number::DUTY_BOTH);
    assert_eq!(duties.len(), 1);
    assert_eq!(duties[0].values, [16_384, 16_384]);
    let reported: Vec<_> = link
        .events
        .iter()
        .filter_map(|(at, event)| match event {
            Event::Driven { sent_at, drive, .. } => Some((*sent_at <= *at, *drive)),
            _ => None,
        })
        .collect();
    assert_eq!(
        reported,
        [(true, Drive::both(DriveCommand::duty(0.5)))],
        "what was sent is told, and nothing else"
    );
    let step = DriveCommand::Distance {
        speed_counts_per_s: 100,
        accel_counts_per_s2: None,
        distance_counts: 10,
        queued: true,
    };
    for _ in 0..3 {
        link.ask(Request::Drive(Drive::one(Motor::M1, step)));
    }
    link.run_for(ms(100));
    assert_eq!(link.bus().count(number::SPEED_DISTANCE_M1), 3);
}

#[test]
fn disarming_stops_the_motors() {
    let mut link = Link::armed();
    link.drive(0.5);
    link.run_for(ms(50));
    link.ask(Request::Disarm);
    link.run_for(ms(100));
    assert_eq!(link.disarm_reasons(), [DisarmReason::Asked]);
    assert_eq!(link.taken(number::DUTY_ACCEL_BOTH)[0].values, DUTY_ZERO);
    link.forget();
    link.drive(0.5);
    link.run_for(ms(50));
    assert!(!moved(&link));
}

#[test]
fn a_disarm_after_an_arm_wins_even_if_both_wait() {
    let mut link = Link::connected();
    link.ask(Request::Arm(ArmScope::Pwm));
    link.ask(Request::Disarm);
    link.drive(0.5);
    link.run_for(ms(200));
    assert_eq!(link.disarm_reasons(), [DisarmReason::Asked]);
    assert!(!moved(&link));
}

#[test]
fn another_screen_disarms_the_first_and_stops_before_it_is_armed() {
    let mut link = Link::armed();
    link.drive(0.5);
    link.run_for(ms(50));
    link.forget();
    link.ask(Request::Arm(ArmScope::Velocity));
    link.run_for(ms(200));
    assert_eq!(link.disarm_reasons(), [DisarmReason::ScopeChange]);
    let disarmed = link.when(|event| matches!(event, Event::Disarmed(_))).unwrap();
    let armed = link.when(|event| matches!(event, Event::Armed { scope: ArmScope::Velocity, .. })).unwrap();
    assert!(disarmed <= armed);
    assert_eq!(link.bus().commands()[..1], [number::DUTY_ACCEL_BOTH]);
}

#[test]
fn a_fault_disarms_and_a_warning_does_not() {
    let mut link = Link::armed();
    link.drive(0.5);
    // Bit 0 in generation 1: M1 over-current warning.
    link.bus().set(number::READ_STATUS, &[0x0001]);
    link.run_for(ms(500));
    assert!(link.disarm_reasons().is_empty());
    // Bit 5: main battery high error.
    link.bus().set(number::READ_STATUS, &[0x0020]);
    link.run_for(ms(500));
    let reasons = link.disarm_reasons();
    assert!(matches!(reasons.as_slice(), [DisarmReason::Fault(_)]), "{reasons:?}");
    assert_eq!(link.taken(number::DUTY_ACCEL_BOTH)[0].values, DUTY_ZERO);
}

#[test]
fn a_drive_that_is_not_confirmed_disarms_and_stops() {
    let mut link = Link::armed();
    link.bus().mute.insert(number::DUTY_BOTH);
    link.drive(0.5);
    link.run_for(ms(500));
    assert_eq!(link.bus().count(number::DUTY_BOTH), 3, "an absolute motion is tried three times");
    assert_eq!(link.disarm_reasons(), [DisarmReason::NoAnswer]);
    assert_eq!(link.taken(number::DUTY_ACCEL_BOTH)[0].values, DUTY_ZERO);
}

#[test]
fn a_relative_move_that_is_not_confirmed_goes_out_once_and_the_failure_says_it_may_have_run() {
    let mut link = Link::armed();
    link.bus().mute.insert(number::SPEED_DISTANCE_M1);
    let step = DriveCommand::Distance {
        speed_counts_per_s: 100,
        accel_counts_per_s2: None,
        distance_counts: 10,
        queued: true,
    };
    link.ask(Request::Drive(Drive::one(Motor::M1, step)));
    link.run_for(ms(500));
    assert_eq!(link.bus().count(number::SPEED_DISTANCE_M1), 1);
    assert!(link.sentences()[0].contains("may have been carried out"), "{:?}", link.sentences());
    assert_eq!(link.disarm_reasons(), [DisarmReason::NoAnswer]);
}

#[test]
fn losing_the_link_disarms() {
    let mut link = Link::armed();
    link.drive(0.5);
    link.run_for(ms(50));
    link.tap.unplug();
    link.run_for(ms(300));
    assert_eq!(link.disarm_reasons(), [DisarmReason::LinkLost]);
    assert!(link.sentences()[0].contains("Make sure that the motors stand still"), "{:?}", link.sentences());
}

#[test]
fn a_controller_that_falls_silent_while_armed_is_stopped_at_the_first_unanswered_reading() {
    let mut link = Link::armed();
    link.drive(0.5);
    link.run_for(ms(50));
    link.bus().dead = true;
    link.forget();
    link.run_for(ms(3_000));
    assert_eq!(link.disarm_reasons(), [DisarmReason::NoAnswer]);
    assert!(!link.stops()[0].confirmed());
    let reported = link.stops()[0].units[0].failures[0].to_string();
    assert!(reported.contains("Cut the motor power now"), "{reported}");
    assert!(link.has(|event| matches!(event, Event::Lost(_))), "silence for two seconds is a lost link");
}

#[test]
fn changing_a_setting_that_arming_was_based_on_disarms() {
    for (command, values) in [
        (number::SET_STREAM, vec![0, 1, 115_200, 0]),
        (number::SET_PRIORITIES, vec![0, 0, 0]),
        (number::RELOAD_SETTINGS, vec![]),
    ] {
        let mut link = Link::armed();
        link.drive(0.5);
        link.run_for(ms(50));
        let values = values.into_iter().map(Value::Int).collect();
        link.ask(Request::Transact { id: 1, command, values });
        link.run_for(ms(200));
        assert_eq!(link.disarm_reasons(), [DisarmReason::SettingsChanged], "command {command}");
    }
}

#[test]
fn while_armed_the_controller_hears_something_well_within_its_own_time_out() {
    let bus = Bus::shared();
    bus.lock().unwrap().set_streams(&[60; 5]);
    let mut link = Link::with(bus, DeviceOptions { stream: Some(Stream::Usb), ..DeviceOptions::default() });
    link.run_for(ms(1_500));
    link.ask(Request::Poll(PollRate::Off));
    link.ask(Request::Arm(ArmScope::Pwm));
    link.run_for(ms(100));
    link.forget();
    link.run_for(ms(2_000));
    let times: Vec<Duration> = link.bus().taken.iter().map(|taken| taken.at).collect();
    let longest = times.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap();
    assert!(longest <= ms(25), "{longest:?}");
    link.ask(Request::Disarm);
    link.run_for(ms(200));
    link.forget();
    link.run_for(ms(2_000));
    assert!(link.bus().taken.is_empty(), "reading is off again");
}

#[test]
fn closing_stops_what_moves() {
    let mut link = Link::armed();
    link.drive(0.5);
    link.run_for(ms(50));
    link.forget();
    link.ask(Request::Disconnect);
    link.settle_to_end();
    assert_eq!(link.disarm_reasons(), [DisarmReason::Closing]);
    assert_eq!(link.taken(number::DUTY_ACCEL_BOTH)[0].values, DUTY_ZERO);
    assert!(link.stops()[0].confirmed());
    assert!(link.has(|event| matches!(event, Event::Closed)));
}

/// What guards are told, in order, with the time on the clock of the link.
#[derive(Clone, Debug, Default)]
struct Told(Arc<Mutex<Vec<&'static str>>>);

impl Told {
    fn note(&self, what: &'static str) {
        self.0.lock().unwrap().push(what);
    }

    fn take(&self) -> Vec<&'static str> {
        std::mem::take(&mut self.0.lock().unwrap())
    }
}

impl Guardian for Told {
    fn start(&self, _port: &str, _line: SecondWay) -> io::Result<Box<dyn LineGuard>> {
        self.note("start");
        Ok(Box::new(self.clone()))
    }
}

impl LineGuard for Told {
    fn hold(&self, stop: &StopBytes) {
        assert!(!stop.is_empty());
        self.note("hold");
    }

    fn release(&self) {
        self.note("release");
    }

    fn moving(&self, moving: bool) {
        self.note(if moving { "moving" } else { "at rest" });
    }

    fn is_there(&self) -> bool {
        true
    }

    fn lives(&self) {}
}

#[test]
fn a_guard_knows_the_stop_before_anything_may_move_and_is_released_when_nothing_does() {
    let told = Told::default();
    let options = DeviceOptions {
        stream: Some(Stream::Usb),
        guardian: Some(Arc::new(told.clone())),
        ..DeviceOptions::default()
    };
    let mut link = Link::with(Bus::shared(), options);
    link.run_for(ms(500));
    assert_eq!(told.take(), [""; 0], "a line that moves nothing has none");
    link.ask(Request::Arm(ArmScope::Pwm));
    link.settle();
    assert_eq!(told.take(), ["start", "hold"]);
    assert!(!moved(&link));
    link.drive(0.5);
    link.run_for(ms(300));
    assert_eq!(told.take(), ["moving", "hold"], "by now the unit has moved");
    link.ask(Request::Disarm);
    link.run_for(ms(300));
    assert_eq!(told.take(), ["at rest", "release"]);
    link.ask(Request::Arm(ArmScope::Pwm));
    link.settle();
    assert_eq!(told.take(), ["hold"], "the line has its guard");
}

/// No process can be had.
#[derive(Debug)]
struct Nobody;

impl Guardian for Nobody {
    fn start(&self, _port: &str, _line: SecondWay) -> io::Result<Box<dyn LineGuard>> {
        Err(io::Error::other("too many processes"))
    }
}

#[test]
fn where_no_guard_can_be_had_arming_says_so() {
    let guardian: Option<Arc<dyn Guardian>> = Some(Arc::new(Nobody));
    let mut link = Link::with(
        Bus::shared(),
        DeviceOptions { stream: Some(Stream::Usb), guardian, ..DeviceOptions::default() },
    );
    link.run_for(ms(500));
    link.ask(Request::Arm(ArmScope::Pwm));
    link.settle();
    let said = |event: &Event| match event {
        Event::Armed { warnings, .. } => warnings.iter().any(|warning| {
            warning.to_string().starts_with(
                "No second process watches over this line (too many processes): if this program dies",
            )
        }),
        _ => false,
    };
    assert!(link.has(said), "{:?}", link.events);
}
