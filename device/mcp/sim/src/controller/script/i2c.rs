//! The unit's I2C bus as its one master (MCP manual 1.9.6): starts, addresses, bytes, stops and the time they take.
//!
//! Assumed: the values of I2CERROR, which no source tells; a command that fails sends a stop.

use brushwork_plant::world::World;
use std::time::Duration;

/// Bits of a byte on the bus, the acknowledgement included.
const BITS_PER_BYTE: u32 = 9;

/// What I2CERROR says. Assumed as a whole, but that 0 is none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum I2cError {
    /// Nothing went wrong.
    #[default]
    None = 0,
    /// The bus is not enabled: UART1, which shares its pins, is not disabled (MCP manual, command 145).
    NotEnabled = 1,
    /// Nobody acknowledged the address.
    NoDevice = 2,
    /// The device did not acknowledge a byte, or was asked to read what it was to be written.
    Refused = 3,
    /// The bus was read before a device was addressed for it.
    NotAddressed = 4,
    /// The device held the bus for longer than the time-out.
    TimedOut = 5,
}

/// The state of the bus between commands.
#[derive(Clone, Debug, Default)]
pub struct I2cMaster {
    /// The device that was addressed for reading and waits for the master's clock.
    reading: Option<u8>,
    error: I2cError,
}

/// One command's means and costs.
pub struct Transfer<'a> {
    /// Where the devices are.
    pub world: &'a mut World,
    /// Whether the pins are the bus's.
    pub enabled: bool,
    /// The bus rate.
    pub rate_bps: u32,
    /// How long a device may hold one byte.
    pub timeout: Option<Duration>,
}

impl I2cMaster {
    /// What went wrong in the last command.
    pub fn error(&self) -> I2cError {
        self.error
    }

    /// A start, the bytes, of which the first is the address with the direction bit, and a stop if it is wanted. Gives the time it took.
    pub fn write(&mut self, bytes: &[u8], stop: bool, transfer: Transfer<'_>) -> Duration {
        self.reading = None;
        let mut took = Duration::ZERO;
        let done = self.try_write(bytes, stop, transfer, &mut took);
        self.error = done.err().unwrap_or_default();
        took
    }

    /// Bytes from the device that was addressed for reading, then a stop.
    pub fn read(&mut self, count: usize, transfer: Transfer<'_>) -> (Option<Vec<u8>>, Duration) {
        let mut took = Duration::ZERO;
        let done = self.try_read(count, transfer, &mut took);
        self.reading = None;
        self.error = done.as_ref().err().copied().unwrap_or_default();
        (done.ok(), took)
    }

    fn try_write(
        &mut self,
        bytes: &[u8],
        stop: bool,
        transfer: Transfer<'_>,
        took: &mut Duration,
    ) -> Result<(), I2cError> {
        let Transfer { world, enabled, rate_bps, timeout } = transfer;
        if !enabled {
            return Err(I2cError::NotEnabled);
        }
        let Some((&head, data)) = bytes.split_first() else { return Ok(()) };
        let (address, is_read) = (head >> 1, head & 1 != 0);
        let Some(device) = world.i2c_device(address) else {
            *took += byte_time(rate_bps);
            return Err(I2cError::NoDevice);
        };
        let stretch = Duration::from_micros(device.stretch_us.into());
        *took += byte_time(rate_bps) + hold(stretch, timeout)?;
        if is_read {
            self.reading = Some(address).filter(|_| !stop);
            return if data.is_empty() { Ok(()) } else { Err(I2cError::Refused) };
        }
        device.begin();
        for byte in data {
            *took += byte_time(rate_bps) + hold(stretch, timeout)?;
            device.write(*byte);
        }
        Ok(())
    }

    fn try_read(
        &mut self,
        count: usize,
        transfer: Transfer<'_>,
        took: &mut Duration,
    ) -> Result<Vec<u8>, I2cError> {
        let Transfer { world, enabled, rate_bps, timeout } = transfer;
        if !enabled {
            return Err(I2cError::NotEnabled);
        }
        let address = self.reading.ok_or(I2cError::NotAddressed)?;
        let device = world.i2c_device(address).ok_or(I2cError::NoDevice)?;
        let stretch = Duration::from_micros(device.stretch_us.into());
        let mut bytes = Vec::with_capacity(count.min(256));
        for _ in 0..count {
            *took += byte_time(rate_bps) + hold(stretch, timeout)?;
            bytes.push(device.read());
        }
        Ok(bytes)
    }
}

fn byte_time(rate_bps: u32) -> Duration {
    Duration::from_secs(1) * BITS_PER_BYTE / rate_bps.max(1)
}

/// The time a device holds a byte, unless that is too long.
fn hold(stretch: Duration, timeout: Option<Duration>) -> Result<Duration, I2cError> {
    match timeout {
        Some(timeout) if stretch > timeout => Err(I2cError::TimedOut),
        _ => Ok(stretch),
    }
}
