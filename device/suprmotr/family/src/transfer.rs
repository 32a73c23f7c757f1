//! What is done with the macros on a board, line by line: listed, stored and read back, called.
//!
//! A line ends a macro that runs, so the status is asked first, by its single character, and no line is sent while it tells of a macro or a wait.
//! Who has the link sends what [`Transfer::bytes`] gives and hands the reply to [`Transfer::answered`].

use brushwork_suprmotr_wire::{
    Command, EXECUTE, Line, Mnemonic, Progress, Radix, Report, Single, Status, operation, parse_report,
};
use std::collections::VecDeque;

/// What is to be done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Job {
    /// All macros are listed.
    List,
    /// These definitions are stored, one after the other, and each read back.
    Store(Vec<Line>),
    /// One macro is called.
    Call(u8),
}

/// What came of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Done {
    /// The macros of the board.
    Listed(Vec<Line>),
    /// So many were stored.
    Stored(usize),
    /// The macro of this number was called.
    Called(u8),
}

/// Why nothing more is sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// A macro or a wait is in process, which a line would end.
    MacroRuns,
    /// The report to this command was not understood.
    NoReport(Mnemonic),
    /// The macro of this number did not read back as it was defined.
    NotStored(u8),
}

/// How far it is after an answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// There is more to be sent.
    GoesOn,
    /// The macro of this number was stored and read back, and there may be more to be sent.
    Stored(u8),
    /// That was all.
    Ended(Result<Done, Trouble>),
}

/// What waits for its answer.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Stage {
    /// `%`: whether lines may be sent.
    Status,
    List,
    Define(Line),
    /// A macro that was defined, as the board has it.
    Back(Line),
    Call(u8),
    Nothing,
}

/// A job under way.
#[derive(Clone, Debug)]
pub struct Transfer {
    stage: Stage,
    /// What follows the status, but for definitions.
    then: Stage,
    left: VecDeque<Line>,
    stored: usize,
    /// How the board writes its numbers, as its status said.
    radix: Radix,
    sent: Vec<u8>,
}

impl Transfer {
    /// Begins with the status.
    #[must_use]
    pub fn new(job: Job) -> Self {
        let (then, left) = match job {
            Job::List => (Stage::List, Vec::new()),
            Job::Store(lines) => (Stage::Nothing, lines),
            Job::Call(number) => (Stage::Call(number), Vec::new()),
        };
        let stage = Stage::Status;
        Self { stage, then, left: left.into(), stored: 0, radix: Radix::Decimal, sent: Vec::new() }
    }

    /// How many macros are stored, and how many there are to be.
    #[must_use]
    pub fn stored(&self) -> (usize, usize) {
        let under_way = matches!(self.stage, Stage::Define(_) | Stage::Back(_));
        (self.stored, self.stored + self.left.len() + usize::from(under_way))
    }

    /// The bytes that are to be sent now; the same again until they are answered.
    pub fn bytes(&mut self) -> &[u8] {
        let line = match &self.stage {
            Stage::Status | Stage::Nothing => String::new(),
            Stage::List | Stage::Back(_) => {
                self.question().map_or_else(String::new, |of| of.text(self.radix))
            }
            Stage::Define(line) => line.text(self.radix),
            Stage::Call(number) => Command::with(Mnemonic::MC, (*number).into()).text(self.radix),
        };
        self.sent = line.into_bytes();
        // A carriage return alone would repeat what was sent last.
        self.sent.push(if self.sent.is_empty() { Single::Status.character() } else { EXECUTE });
        &self.sent
    }

    /// Takes in what came back.
    pub fn answered(&mut self, reply: &[u8]) -> Step {
        let report = match self.question().map(|of| (of, self.heard(&of, reply))) {
            None => Report::default(),
            Some((_, Some(report))) => report,
            Some((of, None)) => return Step::Ended(Err(Trouble::NoReport(of.mnemonic))),
        };
        match std::mem::replace(&mut self.stage, Stage::Nothing) {
            Stage::Status => self.begin(report.status().unwrap_or_default()),
            Stage::List => Step::Ended(Ok(Done::Listed(report.macros().cloned().collect()))),
            Stage::Define(line) => {
                self.stage = Stage::Back(line);
                Step::GoesOn
            }
            Stage::Back(line) => {
                let number = line.defines.unwrap_or_default();
                if !report.macros().any(|told| *told == line) {
                    return Step::Ended(Err(Trouble::NotStored(number)));
                }
                self.stored += 1;
                match self.left.pop_front() {
                    Some(line) => {
                        self.stage = Stage::Define(line);
                        Step::Stored(number)
                    }
                    None => Step::Ended(Ok(Done::Stored(self.stored))),
                }
            }
            Stage::Call(number) => Step::Ended(Ok(Done::Called(number))),
            Stage::Nothing => Step::Ended(Ok(Done::Stored(self.stored))),
        }
    }

    fn begin(&mut self, status: Status) -> Step {
        if status.operation & (operation::MACRO | operation::WAIT) != 0 {
            return Step::Ended(Err(Trouble::MacroRuns));
        }
        let is_hexadecimal = status.operation & operation::HEXADECIMAL != 0;
        self.radix = if is_hexadecimal { Radix::Hexadecimal } else { Radix::Decimal };
        let then = std::mem::replace(&mut self.then, Stage::Nothing);
        self.stage = self.left.pop_front().map_or(then, Stage::Define);
        if self.stage == Stage::Nothing { Step::Ended(Ok(Done::Stored(0))) } else { Step::GoesOn }
    }

    /// The command whose report is waited for.
    fn question(&self) -> Option<Command> {
        match &self.stage {
            Stage::Status => Some(Command::plain(Mnemonic::TS)),
            Stage::List => Some(Command::plain(Mnemonic::TM)),
            // TM 0 lists all of them.
            Stage::Back(Line { defines: Some(0), .. }) => Some(Command::plain(Mnemonic::TZ)),
            Stage::Back(line) => Some(Command::with(Mnemonic::TM, line.defines.unwrap_or_default().into())),
            Stage::Define(_) | Stage::Call(_) | Stage::Nothing => None,
        }
    }

    fn heard(&self, asked: &Command, reply: &[u8]) -> Option<Report> {
        match parse_report(asked, self.radix, &self.sent, reply) {
            Progress::Done { report, .. } => Some(report),
            Progress::Incomplete | Progress::Bad(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_suprmotr_macros::{Macro, check};
    use brushwork_suprmotr_sim::{SuprMotr, SuprMotrBus, SuprMotrConfig};
    use brushwork_suprmotr_wire::Address;
    use std::time::Duration;

    fn bus() -> SuprMotrBus {
        let unit = SuprMotr::new(SuprMotrConfig::new(Address::FACTORY)).expect("a slide");
        let mut bus = SuprMotrBus::new(vec![unit]);
        bus.exchange(b"\x010", Duration::from_millis(50));
        bus
    }

    /// Carries a job through and gives the numbers that were told as stored, and its end.
    fn carried(bus: &mut SuprMotrBus, job: Job) -> (Vec<u8>, Result<Done, Trouble>) {
        let mut transfer = Transfer::new(job);
        let mut told = Vec::new();
        loop {
            let bytes = transfer.bytes().to_vec();
            assert_ne!(bytes, [EXECUTE], "a carriage return alone repeats the last line");
            let reply = bus.exchange(&bytes, Duration::from_secs(6));
            match transfer.answered(&reply) {
                Step::GoesOn => {}
                Step::Stored(number) => told.push(number),
                Step::Ended(end) => return (told, end),
            }
        }
    }

    fn lines() -> Vec<Line> {
        let file = check("macro start = 0\n    SO 3\nmacro out = 1\n    MA 5\nmacro home = 2\n    GH\n");
        assert!(file.is_right());
        file.macros.iter().map(Macro::as_line).collect()
    }

    #[test]
    fn what_is_stored_is_read_back_and_listed_in_both_number_modes() {
        for mode in ["DM", "HM"] {
            let mut bus = bus();
            bus.exchange(format!("{mode}\r").as_bytes(), Duration::from_millis(100));
            assert_eq!(carried(&mut bus, Job::Store(lines())), (vec![0, 1], Ok(Done::Stored(3))), "{mode}");
            assert_eq!(carried(&mut bus, Job::List).1, Ok(Done::Listed(lines())), "{mode}");
            assert_eq!(carried(&mut bus, Job::Store(Vec::new())).1, Ok(Done::Stored(0)));
        }
    }

    #[test]
    fn nothing_is_sent_beside_the_status_while_a_macro_runs() {
        let mut bus = bus();
        let waits = check("macro wait = 4\n    WA 60000\n");
        carried(&mut bus, Job::Store(waits.macros.iter().map(Macro::as_line).collect())).1.expect("stored");
        assert_eq!(carried(&mut bus, Job::Call(4)).1, Ok(Done::Called(4)));
        assert_eq!(carried(&mut bus, Job::List).1, Err(Trouble::MacroRuns));
        assert!(bus.suprmotrs()[0].is_in_macro(), "it goes on");
    }

    #[test]
    fn a_macro_that_reads_back_otherwise_and_a_report_that_is_none_end_it() {
        let mut transfer = Transfer::new(Job::Store(lines()));
        transfer.bytes();
        assert_eq!(transfer.answered(b"0S:00 80 00 00 00 00\r\n\x03"), Step::GoesOn);
        assert_eq!(transfer.stored(), (0, 3));
        transfer.bytes();
        assert_eq!(transfer.answered(b""), Step::GoesOn);
        transfer.bytes();
        let other = transfer.answered(b"MD0, SO+0000000004\r\n\x03");
        assert_eq!(other, Step::Ended(Err(Trouble::NotStored(0))));
        let mut transfer = Transfer::new(Job::List);
        transfer.bytes();
        assert_eq!(transfer.answered(b"?"), Step::Ended(Err(Trouble::NoReport(Mnemonic::TS))));
    }
}
