//! `brushwork mecc run`: a program on a simulated board in virtual time, its frames on standard output.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;
use std::time::Duration;

use brushwork_motorvator_sim::assumed::byte_time;
use brushwork_motorvator_sim::{Motorvator, What};
use brushwork_motorvator_wire::{BITS_PER_SECOND, parse_line_of_board};

use super::args::RunArgs;
use super::language::compiled;
use crate::messages::{CliMeccMessage, CliScriptMessage};
use crate::{Exit, Interrupt, NewFile, Output, Replace, say};

/// How far the board goes between two looks at Ctrl-C.
const SLICE: Duration = Duration::from_millis(250);

/// Something that is done to the board.
enum Act {
    Line(String),
    Input(usize, bool),
}

/// Runs the program to its end, its fault or the limit.
pub fn run(args: &RunArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let program = compiled(&args.file, args.quiet)?;
    let mut trace = Trace::new(args)?;
    let mut board = Motorvator::new(Some(program));
    board.trace();
    board.start();
    let mut acts = acts(args).into_iter().peekable();
    let mut lost = 0;
    while board.now() < args.limit && !interrupt.is_raised() {
        let next = acts.peek().map_or(args.limit, |(at, _)| *at).min(args.limit);
        board.advance(next.min(board.now() + SLICE));
        while let Some((_, act)) = acts.next_if(|(at, _)| *at <= board.now()) {
            match act {
                // It is whole with its carriage return.
                Act::Line(line) => board.receive(format!("{line}\r").as_bytes()),
                Act::Input(input, on) => board.set_on_off(input, on),
            }
        }
        while let Some(line) = board.take_output() {
            print(&line, out)?;
        }
        lost += trace.keep(&mut board);
        if !board.is_running() && board.next_output_at().is_none() {
            break;
        }
    }
    trace.write()?;
    if lost > 0 {
        say(CliMeccMessage::Lost { count: lost }.to_string());
    }
    let file = args.file.display().to_string();
    match board.fault() {
        _ if interrupt.is_raised() => Err(Exit::Interrupted),
        Some(fault) => {
            let what = format!("{}: {}", brushwork_motorvator_sim::assumed::UNKNOWN_INSTRUCTION, fault.kind);
            Err(Exit::ScriptFaulted.saying(CliScriptMessage::Faulted { file, line: fault.line, what }))
        }
        None => Ok(Exit::Done),
    }
}

/// What is done to the board, in the order of time; a line is there when its last byte is.
fn acts(args: &RunArgs) -> Vec<(Duration, Act)> {
    let lines = args.send.iter().map(|(at, line)| {
        let bytes = u32::try_from(line.len()).unwrap_or(u32::MAX).saturating_add(1);
        (at.saturating_add(byte_time(BITS_PER_SECOND).saturating_mul(bytes)), Act::Line(line.clone()))
    });
    let inputs = args.input.iter().map(|(at, input, on)| (*at, Act::Input(*input, *on)));
    let mut acts: Vec<(Duration, Act)> = lines.chain(inputs).collect();
    acts.sort_by_key(|(at, _)| *at);
    acts
}

/// Frames go to standard output; what the command line of the board says is for people.
fn print(line: &[u8], out: &mut Output) -> Result<(), Exit> {
    let shown = String::from_utf8_lossy(line);
    let shown = shown.trim_end();
    if parse_line_of_board(shown.as_bytes()).is_some() {
        return Ok(out.line(shown)?);
    }
    say(CliMeccMessage::BoardSays { words: shown.to_owned() }.to_string());
    Ok(())
}

/// What a file of a trace begins with: such a one is replaced by the next.
const TRACE_BEGINS: &[u8] = b"{\"t\":";

/// Bytes of a trace; a program that beeps without end for an hour fills them.
const MOST_BYTES: usize = 256 << 20;

/// The lines of a trace, where one is wanted.
struct Trace<'a> {
    file: Option<NewFile<'a>>,
    lines: Vec<u8>,
    is_full: bool,
}

impl<'a> Trace<'a> {
    fn new(args: &'a RunArgs) -> Result<Self, Exit> {
        let file = args.trace.as_deref().map(|path| {
            let force = args.replace.force || is_trace(path);
            NewFile::new(path, Replace { force }).apart_from(&args.file)
        });
        file.as_ref().map_or(Ok(()), NewFile::check)?;
        Ok(Self { file, lines: Vec::new(), is_full: false })
    }

    /// Keeps what was seen; how many frames were lost.
    fn keep(&mut self, board: &mut Motorvator) -> u64 {
        let mut lost = 0;
        for seen in board.take_trace() {
            lost += u64::from(matches!(seen.what, What::Transmit { lost: true, .. }));
            self.is_full |= self.lines.len() > MOST_BYTES;
            if self.file.is_some() && !self.is_full {
                self.lines.extend(serde_json::to_vec(&seen).unwrap_or_default());
                self.lines.push(b'\n');
            }
        }
        lost
    }

    fn write(self) -> Result<(), Exit> {
        if self.is_full {
            say(CliMeccMessage::TraceFull { bytes: MOST_BYTES >> 20 }.to_string());
        }
        self.file.map_or(Ok(()), |mut file| Ok(file.write(&self.lines)?))
    }
}

/// Whether a file is empty or holds an older trace.
fn is_trace(path: &Path) -> bool {
    let mut head = [0; TRACE_BEGINS.len()];
    let is_plain = std::fs::symlink_metadata(path).is_ok_and(|found| found.is_file());
    let Some(mut file) = is_plain.then(|| File::open(path).ok()).flatten() else { return false };
    match file.read(&mut head) {
        Ok(0) => true,
        Ok(count) => head[..count] == *TRACE_BEGINS,
        Err(_) => false,
    }
}
