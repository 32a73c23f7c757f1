//! What simulated board to make: the text behind `sim:motorvator-3`, and the arguments of `brushwork sim`.
//!
//! `motorvator-3,program=FILE,started=yes,baud=9600,preset=NAME,seed=N`; `?` and `&` may stand for the commas. A board is at the addresses 1
//! and 2, one for each half, whichever are asked for by `address=N`.

use brushwork_link::bounded;
use brushwork_motorvator_client::Half;
use brushwork_motorvator_sim::{DrivenMotorvator, Motorvator};
use brushwork_motorvator_wire::BITS_PER_SECOND;
use brushwork_motorvator_wire::host::LIBRARY;
use brushwork_plant::ParamsError;
use brushwork_plant::presets::{self, presets};
use brushwork_script::diagnostic::Severity;
use brushwork_script::mecc::compile;
use brushwork_script::program::Program;
use brushwork_script::text::{Lines, Place, decoded};
use std::path::{Path, PathBuf};

/// The name of the model.
pub const MODEL: &str = "motorvator-3";

/// The rates of a serial line. Which of them a board has no page says, so that any can be tried.
pub const RATES_BPS: [u32; 8] = [1_200, 2_400, 4_800, 9_600, 19_200, 38_400, 57_600, 115_200];

/// A simulated board.
#[derive(Clone, Debug, PartialEq)]
pub struct MotorvatorSpec {
    /// Which half a command is for, where one is named.
    pub half: Option<Half>,
    /// The MeccCode file of its program; the host library if none is named.
    pub program: Option<PathBuf>,
    /// Whether its program runs at once, as if somebody had started it; else it waits for `G`.
    pub is_started: bool,
    /// The rate of its line.
    pub rate_bps: u32,
    /// What its four motors are and drive.
    pub preset: Option<String>,
    /// Seed of the measurement noise; 0 for none.
    pub seed: u64,
}

impl Default for MotorvatorSpec {
    fn default() -> Self {
        Self { half: None, program: None, is_started: true, rate_bps: BITS_PER_SECOND, preset: None, seed: 1 }
    }
}

const SEPARATORS: [char; 3] = [',', '?', '&'];

impl MotorvatorSpec {
    /// Whether the text behind `sim:` asks for a MotorVator.
    #[must_use]
    pub fn is_asked_for(text: &str) -> bool {
        text.split(SEPARATORS).next().is_some_and(|model| model.trim().eq_ignore_ascii_case(MODEL))
    }

    /// Reads the text behind `sim:`.
    ///
    /// # Errors
    /// A clause that names the part at fault and what may stand there.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut spec = Self::default();
        for part in text.split(SEPARATORS).map(str::trim).skip(1).filter(|part| !part.is_empty()) {
            let (key, value) = part.split_once('=').ok_or_else(|| no_option(part))?;
            spec.set(key.trim(), value.trim())?;
        }
        Ok(spec)
    }

    fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        match key {
            "address" => {
                let half = value.parse().ok().and_then(Half::of);
                let half = half.ok_or_else(|| {
                    format!("\"{value}\" is no address of a MotorVator. Use 1 for motors A and B, or 2 for C and D")
                })?;
                self.half = self.half.or(Some(half));
            }
            "program" if value.is_empty() => return Err("program= lacks the name of its file".to_owned()),
            "program" => self.program = Some(PathBuf::from(value)),
            "started" => self.is_started = is_yes(key, value)?,
            "baud" => {
                self.rate_bps = value.parse().ok().and_then(rate).ok_or_else(|| {
                    let rates = RATES_BPS.map(|rate| rate.to_string()).join(", ");
                    format!("a simulated MotorVator has {rates} baud, not \"{value}\"")
                })?;
            }
            "preset" => self.preset = Some(preset(value)?),
            "seed" => {
                self.seed =
                    value.parse().map_err(|_| format!("\"{value}\" is no seed. Use a whole number"))?;
            }
            _ => return Err(no_option(key)),
        }
        Ok(())
    }

    /// What it has in its memory: the program of its file, or the host library.
    ///
    /// # Errors
    /// A clause: the file cannot be read, or what is wrong with it as `FILE:LINE:COLUMN: ...`.
    pub fn program(&self) -> Result<Program, String> {
        self.program.as_deref().map_or_else(|| Ok(library()), compiled)
    }

    /// The board with a program in its memory.
    ///
    /// # Errors
    /// Figures of a preset that make no sense.
    pub fn board(&self, program: Program) -> Result<DrivenMotorvator, ParamsError> {
        let mut board = Motorvator::new(Some(program)).at_rate(self.rate_bps);
        if self.is_started {
            board.start();
        }
        let preset = self.preset.as_deref().and_then(presets::lookup);
        let preset = preset.or(presets::lookup(PRESET)).unwrap_or(&presets()[0]);
        DrivenMotorvator::new(board, preset, self.seed)
    }
}

/// What its motors are unless something else is named.
const PRESET: &str = "small-gearmotor";

/// The program of a file.
fn compiled(path: &Path) -> Result<Program, String> {
    let file = path.display();
    let bytes = bounded::read_file(path).map_err(|error| format!("{file} cannot be read: {error}"))?;
    let text = decoded(bytes);
    let compiled = compile(&text);
    compiled.program.ok_or_else(|| {
        let mut errors = compiled.diagnostics.iter().filter(|said| said.severity() == Severity::Error);
        let Some(first) = errors.next() else { return format!("{file} is no program") };
        let Place { line, column } = Lines::of(&text).place(&text, first.span.start);
        let more = match errors.count() {
            0 => String::new(),
            1 => " (and 1 more error)".to_owned(),
            count => format!(" (and {count} more errors)"),
        };
        format!("{file}:{line}:{column}: error {}: {}{more}", first.code, first.message.trim_end_matches('.'))
    })
}

/// The host library, compiled.
///
/// # Panics
/// Never: a test compiles it.
#[must_use]
pub fn library() -> Program {
    compile(LIBRARY).program.expect("the host library has no error")
}

/// The rate, if a serial line has it.
#[must_use]
pub fn rate(bits_per_second: u32) -> Option<u32> {
    RATES_BPS.contains(&bits_per_second).then_some(bits_per_second)
}

/// The name of a preset, if there is one of that name.
///
/// # Errors
/// A clause with all names.
pub fn preset(name: &str) -> Result<String, String> {
    match presets::lookup(name) {
        Some(preset) => Ok(preset.key.clone()),
        None => Err(format!("\"{name}\" is no motor preset. There are {}", presets::keys().join(", "))),
    }
}

fn is_yes(key: &str, value: &str) -> Result<bool, String> {
    match value.to_ascii_lowercase().as_str() {
        "yes" => Ok(true),
        "no" => Ok(false),
        _ => Err(format!("{key} is yes or no, not \"{value}\"")),
    }
}

fn no_option(given: &str) -> String {
    format!(
        "\"{given}\" is no option of a simulated MotorVator V3. There are address=1 or 2, program=FILE, started=yes or no, baud=N, \
         preset=NAME and seed=N"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_plant::machine::{Machine, StreamIndex};
    use std::time::Duration;

    #[test]
    fn both_ways_of_writing_say_the_same_and_make_a_board_that_has_begun() {
        let commas =
            MotorvatorSpec::parse("motorvator-3,address=2,baud=19200,preset=flywheel,seed=7").unwrap();
        let marks =
            MotorvatorSpec::parse("MotorVator-3?address=2&baud=19200&preset=flywheel&seed=7").unwrap();
        assert_eq!(commas, marks);
        let mut board = commas.board(library()).unwrap();
        assert_eq!((board.units(), board.bits_per_second(StreamIndex::Usb)), (2, 19_200));
        board.advance(Duration::from_millis(10));
        assert_eq!(board.board().display(), *b"H2");
        let waits = MotorvatorSpec::parse("motorvator-3,started=no").unwrap().board(library()).unwrap();
        assert!(!waits.board().is_running());
    }

    #[test]
    fn what_cannot_be_is_told_with_what_can() {
        for (text, clause) in [
            ("motorvator-3,address=3", "C and D"),
            ("motorvator-3,started=1", "yes or no"),
            ("motorvator-3,baud=9601", "9600"),
            ("motorvator-3,preset=none", "There are"),
            ("motorvator-3,seed=x", "whole number"),
            ("motorvator-3,program=", "lacks the name"),
            ("motorvator-3,echo=on", "started"),
            ("motorvator-3,2", "started"),
        ] {
            let said = MotorvatorSpec::parse(text).unwrap_err();
            assert!(said.contains(clause), "{text}: {said}");
        }
    }
}
