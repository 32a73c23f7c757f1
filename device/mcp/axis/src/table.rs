//! The registers of both loops by the keys of their settings.

use crate::registers::{McpHeld, McpRegisters, PositionRegisters, VELOCITY_SCALE, VelocityRegisters};
use brushwork_tuning::registers::{Form, RegisterField, RegisterTable};

/// Wire value of a position gain of 1 (public clients, 2015-2025).
const POSITION_SCALE: f64 = 1_024.0;

const fn velocity(key: &'static str, label: &'static str) -> RegisterField {
    RegisterField {
        key,
        of_motor: true,
        label,
        form: Form::Number,
        hint: "",
        unit: "",
        scale: VELOCITY_SCALE,
        decimals: 4,
        step: 0.01,
        range: (0.0, 65_535.0),
    }
}

const fn position(key: &'static str, label: &'static str) -> RegisterField {
    let range = (0.0, 2_000_000_000.0);
    RegisterField { scale: POSITION_SCALE, decimals: 3, step: 1.0, range, ..velocity(key, label) }
}

const fn counts(key: &'static str, label: &'static str, unit: &'static str) -> RegisterField {
    RegisterField { unit, scale: 1.0, decimals: 0, ..position(key, label) }
}

const fn end(key: &'static str, label: &'static str) -> RegisterField {
    RegisterField { step: 100.0, range: (-2_147_483_648.0, 2_147_483_647.0), ..counts(key, label, "counts") }
}

/// Those of the position loop first, as its screen has them.
static FIELDS: [RegisterField; 11] = [
    position("position.p", "Position P"),
    position("position.i", "Position I"),
    position("position.d", "Position D"),
    counts("position.max_i", "Max I", ""),
    counts("position.deadzone", "Deadzone", "counts"),
    end("position.min", "Min"),
    end("position.max", "Max"),
    velocity("velocity.p", "Velocity P"),
    velocity("velocity.i", "Velocity I"),
    velocity("velocity.d", "Velocity D"),
    RegisterField {
        step: 100.0,
        range: (0.0, 4_294_967_295.0),
        ..counts("velocity.qpps", "QPPS", "counts/s")
    },
];

/// A register of 32 bits, either way.
enum Word<'r> {
    Unsigned(&'r mut u32),
    Signed(&'r mut i32),
}

fn word<'r>(registers: &'r mut McpRegisters, key: &str) -> Option<Word<'r>> {
    let McpRegisters { velocity, position } = registers;
    Some(match key.split_once('.')? {
        ("velocity", name) => {
            let velocity = velocity.as_mut()?;
            Word::Unsigned(match name {
                "p" => &mut velocity.p,
                "i" => &mut velocity.i,
                "d" => &mut velocity.d,
                "qpps" => &mut velocity.qpps,
                _ => return None,
            })
        }
        ("position", name) => {
            let position = position.as_mut()?;
            match name {
                "p" => Word::Unsigned(&mut position.p),
                "i" => Word::Unsigned(&mut position.i),
                "d" => Word::Unsigned(&mut position.d),
                "max_i" => Word::Unsigned(&mut position.max_i),
                "deadzone" => Word::Unsigned(&mut position.deadzone),
                "min" => Word::Signed(&mut position.min),
                "max" => Word::Signed(&mut position.max),
                _ => return None,
            }
        }
        _ => return None,
    })
}

impl RegisterTable for McpRegisters {
    fn fields() -> Vec<&'static RegisterField> {
        FIELDS.iter().collect()
    }

    fn raw(&self, key: &str) -> Option<i64> {
        Some(match word(&mut { *self }, key)? {
            Word::Unsigned(raw) => i64::from(*raw),
            Word::Signed(raw) => i64::from(*raw),
        })
    }

    fn set_raw(&mut self, key: &str, raw: i64) {
        match word(self, key) {
            Some(Word::Unsigned(word)) => *word = u32::try_from(raw.max(0)).unwrap_or(u32::MAX),
            Some(Word::Signed(word)) => {
                *word = i32::try_from(raw).unwrap_or(if raw < 0 { i32::MIN } else { i32::MAX });
            }
            None => {}
        }
    }

    fn blank(with_position: bool) -> Self {
        let position = with_position.then(PositionRegisters::default);
        Self { velocity: Some(VelocityRegisters::default()), position }
    }

    fn of_speed(self) -> Self {
        Self { position: None, ..self }
    }

    fn has_a_loop(&self) -> bool {
        self.position.is_none_or(|position| position.p > 0 || position.i > 0)
    }
}

/// Both loops for people: name, held, proposed, and what is on the wire.
pub(crate) fn rows(held: &McpHeld, proposed: &McpRegisters, position_scale: f64) -> Vec<[String; 4]> {
    let mut rows = Vec::new();
    let mut row = |name: &str, old: String, new: String, raw: u32| {
        rows.push([name.to_owned(), old, new, raw.to_string()]);
    };
    let scaled = |raw: u32, scale: f64| format!("{:.4}", f64::from(raw) / scale);
    if let Some(new) = proposed.velocity {
        let old = held.velocity;
        for (name, old, new) in
            [("velocity P", old.p, new.p), ("velocity I", old.i, new.i), ("velocity D", old.d, new.d)]
        {
            row(name, scaled(old, VELOCITY_SCALE), scaled(new, VELOCITY_SCALE), new);
        }
        row("QPPS", old.qpps.to_string(), new.qpps.to_string(), new.qpps);
    }
    if let Some(new) = proposed.position {
        let old = held.position;
        for (name, old, new) in
            [("position P", old.p, new.p), ("position I", old.i, new.i), ("position D", old.d, new.d)]
        {
            row(name, scaled(old, position_scale), scaled(new, position_scale), new);
        }
        for (name, old, new) in
            [("position max I", old.max_i, new.max_i), ("position deadzone", old.deadzone, new.deadzone)]
        {
            row(name, old.to_string(), new.to_string(), new);
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_that_is_shown_and_set_again_is_the_same_register() {
        let position = PositionRegisters {
            p: 12_345,
            i: 7,
            d: 999_999,
            max_i: 50,
            deadzone: 3,
            min: -900,
            max: 1_000_000,
        };
        let velocity = VelocityRegisters { p: 0x1_2345, i: 1, d: 0x4000, qpps: 44_000 };
        let full = McpRegisters { velocity: Some(velocity), position: Some(position) };
        let mut again = McpRegisters::blank(true);
        for field in McpRegisters::fields() {
            again.set_value(field, full.value(field).unwrap());
        }
        assert_eq!(again, full);
    }

    #[test]
    fn without_a_position_loop_there_are_four_registers() {
        let reported = |registers: McpRegisters| {
            McpRegisters::fields().iter().filter(|field| registers.raw(field.key).is_some()).count()
        };
        assert_eq!((reported(McpRegisters::blank(false)), reported(McpRegisters::blank(true))), (4, 11));
    }
}
