//! What a RoboClaw does by its control pins and its configuration word: emergency stop, limit and home switches, homing at power up,
//! R/C and analog inputs, simple serial, control outputs, battery cut-off (RoboClaw manual 2018).
//!
//! Assumed, all in this folder, since no public source says it:
//! - the configuration word but for its address counts from a power up on, and packet serial goes on over USB in every mode;
//! - an open pin is pulled up, and a pin reads low below 1.5 V; D1 and D2 are the outputs CTRL1 and CTRL2 of earlier firmware;
//! - a latching emergency stop is released by command 200 where 201 allows it, as a button is;
//! - a switch for both ends stops the direction in which the motor ran when it closed, backward if it stood;
//! - homing is by duty whatever loops are set, 25 % in generation 4, which has no setting for it, and any command ends it; without a
//!   time-out it does not begin;
//! - in R/C and analog mode packet serial moves nothing; R/C pulses go from 1000 to 2000 us and their center is what they are at first,
//!   1500 us with MCU; pulses that stop for 250 ms are lost; the flip switch turns both motors round; an open analog input is a stop;
//!   the range and the limits of generation 4 are in us, in mV, and in 1/32767 of full output, and zeros leave the unit's own;
//! - exponential is a square; behind a deadband the slope begins at its edge; a motor goes on by its input after an emergency stop;
//! - a cell is cut off at 3.0 V and full at 4.2 V; with automatic offset the maximum is so much above the voltage at power up;
//! - slave mode, relay mode, swapped buttons, encoder toggle and RS-485 direction have no effect here.

mod homing;
mod inputs;
mod outputs;
mod pins;

use super::firmware::Firmware;
use crate::settings::{Settings, StreamSettings};
use brushwork_mcp_wire::models::Family;
use brushwork_mcp_wire::packet_serial::{Address, scale};
use brushwork_mcp_wire::roboclaw::{BAUD_RATES, ConfigWord, ControlMode};
use brushwork_plant::machine::StreamIndex;
use homing::Homing;
use inputs::Input;
use pins::Watched;

/// A cell below this is empty.
const EMPTY_CELL_VOLTS: f64 = 3.0;
/// A cell above this is full.
const FULL_CELL_VOLTS: f64 = 4.2;

/// What a power up starts anew.
#[derive(Clone, Debug)]
pub(super) struct Control {
    /// The configuration word in force.
    word: ConfigWord,
    /// S3, S4 and S5.
    pins: [Watched; 3],
    /// A momentary emergency stop is pulled.
    is_held: bool,
    homing: Homing,
    /// S1 and S2.
    inputs: [Input; 2],
    /// The main battery at power up.
    start_volts: f64,
}

impl Control {
    /// As after a power up with these settings.
    pub fn boot(word: u16, start_volts: f64) -> Self {
        Self {
            word: ConfigWord(word),
            pins: Default::default(),
            is_held: false,
            homing: Homing::START,
            inputs: Default::default(),
            start_volts,
        }
    }

    /// Who commands the motors.
    pub fn mode(&self) -> ControlMode {
        self.word.mode()
    }

    /// Whether a momentary emergency stop is pulled.
    pub fn is_held(&self) -> bool {
        self.is_held
    }

    /// Ends homing.
    pub fn end_homing(&mut self) {
        self.homing = Homing::Done;
    }

    /// Least and greatest main battery voltage, where something else than command 57 sets them. `auto_offset_tenths` is that of
    /// command 57 in generation 4.
    pub fn battery_volts(&self, own: (f64, f64), auto_offset_tenths: u8) -> (f64, f64) {
        let cells = match self.word.battery() {
            0 if auto_offset_tenths > 0 => {
                return (own.0, self.start_volts + f64::from(auto_offset_tenths) * scale::VOLTAGE_VOLTS);
            }
            0 => return own,
            1 => (self.start_volts / FULL_CELL_VOLTS).ceil().max(2.0),
            cells => f64::from(cells),
        };
        (cells * EMPTY_CELL_VOLTS, cells * FULL_CELL_VOLTS)
    }
}

/// The rates of the serial lines as the configuration word has them; a rate that it has no number for stays.
pub(super) fn follow_rate(settings: &mut Settings) {
    let Some(rate_bps) = ConfigWord(settings.unit.config_word).baud_bps() else { return };
    for stream in settings.streams.iter_mut().skip(1) {
        if BAUD_RATES.contains(&stream.rate_bps) {
            stream.rate_bps = rate_bps;
        }
    }
}

impl Firmware {
    pub(super) fn is_roboclaw(&self) -> bool {
        self.model.family == Family::RoboClaw
    }

    /// The configuration word as command 99 returns it: what it says is so. An MCP has other commands for what stands in it; Assumed:
    /// there it tells the mode, the rate and the multi-unit mode of TTL UART1 and the address.
    pub(super) fn config_word(&self) -> u16 {
        let stored = ConfigWord(self.settings.unit.config_word);
        let number = self.settings.unit.address - Address::FIRST.get();
        if self.is_roboclaw() {
            return stored.with_address_number(number).0;
        }
        let line = &self.settings.streams[StreamIndex::Uart1.index()];
        let told = stored.with_mode(ControlMode::PacketSerial).with_baud_bps(line.rate_bps);
        told.with_multi_unit(line.multi_unit).with_address_number(number).0
    }

    /// Whether encoder 1 serves motor 2 and the other way round.
    pub(super) fn swaps_encoders(&self) -> bool {
        self.is_roboclaw() && self.control.word.swaps_encoders()
    }

    /// Takes a configuration word (command 98). Its address counts at once (public clients, 2015-2025).
    pub(super) fn set_config_word(&mut self, word: u16) {
        self.settings.unit.config_word = word;
        if let Some(number) = ConfigWord(word).address_number() {
            self.settings.unit.address = Address::FIRST.get() + number;
        }
    }

    /// The rates of the lines go on as they are, whatever settings are loaded.
    pub(super) fn keep_rates(&mut self, before: &[StreamSettings; 5]) {
        if self.is_roboclaw() {
            for (stream, before) in self.settings.streams.iter_mut().zip(before) {
                stream.rate_bps = before.rate_bps;
            }
        }
    }
}
