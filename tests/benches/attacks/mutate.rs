//! Hostile inputs: the worst of a megabyte, and samples that were changed at random.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};
use serde_json::Value;

/// What most inputs have at most: what is wrong with a reader shows in a few KiB, of which it reads thousands in the time of one megabyte.
const SMALL_BYTES: usize = 4 << 10;
/// What one of so many has at most.
const LARGE_BYTES: usize = 64 << 10;
const LARGE_EVERY: usize = 256;
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

/// What is read like a sample and is small, so that a change of it is not lost among thousands of bytes.
fn small(sample: &[u8]) -> Vec<u8> {
    if sample.len() <= SMALL_BYTES {
        return sample.to_vec();
    }
    if let Ok(value) = serde_json::from_slice::<Value>(sample) {
        let shorter = [16, 8, 4, 2, 1].into_iter().map(|most| with_at_most(most, &value).to_string());
        if let Some(text) = shorter.into_iter().find(|text| text.len() <= SMALL_BYTES) {
            return text.into_bytes();
        }
    }
    // Whole lines, where there are any.
    let begun = &sample[..SMALL_BYTES];
    let end = begun.iter().rposition(|byte| *byte == b'\n').map_or(SMALL_BYTES, |at| at + 1);
    begun[..end].to_vec()
}

/// The same JSON with so many entries in each list. An object with many keys is a list; one with few needs each of them.
fn with_at_most(most: usize, value: &Value) -> Value {
    const FEW: usize = 16;
    match value {
        Value::Array(entries) => entries.iter().take(most).map(|entry| with_at_most(most, entry)).collect(),
        Value::Object(entries) => {
            let kept = if entries.len() > FEW { most } else { FEW };
            let shorter =
                entries.iter().take(kept).map(|(key, entry)| (key.clone(), with_at_most(most, entry)));
            Value::Object(shorter.collect())
        }
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => value.clone(),
    }
}

/// Inputs one after the other, the same for the same seed.
#[derive(Debug)]
pub struct Inputs {
    random: ChaCha8Rng,
    samples: Vec<Vec<u8>>,
    /// Each sample, or a small one like it.
    small: Vec<Vec<u8>>,
    words: Vec<Vec<u8>>,
}

impl Inputs {
    pub fn new(seed: u64, samples: Vec<Vec<u8>>, words: &[&str]) -> Self {
        let words =
            words.iter().chain(&PIECES).chain(&NUMBERS).map(|word| word.as_bytes().to_vec()).collect();
        let samples = if samples.is_empty() { vec![Vec::new()] } else { samples };
        let small = samples.iter().map(|sample| small(sample)).collect();
        Self { random: ChaCha8Rng::seed_from_u64(seed), samples, small, words }
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
                let sample = self.below(self.small.len());
                let range = self.range(self.small[sample].len());
                self.small[sample][range].to_vec()
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
        let (mut input, most_bytes) = match self.below(LARGE_EVERY) {
            0 => (self.samples[sample].clone(), LARGE_BYTES),
            _ => (self.small[sample].clone(), SMALL_BYTES),
        };
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
                    let most = most_bytes.saturating_sub(input.len());
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
        input.truncate(most_bytes);
        input
    }
}
