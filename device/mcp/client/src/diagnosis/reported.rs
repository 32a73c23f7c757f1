//! What the status word says, made exact by what was measured and set (MCP manual 1.6.3 and command 90).

use crate::diagnosis::evidence::Evidence;
use crate::diagnosis::finding::Hindrance::{BlocksAll, BlocksSome, Limits};
use crate::diagnosis::finding::{Finding, finding};
use brushwork_link::device::Indicator;
use brushwork_link::settings::SettingValue;
use brushwork_values::Severity;

/// What an indicator means for the motors; none for one that says nothing about them.
pub fn of(indicator: &Indicator, evidence: &Evidence<'_>) -> Option<Finding> {
    let reported = |hindrance, cure: &str| {
        Some(finding(hindrance, format!("the controller reports: {}", indicator.title), cure))
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
        "m1_driver_fault" | "m2_driver_fault" => reported(
            BlocksAll,
            "Check the motor and its leads for a short circuit, then restart the controller; if it stays, the bridge is \
             damaged",
        ),
        "m1_speed_error" | "m2_speed_error" | "m1_position_error" | "m2_position_error" => reported(
            BlocksSome,
            "Check encoder, wiring and the error limits; the motor's next command clears the fault",
        ),
        "m1_current_error" | "m2_current_error" => {
            reported(BlocksAll, "Look for a blocked shaft or a short circuit, then restart the controller")
        }
        "m1_over_current_warning" => Some(current_limit(1, evidence)),
        "m2_over_current_warning" => Some(current_limit(2, evidence)),
        "speed_limit_warning" | "m1_speed_warning" | "m2_speed_warning" => {
            reported(Limits, "Look for a load that is too heavy, or raise the speed error limit")
        }
        "position_limit_warning" | "m1_position_warning" | "m2_position_warning" => {
            reported(Limits, "Look for a load that is too heavy, or raise the position error limit")
        }
        "can_warning" => reported(Limits, "Check the CAN bus: its wiring, terminators and rate"),
        "boot_warning" => reported(
            Limits,
            "Read the settings and compare them with a backup: something was wrong at start-up",
        ),
        "m1_over_regeneration_warning" | "m2_over_regeneration_warning" => {
            reported(Limits, "Decelerate more gently, or raise the minimum current")
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
        Some(SettingValue::Choice("hardware")) => {
            "Release it, then restart the controller: its reset is set to hardware"
        }
        Some(SettingValue::Choice("software")) => "Release it, then reset it on the Device Status screen",
        Some(SettingValue::Choice("automatic")) => "Release it: the reset is automatic",
        _ => "Release it, then reset it or restart the controller",
    };
    finding(BlocksAll, "the emergency stop is active (E-Stop)", cure)
}

fn temperature(indicator: &Indicator, evidence: &Evidence<'_>) -> Finding {
    let second = matches!(indicator.key, "temperature2_error" | "temperature2_warning");
    let at = match evidence.measured.celsius[usize::from(second)] {
        Some(celsius) => format!("the board is at {celsius:.1} °C ({})", indicator.title),
        None => format!("the controller reports: {}", indicator.title),
    };
    match indicator.severity {
        Severity::Error => finding(BlocksAll, at, "Let the board cool below 100 °C"),
        Severity::Signal | Severity::Warning => finding(
            Limits,
            format!("{at}, so its current limit is reduced"),
            "Let the board cool below 85 °C",
        ),
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
    let which = if is_high { "above its maximum" } else { "below its minimum" };
    let exceeded = |volts: f64, limit: f64| if is_high { volts > limit } else { volts < limit };
    let what = match (volts, limit) {
        (Some(volts), Some(limit)) if exceeded(volts, limit) => {
            format!("the {name} battery is at {volts:.1} V, {which} of {limit:.1} V ({})", indicator.title)
        }
        (Some(volts), _) => format!("the controller reports: {} (now {volts:.1} V)", indicator.title),
        (None, _) => format!("the controller reports: {}", indicator.title),
    };
    let cure = match (is_high, is_logic, indicator.severity) {
        (_, _, Severity::Error) => {
            format!("Bring the {name} battery between its limits and restart the controller")
        }
        (true, ..) => "Lower the main battery voltage or raise its maximum".to_owned(),
        (false, ..) => "Charge the main battery or lower its minimum".to_owned(),
    };
    finding(BlocksAll, what, cure)
}

fn current_limit(motor: u8, evidence: &Evidence<'_>) -> Finding {
    let amps = evidence.measured.amps[usize::from(motor - 1)];
    let measured = amps.map_or(String::new(), |amps| format!(" ({amps:.1} A now)"));
    finding(
        Limits,
        format!("motor {motor} is at its current limit{measured}"),
        "Free the shaft or take load off, or raise the motor's current limit",
    )
}

fn at_switch(motor: u8) -> Finding {
    finding(
        BlocksSome,
        format!("motor {motor} is at its home or limit switch"),
        "Drive away from the switch, or open it",
    )
}
