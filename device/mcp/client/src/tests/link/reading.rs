//! Sweeps: what is read how often, what a sample holds, and a window that does not take it.

use crate::controller::channels::CHANNELS;
use crate::tests::link::harness::Link;
use crate::tests::testing::ms;
use crate::tests::testing::unit::{Bus, of_generation};
use brushwork_link::clock::Clock;
use brushwork_link::device::DeviceOptions;
use brushwork_link::device::Event;
use brushwork_link::device::PollRate;
use brushwork_link::device::Request;
use brushwork_link::device::{Channel, PinSignal, Role, Sample};
use brushwork_mcp_wire::packet_serial::{Generation, number};
use brushwork_values::Value;

fn samples(link: &Link) -> Vec<Sample> {
    let samples = link.events.iter().filter_map(|(_, event)| match event {
        Event::Sample(sample) => Some(sample.as_ref().clone()),
        _ => None,
    });
    samples.collect()
}

#[test]
fn fast_signals_are_read_in_every_sweep_and_slow_ones_in_turn_ten_times_a_second() {
    let mut link = Link::connected();
    link.run_for(ms(10_000));
    let count = |command| link.bus().count(command);
    for fast in [
        number::READ_STATUS,
        number::READ_ENCODERS,
        number::READ_SPEED_M1,
        number::READ_SPEED_M2,
        number::READ_PWMS,
        number::READ_CURRENTS,
    ] {
        assert!((99..=101).contains(&count(fast)), "{fast} was read {} times", count(fast));
    }
    for slow in [
        number::READ_MAIN_BATTERY,
        number::READ_LOGIC_BATTERY,
        number::READ_TEMPERATURE_1,
        number::READ_TEMPERATURE_2,
    ] {
        assert!((24..=26).contains(&count(slow)), "{slow} was read {} times", count(slow));
    }
}

#[test]
fn a_sample_carries_physical_values_and_the_times_of_request_and_reply() {
    let mut link = Link::connected();
    {
        let mut bus = link.bus();
        bus.set(number::READ_ENCODERS, &[-12_345, 678]);
        // Magnitude and direction: 1 is backwards.
        bus.set(number::READ_SPEED_M1, &[4_000, 1]);
        bus.set(number::READ_SPEED_M2, &[4_000, 0]);
        bus.set(number::READ_PWMS, &[-16_384, 32_767]);
        bus.set(number::READ_CURRENTS, &[150, -20]);
        bus.set(number::READ_MAIN_BATTERY, &[243]);
        bus.set(number::READ_LOGIC_BATTERY, &[50]);
        bus.set(number::READ_TEMPERATURE_1, &[307]);
        bus.set(number::READ_TEMPERATURE_2, &[-5]);
    }
    link.run_for(ms(100));
    link.forget();
    link.run_for(ms(1_000));
    let samples = samples(&link);
    let last = samples.last().unwrap();
    let close = |channel: Channel, value: f64| {
        let got = last.get(channel).unwrap_or_else(|| panic!("no {channel:?}"));
        assert!((got - value).abs() < 1e-2, "{channel:?} is {got}");
    };
    close(Channel::M1_POSITION, -12_345.0);
    close(Channel::M2_POSITION, 678.0);
    close(Channel::M1_VELOCITY, -4_000.0);
    close(Channel::M2_VELOCITY, 4_000.0);
    close(Channel::M1_PWM, -50.0);
    close(Channel::M2_PWM, 100.0);
    close(Channel::M1_CURRENT, 1.5);
    close(Channel::M2_CURRENT, -0.2);
    let slow = |channel: Channel| samples.iter().find_map(|sample| sample.get(channel)).unwrap();
    assert!((slow(Channel::MAIN_BATTERY) - 24.3).abs() < 1e-9);
    assert!((slow(Channel::LOGIC_BATTERY) - 5.0).abs() < 1e-9);
    assert!((slow(Channel::TEMPERATURE_1) - 30.7).abs() < 1e-9);
    assert!((slow(Channel::TEMPERATURE_2) + 0.5).abs() < 1e-9);
    // Six exchanges of a millisecond each bring values; the encoders are the first, the PWM outputs the fourth.
    assert_eq!(last.replied_at - last.requested_at, ms(6));
    assert_eq!(last.read_at(Channel::M1_POSITION), Some(last.requested_at + ms(1) / 2));
    assert_eq!(last.read_at(Channel::M2_PWM), Some(last.requested_at + ms(3) + ms(1) / 2));
    assert!(samples.windows(2).all(|pair| pair[1].sequence == pair[0].sequence + 1));
}

#[test]
fn a_unit_of_the_newest_generation_is_read_with_one_request() {
    let bus = Bus::shared();
    of_generation(&bus, Generation::Gen4);
    let mut link = Link::with(bus, DeviceOptions::default());
    link.run_for(ms(1_000));
    link.forget();
    link.run_for(ms(1_000));
    let commands = link.bus().commands();
    assert!(commands.iter().all(|command| *command == number::READ_ALL_STATUS), "{commands:?}");
    let samples = samples(&link);
    assert_eq!(samples.len(), 10);
    for channel in CHANNELS.iter().copied() {
        let is_read = channel.role != Role::Setpoint && !channel.is_pin();
        assert_eq!(samples[0].get(channel).is_some(), is_read, "{channel:?}");
    }
}

#[test]
fn the_input_pins_are_read_only_while_somebody_wants_them() {
    let mut link = Link::connected();
    // command, position, percent, speed, average speed of two pins
    let pins = vec![vec![-16_384, -1024, -16_384, 7, 5], vec![0, 0, 0, 0, 0]];
    link.bus().values.insert(number::READ_SIGNAL_VALUES, vec![Value::Records(pins)]);
    link.run_for(ms(1_000));
    assert!(!link.bus().commands().contains(&number::READ_SIGNAL_VALUES));
    link.ask(Request::ReadSignals(true));
    link.run_for(ms(1_000));
    let last = samples(&link).pop().unwrap();
    let first_pin =
        PinSignal { command: -16_384, position: -1024, percent: -16_384, speed: 7, average_speed: 5 };
    assert_eq!(last.signals, [first_pin, PinSignal::default()]);
    let percent = last.get(CHANNELS[18]).unwrap();
    assert!((percent + 50.001_5).abs() < 1e-3, "{percent}");
    assert_eq!(last.get(CHANNELS[20]), None, "the unit has two");
    link.ask(Request::ReadSignals(false));
    link.run_for(ms(200));
    link.forget();
    link.run_for(ms(1_000));
    assert!(samples(&link).iter().all(|sample| sample.signals.is_empty()));
}

#[test]
fn on_request_it_reads_as_fast_as_the_link_allows() {
    let mut link = Link::connected();
    link.ask(Request::Poll(PollRate::Fastest));
    link.run_for(ms(7_000));
    // A sweep is six exchanges of a millisecond, and a seventh for a slow signal when 20 ms have passed since the last:
    // four sweeps in 25 ms.
    let count = samples(&link).len();
    assert!((1_110..=1_121).contains(&count), "{count} sweeps in 7 s");
    link.ask(Request::Poll(PollRate::Off));
    link.run_for(ms(100));
    link.forget();
    link.run_for(ms(5_000));
    assert!(link.bus().taken.is_empty());
}

#[test]
fn a_status_is_told_when_it_changes_and_once_a_second() {
    let mut link = Link::connected();
    link.run_for(ms(10_000));
    let reported = link.events.iter().filter(|(_, event)| matches!(event, Event::Status(_))).count();
    assert!((9..=11).contains(&reported), "{reported} in ten seconds");
    link.forget();
    // Bit 12 in generation 1: temperature warning.
    link.bus().set(number::READ_STATUS, &[0x1000]);
    let changed_at = link.clock.now();
    link.run_for(ms(200));
    let told_at = link.when(|event| matches!(event, Event::Status(status) if status.word == 0x1000)).unwrap();
    assert!(told_at - changed_at <= ms(110));
}

#[test]
fn the_links_figures_are_told_twice_a_second() {
    let mut link = Link::connected();
    link.run_for(ms(5_000));
    let figures: Vec<_> = link
        .events
        .iter()
        .filter_map(|(_, event)| match event {
            Event::Link(statistics) => Some(statistics.clone()),
            _ => None,
        })
        .collect();
    assert!((9..=11).contains(&figures.len()));
    let last = figures.last().unwrap();
    assert!((last.transactions_per_s - 70.0).abs() < 2.0, "{last:?}");
    assert!((last.round_trip_median_s / 1e-3 - 1.0).abs() < 0.05, "{last:?}");
    // The search asked seven absent addresses twice.
    assert_eq!((last.timeouts, last.retries, last.crc_errors, last.stray_bytes), (14, 7, 0, 0), "{last:?}");
}

#[test]
fn a_window_that_takes_nothing_loses_old_samples_and_hears_what_matters() {
    let mut link = Link::connected();
    link.ask(Request::Poll(PollRate::Fastest));
    let until = link.clock.now() + ms(60_000);
    // The window does not take events, but stays alive otherwise.
    while link.clock.now() < until {
        link.handle.renew();
        let _ = link.device_loop.step();
    }
    link.handle.stop_all();
    link.run_for(ms(1_000));
    let dropped = link.events.iter().rev().find_map(|(_, event)| match event {
        Event::Link(statistics) => Some(statistics.dropped_samples),
        _ => None,
    });
    let taken = samples(&link).len() as u64;
    let dropped = dropped.unwrap();
    assert!(dropped > 2_000, "{dropped}");
    assert!(taken > 1_000, "{taken}");
    let sequences: Vec<_> = samples(&link).iter().map(|sample| sample.sequence).collect();
    assert!(sequences.is_sorted());
    assert_eq!(link.stops().len(), 1);
}

#[test]
fn a_reading_that_stops_working_is_left_out_for_a_while_and_told_once() {
    let mut link = Link::connected();
    link.bus().mute.insert(number::READ_TEMPERATURE_2);
    link.run_for(ms(25_000));
    assert_eq!(link.bus().count(number::READ_TEMPERATURE_2), 6, "two readings of three tries");
    let sentences = link.sentences();
    assert_eq!(
        sentences,
        [
            "Could not read: temperature 2 on 0x80 at /dev/test: no answer within 50 ms (3 tries). It is left out for 30 s, then \
          tried again."
        ]
    );
    link.bus().mute.clear();
    link.run_for(ms(15_000));
    assert!(link.bus().count(number::READ_TEMPERATURE_2) > 10, "it is read again");
}

#[test]
fn traffic_is_shown_on_request() {
    let mut link = Link::connected();
    link.run_for(ms(300));
    assert!(!link.has(|event| matches!(event, Event::Traffic { .. })));
    link.ask(Request::Trace(true));
    link.run_for(ms(300));
    let is = |event: &Event, sent: bool, bytes: &[u8]| match event {
        Event::Traffic { traffic, .. } => traffic.sent == sent && traffic.bytes == bytes,
        _ => false,
    };
    // 0x80, command 78; then two counts of zero with their CRC.
    assert!(link.has(|event| is(event, true, &[0x80, 78])));
    let reply = crate::tests::testing::reply_to(&[0x80, 78], &[0; 8]);
    assert!(link.has(|event| is(event, false, &reply)));
}
