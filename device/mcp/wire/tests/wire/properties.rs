//! Properties of the codec over every command in every generation, with values and bytes that nobody thought of.
//!
//! The seed is fixed, so that a failure repeats; proptest prints the smallest case that fails.

use std::time::Duration;

use brushwork_mcp_wire::crc::crc16_xmodem;
use brushwork_mcp_wire::packet_serial::{
    Address, COMMANDS, Command, Direction, Form, FramerEvent, Generation, PACKET_GAP, ReplyProgress, Request,
    RequestFramer, describe_event, describe_reply, describe_request, encode_reply, parse_reply,
};
use brushwork_values::{Field, Kind, Value};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;
use proptest::strategy::BoxedStrategy;
use proptest::test_runner::{Config, RngSeed, TestRunner};

const SEED: u64 = 0x5EED;

fn config(cases: u32) -> Config {
    Config { cases, rng_seed: RngSeed::Fixed(SEED), failure_persistence: None, ..Config::default() }
}

/// Runs a property for every command in every generation that has it.
fn for_every_form(
    cases: u32,
    property: impl Fn(&mut TestRunner, &'static Command, &'static Form, Generation),
) {
    let mut forms = 0;
    for generation in Generation::ALL {
        for command in COMMANDS {
            if let Some(form) = command.form(generation) {
                property(&mut TestRunner::new(config(cases)), command, form, generation);
                forms += 1;
            }
        }
    }
    // 171 numbers have a layout; not every generation has every one.
    assert!(forms > 550, "only {forms} forms were tried");
}

fn any_address() -> impl Strategy<Value = Address> {
    select(Address::ALL.to_vec())
}

fn any_value(field: &'static Field) -> BoxedStrategy<Value> {
    match field.kind {
        Kind::Text { max } => {
            "[ -~]{0,46}".prop_filter("fits", move |text| text.len() + 2 <= max).prop_map(Value::Text).boxed()
        }
        Kind::Ascii36 => "[ -~]{0,36}".prop_map(Value::Text).boxed(),
        Kind::Utf16Le36 => "[ -~äöü€]{0,18}".prop_map(Value::Text).boxed(),
        Kind::Bytes(count) => vec(any::<u8>(), count).prop_map(Value::Bytes).boxed(),
        Kind::Counted(record) => {
            let record: Vec<_> = record.iter().map(any_int).collect();
            vec(record, 0..24).prop_map(Value::Records).boxed()
        }
        Kind::U8 | Kind::I8 | Kind::U16 | Kind::I16 | Kind::U24 | Kind::U32 | Kind::I32 => {
            any_int(field).prop_map(Value::Int).boxed()
        }
    }
}

/// Any number that fits, its ends more often than chance would have them.
fn any_int(field: &'static Field) -> BoxedStrategy<i64> {
    let (low, high) = field.kind.limits().expect("a number");
    prop_oneof![6 => low..=high, 1 => Just(low), 1 => Just(high), 1 => Just(0)].boxed()
}

fn any_values(fields: &'static [Field]) -> Vec<BoxedStrategy<Value>> {
    fields.iter().map(any_value).collect()
}

fn any_request(command: &'static Command, form: &'static Form) -> impl Strategy<Value = Request> {
    let number = command.number;
    (any_address(), any_values(form.request)).prop_map(move |(address, values)| Request {
        address,
        command: number,
        values,
    })
}

/// A write that is also known with a shorter payload, whose bytes happen to have the right CRC there: one in 65536. A
/// controller cannot tell.
fn is_cut_short_by_chance(command: &Command, packet: &[u8]) -> bool {
    let writes = command.forms.iter().filter(|form| form.direction == Direction::Write);
    writes.map(Form::payload_width).any(|width| {
        let crc = packet.get(width + 2..width + 4).filter(|_| packet.len() > width + 4);
        crc.is_some_and(|crc| crc == crc16_xmodem(&packet[..width + 2]).to_be_bytes())
    })
}

#[test]
fn every_request_is_framed_as_it_was_encoded() {
    for_every_form(24, |runner, command, form, generation| {
        let result = runner.run(&any_request(command, form), |request| {
            let bytes = request.encode(generation).expect("fits");
            prop_assume!(!is_cut_short_by_chance(command, &bytes));
            let mut framer = RequestFramer::new(generation);
            let mut events = bytes.iter().filter_map(|&byte| framer.feed(byte, Duration::ZERO));
            let Some(FramerEvent::Request(framed)) = events.next() else {
                return Err(TestCaseError::fail("no request"));
            };
            prop_assert!(events.next().is_none() && framed.native);
            prop_assert_eq!(&*framed.raw, bytes.as_slice());
            prop_assert_eq!(framed.request(), request);
            Ok(())
        });
        assert!(result.is_ok(), "{} in {generation}: {result:?}", command.key);
    });
}

#[test]
fn every_reply_is_parsed_as_it_was_encoded_and_not_before_it_is_whole() {
    for_every_form(8, |runner, command, form, generation| {
        let exchange = (any_request(command, form), any_values(form.reply.fields()), vec(any::<u8>(), 0..4));
        let result = runner.run(&exchange, |(request, values, more)| {
            let bytes = encode_reply(&request, generation, &values).expect("fits");
            for length in 0..bytes.len() {
                match parse_reply(&request, generation, &bytes[..length]) {
                    ReplyProgress::NeedMore { at_least } => {
                        prop_assert!(at_least > length && at_least <= bytes.len());
                    }
                    other => prop_assert!(false, "after {} of {} bytes: {:?}", length, bytes.len(), other),
                }
            }
            match parse_reply(&request, generation, &[bytes.as_slice(), more.as_slice()].concat()) {
                ReplyProgress::Done { values: got, used } => {
                    prop_assert_eq!(got.values(), values.as_slice());
                    prop_assert_eq!(used, bytes.len());
                }
                other => prop_assert!(false, "{:?}", other),
            }
            Ok(())
        });
        assert!(result.is_ok(), "{} in {generation}: {result:?}", command.key);
    });
}

#[test]
fn no_single_damaged_byte_of_a_reply_with_crc_goes_unseen() {
    for_every_form(4, |runner, command, form, generation| {
        let exchange = (
            any_request(command, form),
            any_values(form.reply.fields()),
            any::<prop::sample::Index>(),
            1..=255_u8,
        );
        let result = runner.run(&exchange, |(request, values, index, change)| {
            let mut bytes = encode_reply(&request, generation, &values).expect("fits");
            if bytes.len() < 3 {
                return Ok(()); // acknowledgements have no CRC
            }
            let index = index.index(bytes.len());
            bytes[index] ^= change;
            let progress = parse_reply(&request, generation, &bytes);
            prop_assert!(!matches!(progress, ReplyProgress::Done { .. }), "{:?}", progress);
            Ok(())
        });
        assert!(result.is_ok(), "{} in {generation}: {result:?}", command.key);
    });
}

#[test]
fn any_bytes_may_come_as_a_reply() {
    for_every_form(12, |runner, command, form, generation| {
        let exchange = (any_request(command, form), vec(any::<u8>(), 0..80));
        let result = runner.run(&exchange, |(request, bytes)| {
            match parse_reply(&request, generation, &bytes) {
                ReplyProgress::NeedMore { at_least } => prop_assert!(at_least > bytes.len()),
                ReplyProgress::Done { values, used } => {
                    prop_assert!(used <= bytes.len());
                    prop_assert!(!describe_reply(&request, &values, generation).is_empty());
                }
                ReplyProgress::BadCrc { expected, got, used } => {
                    prop_assert!(expected != got && used <= bytes.len());
                }
                ReplyProgress::BadAck { got } => prop_assert!(got != 0xFF),
                ReplyProgress::Malformed { .. } => {}
            }
            Ok(())
        });
        assert!(result.is_ok(), "{} in {generation}: {result:?}", command.key);
    });
}

/// A byte and the time before it.
fn any_arrival() -> impl Strategy<Value = (u8, Duration)> {
    let byte = prop_oneof![3 => any::<u8>(), 1 => 0x80..=0x87_u8, 2 => select(COMMANDS.iter().map(|row| row.number).collect::<Vec<_>>())];
    let pause = prop_oneof![20 => Just(Duration::ZERO), 4 => Just(Duration::from_millis(9)), 1 => Just(Duration::from_millis(11))];
    (byte, pause)
}

proptest! {
    #![proptest_config(config(2_000))]

    #[test]
    fn any_bytes_at_any_time_may_come_as_requests(
        generation in select(Generation::ALL.to_vec()),
        arrivals in vec(any_arrival(), 0..300),
    ) {
        let mut framer = RequestFramer::new(generation);
        let mut now = Duration::ZERO;
        let mut seen = 0;
        for (byte, pause) in &arrivals {
            now += *pause;
            if let Some(event) = framer.feed(*byte, now) {
                prop_assert!(!describe_event(&event, generation).is_empty());
                match event {
                    FramerEvent::Discarded(discarded) => seen += discarded.bytes.len(),
                    FramerEvent::Request(framed) => {
                        seen += framed.raw.len();
                        prop_assert!(framed.command.form(generation).is_some());
                        let again = framed.request().encode(generation);
                        // Padding behind a serial number need not be zero; everything else is given back to the byte.
                        let texts = framed.values.iter().any(|(_, value)| matches!(value, Value::Text(_)));
                        if framed.native && !texts {
                            prop_assert_eq!(again.as_deref(), Ok(&*framed.raw));
                        }
                    }
                }
            }
        }
        prop_assert!(seen <= arrivals.len());
    }

    #[test]
    fn after_a_silence_every_request_is_taken(
        generation in select(Generation::ALL.to_vec()),
        noise in vec(any::<u8>(), 0..120),
    ) {
        let mut framer = RequestFramer::new(generation);
        for &byte in &noise {
            framer.feed(byte, Duration::ZERO);
        }
        let now = PACKET_GAP + Duration::from_nanos(1);
        framer.feed(0x80, now);
        let event = framer.feed(0x15, now);
        prop_assert!(matches!(event, Some(FramerEvent::Request(_))), "{:?}", event);
    }

    #[test]
    fn any_request_can_be_told(number in any::<u8>(), values in vec(any::<i64>(), 0..6)) {
        let request = Request::new(Address::DEFAULT, number, &values);
        for generation in Generation::ALL {
            prop_assert!(!describe_request(&request, generation).is_empty());
        }
    }
}
