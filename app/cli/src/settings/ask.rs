//! Asking before something is written, without losing sight of Ctrl-C and the link meanwhile.

use crate::messages::CliSettingsMessage;
use std::io::{self, BufRead as _, IsTerminal as _, Write as _};

use super::controller::Controller;
use crate::interrupt::meanwhile;
use crate::{Exit, say};

/// Returns when `question` was answered with yes, here or by `--yes` beforehand.
///
/// # Errors
/// The answer was no, or there is nobody to ask: that is said on standard error. Ctrl-C and a lost link end
/// the waiting.
pub fn agreed(question: &str, yes: bool, controller: &Controller<'_>) -> Result<(), Exit> {
    agreed_while(question, yes, &|| controller.breathe())
}

/// The same, with something to do while the answer is awaited, which can end that.
///
/// # Errors
/// As for [`agreed`].
pub fn agreed_while(question: &str, yes: bool, breathe: &dyn Fn() -> Result<(), Exit>) -> Result<(), Exit> {
    if yes {
        return Ok(());
    }
    if !io::stdin().is_terminal() {
        return Err(Exit::Refused.saying(CliSettingsMessage::NobodyToAsk { question: question.to_string() }));
    }
    let _ = write!(io::stderr(), "{question} [y/N] ");
    let breathe = || breathe().inspect_err(|_| say(CliSettingsMessage::StoppedAsking));
    if is_yes(&line(&breathe)?) { Ok(()) } else { Err(Exit::Refused.saying(CliSettingsMessage::NotWritten)) }
}

/// One line from the terminal; `breathe` is called meanwhile and can end the waiting.
///
/// # Errors
/// What `breathe` said, or that nobody can be asked.
pub fn line(breathe: &dyn Fn() -> Result<(), Exit>) -> Result<String, Exit> {
    let read = || {
        let mut line = String::new();
        // Standard input that cannot be read gives no yes.
        let _ = io::stdin().lock().read_line(&mut line);
        line
    };
    Ok(meanwhile(read, breathe)?.unwrap_or_default())
}

/// Whether a line says yes.
pub fn is_yes(line: &str) -> bool {
    matches!(line.trim().to_lowercase().as_str(), "y" | "yes")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_plain_yes_is_a_yes() {
        assert!(is_yes("y\n"));
        assert!(is_yes(" YES \r\n"));
        for no in ["", "\n", "n\n", "yeah\n", "j\n"] {
            assert!(!is_yes(no), "{no:?}");
        }
    }
}
