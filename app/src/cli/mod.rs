//! The command line: everything that can be done without a window.
//!
//! [`run`] reads the arguments and hands over to one file per command. Commands talk to controllers through
//! [`crate::session`] like the window does; they print data on standard output and words on standard error.

pub mod args;
#[cfg(feature = "bench")]
mod bench;
mod client;
mod drive;
mod exit;
mod firmware;
mod interrupt;
mod list;
mod mcl;
mod monitor;
mod new_file;
mod nodes;
mod output;
mod protocol;
mod response;
mod script;
pub mod settings;
pub mod shared_args;
mod sim;
mod status;
mod stop;
mod terminal;
pub mod tune;

use std::process::ExitCode;

use clap::Parser as _;

use crate::gui::run::WindowOptions;
use args::{Cli, Command, WindowArgs};
pub use exit::Exit;
use interrupt::Interrupt;
use output::{Output, say};

/// Runs the program: a command, or the window where none is given.
#[must_use]
pub fn run() -> ExitCode {
    let cli = Cli::parse();
    let Some(command) = cli.command else {
        return match crate::gui::run::run(window_options(&cli.window)) {
            Ok(()) => Exit::Done.into(),
            Err(error) => {
                say(error.to_string());
                Exit::Failed.into()
            }
        };
    };
    let interrupt = match Interrupt::install() {
        Ok(interrupt) => interrupt,
        Err(error) => {
            say(format!("Could not take over Ctrl-C, without which motors could not be stopped: {error}."));
            return Exit::Failed.into();
        }
    };
    dispatch(&command, &mut Output::stdout(), &interrupt).into()
}

fn window_options(args: &WindowArgs) -> WindowOptions {
    WindowOptions { open: args.open.clone(), plain: args.plain }
}

fn dispatch(command: &Command, out: &mut Output, interrupt: &Interrupt) -> Exit {
    match command {
        Command::List(args) => list::run(args, out, interrupt),
        Command::Nodes(args) => nodes::run(args, out, interrupt),
        Command::Status(args) => status::run(args, out, interrupt),
        Command::Drive(args) => drive::run(args, out, interrupt),
        Command::Stop(args) => stop::run(args, out, interrupt),
        Command::Settings(args) => settings::run(args, out, interrupt),
        Command::Firmware(args) => firmware::run(args, out, interrupt),
        Command::Sim(args) => sim::run(args, out, interrupt),
        Command::Script(args) => script::run(args, out, interrupt),
        Command::Protocol(args) => protocol::run(args, out),
        Command::Terminal(args) => terminal::run(args, out, interrupt),
        Command::Monitor(args) => monitor::run(args, out, interrupt),
        Command::Tune(args) => tune::run(args, out, interrupt),
        Command::Mcl(args) => mcl::run(args, out, interrupt),
        #[cfg(feature = "bench")]
        Command::Bench(args) => bench::run(args, out, interrupt),
    }
}
