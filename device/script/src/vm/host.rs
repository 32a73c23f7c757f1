//! What the machine asks of whatever it runs in.

use crate::board::Board;
use crate::mcl::ast::Motion;
use crate::mcl::registers::RegisterId;
use std::time::Duration;

/// The surroundings of a script: a simulated controller, or a test.
pub trait Host {
    /// Time since power-up.
    fn now(&self) -> Duration;

    /// Until when what the script just did keeps it from going on: a byte on a bus, a byte into the EEPROM, a port without room. Asked
    /// after instructions that can take time.
    fn busy_until(&self) -> Option<Duration> {
        None
    }

    /// An element of a system register; elements that the controller does not have are 0.
    fn register(&mut self, id: RegisterId, element: u8) -> u32;

    /// Sets an element of a writable register.
    fn set_register(&mut self, id: RegisterId, element: u8, value: u32);

    /// Sends a byte to a stream; one that does not exist takes it and loses it.
    fn put(&mut self, stream: u32, byte: u8);

    /// The next byte of a stream, if one has come.
    fn get(&mut self, stream: u32) -> Option<u8>;

    /// A motion command with its arguments in the order of its syntax line.
    fn motion(&mut self, command: Motion, arguments: &[i32]);

    /// A byte of the user EEPROM.
    fn read_eeprom(&mut self, address: u32) -> u8;

    /// Sets a byte of the user EEPROM.
    fn write_eeprom(&mut self, address: u32, value: u8);

    /// Sends bytes to the I2C bus; false if nobody took one in time.
    fn i2c_write(&mut self, bytes: &[u8], stop: bool, timeout: Option<Duration>) -> bool;

    /// Reads bytes of the I2C bus; `None` if one did not come in time.
    fn i2c_read(&mut self, count: usize, timeout: Option<Duration>) -> Option<Vec<u8>>;

    /// A command of the board with its arguments, and what it gives; a controller without it does nothing.
    fn board(&mut self, _command: Board, _arguments: &[u32]) -> u32 {
        0
    }

    /// Sends bytes of memory as one frame.
    fn send(&mut self, _bytes: &[u8]) {}

    /// The bytes of the frame that was received last; what is missing of those asked for is 0.
    fn receive(&mut self) -> Vec<u8> {
        Vec::new()
    }
}
