//! The board with what it drives, as a server and the window drive it: two worlds, motors A and B in one, C and D in the other.

use super::assumed::{ANALOG_FULL_VOLTS, ON_BELOW_VOLTS};
use super::rotor::{Rotor, RotorParams};
use super::unit::Motorvator;
use brushwork_motorvator_wire::host::characters_text;
use brushwork_plant::ParamsError;
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::presets::{Preset, world_of};
use brushwork_plant::world::{PinState, World, WorldAction, WorldView};
use brushwork_script::debug::{Request, View, Wanted};
use std::time::Duration;

/// What the motors and the board take of each other's doing is looked at so often.
const STEP: Duration = Duration::from_millis(1);
/// On/off inputs, which are the first input pins of each world, and the analog inputs behind them. The board has them once: what is put on
/// a pin of one world is put on that of the other, while a switch trips by the motors of its own.
const ON_OFF: usize = 4;
const PINS: usize = ON_OFF + 6;

/// A simulated board with four motors.
#[derive(Clone, Debug)]
pub struct DrivenMotorvator {
    board: Motorvator,
    worlds: [World; 2],
    /// Those of the two steppers, which take the place of two motors each.
    rotors: [Rotor; 2],
    has_power: bool,
    /// How long board and worlds stood still, held by the debugger, while time went on for the line.
    frozen_for: Duration,
    /// The stream that stands for the one wire there is: the one that was last written to.
    wire: StreamIndex,
}

impl DrivenMotorvator {
    /// A board whose four motors drive the same.
    ///
    /// # Errors
    /// A figure of the preset that is out of its range, by name.
    pub fn new(board: Motorvator, preset: &Preset, seed: u64) -> Result<Self, ParamsError> {
        let params = world_of(preset, preset, PINS);
        let second = if seed == 0 { 0 } else { seed.wrapping_add(1).max(1) };
        let worlds = [World::new(&params, seed)?, World::new(&params, second)?];
        let rotors = [Rotor::new(RotorParams::default()); 2];
        Ok(Self {
            board,
            worlds,
            rotors,
            has_power: true,
            frozen_for: Duration::ZERO,
            wire: StreamIndex::Usb,
        })
    }

    /// The board alone.
    #[must_use]
    pub fn board(&self) -> &Motorvator {
        &self.board
    }

    /// The same, to be changed.
    pub fn board_mut(&mut self) -> &mut Motorvator {
        &mut self.board
    }

    /// Steps that each stepper has lost.
    #[must_use]
    pub fn lost_steps(&self) -> [i64; 2] {
        let fields = self.board.steps();
        std::array::from_fn(|index| self.rotors[index].lost(fields[index]))
    }

    /// Asks the debugger of the board's program for things, and looks at it.
    pub fn debug(&mut self, requests: Vec<Request>, wanted: &Wanted) -> View {
        match self.has_power {
            true => self.board.debug(requests, wanted),
            false => self.board.debug_without_power(requests),
        }
    }

    fn step(&mut self, to: Duration) {
        let passed = to.saturating_sub(self.board.now());
        if self.has_power {
            for pin in 0..ON_OFF {
                let is_low =
                    |state: PinState| matches!(state, PinState::Volts(volts) if volts < ON_BELOW_VOLTS);
                let [first, second] = self.worlds.each_mut().map(|world| is_low(world.pin(pin)));
                self.board.set_on_off(pin + 1, first || second);
            }
            for pin in ON_OFF..PINS {
                let volts = match self.worlds[0].pin(pin) {
                    PinState::Volts(volts) => volts,
                    PinState::Open | PinState::Pulse { .. } | PinState::Counts(_) => 0.0,
                };
                // Within a byte.
                let reads = (volts / ANALOG_FULL_VOLTS).clamp(0.0, 1.0) * 255.0;
                self.board.set_analog(pin - ON_OFF + 1, reads.round() as u8);
            }
            self.board.advance(to);
        } else {
            self.board.rest(to);
        }
        let (fields, power) = (self.board.steps(), self.board.stepper_power());
        for ((rotor, field), power) in self.rotors.iter_mut().zip(fields).zip(power) {
            let power = if self.has_power { power } else { 0.0 };
            rotor.advance(field, power, passed.as_secs_f64());
        }
        let motors = self.board.motors();
        let output = |percent: i32| match percent {
            0 => BridgeOutput::Coast,
            percent => BridgeOutput::Duty(f64::from(percent) / 100.0),
        };
        for (world, pair) in self.worlds.iter_mut().zip(motors.chunks_exact(2)) {
            world.advance([output(pair[0]), output(pair[1])], passed.as_secs_f64());
        }
    }
}

impl Machine for DrivenMotorvator {
    fn now(&self) -> Duration {
        self.board.now() + self.frozen_for
    }

    fn receive(&mut self, stream: StreamIndex, bytes: &[u8]) {
        self.wire = stream;
        if self.has_power && self.plugged() {
            self.board.receive(bytes);
        }
    }

    fn advance(&mut self, to: Duration) {
        while self.now() < to {
            if self.has_power && self.board.is_frozen() {
                self.frozen_for += to - self.now();
            } else {
                self.step((self.now() + STEP).min(to) - self.frozen_for);
            }
        }
    }

    fn next_output_at(&self) -> Option<Duration> {
        self.board.next_output_at().map(|at| at + self.frozen_for)
    }

    fn take_output(&mut self, stream: StreamIndex) -> Option<Vec<u8>> {
        if stream == self.wire { self.board.take_output() } else { None }
    }

    fn bits_per_second(&self, _: StreamIndex) -> u32 {
        self.board.bits_per_second()
    }

    fn units(&self) -> usize {
        self.worlds.len()
    }

    /// The board has one supply and one cable: what is done to these in the first world is done to the board.
    fn apply(&mut self, unit: usize, action: &WorldAction) {
        if unit >= self.worlds.len() {
            return;
        }
        let is_of_both = matches!(action, WorldAction::SetPin { .. });
        for (index, world) in self.worlds.iter_mut().enumerate() {
            if index == unit || is_of_both {
                world.apply(action);
            }
        }
        let has_power = self.worlds[0].powered();
        if has_power != self.has_power {
            self.has_power = has_power;
            self.board.power_up();
        }
    }

    fn views(&self) -> Vec<WorldView> {
        let script = self.has_power.then(|| self.board.script_view());
        let display = self.has_power.then(|| characters_text(self.board.display()));
        let view = |world: &World| WorldView {
            script: script.clone(),
            display: display.clone(),
            ..world.view(self.now())
        };
        self.worlds.iter().map(view).collect()
    }

    fn plugged(&self) -> bool {
        self.worlds[0].plugged()
    }
}
