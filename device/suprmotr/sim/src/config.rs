//! What a simulated board is built from, and the slide that it drives if nothing else is said.

use super::store::Eeprom;
use brushwork_plant::world::{
    CanPeer, PinSignal, SwitchKind, SwitchWiring, Wiring, World, WorldAction, WorldParams,
};
use brushwork_plant::{
    AxisParams, BoardParams, Datasheet, EncoderKind, EncoderParams, GearParams, ParamsError, ShaftSide,
    StopKind, SupplyParams, TravelParams,
};
use brushwork_suprmotr_wire::{Address, ReportForm};
use brushwork_values::Motor;

/// The input pins of the board as the simulated world counts them.
pub mod pin {
    /// Negative limit: J4 pin 7.
    pub const NEGATIVE_LIMIT: usize = 0;
    /// Index or reference: J4 pin 8.
    pub const REFERENCE: usize = 1;
    /// Positive limit: J4 pin 9.
    pub const POSITIVE_LIMIT: usize = 2;
    /// I/O channel 1; the other 15 follow it. Channels 11 to 16 are the analog inputs 3 to 8.
    pub const CHANNEL_1: usize = 3;
    /// Analog input 1: J1 pin 3.
    pub const ANALOG_1: usize = CHANNEL_1 + super::CHANNELS;
    /// Analog input 2: J2 pin 1.
    pub const ANALOG_2: usize = ANALOG_1 + 1;
    /// How many there are.
    pub const COUNT: usize = ANALOG_2 + 1;
}

/// Digital channels.
pub const CHANNELS: usize = 16;

/// What a simulated board is built from.
#[derive(Clone, Debug)]
pub struct SuprMotrConfig {
    /// What its EEPROM holds when it is switched on for the first time: its address among it.
    pub eeprom: Eeprom,
    /// How it writes reports.
    pub reply_form: ReportForm,
    /// Whether it is selected after a start, with its notice; the manual says both.
    pub is_addressed: bool,
    /// Whether channels 14 to 16 are its address at a start, as the manual says that they once were; else the EEPROM has it.
    pub has_address_pins: bool,
    /// The motor and all around it. Motor 2 is not connected.
    pub world: WorldParams,
    /// What is on the input pins at the start.
    pub signals: Vec<(usize, PinSignal)>,
    /// Seed of the measurement noise; 0 for none.
    pub seed: u64,
}

impl SuprMotrConfig {
    /// A board as it comes from the factory, with an address, on the [`slide`].
    pub fn new(address: Address) -> Self {
        Self {
            eeprom: Eeprom::factory(address),
            reply_form: ReportForm::default(),
            is_addressed: false,
            has_address_pins: false,
            world: slide(),
            signals: Vec::new(),
            seed: 0,
        }
    }

    /// The world that the board stands in.
    ///
    /// # Errors
    /// A figure of the motor that is out of its range, by name.
    pub(super) fn world(&self) -> Result<World, ParamsError> {
        let mut world = World::new(&self.world, self.seed)?;
        world.apply(&WorldAction::OpenLead { motor: Motor::M2, on: true });
        for (pin, signal) in &self.signals {
            world.apply(&WorldAction::SetPin { pin: *pin, signal: *signal });
        }
        Ok(world)
    }
}

/// Where things are on the [`slide`], in encoder counts from the start.
pub mod place {
    /// The negative limit switch closes at and below this.
    pub const NEGATIVE_LIMIT_COUNTS: i64 = -60_000;
    /// The reference switch is closed at and below this.
    pub const REFERENCE_COUNTS: i64 = 30_000;
    /// The positive limit switch closes at and above this.
    pub const POSITIVE_LIMIT_COUNTS: i64 = 90_000;
    /// The carriage meets the ends this far behind the switches.
    pub const BEHIND_SWITCH_COUNTS: i64 = 5_000;
}

/// Counts for one turn of the slide's motor.
const COUNTS_PER_TURN: f64 = 2_000.0;

fn radians(counts: i64) -> f64 {
    // Half a count further: the edges of the encoder stand there.
    (counts as f64 - 0.5) / COUNTS_PER_TURN * std::f64::consts::TAU
}

/// A carriage on a screw: 25,000 counts free on each side of where it starts and more, limit switches before both ends, and a reference switch
/// between them. Its motor of 12 V reaches about 100,000 counts/s.
pub fn slide() -> WorldParams {
    let motor = Datasheet {
        volts: SUPPLY_VOLTS,
        no_load_radians_per_second: 314.0,
        stall_amps: 1.6,
        mechanical_time_constant_s: 0.008,
        electrical_time_constant_s: 0.000_6,
        coulomb_share: 0.04,
        stiction_ratio: 1.2,
        viscous_share: 0.02,
        load_share: 0.3,
    };
    let encoder = EncoderParams {
        kind: EncoderKind::Quadrature,
        counts_per_turn: COUNTS_PER_TURN,
        side: ShaftSide::Motor,
        start_counts: 0.0,
        wraps: false,
        noise_counts: 0.0,
    };
    let mut axis = motor.axis(GearParams::default(), encoder);
    axis.load.travel = Some(TravelParams {
        lower_radians: radians(place::NEGATIVE_LIMIT_COUNTS - place::BEHIND_SWITCH_COUNTS),
        upper_radians: radians(place::POSITIVE_LIMIT_COUNTS + place::BEHIND_SWITCH_COUNTS),
        stop: StopKind::Hard,
    });
    WorldParams {
        axes: [axis.clone(), axis],
        supply: supply(),
        board: BoardParams::default(),
        wiring: wiring(),
        i2c: Vec::new(),
        can_peer: CanPeer::default(),
        pins: pin::COUNT,
    }
}

/// Any axis on the board's supply, without switches.
pub fn world_of(axis: &AxisParams) -> WorldParams {
    WorldParams { axes: [axis.clone(), axis.clone()], wiring: Wiring::default(), ..slide() }
}

/// The board takes 9 to 12 V.
const SUPPLY_VOLTS: f64 = 12.0;

fn supply() -> SupplyParams {
    SupplyParams {
        open_circuit_volts: SUPPLY_VOLTS,
        breakdown_volts: 30.0,
        logic_volts: 0.0,
        ..SupplyParams::default()
    }
}

fn wiring() -> Wiring {
    let switch = |switch, pin, counts| SwitchWiring {
        motor: Motor::M1,
        switch,
        pin,
        trips_at_radians: Some(radians(counts)),
    };
    Wiring {
        estop_pin: None,
        switches: vec![
            // One that closes at and below a place is passed when the count after it is reached.
            switch(SwitchKind::Backward, pin::NEGATIVE_LIMIT, place::NEGATIVE_LIMIT_COUNTS + 1),
            switch(SwitchKind::Forward, pin::POSITIVE_LIMIT, place::POSITIVE_LIMIT_COUNTS),
            switch(SwitchKind::Home, pin::REFERENCE, place::REFERENCE_COUNTS + 1),
        ],
    }
}
