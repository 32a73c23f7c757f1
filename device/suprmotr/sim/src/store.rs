//! What the board keeps: parameters in RAM and in EEPROM, macros and the address in EEPROM alone (SuprMotr manual, commands UD, DB, MD, RM).

use super::assumed::{BYTES_PER_COMMAND, MACRO_STORAGE};
use brushwork_suprmotr_wire::{Address, Command, LAST_MACRO, Line, Radix, parse_line};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What UD stores.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parameters {
    /// DV, in counts per second.
    pub velocity: i32,
    /// DA, in counts per second squared.
    pub acceleration: i32,
    /// DP.
    pub proportional: i32,
    /// DI.
    pub integral: i32,
    /// DD.
    pub derivative: i32,
    /// DL.
    pub integral_limit: i32,
    /// SM, in counts.
    pub most_error: i32,
    /// SQ.
    pub torque: i32,
    /// SJ.
    pub jog: i32,
    /// BR: 0 to 2.
    pub rate: i32,
    /// EN and EF.
    pub has_echo: bool,
    /// LN and LF.
    pub has_limits: bool,
    /// LH and LL.
    pub is_active_high: bool,
    /// PH.
    pub is_phase_reversed: bool,
}

impl Default for Parameters {
    /// As the board leaves the factory (SuprMotr manual, "Factory Settings").
    fn default() -> Self {
        Self {
            velocity: 20_000,
            acceleration: 200_000,
            proportional: 75,
            integral: 0,
            derivative: 0,
            integral_limit: 100,
            most_error: 10_000,
            torque: 255,
            jog: 0,
            rate: 0,
            has_echo: true,
            has_limits: true,
            is_active_high: false,
            is_phase_reversed: false,
        }
    }
}

/// What outlives the power.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Image", into = "Image")]
pub struct Eeprom {
    /// DB.
    pub address: Address,
    /// What UD stored last.
    pub parameters: Parameters,
    macros: [Vec<Command>; MACROS],
}

const MACROS: usize = LAST_MACRO as usize + 1;

/// How the EEPROM is written to a file.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Image {
    address: Address,
    parameters: Parameters,
    /// By number, as lines.
    macros: BTreeMap<u8, String>,
}

/// The text is no image of an EEPROM.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ImageError {
    /// It is no JSON, or has other fields.
    #[error("{0}")]
    Form(String),
    /// A macro has a number that there is none of.
    #[error("there is no macro {0}: they are 0 to {LAST_MACRO}")]
    Number(u8),
    /// A macro's line is refused.
    #[error("macro {number}: {error}")]
    Macro {
        /// The macro.
        number: u8,
        /// What is wrong with it.
        error: String,
    },
}

impl Eeprom {
    /// As the board leaves the factory, but for the address.
    pub fn factory(address: Address) -> Self {
        Self { address, parameters: Parameters::default(), macros: Default::default() }
    }

    /// The content of one board or of several, as [`Eeprom::text_of`] writes it.
    ///
    /// # Errors
    /// A clause that says what is wrong with it.
    pub fn all_in(text: &str) -> Result<Vec<Self>, ImageError> {
        serde_json::from_str(text).map_err(|error| ImageError::Form(error.to_string()))
    }

    /// The content of one board or of several as JSON.
    pub fn text_of<'a>(eeproms: impl IntoIterator<Item = &'a Self>) -> String {
        let all: Vec<&Self> = eeproms.into_iter().collect();
        serde_json::to_string_pretty(&all).unwrap_or_default() + "\n"
    }

    /// The commands of a macro; none where there is no such macro.
    pub fn macro_of(&self, number: u8) -> &[Command] {
        self.macros.get(usize::from(number)).map_or(&[], Vec::as_slice)
    }

    /// The macros that there are, each with its number.
    pub fn macros(&self) -> impl Iterator<Item = (u8, &[Command])> {
        (0..=LAST_MACRO)
            .map(|number| (number, self.macro_of(number)))
            .filter(|(_, commands)| !commands.is_empty())
    }

    /// Puts a macro in the place of an older one; whether there was room.
    pub fn define(&mut self, number: u8, commands: Vec<Command>) -> bool {
        let others = self.macros().filter(|(other, _)| *other != number);
        let used: usize = others.map(|(_, commands)| commands.len()).sum();
        let fits = (used + commands.len()) * BYTES_PER_COMMAND <= MACRO_STORAGE;
        match self.macros.get_mut(usize::from(number)) {
            Some(place) if fits => *place = commands,
            Some(_) | None => return false,
        }
        true
    }

    /// Erases a macro, or all of them.
    pub fn erase(&mut self, number: Option<u8>) {
        match number {
            Some(number) => {
                if let Some(place) = self.macros.get_mut(usize::from(number)) {
                    place.clear();
                }
            }
            None => self.macros = Default::default(),
        }
    }
}

impl From<Eeprom> for Image {
    fn from(eeprom: Eeprom) -> Self {
        let line =
            |commands: &[Command]| Line { defines: None, commands: commands.to_vec() }.text(Radix::Decimal);
        let macros = eeprom.macros().map(|(number, commands)| (number, line(commands))).collect();
        Self { address: eeprom.address, parameters: eeprom.parameters, macros }
    }
}

impl TryFrom<Image> for Eeprom {
    type Error = ImageError;

    fn try_from(image: Image) -> Result<Self, ImageError> {
        let mut eeprom = Self { parameters: image.parameters, ..Self::factory(image.address) };
        for (number, text) in image.macros {
            let parsed = parse_line(text.as_bytes(), Radix::Decimal);
            let wrong = |error: String| ImageError::Macro { number, error };
            if let Some(error) = parsed.error {
                return Err(wrong(error.to_string()));
            }
            if parsed.line.defines.is_some() {
                return Err(wrong("a macro defines none".to_owned()));
            }
            let place = eeprom.macros.get_mut(usize::from(number)).ok_or(ImageError::Number(number))?;
            *place = parsed.line.commands;
        }
        Ok(eeprom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_suprmotr_wire::Mnemonic;

    #[test]
    fn an_image_comes_back_as_it_was() {
        let mut eeprom = Eeprom::factory(Address::new(15).expect("there are 16"));
        eeprom.parameters.velocity = 12_345;
        let calls = vec![
            Command::with(Mnemonic::MR, -500),
            Command::plain(Mnemonic::WS),
            Command::plain(Mnemonic::RP),
        ];
        assert!(eeprom.define(14, calls));
        let other = Eeprom::factory(Address::FACTORY);
        let text = Eeprom::text_of([&eeprom, &other]);
        assert!(text.contains("\"14\": \"MR-500,WS,RP\""), "{text}");
        assert_eq!(Eeprom::all_in(&text), Ok(vec![eeprom, other]));
    }

    #[test]
    fn what_is_no_image_is_told_with_its_fault() {
        let text = Eeprom::text_of([&Eeprom::factory(Address::FACTORY)]);
        for (from, to, clause) in [
            ("\"macros\": {}", "\"macros\": {\"15\": \"MR1\"}", "no macro 15"),
            ("\"macros\": {}", "\"macros\": {\"1\": \"MR1,QQ\"}", "macro 1: character 5"),
            ("\"macros\": {}", "\"macros\": {\"1\": \"MD2,MR1\"}", "defines none"),
            ("\"address\": 0", "\"address\": 16", "no address"),
            ("velocity", "speed", "speed"),
        ] {
            let said = Eeprom::all_in(&text.replacen(from, to, 1)).expect_err(to).to_string();
            assert!(said.contains(clause), "{to}: {said}");
        }
    }

    #[test]
    fn a_macro_takes_the_place_of_an_older_one_and_all_can_go() {
        let mut eeprom = Eeprom::factory(Address::FACTORY);
        let of = |number| vec![Command::with(Mnemonic::MR, number)];
        for number in 0..=LAST_MACRO {
            assert!(eeprom.define(number, of(i32::from(number))));
        }
        assert!(eeprom.define(3, of(99)));
        assert_eq!(eeprom.macro_of(3), of(99));
        assert!(!eeprom.define(15, of(1)), "there are 15");
        eeprom.erase(Some(3));
        assert_eq!((eeprom.macros().count(), eeprom.macro_of(3).len()), (14, 0));
        eeprom.erase(None);
        assert_eq!(eeprom.macros().count(), 0);
    }
}
