//! Arguments of `brushwork script`.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Subcommand};

use crate::shared_args::{ConnectArgs, parse_seconds};

/// Arguments of `brushwork script`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork script start door.mcl --connect sim:mcp266 --for 10\n  \
    brushwork script download door.mcli --connect /dev/ttyACM0\n  \
    brushwork script autorun 500 --connect /dev/ttyACM0\n  \
    brushwork script status --json\n\n\
    The byte code of real controllers is not public: they are sent files that the maker's tool compiled, and nothing else.\n\
    What Brushwork compiles runs on simulated controllers.")]
pub struct ScriptArgs {
    /// What to do.
    #[command(subcommand)]
    pub command: ScriptCommand,
}

/// What can be done with a controller's script.
#[derive(Debug, Subcommand)]
pub enum ScriptCommand {
    /// Write a compiled script, or a .mcl file, into the controller's script memory.
    Download(DownloadArgs),
    /// Start the script and stop it, with both motors, on the way out.
    Start(StartArgs),
    /// Stop the script and both motors.
    Stop(StopArgs),
    /// Tell or set whether the script runs by itself after power-up.
    Autorun(AutorunArgs),
    /// Tell what is known of the script.
    Status(StatusArgs),
}

/// Arguments of `brushwork script download`.
#[derive(Debug, Args)]
pub struct DownloadArgs {
    /// A script (.mcl), which is compiled, or a compiled file.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// The controller is simulated by another program, such as `brushwork sim`: what Brushwork compiles is sent to it.
    #[arg(long)]
    pub simulated: bool,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `brushwork script start`.
#[derive(Debug, Args)]
#[command(
    after_help = "The script is stopped, and both motors with it, when the time is over, on Ctrl-C, SIGTERM, SIGHUP, a closed pipe, a \
    fault or a lost link. To let one run on its own, set autorun."
)]
pub struct StartArgs {
    /// Download this first.
    #[arg(value_name = "FILE")]
    pub file: Option<PathBuf>,
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// How long it may run (default: until interrupted).
    #[arg(long = "for", value_name = "SECONDS", value_parser = parse_seconds)]
    pub duration: Option<Duration>,
    /// The controller is simulated by another program.
    #[arg(long)]
    pub simulated: bool,
}

/// Arguments of `brushwork script stop`.
#[derive(Debug, Args)]
pub struct StopArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
}

/// Arguments of `brushwork script autorun`.
#[derive(Debug, Args)]
#[command(
    after_help = "It is set in the controller's RAM and forgotten with its power, unless `brushwork settings save` saves the settings."
)]
pub struct AutorunArgs {
    /// Time after power-up at which the script starts, in ms, 100 or more; or off. Left out, it is told.
    #[arg(value_name = "MS|off", value_parser = parse_delay)]
    pub delay: Option<Delay>,
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `brushwork script status`.
#[derive(Debug, Args)]
pub struct StatusArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// When a script starts by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Delay(pub Option<Duration>);

fn parse_delay(text: &str) -> Result<Delay, String> {
    if text.eq_ignore_ascii_case("off") {
        return Ok(Delay(None));
    }
    match text.parse::<u32>() {
        Ok(ms) if ms >= 100 => Ok(Delay(Some(Duration::from_millis(ms.into())))),
        _ => Err(format!("\"{text}\" is no delay: use 100 or more milliseconds, or off")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_delay_below_100_ms_would_switch_autorun_off_and_is_refused() {
        assert_eq!(parse_delay("OFF"), Ok(Delay(None)));
        assert_eq!(parse_delay("100"), Ok(Delay(Some(Duration::from_millis(100)))));
        assert!(parse_delay("99").is_err() && parse_delay("soon").is_err());
    }
}
