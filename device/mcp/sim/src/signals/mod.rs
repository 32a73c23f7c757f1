//! The input pins: from what is on the pin to position, percent, speeds, motor command, actions and activity.
//!
//! What is on the pin comes from outside as a [`PinReading`]. What becomes of the command is the controller's business.

mod actions;
mod filter;
mod shape;

pub use actions::{ActionBits, MotorTriggers, Triggers};
pub use filter::{RunningAverage, SAMPLES_PER_S};
pub use shape::FULL_SCALE;

use crate::settings::SignalSettings;
use std::collections::VecDeque;
use std::time::Duration;

/// What the firmware samples on a pin, in input units: 0 to 4095 for an analog or digital pin, microseconds for a pulse,
/// counts for an encoder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PinReading {
    /// The pin has no function, or its function finds nothing (no pulses).
    Nothing,
    /// A level or count that is always there.
    Level(f64),
    /// The width of the pulses that arrive, in microseconds.
    Pulse(f64),
}

/// The five values of command 147.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SignalValues {
    /// The value of the selected mode, scaled to the output range.
    pub command: i32,
    /// Shaped distance from the center.
    pub position: i32,
    /// Position as a share of the range, +-32767.
    pub percent: i32,
    /// Speed since the last update, units per second.
    pub speed: i32,
    /// Average speed over the last second, units per second.
    pub average_speed: i32,
}

/// One input pin at work.
#[derive(Clone, Debug, Default)]
pub struct Signal {
    average: RunningAverage,
    filtered: f64,
    speed_per_s: f64,
    updated_at: Option<Duration>,
    /// Positions of the last second for the average speed.
    history: VecDeque<(Duration, f64)>,
    last_activity: Option<Duration>,
    updates: u32,
    at_min: bool,
    at_max: bool,
    stopped_by_min: bool,
    stopped_by_max: bool,
}

/// Window of the average speed (MCP manual 1.9.12).
const AVERAGE_SPEED_WINDOW: Duration = Duration::from_secs(1);
/// Spacing of the samples kept for the average speed.
const HISTORY_SPACING: Duration = Duration::from_millis(20);

impl Signal {
    /// Takes one reading and adds to `triggers` what the min and max actions ask for.
    pub fn update(
        &mut self,
        reading: PinReading,
        settings: &SignalSettings,
        one_byte_actions: bool,
        now: Duration,
        triggers: &mut Triggers,
    ) {
        let value = match reading {
            PinReading::Nothing => return,
            PinReading::Level(value) | PinReading::Pulse(value) => value,
        };
        let before = self.filtered;
        self.average.push(now, value);
        self.filtered = self.average.mean(now, settings.low_pass);
        self.updates = self.updates.wrapping_add(1);
        self.update_speed(before, now);
        if matches!(reading, PinReading::Pulse(_)) || self.filtered != before || self.last_activity.is_none()
        {
            self.last_activity = Some(now);
        }
        self.update_actions(settings, one_byte_actions, triggers);
    }

    /// The filtered reading, in input units.
    pub fn raw(&self) -> f64 {
        self.filtered
    }

    /// When the last signal or change was seen.
    pub fn last_activity(&self) -> Option<Duration> {
        self.last_activity
    }

    /// How often it was read. Assumed: once in each control tick.
    pub fn updates(&self) -> u32 {
        self.updates
    }

    /// Speed of the reading, in units per second.
    pub fn speed_per_s(&self) -> f64 {
        self.speed_per_s
    }

    /// The values of command 147.
    pub fn values(&self, settings: &SignalSettings) -> SignalValues {
        if self.updated_at.is_none() {
            return SignalValues::default();
        }
        let position = shape::position(self.filtered, settings);
        let percent = shape::percent(position, settings);
        SignalValues {
            command: self.command(settings) as i32,
            position: position as i32,
            percent: percent as i32,
            speed: self.speed_per_s as i32,
            average_speed: self.average_speed_per_s() as i32,
        }
    }

    /// The motor command in the selected mode, scaled or limited to the output range.
    pub fn command(&self, settings: &SignalSettings) -> f64 {
        match settings.mode {
            2 => shape::limited_to_output(self.average_speed_per_s(), settings),
            3 => shape::limited_to_output(self.speed_per_s, settings),
            _ => {
                let position = shape::position(self.filtered, settings);
                shape::scaled_to_output(shape::percent(position, settings), settings)
            }
        }
    }

    /// Whether a signal or a change was seen within the pin's time-out. Assumed: a time-out of 0 never runs out.
    pub fn is_active(&self, settings: &SignalSettings, now: Duration) -> bool {
        let timeout = Duration::from_millis(settings.timeout_ms.into());
        self.last_activity.is_some_and(|last| timeout.is_zero() || now.saturating_sub(last) <= timeout)
    }

    fn update_speed(&mut self, before: f64, now: Duration) {
        if let Some(last) = self.updated_at {
            let elapsed_s = now.saturating_sub(last).as_secs_f64();
            if elapsed_s > 0.0 {
                self.speed_per_s = (self.filtered - before) / elapsed_s;
            }
        }
        self.updated_at = Some(now);
        if self.history.back().is_none_or(|(at, _)| now.saturating_sub(*at) >= HISTORY_SPACING) {
            self.history.push_back((now, self.filtered));
        }
        let opening = now.saturating_sub(AVERAGE_SPEED_WINDOW);
        while self.history.get(1).is_some_and(|(at, _)| *at <= opening) {
            self.history.pop_front();
        }
    }

    fn average_speed_per_s(&self) -> f64 {
        let (Some(&(start, from)), Some(now)) = (self.history.front(), self.updated_at) else {
            return 0.0;
        };
        // Over the first second the missing past counts as standing still.
        let span_s = now.saturating_sub(start).max(AVERAGE_SPEED_WINDOW).as_secs_f64();
        (self.filtered - from) / span_s
    }

    fn update_actions(&mut self, settings: &SignalSettings, one_byte: bool, triggers: &mut Triggers) {
        let min = ActionBits::from_raw(settings.min_action, one_byte);
        let max = ActionBits::from_raw(settings.max_action, one_byte);
        if min.is_none() && max.is_none() {
            (self.at_min, self.at_max, self.stopped_by_min, self.stopped_by_max) = Default::default();
            return;
        }
        let at_min = self.filtered <= f64::from(settings.min);
        let at_max = self.filtered >= f64::from(settings.max);
        let center = f64::from(settings.center);
        self.stopped_by_min = at_min || (self.stopped_by_min && self.filtered < center);
        self.stopped_by_max = at_max || (self.stopped_by_max && self.filtered > center);
        let ends = [
            (min, at_min, self.at_min, self.stopped_by_min),
            (max, at_max, self.at_max, self.stopped_by_max),
        ];
        for (bits, at_end, was_at_end, stopped) in ends {
            if at_end {
                bits.hold(triggers);
                if !was_at_end {
                    bits.fire(settings.load_home, triggers);
                }
            }
            if stopped {
                bits.hold_until_center(triggers);
            }
        }
        (self.at_min, self.at_max) = (at_min, at_max);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    fn at(signal: &mut Signal, value: f64, settings: &SignalSettings, now: Duration) -> Triggers {
        let mut triggers = Triggers::default();
        signal.update(PinReading::Level(value), settings, false, now, &mut triggers);
        triggers
    }

    #[test]
    fn a_limit_switch_holds_while_pressed_and_loads_home_once() {
        // M1 forward limit and M1 load home together: bits 0x08 and 0x20.
        let settings = SignalSettings { max_action: 0x0028, load_home: 1234, ..SignalSettings::default() };
        let mut signal = Signal::default();
        assert_eq!(at(&mut signal, 2000.0, &settings, ms(0)), Triggers::default());
        let pressed = at(&mut signal, 4095.0, &settings, ms(2));
        assert!(pressed.motors[0].forward_limit && pressed.motors[0].load_home == Some(1234));
        let held = at(&mut signal, 4095.0, &settings, ms(4));
        assert!(held.motors[0].forward_limit && held.motors[0].load_home.is_none() && held.motors[0].at_home);
        assert_eq!(at(&mut signal, 4000.0, &settings, ms(6)), Triggers::default());
    }

    #[test]
    fn a_safe_stop_stays_until_the_input_is_back_at_its_center() {
        let settings = SignalSettings { min_action: 0x0101, ..SignalSettings::default() };
        let mut signal = Signal::default();
        let stopped = |triggers: Triggers| triggers.motors.map(|motor| motor.safe_stop);
        assert_eq!(stopped(at(&mut signal, 0.0, &settings, ms(0))), [true, true]);
        assert_eq!(stopped(at(&mut signal, 1000.0, &settings, ms(2))), [true, true]);
        assert_eq!(stopped(at(&mut signal, 2048.0, &settings, ms(4))), [false, false]);
        assert_eq!(stopped(at(&mut signal, 1000.0, &settings, ms(6))), [false, false]);
    }

    #[test]
    fn pulses_keep_an_input_active_and_silence_lets_it_time_out() {
        let settings = SignalSettings { timeout_ms: 100, ..SignalSettings::default() };
        let mut signal = Signal::default();
        let mut triggers = Triggers::default();
        assert!(!signal.is_active(&settings, ms(0)));
        for step in 0..10 {
            signal.update(PinReading::Pulse(1500.0), &settings, false, ms(step * 20), &mut triggers);
        }
        signal.update(PinReading::Nothing, &settings, false, ms(250), &mut triggers);
        assert!(signal.is_active(&settings, ms(280)));
        assert!(!signal.is_active(&settings, ms(281)));
    }

    #[test]
    fn speeds_follow_a_ramp() {
        let settings = SignalSettings { mode: 3, ..SignalSettings::default() };
        let mut signal = Signal::default();
        for step in 0..=2000_u64 {
            at(&mut signal, step as f64, &settings, ms(step));
        }
        let values = signal.values(&settings);
        assert_eq!((values.speed, values.average_speed, values.command), (1000, 1000, 1000));
    }

    #[test]
    fn a_pin_that_was_never_read_has_no_values() {
        assert_eq!(Signal::default().values(&SignalSettings::default()), SignalValues::default());
    }
}
