//! Statements.

use super::block::{Block, Closer};
use super::counted::{are, values};
use super::{Broken, Parse, Parser, written};
use crate::board::Board;
use crate::mecc::ast::{Case, Expr, Name, Statement, StatementKind};
use crate::mecc::lexer::TokenKind;
use crate::mecc::{codes, events, words};
use crate::text::Span;

impl Parser<'_> {
    pub fn statement(&mut self) -> Parse<Statement> {
        let head = self.span();
        let kind = self.statement_kind(head)?;
        let is_block = matches!(
            kind,
            StatementKind::Loop(_)
                | StatementKind::Until { .. }
                | StatementKind::While { .. }
                | StatementKind::If { .. }
                | StatementKind::Select { .. }
        );
        let span = if is_block { head } else { head.to(self.span_before()) };
        Ok(Statement { kind, span })
    }

    fn statement_kind(&mut self, head: Span) -> Parse<StatementKind> {
        use StatementKind as Kind;
        let Some(word) = self.word_here() else {
            let found = self.found_here();
            let message = format!("A statement should begin here, but there is {found}.");
            let hint = "A statement begins with a command or with the variable that it sets.".to_owned();
            return self.fail(codes::UNKNOWN_COMMAND, message, Some(hint));
        };
        if let Some(command) = words::command(&word).filter(|command| !command.gives()) {
            self.advance();
            let arguments = self.arguments(command.word(), command.arguments())?;
            return Ok(Kind::Board { command, arguments });
        }
        self.form_unknown(&word)?;
        if !words::is_reserved(&word) {
            return self.assignment();
        }
        self.advance();
        match word.as_str() {
            "declare" => {
                if self.open.len() > 1 {
                    let message =
                        "A variable is declared at the top of its routine, not in a block.".to_owned();
                    let hint = "Move it above the block.".to_owned();
                    self.report(codes::MISPLACED, head, message, Some(hint));
                }
                self.local().map(|variable| Kind::Declare(Box::new(variable)))
            }
            "increment" => self.name("a variable").map(Kind::Increment),
            "call" => self.call(),
            "loop" => self.block(Block::Loop, head).map(Kind::Loop),
            "do" => self.until(head),
            "while" => {
                let condition = Box::new(self.expression()?);
                self.block(Block::While, head).map(|body| Kind::While { condition, body })
            }
            "if" => self.when(head),
            "select" => self.select(head),
            "wait" => self.argument("Wait").map(|ticks| Kind::Wait(Box::new(ticks))),
            "setevent" => self.set_event(),
            "enable" | "disable" => {
                let syntax = if word == "enable" { "Enable Events" } else { "Disable Events" };
                self.expect_word("Events", "behind it", syntax)?;
                Ok(Kind::Events(word == "enable"))
            }
            "transmit" => self.pointer("Transmit").map(Kind::Transmit),
            "receive" => self.pointer("Receive").map(Kind::Receive),
            "return" => {
                let ends = self.at_newline() || self.is_end();
                let value = if ends { None } else { Some(Box::new(self.expression()?)) };
                Ok(Kind::Return(value))
            }
            _ => self.no_statement(&word, head),
        }
    }

    /// A word of the language that begins no statement.
    fn no_statement<T>(&mut self, word: &str, head: Span) -> Parse<T> {
        self.at = self.at.saturating_sub(1);
        let shown = head.of(self.text).to_owned();
        if word == "end" {
            let hint = "Write which: End Loop, End If, End Program.".to_owned();
            let next = self.word_at(self.at + 1).unwrap_or_default();
            return self.fail(
                codes::UNEXPECTED,
                format!("`End {next}` ends nothing of this language."),
                Some(hint),
            );
        }
        let hint = match word {
            "getclock" | "readdata" | "readanalogue" | "getprogramnumber" | "setpointer" => {
                format!("It gives a value: write variable = {}", words::syntax(word))
            }
            _ => "Look at the reference: brushwork mecc reference".to_owned(),
        };
        self.fail(codes::UNKNOWN_COMMAND, format!("`{shown}` begins no statement."), Some(hint))
    }

    fn assignment(&mut self) -> Parse<StatementKind> {
        let typed = self.word_at(self.at).unwrap_or_default().to_owned();
        if !matches!(self.tokens.get(self.at + 1).map(|token| token.kind), Some(TokenKind::Sign("="))) {
            let is_call =
                matches!(self.tokens.get(self.at + 1).map(|token| token.kind), Some(TokenKind::Sign("(")));
            let message = format!("`{}` is no command.", crate::diagnostic::excerpt(&typed));
            let hint = if is_call {
                Some(format!("A function is called with Call: Call {typed}(...)"))
            } else {
                let small = typed.to_ascii_lowercase();
                words::instead_of(&small).map(str::to_owned).or_else(|| self.meant(&typed))
            };
            let hint = hint
                .unwrap_or_else(|| "A variable is set with =, a function is called with Call.".to_owned());
            return self.fail(codes::UNKNOWN_COMMAND, message, Some(hint));
        }
        let to = self.name("a variable")?;
        self.advance();
        let value = Box::new(self.expression()?);
        Ok(StatementKind::Assign { to, value })
    }

    /// The one argument of a command.
    fn argument(&mut self, command: &str) -> Parse<Expr> {
        self.no_argument_missing(command, 1, 0)?;
        self.expression()
    }

    fn no_argument_missing(&mut self, command: &str, wanted: usize, had: usize) -> Parse<()> {
        if !self.at_newline() && !self.is_end() {
            return Ok(());
        }
        let message = format!("{command} takes {}, and {} here.", values(wanted), are(had));
        self.fail(codes::ARGUMENT_COUNT, message, written(words::syntax(command)))
    }

    /// The arguments of a command, with commas between them.
    fn arguments(&mut self, command: &str, wanted: usize) -> Parse<Vec<Expr>> {
        let mut arguments: Vec<Expr> = Vec::new();
        while arguments.len() < wanted {
            self.no_argument_missing(command, wanted, arguments.len())?;
            arguments.push(self.expression()?);
            if arguments.len() < wanted && !self.skip_sign(",") {
                self.no_argument_missing(command, wanted, arguments.len())?;
                self.expect_sign(",", "between two values", words::syntax(command))?;
            }
        }
        if wanted > 0 && self.is_sign(",") {
            let message = format!("{command} takes {}, and there are more here.", values(wanted));
            return self.fail(codes::ARGUMENT_COUNT, message, written(words::syntax(command)));
        }
        Ok(arguments)
    }

    fn pointer(&mut self, command: &str) -> Parse<Name> {
        self.no_argument_missing(command, 1, 0)?;
        self.name("a DataPointer")
    }

    fn call(&mut self) -> Parse<StatementKind> {
        let name = self.name("a function")?;
        let arguments = if self.is_sign("(") { self.in_parentheses("Call")? } else { Vec::new() };
        Ok(StatementKind::Call { name, arguments })
    }

    fn until(&mut self, head: Span) -> Parse<StatementKind> {
        self.end_of_statement();
        let body = self.deeper(|parser| Ok(parser.statements(Block::Do)))?;
        let end = self.span();
        if self.closer() != Some(Closer::Until) {
            self.no_end(Block::Do, head);
            let condition = Box::new(Expr { kind: crate::mecc::ast::ExprKind::Number(1), span: end });
            return Ok(StatementKind::Until { body, condition, end });
        }
        self.advance();
        let condition = Box::new(self.expression()?);
        Ok(StatementKind::Until { body, condition, end })
    }

    /// `If`, in lines of its own or in one.
    fn when(&mut self, head: Span) -> Parse<StatementKind> {
        let condition = Box::new(self.expression()?);
        if self.at_newline() {
            let message = "`Then` should stand behind the condition, but the line ends.".to_owned();
            self.report(codes::UNEXPECTED, self.span(), message, written(words::syntax("If")));
        } else {
            self.expect_word("Then", "behind the condition", words::syntax("If"))?;
        }
        if !self.at_newline() && !self.is_end() {
            let then = self.deeper(|parser| Ok(vec![parser.statement()?]))?;
            let has_else = self.skip_word("else");
            let otherwise =
                if has_else { self.deeper(|parser| Ok(vec![parser.statement()?]))? } else { Vec::new() };
            return Ok(StatementKind::If { condition, then, otherwise });
        }
        self.deeper(|parser| {
            let then = parser.statements(Block::If);
            let mut otherwise = Vec::new();
            if parser.closer() == Some(Closer::Else) {
                parser.advance();
                if parser.is_word("if") {
                    let message = "Else stands in a line of its own.".to_owned();
                    let hint =
                        "Write Else, and the next If with its own End If in the lines below.".to_owned();
                    parser.report(codes::UNEXPECTED, parser.span(), message, Some(hint));
                    parser.skip_line();
                }
                parser.end_of_statement();
                otherwise = parser.statements(Block::Else);
            }
            parser.end_of_block(Block::If, head);
            Ok(StatementKind::If { condition, then, otherwise })
        })
    }

    /// `Select value`, `Select Case value`, and `Case value` in the line below `Select`: the maker's page is torn there.
    fn select(&mut self, head: Span) -> Parse<StatementKind> {
        if self.at_newline()
            && self.tokens.get(self.at + 1).is_some_and(|token| {
                token.kind == TokenKind::Word && token.span.of(self.text).eq_ignore_ascii_case("case")
            })
        {
            self.advance();
        }
        self.skip_word("case");
        self.no_argument_missing("Select", 1, 0)?;
        let value = Box::new(self.expression()?);
        self.end_of_statement();
        self.deeper(|parser| {
            let (mut cases, mut otherwise) = (Vec::new(), None);
            let before = parser.statements(Block::Select);
            if let Some(first) = before.first() {
                let message = "A Select begins with its first Case.".to_owned();
                let hint = "Write Case and a value above this.".to_owned();
                parser.report(codes::MISPLACED, first.span, message, Some(hint));
            }
            while parser.closer() == Some(Closer::Case) {
                let at = parser.span();
                parser.advance();
                let is_else = parser.skip_word("else");
                let values = if is_else { Vec::new() } else { parser.case_values() };
                // The first statement may stand in the line of its Case.
                let body = parser.statements(Block::Select);
                if is_else {
                    if otherwise.replace(body).is_some() {
                        let hint = Some("Keep one of them.".to_owned());
                        parser.report(
                            codes::MISPLACED,
                            at,
                            "This Select has two Case Else.".to_owned(),
                            hint,
                        );
                    }
                    continue;
                }
                if otherwise.is_some() {
                    let hint = Some("Put Case Else last.".to_owned());
                    parser.report(codes::MISPLACED, at, "A Case stands behind Case Else.".to_owned(), hint);
                }
                cases.push(Case { values, body });
            }
            parser.end_of_block(Block::Select, head);
            Ok(StatementKind::Select { value, cases, otherwise: otherwise.unwrap_or_default() })
        })
    }

    /// The values of a Case; of a line that is wrong those before that.
    fn case_values(&mut self) -> Vec<Expr> {
        let mut values = Vec::new();
        loop {
            match self.expression() {
                Ok(value) => values.push(value),
                Err(Broken) => {
                    self.skip_line();
                    return values;
                }
            }
            if !self.skip_sign(",") {
                return values;
            }
        }
    }

    fn set_event(&mut self) -> Parse<StatementKind> {
        let syntax = words::syntax("SetEvent");
        let Some(word) = self.word_at(self.at) else {
            let found = self.found_here();
            let message = format!("The name of an event should stand here, but there is {found}.");
            return self.fail(codes::UNEXPECTED, message, written(syntax));
        };
        let Some(event) = events::lookup(word) else {
            let message = format!("The board has no event `{}`.", crate::diagnostic::excerpt(word));
            self.guesses += 1;
            let names = events::EVENTS.iter().map(|event| event.name);
            let near = (self.guesses <= super::MOST_GUESSES)
                .then(|| crate::mcl::words::did_you_mean(word, names))
                .flatten();
            let known = "There are UserTimer1Event to UserTimer8Event, OnOff1Event to OnOff4Event, Stepper1Event, Stepper2Event, \
                         ReceiveEvent and TransmitEvent.";
            return self.fail(codes::UNKNOWN_EVENT, message, Some(near.unwrap_or_else(|| known.to_owned())));
        };
        self.advance();
        self.expect_sign(",", "behind the event", syntax)?;
        let handler = self.name("an event handler")?;
        if self.skip_sign("(") {
            self.expect_sign(")", "behind `(`", syntax)?;
        }
        Ok(StatementKind::SetEvent { event, handler })
    }

    /// Values in parentheses, for a function.
    pub fn in_parentheses(&mut self, syntax_of: &str) -> Parse<Vec<Expr>> {
        let syntax = words::syntax(syntax_of);
        self.expect_sign("(", "behind the name of the function", syntax)?;
        let mut arguments = Vec::new();
        if !self.is_sign(")") {
            loop {
                arguments.push(self.expression()?);
                if !self.skip_sign(",") {
                    break;
                }
            }
        }
        self.expect_sign(")", "behind the values", syntax)?;
        Ok(arguments)
    }

    /// A function of the board, which gives a value.
    pub fn board_value(&mut self, command: Board) -> Parse<Vec<Expr>> {
        let at = self.span_before();
        let arguments = if self.is_sign("(") { self.in_parentheses(command.word())? } else { Vec::new() };
        if arguments.len() != command.arguments() {
            let (wanted, had) = (values(command.arguments()), are(arguments.len()));
            let message = format!("{} takes {wanted}, and {had} here.", command.word());
            self.report(codes::ARGUMENT_COUNT, at, message, written(words::syntax(command.word())));
        }
        Ok(arguments)
    }
}
