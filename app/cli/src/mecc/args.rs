//! Arguments of `brushwork mecc`.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Subcommand};

use crate::new_file::Replace;
use crate::shared_args::{ConnectArgs, parse_time};

/// Arguments of `brushwork mecc`.
#[derive(Debug, Args)]
pub struct MeccArgs {
    /// What to do.
    #[command(subcommand)]
    pub command: MeccCommand,
}

/// What can be done with programs.
#[derive(Debug, Subcommand)]
pub enum MeccCommand {
    /// Look for errors.
    Check(CheckArgs),
    /// Run a program on a simulated board in virtual time.
    Run(RunArgs),
    /// Start the program in a board's memory.
    Start(StartArgs),
    /// Bring programs into one style.
    Fmt(FmtArgs),
    /// Print the language reference.
    Reference(ReferenceArgs),
}

/// Arguments of `brushwork mecc check`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork mecc check crane.mecc\n  \
    cat crane.mecc | brushwork mecc check --json -\n\n\
    Ends with 0 when no file has an error, with 9 when one has, with 1 when one cannot be read. A program has at most 2 MiB.\n\
    JSON is as that of brushwork mcl check.")]
pub struct CheckArgs {
    /// Programs; - is standard input.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Print JSON: every file with its diagnostics.
    #[arg(long)]
    pub json: bool,
    /// End with 9 for warnings too.
    #[arg(long)]
    pub deny_warnings: bool,
}

/// Arguments of `brushwork mecc run`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork mecc run flash.mecc --limit 10\n  \
    brushwork mecc run echo.mecc --send 1:I001002003 --send 2.5:I048\n  \
    brushwork mecc run crane.mecc --input 3:3=on --trace crane.jsonl\n\n\
    Standard output carries the frames that the program transmits, one to a line, when they are out, and nothing else.\n\
    A line of a trace is {\"t\": seconds, \"event\": \"display\", \"text\": \"OO\"}; other events are beep, motor, stepper, servo, timer, debug,\n\
    transmit, receive, input, end and fault. Ends with 0 at End Program or the limit, with 9 when the program has errors, with 10\n\
    when it cannot go on.\n\n\
    Compiled programs run on simulated boards alone: the byte code of the real one is not public.")]
pub struct RunArgs {
    /// A program; - is standard input.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// How long it runs at most, in the board's time.
    #[arg(long, value_name = "SECONDS", default_value = "60", value_parser = parse_time)]
    pub limit: Duration,
    /// A line for the board's serial port, and when it begins to arrive; the carriage return is put behind it.
    #[arg(long, value_name = "SECONDS:TEXT", value_parser = parse_sent)]
    pub send: Vec<(Duration, String)>,
    /// An on/off input that changes, and when.
    #[arg(long, value_name = "SECONDS:INPUT=on|off", value_parser = parse_input)]
    pub input: Vec<(Duration, usize, bool)>,
    /// Where a trace goes: lines of JSON.
    #[arg(long, value_name = "FILE")]
    pub trace: Option<PathBuf>,
    /// Whether a file that holds something else than a trace is replaced.
    #[command(flatten)]
    pub replace: Replace,
    /// Print no warnings.
    #[arg(long, short = 'q')]
    pub quiet: bool,
}

/// Arguments of `brushwork mecc start`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork mecc start --connect /dev/ttyUSB0,family=motorvator\n  \
    brushwork mecc start --connect /dev/ttyUSB0,family=motorvator --yes\n\n\
    The board begins its program with the line G. If that is the host library (assets/mecc/host.mecc), the board is driven from here afterwards.\n\
    Any other may move motors at once, and nothing on the line stops it.")]
pub struct StartArgs {
    /// The board.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// Start without asking.
    #[arg(long)]
    pub yes: bool,
}

/// Arguments of `brushwork mecc fmt`.
#[derive(Debug, Args)]
pub struct FmtArgs {
    /// Programs, which are rewritten; - formats standard input to standard output.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Write nothing; name the files that would change, and end with 6 if there is one.
    #[arg(long)]
    pub check: bool,
}

/// Arguments of `brushwork mecc reference`.
#[derive(Debug, Args)]
pub struct ReferenceArgs {
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

fn parse_sent(text: &str) -> Result<(Duration, String), String> {
    let (time, line) = text.split_once(':').ok_or("write SECONDS:TEXT, as in 1.5:I001002003")?;
    if !line.is_ascii() || line.contains(['\r', '\n']) {
        return Err(
            "the text is one line of ASCII characters; the carriage return is put behind it".to_owned()
        );
    }
    Ok((parse_time(time)?, line.to_owned()))
}

fn parse_input(text: &str) -> Result<(Duration, usize, bool), String> {
    let wrong = "write SECONDS:INPUT=on or off, as in 2:3=on";
    let (time, rest) = text.split_once(':').ok_or(wrong)?;
    let (input, state) = rest.split_once('=').ok_or(wrong)?;
    let input = input.parse().ok().filter(|input| (1..=4).contains(input)).ok_or("the inputs are 1 to 4")?;
    let is_on = match state {
        "on" | "1" => true,
        "off" | "0" => false,
        _ => return Err(wrong.to_owned()),
    };
    Ok((parse_time(time)?, input, is_on))
}
