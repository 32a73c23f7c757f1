//! Names that nothing uses.

use super::super::codes;
use super::Lowering;
use super::scope::SymbolKind;
use crate::diagnostic::excerpt;

impl Lowering<'_> {
    /// Names that nothing uses.
    pub(super) fn warn_of_unused(&mut self) {
        let mut found = Vec::new();
        for entry in self.scope.entries() {
            let name = excerpt(entry.symbol.defined.of(self.text));
            let (code, message) = match entry.symbol.kind {
                SymbolKind::Variable if !entry.is_read && entry.is_written => {
                    (codes::UNUSED_VARIABLE, format!("`{name}` is set but never read."))
                }
                SymbolKind::Variable if !entry.is_read => {
                    (codes::UNUSED_VARIABLE, format!("`{name}` is never used."))
                }
                SymbolKind::Label if entry.symbol.uses.is_empty() => {
                    (codes::UNUSED_LABEL, format!("Nothing jumps to `{name}`."))
                }
                SymbolKind::Variable
                | SymbolKind::Alias
                | SymbolKind::Constant
                | SymbolKind::Table
                | SymbolKind::Label
                | SymbolKind::Function
                | SymbolKind::Handler => continue,
            };
            found.push((code, entry.symbol.defined, message));
        }
        for (code, span, message) in found {
            self.report(code, span, message, None);
        }
    }
}
