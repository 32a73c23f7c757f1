//! Every example program of MCP manual chapter 3 compiles and does what the manual says, or a correction says which rule the printed
//! line breaks or what the scan lost.
//!
//! In the files of `tests/manual` a program begins with `===` and its section. `!` is a correction: what is printed, what has to be
//! there, and why; `~` stands for the end of a line, `^` for the beginning. `?` is what has to be seen: `> bytes` on stream 0 from the
//! start, `< bytes` given to stream 0, `= NAME element value` in a register, `var NAME element value`, `real` and `near` for floats,
//! `@ COMMAND arguments` in this order, `i2c byte` a device that answers so, `set NAME element value` a register before the start, `ends`.
//! A register that nothing sets reads 42.

use crate::support::examples::{Example, corrected, examples};
use crate::support::{TestHost, run_on};
use brushwork_script::diagnostic::Severity;
use brushwork_script::mcl::{compile, registers, words};
use brushwork_script::text::Lines;
use brushwork_script::vm::{Machine, State, element};
use std::sync::Arc;

fn errors(text: &str) -> String {
    let lines = Lines::of(text);
    let compiled = compile(text);
    let errors = compiled.diagnostics.iter().filter(|diagnostic| diagnostic.severity() == Severity::Error);
    errors.map(|error| error.render("example", text, &lines)).collect()
}

fn bytes(text: &str) -> Vec<u8> {
    text.replace("\\r", "\r")
        .replace("\\0", "\0")
        .replace("\\x01", "\x01")
        .replace("\\x02", "\x02")
        .into_bytes()
}

fn number<T: std::str::FromStr>(text: &str) -> T {
    text.parse().ok().unwrap_or_else(|| panic!("{text} is no number"))
}

fn register(host: &TestHost, name: &str, index: &str) -> u32 {
    let (id, _) = words::register(name).expect("a register");
    host.registers[&(id.0, number(index))]
}

fn prepare(example: &Example<'_>) -> TestHost {
    let mut host = TestHost::default();
    for (id, row) in registers::REGISTERS.iter().enumerate() {
        for index in 0..row.length {
            host.registers.insert((id as u8, index), 42);
        }
    }
    for line in &example.expected {
        let words: Vec<&str> = line.split(' ').collect();
        match words[..] {
            ["set", name, index, value] => {
                let (id, _) = words::register(name).expect("a register");
                host.registers.insert((id.0, number(index)), number(value));
            }
            ["i2c", byte] => host.i2c_reply = Some(vec![number(byte)]),
            _ => {
                if let Some(input) = line.strip_prefix("< ") {
                    host.waiting.insert(0, bytes(input).into());
                }
            }
        }
    }
    host
}

fn variable(machine: &Machine, name: &str, index: u32) -> u32 {
    let found = machine.program().variables.iter().find(|variable| variable.name.eq_ignore_ascii_case(name));
    let found = found.unwrap_or_else(|| panic!("no variable {name}"));
    machine.memory().load(element(found.memory, index).expect("an element"))
}

fn check(example: &Example<'_>, machine: &Machine, host: &TestHost, state: &State) {
    let title = example.title;
    let mut motions = host.motions.iter();
    for line in &example.expected {
        let words: Vec<&str> = line.split(' ').collect();
        match words[..] {
            ["=", name, index, value] => {
                assert_eq!(register(host, name, index).to_string(), value, "{title}: {line}");
            }
            ["var", name, index, value] => {
                assert_eq!(variable(machine, name, number(index)).to_string(), value, "{title}: {line}");
            }
            ["real", name, value] => {
                let got = f32::from_bits(variable(machine, name, 0));
                assert_eq!(got, number::<f32>(value), "{title}: {line}");
            }
            ["near", name, value, within] => {
                let got = f32::from_bits(variable(machine, name, 0));
                let (value, within): (f32, f32) = (number(value), number(within));
                assert!((got - value).abs() <= within, "{title}: {line}, got {got}");
            }
            ["@", command, ..] => {
                let (motion, arguments) = motions.next().unwrap_or_else(|| panic!("{title}: {line}"));
                let got: Vec<String> = arguments.iter().map(ToString::to_string).collect();
                assert_eq!((motion.word(), got.join(" ")), (command, words[2..].join(" ")), "{title}");
            }
            ["ends"] => assert_eq!(state, &State::Ended, "{title}"),
            _ => {
                if let Some(output) = line.strip_prefix("> ") {
                    let sent = host.sent.get(&0).cloned().unwrap_or_default();
                    let shown = String::from_utf8_lossy(&sent);
                    assert!(sent.starts_with(&bytes(output)), "{title}: sent {shown:?}, not {output:?}");
                }
            }
        }
    }
}

fn prove(file: &str) -> usize {
    let examples = examples(file);
    for example in &examples {
        let text = corrected(example);
        let compiled = compile(&text);
        let Some(program) = compiled.program else { panic!("{}:\n{}", example.title, errors(&text)) };
        let mut host = prepare(example);
        let mut machine = Machine::new(Arc::new(program));
        let state = run_on(&mut machine, &mut host, 20_000);
        check(example, &machine, &host, &state);
        assert!(!matches!(state, State::Faulted(_)), "{}: {state:?}", example.title);
    }
    examples.len()
}

#[test]
fn the_examples_of_the_register_pages_do_what_they_say() {
    assert!(prove(include_str!("../manual/registers.txt")) > 60);
}

#[test]
fn the_examples_of_the_rest_of_the_chapter_do_what_it_says() {
    assert!(prove(include_str!("../manual/chapter.txt")) > 70);
}
