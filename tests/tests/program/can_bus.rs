//! The device thread on a CANopen bus with simulated nodes, in virtual time: it finds them, reads and writes what packet serial does, and
//! holds the same safety rules.

use brushwork_tests::said::Said;
use std::time::Duration;

use brushwork_canopen::NodeId;
use brushwork_canopen::adapter::Form;
use brushwork_link::device::{
    Addresses, ArmScope, Channel, DeviceOptions, DisarmReason, Drive, DriveCommand, Event, Identity, Job,
    Request,
};
use brushwork_link::settings::{ReadReport, SettingValue, SettingsImage, WriteOptions, read_all, write};
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_plant::faults::{Direction, Fault, FaultEffect};
use brushwork_plant::machine::{Machine as _, StreamIndex};
use brushwork_plant::world::WorldAction;
use brushwork_tests::virtual_link::VirtualLink;

fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

fn config(generation: Generation, node: u8) -> ControllerConfig {
    let mut config = ControllerConfig { generation, ..ControllerConfig::default() };
    let mut settings = Settings::factory(config.model, config.address.get());
    settings.unit.can_node_id = node;
    config.settings = Some(settings);
    config
}

fn bus(generation: Generation, nodes: &[u8], form: Form) -> Bus {
    let units =
        nodes.iter().map(|node| Controller::new(config(generation, *node)).expect("the preset is valid"));
    Bus::on_can(units.collect(), form).expect("there is a unit")
}

fn options(simulated: bool) -> DeviceOptions {
    DeviceOptions { simulated, ..DeviceOptions::default() }
}

/// A link to one simulated node that is found and read.
fn connected(generation: Generation) -> VirtualLink {
    let mut link =
        VirtualLink::on_can(bus(generation, &[3], Form::Ascii), Form::Ascii, options(true), Vec::new(), 1);
    link.run_for(ms(3000));
    link
}

fn armed() -> VirtualLink {
    let mut link = connected(Generation::Gen1);
    assert!(link.arm(ArmScope::Pwm), "{:?}", link.events);
    link
}

fn identities(link: &VirtualLink) -> Vec<Identity> {
    let found = link.events.iter().filter_map(|(_, event)| match event {
        Event::Connected(identity) => Some(identity.clone()),
        _ => None,
    });
    found.collect()
}

fn disarmed_by(link: &VirtualLink) -> Vec<DisarmReason> {
    let reasons = link.events.iter().filter_map(|(_, event)| match event {
        Event::Disarmed(reason) => Some(reason.clone()),
        _ => None,
    });
    reasons.collect()
}

#[test]
fn nodes_are_found_in_both_forms_and_generations_and_nothing_moves() {
    for form in Form::ALL {
        for generation in Generation::ALL {
            let mut link =
                VirtualLink::on_can(bus(generation, &[3, 17], form), form, options(false), Vec::new(), 1);
            link.run_for(Duration::from_secs(5));
            let found = identities(&link);
            let reported: Vec<_> =
                found.iter().map(|unit| (unit.place(), unit.model, unit.generation)).collect();
            let expected = [
                ("node 3".to_owned(), Some("MCP266"), brushwork_mcp_client::firmware_of(generation)),
                ("node 17".to_owned(), Some("MCP266"), brushwork_mcp_client::firmware_of(generation)),
            ];
            assert_eq!(reported, expected, "{form:?}");
            assert!(
                found[0].notes.iter().any(|note| note.to_string().contains("product 0x0000010A")),
                "{:?}",
                found[0].notes
            );
            assert!(found.iter().all(|unit| unit.protocol == "CANopen" && unit.firmware == "1.0.0"));
            assert_eq!((link.duties(0), link.duties(1)), ([0.0; 2], [0.0; 2]));
        }
    }
}

#[test]
fn a_node_that_is_named_is_found_alone_and_one_that_is_not_there_is_told() {
    let named = |node| DeviceOptions { addresses: Addresses::Only(node), ..options(true) };
    let open = |node| {
        let bus = bus(Generation::Gen1, &[3, 17], Form::Ascii);
        let mut link = VirtualLink::on_can(bus, Form::Ascii, named(node), Vec::new(), 1);
        link.run_for(ms(3000));
        link
    };
    assert_eq!(identities(&open(17)).iter().map(|unit| unit.address).collect::<Vec<_>>(), [17]);
    let lost = open(9).events.into_iter().find_map(|(_, event)| match event {
        Event::Lost(failure) => Some(failure.to_string()),
        _ => None,
    });
    assert!(lost.clone().unwrap().contains("node 9"), "{lost:?}");
}

#[test]
fn readings_are_those_of_the_machine() {
    let mut link = connected(Generation::Gen1);
    link.events.clear();
    link.run_for(ms(3000));
    let newest = |channel| {
        link.events.iter().rev().find_map(|(_, event)| match event {
            Event::Sample(sample) => sample.get(channel),
            _ => None,
        })
    };
    let volts = link.bus(|bus| bus.views()[0].battery_volts);
    let read = newest(Channel::MAIN_BATTERY).unwrap();
    assert!((read - volts).abs() < 0.2, "{read} V against {volts} V");
    assert!(link.events.iter().any(|(_, event)| matches!(event, Event::Status(status) if status.word == 0)));
    assert!(newest(Channel::M1_POSITION).is_some() && newest(Channel::M2_VELOCITY).is_some());
}

/// Runs a job that hands back a value.
fn run<T: Send + 'static>(
    link: &mut VirtualLink,
    mut work: impl FnMut(&mut brushwork_link::device::JobContext<'_>) -> T + Send + 'static,
) -> T {
    let ticket = link.start(Job::new(Said::Test, Duration::from_secs(300), move |wire| Ok(work(wire))));
    for _ in 0..300 {
        link.run_for(ms(1000));
        if let Some(value) = ticket.take() {
            return value;
        }
    }
    panic!("the job did not end");
}

fn settings(link: &mut VirtualLink, generation: Generation) -> ReadReport {
    let subject = brushwork_mcp_client::subject(models::lookup("mcp266").expect("it is listed"), generation);
    run(link, move |wire| read_all(wire, subject)).expect("the link holds")
}

#[test]
fn every_setting_reads_over_can_as_over_packet_serial_in_every_generation() {
    for generation in Generation::ALL {
        let mut can = connected(generation);
        let serial_bus = Bus::single(Controller::new(config(generation, 3)).unwrap(), StreamIndex::Usb);
        let mut serial = VirtualLink::new(serial_bus, StreamIndex::Usb, options(true), Vec::new(), 1);
        serial.run_for(ms(3000));
        let (over_can, over_serial) = (settings(&mut can, generation), settings(&mut serial, generation));
        // What needs an argument to be read has no object.
        let missing: Vec<_> = over_can.failures.iter().flat_map(|unread| unread.keys.clone()).collect();
        assert!(missing.is_empty(), "{generation}: {missing:?}");
        assert_eq!(over_can.image, over_serial.image, "{generation}");
        assert!(over_can.image.len() > 150, "{} settings", over_can.image.len());
    }
}

#[test]
fn settings_written_over_can_take_and_are_read_back() {
    let mut link = connected(Generation::Gen4);
    let report = settings(&mut link, Generation::Gen4);
    let mut wanted = SettingsImage::default();
    wanted.set("motor1.velocity.qpps", SettingValue::Int(12_345));
    let table = report.table.clone();
    let written = run(&mut link, move |wire| {
        write(wire, &table, &wanted, WriteOptions { own_stream: None, simulated: true, as_read: false })
    });
    assert!(written.is_ok(), "{:?}", written.err().map(|failure| failure.to_string()));
    let qpps = link.bus(|bus| bus.controllers()[0].settings().motors[0].motion.qpps);
    assert_eq!(qpps, 12_345);
}

#[test]
fn a_real_controller_is_not_armed_over_can_and_it_says_why() {
    let bus = bus(Generation::Gen1, &[3], Form::Ascii);
    let mut link = VirtualLink::on_can(bus, Form::Ascii, options(false), Vec::new(), 1);
    link.run_for(ms(3000));
    assert!(!link.arm(ArmScope::Pwm));
    let reported = link.events.iter().find_map(|(_, event)| match event {
        Event::ArmRefused { reasons, .. } => Some(reasons[0].to_string()),
        _ => None,
    });
    assert!(reported.clone().unwrap().contains("no time-out (MCP manual 1.9.4)"), "{reported:?}");
    link.drive(0.5);
    link.run_for(ms(500));
    assert_eq!(link.duties(0), [0.0, 0.0]);
}

#[test]
fn motion_needs_arming_lives_while_it_is_renewed_and_stops() {
    let mut link = connected(Generation::Gen1);
    link.drive(0.5);
    link.run_for(ms(300));
    assert_eq!(link.duties(0), [0.0, 0.0], "nothing is armed");
    assert!(link.arm(ArmScope::Pwm));
    link.drive(0.5);
    link.run_for(Duration::from_secs(5));
    assert!(link.duties(0).iter().all(|duty| (duty - 0.5).abs() < 0.01), "{:?}", link.duties(0));
    link.handle.stop_all();
    link.run_for(ms(100));
    assert_eq!(link.duties(0), [0.0, 0.0]);
    assert!(link.stops().last().unwrap().confirmed());
    assert_eq!(disarmed_by(&link), [DisarmReason::Stop]);
}

#[test]
fn a_frozen_window_stops_the_motors_after_250_ms() {
    let mut link = armed();
    link.drive(0.5);
    link.run_for(ms(500));
    link.freeze_window();
    let frozen_at = link.now();
    let after = link.duties_at(frozen_at + ms(300), 0);
    link.run_for(ms(1000));
    assert_eq!(*after.lock().unwrap(), Some([0.0, 0.0]), "within 300 ms of the last frame");
}

#[test]
fn a_program_that_dies_leaves_the_motors_to_the_node_that_watches_its_heartbeat() {
    let mut link = armed();
    link.drive(0.5);
    link.run_for(Duration::from_secs(3));
    assert!(link.duties(0)[0] > 0.4);
    link.machine_alone_for(ms(900));
    assert!(link.duties(0)[0] > 0.4, "the heartbeat may stay away for a second");
    link.machine_alone_for(ms(300));
    assert_eq!(link.duties(0), [0.0, 0.0]);
}

#[test]
fn stop_breaks_into_the_reading_of_a_list_and_every_access_at_any_moment() {
    for moment in (0..60).map(|step| Duration::from_micros(step * 700)) {
        let mut link = armed();
        link.drive(0.4);
        link.run_for(ms(300));
        // A list of eight records with many fields each: hundreds of accesses.
        link.ask(Request::Transact { id: 1, command: 144, values: Vec::new() });
        let at = link.now() + moment;
        link.at(at, brushwork_link::device::DeviceHandle::stop_all);
        link.run_for(ms(300));
        assert_eq!(link.duties(0), [0.0, 0.0], "stop {moment:?} after the request");
        let stop = link.stops().last().copied().cloned().unwrap();
        assert!(
            stop.written_at <= at + ms(3),
            "{moment:?}: {:?} after it was asked for",
            stop.written_at - at
        );
        assert!(stop.confirmed());
    }
}

#[test]
fn a_node_without_power_is_a_lost_link_and_disarms() {
    let mut link = armed();
    link.drive(0.5);
    link.run_for(ms(500));
    link.events.clear();
    link.apply(0, &WorldAction::Power { on: false });
    link.run_for(Duration::from_secs(6));
    assert!(link.ended, "{:?}", link.events);
    assert!(!disarmed_by(&link).is_empty());
}

#[test]
fn a_heartbeat_that_stays_away_is_a_lost_link_though_the_node_still_answers() {
    let mut link = connected(Generation::Gen1);
    link.run_for(Duration::from_secs(3));
    // Object 1017: no heartbeat any more; the node goes on answering.
    link.bus(|bus| bus.set_producer_heartbeat(0, 0));
    link.run_for(Duration::from_secs(8));
    let lost = link.events.iter().find_map(|(_, event)| match event {
        Event::Lost(failure) => Some(failure.to_string()),
        _ => None,
    });
    assert!(lost.clone().is_some_and(|lost| lost.contains("heartbeat of node 3 stayed away")), "{lost:?}");
}

#[test]
fn a_node_that_starts_anew_disarms() {
    let mut link = armed();
    link.drive(0.3);
    link.run_for(ms(400));
    link.events.clear();
    link.apply(0, &WorldAction::Power { on: false });
    link.run_for(ms(20));
    link.apply(0, &WorldAction::Power { on: true });
    link.run_for(ms(1500));
    assert!(!disarmed_by(&link).is_empty(), "{:?}", link.events);
    assert_eq!(link.duties(0), [0.0, 0.0]);
    let armed_again = link.events.iter().any(|(_, event)| matches!(event, Event::Armed { .. }));
    assert!(!armed_again);
}

#[test]
fn on_a_noisy_line_nothing_is_driven_unasked() {
    for seed in 0..12 {
        let noise = Fault {
            effect: FaultEffect::Drop { share: 0.002 },
            direction: Direction::Both,
            unit: 0,
            from: ms(5000),
            until: None,
        };
        let bus = bus(Generation::Gen1, &[3], Form::Ascii);
        let mut link = VirtualLink::on_can(bus, Form::Ascii, options(true), vec![noise], seed);
        link.run_for(ms(5000));
        for _ in 0..6 {
            if link.ended || !link.arm(ArmScope::Pwm) {
                continue;
            }
            link.ask(Request::Drive(Drive::both(DriveCommand::duty(0.3))));
            link.run_for(ms(700));
            link.handle.stop_all();
            link.run_for(ms(1500));
            assert_eq!(link.duties(0), [0.0, 0.0], "seed {seed}: {:?}", link.events);
        }
    }
}

/// What a search that found nobody said.
fn lost(link: &VirtualLink) -> String {
    let lost = link.events.iter().find_map(|(_, event)| match event {
        Event::Lost(failure) => Some(failure.to_string()),
        _ => None,
    });
    lost.unwrap_or_default()
}

#[test]
fn a_node_that_is_stopped_is_told_as_such_with_what_to_do() {
    for addresses in [Addresses::Scan, Addresses::Only(3)] {
        let mut bus = bus(Generation::Gen1, &[3], Form::Ascii);
        bus.receive(StreamIndex::Usb, b":S000N0203;"); // NMT: stop, node 3
        let mut link = VirtualLink::on_can(
            bus,
            Form::Ascii,
            DeviceOptions { addresses, ..options(true) },
            Vec::new(),
            1,
        );
        link.run_for(Duration::from_secs(5));
        let sentence = lost(&link);
        assert!(sentence.contains("node 3 is stopped"), "{addresses:?}: {sentence}");
        assert!(sentence.contains("brushwork nodes --start 3"), "{sentence}");
    }
}

#[test]
fn a_foreign_node_is_never_written_to_not_even_by_a_stop_at_any_moment_of_the_search() {
    for moment in (0..40).map(|step| ms(step * 50)) {
        let mut bus = bus(Generation::Gen1, &[3], Form::Ascii);
        bus.add_other_node(NodeId::new(9).unwrap());
        let mut link = VirtualLink::on_can(bus, Form::Ascii, options(false), Vec::new(), 1);
        link.at(moment, brushwork_link::device::DeviceHandle::stop_all);
        link.run_for(Duration::from_secs(8));
        let found: Vec<u8> = identities(&link).iter().map(|unit| unit.address).collect();
        assert_eq!(found, [3], "{moment:?}");
        assert!(link.stops().last().is_some_and(|stop| stop.confirmed()), "{moment:?}");
        assert!(link.bus(|bus| bus.other_nodes()[0].written().is_empty()), "{moment:?}");
    }
}

#[test]
fn two_controllers_with_one_number_are_told_and_neither_is_written_to() {
    for addresses in [Addresses::Scan, Addresses::Only(3)] {
        let bus = bus(Generation::Gen1, &[3, 3], Form::Ascii);
        let mut link = VirtualLink::on_can(
            bus,
            Form::Ascii,
            DeviceOptions { addresses, ..options(true) },
            Vec::new(),
            1,
        );
        link.run_for(Duration::from_secs(5));
        assert!(identities(&link).is_empty());
        let sentence = lost(&link);
        assert!(sentence.contains("several devices answer as node 3"), "{addresses:?}: {sentence}");
    }
}
