//! One profile for every unit of the open links: all are read and the differences of each are shown, then one question, and nothing is written where
//! one of them cannot take it.

use std::collections::BTreeMap;

use brushwork_core::settings::for_all::Share;
use brushwork_core::settings::{Act, Done};
use brushwork_link::device::JobId;
use brushwork_link::settings::{Known, OpenedProfile, SaveVerdict};
use brushwork_link::{Identity, Message, SettingsTable, WriteOptions};
use brushwork_values::Sentences;

use super::errand::{Asked, Came};
use super::{Connection, ConnectionId, Gravity, Model};
use crate::messages::ToAllMessage;

/// What a person asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ToAllAction {
    /// Reads all that are ticked, and compares.
    Read,
    /// Writes to each what was shown.
    Write,
    Cancel,
}

/// The window, and what goes on.
#[derive(Debug, Default)]
pub struct ToAll {
    pub open: bool,
    profile: Option<(String, Box<OpenedProfile>)>,
    pub units: Vec<Target>,
    /// Whether each saves all its settings to EEPROM afterwards.
    pub saves: bool,
    round: Option<Round>,
    job: Option<(ConnectionId, JobId)>,
    /// The units that were looked at before, which are turned back to at the end.
    looked_at: BTreeMap<ConnectionId, u8>,
    /// How the last round ended.
    pub ended: Option<(Gravity, Message)>,
}

/// Which round goes on, and which unit is at its turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Round {
    kind: Kind,
    at: usize,
    /// Its write is done, its save is not.
    saving: bool,
    cancelled: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Read,
    Write,
}

/// A unit that may get the profile.
#[derive(Debug)]
pub struct Target {
    pub connection: ConnectionId,
    pub identity: Identity,
    pub chosen: bool,
    pub state: State,
}

/// How far a unit is.
#[derive(Debug, Default)]
pub enum State {
    #[default]
    Waiting,
    /// What it gets.
    Shown(Box<Share>),
    /// Why it cannot take it.
    Refused(Vec<Message>),
    /// What became of it.
    Done(Gravity, Message),
}

/// What the window is to do.
#[derive(Debug)]
pub enum Wish {
    Act(ConnectionId, Box<Asked>),
    /// Turns back to the units that were looked at.
    TurnBack(BTreeMap<ConnectionId, u8>),
}

/// "RoboClaw 2x7A at 0x81 on /dev/ttyUSB0".
pub fn unit_name(identity: &Identity) -> String {
    let (unit, place, port) = (identity.title().to_owned(), identity.place(), identity.port.clone());
    Message::from(ToAllMessage::Unit { unit, place, port }).to_string()
}

impl Target {
    /// "RoboClaw 2x7A at 0x81 on /dev/ttyUSB0".
    pub fn name(&self) -> String {
        unit_name(&self.identity)
    }

    fn options(&self, connection: &Connection) -> WriteOptions {
        WriteOptions {
            own_stream: connection.link.stream,
            simulated: self.identity.simulated,
            as_read: false,
        }
    }
}

impl ToAll {
    /// Opens the window with a profile, and takes in who is connected.
    pub fn show(&mut self, profile: Option<(String, OpenedProfile)>) {
        self.open = true;
        if self.round.is_none() {
            self.profile = profile.map(|(name, opened)| (name, Box::new(opened)));
            self.ended = None;
            self.units.clear();
        }
    }

    pub fn profile(&self) -> Option<&str> {
        self.profile.as_ref().map(|(name, _)| name.as_str())
    }

    pub fn is_running(&self) -> bool {
        self.round.is_some()
    }

    /// Which unit is at its turn.
    pub fn current(&self) -> Option<usize> {
        self.round.map(|round| round.at)
    }

    /// The links that it is at work on.
    pub fn works_on(&self) -> Vec<ConnectionId> {
        let units = self.units.iter().filter(|target| target.chosen && self.round.is_some());
        units.map(|target| target.connection).collect()
    }

    pub fn job(&self) -> Option<(ConnectionId, JobId)> {
        self.job
    }

    /// Takes in who is connected, unless a round goes on: those that are new, and those that are gone.
    pub fn look(&mut self, connections: &[&Connection]) {
        let Some((_, opened)) = self.profile.as_ref().filter(|_| self.round.is_none()) else { return };
        let is_there = |target: &Target| {
            let of = connections.iter().find(|connection| connection.id() == target.connection);
            of.is_some_and(|of| of.link.units.contains(&target.identity))
        };
        self.units.retain(is_there);
        for connection in connections.iter().filter(|connection| connection.is_connected()) {
            for unit in &connection.link.units {
                let id = connection.id();
                let is_known =
                    |target: &Target| target.connection == id && target.identity.address == unit.address;
                let Some(subject) = unit.subject().filter(|_| !self.units.iter().any(is_known)) else {
                    continue;
                };
                let chosen = subject.family() == opened.profile.subject.family();
                let target = Target { connection: id, identity: unit.clone(), chosen, state: State::Waiting };
                self.units.push(target);
            }
        }
    }

    /// Whether any that is ticked was not compared yet.
    pub fn wants_reading(&self) -> bool {
        self.chosen().any(|target| matches!(target.state, State::Waiting))
    }

    fn chosen(&self) -> impl Iterator<Item = &Target> {
        self.units.iter().filter(|target| target.chosen)
    }

    /// How many would be written, or why nothing can be.
    ///
    /// # Errors
    /// A sentence.
    pub fn ready(&self) -> Result<usize, ToAllMessage> {
        if self.profile.is_none() {
            return Err(ToAllMessage::NoProfile);
        }
        if self.round.is_some() {
            return Err(ToAllMessage::GoesOn);
        }
        if self.chosen().next().is_none() {
            return Err(ToAllMessage::NobodyChosen);
        }
        if self.chosen().any(|target| matches!(target.state, State::Refused(_))) {
            return Err(ToAllMessage::OneCannot);
        }
        if self.chosen().any(|target| !matches!(target.state, State::Shown(_))) {
            return Err(ToAllMessage::NotCompared);
        }
        let differs = |target: &&Target| matches!(&target.state, State::Shown(share) if self.saves || !share.changes.is_empty());
        match self.chosen().filter(differs).count() {
            0 => Err(ToAllMessage::NothingDiffers),
            count => Ok(count),
        }
    }

    /// Begins a round. Nothing is begun where one goes on, or where not all that are ticked can take theirs.
    ///
    /// # Errors
    /// Why not.
    pub fn begin(&mut self, action: ToAllAction, connections: &[&Connection]) -> Result<(), Message> {
        let kind = match action {
            ToAllAction::Cancel => {
                self.cancel();
                return Ok(());
            }
            ToAllAction::Read if self.round.is_some() => return Err(ToAllMessage::GoesOn.into()),
            ToAllAction::Read => {
                let chosen = self.units.iter_mut().filter(|target| target.chosen);
                chosen.for_each(|target| target.state = State::Waiting);
                Kind::Read
            }
            ToAllAction::Write => {
                self.ready()?;
                Kind::Write
            }
        };
        self.ended = None;
        let selected = |connection: &&Connection| Some((connection.id(), connection.link.selected?));
        self.looked_at = connections.iter().filter_map(selected).collect();
        self.round = Some(Round { kind, at: 0, saving: false, cancelled: false });
        Ok(())
    }

    /// Begins with no further unit.
    pub fn cancel(&mut self) {
        if let Some(round) = &mut self.round {
            round.cancelled = true;
        }
    }

    /// What is to be done now; asked in every frame.
    pub fn next(&mut self, connections: &[&Connection]) -> Option<Wish> {
        let round = self.round.as_mut().filter(|_| self.job.is_none())?;
        while let Some(target) = self.units.get_mut(round.at).filter(|_| !round.cancelled) {
            let of = connections.iter().find(|connection| connection.id() == target.connection);
            if !target.chosen {
                (round.at, round.saving) = (round.at + 1, false);
                continue;
            }
            let Some(connection) = of.filter(|connection| connection.is_connected()) else {
                target.state = State::Done(Gravity::Error, ToAllMessage::Gone.into());
                (round.at, round.saving) = (round.at + 1, false);
                continue;
            };
            let options = target.options(connection);
            let (id, address) = (target.connection, target.identity.address);
            let act = match (round.kind, &target.state) {
                (Kind::Read, State::Waiting) => {
                    let subject = target.identity.subject()?;
                    Some((Act::Read, SettingsTable::new(subject), options))
                }
                (Kind::Write, State::Shown(share)) if round.saving => {
                    Some((Act::Save, share.table.clone(), options))
                }
                (Kind::Write, State::Shown(share)) if !share.changes.is_empty() => {
                    let act = Act::Write { wanted: share.changes.clone(), known: Known::default() };
                    Some((act, share.table.clone(), share.options))
                }
                (Kind::Write, State::Shown(share)) if self.saves => {
                    round.saving = true;
                    Some((Act::Save, share.table.clone(), options))
                }
                (Kind::Write, State::Shown(_)) => {
                    target.state = State::Done(Gravity::Note, ToAllMessage::HeldAlready.into());
                    None
                }
                (
                    Kind::Read | Kind::Write,
                    State::Waiting | State::Shown(_) | State::Refused(_) | State::Done(..),
                ) => None,
            };
            match act {
                Some((act, table, options)) => {
                    let asked = Asked { address, act, table, options, raw: None };
                    return Some(Wish::Act(id, Box::new(asked)));
                }
                None => (round.at, round.saving) = (round.at + 1, false),
            }
        }
        Some(self.end())
    }

    /// What was asked of the device thread was taken.
    pub fn begun(&mut self, connection: ConnectionId, job: Option<JobId>) {
        self.job = job.map(|job| (connection, job));
    }

    fn end(&mut self) -> Wish {
        if let Some(round) = self.round.take() {
            self.ended = Some(self.outcome(round));
        }
        Wish::TurnBack(std::mem::take(&mut self.looked_at))
    }

    fn outcome(&self, round: Round) -> (Gravity, Message) {
        let of = self.chosen().count();
        let is_done = |target: &&Target| matches!(target.state, State::Done(Gravity::Note, _));
        match round.kind {
            Kind::Read if round.cancelled => (Gravity::Note, ToAllMessage::NotComparedToEnd.into()),
            Kind::Read => match self.chosen().any(|target| matches!(target.state, State::Refused(_))) {
                true => (Gravity::Warning, ToAllMessage::OneCannot.into()),
                false => (Gravity::Note, ToAllMessage::Compared.into()),
            },
            Kind::Write => match self.chosen().filter(is_done).count() {
                done if done == of && of == 1 => (Gravity::Note, ToAllMessage::OneHasIt.into()),
                done if done == of => (Gravity::Note, ToAllMessage::AllHaveIt { of }.into()),
                done => (Gravity::Error, ToAllMessage::SomeHaveIt { done, of }.into()),
            },
        }
    }

    /// Takes in what came of the work that was asked for.
    pub fn came(&mut self, came: Came, connection: Option<&Connection>) {
        self.job = None;
        let Some(round) = &mut self.round else { return };
        let Some(target) = self.units.get_mut(round.at) else { return };
        let next = match (came, std::mem::take(&mut target.state)) {
            (Err(unfinished), _) if round.kind == Kind::Read => State::Refused(vec![unfinished.sentence]),
            (Err(unfinished), _) => State::Done(Gravity::Error, unfinished.sentence),
            (Ok(Done::Read(ram)), _) => {
                let opened = self.profile.as_ref().map(|(_, opened)| opened);
                let share = opened
                    .zip(connection)
                    .map(|(opened, connection)| Share::new(opened, &ram, target.options(connection)));
                match share {
                    Some(Ok(share)) => State::Shown(Box::new(share)),
                    Some(Err(reasons)) => State::Refused(reasons),
                    None => State::Waiting,
                }
            }
            (Ok(Done::Written(report, _)), State::Shown(share)) => {
                let settings = brushwork_core::settings::counted(share.changes.len());
                match (report.is_complete(), self.saves) {
                    (true, true) => {
                        round.saving = true;
                        target.state = State::Shown(share);
                        return;
                    }
                    (true, false) => State::Done(Gravity::Note, ToAllMessage::Written { settings }.into()),
                    (false, _) => {
                        let why = Sentences(report.sentences(&share.table));
                        State::Done(Gravity::Error, ToAllMessage::NotTaken { why }.into())
                    }
                }
            }
            (Ok(Done::NotWritten(error)), _) => State::Done(Gravity::Error, Message::error(error)),
            (Ok(Done::Saved(report)), State::Shown(share)) => match report.verdict {
                SaveVerdict::Verified | SaveVerdict::Stored | SaveVerdict::Acknowledged => {
                    let settings = brushwork_core::settings::counted(share.changes.len());
                    State::Done(Gravity::Note, ToAllMessage::WrittenAndSaved { settings }.into())
                }
                SaveVerdict::NotSaved | SaveVerdict::Unknown => {
                    State::Done(Gravity::Error, report.sentence())
                }
            },
            (Ok(Done::Reloaded(_) | Done::Restored(_) | Done::Written(..) | Done::Saved(_)), state) => state,
        };
        target.state = next;
        (round.at, round.saving) = (round.at + 1, false);
    }
}

impl Model {
    /// What of the window for all units needs every link.
    pub fn look_for_all(&mut self) {
        if !self.to_all.open {
            return;
        }
        let mut to_all = std::mem::take(&mut self.to_all);
        to_all.look(&self.connections().collect::<Vec<_>>());
        self.to_all = to_all;
    }
}
