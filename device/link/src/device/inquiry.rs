//! A question to a firmware in bytes: how it takes them is what is to be found out, so nothing of the answer is known beforehand.

use std::time::Duration;

/// What a question may do, as far as its owner has agreed. It never moves a motor and never changes what is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Leave {
    /// Only what documented reads do.
    Read,
    /// Reads whose layout is a guess: what the firmware makes of them nobody knows.
    Guess,
    /// Settings are written in RAM.
    Write,
}

/// One question.
#[derive(Clone, Copy, Debug)]
pub struct Inquiry<'a> {
    /// The bytes of it, whole.
    pub bytes: &'a [u8],
    /// What it may do.
    pub leave: Leave,
    /// How often it is asked again while nothing comes.
    pub retries: u32,
}

/// What came back. Nothing is an answer too.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Heard {
    /// All that came until the answer was whole, or nothing more came.
    pub bytes: Vec<u8>,
    /// From the question to its answer, where that was whole.
    pub took: Option<Duration>,
}
