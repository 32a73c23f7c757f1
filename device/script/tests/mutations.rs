//! Damaged programs: whatever the compiler is given it answers, and whatever it lets through runs without a panic or a hang.
//!
//! `BRUSHWORK_MCL_MUTATIONS=n` runs n of them (the default is small), `BRUSHWORK_SEED=n` others.

mod support;

use brushwork_script::image;
use brushwork_script::mcl::{codes, compile};
use brushwork_script::vm::{Machine, State};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::sync::Arc;
use support::examples::{corrected, examples};
use support::{Desk, run_on};

/// Programs to damage: the manual's, which use every statement.
fn seeds() -> Vec<String> {
    let files = [include_str!("manual/registers.txt"), include_str!("manual/chapter.txt")];
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

fn damaged(rng: &mut ChaCha8Rng, seeds: &[String]) -> String {
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

fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(default)
}

#[test]
fn damaged_programs_neither_panic_nor_hang() {
    let (seed, runs) = (number("BRUSHWORK_SEED", 1), number("BRUSHWORK_MCL_MUTATIONS", 3_000));
    println!("seed {seed}, {runs} programs");
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let seeds = seeds();
    let mut ran = 0;
    for _ in 0..runs {
        let text = damaged(&mut rng, &seeds);
        let compiled = compile(&text);
        for diagnostic in &compiled.diagnostics {
            assert!(codes::ALL.iter().any(|(code, _)| *code == diagnostic.code));
            assert!(diagnostic.span.start <= diagnostic.span.end, "{text}");
            assert!(diagnostic.span.end as usize <= text.len(), "{text}");
        }
        let Some(program) = compiled.program else { continue };
        assert_eq!(image::decode(&image::encode(&program)).as_ref(), Ok(&program), "{text}");
        let mut machine = Machine::new(Arc::new(program));
        let mut desk = Desk::default();
        desk.waiting.insert(0, (0..=255).collect());
        let state = run_on(&mut machine, &mut desk, 2_000);
        assert!(state != State::Ready || machine.executed() > 0);
        ran += 1;
    }
    assert!(
        ran > runs / 20,
        "only {ran} of {runs} compiled: the mutations are too coarse to test the machine"
    );
}

#[test]
fn deep_nesting_is_refused_with_a_sentence() {
    for text in
        ["a = ".to_owned() + &"(".repeat(100_000), "if 1 then\n".repeat(50_000), "-".repeat(100_000) + "1"]
    {
        let found = compile(&text).diagnostics;
        assert!(!found.is_empty());
    }
    let deep = "a var byte\na = ".to_owned() + &"(".repeat(200) + "1" + &")".repeat(200);
    assert!(compile(&deep).diagnostics.iter().any(|diagnostic| diagnostic.code == codes::TOO_DEEP));
}

#[test]
fn a_program_of_twenty_thousand_lines_compiles() {
    let mut text = "value var long\nmain\n".to_owned();
    for line in 0..20_000 {
        text += &format!("value = value + {line} * (value // 7)\n");
    }
    text += "puts 0,[dec value]\ngoto main\n";
    let compiled = compile(&text);
    assert!(compiled.is_ok(), "{:?}", compiled.diagnostics.first());
}
