//! The conditions a unit reports with command 90, and with them its lamps.

use super::firmware::Firmware;
use crate::signals::MotorTriggers;
use brushwork_protocol::packet_serial::status::{self, Condition, Conditions};

impl Firmware {
    /// Everything that is so now, whether or not this generation has a bit for it.
    pub(super) fn conditions(&self) -> Conditions {
        let limits = &self.protection;
        let faults = self.loop_faults;
        let homed = self.triggers.motors.map(MotorTriggers::is_limited);
        [
            (Condition::EStop, self.estop.is_tripped()),
            (Condition::Temperature1Error, limits.temperature_error),
            (Condition::Temperature2Error, limits.temperature_2_error),
            (Condition::MainBatteryHighError, limits.main_high_error),
            (Condition::MainBatteryLowError, limits.main_low_error),
            (Condition::LogicBatteryHighError, limits.logic_high_error),
            (Condition::LogicBatteryLowError, limits.logic_low_error),
            (Condition::M1SpeedError, faults[0].speed),
            (Condition::M2SpeedError, faults[1].speed),
            (Condition::M1PositionError, faults[0].position),
            (Condition::M2PositionError, faults[1].position),
            (Condition::M1OverCurrentWarning, limits.over_current[0]),
            (Condition::M2OverCurrentWarning, limits.over_current[1]),
            (Condition::MainBatteryHighWarning, limits.main_high_warning),
            (Condition::MainBatteryLowWarning, limits.main_low_warning),
            (Condition::Temperature1Warning, limits.temperature_warning),
            (Condition::Temperature2Warning, limits.temperature_2_warning),
            (Condition::M1OverRegenerationWarning, limits.over_regeneration[0]),
            (Condition::M2OverRegenerationWarning, limits.over_regeneration[1]),
            (Condition::M1Home, homed[0]),
            (Condition::M2Home, homed[1]),
            (Condition::S4Signal, homed[0]),
            (Condition::S5Signal, homed[1]),
        ]
        .into_iter()
        .filter_map(|(condition, present)| present.then_some(condition))
        .collect()
    }

    /// The status word of this generation.
    pub(super) fn status_word(&self) -> u32 {
        status::encode(self.conditions(), self.generation)
    }
}
