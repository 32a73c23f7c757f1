//! Manual pages and completions, written as files where packages want them.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use clap::Command;
use clap_complete::Shell;

/// The shells that get completions, each with the path below `share` where it looks for them. PowerShell looks nowhere: its file is sourced
/// from a profile.
pub const COMPLETIONS: [(Shell, &str); 4] = [
    (Shell::Bash, "bash-completion/completions/brushwork"),
    (Shell::Zsh, "zsh/site-functions/_brushwork"),
    (Shell::Fish, "fish/vendor_completions.d/brushwork.fish"),
    (Shell::PowerShell, "brushwork/brushwork.ps1"),
];

/// Where manual pages of commands lie below `share`.
pub const MANUAL: &str = "man/man1";

/// The command line of the program as it is packaged: without the tools of its developers.
#[must_use]
pub fn command_line() -> Command {
    brushwork::install();
    let mut command = brushwork_cli::command_line();
    command.build();
    command
}

/// Writes all of them below `share`, and gives the paths of what was written.
///
/// # Errors
/// A folder could not be made or a file not be written.
pub fn write(share: &Path) -> io::Result<Vec<PathBuf>> {
    let mut written = Vec::new();
    let mut keep = |path: PathBuf, content: &[u8]| {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        fs::write(&path, content)?;
        written.push(path);
        io::Result::Ok(())
    };
    let mut command = command_line();
    for (shell, path) in COMPLETIONS {
        let mut content = Vec::new();
        clap_complete::generate(shell, &mut command, "brushwork", &mut content);
        keep(share.join(path), &content)?;
    }
    for (name, page) in manual(&command) {
        let mut content = Vec::new();
        clap_mangen::Man::new(page).title(name.to_uppercase()).manual("Brushwork").render(&mut content)?;
        keep(share.join(MANUAL).join(format!("{name}.1")), &content)?;
    }
    Ok(written)
}

/// Each command that has a page, with the name of it: "brushwork-settings-read".
fn manual(command: &Command) -> Vec<(String, Command)> {
    let name = command.get_display_name().unwrap_or(command.get_name()).to_owned();
    let mut pages = vec![(name, command.clone().disable_help_subcommand(true))];
    pages.extend(shown(command).flat_map(manual));
    pages
}

/// The commands below one that people are told of; that which prints help pages is told by each page itself.
fn shown(command: &Command) -> impl Iterator<Item = &Command> {
    command.get_subcommands().filter(|below| !below.is_hide_set() && below.get_name() != "help")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    use brushwork_child::Child;

    fn read(path: &Path) -> String {
        fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
    }

    /// As `roff` writes it: a hyphen that is none of the language is escaped.
    fn in_roff(text: &str) -> String {
        text.replace('-', "\\-")
    }

    #[test]
    fn every_command_has_a_page_that_names_each_of_its_arguments() {
        let folder = tempfile::tempdir().unwrap();
        let written = write(folder.path()).unwrap();
        let pages = manual(&command_line());
        assert_eq!(written.len(), pages.len() + COMPLETIONS.len());
        for (name, command) in &pages {
            let page = read(&folder.path().join(MANUAL).join(format!("{name}.1")));
            assert!(page.contains(&format!("\n{} \\- ", in_roff(name))), "{name} has no NAME:\n{page}");
            for argument in command.get_arguments().filter(|argument| !argument.is_hide_set()) {
                let flag = argument.get_long().map(|long| in_roff(&format!("--{long}")));
                let values = argument.get_value_names().and_then(|names| names.first());
                let told = flag.or(values.map(ToString::to_string)).unwrap_or_default();
                assert!(
                    !told.is_empty() && page.contains(&told),
                    "{name} does not tell of {}",
                    argument.get_id()
                );
            }
            for below in shown(command) {
                assert!(
                    page.contains(&in_roff(&format!("{name}-{}(1)", below.get_name()))),
                    "{name}: {below}"
                );
            }
        }
        for known in [
            "brushwork",
            "brushwork-status",
            "brushwork-settings-read",
            "brushwork-tune-velocity",
            "brushwork-mcl-check",
        ] {
            assert!(pages.iter().any(|(name, _)| name == known), "no page {known}");
        }
    }

    #[test]
    fn the_completions_of_every_shell_name_every_command_and_option() {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path()).unwrap();
        for (shell, path) in COMPLETIONS {
            let script = read(&folder.path().join(path));
            for (name, command) in manual(&command_line()) {
                let last = command.get_name();
                assert!(script.contains(last), "{shell}: no {name}");
                for long in command.get_arguments().filter_map(clap::Arg::get_long) {
                    assert!(script.contains(long), "{shell}: no --{long} of {name}");
                }
            }
        }
    }

    #[test]
    fn bash_completes_a_word_of_each_level() {
        let folder = tempfile::tempdir().unwrap();
        write(folder.path()).unwrap();
        let (_, path) = COMPLETIONS.into_iter().find(|(shell, _)| *shell == Shell::Bash).unwrap();
        let completed = |line: &str| {
            let ask = "source \"$0\"; COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _brushwork \"$1\" \"${@: -1}\" \"${@: -2:1}\"; echo \"${COMPREPLY[@]}\"";
            let mut bash = std::process::Command::new("bash");
            bash.args(["--norc", "-c", ask]).arg(folder.path().join(path)).args(line.split(' '));
            let output = Child::output(&bash, b"", Duration::from_secs(60));
            assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
            String::from_utf8(output.stdout).unwrap().trim().to_owned()
        };
        assert_eq!(completed("brushwork sta"), "status");
        assert_eq!(completed("brushwork settings re"), "read reload restore reference");
        assert_eq!(completed("brushwork tune velocity --enc"), "--encoder");
        assert_eq!(completed("brushwork drive --motor b"), "both");
    }

    #[test]
    fn no_page_tells_of_what_is_not_packaged() {
        assert!(command_line().find_subcommand("bench").is_none());
    }
}
