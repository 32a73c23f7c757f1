//! What a running script reaches: its streams, the motors, the user EEPROM, the I2C bus; the registers stand in a folder of their own.

use super::host::ScriptHost;
use super::i2c::I2cError;
use super::streams::{CAN, port_of};
use super::{motion, registers};
use crate::settings::ROW_WRITE_TIME;
use brushwork_script::mcl::ast::Motion;
use brushwork_script::mcl::registers::RegisterId;
use brushwork_script::vm::Host;
use brushwork_values::Motor;
use std::time::Duration;

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
