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
    /// The macro that it is; none for a line.
    of_macro: Option<u8>,
}

/// A command that was begun, for those who look on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// When.
    pub at: Duration,
    /// In which macro it stands; none for a line.
    pub of_macro: Option<u8>,
    /// Which of its commands it is, from 0.
    pub index: usize,
    /// The command.
    pub command: Command,
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
        self.frames.push(Frame::new(commands, None));
    }

    /// Begins a macro, in place of all that runs.
    pub fn start_macro(&mut self, number: u8, commands: Vec<Command>) {
        self.end();
        self.frames.push(Frame::new(commands, Some(number)));
    }

    /// Calls a macro from the line or macro that runs; whether that goes so deep.
    pub fn call(&mut self, number: u8, commands: Vec<Command>) -> bool {
        self.leave_finished();
        if self.frames.len() >= MOST_NESTED {
            return false;
        }
        self.frames.push(Frame::new(commands, Some(number)));
        true
    }

    /// Ends all that runs.
    pub fn end(&mut self) {
        self.frames.clear();
        self.wait = None;
        self.has_reported = false;
    }

    /// Whether anything is still to be done, or waited for.
    pub fn is_running(&self) -> bool {
        self.wait.is_some() || self.frames.iter().any(|frame| frame.next < frame.commands.len())
    }

    /// Whether a macro is among it.
    pub fn is_in_macro(&self) -> bool {
        self.frames.iter().any(|frame| frame.of_macro.is_some())
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
    pub fn take(&mut self, at: Duration) -> Option<Step> {
        let command = self.peek()?;
        let frame = self.frames.last_mut()?;
        frame.next += 1;
        Some(Step { at, of_macro: frame.of_macro, index: frame.next - 1, command })
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
    fn new(commands: Vec<Command>, of_macro: Option<u8>) -> Self {
        Self { commands, next: 0, repeats: [None; MOST_COMMANDS], of_macro }
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
            && let Some(Step { command, .. }) = program.take(Duration::ZERO)
        {
            match command.mnemonic {
                Mnemonic::RP => program.repeat(command.value().expect("a count").unsigned_abs()),
                Mnemonic::MC => {
                    let called = macros.iter().find(|(number, _)| command.number == Some(*number));
                    let deep = program.call(1, called.map(|(_, text)| line(text)).unwrap_or_default());
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
        while let Some(Step { command, .. }) = program.take(Duration::ZERO) {
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
        let take = |program: &mut Program| program.take(Duration::ZERO);
        take(&mut program);
        assert!(program.call(9, line("MR2,MR3")));
        let inside = take(&mut program).expect("it has two");
        assert_eq!((inside.of_macro, inside.index), (Some(9), 0));
        program.skip_rest();
        let back = take(&mut program).expect("the line goes on");
        assert_eq!((back.of_macro, back.index, back.command), (None, 1, Command::with(Mnemonic::MR, 1)));
        assert_eq!(take(&mut program), None);
    }
}
