//! Compile-time directives (MCP manual 3.4.2, second of that number): what they leave out is skipped as tokens.

use super::Parser;
use crate::diagnostic::excerpt;
use crate::mcl::codes;
use crate::mcl::constant;
use crate::mcl::lexer::TokenKind;

const NAMES: [&str; 8] = ["if", "ifdef", "ifndef", "else", "elseif", "elseifdef", "elseifndef", "endif"];

impl Parser<'_> {
    /// Obeys the directive here.
    pub(super) fn directive(&mut self) {
        let TokenKind::Directive(name) = self.kind().clone() else { return };
        let span = self.span();
        match name.as_str() {
            "if" | "ifdef" | "ifndef" => {
                self.conditions.push(span);
                if !self.holds(&name) {
                    self.skip_branches();
                }
            }
            "else" | "elseif" | "elseifdef" | "elseifndef" | "endif" if self.conditions.is_empty() => {
                let message = format!("#{} without #IF.", excerpt(&name).to_uppercase());
                self.report(codes::BAD_DIRECTIVE, span, message, None);
                self.skip_line();
            }
            "endif" => {
                self.conditions.pop();
                self.advance();
            }
            // The branch before was compiled, so the rest up to #ENDIF is not.
            "else" | "elseif" | "elseifdef" | "elseifndef" => self.skip_to_end(),
            _ => {
                let hint = self.did_you_mean(&name, NAMES).map(|hint| hint.replace("mean ", "mean #"));
                let message = format!("`#{}` is no directive.", excerpt(&name));
                self.report(codes::BAD_DIRECTIVE, span, message, hint);
                self.skip_line();
            }
        }
    }

    /// Takes the condition of a directive and says whether it holds.
    fn holds(&mut self, name: &str) -> bool {
        let span = self.span();
        self.advance();
        if name.ends_with("def") {
            let Some(word) = self.word_here() else {
                self.report(codes::BAD_DIRECTIVE, span, "A name should follow.".into(), None);
                return false;
            };
            let known = self.defined.contains(word.to_ascii_lowercase().as_str())
                || crate::mcl::words::register(word).is_some();
            self.advance();
            return known != name.ends_with("ndef");
        }
        let Ok(condition) = self.expression() else { return false };
        let constants = &self.constants;
        match constant::evaluate(&condition, &|key| constants.get(key).copied()) {
            Ok(value) => value.is_true(),
            Err(error) => {
                let (message, hint) = error.reported("A condition of a directive");
                self.report(codes::NOT_CONSTANT, error.span, message, hint);
                false
            }
        }
    }

    /// Skips branches until one holds, or to the end of the whole.
    fn skip_branches(&mut self) {
        loop {
            let Some(name) = self.skip_branch() else { return };
            match name.as_str() {
                "endif" => {
                    self.conditions.pop();
                    return self.advance();
                }
                "else" => return self.advance(),
                _ => {
                    if self.holds(name.trim_start_matches("else")) {
                        return;
                    }
                }
            }
        }
    }

    fn skip_to_end(&mut self) {
        self.advance();
        while let Some(name) = self.skip_branch() {
            if name == "endif" {
                self.conditions.pop();
                return self.advance();
            }
            self.advance();
        }
    }

    /// Goes to the next directive of this level and gives its name; `None` at the end of the program.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn skip_branch(&mut self) -> Option<String> {
        let from = self.span();
        let mut inner = 0u32;
        loop {
            match self.kind() {
                TokenKind::End => {
                    self.left_out.push(from.to(self.span()));
                    return None;
                }
                TokenKind::Directive(name) => match name.as_str() {
                    "if" | "ifdef" | "ifndef" => inner += 1,
                    "endif" if inner > 0 => inner -= 1,
                    name if inner == 0 && NAMES.contains(&name) => {
                        let name = name.to_owned();
                        self.left_out.push(from.to(self.span_before()));
                        return Some(name);
                    }
                    _ => {}
                },
                _ => {}
            }
            self.advance();
        }
    }

    /// Says which #IFs are still open at the end.
    pub(super) fn close_conditions(&mut self) {
        for span in std::mem::take(&mut self.conditions) {
            let hint = Some("Write #ENDIF where it ends.".to_owned());
            self.report(codes::NO_BLOCK_END, span, "This #IF has no #ENDIF.".into(), hint);
        }
    }
}
