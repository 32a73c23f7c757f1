//! Controllers that act together: of each line one link, with the units that are meant of it.

use brushwork_core::addresses::{AddressList, in_words, name};
use brushwork_link::{Identity, PollRate, Request};

use super::client::ask;
use super::{Client, ConnectArgs, Exit, Interrupt};

/// A line, and those of its controllers that act together. The link's selected one comes first.
pub struct JoinedLine {
    /// The link.
    pub client: Client,
    /// As it was typed.
    pub place: String,
    /// Who they are.
    pub units: Vec<Identity>,
    /// The addresses that were named and at which nobody answers.
    pub missing: Vec<u8>,
}

/// Opens all lines that are named.
///
/// # Errors
/// Says on standard error what went wrong and gives the exit code.
pub fn open(args: &ConnectArgs, poll: PollRate, interrupt: &Interrupt) -> Result<Vec<JoinedLine>, Exit> {
    let line = |place: &String| {
        let own = ConnectArgs { connect: vec![place.clone()], ..args.clone() };
        let (client, units) = match &args.address {
            Some(AddressList::These(_) | AddressList::All) => Client::connect_all(&own, poll, interrupt)?,
            None | Some(AddressList::One(_)) => {
                let client = Client::connect(&own, poll, interrupt)?;
                let units = vec![client.identity.clone()];
                (client, units)
            }
        };
        let named = args.address.as_ref().map_or(&[][..], AddressList::numbers);
        let is_there = |number: &u8| {
            units.iter().any(|unit| unit.address == *number || unit.also_answers.contains(number))
        };
        let missing = named.iter().copied().filter(|number| !is_there(number)).collect();
        Ok(JoinedLine { client, place: place.clone(), units, missing })
    };
    args.connect.iter().map(line).collect()
}

impl JoinedLine {
    /// What a unit of it is called where there are several.
    pub fn name_of(&self, unit: &Identity) -> String {
        format!("{} on {}", name(unit.address), self.place)
    }

    /// The addresses at which nobody answers, as a sentence has them; `None` where all do.
    pub fn silent(&self) -> Option<String> {
        (!self.missing.is_empty()).then(|| in_words(&self.missing))
    }

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
