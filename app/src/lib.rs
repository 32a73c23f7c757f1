//! The program `brushwork`: the window, the command line, and with the feature `bench` what measures them.

#[cfg(feature = "bench")]
mod bench;

use brushwork_cli::family::Family as Commands;
use brushwork_gui::run::{WindowOptions, run as open_window};
use brushwork_link::Driver;
use std::process::ExitCode;

/// The families of controllers that this program has, the one that is looked for first at the head. To add one, name it here.
pub static FAMILIES: [&dyn Driver; 2] =
    [&brushwork_mcp_client::McpDriver, &brushwork_motion_mind_client::MotionMindDriver];

/// What each of them adds to the command line.
pub static COMMANDS: [&dyn Commands; 2] =
    [&brushwork_cli::mcp::McpCommands, &brushwork_cli::motion_mind::MotionMindCommands];

/// Runs the program: a command, or the window where none is given.
#[must_use]
pub fn run() -> ExitCode {
    brushwork_link::install(&FAMILIES);
    brushwork_cli::family::install(&COMMANDS);
    brushwork_cli::run(
        |window| {
            let options = WindowOptions { open: window.open.clone(), plain: window.plain };
            open_window(options).map_err(|error| error.to_string())
        },
        [
            #[cfg(feature = "bench")]
            bench::tool(),
        ],
    )
}
