//! Arguments of `brushwork tune`.

use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};

use crate::{ConnectArgs, Replace};

/// Arguments of `brushwork tune`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork tune velocity --motor 1 --dry-run --report run.json\n  \
    brushwork tune velocity --motor 1 --method relay --about 40 --report run.html\n  \
    brushwork tune position --motor 1 --method piv --travel -2000..2000 --max-current 10 --apply\n  \
    brushwork tune replay run.json\n\n\
    The motor turns both ways at up to full duty (--max-duty), or within --travel at less. Ctrl-C stops both motors at once and \
    puts the old gains back. A report is written whatever the verdict.\n\n\
    Exit codes:\n  \
    0  TUNED\n  \
    8  TUNED WITH WARNINGS: gains were found, with something to know about them\n  \
    4  REFUSED, with the cause; the old gains are in force\n  \
    1  the report could not be written, or a replay differs from its report\n  \
    2  the command line could not be understood\n  \
    3  no controller could be reached, or the link was lost\n  \
    5  the gains are in RAM, but saving them to EEPROM did not take\n  \
    11  this computer or the line answered late, also where it was tried again: nothing is known of the motor; the old gains are in force\n  \
    130  ended by Ctrl-C or another signal, after both motors were stopped and the old gains put back\n\
    A replay ends with the code of the verdict in its report.")]
pub struct TuneArgs {
    /// What to do.
    #[command(subcommand)]
    pub command: TuneCommand,
}

/// What `brushwork tune` does.
#[derive(Debug, Subcommand)]
pub enum TuneCommand {
    /// Tune the velocity loop of a motor that may turn freely.
    Velocity(VelocityArgs),
    /// Tune a position loop.
    Position(PositionArgs),
    /// Compute the gains of a report again from its raw record.
    Replay {
        /// The report.
        report: PathBuf,
        /// Print JSON.
        #[arg(long)]
        json: bool,
    },
}

impl TuneCommand {
    /// The run, where it is one and no replay.
    pub fn run_mut(&mut self) -> Option<&mut RunArgs> {
        match self {
            Self::Velocity(args) => Some(&mut args.run),
            Self::Position(args) => Some(&mut args.run),
            Self::Replay { .. } => None,
        }
    }
}

/// A run of the velocity loop.
#[derive(Debug, Args)]
pub struct VelocityArgs {
    /// How the motor is identified, and whose gains are proposed.
    #[arg(long, value_enum, default_value_t = IdentificationArg::Fit)]
    pub method: IdentificationArg,
    /// Duty about which step, relay or the controller's own test works, in percent.
    #[arg(long, value_name = "PERCENT", default_value_t = 50, value_parser = clap::value_parser!(u8).range(10..=90))]
    pub about: u8,
    /// The rest.
    #[command(flatten)]
    pub run: RunArgs,
}

/// A run of a position loop.
#[derive(Debug, Args)]
pub struct PositionArgs {
    /// Form of the loop; fit, step and relay stand for PIV, or PID where a controller has no such loop, identified so.
    #[arg(long, value_enum, default_value_t = MethodArg::Fit)]
    pub method: MethodArg,
    /// How the motor of a PD, PID or PIV loop is identified, and whose gains are proposed.
    #[arg(long, value_enum, default_value_t = PositionIdentificationArg::Fit)]
    pub identify: PositionIdentificationArg,
    /// Duty about which a step works, in percent. A relay works about where the axis stands.
    #[arg(long, value_name = "PERCENT", default_value_t = 50, value_parser = clap::value_parser!(u8).range(10..=90))]
    pub about: u8,
    /// The axis has no end stops: it is driven at up to full duty both ways. Position limits of 0 to 0, within which it could not move, become
    /// those of a minute at full speed to either side of where it stands.
    #[arg(long, conflicts_with = "travel")]
    pub turns_freely: bool,
    /// The rest.
    #[command(flatten)]
    pub run: RunArgs,
}

/// How a motor is identified.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum IdentificationArg {
    /// A model fitted to several motions up to full duty; gains searched for on it.
    Fit,
    /// One step about a duty (--about), never more, to and fro within --travel; gains by SIMC.
    Step,
    /// A relay about the speed of a duty (--about), never more, within --travel about where the axis stands; gains by Tyreus-Luyben.
    Relay,
    /// The controller's own relay test about that speed, beside a fitted model; gains by Tyreus-Luyben. Simulated MCPs and RoboClaws only: how a real one
    /// does it is not public.
    Controller,
}

/// How the motor of a position loop is identified.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PositionIdentificationArg {
    /// A model fitted to several motions; gains searched for on it.
    Fit,
    /// A step about a duty (--about), to and fro within --travel; gains by SIMC.
    Step,
    /// A relay about where the axis stands; gains by Tyreus-Luyben, of a PD loop by Ziegler-Nichols.
    Relay,
    /// The controller's own relay test about where the axis stands, beside a fitted model, for pd and pid; gains as by a relay. Simulated MCPs and RoboClaws
    /// only: how a real one does it is not public.
    Controller,
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
    /// From 0 (soft) to 100 (stiff).
    #[arg(long, default_value_t = 50, value_parser = clap::value_parser!(u8).range(0..=100))]
    pub level: u8,
    /// Counts of the encoder between which the axis may move: it goes to the middle if it must, and never at full speed.
    #[arg(long, value_name = "LOW..HIGH", allow_hyphen_values = true, value_parser = parse_travel)]
    pub travel: Option<Travel>,
    /// Highest motor current in amperes: the controller's limit is lowered to it for the run.
    #[arg(long, value_name = "AMPS", value_parser = parse_amps)]
    pub max_current: Option<f64>,
    /// Clear inductance and resistance for the run where both are set, since duty is a current then; they are put back.
    #[arg(long)]
    pub clear_lr: bool,
    /// Highest duty in percent.
    #[arg(long, value_name = "PERCENT", default_value_t = 100, value_parser = clap::value_parser!(u8).range(20..=100))]
    pub max_duty: u8,
    /// What the encoder is, where the controller's settings do not say it (whether an absolute one wraps, they never do).
    #[arg(long, value_enum)]
    pub encoder: Option<EncoderArg>,
    /// Leave the new gains in force (RAM).
    #[arg(long, conflicts_with = "dry_run")]
    pub apply: bool,
    /// Leave them in force and save all settings to EEPROM.
    #[arg(long, conflicts_with = "dry_run")]
    pub save: bool,
    /// Only propose them; this is the default.
    #[arg(long)]
    pub dry_run: bool,
    /// Write the report to a file: with its raw record, or as one page with plots where the name ends in .html.
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,
    /// Whether an older report is replaced.
    #[command(flatten)]
    pub replace: Replace,
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
    /// P over the velocity loop, where the controller has one.
    Piv,
    /// PIV; PID where the controller has no velocity loop under its position loop.
    Fit,
    /// The same loop, by a step.
    Step,
    /// The same loop, by a relay.
    Relay,
    /// Asked for by `--method pd` or `pid` with `--identify controller`.
    #[value(hide = true)]
    Controller,
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

/// The narrowest travel, counts.
const LEAST_TRAVEL: i64 = 40;

fn parse_travel(text: &str) -> Result<Travel, String> {
    let parsed = text.split_once("..").and_then(|(low, high)| {
        Some(Travel { low: low.trim().parse().ok()?, high: high.trim().parse().ok()? })
    });
    let in_range = |counts: i64| i32::try_from(counts).is_ok();
    let sound = |travel: &Travel| {
        in_range(travel.low) && in_range(travel.high) && travel.high - travel.low >= LEAST_TRAVEL
    };
    parsed.filter(sound).ok_or_else(|| {
        format!(
            "\"{text}\" is no travel: use for example -2000..2000, from the lower to the higher count, at least {LEAST_TRAVEL} \
             counts wide"
        )
    })
}

fn parse_amps(text: &str) -> Result<f64, String> {
    let amps = text.trim().trim_end_matches(['A', 'a']).trim_end().parse::<f64>().ok();
    amps.filter(|amps| (0.05..=1000.0).contains(amps))
        .ok_or_else(|| format!("\"{text}\" is no current: use amperes from 0.05 to 1000, for example 10"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_current_is_in_amperes_above_nought() {
        assert_eq!(parse_amps("10"), Ok(10.0));
        assert_eq!(parse_amps("2.5A"), Ok(2.5));
        for wrong in ["0", "-3", "nan", "inf", "ten", ""] {
            assert!(parse_amps(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_travel_is_two_counts_with_room_between_them() {
        assert_eq!(parse_travel("-2000..2000"), Ok(Travel { low: -2000, high: 2000 }));
        for wrong in ["2000", "5..1", "a..b", "0..10", "..", "0..99999999999"] {
            assert!(parse_travel(wrong).is_err(), "{wrong}");
        }
    }
}
