//! The three LEDs at work (MCP manual 1.6); what they say is in [`brushwork_mcp_wire::packet_serial::led`].
//!
//! Assumed: how long all of them light after power-up, and how long STAT1 goes dark with a byte.

use brushwork_mcp_wire::packet_serial::led::{BOOT_CODE, Light, blink_code};
use brushwork_mcp_wire::packet_serial::status::{Condition, Conditions};
use brushwork_plant::world::Leds;
use std::time::Duration;

/// How long all three LEDs light after power-up.
pub const POWER_UP_BLINK: Duration = Duration::from_millis(500);
/// STAT1 goes dark for this long when a byte arrives.
const DATA_BLINK: Duration = Duration::from_millis(30);

/// What the LEDs show.
#[derive(Clone, Copy, Debug, Default)]
pub struct LedInputs {
    /// Time since power up.
    pub up_for: Duration,
    /// Time since the last received byte.
    pub since_last_byte: Option<Duration>,
    /// Lithium polymer cells that were counted at start-up, if they were.
    pub detected_cells: Option<u32>,
    /// Either bridge drives.
    pub driving: bool,
    /// The unit waits for new firmware.
    pub in_boot_mode: bool,
    /// Everything that is so.
    pub conditions: Conditions,
}

/// The LEDs at one moment.
pub fn leds(inputs: &LedInputs) -> Leds {
    if inputs.up_for < POWER_UP_BLINK {
        return Leds { stat1: true, stat2: true, err: true };
    }
    let code = if inputs.in_boot_mode { BOOT_CODE } else { blink_code(inputs.conditions, inputs.driving) };
    let lit = |light: Light| light.is_lit(inputs.up_for);
    // An emergency stop keeps all three lit, whatever comes in.
    let blinks = code.stat1 == Light::Lit && !inputs.conditions.contains(Condition::EStop);
    let dark = blinks && inputs.since_last_byte.is_some_and(|since| since < DATA_BLINK);
    let stat2 = shown_cells(inputs)
        .map_or_else(|| lit(code.stat2), |counted| counted.is_lit(inputs.up_for - POWER_UP_BLINK));
    Leds { stat1: lit(code.stat1) && !dark, stat2, err: lit(code.err) }
}

/// STAT2 blinks once for each cell that was counted, then goes on as ever (MCP manual 1.4.1). Assumed: right after the blink at
/// power up.
fn shown_cells(inputs: &LedInputs) -> Option<Light> {
    let counted = Light::Flashes(inputs.detected_cells?);
    let is_shown =
        inputs.up_for < POWER_UP_BLINK + counted.period()? && !inputs.conditions.contains(Condition::EStop);
    is_shown.then_some(counted)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LATER: Duration = Duration::from_secs(100);

    #[test]
    fn all_three_blink_after_power_up_and_in_an_emergency_stop() {
        let all = Leds { stat1: true, stat2: true, err: true };
        assert_eq!(leds(&LedInputs::default()), all);
        let mut inputs = LedInputs { up_for: LATER, ..LedInputs::default() };
        assert_eq!(leds(&inputs), Leds { stat1: true, stat2: false, err: false });
        inputs.conditions.insert(Condition::EStop);
        inputs.since_last_byte = Some(Duration::ZERO);
        assert_eq!(leds(&inputs), all);
    }

    #[test]
    fn stat1_blinks_with_data_and_stat2_shows_a_driving_bridge() {
        let idle = LedInputs { up_for: LATER, ..LedInputs::default() };
        let receiving = LedInputs { since_last_byte: Some(Duration::ZERO), driving: true, ..idle };
        assert_eq!(leds(&receiving), Leds { stat1: false, stat2: true, err: false });
        assert!(leds(&LedInputs { since_last_byte: Some(DATA_BLINK), ..idle }).stat1);
        let conditions = [Condition::MainBatteryLowWarning].into_iter().collect();
        assert!(!leds(&LedInputs { conditions, ..receiving }).stat1, "a warning leaves STAT1 as it was");
    }

    #[test]
    fn in_boot_mode_the_green_leds_take_turns() {
        let at = |ms| {
            leds(&LedInputs { up_for: Duration::from_millis(ms), in_boot_mode: true, ..LedInputs::default() })
        };
        assert_eq!(at(1000), Leds { stat1: true, stat2: false, err: false });
        assert_eq!(at(1250), Leds { stat1: false, stat2: true, err: false });
    }
}
