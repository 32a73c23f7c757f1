//! The program `brushwork`.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]

use std::process::ExitCode;

fn main() -> ExitCode {
    brushwork::run()
}
