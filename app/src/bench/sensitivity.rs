//! `brushwork bench tuning --sensitivity STAGE`: what moves in a bench when one threshold of the tuner is a fifth lower or a quarter higher.
//!
//! A threshold is read once in a process, so that each run of the bench is a process of its own.

use super::arguments::BenchArgs;
use brushwork_cli::Exit;
use brushwork_cli::interrupt::Interrupt;
use brushwork_cli::output::{Output, say};
use brushwork_tuning_bench::sensitivity::thresholds;
use serde_json::Value;
use std::process::Command;

/// What each threshold is multiplied by.
const FACTORS: [f64; 2] = [0.8, 1.25];

/// Differences below this are not printed.
const LEAST: f64 = 0.005;

/// Parts of a bench's JSON that are compared: a column, its name in the JSON, and its name in print.
const COLUMNS: [(&str, &str); 13] = [
    ("found", "found"),
    ("accept", "accepted"),
    ("accepted", "accepted"),
    ("good", "good"),
    ("j_median", "J"),
    ("unwarned", "no warning"),
    ("overpromised", "Ms > 1.8, no warning"),
    ("beyond", "Ms > 2"),
    ("off_in_time", "off in time"),
    ("named", "named"),
    ("off_median_s", "off after, s"),
    ("off_max_s", "at the latest, s"),
    ("seconds_median", "run, s"),
];

/// Runs it for every threshold of the stages that were asked for.
pub fn run(args: &BenchArgs, out: &mut Output, interrupt: &Interrupt) -> Exit {
    let asked = |stage: &str| args.sensitivity.iter().any(|of| of.eq_ignore_ascii_case(stage));
    let all = thresholds();
    if let Some(none) =
        args.sensitivity.iter().find(|of| !all.iter().any(|each| each.stage.eq_ignore_ascii_case(of)))
    {
        let mut stages: Vec<&str> = all.iter().map(|each| each.stage).collect();
        stages.dedup();
        say(format!("There is no stage {none}. There are {}.", stages.join(", ")));
        return Exit::Usage;
    }
    let usual = match bench(args, None) {
        Ok(usual) => usual,
        Err(_) if interrupt.is_raised() => return Exit::Interrupted,
        Err(exit) => return exit,
    };
    for each in all.iter().filter(|each| asked(each.stage)) {
        let mut line = vec![format!("{}.{}", each.stage, each.name), each.value.clone()];
        for factor in FACTORS {
            match bench(args, Some(&format!("{}.{}={factor}", each.stage, each.name))) {
                Ok(moved) => line.push(differences(&usual, &moved)),
                Err(_) if interrupt.is_raised() => return Exit::Interrupted,
                Err(exit) => return exit,
            }
        }
        // Each takes minutes: what is known is printed.
        if let Err(error) = out.line(format!("| {} |", line.join(" | "))) {
            return error.into();
        }
    }
    Exit::Done
}

/// The bench that was asked for, in a process of its own.
#[expect(
    clippy::disallowed_methods,
    reason = "a bench ends by itself, and with this process where it is interrupted"
)]
fn bench(args: &BenchArgs, scale: Option<&str>) -> Result<Value, Exit> {
    let program = std::env::current_exe().map_err(|error| failed(&error.to_string()))?;
    let mut command = Command::new(program);
    command.args(["bench", "tuning", "--quick", "--json", "--family", args.family.0]);
    command.args(["--plants", &args.plants.to_string(), "--seed", &args.seed.to_string()]);
    command.args(args.faults.then_some("--faults"));
    command.args(args.ways.then_some("--ways"));
    command.args(scale.map(|scale| format!("--scale={scale}")));
    let ran = command.output().map_err(|error| failed(&error.to_string()))?;
    if !ran.status.success() {
        let said = String::from_utf8_lossy(&ran.stderr);
        return Err(failed(&format!("it ended with {}: {}", ran.status, said.trim())));
    }
    serde_json::from_slice(&ran.stdout).map_err(|error| failed(&error.to_string()))
}

fn failed(why: &str) -> Exit {
    say(format!("The bench was to run as a process of its own, but {why}."));
    Exit::Failed
}

/// What is different, in the mean of all rows.
fn differences(usual: &Value, moved: &Value) -> String {
    if usual == moved {
        return "nothing".to_owned();
    }
    let different = COLUMNS.iter().filter_map(|(column, name)| {
        let by = mean(moved, column)? - mean(usual, column)?;
        (by.abs() >= LEAST).then(|| format!("{name} {by:+.2}"))
    });
    let different: Vec<String> = different.collect();
    if different.is_empty() { "less than 0.005 of each".to_owned() } else { different.join(", ") }
}

/// The mean of a column over our own rows.
fn mean(bench: &Value, column: &str) -> Option<f64> {
    let tasks = bench.get("tasks").and_then(Value::as_object);
    let rows: Vec<&Value> = match (tasks, bench.as_array()) {
        (Some(tasks), _) => tasks
            .values()
            .filter_map(Value::as_array)
            .flatten()
            .filter(|row| row.get("method").is_some_and(|method| method == "brushwork"))
            .collect(),
        (None, rows) => rows.into_iter().flatten().collect(),
    };
    let figures: Vec<f64> = rows.iter().filter_map(|row| row.get(column)?.as_f64()).collect();
    (!figures.is_empty()).then(|| figures.iter().sum::<f64>() / figures.len() as f64)
}
