//! Arguments of `brushwork mcl`.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Subcommand};

use crate::new_file::Replace;
use crate::shared_args::{ScriptBuses, parse_time};

/// Arguments of `brushwork mcl`.
#[derive(Debug, Args)]
pub struct MclArgs {
    /// What to do.
    #[command(subcommand)]
    pub command: MclCommand,
}

/// What can be done with scripts.
#[derive(Debug, Subcommand)]
pub enum MclCommand {
    /// Look for errors.
    Check(CheckArgs),
    /// Compile into images for simulated controllers.
    Build(BuildArgs),
    /// Run a script on a simulated controller in virtual time.
    Run(RunArgs),
    /// List the instructions of a script or an image.
    Disasm(DisasmArgs),
    /// Bring scripts into one style.
    Fmt(FmtArgs),
    /// Print the language reference.
    Reference(ReferenceArgs),
}

/// Arguments of `brushwork mcl check`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork mcl check door.mcl\n  \
    brushwork mcl check --json scripts/*.mcl\n  \
    cat door.mcl | brushwork mcl check -\n\n\
    Ends with 0 when no file has an error, with 9 when one has, with 1 when one cannot be read. A script has at most 2 MiB.\n\
    The first 100 errors and 100 warnings of a file are listed; E319 and W423 say how many more there are.\n\n\
    JSON is {\"files\": [{\"file\", \"ok\", \"errors\", \"warnings\", \"diagnostics\": [...]}]}. A diagnostic has \"code\" (see brushwork mcl\n\
    reference), \"severity\" (error or warning), \"line\" and \"column\" from 1 in characters, \"end\" with both of the place after it,\n\
    \"message\", and \"hint\" where there is one.")]
pub struct CheckArgs {
    /// Scripts; - is standard input.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Print JSON: every file with its diagnostics.
    #[arg(long)]
    pub json: bool,
    /// End with 9 for warnings too.
    #[arg(long)]
    pub deny_warnings: bool,
}

/// Arguments of `brushwork mcl build`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork mcl build door.mcl                 writes door.mcli\n  \
    brushwork mcl build door.mcl -o image.mcli\n  \
    brushwork mcl build --json *.mcl")]
pub struct BuildArgs {
    /// Scripts; - is standard input.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Where the image of the one script goes; - is standard output. Otherwise beside the script, ending in .mcli.
    #[arg(long, short = 'o', value_name = "IMAGE")]
    pub output: Option<PathBuf>,
    /// Whether an older image is replaced.
    #[command(flatten)]
    pub replace: Replace,
    /// Print JSON: every file with its diagnostics, its size and the models it fits.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `brushwork mcl run`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork mcl run count.mcl\n  \
    echo 42 | brushwork mcl run ask.mcl\n  \
    brushwork mcl run --model mcp2163 --preset flywheel --limit 5s spin.mcl\n  \
    brushwork mcl run --i2c mpu6050 --can-peer echo buses.mcl\n\n\
    Standard output carries the bytes of the script's stream and nothing else; standard input is what the script reads there.\n\
    Ends with 0 at END, STOP or the limit, with 9 when the script has errors, with 10 when it stops by a fault.")]
pub struct RunArgs {
    /// A script or an image; - is a script on standard input, which then has nothing to read.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// How long it runs at most, in the controller's time.
    #[arg(long, value_name = "TIME", default_value = "60s", value_parser = parse_time)]
    pub limit: Duration,
    /// The stream that is printed and that standard input feeds, as GETS and PUTS number it: 0 USB, 2 TTL, 3 RS-232.
    #[arg(long, value_name = "0|2|3", default_value_t = 0, value_parser = parse_stream)]
    pub stream: u8,
    /// Controller model.
    #[arg(long, value_name = "MODEL", default_value = "mcp266")]
    pub model: String,
    /// Motor preset; two, separated by a comma, give motor 1 and motor 2 different ones.
    #[arg(long, value_name = "PRESET", value_delimiter = ',', num_args = 1)]
    pub preset: Vec<String>,
    /// What it finds on its buses.
    #[command(flatten)]
    pub buses: ScriptBuses,
    /// Seed of noise.
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Print no warnings.
    #[arg(long, short = 'q')]
    pub quiet: bool,
    /// Tell at the end, on standard error, how it ended: state, line, controller time, instructions.
    #[arg(long)]
    pub report: bool,
}

/// Arguments of `brushwork mcl disasm`.
#[derive(Debug, Args)]
pub struct DisasmArgs {
    /// Scripts or images; - is a script on standard input.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
}

/// Arguments of `brushwork mcl fmt`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork mcl fmt scripts/*.mcl\n  \
    brushwork mcl fmt --check scripts/*.mcl     ends with 6 when one would change\n  \
    brushwork mcl fmt - <door.mcl")]
pub struct FmtArgs {
    /// Scripts, which are rewritten; - formats standard input to standard output.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Write nothing; name the files that would change.
    #[arg(long)]
    pub check: bool,
}

/// Arguments of `brushwork mcl reference`.
#[derive(Debug, Args)]
pub struct ReferenceArgs {
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

fn parse_stream(text: &str) -> Result<u8, String> {
    match text {
        "0" | "2" | "3" => Ok(text.as_bytes()[0] - b'0'),
        _ => Err("use 0 for USB, 2 for TTL or 3 for RS-232".to_owned()),
    }
}
