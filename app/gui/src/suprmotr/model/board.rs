//! What is done with the macros on a board and the file in front: read, stored and read back, compared, run.

use std::time::Duration;

use brushwork_link::device::{Event, Identity, Request};
use brushwork_suprmotr::rehearsal::{Happening, Rehearsal, State};
use brushwork_suprmotr::transfer::{self, Done, Step, Transfer, Trouble};
use brushwork_suprmotr_client::is_suprmotr;
use brushwork_suprmotr_macros::{Checked, Macro, check, written};
use brushwork_suprmotr_wire::{Command, Line, Radix};

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

/// A job under way.
#[derive(Debug)]
struct Work {
    job: Job,
    transfer: Transfer,
    /// The number of what waits for its answer. The link answers each in its time.
    waiting: Option<u64>,
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
    /// A macro of the file in front, command by command on a simulated board.
    steps: Option<Steps>,
}

/// A macro that is stepped through.
#[derive(Debug)]
struct Steps {
    run: Rehearsal,
    id: DocId,
    revision: u64,
    told: String,
    /// Byte of the file at which the command stands that has just begun.
    at: Option<usize>,
}

/// How long one step may take in the board's time: a wait for an input that never comes has no end.
const LONGEST_STEP: Duration = Duration::from_secs(70);

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

    /// Begins to step through a macro of the file in front, on a simulated board that has all of them.
    pub fn begin_steps(&mut self, number: u8) {
        let Some(known) = &self.known else { return };
        match Rehearsal::of(&known.checked.macros) {
            Ok(mut run) => {
                run.start(number);
                let (id, revision) = (known.id, known.revision);
                self.steps = Some(Steps { run, id, revision, told: String::new(), at: None });
                self.step();
            }
            Err(why) => {
                let why = why.to_string();
                self.outcome = Some(Outcome::Failed(MacrosMessage::NotSimulated { why }.to_string()));
            }
        }
    }

    /// Carries out the command that stands there, up to the beginning of the next one.
    pub fn step(&mut self) {
        let (Some(steps), Some(known)) = (&mut self.steps, &self.known) else { return };
        let happened = steps.run.step(LONGEST_STEP);
        let (counts, seconds) = (steps.run.unit().position(), steps.run.elapsed().as_secs_f64());
        let mut told: Vec<String> = happened.iter().filter_map(aside).collect();
        let begun = happened.iter().rev().find_map(|happening| match happening {
            Happening::Step(step) => {
                let number = step.of_macro?;
                let found = known.checked.macros.iter().find(|known| known.number == number)?;
                let at = found.places.get(step.index)?.start as usize;
                Some((at, found.name.clone(), step.command.text(Radix::Decimal)))
            }
            Happening::Said(_) | Happening::Outputs(_) => None,
        });
        let now = match (begun, steps.run.state()) {
            (Some((at, place, command)), _) => {
                steps.at = Some(at);
                MacrosMessage::Stepped { place, command, counts, seconds }.to_string()
            }
            (None, state) => {
                steps.at = None;
                let how = match state {
                    State::Running => "it waits for longer than a minute",
                    State::Ended => "ended",
                    State::Refused(_) => "a command was refused",
                    State::LetGo => "the motor was let go, since it lagged too far behind",
                };
                MacrosMessage::SteppedOver { how, counts, seconds }.to_string()
            }
        };
        told.insert(0, now);
        steps.told = told.join("; ");
    }

    /// Where the steps are: what is told, and the byte of the file; `None` where the file is another one by now.
    pub fn steps(&self) -> Option<(&str, Option<usize>)> {
        let (steps, known) = (self.steps.as_ref()?, self.known.as_ref()?);
        let is_same = (known.id, known.revision) == (steps.id, steps.revision);
        is_same.then_some((steps.told.as_str(), steps.at))
    }

    /// Whether a step is left.
    pub fn can_step(&self) -> bool {
        self.steps().is_some() && self.steps.as_ref().is_some_and(|steps| !steps.run.is_over())
    }

    /// Ends the steps.
    pub fn end_steps(&mut self) {
        self.steps = None;
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
                let (stored, of) = work.transfer.stored();
                MacrosMessage::Storing { stored, of }.to_string()
            }
            Job::Run(number) => MacrosMessage::Calling { number }.to_string(),
        })
    }

    /// Begins a job, unless one is under way.
    pub fn begin(&mut self, job: Job) {
        if self.work.is_some() {
            return;
        }
        let lines = || self.file().map_or(&[][..], |file| &file.macros).iter().map(Macro::as_line).collect();
        let transfer = Transfer::new(match job {
            Job::Read | Job::Compare => transfer::Job::List,
            Job::Store => transfer::Job::Store(lines()),
            Job::Run(number) => transfer::Job::Call(number),
        });
        self.work = Some(Work { job, transfer, waiting: None });
    }

    /// What is to be sent now.
    pub fn next(&mut self, identity: &Identity) -> Option<Request> {
        let work = self.work.as_mut().filter(|work| is_suprmotr(identity) && work.waiting.is_none())?;
        self.asked += 1;
        let id = FIRST_ID + self.asked;
        work.waiting = Some(id);
        Some(Request::Raw { id, bytes: work.transfer.bytes().to_vec() })
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
        if work.waiting.take_if(|waiting| waiting == id).is_none() {
            return true;
        }
        let step = match result {
            Ok(reply) => work.transfer.answered(reply),
            Err(why) => {
                self.end(Outcome::Failed(why.to_string()));
                return true;
            }
        };
        if let Step::Ended(ended) = step {
            let job = work.job.clone();
            let outcome = match ended {
                Ok(Done::Listed(told)) => self.listed(&told, &job),
                Ok(Done::Stored(stored)) => {
                    Outcome::Done(MacrosMessage::Stored { macros: counted(stored) }.to_string())
                }
                Ok(Done::Called(number)) => Outcome::Done(MacrosMessage::Called { number }.to_string()),
                Err(Trouble::MacroRuns) => Outcome::Failed(
                    "A macro or a wait is in process, which a line would end. Stop it first.".to_owned(),
                ),
                Err(Trouble::NoReport(_)) => Outcome::Failed(
                    "The board's answer was not understood. Nothing more was sent.".to_owned(),
                ),
                Err(Trouble::NotStored(number)) => {
                    Outcome::Failed(MacrosMessage::NotStored { number }.to_string())
                }
            };
            self.end(outcome);
        }
        true
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

/// What a simulated board says or gives besides.
fn aside(happening: &Happening) -> Option<String> {
    match happening {
        Happening::Step(_) => None,
        Happening::Said(text) => {
            let text = text.trim_end_matches('\u{3}').trim_end().replace("\r\n", " | ");
            Some(MacrosMessage::Says { text }.to_string())
        }
        Happening::Outputs(outputs) => {
            Some(MacrosMessage::Gives { bits: format!("{outputs:016b}") }.to_string())
        }
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
    fn a_macro_is_stepped_through_command_by_command_until_it_ends() {
        let mut board = Board::default();
        let text = "macro a = 1\n    MA 500, WS 50\n    CN 1, TT\n";
        board.checked(DocId(3), 1, || text.to_owned());
        board.begin_steps(1);
        let mut places = Vec::new();
        while board.can_step() {
            let (_, at) = board.steps().expect("it goes on");
            places.push(at.map(|at| &text[at..at + 2]));
            board.step();
        }
        assert_eq!(places, [Some("MA"), Some("WS"), Some("CN"), Some("TT")]);
        let (told, at) = board.steps().expect("it stands");
        assert!(told.starts_with("Simulated: ended at ") && told.contains("0T0:+0000000500"), "{told}");
        assert_eq!(at, None);
        // Another text is another program.
        board.checked(DocId(3), 2, || text.to_owned());
        assert!(board.steps().is_none() && !board.can_step());
    }

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
