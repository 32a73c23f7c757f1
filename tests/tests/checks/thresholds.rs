//! The numbers that the tuner decides by stand in the structs of their stages, where a sensitivity run can reach them.

use brushwork_tests::rust_source::without_tests;
use brushwork_tests::workspace;

/// Numbers that decide nothing: units of the wire and of parameters, what the figure of merit is defined by, where a search starts, what a table shows.
const NO_THRESHOLDS: [(&str, &[&str]); 14] = [
    ("axis.rs", &["FULL_DUTY_RAW", "VOLTS_PER_RAW", "AMPS_PER_RAW", "ABSOLUTE_COUNTS"]),
    ("cascade.rs", &["FILTERS_S", "DELAYS"]),
    ("design/task.rs", &["USUAL_OVERSHOOT"]),
    ("experiment_guard/mod.rs", &["RUN_STREAM_TIMEOUT_MS"]),
    ("fit.rs", &["STARTS_S"]),
    ("lag.rs", &["STARTS", "UNITS"]),
    ("linear.rs", &["FREQUENCIES"]),
    ("load_change.rs", &["INERTIAS", "FRICTIONS", "LOADS_DUTY"]),
    ("moves/fit.rs", &["OF_DUTY", "UNITS"]),
    ("report.rs", &["FORMAT"]),
    ("request.rs", &["MIDDLE_DUTY"]),
    ("response.rs", &["STARTS"]),
    ("ticks.rs", &["QUEUE"]),
    ("score.rs", &["LOAD_STEP_DUTY", "VELOCITY_STEP", "VELOCITY_OVERSHOOT", "POSITION_OVERSHOOT"]),
];

/// The sources of the tuner, without their folder.
fn sources() -> impl Iterator<Item = (String, String)> {
    workspace::rust_files().into_iter().filter_map(|path| {
        let file = path.strip_prefix("tuning/src/")?.to_owned();
        let source = workspace::read(&path);
        Some((file, without_tests(&source).to_owned()))
    })
}

/// The name of the number that a line declares by itself.
fn declared(line: &str) -> Option<&str> {
    let (before, rest) = line.split_once("const ")?;
    let (name, rest) = rest.split_once(": ")?;
    let is_number = rest.starts_with(['(', '['])
        || ["f64", "i16", "i32", "i64", "u16", "u32", "u64", "usize", "Duration"]
            .iter()
            .any(|of| rest.starts_with(of));
    let is_item = before.is_empty() || before.starts_with("pub");
    (is_item && is_number && !rest.starts_with("[&")).then_some(name)
}

#[test]
fn no_threshold_of_the_tuner_stands_by_itself() {
    let allowed =
        |file: &str, name: &str| NO_THRESHOLDS.iter().any(|(of, names)| *of == file && names.contains(&name));
    let mut faults = Vec::new();
    for (file, source) in sources() {
        let names = source.lines().filter_map(declared).filter(|name| !allowed(&file, name));
        faults.extend(names.map(|name| format!("tuning/src/{file}: {name}")));
    }
    assert!(faults.is_empty(), "not in the `thresholds!` of its stage:\n{}", faults.join("\n"));
}

#[test]
fn every_threshold_says_what_it_is_and_a_sensitivity_run_reaches_all() {
    let mut faults = Vec::new();
    let mut declared = 0;
    for (file, source) in sources().filter(|(file, _)| file != "thresholds.rs") {
        let blocks = source.split("\nthresholds! {\n").skip(1);
        let lines = blocks.filter_map(|block| block.split_once("\n}")).flat_map(|(inside, _)| inside.lines());
        let mut before = "";
        for line in lines.map(str::trim) {
            if line.contains(" = ") && !line.starts_with("///") {
                declared += 1;
                if !before.starts_with("///") {
                    faults.push(format!("tuning/src/{file}: {line}"));
                }
            }
            before = line;
        }
    }
    let listed = brushwork_tuning::sensitivity::thresholds().len();
    assert!(faults.is_empty(), "without a line that says what they are:\n{}", faults.join("\n"));
    assert_eq!(declared, listed, "declared in the sources, and listed in tuning/src/sensitivity.rs");
}
