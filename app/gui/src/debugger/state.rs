//! What the debugger of one link knows and wants: breakpoints, watches, what the script was like when it stood here last.

use crate::graph::messages::MarkMessage;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use brushwork_plant::server::Pace;
use brushwork_script::debug::{Breakpoint, Reason, Request, Show, Value, View, Wanted, Watch};
use brushwork_script::language::Language;
use brushwork_script::mcl::registers::RegisterId;
use brushwork_script::names::Names;
use brushwork_script::op::Op;
use brushwork_script::program::Program;
use brushwork_script::vm::{Memory, element};

use super::names::{Compiled, Compiler, Loaded, TextId};
use super::terminal::Terminal;

/// The program that is looked at, as the editor has it. Lines count from 1.
pub struct Source<'a> {
    pub id: TextId,
    pub language: Language,
    pub text: &'a dyn Fn() -> String,
    pub breakpoints: Vec<u32>,
}

/// What belongs to a breakpoint besides its line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Terms {
    pub disabled: bool,
    /// As typed; empty for none.
    pub condition: String,
    /// From which time on it stops; 0 and 1 are the first.
    pub from_hit: u64,
    /// What is wrong with the condition.
    pub wrong: Option<String>,
}

/// A watched expression.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WatchRow {
    pub text: String,
    pub show: Show,
}

/// A group of registers that can be unfolded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum RegisterGroup {
    Used,
    System,
    Motors,
    Streams,
    Signals,
}

impl RegisterGroup {
    pub const ALL: [Self; 5] = [Self::Used, Self::System, Self::Motors, Self::Streams, Self::Signals];

    pub const fn title(self) -> &'static str {
        match self {
            Self::Used => "Used by this program",
            Self::System => "System",
            Self::Motors => "Motors",
            Self::Streams => "Streams",
            Self::Signals => "Signals",
        }
    }

    fn holds(self, name: &str) -> bool {
        match self {
            Self::Used => false,
            Self::Motors => name.starts_with("MOTOR"),
            Self::Streams => name.starts_with("STREAM"),
            Self::Signals => name.starts_with("SIGNAL"),
            Self::System => !["MOTOR", "STREAM", "SIGNAL"].iter().any(|other| name.starts_with(other)),
        }
    }
}

/// The debugger of one link.
#[derive(Debug, Default)]
pub struct Debugging {
    /// The script as it was a moment ago; none before the first look, or where there is nothing to debug.
    pub view: Option<Arc<View>>,
    compiler: Compiler,
    /// The text in front as far as it compiles.
    front: Option<Arc<Compiled>>,
    loaded: Loaded,
    /// What is to be asked for in the next look.
    requests: Vec<Request>,
    /// Breakpoints as the editor had them, with what the user said about each.
    pub breakpoints: BTreeMap<u32, Terms>,
    sent_breakpoints: Option<Vec<Breakpoint>>,
    pub watches: Vec<WatchRow>,
    expressions: Expressions,
    pub open_groups: BTreeSet<RegisterGroup>,
    pub new_watch: String,
    pub set_place: String,
    pub set_value: String,
    /// What became of the last value that was set.
    pub set_answer: Option<Result<String, String>>,
    next_id: u64,
    pub terminal: Terminal,
    pub shows_counts: bool,
    pub stops_at_entry: bool,
    pub freezes_world: bool,
    /// How fast the simulated controller's time goes; none where nobody can tell.
    pub pace: Option<Pace>,
    /// The simulated controller runs MeccCode that is put into its memory past the wire.
    pub takes_mecc: bool,
    /// Memory and registers of the last stop before this one.
    before: Snapshot,
    here: Snapshot,
    is_attached: bool,
    /// Whether the MCL screen was open in the last frame.
    is_shown: bool,
    /// Something was asked for in the last frame, whose answer is to be shown soon.
    pub is_stepping: bool,
    pub show: Show,
}

/// What can change from one stop to the next.
#[derive(Clone, Debug, Default)]
struct Snapshot {
    executed: u64,
    memory: Vec<u8>,
    registers: BTreeMap<RegisterId, Vec<u32>>,
}

/// Something worth a mark in the graph.
pub type Happened = Option<String>;

impl Debugging {
    /// Follows the editor: the text in front, and its breakpoints.
    pub fn follow(&mut self, source: &Source<'_>) {
        if let Some(compiled) = self.compiler.follow(source.id, source.language, source.text) {
            self.front = Some(Arc::new(compiled));
        }
        let code = self.view.as_ref().map_or(0, |view| view.code);
        if let Some(front) = self.front.as_ref().filter(|front| front.code == code) {
            self.loaded.set(front.clone());
        }
        let before = std::mem::take(&mut self.breakpoints);
        for line in &source.breakpoints {
            let terms = before.get(line).cloned().unwrap_or_default();
            self.breakpoints.insert(*line, terms);
        }
    }

    /// What is to be asked of the script now, and what is to be shown of it.
    pub fn look(&mut self) -> (Vec<Request>, Wanted) {
        if !self.is_attached {
            self.is_attached = true;
            self.sent_breakpoints = None;
            self.requests.insert(0, Request::StopAtEntry(self.stops_at_entry));
            self.requests.insert(1, Request::FreezeWorld(self.freezes_world));
            self.requests.insert(2, Request::Attach(true));
        }
        let wanted = self.wanted_breakpoints();
        if self.sent_breakpoints.as_ref() != Some(&wanted) {
            self.requests.insert(0, Request::Breakpoints(wanted.clone()));
            self.sent_breakpoints = Some(wanted);
        }
        (std::mem::take(&mut self.requests), self.wanted())
    }

    /// Takes in how the script is; says what happened, if it is worth a mark.
    pub fn take(&mut self, view: View) -> Happened {
        self.terminal.take(&view);
        if let Some((id, answer)) = &view.answer
            && *id == self.next_id
        {
            self.set_answer = Some(answer.clone());
        }
        let stands = view.is_paused || !view.is_running;
        if stands && view.executed != self.here.executed {
            self.before = std::mem::take(&mut self.here);
        }
        if stands {
            let registers = view.registers.iter().map(|reading| (reading.id, reading.cells.clone()));
            let mut known = std::mem::take(&mut self.here.registers);
            known.extend(registers);
            self.here = Snapshot { executed: view.executed, memory: view.memory.clone(), registers: known };
        }
        let was = self.view.as_ref().map(|before| (before.is_paused, before.reason.clone()));
        let happened = match was {
            Some((was_paused, _)) if was_paused != view.is_paused => Some(if view.is_paused {
                MarkMessage::ScriptPaused { line: view.line }.to_string()
            } else {
                "script goes on".into()
            }),
            Some((_, reason)) if reason != view.reason => ended(&view.reason),
            _ => None,
        };
        self.view = Some(Arc::new(view));
        happened
    }

    /// The link has ended, or the unit is another one.
    pub fn forget(&mut self) {
        self.view = None;
        self.is_attached = false;
        self.sent_breakpoints = None;
        self.requests.clear();
        self.pace = None;
        self.takes_mecc = false;
        self.before = Snapshot::default();
        self.here = Snapshot::default();
        self.terminal.forget();
    }

    pub fn ask(&mut self, request: Request) {
        self.requests.push(request);
    }

    /// The MCL screen is open, or not. A world that stands still is not left behind: other screens drive in it.
    pub fn shown(&mut self, is_shown: bool) {
        if is_shown != self.is_shown {
            self.is_shown = is_shown;
            self.ask(Request::FreezeWorld(is_shown && self.freezes_world));
        }
    }

    pub fn has_requests(&self) -> bool {
        !self.requests.is_empty()
    }

    /// Requests that could not be handed over.
    pub fn ask_again(&mut self, mut requests: Vec<Request>) {
        requests.append(&mut self.requests);
        self.requests = requests;
    }

    /// Another program comes into the controller whose text is not open: breakpoints of this one would hold it anywhere.
    pub fn leave_breakpoints(&mut self) {
        self.sent_breakpoints = Some(self.wanted_breakpoints());
        self.ask(Request::Breakpoints(Vec::new()));
    }

    /// The program in front comes into the controller: its breakpoints are to be there before it starts.
    pub fn renew_breakpoints(&mut self) {
        self.sent_breakpoints = None;
    }

    /// Gives what is typed in the terminal to the script.
    pub fn send_typed(&mut self) {
        match self.terminal.typed() {
            Ok(bytes) => {
                let stream = self.terminal.to_stream;
                self.terminal.input.clear();
                self.terminal.refused = None;
                self.ask(Request::Give { stream, bytes });
            }
            Err(why) => self.terminal.refused = Some(why),
        }
    }

    /// The program in the controller, where its text is known.
    pub fn loaded(&self) -> Option<&Arc<Compiled>> {
        self.loaded.of(self.view.as_ref()?.code)
    }

    /// Whether the text in front is still being compiled: until then its names and conditions are not known.
    pub fn is_compiling(&self) -> bool {
        self.compiler.is_busy()
    }

    /// The language of the program in the controller, or that is to run there next.
    pub fn language(&self) -> Language {
        self.loaded()
            .or(self.front.as_ref())
            .map_or(Language::default(), |compiled| compiled.names.language())
    }

    pub fn program(&self) -> Option<&Arc<Program>> {
        self.loaded().map(|loaded| loaded.names.program())
    }

    pub fn is_paused(&self) -> bool {
        self.view.as_ref().is_some_and(|view| view.is_paused)
    }

    pub fn is_running(&self) -> bool {
        self.view.as_ref().is_some_and(|view| view.is_running)
    }

    /// Variables as they are now.
    pub fn memory(&self) -> Memory {
        Memory::of(self.view.as_ref().map(|view| view.memory.clone()).unwrap_or_default())
    }

    /// Variables as they were when the script stood the time before.
    pub fn memory_before(&self) -> Option<Memory> {
        (!self.before.memory.is_empty()).then(|| Memory::of(self.before.memory.clone()))
    }

    /// A register as it was when the script stood the time before.
    pub fn register_before(&self, id: RegisterId) -> Option<&Vec<u32>> {
        self.before.registers.get(&id)
    }

    /// Sets a place to a value, if both can be understood.
    pub fn set(&mut self) {
        self.set_answer = None;
        let code = self.view.as_ref().map_or(0, |view| view.code);
        let Some(loaded) = self.loaded.of(code) else {
            self.set_answer = Some(Err(NO_NAMES.to_owned()));
            return;
        };
        match loaded.names.clone().setting(&self.set_place, &self.set_value) {
            Ok(setting) => {
                self.next_id += 1;
                self.requests.push(Request::Set { id: self.next_id, setting });
            }
            Err(why) => self.set_answer = Some(Err(why)),
        }
    }

    /// Adds what is typed to the watches.
    pub fn add_watch(&mut self) {
        let text = self.new_watch.trim().to_owned();
        if !text.is_empty() {
            self.watches.push(WatchRow { text, show: self.show });
            self.new_watch.clear();
        }
    }

    /// What a name under the pointer is now; nothing while the script's names are not known.
    pub fn value_of(&self, name: &str) -> Option<String> {
        let program = self.program()?;
        let variable = program.variables.iter().find(|variable| variable.name.eq_ignore_ascii_case(name))?;
        let memory = self.memory();
        let cells = (0..variable.memory.length.min(16))
            .filter_map(|index| element(variable.memory, index))
            .map(|cell| memory.load(cell))
            .collect();
        let value = Value { kind: variable.kind(), cells, is_array: variable.is_array };
        Some(format!("{} = {}", variable.name, value.text(self.show)))
    }

    /// The registers that a group shows.
    pub fn registers_of(&self, group: RegisterGroup) -> Vec<RegisterId> {
        let all = (0..brushwork_script::mcl::registers::REGISTERS.len())
            .filter_map(|index| u8::try_from(index).ok().map(RegisterId));
        if group != RegisterGroup::Used {
            return all.filter(|id| group.holds(id.row().name)).collect();
        }
        let Some(program) = self.program() else { return Vec::new() };
        let used: BTreeSet<RegisterId> = program.ops.iter().filter_map(register_of).collect();
        used.into_iter().collect()
    }

    fn wanted(&mut self) -> Wanted {
        let code = self.view.as_ref().map_or(0, |view| view.code);
        let groups = self.open_groups.iter().flat_map(|group| self.registers_of(*group));
        let registers: BTreeSet<RegisterId> = groups.collect();
        Wanted {
            watches: self.watched(),
            code,
            registers: Arc::new(registers.into_iter().collect()),
            output_from: self.terminal.seen(),
        }
    }

    /// The watches as expressions of the program that is loaded.
    fn watched(&mut self) -> Arc<Vec<Result<Watch, String>>> {
        let Some(loaded) = self.loaded().cloned() else { return Arc::default() };
        let expressions = &mut self.expressions;
        Arc::new(self.watches.iter().map(|row| expressions.get(&loaded, &row.text)).collect())
    }

    fn wanted_breakpoints(&mut self) -> Vec<Breakpoint> {
        let compiled = self.loaded().or(self.front.as_ref()).cloned();
        let expressions = &mut self.expressions;
        let breakpoint = |(line, terms): (&u32, &mut Terms)| {
            let text = terms.condition.trim();
            let made = compiled
                .as_ref()
                .filter(|_| !text.is_empty())
                .map(|compiled| expressions.get(compiled, text));
            let (condition, wrong) = match made {
                Some(Ok(watch)) => (Some(watch), None),
                Some(Err(why)) => (None, Some(why)),
                None => (None, None),
            };
            terms.wrong = wrong;
            let enabled = !terms.disabled && terms.wrong.is_none();
            Breakpoint { line: *line, enabled, condition, from_hit: terms.from_hit }
        };
        self.breakpoints.iter_mut().map(breakpoint).collect()
    }
}

/// Expressions that were made for a program.
#[derive(Debug, Default)]
struct Expressions {
    code: u64,
    names: Option<Names>,
    made: BTreeMap<String, Result<Watch, String>>,
}

impl Expressions {
    fn get(&mut self, compiled: &Compiled, text: &str) -> Result<Watch, String> {
        if self.code != compiled.code || self.names.is_none() || self.made.len() > 1000 {
            *self = Self { code: compiled.code, names: Some(compiled.names.clone()), made: BTreeMap::new() };
        }
        if let Some(made) = self.made.get(text) {
            return made.clone();
        }
        let names = self.names.as_mut().ok_or_else(|| NO_NAMES.to_owned())?;
        let made = names.watch(text);
        self.made.insert(text.to_owned(), made.clone());
        made
    }
}

/// What the panel says where a script runs whose text is not open.
pub const NO_NAMES: &str =
    "The program in the controller is not the text in front: open its text, or download this one (F5).";

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn ended(reason: &Reason) -> Happened {
    match reason {
        Reason::Ended => Some("script ended".to_owned()),
        Reason::Faulted(fault) => Some(MarkMessage::ScriptFailed { line: fault.line }.to_string()),
        Reason::Stopped(_) => Some("script stopped".to_owned()),
        _ => None,
    }
}

#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn register_of(op: &Op) -> Option<RegisterId> {
    match op {
        Op::LoadRegister(id, _)
        | Op::StoreRegister(id, _)
        | Op::LoadRegisterAt(id)
        | Op::StoreRegisterAt(id) => Some(*id),
        _ => None,
    }
}
