//! `brushwork mcl run`: a script on a simulated controller in virtual time, its stream on standard output.

use crate::messages::CliScriptMessage;
use brushwork_link::work::receive_within;
use std::io::{IsTerminal as _, Read as _};
use std::path::Path;
use std::time::Duration;

use brushwork_script::diagnostic::Severity;
use brushwork_script::mcl;
use brushwork_script::program::Program;
use crossbeam_channel::{Receiver, RecvTimeoutError, TryRecvError, bounded};

use super::args::RunArgs;
use super::disasm::program_in;
use super::rig::{Rig, Run};
use crate::scripts::{Source, is_standard, read_bytes};
use crate::{Exit, Interrupt, Output, OutputError, say};

/// How far the controller goes between two looks at its output.
const SLICE: Duration = Duration::from_millis(1);
/// How long a line that has something to send is listened to after the end.
const TAIL: Duration = Duration::from_secs(5);
/// How long piped input may take to begin, so that a script that only looks whether something came finds it.
const HEAD_START: Duration = Duration::from_millis(50);
/// Between two looks at Ctrl-C while a script waits for someone who types.
const LOOK: Duration = Duration::from_millis(20);

/// Runs the script to its end, its fault or the limit.
pub fn run(args: &RunArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let program = load(&args.file, args.quiet)?;
    let mut rig = Rig::new(args, &program).map_err(|sentence| Exit::Usage.saying(sentence))?;
    let mut input = Input::new(is_standard(&args.file));
    let ended = drive(&mut rig, &mut input, args.limit, out, interrupt);
    if args.report {
        report(&rig);
    }
    ended?;
    match rig.run() {
        _ if interrupt.is_raised() => Err(Exit::Interrupted),
        Run::Faulted { line, what } => Err(Exit::ScriptFaulted.saying(CliScriptMessage::Faulted {
            file: args.file.display().to_string(),
            line,
            what: what.to_string(),
        })),
        Run::Running { .. } | Run::Ended { .. } => Ok(Exit::Done),
    }
}

fn load(path: &Path, quiet: bool) -> Result<Program, Exit> {
    let bytes = read_bytes(path).map_err(|error| Exit::Failed.saying(error))?;
    if let Some(program) = program_in(&bytes, path)? {
        return Ok(program);
    }
    let source = Source::of(path.display().to_string(), bytes);
    let mut compiled = mcl::compile(&source.text);
    if quiet {
        compiled.diagnostics.retain(|said| said.severity() == Severity::Error);
    }
    let said = source.rendered(&compiled.diagnostics);
    if !said.is_empty() {
        say(said.trim_end());
    }
    compiled.program.ok_or(Exit::ScriptWrong)
}

fn drive(
    rig: &mut Rig,
    input: &mut Input,
    limit: Duration,
    out: &mut Output,
    interrupt: &Interrupt,
) -> Result<(), OutputError> {
    // A short script has said everything while it was started.
    print(rig, out)?;
    while rig.now() < limit && matches!(rig.run(), Run::Running { .. }) && !interrupt.is_raised() {
        input.feed(rig, interrupt);
        rig.advance(SLICE.min(limit - rig.now()));
        print(rig, out)?;
    }
    let over = rig.now() + TAIL;
    while !matches!(rig.run(), Run::Running { .. }) && rig.is_sending() && rig.now() < over {
        rig.advance(SLICE);
        print(rig, out)?;
    }
    Ok(())
}

fn print(rig: &mut Rig, out: &mut Output) -> Result<(), OutputError> {
    let bytes = rig.take_output();
    if bytes.is_empty() { Ok(()) } else { out.bytes(&bytes) }
}

fn report(rig: &Rig) {
    let how = match rig.run() {
        Run::Running { line } => format!("stopped at the limit, on line {line}"),
        Run::Ended { line } => format!("ended on line {line}"),
        Run::Faulted { line, what } => format!("faulted on line {line}: {what}"),
    };
    say(CliScriptMessage::Ran { how, seconds: rig.now().as_secs_f64(), instructions: rig.executed() });
}

/// Standard input, read by a thread of its own, so that Ctrl-C and the script's time do not wait for it.
struct Input {
    /// None when all has been read, or nothing is.
    chunks: Option<Receiver<Vec<u8>>>,
    waiting: Vec<u8>,
}

impl Input {
    fn new(is_taken: bool) -> Self {
        if is_taken {
            return Self { chunks: None, waiting: Vec::new() };
        }
        let (sender, chunks) = bounded(16);
        let reading = std::thread::Builder::new().name("mcl-input".to_owned()).spawn(move || {
            let mut stdin = std::io::stdin().lock();
            let mut buffer = [0; 4096];
            while let Ok(count @ 1..) = stdin.read(&mut buffer) {
                if sender.send(buffer[..count].to_vec()).is_err() {
                    return;
                }
            }
        });
        let mut input = Self { chunks: reading.ok().map(|_| chunks), waiting: Vec::new() };
        if !std::io::stdin().is_terminal() {
            input.wait(HEAD_START);
        }
        input
    }

    /// Gives the script what it has room for. When it waits for a byte and none is there, its time stands until one comes or the input
    /// ends: who types takes no controller time.
    fn feed(&mut self, rig: &mut Rig, interrupt: &Interrupt) {
        self.look();
        while rig.is_listening() && self.waiting.is_empty() && self.chunks.is_some() && !interrupt.is_raised()
        {
            self.wait(LOOK);
        }
        let taken = rig.feed(&self.waiting);
        self.waiting.drain(..taken);
    }

    fn look(&mut self) {
        let Some(chunks) = &self.chunks else { return };
        // What waits is enough for now; the thread keeps the rest.
        if !self.waiting.is_empty() {
            return;
        }
        match chunks.try_recv() {
            Ok(bytes) => self.waiting = bytes,
            Err(TryRecvError::Empty) => {}
            Err(TryRecvError::Disconnected) => self.chunks = None,
        }
    }

    fn wait(&mut self, time: Duration) {
        let Some(chunks) = &self.chunks else { return };
        match receive_within(chunks, time) {
            Ok(mut bytes) => self.waiting.append(&mut bytes),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => self.chunks = None,
        }
    }
}
