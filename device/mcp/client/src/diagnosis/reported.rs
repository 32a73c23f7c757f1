//! What the status word says, made exact by what was measured and set (MCP manual 1.6.3 and command 90).

use crate::diagnosis::evidence::Evidence;
use crate::diagnosis::finding::Hindrance::{BlocksAll, BlocksSome, Limits};
use crate::diagnosis::finding::{Finding, finding};
use brushwork_link::settings::SettingValue;
use brushwork_mcp_wire::packet_serial::status::{Condition, Severity};

/// What a condition means for the motors; none for a signal that says nothing about them.
pub fn of(condition: Condition, evidence: &Evidence<'_>) -> Option<Finding> {
    use Condition as C;
    let told = |hindrance, cure: &str| {
        Some(finding(hindrance, format!("the controller reports: {}", condition.title()), cure))
    };
    match condition {
        C::EStop => Some(emergency_stop(evidence)),
        C::Temperature1Error | C::Temperature2Error | C::Temperature1Warning | C::Temperature2Warning => {
            Some(temperature(condition, evidence))
        }
        C::MainBatteryHighError
        | C::MainBatteryLowError
        | C::MainBatteryHighHysteresis
        | C::MainBatteryHighWarning
        | C::MainBatteryLowWarning
        | C::LogicBatteryHighError
        | C::LogicBatteryLowError => Some(battery(condition, evidence)),
        C::M1DriverFault | C::M2DriverFault => told(
            BlocksAll,
            "Check the motor and its leads for a short circuit, then restart the controller; if it stays, the bridge is \
             damaged",
        ),
        C::M1SpeedError | C::M2SpeedError | C::M1PositionError | C::M2PositionError => told(
            BlocksSome,
            "Check encoder, wiring and the error limits; the motor's next command clears the fault",
        ),
        C::M1CurrentError | C::M2CurrentError => {
            told(BlocksAll, "Look for a blocked shaft or a short circuit, then restart the controller")
        }
        C::M1OverCurrentWarning => Some(current_limit(1, evidence)),
        C::M2OverCurrentWarning => Some(current_limit(2, evidence)),
        C::SpeedLimitWarning | C::M1SpeedWarning | C::M2SpeedWarning => {
            told(Limits, "Look for a load that is too heavy, or raise the speed error limit")
        }
        C::PositionLimitWarning | C::M1PositionWarning | C::M2PositionWarning => {
            told(Limits, "Look for a load that is too heavy, or raise the position error limit")
        }
        C::CanWarning => told(Limits, "Check the CAN bus: its wiring, terminators and rate"),
        C::BootWarning => {
            told(Limits, "Read the settings and compare them with a backup: something was wrong at start-up")
        }
        C::M1OverRegenerationWarning | C::M2OverRegenerationWarning => {
            told(Limits, "Decelerate more gently, or raise the minimum current")
        }
        // Where the pins tell the same in full, the pin is named instead.
        C::M1Home | C::M2Home | C::S4Signal | C::S5Signal if evidence.pins.is_some() => None,
        C::M1Home | C::S4Signal => Some(at_switch(1)),
        C::M2Home | C::S5Signal => Some(at_switch(2)),
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

fn temperature(condition: Condition, evidence: &Evidence<'_>) -> Finding {
    let second = matches!(condition, Condition::Temperature2Error | Condition::Temperature2Warning);
    let at = match evidence.measured.celsius[usize::from(second)] {
        Some(celsius) => format!("the board is at {celsius:.1} °C ({})", condition.title()),
        None => format!("the controller reports: {}", condition.title()),
    };
    match condition.severity() {
        Severity::Error => finding(BlocksAll, at, "Let the board cool below 100 °C"),
        _ => finding(
            Limits,
            format!("{at}, so its current limit is reduced"),
            "Let the board cool below 85 °C",
        ),
    }
}

fn battery(condition: Condition, evidence: &Evidence<'_>) -> Finding {
    use Condition as C;
    let is_logic = matches!(condition, C::LogicBatteryHighError | C::LogicBatteryLowError);
    let is_high =
        !matches!(condition, C::MainBatteryLowError | C::MainBatteryLowWarning | C::LogicBatteryLowError);
    let (name, key, volts) = if is_logic {
        ("logic", "logic_battery", evidence.measured.logic_volts)
    } else {
        ("main", "main_battery", evidence.measured.main_volts)
    };
    let end = if is_high { "max_volts" } else { "min_volts" };
    let limit =
        evidence.settings.and_then(|settings| match settings.get(&format!("limits.{key}.{end}"))? {
            SettingValue::Number(limit) => Some(limit),
            _ => None,
        });
    let which = if is_high { "above its maximum" } else { "below its minimum" };
    let exceeded = |volts: f64, limit: f64| if is_high { volts > limit } else { volts < limit };
    let what = match (volts, limit) {
        (Some(volts), Some(limit)) if exceeded(volts, limit) => {
            format!("the {name} battery is at {volts:.1} V, {which} of {limit:.1} V ({})", condition.title())
        }
        (Some(volts), _) => format!("the controller reports: {} (now {volts:.1} V)", condition.title()),
        (None, _) => format!("the controller reports: {}", condition.title()),
    };
    let cure = match (is_high, is_logic, condition.severity()) {
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
