//! The surroundings of a running script: the unit, its world, and the bytes on their way in and out.

use super::super::firmware::Firmware;
use super::i2c::Transfer;
use super::streams::{self, CAN};
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::World;
use std::time::Duration;

/// Stream type "MCL" (MCP manual, command 145).
const STREAM_MCL: u8 = 0;
/// Stream type "disabled".
pub(super) const STREAM_DISABLED: u8 = 2;

/// The surroundings of a script at one moment.
pub struct ScriptHost<'a> {
    pub(super) unit: &'a mut Firmware,
    pub(super) world: &'a mut World,
    /// The script's moment, in time since power-up.
    pub(super) up_for: Duration,
    /// How long what it did keeps it busy.
    pub(super) busy: Duration,
    said: Vec<(StreamIndex, Vec<u8>)>,
}

impl<'a> ScriptHost<'a> {
    pub(super) fn new(unit: &'a mut Firmware, world: &'a mut World, up_for: Duration) -> Self {
        unit.now = unit.now.max(unit.booted_at + up_for);
        Self { unit, world, up_for, busy: Duration::ZERO, said: Vec::new() }
    }

    /// What was sent to which stream.
    pub(super) fn finish(self) -> Vec<(StreamIndex, Vec<u8>)> {
        self.said
    }

    /// Whether a serial stream belongs to the script: it is in MCL mode, and nobody forces packet serial (MCP manual 1.9.3).
    fn is_scripts(&self, port: StreamIndex) -> bool {
        self.unit.settings.streams[port.index()].kind == STREAM_MCL && !self.unit.speaks_packet_serial(port)
    }

    /// A byte to a serial stream. One that does not belong to the script loses it; a slow one makes the script wait.
    pub(super) fn say(&mut self, port: StreamIndex, byte: u8) {
        if !self.is_scripts(port) {
            return;
        }
        if port != StreamIndex::Usb {
            let rate_bps = self.unit.settings.streams[port.index()].rate_bps;
            // Bytes go out one after the other, so that the wait for the last one is the longest.
            let wait = self.unit.script.sending.send(port, rate_bps, self.up_for);
            self.busy = self.busy.max(wait);
        }
        match self.said.iter_mut().find(|(known, _)| *known == port) {
            Some((_, bytes)) => bytes.push(byte),
            None => self.said.push((port, vec![byte])),
        }
    }

    pub(super) fn transfer(&mut self, timeout: Option<Duration>) -> Transfer<'_> {
        let streams = &self.unit.settings.streams;
        Transfer {
            world: self.world,
            // "I2C will be active if UART1 is disabled" (MCP manual, command 145).
            enabled: streams[StreamIndex::Uart1.index()].kind == STREAM_DISABLED,
            rate_bps: self.unit.settings.unit.i2c_rate_bps,
            timeout,
        }
    }
}

impl Firmware {
    /// Whether the CAN port is there for scripts: "CAN will be active if UART0 is disabled" (MCP manual, command 145).
    pub(crate) fn can_stream_is_active(&self) -> bool {
        self.settings.streams[StreamIndex::Uart0.index()].kind == STREAM_DISABLED
    }

    /// A byte has come on a serial stream that does not speak packet serial.
    pub(crate) fn hear_for_script(&mut self, port: StreamIndex, byte: u8, now: Duration) {
        let stream = streams::number_of(port);
        if let (Some(stream), STREAM_MCL) = (stream, self.settings.streams[port.index()].kind) {
            self.script.streams.take_in(stream, byte, now.saturating_sub(self.booted_at));
        }
    }

    /// Takes what has come over CAN by a time since power-up.
    pub(crate) fn hear_can(&mut self, world: &mut World, up_for: Duration) {
        while let Some((at, byte)) = world.can_line.take(self.booted_at + up_for) {
            if self.can_stream_is_active() {
                self.script.streams.take_in(CAN, byte, at.saturating_sub(self.booted_at));
            }
        }
    }
}
