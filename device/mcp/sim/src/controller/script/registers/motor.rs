//! MOTOR...: settings and state of both channels. Assumed: the values are raw as on the wire of the command that carries them.

use super::super::ScriptHost;
use super::Binding;
use crate::motion::{BUFFER_EMPTY, Channel, ChannelState, MotionSettings};
use brushwork_values::Motor;

/// A setting that a script reads and writes as it lies on the wire.
macro_rules! setting {
    ($name:literal, $field:ident) => {
        (
            $name,
            |host, index| motion(host, index).$field,
            Some(|host, index, value| set(host, index, |motion| motion.$field = value)),
        )
    };
    ($name:literal, $field:ident, signed) => {
        (
            $name,
            |host, index| motion(host, index).$field as u32,
            Some(|host, index, value| set(host, index, |motion| motion.$field = value as i32)),
        )
    };
}

pub const BINDINGS: &[Binding] = &[
    ("MOTORFLAGS", flags, None),
    ("MOTORPWM", |host, index| of(host, index, |channel| i32::from(channel.duty_raw())), None),
    ("MOTORCURRENT", |host, index| current(host, index), None),
    ("MOTORTARGETPWM", |host, index| state(host, index).target_duty_raw as u32, None),
    setting!("MOTORVELKP", velocity_p_raw),
    setting!("MOTORVELKI", velocity_i_raw),
    setting!("MOTORVELKD", velocity_d_raw),
    setting!("MOTORVELQPPS", qpps),
    ("MOTORTARGETSPEED", |host, index| state(host, index).target_speed_counts_per_s as u32, None),
    ("MOTORDISTANCE", |host, index| state(host, index).distance_left_counts, None),
    setting!("MOTORPOSKP", position_p_raw),
    setting!("MOTORPOSKI", position_i_raw),
    setting!("MOTORPOSKIMAX", position_max_i),
    setting!("MOTORPOSKD", position_d_raw),
    setting!("MOTORPOSMAX", position_max_counts, signed),
    setting!("MOTORPOSMIN", position_min_counts, signed),
    setting!("MOTORPOSDEADZONE", position_deadzone_counts),
    ("MOTORTARGETPOS", |host, index| state(host, index).target_position_counts as u32, None),
    ("MOTORACCEL", |host, index| state(host, index).acceleration, None),
    ("MOTORDECCEL", |host, index| state(host, index).deceleration, None),
    ("MOTORSPEED", |host, index| state(host, index).speed_setpoint_counts_per_s as u32, None),
    ("MOTORDEFAULTACCEL", |host, index| motion(host, index).default_accel_raw, Some(set_default_accel)),
    setting!("MOTORMAXCURRENT", max_current_raw),
    setting!("MOTORMINCURRENT", min_current_raw, signed),
    setting!("MOTORL", inductance_raw),
    setting!("MOTORR", resistance_raw),
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
