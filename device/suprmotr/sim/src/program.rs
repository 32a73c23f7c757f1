//! The line that is carried out, with the macros that it calls: repeats, waits and conditions (SuprMotr manual, "Macro Commands").
//!
//! A line and each macro is a list of commands with a place in it. A call puts one on top of the other; the end of one goes back. A call at the very end
//! takes the place of the list it stands in, so that a macro may call itself for ever.

use super::assumed::MOST_NESTED;
use brushwork_suprmotr_wire::{Command, MOST_COMMANDS};
use std::time::Duration;

/// What holds a line up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wait {
    /// The end of the trajectory, and then so long.
    Stop(Duration),
    /// A moment.
    Until(Duration),
    /// A channel that is to be on, or off.
    Channel {
        /// Which one, from 1.
        channel: i64,
        /// What it is to be.
        is_on: bool,
    },
}

/// A list of commands that is being done.
#[derive(Clone, Debug)]
struct Frame {
    commands: Vec<Command>,
    next: usize,
    /// For each command the repeats that its RP still has to do; none where it was not reached, or is done.
    repeats: [Option<u32>; MOST_COMMANDS],
    is_macro: bool,
}

/// The line that is carried out.
#[derive(Clone, Debug, Default)]
pub struct Program {
    frames: Vec<Frame>,
    /// What it waits for.
    pub wait: Option<Wait>,
    /// What TI tells: the repeats that the RP met last still has to do.
    repeats_left: u32,
    /// Whether it has reported anything yet.
    pub has_reported: bool,
}

impl Program {
    /// Begins a line, in place of all that runs.
    pub fn start(&mut self, commands: Vec<Command>) {
        self.end();
        self.frames.push(Frame::new(commands, false));
    }

    /// Begins a macro, in place of all that runs.
    pub fn start_macro(&mut self, commands: Vec<Command>) {
        self.end();
        self.frames.push(Frame::new(commands, true));
    }

    /// Calls a macro from the line or macro that runs; whether that goes so deep.
    pub fn call(&mut self, commands: Vec<Command>) -> bool {
        self.leave_finished();
        if self.frames.len() >= MOST_NESTED {
            return false;
        }
        self.frames.push(Frame::new(commands, true));
        true
    }

    /// Ends all that runs.
    pub fn end(&mut self) {
        self.frames.clear();
        self.wait = None;
        self.has_reported = false;
    }

    /// Whether a macro is among it.
    pub fn is_in_macro(&self) -> bool {
        self.frames.iter().any(|frame| frame.is_macro)
    }

    /// What TI tells.
    pub fn repeats_left(&self) -> u32 {
        self.repeats_left
    }

    /// The command that comes next, without taking it.
    pub fn peek(&mut self) -> Option<Command> {
        self.leave_finished();
        let frame = self.frames.last()?;
        frame.commands.get(frame.next).copied()
    }

    /// Takes the next command.
    pub fn take(&mut self) -> Option<Command> {
        let command = self.peek()?;
        self.frames.last_mut()?.next += 1;
        Some(command)
    }

    /// The RP just taken: the list it stands in begins anew, so often.
    pub fn repeat(&mut self, times: u32) {
        let Some(frame) = self.frames.last_mut() else { return };
        let Some(place) = frame.next.checked_sub(1).and_then(|at| frame.repeats.get_mut(at)) else { return };
        let left = place.unwrap_or(times);
        self.repeats_left = left.saturating_sub(1);
        *place = left.checked_sub(1);
        if left > 0 {
            frame.next = 0;
        }
    }

    /// The condition just taken does not hold: the rest of its list is passed by.
    pub fn skip_rest(&mut self) {
        if let Some(frame) = self.frames.last_mut() {
            frame.next = frame.commands.len();
        }
    }

    fn leave_finished(&mut self) {
        while self.frames.pop_if(|frame| frame.next >= frame.commands.len()).is_some() {}
    }
}

impl Frame {
    fn new(commands: Vec<Command>, is_macro: bool) -> Self {
        Self { commands, next: 0, repeats: [None; MOST_COMMANDS], is_macro }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_suprmotr_wire::{Mnemonic, Radix, parse_line};

    fn line(text: &str) -> Vec<Command> {
        let parsed = parse_line(text.as_bytes(), Radix::Decimal);
        assert_eq!(parsed.error, None, "{text}");
        parsed.line.commands
    }

    /// The commands that a line comes to with some macros, without waiting.
    fn run(text: &str, macros: &[(i32, &str)], most: usize) -> Vec<String> {
        let mut program = Program::default();
        program.start(line(text));
        let mut done = Vec::new();
        while done.len() < most
            && let Some(command) = program.take()
        {
            match command.mnemonic {
                Mnemonic::RP => program.repeat(command.value().expect("a count").unsigned_abs()),
                Mnemonic::MC => {
                    let called = macros.iter().find(|(number, _)| command.number == Some(*number));
                    let deep = program.call(called.map(|(_, text)| line(text)).unwrap_or_default());
                    done.extend((!deep).then(|| "too deep".to_owned()));
                    if !deep {
                        program.end();
                    }
                }
                _ => done.push(command.text(Radix::Decimal)),
            }
        }
        done
    }

    #[test]
    fn a_line_is_repeated_once_more_than_its_number() {
        assert_eq!(run("MA0,RP49", &[], 1_000).len(), 50);
        assert_eq!(run("MA0,RP0", &[], 1_000).len(), 1);
        assert_eq!(run("MA0,RP", &[], 100_000).len(), 65_536);
    }

    /// The first goes round twice each time that the second begins anew: 3 x 3.
    #[test]
    fn two_repeats_multiply() {
        assert_eq!(run("MA0,RP2,RP2", &[], 1_000).len(), 9);
    }

    #[test]
    fn calls_come_back_and_repeat_their_own_list() {
        let macros = [(2, "MR2,RP1"), (3, "MC2,MR3")];
        assert_eq!(run("MC3,MR0,RP1", &macros, 100).join(","), "MR2,MR2,MR3,MR0,MR2,MR2,MR3,MR0");
    }

    #[test]
    fn a_call_at_the_end_goes_on_for_ever_and_another_does_not() {
        assert_eq!(run("MC1", &[(1, "MR1,MC1")], 10_000).len(), 10_000);
        let done = run("MC1", &[(1, "MR1,MC1,MR2")], 10_000);
        assert_eq!((done.len(), done.last().map(String::as_str)), (MOST_NESTED + 1, Some("too deep")));
    }

    #[test]
    fn the_counter_tells_what_is_still_to_be_done() {
        let mut program = Program::default();
        program.start(line("MA0,RP2"));
        let mut left = Vec::new();
        while let Some(command) = program.take() {
            if command.mnemonic == Mnemonic::RP {
                program.repeat(2);
                left.push(program.repeats_left());
            }
        }
        assert_eq!(left, [1, 0, 0]);
    }

    #[test]
    fn a_condition_passes_the_rest_of_its_own_list_by() {
        let mut program = Program::default();
        program.start(line("MR0,MR1"));
        program.take();
        assert!(program.call(line("MR2,MR3")));
        program.take();
        program.skip_rest();
        assert_eq!(program.take(), Some(Command::with(Mnemonic::MR, 1)));
        assert_eq!(program.take(), None);
    }
}
