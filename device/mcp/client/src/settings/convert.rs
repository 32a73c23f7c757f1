//! What becomes of settings that the other controller divides otherwise, or does not have.

use crate::messages::{McpSettingsMessage, WithoutMessage};
use brushwork_link::Message;
use brushwork_link::settings::{Conversion, Fit, Kind, Row, SettingValue, SettingsTable};

/// One setting that stands for two of another controller.
struct Divided {
    one: &'static str,
    /// The first is what becomes of the one, where there is only one.
    two: [&'static str; 2],
    /// What follows where the two were not the same.
    effect: WithoutMessage,
}

/// Generation 1 brakes by the acceleration, command 68 of later ones has a deceleration; command 148 has one PWM mode up to generation 2, and
/// command 76 one deadband.
static DIVIDED: &[Divided] = &[
    accel(["motor1.default_accel", "motor1.default_decel"]),
    accel(["motor2.default_accel", "motor2.default_decel"]),
    Divided {
        one: "unit.pwm_mode",
        two: ["motor1.pwm_mode", "motor2.pwm_mode"],
        effect: WithoutMessage::OnePwmMode,
    },
    Divided {
        one: "roboclaw.deadband.reverse",
        two: ["roboclaw.s1.reverse_deadband", "roboclaw.s2.reverse_deadband"],
        effect: WithoutMessage::OneDeadband,
    },
    Divided {
        one: "roboclaw.deadband.forward",
        two: ["roboclaw.s1.forward_deadband", "roboclaw.s2.forward_deadband"],
        effect: WithoutMessage::OneDeadband,
    },
];

const fn accel(two: [&'static str; 2]) -> Divided {
    Divided { one: two[0], two, effect: WithoutMessage::OneAcceleration }
}

/// The settings over there that follow from others of the profile.
pub(super) fn conversions(fit: &Fit<'_>) -> Vec<Conversion> {
    DIVIDED.iter().flat_map(|divided| divided.conversions(fit)).collect()
}

impl Divided {
    fn conversions(&self, fit: &Fit<'_>) -> Vec<Conversion> {
        let is_two = |table: &SettingsTable| self.two.iter().all(|key| table.row(key).is_some());
        match (is_two(fit.from), is_two(fit.to)) {
            (false, true) => self.divide(fit),
            (true, false) => self.join(fit).into_iter().collect(),
            (true, true) | (false, false) => Vec::new(),
        }
    }

    /// Both get what the one had.
    fn divide(&self, fit: &Fit<'_>) -> Vec<Conversion> {
        let Some((one, value)) = held(fit, self.one) else { return Vec::new() };
        let added = self.two.iter().filter(|key| fit.from.row(key).is_none());
        let conversion = |key: &&'static str| {
            let there = fit.to.row(key)?;
            let told = McpSettingsMessage::Divided {
                title: there.title(),
                value: there.format(value),
                one: one.title(),
            };
            let told = if value == there.default { Message::default() } else { told.into() };
            Some(Conversion { from: self.one, to: key, told, absorbed: None })
        };
        added.filter_map(conversion).collect()
    }

    /// The one gets what the first had; what the second had is lost where it was another.
    fn join(&self, fit: &Fit<'_>) -> Option<Conversion> {
        let ((first, kept), (second, lost)) = (held(fit, self.two[0])?, held(fit, self.two[1])?);
        let there = fit.to.row(self.one)?;
        let told = McpSettingsMessage::Joined {
            title: second.title(),
            lost: second.format(lost),
            kept: first.format(kept),
            one: there.title(),
            effect: self.effect.clone().into(),
        };
        let told = if kept == lost { Message::default() } else { told.into() };
        Some(Conversion { from: self.two[0], to: self.one, told, absorbed: Some(self.two[1]) })
    }
}

fn held<'f>(fit: &Fit<'f>, key: &str) -> Option<(&'f Row, SettingValue)> {
    Some((fit.from.row(key)?, fit.profile.settings.get(key)?))
}

/// Why an emergency stop cannot end by itself there.
pub(super) fn impossible_reset(there: &Row, value: SettingValue) -> Option<Message> {
    let (SettingValue::Choice(key), Kind::Choice(codes)) = (value, there.kind) else { return None };
    let is_lacking = there.key == "unit.estop_reset" && codes.iter().all(|code| code.key != key);
    is_lacking.then(|| McpSettingsMessage::NoAutomaticReset.into())
}

/// What changes in the motion where a setting has no place; nothing of one that moves, stops and limits nothing by itself.
pub(super) fn without(row: &Row) -> Option<Message> {
    Some(
        match row.pattern {
            "limits.main_battery.auto_offset_volts" => WithoutMessage::FixedMaximum,
            "limits.main_battery.offset_volts" | "limits.logic_battery.offset_volts" => {
                WithoutMessage::UncorrectedVolts
            }
            "motor{n}.default_speed" => WithoutMessage::NoDefaultSpeed,
            "motor{n}.idle.delay_seconds" | "motor{n}.idle.mode" => WithoutMessage::NoIdle,
            "motor{n}.error_limit.speed" | "motor{n}.error_limit.position" => WithoutMessage::NoErrorLimit,
            "motor{n}.home.duty" => WithoutMessage::NoHomingDuty,
            "motor{n}.home.timeout_seconds" => WithoutMessage::NoHomingTimeout,
            "unit.serial_timeout" | "stream.{n}.timeout" => WithoutMessage::NoTimeout,
            "unit.mixing" => WithoutMessage::NotMixed,
            "unit.bridge_channels" => WithoutMessage::NotBridged,
            "priority.{n}" | "roboclaw.config.mode" => WithoutMessage::OtherCommander,
            "script.autorun_delay" => WithoutMessage::NoScript,
            "pin.{n}.target" => WithoutMessage::CommandsNothing,
            "pin.{n}.min_action" | "pin.{n}.max_action" => WithoutMessage::StopsNothing,
            "dout.{n}.action" | "dout.{n}.inverted" | "roboclaw.ctrl{n}.mode" => {
                WithoutMessage::SwitchesNothing
            }
            "roboclaw.pin.{n}" => WithoutMessage::PinDoesNothing,
            "roboclaw.config.battery" => WithoutMessage::NoCells,
            "roboclaw.config.swap_encoders" => WithoutMessage::EncodersNotSwapped,
            "roboclaw.deadband.reverse"
            | "roboclaw.deadband.forward"
            | "roboclaw.{n}.reverse_deadband"
            | "roboclaw.{n}.forward_deadband" => WithoutMessage::NoDeadband,
            "roboclaw.{n}.reverse_limit"
            | "roboclaw.{n}.forward_limit"
            | "roboclaw.{n}.center"
            | "roboclaw.{n}.min"
            | "roboclaw.{n}.max"
            | "roboclaw.{n}.output_min"
            | "roboclaw.{n}.output_max" => WithoutMessage::OtherInputRange,
            pattern if pattern.starts_with("motor{n}.encoder.") => WithoutMessage::OtherEncoder,
            _ => return None,
        }
        .into(),
    )
}
