//! The registers of a Motion Mind as they are now: settings come from the settings' model, and what the unit measures is read
//! all at once while a screen shows it.

use std::time::Duration;

use brushwork_link::device::{Event, Request};
use brushwork_motion_mind_wire::{REGISTERS, Register, register_named};
use brushwork_values::{Value, Values};

pub const RCCOUNT: &str = "RCCOUNT";
pub const FUNCTION: &str = "FUNCTION";
pub const FUNCTION2: &str = "FUNCTION2";

/// READ with every register of the mask.
const READ_ALL: u8 = 0x1A;
/// Answers to the window's own reads begin with this number, far from those of commands by hand.
const FIRST_ID: u64 = 1 << 40;
/// Time between two reads of all registers.
const INTERVAL: Duration = Duration::from_millis(400);
/// After so long an answer is not waited for any more.
const PATIENCE: Duration = Duration::from_secs(3);

/// Every register as it was read last, raw.
#[derive(Debug, Default)]
pub struct Live {
    values: [Option<i64>; REGISTERS.len()],
    /// The number of the read that is under way, and when it was asked for.
    waiting: Option<(u64, Duration)>,
    asked: u64,
    last_at: Option<Duration>,
}

impl Live {
    /// The request that reads all registers, when it is time for it.
    pub fn read(&mut self, now: Duration) -> Option<Request> {
        if self.waiting.is_some_and(|(_, at)| now.saturating_sub(at) < PATIENCE)
            || self.last_at.is_some_and(|at| now.saturating_sub(at) < INTERVAL)
        {
            return None;
        }
        self.asked += 1;
        let id = FIRST_ID + self.asked;
        self.waiting = Some((id, now));
        self.last_at = Some(now);
        Some(Request::Transact { id, command: READ_ALL, values: Vec::new() })
    }

    /// The request was not taken.
    pub fn not_begun(&mut self) {
        self.waiting = None;
    }

    /// Takes in an answer to such a read. True where the event was one.
    pub fn take(&mut self, event: &Event) -> bool {
        let Event::Transacted { id, result } = event else { return false };
        if *id < FIRST_ID {
            return false;
        }
        if self.waiting.is_some_and(|(waiting, _)| waiting == *id) {
            self.waiting = None;
        }
        if let Ok(values) = result {
            self.note(values);
        }
        true
    }

    fn note(&mut self, values: &Values) {
        for (field, value) in values.iter() {
            if let (Some(register), Value::Int(value)) = (register_named(field.name), value) {
                self.values[usize::from(register.number)] = Some(*value);
            }
        }
    }

    /// The raw value of a register.
    pub fn get(&self, register: &Register) -> Option<i64> {
        self.values[usize::from(register.number)]
    }

    /// Nothing is known: another unit, or none.
    pub fn forget(&mut self) {
        *self = Self { asked: self.asked, ..Self::default() };
    }
}

/// The key of a register in the settings table, where it can be written.
pub fn key(register: &Register) -> String {
    format!("register.{}", register.name.to_lowercase())
}

/// A raw value in the register's unit: "2.000 ms". Numbers without a unit stand as they are.
pub fn in_unit(register: &Register, raw: i64) -> Option<String> {
    if register.name == "THERMISTOR" {
        return Some(format!("{:.1} °C", celsius(raw)));
    }
    if register.unit.is_empty() {
        return None;
    }
    let value = raw as f64 * register.scale;
    let decimals = match register.scale {
        scale if scale >= 1.0 => 0,
        scale if scale >= 0.01 => 2,
        _ => 3,
    };
    Some(format!("{value:.decimals$} {}", register.unit))
}

/// The board's temperature from the thermistor (Motion Mind manual 3.18: the line through its two points).
fn celsius(raw: i64) -> f64 {
    (raw as f64 - 1104.0) * -0.165
}

/// The key of a bit in the settings table.
pub fn bit_key(register: &str, bit: &str) -> String {
    let bit: String = bit
        .to_lowercase()
        .chars()
        .map(|letter| if letter.is_alphanumeric() { letter } else { '_' })
        .collect();
    format!("{}.{bit}", register.to_lowercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_stand_in_the_unit_of_their_register() {
        let reported = |name: &str, raw| in_unit(register_named(name).unwrap(), raw);
        assert_eq!(reported("RCMAX", 1152).as_deref(), Some("2.000 ms"));
        assert_eq!(reported("AMPS", 512).as_deref(), Some("10.24 A"));
        assert_eq!(reported("THERMISTOR", 952).as_deref(), Some("25.1 °C"));
        assert_eq!(reported("TIMER", 10).as_deref(), Some("0.050 s"));
        assert_eq!(reported("PTERM", 6000), None);
    }

    #[test]
    fn one_read_at_a_time_and_a_lost_one_is_given_up() {
        let mut live = Live::default();
        let ms = Duration::from_millis;
        assert!(live.read(ms(0)).is_some());
        assert!(live.read(ms(1000)).is_none(), "the first waits for its answer");
        assert!(live.read(ms(3100)).is_some(), "after three seconds nobody waits");
    }
}
