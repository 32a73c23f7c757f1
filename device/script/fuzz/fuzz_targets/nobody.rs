//! A host without streams, registers and motors.

use brushwork_script::mcl::ast::Motion;
use brushwork_script::mcl::registers::RegisterId;
use brushwork_script::vm::Host;
use std::time::Duration;

pub struct Nobody;

impl Host for Nobody {
    fn now(&self) -> Duration {
        Duration::ZERO
    }
    fn register(&mut self, _: RegisterId, _: u8) -> u32 {
        42
    }
    fn set_register(&mut self, _: RegisterId, _: u8, _: u32) {}
    fn put(&mut self, _: u32, _: u8) {}
    fn get(&mut self, _: u32) -> Option<u8> {
        Some(b'7')
    }
    fn motion(&mut self, _: Motion, _: &[i32]) {}
    fn read_eeprom(&mut self, _: u32) -> u8 {
        0
    }
    fn write_eeprom(&mut self, _: u32, _: u8) {}
    fn i2c_write(&mut self, _: &[u8], _: bool, _: Option<Duration>) -> bool {
        true
    }
    fn i2c_read(&mut self, count: usize, _: Option<Duration>) -> Option<Vec<u8>> {
        Some(vec![0; count.min(256)])
    }
}
