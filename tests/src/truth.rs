//! The simulator's truth as JSON: what its memory and its machine hold, read past the wire.
//!
//! The keys are those that the scripts in `tests/foreign` look up; numbers are raw, as the unit keeps them.

use std::f64::consts::TAU;

use brushwork_mcp_sim::controller::{Controller, UnitView};
use brushwork_mcp_sim::settings::{
    ControlInput, MotorRegisters, Settings, SignalSettings, StreamSettings, USER_WORDS,
};
use brushwork_mcp_sim::signals::SignalValues;
use brushwork_plant::ShaftSide;
use brushwork_plant::bridge::BridgeOutput;
use brushwork_values::Motor;
use serde_json::{Value, json};

/// Everything: settings, EEPROM, and what the machine does at this moment.
///
/// # Panics
/// When the unit has no power: then it knows nothing.
#[must_use]
pub fn of(controller: &Controller) -> Value {
    let unit = controller.unit().expect("the unit has power");
    let view = controller.view();
    let tenths = |value: f64| (value * 10.0).round() as i64;
    json!({
        "version": unit.version_text(),
        "settings": settings(&controller.settings()),
        "saved_settings": settings(&controller.stored_settings()),
        "user_memory": (0..USER_WORDS).filter_map(|word| u8::try_from(word).ok())
            .map(|word| controller.eeprom().user_word(word)).collect::<Vec<u16>>(),
        "main_tenths": tenths(view.bus_volts),
        "logic_tenths": tenths(view.logic_volts),
        "temperature_tenths": [tenths(view.board_celsius[0]), second_sensor(controller, tenths(view.board_celsius[1]))],
        "status_word": unit.status_word(),
        "estop": unit.estop_is_tripped(),
        "estop_pressed": unit.readings().estop_pressed,
        "aux_duties": unit.auxiliary_duties(),
        "signals": unit.signal_values().iter().map(signal_values).collect::<Vec<Value>>(),
        "can_error_state": unit.can_error_state(),
        "motors": Motor::BOTH.map(|motor| live_motor(controller, &unit, motor)),
    })
}

/// Speed of a motor's shaft as its encoder would count it, from the motion of the machine.
#[must_use]
pub fn speed_counts_per_s(controller: &Controller, motor: Motor) -> f64 {
    let encoder = &controller.config().world.axes[motor.index()].encoder;
    let shaft = &controller.view().axes[motor.index()].truth;
    let radians_per_second = match encoder.side {
        ShaftSide::Motor => shaft.motor_radians_per_second,
        ShaftSide::Load => shaft.load_radians_per_second,
    };
    radians_per_second * encoder.counts_per_turn / TAU
}

/// What a sensor 2 would read, or the 0 of a model that has none (MCP manual 1.2.10).
fn second_sensor(controller: &Controller, tenths: i64) -> i64 {
    if controller.config().model.second_temperature { tenths } else { 0 }
}

/// The bridge's duty in raw units; 0 while it brakes or coasts.
fn duty_raw(controller: &Controller, motor: Motor) -> i64 {
    match controller.view().axes[motor.index()].output {
        BridgeOutput::Duty(duty) => (duty * 32_767.0).round() as i64,
        BridgeOutput::Brake | BridgeOutput::Coast => 0,
    }
}

fn live_motor(controller: &Controller, unit: &UnitView<'_>, motor: Motor) -> Value {
    let channel = unit.channel(motor);
    let speed = speed_counts_per_s(controller, motor);
    let amps = controller.view().axes[motor.index()].truth.amps;
    json!({
        "encoder_counts": channel.encoder().position(),
        "encoder_status": channel.encoder().status(),
        "speed_counts_per_s": speed,
        "speed_status": u8::from(channel.speeds().filtered < 0),
        "duty_raw": duty_raw(controller, motor),
        "current_hundredths": (amps * 100.0).round() as i64,
        "buffer": channel.buffer_length(),
        "speed_error_counts_per_s": channel.errors().speed_counts_per_s,
        "position_error_counts": channel.errors().position_counts,
    })
}

fn signal_values(values: &SignalValues) -> Value {
    json!({
        "command": values.command,
        "position": values.position,
        "percent": values.percent,
        "speed": values.speed,
        "speeds": values.average_speed,
    })
}

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
