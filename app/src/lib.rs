//! The program `brushwork`: the window, the command line, and with the feature `bench` what measures them.

#[cfg(feature = "bench")]
mod bench;

use brushwork_family::Simulator;
use brushwork_gui::run::{WindowOptions, run as open_window};
use brushwork_link::Driver;
use std::process::ExitCode;

/// The families of controllers that this program has, the one that is looked for first at the head. To add one, name it here.
pub static FAMILIES: [&dyn Driver; 2] =
    [&brushwork_mcp_client::McpDriver, &brushwork_motion_mind_client::MotionMindDriver];

/// What simulates their units. The first one's are made where the text behind `sim:` names none.
pub static SIMULATORS: [&dyn Simulator; 2] =
    [&brushwork_mcp::McpSimulator, &brushwork_motion_mind::MotionMindSimulator];

/// Makes the families known to every part of the program.
pub fn install() {
    brushwork_link::install(&FAMILIES);
    brushwork_family::simulator::install(&SIMULATORS);
}

/// Runs the program: a command, or the window where none is given.
#[must_use]
pub fn run() -> ExitCode {
    install();
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
