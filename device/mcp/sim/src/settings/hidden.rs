//! Settings that no public command carries. A person at a simulated controller can still set them, by key.
//!
//! Keys: `unit.bridge_channels`, `dout.N.inverted`, `stream.ttl1.multi_unit` to `ttl3`, `pin.N.digital`, `pin.N.low_pass`,
//! `can.rate`, `can.node_id`, `i2c.rate`; N counts from 1, values are raw.

use super::Settings;

/// A key that names no setting without a wire form, or not one this model has.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("this simulated controller has no hidden setting {0:?}")]
pub struct UnknownKey(pub String);

impl Settings {
    /// The raw value of a setting without a wire form.
    pub fn hidden(&self, key: &str) -> Result<i64, UnknownKey> {
        // Reading goes through the writing side on a copy, so that the list of keys exists once.
        let mut copy = self.clone();
        let value = copy.hidden_mut(key).map(|field| field.get());
        value.ok_or_else(|| UnknownKey(key.to_owned()))
    }

    /// Sets a setting without a wire form. Flags take 0 and 1; out-of-range values are limited.
    pub fn set_hidden(&mut self, key: &str, value: i64) -> Result<(), UnknownKey> {
        match self.hidden_mut(key) {
            Some(field) => {
                field.set(value);
                Ok(())
            }
            None => Err(UnknownKey(key.to_owned())),
        }
    }

    fn hidden_mut(&mut self, key: &str) -> Option<Field<'_>> {
        let mut parts = key.split('.');
        let (group, name, field) = (parts.next()?, parts.next()?, parts.next());
        match (group, name, field) {
            ("unit", "bridge_channels", None) => Some(Field::Flag(&mut self.unit.bridged)),
            ("can", "rate", None) => Some(Field::U32(&mut self.unit.can_rate_bps)),
            ("can", "node_id", None) => Some(Field::NodeId(&mut self.unit.can_node_id)),
            ("i2c", "rate", None) => Some(Field::U32(&mut self.unit.i2c_rate_bps)),
            ("dout", number, Some("inverted")) => {
                self.outputs.get_mut(index(number)?).map(|output| Field::Flag(&mut output.inverted))
            }
            ("pin", number, Some("digital")) => {
                self.signals.get_mut(index(number)?).map(|signal| Field::Flag(&mut signal.digital))
            }
            ("pin", number, Some("low_pass")) => {
                self.signals.get_mut(index(number)?).map(|signal| Field::LowPass(&mut signal.low_pass))
            }
            ("stream", name, Some("multi_unit")) => {
                let uart = ["ttl1", "ttl2", "ttl3"].iter().position(|ttl| *ttl == name)?;
                Some(Field::Flag(&mut self.streams[uart + 2].multi_unit))
            }
            _ => None,
        }
    }
}

enum Field<'a> {
    Flag(&'a mut bool),
    U32(&'a mut u32),
    LowPass(&'a mut u8),
    NodeId(&'a mut u8),
}

/// Largest exponent of the low-pass filter: 2^15 samples.
const MAX_LOW_PASS: i64 = 15;

/// Largest CANopen node id (MCP manual 1.9.4).
const MAX_NODE_ID: i64 = 127;

impl Field<'_> {
    fn get(&self) -> i64 {
        match self {
            Self::Flag(flag) => i64::from(**flag),
            Self::U32(value) => i64::from(**value),
            Self::LowPass(value) | Self::NodeId(value) => i64::from(**value),
        }
    }

    fn set(self, value: i64) {
        match self {
            Self::Flag(flag) => *flag = value != 0,
            Self::U32(field) => *field = value.clamp(0, i64::from(u32::MAX)) as u32,
            Self::LowPass(field) => *field = value.clamp(0, MAX_LOW_PASS) as u8,
            Self::NodeId(field) => *field = value.clamp(1, MAX_NODE_ID) as u8,
        }
    }
}

/// The index behind a number that counts from 1.
fn index(number: &str) -> Option<usize> {
    number.parse::<usize>().ok()?.checked_sub(1)
}
