//! The simulator's truth as JSON: what its memory and its machine hold, read past the wire.
//!
//! The keys are those that the scripts in `tests/foreign` look up; numbers are raw, as the unit keeps them.

use brushwork_sim::settings::{ControlInput, MotorRegisters, Settings, SignalSettings, StreamSettings};
use serde_json::{Value, json};

/// Every setting of a unit.
#[must_use]
pub fn settings(settings: &Settings) -> Value {
    let unit = &settings.unit;
    let battery = &settings.battery;
    json!({
        "address": unit.address,
        "mixed": unit.mixed,
        "serial_timeout_tenths": unit.serial_timeout_tenths,
        "estop_lock": unit.estop_lock,
        "script_autorun_ms": unit.script_autorun_ms,
        "can_node_id": unit.can_node_id,
        "config_word": unit.config_word,
        "serial_number": unit.serial_number,
        "main_min_tenths": battery.main_min_tenths,
        "main_max_tenths": battery.main_max_tenths,
        "main_auto_offset_tenths": battery.main_auto_offset_tenths,
        "logic_min_tenths": battery.logic_min_tenths,
        "logic_max_tenths": battery.logic_max_tenths,
        "main_offset_tenths": battery.main_offset_tenths,
        "logic_offset_tenths": battery.logic_offset_tenths,
        "motors": settings.motors.iter().map(motor).collect::<Vec<Value>>(),
        "outputs": settings.outputs.iter().map(|output| output.action).collect::<Vec<u8>>(),
        "priority": settings.priority,
        "signals": settings.signals.iter().map(signal).collect::<Vec<Value>>(),
        "streams": settings.streams.iter().map(stream).collect::<Vec<Value>>(),
        "pin_functions": settings.roboclaw.pin_functions,
        "control_inputs": settings.roboclaw.inputs.iter().flat_map(control_input).collect::<Vec<u32>>(),
    })
}

fn motor(registers: &MotorRegisters) -> Value {
    let motion = &registers.motion;
    json!({
        "velocity_p_raw": motion.velocity_p_raw,
        "velocity_i_raw": motion.velocity_i_raw,
        "velocity_d_raw": motion.velocity_d_raw,
        "qpps": motion.qpps,
        "position_p_raw": motion.position_p_raw,
        "position_i_raw": motion.position_i_raw,
        "position_d_raw": motion.position_d_raw,
        "position_max_i": motion.position_max_i,
        "position_deadzone_counts": motion.position_deadzone_counts,
        "position_min_counts": motion.position_min_counts,
        "position_max_counts": motion.position_max_counts,
        "default_accel_raw": motion.default_accel_raw,
        "default_decel_raw": motion.default_decel_raw,
        "default_speed_raw": motion.default_speed_raw,
        "inductance_raw": motion.inductance_raw,
        "resistance_raw": motion.resistance_raw,
        "max_current_raw": motion.max_current_raw,
        "min_current_raw": motion.min_current_raw,
        "speed_error_limit": motion.speed_error_limit,
        "position_error_limit": motion.position_error_limit,
        "pwm_idle_raw": motion.pwm_idle_raw,
        "pwm_mode": registers.pwm_mode,
        "encoder_mode": registers.encoder_mode,
        "homing_timeout_ticks": registers.homing_timeout_ticks,
    })
}

fn signal(signal: &SignalSettings) -> Value {
    json!({
        "type": signal.kind,
        "mode": signal.mode,
        "target": signal.target,
        "min_action": signal.min_action,
        "max_action": signal.max_action,
        "lowpass": signal.low_pass,
        "timeout": signal.timeout_ms,
        "loadhome": signal.load_home,
        "min_val": signal.min,
        "max_val": signal.max,
        "center": signal.center,
        "deadband": signal.deadband,
        "powerexp": signal.power_exp_raw,
        "minout": signal.min_output,
        "maxout": signal.max_output,
        "powermin": signal.power_min,
        "potentiometer": signal.potentiometer,
    })
}

fn stream(stream: &StreamSettings) -> Value {
    json!({ "type": stream.kind, "baudrate": stream.rate_bps, "timeout": stream.timeout_ms })
}

/// In the order of command 76 in generation 4.
fn control_input(input: &ControlInput) -> [u32; 7] {
    [
        u32::from(input.reverse_deadband),
        u32::from(input.forward_deadband),
        u32::from(input.reverse_limit),
        u32::from(input.forward_limit),
        u32::from(input.center),
        u32::from(input.min),
        u32::from(input.max),
    ]
}
