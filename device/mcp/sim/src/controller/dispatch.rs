//! From a request to the handler that acts on it.

use super::answer::{AnyAnswer, Handler};
use super::commands::THEMES;
use super::firmware::Firmware;
use brushwork_mcp_wire::packet_serial::Framed;
use brushwork_values::Values;
use std::sync::LazyLock;

impl Firmware {
    /// Acts on one request for this unit.
    pub(super) fn execute(&mut self, framed: &Framed) -> AnyAnswer {
        self.answer(framed.command.number, &framed.values)
    }

    /// Acts on a command byte with its values, whichever wire it came over.
    pub(super) fn answer(&mut self, number: u8, values: &Values) -> AnyAnswer {
        match handler(number) {
            Some(handler) => handler.act(self, values),
            None => AnyAnswer::Silence,
        }
    }
}

/// The handler of a command byte.
pub(super) fn handler(number: u8) -> Option<&'static dyn Handler> {
    INDEX[usize::from(number)]
}

static INDEX: LazyLock<[Option<&dyn Handler>; 256]> = LazyLock::new(|| {
    let mut index = [None; 256];
    for handler in THEMES.into_iter().flatten() {
        index[usize::from(handler.number())] = Some(*handler);
    }
    index
});
