//! Arguments of `brushwork bench`.

use crate::FAMILIES;
use brushwork_cli::new_file::Replace;
use brushwork_tuning_bench::judge::Judge;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use std::str::FromStr;

/// Arguments of `brushwork bench`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork bench link stop --quick\n  \
    brushwork bench all --json")]
pub struct BenchArgs {
    /// What to measure.
    #[arg(value_enum, value_name = "WHAT", required = true)]
    pub what: Vec<BenchArg>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
    /// Shorter runs with wider spread.
    #[arg(long)]
    pub quick: bool,
    /// Motors that `tuning` tunes.
    #[arg(long, value_name = "N", default_value_t = 200)]
    pub plants: usize,
    /// Seed that `tuning` draws them from; the optima of 7 and 11 are built in.
    #[arg(long, value_name = "SEED", default_value_t = 7)]
    pub seed: u64,
    /// Controllers that `tuning` tunes.
    #[arg(long, value_parser = judge_of(), default_value = judges().next().map_or("", |(key, _)| key))]
    pub family: (&'static str, Judge),
    /// Of `tuning`, only the faults: they need no optima.
    #[arg(long)]
    pub faults: bool,
    /// Of `tuning`, every way to tune, turning freely and in a travel: what is found and what is promised. It needs no optima.
    #[arg(long, conflicts_with = "faults")]
    pub ways: bool,
    /// Of `tuning`, change one threshold of the tuner by a factor, for example MARGIN.most_ms=1.25.
    #[arg(long, value_name = "STAGE.NAME=FACTOR")]
    pub scale: Option<Scale>,
    /// Of `tuning`, what moves with each threshold of these stages: the bench at 0.8 and 1.25 times its value. It takes minutes a stage.
    #[arg(long, value_name = "STAGE,...", value_delimiter = ',', conflicts_with_all = ["scale", "write_oracle"])]
    pub sensitivity: Vec<String>,
    /// Work the optima out anew and write them to a file instead.
    #[arg(long, value_name = "FILE")]
    pub write_oracle: Option<PathBuf>,
    /// Whether an older file of optima is replaced.
    #[command(flatten)]
    pub replace: Replace,
}

impl BenchArgs {
    /// The first option given that changes nothing but `bench tuning`.
    pub fn of_tuning(&self) -> Option<&'static str> {
        let given = [
            ("--faults", self.faults),
            ("--ways", self.ways),
            ("--scale", self.scale.is_some()),
            ("--sensitivity", !self.sensitivity.is_empty()),
            ("--write-oracle", self.write_oracle.is_some()),
        ];
        given.into_iter().find_map(|(option, is_given)| is_given.then_some(option))
    }
}

/// A threshold of the tuner and what it is multiplied by.
#[derive(Clone, Debug, PartialEq)]
pub struct Scale {
    stage: String,
    name: String,
    by: f64,
}

impl Scale {
    /// Multiplies it, for the rest of the process.
    pub fn apply(&self) -> Result<(), String> {
        brushwork_tuning_bench::sensitivity::scale(&self.stage, &self.name, self.by)
    }
}

impl FromStr for Scale {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let of = || {
            let (threshold, by) = text.split_once('=')?;
            let (stage, name) = threshold.split_once('.')?;
            let by = by.parse().ok().filter(|by: &f64| by.is_finite() && *by > 0.0)?;
            Some(Self { stage: stage.to_owned(), name: name.to_owned(), by })
        };
        of().ok_or_else(|| {
            "write STAGE.NAME=FACTOR with a factor above 0, for example MARGIN.most_ms=1.25".to_owned()
        })
    }
}

/// What judges the tuner, by the keys of the program's families.
fn judges() -> impl Iterator<Item = (&'static str, Judge)> {
    FAMILIES.iter().filter_map(|family| Some((family.driver.family().key(), family.judge?)))
}

fn judge_of() -> impl TypedValueParser<Value = (&'static str, Judge)> {
    let keys = judges().map(|(key, judge)| PossibleValue::new(key).help(judge.title));
    let of = |asked: String| judges().find(|(key, _)| *key == asked);
    PossibleValuesParser::new(keys).try_map(move |asked| of(asked).ok_or("no such family"))
}

/// A benchmark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum BenchArg {
    /// Wire time over real time of status sweeps at 115200 and 1000000 bit/s.
    Link,
    /// From the stop key's event to the stop bytes on the wire.
    Stop,
    /// Simulated seconds per second with both motors in closed loop.
    Sim,
    /// An hour of 16 channels: our graph against plain plot lines.
    Window,
    /// MCL: lines compiled per second, and instructions run beside those of a controller.
    Mcl,
    /// The tuner and every textbook rule on simulated motors, in virtual time.
    Tuning,
    /// All of them but tuning.
    All,
}
