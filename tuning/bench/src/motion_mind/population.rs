//! Motors for a Motion Mind: 12 or 24 V, at most 25 A, encoders that give a loop of 5 ms something to count; and how they are wired.

use crate::population::{Draw, Kind, KindRow, Specimen, draw_of, drawn, row};
use brushwork_motion_mind_sim::{Mode, MotionMind, MotionMindConfig, Protocol};
use brushwork_motion_mind_wire::register_number as number;
use brushwork_motion_mind_wire::{Address, Command, encode_frame, encode_line, function2};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::time::Duration;

/// Highest current of the board, A (Motion Mind manual 1.0).
const PEAK_AMPS: f64 = 25.0;
/// One step of number::AMPSLIMIT, A.
const AMPS_STEP: f64 = 0.02;
/// Longer than a write to EEPROM.
const STORE: Duration = Duration::from_millis(100);

const KINDS: [KindRow; 8] = [
    row(Kind::Gearmotor, 12.0, (8e3, 13e3), (30.0, 90.0), 64.0, 6.0, 30.0, 0.2, 0.0, (0.0, 0.0)),
    row(Kind::RoverWheel, 12.0, (3e3, 12e3), (60.0, 250.0), 1632.0, 9.0, 1.0, 0.0, 0.0, (0.0, 0.0)),
    row(Kind::RobotBase, 24.0, (20e3, 80e3), (120.0, 600.0), 4096.0, 15.0, 1.0, 0.0, 0.0, (0.0, 0.0)),
    row(Kind::CorelessServo, 12.0, (60e3, 200e3), (12.0, 40.0), 2000.0, 4.0, 1.0, 0.0, 0.0, (0.0, 0.0)),
    row(Kind::LinearActuator, 12.0, (2e3, 8e3), (20.0, 60.0), 256.0, 6.0, 20.0, 0.0, 0.0, (0.0, 0.0)),
    row(Kind::Flywheel, 24.0, (10e3, 60e3), (700.0, 2500.0), 2048.0, 14.0, 1.0, 0.0, 0.0, (0.0, 0.0)),
    row(Kind::Steering, 12.0, (3e3, 10e3), (40.0, 150.0), 8192.0, 8.0, 50.0, 1.0, 1.0, (3e-4, 2e-3)),
    row(Kind::ArmJoint, 24.0, (10e3, 50e3), (30.0, 120.0), 8192.0, 10.0, 20.0, 1.0, 0.5, (1e-4, 1e-3)),
];

/// How a unit is reached.
#[derive(Clone, Copy, Debug)]
pub struct MindSetup {
    /// Which protocol the unit is set to.
    pub protocol: Protocol,
    /// Bits per second.
    pub bits_per_second: u32,
}

/// A plant under a Motion Mind.
pub type MindSpecimen = Specimen<MindSetup>;

/// Plant `number` of a seed, whatever the size of the population.
#[must_use]
pub fn specimen(seed: u64, number: usize) -> MindSpecimen {
    let fresh = MindSetup { protocol: Protocol::Binary, bits_per_second: 19_200 };
    let mut plant = drawn(&mut draw_of(seed, number, 0), &KINDS, number, |_| fresh);
    plant.current_limit_amps = plant.current_limit_amps.min(PEAK_AMPS);
    let mut draw = Draw(ChaCha8Rng::seed_from_u64(plant.link.seed ^ 0x4D4D));
    let bits_per_second = [19_200, 38_400, 115_200][draw.one_of(3)];
    let is_text = draw.uniform() < 0.15;
    let (protocol, bits_per_second) =
        if is_text { (Protocol::Text, 115_200) } else { (Protocol::Binary, bits_per_second) };
    // What one poll takes, and some rest.
    plant.link.poll_s = match (protocol, bits_per_second) {
        (Protocol::Text, _) => 0.036,
        (Protocol::Binary, 19_200) => plant.link.poll_s.max(0.020),
        (Protocol::Binary, _) => plant.link.poll_s,
    };
    Specimen { unit: MindSetup { protocol, bits_per_second }, ..plant }
}

impl MindSpecimen {
    /// The unit with this motor, as its owner has set it up: baud and number::AMPSLIMIT in EEPROM.
    #[must_use]
    pub fn controller(&self) -> MotionMind {
        self.controller_in(Mode::SerialPid)
    }

    /// The same in another mode.
    #[must_use]
    pub fn controller_in(&self, mode: Mode) -> MotionMind {
        let base = MotionMindConfig::new(mode);
        let world = self.world(&base.world);
        let config = MotionMindConfig { protocol: self.unit.protocol, world, ..base };
        let mut unit = MotionMind::new(config).expect("every drawn figure is in its range");
        let baud = match self.unit.bits_per_second {
            115_200 => function2::BAUD115200,
            38_400 => function2::BAUD38400,
            _ => 0,
        };
        let steps = (self.current_limit_amps / AMPS_STEP).round().clamp(1.0, 1023.0);
        for (register, value) in [(number::FUNCTION2, i64::from(baud)), (number::AMPSLIMIT, steps as i64)] {
            command_unit(&mut unit, &Command::WriteStore { register, value });
            unit.advance(unit.now() + STORE);
            while unit.take_output().is_some() {}
        }
        unit
    }
}

/// Sends a command past any line. Its answer waits to be taken.
pub(crate) fn command_unit(unit: &mut MotionMind, command: &Command) {
    let bytes = match unit.protocol() {
        Protocol::Binary => encode_frame(Address::FACTORY, command),
        Protocol::Text => encode_line(Address::FACTORY, command).map(String::into_bytes),
    };
    unit.receive(&bytes.expect("a command of the manual with values of their width"));
}
