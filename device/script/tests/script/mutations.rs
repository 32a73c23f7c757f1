//! Damaged programs: whatever the compiler is given it answers, and whatever it lets through runs without a panic or a hang.
//!
//! `BRUSHWORK_MCL_MUTATIONS=n` runs n of them (the default is small), `BRUSHWORK_SEED=n` others.

use crate::support::mutation::{damaged, number, seeds};
use crate::support::{TestHost, run_in_slices};
use brushwork_script::image;
use brushwork_script::mcl::{codes, compile};
use brushwork_script::vm::{Machine, State};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::sync::Arc;

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
        let mut host = TestHost::default();
        host.waiting.insert(0, (0..=255).collect());
        let state = run_in_slices(&mut machine, &mut host, 2_000, 1_000);
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
