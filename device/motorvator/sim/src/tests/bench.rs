//! A board in virtual time.

use crate::assumed::INSTRUCTION_TIME;
use crate::{Happening, Motorvator, What};
use brushwork_script::mecc::compile;
use brushwork_script::text::Lines;
use std::time::Duration;

/// What a program may take from an event to what it does about it: some instructions.
pub const SOON: Duration = INSTRUCTION_TIME.saturating_mul(20);

pub struct Bench {
    pub board: Motorvator,
    pub trace: Vec<Happening>,
    /// Frames that are out, without their ends, with the time.
    pub frames: Vec<(f64, String)>,
    /// Other words of the board.
    pub words: String,
}

impl Bench {
    /// A board whose program has just begun.
    pub fn new(text: &str) -> Self {
        let compiled = compile(text);
        let lines = Lines::of(text);
        let page: String =
            compiled.diagnostics.iter().map(|said| said.render("test.mecc", text, &lines)).collect();
        let mut board = Motorvator::new(Some(compiled.program.unwrap_or_else(|| panic!("{page}"))));
        board.trace();
        board.start();
        Self { board, trace: Vec::new(), frames: Vec::new(), words: String::new() }
    }

    /// Lets time pass up to so many seconds since the start.
    pub fn run(&mut self, to_s: f64) -> &mut Self {
        let to = Duration::from_secs_f64(to_s);
        while self.board.now() < to {
            // In unequal pieces, as a server has them.
            let next = self.board.now() + Duration::from_micros(33_333);
            self.board.advance(next.min(to));
            while let Some(line) = self.board.take_output() {
                let text = String::from_utf8(line).expect("a board sends ASCII");
                match text.strip_suffix('\r').filter(|text| text.starts_with("073")) {
                    Some(frame) => self.frames.push((self.board.now().as_secs_f64(), frame.to_owned())),
                    None => self.words += &text,
                }
            }
        }
        self.trace.extend(self.board.take_trace());
        self
    }

    pub fn send(&mut self, line: &str) -> &mut Self {
        self.board.receive(format!("{line}\r").as_bytes());
        self
    }

    /// The texts of the frames.
    pub fn sent(&self) -> Vec<&str> {
        self.frames.iter().map(|(_, frame)| frame.as_str()).collect()
    }

    /// The times of what was seen, in seconds, where `pick` takes it.
    pub fn times(&self, pick: impl Fn(&What) -> bool) -> Vec<f64> {
        self.trace.iter().filter(|seen| pick(&seen.what)).map(|seen| seen.t).collect()
    }

    /// What the display showed, with the times.
    pub fn shown(&self) -> Vec<(f64, &str)> {
        let display = |seen: &'_ Happening| matches!(seen.what, What::Display { .. });
        self.trace
            .iter()
            .filter(|seen| display(seen))
            .map(|seen| match &seen.what {
                What::Display { text } => (seen.t, text.as_str()),
                _ => unreachable!(),
            })
            .collect()
    }
}

/// Whether times are as they should be: not before, and only some instructions later.
#[track_caller]
pub fn assert_times(found: &[f64], expected: &[f64]) {
    let soon = SOON.as_secs_f64();
    let fits = found.len() == expected.len()
        && found.iter().zip(expected).all(|(found, expected)| (-1e-9..soon).contains(&(found - expected)));
    assert!(fits, "{found:?} instead of {expected:?}");
}
