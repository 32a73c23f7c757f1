//! From a request to the handler that acts on it.

use super::answer::{Answer, Arguments, Handler, Handlers};
use super::commands::THEMES;
use super::firmware::Firmware;
use brushwork_mcp_wire::packet_serial::Framed;

impl Firmware {
    /// Acts on one request for this unit.
    pub(super) fn execute(&mut self, framed: &Framed) -> Answer {
        match handler(framed.command.number) {
            Some(handler) => handler(self, &Arguments { values: &framed.values }),
            None => Answer::Silence,
        }
    }
}

/// The handler of a command byte.
pub(super) fn handler(number: u8) -> Option<Handler> {
    INDEX[usize::from(number)]
}

static INDEX: [Option<Handler>; 256] = index_of(&THEMES);

const fn index_of(themes: &[Handlers]) -> [Option<Handler>; 256] {
    let mut index = [None; 256];
    let mut theme = 0;
    while theme < themes.len() {
        let mut row = 0;
        while row < themes[theme].len() {
            let (number, handler) = themes[theme][row];
            index[number as usize] = Some(handler);
            row += 1;
        }
        theme += 1;
    }
    index
}
