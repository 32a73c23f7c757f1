//! Finding a board: by the frames of the host library, and by the command line's answer to `H`. No program hears of either.

use crate::controller::facts::MotorvatorFacts;
use crate::controller::speaker::{Found, Speaker, look};
use crate::controller::stopping;
use crate::controller::unit::Board;
use crate::family::{Half, MOTORVATOR, NAME, VERSION, firmware};
use crate::messages::{MotorvatorCauseMessage, MotorvatorIdentityMessage, MotorvatorRemedyMessage};
use brushwork_link::Message;
use brushwork_link::device::controller::{Controller, DiscoverError, Line, Search};
use brushwork_link::device::{Addresses, DeviceOptions, Facts, Identity, StopBytes};
use brushwork_link::failure::Failure;
use brushwork_link::messages::ActMessage;
use brushwork_motorvator_wire::host;

/// The board on a line, in its halves.
#[derive(Clone, Copy, Debug)]
pub struct Boards;

impl Search for Boards {
    fn discover(
        &mut self,
        line: &mut Line<'_>,
        options: &DeviceOptions,
    ) -> Result<Vec<Box<dyn Controller>>, DiscoverError> {
        let heard_before = line.exchange().statistics().bytes_in;
        let found = look(line)?;
        let halves = halves(options.addresses);
        if halves.is_empty() || matches!(found, Found::Bytes | Found::Nothing) {
            return Err(nothing_there(line, heard_before));
        }
        let boards = halves.into_iter().map(|half| {
            let identity = identify(line, half, found, options.simulated);
            Box::new(Board::new(Speaker::new(half, found), half, identity)) as Box<dyn Controller>
        });
        Ok(boards.collect())
    }

    fn stop_bytes(&self, _addresses: Addresses) -> StopBytes {
        stopping::bytes()
    }

    fn stop_all_bytes(&self, units: &[&Identity]) -> Option<StopBytes> {
        (!units.is_empty()).then(stopping::bytes)
    }
}

/// The halves that are asked for.
fn halves(addresses: Addresses) -> Vec<Half> {
    let is_asked = |half: &Half| match addresses {
        Addresses::Scan => true,
        Addresses::Only(number) => half.number() == number,
        Addresses::These(set) => set.contains(half.number()),
        Addresses::Factory => *half == Half::First,
    };
    Half::ALL.into_iter().filter(is_asked).collect()
}

pub fn identify(line: &mut Line<'_>, half: Half, found: Found, simulated: bool) -> Identity {
    let note = match found {
        Found::Library(host::VERSION) => None,
        Found::Library(version) => Some(MotorvatorIdentityMessage::OtherLibrary { version }),
        Found::CommandLine | Found::Bytes | Found::Nothing => Some(MotorvatorIdentityMessage::NoLibrary),
    };
    let library = match found {
        Found::Library(version) => Some(version),
        Found::CommandLine | Found::Bytes | Found::Nothing => None,
    };
    Identity {
        address: half.number(),
        family: MOTORVATOR,
        protocol: MOTORVATOR.label(),
        version_text: NAME.to_owned(),
        model: Some(NAME),
        firmware: VERSION.to_string(),
        generation: firmware(),
        facts: Facts::new(MotorvatorFacts { half, library }),
        also_answers: Vec::new(),
        simulated,
        port: line.exchange().port(),
        notes: note.into_iter().map(Message::from).collect(),
    }
}

fn nothing_there(line: &mut Line<'_>, heard_before: u64) -> DiscoverError {
    let heard = line.exchange().statistics().bytes_in - heard_before;
    let (came_back, remedy) = match heard {
        0 => (MotorvatorCauseMessage::NothingAnswered, MotorvatorRemedyMessage::CheckPowerAndPort),
        count => (MotorvatorCauseMessage::BytesCame { count }, MotorvatorRemedyMessage::CheckBaudRate),
    };
    let on = line.exchange().port();
    DiscoverError::NothingThere(Failure::new(ActMessage::FindController, on, came_back, remedy))
}
