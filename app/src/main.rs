//! The program `brushwork`.

use std::io::Write as _;
use std::process::ExitCode;

fn main() -> ExitCode {
    match brushwork::gui::run::run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Nothing is left to be done if even this cannot be written.
            let _ = writeln!(std::io::stderr(), "{error}");
            ExitCode::FAILURE
        }
    }
}
