//! Stop overtakes everything, goes to every unit, and tells what became of it.

use crate::tests::link::harness::{DUTY_ZERO, Link};
use crate::tests::testing::ms;
use crate::tests::testing::unit::{Bus, SharedBus, of_roboclaws};
use brushwork_link::clock::Clock;
use brushwork_link::device::DeviceOptions;
use brushwork_link::device::PollRate;
use brushwork_link::device::Request;
use brushwork_link::device::StopReport;
use brushwork_link::device::{ArmScope, Drive, DriveCommand};
use brushwork_link::device::{DisarmReason, Event};
use brushwork_link::transport::Stream;
use brushwork_mcp_wire::packet_serial::number;
use brushwork_values::{Motor, Value};
use std::collections::BTreeSet;

#[test]
fn stop_all_is_duty_zero_then_end_of_script_and_duty_zero_armed_or_not() {
    let mut link = Link::connected();
    link.handle.stop_all();
    link.run_for(ms(200));
    let commands = link.bus().commands();
    let burst = [number::DUTY_ACCEL_BOTH, number::STOP_SCRIPT, number::DUTY_ACCEL_BOTH];
    assert_eq!(commands[..3], burst);
    assert_eq!(link.taken(number::DUTY_ACCEL_BOTH)[0].values, DUTY_ZERO);
    let report = &link.stops()[0];
    assert!(report.confirmed() && report.latency() == ms(0));
    assert_eq!(report.units[0].buffers_empty, Some(true));
    assert!(link.disarm_reasons().is_empty(), "nothing was armed");
}

#[test]
fn stop_overtakes_a_queue_of_settings_writes() {
    let mut link = Link::connected();
    link.ask(Request::Poll(PollRate::Off));
    link.settle();
    link.forget();
    for id in 0..40 {
        let values = vec![Value::Int(0); 4];
        link.ask(Request::Transact { id, command: number::SET_VELOCITY_PID_M1, values });
    }
    let handle = link.handle.clone();
    // In the middle of the eleventh write, each of which takes three milliseconds.
    link.bus().slow.insert(number::SET_VELOCITY_PID_M1, ms(3));
    let stop_at = link.clock.now() + ms(31) + ms(1) / 2;
    link.tap.at(stop_at, move || handle.stop_all());
    link.run_for(ms(300));
    let commands = link.bus().commands();
    let stopped = commands.iter().position(|command| *command == number::DUTY_ACCEL_BOTH).unwrap();
    let before =
        commands[..stopped].iter().filter(|command| **command == number::SET_VELOCITY_PID_M1).count();
    assert_eq!(before, 11, "{commands:?}");
    let late = link.taken(number::DUTY_ACCEL_BOTH)[0].at - stop_at;
    assert!(late <= ms(1), "{late:?} late: in mid-write it is seen at the end of the slice");
    assert_eq!(link.bus().count(number::SET_VELOCITY_PID_M1), 40, "the writes go on after it");
    let interrupted = link.sentences();
    assert_eq!(interrupted.len(), 1, "{interrupted:?}");
    assert!(interrupted[0].contains("Stop came first"), "{interrupted:?}");
}

#[test]
fn stop_does_not_wait_for_a_long_reply_and_the_rest_of_it_is_thrown_away() {
    let mut link = Link::armed();
    link.drive(0.5);
    link.run_for(ms(50));
    // 18 records in reply to 144, all of it arriving after 45 ms.
    let pins = Value::Records(vec![vec![0; 15]; 18]);
    link.bus().values.insert(number::READ_SIGNALS, vec![pins]);
    link.bus().slow.insert(number::READ_SIGNALS, ms(45));
    link.forget();
    link.ask(Request::Transact { id: 1, command: number::READ_SIGNALS, values: Vec::new() });
    let handle = link.handle.clone();
    let stop_at = link.clock.now() + ms(20);
    link.tap.at(stop_at, move || handle.stop_all());
    link.run_for(ms(500));
    let stop = &link.taken(number::DUTY_ACCEL_BOTH)[0];
    assert_eq!((stop.at, stop.values.as_slice()), (stop_at, DUTY_ZERO.as_slice()));
    let report = &link.stops()[0];
    assert!(report.confirmed(), "{report:?}");
    assert_eq!(report.latency(), ms(0));
    // After the late reply the line works on.
    assert_eq!(link.disarm_reasons(), [DisarmReason::Stop]);
    link.forget();
    link.run_for(ms(1_000));
    assert_eq!(link.sentences(), Vec::<String>::new());
    assert!(link.has(|event| matches!(event, Event::Sample(_))));
}

#[test]
fn motion_asked_for_before_stop_is_not_sent_after_it() {
    let mut link = Link::armed();
    link.drive(0.5);
    link.ask(Request::Arm(ArmScope::Velocity));
    link.handle.stop_all();
    link.run_for(ms(300));
    assert_eq!(link.bus().count(number::DUTY_BOTH), 0);
    let sentences = link.sentences().join(" ");
    assert!(sentences.contains("Stop was pressed after it"), "{sentences}");
    assert!(!link.has(|event| matches!(event, Event::Armed { scope: ArmScope::Velocity, .. })));
    link.ask(Request::Arm(ArmScope::Pwm));
    link.drive(0.5);
    link.run_for(ms(100));
    assert_eq!(link.bus().count(number::DUTY_BOTH), 1, "a fresh act moves again");
}

#[test]
fn stop_goes_to_every_unit_of_the_bus_the_selected_one_first() {
    let bus = Bus::shared();
    bus.lock().unwrap().addresses = BTreeSet::from([0x80, 0x83, 0x86]);
    let mut link = Link::with(bus, DeviceOptions { stream: Some(Stream::Ttl1), ..DeviceOptions::default() });
    link.run_for(ms(3_000));
    link.ask(Request::Select(0x83));
    link.run_for(ms(100));
    link.forget();
    link.handle.stop_all();
    link.run_for(ms(500));
    let stops = link.taken(number::DUTY_ACCEL_BOTH);
    let first: Vec<_> = stops[..3].iter().map(|taken| (taken.address, taken.at - stops[0].at)).collect();
    assert_eq!(first, [(0x83, ms(0)), (0x80, ms(0)), (0x86, ms(0))], "one write for all");
    assert_eq!(link.stops()[0].units.len(), 3);
    assert!(link.stops()[0].confirmed());
}

#[test]
fn one_dead_unit_does_not_keep_the_others_from_being_stopped_and_is_named() {
    let bus = Bus::shared();
    bus.lock().unwrap().addresses = BTreeSet::from([0x80, 0x83]);
    let mut link = Link::with(bus, DeviceOptions { stream: Some(Stream::Ttl1), ..DeviceOptions::default() });
    link.run_for(ms(3_000));
    link.bus().addresses = BTreeSet::from([0x83]);
    link.handle.stop_all();
    link.run_for(ms(1_000));
    let report = &link.stops()[0];
    let confirmed: Vec<_> = report.units.iter().map(|unit| (unit.address, unit.confirmed)).collect();
    assert_eq!(confirmed, [(0x80, false), (0x83, true)]);
    let reported = report.units[0].failures[0].to_string();
    assert!(reported.starts_with("Could not stop the motors on 0x80 at /dev/test: no answer"), "{reported}");
}

#[test]
fn buffers_that_are_not_empty_are_emptied() {
    let mut link = Link::armed();
    let step = DriveCommand::Distance {
        speed_counts_per_s: 100,
        accel_counts_per_s2: None,
        distance_counts: 10,
        queued: true,
    };
    link.ask(Request::Drive(Drive::one(Motor::M1, step)));
    link.run_for(ms(50));
    link.forget();
    link.bus().set(number::READ_BUFFERS, &[3, 0x80]);
    link.handle.stop_all();
    link.run_for(ms(200));
    let commands = link.bus().commands();
    let blind = [
        number::DUTY_ACCEL_BOTH,
        number::STOP_SCRIPT,
        number::DUTY_ACCEL_BOTH,
        number::SPEED_DISTANCE_BOTH,
        number::DUTY_ACCEL_BOTH,
    ];
    assert_eq!(commands[..5], blind, "a move was queued, so the buffers go in the first write");
    assert_eq!(link.taken(number::SPEED_DISTANCE_BOTH)[0].values, [0, 0, 0, 0, 1]);
    assert_eq!(link.stops()[0].units[0].buffers_empty, Some(false), "the bus says that one is not");
}

#[test]
fn what_can_still_drive_a_motor_after_stop_is_told() {
    let mut link = Link::connected();
    link.bus().set(number::READ_PRIORITIES, &[1, 2, 0]);
    // Pins of the MCP266: a pulse input on both motors, an analog one that no level lets through, and one whose maximum
    // runs the script (action 19 of generation 1: assumed numbering, see `codes`).
    let pin = |kind, target, max_action| [vec![kind, 0, target, 0, max_action], vec![0; 10]].concat();
    let pins = vec![pin(2, 3, 0), pin(1, 1, 0), pin(1, 0, 19)];
    link.bus().values.insert(number::READ_SIGNALS, vec![Value::Records(pins)]);
    link.bus().mute.insert(number::STOP_SCRIPT);
    link.handle.stop_all();
    link.run_for(ms(1_000));
    assert_eq!(
        link.stops()[0].units[0].still_driven_by,
        [
            "A script may still run: the controller did not confirm its end.",
            "The pulse input DIN1 can drive both motors.",
            "The input DIN3 can start the script.",
        ]
    );
}

#[test]
fn a_second_stop_during_the_first_is_written_at_once_too() {
    let mut link = Link::connected();
    link.bus().slow.insert(number::DUTY_ACCEL_BOTH, ms(40));
    link.handle.stop_all();
    let handle = link.handle.clone();
    let second_at = link.clock.now() + ms(30);
    link.tap.at(second_at, move || handle.stop_all());
    link.run_for(ms(500));
    assert!(link.taken(number::DUTY_ACCEL_BOTH).iter().any(|taken| taken.at == second_at));
    assert!(link.stops().last().unwrap().confirmed());
}

#[test]
fn stop_while_units_are_still_looked_for_goes_to_all_addresses() {
    let mut link = Link::new();
    let handle = link.handle.clone();
    link.tap.at(ms(5), move || handle.stop_all());
    link.run_for(ms(2_000));
    let writes = link.tap.writes();
    let (at, bytes) = writes.iter().find(|(_, bytes)| bytes.len() > 100).unwrap();
    assert_eq!(*at, ms(5));
    // Eight times 54 with its 12 bytes and CRC (16 bytes), and no 249 while nobody knows who runs scripts.
    assert_eq!(bytes.chunks(16).map(|packet| packet[1]).collect::<Vec<_>>(), [number::DUTY_ACCEL_BOTH; 8]);
    assert!(link.has(|event| matches!(event, Event::Connected(_))), "the search goes on after it");
    // It is an MCP, so the Stop is finished: its script is ended too.
    assert_eq!(link.taken(number::STOP_SCRIPT).first().map(|taken| taken.address), Some(0x80));
    assert_eq!(link.stops().last().map(|report| (report.confirmed(), report.units.len())), Some((true, 1)));
}

/// All commands in the bytes that were written, known or not: packets of a Stop have a length that is known.
fn holds(writes: &[(std::time::Duration, Vec<u8>)], address: u8, command: u8) -> bool {
    let packet = crate::tests::testing::with_crc(&[address, command]);
    writes.iter().any(|(_, bytes)| bytes.windows(packet.len()).any(|window| window == packet))
}

fn strict_roboclaw(version: Option<&str>) -> (SharedBus, Link) {
    let bus = Bus::shared();
    of_roboclaws(&bus);
    if let Some(version) = version {
        version.clone_into(&mut bus.lock().unwrap().version);
    }
    let link =
        Link::with(bus.clone(), DeviceOptions { stream: Some(Stream::Usb), ..DeviceOptions::default() });
    (bus, link)
}

#[test]
fn a_roboclaw_that_drops_all_behind_an_unknown_packet_is_stopped_by_the_first_and_never_told_to_end_a_script()
{
    let (_, mut link) = strict_roboclaw(None);
    link.run_for(ms(500));
    link.ask(Request::Arm(ArmScope::Pwm));
    link.drive(0.5);
    link.run_for(ms(50));
    link.forget();
    link.handle.stop_all();
    let stop_at = link.clock.now();
    link.run_for(ms(500));
    let first = link.bus().taken[0].clone();
    assert_eq!((first.command, first.at, first.values.as_slice()), (54, stop_at, DUTY_ZERO.as_slice()));
    let report = &link.stops()[0];
    assert!(report.confirmed(), "{report:?}");
    assert_eq!(report.units[0].script_ended, None);
    assert!(report.units[0].still_driven_by.is_empty(), "{report:?}");
    assert!(!holds(&link.tap.writes(), 0x80, number::STOP_SCRIPT));
}

#[test]
fn a_unit_of_which_nobody_knows_whether_it_runs_scripts_is_not_told_to_end_one_and_that_is_said() {
    let (_, mut link) = strict_roboclaw(Some("Motor board v9"));
    link.run_for(ms(500));
    link.handle.stop_all();
    link.run_for(ms(500));
    let report = &link.stops()[0];
    assert!(report.confirmed(), "{report:?}");
    assert!(
        report.units[0].still_driven_by[0].to_string().starts_with("A script may still run"),
        "{report:?}"
    );
    assert!(!holds(&link.tap.writes(), 0x80, number::STOP_SCRIPT));
}

/// A link on which 144 was asked and given up while the motors ran; its reply of nothing but `byte` comes 400 ms after it was asked.
fn link_with_a_late_reply(byte: i64) -> Link {
    let mut link = Link::armed();
    link.drive(0.5);
    link.run_for(ms(50));
    let pins = Value::Records(vec![vec![byte; 15]; 18]);
    link.bus().values.insert(number::READ_SIGNALS, vec![pins]);
    link.bus().slow.insert(number::READ_SIGNALS, ms(400));
    link.ask(Request::Transact { id: 1, command: number::READ_SIGNALS, values: Vec::new() });
    // Given up three times by now, its first reply not yet there.
    link.run_for(ms(230));
    assert!(link.sentences().iter().any(|sentence| sentence.contains("no answer")), "{:?}", link.sentences());
    link.forget();
    link
}

#[test]
fn bytes_of_a_reply_that_was_given_up_never_confirm_a_stop_that_nobody_heard() {
    // Bytes of 0xFF look like acknowledgements.
    for byte in [-1, 0xFF] {
        let mut link = link_with_a_late_reply(byte);
        // The unit hears nothing from here on; what it was asked before still comes.
        link.bus().addresses.clear();
        link.handle.stop_all();
        link.run_for(ms(1_500));
        assert!(!link.stops().is_empty());
        assert!(link.stops().iter().all(|report| !report.confirmed()), "{:?}", link.stops());
        assert!(link.sentences().is_empty() || !link.sentences()[0].contains("confirmed"));
    }
}

#[test]
fn bytes_of_a_reply_that_was_given_up_never_raise_an_alarm_while_the_motors_stand() {
    for byte in [0, 1, 0x55, -1] {
        let mut link = link_with_a_late_reply(byte);
        link.handle.stop_all();
        let stop_at = link.clock.now();
        link.run_for(ms(3_000));
        let first = &link.taken(number::DUTY_ACCEL_BOTH)[0];
        assert_eq!(first.at, stop_at, "the bytes wait for nothing");
        let reports = link.stops();
        assert_eq!(reports.len(), 1, "{reports:?}");
        assert!(reports[0].confirmed() && reports[0].units[0].failures.is_empty(), "{reports:?}");
        assert_eq!(reports[0].units[0].script_ended, Some(true));
        assert_eq!(link.sentences(), Vec::<String>::new());
        link.forget();
        link.run_for(ms(1_000));
        assert!(link.has(|event| matches!(event, Event::Sample(_))), "the line works on");
    }
}

#[test]
fn a_unit_that_answers_late_by_nearly_half_a_second_confirms_its_stop_without_an_alarm() {
    for delay in [100, 250, 400] {
        let mut link = Link::armed();
        link.drive(0.5);
        link.run_for(ms(50));
        link.forget();
        link.bus().delay = ms(delay);
        link.handle.stop_all();
        link.run_for(ms(4_000));
        let first = &link.stops()[0];
        assert!(first.confirmed() && first.units[0].failures.is_empty(), "{delay} ms: {first:?}");
    }
}

#[test]
fn a_noisy_line_does_not_keep_stop_from_being_confirmed() {
    let mut link = Link::armed();
    link.drive(0.5);
    link.run_for(ms(50));
    // The first two confirmations are lost.
    link.bus().mute.insert(number::DUTY_ACCEL_BOTH);
    let bus = link.bus.clone();
    let now = link.clock.now();
    link.tap.at(now + ms(130), move || bus.lock().unwrap().mute.clear());
    link.handle.stop_all();
    link.run_for(ms(1_000));
    assert!(link.stops()[0].confirmed());
    assert!(link.bus().count(number::DUTY_ACCEL_BOTH) >= 4);
}

#[test]
fn a_stop_that_nobody_heard_is_repeated_and_until_it_is_confirmed_nothing_else_is_sent() {
    let mut link = Link::armed();
    link.drive(0.5);
    link.run_for(ms(50));
    link.forget();
    link.bus().addresses.clear();
    let bus = link.bus.clone();
    let back_at = link.clock.now() + ms(900);
    link.tap.at(back_at, move || bus.lock().unwrap().addresses = BTreeSet::from([0x80]));
    link.handle.stop_all();
    link.run_for(ms(2_000));
    // A reading would feed the controller's own time-out and keep the motor alive.
    let first = link.bus().taken[0].clone();
    assert_eq!((first.command, first.values.as_slice()), (number::DUTY_ACCEL_BOTH, DUTY_ZERO.as_slice()));
    assert!(first.at - back_at <= ms(250), "{:?}", first.at - back_at);
    let confirmed: Vec<_> = link.stops().iter().map(StopReport::confirmed).collect();
    assert_eq!(confirmed, [false, true]);
    assert!(link.has(|event| matches!(event, Event::Sample(_))), "then it reads on");
}

#[test]
fn a_unit_that_never_confirms_its_stop_is_a_lost_link() {
    let mut link = Link::armed();
    link.drive(0.5);
    link.run_for(ms(50));
    link.bus().dead = true;
    link.handle.stop_all();
    let stopped_at = link.clock.now();
    link.run_for(ms(5_000));
    let lost_at = link.when(|event| matches!(event, Event::Lost(_))).unwrap();
    assert!(
        lost_at - stopped_at >= ms(1_900) && lost_at - stopped_at <= ms(2_600),
        "{:?}",
        lost_at - stopped_at
    );
    let last = link.sentences().pop().unwrap();
    assert!(last.contains("Make sure that the motors stand still"), "{last}");
}

#[test]
fn the_other_units_of_a_bus_are_served_again_after_a_dead_one_was_given_up() {
    let bus = Bus::shared();
    bus.lock().unwrap().addresses = BTreeSet::from([0x80, 0x83]);
    let mut link = Link::with(bus, DeviceOptions { stream: Some(Stream::Ttl1), ..DeviceOptions::default() });
    link.run_for(ms(3_000));
    link.ask(Request::Arm(ArmScope::Pwm));
    link.drive(0.5);
    link.run_for(ms(100));
    link.bus().addresses = BTreeSet::from([0x83]);
    link.handle.stop_all();
    link.run_for(ms(6_000));
    let reported = link.sentences().join(" ");
    assert!(reported.contains("Could not stop the motors on 0x80"), "{reported}");
    assert!(!link.ended);
    link.forget();
    link.ask(Request::Select(0x83));
    link.run_for(ms(500));
    assert!(link.has(|event| matches!(event, Event::Sample(sample) if sample.address == 0x83)));
}
