//! The command line: everything that can be done without a window.
//!
//! [`run`] reads the arguments and hands over to one file per command; what a family of controllers adds stands in its folder. Commands
//! talk to controllers through [`brushwork_core::session`] like the window does; they print data on standard output and words on
//! standard error.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

mod address;
mod addresses;
pub mod args;
mod client;
mod drive;
mod examine;
pub mod examples;
mod exit;
pub mod family;
pub mod guardian;
pub mod interrupt;
mod joined;
mod list;
pub mod mcp;
pub mod mecc;
mod messages;
mod monitor;
pub mod motion_mind;
pub mod new_file;
mod nodes;
pub mod output;
mod protocol;
mod readings;
mod response;
mod scripts;
pub mod settings;
pub mod shared_args;
mod sim;
mod status;
mod stop;
pub mod suprmotr;
mod terminal;
mod tool;
pub mod tune;
mod units;
mod work;

use crate::messages::CliLinkMessage;
use std::process::ExitCode;

use clap::{ArgMatches, CommandFactory as _, FromArgMatches as _};

use args::{Cli, Command, WindowArgs};
pub use exit::Exit;
pub use tool::Tool;

pub use brushwork_core::addresses::AddressList;
pub use client::Client;
pub use family::{Family, Page, Simulated};
pub use interrupt::Interrupt;
pub use new_file::{NewFile, Replace};
pub use output::{Output, OutputError, say};
pub use readings::Readings;
pub use shared_args::{ConnectArgs, parse_seconds};

/// Runs the program: a command, or the window where none is given. `open_window` returns when the window is closed, or says in a sentence
/// why there is none.
pub fn run(
    open_window: impl FnOnce(&WindowArgs) -> Result<(), String>,
    tools: impl IntoIterator<Item = Tool>,
) -> ExitCode {
    let tools: Vec<Tool> = commands_of_families().chain(tools).collect();
    let matches = with_commands(&tools).get_matches();
    let tool = matches.subcommand().and_then(|(name, arguments)| {
        Some((tools.iter().find(|tool| tool.command.get_name() == name)?, arguments))
    });
    if let Some((tool, arguments)) = tool {
        return with_interrupt(|out, interrupt| tool.run(arguments, out, interrupt));
    }
    let cli = Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    let Some((command, (_, typed))) = cli.command.zip(matches.subcommand()) else {
        return match open_window(&cli.window) {
            Ok(()) => Exit::Done.into(),
            Err(error) => Exit::Failed.saying(error).into(),
        };
    };
    with_interrupt(|out, interrupt| units::run(command, typed, out, interrupt))
}

/// The command line as it is packaged, for those who make manual pages and completions of it. Families are to be installed before.
#[must_use]
pub fn command_line() -> clap::Command {
    with_commands(&commands_of_families().collect::<Vec<_>>())
}

/// The commands of families.
fn commands_of_families() -> impl Iterator<Item = Tool> {
    family::families().iter().flat_map(|family| family.commands())
}

fn with_commands(tools: &[Tool]) -> clap::Command {
    tools.iter().fold(Cli::command(), |cli, tool| cli.subcommand(tool.command.clone()))
}

fn with_interrupt(run: impl FnOnce(&mut Output, &Interrupt) -> Result<Exit, Exit>) -> ExitCode {
    match Interrupt::install_for_command() {
        Ok(interrupt) => run(&mut Output::stdout(), &interrupt).unwrap_or_else(|exit| exit),
        Err(error) => Exit::Failed.saying(CliLinkMessage::NoCtrlC { error: error.to_string() }),
    }
    .into()
}

fn dispatch(
    command: &Command,
    typed: &ArgMatches,
    out: &mut Output,
    interrupt: &Interrupt,
) -> Result<Exit, Exit> {
    match command {
        Command::List(args) => list::run(args, out, interrupt),
        Command::Nodes(args) => nodes::run(args, out, interrupt),
        Command::Status(args) => status::run(args, out, interrupt),
        Command::Address(args) => address::run(args, out, interrupt),
        Command::Drive(args) => drive::run(args, out, interrupt),
        Command::Examine(args) => examine::run(args, out, interrupt),
        Command::Stop(args) => stop::run(args, out, interrupt),
        Command::Settings(args) => settings::run(args, out, interrupt),
        Command::Sim(args) => sim::run(args, typed, out, interrupt),
        Command::Terminal(args) => terminal::run(args, out, interrupt),
        Command::Protocol(args) => protocol::run(args, out),
        Command::Monitor(args) => monitor::run(args, out, interrupt),
        Command::Tune(args) => Ok(tune::run(args, out, interrupt)),
    }
}
