//! Motors for a SuprMotr: 12 V, about an ampere with the shaft held, encoders on the motor or behind a gear; and how fast the line is.

use crate::population::{Draw, Kind, KindRow, Specimen, draw_of, drawn, row};
use brushwork_plant::SupplyParams;
use brushwork_plant::world::WorldParams;
use brushwork_suprmotr_sim::{Eeprom, SuprMotr, SuprMotrConfig};
use brushwork_suprmotr_wire::Address;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

const KINDS: [KindRow; 6] = [
    row(Kind::Gearmotor, 12.0, (8e3, 13e3), (30.0, 90.0), 64.0, 0.9, 30.0, 0.2, 0.0, (0.0, 0.0)),
    row(Kind::RoverWheel, 12.0, (3e3, 12e3), (60.0, 250.0), 1632.0, 0.9, 1.0, 0.0, 0.0, (0.0, 0.0)),
    row(Kind::CorelessServo, 12.0, (60e3, 200e3), (8.0, 40.0), 2000.0, 0.8, 1.0, 0.0, 0.0, (0.0, 0.0)),
    row(Kind::LinearActuator, 12.0, (2e3, 8e3), (20.0, 60.0), 256.0, 0.8, 20.0, 0.0, 0.0, (0.0, 0.0)),
    row(Kind::Turntable, 12.0, (10e3, 40e3), (120.0, 400.0), 4096.0, 1.0, 1.0, 0.0, 0.0, (0.0, 0.0)),
    row(Kind::ArmJoint, 12.0, (10e3, 50e3), (30.0, 120.0), 8192.0, 1.0, 20.0, 1.0, 0.5, (1e-4, 1e-3)),
];

/// How a board is reached.
#[derive(Clone, Copy, Debug)]
pub struct BoardSetup {
    /// BR: 0 to 2.
    pub rate: i32,
}

impl BoardSetup {
    /// Bits per second.
    #[must_use]
    pub fn bits_per_second(self) -> u32 {
        9_600 << self.rate
    }
}

/// A plant under a SuprMotr.
pub type BoardSpecimen = Specimen<BoardSetup>;

/// Plant `number` of a seed, whatever the size of the population. Half of the lines are as they leave the factory.
#[must_use]
pub fn specimen(seed: u64, number: usize) -> BoardSpecimen {
    let plant = drawn(&mut draw_of(seed, number, 0x5355), &KINDS, number, |_| BoardSetup { rate: 0 });
    let mut draw = Draw(ChaCha8Rng::seed_from_u64(plant.link.seed ^ 0x5355));
    let rate = [0, 0, 1, 2][draw.one_of(4)];
    Specimen { unit: BoardSetup { rate }, ..plant }
}

impl BoardSpecimen {
    /// The board with this motor, as it leaves the factory but for its rate.
    #[must_use]
    pub fn controller(&self) -> SuprMotr {
        let base = SuprMotrConfig::new(Address::FACTORY);
        let world = self.world(&base.world);
        let supply = SupplyParams { logic_volts: base.world.supply.logic_volts, ..self.supply };
        let mut eeprom = Eeprom::factory(Address::FACTORY);
        eeprom.parameters.rate = self.unit.rate;
        let config = SuprMotrConfig { eeprom, world: WorldParams { supply, ..world }, ..base };
        SuprMotr::new(config).expect("every drawn figure is in its range")
    }
}

/// Has lines carried out past any line.
pub(crate) fn command_unit(unit: &mut SuprMotr, line: &str) {
    unit.receive(format!("\x010{line}\r").as_bytes());
    while unit.take_output().is_some() {}
}
