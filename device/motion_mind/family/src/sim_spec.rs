//! What simulated Motion Minds to make: the text behind `sim:motion-mind-3`, and the arguments of `brushwork sim`.
//!
//! `motion-mind-3,mode=4,protocol=ascii,address=1,address=2,preset=NAME,baud=9600,encoder=1x,revision=5,seed=N`; `?` and `&` may stand for
//! the commas, and one address option may name several units: `motion-mind-3?mode=4&address=1,2`.

use brushwork_family::spec::{self, seed};
use brushwork_motion_mind_sim::{EncoderDecode, MotionMind, MotionMindBus, MotionMindConfig, assumed, pin};
use brushwork_motion_mind_wire::{Address, Mode, Protocol};
use brushwork_plant::ParamsError;
use brushwork_plant::presets;

pub use brushwork_family::spec::preset;

/// The name of the model.
pub const MODEL: &str = "motion-mind-3";

/// The motor of mode 5: one whose potentiometer is the feedback that the mode is made for.
const ABSOLUTE: &str = "linear-actuator";

/// One line with one or more simulated Motion Minds.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionMindSpec {
    /// Addresses, one unit each.
    pub addresses: Vec<Address>,
    /// Switches 2 to 4.
    pub mode: Mode,
    /// Switch 6.
    pub protocol: Protocol,
    /// Switch 5: 19,200 baud, else 9,600, which in mode 2 is the direction too.
    pub is_fast: bool,
    /// Switch 7.
    pub decode: EncoderDecode,
    /// The firmware, as register 17 tells it.
    pub revision: u8,
    /// Registers that its firmware does not have, by their bits.
    pub lacks: u32,
    /// The motor; if none is named that of the first preset, or in mode 5 one with a potentiometer.
    pub preset: Option<String>,
    /// Seed of the measurement noise; 0 for none.
    pub seed: u64,
}

impl Default for MotionMindSpec {
    fn default() -> Self {
        Self {
            addresses: vec![Address::FACTORY],
            mode: Mode::SerialPid,
            protocol: Protocol::Binary,
            is_fast: true,
            decode: EncoderDecode::Times4,
            revision: assumed::REVISION,
            lacks: 0,
            preset: None,
            seed: 1,
        }
    }
}

impl MotionMindSpec {
    /// Whether the text behind `sim:` asks for Motion Minds.
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
        for (key, value) in spec::options(text, &["address"]).map_err(no_option)? {
            spec.set(key, value)?;
        }
        if spec.addresses.is_empty() {
            spec.addresses.push(Address::FACTORY);
        }
        Ok(spec)
    }

    fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        match key {
            "mode" => {
                self.mode = value
                    .parse()
                    .ok()
                    .and_then(Mode::from_number)
                    .ok_or_else(|| format!("\"{value}\" is no mode of a Motion Mind 3. Use 0 to 7"))?;
            }
            "protocol" => {
                self.protocol = Protocol::from_key(value).ok_or_else(|| {
                    format!("\"{value}\" is no protocol of a Motion Mind 3. Use binary or ascii")
                })?;
            }
            "baud" => {
                self.is_fast = match value {
                    "19200" => true,
                    "9600" => false,
                    _ => return Err(format!("switch 5 is for 9600 or 19200 baud, not for \"{value}\"")),
                };
            }
            "encoder" => self.decode = decode(value)?,
            "revision" => {
                self.revision = value
                    .parse()
                    .map_err(|_| format!("\"{value}\" is no firmware revision. Use 0 to 255"))?;
            }
            "address" => self.add_address(value)?,
            "preset" => self.preset = Some(preset(value)?),
            "seed" => self.seed = seed(value)?,
            _ => return Err(no_option(key)),
        }
        Ok(())
    }

    fn add_address(&mut self, text: &str) -> Result<(), String> {
        let address = text.parse().ok().and_then(Address::unit).filter(|address| address.get() > 0);
        let address =
            address.ok_or_else(|| format!("\"{text}\" is no address of a Motion Mind 3. Use 1 to 98"))?;
        spec::add(&mut self.addresses, address, address.get())
    }

    /// The units on one wire.
    ///
    /// # Errors
    /// Figures of a preset that make no sense.
    pub fn bus(&self) -> Result<MotionMindBus, ParamsError> {
        let units = self.addresses.iter().map(|address| MotionMind::new(self.config(*address)));
        Ok(MotionMindBus::new(units.collect::<Result<_, _>>()?))
    }

    fn config(&self, address: Address) -> MotionMindConfig {
        let mut config = MotionMindConfig {
            address,
            protocol: self.protocol,
            is_fast: self.is_fast,
            decode: self.decode,
            revision: self.revision,
            lacks: self.lacks,
            ..MotionMindConfig::new(self.mode)
        };
        config.seed = if self.seed == 0 { 0 } else { self.seed.wrapping_add(address.get().into()).max(1) };
        // Mode 5 closes its loop over a voltage, which the encoder of the other modes does not give.
        let of_mode = (self.mode == Mode::AnalogPid).then_some(ABSOLUTE);
        if let Some(preset) = self.preset.as_deref().or(of_mode).and_then(presets::lookup) {
            config.world = presets::world_of(preset, preset, pin::COUNT);
        }
        config
    }
}

/// Which edges of the encoder switch 7 lets count.
///
/// # Errors
/// A clause with what there is.
pub fn decode(text: &str) -> Result<EncoderDecode, String> {
    match text {
        "4x" => Ok(EncoderDecode::Times4),
        "1x" => Ok(EncoderDecode::Times1),
        _ => Err(format!("switch 7 is for 1x or 4x, not for \"{text}\"")),
    }
}

fn no_option(given: &str) -> String {
    format!(
        "\"{given}\" is no option of a simulated Motion Mind 3. There are mode=0..7, protocol=binary or ascii, address=1..98, preset=NAME, \
         baud=9600 or 19200, encoder=1x or 4x, revision=N and seed=N"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(spec: &MotionMindSpec) -> Vec<u8> {
        spec.addresses.iter().map(|address| address.get()).collect()
    }

    #[test]
    fn both_ways_of_writing_say_the_same() {
        let commas =
            MotionMindSpec::parse("motion-mind-3,mode=3,protocol=ascii,address=1,address=2").unwrap();
        let marks = MotionMindSpec::parse("motion-mind-3?mode=3&protocol=ascii&address=1,2").unwrap();
        assert_eq!(commas, marks);
        assert_eq!(
            (commas.mode, commas.protocol, numbers(&commas)),
            (Mode::Serial, Protocol::Text, vec![1, 2])
        );
        let switched = MotionMindSpec::parse("motion-mind-3,baud=9600,encoder=1x,revision=5").unwrap();
        assert_eq!((switched.is_fast, switched.decode, switched.revision), (false, EncoderDecode::Times1, 5));
        let plain = MotionMindSpec::parse("Motion-Mind-3").unwrap();
        assert_eq!(plain, MotionMindSpec::default());
        assert!(
            MotionMindSpec::is_asked_for("motion-mind-3?mode=3") && !MotionMindSpec::is_asked_for("mcp266")
        );
    }

    #[test]
    fn what_cannot_be_is_told_with_what_can() {
        for (text, clause) in [
            ("motion-mind-3,mode=8", "0 to 7"),
            ("motion-mind-3,protocol=can", "binary or ascii"),
            ("motion-mind-3,address=99", "1 to 98"),
            ("motion-mind-3,address=0", "1 to 98"),
            ("motion-mind-3,address=5,5", "two simulated controllers"),
            ("motion-mind-3,preset=none", "There are"),
            ("motion-mind-3,baud=38400", "9600 or 19200"),
            ("motion-mind-3,encoder=2x", "1x or 4x"),
            ("motion-mind-3,revision=A", "0 to 255"),
            ("motion-mind-3,generation=1", "mode=0..7"),
            ("motion-mind-3,1", "mode=0..7"),
        ] {
            let said = MotionMindSpec::parse(text).unwrap_err();
            assert!(said.contains(clause), "{text}: {said}");
        }
    }
}
