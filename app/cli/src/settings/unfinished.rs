//! `brushwork settings unfinished`: acts that were cut short, told at every connection until they are settled.

use brushwork_link::settings::{Act, Aftermath, ReadReport};
use serde_json::json;

use super::args::UnfinishedArgs;
use super::controller::Controller;
use super::cut_short;
use super::write::{self, Wanted};
use crate::{Exit, Interrupt, Output, say};
use brushwork_core::keep::{KeepError, OpenJournal, Store, aftermaths};
use brushwork_core::settings::remedy;

/// Shows what was cut short, and settles it when asked to.
pub fn run(args: &UnfinishedArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let controller = Controller::connect(&args.connect, interrupt)?;
    let ram = controller.read_quietly()?;
    let store = Store::of_user();
    let (journals, damaged) = store.open_journals(&controller.unit);
    damaged.iter().for_each(|fault| say(fault.to_string()));
    let aftermaths = aftermaths(&journals, &ram.table, &ram.image);
    show(args, &ram, &aftermaths, &damaged, out)?;
    cut_short::tell_raw(&controller.unit, &ram);
    // The newest alone is finished or undone; the ones before it were overtaken by it.
    if args.forget {
        store.put_damaged_journals_aside(&damaged).map_err(|error| Exit::Failed.saying(error))?;
        return close(&journals);
    }
    let Some(newest) = journals.last() else {
        return Ok(if damaged.is_empty() { Exit::Done } else { Exit::Different });
    };
    if !args.finish && !args.undo {
        return Ok(Exit::Different);
    }
    let is_simulated = controller.identity().simulated;
    let wanted = Wanted::read(remedy(&newest.journal, &ram.table, &ram.image, args.undo, is_simulated));
    let how = write::how(args, newest.journal.act == Act::Save);
    let exit = write::carry_out(&controller, &ram, &wanted, &how, out)?;
    if exit == Exit::Done && !args.dry_run { close(&journals) } else { Ok(exit) }
}

fn close(journals: &[OpenJournal]) -> Result<Exit, Exit> {
    Store::of_user().close_journals(journals).map_err(|error| Exit::Failed.saying(error))?;
    Ok(Exit::Done)
}

fn show(
    args: &UnfinishedArgs,
    ram: &ReadReport,
    aftermaths: &[Aftermath],
    damaged: &[KeepError],
    out: &mut Output,
) -> Result<(), Exit> {
    if args.json {
        let list: Vec<_> = aftermaths
            .iter()
            .map(|aftermath| {
                json!({
                    "aftermath": aftermath,
                    "headline": aftermath.headline(),
                    "sentences": aftermath.sentences(&ram.table),
                })
            })
            .collect();
        return Ok(out.json(&list)?);
    }
    if aftermaths.is_empty() && damaged.is_empty() {
        out.line("Nothing that was begun on this controller was cut short.")?;
    }
    for aftermath in aftermaths {
        out.line(aftermath.headline())?;
        out.lines(aftermath.sentences(&ram.table).iter().map(|sentence| format!("  {sentence}")))?;
    }
    Ok(())
}
