//! The arguments of `brushwork settings`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::{Args, Subcommand};

use super::side_name::SideName;
use crate::examples;
use crate::{ConnectArgs, Replace};

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
    /// Write one number into one register at your own risk, where what it means is not public.
    Raw(RawArgs),
    /// Compare the controller with a profile, or two profiles.
    Diff(DiffArgs),
    /// Save the controller's RAM settings to its EEPROM.
    Save(MemoryArgs),
    /// Restore the controller's factory defaults in RAM.
    Defaults(MemoryArgs),
    /// Make the controller load its EEPROM, then read that; what was in RAM alone is lost.
    Reload(MemoryArgs),
    /// Read the controller's settings into a profile.
    Export(ExportArgs),
    /// Check a profile and write it to the controller (as `write --profile`).
    Import(ImportArgs),
    /// Compare any two of: RAM, EEPROM as last known, a profile, the defaults, a backup.
    Compare(CompareArgs),
    /// List the backups; one is made before every write, restore of defaults and save.
    Backups(BackupsArgs),
    /// Write what a backup holds, after showing the changes.
    Restore(RestoreArgs),
    /// Copy one motor's settings to the other motor.
    CopyMotor(CopyMotorArgs),
    /// Show what was cut short on this controller, setting by setting, and settle it.
    Unfinished(UnfinishedArgs),
    /// Print every setting with unit, range, default and help.
    Reference(ReferenceArgs),
}

impl SettingsAction {
    /// Where it has its controller, if it can go to several.
    pub fn connect_mut(&mut self) -> Option<&mut ConnectArgs> {
        match self {
            Self::Read(args) => Some(&mut args.connect),
            Self::Write(args) => Some(&mut args.connect),
            Self::Diff(args) => Some(&mut args.connect),
            Self::Save(args) | Self::Defaults(args) | Self::Reload(args) => Some(&mut args.connect),
            Self::Export(args) => Some(&mut args.connect),
            Self::Import(args) => Some(&mut args.connect),
            Self::Compare(args) => Some(&mut args.connect),
            Self::Restore(args) => Some(&mut args.connect),
            Self::CopyMotor(args) => Some(&mut args.connect),
            Self::Unfinished(args) => Some(&mut args.connect),
            // A number at its owner's word goes to one at a time; the others have no controller.
            Self::Raw(_) | Self::Backups(_) | Self::Reference(_) => None,
        }
    }

    /// The files that it writes of one controller.
    pub fn files_mut(&mut self) -> Vec<&mut PathBuf> {
        if let Self::Export(args) = self { vec![&mut args.file] } else { Vec::new() }
    }

    /// How it writes, if it shows changes and writes them.
    pub fn how_mut(&mut self) -> Option<&mut WriteHow> {
        match self {
            Self::Write(args) => Some(&mut args.how),
            Self::Import(args) => Some(&mut args.how),
            Self::Restore(args) => Some(&mut args.how),
            Self::CopyMotor(args) => Some(&mut args.how),
            Self::Read(_)
            | Self::Raw(_)
            | Self::Diff(_)
            | Self::Save(_)
            | Self::Defaults(_)
            | Self::Reload(_)
            | Self::Export(_)
            | Self::Compare(_)
            | Self::Backups(_)
            | Self::Unfinished(_)
            | Self::Reference(_) => None,
        }
    }
}

/// Arguments of `brushwork settings compare`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork settings compare ram cart.json -c /dev/ttyACM0\n  \
    brushwork settings compare eeprom ram -c /dev/ttyACM0\n  \
    brushwork settings compare backup default -c /dev/ttyACM0\n  \
    brushwork settings compare old.json new.json\n\n\
    Each side is one of: ram, eeprom (as last known on this computer), default, backup (the newest), \
    backup:NAME, or the path of a profile.")]
pub struct CompareArgs {
    /// The controller; not asked where both sides are files.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// The first side.
    #[arg(value_name = "A")]
    pub left: SideName,
    /// The second side.
    #[arg(value_name = "B")]
    pub right: SideName,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `brushwork settings backups`.
#[derive(Debug, Args)]
pub struct BackupsArgs {
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `brushwork settings restore`.
#[derive(Debug, Args)]
pub struct RestoreArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// The backup's name or the beginning of it; without a name the newest of this controller.
    #[arg(value_name = "BACKUP")]
    pub name: Option<String>,
    /// How to go about it.
    #[command(flatten)]
    pub how: WriteHow,
}

/// Arguments of `brushwork settings copy-motor`.
#[derive(Debug, Args)]
pub struct CopyMotorArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// The motor whose settings are copied to the other one.
    #[arg(value_name = "FROM", value_parser = clap::value_parser!(u8).range(1..=2), default_value = "1")]
    pub from: u8,
    /// How to go about it.
    #[command(flatten)]
    pub how: WriteHow,
}

/// Arguments of `brushwork settings unfinished`.
#[derive(Debug, Args)]
#[allow(clippy::struct_excessive_bools)]
pub struct UnfinishedArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// Write the values that were to come; a save is done again.
    #[arg(long, conflicts_with_all = ["undo", "forget"])]
    pub finish: bool,
    /// Write the values from before.
    #[arg(long, conflicts_with = "forget")]
    pub undo: bool,
    /// Leave the controller as it is and do not tell it any more.
    #[arg(long)]
    pub forget: bool,
    /// Do it without asking.
    #[arg(long, short = 'y')]
    pub yes: bool,
    /// Show the changes and write nothing.
    #[arg(long)]
    pub dry_run: bool,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
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
#[command(after_help = examples::after("settings", &[
    "settings write --connect {sim} motor1.velocity.p=2.5 --yes",
    "settings write --connect /dev/ttyACM0 limits.main_battery.max_volts=28V motor1.velocity.qpps=12000 --dry-run",
], "`brushwork settings read` shows the keys, `brushwork settings reference` explains them."))]
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

/// Arguments of `brushwork settings raw`.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
    brushwork settings raw --connect /dev/ttyACM0 motor1.encoder.pin=2\n  \
    brushwork settings raw --connect /dev/ttyACM0 --undo\n\n\
    For what the vendor's own program sets and no public text explains: the encoder's pin, the pin type of a digital input. It goes out with the \
    command that carries the setting, its other fields as they are, and is read back. A backup is kept first, and `brushwork examine` \
    reports it. Nothing else writes such a number, not an import and not a restore.")]
pub struct RawArgs {
    /// The controller.
    #[command(flatten)]
    pub connect: ConnectArgs,
    /// The setting and the number, decimal or 0x.
    #[arg(value_name = "KEY=NUMBER", required_unless_present = "undo")]
    pub number: Option<RawNumber>,
    /// Write the number from before the newest one that was written to this controller.
    #[arg(long, conflicts_with = "number")]
    pub undo: bool,
    /// Write it without asking: you answer for what it does.
    #[arg(long)]
    pub own_risk: bool,
    /// Show the change, the command and its bytes, and write nothing.
    #[arg(long)]
    pub dry_run: bool,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
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

/// Which part of writing is done now: all of it, or one of the two rounds that several controllers are written in.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Round {
    /// Show, ask and write.
    #[default]
    Whole,
    /// Show the changes, and nothing else.
    Review,
    /// Write what was shown and agreed to.
    Agreed,
}

/// How settings are written.
#[derive(Debug, Default, Args)]
#[allow(clippy::struct_excessive_bools)]
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
    /// Of a profile or backup, take only keys that begin with this, for example motor1; may be given again.
    #[arg(long, value_name = "KEY")]
    pub only: Vec<String>,
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
    /// Whether it goes to several controllers, of which each keeps its address.
    #[arg(skip)]
    pub several: bool,
    /// Which part of it is done now.
    #[arg(skip)]
    pub round: Round,
}

impl WriteHow {
    /// Whether it needs no answer now.
    pub fn is_agreed(&self) -> bool {
        self.yes || self.round == Round::Agreed
    }

    /// Whether nothing is written now.
    pub fn only_shows(&self) -> bool {
        self.dry_run || self.round == Round::Review
    }
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
    /// The profile to write; with --force an existing one is replaced, whole or not at all.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Whether an older profile is replaced.
    #[command(flatten)]
    pub replace: Replace,
}

/// Arguments of `brushwork settings reference`.
#[derive(Debug, Args)]
pub struct ReferenceArgs {
    /// Print JSON.
    #[arg(long)]
    pub json: bool,
}

/// One KEY=NUMBER as it was typed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RawNumber {
    /// The setting's key.
    pub key: String,
    /// What its register is to hold.
    pub raw: i64,
}

impl FromStr for RawNumber {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let assignment: Assignment = text.parse()?;
        let hex = assignment.value.strip_prefix("0x").map(|digits| i64::from_str_radix(digits, 16));
        match hex.unwrap_or_else(|| assignment.value.parse()) {
            Ok(raw) => Ok(Self { key: assignment.key, raw }),
            Err(_) => Err(format!("\"{}\" is no whole number: use for example 2 or 0x02", assignment.value)),
        }
    }
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
