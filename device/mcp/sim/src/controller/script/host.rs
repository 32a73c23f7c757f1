//! What a running script reaches: its streams, the motors, the user EEPROM, the I2C bus; the registers stand in a folder of their own.

use super::super::firmware::Firmware;
use super::i2c::{I2cError, Transfer};
use super::registers;
use super::streams::{CAN, STREAMS, port_of};
use super::{motion, streams};
use crate::settings::ROW_WRITE_TIME;
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::World;
use brushwork_script::mcl::ast::Motion;
use brushwork_script::mcl::registers::RegisterId;
use brushwork_script::vm::Host;
use brushwork_values::Motor;
use std::time::Duration;

/// Stream type "MCL" (MCP manual, command 145).
const STREAM_MCL: u8 = 0;
/// Stream type "disabled".
pub(super) const STREAM_DISABLED: u8 = 2;
/// Bytes that a serial port holds back before PUTS has to wait. Assumed.
const SEND_BUFFER_BYTES: u32 = 64;
/// Bits of a byte on a serial line.
const BITS_PER_BYTE: u32 = 10;

/// The surroundings of a script at one moment.
pub struct ScriptHost<'a> {
    pub(super) unit: &'a mut Firmware,
    world: &'a mut World,
    /// The script's moment, in time since power-up.
    pub(super) up_for: Duration,
    /// How long what it did keeps it busy.
    busy: Duration,
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
    fn say(&mut self, port: StreamIndex, byte: u8) {
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

    fn transfer(&mut self, timeout: Option<Duration>) -> Transfer<'_> {
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

impl Host for ScriptHost<'_> {
    fn now(&self) -> Duration {
        self.up_for
    }

    fn busy_until(&self) -> Option<Duration> {
        (!self.busy.is_zero()).then(|| self.up_for + self.busy)
    }

    fn register(&mut self, id: RegisterId, element: u8) -> u32 {
        registers::read(self, id, element)
    }

    fn set_register(&mut self, id: RegisterId, element: u8, value: u32) {
        registers::write(self, id, element, value);
    }

    fn put(&mut self, stream: u32, byte: u8) {
        let stream = stream as usize;
        if stream == CAN && self.unit.can_stream_is_active() {
            self.world.can_line.hear(byte, self.unit.booted_at + self.up_for);
        } else if let Some(port) = port_of(stream) {
            self.say(port, byte);
        }
    }

    fn get(&mut self, stream: u32) -> Option<u8> {
        self.unit.script.streams.next(stream as usize)
    }

    fn motion(&mut self, command: Motion, arguments: &[i32]) {
        let commands = motion::commands(command, arguments);
        for (motor, command) in Motor::BOTH.into_iter().zip(commands) {
            if let Some(command) = command {
                self.unit.command(motor, command);
                self.unit.script.drives[motor.index()] = true;
            }
        }
    }

    fn read_eeprom(&mut self, address: u32) -> u8 {
        self.unit.memory.eeprom.user_byte(address)
    }

    fn write_eeprom(&mut self, address: u32, value: u8) {
        self.unit.memory.eeprom.set_user_byte(address, value);
        self.busy += ROW_WRITE_TIME;
    }

    fn i2c_write(&mut self, bytes: &[u8], stop: bool, timeout: Option<Duration>) -> bool {
        let mut master = std::mem::take(&mut self.unit.script.i2c);
        let took = master.write(bytes, stop, self.transfer(timeout));
        self.busy += took;
        let done = master.error() == I2cError::None;
        self.unit.script.i2c = master;
        done
    }

    fn i2c_read(&mut self, count: usize, timeout: Option<Duration>) -> Option<Vec<u8>> {
        let mut master = std::mem::take(&mut self.unit.script.i2c);
        let (bytes, took) = master.read(count, self.transfer(timeout));
        self.busy += took;
        self.unit.script.i2c = master;
        bytes
    }
}

impl Firmware {
    /// Whether the CAN port is there for scripts: "CAN will be active if UART0 is disabled" (MCP manual, command 145).
    pub(in super::super) fn can_stream_is_active(&self) -> bool {
        self.settings.streams[StreamIndex::Uart0.index()].kind == STREAM_DISABLED
    }

    /// A byte has come on a serial stream that does not speak packet serial.
    pub(in super::super) fn hear_for_script(&mut self, port: StreamIndex, byte: u8, now: Duration) {
        let stream = streams::number_of(port);
        if let (Some(stream), STREAM_MCL) = (stream, self.settings.streams[port.index()].kind) {
            self.script.streams.take_in(stream, byte, now.saturating_sub(self.booted_at));
        }
    }

    /// Takes what has come over CAN by a time since power-up.
    pub(in super::super) fn hear_can(&mut self, world: &mut World, up_for: Duration) {
        while let Some((at, byte)) = world.can_line.take(self.booted_at + up_for) {
            if self.can_stream_is_active() {
                self.script.streams.take_in(CAN, byte, at.saturating_sub(self.booted_at));
            }
        }
    }
}

/// When the last byte of each slow stream will be out.
#[derive(Clone, Debug, Default)]
pub struct SendTimes([Duration; STREAMS + 1]);

impl SendTimes {
    /// Puts a byte behind those that are on their way, and tells how long the script waits for room.
    pub fn send(&mut self, port: StreamIndex, rate_bps: u32, now: Duration) -> Duration {
        let byte_time = Duration::from_secs(1) * BITS_PER_BYTE / rate_bps.max(1);
        let done_at = &mut self.0[port.index()];
        *done_at = (*done_at).max(now) + byte_time;
        done_at.saturating_sub(now).saturating_sub(byte_time * SEND_BUFFER_BYTES)
    }
}
