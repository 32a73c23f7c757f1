//! What the assistants for several boards ask of the links: addresses one board at a time, one profile for all, a number written raw.

use brushwork_core::keep::{RawKeeper, UnitId};
use brushwork_core::settings::Act;
use brushwork_link::device::JobId;
use brushwork_link::messages::RemedyMessage;
use brushwork_link::{ConnectTarget, DeviceHandle, Failure, Job, Message, PollRate, Request};

use super::App;
use crate::focus::{self, Region};
use crate::messages::{AddressingMessage, RawPageMessage, ToAllMessage, WindowCauseMessage};
use crate::model::addressing::{self, AddressingAction};
use crate::model::errand::Asked;
use crate::model::raw::RawAction;
use crate::model::to_all::{self, ToAllAction};
use crate::model::{Arming, Connection, ConnectionId, Gravity, Owner, Sheet};

impl App {
    /// Turns to a unit of a link. What is read meanwhile would be taken for the other one's.
    pub(super) fn turn_to_unit(&mut self, id: ConnectionId, address: u8) -> bool {
        let is_taken = self.request_of(id, Request::Select(address));
        if let Some(connection) = self.model.connection_mut(id).filter(|_| is_taken) {
            connection.turning_to = Some(address);
        }
        is_taken
    }

    /// Has an act done on a unit of a link, with its backup and its journal. Nothing where the link is at work for somebody else: it is asked again.
    fn begin_errand(&mut self, id: ConnectionId, asked: Asked) -> Option<JobId> {
        let ports = self.model.devices.ports.clone();
        let connection = self.model.connection_mut(id)?;
        let is_free = connection.is_connected() && !is_taken(connection) && !connection.errand.is_running();
        let unit = connection.link.units.iter().find(|unit| unit.address == asked.address)?.clone();
        let is_selected = connection.link.selected == Some(asked.address) && connection.turning_to.is_none();
        if !is_free {
            return None;
        }
        if !is_selected && !self.turn_to_unit(id, asked.address) {
            return None;
        }
        let Asked { act, table, options, raw, .. } = asked;
        let keeping = &self.parts.keeping;
        let kept_of = UnitId::new(&unit, &ports);
        let mut keeper = keeping.keeper(kept_of.clone(), &unit.version_text);
        if let Some(raw) = raw {
            keeper = RawKeeper::boxed(keeper, keeping.store().clone(), kept_of, raw);
        }
        let (name, limit, at) = (act.name(), act.limit(), unit.unit_address());
        let (tried, port) = (name.clone(), unit.port.clone());
        let mut work = act.work(table, options, keeper);
        let job = Job::new(name, limit, move |context| {
            if context.address() != at {
                let cause = WindowCauseMessage::OtherUnit;
                return Err(Failure::new(tried.clone(), port.clone(), cause, RemedyMessage::TryAgain));
            }
            work(context)
        });
        let job = self.model.connection_mut(id)?.errand.begin(job)?;
        let job_id = job.id();
        if self.start_for(id, Owner::Errand, job) {
            return Some(job_id);
        }
        self.model.connection_mut(id)?.errand.not_begun();
        None
    }

    /// Lets all assistants go on by a step.
    pub(super) fn go_on_assisting(&mut self) {
        self.go_on_addressing();
        self.go_on_to_all();
        self.go_on_raw();
        let addressed = self.model.addressing.works_on();
        let mut given = self.model.to_all.works_on();
        given.extend(addressed);
        for connection in self.model.connections_mut() {
            connection.is_assisted = given.contains(&connection.id());
        }
    }

    pub(super) fn open_addressing(&mut self) {
        let family = self.model.front.family().family();
        self.model.addressing.show(family);
        self.want_dialog();
    }

    pub(super) fn address(&mut self, action: AddressingAction) {
        let Self { model, .. } = self;
        let is_busy = is_taken(&model.front);
        match action {
            AddressingAction::Begin | AddressingAction::Find | AddressingAction::Choose(_) if is_busy => {
                self.model.messages.fail(AddressingMessage::Busy);
            }
            AddressingAction::Begin => {
                if let Err(why) = model.addressing.begin(&model.front) {
                    model.addressing.said = Some((Gravity::Error, why));
                }
            }
            AddressingAction::Find => model.addressing.find(),
            AddressingAction::Choose(address) => {
                let of = model.addressing.connection();
                let mut addressing = std::mem::take(&mut model.addressing);
                if let Some(connection) = of.and_then(|id| model.connection(id)) {
                    addressing.choose(address, connection);
                }
                model.addressing = addressing;
            }
            AddressingAction::Give => model.addressing.give(),
            AddressingAction::End => {
                let of = model.addressing.connection();
                model.addressing.end();
                if let Some(connection) = of.and_then(|id| self.model.connection(id)) {
                    connection.errand.cancel();
                    let (id, poll) = (connection.id(), connection.poll);
                    // It may have been listening as closely as the line lets it.
                    if self.links.device(id).is_some() {
                        self.request_of(id, Request::Poll(poll));
                    }
                }
            }
        }
    }

    fn go_on_addressing(&mut self) {
        let Some(id) = self.model.addressing.connection() else { return };
        let now = self.links.device(id).map(DeviceHandle::now);
        let mut addressing = std::mem::take(&mut self.model.addressing);
        let job = addressing.job();
        let came = job.and_then(|job| self.model.connection_mut(id)?.errand.came(job));
        let wishes = match self.model.connection(id) {
            Some(connection) => {
                if let Some(came) = came {
                    addressing.came(came, connection);
                }
                addressing.next(connection, now)
            }
            // Whoever took the connection off the list has ended this too.
            None => {
                addressing.end();
                Vec::new()
            }
        };
        self.model.addressing = addressing;
        for wish in wishes {
            match wish {
                addressing::Wish::Close => self.disconnect(id),
                addressing::Wish::Open(addresses) => {
                    let target = self.model.connection(id).and_then(|connection| connection.target.clone());
                    if let Some(Ok(target)) = target.map(|target| target.parse::<ConnectTarget>()) {
                        self.bring_to_front(id);
                        self.open_front(target, addresses);
                    }
                }
                addressing::Wish::Listen(address) => {
                    if self.turn_to_unit(id, address) {
                        self.request_of(id, Request::Poll(PollRate::Fastest));
                    }
                }
                addressing::Wish::Quiet => {
                    let poll = self.model.connection(id).map_or(PollRate::default(), |found| found.poll);
                    self.request_of(id, Request::Poll(poll));
                }
                addressing::Wish::Act(asked) => {
                    let job = self.begin_errand(id, *asked);
                    self.model.addressing.begun(job);
                }
            }
        }
    }

    /// Opens the window with the profile that is open in General Settings.
    pub(super) fn open_to_all(&mut self) {
        let opened = self.model.front.general.opened_profile();
        let Some(opened) = opened else {
            self.model.messages.note(ToAllMessage::OpenOneFirst);
            return self.open_sheet(Sheet::OpenProfile);
        };
        self.model.to_all.show(Some(opened));
        self.want_dialog();
    }

    pub(super) fn act_for_all(&mut self, action: ToAllAction) {
        let mut to_all = std::mem::take(&mut self.model.to_all);
        let connections: Vec<&Connection> = self.model.connections().collect();
        let is_busy = |target: &&to_all::Target| {
            let of = connections.iter().find(|connection| connection.id() == target.connection);
            target.chosen && of.is_some_and(|of| is_taken(of))
        };
        let busy = to_all.units.iter().find(is_busy).map(to_all::Target::name);
        let begun = match busy.filter(|_| action != ToAllAction::Cancel) {
            Some(unit) => Err(ToAllMessage::Busy { unit }.into()),
            None => to_all.begin(action, &connections),
        };
        if action == ToAllAction::Cancel
            && let Some((id, _)) = to_all.job()
            && let Some(connection) = self.model.connection(id)
        {
            connection.errand.cancel();
        }
        if let Err(why) = begun {
            to_all.ended = Some((Gravity::Error, why));
        }
        self.model.to_all = to_all;
    }

    fn go_on_to_all(&mut self) {
        self.model.look_for_all();
        let mut to_all = std::mem::take(&mut self.model.to_all);
        if let Some((id, job)) = to_all.job()
            && let Some(came) = self.model.connection_mut(id).and_then(|found| found.errand.came(job))
        {
            to_all.came(came, self.model.connection(id));
        }
        let wish = to_all.next(&self.model.connections().collect::<Vec<_>>());
        let begins = to_all.open && !to_all.is_running() && to_all.ended.is_none() && to_all.wants_reading();
        self.model.to_all = to_all;
        match wish {
            Some(to_all::Wish::Act(connection, asked)) => {
                let job = self.begin_errand(connection, *asked);
                self.model.to_all.begun(connection, job);
            }
            Some(to_all::Wish::TurnBack(units)) => {
                for (id, address) in units {
                    let selected = self.model.connection(id).and_then(|found| found.link.selected);
                    if selected.is_some_and(|selected| selected != address) {
                        self.turn_to_unit(id, address);
                    }
                }
            }
            None if begins => self.act_for_all(ToAllAction::Read),
            None => {}
        }
    }

    pub(super) fn open_raw(&mut self) {
        self.model.front.raw.open = true;
        self.want_dialog();
    }

    /// Writes one number at its owner's word.
    pub(super) fn raw(&mut self, action: RawAction) {
        let front = &self.model.front;
        let address = front.link.selected;
        let begun = front.raw_wanted(action).map(|(raw, options)| {
            let wanted = Act::Write { wanted: raw.changes, known: Default::default() };
            let raw_write = Some(raw.write);
            address.map(|address| Asked { address, act: wanted, table: raw.table, options, raw: raw_write })
        });
        match begun {
            Ok(Some(asked)) => {
                let id = self.model.front.id();
                let job = self.begin_errand(id, asked);
                self.model.front.raw.begun(job);
                if job.is_none() {
                    self.model.front.raw.ended = Some((Gravity::Error, RawPageMessage::Busy.into()));
                }
            }
            Ok(None) => {}
            Err(why) => self.model.front.raw.ended = Some((Gravity::Error, why)),
        }
    }

    fn go_on_raw(&mut self) {
        for id in self.links.ids() {
            let Some(connection) = self.model.connection_mut(id) else { continue };
            if let Some(came) = connection.raw.job().and_then(|job| connection.errand.came(job)) {
                let found = connection.raw.came(came, connection.settings.unit());
                self.end_raw(id, found);
                continue;
            }
            let identity = connection.link.identity();
            if connection.raw.open && identity.is_some_and(|identity| connection.raw.is_of_another(identity))
            {
                self.look_at_raw_writes(id);
            }
            let Some(connection) = self.model.connection_mut(id) else { continue };
            if connection.errand.is_running() || connection.raw.is_running() {
                continue;
            }
            for sentence in connection.settings.take_cut_off() {
                self.say(id, Gravity::Warning, sentence);
            }
        }
    }

    /// A raw write has ended, with what was read back.
    fn end_raw(&mut self, id: ConnectionId, found: Option<(String, i64)>) {
        let store = self.parts.keeping.store();
        let identity = self.model.connection(id).and_then(|connection| connection.link.identity());
        let unit = identity.map(|identity| UnitId::new(identity, &self.model.devices.ports));
        if let (Some((key, raw)), Some(unit)) = (found, &unit)
            && let Err(fault) = store.end_raw_writes(unit, |write| (write.key == key).then_some(raw))
        {
            self.model.messages.fail(Message::error(fault));
        }
        self.look_at_raw_writes(id);
    }

    /// Looks up what was written raw to the unit that is shown.
    fn look_at_raw_writes(&mut self, id: ConnectionId) {
        let store = self.parts.keeping.store().clone();
        let identity = self.model.connection(id).and_then(|connection| connection.link.identity()).cloned();
        let Some(identity) = identity else { return };
        let unit = UnitId::new(&identity, &self.model.devices.ports);
        if let Some(connection) = self.model.connection_mut(id) {
            connection.raw.look_at(&store, identity, &unit);
        }
    }

    /// The keyboard goes into the window that was opened.
    fn want_dialog(&self) {
        focus::want(&self.ctx, Region::Dialog);
    }
}

/// Whether a link is armed, or at work with something that moves motors or puts something back.
fn is_taken(connection: &Connection) -> bool {
    connection.link.arming != Arming::Disarmed || connection.is_guided()
}
