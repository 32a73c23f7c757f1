//! Programs damaged at random, from a seed.

use super::examples::{corrected, examples};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;

/// Programs to damage: the manual's, which use every statement.
pub fn seeds() -> Vec<String> {
    let files = [include_str!("../../manual/registers.txt"), include_str!("../../manual/chapter.txt")];
    files.iter().flat_map(|file| examples(file)).map(|example| corrected(&example)).collect()
}

/// Pieces that change what a program means.
const PIECES: [&str; 40] = [
    "\n",
    " ",
    "(",
    ")",
    "[",
    "]",
    ",",
    "\\",
    ".",
    "\"",
    "%",
    "0x",
    "#",
    "#IF 1\n",
    "#ENDIF\n",
    "#ELSE\n",
    "if 1 then\n",
    "endif\n",
    "else\n",
    "for a = 0 to 3\n",
    "next\n",
    "do\n",
    "while ",
    "wend\n",
    "repeat\n",
    "until 1\n",
    "goto ",
    "gosub ",
    "return\n",
    "var byte\n",
    "var float(3)\n",
    "-",
    "not ",
    "a(1).byte0",
    "4294967295",
    "1.5",
    "real ",
    "str ",
    "é",
    "con ",
];

/// One of them, damaged in one to four places.
pub fn damaged(rng: &mut ChaCha8Rng, seeds: &[String]) -> String {
    let pick = |rng: &mut ChaCha8Rng, below: usize| rng.next_u32() as usize % below.max(1);
    let mut text = seeds[pick(rng, seeds.len())].clone();
    for _ in 0..=pick(rng, 3) {
        let at = boundary(&text, pick(rng, text.len() + 1));
        let to = boundary(&text, (at + pick(rng, 12)).min(text.len()));
        match pick(rng, 6) {
            0 => text.replace_range(at..to, ""),
            1 => text.insert_str(at, PIECES[pick(rng, PIECES.len())]),
            2 => {
                let piece = text[at..to].to_owned();
                let there = boundary(&text, pick(rng, text.len() + 1));
                text.insert_str(there, &piece);
            }
            3 | 4 => replace_digit(&mut text, at, pick(rng, 10)),
            _ => text.replace_range(at..to, PIECES[pick(rng, PIECES.len())]),
        }
    }
    text
}

/// Another digit in the number after `at`, if there is one.
fn replace_digit(text: &mut String, at: usize, digit: usize) {
    if let Some(found) = text[at..].find(|letter: char| letter.is_ascii_digit()) {
        text.replace_range(at + found..at + found + 1, &digit.to_string());
    }
}

fn boundary(text: &str, mut at: usize) -> usize {
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

/// A number that the environment may set.
pub fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(default)
}
