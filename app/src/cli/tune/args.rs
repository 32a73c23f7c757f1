//! Arguments of `brushwork tune`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

use crate::cli::args::ConnectArgs;

/// Arguments of `brushwork tune`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork tune velocity --motor 1 --dry-run --report run.json\n  \
    brushwork tune position --motor 1 --method piv --travel -2000..2000 --max-current 10 --apply\n  \
    brushwork tune replay run.json\n\n\
    The motor turns both ways at up to full duty (--max-duty), or within --travel at less. Ctrl-C stops both motors at once and \
    puts the old gains back. Exit codes: 0 tuned, 4 refused, 8 tuned with warnings.")]
pub struct TuneArgs {
    /// What to do.
    #[command(subcommand)]
    pub command: TuneCommand,
}

/// What `brushwork tune` does.
#[derive(Debug, Subcommand)]
pub enum TuneCommand {
    /// Tune the velocity loop of a motor that may turn freely.
    Velocity(RunArgs),
    /// Tune a position loop.
    Position(RunArgs),
    /// Compute the gains of a report again from its raw record.
    Replay {
        /// The report.
        report: PathBuf,
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
}

/// A run on a machine.
#[derive(Debug, Args)]
pub struct RunArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// Which motor.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=2))]
    pub motor: u8,
    /// Form of a position loop.
    #[arg(long, value_enum, default_value_t = MethodArg::Piv)]
    pub method: MethodArg,
    /// From 0 (soft) to 100 (stiff).
    #[arg(long, default_value_t = 50, value_parser = clap::value_parser!(u8).range(0..=100))]
    pub level: u8,
    /// Counts between which the axis may move, with the axis in the middle: full speed is not used then.
    #[arg(long, value_name = "LOW..HIGH", allow_hyphen_values = true, value_parser = parse_travel)]
    pub travel: Option<Travel>,
    /// Highest motor current in amperes; the run ends above it.
    #[arg(long, value_name = "AMPS")]
    pub max_current: Option<f64>,
    /// Highest duty in percent.
    #[arg(long, value_name = "PERCENT", default_value_t = 100, value_parser = clap::value_parser!(u8).range(20..=100))]
    pub max_duty: u8,
    /// What the encoder is.
    #[arg(long, value_enum, default_value_t = EncoderArg::Quadrature)]
    pub encoder: EncoderArg,
    /// Leave the new gains in force (RAM).
    #[arg(long, conflicts_with = "dry_run")]
    pub apply: bool,
    /// Leave them in force and save all settings to EEPROM.
    #[arg(long, conflicts_with = "dry_run")]
    pub save: bool,
    /// Only propose them; this is the default.
    #[arg(long)]
    pub dry_run: bool,
    /// Write the report with its raw record to a file.
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// A travel window in counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Travel {
    /// Its lower end.
    pub low: i64,
    /// Its upper end.
    pub high: i64,
}

/// The forms of a position loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MethodArg {
    /// P and D on the duty.
    Pd,
    /// With an integral.
    Pid,
    /// P over the velocity loop.
    Piv,
}

/// The kinds of encoders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum EncoderArg {
    /// Counts without bound.
    Quadrature,
    /// 0 to 4095 within one turn.
    Absolute,
    /// 0 to 4095 and on from 4095 to 0.
    AbsoluteWrapping,
}

fn parse_travel(text: &str) -> Result<Travel, String> {
    let parsed = text.split_once("..").and_then(|(low, high)| {
        Some(Travel { low: low.trim().parse().ok()?, high: high.trim().parse().ok()? })
    });
    parsed.filter(|travel| travel.high - travel.low >= 40).ok_or_else(|| {
        format!("\"{text}\" is no travel: use for example -2000..2000, at least 40 counts wide")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_travel_is_two_counts_with_room_between_them() {
        assert_eq!(parse_travel("-2000..2000"), Ok(Travel { low: -2000, high: 2000 }));
        for wrong in ["2000", "5..1", "a..b", "0..10", ".."] {
            assert!(parse_travel(wrong).is_err(), "{wrong}");
        }
    }
}
