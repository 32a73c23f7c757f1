//! The loop: PID over the following error, the limit of its integral term, and the bridge (SuprMotr manual, commands DP, DI, DD, DL, SQ).

use super::assumed::{DRIVE_STEPS, FULL_DRIVE, INTEGRAL_DIVISOR};
use brushwork_plant::world::BridgeSense;

/// The gains, 0 to 255 each, and what they may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gains {
    /// DP.
    pub proportional: i64,
    /// DI.
    pub integral: i64,
    /// DD.
    pub derivative: i64,
    /// DL, which limits what the integral term gives.
    pub integral_limit: i64,
    /// SQ, which limits the drive.
    pub most_drive: i64,
}

/// The loop's memory.
#[derive(Clone, Debug, Default)]
pub struct Servo {
    sum: i64,
    last_error: Option<i64>,
    drive: i64,
}

impl Servo {
    /// One turn with an error in counts. Gives the drive in steps of the bridge.
    pub fn turn(&mut self, gains: &Gains, error: i64) -> i64 {
        let change = self.last_error.map_or(0, |last| error - last);
        self.last_error = Some(error);
        // More than this the limit cuts off, whatever the gain.
        let most = gains.integral_limit * FULL_DRIVE / DRIVE_STEPS;
        let integral = if gains.integral == 0 || most == 0 {
            self.sum = 0;
            0
        } else {
            let most_sum = most * INTEGRAL_DIVISOR / gains.integral;
            self.sum = (self.sum + error).clamp(-most_sum, most_sum);
            gains.integral * self.sum / INTEGRAL_DIVISOR
        };
        let out = gains.proportional * error + integral + gains.derivative * change;
        let most = gains.most_drive.clamp(0, DRIVE_STEPS);
        self.drive = (out * DRIVE_STEPS / FULL_DRIVE).clamp(-most, most);
        self.drive
    }

    /// Forgets everything and drives no more.
    pub fn release(&mut self) {
        *self = Self::default();
    }

    /// The drive in steps of the bridge.
    pub fn drive(&self) -> i64 {
        self.drive
    }
}

/// The bridge's own limit of its current. Assumed: it takes back the voltage that drives more, and lets it rise again by and by.
#[derive(Clone, Debug)]
pub struct Bridge {
    /// The most duty that it gives now, 0 to 1.
    ceiling: f64,
}

/// What the bridge gives at most (SuprMotr manual, key features).
const MOST_AMPS: f64 = 1.0;
/// How quickly the limit takes back and gives again, per step of the plant.
const TAKEN_BACK_PER_AMP: f64 = 0.3;
const GIVEN_AGAIN: f64 = 1.01;
/// With less it would never come back.
const LEAST_CEILING: f64 = 0.01;

impl Default for Bridge {
    fn default() -> Self {
        Self { ceiling: 1.0 }
    }
}

impl Bridge {
    /// The duty of the next step of the plant.
    pub fn duty(&mut self, wanted: f64, sense: BridgeSense) -> f64 {
        let over = if sense.amps * wanted > 0.0 { sense.amps.abs() - MOST_AMPS } else { -MOST_AMPS };
        let factor = if over > 0.0 { 1.0 - (TAKEN_BACK_PER_AMP * over).min(0.5) } else { GIVEN_AGAIN };
        self.ceiling = (self.ceiling * factor).clamp(LEAST_CEILING, 1.0);
        wanted.clamp(-self.ceiling, self.ceiling)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FACTORY: Gains =
        Gains { proportional: 75, integral: 0, derivative: 0, integral_limit: 100, most_drive: 255 };

    /// 75 x 100 of 32,768 is 22.9 % of the bridge's 255 steps: 58.
    #[test]
    fn the_drive_is_in_proportion_to_the_error() {
        let mut servo = Servo::default();
        assert_eq!(servo.turn(&FACTORY, 100), 58);
        assert_eq!(servo.turn(&FACTORY, -100), -58);
        assert_eq!(servo.turn(&FACTORY, 10_000), 255);
        assert_eq!(servo.turn(&FACTORY, 1), 0, "75 of 32,768 is less than a step");
    }

    /// 10 x 100 / 256 more in each turn: 0, 3.9, 7.8 ... beside 75 x 100; DL 100 lets it go to 100 steps.
    #[test]
    fn the_integral_grows_up_to_its_limit() {
        let mut servo = Servo::default();
        let gains = Gains { proportional: 0, integral: 255, ..FACTORY };
        // 255 x 1000 / 256 = 996 a turn: 7.75 steps of the bridge.
        assert_eq!([servo.turn(&gains, 1_000), servo.turn(&gains, 1_000)], [7, 15]);
        for _ in 0..100 {
            servo.turn(&gains, 1_000);
        }
        assert_eq!(servo.drive(), 99, "100 of 255 steps, less what whole numbers lose");
        // It comes back at once: it was not wound up.
        for _ in 0..26 {
            servo.turn(&gains, -1_000);
        }
        assert!(servo.drive() < -99 / 2, "{}", servo.drive());
        assert_eq!(servo.turn(&Gains { integral_limit: 0, ..gains }, 1_000), 0, "DL 0 switches the term off");
    }

    /// 40 x 50 / 32,768 x 255 = 15.6.
    #[test]
    fn the_derivative_looks_at_the_change_and_not_at_the_first_error() {
        let mut servo = Servo::default();
        let gains = Gains { proportional: 0, derivative: 40, ..FACTORY };
        assert_eq!([servo.turn(&gains, 500), servo.turn(&gains, 550), servo.turn(&gains, 550)], [0, 15, 0]);
    }

    #[test]
    fn the_torque_limit_holds_the_drive() {
        let mut servo = Servo::default();
        assert_eq!(servo.turn(&Gains { most_drive: 40, ..FACTORY }, -10_000), -40);
    }

    #[test]
    fn the_bridge_takes_back_what_drives_more_than_an_ampere() {
        let mut bridge = Bridge::default();
        let mut amps = 0.0;
        for _ in 0..200 {
            // A locked motor of 5 ohms on 12 V, without inductance.
            let sense = BridgeSense { amps, bus_volts: 12.0, step_s: 1.0 / 3000.0 };
            amps = bridge.duty(1.0, sense) * 12.0 / 5.0;
        }
        assert!((0.9..1.1).contains(&amps), "{amps} A");
        let braking = BridgeSense { amps: 3.0, bus_volts: 12.0, step_s: 1.0 / 3000.0 };
        assert!(bridge.duty(-0.3, braking) < 0.0, "against the current it may drive");
    }
}
