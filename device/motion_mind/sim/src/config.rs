//! What a simulated unit is built from.

use brushwork_motion_mind_wire::{Address, Mode, Protocol};
use brushwork_plant::presets;
use brushwork_plant::world::{BoardSwitches, PinSignal, PinState, World, WorldAction, WorldParams};
use brushwork_plant::{EncoderKind, ParamsError};
use brushwork_values::Motor;

/// The input pins of the unit as the simulated world counts them.
pub mod pin {
    /// ANA_SPEED, BTN_MODE, ANA_CON: J4 P4.
    pub const ANALOG_CONTROL: usize = 0;
    /// ANA_STEP, BTN_STEP, ANA_FBCK: J4 P3.
    pub const ANALOG_FEEDBACK: usize = 1;
    /// POS_LIM, ANA_DIR, BTN_UP: J4 P17.
    pub const POSITIVE_LIMIT: usize = 2;
    /// NEG_LIM, ANA_MODE, BTN_DN: J4 P16.
    pub const NEGATIVE_LIMIT: usize = 3;
    /// _BRAKE: J4 P12.
    pub const BRAKE: usize = 4;
    /// IND/RC: J6 P2.
    pub const INDEX_RC: usize = 5;
    /// How many there are.
    pub const COUNT: usize = 6;
}

/// Which edges of the encoder switch 7 of the board counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum EncoderDecode {
    /// Every edge of both channels.
    #[default]
    Times4,
    /// One edge a line.
    Times1,
}

/// What a simulated unit is built from.
#[derive(Clone, Debug)]
pub struct MotionMindConfig {
    /// What it answers to until a write changes that.
    pub address: Address,
    /// Switches 2 to 4.
    pub mode: Mode,
    /// Switch 6.
    pub protocol: Protocol,
    /// Switch 7.
    pub decode: EncoderDecode,
    /// Switch 5: 19,200 baud, else 9,600. In mode 2 it also chooses the direction.
    pub is_fast: bool,
    /// Register 17.
    pub revision: u8,
    /// Registers that its firmware does not have, by their bits: a read that asks for one of them is not answered.
    pub lacks: u32,
    /// The motor and all around it. Motor 2 is not connected.
    pub world: WorldParams,
    /// What is on the input pins at the start.
    pub signals: Vec<(usize, PinSignal)>,
    /// Seed of the measurement noise; 0 for none.
    pub seed: u64,
}

impl MotionMindConfig {
    /// A unit in a mode, with the default motor of the presets.
    pub fn new(mode: Mode) -> Self {
        let preset = &presets::presets()[0];
        let mut config = Self {
            address: Address::FACTORY,
            mode,
            protocol: Protocol::Binary,
            decode: EncoderDecode::Times4,
            is_fast: true,
            revision: super::assumed::REVISION,
            lacks: 0,
            world: presets::world_of(preset, preset, pin::COUNT),
            signals: Vec::new(),
            seed: 0,
        };
        config.connect_inputs();
        config
    }

    /// Puts on the pins what the mode needs to stand still with: a stick in the middle, a voltage that asks for nothing.
    fn connect_inputs(&mut self) {
        let volts = |volts| PinSignal::Volts { volts };
        self.signals = match self.mode {
            Mode::RadioControl => vec![
                (pin::INDEX_RC, PinSignal::Pulse { microseconds: 1500.0 }),
                (pin::ANALOG_FEEDBACK, volts(5.0)),
            ],
            Mode::Analog => vec![
                (pin::ANALOG_CONTROL, volts(2.5)),
                (pin::ANALOG_FEEDBACK, volts(5.0)),
                (pin::NEGATIVE_LIMIT, volts(0.0)),
            ],
            Mode::Buttons => vec![(pin::ANALOG_CONTROL, volts(5.0)), (pin::ANALOG_FEEDBACK, volts(0.5))],
            Mode::AnalogPid => vec![(pin::ANALOG_FEEDBACK, PinSignal::Encoder { motor: Motor::M1 })],
            Mode::Serial | Mode::SerialPid | Mode::FactoryRestore | Mode::FactoryTest => Vec::new(),
        };
    }

    /// How the switches of the board stand.
    fn switches(&self) -> BoardSwitches {
        BoardSwitches {
            mode: self.mode.number(),
            is_fast: self.is_fast,
            is_text: self.protocol == Protocol::Text,
            counts_lines: self.decode == EncoderDecode::Times1,
        }
    }

    /// Takes over how the switches stand, as the unit does at power-up.
    pub(super) fn read_switches(&mut self, switches: BoardSwitches) {
        self.mode = Mode::ALL[usize::from(switches.mode & 7)];
        self.protocol = if switches.is_text { Protocol::Text } else { Protocol::Binary };
        self.is_fast = switches.is_fast;
        self.decode = if switches.counts_lines { EncoderDecode::Times1 } else { EncoderDecode::Times4 };
    }

    /// The world that the unit stands in.
    ///
    /// # Errors
    /// A figure of the motor that is out of its range, by name.
    pub(super) fn world(&self) -> Result<World, ParamsError> {
        let mut world = World::new(&self.world, self.seed)?.with_board_switches(self.switches());
        world.apply(&WorldAction::OpenLead { motor: Motor::M2, on: true });
        // An absolute encoder that gives pulses is wired as the manual's figure 16C has it.
        let is_pulse_encoder = self.world.axes[0].encoder.kind == EncoderKind::Pulse;
        let encoder = PinSignal::Encoder { motor: Motor::M1 };
        let pulses = (self.mode == Mode::SerialPid && is_pulse_encoder).then_some((pin::INDEX_RC, encoder));
        for (pin, signal) in pulses.iter().chain(&self.signals) {
            world.apply(&WorldAction::SetPin { pin: *pin, signal: *signal });
        }
        // A stick that asks for where the potentiometer of mode 5 stands already.
        let is_asked = self.signals.iter().any(|(pin, _)| *pin == pin::ANALOG_CONTROL);
        if let (Mode::AnalogPid, false, PinState::Volts(volts)) =
            (self.mode, is_asked, world.pin(pin::ANALOG_FEEDBACK))
        {
            world
                .apply(&WorldAction::SetPin { pin: pin::ANALOG_CONTROL, signal: PinSignal::Volts { volts } });
        }
        Ok(world)
    }
}
