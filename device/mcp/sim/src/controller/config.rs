//! What a simulated controller is made of.

use super::quirks::Quirks;
use crate::motion::ControlLaw;
use crate::settings::{MotorRegisters, Settings, SignalSettings};
use brushwork_canopen::NodeId;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::models::{Family, Model};
use brushwork_mcp_wire::packet_serial::{Address, Generation};
use brushwork_mcp_wire::roboclaw::{ConfigWord, ENCODER_ABSOLUTE};
use brushwork_plant::EncoderKind;
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::presets;
use brushwork_plant::world::WorldParams;

/// Everything that makes one simulated controller and its machine.
#[derive(Clone, Debug)]
pub struct ControllerConfig {
    /// Which board it is.
    pub model: &'static Model,
    /// Which widths and commands its firmware has.
    pub generation: Generation,
    /// Its packet serial address when it leaves the factory.
    pub address: Address,
    /// What it drives and what feeds it. [`WorldParams::pins`] is set to the model's: its input pins, on a RoboClaw its control pins.
    pub world: WorldParams,
    /// The form of its control loops.
    pub law: ControlLaw,
    /// Seed of all noise; 0 for none.
    pub seed: u64,
    /// What its EEPROM holds at first; `None` for factory settings with the inputs set for the encoders that are plugged in.
    pub settings: Option<Settings>,
    /// Details in which firmware versions differ.
    pub options: FirmwareOptions,
    /// What this one unit does otherwise.
    pub quirks: Quirks,
}

/// Details in which firmware versions differ within a generation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FirmwareOptions {
    /// Version number in the reply to command 21, without the "v"; `None` for the one the sources show for the model.
    pub version: Option<String>,
    /// The whole text of that reply without its end mark, where it is not made of the model's title and that number.
    pub text: Option<String>,
    /// Whether commands 0 to 13 are acknowledged. RoboClaw firmware from 4.3.6 on drives and says nothing (public clients,
    /// 2015-2025).
    pub acknowledges_legacy: bool,
}

impl Default for ControllerConfig {
    /// An MCP266 of generation 1 at 0x80 with two small gearmotors, without noise.
    fn default() -> Self {
        let model = models::lookup("mcp266").expect("the model table has it, a test there says so");
        Self::of(model)
    }
}

impl ControllerConfig {
    /// A controller of generation 1 at 0x80 with the default preset on both channels, without noise.
    pub fn of(model: &'static Model) -> Self {
        let axis = presets::lookup(presets::DEFAULT).expect("the default preset is built in");
        Self {
            model,
            generation: Generation::Gen1,
            address: Address::DEFAULT,
            world: presets::world_of(axis, axis, model.wired_pins()),
            law: ControlLaw::default(),
            seed: 0,
            settings: None,
            options: FirmwareOptions::default(),
            quirks: Quirks::default(),
        }
    }
}

impl ControllerConfig {
    /// Makes it another node of a CAN bus than the one it leaves the factory as.
    pub fn set_node(&mut self, node: NodeId) {
        let mut settings = self.stored_settings();
        settings.unit.can_node_id = node.get();
        self.settings = Some(settings);
    }

    /// Sets a stream to another rate than the one it leaves the factory with.
    pub fn set_rate(&mut self, stream: StreamIndex, rate_bps: u32) {
        let mut settings = self.stored_settings();
        settings.streams[stream.index()].rate_bps = rate_bps;
        if self.model.family == Family::RoboClaw {
            let word = ConfigWord(settings.unit.config_word).with_baud_bps(rate_bps);
            settings.unit.config_word = word.0;
        }
        self.settings = Some(settings);
    }

    /// What the EEPROM holds at first.
    pub(super) fn stored_settings(&self) -> Settings {
        let factory = || {
            let mut settings = Settings::factory(self.model, self.address.get());
            for (axis, motor) in self.world.axes.iter().zip(&mut settings.motors) {
                set_input_for(axis.encoder.kind, self.model.family, motor, &mut settings.signals);
            }
            settings
        };
        self.settings.clone().unwrap_or_else(factory)
    }
}

/// Sets a motor's encoder input to the kind of encoder that is plugged in there.
fn set_input_for(
    kind: EncoderKind,
    family: Family,
    motor: &mut MotorRegisters,
    signals: &mut [SignalSettings],
) {
    match (family, signals.get_mut(usize::from(motor.encoder_mode))) {
        (Family::RoboClaw, _) => {
            motor.encoder_mode = if kind == EncoderKind::Quadrature { 0 } else { ENCODER_ABSOLUTE };
        }
        (Family::Mcp, Some(signal)) => {
            signal.kind = match kind {
                EncoderKind::Analog => 1,
                EncoderKind::Pulse => 2,
                EncoderKind::Quadrature => 3,
            };
        }
        (Family::Mcp, None) => {}
    }
}

impl Default for FirmwareOptions {
    fn default() -> Self {
        Self { version: None, text: None, acknowledges_legacy: true }
    }
}

impl FirmwareOptions {
    /// The text of command 21 without its end mark.
    pub(super) fn version_text(&self, model: &Model) -> String {
        self.text.clone().unwrap_or_else(|| format!("{} v{}", model.title, self.version_number(model)))
    }

    /// The number alone, without the "v".
    pub(super) fn version_number(&self, model: &Model) -> &str {
        let shown = match model.family {
            Family::Mcp => "1.0.0",
            Family::RoboClaw => "4.2.8",
        };
        self.version.as_deref().unwrap_or(shown)
    }
}
