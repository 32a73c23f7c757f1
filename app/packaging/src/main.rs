//! `brushwork-pages FOLDER`: writes manual pages and completions below the folder, as below `/usr/share`.

#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a tool of the build")]

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut words = std::env::args_os().skip(1);
    let (Some(folder), None) = (words.next(), words.next()) else {
        eprintln!("usage: brushwork-pages FOLDER");
        return ExitCode::from(2);
    };
    match brushwork_packaging::pages::write(Path::new(&folder)) {
        Ok(written) => {
            written.iter().for_each(|path| println!("{}", path.display()));
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("The pages could not be written below {}: {error}.", folder.display());
            ExitCode::FAILURE
        }
    }
}
