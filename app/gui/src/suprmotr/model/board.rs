//! What is done with the macros on a board, line by line: read, stored and read back, compared with a file, run.
//!
//! A line ends a macro that runs, so the status is asked first, by its single character, and nothing is sent while it tells of a macro or a wait.

use std::collections::VecDeque;

use brushwork_link::device::{Event, Identity, Request};
use brushwork_suprmotr_client::SuprMotrFacts;
use brushwork_suprmotr_macros::{Checked, Macro, check, written};
use brushwork_suprmotr_wire::{
    Command, EXECUTE, Line, Mnemonic, Progress, Radix, Report, Single, operation, parse_report,
};

use super::channels::holds_lines;
use crate::mcl::DocId;
use crate::suprmotr::messages::MacrosMessage;

/// Answers to these lines begin with this number.
const FIRST_ID: u64 = 1 << 47;

/// The file in front as it was checked last.
#[derive(Debug)]
struct Known {
    id: DocId,
    revision: u64,
    checked: Checked,
}

/// What is to be done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Job {
    /// All macros become a file; names come from the one in front.
    Read,
    /// What the file in front and the board have, side by side.
    Compare,
    /// The macros of the file in front, one after the other.
    Store,
    /// One macro is run.
    Run(u8),
}

/// What waits for its answer.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Stage {
    /// `%`: whether lines may be sent.
    Status,
    /// The list of all macros.
    List,
    /// A definition.
    Define(Line),
    /// A macro that was defined, as the board has it.
    Back(Line),
    /// A call.
    Call(u8),
}

/// A job under way.
#[derive(Debug)]
struct Work {
    job: Job,
    /// What comes next.
    next: Stage,
    left: VecDeque<Line>,
    stored: usize,
    /// How the board writes its numbers, as its status said.
    radix: Radix,
    /// The line that waits for its answer, with its number. The link answers each in its time.
    waiting: Option<(u64, Vec<u8>)>,
}

/// What came of a job.
#[derive(Debug, PartialEq, Eq)]
pub enum Outcome {
    /// A sentence.
    Done(String),
    /// Why not.
    Failed(String),
    /// A file of what is on the board, and a sentence.
    File(String, String),
}

/// The macros of a board, as far as this window has to do with them.
#[derive(Debug, Default)]
pub struct Board {
    known: Option<Known>,
    /// The macro that is to be run.
    pub chosen: u8,
    /// A macro 0 may be stored: it runs at power-up.
    pub accepts_autostart: bool,
    work: Option<Work>,
    outcome: Option<Outcome>,
    asked: u64,
}

impl Board {
    /// The file in front, checked: anew if it has changed.
    pub fn checked(&mut self, id: DocId, revision: u64, text: impl FnOnce() -> String) -> &Checked {
        if self.known.as_ref().is_none_or(|known| (known.id, known.revision) != (id, revision)) {
            self.known = Some(Known { id, revision, checked: check(&text()) });
            self.accepts_autostart = false;
        }
        &self.known.get_or_insert_with(|| Known { id, revision, checked: Checked::default() }).checked
    }

    /// The file as it was checked last.
    fn file(&self) -> Option<&Checked> {
        self.known.as_ref().map(|known| &known.checked)
    }

    /// Whether something is under way.
    pub fn is_busy(&self) -> bool {
        self.work.is_some()
    }

    /// What is under way, as a sentence.
    pub fn progress(&self) -> Option<String> {
        let work = self.work.as_ref()?;
        Some(match work.job {
            Job::Read | Job::Compare => "Reading the macros of the board …".to_owned(),
            Job::Store => {
                MacrosMessage::Storing { stored: work.stored, of: work.stored + work.left.len() }.to_string()
            }
            Job::Run(number) => MacrosMessage::Calling { number }.to_string(),
        })
    }

    /// Begins a job, unless one is under way.
    pub fn begin(&mut self, job: Job) {
        if self.work.is_some() {
            return;
        }
        let macros = self.file().filter(|_| job == Job::Store).map_or(&[][..], |file| &file.macros);
        let left = macros.iter().map(Macro::as_line).collect();
        self.work =
            Some(Work { job, next: Stage::Status, left, stored: 0, radix: Radix::Decimal, waiting: None });
    }

    /// What is to be sent now.
    pub fn next(&mut self, identity: &Identity) -> Option<Request> {
        SuprMotrFacts::of(identity)?;
        let work = self.work.as_mut()?;
        if work.waiting.is_some() {
            return None;
        }
        let bytes = bytes_of(&work.next, work.radix);
        self.asked += 1;
        let id = FIRST_ID + self.asked;
        work.waiting = Some((id, bytes.clone()));
        Some(Request::Raw { id, bytes })
    }

    /// The link is busy: the same line is sent again.
    pub fn not_sent(&mut self) {
        if let Some(work) = &mut self.work {
            work.waiting = None;
        }
    }

    /// Takes in an answer.
    pub fn take(&mut self, event: &Event) -> bool {
        let Event::RawReply { id, result } = event else { return false };
        if *id <= FIRST_ID {
            return false;
        }
        let Some(work) = &mut self.work else { return true };
        let Some((_, bytes)) = work.waiting.take_if(|(waiting, ..)| waiting == id) else { return true };
        match result {
            Ok(reply) => self.answered(&bytes, reply),
            Err(why) => self.end(Outcome::Failed(why.to_string())),
        }
        true
    }

    fn answered(&mut self, sent: &[u8], reply: &[u8]) {
        let Some(work) = &mut self.work else { return };
        let heard = heard(&work.next, work.radix, sent, reply);
        let after = match (&work.next, heard) {
            (Stage::Define(line), _) => Ok(Stage::Back(line.clone())),
            (Stage::Call(number), _) => {
                Err(Outcome::Done(MacrosMessage::Called { number: *number }.to_string()))
            }
            (Stage::Status | Stage::List | Stage::Back(_), None) => Err(Outcome::Failed(
                "The board's answer was not understood. Nothing more was sent.".to_owned(),
            )),
            (Stage::Status, Some(report)) => {
                let status = report.status().unwrap_or_default();
                let is_hexadecimal = status.operation & operation::HEXADECIMAL != 0;
                work.radix = if is_hexadecimal { Radix::Hexadecimal } else { Radix::Decimal };
                if holds_lines(status) {
                    Err(Outcome::Failed(
                        "A macro or a wait is in process, which a line would end. Stop it first.".to_owned(),
                    ))
                } else {
                    match work.job {
                        Job::Read | Job::Compare => Ok(Stage::List),
                        Job::Store => next_of(work),
                        Job::Run(number) => Ok(Stage::Call(number)),
                    }
                }
            }
            (Stage::Back(line), Some(report)) => {
                if report.macros().any(|told| told == line) {
                    work.stored += 1;
                    next_of(work)
                } else {
                    let number = line.defines.unwrap_or_default();
                    Err(Outcome::Failed(MacrosMessage::NotStored { number }.to_string()))
                }
            }
            (Stage::List, Some(report)) => {
                let (told, job) = (report.macros().cloned().collect::<Vec<_>>(), work.job.clone());
                Err(self.listed(&told, &job))
            }
        };
        match after {
            Ok(stage) => {
                if let Some(work) = &mut self.work {
                    work.next = stage;
                }
            }
            Err(outcome) => self.end(outcome),
        }
    }

    /// What a list of all macros is good for.
    fn listed(&self, told: &[Line], job: &Job) -> Outcome {
        let empty = Checked::default();
        let file = self.file().unwrap_or(&empty);
        match job {
            Job::Read => {
                let macros: Vec<(u8, Vec<Command>)> =
                    told.iter().filter_map(|line| Some((line.defines?, line.commands.clone()))).collect();
                let said = MacrosMessage::Read { macros: counted(macros.len()) }.to_string();
                Outcome::File(written(&macros, file), said)
            }
            Job::Compare | Job::Store | Job::Run(_) => Outcome::Done(compared(told, file)),
        }
    }

    fn end(&mut self, outcome: Outcome) {
        self.work = None;
        self.outcome = Some(outcome);
    }

    /// What came of the last job, once.
    pub fn take_outcome(&mut self) -> Option<Outcome> {
        self.outcome.take()
    }

    /// Another unit, or none: what was under way has ended.
    pub fn forget(&mut self) {
        if self.work.is_some() {
            self.end(Outcome::Failed("The link ended before the board answered.".to_owned()));
        }
    }
}

/// The macro that is stored next; without one all are.
fn next_of(work: &mut Work) -> Result<Stage, Outcome> {
    let stored = work.stored;
    work.left
        .pop_front()
        .map(Stage::Define)
        .ok_or_else(|| Outcome::Done(MacrosMessage::Stored { macros: counted(stored) }.to_string()))
}

/// The command whose report is waited for.
fn question(stage: &Stage) -> Option<Command> {
    match stage {
        Stage::Status => Some(Command::plain(Mnemonic::TS)),
        Stage::List => Some(Command::plain(Mnemonic::TM)),
        Stage::Back(Line { defines: Some(0), .. }) => Some(Command::plain(Mnemonic::TZ)),
        Stage::Back(line) => Some(Command::with(Mnemonic::TM, line.defines.unwrap_or_default().into())),
        Stage::Define(_) | Stage::Call(_) => None,
    }
}

fn bytes_of(stage: &Stage, radix: Radix) -> Vec<u8> {
    let line = match stage {
        Stage::Status => return vec![Single::Status.character()],
        Stage::List | Stage::Back(_) => {
            question(stage).map(|command| command.text(radix)).unwrap_or_default()
        }
        Stage::Define(line) => line.text(radix),
        Stage::Call(number) => Command::with(Mnemonic::MC, (*number).into()).text(radix),
    };
    let mut bytes = line.into_bytes();
    bytes.push(EXECUTE);
    bytes
}

/// The report in an answer.
fn heard(stage: &Stage, radix: Radix, sent: &[u8], reply: &[u8]) -> Option<Report> {
    match parse_report(&question(stage)?, radix, sent, reply) {
        Progress::Done { report, .. } => Some(report),
        Progress::Incomplete | Progress::Bad(_) => None,
    }
}

fn counted(count: usize) -> String {
    if count == 1 { MacrosMessage::One.to_string() } else { MacrosMessage::Many { count }.to_string() }
}

/// What a board and a file have, side by side, as sentences.
fn compared(told: &[Line], file: &Checked) -> String {
    let on_board = |number: u8| told.iter().find(|line| line.defines == Some(number));
    let names = |wanted: &dyn Fn(&Macro) -> bool| {
        let found = file.macros.iter().filter(|known| wanted(known));
        found.map(|known| format!("{} {}", known.number, known.name)).collect::<Vec<_>>().join(", ")
    };
    let missing = names(&|known| on_board(known.number).is_none());
    let other = names(&|known| on_board(known.number).is_some_and(|line| *line != known.as_line()));
    let only: Vec<String> = told
        .iter()
        .filter_map(|line| line.defines)
        .filter(|number| !file.macros.iter().any(|known| known.number == *number))
        .map(|number| number.to_string())
        .collect();
    if missing.is_empty() && other.is_empty() && only.is_empty() {
        return MacrosMessage::Same { macros: counted(told.len()) }.to_string();
    }
    let said = [
        (!other.is_empty()).then(|| MacrosMessage::Differ { names: other }.to_string()),
        (!missing.is_empty()).then(|| MacrosMessage::NotThere { names: missing }.to_string()),
        (!only.is_empty()).then(|| MacrosMessage::OnlyThere { numbers: only.join(", ") }.to_string()),
    ];
    said.into_iter().flatten().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_board_and_a_file_are_compared_macro_by_macro() {
        let file = check("macro a = 1\n    MA 5\nmacro b = 2\n    GH\nmacro c = 3\n    GH\n");
        assert!(file.is_right());
        let lines: Vec<Line> = file.macros.iter().map(Macro::as_line).collect();
        assert_eq!(compared(&lines, &file), "The board and the file have the same: 3 macros.");
        let turned = Line { defines: Some(2), commands: lines[0].commands.clone() };
        let more = Line { defines: Some(9), commands: lines[0].commands.clone() };
        assert_eq!(
            compared(&[lines[0].clone(), turned, more], &file),
            "Other commands on the board: 2 b. Not on the board: 3 c. On the board alone: 9."
        );
    }
}
