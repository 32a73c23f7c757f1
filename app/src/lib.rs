//! The program `brushwork`: the window, the command line, and with the feature `bench` what measures them.

#[cfg(feature = "bench")]
mod bench;

use brushwork_gui::run::{WindowOptions, run as open_window};
use std::process::ExitCode;

/// Runs the program: a command, or the window where none is given.
#[must_use]
pub fn run() -> ExitCode {
    brushwork_cli::run(
        |window| {
            let options = WindowOptions { open: window.open.clone(), plain: window.plain };
            open_window(options).map_err(|error| error.to_string())
        },
        &[
            #[cfg(feature = "bench")]
            bench::tool(),
        ],
    )
}
