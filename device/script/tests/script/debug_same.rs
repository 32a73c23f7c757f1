//! Debugging changes nothing: whatever is stepped, paused, broken into and watched, a program sends the same bytes, moves the same motors
//! and leaves the same memory after the same number of instructions as when it runs free.
//!
//! `BRUSHWORK_MCL_MUTATIONS=n` runs n damaged programs (the default is small), `BRUSHWORK_SEED=n` others.

use crate::support::examples::{corrected, examples};
use crate::support::mutation::{damaged, number, seeds};
use crate::support::{TestHost, same_host};
use brushwork_script::debug::{Breakpoint, Debugger, Request, StepKind, Wanted};
use brushwork_script::mcl::{Names, compile};
use brushwork_script::program::Program;
use brushwork_script::vm::{Machine, State};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::sync::Arc;

/// Instructions that each program runs at most.
const MOST: u64 = 3_000;

fn host() -> TestHost {
    let mut host = TestHost::default();
    host.waiting.insert(
        0,
        b"x 77 -5,a1 $3f 1.5 abc\r hello 12 34 56 \0\x01\x02".iter().copied().cycle().take(400).collect(),
    );
    host.i2c_reply = Some(vec![7, 9]);
    host
}

/// The end of a run, and whether it can go on from there.
fn is_at_rest(state: &State) -> bool {
    !matches!(state, State::Ready | State::Pausing { .. })
}

fn free(program: &Arc<Program>) -> (Machine, TestHost) {
    let (mut machine, mut host) = (Machine::new(program.clone()), host());
    while machine.executed() < MOST {
        let left = (MOST - machine.executed()) as u32;
        match machine.run(&mut host, left.min(1_500)) {
            State::Pausing { until } => host.now = *until,
            state if is_at_rest(state) => break,
            _ => {}
        }
    }
    (machine, host)
}

fn any_request(rng: &mut ChaCha8Rng, lines: u32) -> Request {
    let line = 1 + rng.next_u32() % lines.max(1);
    match rng.next_u32() % 12 {
        0..=3 => Request::Step(StepKind::Into),
        4..=5 => Request::Step(StepKind::Over),
        6 => Request::Step(StepKind::Out),
        7 => Request::RunTo(line),
        8 => Request::Breakpoints(vec![
            Breakpoint::at(line),
            Breakpoint { from_hit: 3, ..Breakpoint::at(line / 2 + 1) },
        ]),
        9 => Request::Pause,
        10 => Request::Breakpoints(Vec::new()),
        _ => Request::Continue,
    }
}

fn stepped(program: &Arc<Program>, text: &str, rng: &mut ChaCha8Rng) -> (Machine, TestHost) {
    let (mut machine, mut host) = (Machine::new(program.clone()), host());
    let mut debugger = Debugger::default();
    let lines = text.lines().count() as u32;
    let mut names = Names::of(text).expect("it compiles");
    let watched: Vec<_> =
        program.variables.iter().take(3).map(|variable| names.watch(&variable.name)).collect();
    let wanted = Wanted {
        watches: Arc::new(watched),
        code: brushwork_script::debug::code_id(program),
        ..Wanted::default()
    };
    debugger.ask(Request::StopAtEntry(rng.next_u32().is_multiple_of(2)), None, &mut host);
    debugger.ask(Request::Attach(true), Some(&mut machine), &mut host);
    debugger.started(&machine);
    let mut turns = 0u64;
    while machine.executed() < MOST {
        turns += 1;
        assert!(turns < 60 * MOST, "it hangs:\n{text}");
        if debugger.is_paused() || rng.next_u32().is_multiple_of(5) {
            debugger.ask(any_request(rng, lines), Some(&mut machine), &mut host);
            debugger.view(Some(&mut machine), &mut host, &wanted);
        }
        let left = (MOST - machine.executed()) as u32;
        let state = debugger.run(&mut machine, &mut host, left.min(1 + rng.next_u32() % 97)).clone();
        match state {
            _ if debugger.is_paused() => {}
            State::Pausing { until } => host.now = until,
            state if is_at_rest(&state) => break,
            _ => {}
        }
    }
    (machine, host)
}

/// Runs a program both ways.
fn compare(text: &str, rng: &mut ChaCha8Rng) -> bool {
    let Some(program) = compile(text).program else { return false };
    let program = Arc::new(program);
    let (free, free_host) = free(&program);
    let (stepped, stepped_host) = stepped(&program, text, rng);
    assert_eq!(stepped.executed(), free.executed(), "{text}");
    assert_eq!(stepped.at(), free.at(), "{text}");
    assert_eq!(stepped.state(), free.state(), "{text}");
    assert_eq!(stepped.memory(), free.memory(), "{text}");
    assert!(same_host(&stepped_host, &free_host), "{text}\n{stepped_host:?}\n{free_host:?}");
    true
}

#[test]
fn every_program_of_the_manual_does_the_same_stepped_as_free() {
    let seed = number("BRUSHWORK_SEED", 1);
    println!("seed {seed}");
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let files = [include_str!("../manual/registers.txt"), include_str!("../manual/chapter.txt")];
    let mut count = 0;
    for example in files.iter().flat_map(|file| examples(file)) {
        let text = corrected(&example);
        for _ in 0..3 {
            assert!(compare(&text, &mut rng), "{}", example.title);
        }
        count += 1;
    }
    assert!(count > 130, "{count}");
}

#[test]
fn damaged_programs_do_the_same_stepped_as_free() {
    let (seed, runs) = (number("BRUSHWORK_SEED", 1), number("BRUSHWORK_MCL_MUTATIONS", 600));
    println!("seed {seed}, {runs} programs");
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let seeds = seeds();
    let ran = (0..runs).filter(|_| compare(&damaged(&mut rng, &seeds), &mut rng)).count();
    assert!(ran > runs as usize / 20, "only {ran} of {runs} compiled");
}
