//! What a power up starts anew, and what follows from the configuration word alone.

use crate::settings::Settings;
use brushwork_mcp_wire::packet_serial::scale;
use brushwork_mcp_wire::roboclaw::{BAUD_RATES, ConfigWord, ControlMode};
use brushwork_values::Motor;
use std::time::Duration;

/// A cell below this is empty.
const EMPTY_CELL_VOLTS: f64 = 3.0;
/// A cell above this is full.
const FULL_CELL_VOLTS: f64 = 4.2;

/// What a power up starts anew.
#[derive(Clone, Debug)]
pub(crate) struct Control {
    /// The configuration word in force.
    pub(super) word: ConfigWord,
    /// S3, S4 and S5.
    pub(super) pins: [Watched; 3],
    /// A momentary emergency stop is pulled.
    pub(super) is_held: bool,
    pub(super) homing: Homing,
    /// S1 and S2.
    pub(super) inputs: [Input; 2],
    /// The main battery at power-up.
    start_volts: f64,
}

/// One pin as it was seen last.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Watched {
    pub(super) is_active: bool,
    /// The motor ran forward when the pin became active.
    pub(super) was_forward: bool,
}

/// How far homing is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Homing {
    /// This motor comes next, if it looks for its switch at all.
    Next(Motor),
    /// It runs forward off its switch.
    Leaving(Motor, Duration),
    /// It runs backward.
    Seeking(Motor),
    /// Nothing more is looked for.
    #[default]
    Done,
}

impl Homing {
    /// As at power-up.
    pub(super) const START: Self = Self::Next(Motor::M1);
}

/// One input.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Input {
    /// The last command, -1 to 1; none before a signal came.
    pub(super) share: Option<f64>,
    pub(super) heard_at: Option<Duration>,
    /// The first pulse, which is taken for the stick at rest.
    pub(super) center_microseconds: Option<f64>,
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
pub(crate) fn follow_rate(settings: &mut Settings) {
    let Some(rate_bps) = ConfigWord(settings.unit.config_word).baud_bps() else { return };
    for stream in settings.streams.iter_mut().skip(1) {
        if BAUD_RATES.contains(&stream.rate_bps) {
            stream.rate_bps = rate_bps;
        }
    }
}
