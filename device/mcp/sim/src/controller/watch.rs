//! Supervision at work: limits, emergency stop, LEDs and digital outputs of one unit.

use super::firmware::Firmware;
use super::firmware::LoopFaults;
use super::readings::Readings;
use crate::motion::{BridgeOverride, MotionCommand};
use crate::supervision::{EStopReset, LedInputs, Limits, Observed, OutputInputs, leds, output_is_on};
use brushwork_mcp_wire::packet_serial::{Generation, scale};
use brushwork_mcp_wire::roboclaw::PinFunction;
use brushwork_plant::ClampDrive;
use brushwork_plant::bridge::PwmMode;
use brushwork_plant::world::{UnitFault, World};
use brushwork_values::Motor;

/// The over-voltage output action (command 137).
const ACTION_OVER_VOLTAGE: u8 = 7;
/// The over-voltage output opens this far below the voltage at which it closes. Assumed.
const OVER_VOLTAGE_HYSTERESIS_VOLTS: f64 = 0.5;

impl Firmware {
    /// Compares the readings with the limits and stops the motors for good where an error came up.
    pub(super) fn update_protection(&mut self) {
        let observed = self.observed();
        let limits = self.limits();
        self.protection.update(&observed, &limits);
        for motor in Motor::BOTH {
            self.protection.over_current[motor.index()] |= self.channels[motor.index()].is_current_limited();
        }
        self.update_loop_faults();
        self.update_estop();
    }

    /// The button acts at once, between ticks too. One that is wired to a pin acts through that pin's action.
    pub(super) fn update_estop(&mut self) {
        let button = self.readings.estop_pressed && !self.estop_is_on_a_pin;
        self.estop.update(button || self.triggers.estop, self.estop_reset());
        let is_held = self.is_stopped() || self.has_latched_error();
        if is_held && !self.is_held {
            self.stop_both();
        }
        self.is_held = is_held;
    }

    /// Whether an emergency stop holds the motors.
    pub(super) fn is_stopped(&self) -> bool {
        self.estop.is_tripped() || self.control.is_held()
    }

    /// How the emergency stop is released.
    pub(super) fn estop_reset(&self) -> EStopReset {
        EStopReset::from_wire(self.settings.unit.estop_lock, self.generation == Generation::Gen4)
    }

    /// What protection makes of both bridges.
    pub(super) fn bridge_override(&self) -> BridgeOverride {
        if self.is_stopped() { BridgeOverride::Brake } else { self.protection.bridge() }
    }

    /// Share of the current limits that temperature leaves.
    pub(super) fn current_limit_share(&self) -> f64 {
        self.protection.current_limit_share(&self.observed())
    }

    /// LEDs, digital outputs and the brake resistor.
    pub(super) fn update_outputs(&mut self, world: &mut World) {
        let states = [self.channels[0].state(), self.channels[1].state()];
        let duties = Motor::BOTH.map(|motor| self.channels[motor.index()].duty_raw());
        let last_byte = self.ports.last_bytes.iter().flatten().max().copied();
        self.leds = leds(&LedInputs {
            up_for: self.up_for(),
            since_last_byte: last_byte.map(|last| self.now.saturating_sub(last)),
            detected_cells: self.battery.map(|battery| battery.cells),
            driving: states.iter().any(|state| state.active),
            in_boot_mode: self.loader.is_some(),
            conditions: self.conditions(),
        });
        let inputs = OutputInputs {
            motor_on: states.map(|state| state.active),
            motor_reversed: duties.map(|duty| duty < 0),
            over_voltage: self.protection.main_high_warning || self.protection.main_high_error,
            over_temperature: self.protection.temperature_warning || self.protection.temperature_2_warning,
            leds: self.leds,
        };
        let settings = self.settings.outputs.iter().zip(&self.overrides);
        for (state, (settings, over)) in self.outputs.iter_mut().zip(settings) {
            *state = over.unwrap_or_else(|| output_is_on(settings, &inputs));
        }
        world.set_pwm_modes(Motor::BOTH.map(|motor| self.pwm_mode(motor)));
        if self.is_roboclaw() {
            self.outputs = self.control_outputs(inputs.over_voltage);
        }
        if let Some(dout) = world.brake_resistor_dout() {
            world.set_clamp(self.clamp_drive(dout));
        }
    }

    /// How a bridge makes its mean voltage (command 148).
    fn pwm_mode(&self, motor: Motor) -> PwmMode {
        const SIGN_MAGNITUDE: u8 = 1;
        match self.settings.motors[motor.index()].pwm_mode {
            SIGN_MAGNITUDE => PwmMode::SignMagnitude,
            _ => PwmMode::LockedAntiphase,
        }
    }

    /// Whether a digital output is on, for scripts: what was set last counts at once.
    pub(super) fn output_is_on(&self, index: usize) -> bool {
        let over = self.overrides.get(index).copied().flatten();
        over.or_else(|| self.outputs.get(index).copied()).unwrap_or(false)
    }

    /// Sets a digital output, which overrides its action (MCP manual 1.9.9). Assumed: until the action is set again or the unit starts
    /// anew, whether or not the script goes on.
    pub(super) fn override_output(&mut self, index: usize, on: bool) {
        if let Some(over) = self.overrides.get_mut(index) {
            *over = Some(on);
        }
    }

    /// Sets the action of a digital output, from which on it follows that again; false for an output that is not there.
    pub(super) fn set_output_action(&mut self, index: usize, action: u8) -> bool {
        let Some(output) = self.settings.outputs.get_mut(index) else { return false };
        output.action = action;
        self.overrides[index] = None;
        true
    }

    /// An output with the plain over-voltage action follows the link faster than a tick; any other is as it is.
    fn clamp_drive(&self, dout: usize) -> ClampDrive {
        let settings = self.settings.outputs.get(dout);
        let is_overridden = self.overrides.get(dout).copied().flatten().is_some();
        let has_action =
            settings.is_some_and(|output| output.action == ACTION_OVER_VOLTAGE && !output.inverted);
        let is_control = self.is_roboclaw() && self.output_function(dout) == PinFunction::VoltageClamp;
        if !is_overridden && has_action || is_control {
            let on_volts = self.main_volts_limits().1;
            return ClampDrive::Above { on_volts, off_volts: on_volts - OVER_VOLTAGE_HYSTERESIS_VOLTS };
        }
        if self.outputs.get(dout) == Some(&true) { ClampDrive::On } else { ClampDrive::Off }
    }

    fn has_latched_error(&self) -> bool {
        let limits = &self.protection;
        limits.main_high_error
            || limits.logic_high_error
            || limits.logic_low_error
            || limits.has_bridge_fault()
    }

    /// A speed or position error beyond its limit stops its motor. Assumed: the fault shows until the motor's next command.
    fn update_loop_faults(&mut self) {
        for motor in Motor::BOTH {
            let errors = self.channels[motor.index()].errors();
            if errors.speed_exceeded || errors.position_exceeded {
                self.command(motor, MotionCommand::SafeStop);
                self.loop_faults[motor.index()] =
                    LoopFaults { speed: errors.speed_exceeded, position: errors.position_exceeded };
            }
        }
    }

    fn observed(&self) -> Observed {
        let Readings { main_volts, logic_volts, celsius, amps, unit_faults, .. } = self.readings;
        let driving = |motor: Motor| {
            let duty = f64::from(self.channels[motor.index()].duty_raw());
            if duty == 0.0 { 0.0 } else { amps[motor.index()] * duty.signum() }
        };
        Observed {
            main_volts,
            logic_volts,
            temperature_celsius: celsius[0],
            temperature_2_celsius: self.model.second_temperature.then_some(celsius[1]),
            driving_amps: Motor::BOTH.map(driving),
            driver_fault: [UnitFault::M1Driver, UnitFault::M2Driver].map(|fault| unit_faults.has(fault)),
            short_circuit: [UnitFault::M1Current, UnitFault::M2Current].map(|fault| unit_faults.has(fault)),
        }
    }

    /// The main battery limits in force.
    fn main_volts_limits(&self) -> (f64, f64) {
        let battery = &self.settings.battery;
        let volts = |tenths: u16| f64::from(tenths) * scale::VOLTAGE_VOLTS;
        let own = match self.battery {
            Some(detected) => detected.limits_volts(),
            None => (volts(battery.main_min_tenths), volts(battery.main_max_tenths)),
        };
        self.control.battery_volts(own, battery.main_auto_offset_tenths)
    }

    fn limits(&self) -> Limits {
        let battery = &self.settings.battery;
        let volts = |tenths: u16| f64::from(tenths) * scale::VOLTAGE_VOLTS;
        let motion = Motor::BOTH.map(|motor| self.motion_settings(motor));
        Limits {
            main_volts: self.main_volts_limits(),
            rated_main_volts: self.model.main_volts,
            logic_volts: (volts(battery.logic_min_tenths), volts(battery.logic_max_tenths)),
            max_amps: motion.map(|settings| settings.max_current_amps()),
            max_braking_amps: motion.map(|settings| settings.braking_current_amps()),
        }
    }
}
