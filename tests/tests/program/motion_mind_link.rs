//! The device thread on simulated Motion Minds in virtual time: found, read, driven by mode, stopped, set and saved, in both
//! protocols, on clean and on bad lines.

use brushwork_core::keep::{Store, UnitId};
use brushwork_link::files::{DiskFault, SimulatedDisk};
use brushwork_tests::said::Said;
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use brushwork_link::Failure;
use brushwork_link::FamilyChoice;
use brushwork_link::Message;
use brushwork_link::device::{
    Addresses, ArmScope, Channel, DeviceOptions, DisarmReason, Drive, DriveCommand, Event, Identity, Job,
    JobContext, JobEnding, Request,
};
use brushwork_link::settings::{
    SaveVerdict, SettingValue, SettingsImage, SettingsTable, WriteOptions, read_all, reload,
    restore_defaults, save_eeprom, write,
};
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_motion_mind_sim::{MotionMind, MotionMindBus, MotionMindConfig};
use brushwork_motion_mind_wire::{
    Address, Command, FrameEvent, FrameReader, LineEvent, LineReader, Mode, Protocol, encode_frame,
    encode_line, function,
};
use brushwork_plant::faults::Fault;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_values::Motor;

/// Registers by number.
const POSITION: u8 = 0;
const VELOCITYLIMIT: u8 = 1;
const FUNCTION: u8 = 3;
const PTERM: u8 = 4;
const ITERM: u8 = 5;
const DTERM: u8 = 6;
const ADDRESS: u8 = 7;
const PIDSCALAR: u8 = 8;
const PWMOUT: u8 = 21;

type Link = VirtualLink<Tapped>;
type Heard = Arc<Mutex<Vec<u8>>>;

/// Units, and every byte that was sent to them.
struct Tapped {
    bus: MotionMindBus,
    heard: Heard,
}

impl Machine for Tapped {
    fn now(&self) -> Duration {
        self.bus.now()
    }

    fn receive(&mut self, stream: StreamIndex, bytes: &[u8]) {
        self.heard.lock().expect("no test panicked").extend(bytes);
        self.bus.receive(stream, bytes);
    }

    fn advance(&mut self, to: Duration) {
        self.bus.advance(to);
    }

    fn next_output_at(&self) -> Option<Duration> {
        self.bus.next_output_at()
    }

    fn take_output(&mut self, stream: StreamIndex) -> Option<Vec<u8>> {
        self.bus.take_output(stream)
    }

    fn bits_per_second(&self, stream: StreamIndex) -> u32 {
        self.bus.bits_per_second(stream)
    }

    fn units(&self) -> usize {
        self.bus.units()
    }

    fn apply(&mut self, unit: usize, action: &WorldAction) {
        self.bus.apply(unit, action);
    }

    fn views(&self) -> Vec<WorldView> {
        self.bus.views()
    }

    fn plugged(&self) -> bool {
        self.bus.plugged()
    }
}

fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

fn unit(mode: Mode, protocol: Protocol, address: u8) -> MotionMind {
    let address = Address::unit(address).expect("an address of a unit");
    let config = MotionMindConfig { address, protocol, ..MotionMindConfig::new(mode) };
    MotionMind::new(config).expect("the default motor is sound")
}

fn options(addresses: Addresses) -> DeviceOptions {
    DeviceOptions {
        addresses,
        family: FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND),
        ..DeviceOptions::default()
    }
}

fn over(units: Vec<MotionMind>, options: DeviceOptions, faults: Vec<Fault>) -> (Link, Heard) {
    let heard = Heard::default();
    let machine = Tapped { bus: MotionMindBus::new(units), heard: Arc::clone(&heard) };
    (VirtualLink::over(machine, options, faults, 1), heard)
}

/// A connected link to one unit at address 1.
fn connected(mode: Mode, protocol: Protocol) -> Link {
    let (mut link, _) = over(vec![unit(mode, protocol, 1)], options(Addresses::Only(1)), Vec::new());
    link.run_for(ms(1_500));
    assert_eq!(identities(&link).len(), 1, "{:?}", link.events);
    link
}

fn identities(link: &Link) -> Vec<Identity> {
    let found = link.events.iter().filter_map(|(_, event)| match event {
        Event::Connected(identity) => Some(identity.clone()),
        _ => None,
    });
    found.collect()
}

fn failures(link: &Link) -> Vec<String> {
    let reported = link.events.iter().filter_map(|(_, event)| match event {
        Event::Failure(failure) | Event::Lost(failure) => Some(failure.to_string()),
        Event::ArmRefused { reasons, .. } => {
            Some(reasons.iter().map(ToString::to_string).collect::<Vec<_>>().join(" "))
        }
        _ => None,
    });
    reported.collect()
}

fn register(link: &Link, number: u8) -> i64 {
    link.bus(|tapped| tapped.bus.motion_minds()[0].read_one(number))
}

fn stored(link: &Link, number: u8) -> i64 {
    link.bus(|tapped| tapped.bus.motion_minds()[0].stored(number))
}

fn latest(link: &Link, channel: Channel) -> Option<f64> {
    link.events.iter().rev().find_map(|(_, event)| match event {
        Event::Sample(sample) => sample.get(channel),
        _ => None,
    })
}

fn drive(link: &Link, command: DriveCommand) {
    link.ask(Request::Drive(Drive::one(Motor::M1, command)));
}

fn speed(speed_counts_per_s: i32) -> DriveCommand {
    DriveCommand::Speed { speed_counts_per_s, accel_counts_per_s2: None }
}

fn position(position_counts: i32) -> DriveCommand {
    DriveCommand::Position {
        position_counts,
        speed_counts_per_s: 0,
        accel_counts_per_s2: 0,
        decel_counts_per_s2: 0,
        queued: false,
    }
}

/// Gains with which the default motor follows well.
fn tame(link: &Link) {
    for (number, value) in [(PTERM, 3000), (ITERM, 20), (DTERM, 12_000), (PIDSCALAR, 9)] {
        inject(link, Address::BROADCAST, &Command::Write { register: number, value });
    }
}

/// Somebody else on the line sends a command.
fn inject(link: &Link, address: Address, command: &Command) {
    link.bus(|tapped| {
        let bytes = match tapped.bus.motion_minds()[0].protocol() {
            Protocol::Binary => encode_frame(address, command).expect("the tests send what fits"),
            Protocol::Text => encode_line(address, command).expect("the tests send what fits").into_bytes(),
        };
        tapped.bus.receive(StreamIndex::Uart0, &bytes);
    });
}

/// Runs a job to its end and gives what it handed back.
fn job<T: Send + 'static>(
    link: &mut Link,
    work: impl FnMut(&mut JobContext<'_>) -> Result<T, Failure> + Send + 'static,
) -> Result<T, String> {
    let limit = Duration::from_secs(60);
    match link.finish(Job::new(Said::Work, limit, work), limit) {
        Some(JobEnding::Done(value)) => Ok(value),
        other => Err(format!("{other:?}: {:?}", link.events)),
    }
}

#[test]
fn a_unit_is_found_in_either_protocol_and_mode_and_told_by_its_registers() {
    for protocol in Protocol::ALL {
        for mode in Mode::ALL {
            let link = connected(mode, protocol);
            let unit = &identities(&link)[0];
            let facts = brushwork_motion_mind_client::MotionMindFacts::of(unit).unwrap();
            assert_eq!((facts.mode, facts.protocol), (mode, protocol));
            assert_eq!((unit.place(), unit.model), ("unit 1".to_owned(), Some("Motion Mind 3")));
            assert_eq!(unit.generation.to_string(), "revision 10");
            assert!(failures(&link).is_empty(), "{protocol} {mode}: {:?}", failures(&link));
            assert!(
                latest(&link, Channel::TEMPERATURE_1).is_some_and(|celsius| (15.0..40.0).contains(&celsius))
            );
        }
    }
}

#[test]
fn without_a_family_named_the_factory_address_is_found_after_packet_serial_was_looked_for() {
    for protocol in Protocol::ALL {
        let options = DeviceOptions { addresses: Addresses::Scan, ..DeviceOptions::default() };
        let (mut link, _) = over(vec![unit(Mode::Serial, protocol, 1)], options, Vec::new());
        link.run_for(Duration::from_secs(20));
        let found = identities(&link);
        assert_eq!(found.len(), 1, "{:?}", link.events);
        assert_eq!(brushwork_motion_mind_client::MotionMindFacts::of(&found[0]).unwrap().protocol, protocol);
    }
}

#[test]
fn without_a_family_named_a_scan_goes_on_from_the_factory_address_to_the_rest_of_the_bus() {
    let units = [1, 2, 40].map(|number| unit(Mode::SerialPid, Protocol::Binary, number)).to_vec();
    let scan = DeviceOptions { addresses: Addresses::Scan, ..DeviceOptions::default() };
    let (mut link, _) = over(units, scan, Vec::new());
    link.run_for(Duration::from_secs(40));
    let found: Vec<u8> = identities(&link).iter().map(|unit| unit.address).collect();
    assert_eq!(found, [1, 2, 40]);
}

#[test]
fn a_scan_finds_every_unit_of_the_bus_with_progress_and_within_seconds() {
    for protocol in Protocol::ALL {
        for numbers in [&[1, 2, 98][..], &[7, 50]] {
            let units = numbers.iter().map(|number| unit(Mode::Serial, protocol, *number)).collect();
            let (mut link, _) = over(units, options(Addresses::Scan), Vec::new());
            link.run_for(Duration::from_secs(20));
            let found: Vec<u8> = identities(&link).iter().map(|unit| unit.address).collect();
            assert_eq!(found, numbers, "{protocol}");
            let steps: BTreeSet<_> = link
                .events
                .iter()
                .filter_map(|(_, event)| match event {
                    Event::Searching { done, of, .. } => Some((*done, *of)),
                    _ => None,
                })
                .collect();
            assert!(steps.len() > 90 && steps.iter().all(|(done, of)| done < of), "{}", steps.len());
            let selected = link.events.iter().find(|(_, event)| matches!(event, Event::Selected { .. }));
            let (at, _) = selected.expect("one is selected");
            assert!(*at < Duration::from_secs(16), "{protocol} {numbers:?}: {at:?}");
        }
    }
}

#[test]
fn a_scan_is_cancelled_at_once() {
    let (mut link, _) =
        over(vec![unit(Mode::Serial, Protocol::Binary, 98)], options(Addresses::Scan), Vec::new());
    link.run_for(ms(1_700));
    link.ask(Request::Disconnect);
    link.run_for(ms(100));
    assert!(link.ended, "{:?}", link.events);
    assert!(matches!(link.events.last(), Some((_, Event::Closed))));
}

/// Every command in the bytes that a unit could make out, whichever protocol it speaks; the self-test counts as a text of its own.
fn commands_in(bytes: &[u8]) -> Vec<String> {
    let mut found = Vec::new();
    // Frames at every offset: a unit may have lost any byte before.
    for start in 0..bytes.len() {
        let mut reader = FrameReader::new();
        for byte in bytes[start..].iter().take(8) {
            if let Some(FrameEvent::Command(_, command)) = reader.feed(*byte, Duration::ZERO) {
                found.push(format!("{command:?}"));
                break;
            }
        }
    }
    let mut reader = LineReader::new();
    for byte in bytes {
        match reader.feed(*byte) {
            Some(LineEvent::Command(_, command)) => found.push(format!("{command:?}")),
            Some(LineEvent::SelfTest(_)) => found.push("SelfTest".to_owned()),
            _ => {}
        }
    }
    found
}

#[test]
fn looking_for_units_sends_reads_and_nothing_else() {
    for family in FamilyChoice::all() {
        // Nobody has an address that is asked, so that everything is tried.
        let options = DeviceOptions { family, ..DeviceOptions::default() };
        let (mut link, heard) = over(vec![unit(Mode::Serial, Protocol::Binary, 0)], options, Vec::new());
        link.run_for(Duration::from_secs(60));
        assert!(link.ended, "{family} at {:?}: {:?}", link.now(), link.events.last());
        let heard = heard.lock().unwrap().clone();
        assert!(!heard.is_empty());
        for command in commands_in(&heard) {
            assert!(command.starts_with("Read"), "{family}: {command}");
        }
    }
}

#[test]
fn the_probes_of_one_family_do_nothing_to_the_other() {
    // Motion Minds in every mode and protocol, their motors held or still, while packet serial is looked for.
    for protocol in Protocol::ALL {
        for mode in Mode::ALL {
            let options = DeviceOptions {
                family: FamilyChoice::of(brushwork_mcp_client::MCP),
                ..DeviceOptions::default()
            };
            let (mut link, _) = over(vec![unit(mode, protocol, 1)], options, Vec::new());
            let before: Vec<i64> = (0..=30).map(|number| register(&link, number)).collect();
            link.run_for(Duration::from_secs(10));
            assert!(link.ended && identities(&link).is_empty(), "{mode} {protocol}");
            for number in (1..=12).chain(23..=26).chain([28, 30]) {
                assert_eq!(
                    register(&link, number),
                    before[usize::from(number)],
                    "{mode} {protocol} {number}"
                );
            }
            assert_eq!(link.bus(|tapped| tapped.bus.motion_minds()[0].eeprom_writes()), 0);
            // It still answers.
            let reply = link.bus(|tapped| tapped.bus.exchange(&probe(protocol), ms(200)));
            assert!(!reply.is_empty(), "{mode} {protocol}");
        }
    }
    // An MCP while Motion Minds are looked for.
    let controller = Controller::new(ControllerConfig::default()).unwrap();
    let bus = Bus::single(controller, StreamIndex::Uart0);
    let mut link: VirtualLink = VirtualLink::over(bus, options(Addresses::Scan), Vec::new(), 1);
    let settings = link.bus(|bus| format!("{:?}", bus.controllers()[0].settings()));
    link.run_for(Duration::from_secs(60));
    assert!(link.ended);
    assert_eq!(link.duties(0), [0.0; 2]);
    assert_eq!(link.bus(|bus| format!("{:?}", bus.controllers()[0].settings())), settings);
}

/// READ REGISTER 18 of unit 1, after a line end for what the probes left in a unit's line.
fn probe(protocol: Protocol) -> Vec<u8> {
    match protocol {
        Protocol::Binary => vec![0x1D, 0x01, 0x12, 0x30],
        Protocol::Text => b"\r\nR01 18\r\n".to_vec(),
    }
}

#[test]
fn each_mode_takes_what_it_takes_and_says_what_it_does_not() {
    for protocol in Protocol::ALL {
        let mut link = connected(Mode::Serial, protocol);
        assert!(link.arm(ArmScope::Pwm), "{:?}", failures(&link));
        drive(&link, DriveCommand::duty(0.5));
        link.run_for(ms(600));
        assert_eq!(register(&link, PWMOUT), 512, "{protocol}: {:?}", failures(&link));
        assert!(latest(&link, Channel::M1_PWM).is_some_and(|pwm| (pwm - 50.0).abs() < 0.1));
        assert!(latest(&link, Channel::M1_VELOCITY).is_some_and(|speed| speed > 1000.0));
        drive(&link, speed(1000));
        link.run_for(ms(100));
        assert!(failures(&link).iter().any(|reported| reported.contains("duties and nothing else")));

        let mut link = connected(Mode::SerialPid, protocol);
        tame(&link);
        assert!(link.arm(ArmScope::Position), "{:?}", failures(&link));
        drive(&link, position(3_000));
        link.run_for(ms(2_500));
        let at = register(&link, POSITION);
        assert!((at - 3_000).abs() < 60, "{protocol}: at {at}, {:?}", failures(&link));
        drive(
            &link,
            DriveCommand::Distance {
                speed_counts_per_s: -1,
                accel_counts_per_s2: None,
                distance_counts: 1_000,
                queued: false,
            },
        );
        link.run_for(ms(2_500));
        let at = register(&link, POSITION);
        assert!((at - 2_000).abs() < 60, "{protocol}: at {at}");
        drive(&link, speed(2_000));
        link.run_for(ms(2_000));
        let seen = latest(&link, Channel::M1_VELOCITY).unwrap();
        assert!((seen - 2_000.0).abs() <= 400.0, "{protocol}: {seen} counts/s");
    }
    for mode in [Mode::RadioControl, Mode::Analog, Mode::Buttons, Mode::AnalogPid, Mode::FactoryRestore] {
        let mut link = connected(mode, Protocol::Binary);
        assert!(!link.arm(ArmScope::Pwm), "{mode}");
        let said = failures(&link).concat();
        let wanted = if mode == Mode::AnalogPid { "ADSERIAL" } else { "mode 3 or 4" };
        assert!(said.contains(wanted), "{mode}: {said}");
    }
}

#[test]
fn nothing_moves_unarmed_by_whatever_request() {
    for (mode, protocol) in [(Mode::Serial, Protocol::Binary), (Mode::SerialPid, Protocol::Text)] {
        let mut link = connected(mode, protocol);
        drive(&link, DriveCommand::duty(0.5));
        drive(&link, speed(2_000));
        for (command, value) in [(0x14_u8, 500), (0x15, 5_000), (0x16, 5_000), (0x17, 50)] {
            let values = vec![brushwork_values::Value::Int(value)];
            link.ask(Request::Transact { id: command.into(), command, values });
        }
        let typed: [&[u8]; 2] = match protocol {
            // CHANGE_SPEED 500: 14 01 F4 01, sum 0A; MOVEAT_VELOCITY 50: 17 01 32 00, sum 4A.
            Protocol::Binary => [&[0x14, 1, 0xF4, 1, 0x0A], &[0x17, 1, 0x32, 0, 0x4A]],
            Protocol::Text => [b"C01 500\r\n", b"V01 50\r\n"],
        };
        for bytes in typed {
            link.ask(Request::Raw { id: 9, bytes: bytes.to_vec() });
        }
        link.run_for(ms(2_000));
        assert_eq!((register(&link, PWMOUT), register(&link, POSITION)), (0, 0), "{mode}");
        let reported = failures(&link).len()
            + link
                .events
                .iter()
                .filter(|(_, event)| match event {
                    Event::Transacted { result, .. } => result.is_err(),
                    Event::RawReply { result, .. } => result.is_err(),
                    _ => false,
                })
                .count();
        assert!(reported >= 7, "{mode}: {:?}", link.events);
    }
}

#[test]
fn stop_stands_the_motor_in_every_mode_and_is_confirmed_by_looking() {
    for protocol in Protocol::ALL {
        for (mode, command) in [
            (Mode::Serial, DriveCommand::duty(1.0)),
            (Mode::SerialPid, speed(4_000)),
            (Mode::SerialPid, position(40_000)),
        ] {
            let mut link = connected(mode, protocol);
            tame(&link);
            assert!(link.arm(ArmScope::Pwm), "{:?}", failures(&link));
            drive(&link, command);
            link.run_for(ms(700));
            assert!(link.speeds(0)[0].abs() > 1.0, "{protocol} {mode}");
            link.events.clear();
            link.handle.stop_all();
            link.run_for(ms(2_500));
            let stops = link.stops();
            assert!(stops.len() == 1 && stops[0].confirmed(), "{protocol} {mode}: {stops:?}");
            assert!(link.speeds(0)[0].abs() < 0.5, "{protocol} {mode}: {:?}", link.speeds(0));
            assert!(
                link.events.iter().any(|(_, event)| matches!(event, Event::Disarmed(DisarmReason::Stop)))
            );
        }
    }
}

#[test]
fn stop_takes_a_slow_ramp_away_and_puts_it_back() {
    for protocol in Protocol::ALL {
        let mut link = connected(Mode::Serial, protocol);
        // 10 of 1023 every 50 ms: five seconds from full drive to nothing.
        job(&mut link, |wire| {
            wire.transact(0x18, &[VELOCITYLIMIT.into(), 10]).map_err(|error| error.failure(Said::Write, "it"))
        })
        .unwrap();
        assert!(link.arm(ArmScope::Pwm));
        let warned = link.events.iter().any(|(_, event)| {
            matches!(event, Event::Armed { warnings, .. } if warnings.iter().any(|text| text.to_string().contains("5.2 s")))
        });
        assert!(warned, "{:?}", link.events);
        drive(&link, DriveCommand::duty(1.0));
        link.run_for(ms(3_000));
        assert!(register(&link, PWMOUT) > 400);
        let seen = link.duties_at(link.now() + ms(150), 0);
        link.handle.stop_all();
        link.run_for(ms(500));
        assert_eq!(*seen.lock().unwrap(), Some([0.0; 2]), "{protocol}");
        link.run_for(ms(1_000));
        assert_eq!(register(&link, VELOCITYLIMIT), 10, "{protocol}");
        assert!(link.stops().last().unwrap().confirmed());
    }
}

#[test]
fn a_loop_that_shakes_its_motor_is_switched_off_by_stop_until_the_motor_stands() {
    for protocol in Protocol::ALL {
        let mut link = connected(Mode::SerialPid, protocol);
        tame(&link);
        assert!(link.arm(ArmScope::Velocity));
        // So much gain that the loop oscillates for ever.
        job(&mut link, |wire| {
            wire.transact(0x18, &[PTERM.into(), 60_000]).map_err(|error| error.failure(Said::Write, "it"))?;
            wire.transact(0x18, &[DTERM.into(), 0]).map_err(|error| error.failure(Said::Write, "it"))?;
            wire.transact(0x18, &[PIDSCALAR.into(), 4]).map_err(|error| error.failure(Said::Write, "it"))
        })
        .unwrap();
        link.arm(ArmScope::Velocity);
        drive(&link, speed(4_000));
        link.run_for(ms(700));
        link.events.clear();
        link.handle.stop_all();
        link.run_for(ms(3_000));
        let stops = link.stops();
        assert!(stops[0].confirmed(), "{protocol}: {stops:?}");
        assert_eq!(register(&link, PWMOUT), 0, "{protocol}");
        let said = text_of(&stops[0].units[0].still_driven_by);
        assert!(said.contains("DISABLEPID"), "{protocol}: it was still, so the test tests nothing: {said}");
        assert!(!stops[0].left_a_loop_off(), "{protocol}: {said}");
        assert_eq!(register(&link, FUNCTION), 0, "{protocol}: as it was");
        let before = register(&link, POSITION);
        link.run_for(ms(1_000));
        assert!((register(&link, POSITION) - before).abs() <= 4, "{protocol}: it is held");
        tame(&link);
        assert!(link.arm(ArmScope::Velocity), "{:?}", failures(&link));
        link.run_for(ms(500));
        assert!((register(&link, POSITION) - before).abs() < 20, "arming does not move the motor");
    }
}

#[test]
fn stop_reaches_every_unit_of_a_bus_at_once() {
    for protocol in Protocol::ALL {
        let units = vec![unit(Mode::Serial, protocol, 1), unit(Mode::Serial, protocol, 2)];
        let (mut link, _) = over(units, options(Addresses::Scan), Vec::new());
        link.run_for(Duration::from_secs(15));
        assert_eq!(identities(&link).len(), 2);
        // Somebody else has set both in motion.
        for number in [1, 2] {
            inject(&link, Address::unit(number).unwrap(), &Command::ChangeSpeed(800));
            link.run_for(ms(50));
        }
        link.run_for(ms(500));
        link.handle.stop_all();
        link.run_for(ms(1_500));
        let left =
            link.bus(|tapped| tapped.bus.motion_minds().iter().map(|unit| unit.read_one(PWMOUT)).max());
        assert_eq!(left, Some(0), "{protocol}");
        let report = link.stops()[0];
        assert!(report.confirmed() && report.units.len() == 2, "{protocol}: {report:?}");
    }
}

#[test]
fn a_frozen_window_stops_the_motor_after_a_quarter_second() {
    for protocol in Protocol::ALL {
        for (mode, command) in [(Mode::Serial, DriveCommand::duty(0.8)), (Mode::SerialPid, speed(4_000))] {
            let mut link = connected(mode, protocol);
            tame(&link);
            assert!(link.arm(ArmScope::Pwm));
            drive(&link, command);
            link.run_for(ms(600));
            link.freeze_window();
            link.run_for(ms(1_500));
            assert!(link.speeds(0)[0].abs() < 1.0, "{protocol} {mode}: {:?}", link.speeds(0));
            link.thaw_window();
            link.run_for(ms(50));
            let reasons = link
                .events
                .iter()
                .filter(|(_, event)| matches!(event, Event::Disarmed(DisarmReason::DeadMan)));
            assert_eq!(reasons.count(), 1, "{protocol} {mode}");
        }
    }
}

#[test]
fn arming_says_that_no_time_out_covers_the_death_of_the_program_and_refuses_what_holds_the_drive_back() {
    let mut link = connected(Mode::Serial, Protocol::Binary);
    assert!(link.arm(ArmScope::Pwm));
    assert!(link.events.iter().any(|(_, event)| matches!(
        event,
        Event::Armed { controller_timeout: None, warnings, .. } if warnings[0].to_string().contains("no serial time-out")
    )));
    let mut link = connected(Mode::SerialPid, Protocol::Binary);
    job(&mut link, |wire| {
        let word = i64::from(function::DISABLEPID);
        wire.transact(0x18, &[FUNCTION.into(), word]).map_err(|error| error.failure(Said::Write, "it"))
    })
    .unwrap();
    tame(&link);
    let before = register(&link, POSITION);
    assert!(link.arm(ArmScope::Velocity), "who arms asks for motion: {:?}", failures(&link));
    assert!(warnings(&link).iter().any(|text| text.contains("DISABLEPID")), "{:?}", warnings(&link));
    link.run_for(ms(500));
    assert_eq!(register(&link, FUNCTION), 0);
    assert!((register(&link, POSITION) - before).abs() <= 4, "arming does not move the motor");
}

/// What arming has said.
fn warnings(link: &Link) -> Vec<String> {
    let said = link.events.iter().filter_map(|(_, event)| match event {
        Event::Armed { warnings, .. } => Some(warnings.clone()),
        _ => None,
    });
    said.flatten().map(|message| message.to_string()).collect()
}

#[test]
fn arming_switches_a_loop_on_only_where_it_holds_the_motor_still() {
    for protocol in Protocol::ALL {
        let mut link = connected(Mode::SerialPid, protocol);
        // It is told to be elsewhere while it is off; and its gains make it oscillate for ever once it moves.
        job(&mut link, |wire| {
            let word = i64::from(function::DISABLEPID);
            for (register, value) in [(FUNCTION, word), (PTERM, 60_000), (DTERM, 0), (PIDSCALAR, 4)] {
                wire.transact(0x18, &[register.into(), value])
                    .map_err(|error| error.failure(Said::Write, "it"))?;
            }
            Ok(())
        })
        .unwrap();
        inject(&link, Address::FACTORY, &Command::MoveToAbsolute(50_000));
        link.run_for(ms(200));
        let before = register(&link, POSITION);
        let seen = link.duties_at(link.now() + ms(400), 0);
        let armed = link.arm(ArmScope::Velocity);
        link.run_for(ms(1_500));
        assert!((register(&link, POSITION) - before).abs() < 20, "{protocol}: the motor does not jump");
        assert!(seen.lock().unwrap().is_some_and(|duties| duties[0].abs() < 0.5), "{protocol}");
        let is_off = register(&link, FUNCTION) & i64::from(function::DISABLEPID) != 0;
        assert_eq!(is_off, !armed, "{protocol}: {:?}", failures(&link));
    }
}

#[test]
fn a_loop_that_cannot_hold_its_motor_is_left_off_which_is_said_and_arming_waits_until_the_motor_stands() {
    let motor = Motor::M1;
    for protocol in Protocol::ALL {
        let mut link = connected(Mode::SerialPid, protocol);
        tame(&link);
        let before = register(&link, FUNCTION);
        assert!(link.arm(ArmScope::Velocity), "{protocol}: {:?}", failures(&link));
        drive(&link, speed(1_000));
        link.run_for(ms(500));
        // A weight that no loop without gains holds, and that goes down without a duty too.
        for register in [PTERM, ITERM, DTERM] {
            inject(&link, Address::FACTORY, &Command::Write { register, value: 0 });
        }
        link.apply(0, &WorldAction::SetLoadTorque { motor, newton_metres: stall_torque() });
        link.run_for(ms(500));
        link.events.clear();
        link.handle.stop_all();
        link.run_for(ms(6_000));
        let stop = link.stops()[0].clone();
        assert!(stop.left_a_loop_off(), "{protocol}: {stop:?}");
        let said = text_of(&stop.units[0].still_driven_by);
        assert!(said.contains("left switched off (DISABLEPID"), "{protocol}: {said}");
        let off = before | i64::from(function::DISABLEPID);
        assert_eq!(register(&link, FUNCTION), off, "{protocol}");
        assert!(!link.arm(ArmScope::Velocity), "{protocol}: it still turns");
        assert!(failures(&link).concat().contains("DISABLEPID"), "{:?}", failures(&link));
        assert_eq!(register(&link, FUNCTION), off, "{protocol}");
        link.apply(0, &WorldAction::SetLoadTorque { motor, newton_metres: 0.0 });
        tame(&link);
        link.run_for(ms(1_000));
        assert!(link.arm(ArmScope::Velocity), "{protocol}: {:?}", failures(&link));
        assert_eq!(register(&link, FUNCTION), before, "{protocol}");
    }
}

/// What the default motor gives at 12 V with its shaft held.
fn stall_torque() -> f64 {
    let config = MotionMindConfig::new(Mode::SerialPid);
    let axis = &config.world.axes[0];
    12.0 * axis.motor.torque_constant_newton_metres_per_amp / axis.motor.armature_ohms * axis.gear.ratio
}

#[test]
fn return_bits_change_the_acknowledges_and_nothing_else() {
    for protocol in Protocol::ALL {
        let mut link = connected(Mode::Serial, protocol);
        for word in [2_i64, 4, 8, 14, 6, 0] {
            job(&mut link, move |wire| {
                wire.transact(0x18, &[FUNCTION.into(), word])
                    .map_err(|error| error.failure(Said::Write, "it"))
            })
            .unwrap();
            assert!(link.arm(ArmScope::Pwm), "{protocol} {word}: {:?}", failures(&link));
            drive(&link, DriveCommand::duty(0.3));
            link.run_for(ms(500));
            assert_eq!(register(&link, PWMOUT), 307, "{protocol} {word}: {:?}", failures(&link));
            link.ask(Request::Disarm);
            link.run_for(ms(800));
            assert_eq!(register(&link, PWMOUT), 0, "{protocol} {word}");
        }
        // Somebody else sets RETPOS, and this program does not know.
        inject(&link, Address::FACTORY, &Command::Write { register: FUNCTION, value: 2 });
        link.run_for(ms(100));
        link.events.clear();
        assert!(link.arm(ArmScope::Pwm), "{protocol}: {:?}", failures(&link));
        drive(&link, DriveCommand::duty(0.3));
        link.run_for(ms(500));
        assert_eq!(register(&link, PWMOUT), 307, "{protocol}: {:?}", failures(&link));
    }
}

fn table(link: &mut Link) -> SettingsTable {
    let subject = connected_subject(link);
    SettingsTable::new(subject)
}

fn connected_subject(link: &Link) -> brushwork_link::settings::Subject {
    let facts = link.bus(|tapped| tapped.bus.motion_minds()[0].read_one(17));
    let revision = u8::try_from(facts).expect("a revision is small");
    brushwork_motion_mind_client::subject(revision)
}

const OPTIONS: WriteOptions = WriteOptions { own_stream: None, simulated: false, as_read: false };

fn wanted(changes: &[(&str, SettingValue)]) -> SettingsImage {
    changes.iter().map(|(key, value)| ((*key).to_owned(), *value)).collect()
}

#[test]
fn settings_are_read_written_saved_and_survive_a_power_cycle_and_what_was_not_saved_does_not() {
    for protocol in Protocol::ALL {
        let mut link = connected(Mode::SerialPid, protocol);
        let table = table(&mut link);
        let changes = wanted(&[
            ("register.pterm", SettingValue::Int(1_234)),
            ("register.ampslimit", SettingValue::Number(5.0)),
            ("function.satprot", SettingValue::Bool(true)),
            ("function.activestop", SettingValue::Bool(true)),
            ("function2.freqx2", SettingValue::Bool(true)),
            ("register.vnlimit", SettingValue::Int(-123_456)),
        ]);
        let (copy, on) = (table.clone(), changes.clone());
        let report = job(&mut link, move |wire| {
            write(wire, &copy, &on, OPTIONS)
                .map_err(|error| Failure::new(Said::Write, "it", Message::error(error), Said::Look))
        })
        .unwrap();
        assert!(report.is_complete(), "{protocol}: {:?}", report.rows);
        // SATPROT is bit 4, ACTIVESTOP bit 7: 0x90. FREQX2 is bit 1 of FUNCTION2.
        assert_eq!((register(&link, FUNCTION), register(&link, 30)), (0x90, 2), "{protocol}");
        assert_eq!((register(&link, 28), register(&link, 23)), (250, -123_456));
        assert_eq!(stored(&link, PTERM), 6_000, "nothing went to EEPROM");

        let copy = table.clone();
        let saved = job(&mut link, move |wire| save_eeprom(wire, &copy, OPTIONS)).unwrap();
        assert_eq!(saved.verdict, SaveVerdict::Stored, "{protocol}: {saved:?}");
        for number in (1..=12).chain(23..=26).chain([28, 30]) {
            assert_eq!(stored(&link, number), register(&link, number), "{protocol} {number}");
        }
        let copy = table.clone();
        job(&mut link, move |wire| {
            write(wire, &copy, &wanted(&[("register.dterm", SettingValue::Int(99))]), OPTIONS)
                .map_err(|error| Failure::new(Said::Write, "it", Message::error(error), Said::Look))
        })
        .unwrap();
        let subject = *table.subject();
        let after = job(&mut link, move |wire| reload(wire, &SettingsTable::new(subject))).unwrap();
        assert_eq!(after.image.get("register.dterm"), Some(SettingValue::Int(0)), "{protocol}");
        assert_eq!(after.image.get("register.pterm"), Some(SettingValue::Int(1_234)), "{protocol}");

        link.apply(0, &WorldAction::Power { on: false });
        link.apply(0, &WorldAction::Power { on: true });
        link.run_for(ms(800));
        assert_eq!((register(&link, FUNCTION), register(&link, PTERM)), (0x90, 1_234), "{protocol}");
    }
}

#[test]
fn restoring_the_factory_values_changes_ram_and_eeprom_and_follows_the_unit_to_address_1() {
    for protocol in Protocol::ALL {
        let (mut link, _) =
            over(vec![unit(Mode::SerialPid, protocol, 9)], options(Addresses::Only(9)), Vec::new());
        link.run_for(ms(1_500));
        let subject = connected_subject(&link);
        let report = job(&mut link, move |wire| {
            wire.transact(0x19, &[PTERM.into(), 77]).map_err(|error| error.failure(Said::Store, "it"))?;
            restore_defaults(wire, subject)
        })
        .unwrap();
        assert!(report.differences.is_empty(), "{protocol}: {:?}", report.differences);
        assert_eq!(report.address, brushwork_motion_mind_client::unit_address(1).unwrap(), "{protocol}");
        assert_eq!((register(&link, PTERM), stored(&link, PTERM)), (6_000, 6_000));
        link.run_for(ms(500));
        assert!(failures(&link).is_empty(), "{:?}", failures(&link));
    }
}

#[test]
fn a_new_address_is_followed() {
    for protocol in Protocol::ALL {
        let mut link = connected(Mode::SerialPid, protocol);
        let table = table(&mut link);
        let report = job(&mut link, move |wire| {
            write(wire, &table, &wanted(&[("register.address", SettingValue::Int(42))]), OPTIONS)
                .map_err(|error| Failure::new(Said::Write, "it", Message::error(error), Said::Look))
        })
        .unwrap();
        assert!(report.is_complete(), "{protocol}: {report:?}");
        assert_eq!(
            (register(&link, ADDRESS), report.address),
            (42, brushwork_motion_mind_client::unit_address(42).unwrap())
        );
        link.events.clear();
        link.run_for(ms(1_000));
        assert!(failures(&link).is_empty() && latest(&link, Channel::M1_POSITION).is_some(), "{protocol}");
    }
}

#[test]
fn the_motor_is_stopped_before_what_stops_it_anyway() {
    let mut link = connected(Mode::Serial, Protocol::Binary);
    assert!(link.arm(ArmScope::Pwm));
    drive(&link, DriveCommand::duty(0.5));
    link.run_for(ms(500));
    let values = [PTERM.into(), 5_000].map(brushwork_values::Value::Int).to_vec();
    link.ask(Request::Transact { id: 1, command: 0x19, values });
    link.run_for(ms(500));
    assert!(
        link.events.iter().any(|(_, event)| matches!(event, Event::Disarmed(DisarmReason::SettingsChanged))),
        "{:?}",
        link.events
    );
    assert_eq!((register(&link, PWMOUT), stored(&link, PTERM)), (0, 5_000));
}

#[test]
fn on_a_bad_line_settings_are_right_or_said_to_be_unknown() {
    for protocol in Protocol::ALL {
        for fault in ["drop=0.004", "corrupt=0.004", "duplicate=0.004", "delay=25ms,share=0.1"] {
            let fault: Fault = fault.parse().expect("the faults are of the list");
            let (mut link, _) = over(
                vec![unit(Mode::SerialPid, protocol, 1)],
                options(Addresses::Only(1)),
                vec![fault.clone()],
            );
            link.run_for(Duration::from_secs(5));
            if identities(&link).is_empty() || link.ended {
                continue;
            }
            let subject = connected_subject(&link);
            let report = job(&mut link, move |wire| read_all(wire, subject));
            let Ok(report) = report else { continue };
            for (key, value) in report.image.iter() {
                let row = report.table.row(key).unwrap();
                let (number, bits) = (row.register.unwrap(), row.sink().unwrap().place.bits);
                let raw = bits.map_or(register(&link, number), |bits| bits.extract(register(&link, number)));
                // One wrong byte in the sum of a frame is always found; text has no sum.
                if protocol == Protocol::Binary {
                    assert_eq!(row.encode(value), Some(raw), "{protocol} {fault:?}: {key}");
                }
            }
        }
    }
}

#[test]
fn typed_bytes_come_back_as_they_are_and_the_self_test_never_goes_out() {
    let replies = |link: &mut Link, bytes: &[u8]| -> Result<Vec<u8>, String> {
        link.events.clear();
        link.ask(Request::Raw { id: 5, bytes: bytes.to_vec() });
        link.run_for(ms(1_000));
        let reply = link.events.drain(..).find_map(|(_, event)| match event {
            Event::RawReply { id: 5, result } => Some(result.map_err(|failure| failure.to_string())),
            _ => None,
        });
        reply.expect("it is answered")
    };
    let mut text = connected(Mode::SerialPid, Protocol::Text);
    assert_eq!(replies(&mut text, b"R01 04\r\n").unwrap(), b"PTRM=6000\r\n");
    assert_eq!(replies(&mut text, b"Q\r\n").unwrap(), b"BAD COMMAND\r\n");
    assert_eq!(replies(&mut text, b"R02 04\r\n").unwrap(), b"", "another unit's");
    assert!(replies(&mut text, b"R01 97\r\n").unwrap().starts_with(b"S0O"));
    for bytes in [&b"Z01\r\n"[..], b"z01\r\n", b"  Z01\r\n", b"XZ\x0801\r\n", b"Z01", b"R01 04"] {
        let said = replies(&mut text, bytes).unwrap_err();
        assert!(said.contains("never") || said.contains("whole line"), "{said}");
    }
    let heard = text.bus(|tapped| tapped.heard.lock().unwrap().clone());
    assert!(!heard.contains(&b'Z') && !heard.contains(&b'z'));

    let mut binary = connected(Mode::SerialPid, Protocol::Binary);
    // READ REGISTER 1 = 1023: 1D 01 01 1F -> 01 FF 03 03.
    assert_eq!(replies(&mut binary, &[0x1D, 0x01, 0x01, 0x1F]).unwrap(), [0x01, 0xFF, 0x03, 0x03]);
    let said = replies(&mut binary, &[0x1D, 0x01, 0x01, 0x20]).unwrap_err();
    assert!(said.contains("no command of the manual"), "{said}");
}

/// What is asked of the link, and the frame and the line that the manual has for it: mode, command, values.
type Vector = (Mode, u8, &'static [i64], &'static [u8], &'static str);

/// The examples of chapter 5, and some by its rules.
const VECTORS: &[Vector] = &[
    // 5.1.1, 5.2.1
    (Mode::SerialPid, 0x15, &[-10_000], &[0x15, 0x01, 0xF0, 0xD8, 0xFF, 0xFF, 0xDC], "P01 -10000"),
    (Mode::Serial, 0x14, &[128], &[0x14, 0x01, 0x80, 0x00, 0x95], "C01 128"),
    (Mode::SerialPid, 0x15, &[1000], &[0x15, 0x01, 0xE8, 0x03, 0x00, 0x00, 0x01], "P01 1000"),
    // 5.3.1 to 5.6.1
    (Mode::Serial, 0x14, &[763], &[0x14, 0x01, 0xFB, 0x02, 0x12], "C01 763"),
    (Mode::SerialPid, 0x15, &[-100_046], &[0x15, 0x01, 0x32, 0x79, 0xFE, 0xFF, 0xBE], "P01 -100046"),
    (Mode::SerialPid, 0x16, &[100_000], &[0x16, 0x01, 0xA0, 0x86, 0x01, 0x00, 0x3E], "M01 100000"),
    (Mode::SerialPid, 0x17, &[-200], &[0x17, 0x01, 0x38, 0xFF, 0x4F], "V01 -200"),
    // 5.7.1
    (
        Mode::SerialPid,
        0x18,
        &[0, -10_000],
        &[0x18, 0x01, 0x00, 0xF0, 0xD8, 0xFF, 0xFF, 0xDF],
        "W01 00 -10000",
    ),
    (Mode::SerialPid, 0x18, &[1, 100], &[0x18, 0x01, 0x01, 0x64, 0x00, 0x7E], "W01 01 100"),
    (Mode::SerialPid, 0x18, &[2, 128], &[0x18, 0x01, 0x02, 0x80, 0x9B], "W01 02 128"),
    // 5.8.1
    (
        Mode::SerialPid,
        0x19,
        &[0, -10_000],
        &[0x19, 0x01, 0x00, 0xF0, 0xD8, 0xFF, 0xFF, 0xE0],
        "S01 00 -10000",
    ),
    (Mode::SerialPid, 0x19, &[1, 100], &[0x19, 0x01, 0x01, 0x64, 0x00, 0x7F], "S01 01 100"),
    (Mode::SerialPid, 0x19, &[2, 128], &[0x19, 0x01, 0x02, 0x80, 0x9C], "S01 02 128"),
    // 5.9.1: in text several registers are read with all of them.
    (Mode::SerialPid, 0x1A, &[0x0018_0104], &[0x1A, 0x01, 0x04, 0x01, 0x18, 0x00, 0x38], "R01 99"),
    (Mode::SerialPid, 0x1A, &[1], &[0x1A, 0x01, 0x01, 0x00, 0x00, 0x00, 0x1C], "R01 00"),
    (Mode::SerialPid, 0x1A, &[0xFFFF_FFFF], &[0x1A, 0x01, 0xFF, 0xFF, 0xFF, 0xFF, 0x17], "R01 99"),
    (Mode::SerialPid, 0x1A, &[0x0001_0001], &[0x1A, 0x01, 0x01, 0x00, 0x01, 0x00, 0x1D], "R01 99"),
    // 5.10.1
    (Mode::SerialPid, 0x1D, &[1], &[0x1D, 0x01, 0x01, 0x1F], "R01 01"),
    (Mode::SerialPid, 0x1D, &[0], &[0x1D, 0x01, 0x00, 0x1E], "R01 00"),
    (Mode::SerialPid, 0x1D, &[27], &[0x1D, 0x01, 0x1B, 0x39], "R01 27"),
    // By the same rules.
    (Mode::Serial, 0x14, &[-512], &[0x14, 0x01, 0x00, 0xFE, 0x13], "C01 -512"),
    (Mode::SerialPid, 0x18, &[3, 0x0890], &[0x18, 0x01, 0x03, 0x90, 0x08, 0xB4], "W01 03 2192"),
    (Mode::SerialPid, 0x19, &[30, 0x0012], &[0x19, 0x01, 0x1E, 0x12, 0x00, 0x4A], "S01 30 18"),
    (Mode::SerialPid, 0x18, &[28, 512], &[0x18, 0x01, 0x1C, 0x00, 0x02, 0x37], "W01 28 512"),
    (
        Mode::SerialPid,
        0x18,
        &[23, -123_456],
        &[0x18, 0x01, 0x17, 0xC0, 0x1D, 0xFE, 0xFF, 0x0A],
        "W01 23 -123456",
    ),
    // 5.11.1, 5.12.1
    (Mode::SerialPid, 0x1B, &[], &[0x1B, 0x01, 0x1C], "X01"),
    (Mode::SerialPid, 0x1C, &[], &[0x1C, 0x01, 0x1D], "Y01"),
];

#[test]
fn every_example_of_the_manual_goes_through_the_link_as_its_bytes_and_is_answered_by_the_unit() {
    for protocol in Protocol::ALL {
        for (mode, command, values, frame, line) in VECTORS {
            let (mut link, heard) =
                over(vec![unit(*mode, protocol, 1)], options(Addresses::Only(1)), Vec::new());
            link.run_for(ms(1_500));
            if (0x14..=0x17).contains(command) {
                assert!(link.arm(ArmScope::Position), "{line}: {:?}", failures(&link));
            }
            link.events.clear();
            heard.lock().unwrap().clear();
            let values = values.iter().map(|value| brushwork_values::Value::Int(*value)).collect();
            link.ask(Request::Transact { id: 7, command: *command, values });
            link.run_for(ms(400));
            let result = link.events.iter().find_map(|(_, event)| match event {
                Event::Transacted { id: 7, result, .. } => Some(result.is_ok()),
                _ => None,
            });
            assert_eq!(result, Some(true), "{protocol} {line}: {:?}", link.events);
            let wanted = match protocol {
                Protocol::Binary => frame.to_vec(),
                Protocol::Text => format!("{line}\r\n").into_bytes(),
            };
            let heard = heard.lock().unwrap();
            assert!(
                heard.windows(wanted.len()).any(|bytes| bytes == wanted),
                "{protocol} {line}: {}",
                heard.escape_ascii()
            );
        }
    }
}

#[test]
fn a_loop_that_is_switched_off_is_told_when_its_unit_is_found() {
    for protocol in Protocol::ALL {
        let (mut link, _) =
            over(vec![unit(Mode::SerialPid, protocol, 1)], options(Addresses::Only(1)), Vec::new());
        inject(
            &link,
            Address::FACTORY,
            &Command::Write { register: FUNCTION, value: function::DISABLEPID.into() },
        );
        link.run_for(ms(1_500));
        let notes = text_of(&identities(&link)[0].notes);
        assert!(notes.contains("DISABLEPID"), "{protocol}: {notes}");
        tame(&link);
        assert!(link.arm(ArmScope::Position), "{protocol}: {:?}", failures(&link));
        assert!(warnings(&link).iter().any(|text| text.contains("DISABLEPID")), "{protocol}");
        assert_eq!(register(&link, FUNCTION), 0, "{protocol}");
    }
}

fn text_of(messages: &[Message]) -> String {
    messages.iter().map(ToString::to_string).collect()
}

/// A unit that a program has armed, and to which it is about to send a Stop that changes a register for a while; the number of that register.
fn about_to_stop(mode: Mode, protocol: Protocol, disk: &SimulatedDisk) -> (Link, u8) {
    let (mut link, _) = over(vec![unit(mode, protocol, 1)], noting(disk), Vec::new());
    link.run_for(ms(1_500));
    let set = |link: &Link, register: u8, value: i64| {
        inject(link, Address::FACTORY, &Command::Write { register, value });
        link.line.pass(ms(30));
    };
    if mode == Mode::Serial {
        set(&link, VELOCITYLIMIT, 10);
        assert!(link.arm(ArmScope::Pwm), "{protocol}: {:?}", failures(&link));
        drive(&link, DriveCommand::duty(0.5));
        link.run_for(ms(500));
        return (link, VELOCITYLIMIT);
    }
    tame(&link);
    assert!(link.arm(ArmScope::Velocity), "{protocol}: {:?}", failures(&link));
    // So much gain that the loop oscillates for ever.
    for (register, value) in [(PTERM, 60_000), (DTERM, 0), (PIDSCALAR, 4)] {
        set(&link, register, value);
    }
    drive(&link, speed(4_000));
    link.run_for(ms(500));
    (link, FUNCTION)
}

fn noting(disk: &SimulatedDisk) -> DeviceOptions {
    let loans = Store::on(Arc::new(disk.clone()), "/keep");
    DeviceOptions { loans: Some(Arc::new(loans)), ..options(Addresses::Only(1)) }
}

/// What the store offers of the unit, as the settings that its journals would have written back.
fn offered(link: &mut Link, disk: &SimulatedDisk) -> (SettingsTable, SettingsImage) {
    let identity = identities(link).pop().expect("it was found");
    let table = table(link);
    let subject = *table.subject();
    let ram = job(link, move |wire| read_all(wire, subject)).expect("the line is clean").image;
    let store = Store::on(Arc::new(disk.clone()), "/keep");
    let (journals, faults) = store.open_journals(&UnitId::new(&identity, &[]));
    assert!(faults.is_empty(), "{faults:?}");
    let undone = journals.iter().flat_map(|open| {
        let back = open.journal.remedy(&ram, true);
        back.iter().map(|(key, value)| (key.to_owned(), value)).collect::<Vec<_>>()
    });
    let undone = undone.collect();
    (table, undone)
}

#[test]
fn a_program_killed_at_any_moment_of_a_stop_leaves_a_note_by_which_all_is_given_back_bit_for_bit() {
    for (mode, step, moments) in [(Mode::Serial, 15, 40), (Mode::SerialPid, 60, 45)] {
        for protocol in Protocol::ALL {
            let mut left_changed = 0;
            for moment in 0..moments {
                let disk = SimulatedDisk::default();
                let (mut link, borrowed) = about_to_stop(mode, protocol, &disk);
                let before = register(&link, borrowed);
                // The cable goes in the midst of the stop, and the program is killed then.
                let line = link.line.clone();
                link.at(link.now() + ms(moment * step), move |_| {
                    let unplug = WorldAction::Unplug { unplugged: true };
                    line.with(|machine| machine.inner_mut().inner_mut().apply(0, &unplug));
                });
                link.handle.stop_all();
                link.run_for(ms(4_000));
                assert!(link.ended, "{mode:?} {protocol} at {moment}");
                link.apply(0, &WorldAction::Unplug { unplugged: false });
                let mut link = link.killed_and_opened_again(noting(&disk));
                tame(&link);
                link.run_for(ms(1_500));
                let is_changed = register(&link, borrowed) != before;
                left_changed += usize::from(is_changed);
                let (table, back) = offered(&mut link, &disk);
                assert_eq!(!back.is_empty(), is_changed, "{mode:?} {protocol} at {moment}: {back:?}");
                if is_changed {
                    job(&mut link, move |wire| {
                        let options = WriteOptions { own_stream: None, simulated: false, as_read: true };
                        write(wire, &table, &back, options).map_err(|error| panic!("{error}"))
                    })
                    .expect("the line is clean");
                }
                assert_eq!(register(&link, borrowed), before, "{mode:?} {protocol} at {moment}");
            }
            assert!(left_changed > 3, "{mode:?} {protocol}: {left_changed}, so the test tests little");
        }
    }
}

#[test]
fn a_stop_that_gives_all_back_leaves_no_note() {
    for protocol in Protocol::ALL {
        let disk = SimulatedDisk::default();
        let (mut link, borrowed) = about_to_stop(Mode::Serial, protocol, &disk);
        let before = register(&link, borrowed);
        link.handle.stop_all();
        link.run_for(ms(3_000));
        assert!(link.stops().last().unwrap().confirmed());
        assert_eq!(register(&link, borrowed), before);
        let identity = identities_of(&noting(&disk), link);
        let store = Store::on(Arc::new(disk.clone()), "/keep");
        assert_eq!(store.open_journals(&UnitId::new(&identity, &[])).0, []);
    }
}

/// Who answers a program that opens the line anew.
fn identities_of(options: &DeviceOptions, link: Link) -> Identity {
    let mut link = link.killed_and_opened_again(options.clone());
    link.run_for(ms(1_500));
    identities(&link).pop().expect("it was found")
}

#[test]
fn where_the_note_cannot_be_kept_arming_says_so() {
    let disk = SimulatedDisk::default();
    disk.fail_at(1, DiskFault::Full);
    let (mut link, _) = over(vec![unit(Mode::SerialPid, Protocol::Binary, 1)], noting(&disk), Vec::new());
    link.run_for(ms(1_500));
    assert!(link.arm(ArmScope::Velocity), "{:?}", failures(&link));
    let said = warnings(&link).concat();
    assert!(
        said.contains("note what a stop may change for a while") && said.contains("BRUSHWORK_DATA_DIR"),
        "{said}"
    );
}
