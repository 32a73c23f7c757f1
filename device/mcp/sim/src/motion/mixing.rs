//! Duties of the 7-bit and mixed commands (MCP manual 2.2.12 and 2.2.13).

use super::FULL_DUTY_RAW;

/// Duty of commands 0 and 4: 0 stop, 127 full forward. Values above 127 count as 127.
#[must_use]
pub fn seven_bit_forward(value: u8) -> i16 {
    share_of_full(i32::from(value.min(127)), 127)
}

/// Duty of commands 1 and 5: 0 stop, 127 full backward.
#[must_use]
pub fn seven_bit_backward(value: u8) -> i16 {
    -seven_bit_forward(value)
}

/// Duty of commands 6, 7, 12 and 13: 0 full backward (left), 64 stop, 127 full forward (right).
#[must_use]
pub fn seven_bit_centered(value: u8) -> i16 {
    let offset = i32::from(value.min(127)) - 64;
    share_of_full(offset, if offset < 0 { 64 } else { 63 })
}

/// The drive and turn values of mixed mode. The motors run once both are known (MCP manual 2.2.13).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mixer {
    drive_raw: Option<i16>,
    turn_raw: Option<i16>,
}

impl Mixer {
    /// Sets the drive value, forward positive; returns the duties of both motors once the turn value is known too.
    pub fn drive(&mut self, duty_raw: i16) -> Option<[i16; 2]> {
        self.drive_raw = Some(duty_raw);
        self.duties()
    }

    /// Sets the turn value, right positive; returns the duties of both motors once the drive value is known too.
    pub fn turn(&mut self, duty_raw: i16) -> Option<[i16; 2]> {
        self.turn_raw = Some(duty_raw);
        self.duties()
    }

    /// Duties of motor 1 and 2. Assumed: motor 1 is the left one, and what exceeds 100 % is cut off.
    fn duties(&self) -> Option<[i16; 2]> {
        let (drive, turn) = (i32::from(self.drive_raw?), i32::from(self.turn_raw?));
        Some([clamp_duty(drive + turn), clamp_duty(drive - turn)])
    }
}

/// Duties of both motors for a drive and a turn value, for inputs with control mixing on.
#[must_use]
pub fn mixed_duties(drive_raw: i16, turn_raw: i16) -> [i16; 2] {
    let mixer = Mixer { drive_raw: Some(drive_raw), turn_raw: Some(turn_raw) };
    mixer.duties().unwrap_or([0, 0])
}

fn share_of_full(part: i32, whole: i32) -> i16 {
    let scaled = 2 * part * FULL_DUTY_RAW;
    clamp_duty((scaled + scaled.signum() * whole) / (2 * whole))
}

fn clamp_duty(raw: i32) -> i16 {
    i16::try_from(raw.clamp(-FULL_DUTY_RAW, FULL_DUTY_RAW)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seven_bit_values_map_to_their_documented_ends() {
        for (value, forward) in [(0, 0), (127, 32_767), (200, 32_767), (64, 16_513)] {
            assert_eq!(seven_bit_forward(value), forward);
            assert_eq!(seven_bit_backward(value), -forward);
        }
        for (value, duty) in [(0, -32_767), (64, 0), (127, 32_767), (32, -16_384), (65, 520)] {
            assert_eq!(seven_bit_centered(value), duty, "value {value}");
        }
    }

    #[test]
    fn mixed_mode_waits_for_drive_and_turn_and_then_follows_either() {
        let mut mixer = Mixer::default();
        assert_eq!(mixer.drive(10_000), None);
        assert_eq!(mixer.drive(12_000), None);
        assert_eq!(mixer.turn(4_000), Some([16_000, 8_000]));
        assert_eq!(mixer.drive(-12_000), Some([-8_000, -16_000]));
        assert_eq!(mixer.turn(-4_000), Some([-16_000, -8_000]));
    }

    #[test]
    fn mixing_cuts_off_at_full_duty() {
        assert_eq!(mixed_duties(30_000, 20_000), [32_767, 10_000]);
        assert_eq!(mixed_duties(-32_767, -32_767), [-32_767, 0]);
    }
}
