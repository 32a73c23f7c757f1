//! `brushwork macro upload` and `read`: macros to a controller and back.
//!
//! Nothing runs of it: a macro is called by an explicit act alone. But macro 0 runs by itself at the next power-up, which is said before.

use std::time::{Duration, Instant};

use brushwork_link::device::{Event, PollRate, Request};
use brushwork_suprmotr_client::SuprMotrFacts;
use brushwork_suprmotr_macros::{Checked, check, written};
use brushwork_suprmotr_wire::{
    Command, EXECUTE, Line, Mnemonic, Progress, Radix, Report, Single, operation, parse_report,
};

use super::args::{ReadArgs, UploadArgs};
use super::source::{Source, is_standard};
use crate::client::{Client, ask};
use crate::messages::CliMacroMessage;
use crate::shared_args::ConnectArgs;
use crate::{Exit, Interrupt, NewFile, Output, say};

/// How long an answer may take: a list of all macros is four seconds long at 9600 baud.
const ANSWER_LIMIT: Duration = Duration::from_secs(15);

/// Stores every macro of a file, and reads each back.
pub fn upload(args: &UploadArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let source = Source::read(&args.file)?;
    let said = source.rendered();
    if !said.is_empty() {
        say(said.trim_end());
    }
    if !source.checked.is_right() {
        return Err(Exit::ScriptWrong);
    }
    let mut board = Board::connect(&args.connect, interrupt)?;
    board.check_idle()?;
    for known in &source.checked.macros {
        let mut line = known.as_line().text(board.radix).into_bytes();
        line.push(EXECUTE);
        board.exchange(line)?;
        let told = board.macros_told(known.number)?;
        let is_there = told.iter().any(|line| *line == known.as_line());
        if !is_there {
            let name = known.name.clone();
            return Err(Exit::NotTaken.saying(CliMacroMessage::NotStored { name, number: known.number }));
        }
        out.line(format!("macro {} {}: stored and read back", known.number, known.name))?;
    }
    Ok(Exit::Done)
}

/// Writes a file of the macros that a controller has.
pub fn read(args: &ReadArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let is_printed = is_standard(&args.file);
    let file = NewFile::new(&args.file, args.replace);
    if !is_printed {
        file.check()?;
    }
    let mut board = Board::connect(&args.connect, interrupt)?;
    board.check_idle()?;
    let told = board.macros_told(0)?;
    let macros: Vec<(u8, Vec<Command>)> =
        told.into_iter().filter_map(|line| Some((line.defines?, line.commands))).collect();
    // A file that is replaced gives its names to the macros of the same numbers.
    let names = if is_printed { Checked::default() } else { names_in(args) };
    let text = written(&macros, &names);
    if is_printed {
        out.bytes(text.as_bytes())?;
    } else {
        let mut file = file;
        file.write(text.as_bytes())?;
        let word = if macros.len() == 1 { "macro" } else { "macros" };
        out.line(format!("{}: {} {word}", args.file.display(), macros.len()))?;
    }
    Ok(Exit::Done)
}

fn names_in(args: &ReadArgs) -> Checked {
    brushwork_link::bounded::read_text(&args.file).map(|text| check(&text)).unwrap_or_default()
}

/// A controller that is spoken to line by line.
struct Board<'a> {
    client: Client,
    interrupt: &'a Interrupt,
    radix: Radix,
    next_id: u64,
}

impl<'a> Board<'a> {
    fn connect(connect: &ConnectArgs, interrupt: &'a Interrupt) -> Result<Self, Exit> {
        let client = Client::connect(connect, PollRate::Off, interrupt)?;
        let Some(facts) = SuprMotrFacts::of(&client.identity) else {
            let title = client.identity.title().to_owned();
            return Err(Exit::Refused.saying(CliMacroMessage::KeepsNone { title }));
        };
        Ok(Self { client, interrupt, radix: facts.radix(), next_id: 1 })
    }

    /// A line would end a macro that runs.
    fn check_idle(&mut self) -> Result<(), Exit> {
        let reply = self.exchange(vec![Single::Status.character()])?;
        let report = self.report(&Command::plain(Mnemonic::TS), &[Single::Status.character()], &reply)?;
        let runs = report
            .status()
            .is_some_and(|status| status.operation & (operation::MACRO | operation::WAIT) != 0);
        if runs { Err(Exit::Refused.saying(CliMacroMessage::MacroRuns)) } else { Ok(()) }
    }

    /// A macro as the controller has it, or all with 0; macro 0 has a command of its own, but stands among all too.
    fn macros_told(&mut self, number: u8) -> Result<Vec<Line>, Exit> {
        let command = if number == 0 {
            Command::plain(Mnemonic::TM)
        } else {
            Command::with(Mnemonic::TM, number.into())
        };
        let mut line = command.text(self.radix).into_bytes();
        line.push(EXECUTE);
        let reply = self.exchange(line.clone())?;
        let report = self.report(&command, &line, &reply)?;
        Ok(report.macros().cloned().collect())
    }

    fn report(&self, command: &Command, sent: &[u8], reply: &[u8]) -> Result<Report, Exit> {
        match parse_report(command, self.radix, sent, reply) {
            Progress::Done { report, .. } => Ok(report),
            Progress::Incomplete | Progress::Bad(_) => {
                let command = command.mnemonic.row().title.to_owned();
                Err(Exit::NoLink.saying(CliMacroMessage::NoReport { command }))
            }
        }
    }

    fn exchange(&mut self, bytes: Vec<u8>) -> Result<Vec<u8>, Exit> {
        let id = self.next_id;
        self.next_id += 1;
        ask(self.client.device(), Request::Raw { id, bytes })?;
        let deadline = Instant::now() + ANSWER_LIMIT;
        while Instant::now() < deadline {
            match self.client.next_event(self.interrupt)? {
                Some(Event::RawReply { id: answered, result }) if answered == id => {
                    return result.map_err(|failure| Exit::Refused.saying(failure.to_string()));
                }
                Some(Event::Failure(failure)) => say(failure.to_string()),
                _ => {}
            }
        }
        Err(Exit::NoLink.saying(CliMacroMessage::NoReport { command: "the line".to_owned() }))
    }
}
