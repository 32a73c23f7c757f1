//! Traffic, damaged in the ways that lines and programs damage it, into the simulated board: no panic, bounded output, and the next good command is
//! answered. Seeds are fixed and named on failure.

use std::time::Duration;

use crate::{SuprMotr, SuprMotrBus, SuprMotrConfig};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_suprmotr_wire::{Address, COMMANDS, Command, Line, Mnemonic, Radix, Single};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Conversations tried; each seed is one of them.
const SEEDS: u64 = 2_000;

struct Dice(ChaCha8Rng);

impl Dice {
    fn below(&mut self, count: usize) -> usize {
        self.0.next_u32() as usize % count.max(1)
    }

    fn byte(&mut self) -> u8 {
        self.0.next_u32() as u8
    }

    fn command(&mut self) -> Command {
        let row = &COMMANDS[self.below(COMMANDS.len())];
        let number = row.takes.filter(|_| self.below(4) > 0).map(|takes| {
            let span = i64::from(takes.high) - i64::from(takes.low) + 1;
            let drawn = i64::from(takes.low) + (self.0.next_u64() % span.unsigned_abs()) as i64;
            // Now and then one more than fits.
            i32::try_from(drawn + i64::from(self.below(16) == 0)).unwrap_or_default()
        });
        Command { mnemonic: row.mnemonic, number }
    }

    fn bytes(&mut self) -> Vec<u8> {
        match self.below(8) {
            0 => vec![Single::ALL[self.below(7)].character()],
            1 => vec![0x01, Address::ALL[self.below(16)].character()],
            2 => b"\r".to_vec(),
            _ => {
                let defines = (self.below(4) == 0).then(|| self.below(15) as u8);
                let commands: Vec<Command> = (0..=self.below(16)).map(|_| self.command()).collect();
                let commands =
                    commands.into_iter().filter(|command| command.mnemonic != Mnemonic::MD).collect();
                (Line { defines, commands }.text(Radix::Decimal) + "\r").into_bytes()
            }
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
        if self.below(8) == 0 {
            let noise = self.below(400);
            bytes.extend((0..noise).map(|_| self.byte()));
        }
    }
}

#[test]
fn no_damaged_conversation_makes_a_board_panic_babble_or_fall_silent_for_good() {
    for seed in 0..SEEDS {
        let mut dice = Dice(ChaCha8Rng::seed_from_u64(seed));
        let config = SuprMotrConfig::new(Address::FACTORY);
        let mut bus = SuprMotrBus::new(vec![SuprMotr::new(config).expect("the slide is sound")]);
        bus.receive(StreamIndex::Usb, b"\x010");
        let (mut heard, mut said) = (0, 0);
        for _ in 0..=dice.below(6) {
            let mut bytes = dice.bytes();
            dice.damage(&mut bytes);
            heard += bytes.len();
            for piece in bytes.chunks(1 + dice.below(9)) {
                bus.receive(StreamIndex::Usb, piece);
                let pause = [0, 0, 0, 1, 4, 60][dice.below(6)];
                bus.advance(bus.now() + Duration::from_millis(pause));
            }
            while let Some(bytes) = bus.take_output(StreamIndex::Usb) {
                said += bytes.len();
            }
        }
        // At most as much as HE and TM say for every three bytes, and what a loop says at the rate of the wire.
        let seconds = bus.now().as_secs_f64();
        let most = 4_000 * (heard / 3 + 1) + (seconds * 3_840.0) as usize;
        assert!(said <= most, "seed {seed}: {said} bytes for {heard}");
        // A macro 0 may select nothing, but it may reset, and RT takes a tenth of a second.
        bus.receive(StreamIndex::Usb, b"\x01V\x08RM,EF,DM\r");
        bus.advance(bus.now() + Duration::from_millis(150));
        bus.receive(StreamIndex::Usb, b"\x01V\x08RM,EF,DM\r");
        bus.advance(bus.now() + Duration::from_millis(300));
        while bus.take_output(StreamIndex::Usb).is_some() {}
        let answer = bus.exchange(b"TB\r", Duration::from_millis(20));
        let address = bus.suprmotrs()[0].address();
        let number = address.get();
        let expected = format!("{}B0:+{number:010}\r\n\u{3}", char::from(address.character()));
        assert_eq!(String::from_utf8_lossy(&answer), expected, "seed {seed}");
    }
}

#[test]
fn noise_of_any_bytes_does_no_harm() {
    for seed in 0..SEEDS / 4 {
        let mut dice = Dice(ChaCha8Rng::seed_from_u64(seed));
        let units = [0, 3, 15].map(|number| {
            let address = Address::new(number).expect("there are 16");
            let config = SuprMotrConfig { is_addressed: true, ..SuprMotrConfig::new(address) };
            SuprMotr::new(config).expect("the slide is sound")
        });
        let mut bus = SuprMotrBus::new(units.into());
        let noise: Vec<u8> = (0..600).map(|_| dice.byte()).collect();
        bus.receive(StreamIndex::Usb, &noise);
        bus.advance(Duration::from_millis(50));
        let said: usize =
            std::iter::from_fn(|| bus.take_output(StreamIndex::Usb)).map(|bytes| bytes.len()).sum();
        assert!(said <= 60_000, "seed {seed}: {said}");
    }
}
