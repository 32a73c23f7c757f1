//! Traffic of both Motion Mind protocols, damaged in the ways that lines and programs damage it, into the readers, the parsers and the
//! simulated unit: no panic, bounded output, and the next good command is answered. Seeds are fixed and named on failure.

use std::time::Duration;

use brushwork_motion_mind_sim::{Mode, MotionMind, MotionMindBus, MotionMindConfig, Protocol};
use brushwork_motion_mind_wire::{
    Address, Command, FrameReader, LineReader, Part, Progress, REGISTERS, Returns, encode_frame, encode_line,
    parse_all_loosely, parse_frame_reply, parse_line_reply,
};
use brushwork_plant::machine::{Machine, StreamIndex};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Conversations tried; each seed is one of them.
const SEEDS: u64 = 5_000;
const UNIT_1: Address = Address::FACTORY;

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

    fn command(&mut self, protocol: Protocol) -> Command {
        let register = self.below(REGISTERS.len()) as u8;
        let fits = REGISTERS[usize::from(register)].kind.range();
        let span = (fits.end() - fits.start()) as u64 + 1;
        let value = fits.start() + (self.0.next_u64() % span) as i64;
        let word = self.0.next_u32();
        match self.below(9) {
            0 => Command::ChangeSpeed(word as i16),
            1 => Command::MoveToAbsolute(word as i32),
            2 => Command::MoveToRelative(word as i32),
            3 => Command::MoveAtVelocity(word as i16),
            // The address stays, so that the last command is for this unit.
            4 if register != 7 => Command::Write { register, value },
            5 if register != 7 => Command::WriteStore { register, value },
            6 => Command::Restore,
            _ if protocol == Protocol::Binary && word.is_multiple_of(2) => Command::Read(self.0.next_u32()),
            _ if protocol == Protocol::Binary => Command::ReadRegister(register),
            7 => Command::ReadText([Part::All, Part::StatusBits, Part::FunctionBits][self.below(3)]),
            _ => Command::ReadText(Part::Register(register)),
        }
    }

    fn bytes(&mut self, protocol: Protocol) -> Vec<u8> {
        let command = self.command(protocol);
        match protocol {
            Protocol::Binary => encode_frame(UNIT_1, &command).expect("it fits"),
            Protocol::Text => encode_line(UNIT_1, &command).expect("it fits").into_bytes(),
        }
    }

    /// None to four of: flip a bit, drop, double, insert, swap, cut off.
    fn damage(&mut self, bytes: &mut Vec<u8>) {
        for _ in 0..self.below(5) {
            let at = self.below(bytes.len());
            if bytes.is_empty() {
                return;
            }
            match self.below(6) {
                0 => bytes[at] ^= 1 << self.below(8),
                1 => drop(bytes.remove(at)),
                2 => bytes.insert(at, bytes[at]),
                3 => bytes.insert(at, self.byte()),
                4 => {
                    let other = self.below(bytes.len());
                    bytes.swap(at, other);
                }
                _ => bytes.truncate(at),
            }
        }
        // A damaged address may name all units, a damaged register ADDRESS: neither is what this test is about.
        if self.below(8) == 0 {
            let noise = self.below(80);
            bytes.extend((0..noise).map(|_| self.byte()));
        }
    }
}

/// Whether the unit may answer no more by rights: its address was written, or it was sent into its self-test.
fn is_lost(unit: &MotionMind, heard: &[u8]) -> bool {
    let mut lines = LineReader::new();
    let is_tested = heard
        .iter()
        .any(|byte| matches!(lines.feed(*byte), Some(brushwork_motion_mind_wire::LineEvent::SelfTest(_))));
    unit.read_one(7) != 1 || is_tested
}

#[test]
fn no_damaged_conversation_makes_a_unit_panic_babble_or_fall_silent_for_good() {
    let mut lost = 0;
    for seed in 0..SEEDS {
        let mut dice = Dice::new(seed);
        let protocol = Protocol::ALL[(seed % 2) as usize];
        let mode = Mode::ALL[dice.below(8)];
        let config = MotionMindConfig { protocol, ..MotionMindConfig::new(mode) };
        let mut bus = MotionMindBus::new(vec![MotionMind::new(config).expect("the preset is sound")]);
        let mut heard = Vec::new();
        let mut answered = 0;
        for _ in 0..=dice.below(4) {
            let mut bytes = dice.bytes(protocol);
            dice.damage(&mut bytes);
            for piece in bytes.chunks(1 + dice.below(9)) {
                bus.receive(StreamIndex::Usb, piece);
                let pause = [0, 0, 0, 1, 4, 7][dice.below(6)];
                bus.advance(bus.now() + Duration::from_millis(pause));
            }
            heard.extend(bytes);
            bus.advance(bus.now() + Duration::from_millis(70));
            while let Some(reply) = bus.take_output(StreamIndex::Usb) {
                answered += reply.len();
            }
        }
        // The longest answer is 16 lines or 32 numbers; a byte heard is worth at most one command of three.
        assert!(answered <= 400 * (heard.len() / 3 + 1), "seed {seed}: {answered} bytes for {}", heard.len());
        // A line that was cut off may be a command; a reset or a write to EEPROM may be under way.
        bus.receive(StreamIndex::Usb, if protocol == Protocol::Text { b"\r\n" } else { b"" });
        heard.extend(b"\r\n");
        bus.advance(bus.now() + Duration::from_millis(150));
        while bus.take_output(StreamIndex::Usb).is_some() {}
        if is_lost(&bus.motion_minds()[0], &heard) {
            lost += 1;
            continue;
        }
        let (question, length) = match protocol {
            Protocol::Binary => (vec![0x1D, 0x01, 0x12, 0x30], 3),
            Protocol::Text => (b"R01 18\r\n".to_vec(), 8),
        };
        bus.receive(StreamIndex::Usb, &question);
        bus.advance(bus.now() + Duration::from_millis(30));
        let mut answer = Vec::new();
        while let Some(reply) = bus.take_output(StreamIndex::Usb) {
            answer.extend(reply);
        }
        let expected = match protocol {
            Protocol::Binary => vec![1, mode.number(), mode.number() + 1],
            Protocol::Text => format!("MODE={}\r\n", mode.number()).into_bytes(),
        };
        assert!(
            answer.len() >= length && answer.ends_with(&expected),
            "seed {seed}: {answer:02X?} after {}",
            heard.escape_ascii()
        );
    }
    assert!(lost < SEEDS / 20, "{lost} units were given another address");
}

#[test]
fn damaged_answers_make_no_client_panic_and_are_never_more_than_came() {
    for seed in 0..SEEDS {
        let mut dice = Dice::new(seed);
        let protocol = Protocol::ALL[(seed % 2) as usize];
        let config = MotionMindConfig { protocol, ..MotionMindConfig::new(Mode::SerialPid) };
        let mut bus = MotionMindBus::new(vec![MotionMind::new(config).expect("the preset is sound")]);
        let command = dice.command(protocol);
        let bytes = match protocol {
            Protocol::Binary => encode_frame(UNIT_1, &command).expect("it fits"),
            Protocol::Text => encode_line(UNIT_1, &command).expect("it fits").into_bytes(),
        };
        let mut answer = bus.exchange(&bytes, Duration::from_millis(200));
        dice.damage(&mut answer);
        let returns = Returns::of_function(dice.byte().into());
        for length in 0..=answer.len() {
            let part = &answer[..length];
            let read = match protocol {
                Protocol::Binary => parse_frame_reply(UNIT_1, &command, returns, part),
                Protocol::Text => parse_line_reply(&command, returns, part),
            };
            for progress in [read, parse_all_loosely(part)] {
                if let Progress::Done { used, .. } = progress {
                    assert!(0 < used && used <= length, "seed {seed}: {used} of {length}");
                }
            }
        }
        // The other end of each protocol is given what was never meant for it.
        let (mut frames, mut lines) = (FrameReader::new(), LineReader::new());
        for byte in &answer {
            frames.feed(*byte, Duration::ZERO);
            lines.feed(*byte);
        }
    }
}
