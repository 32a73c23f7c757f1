//! What simulated SuprMotrs to make: the text behind `sim:suprmotr-v9`, and the arguments of `brushwork sim`.
//!
//! `suprmotr-v9,units=0,3,F,reply-form=id,echo=off,addressed=yes,baud=9600,preset=NAME,seed=N`; `?` and `&` may stand for the commas, and `address`
//! for `units`.

use brushwork_family::spec::{self, seed};
use brushwork_plant::ParamsError;
use brushwork_plant::presets;

pub use brushwork_family::spec::preset;
use brushwork_suprmotr_sim::{Eeprom, SuprMotr, SuprMotrBus, SuprMotrConfig, world_of};
use brushwork_suprmotr_wire::{Address, ReportForm};

/// The name of the model.
pub const MODEL: &str = "suprmotr-v9";

/// The rates that BR knows, by its numbers.
pub const RATES_BPS: [u32; 3] = [9_600, 19_200, 38_400];

/// One line with one or more simulated SuprMotrs.
#[derive(Clone, Debug, PartialEq)]
pub struct SuprMotrSpec {
    /// Addresses, one board each.
    pub addresses: Vec<Address>,
    /// What the boards' EEPROMs hold, in their order; those of the factory if there are none.
    pub eeproms: Vec<Eeprom>,
    /// How they write reports.
    pub reply_form: ReportForm,
    /// Whether what they hear comes back.
    pub has_echo: bool,
    /// Whether they are selected after a start.
    pub is_addressed: bool,
    /// The rate that the factory's EEPROM has, in bits per second.
    pub rate_bps: u32,
    /// The motor; the slide if none is named.
    pub preset: Option<String>,
    /// Seed of the measurement noise; 0 for none.
    pub seed: u64,
}

impl Default for SuprMotrSpec {
    fn default() -> Self {
        Self {
            addresses: vec![Address::FACTORY],
            eeproms: Vec::new(),
            reply_form: ReportForm::default(),
            has_echo: true,
            is_addressed: false,
            rate_bps: RATES_BPS[0],
            preset: None,
            seed: 1,
        }
    }
}

impl SuprMotrSpec {
    /// Whether the text behind `sim:` asks for SuprMotrs.
    #[must_use]
    pub fn is_asked_for(text: &str) -> bool {
        spec::asks_for(text, MODEL)
    }

    /// Reads the text behind `sim:`.
    ///
    /// # Errors
    /// A clause that names the part at fault and what may stand there.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut spec = Self { addresses: Vec::new(), ..Self::default() };
        for (key, value) in spec::options(text, &["address", "units"]).map_err(no_option)? {
            spec.set(key, value)?;
        }
        if spec.addresses.is_empty() {
            spec.addresses.push(Address::FACTORY);
        }
        Ok(spec)
    }

    fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        match key {
            "address" | "units" => self.add_address(value)?,
            "reply-form" => self.reply_form = reply_form(value)?,
            "echo" => self.has_echo = switch(key, value, ["on", "off"])?,
            "addressed" => self.is_addressed = switch(key, value, ["yes", "no"])?,
            "baud" => self.rate_bps = value.parse().ok().and_then(rate).ok_or_else(|| no_rate(value))?,
            "preset" => self.preset = Some(preset(value)?),
            "seed" => self.seed = seed(value)?,
            _ => return Err(no_option(key)),
        }
        Ok(())
    }

    /// Adds a board, by the character of its address.
    ///
    /// # Errors
    /// A clause: there is no such address, or another board has it.
    pub fn add_address(&mut self, text: &str) -> Result<(), String> {
        let address = match *text.as_bytes() {
            [character] => Address::from_character(character),
            _ => None,
        };
        let address = address
            .ok_or_else(|| format!("\"{text}\" is no address of a SuprMotr. Use 0 to 9 and A to F"))?;
        spec::add(&mut self.addresses, address, char::from(address.character()))
    }

    /// The boards on one wire.
    ///
    /// # Errors
    /// Figures of a preset that make no sense.
    pub fn bus(&self) -> Result<SuprMotrBus, ParamsError> {
        let units =
            (0..self.addresses.len().max(self.eeproms.len())).map(|index| SuprMotr::new(self.config(index)));
        Ok(SuprMotrBus::new(units.collect::<Result<_, _>>()?))
    }

    fn config(&self, index: usize) -> SuprMotrConfig {
        let address = self.addresses.get(index).copied().unwrap_or(Address::FACTORY);
        let mut config = SuprMotrConfig::new(address);
        config.eeprom.parameters.has_echo = self.has_echo;
        let rates = RATES_BPS.iter().zip(0..);
        config.eeprom.parameters.rate =
            rates.filter(|(rate, _)| **rate == self.rate_bps).map(|(_, number)| number).sum();
        if let Some(eeprom) = self.eeproms.get(index) {
            config.eeprom = eeprom.clone();
        }
        config.reply_form = self.reply_form;
        config.is_addressed = self.is_addressed;
        let own = u64::from(config.eeprom.address.get()) + 1;
        config.seed = if self.seed == 0 { 0 } else { self.seed.wrapping_add(own).max(1) };
        if let Some(preset) = self.preset.as_deref().and_then(presets::lookup) {
            config.world = world_of(&preset.axis);
        }
        config
    }
}

/// The form of reports of that name.
///
/// # Errors
/// A clause with all names.
pub fn reply_form(text: &str) -> Result<ReportForm, String> {
    ReportForm::from_key(text).ok_or_else(|| {
        let all = ReportForm::ALL.map(ReportForm::key).join(", ");
        format!("\"{text}\" is no form of a report. There are {all}")
    })
}

/// The rate, if BR knows it.
#[must_use]
pub fn rate(bits_per_second: u32) -> Option<u32> {
    RATES_BPS.contains(&bits_per_second).then_some(bits_per_second)
}

fn no_rate(given: &str) -> String {
    format!("a SuprMotr has 9600, 19200 and 38400 baud, not \"{given}\"")
}

fn switch(key: &str, value: &str, [yes, no]: [&str; 2]) -> Result<bool, String> {
    if value.eq_ignore_ascii_case(yes) {
        Ok(true)
    } else if value.eq_ignore_ascii_case(no) {
        Ok(false)
    } else {
        Err(format!("{key} is {yes} or {no}, not \"{value}\""))
    }
}

fn no_option(given: &str) -> String {
    format!(
        "\"{given}\" is no option of a simulated SuprMotr V9. There are units=0,3,F, reply-form=full, address or id, echo=on or off, \
         addressed=yes or no, baud=9600, 19200 or 38400, preset=NAME and seed=N"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_plant::machine::{Machine, StreamIndex};

    #[test]
    fn both_ways_of_writing_say_the_same() {
        let commas =
            SuprMotrSpec::parse("suprmotr-v9,units=0,3,F,reply-form=id,echo=off,addressed=yes,baud=38400")
                .unwrap();
        let marks = SuprMotrSpec::parse(
            "SuprMotr-V9?address=0&address=3&address=f&reply-form=ID&echo=off&addressed=yes&baud=38400",
        )
        .unwrap();
        assert_eq!(commas, marks);
        let bus = commas.bus().unwrap();
        let addresses: Vec<u8> = bus.suprmotrs().iter().map(|unit| unit.address().get()).collect();
        assert_eq!((addresses, bus.bits_per_second(StreamIndex::Usb)), (vec![0, 3, 15], 38_400));
        assert_eq!(SuprMotrSpec::parse("suprmotr-v9").unwrap(), SuprMotrSpec::default());
        assert!(SuprMotrSpec::is_asked_for("suprmotr-v9,seed=0") && !SuprMotrSpec::is_asked_for("mcp266"));
    }

    #[test]
    fn what_cannot_be_is_told_with_what_can() {
        for (text, clause) in [
            ("suprmotr-v9,units=G", "0 to 9 and A to F"),
            ("suprmotr-v9,units=10", "0 to 9 and A to F"),
            ("suprmotr-v9,units=5,5", "two simulated controllers"),
            ("suprmotr-v9,reply-form=long", "full, address, id"),
            ("suprmotr-v9,echo=yes", "on or off"),
            ("suprmotr-v9,addressed=on", "yes or no"),
            ("suprmotr-v9,baud=115200", "38400"),
            ("suprmotr-v9,preset=none", "There are"),
            ("suprmotr-v9,seed=x", "whole number"),
            ("suprmotr-v9,mode=4", "reply-form"),
            ("suprmotr-v9,1", "reply-form"),
        ] {
            let said = SuprMotrSpec::parse(text).unwrap_err();
            assert!(said.contains(clause), "{text}: {said}");
        }
    }

    #[test]
    fn an_eeprom_makes_the_board_that_it_came_from() {
        let mut eeprom = Eeprom::factory(Address::new(7).unwrap());
        eeprom.parameters.has_echo = false;
        let spec = SuprMotrSpec { eeproms: vec![eeprom], ..SuprMotrSpec::default() };
        let bus = spec.bus().unwrap();
        assert_eq!(bus.suprmotrs()[0].address().get(), 7);
        assert!(!bus.suprmotrs()[0].eeprom().parameters.has_echo);
    }
}
