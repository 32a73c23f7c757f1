//! What the command line prints for programs: keys and kinds everywhere, values too where they are the same each time.

use std::path::Path;
use std::process::Command;

use brushwork_tests::program::Child;
use brushwork_tests::wait::LIMIT;
use serde_json::{Map, Value, json};
use tempfile::TempDir;

use crate::{folder, is_recording};

/// Whether values are held against the kept ones, or only their keys and kinds with the exit code; of a run whose verdict depends on
/// how busy the computer is, the keys and kinds alone.
#[derive(Clone, Copy, PartialEq)]
enum Of {
    Values,
    Kinds,
    Verdict,
}
use Of::{Kinds, Values, Verdict};

const SCRIPT: &str = "x var word\nfor x = 1 to 10\nnext\nend\n";
const FAULTY: &str = "x var word\nfor y = 1 to 10\nnext\nend\n";

/// File, what is held, arguments: "SCRIPT", "FAULTY" and "PROFILE" stand for files of these.
type Kept = (&'static str, Of, &'static str);

/// What is called one after the other in a folder, where a command may find what those before it left behind.
const COMMANDS: [&[Kept]; 4] = [
    &[
        ("status-mcp266", Kinds, "status --json"),
        ("status-mcp266-4", Kinds, "status --json --connect sim:mcp266,generation=4"),
        ("status-roboclaw", Kinds, "status --json --connect sim:roboclaw-2x7a"),
        ("status-mind", Kinds, "status --json --connect sim:motion-mind-3,mode=4"),
        ("stop-mcp266", Kinds, "stop --json"),
        ("stop-mind", Kinds, "stop --json --connect sim:motion-mind-3,mode=4"),
        ("drive-mcp266", Kinds, "drive --json --duty 10 --for 0.3"),
        ("drive-mind", Kinds, "drive --json --connect sim:motion-mind-3,mode=4 --speed 500 --for 0.3"),
        ("firmware-info", Values, "firmware info --json"),
    ],
    &[
        ("protocol-mcp", Values, "protocol --json"),
        ("protocol-mind", Values, "protocol --json --family motion-mind"),
        ("reference", Values, "settings reference --json"),
        ("read-mcp266", Values, "settings read --json"),
        ("read-mcp266-4", Values, "settings read --json --connect sim:mcp266,generation=4"),
        ("read-roboclaw", Values, "settings read --json --connect sim:roboclaw-2x7a"),
        ("read-mind", Values, "settings read --json --connect sim:motion-mind-3,mode=4"),
        ("monitor", Kinds, "monitor --json --for 0.5"),
    ],
    &[
        ("write-mcp266", Kinds, "settings write --json motor1.velocity.qpps=12000 --yes"),
        ("write-dry-mcp266", Values, "settings write --json motor1.velocity.qpps=12000 --dry-run"),
        (
            "write-mind",
            Kinds,
            "settings write --json --connect sim:motion-mind-3,mode=4 register.pterm=77 --yes",
        ),
        ("diff-mcp266", Values, "settings diff --json PROFILE"),
        ("save-mcp266", Kinds, "settings save --json --yes"),
        ("defaults-mcp266", Kinds, "settings defaults --json --yes"),
        ("reload-mcp266", Kinds, "settings reload --json --yes"),
        ("compare-mcp266", Values, "settings compare --json ram defaults"),
        ("copy-motor-mcp266", Kinds, "settings copy-motor --json 1 --yes"),
        ("backups", Kinds, "settings backups --json"),
        ("unfinished", Kinds, "settings unfinished --json"),
    ],
    &[
        ("script-status", Kinds, "script status --json"),
        ("script-download", Kinds, "script download SCRIPT --json"),
        ("mcl-check", Values, "mcl check --json SCRIPT"),
        ("mcl-check-faulty", Values, "mcl check --json FAULTY"),
        ("mcl-reference", Values, "mcl reference --json"),
        ("tune-velocity", Verdict, "tune velocity --json --motor 1 --dry-run"),
    ],
];

/// A run of the program in a folder of its own: its exit code and the objects that it printed.
fn run(arguments: &str, folder: &Path) -> Value {
    let mut command = Command::new(env!("CARGO_BIN_EXE_brushwork-for-tests"));
    command.env("BRUSHWORK_DATA_DIR", folder.join("data")).current_dir(folder);
    for word in arguments.split(' ') {
        command.arg(match word {
            "SCRIPT" => "script.mcl",
            "FAULTY" => "faulty.mcl",
            "PROFILE" => "profile.json",
            other => other,
        });
    }
    let output = Child::output(&command, b"", LIMIT);
    let text = String::from_utf8(output.stdout).expect("the program prints UTF-8");
    let objects: Vec<Value> =
        serde_json::Deserializer::from_str(&text).into_iter().collect::<Result<_, _>>().unwrap_or_else(
            |error| panic!("{arguments}: {error} in {text}{}", String::from_utf8_lossy(&output.stderr)),
        );
    json!({ "exit code": output.status.code(), "printed": objects })
}

/// The kinds of what was printed, and the exit code itself where it is the same each time.
fn kinds_of(printed: &Value, of: Of) -> Value {
    let mut found = kinds(printed);
    if of == Kinds {
        found["exit code"] = printed["exit code"].clone();
    }
    found
}

/// The kinds of a value: of the members of a list what each of them has or some have.
fn kinds(value: &Value) -> Value {
    match value {
        Value::Null => json!("null"),
        Value::Bool(_) => json!("truth"),
        Value::Number(_) => json!("number"),
        Value::String(_) => json!("text"),
        Value::Array(members) => {
            json!([members.iter().map(kinds).fold(Value::Null, |all, one| merged(&all, &one))])
        }
        Value::Object(members) => {
            Value::Object(members.iter().map(|(key, value)| (key.clone(), kinds(value))).collect())
        }
    }
}

/// What is of either kind.
fn merged(one: &Value, other: &Value) -> Value {
    match (one, other) {
        (Value::Null, kind) | (kind, Value::Null) => kind.clone(),
        (Value::Object(a), Value::Object(b)) => {
            let mut all: Map<String, Value> = a.clone();
            for (key, value) in b {
                let value = all.get(key).map_or_else(|| value.clone(), |before| merged(before, value));
                all.insert(key.clone(), value);
            }
            Value::Object(all)
        }
        (Value::Array(a), Value::Array(b)) => json!([merged(&a[0], &b[0])]),
        (a, b) if a == b => a.clone(),
        // What may be absent, or is a number or a word, is the other thing where that was seen.
        (Value::String(a), Value::String(b)) => {
            let mut words: Vec<&str> = a.split(" or ").chain(b.split(" or ")).collect();
            words.sort_unstable();
            words.dedup();
            json!(words.join(" or "))
        }
        (a, b) => json!({ "one of": [a, b] }),
    }
}

/// Every key of the kept kinds is there, of one of its kinds.
fn assert_same_kinds(kept: &Value, now: &Value, place: &str) {
    match (kept, now) {
        (Value::Object(kept), Value::Object(now)) => {
            for (key, kind) in kept {
                let found = now.get(key).unwrap_or_else(|| panic!("{place}: there is no {key} any more"));
                assert_same_kinds(kind, found, &format!("{place}.{key}"));
            }
        }
        (Value::Array(kept), Value::Array(now)) => {
            for (kind, found) in kept.iter().zip(now) {
                assert_same_kinds(kind, found, &format!("{place}[]"));
            }
        }
        (Value::String(kept), Value::String(now)) => {
            for word in now.split(" or ") {
                assert!(kept.split(" or ").any(|known| known == word), "{place}: {now}, not {kept}");
            }
        }
        // An empty list, or one that was.
        (_, Value::Null) | (Value::Null, _) => {}
        (kept, now) => assert_eq!(kept, now, "{place}"),
    }
}

#[test]
fn what_is_printed_for_programs_keeps_its_keys_and_its_values() {
    // They wait for their controllers most of the time.
    std::thread::scope(|scope| {
        for commands in COMMANDS {
            scope.spawn(move || called_in_turn(commands));
        }
    });
}

fn called_in_turn(commands: &[Kept]) {
    let work = TempDir::new().expect("a temporary folder can be made");
    let write = |name: &str, text: &str| std::fs::write(work.path().join(name), text).expect("it is ours");
    write("script.mcl", SCRIPT);
    write("faulty.mcl", FAULTY);
    std::fs::copy(folder().join("files/profile mcp266.json"), work.path().join("profile.json"))
        .expect("it is in the repository");
    for (name, of, arguments) in commands {
        let path = folder().join("json").join(format!("{name}.json"));
        let printed = run(arguments, work.path());
        if is_recording() {
            let found = match of {
                Values => printed,
                Kinds | Verdict => {
                    let more = (0..2).map(|_| kinds_of(&run(arguments, work.path()), *of));
                    more.fold(kinds_of(&printed, *of), |all, one| merged(&all, &one))
                }
            };
            let text = serde_json::to_string_pretty(&found).expect("it is JSON");
            std::fs::write(&path, text + "\n").expect("the folder is in the repository");
            continue;
        }
        let kept =
            std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let kept: Value = serde_json::from_str(&kept).expect("it is JSON");
        match of {
            Values => assert!(printed == kept, "{name}: {}", first_difference(&kept, &printed, "")),
            Kinds | Verdict => assert_same_kinds(&kept, &kinds_of(&printed, *of), name),
        }
    }
}

/// Where two values first differ, and how.
fn first_difference(kept: &Value, now: &Value, place: &str) -> String {
    match (kept, now) {
        (Value::Object(a), Value::Object(b)) => {
            let keys: std::collections::BTreeSet<&String> = a.keys().chain(b.keys()).collect();
            let at = keys.into_iter().find(|key| a.get(*key) != b.get(*key)).expect("they differ");
            let none = Value::Null;
            first_difference(a.get(at).unwrap_or(&none), b.get(at).unwrap_or(&none), &format!("{place}.{at}"))
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            let at = (0..a.len()).find(|at| a[*at] != b[*at]).expect("they differ");
            first_difference(&a[at], &b[at], &format!("{place}[{at}]"))
        }
        (kept, now) => format!("{place} was {kept} and is {now}"),
    }
}
