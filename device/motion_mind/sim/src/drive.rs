//! From inputs and commands to the bridge: the open-loop modes, the limits and the protections, once a loop of 5 ms.

use super::assumed::OVER_TEMPERATURE_CELSIUS;
use super::inputs::{ANALOG_FULL, Inputs, RC_CENTER};
use super::loops::FULL_DUTY;
use super::store::Store;
use brushwork_motion_mind_wire::Mode;
use brushwork_motion_mind_wire::register_number as number;
use brushwork_motion_mind_wire::{function, function2};
use brushwork_plant::bridge::BridgeOutput;

/// Middle of the analog input.
const ANALOG_CENTER: i64 = 512;
/// With both buttons free a motor that changes its direction stands still for so many debounce times.
const STOP_AT_ZERO_UPDATES: i64 = 4;

/// The drive of the open-loop modes 0 to 3, which changes by steps.
#[derive(Clone, Debug, Default)]
pub struct OpenLoop {
    /// The drive now, -1023 to 1023.
    pub duty: i64,
    /// What CHANGE_SPEED asked for.
    pub asked: i64,
    loops_to_update: i64,
    updates_to_stand: i64,
}

/// What keeps the drive small.
#[derive(Clone, Debug)]
pub struct Limits {
    /// The most drive, lowered while the current is too high.
    pub pwm_limit: i64,
    /// The current was above AMPSLIMIT, and the drive is held down since.
    pub is_over_current: bool,
    /// The drive asked for is above the limit.
    pub is_at_pwm_limit: bool,
    /// The bridge is off because it is hot.
    pub is_too_hot: bool,
    /// At the negative and the positive virtual limit.
    pub virtual_limits: [bool; 2],
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            pwm_limit: FULL_DUTY,
            is_over_current: false,
            is_at_pwm_limit: false,
            is_too_hot: false,
            virtual_limits: [false; 2],
        }
    }
}

impl OpenLoop {
    /// One loop of 5 ms. `is_forward` is what switch 5 says in mode 2.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn turn(
        &mut self,
        mode: Mode,
        store: &Store,
        inputs: &Inputs,
        uses_register: bool,
        is_forward: bool,
    ) -> i64 {
        self.loops_to_update -= 1;
        if self.loops_to_update > 0 {
            return self.duty;
        }
        self.loops_to_update = store.get(number::TIMER).max(1);
        let step = match mode {
            Mode::Serial => store.get(number::VELOCITYLIMIT),
            _ if uses_register => store.get(number::VELOCITYLIMIT),
            _ => inputs.feedback.max(1),
        };
        match mode {
            Mode::RadioControl => self.approach(radio_duty(store, inputs), step),
            Mode::Analog => self.approach(analog_duty(store, inputs), step),
            Mode::Serial => self.approach(self.asked, step),
            Mode::Buttons => self.press(inputs, step, is_forward),
            Mode::SerialPid | Mode::AnalogPid | Mode::FactoryRestore | Mode::FactoryTest => self.duty = 0,
        }
        self.duty
    }

    /// Stops at once.
    pub fn stop(&mut self) {
        *self = Self::default();
    }

    fn approach(&mut self, target: i64, step: i64) {
        let step = step.max(0);
        self.duty += (target - self.duty).clamp(-step, step);
    }

    fn press(&mut self, inputs: &Inputs, step: i64, is_forward: bool) {
        if self.updates_to_stand > 0 {
            self.updates_to_stand -= 1;
            return;
        }
        let change = step * (i64::from(inputs.positive.is_low) - i64::from(inputs.negative.is_low));
        let is_bidirectional = inputs.control >= ANALOG_CENTER;
        let allowed = match (is_bidirectional, is_forward) {
            (true, _) => -FULL_DUTY..=FULL_DUTY,
            (false, true) => 0..=FULL_DUTY,
            (false, false) => -FULL_DUTY..=0,
        };
        let next = (self.duty + change).clamp(*allowed.start(), *allowed.end());
        let crosses = is_bidirectional && self.duty.signum() * next.signum() < 0;
        self.duty = if crosses { 0 } else { next };
        if crosses || (is_bidirectional && next == 0 && change != 0) {
            self.updates_to_stand = STOP_AT_ZERO_UPDATES;
        }
    }
}

/// At 9 and 36 kHz the bridge resolves 9 bits (Motion Mind manual 3.16).
fn resolved(store: &Store, duty: i64) -> i64 {
    let is_coarse = store.has2(function2::FREQ_HALF) || store.has2(function2::FREQ_DOUBLE);
    if is_coarse { duty / 2 * 2 } else { duty }
}

/// Mode 0: 1.5 ms stops, RCMAX is full forward, RCMIN full reverse.
fn radio_duty(store: &Store, inputs: &Inputs) -> i64 {
    let away = inputs.rc - RC_CENTER;
    if away.abs() <= store.get(number::RCBAND) {
        return 0;
    }
    let end = if away > 0 { store.get(number::RCMAX) } else { store.get(number::RCMIN) };
    let span = (end - RC_CENTER).abs().max(1);
    (away * FULL_DUTY / span).clamp(-FULL_DUTY, FULL_DUTY)
}

/// Mode 1: ANA_MODE at ground makes 2.5 V the stop, else ANA_DIR tells the direction.
fn analog_duty(store: &Store, inputs: &Inputs) -> i64 {
    if !inputs.negative.is_low {
        return if inputs.positive.is_low { -inputs.control } else { inputs.control };
    }
    let away = inputs.control - ANALOG_CENTER;
    if away.abs() <= store.get(number::DEADBAND) {
        return 0;
    }
    (away * FULL_DUTY / (ANALOG_FULL - ANALOG_CENTER)).clamp(-FULL_DUTY, FULL_DUTY)
}

/// Mode 0 as a position: the pulse between RCMIN and RCMAX as 0 to 1023.
pub fn radio_position(store: &Store, inputs: &Inputs) -> i64 {
    let (min, max) = (store.get(number::RCMIN), store.get(number::RCMAX));
    let pulse = inputs.rc.clamp(min.min(max), max.max(min));
    (pulse - min) * ANALOG_FULL / (max - min).max(1)
}

impl Limits {
    /// Looks at current and heat, once a loop.
    ///
    /// Assumed: the limit of the drive falls by the excess of AMPS over AMPSLIMIT each loop, and rises again by what is free.
    pub fn look(&mut self, store: &Store, amps: i64, celsius: f64, is_heat_ignored: bool) {
        let full = store.get(number::PWMLIMIT).clamp(0, FULL_DUTY);
        let amps_limit = store.get(number::AMPSLIMIT);
        self.pwm_limit = match amps_limit {
            0 => full,
            limit => (self.pwm_limit + (limit - amps).min(full)).clamp(0, full),
        };
        let is_above = amps_limit > 0 && amps > amps_limit;
        self.is_over_current = is_above || self.is_over_current && self.pwm_limit < full;
        let [off, on] = OVER_TEMPERATURE_CELSIUS;
        self.is_too_hot = !is_heat_ignored && celsius > if self.is_too_hot { on } else { off };
    }

    /// What is left of a drive. `position` is there in closed loops, where the virtual limits act.
    pub fn apply(
        &mut self,
        store: &Store,
        inputs: &Inputs,
        duty: i64,
        has_limit_inputs: bool,
        position: Option<i64>,
    ) -> i64 {
        self.virtual_limits = [false; 2];
        if let Some(position) = position.filter(|_| store.has(function::VIRTLIMIT)) {
            self.virtual_limits =
                [position <= store.get(number::VNLIMIT), position >= store.get(number::VPLIMIT)];
        }
        let [no_backward, no_forward] = [
            self.virtual_limits[0] || has_limit_inputs && inputs.negative.is_low,
            self.virtual_limits[1] || has_limit_inputs && inputs.positive.is_low,
        ];
        let duty = if duty > 0 && no_forward || duty < 0 && no_backward { 0 } else { duty };
        self.is_at_pwm_limit = duty.abs() > self.pwm_limit;
        duty.clamp(-self.pwm_limit, self.pwm_limit)
    }

    /// What the bridge does with a drive.
    pub fn bridge(&self, store: &Store, inputs: &Inputs, duty: i64) -> BridgeOutput {
        match duty {
            _ if inputs.brake || self.is_too_hot => BridgeOutput::Coast,
            0 if store.has(function::ACTIVESTOP) => BridgeOutput::Brake,
            0 => BridgeOutput::Coast,
            duty => BridgeOutput::Duty(resolved(store, duty) as f64 / FULL_DUTY as f64),
        }
    }
}
