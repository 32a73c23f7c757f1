//! `brushwork settings raw`: one number in one register, at its owner's word, where what it means is not public.
//!
//! It has a backup and a journal like every write, is read back, and is noted for the report of `brushwork examine`. No other command writes
//! past what the table of settings allows.

use crate::messages::CliSettingsMessage;
use brushwork_core::examine::RawWrite;
use brushwork_core::keep::{Store, today};
use brushwork_link::settings::{ReadReport, Row, SettingsImage};

use super::args::{RawArgs, RawNumber, WriteHow};
use super::controller::Controller;
use super::write::{self, Wanted};
use crate::{Exit, Interrupt, Output, say};

/// What is said before the question.
const WARNING: &str = "What this number means is not public: the controller may take it for anything, and a motor may move when something \
                       commands it. Take the load off, keep a hand on the power, and save it to EEPROM only when it does what you want.";

/// Writes the number, or undoes the newest one.
pub fn run(args: &RawArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let controller = Controller::connect(&args.connect, interrupt)?;
    let ram = controller.read()?;
    let store = Store::of_user();
    let number = match &args.number {
        Some(number) => number.clone(),
        None => newest(&store.raw_writes(&controller.unit).map_err(|fault| Exit::Failed.saying(fault))?)?,
    };
    let table = ram.table.at_owners_word(&number.key).map_err(|why| Exit::NotTaken.saying(why))?;
    let ram = ReadReport { table, ..ram };
    let Some(row) = ram.table.row(&number.key) else { return Err(Exit::Failed) };
    let changes = SettingsImage::from_iter([(number.key.clone(), row.decode(number.raw))]);
    if ram.image.get(&row.key).and_then(|value| row.register_of(value)) == Some(number.raw) {
        out.line(format!("{} holds {} already: there is nothing to write.", row.key, number.raw))?;
        return Ok(Exit::Done);
    }
    say(WARNING);
    let how = WriteHow { yes: args.own_risk, dry_run: args.dry_run, json: args.json, ..WriteHow::default() };
    let exit = write::carry_out(&controller, &ram, &Wanted::read(changes), &how, out)?;
    if args.dry_run {
        return Ok(exit);
    }
    let found = controller.read_quietly()?;
    let noted = noted(row, &ram, &found, number.raw);
    let undo = noted.before;
    store.note_raw_write(&controller.unit, noted).map_err(|error| Exit::Failed.saying(error))?;
    if let Some(before) = undo {
        say(CliSettingsMessage::RawUndo { before });
    }
    Ok(exit)
}

/// The number that undoes the newest one.
fn newest(writes: &[RawWrite]) -> Result<RawNumber, Exit> {
    let undoable = writes.last().and_then(|newest| Some((newest, newest.before?)));
    match undoable {
        Some((newest, before)) => Ok(RawNumber { key: newest.key.clone(), raw: before }),
        None => Err(Exit::Refused.saying(CliSettingsMessage::NoRawNumber)),
    }
}

fn noted(row: &Row, ram: &ReadReport, found: &ReadReport, wanted: i64) -> RawWrite {
    let register = |image: &SettingsImage| image.get(&row.key).and_then(|value| row.register_of(value));
    let sink = row.sink();
    RawWrite {
        date: today(),
        key: row.key.clone(),
        command: sink.map_or(0, |sink| sink.command),
        index: sink.and_then(|sink| sink.index),
        field: sink.map_or("", |sink| sink.place.field).to_owned(),
        before: register(&ram.image),
        wanted,
        found: register(&found.image),
    }
}
