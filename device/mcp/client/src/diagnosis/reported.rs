//! What the status word says, made exact by what was measured and set (MCP manual 1.6.3 and command 90).

use crate::diagnosis::evidence::Evidence;
use crate::diagnosis::finding::Hindrance::{BlocksAll, BlocksSome, Limits};
use crate::diagnosis::finding::{Finding, finding};
use crate::messages::{CureMessage, FindingMessage};
use brushwork_link::device::Indicator;
use brushwork_link::settings::SettingValue;
use brushwork_values::Severity;

/// What an indicator means for the motors; none for one that says nothing about them.
pub fn of(indicator: &Indicator, evidence: &Evidence<'_>) -> Option<Finding> {
    let reported = |hindrance, cure: CureMessage| {
        Some(finding(hindrance, FindingMessage::Reported { title: indicator.title }, cure))
    };
    match indicator.key {
        "e_stop" => Some(emergency_stop(evidence)),
        "temperature1_error" | "temperature2_error" | "temperature1_warning" | "temperature2_warning" => {
            Some(temperature(indicator, evidence))
        }
        "main_battery_high_error"
        | "main_battery_low_error"
        | "main_battery_high_hysteresis"
        | "main_battery_high_warning"
        | "main_battery_low_warning"
        | "logic_battery_high_error"
        | "logic_battery_low_error" => Some(battery(indicator, evidence)),
        "m1_driver_fault" | "m2_driver_fault" => reported(BlocksAll, CureMessage::CheckBridge),
        "m1_speed_error" | "m2_speed_error" | "m1_position_error" | "m2_position_error" => {
            reported(BlocksSome, CureMessage::CheckErrorLimits)
        }
        "m1_current_error" | "m2_current_error" => reported(BlocksAll, CureMessage::LookForBlock),
        "m1_over_current_warning" => Some(current_limit(1, evidence)),
        "m2_over_current_warning" => Some(current_limit(2, evidence)),
        "speed_limit_warning" | "m1_speed_warning" | "m2_speed_warning" => {
            reported(Limits, CureMessage::RaiseSpeedLimit)
        }
        "position_limit_warning" | "m1_position_warning" | "m2_position_warning" => {
            reported(Limits, CureMessage::RaisePositionLimit)
        }
        "can_warning" => reported(Limits, CureMessage::CheckCanBus),
        "boot_warning" => reported(Limits, CureMessage::CompareSettings),
        "m1_over_regeneration_warning" | "m2_over_regeneration_warning" => {
            reported(Limits, CureMessage::BrakeGently)
        }
        // Where the pins tell the same in full, the pin is named instead.
        "m1_home" | "m2_home" | "s4_signal" | "s5_signal" if evidence.pins.is_some() => None,
        "m1_home" | "s4_signal" => Some(at_switch(1)),
        "m2_home" | "s5_signal" => Some(at_switch(2)),
        // The tests walk every condition of the table: none of them ends here.
        _ => None,
    }
}

fn emergency_stop(evidence: &Evidence<'_>) -> Finding {
    let reset = evidence.settings.and_then(|settings| settings.get("unit.estop_reset"));
    let cure = match reset {
        Some(SettingValue::Choice("hardware")) => CureMessage::RestartAfterEStop,
        Some(SettingValue::Choice("software")) => CureMessage::ResetAfterEStop,
        Some(SettingValue::Choice("automatic")) => CureMessage::ReleaseEStop,
        _ => CureMessage::ResetOrRestart,
    };
    finding(BlocksAll, FindingMessage::EmergencyStop, cure)
}

fn temperature(indicator: &Indicator, evidence: &Evidence<'_>) -> Finding {
    let second = matches!(indicator.key, "temperature2_error" | "temperature2_warning");
    let title = indicator.title;
    let at = match evidence.measured.celsius[usize::from(second)] {
        Some(celsius) => FindingMessage::BoardIsAt { celsius, title },
        None => FindingMessage::Reported { title },
    };
    match indicator.severity {
        Severity::Error => finding(BlocksAll, at, CureMessage::CoolBelow100),
        Severity::Signal | Severity::Warning => {
            finding(Limits, FindingMessage::LessCurrent { what: at.into() }, CureMessage::CoolBelow85)
        }
    }
}

fn battery(indicator: &Indicator, evidence: &Evidence<'_>) -> Finding {
    let is_logic = matches!(indicator.key, "logic_battery_high_error" | "logic_battery_low_error");
    let is_high = !matches!(
        indicator.key,
        "main_battery_low_error" | "main_battery_low_warning" | "logic_battery_low_error"
    );
    let (name, key, volts) = if is_logic {
        ("logic", "logic_battery", evidence.measured.logic_volts)
    } else {
        ("main", "main_battery", evidence.measured.main_volts)
    };
    let end = if is_high { "max_volts" } else { "min_volts" };
    let limit = evidence.settings.and_then(|settings| settings.get(&format!("limits.{key}.{end}"))?.number());
    let title = indicator.title;
    let exceeded = |volts: f64, limit: f64| if is_high { volts > limit } else { volts < limit };
    let what = match (volts, limit) {
        (Some(volts), Some(limit)) if exceeded(volts, limit) => match is_high {
            true => FindingMessage::BatteryAbove { name, volts, limit, title },
            false => FindingMessage::BatteryBelow { name, volts, limit, title },
        },
        (Some(volts), _) => FindingMessage::ReportedVolts { title, volts },
        (None, _) => FindingMessage::Reported { title },
    };
    let cure = match (is_high, is_logic, indicator.severity) {
        (_, _, Severity::Error) => CureMessage::BringBetween { name },
        (true, ..) => CureMessage::LowerVoltage,
        (false, ..) => CureMessage::Charge,
    };
    finding(BlocksAll, what, cure)
}

fn current_limit(motor: u8, evidence: &Evidence<'_>) -> Finding {
    let amps = evidence.measured.amps[usize::from(motor - 1)];
    let what = match amps {
        Some(amps) => FindingMessage::CurrentLimitNow { motor, amps },
        None => FindingMessage::CurrentLimit { motor },
    };
    finding(Limits, what, CureMessage::FreeShaft)
}

fn at_switch(motor: u8) -> Finding {
    finding(BlocksSome, FindingMessage::AtSwitch { motor }, CureMessage::LeaveSwitch)
}
