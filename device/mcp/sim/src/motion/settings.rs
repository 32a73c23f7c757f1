//! The settings of one channel as the loops use them: raw wire values, scaled here and nowhere else in this module.

use super::ControlLaw;
use brushwork_mcp_wire::packet_serial::scale;

/// Raw duty of 100 %; 0 to 32767 (MCP manual, command 32).
pub const FULL_DUTY_RAW: i32 = scale::FULL_DUTY_RAW as i32;
/// Highest raw duty acceleration: 100 % to -100 % in 100 ms (MCP manual, command 52).
pub const MAX_DUTY_ACCELERATION: u32 = scale::MAX_DUTY_ACCEL_RAW as u32;

/// Settings of one channel, raw as they travel on the wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MotionSettings {
    /// Velocity P x 65536 (command 28).
    pub velocity_p_raw: u32,
    /// Velocity I x 65536.
    pub velocity_i_raw: u32,
    /// Velocity D x 65536.
    pub velocity_d_raw: u32,
    /// Speed at 100 % duty, counts/s. 0 turns every closed loop's output off.
    pub qpps: u32,
    /// Position P x [`ControlLaw::position_gain_scale`] (command 61).
    pub position_p_raw: u32,
    /// Position I, scaled like P.
    pub position_i_raw: u32,
    /// Position D, scaled like P.
    pub position_d_raw: u32,
    /// Bound of the position integral. Assumed: in counts times the unit of [`ControlLaw::gain_timing`].
    pub position_max_i: u32,
    /// Errors up to this many counts count as none.
    pub position_deadzone_counts: u32,
    /// Lowest position, counts.
    pub position_min_counts: i32,
    /// Highest position, counts. Minimum = maximum = 0 allows no position move at all.
    pub position_max_counts: i32,
    /// Duty acceleration of commands without their own (command 68), 32768 = 100 %/s.
    pub default_accel_raw: u32,
    /// Duty deceleration of commands without their own (command 68 from generation 2); in generation 1 the same as the
    /// acceleration.
    pub default_decel_raw: u32,
    /// Speed of position commands without their own as a share of QPPS, 32768 = 100 % (command 70).
    pub default_speed_raw: u16,
    /// Motor inductance, henry x 2^24 (command 128). With the resistance non-zero too, duty commands become torque.
    pub inductance_raw: u32,
    /// Motor resistance, ohm x 2^24 (command 128).
    pub resistance_raw: u32,
    /// Highest driving current, 10 mA (command 133). 0 = no limit.
    pub max_current_raw: u32,
    /// Highest braking (regenerated) current, 10 mA (command 133), as a negative value or its magnitude.
    /// Assumed: 0 means the same as the maximum, since clients send 0 and motors still brake.
    pub min_current_raw: i32,
    /// Speed error that trips, counts/s (command 109); 0 = off.
    pub speed_error_limit: u32,
    /// Position error that trips, counts (command 112); 0 = off.
    pub position_error_limit: u32,
    /// PWM idle (command 160): bit 7 freewheel, low 7 bits delay in 0.1 s.
    /// Assumed: once the duty has been 0 for the delay outside closed loops, the bridge opens if bit 7 is set.
    pub pwm_idle_raw: u8,
}

impl Default for MotionSettings {
    /// Factory values of the velocity loop (MCP manual, command 28), all position values 0 (command 61), default
    /// acceleration 655360 (MCP manual, MOTORDEFAULTACCEL) held to the documented maximum, no current limit.
    fn default() -> Self {
        MotionSettings {
            velocity_p_raw: 0x0001_0000,
            velocity_i_raw: 0x0000_8000,
            velocity_d_raw: 0x0000_4000,
            qpps: 44_000,
            position_p_raw: 0,
            position_i_raw: 0,
            position_d_raw: 0,
            position_max_i: 0,
            position_deadzone_counts: 0,
            position_min_counts: 0,
            position_max_counts: 0,
            default_accel_raw: MAX_DUTY_ACCELERATION,
            default_decel_raw: MAX_DUTY_ACCELERATION,
            default_speed_raw: 32_767,
            inductance_raw: 0,
            resistance_raw: 0,
            max_current_raw: 0,
            min_current_raw: 0,
            speed_error_limit: 0,
            position_error_limit: 0,
            pwm_idle_raw: 0,
        }
    }
}

/// Gains of one loop as the loop multiplies with them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    /// Proportional gain.
    pub p: f64,
    /// Integral gain, per tick or per second as [`ControlLaw::gain_timing`] says.
    pub i: f64,
    /// Derivative gain, in ticks or seconds.
    pub d: f64,
}

impl MotionSettings {
    /// Whether duty commands act as current setpoints: L and R both non-zero (MCP manual 1.2.11, MOTORL).
    #[must_use]
    pub fn torque_mode(&self) -> bool {
        self.inductance_raw != 0 && self.resistance_raw != 0
    }

    /// Whether position moves act on the duty directly: velocity P, I and D all 0 (MCP manual 2.4.7).
    #[must_use]
    pub fn simple_position(&self) -> bool {
        self.velocity_p_raw == 0 && self.velocity_i_raw == 0 && self.velocity_d_raw == 0
    }

    /// Whether any position move is allowed: not while minimum and maximum are both 0 (vendor forum).
    #[must_use]
    pub fn allows_position(&self) -> bool {
        self.position_min_counts != 0 || self.position_max_counts != 0
    }

    /// `position` brought between minimum and maximum, counts. With the limits the wrong way round: unchanged.
    #[must_use]
    pub fn clamp_position(&self, position: i32) -> i32 {
        if self.position_min_counts <= self.position_max_counts {
            position.clamp(self.position_min_counts, self.position_max_counts)
        } else {
            position
        }
    }

    /// Position of a percent command: -32767 is the minimum, 32767 the maximum (commands 125 to 127).
    #[must_use]
    pub fn percent_position(&self, percent_raw: i16) -> i32 {
        let share = i64::from(percent_raw).clamp(-32_767, 32_767) + 32_767;
        let (low, high) = (i64::from(self.position_min_counts), i64::from(self.position_max_counts));
        let offset = (high - low) * share;
        let rounded = (2 * offset + 65_534 * offset.signum()) / (2 * 65_534);
        i32::try_from(low + rounded).unwrap_or(self.position_max_counts)
    }

    /// Speed of position commands that carry none, counts/s.
    #[must_use]
    pub fn default_speed(&self) -> u32 {
        scaled_share(self.qpps, u32::from(self.default_speed_raw), scale::DEFAULT_SPEED_RAW)
    }

    /// Acceleration of position commands that carry none, counts/s^2. Assumed: the default duty acceleration as a share of
    /// QPPS per second.
    #[must_use]
    pub fn default_acceleration(&self) -> u32 {
        scaled_share(self.qpps, self.default_accel_raw, scale::DUTY_ACCEL_RAW_PER_SECOND)
    }

    /// Like [`MotionSettings::default_acceleration`] from the default deceleration, counts/s^2.
    #[must_use]
    pub fn default_deceleration(&self) -> u32 {
        scaled_share(self.qpps, self.default_decel_raw, scale::DUTY_ACCEL_RAW_PER_SECOND)
    }

    /// Highest driving current, A; `None` = no limit.
    #[must_use]
    pub fn max_current_amps(&self) -> Option<f64> {
        (self.max_current_raw != 0).then(|| f64::from(self.max_current_raw) * scale::CURRENT_AMPS)
    }

    /// Highest braking current as a magnitude, A; `None` = no limit.
    #[must_use]
    pub fn braking_current_amps(&self) -> Option<f64> {
        if self.min_current_raw == 0 {
            return self.max_current_amps();
        }
        Some(f64::from(self.min_current_raw.unsigned_abs()) * scale::CURRENT_AMPS)
    }

    /// Motor inductance, H.
    #[must_use]
    pub fn inductance_henries(&self) -> f64 {
        f64::from(self.inductance_raw) / scale::INDUCTANCE_RESISTANCE
    }

    /// Motor resistance, ohm.
    #[must_use]
    pub fn resistance_ohms(&self) -> f64 {
        f64::from(self.resistance_raw) / scale::INDUCTANCE_RESISTANCE
    }

    /// Gains of the velocity loop; counts/s in, counts/s out.
    #[must_use]
    pub fn velocity_gains(&self) -> Gains {
        scaled_gains([self.velocity_p_raw, self.velocity_i_raw, self.velocity_d_raw], scale::VELOCITY_GAIN)
    }

    /// Gains of the position loop; counts in, counts/s out.
    #[must_use]
    pub fn position_gains(&self, law: &ControlLaw) -> Gains {
        scaled_gains([self.position_p_raw, self.position_i_raw, self.position_d_raw], law.position_gain_scale)
    }
}

fn scaled_share(whole: u32, share_raw: u32, full_raw: f64) -> u32 {
    // The cast saturates.
    (f64::from(whole) * f64::from(share_raw) / full_raw) as u32
}

fn scaled_gains(raw: [u32; 3], scale: f64) -> Gains {
    let [p, i, d] = raw.map(|gain| f64::from(gain) / scale);
    Gains { p, i, d }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percent_positions_map_to_minimum_middle_and_maximum() {
        let settings = MotionSettings {
            position_min_counts: -1000,
            position_max_counts: 3000,
            ..MotionSettings::default()
        };
        for (percent, expected) in
            [(-32_767, -1000), (i16::MIN, -1000), (0, 1000), (32_767, 3000), (16_384, 2000), (-16_384, 0)]
        {
            assert_eq!(settings.percent_position(percent), expected, "percent {percent}");
        }
    }

    #[test]
    fn percent_positions_span_the_whole_32_bit_range_without_overflow() {
        let settings = MotionSettings {
            position_min_counts: i32::MIN,
            position_max_counts: i32::MAX,
            ..MotionSettings::default()
        };
        assert_eq!(settings.percent_position(-32_767), i32::MIN);
        assert_eq!(settings.percent_position(32_767), i32::MAX);
    }

    #[test]
    fn wire_gains_scale_as_documented() {
        let settings = MotionSettings { position_p_raw: 2048, ..MotionSettings::default() };
        let velocity = settings.velocity_gains();
        assert_eq!((velocity.p, velocity.i, velocity.d), (1.0, 0.5, 0.25));
        assert_eq!(settings.position_gains(&ControlLaw::default()).p, 2.0);
        let other = ControlLaw { position_gain_scale: 2048.0, ..ControlLaw::default() };
        assert_eq!(settings.position_gains(&other).p, 1.0);
    }

    #[test]
    fn a_minimum_current_of_zero_brakes_with_the_maximum() {
        let settings = MotionSettings { max_current_raw: 500, ..MotionSettings::default() };
        assert_eq!(settings.braking_current_amps(), Some(5.0));
        for raw in [-200, 200] {
            assert_eq!(MotionSettings { min_current_raw: raw, ..settings }.braking_current_amps(), Some(2.0));
        }
    }

    #[test]
    fn default_speed_and_acceleration_are_shares_of_qpps() {
        let settings = MotionSettings {
            qpps: 10_000,
            default_speed_raw: 16_384,
            default_accel_raw: 65_536,
            default_decel_raw: 32_768,
            ..MotionSettings::default()
        };
        assert_eq!(settings.default_speed(), 5_000);
        assert_eq!(settings.default_acceleration(), 20_000);
        assert_eq!(settings.default_deceleration(), 10_000);
    }
}
