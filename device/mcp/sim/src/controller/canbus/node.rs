//! One node: its state, its heartbeat, whose heartbeat it listens for, and its SDO server.

use super::dictionary::{Communication, Objects};
use super::rate::ADAPTER_RATE_BPS;
use crate::controller::Controller;
use brushwork_canopen::nmt::{Command, State};
use brushwork_canopen::sdo::Server;
use brushwork_canopen::{Emergency, Frame, Function, NodeId};
use std::time::Duration;

/// Emergency code "heartbeat lost" (CiA 301).
const HEARTBEAT_LOST: u16 = 0x8130;
/// Bits of the error register: generic, communication (CiA 301, object 0x1001).
pub(super) const GENERIC_ERROR: u8 = 0x01;
pub(super) const COMMUNICATION_ERROR: u8 = 0x10;

/// A node. Without power it forgets everything but what the controller's settings hold.
#[derive(Clone, Debug, Default)]
pub(super) struct Node {
    running: Option<Running>,
}

#[derive(Clone, Debug)]
struct Running {
    id: NodeId,
    state: State,
    started_at: Duration,
    server: Server,
    communication: Communication,
    heartbeat_at: Option<Duration>,
    /// When the master that is listened for was last heard.
    heard_at: Option<Duration>,
}

impl Node {
    /// When it next does something by itself. A unit that has just got its power is noticed at the next look.
    pub fn next_event_at(&self) -> Option<Duration> {
        let running = self.running.as_ref()?;
        [running.heartbeat_at, running.lost_at()].into_iter().flatten().min()
    }

    /// Sets how often it sends its heartbeat.
    pub fn set_producer_heartbeat(&mut self, milliseconds: u16) {
        if let Some(running) = &mut self.running {
            running.communication.set_producer(milliseconds);
            running.heartbeat_at = running.heartbeat_at.filter(|_| milliseconds > 0);
        }
    }

    /// Starts and stops with the unit's power; sends what is due at `now`.
    pub fn run(&mut self, unit: &mut Controller, now: Duration) -> Vec<Frame> {
        let started_at = match unit.unit() {
            Some(view) if !view.is_in_loader() => view.booted_at(),
            _ => {
                self.running = None;
                return Vec::new();
            }
        };
        let is_new = self.running.as_ref().is_none_or(|running| running.started_at != started_at);
        if is_new {
            return self.start(unit, started_at, now);
        }
        let Some(running) = &mut self.running else { return Vec::new() };
        let mut frames = Vec::new();
        if running.heartbeat_at.is_some_and(|at| at <= now) {
            frames.push(running.state.heartbeat(running.id));
            running.heartbeat_at = running.communication.producer().map(|every| now + every);
        }
        if running.lost_at().is_some_and(|at| at <= now) {
            frames.push(running.lose_master(unit));
        }
        if is_on_the_bus(unit) { frames } else { Vec::new() }
    }

    /// Takes a frame from the bus and says what it answers.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn take(&mut self, frame: &Frame, unit: &mut Controller, now: Duration) -> Option<Frame> {
        if !is_on_the_bus(unit) || unit.unit().is_none_or(|view| view.is_in_loader()) {
            return None;
        }
        let running = self.running.as_mut()?;
        match Function::of(frame.id())? {
            Function::Nmt => {
                let (command, whom) = Command::read(frame)?;
                if whom.is_none_or(|node| node == running.id) {
                    self.obey(command, unit);
                }
                None
            }
            Function::Heartbeat(node) => {
                if running.communication.consumer().is_some_and(|(other, _)| other == node) {
                    running.heard_at = Some(now);
                    running.communication.error_register &= !(COMMUNICATION_ERROR | GENERIC_ERROR);
                }
                None
            }
            Function::SdoRequest(node) if node == running.id && running.state != State::Stopped => {
                let Running { server, communication, heartbeat_at, .. } = running;
                let had = communication.producer();
                let answer = server.take(frame.bytes(), &mut Objects { communication, unit });
                if communication.producer() != had {
                    *heartbeat_at = communication.producer().map(|every| now + every);
                }
                Some(Frame::full(Function::SdoResponse(node).id(), answer?))
            }
            _ => None,
        }
    }

    fn start(&mut self, unit: &Controller, started_at: Duration, now: Duration) -> Vec<Frame> {
        let id = NodeId::new(unit.settings().unit.can_node_id).unwrap_or(NodeId::DEFAULT);
        let communication = Communication::default();
        let heartbeat_at = communication.producer().map(|every| now + every);
        self.running = Some(Running {
            id,
            // After boot-up a node is pre-operational by itself (CiA 301).
            state: State::PreOperational,
            started_at,
            server: Server::default(),
            communication,
            heartbeat_at,
            heard_at: None,
        });
        if is_on_the_bus(unit) { vec![State::BootUp.heartbeat(id)] } else { Vec::new() }
    }

    /// Does what the master says. A reset of node or communication starts the node anew; Assumed: not the controller.
    fn obey(&mut self, command: Command, unit: &mut Controller) {
        let Some(running) = &mut self.running else { return };
        running.state = match command {
            Command::Start => State::Operational,
            Command::Stop => State::Stopped,
            Command::EnterPreOperational => State::PreOperational,
            Command::ResetNode | Command::ResetCommunication => {
                unit.stop_for_can();
                self.running = None;
                return;
            }
        };
    }
}

impl Running {
    /// When the master counts as lost.
    fn lost_at(&self) -> Option<Duration> {
        let (_, within) = self.communication.consumer()?;
        Some(self.heard_at? + within)
    }

    fn lose_master(&mut self, unit: &mut Controller) -> Frame {
        self.heard_at = None;
        self.communication.error_register |= COMMUNICATION_ERROR | GENERIC_ERROR;
        if self.state == State::Operational {
            self.state = State::PreOperational;
        }
        unit.stop_for_can();
        let register = self.communication.error_register;
        Emergency { node: self.id, code: HEARTBEAT_LOST, register, data: [0; 5] }.frame()
    }
}

/// Whether its plug is in and it runs at the adapter's rate.
fn is_on_the_bus(unit: &Controller) -> bool {
    unit.world().plugged() && unit.settings().unit.can_rate_bps == ADAPTER_RATE_BPS
}
