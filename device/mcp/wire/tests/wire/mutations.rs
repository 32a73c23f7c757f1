//! Valid traffic, damaged in the ways that lines and programs damage it. Seeds are fixed and named on failure.

use std::time::Duration;

use brushwork_mcp_wire::packet_serial::{
    Address, COMMANDS, FramerEvent, Generation, PACKET_GAP, ReplyProgress, Request, RequestFramer,
    describe_event, encode_reply, parse_reply,
};
use brushwork_values::{Field, Kind, Value};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Streams and replies tried; each seed is one of them.
const SEEDS: u64 = 4_000;

struct Dice(ChaCha8Rng);

impl Dice {
    fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    fn below(&mut self, count: usize) -> usize {
        self.0.next_u32() as usize % count.max(1)
    }

    fn byte(&mut self) -> u8 {
        self.0.next_u32() as u8
    }

    fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    fn pick<T: Copy>(&mut self, items: &[T]) -> T {
        items[self.below(items.len())]
    }

    fn int(&mut self, field: &Field) -> i64 {
        let (low, high) = field.kind.limits().expect("a number");
        let span = (high - low) as u64 + 1;
        low + (self.0.next_u64() % span) as i64
    }

    fn text(&mut self, most: usize) -> String {
        let length = self.below(most + 1);
        (0..length).map(|_| char::from(b' ' + self.byte() % 95)).collect()
    }

    fn value(&mut self, field: &Field) -> Value {
        match field.kind {
            Kind::Text { max } => Value::Text(self.text(max - 2)),
            Kind::Ascii36 => Value::Text(self.text(36)),
            Kind::Utf16Le36 => Value::Text(self.text(18)),
            Kind::Bytes(count) => Value::Bytes((0..count).map(|_| self.byte()).collect()),
            Kind::Counted(record) => {
                let count = self.below(12);
                Value::Records(
                    (0..count).map(|_| record.iter().map(|field| self.int(field)).collect()).collect(),
                )
            }
            _ => Value::Int(self.int(field)),
        }
    }

    fn values(&mut self, fields: &[Field]) -> Vec<Value> {
        fields.iter().map(|field| self.value(field)).collect()
    }

    fn request(&mut self, generation: Generation) -> Request {
        loop {
            let command = &COMMANDS[self.below(COMMANDS.len())];
            if let Some(form) = command.form(generation) {
                let values = self.values(form.request);
                return Request { address: self.pick(&Address::ALL), command: command.number, values };
            }
        }
    }

    /// One to four of: flip a bit, drop, double, insert, swap, cut off, repeat a part.
    fn damage(&mut self, bytes: &mut Vec<u8>) {
        for _ in 0..=self.below(4) {
            if bytes.is_empty() {
                return;
            }
            let at = self.below(bytes.len());
            match self.below(8) {
                0 | 1 => bytes[at] ^= 1 << self.below(8),
                2 => drop(bytes.remove(at)),
                3 => bytes.insert(at, bytes[at]),
                4 => bytes.insert(at, self.byte()),
                5 => {
                    let other = self.below(bytes.len());
                    bytes.swap(at, other);
                }
                6 => bytes.truncate(at),
                _ => bytes.extend_from_within(at..),
            }
        }
    }
}

/// Several requests, some with an appended CRC, some stubs.
fn stream(dice: &mut Dice, generation: Generation) -> Vec<u8> {
    let mut bytes = Vec::new();
    for _ in 0..=dice.below(6) {
        let mut packet = dice.request(generation).encode(generation).expect("fits");
        if dice.one_in(4) {
            packet.extend(brushwork_mcp_wire::crc::crc16_xmodem(&packet).to_be_bytes());
        }
        if dice.one_in(8) {
            packet.truncate(2);
        }
        bytes.extend(packet);
    }
    bytes
}

#[test]
fn after_damaged_traffic_and_a_silence_a_valid_request_is_always_taken() {
    let mut taken = 0;
    for seed in 0..SEEDS {
        let dice = &mut Dice::new(seed);
        let generation = dice.pick(&Generation::ALL);
        let mut bytes = stream(dice, generation);
        dice.damage(&mut bytes);

        let mut framer = RequestFramer::new(generation);
        let mut now = Duration::ZERO;
        for &byte in &bytes {
            now += Duration::from_millis(if dice.one_in(16) { 11 } else { 0 });
            if let Some(event) = framer.feed(byte, now) {
                taken += usize::from(matches!(event, FramerEvent::Request(_)));
                assert!(!describe_event(&event, generation).is_empty(), "seed {seed}");
            }
        }

        now += PACKET_GAP + Duration::from_nanos(1);
        let request = dice.request(generation);
        let packet = request.encode(generation).expect("fits");
        let events: Vec<FramerEvent> = packet.iter().filter_map(|&byte| framer.feed(byte, now)).collect();
        // The first byte may also end what the silence has cut off.
        match events.last() {
            Some(FramerEvent::Request(framed)) => assert_eq!(framed.request(), request, "seed {seed}"),
            other => panic!("seed {seed}: {packet:02X?} gave {other:?} after {bytes:02X?}"),
        }
    }
    assert!(taken > 4_000, "the damage left only {taken} requests: nothing was tried");
}

#[test]
fn undamaged_traffic_is_taken_whole_in_any_pieces() {
    for seed in 0..SEEDS / 4 {
        let dice = &mut Dice::new(seed);
        let generation = dice.pick(&Generation::ALL);
        let address = dice.pick(&Address::ALL);
        let mut framer = RequestFramer::new(generation);
        let mut now = Duration::ZERO;
        for _ in 0..20 {
            let request = Request { address, ..dice.request(generation) };
            let mut packet = request.encode(generation).expect("fits");
            let whole_after = packet.len();
            if dice.one_in(2) && request.row().and_then(|row| row.form(generation)).is_some_and(is_read) {
                packet.extend(brushwork_mcp_wire::crc::crc16_xmodem(&packet).to_be_bytes());
            }
            let mut events = Vec::new();
            for (index, &byte) in packet.iter().enumerate() {
                now += Duration::from_millis(dice.below(6) as u64);
                events.extend(framer.feed(byte, now).map(|event| (index + 1, event)));
            }
            match events.as_slice() {
                [(after, FramerEvent::Request(framed))] => {
                    assert_eq!((*after, framed.request()), (whole_after, request), "seed {seed}");
                }
                other => panic!("seed {seed}: {packet:02X?} gave {other:?}"),
            }
        }
    }
}

fn is_read(form: &brushwork_mcp_wire::packet_serial::Form) -> bool {
    form.direction == brushwork_mcp_wire::packet_serial::Direction::Read
}

#[test]
fn damaged_replies_are_told_apart_from_whole_ones_and_never_panic() {
    let mut refused = 0;
    for seed in 0..SEEDS {
        let dice = &mut Dice::new(seed);
        let generation = dice.pick(&Generation::ALL);
        let request = dice.request(generation);
        let form = request.row().and_then(|row| row.form(generation)).expect("in the generation");
        let values = dice.values(form.reply.fields());
        let whole = encode_reply(&request, generation, &values).expect("fits");
        let mut bytes = whole.clone();
        dice.damage(&mut bytes);

        for length in 0..=bytes.len() {
            let part = &bytes[..length];
            match parse_reply(&request, generation, part) {
                ReplyProgress::NeedMore { at_least } => assert!(at_least > length, "seed {seed}"),
                ReplyProgress::Done { used, .. } => {
                    let started_whole = used == whole.len() && bytes.starts_with(&whole);
                    let acknowledged = whole.len() <= 2 && bytes.first() == Some(&0xFF);
                    assert!(
                        started_whole || acknowledged,
                        "seed {seed}: {bytes:02X?} passed for {whole:02X?}"
                    );
                }
                ReplyProgress::BadCrc { used, .. } => {
                    assert!(used <= length, "seed {seed}");
                    refused += 1;
                }
                ReplyProgress::BadAck { got } => assert_ne!(got, 0xFF, "seed {seed}"),
                ReplyProgress::Malformed { what } => assert!(!what.is_empty(), "seed {seed}"),
            }
        }
    }
    assert!(refused > 1_000, "only {refused} damaged replies were refused: nothing was tried");
}
