//! The program `brushwork`: the window, the command line, and with the feature `bench` what measures them.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

#[cfg(feature = "bench")]
mod bench;
#[cfg(feature = "bench")]
mod mcp;
#[cfg(feature = "bench")]
mod motion_mind;

#[cfg(not(target_family = "wasm"))]
use brushwork_cli::family::Family as Commands;
#[cfg(not(target_family = "wasm"))]
use brushwork_core::{guardian, panics};
use brushwork_family::{Examiner, Simulator, examine, simulator};
#[cfg(not(target_family = "wasm"))]
use brushwork_gui::run::{WindowOptions, run as open_window};
use brushwork_gui::screens::face::Window;
use brushwork_link::Driver;
use std::process::ExitCode;

/// A family of controllers, as each part of the program has it.
pub struct Family {
    /// What speaks with its units.
    pub driver: &'static dyn Driver,
    /// What simulates them.
    pub simulator: &'static dyn Simulator,
    /// What examines them, where there are questions.
    pub examiner: Option<&'static dyn Examiner>,
    /// What the window shows of them.
    pub window: &'static dyn Window,
    /// What they add to the command line.
    #[cfg(not(target_family = "wasm"))]
    pub commands: &'static dyn Commands,
    /// What judges the tuner on them, where they can be tuned.
    #[cfg(feature = "bench")]
    pub judge: Option<brushwork_tuning_bench::judge::Judge>,
    /// What is measured of them beside.
    #[cfg(feature = "bench")]
    pub measures: &'static [bench::Measure],
}

/// The families that this program has. The one that is looked for first, and simulated where nothing else is named, is at the head. To add one,
/// name it here.
pub static FAMILIES: [Family; 4] = [
    Family {
        driver: &brushwork_mcp_client::McpDriver,
        simulator: &brushwork_mcp::McpSimulator,
        examiner: Some(&brushwork_mcp::McpExaminer),
        window: &brushwork_gui::mcp::Mcp,
        #[cfg(not(target_family = "wasm"))]
        commands: &brushwork_cli::mcp::McpCommands,
        #[cfg(feature = "bench")]
        judge: Some(brushwork_tuning_bench::mcp::JUDGE),
        #[cfg(feature = "bench")]
        measures: mcp::MEASURES,
    },
    Family {
        driver: &brushwork_motion_mind_client::MotionMindDriver,
        simulator: &brushwork_motion_mind::MotionMindSimulator,
        examiner: Some(&brushwork_motion_mind::MotionMindExaminer),
        window: &brushwork_gui::motion_mind::MotionMind,
        #[cfg(not(target_family = "wasm"))]
        commands: &brushwork_cli::motion_mind::MotionMindCommands,
        #[cfg(feature = "bench")]
        judge: Some(brushwork_tuning_bench::motion_mind::JUDGE),
        #[cfg(feature = "bench")]
        measures: motion_mind::MEASURES,
    },
    Family {
        driver: &brushwork_suprmotr_client::SuprMotrDriver,
        simulator: &brushwork_suprmotr::SuprMotrSimulator,
        examiner: None,
        window: &brushwork_gui::suprmotr::SuprMotr,
        #[cfg(not(target_family = "wasm"))]
        commands: &brushwork_cli::suprmotr::SuprMotrCommands,
        #[cfg(feature = "bench")]
        judge: Some(brushwork_tuning_bench::suprmotr::JUDGE),
        #[cfg(feature = "bench")]
        measures: &[],
    },
    Family {
        driver: &brushwork_motorvator_client::MotorvatorDriver,
        simulator: &brushwork_motorvator::MotorvatorSimulator,
        examiner: None,
        window: &brushwork_gui::motorvator::Motorvator,
        #[cfg(not(target_family = "wasm"))]
        commands: &brushwork_cli::mecc::MotorvatorCommands,
        #[cfg(feature = "bench")]
        judge: None,
        #[cfg(feature = "bench")]
        measures: &[],
    },
];

/// Makes the families known to every part of the program.
pub fn install() {
    brushwork_link::install(&FAMILIES.each_ref().map(|family| family.driver));
    simulator::install(&FAMILIES.each_ref().map(|family| family.simulator));
    examine::install(&FAMILIES.iter().filter_map(|family| family.examiner).collect::<Vec<_>>());
    brushwork_gui::install(&FAMILIES.each_ref().map(|family| family.window));
    #[cfg(not(target_family = "wasm"))]
    brushwork_cli::family::install(&FAMILIES.each_ref().map(|family| family.commands));
}

/// Runs the program as a web page: the window, with simulated controllers.
#[cfg(target_family = "wasm")]
#[must_use]
pub fn run() -> ExitCode {
    install();
    brushwork_gui::page::run();
    ExitCode::SUCCESS
}

/// Runs the program: a command, or the window where none is given.
#[cfg(not(target_family = "wasm"))]
#[must_use]
pub fn run() -> ExitCode {
    let mut words = std::env::args_os().skip(1);
    if words.next().is_some_and(|word| word == guardian::COMMAND) {
        return brushwork_cli::guardian::run(words);
    }
    panics::install();
    if let Ok(program) = std::env::current_exe() {
        guardian::install(program);
    }
    install();
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
