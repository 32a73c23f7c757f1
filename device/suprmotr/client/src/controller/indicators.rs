//! The bits of the status as indicators, and the status row with a place for each.

use brushwork_link::device::Indicator;
use brushwork_suprmotr_wire::{Status, inputs, limits, motion, operation};
use brushwork_values::Severity;

/// Where each byte of the status lies in the word: operation, motion, limits, inputs, and the number of the error. The mode of moving, which
/// the manual does not describe, has no place.
const MOTION_SHIFT: u32 = 8;
const LIMITS_SHIFT: u32 = 16;
const INPUTS_SHIFT: u32 = 20;
const ERROR_SHIFT: u32 = 24;
const NIBBLE: u8 = 0x0F;

/// The status as one word of indicators.
#[must_use]
pub fn word_of(status: Status) -> u32 {
    u32::from(status.operation)
        | u32::from(status.motion) << MOTION_SHIFT
        | u32::from(status.limits & NIBBLE) << LIMITS_SHIFT
        | u32::from(status.inputs & NIBBLE) << INPUTS_SHIFT
        | u32::from(status.error) << ERROR_SHIFT
}

/// The status that a word of indicators stands for.
#[must_use]
pub fn status_of_word(word: u32) -> Status {
    let byte = |shift: u32| word.to_le_bytes()[shift as usize / 8];
    let limits = byte(LIMITS_SHIFT);
    Status {
        operation: byte(0),
        motion: byte(MOTION_SHIFT),
        limits: limits & NIBBLE,
        inputs: limits >> 4,
        mode: 0,
        error: byte(ERROR_SHIFT),
    }
}

macro_rules! indicators {
    ($($byte:ident $bit:ident $shift:expr, $key:literal $short:literal $title:literal $severity:ident;)*) => {
        /// The bits of the status that say something to people. What ends a move is an error, what limits one a warning, the rest is nothing
        /// but news.
        pub static INDICATORS: &[Indicator] = &[$(Indicator {
            mask: ($byte::$bit as u32) << $shift,
            key: $key,
            short: $short,
            title: $title,
            severity: Severity::$severity,
        }),*];
    };
}

indicators! {
    motion EXCESSIVE_ERROR MOTION_SHIFT, "excessive_error" "EXCESS" "The position lagged further behind than SM allows" Error;
    motion MOVE_ERROR MOTION_SHIFT, "move_error" "MOVE" "A move went wrong" Warning;
    operation COMMAND_ERROR 0, "command_error" "CMD" "A command was refused" Warning;
    inputs NEGATIVE INPUTS_SHIFT, "negative_limit" "NEG" "Negative limit switch on" Warning;
    inputs POSITIVE INPUTS_SHIFT, "positive_limit" "POS" "Positive limit switch on" Warning;
    inputs REFERENCE INPUTS_SHIFT, "reference" "REF" "Reference switch on" Signal;
    motion MOTOR_OFF MOTION_SHIFT, "motor_off" "OFF" "Motor off: nothing holds it" Signal;
    motion COMPLETE MOTION_SHIFT, "trajectory_complete" "DONE" "No move is in process" Signal;
    motion FORWARD MOTION_SHIFT, "forward" "FWD" "The move is in the positive direction" Signal;
    motion PHASE MOTION_SHIFT, "encoder_phase" "PHASE" "Phase of the encoder" Signal;
    operation MACRO 0, "macro" "MACRO" "A macro is running" Signal;
    operation WAIT 0, "wait" "WAIT" "A wait is in process" Signal;
    limits ENABLED LIMITS_SHIFT, "limits_on" "LIMITS" "Limit switches stop the motor" Signal;
    limits ACTIVE_HIGH LIMITS_SHIFT, "limits_high" "HIGH" "A limit switch is on while its input is high" Signal;
    limits FIND_EDGE LIMITS_SHIFT, "find_edge" "EDGE" "An edge is being looked for" Signal;
    operation ECHO 0, "echo" "ECHO" "Received characters come back" Signal;
    operation HEXADECIMAL 0, "hexadecimal" "HEX" "Numbers are hexadecimal" Signal;
    operation ADDRESSED 0, "addressed" "SEL" "The controller is selected" Signal;
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_link::device::StatusReport;

    #[test]
    fn every_bit_comes_back_from_the_word_and_each_indicator_has_its_own() {
        let status =
            Status { operation: 0xA5, motion: 0x5A, limits: 0x0D, inputs: 0x0A, mode: 0, error: 0x0A };
        assert_eq!(status_of_word(word_of(status)), status);
        for (index, indicator) in INDICATORS.iter().enumerate() {
            assert_eq!(indicator.mask.count_ones(), 1, "{}", indicator.key);
            assert_eq!(INDICATORS.iter().position(|other| other.mask == indicator.mask), Some(index));
        }
        let limit = Status { inputs: inputs::NEGATIVE, ..Status::default() };
        let report = StatusReport::new(0, std::time::Duration::ZERO, word_of(limit), INDICATORS);
        assert_eq!(report.active().map(|on| on.key).collect::<Vec<_>>(), ["negative_limit"]);
    }
}
