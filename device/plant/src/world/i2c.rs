//! Devices on a unit's I2C bus: files of registers behind an address, as sensors and memories are.

use serde::{Deserialize, Serialize};

/// How many registers a device has.
pub const REGISTERS: usize = 256;

/// A device on the bus. The first byte written sets which register comes next; each further byte written or read goes on to the one after
/// it, and after the last comes the first.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct I2cDevice {
    /// What it is, for panels.
    pub name: String,
    /// Its address of seven bits.
    pub address: u8,
    /// Its registers; those that are not given are 0.
    #[serde(default)]
    pub registers: Vec<u8>,
    /// How long it holds the clock before each byte.
    #[serde(default)]
    pub stretch_us: u32,
    #[serde(skip)]
    pointer: u8,
    #[serde(skip)]
    is_pointer_next: bool,
}

impl I2cDevice {
    /// A device whose registers are all 0.
    #[must_use]
    pub fn new(name: &str, address: u8) -> Self {
        Self {
            name: name.to_owned(),
            address,
            registers: vec![0; REGISTERS],
            stretch_us: 0,
            pointer: 0,
            is_pointer_next: false,
        }
    }

    /// The motion sensor of the manual's I2C example: MPU-6050 at 0x68, lying level and still at 25 degrees Celsius (register map of
    /// its data sheet).
    #[must_use]
    pub fn mpu6050() -> Self {
        let mut device = Self::new("MPU-6050", 0x68);
        // WHO_AM_I is the address, PWR_MGMT_1 begins with the sleep bit.
        device.set(0x75, &[0x68]);
        device.set(0x6B, &[0x40]);
        // Acceleration in x, y, z: 16384 is 1 g. Temperature: (25 - 36.53) x 340. Turn rates: none.
        device.set(0x3B, &[0, 0, 0, 0, 0x40, 0x00]);
        device.set(0x41, &(-3920_i16).to_be_bytes());
        device
    }

    /// The same device, holding the clock for so long before each byte.
    #[must_use]
    pub fn stretching(self, stretch_us: u32) -> Self {
        Self { stretch_us, ..self }
    }

    /// The device of that name; for command lines and presets.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        name.eq_ignore_ascii_case("mpu6050").then(Self::mpu6050)
    }

    /// Sets registers from one on; those past the last are passed by.
    pub fn set(&mut self, first: u8, values: &[u8]) {
        self.registers.resize(REGISTERS, 0);
        let places = self.registers.iter_mut().skip(first.into());
        places.zip(values).for_each(|(place, value)| *place = *value);
    }

    /// A start with this device's address for writing.
    pub fn begin(&mut self) {
        self.is_pointer_next = true;
    }

    /// Takes a byte.
    pub fn write(&mut self, byte: u8) {
        if std::mem::take(&mut self.is_pointer_next) {
            self.pointer = byte;
        } else {
            self.set(self.pointer, &[byte]);
            self.pointer = self.pointer.wrapping_add(1);
        }
    }

    /// Gives a byte.
    pub fn read(&mut self) -> u8 {
        let byte = self.registers.get(usize::from(self.pointer)).copied().unwrap_or(0);
        self.pointer = self.pointer.wrapping_add(1);
        byte
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pointer_is_written_first_and_counts_on() {
        let mut device = I2cDevice::new("memory", 0x50);
        device.begin();
        [0xFE, 1, 2, 3].into_iter().for_each(|byte| device.write(byte));
        assert_eq!((device.registers[0xFE], device.registers[0xFF], device.registers[0]), (1, 2, 3));
        device.begin();
        device.write(0xFF);
        assert_eq!((device.read(), device.read(), device.read()), (2, 3, 0));
    }

    #[test]
    fn a_short_list_of_registers_reads_as_zeros() {
        let mut device = I2cDevice { registers: vec![7], ..I2cDevice::new("stub", 1) };
        assert_eq!((device.read(), device.read()), (7, 0));
    }
}
