//! `brushwork settings unfinished`: acts that were cut short, told at every connection until they are settled.

use brushwork_link::settings::{Act, Aftermath, ReadReport};
use serde_json::json;

use super::args::UnfinishedArgs;
use super::controller::Controller;
use super::cut_short::journals;
use super::write::{self, Wanted};
use crate::{Exit, Interrupt, Output};
use brushwork_core::keep::{OpenJournal, Store, aftermaths};
use brushwork_core::settings::remedy;

/// Shows what was cut short, and settles it when asked to.
pub fn run(args: &UnfinishedArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let controller = Controller::connect(&args.connect, interrupt)?;
    let ram = controller.read_quietly()?;
    let journals = journals(&controller.unit);
    let aftermaths = aftermaths(&journals, &ram.table, &ram.image);
    show(args, &ram, &aftermaths, out)?;
    // The newest alone is finished or undone; the ones before it were overtaken by it.
    let Some(newest) = journals.last() else { return Ok(Exit::Done) };
    if !args.finish && !args.undo {
        return if args.forget { close(&journals) } else { Ok(Exit::Different) };
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
    if aftermaths.is_empty() {
        out.line("Nothing that was begun on this controller was cut short.")?;
    }
    for aftermath in aftermaths {
        out.line(aftermath.headline())?;
        out.lines(aftermath.sentences(&ram.table).iter().map(|sentence| format!("  {sentence}")))?;
    }
    Ok(())
}
