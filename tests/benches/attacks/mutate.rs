//! Hostile inputs: the worst of a megabyte, and samples that were changed at random.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

/// What an input has at most where it is not one of the worst.
const USUAL_BYTES: usize = 64 << 10;
/// What the worst have.
pub const WORST_BYTES: usize = 1 << 20;
/// Numbers at which code ends.
const NUMBERS: [&str; 14] = [
    "0",
    "-0",
    "-1",
    "255",
    "256",
    "65535",
    "65536",
    "2147483647",
    "2147483648",
    "-2147483649",
    "18446744073709551616",
    "1e999",
    "NaN",
    "0.1e-400",
];
/// Pieces that any text may be cut up by.
const PIECES: [&str; 22] = [
    "[",
    "]",
    "{",
    "}",
    "(",
    ")",
    "\"",
    "\\",
    "\\u0000",
    "\u{feff}",
    "ß",
    "\u{1F600}",
    "\0",
    "\n",
    "\r",
    "\r\n",
    "\t",
    ",",
    ";",
    ":",
    "#",
    "null",
];

/// The worst inputs of a target, made when they are asked for: each of its pieces, each of those of any text and each sample, over and
/// over, and each piece so behind half a sample.
#[derive(Debug)]
pub struct Worst {
    samples: Vec<Vec<u8>>,
    pieces: Vec<Vec<u8>>,
}

impl Worst {
    pub fn new(samples: Vec<Vec<u8>>, words: &[&str]) -> Self {
        let bytes = (0..=u8::MAX).step_by(51).map(|byte| vec![byte]);
        let words = words.iter().chain(&PIECES).chain(&NUMBERS).map(|piece| piece.as_bytes().to_vec());
        Self { samples, pieces: bytes.chain(words).collect() }
    }

    pub fn len(&self) -> usize {
        self.pieces.len() * (1 + self.samples.len()) + self.samples.len()
    }

    /// The one of a number, which is below their count.
    pub fn get(&self, number: usize) -> Vec<u8> {
        let over = |begun: &[u8], piece: &[u8]| {
            let rest = piece.iter().copied().cycle().take(WORST_BYTES.saturating_sub(begun.len()));
            begun.iter().copied().chain(rest).collect()
        };
        let (round, piece) = (number / self.pieces.len(), number % self.pieces.len());
        match round.checked_sub(1) {
            None => over(&[], &self.pieces[piece]),
            Some(sample) if sample < self.samples.len() => {
                // A sound beginning, and then no end of it.
                let sample = &self.samples[sample];
                over(&sample[..sample.len() / 2], &self.pieces[piece])
            }
            Some(_) => over(&[], &self.samples[piece]),
        }
    }
}

/// Inputs one after the other, the same for the same seed.
#[derive(Debug)]
pub struct Inputs {
    random: ChaCha8Rng,
    samples: Vec<Vec<u8>>,
    words: Vec<Vec<u8>>,
}

impl Inputs {
    pub fn new(seed: u64, samples: Vec<Vec<u8>>, words: &[&str]) -> Self {
        let words =
            words.iter().chain(&PIECES).chain(&NUMBERS).map(|word| word.as_bytes().to_vec()).collect();
        let samples = if samples.is_empty() { vec![Vec::new()] } else { samples };
        Self { random: ChaCha8Rng::seed_from_u64(seed), samples, words }
    }

    fn below(&mut self, limit: usize) -> usize {
        let limit = u64::try_from(limit.max(1)).unwrap_or(u64::MAX);
        usize::try_from(self.random.next_u64() % limit).unwrap_or(0)
    }

    fn range(&mut self, length: usize) -> std::ops::Range<usize> {
        let start = self.below(length + 1);
        // Mostly short.
        let most = if self.below(4) == 0 { length } else { length.min(start + 32) };
        start..start + self.below(most.saturating_sub(start) + 1)
    }

    fn piece(&mut self) -> Vec<u8> {
        match self.below(4) {
            0 => {
                let count = 1 + self.below(8);
                (0..count).map(|_| u8::try_from(self.random.next_u32() & 0xFF).unwrap_or(0)).collect()
            }
            1 => {
                let sample = self.below(self.samples.len());
                let range = self.range(self.samples[sample].len());
                self.samples[sample][range].to_vec()
            }
            _ => {
                let word = self.below(self.words.len());
                self.words[word].clone()
            }
        }
    }

    /// The next one.
    pub fn next(&mut self) -> Vec<u8> {
        let sample = self.below(self.samples.len());
        let mut input = self.samples[sample].clone();
        for _ in 0..=self.below(8) {
            let range = self.range(input.len());
            match self.below(6) {
                0 if !input.is_empty() => {
                    let at = self.below(input.len());
                    input[at] ^= 1 << self.below(8);
                }
                1 => drop(input.drain(range)),
                2 => {
                    let piece = self.piece();
                    drop(input.splice(range, piece));
                }
                3 => {
                    let times = 1 << self.below(10);
                    let piece = if self.below(2) == 0 { self.piece() } else { input[range.clone()].to_vec() };
                    let most = USUAL_BYTES.saturating_sub(input.len());
                    let many: Vec<u8> =
                        piece.iter().copied().cycle().take(most.min(piece.len() * times)).collect();
                    drop(input.splice(range.start..range.start, many));
                }
                4 => input.truncate(range.start),
                _ => {
                    let piece = self.piece();
                    drop(input.splice(range.start..range.start, piece));
                }
            }
        }
        input.truncate(USUAL_BYTES);
        input
    }
}
