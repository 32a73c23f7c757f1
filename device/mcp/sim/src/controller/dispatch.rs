//! From a request to the handler that acts on it.

use super::answer::{AnyAnswer, Handler};
use super::commands::THEMES;
use super::firmware::Firmware;
use brushwork_mcp_wire::packet_serial::Framed;
use brushwork_mcp_wire::packet_serial::name::{KEY, MAX_ACTION, MIN_ACTION, Name};
use brushwork_values::{Value, Values};
use std::sync::LazyLock;

impl Firmware {
    /// Acts on one request for this unit.
    pub(super) fn execute(&mut self, framed: &Framed) -> AnyAnswer {
        self.answer(framed.command.number, &framed.values)
    }

    /// Acts on a command byte with its values, whichever wire it came over. A packet that is not valid for any reason is not
    /// acknowledged (MCP manual 2.2.5); that a value beyond its valid range is such a reason, and changes nothing, is assumed.
    pub(super) fn answer(&mut self, number: u8, values: &Values) -> AnyAnswer {
        match handler(number) {
            Some(handler) if is_valid(values) => handler.act(self, values),
            Some(_) | None => AnyAnswer::Silence,
        }
    }
}

/// Fields that are taken whatever they carry: a wrong key has an answer of its own, and the actions of a signal may be joined.
const ALWAYS_VALID: [&str; 3] = [KEY::TEXT, MIN_ACTION::TEXT, MAX_ACTION::TEXT];

fn is_valid(values: &Values) -> bool {
    values.iter().all(|(field, value)| match value {
        Value::Int(raw) => ALWAYS_VALID.contains(&field.name) || field.allows(*raw),
        Value::Text(_) | Value::Bytes(_) | Value::Records(_) => true,
    })
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
