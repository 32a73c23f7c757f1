//! The device thread on a simulated MotorVator in virtual time: what goes over the line before anybody asks for it, and what stops the motors.

use std::time::Duration;

use brushwork::FAMILIES;
use brushwork_core::session::line::SimulatedLine;
use brushwork_link::FamilyChoice;
use brushwork_link::device::{Addresses, ArmScope, DeviceOptions, Event, Request};
use brushwork_plant::machine::{Machine as _, StreamIndex};
use brushwork_plant::world::WorldAction;
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_values::Value;

const MS: Duration = Duration::from_millis(1);

fn link(text: &str, addresses: Addresses) -> VirtualLink<SimulatedLine> {
    brushwork::install();
    let family =
        FAMILIES.iter().find(|family| family.driver.family().key() == "motorvator").expect("it is listed");
    let started = family.simulator.start(text).unwrap_or_else(|error| panic!("{text}: {error}"));
    let options = DeviceOptions {
        addresses,
        family: FamilyChoice::of(family.driver.family()),
        stream: Some(started.stream),
        simulated: true,
        ..DeviceOptions::default()
    };
    let mut link = VirtualLink::to_simulated(started, options);
    link.run_for(3000 * MS);
    assert!(link.events.iter().any(|(_, event)| matches!(event, Event::Connected(_))), "{:?}", link.events);
    link
}

/// Duties of motors A, B, C and D.
fn duties(link: &VirtualLink<SimulatedLine>) -> [f64; 4] {
    let [[a, b], [c, d]] = [link.duties(0), link.duties(1)];
    [a, b, c, d]
}

fn driven() -> VirtualLink<SimulatedLine> {
    let mut link = link("motorvator-3", Addresses::Factory);
    assert!(link.arm(ArmScope::CommandLine));
    link.drive(0.4);
    link.run_for(500 * MS);
    assert_eq!(duties(&link), [0.4, 0.4, 0.0, 0.0]);
    link
}

#[test]
fn nothing_goes_to_a_program_that_may_not_be_the_host_library() {
    let mut link = link("motorvator-3,started=no", Addresses::Scan);
    link.run_for(5000 * MS);
    assert!(!link.arm(ArmScope::CommandLine));
    link.drive(0.4);
    link.run_for(1000 * MS);
    let written = link.take_written();
    assert!(written.len() > 5, "it is looked for again and again");
    // The command line alone hears of these: an end of line, and H.
    assert!(written.iter().all(|bytes| bytes == b"073\rH\r"), "{written:?}");
    let refused = link.events.iter().any(|(_, event)| matches!(event, Event::ArmRefused { .. }));
    assert!(!refused || duties(&link) == [0.0; 4]);
}

#[test]
fn a_board_is_armed_once_the_host_library_answers_and_not_before() {
    let mut link = link("motorvator-3,started=no", Addresses::Factory);
    assert!(!link.arm(ArmScope::CommandLine));
    let reasons = link.events.iter().find_map(|(_, event)| match event {
        Event::ArmRefused { reasons, .. } => Some(reasons[0].to_string()),
        _ => None,
    });
    let said = reasons.expect("it says why");
    assert!(said.contains("the host library does not answer") && said.contains("host.mecc"), "{said}");
    // Somebody at the board starts it.
    link.bus(|bus| bus.receive(StreamIndex::Uart0, b"G\r"));
    link.run_for(2000 * MS);
    assert!(link.arm(ArmScope::CommandLine), "{:?}", link.events);
}

#[test]
fn a_stop_stands_all_four_motors_and_both_steppers() {
    let mut link = driven();
    link.ask(Request::Transact { id: 1, command: b'M', values: vec![Value::Int(3), Value::Int(-70)] });
    link.run_for(200 * MS);
    assert_eq!(duties(&link), [0.4, 0.4, -0.7, 0.0]);
    link.take_written();
    link.handle.stop_all();
    link.run_for(60 * MS);
    assert_eq!(duties(&link), [0.0; 4]);
    link.run_for(500 * MS);
    let first = link.take_written().into_iter().next();
    assert_eq!(first.as_deref(), Some(&b"073\rI088000\r"[..]));
    assert!(link.stops().last().is_some_and(|stop| stop.confirmed()), "{:?}", link.stops());
}

#[test]
fn a_stepper_is_stopped_in_the_midst_of_its_move_and_moves_only_while_armed() {
    let mut link = link("motorvator-3", Addresses::Factory);
    let steps = |id| Request::Transact { id, command: b'T', values: vec![Value::Int(20_000)] };
    let moves = |link: &mut VirtualLink<SimulatedLine>| {
        link.events.clear();
        link.run_for(1500 * MS);
        link.events.iter().any(|(_, event)| match event {
            Event::Status(status) => status.is_active("stepper_1"),
            _ => false,
        })
    };
    link.ask(steps(1));
    assert!(!moves(&mut link), "it moves unarmed");
    assert!(link.arm(ArmScope::CommandLine));
    link.ask(steps(2));
    assert!(moves(&mut link));
    link.handle.stop_all();
    link.run_for(1000 * MS);
    assert!(link.stops().last().is_some_and(|stop| stop.confirmed()), "{:?}", link.stops());
    assert!(!moves(&mut link));
}

#[test]
fn when_this_program_is_gone_the_library_stops_the_motors_after_250_ms() {
    let mut link = driven();
    link.machine_alone_for(200 * MS);
    assert_eq!(duties(&link), [0.4, 0.4, 0.0, 0.0]);
    link.machine_alone_for(150 * MS);
    assert_eq!(duties(&link), [0.0; 4]);
}

#[test]
fn a_board_that_starts_anew_is_disarmed_and_its_motors_stand() {
    let mut link = driven();
    link.apply(0, &WorldAction::Power { on: false });
    link.run_for(300 * MS);
    link.apply(0, &WorldAction::Power { on: true });
    link.run_for(3000 * MS);
    assert!(link.events.iter().any(|(_, event)| matches!(event, Event::Disarmed(_))), "{:?}", link.events);
    assert_eq!(duties(&link), [0.0; 4]);
}
