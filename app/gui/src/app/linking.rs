//! Links as the window opens, brings to the front and ends them.

use crate::messages::WindowStatusMessage;
use crate::messages::{WindowActMessage, WindowRemedyMessage};
use brushwork_canopen::{NodeId, nmt};
use brushwork_core::session::bus;
use brushwork_link::Message;
use brushwork_link::transport::TargetError;
use brushwork_link::work;
use brushwork_link::{Addresses, ConnectTarget, Failure, PollRate, Request};
use crossbeam_channel::{TryRecvError, bounded};
use egui::Context;

use super::{App, OPENING_INTERVAL, waker};
use crate::focus::{self, Region};
use crate::model::Afterwards;
use crate::model::{Choice, Connection, ConnectionId, Effect, Gravity, LinkView, Phase, Screen, place_of};
use crate::parts::OpenLink;
use crate::{family, links};

impl App {
    /// Connects to what is chosen in the device list.
    pub(super) fn connect(&mut self) {
        let chosen = match self.model.devices.choice {
            Choice::Connection(id) => {
                self.model.connection(id).and_then(|connection| connection.target.clone())
            }
            Choice::Simulated | Choice::Port(_) | Choice::Typed => None,
        };
        let target = chosen.as_ref().map_or_else(|| self.model.devices.target(), |target| target.parse());
        let typed = chosen.unwrap_or_else(|| self.model.devices.typed.trim().to_owned());
        self.connect_to(&typed, target);
    }

    /// Lets a port be chosen; it is the one in the list then.
    pub(super) fn choose_port(&mut self) {
        self.model.devices.is_choosing = true;
        self.parts.ports.choose();
    }

    /// Opens a link on a connection of its own, or brings the one that is open to the front.
    pub(super) fn connect_to(&mut self, typed: &str, target: Result<ConnectTarget, TargetError>) {
        let target = match target {
            Ok(target) => target,
            Err(error) => {
                let (error, remedy) = (Message::error(error), WindowRemedyMessage::TypeTarget);
                let failure = Failure::new(WindowActMessage::Connect, typed, error, remedy);
                return self.model.messages.fail(failure.message());
            }
        };
        let place = place_of(&target.to_string());
        match self.model.connection_at(&place).map(Connection::id) {
            Some(connection) => self.bring_to_front(connection),
            None => {
                self.disarm();
                self.model.add_connection();
                self.model.closed_too_many().into_iter().for_each(|connection| self.forget(connection));
            }
        }
        self.open_front(target, self.model.devices.addresses());
    }

    pub(super) fn open_front(&mut self, target: ConnectTarget, addresses: Addresses) {
        let text = target.to_string();
        let front = &mut self.model.front;
        front.target = Some(text.clone());
        front.set_family(family::of_target(&text).unwrap_or(front.family()));
        if front.phase == Phase::Closed {
            self.model.messages.dismiss();
            front.lost = None;
            front.could_not_open = false;
            front.shows_start = false;
            if self.model.screen != Screen::MclEditor {
                focus::want(&self.ctx, Region::Screen);
            }
            self.model.files.close();
            front.phase = Phase::Opening { target: text };
            let opening = self.parts.opener.open(target, addresses);
            self.links.entry(front.id()).opening = Some(opening);
        }
        self.model.devices.choose_connection(&self.model.front);
    }

    pub(super) fn finish_opening(&mut self, id: ConnectionId, ctx: &Context) {
        let Some(opening) = self.links.get(id).and_then(|link| link.opening.as_ref()) else { return };
        let why = match opening.try_recv() {
            Ok(Ok(link)) => return self.opened(id, link, ctx),
            Ok(Err(error)) => Message::error(error),
            Err(TryRecvError::Empty) => return ctx.request_repaint_after(OPENING_INTERVAL),
            Err(TryRecvError::Disconnected) => WindowStatusMessage::NoLinkThread.into(),
        };
        self.links.entry(id).opening = None;
        if let Some(connection) = self.model.connection_mut(id) {
            connection.phase = Phase::Closed;
            connection.could_not_open = true;
        }
        self.say(id, Gravity::Error, why);
    }

    fn opened(&mut self, id: ConnectionId, opened: OpenLink, ctx: &Context) {
        let ports = self.model.devices.ports.to_vec();
        self.links.entry(id).opening = None;
        // A connection that was given up meanwhile: the link is closed again by being dropped.
        let Some(connection) = self.model.connection_mut(id) else { return };
        let target = connection.phase.target().unwrap_or_default().to_owned();
        connection.phase = Phase::Open { target: target.clone() };
        let waiting = self.parts.keeping.store().waiting_at(&target);
        connection.link = LinkView::default();
        connection.link.waiting = waiting;
        connection.bus = opened.bus;
        connection.settings.keep_in(self.parts.keeping.clone(), ports);
        connection.world.forget();
        let poll = connection.poll;
        self.model.devices.remember(&target);
        self.model.devices.opened(&target);
        opened.device.set_waker(waker(ctx.clone(), self.last_frame.clone()));
        let link = self.links.entry(id);
        link.world = opened.world;
        link.device = Some(opened.device);
        link.reads_signals = false;
        link.traced = false;
        self.end.watch(self.links.stoppers().collect());
        if poll != PollRate::default() {
            self.request_of(id, Request::Poll(poll));
        }
    }

    pub(super) fn disconnect(&mut self, id: ConnectionId) {
        let Some(connection) = self.model.connection_mut(id) else { return };
        match &connection.phase {
            Phase::Opening { .. } => {
                self.links.entry(id).opening = None;
                connection.phase = Phase::Closed;
                self.model.messages.note(WindowStatusMessage::GaveUp);
            }
            Phase::Open { target } => {
                let target = target.clone();
                if self.waits_for_run(id, Afterwards::Disconnect) {
                    return;
                }
                let Some(connection) = self.model.connection_mut(id) else { return };
                connection.phase = Phase::Closing { target };
                self.request_of(id, Request::Disconnect);
            }
            Phase::Closed | Phase::Closing { .. } => {}
        }
    }

    /// A link is gone, on request or not. A simulated world lives on.
    pub(super) fn ended(&mut self, id: ConnectionId) {
        if let Some(device) = self.links.entry(id).device.take() {
            links::close(device);
        }
        let effects = self.model.connection_mut(id).map(Connection::link_ended).unwrap_or_default();
        for effect in effects {
            if let Effect::Say(gravity, text) = effect {
                self.say(id, gravity, text);
            }
        }
    }

    /// Another link comes to the front. What is armed is disarmed and stopped first: only the front can be armed.
    pub(super) fn bring_to_front(&mut self, id: ConnectionId) {
        if id == self.model.front.id() || self.model.connection(id).is_none() {
            return;
        }
        self.disarm();
        self.model.bring_to_front(id);
        self.model.devices.choose_connection(&self.model.front);
    }

    pub(super) fn forget(&mut self, id: ConnectionId) {
        self.links.remove(id);
        self.model.remove_connection(id);
        self.model.devices.choose_connection(&self.model.front);
    }

    /// Starts a node of the bus in front, by one NMT command: over the open link, or over the adapter by itself.
    pub(super) fn start_node(&mut self, node: NodeId) {
        let front = &self.model.front;
        if let Some(bus) = front.bus.as_ref().filter(|_| front.phase.is_open()) {
            bus.command(nmt::Command::Start, node);
            return self.model.messages.note(WindowStatusMessage::NodeStartSent { node });
        }
        let target = front.target.as_ref().and_then(|target| target.parse::<ConnectTarget>().ok());
        let Some(target) = target.filter(|_| self.model.canopen.starting.is_none()) else { return };
        let (sender, started) = bounded(1);
        let work = move || {
            // A window that was closed meanwhile does not want to know.
            let _ = sender.send(bus::start(&target, None, node).map(|started| started.message(node)));
        };
        // Without a thread the receiver is disconnected, which is told.
        let _ = work::spawn("start node", work);
        self.model.canopen.starting = Some(started);
    }

    /// Tells what came of starting a node.
    pub(super) fn take_started(&mut self, ctx: &Context) {
        let Some(started) = &self.model.canopen.starting else { return };
        match started.try_recv() {
            Err(TryRecvError::Empty) => return ctx.request_repaint_after(OPENING_INTERVAL),
            Ok(Ok(sentence)) => self.model.messages.note(WindowStatusMessage::ConnectAgain { sentence }),
            Ok(Err(why)) => self.model.messages.fail(why),
            Err(TryRecvError::Disconnected) => {
                self.model.messages.fail(WindowStatusMessage::NodeNotStarted);
            }
        }
        self.model.canopen.starting = None;
    }
}
