//! What the debugger needs before there is anything to show.

use std::borrow::Cow;

use crate::model::Model;

/// Why there is nothing to debug; none where there is.
pub fn why_not(model: &Model) -> Option<Cow<'static, str>> {
    if !model.is_connected() {
        return Some("The debugger needs a simulated controller: connect to sim:mcp266, then download and start the program.".into());
    }
    if model.front.worlds.is_none() {
        return Some(
            "The debugger works with controllers that are simulated in this program. The protocol cannot stop a program \
             in the middle or read its variables, so on this controller use PUTS and the terminal; or connect to \
             sim:mcp266 and download the program there."
                .into(),
        );
    }
    None
}
