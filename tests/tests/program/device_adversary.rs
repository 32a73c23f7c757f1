//! Attempts to get a motor driven that should stand: everything that could go wrong at the worst moment, in virtual time against
//! the simulated controller.

use brushwork_tests::said::Said;
use std::time::Duration;

use brushwork_link::Stream;
use brushwork_link::device::{
    ArmScope, DeviceHandle, DeviceOptions, DisarmReason, Drive, DriveCommand, Event, Job, PollRate, Request,
};
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_wire::packet_serial::{Address, Generation, number};
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::WorldAction;
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_values::{Motor, Value};

/// From full duty to none at the highest acceleration, 655359 of 32768 per full duty and second, and the ticks around it.
const RAMP_DOWN: Duration = Duration::from_millis(58);

fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

fn link(stream: Stream, index: StreamIndex, generation: Generation) -> VirtualLink {
    bus_link(stream, index, generation, &[0x80])
}

fn bus_link(stream: Stream, index: StreamIndex, generation: Generation, addresses: &[u8]) -> VirtualLink {
    let units = addresses.iter().map(|address| {
        let address = Address::new(*address).expect("it is one of the eight");
        Controller::new(ControllerConfig { address, generation, ..ControllerConfig::default() })
            .expect("the default world is sound")
    });
    let bus = Bus::new(units.collect(), index).expect("one unit, or a bus of them");
    let options = DeviceOptions { stream: Some(stream), simulated: true, ..DeviceOptions::default() };
    let mut link = VirtualLink::new(bus, index, options, Vec::new(), 1);
    link.run_for(ms(3_000));
    link
}

fn usb(generation: Generation) -> VirtualLink {
    link(Stream::Usb, StreamIndex::Usb, generation)
}

fn rs232() -> VirtualLink {
    link(Stream::Rs232, StreamIndex::Uart0, Generation::Gen1)
}

fn start(link: &mut VirtualLink, unit: usize) {
    assert!(link.arm(ArmScope::Pwm), "{:?}", link.events);
    link.drive(0.5);
    link.run_for(ms(200));
    assert!(link.duties(unit).iter().all(|duty| *duty > 0.4), "{:?}", link.events);
    link.events.clear();
}

fn transact(command: u8, values: &[i64]) -> Request {
    Request::Transact { id: 1, command, values: values.iter().copied().map(Value::Int).collect() }
}

fn disarm_reasons(link: &VirtualLink) -> Vec<DisarmReason> {
    let reasons = link.events.iter().filter_map(|(_, event)| match event {
        Event::Disarmed(reason) => Some(reason.clone()),
        _ => None,
    });
    reasons.collect()
}

fn was_armed(link: &VirtualLink) -> bool {
    link.events.iter().any(|(_, event)| matches!(event, Event::Armed { .. }))
}

/// Watches for a time that no motor of a unit is driven.
fn assert_at_rest(link: &mut VirtualLink, unit: usize, time: Duration, when: &str) {
    let until = link.now() + time;
    while link.now() < until && !link.ended {
        link.run_for(ms(5));
        assert_eq!(link.duties(unit), [0.0, 0.0], "{when}, at {:?}: {:?}", link.now(), link.events);
    }
}

/// One of each kind of request that does not end the link.
fn every_request(index: usize) -> Option<Request> {
    let duty = Drive::both(DriveCommand::duty(0.7));
    let step = DriveCommand::Distance {
        speed_counts_per_s: 2_000,
        accel_counts_per_s2: None,
        distance_counts: 4_000,
        queued: true,
    };
    Some(match index {
        0 => Request::Arm(ArmScope::Pwm),
        1 => Request::Arm(ArmScope::Velocity),
        2 => Request::Drive(duty),
        3 => Request::Drive(Drive::one(Motor::M2, step)),
        4 => Request::SetEncoder { motor: Motor::M1, counts: 7 },
        5 => Request::ZeroEncoders,
        6 => Request::ResetEStop,
        7 => Request::StartScript,
        8 => Request::StopScript,
        9 => transact(number::READ_SIGNALS, &[]),
        10 => transact(number::SET_VELOCITY_PID_M1, &[0, 65_536, 32_768, 44_000]),
        11 => transact(number::DUTY_M1, &[20_000]),
        12 => Request::Poll(PollRate::Fastest),
        13 => Request::Select(0x80),
        14 => Request::SetStream(Stream::Rs232),
        15 => Request::Trace(true),
        16 => Request::Disarm,
        17 => Request::Job(
            Job::<()>::moving(Said::Wander, ms(400), |context| {
                loop {
                    let moved =
                        context.transact(number::DUTY_M1, &[9_000]).and_then(|_| context.sleep(ms(20)));
                    if let Err(error) = moved {
                        return Err(error.failure(Said::Wander, "the bench"));
                    }
                }
            })
            .queued()
            .0,
        ),
        _ => return None,
    })
}

#[test]
fn stop_at_any_moment_of_any_request_stands_the_motors_and_nothing_moves_after_it() {
    let mut link = rs232();
    for index in (0..).take_while(|index| every_request(*index).is_some()) {
        for after in [0, 1, 2, 4, 7, 11, 16, 24] {
            let when = format!("Stop {after} ms after request {index}");
            start(&mut link, 0);
            // Two of a kind, so that one waits behind the other.
            for request in [every_request(index), every_request(index)].into_iter().flatten() {
                link.ask(request);
            }
            let stop_at = link.now() + ms(after);
            link.at(stop_at, |handle| {
                let _ = handle.request(Request::Drive(Drive::both(DriveCommand::duty(0.9))));
                handle.stop_all();
                let _ = handle.request(Request::Drive(Drive::both(DriveCommand::duty(-0.9))));
            });
            // Stop's bytes wait for at most one write of another request: 57 bytes of 115200 baud take 5 ms.
            let stands = link.duties_at(stop_at + ms(12) + RAMP_DOWN, 0);
            link.run_for(ms(after + 12) + RAMP_DOWN + ms(5));
            assert_eq!(*stands.lock().expect("nothing panicked"), Some([0.0, 0.0]), "{when}");
            assert_at_rest(&mut link, 0, ms(400), &when);
            assert!(link.stops().iter().any(|stop| stop.confirmed()), "{when}");
            assert!(!link.ended, "{when}: {:?}", link.events);
        }
    }
}

#[test]
fn a_drive_around_a_disarm_does_not_outlive_it() {
    for after in 0..30 {
        let mut link = rs232();
        start(&mut link, 0);
        // 71 ms of reply, in the middle of which all of it is asked for.
        link.ask(transact(number::READ_SIGNALS, &[]));
        link.at(link.now() + ms(3 * after), |handle| {
            let _ = handle.request(Request::Drive(Drive::both(DriveCommand::duty(0.9))));
            let _ = handle.request(Request::Disarm);
            let _ = handle.request(Request::Drive(Drive::both(DriveCommand::duty(-0.9))));
        });
        link.run_for(ms(3 * after + 120) + RAMP_DOWN);
        assert_eq!(disarm_reasons(&link), [DisarmReason::Asked]);
        assert_at_rest(&mut link, 0, ms(300), &format!("disarmed after {} ms", 3 * after));
    }
}

#[test]
fn a_drive_asked_for_before_arming_does_not_run_after_it() {
    let mut link = usb(Generation::Gen1);
    link.drive(0.5);
    assert!(link.arm(ArmScope::Pwm));
    assert_at_rest(&mut link, 0, ms(500), "armed after the drive");
}

#[test]
fn a_window_that_hangs_while_armed_at_rest_moves_nothing_then_or_afterwards() {
    let mut link = usb(Generation::Gen1);
    assert!(link.arm(ArmScope::Pwm));
    link.freeze_window();
    assert_at_rest(&mut link, 0, ms(5_000), "frozen");
    link.thaw_window();
    assert_at_rest(&mut link, 0, ms(500), "thawed");
}

#[test]
fn a_link_lost_at_any_moment_of_arming_is_not_armed_afterwards() {
    for after in 0..24 {
        let mut link = rs232();
        link.events.clear();
        link.ask(Request::Arm(ArmScope::Pwm));
        link.run_for(ms(2 * after));
        link.apply(0, &WorldAction::Unplug { unplugged: true });
        link.drive(0.5);
        link.run_for(ms(3_000));
        assert!(link.ended, "after {} ms: {:?}", 2 * after, link.events);
        if was_armed(&link) {
            assert_eq!(disarm_reasons(&link).len(), 1, "after {} ms: {:?}", 2 * after, link.events);
        }
        // The cable comes back: nobody is connected, nothing moves.
        link.apply(0, &WorldAction::Unplug { unplugged: false });
        link.machine_alone_for(ms(1_500));
        assert_eq!(link.duties(0), [0.0, 0.0]);
    }
}

#[test]
fn a_fault_that_goes_away_does_not_bring_the_motion_back() {
    for generation in Generation::ALL {
        let mut link = usb(generation);
        // The E-stop resets by itself when it is released.
        let automatic = if generation == Generation::Gen4 { 0x55 } else { 0xAA };
        link.ask(transact(number::SET_ESTOP_LOCK, &[automatic]));
        link.run_for(ms(100));
        start(&mut link, 0);
        link.apply(0, &WorldAction::EStop { pressed: true });
        link.run_for(ms(300));
        assert!(matches!(disarm_reasons(&link).as_slice(), [DisarmReason::Fault(_)]), "{:?}", link.events);
        link.apply(0, &WorldAction::EStop { pressed: false });
        link.ask(Request::ResetEStop);
        let _ = link.handle.request(Request::Drive(Drive::both(DriveCommand::duty(0.9))));
        assert_at_rest(&mut link, 0, ms(1_500), "the E-stop was released");
        assert!(!was_armed(&link));
    }
}

/// Lets the unit lose its power while its motors run, and says why it was disarmed.
fn power_lost_for(mut link: VirtualLink, off_for: Duration, when: &str) -> Vec<DisarmReason> {
    start(&mut link, 0);
    link.apply(0, &WorldAction::Power { on: false });
    link.run_for(off_for);
    link.apply(0, &WorldAction::Power { on: true });
    link.run_for(ms(800));
    let reasons = disarm_reasons(&link);
    assert_eq!(reasons.len(), 1, "{when}: {:?}", link.events);
    let _ = link.handle.request(Request::Drive(Drive::both(DriveCommand::duty(0.9))));
    assert_at_rest(&mut link, 0, ms(500), when);
    reasons
}

#[test]
fn a_unit_that_lost_its_power_while_armed_is_disarmed() {
    for generation in Generation::ALL {
        for off_for in [1, 10, 50, 100, 300, 1_000].map(ms) {
            // Over USB the port goes with the power.
            let when = format!("{generation} on USB, without power for {off_for:?}");
            power_lost_for(usb(generation), off_for, &when);
            // Over a cable of its own only silence shows it; the newest generation also tells its running time.
            let when = format!("{generation} on RS-232, without power for {off_for:?}");
            let is_seen = off_for >= ms(300) || generation == Generation::Gen4;
            if is_seen {
                power_lost_for(link(Stream::Rs232, StreamIndex::Uart0, generation), off_for, &when);
            }
        }
    }
    let blink = link(Stream::Rs232, StreamIndex::Uart0, Generation::Gen4);
    assert_eq!(power_lost_for(blink, ms(1), "a blink"), [DisarmReason::Restarted]);
}

#[test]
fn a_unit_that_gets_another_address_while_it_moves_is_stopped_first() {
    for (stream, index) in [(Stream::Usb, StreamIndex::Usb), (Stream::Ttl1, StreamIndex::Uart1)] {
        let mut link = link(stream, index, Generation::Gen1);
        start(&mut link, 0);
        // Address 0x83, channels not mixed.
        link.ask(transact(number::SET_ADDRESS_MIXED, &[0x83, 0]));
        link.run_for(ms(30) + RAMP_DOWN);
        assert_eq!(disarm_reasons(&link), [DisarmReason::SettingsChanged]);
        assert_at_rest(&mut link, 0, ms(500), &format!("moved to 0x83 on {stream}"));
    }
}

#[test]
fn a_silent_unit_on_the_bus_does_not_delay_the_stop_of_the_others() {
    let mut link = bus_link(Stream::Ttl1, StreamIndex::Uart1, Generation::Gen1, &[0x80, 0x81, 0x85]);
    for dead in [0, 1] {
        link.ask(Request::Select(0x85));
        start(&mut link, 2);
        link.apply(dead, &WorldAction::Power { on: false });
        let stop_at = link.now() + ms(37);
        link.at(stop_at, DeviceHandle::stop_all);
        let stands = link.duties_at(stop_at + ms(20) + RAMP_DOWN, 2);
        link.run_for(ms(3_000));
        assert_eq!(*stands.lock().expect("nothing panicked"), Some([0.0, 0.0]));
        let stop = link.stops()[0].clone();
        assert!(stop.latency() < ms(3), "{:?}", stop.latency());
        let confirmed: Vec<_> = stop.units.iter().map(|unit| (unit.address, unit.confirmed)).collect();
        let dead_address = [0x80, 0x81][dead];
        for (address, confirmed) in confirmed {
            assert_eq!(confirmed, address != dead_address, "0x{address:02X}");
        }
        link.apply(dead, &WorldAction::Power { on: true });
        link.run_for(ms(1_000));
    }
}

#[test]
fn a_settings_job_that_changes_what_arming_was_based_on_stops_the_motors_first_and_goes_on() {
    let mut link = usb(Generation::Gen1);
    start(&mut link, 0);
    let job = Job::new(Said::Settings, ms(2_000), |context| {
        let fail = |error: brushwork_link::ExchangeError| error.failure(Said::Settings, "the bench");
        context.transact(number::SET_STREAM, &[0, 1, 115_200, 0]).map_err(fail)?;
        context.transact(number::SET_VELOCITY_PID_M1, &[0, 65_536, 32_768, 30_000]).map_err(fail)?;
        Ok(())
    });
    link.start(job);
    link.run_for(ms(100) + RAMP_DOWN);
    assert_eq!(disarm_reasons(&link), [DisarmReason::SettingsChanged]);
    let report = link.events.iter().find_map(|(_, event)| match event {
        Event::JobEnded(report) => Some(format!("{:?}", report.ending)),
        _ => None,
    });
    assert!(report.as_ref().is_some_and(|ending| ending.starts_with("Done")), "{report:?}");
    assert_at_rest(&mut link, 0, ms(500), "the job is done");
    assert!(!link.arm(ArmScope::Pwm), "the time-out of the port is 0 now");
}
