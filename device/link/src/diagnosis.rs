//! Why the motors do not run, in one sentence with its cure: shared by the window and the command line.
//!
//! It judges what was read elsewhere (status word, settings) and sends nothing. The findings come in the order in which
//! a person would mend them: what stops everything first, then what stops one kind of motion.

use brushwork_protocol::packet_serial::status::{Condition, Conditions};
use serde::Serialize;

use crate::settings::{SettingValue, SettingsImage};

/// How much a finding keeps the motors from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Hindrance {
    /// The motors still run, perhaps with less.
    Limits,
    /// One kind of command does not move them.
    BlocksSome,
    /// No command moves them.
    BlocksAll,
}

/// One reason.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// How much it keeps the motors from.
    pub hindrance: Hindrance,
    /// What is so: a clause without a full stop.
    pub what: String,
    /// What to do: a sentence without its full stop.
    pub cure: String,
}

/// All reasons, the gravest first.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Diagnosis {
    /// The reasons; empty when nothing speaks against motion.
    pub findings: Vec<Finding>,
}

impl Diagnosis {
    /// The one sentence.
    #[must_use]
    pub fn sentence(&self) -> String {
        let Some(first) = self.findings.first() else {
            return "Nothing that can be read keeps the motors from running: arm a screen and drive them."
                .to_owned();
        };
        let effect = match first.hindrance {
            Hindrance::BlocksAll => "The motors do not run",
            Hindrance::BlocksSome => "Some commands do not move the motors",
            Hindrance::Limits => "The motors run with limits",
        };
        let more = match self.findings.len() - 1 {
            0 => String::new(),
            1 => " (and 1 more reason)".to_owned(),
            others => format!(" (and {others} more reasons)"),
        };
        format!("{effect}: {}{more}. {}.", first.what, first.cure)
    }
}

/// Judges a status and, where they have been read, the settings in the controller's RAM.
#[must_use]
pub fn diagnose(conditions: Conditions, settings: Option<&SettingsImage>) -> Diagnosis {
    let mut findings: Vec<Finding> = conditions.iter().filter_map(of_condition).collect();
    if let Some(settings) = settings {
        findings.extend(of_priorities(settings));
        for motor in 1..=2 {
            findings.extend(of_qpps(settings, motor));
            findings.extend(of_position_limits(settings, motor));
        }
    }
    findings.sort_by_key(|finding| std::cmp::Reverse(finding.hindrance));
    Diagnosis { findings }
}

fn finding(hindrance: Hindrance, what: impl Into<String>, cure: &str) -> Finding {
    Finding { hindrance, what: what.into(), cure: cure.to_owned() }
}

/// The effects of MCP manual 1.6.3.
fn of_condition(condition: Condition) -> Option<Finding> {
    use Condition as C;
    use Hindrance::{BlocksAll, Limits};
    let (hindrance, cure) = match condition {
        C::EStop => (BlocksAll, "Release the emergency stop, then reset it or restart the controller"),
        C::Temperature1Error | C::Temperature2Error => (BlocksAll, "Let the board cool below 100 °C"),
        C::MainBatteryHighError | C::MainBatteryLowError => {
            (BlocksAll, "Bring the main battery between its limits and restart the controller")
        }
        C::LogicBatteryHighError | C::LogicBatteryLowError => {
            (BlocksAll, "Bring the logic battery between its limits and restart the controller")
        }
        C::MainBatteryHighWarning => (BlocksAll, "Lower the main battery voltage or raise its upper limit"),
        C::MainBatteryLowWarning => (BlocksAll, "Charge the main battery or lower its lower limit"),
        C::M1DriverFault | C::M2DriverFault => {
            (BlocksAll, "Check the motor's wiring for a short circuit and restart")
        }
        C::M1SpeedError | C::M2SpeedError | C::M1PositionError | C::M2PositionError => {
            (BlocksAll, "Check the encoder and the error limits, then drive again")
        }
        C::M1CurrentError | C::M2CurrentError => (BlocksAll, "Look for a blocked shaft or a short circuit"),
        C::M1OverCurrentWarning | C::M2OverCurrentWarning => {
            (Limits, "Take load off the motor or raise its current limit")
        }
        C::Temperature1Warning | C::Temperature2Warning => (Limits, "Let the board cool below 85 °C"),
        _ => return None,
    };
    Some(finding(hindrance, format!("the controller reports: {}", condition.title()), cure))
}

/// Without Serial in any level no command of this program is listened to (MCP manual 1.2.10, command 139).
fn of_priorities(settings: &SettingsImage) -> Option<Finding> {
    let levels: Vec<SettingValue> =
        (1..=3).filter_map(|level| settings.get(&format!("priority.{level}"))).collect();
    let is_serial =
        |value: &SettingValue| matches!(value, SettingValue::Choice(key) if key.contains("serial"));
    (levels.len() == 3 && !levels.iter().any(is_serial)).then(|| {
        finding(
            Hindrance::BlocksAll,
            "serial is in none of the three priority levels, so the inputs alone command the motors",
            "Set a priority level to serial",
        )
    })
}

/// QPPS scales every speed (MCP manual 2.4.5).
fn of_qpps(settings: &SettingsImage, motor: u8) -> Option<Finding> {
    (whole(settings, motor, "velocity.qpps")? == 0).then(|| {
        finding(
            Hindrance::BlocksSome,
            format!("motor {motor}'s QPPS is 0, and speed and position commands are scaled by it"),
            "Measure the speed at full duty and set QPPS to it",
        )
    })
}

/// Equal limits leave no room to move (MCP manual 2.4.7).
fn of_position_limits(settings: &SettingsImage, motor: u8) -> Option<Finding> {
    let (min, max) = (whole(settings, motor, "position.min")?, whole(settings, motor, "position.max")?);
    (min >= max).then(|| {
        finding(
            Hindrance::BlocksSome,
            format!("motor {motor}'s position limits ({min} to {max}) leave no room for position commands"),
            "Set the lowest and the highest position",
        )
    })
}

fn whole(settings: &SettingsImage, motor: u8, what: &str) -> Option<i64> {
    match settings.get(&format!("motor{motor}.{what}"))? {
        SettingValue::Int(value) => Some(value),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings(pairs: &[(&str, SettingValue)]) -> SettingsImage {
        let mut image = SettingsImage::default();
        for &(key, value) in pairs {
            image.set(key, value);
        }
        image
    }

    #[test]
    fn nothing_wrong_says_so() {
        assert!(diagnose(Conditions::NONE, None).sentence().starts_with("Nothing that can be read"));
    }

    #[test]
    fn an_emergency_stop_comes_before_a_setting() {
        let conditions: Conditions =
            [Condition::M1OverCurrentWarning, Condition::EStop].into_iter().collect();
        let image = settings(&[("motor1.velocity.qpps", SettingValue::Int(0))]);
        let diagnosis = diagnose(conditions, Some(&image));
        let order: Vec<Hindrance> = diagnosis.findings.iter().map(|finding| finding.hindrance).collect();
        assert_eq!(order, [Hindrance::BlocksAll, Hindrance::BlocksSome, Hindrance::Limits]);
        let sentence = diagnosis.sentence();
        assert!(sentence.contains("E-Stop") && sentence.contains("2 more reasons"), "{sentence}");
    }

    #[test]
    fn equal_position_limits_are_told_with_the_motor_and_the_cure() {
        let image = settings(&[
            ("motor2.position.min", SettingValue::Int(0)),
            ("motor2.position.max", SettingValue::Int(0)),
        ]);
        let sentence = diagnose(Conditions::NONE, Some(&image)).sentence();
        assert!(sentence.contains("motor 2's position limits (0 to 0)"), "{sentence}");
        assert!(sentence.ends_with("Set the lowest and the highest position."), "{sentence}");
    }

    #[test]
    fn serial_in_no_priority_level_blocks_all() {
        let levels = |third| {
            settings(&[
                ("priority.1", SettingValue::Choice("pulse")),
                ("priority.2", SettingValue::Choice("analog")),
                ("priority.3", SettingValue::Choice(third)),
            ])
        };
        let blocked = diagnose(Conditions::NONE, Some(&levels("disabled")));
        assert_eq!(blocked.findings[0].hindrance, Hindrance::BlocksAll);
        assert!(diagnose(Conditions::NONE, Some(&levels("serial"))).findings.is_empty());
    }

    #[test]
    fn the_priority_choices_still_have_a_serial_one() {
        let codes = brushwork_protocol::codes::PRIORITY_SIGNALS;
        assert_eq!(codes.iter().filter(|code| code.key.contains("serial")).count(), 1);
    }
}
