//! `brushwork bench`: measures what the program promises, and says beside each figure whether the promise is kept.
//!
//! Everything runs in this process, against simulated controllers; nothing here is drawn on a screen. The figures hold for
//! the machine and the build they were taken on: use a release build on a quiet machine.

pub mod arguments;
pub mod at_motor;
pub mod editor;
pub mod figure;
pub mod graph;
pub mod headless;
pub mod rig;
pub mod sensitivity;
pub mod spread;
pub mod tap;
pub mod tuning;
pub mod watched;
pub mod window;

use std::time::Duration;

use serde_json::json;

use crate::FAMILIES;
use arguments::{BenchArg, BenchArgs};
use brushwork_cli::interrupt::Interrupt;
use brushwork_cli::output::{Output, OutputError, say};
use brushwork_cli::{Exit, Tool};
use figure::{Figure, MARKS};

/// How long and how often to measure.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Rounds of the link benchmark.
    pub rounds: usize,
    /// How long each of them is.
    pub round: Duration,
    /// Stops to time in each situation.
    pub stops: usize,
    /// Rounds of five simulated seconds for each preset.
    pub sim_rounds: usize,
    /// Frames of the graph; the plain one has a tenth of them.
    pub frames: usize,
    /// Rounds of each loop of the script benchmark.
    pub mcl_rounds: usize,
}

/// Something that is measured of one family, and what measures it.
pub type Measure = (BenchArg, fn(Effort, &Interrupt) -> Result<Vec<Figure>, String>);

/// The figures that are quoted.
const FULL: Effort = Effort {
    rounds: 15,
    round: Duration::from_secs(1),
    stops: 250,
    sim_rounds: 24,
    frames: 200,
    mcl_rounds: 9,
};

/// A look.
const QUICK: Effort =
    Effort { rounds: 3, round: Duration::from_secs(1), stops: 40, sim_rounds: 6, frames: 40, mcl_rounds: 3 };

/// `brushwork bench`.
#[must_use]
pub fn tool() -> Tool {
    Tool::new(
        "bench",
        50,
        "Measure link use, stop latency, the simulator and the window",
        |args: &BenchArgs, out, interrupt| Ok(run(args, out, interrupt)),
    )
}

/// Measures, prints, and fails when a promise is not kept.
fn run(args: &BenchArgs, out: &mut Output, interrupt: &Interrupt) -> Exit {
    if cfg!(debug_assertions) {
        say("This is a debug build: its figures say little. Use cargo run --release -p brushwork -- bench …");
    }
    if args.what.contains(&BenchArg::Tuning) {
        return tuning::run(args, out, interrupt);
    }
    if let Some(option) = args.of_tuning() {
        say(format!("{option} is an option of `bench tuning`, which was not asked for."));
        return Exit::Usage;
    }
    let effort = if args.quick { QUICK } else { FULL };
    let mut figures = Vec::new();
    for what in wanted(&args.what) {
        if interrupt.is_raised() {
            return Exit::Interrupted;
        }
        match measure(what, effort, interrupt) {
            Ok(measured) => figures.extend(measured),
            Err(_) if interrupt.is_raised() => return Exit::Interrupted,
            Err(why) => {
                say(format!("Could not measure {}: {why}.", name_of(what)));
                return Exit::Failed;
            }
        }
    }
    if let Err(error) = print(args.json, &figures, out) {
        return error.into();
    }
    if figures.iter().any(|figure| figure.is_met() == Some(false)) { Exit::Failed } else { Exit::Done }
}

fn measure(what: BenchArg, effort: Effort, interrupt: &Interrupt) -> Result<Vec<Figure>, String> {
    if what == BenchArg::Window {
        return window::measure(effort);
    }
    let measures = FAMILIES.iter().flat_map(|family| family.measures).filter(|(of, _)| *of == what);
    measures
        .map(|(_, measure)| measure(effort, interrupt))
        .collect::<Result<Vec<_>, _>>()
        .map(|all| all.concat())
}

/// Each benchmark once, in the order of the table.
fn wanted(asked: &[BenchArg]) -> impl Iterator<Item = BenchArg> + '_ {
    let each = [BenchArg::Link, BenchArg::Stop, BenchArg::Sim, BenchArg::Window, BenchArg::Mcl];
    each.into_iter().filter(|what| asked.contains(what) || asked.contains(&BenchArg::All))
}

fn name_of(what: BenchArg) -> &'static str {
    match what {
        BenchArg::Link => "the link",
        BenchArg::Stop => "the stop",
        BenchArg::Sim => "the simulator",
        BenchArg::Window => "the window",
        BenchArg::Mcl => "scripts",
        BenchArg::Tuning => "the tuner",
        BenchArg::All => "everything",
    }
}

fn print(as_json: bool, figures: &[Figure], out: &mut Output) -> Result<(), OutputError> {
    if as_json {
        return out.json(&json!({
            "version": env!("CARGO_PKG_VERSION"),
            "build": BUILD,
            "processors": processors(),
            "load": load(),
            "figures": figures,
        }));
    }
    let rows: Vec<Vec<String>> = figures.iter().map(Figure::cells).collect();
    out.table(&MARKS, &rows)?;
    let load = load().map_or_else(String::new, |load| format!(", load {load}"));
    out.line(format!("\n{BUILD} build, {} processors{load}", processors()))
}

const BUILD: &str = if cfg!(debug_assertions) { "debug" } else { "release" };

fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// How many threads wanted a processor at a time in the last minute, where the system tells. More than there are
/// processors makes every figure worse.
fn load() -> Option<f64> {
    std::fs::read_to_string("/proc/loadavg").ok()?.split(' ').next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_means_each_once_in_a_fixed_order() {
        let each = [BenchArg::Link, BenchArg::Stop, BenchArg::Sim, BenchArg::Window, BenchArg::Mcl];
        assert!(wanted(&[BenchArg::All]).eq(each));
        assert!(wanted(&[BenchArg::Sim, BenchArg::Link, BenchArg::Sim]).eq([BenchArg::Link, BenchArg::Sim]));
    }
}
