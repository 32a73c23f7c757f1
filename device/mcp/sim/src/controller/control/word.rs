//! The configuration word as it is told and taken (RoboClaw manual 2018; public clients, 2015-2025).

use super::super::firmware::Firmware;
use crate::settings::StreamSettings;
use brushwork_mcp_wire::models::Family;
use brushwork_mcp_wire::packet_serial::Address;
use brushwork_mcp_wire::roboclaw::{ConfigWord, ControlMode};
use brushwork_plant::machine::StreamIndex;

impl Firmware {
    pub(crate) fn is_roboclaw(&self) -> bool {
        self.model.family == Family::RoboClaw
    }

    /// The configuration word as command 99 returns it: what it says is so. An MCP has other commands for what stands in it; Assumed:
    /// there it tells the mode, the rate and the multi-unit mode of TTL UART1 and the address.
    pub(crate) fn config_word(&self) -> u16 {
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
    pub(crate) fn swaps_encoders(&self) -> bool {
        self.is_roboclaw() && self.control.word.swaps_encoders()
    }

    /// Takes a configuration word (command 98). Its address counts at once (public clients, 2015-2025).
    pub(crate) fn set_config_word(&mut self, word: u16) {
        self.settings.unit.config_word = word;
        if let Some(number) = ConfigWord(word).address_number() {
            self.settings.unit.address = Address::FIRST.get() + number;
        }
    }

    /// The rates of the lines go on as they are, whatever settings are loaded.
    pub(crate) fn keep_rates(&mut self, before: &[StreamSettings; 5]) {
        if self.is_roboclaw() {
            for (stream, before) in self.settings.streams.iter_mut().zip(before) {
                stream.rate_bps = before.rate_bps;
            }
        }
    }
}
