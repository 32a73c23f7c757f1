//! What is known of a unit whose motors do not run: status, settings, pins, measurements.

use crate::diagnosis::pin_end::PinEnd;
use brushwork_link::device::{Channel, Identity, StatusReport};
use brushwork_link::settings::SettingsImage;
use brushwork_link::transport::Stream;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::models::Model;

/// What is known of a unit. The more of it is there, the more can be found; what is missing is not guessed.
#[derive(Clone, Copy, Debug, Default)]
pub struct Evidence<'a> {
    /// What the unit reports; nothing before it was read.
    pub status: Option<&'a StatusReport>,
    /// The model, for the names of its pins.
    pub model: Option<&'static Model>,
    /// The settings in the controller's RAM.
    pub settings: Option<&'a SettingsImage>,
    /// Where each input pin stands within its range (command 147).
    pub pins: Option<&'a [PinEnd]>,
    /// Which of the controller's streams is spoken to.
    pub stream: Option<Stream>,
    /// What was measured.
    pub measured: Measured,
    /// What is known of its script.
    pub script: Script,
}

/// Measured values that make a sentence exact; `None` for what was not read.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// Main battery.
    pub main_volts: Option<f64>,
    /// Logic battery.
    pub logic_volts: Option<f64>,
    /// Both temperatures.
    pub celsius: [Option<f64>; 2],
    /// Both motor currents.
    pub amps: [Option<f64>; 2],
}

/// What is known of the unit's script. No command of the protocol tells whether one runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Script {
    /// Nothing.
    #[default]
    NotKnown,
    /// It was started over this link.
    Started,
    /// It was stopped over this link.
    Stopped,
}

impl<'a> Evidence<'a> {
    /// What a unit's status says, without settings and pins.
    #[must_use]
    pub fn of(report: &'a StatusReport, identity: &Identity) -> Self {
        let model = identity.model.and_then(models::lookup);
        let model = model.or_else(|| models::identify(&identity.version_text));
        Self { status: Some(report), model, ..Self::default() }
    }

    /// The number of an input pin and its name: "pin 7 (DIN7/AN7/P7/ENC1A)".
    pub(super) fn pin_name(&self, index: usize) -> String {
        let named = self.model.and_then(|model| model.pins.get(index));
        named.map_or_else(|| format!("pin {}", index + 1), |pin| format!("pin {}", pin.name()))
    }
}

impl Measured {
    /// From the newest readings of a unit's channels.
    pub fn of(read: impl Fn(Channel) -> Option<f64>) -> Self {
        Self {
            main_volts: read(Channel::MAIN_BATTERY),
            logic_volts: read(Channel::LOGIC_BATTERY),
            celsius: [Channel::TEMPERATURE_1, Channel::TEMPERATURE_2].map(&read),
            amps: [Channel::M1_CURRENT, Channel::M2_CURRENT].map(&read),
        }
    }
}
