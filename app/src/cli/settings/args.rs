//! The arguments of `brushwork settings`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, Subcommand};

use crate::cli::args::ConnectArgs;

/// Arguments of `brushwork settings`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork settings read --connect /dev/ttyACM0 motor1\n  \
    brushwork settings write --connect /dev/ttyACM0 motor1.velocity.qpps=12000 --dry-run\n\n\
    `brushwork settings help ACTION` has more.")]
pub struct SettingsArgs {
    /// What to do.
    #[command(subcommand)]
    pub action: SettingsAction,
}

/// What to do with the settings.
#[derive(Debug, Subcommand)]
pub enum SettingsAction {
    /// Read the settings in the controller's RAM.
    Read(ReadArgs),
    /// Show what would change, write it to RAM, read it back and name what did not take.
    Write(WriteArgs),
    /// Compare the controller with a profile, or two profiles.
    Diff(DiffArgs),
    /// Save the controller's RAM settings to its EEPROM.
    Save(MemoryArgs),
    /// Restore the controller's factory defaults in RAM.
    Defaults(MemoryArgs),
    /// Read the controller's settings into a profile.
    Export(ExportArgs),
    /// Check a profile and write it to the controller (as `write --profile`).
    Import(ImportArgs),
    /// Print every setting with unit, range, default and help.
    Reference(ReferenceArgs),
}

/// Arguments of `brushwork settings read`.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  brushwork settings read --connect /dev/ttyACM0 motor1 limits.main_battery"
)]
pub struct ReadArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// Only keys that begin with one of these, for example motor1 or pin.3.
    #[arg(value_name = "KEY")]
    pub keys: Vec<String>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `brushwork settings write`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork settings write --connect sim:mcp266 motor1.velocity.p=2.5 --yes\n  \
    brushwork settings write --connect /dev/ttyACM0 limits.main_battery.max_volts=28V motor1.velocity.qpps=12000 --dry-run\n\n\
    `brushwork settings read` shows the keys, `brushwork settings reference` explains them.")]
pub struct WriteArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// Settings to change, each value in the setting's unit.
    #[arg(value_name = "KEY=VALUE", required_unless_present = "profile")]
    pub changes: Vec<Assignment>,
    /// Write what this profile says; changes given besides win over it.
    #[arg(long, value_name = "FILE")]
    pub profile: Option<PathBuf>,
    /// How to go about it.
    #[command(flatten)]
    pub how: WriteHow,
}

/// Arguments of `brushwork settings import`.
#[derive(Debug, Args)]
pub struct ImportArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// The profile to read.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// How to go about it.
    #[command(flatten)]
    pub how: WriteHow,
}

/// How settings are written.
#[derive(Debug, Args)]
pub struct WriteHow {
    /// Write without asking.
    #[arg(long, short = 'y')]
    pub yes: bool,
    /// Show the changes, the commands and their bytes, and write nothing.
    #[arg(long)]
    pub dry_run: bool,
    /// Save to EEPROM when everything took.
    #[arg(long)]
    pub save: bool,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `brushwork settings diff`.
#[derive(Debug, Args)]
pub struct DiffArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// One profile is compared with the controller's RAM, two with each other.
    #[arg(value_name = "PROFILE", num_args = 1..=2, required = true)]
    pub profiles: Vec<PathBuf>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `brushwork settings save` and `defaults`.
#[derive(Debug, Args)]
pub struct MemoryArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// Do it without asking.
    #[arg(long, short = 'y')]
    pub yes: bool,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `brushwork settings export`.
#[derive(Debug, Args)]
pub struct ExportArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// The profile to write; an existing one is replaced whole or not at all.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
}

/// Arguments of `brushwork settings reference`.
#[derive(Debug, Args)]
pub struct ReferenceArgs {
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// One KEY=VALUE as it was typed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Assignment {
    /// The setting's key.
    pub key: String,
    /// The value's text.
    pub value: String,
}

impl FromStr for Assignment {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some((key, value)) if !key.trim().is_empty() => {
                Ok(Self { key: key.trim().to_owned(), value: value.trim().to_owned() })
            }
            _ => Err(format!("\"{text}\" is no KEY=VALUE: use for example motor1.velocity.p=2.5")),
        }
    }
}
