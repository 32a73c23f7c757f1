//! Macros on a simulated board in virtual time, before they are given to a real one.

use brushwork_plant::ParamsError;
use brushwork_suprmotr_macros::Macro;
use brushwork_suprmotr_sim::{Step, SuprMotr, SuprMotrConfig};
use brushwork_suprmotr_wire::{Address, EncodeError, ErrorCode, Selection};
use std::collections::VecDeque;
use std::time::Duration;

/// A board that has macros and runs one of them.
#[derive(Debug)]
pub struct Rehearsal {
    unit: SuprMotr,
    begun_at: Duration,
    outputs: u16,
    /// What has happened and was not told yet by steps.
    pending: VecDeque<Happening>,
}

/// What is to be seen from outside, and what the board does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Happening {
    /// A command begins.
    Step(Step),
    /// The board says something.
    Said(String),
    /// The digital outputs change, channel 1 in bit 0.
    Outputs(u16),
}

/// How a run stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It goes on.
    Running,
    /// All is done, and the axis has come to rest.
    Ended,
    /// A command was refused.
    Refused(ErrorCode),
    /// The position lagged too far behind: the motor was let go.
    LetGo,
}

/// Why macros cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum RehearsalError {
    /// Figures of a motor that make no sense.
    #[error(transparent)]
    Params(#[from] ParamsError),
    /// A macro has no line.
    #[error("macro {number}: {error}")]
    Macro {
        /// Its number.
        number: u8,
        /// Why.
        error: EncodeError,
    },
    /// A board has no room for it.
    #[error("macro {number} was refused: {error}")]
    Refused {
        /// Its number.
        number: u8,
        /// Why.
        error: ErrorCode,
    },
}

/// How finely is looked on.
const LOOK: Duration = Duration::from_millis(1);

impl Rehearsal {
    /// Gives a board the macros, by the lines that a real one would be given.
    ///
    /// # Errors
    /// What the board does not take.
    pub fn new(config: SuprMotrConfig, macros: &[Macro]) -> Result<Self, RehearsalError> {
        let mut unit = SuprMotr::new(config)?;
        unit.advance(LOOK);
        unit.receive(&Selection::Unit(unit.address()).bytes());
        unit.receive(b"EF\r");
        for known in macros {
            let number = known.number;
            let line = known.line().map_err(|error| RehearsalError::Macro { number, error })?;
            unit.receive(&line);
            if let Some(error) = unit.error() {
                return Err(RehearsalError::Refused { number, error });
            }
        }
        unit.advance(unit.now() + LOOK);
        while unit.take_output().is_some() {}
        unit.start_trace();
        Ok(Self { begun_at: unit.now(), outputs: unit.outputs(), unit, pending: VecDeque::new() })
    }

    /// The same on a board as it comes from the factory, on the usual slide.
    ///
    /// # Errors
    /// What the board does not take.
    pub fn of(macros: &[Macro]) -> Result<Self, RehearsalError> {
        Self::new(SuprMotrConfig::new(Address::FACTORY), macros)
    }

    /// Calls a macro.
    pub fn start(&mut self, number: u8) {
        self.unit.receive(format!("MC{number}\r").as_bytes());
    }

    /// Goes on by a millisecond.
    pub fn advance(&mut self) -> Vec<Happening> {
        self.unit.advance(self.unit.now() + LOOK);
        let mut happened: Vec<Happening> = self.unit.take_trace().into_iter().map(Happening::Step).collect();
        while let Some((_, bytes)) = self.unit.take_output() {
            happened.push(Happening::Said(String::from_utf8_lossy(&bytes).into_owned()));
        }
        let outputs = self.unit.outputs();
        if std::mem::replace(&mut self.outputs, outputs) != outputs {
            happened.push(Happening::Outputs(outputs));
        }
        happened
    }

    /// Goes on until the next command of a macro has begun, until all is over, or for so long.
    pub fn step(&mut self, most: Duration) -> Vec<Happening> {
        let end = self.elapsed() + most;
        let mut happened = Vec::new();
        loop {
            while let Some(next) = self.pending.pop_front() {
                let begins = matches!(&next, Happening::Step(step) if step.of_macro.is_some());
                happened.push(next);
                if begins {
                    return happened;
                }
            }
            if self.elapsed() >= end {
                return happened;
            }
            let more = self.advance();
            self.pending.extend(more);
            if self.pending.is_empty() && self.state() != State::Running {
                return happened;
            }
        }
    }

    /// Whether all has been told of a run that is over.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.pending.is_empty() && self.state() != State::Running
    }

    /// How it stands.
    #[must_use]
    pub fn state(&self) -> State {
        if let Some(error) = self.unit.error() {
            State::Refused(error)
        } else if self.unit.has_excessive_error() {
            State::LetGo
        } else if self.unit.is_busy()
            || !self.unit.is_motion_complete()
            || self.unit.next_output_at().is_some()
        {
            State::Running
        } else {
            State::Ended
        }
    }

    /// How long it has run.
    #[must_use]
    pub fn elapsed(&self) -> Duration {
        self.unit.now().saturating_sub(self.begun_at)
    }

    /// When a step began, from the start on.
    #[must_use]
    pub fn time_of(&self, step: &Step) -> Duration {
        step.at.saturating_sub(self.begun_at)
    }

    /// The board.
    #[must_use]
    pub fn unit(&self) -> &SuprMotr {
        &self.unit
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_suprmotr_macros::check;

    fn rehearse(text: &str, most: Duration) -> (State, Duration, Vec<Happening>) {
        let macros = check(text).macros;
        let mut run = Rehearsal::new(SuprMotrConfig::new(Address::FACTORY), &macros).unwrap();
        run.start(macros[0].number);
        let mut happened = Vec::new();
        while run.elapsed() < most {
            happened.extend(run.advance());
            if run.state() != State::Running {
                break;
            }
        }
        (run.state(), run.elapsed(), happened)
    }

    #[test]
    fn a_run_ends_when_all_is_done_and_tells_what_happened() {
        let (state, took, happened) = rehearse("macro go\nMA 500, WS 50, CN 1, TT\n", Duration::from_secs(5));
        // 2 sqrt(500 / 200,000) = 0.1 s and 50 ms; the report leaves a millisecond later.
        assert_eq!((state, took), (State::Ended, Duration::from_millis(151)));
        assert!(happened.contains(&Happening::Outputs(1)));
        assert!(happened.contains(&Happening::Said("0T0:+0000000500\r\n\u{3}".to_owned())));
        let steps = happened.iter().filter(|happening| matches!(happening, Happening::Step(_)));
        assert_eq!(steps.count(), 5, "the call and its four commands");
    }

    #[test]
    fn steps_go_from_command_to_command_and_tell_everything_once() {
        let macros = check("macro go\nMA 500, WS 50, CN 1, TT\n").macros;
        let mut run = Rehearsal::of(&macros).unwrap();
        run.start(macros[0].number);
        let mut all = Vec::new();
        for index in 0..4 {
            assert!(!run.is_over());
            let happened = run.step(Duration::from_secs(5));
            let Some(Happening::Step(step)) = happened.last() else { panic!("{happened:?}") };
            assert_eq!((step.of_macro, step.index), (Some(macros[0].number), index));
            all.extend(happened);
        }
        let last = run.step(Duration::from_secs(5));
        assert!(run.is_over() && run.state() == State::Ended);
        all.extend(last);
        let (_, _, whole) = rehearse("macro go\nMA 500, WS 50, CN 1, TT\n", Duration::from_secs(5));
        assert_eq!(all, whole, "as without steps");
        assert_eq!(run.step(Duration::from_secs(5)), []);
        // A loop without a wait is left when its time is over.
        let macros = check("macro go\nWA 60000\n").macros;
        let mut run = Rehearsal::of(&macros).unwrap();
        run.start(macros[0].number);
        run.step(Duration::from_secs(1));
        assert_eq!(run.step(Duration::from_secs(1)), []);
        assert!(!run.is_over());
    }

    #[test]
    fn a_run_that_fails_says_how() {
        let (state, ..) = rehearse("macro go\nMA 1073741823, WA 100, MC go, CN 1\n", Duration::from_secs(5));
        assert_eq!(state, State::Refused(ErrorCode::LineOverflow));
        let (state, ..) = rehearse("macro go\nDV 1000000, SM 10, MA 50000, WS\n", Duration::from_secs(5));
        assert_eq!(state, State::LetGo);
        let (state, ..) = rehearse("macro go\nMA 500, WS, MA 0, WS, RP\n", Duration::from_secs(5));
        assert_eq!(state, State::Running);
    }
}
