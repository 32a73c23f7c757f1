//! A macro file of macros that a controller told, so that what is on it can be kept, read and changed.

use super::check::{Checked, Macro};
use brushwork_suprmotr_wire::{Command, Mnemonic};
use std::fmt::Write as _;

/// A file of these macros. A macro has the name that a file known before gives to its number, else `macro_N`; a name that calls it is used where it
/// is called.
pub fn written(macros: &[(u8, Vec<Command>)], known: &Checked) -> String {
    let name = |number: u8| {
        let named = known.macros.iter().find(|known| known.number == number);
        named.map_or_else(|| format!("macro_{number}"), |Macro { name, .. }| name.clone())
    };
    let mut page = String::new();
    for (number, commands) in macros {
        if !page.is_empty() {
            page.push('\n');
        }
        // Writing to a string cannot fail.
        let _ = writeln!(page, "macro {} = {number}", name(*number));
        for command in commands {
            let letters = command.mnemonic.name();
            let called = command.number.and_then(|number| u8::try_from(number).ok());
            let is_call = matches!(command.mnemonic, Mnemonic::MC | Mnemonic::EM);
            let is_here =
                called.filter(|called| is_call && macros.iter().any(|(number, _)| number == called));
            let _ = match (is_here, command.number) {
                (Some(called), _) => writeln!(page, "    {letters} {}", name(called)),
                (None, Some(number)) => writeln!(page, "    {letters} {number}"),
                (None, None) => writeln!(page, "    {letters}"),
            };
        }
    }
    page
}
