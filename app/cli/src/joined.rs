//! Controllers that act together: of each line one link, with the units that are meant of it.

use brushwork_link::{Identity, PollRate, Request};

use super::addresses::{AddressList, Line, in_words};
use super::client::ask;
use super::messages::CliUnitsMessage;
use super::{Client, ConnectArgs, Exit, Interrupt};

/// A line, and those of its controllers that act together. The link's selected one comes first.
pub struct JoinedLine {
    /// The link.
    pub client: Client,
    /// As it was typed.
    pub place: String,
    /// Who they are.
    pub units: Vec<Identity>,
}

/// Opens all lines that are named. Whoever is named and is not there keeps all of them from acting.
///
/// # Errors
/// Says on standard error what went wrong and gives the exit code.
pub fn open(args: &ConnectArgs, poll: PollRate, interrupt: &Interrupt) -> Result<Vec<JoinedLine>, Exit> {
    let line = |place: &String| {
        let own = ConnectArgs { connect: vec![place.clone()], ..args.clone() };
        let (client, units) = match &args.address {
            Some(list @ (AddressList::These(_) | AddressList::All)) => {
                let line = Line { connect: place, address: Some(list), family: args.family };
                let (client, units) = Client::connect_all(&own, poll, interrupt)?;
                let is_there = |number: &u8| units.iter().any(|unit| unit.address == *number);
                let missing: Vec<u8> =
                    line.numbers().iter().copied().filter(|number| !is_there(number)).collect();
                if !missing.is_empty() {
                    let addresses = in_words(&missing);
                    return Err(
                        Exit::NoLink.saying(CliUnitsMessage::NotAllThere { addresses, place: place.clone() })
                    );
                }
                (client, units)
            }
            None | Some(AddressList::One(_)) => {
                let client = Client::connect(&own, poll, interrupt)?;
                let units = vec![client.identity.clone()];
                (client, units)
            }
        };
        Ok(JoinedLine { client, place: place.clone(), units })
    };
    args.connect.iter().map(line).collect()
}

impl JoinedLine {
    /// Has its units armed, driven and read together from now on.
    ///
    /// # Errors
    /// The device thread takes no request, which is said on standard error.
    pub fn join(&self) -> Result<(), Exit> {
        let [first, others @ ..] = self.units.as_slice() else { return Ok(()) };
        if others.is_empty() {
            return Ok(());
        }
        ask(self.client.device(), Request::Select(first.address))?;
        ask(self.client.device(), Request::Join(others.iter().map(|unit| unit.address).collect()))
    }
}
