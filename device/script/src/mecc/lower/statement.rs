//! Statements.

use super::Lowering;
use super::scope::Meaning;
use crate::arithmetic::Type;
use crate::board::Board;
use crate::mcl::ast::Binary;
use crate::mcl::types::{Part, VarType};
use crate::mecc::ast::{Case, Expr, Kind, Name, Statement, StatementKind};
use crate::mecc::board::{DIRECTIONS, FRAME_BYTES, TICKS_PER_SECOND};
use crate::mecc::{codes, events, words};
use crate::op::{Cell, Op};

impl Lowering<'_> {
    pub fn block(&mut self, statements: &[Statement]) {
        let mut ends = false;
        for statement in statements {
            if std::mem::take(&mut ends) {
                let hint = Some("Take it out, or move it above.".to_owned());
                self.report(codes::UNREACHABLE, statement.span, "Nothing leads to this.".to_owned(), hint);
            }
            self.at(statement.span);
            self.statement(statement);
            ends = matches!(statement.kind, StatementKind::Loop(_) | StatementKind::Return(_));
        }
    }

    fn statement(&mut self, statement: &Statement) {
        use StatementKind as K;
        let span = statement.span;
        match &statement.kind {
            K::Declare(variable) => {
                if let Some(symbol) = self.locals.get_mut(&variable.name.key) {
                    symbol.is_known = true;
                    let constant = self.first_value(variable).unwrap_or(0);
                    self.emit(Op::Push(constant));
                    self.store(&variable.name);
                }
            }
            K::Assign { to, value } => self.assign(to, value),
            K::Increment(name) => self.increment(name),
            K::Call { name, arguments } => {
                self.call(name, arguments);
            }
            K::Loop(body) => {
                let top = self.here();
                self.block(body);
                self.emit(Op::Jump(top));
            }
            K::Until { body, condition, end } => {
                let top = self.here();
                self.block(body);
                self.at(*end);
                self.expression(condition);
                self.emit(Op::JumpIfZero(top));
            }
            K::While { condition, body } => {
                self.facts.assume("While ... End While", span);
                let top = self.here();
                self.expression(condition);
                let out = self.jump(Op::JumpIfZero(0));
                self.block(body);
                self.at(span);
                self.emit(Op::Jump(top));
                self.land(out);
            }
            K::If { condition, then, otherwise } => {
                self.expression(condition);
                let over = self.jump(Op::JumpIfZero(0));
                self.block(then);
                if otherwise.is_empty() {
                    return self.land(over);
                }
                let out = self.jump(Op::Jump(0));
                self.land(over);
                self.block(otherwise);
                self.land(out);
            }
            K::Select { value, cases, otherwise } => self.select(value, cases, otherwise),
            K::Wait(ticks) => {
                self.expression(ticks);
                if let Some(constant) = self.constant(ticks) {
                    self.facts.waits.push((ticks.span, constant));
                }
                self.emit(Op::Wait(TICKS_PER_SECOND));
            }
            K::SetEvent { event, handler } => self.set_event(*event, handler),
            K::Events(on) => {
                self.facts.lets_events_in |= on;
                self.emit(Op::Events(*on));
            }
            K::Transmit(name) => {
                let Some(cell) = self.pointer(name, "Transmit") else { return };
                self.facts.frames.insert(name.key.clone());
                self.emit(Op::Load(cell));
                self.emit(Op::Send(FRAME_BYTES));
                self.move_on(cell, FRAME_BYTES);
            }
            K::Receive(name) => {
                let Some(cell) = self.pointer(name, "Receive") else { return };
                self.facts.frames.insert(name.key.clone());
                self.emit(Op::Load(cell));
                self.emit(Op::Receive(FRAME_BYTES));
                self.move_on(cell, FRAME_BYTES);
            }
            K::Return(value) => self.give_back(value.as_deref(), statement),
            K::Board { command, arguments } => {
                arguments.iter().for_each(|argument| self.expression(argument));
                self.check_board(*command, arguments);
                self.emit(Op::Board(*command));
            }
        }
    }

    /// Stores what is on the stack in a variable, or as the value of the function that is named.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn store(&mut self, to: &Name) -> Option<Kind> {
        if !self.locals.contains_key(&to.key)
            && let Some((_, at, kind)) = self.result.clone().filter(|(own, _, _)| *own == to.key)
        {
            self.facts.sets_value = true;
            self.facts.assume("A value that is given to the name of its function", to.span);
            self.emit(Op::Store(Cell { kind: kind.stored(), at: at * 8 }));
            return Some(kind);
        }
        match self.look_up(to)? {
            Meaning::Variable(kind, at) => {
                self.emit(Op::Store(Cell { kind: kind.stored(), at: at * 8 }));
                Some(kind)
            }
            other => {
                let message = format!("`{}` is {} and cannot be set.", to.span.of(self.text), other.title());
                let hint = "Only a Byte, a Word or a DataPointer is set with =.".to_owned();
                self.report(codes::NOT_A_VARIABLE, to.span, message, Some(hint));
                None
            }
        }
    }

    fn assign(&mut self, to: &Name, value: &Expr) {
        use crate::mecc::ast::ExprKind;
        self.expression(value);
        let Some(kind) = self.store(to) else { return };
        if let Some(constant) = self.constant(value) {
            self.check_fit(constant, kind, to, value.span);
        }
        let ExprKind::Address(table) = &value.kind else { return };
        if kind != Kind::Pointer {
            let message = format!(
                "`{}` is a {}, and a table's place goes into a DataPointer.",
                to.span.of(self.text),
                kind.title()
            );
            let hint = Some(format!("Declare DataPointer {}", to.span.of(self.text)));
            self.report(codes::NOT_A_POINTER, to.span, message, hint);
        }
        if let Some(Meaning::Table(at, length)) =
            self.globals.get(&table.key).map(|symbol| symbol.meaning.clone())
            && length < FRAME_BYTES
        {
            self.facts.short.push((to.key.clone(), table.clone(), at, length));
        }
    }

    fn increment(&mut self, name: &Name) {
        match self.look_up(name) {
            Some(Meaning::Variable(kind, at)) => {
                let cell = Cell { kind: kind.stored(), at: at * 8 };
                self.move_on(cell, 1);
            }
            Some(other) => {
                let message =
                    format!("`{}` is {} and cannot be counted.", name.span.of(self.text), other.title());
                let hint = Some("Only a variable is counted with Increment.".to_owned());
                self.report(codes::NOT_A_VARIABLE, name.span, message, hint);
            }
            None => {}
        }
    }

    /// The value is kept on the stack, of which each comparison takes a copy from where it is kept: a place in memory of its own.
    fn select(&mut self, value: &Expr, cases: &[Case], otherwise: &[Statement]) {
        let at = self.allocate(2);
        let kept = Cell { kind: VarType::Word, at: at * 8 };
        self.expression(value);
        self.emit(Op::Store(kept));
        let mut outs = Vec::new();
        let mut known = std::collections::HashSet::new();
        for case in cases {
            let mut hits = Vec::new();
            for value in &case.values {
                self.at(value.span);
                if let Some(constant) = self.constant(value)
                    && !known.insert(constant)
                {
                    let message = format!("Case {constant} stands above already, and that one is taken.");
                    self.report(codes::SAME_CASE, value.span, message, Some("Take it out.".to_owned()));
                }
                self.emit(Op::Load(kept));
                self.expression(value);
                self.emit(Op::Binary(Binary::Equal, Type::Unsigned));
                hits.push(self.jump(Op::JumpIfNotZero(0)));
            }
            let next = self.jump(Op::Jump(0));
            hits.into_iter().for_each(|hit| self.land(hit));
            self.block(&case.body);
            outs.push(self.jump(Op::Jump(0)));
            self.land(next);
        }
        self.block(otherwise);
        outs.into_iter().for_each(|out| self.land(out));
    }

    fn set_event(&mut self, event: u32, handler: &Name) {
        match self.look_up_or(handler, "Declare EventHandler name() ... End EventHandler") {
            Some(Meaning::Handler(routine)) => {
                self.used(handler);
                self.facts.handled |= 1 << event;
                self.facts.first_handler.get_or_insert(handler.span);
                self.emit_to(Op::Handle(event, 0), routine);
            }
            Some(other) => {
                let message =
                    format!("`{}` is {}, no event handler.", handler.span.of(self.text), other.title());
                let hint = Some(format!("It is written: {}", words::syntax("Declare EventHandler")));
                self.report(codes::NOT_A_HANDLER, handler.span, message, hint);
            }
            None => {}
        }
    }

    fn give_back(&mut self, value: Option<&Expr>, statement: &Statement) {
        self.facts.assume("Return", statement.span);
        match (value, self.result.clone()) {
            (Some(value), Some((_, _, kind))) => {
                self.facts.sets_value = true;
                self.expression(value);
                self.emit(Op::Part(Part { kind: kind.stored(), first_bit: 0 }));
                self.emit(Op::Return(Some(Type::Unsigned)));
            }
            (None, Some((_, at, kind))) => {
                self.emit(Op::Load(Cell { kind: kind.stored(), at: at * 8 }));
                self.emit(Op::Return(Some(Type::Unsigned)));
            }
            (Some(value), None) => {
                let hint = "Write Returns Word behind the parameters of the function.".to_owned();
                self.report(codes::NO_VALUE, value.span, "Nothing takes this value.".to_owned(), Some(hint));
            }
            (None, None) if self.in_program => {
                let message = "There is nothing to return to: this is the program.".to_owned();
                self.report(
                    codes::MISPLACED,
                    statement.span,
                    message,
                    Some("Use If to leave lines out.".to_owned()),
                );
            }
            (None, None) => self.emit(Op::Return(None)),
        }
    }

    /// Says which constants a command of the board does not take.
    pub fn check_board(&mut self, command: Board, arguments: &[Expr]) {
        let ranges: &[(&str, Takes)] = match command {
            Board::SetTimer => &[("timer", Takes::Number(1, events::TIMERS))],
            Board::SetMotor => {
                &[("motor", Takes::Number(1, 4)), ("direction", Takes::Direction), ("speed", Takes::Percent)]
            }
            Board::StopMotor => &[("motor", Takes::Number(1, 4))],
            Board::ConfigStepper => &[
                ("stepper", Takes::Number(1, 2)),
                ("minwait", Takes::Any),
                ("maxwait", Takes::Any),
                ("holdcurrent", Takes::Percent),
            ],
            Board::SetStepper => &[("stepper", Takes::Number(1, 2)), ("direction", Takes::Direction)],
            Board::SetServo => &[("servo", Takes::Number(1, 2)), ("direction", Takes::Direction)],
            Board::ReadAnalogue => &[("input", Takes::Number(1, 6))],
            Board::DisplayChars => &[("left", Takes::Byte), ("right", Takes::Byte)],
            Board::DisplayHex => &[("value", Takes::Byte)],
            Board::Beep | Board::GetClock | Board::StopMotors | Board::GetProgramNumber | Board::Debug => &[],
        };
        for ((name, takes), argument) in ranges.iter().zip(arguments) {
            let Some(value) = self.constant(argument) else { continue };
            self.check_argument(command, name, *takes, value, argument);
        }
        let first = arguments.first().and_then(|first| Some((first.span, self.constant(first)?)));
        if let (Board::SetMotor, Some(motor)) = (command, first) {
            self.facts.motors.push(motor);
        }
        if let (Board::ConfigStepper | Board::SetStepper, Some((_, stepper @ 1..=2))) = (command, first) {
            self.facts.steppers |= 1 << (stepper - 1);
        }
        if command == Board::SetTimer {
            if let Some(timer) = arguments.first().and_then(|timer| self.constant(timer)) {
                self.facts.timers.push((arguments[0].span, timer));
            }
            if let Some(ticks) = arguments.get(1).and_then(|ticks| self.constant(ticks)) {
                self.facts.old_ticks(arguments[1].span, ticks);
            }
        }
    }

    fn check_argument(&mut self, command: Board, name: &str, takes: Takes, value: u32, argument: &Expr) {
        let command = command.word();
        let (code, message, hint) = match takes {
            Takes::Number(least, most) if !(least..=most).contains(&value) => (
                codes::OUT_OF_RANGE,
                format!("{command} has no {name} {value}."),
                format!("There are {name} {least} to {most}."),
            ),
            Takes::Direction if !DIRECTIONS.iter().any(|letter| value == u32::from(*letter)) => (
                codes::OUT_OF_RANGE,
                format!("{} is no direction of {command}.", argument.span.of(self.text)),
                "A direction is \"F\" or \"B\".".to_owned(),
            ),
            Takes::Percent if value > 100 => (
                codes::DOES_NOT_FIT,
                format!("{value} is more than 100 %: {command} takes it as 100."),
                "It is a percentage.".to_owned(),
            ),
            Takes::Byte if value > 0xFF => (
                codes::DOES_NOT_FIT,
                format!("{value} does not fit a Byte: {command} shows {}.", value & 0xFF),
                "A Byte is 0 to 255.".to_owned(),
            ),
            Takes::Any | Takes::Number(..) | Takes::Direction | Takes::Percent | Takes::Byte => return,
        };
        self.report(code, argument.span, message, Some(hint));
    }
}

/// What an argument of a command takes.
#[derive(Clone, Copy, Debug)]
enum Takes {
    /// Whatever there is.
    Any,
    /// One of these.
    Number(u32, u32),
    /// "F" or "B".
    Direction,
    /// 0 to 100.
    Percent,
    /// 0 to 255.
    Byte,
}
