//! The program `brushwork`.

use std::process::ExitCode;

fn main() -> ExitCode {
    brushwork::run()
}
