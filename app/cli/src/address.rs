//! `brushwork address`: gives controllers their addresses, one after the other, so that several can share a line.

use brushwork_core::addresses::{AddressList, in_words, name};
use std::io::{self, IsTerminal as _};
use std::time::{Duration, Instant};

use brushwork_core::addressing::{LOOK, Meant, address_of, in_order, is_sound, meant as meant_of};
use brushwork_core::messages::AddressMessage;
use brushwork_link::{Event, Identity, LinkStatistics, PollRate, Request};

use super::addresses::Line;
use super::args::AddressArgs;
use super::client::{self, ask};
use super::messages::CliAddressMessage;
use super::settings::args::WriteHow;
use super::settings::ask::line;
use super::settings::controller::Controller;
use super::settings::write::{Wanted, carry_out};
use super::{Client, ConnectArgs, Exit, Interrupt, Output, say};

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
    if !sounds_right(&controller)? {
        return Err(Exit::Refused.saying(AddressMessage::Garbled { unit: controller.describe() }));
    }
    let ram = controller.read()?;
    let Some(changes) = address_of(&ram, controller.write_options(), number) else {
        let (unit, address) = (controller.describe(), name(number));
        return Err(Exit::Refused.saying(AddressMessage::CannotHave { unit, address }));
    };
    let wanted = Wanted::of(changes);
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
    match meant_of(&units, number, named, given) {
        Meant::This(unit) => Ok(*unit),
        Meant::Taken => {
            Err(Exit::Refused.saying(AddressMessage::Taken { address: name(number), place: here() }))
        }
        Meant::Nobody => Err(Exit::NoLink.saying(AddressMessage::NobodyWaits { place: here() })),
        Meant::Several(addresses) => {
            let (units, place) = (in_words(&addresses), here());
            Err(Exit::Refused.saying(CliAddressMessage::SeveralMeant { units, place }))
        }
    }
}

/// Reads for a moment, and tells whether the replies are those of one unit.
fn sounds_right(controller: &Controller<'_>) -> Result<bool, Exit> {
    ask(controller.device(), Request::Poll(PollRate::Fastest))?;
    let until = Instant::now() + LOOK;
    let mut newest = LinkStatistics::default();
    while Instant::now() < until {
        if let Some(Event::Link(statistics)) = controller.next_event()? {
            newest = statistics;
        }
    }
    ask(controller.device(), Request::Poll(PollRate::Off))?;
    Ok(is_sound(&newest))
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
