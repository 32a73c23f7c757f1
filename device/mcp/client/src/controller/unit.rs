//! One MCP or RoboClaw controller, as the device thread sees it.

use crate::can::describe;
use crate::controller::driving::packets;
use crate::controller::speaker::{Speaker, Wire};
use crate::controller::traffic::{describe_received, describe_sent};
use crate::controller::{arming, inquiry, polling, stopping};
use crate::messages::{McpCauseMessage, McpDriverMessage, RoboClawMessage};
use brushwork_canopen::bus::Monitor;
use brushwork_link::Message;
use brushwork_link::device::Described;
use brushwork_link::device::Drive;
use brushwork_link::device::Identity;
use brushwork_link::device::Sample;
use brushwork_link::device::StatusReport;
use brushwork_link::device::controller::{ArmCheck, Controller, Line, PollItem, PollList};
use brushwork_link::device::{Heard, Inquiry, StopBytes, UnitStop};
use brushwork_link::exchange::{ExchangeError, Reply, Tries};
use brushwork_link::transport::{Stream, TransportError};
use brushwork_mcp_wire::models::{Family, Model};
use brushwork_mcp_wire::packet_serial::name::STATUS;
use brushwork_mcp_wire::packet_serial::status::Condition;
use brushwork_mcp_wire::packet_serial::{Address, Effect, commands, lookup, number, status};
use brushwork_values::{Motor, Value};

/// One MCP or RoboClaw controller.
pub struct Mcp {
    pub(super) speaker: Speaker,
    pub(super) identity: Identity,
    pub(super) model: Option<&'static Model>,
    pub(super) polls: PollList,
    /// Whether it is known to run scripts: by its model, or since it has started one.
    pub(super) runs_scripts: bool,
    /// Whether this program has sent moves that can wait in the unit's buffers.
    pub(super) has_buffered: bool,
    /// What is heard of the nodes, on a CAN bus.
    pub(super) monitor: Option<Monitor>,
}

impl Controller for Mcp {
    fn identity(&self) -> &Identity {
        &self.identity
    }

    fn poll_list(&self) -> PollList {
        let has_pins = self.model.is_some_and(|model| model.family == Family::Mcp);
        PollList { signals: has_pins.then(polling::signals), ..self.polls.clone() }
    }

    fn poll(
        &mut self,
        line: &mut Line<'_>,
        item: PollItem,
        sample: &mut Sample,
    ) -> Result<Option<StatusReport>, ExchangeError> {
        let status = polling::read(self.speaker, line, item, sample)?;
        self.look_at_the_bus(line, status)
    }

    fn drive(&mut self, line: &mut Line<'_>, drive: &Drive) -> Result<(), ExchangeError> {
        if let (Some(model), Some(_)) = (self.model.filter(|model| model.motors == 1), drive.m2) {
            return Err(ExchangeError::impossible(RoboClawMessage::OneMotor { model: model.name }));
        }
        for (command, values) in packets(drive)? {
            self.transact(line, command, values.into_iter().map(Value::Int).collect())?;
        }
        Ok(())
    }

    fn stop_bytes(&self, scripts: bool) -> StopBytes {
        stopping::bytes(self.speaker, scripts && self.runs_scripts, self.has_buffered)
    }

    fn confirm_stop(&mut self, line: &mut Line<'_>, scripts: bool) -> Result<UnitStop, ExchangeError> {
        let on = self.name(line);
        let reads = polling::commands(&self.polls);
        let mut stop = stopping::confirm(self.speaker, line, &reads, scripts && self.runs_scripts, &on)?;
        if scripts && !self.runs_scripts && self.model.is_none() {
            stop.still_driven_by.push(McpDriverMessage::ScriptUnknown.into());
        }
        if stop.buffers_empty == Some(true) {
            self.has_buffered = false;
        }
        self.leave_alone(line)?;
        Ok(stop)
    }

    fn other_drivers(&mut self, line: &mut Line<'_>) -> Result<Vec<Message>, ExchangeError> {
        stopping::other_drivers(self.speaker, line, self.model)
    }

    fn check_arming(
        &mut self,
        line: &mut Line<'_>,
        stream: Option<Stream>,
    ) -> Result<ArmCheck, ExchangeError> {
        let on = self.name(line);
        let check = arming::check(self.speaker, self.monitor.as_ref(), line, stream, &on)?;
        if !check.reasons.is_empty() {
            self.leave_alone(line)?;
        }
        Ok(check)
    }

    fn set_encoder(&mut self, line: &mut Line<'_>, motor: Motor, counts: i32) -> Result<(), ExchangeError> {
        let command = [commands::SET_ENCODER_M1, commands::SET_ENCODER_M2][motor.index()];
        self.speaker.ask(line, command, &[i64::from(counts)]).map(drop)
    }

    fn zero_encoders(&mut self, line: &mut Line<'_>) -> Result<(), ExchangeError> {
        self.speaker.ask(line, commands::RESET_ENCODERS, &[]).map(drop)
    }

    fn reset_estop(&mut self, line: &mut Line<'_>) -> Result<(), ExchangeError> {
        self.speaker.ask(line, commands::RESET_ESTOP, &[])?;
        let reply = self.speaker.ask(line, commands::READ_STATUS, &[])?;
        let word = u32::try_from(reply.values.int(STATUS)).unwrap_or(0);
        if status::decode(word, self.speaker.generation).contains(Condition::EStop) {
            return Err(ExchangeError::impossible(McpCauseMessage::EStopIsSet));
        }
        Ok(())
    }

    fn start_script(&mut self, line: &mut Line<'_>) -> Result<(), ExchangeError> {
        self.speaker.ask(line, commands::START_SCRIPT, &[])?;
        self.runs_scripts = true;
        Ok(())
    }

    fn stop_script(&mut self, line: &mut Line<'_>) -> Result<(), ExchangeError> {
        if let Some(model) = self.model.filter(|model| !model.runs_scripts()) {
            let family = model.family.name();
            return Err(ExchangeError::impossible(McpCauseMessage::NoScripts { family }));
        }
        self.speaker.ask(line, commands::STOP_SCRIPT, &[]).map(drop)
    }

    fn enter_loader(&mut self, line: &mut Line<'_>) -> Result<(), ExchangeError> {
        if matches!(self.speaker.wire, Wire::Objects(_)) {
            return Err(ExchangeError::impossible(McpCauseMessage::NoLoaderOverCan));
        }
        match self.speaker.ask(line, commands::ENTER_LOADER, &[]) {
            // The libraries do not insist on the acknowledgement: the unit restarts.
            Err(error) if error.is_unusable_answer() || error.is_link_lost() => Ok(()),
            other => other.map(drop),
        }
    }

    fn transact(
        &mut self,
        line: &mut Line<'_>,
        command: u8,
        values: Vec<Value>,
    ) -> Result<Reply, ExchangeError> {
        if matches!(self.effect(command), Effect::RelativeMotion | Effect::Buffered) {
            self.has_buffered = true;
        }
        self.speaker.ask_values(line, command, values)
    }

    fn inquire(&mut self, line: &mut Line<'_>, asked: &Inquiry<'_>) -> Result<Heard, ExchangeError> {
        inquiry::inquire(self.speaker, line, asked)
    }

    fn look_again(&mut self, line: &mut Line<'_>) -> Result<(), ExchangeError> {
        self.polls = polling::find(self.speaker, line)?;
        Ok(())
    }

    fn set_address(&mut self, address: u8) -> bool {
        let Some(new) = Address::new(address) else { return false };
        if matches!(self.speaker.wire, Wire::Objects(_)) {
            // The node id stays, whatever the address of packet serial is.
            return true;
        }
        let old = std::mem::replace(&mut self.speaker.address, new).get();
        self.identity.address = address;
        // A unit that answers all eight goes on answering the others.
        let others = &mut self.identity.also_answers;
        if let Some(other) = others.iter_mut().find(|other| **other == address) {
            *other = old;
        }
        true
    }

    fn can_move(&self, command: u8) -> bool {
        self.effect(command).may_move()
    }

    fn starts_script(&self, command: u8) -> bool {
        self.effect(command) == Effect::Script
    }

    fn undermines_arming(&self, command: u8) -> bool {
        UNDERMINING.contains(&command)
    }

    fn describe_traffic(&self, request: &[u8], reply: Option<&[u8]>) -> Described {
        let generation = self.speaker.generation;
        if let Wire::Objects(place) = self.speaker.wire {
            return describe(reply.unwrap_or(request), place.form);
        }
        match reply {
            None => describe_sent(request, generation),
            Some(reply) => describe_received(request, reply, generation),
        }
    }
}

impl Mcp {
    /// The unit and its port, for sentences.
    fn name(&self, line: &mut Line<'_>) -> String {
        format!("{} at {}", self.identity.place(), line.exchange().port())
    }

    /// What the bus told on the way: a node that no longer beats is lost, an emergency is a failure, a boot-up a restart.
    fn look_at_the_bus(
        &self,
        line: &mut Line<'_>,
        status: Option<StatusReport>,
    ) -> Result<Option<StatusReport>, ExchangeError> {
        let (Wire::Objects(place), Some(monitor)) = (self.speaker.wire, &self.monitor) else {
            return Ok(status);
        };
        let now = line.exchange().clock().now();
        if let Some(away) = monitor.lost_for(place.node, now) {
            let detail = format!("the heartbeat of {} stayed away for {} ms", place.node, away.as_millis());
            return Err(TransportError::Gone { detail }.into());
        }
        if let Some(emergency) =
            monitor.take_emergencies(place.node).iter().find(|emergency| emergency.code != 0)
        {
            let what =
                format!("{} reported emergency {:04X} ({})", place.node, emergency.code, emergency.class());
            return Err(ExchangeError::Malformed { what, tries: Tries(1) });
        }
        // Time since its last boot-up that was heard; it falls when the node starts anew.
        let (_, booted_at) = monitor.boots(place.node);
        let running = now.saturating_sub(booted_at.unwrap_or_default()).as_millis();
        Ok(status.map(|status| StatusReport {
            running_ticks: status.running_ticks.or(u32::try_from(running).ok()),
            ..status
        }))
    }

    /// A node that was made to watch this program's heartbeat need not do so any more.
    fn leave_alone(&self, line: &mut Line<'_>) -> Result<(), ExchangeError> {
        let (Wire::Objects(place), Some(monitor)) = (self.speaker.wire, &self.monitor) else { return Ok(()) };
        if !monitor.is_beating() {
            return Ok(());
        }
        match place.unwatch_master(line) {
            Err(error) if error.is_link_lost() || error.interruption().is_some() => Err(error),
            // It may go on watching then, and stops motors that stand.
            _ => {
                monitor.beat(false);
                Ok(())
            }
        }
    }

    fn effect(&self, command: u8) -> Effect {
        lookup(command).map_or(Effect::Query, |row| row.effect(self.speaker.generation))
    }
}

/// Commands that change what arming was based on: time-outs, streams, priorities, address, or all settings at once.
const UNDERMINING: [u8; 7] = [
    number::SET_SERIAL_TIMEOUT,
    number::SET_STREAM,
    number::SET_PRIORITIES,
    number::SET_ADDRESS_MIXED,
    number::RESTORE_DEFAULTS,
    number::RELOAD_SETTINGS,
    number::SET_CONFIG,
];
