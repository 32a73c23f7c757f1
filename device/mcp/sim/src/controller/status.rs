//! The conditions a unit reports with command 90, and with them its indicators.

use super::firmware::Firmware;
use crate::signals::MotorTriggers;
use brushwork_mcp_wire::models::Family;
use brushwork_mcp_wire::packet_serial::status;
use brushwork_mcp_wire::packet_serial::status::{Condition, Conditions};
use brushwork_plant::world::UnitFault;

/// What only a RoboClaw reports.
const ROBOCLAW_ONLY: [Condition; 6] = [
    Condition::M1DriverFault,
    Condition::M2DriverFault,
    Condition::M1Home,
    Condition::M2Home,
    Condition::S4Signal,
    Condition::S5Signal,
];

impl Firmware {
    /// Everything that is so now, whether or not this generation has a bit for it.
    pub(super) fn conditions(&self) -> Conditions {
        let limits = &self.protection;
        let faults = self.loop_faults;
        let homed = self.triggers.motors.map(MotorTriggers::is_limited);
        [
            (Condition::EStop, self.is_stopped()),
            (Condition::Temperature1Error, limits.temperature_error),
            (Condition::Temperature2Error, limits.temperature_2_error),
            (Condition::MainBatteryHighError, limits.main_high_error),
            (Condition::MainBatteryLowError, limits.main_low_error),
            (Condition::LogicBatteryHighError, limits.logic_high_error),
            (Condition::LogicBatteryLowError, limits.logic_low_error),
            (Condition::M1DriverFault, limits.driver_fault[0]),
            (Condition::M2DriverFault, limits.driver_fault[1]),
            (Condition::M1CurrentError, limits.current_error[0]),
            (Condition::M2CurrentError, limits.current_error[1]),
            (Condition::CanWarning, self.readings.unit_faults.has(UnitFault::Can)),
            (Condition::BootWarning, self.boot_warning),
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

    /// The status word of this generation. The MCP's has no bits for driver faults and home switches (MCP manual 1.2.5 and
    /// command 90).
    pub(super) fn status_word(&self) -> u32 {
        let mut conditions = self.conditions();
        if self.model.family == Family::Mcp {
            ROBOCLAW_ONLY.into_iter().for_each(|condition| conditions.remove(condition));
        }
        status::encode(conditions, self.generation)
    }
}
