//! The safety rules of the device thread against the simulated controller in virtual time: motors that turn, and what
//! stops them.

use brushwork_tests::said::Said;
use std::time::Duration;

use brushwork_link::Interruption;
use brushwork_link::Stream;
use brushwork_link::device::{
    ArmScope, Channel, DeviceHandle, DeviceOptions, DisarmReason, Drive, DriveCommand, Event, Job, JobEnding,
    PollRate, Request,
};
use brushwork_link::settings::read_all;
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::{Address, Generation, Request as Packet, number};
use brushwork_plant::faults::{Direction, Fault, FaultEffect};
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::WorldAction;
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_values::{Motor, Value};

fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

fn config(generation: Generation) -> ControllerConfig {
    ControllerConfig { generation, ..ControllerConfig::default() }
}

/// A connected link to one unit over USB.
fn usb(config: ControllerConfig, faults: Vec<Fault>, seed: u64) -> VirtualLink {
    connected(config, StreamIndex::Usb, Stream::Usb, faults, seed)
}

fn connected(
    config: ControllerConfig,
    index: StreamIndex,
    stream: Stream,
    faults: Vec<Fault>,
    seed: u64,
) -> VirtualLink {
    let controller = Controller::new(config).expect("the default world is sound");
    let options = DeviceOptions { stream: Some(stream), simulated: true, ..DeviceOptions::default() };
    let mut link = VirtualLink::new(Bus::single(controller, index), index, options, faults, seed);
    link.run_for(ms(2_000));
    link
}

/// Over USB with both motors at half duty.
fn driving(generation: Generation) -> VirtualLink {
    drive(usb(config(generation), Vec::new(), 1))
}

/// Over RS-232 at its factory rate with both motors at half duty.
fn driving_on_rs232() -> VirtualLink {
    drive(connected(config(Generation::Gen1), StreamIndex::Uart0, Stream::Rs232, Vec::new(), 1))
}

fn drive(mut link: VirtualLink) -> VirtualLink {
    assert!(link.arm(ArmScope::Pwm), "{:?}", link.events);
    link.drive(0.5);
    link.run_for(ms(500));
    let speeds = link.speeds(0);
    assert!(speeds.iter().all(|speed| *speed > 10.0), "the motors do not turn: {speeds:?} rad/s");
    link.events.clear();
    link
}

/// From full duty to none at the highest acceleration, 655359 of 32768 per full duty and second.
const RAMP_DOWN: Duration = Duration::from_millis(50);

fn assert_standing(link: &mut VirtualLink, unit: usize) {
    link.line.pass(RAMP_DOWN);
    assert_eq!(link.duties(unit), [0.0, 0.0]);
    link.line.pass(ms(1_500));
    let speeds = link.speeds(unit);
    assert!(speeds.iter().all(|speed| speed.abs() < 0.01), "{speeds:?} rad/s");
}

fn disarm_reasons(link: &VirtualLink) -> Vec<DisarmReason> {
    let reasons = link.events.iter().filter_map(|(_, event)| match event {
        Event::Disarmed(reason) => Some(reason.clone()),
        _ => None,
    });
    reasons.collect()
}

#[test]
fn stop_brings_both_motors_to_a_stand_in_every_generation() {
    for generation in Generation::ALL {
        let mut link = driving(generation);
        link.handle.stop_all();
        link.run_for(ms(300));
        let report = link.stops()[0].clone();
        assert!(report.confirmed(), "{generation}: {report:?}");
        assert_eq!(report.units[0].buffers_empty, Some(true));
        assert!(report.latency() < ms(2), "{:?}", report.latency());
        assert_eq!(disarm_reasons(&link), [DisarmReason::Stop]);
        assert_standing(&mut link, 0);
    }
}

#[test]
fn stop_in_the_middle_of_the_longest_reply_stands_the_motors_at_once() {
    let mut link = driving_on_rs232();
    // The reply to 144 has 18 records of 45 bytes: 71 ms at 115200.
    link.ask(Request::Transact { id: 1, command: number::READ_SIGNALS, values: Vec::new() });
    let stop_at = link.now() + ms(25);
    link.at(stop_at, DeviceHandle::stop_all);
    // 20 bytes of stop take 1.7 ms; the ramp from half duty 25 ms, in ticks of 3.3 ms.
    let after = link.duties_at(stop_at + ms(9) + RAMP_DOWN / 2, 0);
    link.run_for(ms(700));
    assert_eq!(*after.lock().expect("nothing panicked"), Some([0.0, 0.0]));
    assert!(link.stops()[0].latency() <= ms(1));
    assert!(link.stops()[0].confirmed(), "{:?}", link.stops());
    assert!(link.stops()[0].ended_at > stop_at + ms(40), "the rest of the reply was waited out");
    assert_standing(&mut link, 0);
}

#[test]
fn a_roboclaw_stands_by_the_first_bytes_of_a_stop_alone_and_beside_an_mcp() {
    let roboclaw = models::lookup("roboclaw-2x7a").expect("in the list");
    for generation in Generation::ALL {
        for neighbour in [None, Some(0x81), Some(0x87)] {
            let claw = ControllerConfig { generation, ..ControllerConfig::of(roboclaw) };
            let mut units = vec![Controller::new(claw).expect("the default world is sound")];
            if let Some(address) = neighbour.and_then(Address::new) {
                let mcp = ControllerConfig { address, ..config(generation) };
                units.push(Controller::new(mcp).expect("the default world is sound"));
            }
            let bus = Bus::new(units, StreamIndex::Uart1).expect("a TTL line takes several");
            let options =
                DeviceOptions { stream: Some(Stream::Ttl1), simulated: true, ..DeviceOptions::default() };
            let mut link = VirtualLink::new(bus, StreamIndex::Uart1, options, Vec::new(), 1);
            link.run_for(ms(4_000));
            let duty = Packet::new(Address::DEFAULT, number::DUTY_BOTH, &[16_000, 16_000]);
            let bytes = duty.encode(generation).expect("every generation has it");
            link.bus(|bus| bus.controllers_mut()[0].receive(StreamIndex::Uart1, &bytes));
            link.run_for(ms(500));
            assert!(link.duties(0)[0] > 0.4, "{generation}: {:?}", link.duties(0));
            let stop_at = link.now();
            // At 38400 bit/s 16 bytes take 4.2 ms, those of the neighbour as long; then the ramp, in ticks of 3.3 ms.
            let after = link.duties_at(stop_at + ms(12) + RAMP_DOWN / 2, 0);
            link.handle.stop_all();
            link.run_for(ms(900));
            let duties = *after.lock().expect("nothing panicked");
            assert_eq!(duties, Some([0.0, 0.0]), "{generation}, neighbour {neighbour:?}");
            assert!(link.stops()[0].confirmed(), "{generation}: {:?}", link.stops());
            assert_standing(&mut link, 0);
        }
    }
}

#[test]
fn a_unit_on_usb_is_one_although_it_answers_all_eight_addresses() {
    for generation in Generation::ALL {
        let link = usb(config(generation), Vec::new(), 7);
        let found: Vec<_> = link
            .events
            .iter()
            .filter_map(|(_, event)| match event {
                Event::Connected(identity) => Some(identity.clone()),
                _ => None,
            })
            .collect();
        assert_eq!(found.len(), 1);
        assert_eq!(
            (found[0].generation, found[0].also_answers.len()),
            (brushwork_mcp_client::firmware_of(generation), 7)
        );
        assert!(found[0].notes.is_empty(), "{:?}", found[0].notes);
    }
}

#[test]
fn connecting_and_reading_for_a_minute_moves_nothing() {
    for generation in Generation::ALL {
        let mut link = usb(config(generation), Vec::new(), 1);
        for _ in 0..60 {
            link.run_for(ms(1_000));
            assert_eq!(link.duties(0), [0.0, 0.0]);
        }
        assert!(link.events.iter().any(|(_, event)| matches!(event, Event::Sample(_))));
    }
}

#[test]
fn a_frozen_window_stops_the_motors_250_ms_after_its_last_frame() {
    for generation in [Generation::Gen1, Generation::Gen4] {
        let mut link = driving(generation);
        link.handle.renew();
        link.freeze_window();
        let dies_at = link.now() + ms(250);
        let before = link.duties_at(dies_at - ms(1), 0);
        let after = link.duties_at(dies_at + ms(8) + RAMP_DOWN / 2, 0);
        link.run_for(ms(500));
        let before = before.lock().expect("nothing panicked").expect("it has passed");
        assert!(before.iter().all(|duty| *duty > 0.4), "alive at 249 ms: {before:?}");
        // From half duty the ramp takes 25 ms, in ticks of 3.3 ms.
        assert_eq!(*after.lock().expect("nothing panicked"), Some([0.0, 0.0]));
        assert_eq!(disarm_reasons(&link), [DisarmReason::DeadMan]);
        assert_standing(&mut link, 0);
    }
}

#[test]
fn a_program_that_dies_leaves_the_motors_to_the_controllers_own_time_out() {
    let mut link = driving(Generation::Gen1);
    // Nobody turns the loop any more; the stream's time-out is one second.
    link.machine_alone_for(ms(900));
    assert!(link.duties(0).iter().all(|duty| *duty > 0.4));
    link.machine_alone_for(ms(200));
    assert_standing(&mut link, 0);
}

#[test]
fn pulling_the_cable_is_told_and_the_controller_stops_by_itself() {
    let mut link = driving(Generation::Gen1);
    link.apply(0, &WorldAction::Unplug { unplugged: true });
    link.run_for(ms(1_200));
    assert!(link.ended);
    assert!(link.events.iter().any(|(_, event)| matches!(event, Event::Lost(_))));
    assert_eq!(disarm_reasons(&link), [DisarmReason::LinkLost]);
    assert_standing(&mut link, 0);
}

#[test]
fn moves_that_wait_in_the_buffers_are_dropped_by_a_stop() {
    for generation in Generation::ALL {
        let mut link = usb(config(generation), Vec::new(), 1);
        assert!(link.arm(ArmScope::Velocity));
        let step = DriveCommand::Distance {
            speed_counts_per_s: 2_000,
            accel_counts_per_s2: Some(20_000),
            distance_counts: 4_000,
            queued: true,
        };
        for _ in 0..10 {
            link.ask(Request::Drive(Drive::both(step)));
        }
        link.run_for(ms(800));
        assert!(link.buffers(0).iter().all(|length| (1..=10).contains(length)), "{:?}", link.buffers(0));
        link.handle.stop_all();
        link.run_for(ms(300));
        assert_eq!(link.buffers(0), [0x80, 0x80]);
        assert_eq!(link.stops()[0].units[0].buffers_empty, Some(true));
        assert_standing(&mut link, 0);
    }
}

#[test]
fn an_emergency_stop_disarms_and_arming_again_is_refused_until_it_is_reset() {
    let mut link = driving(Generation::Gen3);
    link.apply(0, &WorldAction::EStop { pressed: true });
    link.run_for(ms(500));
    let stopped = link
        .events
        .iter()
        .any(|(_, event)| matches!(event, Event::Status(status) if status.faults().next().is_some()));
    assert!(stopped, "no fault was told: {:?}", link.events);
    assert!(matches!(disarm_reasons(&link).as_slice(), [DisarmReason::Fault(_)]));
    assert!(!link.arm(ArmScope::Pwm));
    assert_standing(&mut link, 0);
}

#[test]
fn stop_all_reaches_every_unit_of_a_bus() {
    let units = [0x80, 0x81, 0x85].map(|address| {
        let address = Address::new(address).expect("it is one of the eight");
        Controller::new(ControllerConfig { address, ..ControllerConfig::default() }).expect("it is sound")
    });
    let bus = Bus::new(units.to_vec(), StreamIndex::Uart1).expect("TTL is a bus");
    let options = DeviceOptions { stream: Some(Stream::Ttl1), simulated: true, ..DeviceOptions::default() };
    let mut link = VirtualLink::new(bus, StreamIndex::Uart1, options, Vec::new(), 1);
    link.run_for(ms(3_000));
    let found = link.events.iter().filter(|(_, event)| matches!(event, Event::Connected(_))).count();
    assert_eq!(found, 3);
    link.ask(Request::Select(0x85));
    assert!(link.arm(ArmScope::Pwm), "{:?}", link.events);
    link.drive(0.5);
    link.run_for(ms(300));
    assert_eq!(link.duties(0), [0.0, 0.0], "the others do not move");
    assert!(link.duties(2).iter().all(|duty| *duty > 0.4));
    link.handle.stop_all();
    link.run_for(ms(500));
    assert_eq!(link.stops()[0].units.len(), 3);
    assert!(link.stops()[0].confirmed());
    assert_standing(&mut link, 2);
}

#[test]
fn the_ten_motors_of_a_rover_stand_after_one_stop_on_its_line() {
    let roboclaw = models::lookup("roboclaw-2x7a").expect("in the list");
    let units = (0x80..=0x84).filter_map(Address::new).map(|address| {
        let claw = ControllerConfig { address, ..ControllerConfig::of(roboclaw) };
        Controller::new(claw).expect("the default world is sound")
    });
    let bus = Bus::new(units.collect(), StreamIndex::Uart1).expect("a TTL line takes several");
    let options = DeviceOptions { stream: Some(Stream::Ttl1), simulated: true, ..DeviceOptions::default() };
    let mut link = VirtualLink::new(bus, StreamIndex::Uart1, options, Vec::new(), 1);
    link.run_for(ms(4_000));
    let found = link.events.iter().filter(|(_, event)| matches!(event, Event::Connected(_))).count();
    assert_eq!(found, 5);
    for (unit, address) in (0x80..=0x84).filter_map(Address::new).enumerate() {
        let duty = Packet::new(address, number::DUTY_BOTH, &[16_000, 16_000]);
        let bytes = duty.encode(Generation::Gen1).expect("every generation has it");
        link.bus(|bus| bus.controllers_mut()[unit].receive(StreamIndex::Uart1, &bytes));
    }
    link.run_for(ms(500));
    assert!(
        (0..5).all(|unit| link.duties(unit).iter().all(|duty| *duty > 0.4)),
        "another program drives all"
    );
    // At 38400 bit/s the 16 bytes of each unit take 4.2 ms, those of all 21 ms; then the ramp, in ticks of 3.3 ms.
    let stop_at = link.now();
    let after: Vec<_> = (0..5).map(|unit| link.duties_at(stop_at + ms(25) + RAMP_DOWN / 2, unit)).collect();
    link.handle.stop_all();
    link.run_for(ms(900));
    for (unit, duties) in after.iter().enumerate() {
        assert_eq!(*duties.lock().expect("nothing panicked"), Some([0.0, 0.0]), "unit {unit}");
    }
    assert_eq!(link.stops()[0].units.len(), 5);
    assert!(link.stops()[0].confirmed(), "{:?}", link.stops());
}

/// Three units on a TTL line, the second set up by `second`, joined and not armed yet.
fn joined(second: impl Fn(&mut ControllerConfig), faults: Vec<Fault>) -> VirtualLink {
    let units = [0x80, 0x81, 0x85].map(|address| {
        let number = Address::new(address).expect("it is one of the eight");
        let mut config = ControllerConfig { address: number, ..ControllerConfig::default() };
        if address == 0x81 {
            second(&mut config);
        }
        Controller::new(config).expect("it is sound")
    });
    let bus = Bus::new(units.to_vec(), StreamIndex::Uart1).expect("TTL is a bus");
    let options = DeviceOptions { stream: Some(Stream::Ttl1), simulated: true, ..DeviceOptions::default() };
    let mut link = VirtualLink::new(bus, StreamIndex::Uart1, options, faults, 1);
    link.run_for(ms(3_000));
    link.ask(Request::Select(0x85));
    link.ask(Request::Join(vec![0x80, 0x81]));
    link
}

/// The same, armed and driven at half duty.
fn joined_and_driven() -> VirtualLink {
    let mut link = joined(|_| (), Vec::new());
    assert!(link.arm(ArmScope::CommandLine), "{:?}", link.events);
    link.drive(0.5);
    link.run_for(ms(500));
    assert!((0..3).all(|unit| link.duties(unit).iter().all(|duty| *duty > 0.4)), "all move");
    link.events.clear();
    link
}

fn assert_all_stand(link: &mut VirtualLink) {
    (0..3).for_each(|unit| assert_standing(link, unit));
}

#[test]
fn units_that_are_joined_move_and_are_read_together_and_the_dead_man_stands_all_of_them() {
    let mut link = joined_and_driven();
    link.run_for(ms(5_000));
    assert_eq!(disarm_reasons(&link), [], "no time-out of any of them runs out while they are read");
    for address in [0x80, 0x81, 0x85] {
        let samples = link.events.iter().filter_map(|(_, event)| match event {
            Event::Sample(sample) if sample.address == address => sample.get(Channel::M2_VELOCITY),
            _ => None,
        });
        assert!(samples.filter(|speed| *speed > 100.0).count() > 20, "0x{address:02X} is read");
    }
    link.freeze_window();
    link.run_for(ms(700));
    assert_eq!(disarm_reasons(&link), [DisarmReason::DeadMan]);
    let stopped: Vec<u8> = link.stops()[0].units.iter().map(|unit| unit.address).collect();
    assert_eq!(stopped, [0x85, 0x80, 0x81]);
    assert!(link.stops()[0].confirmed());
    assert_all_stand(&mut link);
}

#[test]
fn a_fault_or_the_silence_of_one_joined_unit_stands_all_of_them() {
    let mut link = joined_and_driven();
    link.apply(0, &WorldAction::EStop { pressed: true });
    link.run_for(ms(600));
    assert!(matches!(disarm_reasons(&link).as_slice(), [DisarmReason::Fault(_)]), "{:?}", link.events);
    assert_all_stand(&mut link);

    let mut link = joined_and_driven();
    link.apply(1, &WorldAction::Power { on: false });
    link.run_for(ms(1_000));
    assert_eq!(disarm_reasons(&link), [DisarmReason::NoAnswer]);
    [0, 2].into_iter().for_each(|unit| assert_standing(&mut link, unit));
}

#[test]
fn of_joined_units_none_is_armed_unless_all_can_be_and_another_selection_parts_them() {
    let no_time_out = |config: &mut ControllerConfig| {
        let mut settings = Settings::factory(config.model, config.address.get());
        settings.streams[StreamIndex::Uart1.index()].timeout_ms = 0;
        config.settings = Some(settings);
    };
    let mut link = joined(no_time_out, Vec::new());
    assert!(!link.arm(ArmScope::CommandLine));
    link.drive(0.5);
    link.run_for(ms(300));
    assert!((0..3).all(|unit| link.duties(unit) == [0.0, 0.0]), "none moves");

    let mut link = joined_and_driven();
    link.ask(Request::Select(0x85));
    link.run_for(ms(500));
    assert_eq!(disarm_reasons(&link), [DisarmReason::Selection]);
    assert_all_stand(&mut link);
    assert!(link.arm(ArmScope::CommandLine), "{:?}", link.events);
    link.drive(0.5);
    link.run_for(ms(300));
    assert_eq!([0, 1].map(|unit| link.duties(unit)), [[0.0; 2]; 2], "the selected one moves alone");
    assert!(link.duties(2).iter().all(|duty| *duty > 0.4));
}

#[test]
fn arming_is_refused_with_its_reason_by_what_the_simulated_unit_is_set_to() {
    let cases = [
        (number::SET_STREAM, vec![0, 1, 115_200, 0], "time-out of USB is 0"),
        (number::SET_PRIORITIES, vec![3, 2, 0], "none of the three priority levels"),
    ];
    for (command, values, word) in cases {
        let mut link = usb(config(Generation::Gen1), Vec::new(), 1);
        let values = values.into_iter().map(Value::Int).collect();
        link.ask(Request::Transact { id: 1, command, values });
        assert!(!link.arm(ArmScope::Pwm));
        let reasons = link.events.iter().find_map(|(_, event)| match event {
            Event::ArmRefused { reasons, .. } => Some(reasons.clone()),
            _ => None,
        });
        let reasons = reasons.expect("it was refused");
        assert_eq!(reasons.len(), 1);
        assert!(reasons[0].to_string().contains(word), "{}", reasons[0]);
        link.drive(0.5);
        link.run_for(ms(300));
        assert_eq!(link.duties(0), [0.0, 0.0]);
    }
}

#[test]
fn a_roboclaw_is_refused_until_its_serial_time_out_is_set() {
    let model = models::lookup("roboclaw-2x7a").expect("it is in the list");
    let mut link = usb(
        ControllerConfig { model, generation: Generation::Gen3, ..ControllerConfig::of(model) },
        Vec::new(),
        1,
    );
    assert!(!link.arm(ArmScope::Pwm));
    link.ask(Request::Transact { id: 1, command: number::SET_SERIAL_TIMEOUT, values: vec![Value::Int(10)] });
    assert!(link.arm(ArmScope::Pwm), "{:?}", link.events);
    link.drive(0.5);
    link.run_for(ms(300));
    assert!(link.duties(0).iter().all(|duty| *duty > 0.4));
    link.machine_alone_for(ms(1_200));
    assert_standing(&mut link, 0);
}

#[test]
fn an_input_that_can_still_drive_a_motor_is_named_after_a_stop() {
    let mut link = usb(config(Generation::Gen3), Vec::new(), 1);
    // Pin 1: analog, position, motor 1, no actions, low pass 0, 1 s, home 0, 0 to 4095 around 2048, no dead band, linear,
    // full output, no offset, no potentiometer.
    let pin = [0, 1, 0, 1, 0, 0, 0, 1_000, 0, 0, 4_095, 2_048, 0, 0, -32_767, 32_767, 0, 0];
    let values = pin.into_iter().map(Value::Int).collect();
    link.ask(Request::Transact { id: 1, command: number::SET_SIGNAL, values });
    let levels = [1, 3, 0].into_iter().map(Value::Int).collect();
    link.ask(Request::Transact { id: 2, command: number::SET_PRIORITIES, values: levels });
    link.run_for(ms(200));
    let answers =
        link.events.iter().filter(|(_, event)| matches!(event, Event::Transacted { result: Ok(_), .. }));
    assert_eq!(answers.count(), 2, "{:?}", link.events);
    link.handle.stop_all();
    link.run_for(ms(300));
    let drivers = &link.stops()[0].units[0].still_driven_by;
    assert_eq!(drivers.as_slice(), ["The analog input DIN1 can drive motor 1."]);
}

#[test]
fn a_stop_into_a_dead_spot_of_the_line_is_repeated_until_it_is_heard() {
    for length in [100, 300, 500, 700, 900, 1_100] {
        let mut link = drive(usb(
            config(Generation::Gen1),
            vec![Fault {
                effect: FaultEffect::Mute,
                direction: Direction::ToController,
                unit: 0,
                from: ms(4_000),
                until: Some(ms(4_000 + length)),
            }],
            1,
        ));
        link.run_for(ms(4_020) - link.now());
        link.handle.stop_all();
        link.run_for(ms(length + 300) + RAMP_DOWN);
        assert_eq!(link.duties(0), [0.0, 0.0], "after {length} ms without a byte");
        assert!(
            link.stops().last().is_some_and(|stop| stop.confirmed()),
            "after {length} ms: {:?}",
            link.stops()
        );
        assert_standing(&mut link, 0);
    }
}

#[test]
fn a_job_that_panics_in_mid_motion_leaves_the_motors_standing() {
    let mut link = usb(config(Generation::Gen1), Vec::new(), 1);
    assert!(link.arm(ArmScope::Tuning));
    let job = Job::<()>::moving(Said::TryMotor, ms(10_000), |context| {
        context.transact(number::DUTY_BOTH, &[16_384, 16_384]).expect("it is armed");
        context.sleep(ms(300)).expect("nothing breaks in");
        panic!("a bug in the job")
    });
    link.start(job);
    link.run_for(ms(800));
    let ending = link.events.iter().find_map(|(_, event)| match event {
        Event::JobEnded(report) => {
            Some((matches!(report.ending, JobEnding::Panicked(_)), report.motors_stopped))
        }
        _ => None,
    });
    assert_eq!(ending, Some((true, Some(true))));
    assert_standing(&mut link, 0);
}

#[test]
fn stop_overtakes_the_reading_of_all_settings() {
    let mut link = driving_on_rs232();
    let model = models::lookup("mcp266").expect("it is in the list");
    let job = Job::new(Said::Settings, ms(30_000), move |context| {
        let subject =
            brushwork_mcp_client::subject(model, brushwork_mcp_client::layout_of(context.generation()));
        read_all(context, subject)
    });
    link.start(job);
    link.at(link.now() + ms(30), DeviceHandle::stop_all);
    link.run_for(ms(1_000));
    let broken = link.events.iter().any(|(_, event)| {
        matches!(event, Event::JobEnded(report) if matches!(report.ending, JobEnding::Interrupted(Interruption::Stop)))
    });
    assert!(broken, "{:?}", link.events);
    assert!(link.stops()[0].latency() <= ms(1));
    assert_standing(&mut link, 0);
}

// ---------------------------------------------------------------------------------------------

/// Numbers that look random and are the same in each run (xorshift).
struct Dice(u64);

impl Dice {
    fn roll(&mut self, sides: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % sides
    }

    fn share(&mut self) -> f64 {
        self.roll(1_000) as f64 / 1_000.0
    }
}

/// What is known of a soaked link from outside.
struct Watchman {
    /// Since when no motion is allowed any more; `None` while it may go on.
    forbidden_since: Option<Duration>,
    frozen_at: Option<Duration>,
    seen: usize,
}

impl Watchman {
    /// Follows the events and says since when the motors must not be driven.
    fn forbidden_since(&mut self, link: &VirtualLink) -> Option<Duration> {
        for (at, event) in &link.events[self.seen..] {
            match event {
                Event::Armed { .. } => self.forbidden_since = None,
                Event::Disarmed(_) | Event::Lost(_) | Event::Closed => {
                    self.forbidden_since = self.forbidden_since.or(Some(*at));
                }
                _ => {}
            }
        }
        self.seen = link.events.len();
        let dead_man = self.frozen_at.map(|at| at + ms(250));
        [self.forbidden_since, dead_man].into_iter().flatten().min()
    }
}

/// A link with a noisy wire on which all kinds of things are done at random. Returns the virtual time it took, and how much of it
/// a motor was driven.
fn soak(seed: u64) -> [Duration; 2] {
    let mut dice = Dice(seed | 1);
    let generation = Generation::ALL[dice.roll(4) as usize];
    let share = [0.0, 0.0, 0.001, 0.01][dice.roll(4) as usize];
    let fault = |effect, from: u64, until: Option<u64>| Fault {
        effect,
        direction: Direction::Both,
        unit: 0,
        from: ms(from),
        until: until.map(ms),
    };
    let mut faults = vec![fault(FaultEffect::Corrupt { share }, 3_000, None)];
    // Silences of all lengths, in both directions or in one.
    let mute = dice.roll(2) == 0;
    let mut from = 3_000;
    while mute && from < 120_000 {
        from += dice.roll(6_000);
        let length = 20 + dice.roll(1_500);
        let direction = [Direction::Both, Direction::ToController, Direction::ToHost][dice.roll(3) as usize];
        faults.push(Fault { direction, ..fault(FaultEffect::Mute, from, Some(from + length)) });
        from += length;
    }
    let mut link = usb(config(generation), faults, seed);
    let mut watchman = Watchman { forbidden_since: Some(ms(0)), frozen_at: None, seen: 0 };
    // What the wire loses costs retries, and in the worst case the controller's own second.
    let grace = if share > 0.0 || mute { ms(1_600) } else { RAMP_DOWN + ms(5) };
    let mut driven = Duration::ZERO;
    while link.now() < ms(120_000) && !link.ended {
        act_at_random(&mut link, &mut dice, &mut watchman);
        let until = link.now() + ms(10 + dice.roll(400));
        while link.now() < until {
            link.run_for(ms(5));
            let forbidden = watchman.forbidden_since(&link).is_some_and(|since| link.now() > since + grace);
            let duties = link.duties(0);
            driven += if duties == [0.0, 0.0] { Duration::ZERO } else { ms(5) };
            assert!(!forbidden || duties == [0.0, 0.0], "seed {seed}: {duties:?} at {:?}", link.now());
        }
    }
    if link.ended {
        link.machine_alone_for(ms(1_200));
        assert_eq!(link.duties(0), [0.0, 0.0], "seed {seed}: driven after the link was lost");
    }
    [link.now(), driven]
}

fn act_at_random(link: &mut VirtualLink, dice: &mut Dice, watchman: &mut Watchman) {
    let scopes = [ArmScope::Pwm, ArmScope::Velocity, ArmScope::Position, ArmScope::Tuning, ArmScope::Script];
    let speed = (dice.share() * 4_000.0) as i32 - 2_000;
    let motion = match dice.roll(4) {
        0 => DriveCommand::duty(dice.share() * 2.0 - 1.0),
        1 => DriveCommand::Speed { speed_counts_per_s: speed, accel_counts_per_s2: Some(10_000) },
        2 => DriveCommand::Distance {
            speed_counts_per_s: speed,
            accel_counts_per_s2: None,
            distance_counts: 3_000,
            queued: true,
        },
        _ => DriveCommand::Duty { duty: dice.share(), accel_duty_per_s: Some(1.0) },
    };
    // A full queue refuses, as it should while a job runs.
    let ask = |request| {
        let _ = link.handle.request(request);
    };
    // A frozen window asks for nothing; Stop may come from elsewhere.
    let act =
        if watchman.frozen_at.is_some() { [9, 15, 15, 14][dice.roll(4) as usize] } else { dice.roll(16) };
    match act {
        0..=2 => ask(Request::Arm(scopes[dice.roll(5) as usize])),
        3..=8 => ask(Request::Drive(Drive::one(Motor::BOTH[dice.roll(2) as usize], motion))),
        9 => link.handle.stop_all(),
        10 => ask(Request::Disarm),
        11 => ask(Request::Poll(
            [PollRate::Off, PollRate::DEFAULT, PollRate::Every(ms(20))][dice.roll(3) as usize],
        )),
        12 => ask(Request::StartScript),
        13 => ask(Request::Job(
            Job::<()>::moving(Said::Wander, ms(400), |context| {
                loop {
                    let error =
                        context.transact(number::DUTY_M1, &[9_000]).and_then(|_| context.sleep(ms(20))).err();
                    if let Some(error) = error {
                        return Err(error.failure(Said::Wander, "the bench"));
                    }
                }
            })
            .queued()
            .0,
        )),
        14 => {
            link.freeze_window();
            watchman.frozen_at = watchman.frozen_at.or(Some(link.now()));
        }
        _ => {
            link.thaw_window();
            watchman.frozen_at = None;
        }
    }
}

/// How much virtual time is soaked; more by the environment variable `BRUSHWORK_SOAK_HOURS`.
fn soak_hours() -> f64 {
    std::env::var("BRUSHWORK_SOAK_HOURS").ok().and_then(|hours| hours.parse().ok()).unwrap_or(0.5)
}

#[test]
fn hours_of_random_use_on_a_noisy_wire_never_leave_a_motor_driven_unasked() {
    let wanted = Duration::from_secs_f64(soak_hours() * 3_600.0);
    let [mut soaked, mut driven] = [Duration::ZERO; 2];
    let mut seed = 0x9E37_79B9;
    while soaked < wanted {
        let [lasted, moved] = soak(seed);
        soaked += lasted;
        driven += moved;
        seed += 0x0123_4567_89AB;
    }
    assert!(driven > soaked / 20, "motors were driven for {driven:?} of {soaked:?} only");
}
