//! The assistant that gives boards their addresses, one after the other, as `brushwork address` does: each is plugged in, found, listened to,
//! written, read back, saved, and met again at its new address.
//!
//! It asks for what is to be done by [`Wish`]es; the window carries them out.

use std::time::Duration;

use brushwork_core::addresses::{AddressList, in_words, name, parse_made};
use brushwork_core::addressing::{
    LOOK, Meant, address_of, answers_at, held_of, in_order, is_factory, is_sound, meant,
};
use brushwork_core::messages::AddressMessage;
use brushwork_core::settings::{Act, Done};
use brushwork_link::device::JobId;
use brushwork_link::settings::{Known, SaveVerdict};
use brushwork_link::{
    Addresses, FamilyRef, Identity, Message, ReadReport, SettingsImage, SettingsTable, WriteOptions,
};
use brushwork_values::Sentences;

use super::errand::{Asked, Came};
use super::{Connection, ConnectionId, Gravity, Phase};
use crate::messages::AddressingMessage;

/// How many boards are proposed: those of a rover.
const BOARDS: u8 = 5;

/// What a person asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AddressingAction {
    /// Begins with the addresses that are typed.
    Begin,
    /// The next board is plugged in.
    Find,
    /// Of several boards that wait the one at this address is meant.
    Choose(u8),
    /// The board that was found is to have the address.
    Give,
    End,
}

/// What the window is to do.
#[derive(Debug)]
pub enum Wish {
    Close,
    Open(Addresses),
    /// Listens to the unit at an address as closely as the line lets it.
    Listen(u8),
    /// Polls as before.
    Quiet,
    Act(Box<Asked>),
}

/// One of the addresses, and what has it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    pub number: u8,
    /// The title of the board, once one has it.
    pub has: Option<String>,
}

/// What a search is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Search {
    /// The board that waits for its address.
    Next,
    /// The same board at its new address.
    Again,
    /// Everybody who has got one.
    All,
}

#[derive(Debug)]
enum Stage {
    /// Somebody plugs in the next board.
    Waiting,
    Searching {
        search: Search,
        is_asked: bool,
    },
    /// Somebody says which of several is meant, that answer at these addresses.
    Choosing {
        addresses: Vec<u8>,
    },
    Listening {
        unit: Box<Identity>,
        until: Option<Duration>,
    },
    Reading {
        unit: Box<Identity>,
    },
    /// Somebody says yes.
    Asking {
        unit: Box<Identity>,
        ram: Box<ReadReport>,
        changes: SettingsImage,
    },
    Writing {
        unit: Box<Identity>,
        ram: Box<ReadReport>,
        changes: SettingsImage,
    },
    Saving {
        unit: Box<Identity>,
        ram: Box<ReadReport>,
    },
}

#[derive(Debug)]
struct Run {
    connection: ConnectionId,
    /// The place of the line, for sentences.
    line: String,
    stage: Stage,
    /// The work that was asked for.
    job: Option<JobId>,
}

/// The window, and the round that goes on.
#[derive(Debug, Default)]
pub struct Addressing {
    pub open: bool,
    /// The addresses to be given, as typed.
    pub typed: String,
    places: Vec<Place>,
    run: Option<Run>,
    /// What came of the last step.
    pub said: Option<(Gravity, Message)>,
}

/// What can be pressed now.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    /// The next board is to be plugged in for this address.
    PlugIn(u8),
    /// It is to be said which of the boards at these addresses is meant.
    Choose(Vec<u8>),
    /// This board is to have this address: what it is, and where, and whether it is there already.
    Give { unit: String, number: u8, stays: bool },
    /// Something goes on by itself.
    Works(Message),
}

impl Addressing {
    /// Opens the window. Where nothing is typed yet, the factory's address and the next few are proposed.
    pub fn show(&mut self, family: FamilyRef) {
        self.open = true;
        let first = family.factory_address();
        let last = first.saturating_add(BOARDS - 1);
        if self.typed.is_empty() && family.has_address(last) {
            let place = |number| family.address_text(number);
            self.typed = format!("{}-{}", place(first), place(last));
        }
    }

    pub fn places(&self) -> &[Place] {
        &self.places
    }

    pub fn is_running(&self) -> bool {
        self.run.is_some()
    }

    /// The connection that it works on.
    pub fn connection(&self) -> Option<ConnectionId> {
        Some(self.run.as_ref()?.connection)
    }

    /// The same while it is at work there by itself.
    pub fn works_on(&self) -> Option<ConnectionId> {
        let run = self.run.as_ref()?;
        let waits = matches!(run.stage, Stage::Waiting | Stage::Choosing { .. } | Stage::Asking { .. });
        (!waits).then_some(run.connection)
    }

    /// The work that was asked for and has not been seen to end.
    pub fn job(&self) -> Option<JobId> {
        self.run.as_ref()?.job
    }

    /// The first address that nobody has.
    pub fn next_number(&self) -> Option<u8> {
        self.places.iter().find(|place| place.has.is_none()).map(|place| place.number)
    }

    /// Where it stands.
    pub fn step(&self) -> Option<Step> {
        let run = self.run.as_ref()?;
        let number = self.next_number();
        Some(match &run.stage {
            Stage::Waiting => Step::PlugIn(number?),
            Stage::Choosing { addresses } => Step::Choose(addresses.clone()),
            Stage::Asking { unit, .. } => {
                let at = AddressingMessage::UnitAt { unit: unit.title().to_owned(), place: unit.place() };
                let number = number?;
                Step::Give { unit: Message::from(at).to_string(), number, stays: unit.address == number }
            }
            Stage::Searching { search: Search::Next, .. } => Step::Works(AddressingMessage::Searches.into()),
            Stage::Searching { search: Search::Again, .. } => Step::Works(AddressingMessage::Meets.into()),
            Stage::Searching { search: Search::All, .. } => Step::Works(AddressingMessage::ShowsAll.into()),
            Stage::Listening { .. } => Step::Works(AddressingMessage::Listens.into()),
            Stage::Reading { .. } => Step::Works(AddressingMessage::Reads.into()),
            Stage::Writing { .. } => Step::Works(AddressingMessage::Writes.into()),
            Stage::Saving { .. } => Step::Works(AddressingMessage::Saves.into()),
        })
    }

    /// Begins a round on a line, with the addresses that are typed.
    ///
    /// # Errors
    /// What is typed is no list of addresses that one line can have.
    pub fn begin(&mut self, connection: &Connection) -> Result<(), Message> {
        let Some(line) = connection.target.clone() else { return Err(AddressingMessage::NoLine.into()) };
        let list = parse_made(&self.typed).map_err(|why| AddressingMessage::NoList { why })?;
        let is_double = |list: &AddressList| {
            let numbers = list.numbers();
            (1..numbers.len()).any(|at| numbers[..at].contains(&numbers[at]))
        };
        if is_double(&list) {
            return Err(AddressingMessage::NamedTwice.into());
        }
        if !list.is_of_one_family() {
            return Err(AddressingMessage::OfTwoFamilies.into());
        }
        self.places =
            in_order(list.numbers()).into_iter().map(|number| Place { number, has: None }).collect();
        self.said = None;
        self.run = Some(Run { connection: connection.id(), line, stage: Stage::Waiting, job: None });
        // Who is there already and has one of them is not asked to be plugged in again.
        self.note_found(&connection.link.units);
        Ok(())
    }

    /// The next board is plugged in: the line is searched.
    pub fn find(&mut self) {
        let waits = |run: &&mut Run| matches!(run.stage, Stage::Waiting | Stage::Choosing { .. });
        if let Some(run) = self.run.as_mut().filter(waits) {
            self.said = None;
            run.stage = Stage::Searching { search: Search::Next, is_asked: false };
        }
    }

    /// Of several boards that wait the one at an address is meant.
    pub fn choose(&mut self, address: u8, connection: &Connection) {
        let is_asked = self.run.as_ref().is_some_and(|run| matches!(run.stage, Stage::Choosing { .. }));
        if let (true, Some(number)) = (is_asked, self.next_number()) {
            self.said = None;
            self.take_meant(meant(&connection.link.units, number, Some(address), &self.given()), number);
        }
    }

    /// The board that was found is to have the address.
    pub fn give(&mut self) {
        let Some(run) = &mut self.run else { return };
        if !matches!(run.stage, Stage::Asking { .. }) {
            return;
        }
        if let Stage::Asking { unit, ram, changes } = std::mem::replace(&mut run.stage, Stage::Waiting) {
            run.stage = Stage::Writing { unit, ram, changes };
        }
    }

    /// Ends the round. What was given stays given.
    pub fn end(&mut self) {
        self.run = None;
    }

    /// Boards that answer at an address of the list have it, unless that is the factory's, at which a new one answers too.
    fn note_found(&mut self, units: &[Identity]) {
        for place in self.places.iter_mut().filter(|place| place.has.is_none()) {
            let has_it = |unit: &&Identity| unit.address == place.number && unit.also_answers.is_empty();
            if let Some(unit) = units.iter().find(has_it).filter(|_| !is_factory(place.number)) {
                place.has = Some(unit.title().to_owned());
            }
        }
    }

    fn given(&self) -> Vec<u8> {
        self.places.iter().filter(|place| place.has.is_some()).map(|place| place.number).collect()
    }

    /// Waits for somebody to look after what came in the way.
    fn fail(&mut self, why: impl Into<Message>) {
        self.said = Some((Gravity::Error, why.into()));
        if let Some(run) = &mut self.run {
            (run.stage, run.job) = (Stage::Waiting, None);
        }
    }

    /// What is to be done now; asked in every frame.
    pub fn next(&mut self, connection: &Connection, now: Option<Duration>) -> Vec<Wish> {
        let Some(run) = &mut self.run else { return Vec::new() };
        if run.job.is_some() {
            return Vec::new();
        }
        match &mut run.stage {
            Stage::Waiting | Stage::Choosing { .. } | Stage::Asking { .. } => Vec::new(),
            Stage::Searching { search, is_asked } => {
                let search = *search;
                match (&connection.phase, *is_asked) {
                    (Phase::Open { .. } | Phase::Opening { .. }, false) => vec![Wish::Close],
                    (Phase::Closed, false) => {
                        *is_asked = true;
                        let only = self.next_number().filter(|_| search == Search::Again);
                        vec![Wish::Open(only.map_or(Addresses::Scan, Addresses::Only))]
                    }
                    (Phase::Closing { .. }, _) | (Phase::Opening { .. }, true) => Vec::new(),
                    (Phase::Open { .. }, true) if connection.link.selected.is_none() => Vec::new(),
                    (Phase::Open { .. }, true) => {
                        self.found(search, &connection.link.units);
                        Vec::new()
                    }
                    (Phase::Closed, true) => {
                        self.not_found(search);
                        Vec::new()
                    }
                }
            }
            Stage::Listening { unit, until: until @ None } => {
                *until = now.map(|now| now + LOOK);
                vec![Wish::Listen(unit.address)]
            }
            Stage::Listening { unit, until: Some(until) } => {
                if now.is_none_or(|now| now < *until) {
                    return Vec::new();
                }
                let unit = unit.clone();
                if !is_sound(&connection.link.statistics) {
                    self.fail(AddressMessage::Garbled { unit: unit.place() });
                    return vec![Wish::Quiet];
                }
                let Some(subject) = unit.subject() else {
                    self.fail(AddressingMessage::UnknownModel { unit: unit.place() });
                    return vec![Wish::Quiet];
                };
                let read = self.act(Act::Read, &unit, SettingsTable::new(subject), connection);
                self.turn_to(Stage::Reading { unit });
                vec![Wish::Quiet, read]
            }
            Stage::Reading { unit } => {
                let unit = unit.clone();
                let Some(subject) = unit.subject() else { return Vec::new() };
                vec![self.act(Act::Read, &unit, SettingsTable::new(subject), connection)]
            }
            Stage::Writing { unit, ram, changes } => {
                let (unit, table) = (unit.clone(), ram.table.clone());
                let act = Act::Write { wanted: changes.clone(), known: Known::default() };
                vec![self.act(act, &unit, table, connection)]
            }
            Stage::Saving { unit, ram } => {
                let (unit, table) = (unit.clone(), ram.table.clone());
                // It may answer at its new address by now.
                let at = connection.link.selected.unwrap_or(unit.address);
                let options = options_of(&unit, connection);
                let asked = Asked { address: at, act: Act::Save, table, options, raw: None };
                vec![Wish::Act(Box::new(asked))]
            }
        }
    }

    fn act(&self, act: Act, unit: &Identity, table: SettingsTable, connection: &Connection) -> Wish {
        Wish::Act(Box::new(Asked {
            address: unit.address,
            act,
            table,
            options: options_of(unit, connection),
            raw: None,
        }))
    }

    fn turn_to(&mut self, stage: Stage) {
        if let Some(run) = &mut self.run {
            run.stage = stage;
        }
    }

    /// What was asked of the device thread, if it took it.
    pub fn begun(&mut self, job: Option<JobId>) {
        if let Some(run) = &mut self.run {
            run.job = job;
        }
    }

    fn found(&mut self, search: Search, units: &[Identity]) {
        if search == Search::All {
            return self.end();
        }
        let Some(number) = self.next_number() else { return };
        if search == Search::Again {
            return match units.iter().find(|unit| answers_at(unit, number)) {
                Some(unit) => self.met(number, unit),
                None => self.not_found(search),
            };
        }
        self.note_found(units);
        match self.next_number() {
            Some(number) => self.take_meant(meant(units, number, None, &self.given()), number),
            None => {
                self.turn_to(Stage::Waiting);
                self.all_have_theirs();
            }
        }
    }

    fn take_meant(&mut self, meant: Meant, number: u8) {
        let Some(line) = self.run.as_ref().map(|run| run.line.clone()) else { return };
        match meant {
            Meant::This(unit) => self.turn_to(Stage::Listening { unit, until: None }),
            Meant::Nobody => self.fail(AddressMessage::NobodyWaits { place: line }),
            Meant::Several(addresses) => {
                let units = in_words(&addresses);
                self.fail(AddressingMessage::SeveralWait { units, place: line });
                self.turn_to(Stage::Choosing { addresses });
            }
            Meant::Taken => self.fail(AddressMessage::Taken { address: name(number), place: line }),
        }
    }

    fn not_found(&mut self, search: Search) {
        let line = self.run.as_ref().map(|run| run.line.clone()).unwrap_or_default();
        let address = self.next_number().map(name).unwrap_or_default();
        match search {
            Search::Next => self.fail(AddressMessage::NobodyWaits { place: line }),
            Search::Again => self.fail(AddressingMessage::NotMet { address }),
            Search::All => self.end(),
        }
    }

    /// The board answers at its new address.
    fn met(&mut self, number: u8, unit: &Identity) {
        let title = unit.title().to_owned();
        if let Some(place) = self.places.iter_mut().find(|place| place.number == number) {
            place.has = Some(title.clone());
        }
        self.said =
            Some((Gravity::Note, AddressingMessage::Has { unit: title, address: name(number) }.into()));
        self.turn_to(Stage::Waiting);
        self.all_have_theirs();
    }

    fn all_have_theirs(&mut self) {
        if self.next_number().is_none() {
            let boards = self.places.len();
            let all =
                if boards == 1 { AddressingMessage::OneHas } else { AddressingMessage::AllHave { boards } };
            self.said = Some((Gravity::Note, all.into()));
            self.turn_to(Stage::Searching { search: Search::All, is_asked: false });
        }
    }

    /// Takes in what came of the work that was asked for.
    pub fn came(&mut self, came: Came, connection: &Connection) {
        let Some(run) = &mut self.run else { return };
        run.job = None;
        let stage = std::mem::replace(&mut run.stage, Stage::Waiting);
        let done = match came {
            Ok(done) => done,
            Err(unfinished) => return self.fail(unfinished.sentence),
        };
        match (stage, done) {
            (Stage::Reading { unit }, Done::Read(ram)) => self.read(unit, ram, connection),
            (Stage::Writing { unit, ram, .. }, Done::Written(report, _)) => {
                if report.is_complete() {
                    self.turn_to(Stage::Saving { unit, ram });
                } else {
                    let sentences = report.sentences(&ram.table);
                    self.fail(AddressingMessage::NotTaken { why: Sentences(sentences) });
                }
            }
            (Stage::Writing { .. }, Done::NotWritten(error)) => self.fail(Message::error(error)),
            (Stage::Saving { .. }, Done::Saved(report)) => match report.verdict {
                SaveVerdict::Verified | SaveVerdict::Stored | SaveVerdict::Acknowledged => {
                    self.turn_to(Stage::Searching { search: Search::Again, is_asked: false });
                }
                SaveVerdict::NotSaved | SaveVerdict::Unknown => self.fail(report.sentence()),
            },
            (
                _,
                Done::Read(_)
                | Done::Reloaded(_)
                | Done::Written(..)
                | Done::NotWritten(_)
                | Done::Saved(_)
                | Done::Restored(_),
            ) => {}
        }
    }

    fn read(&mut self, unit: Box<Identity>, ram: Box<ReadReport>, connection: &Connection) {
        let Some(number) = self.next_number() else { return };
        let options = options_of(&unit, connection);
        if let Some(held) = held_of(&ram, options, &self.given()) {
            return self.fail(AddressingMessage::HasOneAlready {
                unit: unit.title().to_owned(),
                address: name(held),
            });
        }
        match address_of(&ram, options, number) {
            Some(changes) => self.turn_to(Stage::Asking { unit, ram, changes }),
            None => self.fail(AddressMessage::CannotHave { unit: unit.place(), address: name(number) }),
        }
    }
}

fn options_of(unit: &Identity, connection: &Connection) -> WriteOptions {
    WriteOptions { own_stream: connection.link.stream, simulated: unit.simulated, as_read: false }
}
