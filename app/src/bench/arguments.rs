//! Arguments of `brushwork bench`.

use crate::{FAMILIES, Family};
use brushwork_cli::new_file::Replace;
use brushwork_tuning_bench::judge::Judge;
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

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
    #[arg(long, value_parser = family_keys(), default_value = key_of(&FAMILIES[0]))]
    pub family: String,
    /// Of `tuning`, only the faults: they need no optima.
    #[arg(long)]
    pub faults: bool,
    /// Work the optima out anew and write them to a file instead.
    #[arg(long, value_name = "FILE")]
    pub write_oracle: Option<PathBuf>,
    /// Whether an older file of optima is replaced.
    #[command(flatten)]
    pub replace: Replace,
}

/// The families of the program by their keys.
fn family_keys() -> PossibleValuesParser {
    FAMILIES
        .iter()
        .map(|family| PossibleValue::new(key_of(family)).help(family.judge.title))
        .collect::<Vec<_>>()
        .into()
}

fn key_of(family: &Family) -> &'static str {
    family.driver.family().key()
}

impl BenchArgs {
    /// What judges the tuner on the family that is asked for.
    #[must_use]
    pub fn judge(&self) -> Judge {
        FAMILIES.iter().find(|family| key_of(family) == self.family).unwrap_or(&FAMILIES[0]).judge
    }
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
