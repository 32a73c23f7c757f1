//! Arguments of `brushwork bench`.

use brushwork_cli::new_file::Replace;
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
    #[arg(long, value_enum, default_value_t = BenchFamily::Mcp)]
    pub family: BenchFamily,
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

/// A family of controllers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum BenchFamily {
    /// MCP and RoboClaw, packet serial.
    Mcp,
    /// Motion Mind 3, frames and lines.
    MotionMind,
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
