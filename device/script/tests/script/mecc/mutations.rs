//! Damaged programs: whatever the compiler is given it answers, and whatever it lets through runs without a panic or a hang.
//!
//! `BRUSHWORK_MCL_MUTATIONS=n` runs n of them (the default is small), `BRUSHWORK_SEED=n` others.

use super::{Bare, EXAMPLES, wrong};
use brushwork_script::image;
use brushwork_script::mecc::format::format;
use brushwork_script::mecc::{codes, compile};
use brushwork_script::vm::{Machine, State};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::sync::Arc;

/// Pieces that change what a program means.
const PIECES: [&str; 34] = [
    "\n",
    " ",
    "(",
    ")",
    ",",
    "\"",
    "=",
    "-",
    "+",
    "/ 0",
    "\"F\"",
    "Loop\n",
    "End Loop\n",
    "Do\n",
    "Until a > 1\n",
    "While 1\n",
    "End While\n",
    "If a = 1 Then\n",
    "Else\n",
    "End If\n",
    "Select a\n",
    "Case 1\n",
    "End Select\n",
    "End Program\n",
    "Begin Program\n",
    "Declare Byte a\n",
    "Declare Word a\n",
    "Declare EventHandler a()\n",
    "Declare Function a(a As Word)\n",
    "End Function\n",
    "Call a(1)\n",
    "Wait 1\n",
    "é",
    "65535",
];

fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(default)
}

fn damaged(rng: &mut ChaCha8Rng, seeds: &[String]) -> String {
    let pick = |rng: &mut ChaCha8Rng, below: usize| rng.next_u32() as usize % below.max(1);
    let mut text = seeds[pick(rng, seeds.len())].clone();
    for _ in 0..=pick(rng, 2) {
        let at = text.floor_char_boundary(pick(rng, text.len() + 1));
        let to = text.floor_char_boundary((at + pick(rng, 12)).min(text.len()));
        match pick(rng, 6) {
            0 => text.replace_range(at..to, ""),
            1 => text.insert_str(at, PIECES[pick(rng, PIECES.len())]),
            2 | 3 => replace_digit(&mut text, at, pick(rng, 10)),
            4 => {
                let piece = text[at..to].to_owned();
                let there = text.floor_char_boundary(pick(rng, text.len() + 1));
                text.insert_str(there, &piece);
            }
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

#[test]
fn damaged_programs_neither_panic_nor_hang() {
    let (seed, runs) = (number("BRUSHWORK_SEED", 1), number("BRUSHWORK_MCL_MUTATIONS", 3_000));
    println!("seed {seed}, {runs} programs");
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let examples = EXAMPLES.iter().map(|text| (*text).to_owned());
    let seeds: Vec<String> = examples
        .chain(
            wrong()
                .into_iter()
                .map(|(_, text)| text)
                .filter(|text| compile(text).is_ok() && text.len() < 1_000),
        )
        .collect();
    let mut ran = 0;
    for _ in 0..runs {
        let text = damaged(&mut rng, &seeds);
        let compiled = compile(&text);
        for said in &compiled.diagnostics {
            assert!(codes::ALL.iter().any(|(code, _)| *code == said.code));
            assert!(said.span.start <= said.span.end && said.span.end as usize <= text.len(), "{text}");
        }
        let formatted = format(&text);
        assert_eq!(format(&formatted), formatted, "{text}");
        let Some(program) = compiled.program else { continue };
        let same = compile(&formatted).program.map(|program| program.ops);
        assert_eq!(same.as_ref(), Some(&program.ops), "{text}");
        assert_eq!(image::decode(&image::encode(&program)).as_ref(), Ok(&program), "{text}");
        let mut machine = Machine::new(Arc::new(program));
        let mut host = Bare::default();
        for turn in 0..200 {
            machine.raise(turn % 16);
            match machine.run(&mut host, 20) {
                State::Pausing { until } => host.now = *until,
                State::Ready => {}
                State::Listening { .. } | State::Ended | State::Faulted(_) => break,
            }
        }
        assert!(machine.executed() > 0);
        ran += 1;
    }
    assert!(
        ran > runs / 20,
        "only {ran} of {runs} compiled: the mutations are too coarse to test the machine"
    );
}
