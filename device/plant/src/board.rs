//! The controller board's own heat: losses of the two bridges warm two sensors.

use super::params::{ParamsError, above_zero, finite, not_negative};
use serde::{Deserialize, Serialize};

/// Thermal figures of a board.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BoardParams {
    /// Air around the board.
    pub ambient_celsius: f64,
    /// Resistance of one bridge. Only its heat counts here; its voltage drop is taken as part of the motor's resistance.
    pub bridge_ohms: f64,
    /// Rise of one sensor per watt lost in its bridge, once settled.
    pub celsius_per_watt: f64,
    /// Rise of both sensors by the board's own supply.
    pub idle_rise_celsius: f64,
    /// Time constant of a sensor.
    pub time_constant_s: f64,
}

impl Default for BoardParams {
    /// Assumed: a 60 A board without fan, some 3 milliohms a bridge, 85 degrees at about 45 A held.
    fn default() -> Self {
        Self {
            ambient_celsius: 25.0,
            bridge_ohms: 0.003,
            celsius_per_watt: 9.0,
            idle_rise_celsius: 5.0,
            time_constant_s: 40.0,
        }
    }
}

impl BoardParams {
    /// Checks every figure.
    pub fn validate(&self) -> Result<(), ParamsError> {
        finite("board.ambient_celsius", self.ambient_celsius)?;
        not_negative("board.bridge_ohms", self.bridge_ohms)?;
        not_negative("board.celsius_per_watt", self.celsius_per_watt)?;
        finite("board.idle_rise_celsius", self.idle_rise_celsius)?;
        above_zero("board.time_constant_s", self.time_constant_s)
    }
}

/// The temperatures of a board, one sensor by each bridge.
#[derive(Clone, Debug)]
pub struct Board {
    params: BoardParams,
    celsius: [f64; 2],
    forced_celsius: Option<f64>,
}

impl Board {
    /// A board that has been on for a while with both motors at rest.
    pub fn new(params: BoardParams) -> Self {
        Self { params, celsius: [params.ambient_celsius + params.idle_rise_celsius; 2], forced_celsius: None }
    }

    /// Temperature at both sensors in degrees Celsius.
    pub fn celsius(&self) -> [f64; 2] {
        self.celsius
    }

    /// Holds both sensors at a temperature, as a heat gun would; `None` lets the board cool again.
    pub fn force_celsius(&mut self, celsius: Option<f64>) {
        self.forced_celsius = celsius;
        if let Some(celsius) = celsius {
            self.celsius = [celsius; 2];
        }
    }

    /// Advances by `dt_s` with these mean squares of the two motor currents.
    pub fn advance(&mut self, amps_squared: [f64; 2], dt_s: f64) {
        if self.forced_celsius.is_some() {
            return;
        }
        let p = &self.params;
        let share = -(-dt_s / p.time_constant_s).exp_m1();
        for (celsius, squared) in self.celsius.iter_mut().zip(amps_squared) {
            let settled =
                p.ambient_celsius + p.idle_rise_celsius + p.celsius_per_watt * p.bridge_ohms * squared;
            *celsius += (settled - *celsius) * share;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bridge_under_load_warms_with_its_time_constant_and_the_other_stays_cool() {
        let mut board = Board::new(BoardParams::default());
        for _ in 0..4000 {
            board.advance([40.0 * 40.0, 0.0], 0.01);
        }
        let [first, second] = board.celsius();
        let settled_rise = 9.0 * 0.003 * 1600.0;
        assert!((first - 30.0 - settled_rise * (1.0 - (-1.0_f64).exp())).abs() < 1e-6, "{first}");
        assert_eq!(second, 30.0);
    }

    #[test]
    fn a_forced_temperature_holds_until_it_is_let_go() {
        let mut board = Board::new(BoardParams::default());
        board.force_celsius(Some(101.0));
        board.advance([0.0; 2], 100.0);
        assert_eq!(board.celsius(), [101.0; 2]);
        board.force_celsius(None);
        board.advance([0.0; 2], 1e4);
        assert!((board.celsius()[0] - 30.0).abs() < 1e-6);
    }
}
