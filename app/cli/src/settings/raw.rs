//! `brushwork settings raw`: one number in one register, at its owner's word, where what it means is not public.
//!
//! It has a backup and a journal like every write, is read back, and is noted for the report of `brushwork examine`. No other command writes
//! past what the table of settings allows.

use crate::messages::CliSettingsMessage;
use brushwork_core::keep::Store;
use brushwork_core::messages::RawMessage;
use brushwork_core::settings::raw::{Raw, held, undoing};
use brushwork_link::settings::ReadReport;

use super::args::{RawArgs, RawNumber, WriteHow};
use super::controller::Controller;
use super::write::{self, Wanted};
use crate::{Exit, Interrupt, Output, say};

/// Writes the number, or undoes the newest one.
pub fn run(args: &RawArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let controller = Controller::connect(&args.connect, interrupt)?;
    let ram = controller.read()?;
    let store = Store::of_user();
    let RawNumber { key, raw } = match &args.number {
        Some(number) => number.clone(),
        None => {
            let writes = store.raw_writes(&controller.unit).map_err(|fault| Exit::Failed.saying(fault))?;
            let undone = undoing(&writes).ok_or(CliSettingsMessage::NoRawNumber);
            undone.map(|(key, raw)| RawNumber { key, raw }).map_err(|why| Exit::Refused.saying(why))?
        }
    };
    let number = Raw::new(&ram.table, &ram.image, &key, raw).map_err(|why| Exit::NotTaken.saying(why))?;
    let ram = ReadReport { table: number.table.clone(), ..ram };
    if number.is_there() {
        out.line(format!("{key} holds {raw} already: there is nothing to write."))?;
        return Ok(Exit::Done);
    }
    say(RawMessage::Warning);
    let how = WriteHow { yes: args.own_risk, dry_run: args.dry_run, json: args.json, ..WriteHow::default() };
    let undo = number.write.before;
    let mut wanted = Wanted::read(number.changes);
    wanted.raw = Some(number.write);
    let exit = write::carry_out(&controller, &ram, &wanted, &how, out)?;
    if args.dry_run {
        return Ok(exit);
    }
    // What cannot be read back now is told at the next connection.
    let found = controller.read_quietly()?;
    let noted =
        store.end_raw_writes(&controller.unit, |write| held(found.table.row(&write.key)?, &found.image));
    noted.map_err(|error| Exit::Failed.saying(error))?;
    if let Some(before) = undo {
        say(CliSettingsMessage::RawUndo { before });
    }
    Ok(exit)
}
