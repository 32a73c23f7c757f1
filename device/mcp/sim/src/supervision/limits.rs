//! Voltage, current and temperature limits and what they do to the motors (MCP manual 1.6.3).
//!
//! Assumed, all in this file: the maximum of command 57 is the high *warning*, the model's own rating the high *error*; the
//! logic battery's minimum counts for a logic battery that is connected, and where none is for the main battery, which feeds
//! the logic then (1.0.10); the current limit falls in a straight line from all of it at 85 degrees to none at 100; where
//! braking and freewheeling are both asked for, an error wins over a warning and otherwise braking wins; a fault of a bridge
//! and a short circuit let both motors freewheel until a restart (1.6.2 says that a fault disables both outputs until the unit
//! is reset).

use crate::motion::BridgeOverride;

/// Above this temperature the current limit is reduced (MCP manual 1.6.3).
pub const WARNING_FROM_CELSIUS: f64 = 85.0;
/// Above this temperature the motors freewheel (MCP manual 1.6.3).
pub const FREEWHEEL_AT_CELSIUS: f64 = 100.0;

/// What is measured at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observed {
    /// Main battery, V.
    pub main_volts: f64,
    /// Logic battery input, V; 0 when nothing is connected.
    pub logic_volts: f64,
    /// Board temperature at the first sensor, degrees Celsius.
    pub temperature_celsius: f64,
    /// At the second sensor, if the model has one.
    pub temperature_2_celsius: Option<f64>,
    /// Motor currents, A, positive for driving torque whichever way the motor turns.
    pub driving_amps: [f64; 2],
    /// The bridges say that they are broken or shorted.
    pub driver_fault: [bool; 2],
    /// More current than the board stands.
    pub short_circuit: [bool; 2],
}

/// The limits in force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Main battery minimum and maximum set by command 57, V.
    pub main_volts: (f64, f64),
    /// What the board stands, V.
    pub rated_main_volts: (f64, f64),
    /// Logic battery minimum and maximum set by command 58, V.
    pub logic_volts: (f64, f64),
    /// Largest driving current per motor, A.
    pub max_amps: [Option<f64>; 2],
    /// Largest braking current per motor as a magnitude, A.
    pub max_braking_amps: [Option<f64>; 2],
}

/// Which limits are exceeded. Warnings last as long as their cause, the latched errors until a restart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Protection {
    /// Over 100 degrees: the motors freewheel while it lasts.
    pub temperature_error: bool,
    /// The second sensor over 100 degrees.
    pub temperature_2_error: bool,
    /// Over 85 degrees: the current limit is reduced.
    pub temperature_warning: bool,
    /// The second sensor over 85 degrees.
    pub temperature_2_warning: bool,
    /// Latched: the main battery was above the rating. Motors brake.
    pub main_high_error: bool,
    /// The main battery is below the rating. Motors freewheel. (Only generation 4 has a status bit for it.)
    pub main_low_error: bool,
    /// The main battery is above its maximum. Motors brake.
    pub main_high_warning: bool,
    /// The main battery is below its minimum. Motors freewheel.
    pub main_low_warning: bool,
    /// Latched: the logic battery was above its maximum. Motors freewheel.
    pub logic_high_error: bool,
    /// Latched: the logic battery, or the main battery that stands in for it, was below the minimum. Motors freewheel.
    pub logic_low_error: bool,
    /// The motor draws as much current as it may.
    pub over_current: [bool; 2],
    /// The motor feeds back as much current as it may.
    pub over_regeneration: [bool; 2],
    /// Latched: a bridge reported a fault. Both motors freewheel.
    pub driver_fault: [bool; 2],
    /// Latched: a short circuit. Both motors freewheel.
    pub current_error: [bool; 2],
}

/// Share of the limit at which the warning shows: the limiter holds the current there, so it is never much above.
const OVER_CURRENT_SHARE: f64 = 0.98;

impl Protection {
    /// Compares one set of measurements with the limits.
    pub fn update(&mut self, observed: &Observed, limits: &Limits) {
        let second = observed.temperature_2_celsius.unwrap_or(f64::MIN);
        self.temperature_warning = observed.temperature_celsius > WARNING_FROM_CELSIUS;
        self.temperature_2_warning = second > WARNING_FROM_CELSIUS;
        self.temperature_error = observed.temperature_celsius > FREEWHEEL_AT_CELSIUS;
        self.temperature_2_error = second > FREEWHEEL_AT_CELSIUS;

        self.main_low_warning = observed.main_volts < limits.main_volts.0;
        self.main_high_warning = observed.main_volts > limits.main_volts.1;
        self.main_low_error = observed.main_volts < limits.rated_main_volts.0;
        self.main_high_error |= observed.main_volts > limits.rated_main_volts.1;

        let logic_supply_volts =
            if observed.logic_volts > 0.0 { observed.logic_volts } else { observed.main_volts };
        self.logic_high_error |= observed.logic_volts > limits.logic_volts.1;
        self.logic_low_error |= logic_supply_volts < limits.logic_volts.0;

        let share = self.current_limit_share(observed);
        for motor in 0..2 {
            let reached = |amps: f64, limit: Option<f64>| {
                limit.is_some_and(|limit| amps > OVER_CURRENT_SHARE * limit * share)
            };
            let amps = observed.driving_amps[motor];
            self.over_current[motor] = reached(amps, limits.max_amps[motor]);
            self.over_regeneration[motor] = reached(-amps, limits.max_braking_amps[motor]);
            self.driver_fault[motor] |= observed.driver_fault[motor];
            self.current_error[motor] |= observed.short_circuit[motor];
        }
    }

    /// What the bridges must do.
    pub fn bridge(&self) -> BridgeOverride {
        if self.main_high_error {
            BridgeOverride::Brake
        } else if self.has_freewheeling_error() {
            BridgeOverride::Freewheel
        } else if self.main_high_warning {
            BridgeOverride::Brake
        } else if self.main_low_warning {
            BridgeOverride::Freewheel
        } else {
            BridgeOverride::None
        }
    }

    /// Share of the current limits that the temperature leaves, 0 to 1.
    pub fn current_limit_share(&self, observed: &Observed) -> f64 {
        let hottest = observed.temperature_celsius.max(observed.temperature_2_celsius.unwrap_or(f64::MIN));
        let above = hottest - WARNING_FROM_CELSIUS;
        (1.0 - above / (FREEWHEEL_AT_CELSIUS - WARNING_FROM_CELSIUS)).clamp(0.0, 1.0)
    }

    /// Whether a bridge fault or a short circuit has disabled the motors.
    pub fn has_bridge_fault(&self) -> bool {
        self.driver_fault.contains(&true) || self.current_error.contains(&true)
    }

    fn has_freewheeling_error(&self) -> bool {
        self.has_bridge_fault()
            || self.temperature_error
            || self.temperature_2_error
            || self.logic_high_error
            || self.logic_low_error
            || self.main_low_error
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits {
        main_volts: (10.0, 30.0),
        rated_main_volts: (6.0, 34.0),
        logic_volts: (8.0, 15.0),
        max_amps: [Some(20.0), Some(20.0)],
        max_braking_amps: [Some(10.0), None],
    };

    const GOOD: Observed = Observed {
        main_volts: 24.0,
        logic_volts: 0.0,
        temperature_celsius: 25.0,
        temperature_2_celsius: None,
        driving_amps: [1.0, 0.0],
        driver_fault: [false; 2],
        short_circuit: [false; 2],
    };

    fn after(observed: Observed) -> Protection {
        let mut protection = Protection::default();
        protection.update(&observed, &LIMITS);
        protection
    }

    /// Whether a condition is still there after good measurements.
    fn lasts(observed: Observed) -> bool {
        let mut protection = after(observed);
        protection.update(&GOOD, &LIMITS);
        protection.bridge() != BridgeOverride::None
    }

    #[test]
    fn with_everything_in_range_nothing_is_said() {
        assert_eq!(after(GOOD), Protection::default());
        assert_eq!(after(GOOD).bridge(), BridgeOverride::None);
        assert_eq!(after(GOOD).current_limit_share(&GOOD), 1.0);
    }

    #[test]
    fn main_battery_high_brakes_for_as_long_as_it_lasts() {
        let high = Observed { main_volts: 31.0, ..GOOD };
        assert!(after(high).main_high_warning && !after(high).main_high_error);
        assert_eq!(after(high).bridge(), BridgeOverride::Brake);
        assert!(!lasts(high));
    }

    #[test]
    fn main_battery_above_the_rating_brakes_until_a_restart() {
        let high = Observed { main_volts: 35.0, ..GOOD };
        assert!(after(high).main_high_error);
        assert_eq!(after(high).bridge(), BridgeOverride::Brake);
        assert!(lasts(high));
    }

    #[test]
    fn a_bridge_fault_and_a_short_circuit_freewheel_until_a_restart() {
        let faults = [
            Observed { driver_fault: [false, true], ..GOOD },
            Observed { short_circuit: [true, false], ..GOOD },
        ];
        for observed in faults {
            assert_eq!(after(observed).bridge(), BridgeOverride::Freewheel);
            assert!(lasts(observed), "{observed:?}");
        }
    }

    #[test]
    fn main_battery_low_freewheels_for_as_long_as_it_lasts() {
        let low = Observed { main_volts: 9.0, ..GOOD };
        assert!(after(low).main_low_warning && !after(low).main_low_error);
        assert_eq!(after(low).bridge(), BridgeOverride::Freewheel);
        assert!(!lasts(low));
    }

    #[test]
    fn logic_battery_errors_freewheel_until_a_restart() {
        let high = Observed { logic_volts: 16.0, ..GOOD };
        assert!(after(high).logic_high_error && lasts(high));
        assert_eq!(after(high).bridge(), BridgeOverride::Freewheel);
        for (main_volts, logic_volts) in [(7.0, 7.5), (24.0, 7.5), (7.0, 0.0)] {
            let low = Observed { main_volts, logic_volts, ..GOOD };
            assert!(after(low).logic_low_error && lasts(low), "{main_volts} V main, {logic_volts} V logic");
        }
    }

    #[test]
    fn an_unused_logic_input_is_no_error_while_the_main_battery_feeds_the_logic() {
        assert!(!after(GOOD).logic_low_error);
    }

    #[test]
    fn heat_takes_the_current_limit_away_and_then_opens_the_bridges() {
        let warm = Observed { temperature_celsius: 92.5, ..GOOD };
        assert!(after(warm).temperature_warning && !after(warm).temperature_error);
        assert_eq!(after(warm).current_limit_share(&warm), 0.5);
        assert_eq!(after(warm).bridge(), BridgeOverride::None);
        let hot = Observed { temperature_2_celsius: Some(101.0), ..GOOD };
        assert!(after(hot).temperature_2_error && !after(hot).temperature_error);
        assert_eq!(after(hot).bridge(), BridgeOverride::Freewheel);
        assert!(!lasts(hot));
    }

    #[test]
    fn driving_and_braking_currents_have_their_own_warnings() {
        let driving = after(Observed { driving_amps: [19.9, 5.0], ..GOOD });
        assert_eq!((driving.over_current, driving.over_regeneration), ([true, false], [false, false]));
        let braking = after(Observed { driving_amps: [-11.0, -50.0], ..GOOD });
        assert_eq!((braking.over_current, braking.over_regeneration), ([false, false], [true, false]));
    }

    #[test]
    fn an_error_wins_over_a_warning() {
        let mut protection = after(Observed { main_volts: 31.0, temperature_celsius: 120.0, ..GOOD });
        assert_eq!(protection.bridge(), BridgeOverride::Freewheel);
        protection.update(&Observed { main_volts: 40.0, temperature_celsius: 120.0, ..GOOD }, &LIMITS);
        assert_eq!(protection.bridge(), BridgeOverride::Brake);
    }
}
