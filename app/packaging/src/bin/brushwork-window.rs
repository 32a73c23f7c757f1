//! Opens the window of `brushwork.exe` on Windows with no console behind it.
//!
//! `brushwork.exe` is a program of the console, so that its commands print where they are typed. Started from the menu it would open a
//! console of its own beside the window. This starts it without one. Had it no window to open, what it said is shown in Notepad.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]
#![cfg_attr(windows, windows_subsystem = "windows")]

use std::process::ExitCode;

#[cfg(windows)]
fn main() -> ExitCode {
    use std::fs::File;
    use std::os::windows::process::CommandExt as _;
    use std::process::Command;
    use std::time::{Duration, Instant};

    /// `CREATE_NO_WINDOW` of the Windows API: a program of the console that gets none to be seen.
    const NO_CONSOLE: u32 = 0x0800_0000;
    /// What every Windows shows a text with.
    const EDITOR: &str = "notepad.exe";
    /// A program that ran longer had its window.
    const HAD_A_WINDOW: Duration = Duration::from_secs(10);

    let said = std::env::temp_dir().join("brushwork-window.txt");
    let Some(program) =
        std::env::current_exe().ok().and_then(|own| Some(own.parent()?.join("brushwork.exe")))
    else {
        return ExitCode::FAILURE;
    };
    let mut command = Command::new(program);
    command.args(std::env::args_os().skip(1)).creation_flags(NO_CONSOLE);
    if let Ok(file) = File::create(&said) {
        command.stderr(file);
    }
    let begun = Instant::now();
    if command.status().is_ok_and(|status| status.success()) {
        return ExitCode::SUCCESS;
    }
    if begun.elapsed() < HAD_A_WINDOW {
        // Without Notepad there is nobody to tell it to.
        let _ = Command::new(EDITOR).arg(&said).spawn();
    }
    ExitCode::FAILURE
}

#[cfg(not(windows))]
#[expect(clippy::print_stderr, reason = "a person started it")]
fn main() -> ExitCode {
    eprintln!("This is for Windows alone: run `brushwork`.");
    ExitCode::FAILURE
}
