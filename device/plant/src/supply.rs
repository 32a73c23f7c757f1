//! The main supply: a battery or a power supply behind its resistance, the board's link capacitors, and a brake resistor.
//!
//! The link voltage over a step is solved together with the currents of both motors (implicitly, since each depends on the
//! other), so that no pairing of motor, battery and capacitor makes it unstable. A supply that cannot sink takes no current back:
//! what the motors regenerate then stays on the capacitors and lifts the voltage until the motors slow or a resistor eats it
//! (MCP manual 1.7).

use super::params::{ParamsError, above_zero, not_negative};
use serde::{Deserialize, Serialize};

/// What feeds the board.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SupplyParams {
    /// Main voltage without load.
    pub open_circuit_volts: f64,
    /// Resistance of battery and leads.
    pub internal_ohms: f64,
    /// Whether it takes current back: a battery does, most power supplies do not.
    pub can_sink: bool,
    /// Link capacitance on the board.
    pub capacitance_farads: f64,
    /// Voltage the link never exceeds, since the bridges' transistors break down and eat what comes in. A real board does not
    /// survive that for long; this one does.
    pub breakdown_volts: f64,
    /// What discharges the capacitors when nothing feeds them.
    pub bleed_ohms: f64,
    /// A resistor that a digital output can switch across the link.
    pub brake_resistor: Option<BrakeResistorParams>,
    /// Logic supply; 0 where none is connected.
    pub logic_volts: f64,
}

/// A brake resistor and the output that switches it (MCP manual 1.7.2).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BrakeResistorParams {
    /// Its resistance.
    pub ohms: f64,
    /// The digital output it hangs on: 0 is DOUT1.
    pub dout: usize,
}

impl Default for SupplyParams {
    /// A 24 V battery on a board for 60 V. Assumed: 2.2 mF of link capacitors, transistors for 100 V.
    fn default() -> Self {
        Self {
            open_circuit_volts: 24.0,
            internal_ohms: 0.05,
            can_sink: true,
            capacitance_farads: 2.2e-3,
            breakdown_volts: 100.0,
            bleed_ohms: 2000.0,
            brake_resistor: None,
            logic_volts: 12.0,
        }
    }
}

impl SupplyParams {
    /// Checks every figure; zero capacitance, resistance or bleeder is taken as very little.
    pub fn validate(&self) -> Result<(), ParamsError> {
        not_negative("supply.open_circuit_volts", self.open_circuit_volts)?;
        not_negative("supply.internal_ohms", self.internal_ohms)?;
        not_negative("supply.capacitance_farads", self.capacitance_farads)?;
        above_zero("supply.breakdown_volts", self.breakdown_volts)?;
        not_negative("supply.bleed_ohms", self.bleed_ohms)?;
        not_negative("supply.logic_volts", self.logic_volts)?;
        self.brake_resistor
            .map_or(Ok(()), |resistor| not_negative("supply.brake_resistor.ohms", resistor.ohms))
    }
}

/// What a digital output does to the brake resistor on it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ClampDrive {
    /// Open.
    #[default]
    Off,
    /// Closed.
    On,
    /// Closed while the link voltage is high. Assumed: this acts faster than the control tick, so the plant itself switches it.
    Above {
        /// Closes above this.
        on_volts: f64,
        /// Opens below this.
        off_volts: f64,
    },
}

/// The main supply and the link, as they are now.
#[derive(Clone, Debug)]
pub struct Supply {
    /// Figures that a person may change at any time.
    pub params: SupplyParams,
    /// Whether the main battery is connected.
    pub connected: bool,
    /// What the output with the brake resistor does.
    pub clamp: ClampDrive,
    bus_volts: f64,
    battery_amps: f64,
    clamp_closed: bool,
    regenerated_joules: f64,
}

impl Supply {
    /// A connected supply with its capacitors charged.
    pub fn new(params: SupplyParams) -> Self {
        Self {
            params,
            connected: true,
            clamp: ClampDrive::Off,
            bus_volts: params.open_circuit_volts,
            battery_amps: 0.0,
            clamp_closed: false,
            regenerated_joules: 0.0,
        }
    }

    /// Voltage across the board's main terminals.
    pub fn bus_volts(&self) -> f64 {
        self.bus_volts
    }

    /// Current out of the battery over the last step; negative while it is charged.
    pub fn battery_amps(&self) -> f64 {
        self.battery_amps
    }

    /// Whether the brake resistor is across the link.
    pub fn clamp_closed(&self) -> bool {
        self.clamp_closed
    }

    /// Energy the motors have given back to the link so far.
    pub fn regenerated_joules(&self) -> f64 {
        self.regenerated_joules
    }

    /// The link voltage at the end of a step in which the motors draw `amps + amps_per_volt * bus_volts`.
    pub fn foretell(&self, amps: f64, amps_per_volt: f64, dt_s: f64) -> f64 {
        self.solve(amps, amps_per_volt, dt_s).0
    }

    /// Advances by `dt_s` in which the motors drew `amps` from the link.
    pub fn step(&mut self, amps: f64, dt_s: f64) {
        (self.bus_volts, self.battery_amps) = self.solve(amps, 0.0, dt_s);
        if amps < 0.0 {
            self.regenerated_joules -= amps * self.bus_volts * dt_s;
        }
        self.clamp_closed = match (self.params.brake_resistor, self.clamp) {
            (None, _) | (_, ClampDrive::Off) => false,
            (_, ClampDrive::On) => true,
            (_, ClampDrive::Above { on_volts, off_volts }) => {
                let limit = if self.clamp_closed { off_volts } else { on_volts };
                self.bus_volts > limit
            }
        };
    }

    /// Backward Euler of the one node: (link volts, battery amps) at the end of the step.
    fn solve(&self, amps: f64, amps_per_volt: f64, dt_s: f64) -> (f64, f64) {
        let p = &self.params;
        let capacitor = p.capacitance_farads.max(1e-6) / dt_s;
        let resistor = match p.brake_resistor {
            Some(resistor) if self.clamp_closed => 1.0 / resistor.ohms.max(1e-3),
            _ => 0.0,
        };
        let siemens = capacitor + resistor + 1.0 / p.bleed_ohms.max(1.0) + amps_per_volt;
        let source = capacitor * self.bus_volts - amps;
        let feed = 1.0 / p.internal_ohms.max(1e-4);
        let fed = (source + p.open_circuit_volts * feed) / (siemens + feed);
        let feeds = self.connected && (p.can_sink || fed <= p.open_circuit_volts);
        let (volts, battery_amps) =
            if feeds { (fed, (p.open_circuit_volts - fed) * feed) } else { (source / siemens, 0.0) };
        (volts.max(0.0).min(p.breakdown_volts), battery_amps)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settled(mut supply: Supply, amps: f64) -> Supply {
        for _ in 0..20_000 {
            supply.step(amps, 1e-3);
        }
        supply
    }

    #[test]
    fn a_loaded_battery_sags_by_its_resistance_and_a_charged_one_rises() {
        let params = SupplyParams { internal_ohms: 0.1, bleed_ohms: 1e12, ..SupplyParams::default() };
        let loaded = settled(Supply::new(params), 20.0);
        assert!((loaded.bus_volts() - 22.0).abs() < 1e-6);
        assert!((loaded.battery_amps() - 20.0).abs() < 1e-6);
        let charged = settled(Supply::new(params), -20.0);
        assert!((charged.bus_volts() - 26.0).abs() < 1e-6);
        assert!((charged.battery_amps() + 20.0).abs() < 1e-6);
    }

    #[test]
    fn a_supply_that_cannot_sink_lets_the_link_rise_by_charge_over_capacitance() {
        let params = SupplyParams { can_sink: false, bleed_ohms: 1e12, ..SupplyParams::default() };
        let mut supply = Supply::new(params);
        for _ in 0..10 {
            supply.step(-2.2, 1e-3);
        }
        // 2.2 A for 10 ms into 2.2 mF: 10 V.
        assert!((supply.bus_volts() - 34.0).abs() < 1e-3, "{}", supply.bus_volts());
        assert_eq!(supply.battery_amps(), 0.0);
        assert!(supply.regenerated_joules() > 0.0);
    }

    #[test]
    fn a_brake_resistor_holds_the_link_between_its_limits() {
        let params = SupplyParams {
            can_sink: false,
            brake_resistor: Some(BrakeResistorParams { ohms: 2.0, dout: 0 }),
            ..SupplyParams::default()
        };
        let mut supply = Supply::new(params);
        supply.clamp = ClampDrive::Above { on_volts: 30.0, off_volts: 28.0 };
        let mut highest: f64 = 0.0;
        for _ in 0..10_000 {
            supply.step(-5.0, 1.0 / 3000.0);
            highest = highest.max(supply.bus_volts());
        }
        assert!(highest > 30.0 && highest < 31.0, "{highest}");
        assert!(supply.bus_volts() > 26.0, "{}", supply.bus_volts());
    }

    #[test]
    fn a_disconnected_link_drains_through_its_bleeder() {
        let mut supply = Supply::new(SupplyParams::default());
        supply.connected = false;
        let time_constant_s: f64 = 2000.0 * 2.2e-3;
        for _ in 0..44_000 {
            supply.step(0.0, 1e-4);
        }
        assert!((supply.bus_volts() - 24.0 * (-4.4 / time_constant_s).exp()).abs() < 1e-3);
    }
}
