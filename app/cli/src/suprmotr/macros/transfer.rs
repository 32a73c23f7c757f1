//! `brushwork macro upload` and `read`: macros to a controller and back.
//!
//! Nothing runs of it: a macro is called by an explicit act alone. But macro 0 runs by itself at the next power-up, which is said before.

use std::time::{Duration, Instant};

use brushwork_link::device::{Event, PollRate, Request};
use brushwork_suprmotr::transfer::{Done, Job, Step, Transfer, Trouble};
use brushwork_suprmotr_client::is_suprmotr;
use brushwork_suprmotr_macros::{Checked, Macro, check, written};
use brushwork_suprmotr_wire::{Command, Line};

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
    let macros = &source.checked.macros;
    let tell = |out: &mut Output, known: &Macro| {
        out.line(format!("macro {} {}: stored and read back", known.number, known.name))
    };
    let mut board = Board::connect(&args.connect, interrupt)?;
    let job = Job::Store(macros.iter().map(Macro::as_line).collect());
    // They are told in their order, the last by the end of the job.
    let mut left = macros.iter();
    let ended = board.carry_out(job, &mut |_| Ok(left.next().map_or(Ok(()), |known| tell(out, known))?))?;
    if let Err(Trouble::NotStored(number)) = ended {
        let name = left.next().map(|known| known.name.clone()).unwrap_or_default();
        return Err(Exit::NotTaken.saying(CliMacroMessage::NotStored { name, number }));
    }
    done(ended)?;
    left.try_for_each(|known| tell(out, known))?;
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
    let told: Vec<Line> = match done(board.carry_out(Job::List, &mut |_| Ok(()))?)? {
        Done::Listed(lines) => lines,
        Done::Stored(_) | Done::Called(_) => Vec::new(),
    };
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

/// The end of a job, where nothing stood in its way.
fn done(ended: Result<Done, Trouble>) -> Result<Done, Exit> {
    ended.map_err(|trouble| match trouble {
        Trouble::MacroRuns => Exit::Refused.saying(CliMacroMessage::MacroRuns),
        Trouble::NoReport(mnemonic) => {
            Exit::NoLink.saying(CliMacroMessage::NoReport { command: mnemonic.row().title.to_owned() })
        }
        Trouble::NotStored(number) => {
            Exit::NotTaken.saying(CliMacroMessage::NotStored { name: String::new(), number })
        }
    })
}

/// A controller that is spoken to line by line.
struct Board<'a> {
    client: Client,
    interrupt: &'a Interrupt,
    next_id: u64,
}

impl<'a> Board<'a> {
    fn connect(connect: &ConnectArgs, interrupt: &'a Interrupt) -> Result<Self, Exit> {
        let client = Client::connect(connect, PollRate::Off, interrupt)?;
        if !is_suprmotr(&client.identity) {
            let title = client.identity.title().to_owned();
            return Err(Exit::Refused.saying(CliMacroMessage::KeepsNone { title }));
        }
        Ok(Self { client, interrupt, next_id: 1 })
    }

    /// Does something with its macros; `stored` is told each that was, but for the last.
    fn carry_out(
        &mut self,
        job: Job,
        stored: &mut dyn FnMut(u8) -> Result<(), Exit>,
    ) -> Result<Result<Done, Trouble>, Exit> {
        let mut transfer = Transfer::new(job);
        loop {
            let reply = self.exchange(transfer.bytes().to_vec())?;
            match transfer.answered(&reply) {
                Step::GoesOn => {}
                Step::Stored(number) => stored(number)?,
                Step::Ended(ended) => return Ok(ended),
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
        Err(Exit::NoLink.saying(CliMacroMessage::NoReportOfLine))
    }
}
