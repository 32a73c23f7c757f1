//! From statements to macros: names, numbers and ranges, and what is likely to be a mistake.

use super::codes;
use super::lexer;
use super::parser::{Operand, Statement, WrittenCommand, statements};
use brushwork_script::diagnostic::{Diagnostic, Severity};
use brushwork_script::text::Span;
use brushwork_suprmotr_wire::{
    Absent, COMMANDS, Command, EncodeError, LAST_MACRO, Line, MOST_COMMANDS, Mnemonic, Radix,
};

/// A text of more bytes is refused: far more than 15 macros with all their comments need.
pub const LONGEST_TEXT: usize = 256 * 1024;

/// A macro of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Macro {
    /// Its number on the controller, 0 to 14.
    pub number: u8,
    /// Its name in the file.
    pub name: String,
    /// Where its name stands.
    pub span: Span,
    /// Its commands.
    pub commands: Vec<Command>,
    /// Where each of them stands.
    pub places: Vec<Span>,
}

/// A file that was read.
#[derive(Clone, Debug, Default)]
pub struct Checked {
    /// Its macros in the order of the file. Only those of a file without errors are whole.
    pub macros: Vec<Macro>,
    /// What is said about it, in the order of the file.
    pub diagnostics: Vec<Diagnostic>,
}

/// Errors and warnings that are listed.
const MOST_SAID: usize = 100;

impl Macro {
    /// The line that defines it on a controller, with its carriage return.
    ///
    /// # Errors
    /// If it is empty or too long: [`check`] says so before.
    pub fn line(&self) -> Result<Vec<u8>, EncodeError> {
        self.as_line().encode(Radix::Decimal)
    }

    /// The same as commands.
    #[must_use]
    pub fn as_line(&self) -> Line {
        Line { defines: Some(self.number), commands: self.commands.clone() }
    }
}

impl Checked {
    /// Whether nothing is wrong.
    pub fn is_right(&self) -> bool {
        !self.diagnostics.iter().any(|said| said.severity() == Severity::Error)
    }

    /// The macro of a name, in either case, or of a number.
    pub fn find(&self, name: &str) -> Option<&Macro> {
        let is_it =
            |found: &&Macro| found.name.eq_ignore_ascii_case(name) || found.number.to_string() == name;
        self.macros.iter().find(is_it)
    }
}

/// Reads a file.
pub fn check(text: &str) -> Checked {
    let mut checker = Checker::default();
    if text.len() > LONGEST_TEXT {
        checker.say(
            codes::TEXT_TOO_LONG,
            Span::new(0, 0),
            format!("A macro file has at most {LONGEST_TEXT} bytes."),
        );
        return Checked { macros: Vec::new(), diagnostics: checker.said };
    }
    let found = statements(text, &mut checker.said);
    checker.declare(&found);
    checker.fill(&found);
    checker.look();
    checker.finish()
}

struct Constant<'a> {
    name: &'a str,
    span: Span,
    number: i32,
    is_used: bool,
}

#[derive(Default)]
struct Checker<'a> {
    macros: Vec<Macro>,
    constants: Vec<Constant<'a>>,
    said: Vec<Diagnostic>,
}

impl<'a> Checker<'a> {
    fn say(&mut self, code: &'static str, span: Span, message: String) {
        self.said.push(Diagnostic { code, span, message, hint: None });
    }

    fn hint(&mut self, hint: &str) {
        if let Some(last) = self.said.last_mut() {
            last.hint = Some(hint.to_owned());
        }
    }

    /// All names first, so that a macro may be called before it stands there.
    fn declare(&mut self, found: &[Statement<'a>]) {
        let mut taken = [false; LAST_MACRO as usize + 1];
        let mut unnumbered = Vec::new();
        for statement in found {
            match *statement {
                Statement::Macro { name, span, number } => {
                    self.is_new(name, span);
                    let given = number.and_then(|(number, at)| self.macro_number(number, at, &mut taken));
                    if number.is_none() {
                        unnumbered.push(self.macros.len());
                    }
                    let name = name.to_owned();
                    // One without a number has it below; that of one that is refused is of no use.
                    let number = given.unwrap_or_default();
                    self.macros.push(Macro { number, name, span, commands: Vec::new(), places: Vec::new() });
                }
                Statement::Const { name, span, number } => {
                    self.is_new(name, span);
                    self.constants.push(Constant { name, span, number, is_used: false });
                }
                Statement::Commands(_) => {}
            }
        }
        for index in unnumbered {
            match (1..=LAST_MACRO).find(|number| !taken[usize::from(*number)]) {
                Some(number) => {
                    taken[usize::from(number)] = true;
                    self.macros[index].number = number;
                }
                None => {
                    let message = format!(
                        "There is no number left for {}: macros are 0 to {LAST_MACRO}.",
                        self.macros[index].name
                    );
                    self.say(codes::TOO_MANY_MACROS, self.macros[index].span, message);
                }
            }
        }
    }

    fn is_new(&mut self, name: &str, span: Span) {
        let is_macro = self.macros.iter().any(|known| known.name.eq_ignore_ascii_case(name));
        if is_macro || self.constant(name).is_some() {
            self.say(codes::DEFINED_TWICE, span, format!("{name} is defined already."));
        }
    }

    fn macro_number(&mut self, number: i32, span: Span, taken: &mut [bool]) -> Option<u8> {
        let Some(place) = usize::try_from(number).ok().and_then(|index| taken.get_mut(index)) else {
            self.say(codes::BAD_MACRO_NUMBER, span, format!("Macros are 0 to {LAST_MACRO}, not {number}."));
            return None;
        };
        if std::mem::replace(place, true) {
            self.say(codes::NUMBER_TWICE, span, format!("Another macro has the number {number}."));
        }
        u8::try_from(number).ok()
    }

    fn constant(&self, name: &str) -> Option<usize> {
        self.constants.iter().position(|known| known.name.eq_ignore_ascii_case(name))
    }

    fn fill(&mut self, found: &[Statement<'a>]) {
        let mut current = None;
        let mut next = 0;
        for statement in found {
            match statement {
                Statement::Macro { .. } => {
                    current = Some(next);
                    next += 1;
                }
                Statement::Const { .. } => {}
                Statement::Commands(written) => {
                    let Some(current) = current else {
                        let span = written.first().map_or(Span::new(0, 0), |first| first.span);
                        self.say(codes::OUTSIDE, span, "Commands stand in a macro.".to_owned());
                        self.hint("Begin one with: macro NAME");
                        continue;
                    };
                    for command in written {
                        if let Some((command, span)) = self.command(command) {
                            self.macros[current].commands.push(command);
                            self.macros[current].places.push(span);
                        }
                    }
                }
            }
        }
    }

    fn command(&mut self, written: &WrittenCommand<'_>) -> Option<(Command, Span)> {
        let letters = <[u8; 2]>::try_from(written.letters.as_bytes()).ok();
        let Some(mnemonic) = letters.and_then(Mnemonic::from_letters) else {
            self.say(
                codes::UNKNOWN_COMMAND,
                written.span,
                format!("There is no command {}.", written.letters),
            );
            if let Some(title) = titled(written.letters) {
                self.hint(&title);
            }
            return None;
        };
        if mnemonic == Mnemonic::MD {
            self.say(codes::DEFINITION, written.span, "A macro cannot define another one.".to_owned());
            return None;
        }
        let number = match written.operand {
            None => None,
            Some((Operand::Number(number), _)) => Some(number),
            Some((Operand::Name(name), span)) => Some(self.named(mnemonic, name, span)?),
        };
        let command = Command { mnemonic, number };
        let span = written.operand.map_or(written.span, |(_, span)| written.span.to(span));
        self.fits(&command, span).then_some((command, span))
    }

    /// The number that a name stands for: of a macro behind MC and EM, else a constant.
    fn named(&mut self, mnemonic: Mnemonic, name: &str, span: Span) -> Option<i32> {
        if is_call(mnemonic)
            && let Some(found) = self.macros.iter().find(|known| known.name.eq_ignore_ascii_case(name))
        {
            return Some(found.number.into());
        }
        if let Some(index) = self.constant(name) {
            self.constants[index].is_used = true;
            return Some(self.constants[index].number);
        }
        let what = if is_call(mnemonic) { "macro or number" } else { "number" };
        self.say(codes::UNKNOWN_NAME, span, format!("There is no {what} of the name {name}."));
        None
    }

    fn fits(&mut self, command: &Command, span: Span) -> bool {
        let row = command.row();
        let (code, message) = match (row.takes, command.number) {
            (None, None) => return true,
            (None, Some(_)) => (codes::NEEDLESS_NUMBER, format!("{} takes no number.", row.name)),
            (Some(takes), None) if takes.absent == Absent::Refused => {
                let unit = takes.unit.symbol();
                let unit = if unit.is_empty() { String::new() } else { format!(" in {unit}") };
                (
                    codes::NO_NUMBER,
                    format!(
                        "{} needs a number: {}{unit}, {} to {}.",
                        row.name, takes.name, takes.low, takes.high
                    ),
                )
            }
            (Some(_), None) => return true,
            (Some(takes), Some(number)) if takes.allows(number) => return true,
            (Some(takes), Some(number)) if takes.only.is_empty() => (
                codes::OUT_OF_RANGE,
                format!("{} takes {} to {}, not {number}.", row.name, takes.low, takes.high),
            ),
            (Some(takes), Some(number)) => {
                let only: Vec<String> = takes.only.iter().map(ToString::to_string).collect();
                (codes::OUT_OF_RANGE, format!("{} takes {}, not {number}.", row.name, only.join(", ")))
            }
        };
        self.say(code, span, message);
        false
    }

    fn look(&mut self) {
        for index in 0..self.macros.len() {
            self.look_at_size(index);
            if self.said.iter().all(|said| said.severity() != Severity::Error) {
                self.look_at_calls(index);
                self.look_at_loops(index);
            }
        }
        for index in 0..self.constants.len() {
            let Constant { name, span, is_used, .. } = self.constants[index];
            if !is_used {
                self.say(codes::UNUSED, span, format!("Nothing uses {name}."));
            }
        }
    }

    fn look_at_size(&mut self, index: usize) {
        let Macro { name, span, commands, places, .. } = &self.macros[index];
        let (name, span, count) = (name.clone(), *span, commands.len());
        if count == 0 && !self.said.iter().any(|said| said.severity() == Severity::Error) {
            self.say(codes::EMPTY, span, format!("{name} has no commands."));
        } else if count > MOST_COMMANDS {
            let place = places[MOST_COMMANDS];
            self.say(
                codes::TOO_MANY_COMMANDS,
                place,
                format!("{name} has {count} commands; a macro has {MOST_COMMANDS} at most."),
            );
            self.hint("Put some of them in a macro of their own and call that with MC.");
        } else if let Err(EncodeError::TooLong(length)) = self.macros[index].line() {
            self.say(
                codes::LINE_TOO_LONG,
                span,
                format!("{name} makes a line of {length} characters, for which the controller has no room."),
            );
        }
    }

    fn look_at_calls(&mut self, index: usize) {
        let known = &self.macros[index];
        let calls: Vec<(u8, Span, bool)> = calls_of(known).collect();
        let (number, name, span) = (known.number, known.name.clone(), known.span);
        if number == 0 && self.may_move(0, &mut Vec::new()) {
            self.say(
                codes::RUNS_AT_POWER_UP,
                span,
                format!(
                    "{name} is macro 0: it runs as soon as the controller has power, and may move the motor."
                ),
            );
        }
        for (called, place, is_last) in calls {
            if !self.macros.iter().any(|other| other.number == called) {
                self.say(codes::NOT_HERE, place, format!("Macro {called} is not in this file."));
            } else if !is_last && self.leads_to(called, number, &mut Vec::new()) {
                self.say(
                    codes::CALLS_ITSELF,
                    place,
                    format!(
                        "This call comes back to {name}: the controller refuses when it is nested too deep."
                    ),
                );
                self.hint("A call that is a macro's last command takes its place and may go on for ever.");
            }
        }
    }

    fn look_at_loops(&mut self, index: usize) {
        let Macro { commands, places, .. } = self.macros[index].clone();
        let repeats: Vec<usize> =
            (0..commands.len()).filter(|at| commands[*at].mnemonic == Mnemonic::RP).collect();
        let Some(end) = repeats.last().copied() else { return };
        let body = &commands[..end];
        let moves = body.iter().position(|command| {
            matches!(command.mnemonic, Mnemonic::MA | Mnemonic::MR | Mnemonic::GH | Mnemonic::FE)
        });
        let waits = body.iter().any(|command| {
            let is_call = is_call(command.mnemonic);
            is_call || matches!(command.mnemonic, Mnemonic::WS | Mnemonic::WA | Mnemonic::WN | Mnemonic::WF)
        });
        if let Some(at) = moves.filter(|_| !waits) {
            let name = commands[at].mnemonic.name();
            self.say(codes::NO_WAIT, places[at], format!("The loop begins again before {name} has ended."));
            self.hint("Put WS behind the move.");
        }
        for (at, command) in body.iter().enumerate() {
            if matches!(command.mnemonic, Mnemonic::UD | Mnemonic::DB | Mnemonic::RM | Mnemonic::RZ) {
                let message = format!(
                    "{} writes to EEPROM in each round, which wears it out.",
                    command.mnemonic.name()
                );
                self.say(codes::WEARS_OUT, places[at], message);
            }
        }
        // Two repeats in sequence go on for ever.
        let forever = repeats.windows(2).find(|pair| pair[0] + 1 == pair[1]).map(|pair| pair[1] + 1);
        if let Some(at) = forever.filter(|at| *at < commands.len()) {
            self.say(
                codes::UNREACHABLE,
                places[at],
                "Two RP in sequence repeat for ever: nothing comes after them.".to_owned(),
            );
        }
    }

    fn may_move(&self, number: u8, seen: &mut Vec<u8>) -> bool {
        if seen.contains(&number) {
            return false;
        }
        seen.push(number);
        let Some(known) = self.macros.iter().find(|known| known.number == number) else { return true };
        known.commands.iter().any(|command| {
            let called = command.number.and_then(|number| u8::try_from(number).ok());
            match called.filter(|_| is_call(command.mnemonic)) {
                Some(called) => self.may_move(called, seen),
                None => command.row().effect.may_move(),
            }
        })
    }

    fn leads_to(&self, from: u8, to: u8, seen: &mut Vec<u8>) -> bool {
        if from == to {
            return true;
        }
        if seen.contains(&from) {
            return false;
        }
        seen.push(from);
        let called: Vec<u8> = self
            .macros
            .iter()
            .filter(|known| known.number == from)
            .flat_map(|known| calls_of(known).map(|(called, ..)| called).collect::<Vec<_>>())
            .collect();
        called.into_iter().any(|called| self.leads_to(called, to, seen))
    }

    fn finish(mut self) -> Checked {
        self.said.sort_by_key(|said| said.span.start);
        for severity in [Severity::Error, Severity::Warning] {
            let mut count = 0;
            self.said.retain(|said| {
                count += usize::from(said.severity() == severity);
                said.severity() != severity || count <= MOST_SAID
            });
            if severity == Severity::Error && count > MOST_SAID {
                let message = format!("{} more errors are not listed.", count - MOST_SAID);
                let span = self.said.last().map_or(Span::new(0, 0), |last| last.span);
                self.say(codes::MORE_ERRORS, span, message);
            }
        }
        Checked { macros: self.macros, diagnostics: self.said }
    }
}

/// Macros that a macro calls, where, and whether the call is its last command.
fn calls_of(known: &Macro) -> impl Iterator<Item = (u8, Span, bool)> {
    let last = known.commands.len().saturating_sub(1);
    known.commands.iter().zip(&known.places).enumerate().filter_map(move |(at, (command, place))| {
        let called = command.number.filter(|_| is_call(command.mnemonic))?;
        Some((u8::try_from(called).ok()?, *place, at == last))
    })
}

fn is_call(mnemonic: Mnemonic) -> bool {
    matches!(mnemonic, Mnemonic::MC | Mnemonic::EM)
}

/// What a word may have meant: the command of that title.
fn titled(word: &str) -> Option<String> {
    let close = |title: &str| {
        lexer::is_word(word) && title.to_ascii_lowercase().starts_with(&word.to_ascii_lowercase())
    };
    let row = COMMANDS.iter().find(|row| word.len() > 2 && close(row.title))?;
    Some(format!("{} is {}", row.title, row.name))
}
