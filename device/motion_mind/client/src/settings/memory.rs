//! The EEPROM of a Motion Mind: it is written register by register, and read by a new start alone.
//!
//! A write to EEPROM stops the motor for up to 40 ms. There is no command that reads EEPROM: RESET loads it, at the price of the
//! position and of a motor that coasts, so a save is not proven that way. What is stored is known by its acknowledge, and by its register
//! in RAM, which the same command writes and which is read back.

use brushwork_motion_mind_wire::numbers;

use super::register_of;
use crate::messages::{MotionMindActMessage, MotionMindCauseMessage, MotionMindRemedyMessage};
use brushwork_link::failure::Failure;
use brushwork_link::settings::await_unit;
use brushwork_link::settings::{ReadReport, is_final, is_there, read_all, went_out};
use brushwork_link::settings::{SaveReport, stored, unknown};
use brushwork_link::unit::UnitAddress;
use brushwork_link::wire::Wire;

/// Every register of the table with the word that `before` holds, in the order of the registers. One of which a part is not known is
/// left out.
fn words(before: &ReadReport) -> Vec<(u8, &'static str, i64)> {
    let mut words: Vec<(u8, &'static str, Option<i64>)> = Vec::new();
    for row in before.table.rows() {
        let (Some(register), Some(sink)) = (register_of(row), row.sink()) else { continue };
        let raw = before.image.get(&row.key).and_then(|value| row.encode(value));
        let at = words.iter().position(|(number, ..)| *number == register.number).unwrap_or_else(|| {
            words.push((register.number, register.name, Some(0)));
            words.len() - 1
        });
        let word = &mut words[at].2;
        *word = match (*word, raw) {
            (Some(word), Some(raw)) => Some(sink.place.bits.map_or(raw, |bits| bits.insert(word, raw))),
            _ => None,
        };
    }
    words.sort_by_key(|(number, ..)| *number);
    words.into_iter().filter_map(|(number, name, word)| Some((number, name, word?))).collect()
}

/// Stores every setting as the controller works with it. An error means that nothing was stored.
pub fn save(wire: &mut dyn Wire, before: &ReadReport) -> Result<SaveReport, Failure> {
    let words = words(before);
    let mut stored_any = false;
    for (done, (number, name, word)) in words.iter().enumerate() {
        wire.report_progress(done, words.len(), &format!("store {name}"));
        let stored = wire.transact(numbers::WRITE_STORE, &[i64::from(*number), *word]);
        if let Err(error) = stored {
            let failure = error.failure(MotionMindActMessage::Store { register: name }, wire.describe());
            if !stored_any && !went_out(&error) {
                return Err(failure);
            }
            return Ok(unknown(failure));
        }
        stored_any = true;
    }
    wire.report_progress(words.len(), words.len() + 1, "read back");
    Ok(match read_all(wire, *before.table.subject()) {
        Ok(after) => stored(before, &after),
        Err(failure) => unknown(failure),
    })
}

/// Starts the unit anew, which loads its EEPROM, and waits until it answers.
pub fn reload(wire: &mut dyn Wire) -> Result<(), Failure> {
    reset(wire)?;
    await_unit(wire, MotionMindActMessage::Reload)
}

fn reset(wire: &mut dyn Wire) -> Result<(), Failure> {
    wire.transact(numbers::RESET, &[]).map(drop).or_else(|error| {
        // Without an acknowledge it may have started anew all the same; the settings tell.
        if went_out(&error) && !is_final(&error) {
            return Ok(());
        }
        Err(error.failure(MotionMindActMessage::Reload, wire.describe()))
    })
}

/// Restores the factory values, in RAM and in EEPROM, and follows the unit to its factory address.
pub fn restore(wire: &mut dyn Wire) -> Result<(), Failure> {
    match wire.transact(numbers::RESTORE, &[]) {
        Ok(_) => {}
        Err(error) if went_out(&error) && !is_final(&error) => {}
        Err(error) => return Err(error.failure(MotionMindActMessage::Restore, wire.describe())),
    }
    let old = wire.address();
    if is_there(wire).is_ok() {
        return Ok(());
    }
    if wire.set_address(UnitAddress::factory(old.family())) && is_there(wire).is_ok() {
        return Ok(());
    }
    wire.set_address(old);
    Err(Failure::new(
        MotionMindActMessage::Restore,
        wire.describe(),
        MotionMindCauseMessage::NoAnswerAfterwards,
        MotionMindRemedyMessage::CheckPower,
    ))
}
