//! MOTOR...: settings and state of both channels. Assumed: the values are raw as on the wire of the command that carries them.

use super::super::ScriptHost;
use super::Binding;
use crate::motion::{BUFFER_EMPTY, Channel, ChannelState, MotionSettings};
use brushwork_protocol::packet_serial::Motor;

pub const BINDINGS: &[Binding] = &[
    ("MOTORFLAGS", flags, None),
    ("MOTORPWM", |host, index| of(host, index, |channel| i32::from(channel.duty_raw())), None),
    ("MOTORCURRENT", |host, index| current(host, index), None),
    ("MOTORTARGETPWM", |host, index| state(host, index).target_duty_raw as u32, None),
    (
        "MOTORVELKP",
        |host, index| motion(host, index).velocity_p_raw,
        Some(|host, index, value| set(host, index, |motion| motion.velocity_p_raw = value)),
    ),
    (
        "MOTORVELKI",
        |host, index| motion(host, index).velocity_i_raw,
        Some(|host, index, value| set(host, index, |motion| motion.velocity_i_raw = value)),
    ),
    (
        "MOTORVELKD",
        |host, index| motion(host, index).velocity_d_raw,
        Some(|host, index, value| set(host, index, |motion| motion.velocity_d_raw = value)),
    ),
    (
        "MOTORVELQPPS",
        |host, index| motion(host, index).qpps,
        Some(|host, index, value| set(host, index, |motion| motion.qpps = value)),
    ),
    ("MOTORTARGETSPEED", |host, index| state(host, index).target_speed_counts_per_s as u32, None),
    ("MOTORDISTANCE", |host, index| state(host, index).distance_left_counts, None),
    (
        "MOTORPOSKP",
        |host, index| motion(host, index).position_p_raw,
        Some(|host, index, value| set(host, index, |motion| motion.position_p_raw = value)),
    ),
    (
        "MOTORPOSKI",
        |host, index| motion(host, index).position_i_raw,
        Some(|host, index, value| set(host, index, |motion| motion.position_i_raw = value)),
    ),
    (
        "MOTORPOSKIMAX",
        |host, index| motion(host, index).position_max_i,
        Some(|host, index, value| set(host, index, |motion| motion.position_max_i = value)),
    ),
    (
        "MOTORPOSKD",
        |host, index| motion(host, index).position_d_raw,
        Some(|host, index, value| set(host, index, |motion| motion.position_d_raw = value)),
    ),
    (
        "MOTORPOSMAX",
        |host, index| motion(host, index).position_max_counts as u32,
        Some(|host, index, value| set(host, index, |motion| motion.position_max_counts = value as i32)),
    ),
    (
        "MOTORPOSMIN",
        |host, index| motion(host, index).position_min_counts as u32,
        Some(|host, index, value| set(host, index, |motion| motion.position_min_counts = value as i32)),
    ),
    (
        "MOTORPOSDEADZONE",
        |host, index| motion(host, index).position_deadzone_counts,
        Some(|host, index, value| set(host, index, |motion| motion.position_deadzone_counts = value)),
    ),
    ("MOTORTARGETPOS", |host, index| state(host, index).target_position_counts as u32, None),
    ("MOTORACCEL", |host, index| state(host, index).acceleration, None),
    ("MOTORDECCEL", |host, index| state(host, index).deceleration, None),
    ("MOTORSPEED", |host, index| state(host, index).speed_setpoint_counts_per_s as u32, None),
    ("MOTORDEFAULTACCEL", |host, index| motion(host, index).default_accel_raw, Some(set_default_accel)),
    (
        "MOTORMAXCURRENT",
        |host, index| motion(host, index).max_current_raw,
        Some(|host, index, value| set(host, index, |motion| motion.max_current_raw = value)),
    ),
    (
        "MOTORMINCURRENT",
        |host, index| motion(host, index).min_current_raw as u32,
        Some(|host, index, value| set(host, index, |motion| motion.min_current_raw = value as i32)),
    ),
    (
        "MOTORL",
        |host, index| motion(host, index).inductance_raw,
        Some(|host, index, value| set(host, index, |motion| motion.inductance_raw = value)),
    ),
    (
        "MOTORR",
        |host, index| motion(host, index).resistance_raw,
        Some(|host, index, value| set(host, index, |motion| motion.resistance_raw = value)),
    ),
    (
        "MOTORENCPOS",
        |host, index| of(host, index, |channel| channel.encoder().position()),
        Some(|host, index, value| {
            if let Some(channel) = host.unit.channels.get_mut(index) {
                channel.encoder_mut().set(value);
            }
        }),
    ),
    ("MOTORENCSPEED", |host, index| of(host, index, |channel| channel.speeds().filtered), None),
    ("MOTORENCSPEEDS", |host, index| of(host, index, |channel| channel.speeds().average), None),
    ("MOTORENCSTATUS", |host, index| of(host, index, |channel| i32::from(channel.encoder().status())), None),
    (
        "MOTORENCPIN",
        |host, index| host.unit.settings.motors.get(index).map_or(0, |motor| motor.encoder_mode.into()),
        Some(|host, index, value| {
            if let Some(motor) = host.unit.settings.motors.get_mut(index) {
                motor.encoder_mode = value as u8;
            }
        }),
    ),
    ("MOTORBUFFER", |host, index| of(host, index, |channel| i32::from(channel.buffer_length())), None),
];

fn of(host: &ScriptHost<'_>, index: usize, read: impl Fn(&Channel) -> i32) -> u32 {
    host.unit.channels.get(index).map_or(0, read) as u32
}

fn state(host: &ScriptHost<'_>, index: usize) -> ChannelState {
    host.unit.channels.get(index).map(Channel::state).unwrap_or_default()
}

fn motion(host: &ScriptHost<'_>, index: usize) -> MotionSettings {
    host.unit.settings.motors.get(index).map(|motor| motor.motion).unwrap_or_default()
}

fn set(host: &mut ScriptHost<'_>, index: usize, set: impl FnOnce(&mut MotionSettings)) {
    if let Some(motor) = host.unit.settings.motors.get_mut(index) {
        set(&mut motor.motion);
    }
}

/// As command 68 of generation 1, which has one rate for both directions of a ramp.
fn set_default_accel(host: &mut ScriptHost<'_>, index: usize, value: u32) {
    set(host, index, |motion| {
        motion.default_accel_raw = value;
        motion.default_decel_raw = value;
    });
}

fn current(host: &ScriptHost<'_>, index: usize) -> u32 {
    Motor::BOTH.get(index).map_or(0, |motor| host.unit.current_raw(*motor)) as u32
}

fn flags(host: &mut ScriptHost<'_>, index: usize) -> u32 {
    let (Some(channel), Some(triggers)) =
        (host.unit.channels.get(index), host.unit.triggers.motors.get(index))
    else {
        return 0;
    };
    let state = channel.state();
    let nothing_waits = matches!(channel.buffer_length(), 0 | BUFFER_EMPTY);
    [
        (0x0001, triggers.safe_stop || triggers.off),
        (0x0002, host.unit.reversed[index]),
        (0x0004, triggers.forward_limit),
        (0x0008, triggers.backward_limit),
        (0x0010, triggers.at_home),
        (0x0020, host.unit.estop.is_tripped()),
        (0x0040, state.active),
        (0x0080, state.velocity_loop),
        (0x0100, state.position_loop),
        (0x0200, nothing_waits),
        (0x0400, state.distance_active),
    ]
    .into_iter()
    .fold(0, |word, (bit, is_set)| if is_set { word | bit } else { word })
}
