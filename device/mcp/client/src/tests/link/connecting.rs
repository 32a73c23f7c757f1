//! Finding units: which answer, what they are, and what is said when none does.

use crate::tests::link::harness::Link;
use crate::tests::testing::ms;
use crate::tests::testing::unit::{Bus, answer_all_eight, of_generation};
use brushwork_link::clock::Clock;
use brushwork_link::device::Event;
use brushwork_link::device::Identity;
use brushwork_link::device::Request;
use brushwork_link::device::{Addresses, DeviceOptions};
use brushwork_link::transport::Stream;
use brushwork_mcp_wire::packet_serial::{Effect, Generation, lookup, number};
use std::collections::BTreeSet;

fn identities(link: &Link) -> Vec<Identity> {
    let identities = link.events.iter().filter_map(|(_, event)| match event {
        Event::Connected(identity) => Some(identity.clone()),
        _ => None,
    });
    identities.collect()
}

fn connect(bus: crate::tests::testing::unit::SharedBus, stream: Option<Stream>) -> Link {
    let mut link = Link::with(bus, DeviceOptions { stream, ..DeviceOptions::default() });
    link.run_for(ms(3_000));
    link
}

#[test]
fn each_generation_is_detected_by_the_lengths_of_its_replies() {
    for generation in Generation::ALL {
        let bus = Bus::shared();
        of_generation(&bus, generation);
        let found = identities(&connect(bus, None));
        assert_eq!(found.len(), 1);
        let unit = &found[0];
        assert_eq!(
            (unit.generation, unit.address, unit.model),
            (crate::firmware_of(generation), 0x80, Some("MCP266"))
        );
        assert_eq!((unit.firmware.as_str(), unit.notes.as_slice()), ("1.0.0", [].as_slice()));
    }
}

#[test]
fn connecting_and_reading_send_queries_and_nothing_else() {
    for generation in Generation::ALL {
        let bus = Bus::shared();
        of_generation(&bus, generation);
        let link = connect(bus, None);
        for taken in &link.bus().taken {
            let effect = lookup(taken.command).unwrap().effect(generation);
            assert_eq!(effect, Effect::Query, "command {} in {generation}", taken.command);
        }
        assert!(link.bus().taken.len() > 20, "it has read for a while");
    }
}

#[test]
fn a_unit_that_answers_only_part_is_read_as_far_as_it_goes_and_the_rest_is_named() {
    let bus = Bus::shared();
    of_generation(&bus, Generation::Gen3);
    // What a RoboClaw 2x7A with firmware 4.2.8 leaves unanswered, and a missing second sensor.
    let mute = [number::READ_PWM_MODE, number::READ_ADDRESS_MIXED, number::READ_TEMPERATURE_2];
    bus.lock().unwrap().mute = BTreeSet::from(mute);
    bus.lock().unwrap().version = "USB Roboclaw 2x7a v4.2.8".to_owned();
    let mut link = connect(bus, None);
    let unit = &identities(&link)[0];
    assert_eq!(unit.generation, crate::firmware_of(Generation::Gen3));
    assert_eq!(unit.firmware, "4.2.8");
    link.forget();
    link.run_for(ms(3_000));
    assert_eq!(link.bus().count(number::READ_TEMPERATURE_2), 0, "it is not asked for again");
    assert!(link.bus().count(number::READ_TEMPERATURE_1) > 3);
    assert_eq!(link.sentences(), Vec::<String>::new());
}

#[test]
fn eight_answers_in_the_same_state_are_one_unit_over_usb() {
    for stream in [Some(Stream::Usb), None] {
        let bus = Bus::shared();
        answer_all_eight(&bus);
        let found = identities(&connect(bus, stream));
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].also_answers, [0x81, 0x82, 0x83, 0x84, 0x85, 0x86, 0x87]);
    }
}

#[test]
fn two_units_of_a_bus_are_two_and_the_other_one_is_looked_at_too() {
    let bus = Bus::shared();
    bus.lock().unwrap().addresses = BTreeSet::from([0x80, 0x84]);
    let mut link = connect(bus, Some(Stream::Ttl1));
    let addresses: Vec<_> = identities(&link).iter().map(|unit| unit.address).collect();
    assert_eq!(addresses, [0x80, 0x84]);
    assert!(link.has(|event| matches!(event, Event::Selected { address: 0x80, stream: Some(Stream::Ttl1) })));
    assert!(link.has(|event| matches!(event, Event::Status(status) if status.address == 0x84)));
    link.forget();
    link.ask(Request::Select(0x84));
    link.ask(Request::Select(0x87));
    link.run_for(ms(200));
    assert!(link.has(|event| matches!(event, Event::Selected { address: 0x84, .. })));
    assert!(link.has(|event| matches!(event, Event::Sample(sample) if sample.address == 0x84)));
    assert_eq!(
        link.sentences(),
        [
            "Could not select the unit 0x87 on /dev/test: no unit answered there when the link was opened. Disconnect and \
          connect again to look for it."
        ]
    );
}

#[test]
fn a_silent_port_is_told_in_a_sentence_and_the_loop_ends() {
    let bus = Bus::shared();
    bus.lock().unwrap().dead = true;
    let mut link = connect(bus, None);
    link.settle_to_end();
    assert_eq!(
        link.sentences(),
        [
            "Could not find a controller on /dev/test: nothing answered at addresses 0x80 to 0x87. Check that the controller \
          has motor power, that the cable and the port are right, and the baud rate."
        ]
    );
}

#[test]
fn a_port_that_is_no_controller_is_told_by_what_it_says_and_nothing_is_sent_but_queries() {
    use crate::tests::testing::ScriptedTransport;
    use brushwork_link::clock::VirtualClock;
    use brushwork_link::device::{DeviceLoop, Step};
    let clock = VirtualClock::new();
    let (transport, tap) = ScriptedTransport::new(&clock, |_, _| vec![(ms(1), b"login: ".to_vec())]);
    let options = DeviceOptions { addresses: Addresses::Only(0x80), ..DeviceOptions::default() };
    let (mut device_loop, handle) = DeviceLoop::new(transport, std::sync::Arc::new(clock), options);
    while device_loop.step() != Step::Ended {}
    let Ok(Event::Lost(failure)) = handle.events().try_recv() else { panic!("nothing was told") };
    assert_eq!(
        failure.to_string(),
        "Could not find a controller on /dev/test: 35 bytes came, but no packet serial, from address 0x80. Check the baud \
         rate, and that the device on this port is a motor controller set to packet serial."
    );
    // 0x80, command 21 (read version), three times, and twice more with patience.
    let writes: Vec<_> = tap.writes().into_iter().map(|(_, bytes)| bytes).collect();
    assert_eq!(writes, [[0x80, 21]; 5]);
}

#[test]
fn a_computer_under_load_that_answers_late_is_waited_for() {
    use crate::tests::testing::{ScriptedTransport, reply_to};
    use brushwork_link::clock::VirtualClock;
    use brushwork_link::device::{DeviceLoop, Step};
    let clock = VirtualClock::new();
    // Every answer takes 120 ms, far longer than the 20 ms of a link that is well.
    let (transport, tap) = ScriptedTransport::new(&clock, |request, _| match request {
        [0x80, 21] => vec![(ms(120), reply_to(request, b"MCP266 2x60A v1.0.0\n\0"))],
        _ => Vec::new(),
    });
    let options = DeviceOptions { addresses: Addresses::Only(0x80), ..DeviceOptions::default() };
    let (mut device_loop, handle) = DeviceLoop::new(transport, std::sync::Arc::new(clock.clone()), options);
    let mut found = false;
    while !found && clock.now() < ms(10_000) {
        match device_loop.step() {
            Step::Ended => break,
            Step::IdleUntil(at) => clock.advance_to(at),
            Step::Again => {}
        }
        found |= handle.events().try_iter().any(|event| matches!(event, Event::Connected(_)));
    }
    assert!(found, "{:?}", tap.writes().len());
}

#[test]
fn unplugging_while_connected_is_a_loss_with_a_reason_and_nothing_is_opened_again() {
    let mut link = Link::connected();
    link.tap.unplug();
    link.run_for(ms(500));
    link.settle_to_end();
    assert_eq!(
        link.sentences(),
        [
            "Could not go on talking to the controller on /dev/test: the link is lost: the far end is gone (unplugged). Check \
          the controller's power and the cable, then connect again."
        ]
    );
    assert!(link.ended);
    link.forget();
    link.run_for(ms(5_000));
    assert!(link.bus().taken.is_empty() && link.events.is_empty());
}

#[test]
fn a_controller_that_falls_silent_is_lost_after_two_seconds() {
    let mut link = Link::connected();
    link.bus().dead = true;
    let dead_at = link.clock.now();
    link.run_for(ms(5_000));
    let lost_at = link.when(|event| matches!(event, Event::Lost(_))).unwrap();
    assert!(lost_at >= dead_at + ms(1_900) && lost_at < dead_at + ms(2_500), "{lost_at:?}");
}

#[test]
fn disconnecting_ends_the_loop_and_moves_nothing_that_was_not_moving() {
    let mut link = Link::connected();
    link.ask(Request::Disconnect);
    link.settle_to_end();
    assert!(link.has(|event| matches!(event, Event::Closed)));
    assert_eq!(link.bus().count(number::DUTY_ACCEL_BOTH), 0);
}
