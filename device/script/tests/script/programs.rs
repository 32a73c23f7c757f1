//! One program per operator, modifier, type and command, with the output that was worked out by hand or by a Python script (see
//! `tests/programs/expected.py`), not by this machine.

use crate::support::{TestHost, machine, run_in_slices};
use brushwork_script::mcl::operators::OPERATORS;
use brushwork_script::mcl::types::{TABLES, VarType, parts};
use brushwork_script::mcl::words::{COMMANDS, FORMATS};
use brushwork_script::vm::State;
use std::collections::BTreeSet;

struct Program {
    title: String,
    input: Vec<u8>,
    text: String,
    output: String,
}

fn programs(file: &str) -> Vec<Program> {
    let file = file.replace("\r\n", "\n");
    let parts = file.split("=== ").skip(1);
    let read = |part: &str| {
        let (text, output) = part.split_once("\n---\n").expect("a program has an output");
        let (title, mut text) = text.split_once('\n').expect("a title and a program");
        let mut input = Vec::new();
        if let Some(rest) = text.strip_prefix("< ") {
            let (line, rest) = rest.split_once('\n').expect("a program after its input");
            input = line.as_bytes().to_vec();
            text = rest;
        }
        let output = output.strip_suffix('\n').expect("the output ends with its line").to_owned();
        Program { title: title.to_owned(), input, text: format!("{text}\n"), output }
    };
    parts.map(read).collect()
}

fn prove(programs: &[Program]) {
    for program in programs {
        let mut machine = machine(&program.text);
        let mut host = TestHost::default();
        host.waiting.insert(0, program.input.clone().into());
        let state = run_in_slices(&mut machine, &mut host, 100_000, 50_000);
        assert_eq!(state, State::Ended, "{}\n{}", program.title, program.text);
        let sent: String = host.sent.remove(&0).unwrap_or_default().into_iter().map(char::from).collect();
        let motions = host.motions.iter().map(|(motion, arguments)| {
            let arguments: Vec<String> = arguments.iter().map(ToString::to_string).collect();
            format!("@ {} {}", motion.word(), arguments.join(" "))
        });
        let seen: Vec<String> = motions.chain((!sent.is_empty()).then_some(sent)).collect();
        assert_eq!(seen.join("\n"), program.output, "{}\n{}", program.title, program.text);
    }
}

fn titles(programs: &[Program]) -> BTreeSet<&str> {
    programs.iter().map(|program| program.title.as_str()).collect()
}

#[test]
fn every_operator_gives_what_python_works_out() {
    let programs = programs(include_str!("../programs/operators.txt"));
    let titles = titles(&programs);
    for row in &OPERATORS {
        let title = if row.syntax == "-x" { "- x" } else { row.name };
        assert!(titles.contains(title), "no program for {title}");
    }
    prove(&programs);
}

#[test]
fn every_modifier_of_every_type_names_the_bits_that_python_names() {
    let programs = programs(include_str!("../programs/modifiers.txt"));
    let titles = titles(&programs);
    for kind in VarType::ALL.into_iter().filter(|kind| !matches!(kind, VarType::Bit | VarType::Float)) {
        for part in parts(kind).iter().filter(|part| !part.starts_with("LowS") && !part.starts_with("HighS"))
        {
            let title = format!("{}.{part}", kind.name());
            assert!(titles.contains(title.as_str()), "no program for {title}");
        }
    }
    prove(&programs);
}

#[test]
fn every_type_keeps_what_python_keeps() {
    let programs = programs(include_str!("../programs/widths.txt"));
    let titles = titles(&programs);
    for name in VarType::ALL.map(VarType::name).into_iter().chain(TABLES.map(|(name, _)| name)) {
        assert!(titles.contains(name), "no program for {name}");
    }
    prove(&programs);
}

#[test]
fn every_command_does_what_was_worked_out_by_hand() {
    let programs = programs(include_str!("../programs/commands.txt"));
    let titles = titles(&programs);
    for row in &COMMANDS {
        assert!(titles.contains(row.name), "no program for {}", row.name);
    }
    for row in FORMATS.iter().filter(|row| row.name != "REP") {
        assert!(titles.contains(format!("input {}", row.name).as_str()), "no input program for {}", row.name);
    }
    prove(&programs);
}
