//! Arguments of `brushwork macro`.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Subcommand};

use crate::new_file::Replace;
use crate::shared_args::{ConnectArgs, parse_seconds};

/// Arguments of `brushwork macro`.
#[derive(Debug, Args)]
pub struct MacroArgs {
    /// What to do.
    #[command(subcommand)]
    pub command: MacroCommand,
}

/// What can be done with macro files.
#[derive(Debug, Subcommand)]
pub enum MacroCommand {
    /// Look for errors.
    Check(CheckArgs),
    /// Bring files into one style.
    Fmt(FmtArgs),
    /// Run a macro on a simulated controller in virtual time.
    Run(RunArgs),
    /// Store the macros of a file on a controller, and read them back.
    Upload(UploadArgs),
    /// Write a file of the macros that a controller has.
    Read(ReadArgs),
}

/// Arguments of `brushwork macro upload`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork macro upload slide.macros --connect /dev/ttyUSB0,family=suprmotr --address 3\n\n\
    Macros of other numbers stay. Nothing runs of it, but macro 0 will at the next power-up. A controller whose macro runs is left alone.\n\
    Ends with 0 when all were stored and read back, with 9 when the file has errors, with 5 when one was not stored.")]
pub struct UploadArgs {
    /// A macro file; - is standard input.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
}

/// Arguments of `brushwork macro read`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork macro read slide.macros --connect /dev/ttyUSB0,family=suprmotr --address 3\n  \
    brushwork macro read - --connect sim:suprmotr-v9\n\n\
    A file that --force replaces gives its names to the macros of the same numbers; its comments are lost.")]
pub struct ReadArgs {
    /// The file; - is standard output.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// Whether an older file is replaced.
    #[command(flatten)]
    pub replace: Replace,
}

/// Arguments of `brushwork macro check`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork macro check slide.macros\n  \
    brushwork macro check --json *.macros\n\n\
    A file has macros by name, with comments:\n\n  \
    # To and fro.\n  \
    const FAR = 2000\n\n  \
    macro shuttle = 3\n      \
    MA 0, WS 500\n      \
    MA FAR, WS 500\n      \
    RP 9\n\n\
    macro NAME begins a macro; = NUMBER gives it a place of 0 to 14, else it takes the lowest that is free from 1 on. Macro 0 runs at power-up.\n\
    The commands are the controller's own, 15 at most; MC takes a name. Ends with 0 when no file has an error, with 9 when one has, with 1 when one\n\
    cannot be read.\n\n\
    JSON is {\"files\": [{\"file\", \"ok\", \"errors\", \"warnings\", \"diagnostics\": [...], \"macros\": [{\"number\", \"name\", \"line\"}]}]}.")]
pub struct CheckArgs {
    /// Macro files; - is standard input.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Print JSON: every file with its diagnostics and the lines that define its macros.
    #[arg(long)]
    pub json: bool,
    /// End with 9 for warnings too.
    #[arg(long)]
    pub deny_warnings: bool,
}

/// Arguments of `brushwork macro fmt`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork macro fmt slide.macros\n  \
    brushwork macro fmt --check *.macros     ends with 6 when one would change\n\n\
    A file with errors is left as it is, and ends it with 9.")]
pub struct FmtArgs {
    /// Macro files, which are rewritten; - formats standard input to standard output.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Write nothing; name the files that would change.
    #[arg(long)]
    pub check: bool,
}

/// Arguments of `brushwork macro run`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork macro run slide.macros\n  \
    brushwork macro run slide.macros --macro home --for 20\n\n\
    Prints each command with its time, its place in the file and the position, and what the controller reports.\n\
    Ends with 0 when all is done or the time is up, with 9 when the file has errors, with 10 when the controller refused a command or let the motor go.")]
pub struct RunArgs {
    /// A macro file; - is standard input.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// The macro that is run, by name or number; if not given the one of number 0, or the first of the file.
    #[arg(long = "macro", value_name = "NAME")]
    pub of: Option<String>,
    /// How long it runs at most, in the controller's time.
    #[arg(long = "for", value_name = "SECONDS", default_value = "10", value_parser = parse_seconds)]
    pub time: Duration,
    /// Motor preset; the slide if none is named.
    #[arg(long, value_name = "PRESET")]
    pub preset: Option<String>,
}
