//! From a request to the handler that acts on it.

use super::answer::{Answer, Arguments, Handler, Handlers};
use super::commands::THEMES;
use super::firmware::Firmware;
use brushwork_mcp_wire::packet_serial::Framed;
use brushwork_values::Values;

impl Firmware {
    /// Acts on one request for this unit.
    pub(super) fn execute(&mut self, framed: &Framed) -> Answer {
        self.answer(framed.command.number, &framed.values)
    }

    /// Acts on a command byte with its values, whichever wire it came over.
    pub(super) fn answer(&mut self, number: u8, values: &Values) -> Answer {
        match handler(number) {
            Some(handler) => handler(self, &Arguments { values }),
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
