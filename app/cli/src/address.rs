//! `brushwork address`: gives controllers their addresses, one after the other, so that several can share a line.
//!
//! Two units with one address answer at once and take a new one at once, so that they could never be told apart again by their line. So
//! nothing is written before one unit alone was found, its replies were sound, and nobody else was at the new address.

use std::io::{self, IsTerminal as _};
use std::time::{Duration, Instant};

use brushwork_link::settings::{ReadReport, plan};
use brushwork_link::{Event, FamilyRef, Identity, PollRate, Request, SettingsImage, families};

use super::addresses::{AddressList, Line, in_words, name};
use super::args::AddressArgs;
use super::client::{self, ask};
use super::messages::CliAddressMessage;
use super::settings::args::WriteHow;
use super::settings::ask::line;
use super::settings::controller::Controller;
use super::settings::write::{Wanted, carry_out};
use super::{Client, ConnectArgs, Exit, Interrupt, Output, say};

/// How long replies are looked at before an address is written.
const LOOK: Duration = Duration::from_millis(1200);
/// Of so many replies one may be wrong, or bring a byte too many; with two units that answer together most do.
const WRONG_OF: u64 = 50;
/// How long one look for an answer of the person waits.
const BREATH: Duration = Duration::from_millis(20);

/// Gives each address to a unit, and prints what became of it.
pub fn run(args: &AddressArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let numbers = in_order(args.to.numbers());
    let several = numbers.len() > 1;
    if several && !io::stdin().is_terminal() {
        return Err(Exit::Refused.saying(CliAddressMessage::NobodyConnects));
    }
    let mut given: Vec<u8> = Vec::new();
    for number in numbers {
        if several {
            say(CliAddressMessage::Connect { address: name(number) });
            line(&|| if interrupt.sleep(BREATH) { Err(Exit::Interrupted) } else { Ok(()) })?;
        }
        give(args, number, &given, out, interrupt)?;
        given.push(number);
    }
    Ok(Exit::Done)
}

/// The factory's address last: a new unit has it, and must be alone there, while those before it may stay on the line.
fn in_order(numbers: &[u8]) -> Vec<u8> {
    let is_factory = |number: &u8| families().iter().any(|family| family.factory_address() == *number);
    let (last, mut first): (Vec<u8>, Vec<u8>) = numbers.iter().partition(|number| is_factory(number));
    first.extend(last);
    first
}

/// Finds the unit that is meant, gives it the address, saves that, and looks for it there.
fn give(
    args: &AddressArgs,
    number: u8,
    given: &[u8],
    out: &mut Output,
    interrupt: &Interrupt,
) -> Result<(), Exit> {
    let unit = meant(args, number, given, interrupt)?;
    let at = |number| ConnectArgs { address: Some(AddressList::One(number)), ..args.connect.clone() };
    let controller = Controller::connect(&at(unit.address), interrupt)?;
    if !is_sound(&controller)? {
        return Err(Exit::Refused.saying(CliAddressMessage::Garbled { unit: controller.describe() }));
    }
    let ram = controller.read()?;
    let wanted = Wanted::of(address_of(&controller, &ram, number)?);
    let how = WriteHow { yes: args.yes, save: true, json: args.json, ..WriteHow::default() };
    let exit = carry_out(&controller, &ram, &wanted, &how, out)?;
    drop(controller);
    if exit != Exit::Done {
        return Err(exit.saying(CliAddressMessage::NotGiven { address: name(number) }));
    }
    let found = Client::connect(&at(number), PollRate::Off, interrupt).map_err(|exit| {
        exit.saying(CliAddressMessage::NotThereYet { address: name(number), old: name(unit.address) })
    })?;
    if !args.json {
        let Identity { port, .. } = &found.identity;
        out.line(format!("{} answers at {} on {port}.", found.identity.title(), found.identity.place()))?;
    }
    Ok(())
}

/// The one unit that is to have the address: the one that was named, or the only one that has none of this run.
fn meant(args: &AddressArgs, number: u8, given: &[u8], interrupt: &Interrupt) -> Result<Identity, Exit> {
    let line = Line { connect: args.connect.place(), address: None, family: args.connect.family };
    let target = client::target(&args.connect)?;
    let units = client::found(&target, &line, interrupt)?;
    let here = || line.connect.to_owned();
    let named = args.connect.address.as_ref().and_then(|list| list.numbers().first().copied());
    // Over USB one unit answers at every address, and nobody else can be there.
    let taken = units.len() > 1 && units.iter().any(|unit| unit.address == number);
    if taken && named != Some(number) {
        return Err(Exit::Refused.saying(CliAddressMessage::Taken { address: name(number), place: here() }));
    }
    let is_meant = |unit: &&Identity| match named {
        Some(named) => unit.address == named || unit.also_answers.contains(&named),
        None => !given.contains(&unit.address),
    };
    let meant: Vec<Identity> = units.iter().filter(is_meant).cloned().collect();
    match <[Identity; 1]>::try_from(meant) {
        Ok([unit]) => Ok(unit),
        Err(meant) if meant.is_empty() => {
            Err(Exit::NoLink.saying(CliAddressMessage::NoneMeant { place: here() }))
        }
        Err(meant) => {
            let addresses: Vec<u8> = meant.iter().map(|unit| unit.address).collect();
            let (units, place) = (in_words(&addresses), here());
            Err(Exit::Refused.saying(CliAddressMessage::SeveralMeant { units, place }))
        }
    }
}

/// Reads for a moment, and tells whether the replies are those of one unit.
fn is_sound(controller: &Controller<'_>) -> Result<bool, Exit> {
    ask(controller.device(), Request::Poll(PollRate::Fastest))?;
    let until = Instant::now() + LOOK;
    let (mut right, mut wrong) = (0, 0);
    while Instant::now() < until {
        if let Some(Event::Link(statistics)) = controller.next_event()? {
            // Two units spoil each other's bytes, or one of them speaks when the other has ended.
            (right, wrong) = (statistics.transactions, statistics.crc_errors + statistics.stray_bytes);
        }
    }
    ask(controller.device(), Request::Poll(PollRate::Off))?;
    Ok(wrong * WRONG_OF <= right)
}

/// The setting that gives a unit the address, by whichever of its family's settings the unit has.
fn address_of(controller: &Controller<'_>, ram: &ReadReport, number: u8) -> Result<SettingsImage, Exit> {
    let family: FamilyRef = controller.identity().family;
    let moves = |wanted: &SettingsImage| {
        let plan = plan(&ram.table, &ram.image, wanted, controller.write_options()).ok()?;
        plan.steps.iter().find_map(|step| family.settings().new_address(step)).or(Some(number))
    };
    let rows = family.settings().address_keys().iter().filter_map(|key| ram.table.row(key));
    let values = rows.filter_map(|row| {
        let texts = [family.address_text(number), number.to_string()];
        let value = texts.iter().find_map(|text| row.parse(text).ok())?;
        Some(SettingsImage::from_iter([(row.key.clone(), value)]))
    });
    let found = values.into_iter().find(|wanted| moves(wanted) == Some(number));
    found.ok_or_else(|| {
        let (unit, address) = (controller.describe(), name(number));
        Exit::Refused.saying(CliAddressMessage::CannotHave { unit, address })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factorys_address_is_given_last() {
        brushwork_link::install(&[
            &brushwork_mcp_client::McpDriver,
            &brushwork_motion_mind_client::MotionMindDriver,
        ]);
        assert_eq!(in_order(&[0x80, 0x81, 0x82]), [0x81, 0x82, 0x80]);
        assert_eq!(in_order(&[1, 5, 3]), [5, 3, 1]);
    }
}
