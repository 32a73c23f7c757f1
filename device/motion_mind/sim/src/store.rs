//! The registers in RAM and in EEPROM.

use brushwork_motion_mind_wire::{REGISTERS, Register, register, register_number as number};

const COUNT: usize = REGISTERS.len();

/// Both copies of all registers.
#[derive(Clone, Debug)]
pub struct Store {
    ram: [i64; COUNT],
    eeprom: [i64; COUNT],
    /// Writes to EEPROM so far.
    eeprom_writes: u64,
}

impl Store {
    /// As it leaves the factory, but for the address.
    pub fn new(address: u8) -> Self {
        let mut eeprom = factory();
        eeprom[usize::from(number::ADDRESS)] = i64::from(address);
        Self { ram: eeprom, eeprom, eeprom_writes: 0 }
    }

    /// The value in RAM.
    pub fn get(&self, number: u8) -> i64 {
        self.ram.get(usize::from(number)).copied().unwrap_or_default()
    }

    /// The same as 16 bits.
    pub fn bits(&self, number: u8) -> u16 {
        u16::try_from(self.get(number)).unwrap_or_default()
    }

    /// Whether a bit of FUNCTION is set.
    pub fn has(&self, bit: u16) -> bool {
        self.bits(number::FUNCTION) & bit != 0
    }

    /// Whether a bit of FUNCTION2 is set.
    pub fn has2(&self, bit: u16) -> bool {
        self.bits(number::FUNCTION2) & bit != 0
    }

    /// Changes RAM. A read-only register keeps its value when a client writes it: that is for the caller to see to.
    pub fn set(&mut self, number: u8, value: i64) {
        if let Some(place) = self.ram.get_mut(usize::from(number)) {
            *place = value;
        }
    }

    /// Changes RAM and EEPROM.
    pub fn store(&mut self, number: u8, value: i64) {
        self.set(number, value);
        if let Some(place) = self.eeprom.get_mut(usize::from(number)) {
            *place = value;
            self.eeprom_writes += 1;
        }
    }

    /// The value in EEPROM.
    pub fn stored(&self, number: u8) -> i64 {
        self.eeprom.get(usize::from(number)).copied().unwrap_or_default()
    }

    /// Writes to EEPROM so far.
    pub fn eeprom_writes(&self) -> u64 {
        self.eeprom_writes
    }

    /// Factory values in RAM and EEPROM.
    pub fn restore(&mut self) {
        self.eeprom = factory();
        self.ram = self.eeprom;
        self.eeprom_writes += 1;
    }

    /// What a power-up does: RAM is loaded from EEPROM.
    pub fn load(&mut self) {
        self.ram = self.eeprom;
    }

    /// Whether a client may change it.
    pub fn is_writable(number: u8) -> bool {
        register(number).is_some_and(Register::is_writable)
    }
}

fn factory() -> [i64; COUNT] {
    std::array::from_fn(|number| REGISTERS[number].default.unwrap_or_default())
}
