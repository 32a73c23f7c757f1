//! MCP and RoboClaw: Ion Studio's screens, thirteen indicators, two motors (MCP manual 1.2).

use brushwork_link::FamilyRef;
use brushwork_link::device::{ArmScope, Channel, Drive, Identity, Job, PinSignal, StatusReport};
use brushwork_link::settings::{Group, Kind, Row, SettingValue, SettingsImage, SettingsTable, Subject};
use brushwork_mcp_client::channels::CHANNELS;
use brushwork_mcp_client::indicators::{conditions, indicators};
use brushwork_mcp_client::script::MIN_AUTORUN;
use brushwork_mcp_client::settings::{PinMode, function_text, open_range};
use brushwork_mcp_client::{MCP, diagnosis, is_mcp, layout_of, model_of, packet_generation, subject};
use brushwork_mcp_wire::codes::ENCODER_PIN_NONE;
use brushwork_mcp_wire::models::{self, MODELS};
use brushwork_mcp_wire::packet_serial::status::{Condition, Conditions, StatusIndicator};
use brushwork_mcp_wire::packet_serial::{Effect, Generation, lookup, number};
use brushwork_mcp_wire::roboclaw::ConfigWord;
use brushwork_tuning::tune::Method;
use brushwork_values::{Code, Motor};

use super::diagnosis::ends;
use super::{McpConnection, script};
use crate::family::path::{BACK_UP, PathStep, Place, SAVE, ShownBy, Step};
use crate::family::recipe::{Goal, Recipes};
use crate::family::{Ability, ActiveIndicator, Family, Figure, Figures, Known, Own, Sliders};
use crate::mcp::recipes::McpRecipes;
use crate::model::{HelpPage, IndicatorInfo, IndicatorState, Screen, Tab, state_of};
use crate::tune::Loop;

#[derive(Debug)]
pub struct Mcp;

impl Family for Mcp {
    fn family(&self) -> FamilyRef {
        MCP
    }

    fn name(&self) -> &'static str {
        "MCP"
    }

    fn own(&self) -> Option<Box<dyn Own>> {
        Some(Box::<McpConnection>::default())
    }

    fn screens(&self, _identity: Option<&Identity>, _known: Known<'_>) -> Vec<Screen> {
        Screen::USUAL.to_vec()
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn tabs(&self, screen: Screen) -> &'static [Tab] {
        match screen {
            Screen::Pwm => &[Tab::Settings, Tab::Direction, Tab::Generator, Tab::Qpps],
            Screen::Velocity => &[Tab::Settings, Tab::Generator, Tab::ByHand, Tab::Tune],
            Screen::Position => &[Tab::Settings, Tab::VelocityLoop, Tab::Generator, Tab::ByHand, Tab::Tune],
            _ => &[],
        }
    }

    fn path(&self) -> &'static [PathStep] {
        PATH
    }

    fn recipes(&self) -> Option<&'static dyn Recipes> {
        Some(&McpRecipes)
    }

    fn direction_keys(&self) -> Option<[&'static str; 2]> {
        Some(["motor{n}.encoder.reversed", "motor{n}.encoder.motor_reversed"])
    }

    fn figures(&self) -> &'static [Figures] {
        &FIGURES
    }

    fn indicators(&self) -> &'static [IndicatorInfo] {
        &INDICATORS
    }

    fn lit(
        &self,
        report: &StatusReport,
        identity: Option<&Identity>,
        homed: Option<[bool; 2]>,
    ) -> Vec<IndicatorState> {
        let conditions = conditions(report);
        StatusIndicator::ALL
            .into_iter()
            .map(|indicator| lit(indicator, conditions, identity, homed))
            .collect()
    }

    fn home_indicators(&self) -> Option<[ActiveIndicator; 2]> {
        Some([Condition::M1Home, Condition::M2Home].map(|condition| {
            let place = condition as usize;
            ActiveIndicator::new(Some(place), &indicators(Generation::Gen1)[place])
        }))
    }

    fn lit_since(
        &self,
        report: &StatusReport,
        _identity: Option<&Identity>,
        homed: Option<[bool; 2]>,
    ) -> Vec<IndicatorState> {
        self.lit(report, None, homed)
    }

    fn homes_by_pins(&self, identity: &Identity) -> bool {
        is_mcp(identity)
    }

    fn indicators_note(&self, identity: &Identity, homed: Option<[bool; 2]>) -> Option<&'static str> {
        if !is_mcp(identity) {
            return None;
        }
        Some(match homed {
            Some(_) => {
                "M1HM and M2HM follow the actions of the input pins: this controller's status word has no bits for them. \
                 Times are counted from the connection."
            }
            None => {
                "M1HM and M2HM follow the actions of the input pins, which have not been read yet: this controller's status \
                 word has no bits for them. Times are counted from the connection."
            }
        })
    }

    fn diagnosis_keys(&self, table: &SettingsTable) -> Vec<String> {
        diagnosis::keys(table)
    }

    fn has_pin_actions(&self, settings: &SettingsImage) -> bool {
        diagnosis::has_actions(settings)
    }

    fn homed(&self, settings: &SettingsImage, pins: Option<&[PinSignal]>) -> Option<[bool; 2]> {
        if !diagnosis::has_actions(settings) {
            return Some([false; 2]);
        }
        Some(diagnosis::homed(settings, &ends(pins?)))
    }

    fn generation_number(&self, identity: &Identity) -> Option<u8> {
        packet_generation(identity.generation).map(Generation::number)
    }

    /// Small boards have one temperature sensor and report 0 for the second.
    fn makes_up(&self, identity: &Identity, channel: Channel) -> bool {
        let listed = identity.model.and_then(models::lookup);
        channel == Channel::TEMPERATURE_2 && listed.is_some_and(|listed| !listed.second_temperature)
    }

    fn subject(&self, identity: &Identity) -> Subject {
        let any = || subject(&models::UNLISTED[0], layout_of(identity.generation));
        identity.subject().unwrap_or_else(any)
    }

    fn function(
        &self,
        table: &SettingsTable,
        known: Known<'_>,
        (group, number): (Group, usize),
    ) -> Option<String> {
        function_text(table, known, group, number)
    }

    /// The row that names a motor's encoder by the number of its pin: none, and every pin that can be an encoder, by the numbers that we
    /// assume for them. Bits of a configuration word that mean one thing in the serial modes and another with R/C or analog inputs: by
    /// the control mode.
    fn choices(
        &self,
        row: &Row,
        subject: &Subject,
        wanted: Known<'_>,
    ) -> Option<Vec<(SettingValue, String)>> {
        if matches!(row.pattern, "roboclaw.config.baud" | "roboclaw.config.address") {
            return of_mode(row, wanted("roboclaw.config.mode")?.choice()?);
        }
        if row.pattern != "motor{n}.encoder.pin" {
            return None;
        }
        let is_able = |index: &usize| {
            let pin = model_of(subject).and_then(|model| model.pins.get(*index));
            pin.is_none_or(|pin| pin.is_analog() || pin.is_pulse() || pin.encoder_channel().is_some())
        };
        let pins = (0..subject.pins)
            .filter(is_able)
            .map(|index| (index as i64, format!("{index}: {}", subject.pin_name(index))));
        let all = std::iter::once((ENCODER_PIN_NONE, "None".to_owned())).chain(pins);
        Some(all.map(|(number, name)| (SettingValue::Int(number), name)).collect())
    }

    fn opened_input(&self, known: Known<'_>, pin: usize) -> Option<SettingsImage> {
        PinMode::of(known, pin).map(|mode| open_range(pin, mode))
    }

    fn autoruns(&self, known: Known<'_>) -> bool {
        let delay = known("script.autorun_delay");
        matches!(delay, Some(SettingValue::Int(delay_ms)) if delay_ms >= MIN_AUTORUN.as_millis() as i64)
    }

    fn download(&self, bytes: &[u8]) -> Result<Job<String>, String> {
        script::download_job(bytes)
    }

    fn command_title(&self, number: u8) -> &'static str {
        lookup(number).map_or("", |row| row.title)
    }

    fn saves(&self, command: u8, identity: &Identity) -> Option<bool> {
        let effect = lookup(command)?.effect(layout_of(identity.generation));
        matches!(effect, Effect::Setting | Effect::Memory).then_some(command == number::SAVE_SETTINGS)
    }

    fn help_pages(&self) -> &'static [HelpPage] {
        &[HELP_SETTINGS, HELP_COMMANDS, HELP_MCL]
    }

    fn simulated_axis(&self) -> &'static str {
        "Two motors with encoders that turn freely, on a battery"
    }

    fn simulated(&self) -> Vec<(&'static str, &'static str)> {
        let is_first = |key: &str| key == FIRST;
        let listed = || MODELS.iter().map(|model| (model.key, model.name));
        listed().filter(|(key, _)| is_first(key)).chain(listed().filter(|(key, _)| !is_first(key))).collect()
    }

    fn methods(&self, which: Loop) -> &'static [Method] {
        match which {
            Loop::Velocity => &[Method::Velocity],
            Loop::Position => &[Method::Pd, Method::Pid, Method::Piv],
        }
    }

    fn to_send(&self, scope: ArmScope, sliders: Sliders) -> Option<Drive> {
        match scope {
            ArmScope::Pwm => sliders.pwm.to_send(),
            ArmScope::Velocity => sliders.velocity.to_send(),
            ArmScope::Position => sliders.position.to_send(),
            ArmScope::ClampTest | ArmScope::Tuning | ArmScope::Script | ArmScope::CommandLine => None,
        }
    }

    fn has_loops(&self) -> bool {
        true
    }

    fn channels(&self) -> &'static [Channel] {
        CHANNELS
    }

    fn lacks(&self, _ability: Ability) -> Option<&'static str> {
        None
    }
}

/// From what just came out of its box to an axis that holds a position.
const PATH: &[PathStep] = &[
    PathStep {
        step: Step::Limits,
        shown_by: ShownBy::Settings(&[
            "motor{n}.current.max_amps",
            "limits.main_battery.min_volts",
            "limits.main_battery.max_volts",
        ]),
        place: Place::Settings(&["Current limits"]),
    },
    PathStep {
        step: Step::Direction,
        shown_by: ShownBy::Turning,
        place: Place::Drawer(Screen::Pwm, Tab::Direction),
    },
    PathStep { step: Step::Encoder, shown_by: ShownBy::Counting, place: Place::Recipe(Goal::Encoder) },
    PathStep { step: Step::Switches, shown_by: ShownBy::Switches, place: Place::Recipe(Goal::Home) },
    PathStep {
        step: Step::Velocity,
        shown_by: ShownBy::Settings(&["motor{n}.velocity.p", "motor{n}.velocity.i", "motor{n}.velocity.d"]),
        place: Place::Drawer(Screen::Velocity, Tab::Tune),
    },
    PathStep {
        step: Step::Position,
        shown_by: ShownBy::Settings(&["motor{n}.position.p", "motor{n}.position.i", "motor{n}.position.d"]),
        place: Place::Drawer(Screen::Position, Tab::Tune),
    },
    SAVE,
    BACK_UP,
];

/// The model that is simulated unless another is chosen.
const FIRST: &str = "mcp266";

/// Every setting.
pub const HELP_SETTINGS: HelpPage = HelpPage { title: "Settings Reference", group: 1, is_searched: true };
/// Every command.
pub const HELP_COMMANDS: HelpPage =
    HelpPage { title: "Packet Serial Reference", group: 1, is_searched: true };
/// The language of its scripts.
pub const HELP_MCL: HelpPage = HelpPage { title: "MCL Reference", group: 1, is_searched: true };

/// What the values of the baud rate's or the address's row mean in a control mode.
fn of_mode(row: &Row, mode: &str) -> Option<Vec<(SettingValue, String)>> {
    let Kind::Choice(codes) = row.kind else { return None };
    let is_serial = matches!(mode, "simple_serial" | "packet_serial");
    let is_address = row.pattern.ends_with("address");
    let label = |code: &Code| {
        let raw = u16::try_from(code.raw).unwrap_or_default();
        let mut words = match (is_serial, is_address) {
            (true, true) => code.key.to_owned(),
            (true, false) => format!("{} baud", code.key),
            (false, true) => ConfigWord(raw << 8).switches_text(),
            (false, false) => ConfigWord(raw << 5).options_text(),
        };
        // Address numbers of four and more differ from the others in serial modes alone.
        if !is_serial && is_address && raw > 3 {
            words.push_str(" (and bit 10)");
        }
        words[..1].make_ascii_uppercase();
        words
    };
    Some(codes.iter().map(|code| (SettingValue::Choice(code.key), label(code))).collect())
}

/// An indicator as a unit's status lights it; those for home and limit switches of an MCP as its pins do.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
fn lit(
    indicator: StatusIndicator,
    conditions: Conditions,
    identity: Option<&Identity>,
    homed: Option<[bool; 2]>,
) -> IndicatorState {
    let index = match indicator {
        StatusIndicator::M1Home => Some(0),
        StatusIndicator::M2Home => Some(1),
        _ => None,
    };
    let by_pins = identity.map_or(homed.is_some(), is_mcp);
    if let Some(index) = index.filter(|_| by_pins) {
        return match homed {
            None => IndicatorState::Unknown,
            Some(homed) if homed[index] => IndicatorState::Active,
            Some(_) => IndicatorState::Ok,
        };
    }
    let reported = identity
        .is_none_or(|identity| indicator.is_reported(layout_of(identity.generation), is_mcp(identity)));
    let dark = if reported { IndicatorState::Ok } else { IndicatorState::NotApplicable };
    indicator.lit_by(conditions).map_or(dark, state_of)
}

const fn indicator(indicator: StatusIndicator, title: &'static str) -> IndicatorInfo {
    IndicatorInfo { short: indicator.abbreviation(), title }
}

/// In the order of [`StatusIndicator::ALL`] (MCP manual 1.2.5).
const INDICATORS: [IndicatorInfo; StatusIndicator::ALL.len()] = [
    indicator(StatusIndicator::M1OverCurrent, "Motor 1 over current"),
    indicator(StatusIndicator::M2OverCurrent, "Motor 2 over current"),
    indicator(StatusIndicator::MainBatteryHigh, "Main battery over voltage"),
    indicator(StatusIndicator::MainBatteryLow, "Main battery under voltage"),
    indicator(StatusIndicator::LogicBatteryHigh, "Logic battery over voltage"),
    indicator(StatusIndicator::LogicBatteryLow, "Logic battery under voltage"),
    indicator(StatusIndicator::Temperature1, "Temperature 1"),
    indicator(StatusIndicator::Temperature2, "Temperature 2"),
    indicator(StatusIndicator::M1DriverFault, "Motor 1 driver fault"),
    indicator(StatusIndicator::M2DriverFault, "Motor 2 driver fault"),
    indicator(StatusIndicator::EStop, "Emergency stop"),
    indicator(StatusIndicator::M1Home, "Motor 1 home or limit switch"),
    indicator(StatusIndicator::M2Home, "Motor 2 home or limit switch"),
];

const fn m1(channel: Channel, label: &'static str, unit: &'static str) -> Figure {
    Figure { channel, label, unit, motor: Motor::M1 }
}

const fn m2(channel: Channel, label: &'static str, unit: &'static str) -> Figure {
    Figure { channel, label, unit, motor: Motor::M2 }
}

const FIGURES: [Figures; 5] = [
    Figures::new(
        &[m1(Channel::TEMPERATURE_1, "Temp 1", "°C"), m2(Channel::TEMPERATURE_2, "Temp 2", "°C")],
        40.0,
        (2, 5),
        false,
    ),
    Figures::new(
        &[m1(Channel::M1_CURRENT, "M1 amps", "A"), m2(Channel::M2_CURRENT, "M2 amps", "A")],
        51.0,
        (1, 7),
        false,
    ),
    Figures::new(
        &[m1(Channel::M1_POSITION, "M1 encoder", ""), m2(Channel::M2_POSITION, "M2 encoder", "")],
        68.0,
        (0, 11),
        true,
    ),
    Figures::new(
        &[m1(Channel::M1_VELOCITY, "M1 speed", "counts/s"), m2(Channel::M2_VELOCITY, "M2 speed", "counts/s")],
        54.0,
        (5, 8),
        false,
    ),
    Figures::new(
        &[m1(Channel::MAIN_BATTERY, "Main battery", "V"), m2(Channel::LOGIC_BATTERY, "Logic battery", "V")],
        74.0,
        (1, 5),
        false,
    ),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_indicators_stand_in_the_order_of_the_protocols_table() {
        for (indicator, info) in StatusIndicator::ALL.into_iter().zip(&INDICATORS) {
            assert_eq!(indicator.abbreviation(), info.short);
        }
    }
}
