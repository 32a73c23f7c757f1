//! What the unit reads from its pins.

use super::assumed::{PULSE_MISSING_LOOPS, PULSE_PERIOD_LOOPS, PULSES_IN_MEAN};
use super::config::pin;
use super::store::Store;
use brushwork_motion_mind_wire::register_number as number;
use brushwork_motion_mind_wire::{Mode, function};
use brushwork_plant::world::{PinState, World};
use std::collections::VecDeque;

/// Steps of the converter at 5 V.
pub const ANALOG_FULL: i64 = 1023;
/// Below this a pin counts as at ground.
const LOW_BELOW_VOLTS: f64 = 1.5;
/// One step of the R/C pulse measurement.
const RC_STEP_US: f64 = 1.736;
/// One step of the pulse feedback.
const PULSE_STEP_US: f64 = 0.217;
/// The pulse that stops the motor: 1.5 ms.
pub const RC_CENTER: i64 = 864;
/// Pulses so much outside RCMIN and RCMAX are bad: 0.5 ms.
const RC_MARGIN: i64 = 288;

/// A digital input that must keep its level for the time of TIMER before it counts.
#[derive(Clone, Copy, Debug, Default)]
pub struct Debounced {
    /// The level that counts: whether the pin is at ground.
    pub is_low: bool,
    differs_for: i64,
}

/// All inputs as last read.
#[derive(Clone, Debug, Default)]
pub struct Inputs {
    /// J4 P4, 0 to 1023.
    pub control: i64,
    /// J4 P3, 0 to 1023.
    pub feedback: i64,
    /// POS_LIM, ANA_DIR, BTN_UP.
    pub positive: Debounced,
    /// NEG_LIM, ANA_MODE, BTN_DN.
    pub negative: Debounced,
    /// _BRAKE at ground.
    pub brake: bool,
    /// IND/RC at ground.
    pub index: bool,
    /// Pulse feedback in steps of 0.217 us, while pulses come.
    pub pulse_steps: Option<i64>,
    /// The R/C pulse to go by, in steps of 1.736 us. Measured in mode 0 alone.
    pub rc: i64,
    /// Whether the last R/C pulse was missing or bad.
    pub is_rc_bad: bool,
    good_pulses: VecDeque<i64>,
    /// Loops since the last R/C pulse was taken or missed.
    pulse_age: Option<u32>,
    /// Whether the pins were read since power-up.
    has_read: bool,
}

impl Debounced {
    /// Takes the level of this loop.
    fn take(&mut self, is_low: bool, loops_needed: i64) {
        if is_low == self.is_low {
            self.differs_for = 0;
            return;
        }
        self.differs_for += 1;
        if self.differs_for >= loops_needed {
            *self = Self { is_low, differs_for: 0 };
        }
    }
}

impl Inputs {
    /// Reads all pins, once a loop of 5 ms.
    pub fn read(&mut self, world: &mut World, store: &Store, mode: Mode) {
        // Assumed: there is nothing to debounce at power-up. A unit that took ANA_MODE for open until TIMER is over would give half of its
        // drive to a stick at rest.
        let debounce = if self.has_read { store.get(number::TIMER).max(1) } else { 1 };
        self.has_read = true;
        self.control = analog(world.pin(pin::ANALOG_CONTROL));
        self.feedback = analog(world.pin(pin::ANALOG_FEEDBACK));
        self.positive.take(is_low(world.pin(pin::POSITIVE_LIMIT)), debounce);
        self.negative.take(is_low(world.pin(pin::NEGATIVE_LIMIT)), debounce);
        self.brake = is_low(world.pin(pin::BRAKE));
        let index = world.pin(pin::INDEX_RC);
        self.index = is_low(index);
        let pulse_us = match index {
            PinState::Pulse { microseconds } if microseconds > 0.0 => Some(microseconds),
            PinState::Open | PinState::Volts(_) | PinState::Pulse { .. } | PinState::Counts(_) => None,
        };
        self.pulse_steps = pulse_us.map(|microseconds| (microseconds / PULSE_STEP_US).round() as i64);
        if mode == Mode::RadioControl {
            self.await_rc(pulse_us.map(|microseconds| (microseconds / RC_STEP_US).round() as i64), store);
        }
    }

    /// Reads the feedback inputs alone, as the fast loop does.
    pub fn read_feedback(&mut self, world: &mut World) {
        self.control = analog(world.pin(pin::ANALOG_CONTROL));
        self.feedback = analog(world.pin(pin::ANALOG_FEEDBACK));
    }

    /// A pulse is taken when it is due; where none comes, the last one holds until it counts as missing.
    fn await_rc(&mut self, pulse: Option<i64>, store: &Store) {
        let wait = if pulse.is_some() { PULSE_PERIOD_LOOPS } else { PULSE_MISSING_LOOPS };
        let age = self.pulse_age.map_or(wait, |age| age + 1);
        let is_due = age >= wait;
        self.pulse_age = Some(if is_due && pulse.is_some() { 0 } else { age.min(PULSE_MISSING_LOOPS) });
        if is_due {
            self.take_rc(pulse, store);
        }
    }

    /// Reads the limit inputs without debouncing, as at power-up.
    pub fn limits_at_ground(world: &mut World) -> bool {
        is_low(world.pin(pin::POSITIVE_LIMIT)) && is_low(world.pin(pin::NEGATIVE_LIMIT))
    }

    fn take_rc(&mut self, pulse: Option<i64>, store: &Store) {
        let (min, max) = (store.get(number::RCMIN), store.get(number::RCMAX));
        let good = min - RC_MARGIN..=max + RC_MARGIN;
        // Motion Mind manual 4.3: for R/C position control the count is "internally limited to RCMAX and RCMIN".
        let limited = |steps: i64| if store.has(function::RCPOS) { steps.min(max).max(min) } else { steps };
        match pulse.filter(|steps| good.contains(steps)).map(limited) {
            Some(steps) => {
                self.is_rc_bad = false;
                self.rc = steps;
                self.good_pulses.truncate(PULSES_IN_MEAN - 1);
                self.good_pulses.push_front(steps);
            }
            None => {
                self.is_rc_bad = true;
                self.rc = if store.has(function::LASTRC) { self.mean_pulse() } else { RC_CENTER };
            }
        }
    }

    fn mean_pulse(&self) -> i64 {
        let count = self.good_pulses.len() as i64;
        if count == 0 { RC_CENTER } else { self.good_pulses.iter().sum::<i64>() / count }
    }
}

fn analog(state: PinState) -> i64 {
    match state {
        PinState::Volts(volts) => ((volts / 5.0 * ANALOG_FULL as f64).round() as i64).clamp(0, ANALOG_FULL),
        PinState::Open | PinState::Pulse { .. } | PinState::Counts(_) => 0,
    }
}

/// Inputs are pulled up: what is not connected is high.
fn is_low(state: PinState) -> bool {
    matches!(state, PinState::Volts(volts) if volts < LOW_BELOW_VOLTS)
}
