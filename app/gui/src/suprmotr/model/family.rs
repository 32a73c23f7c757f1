//! SuprMotr V9: one motor that takes moves and nothing else (SuprMotr manual).

use brushwork_link::FamilyRef;
use brushwork_link::device::{Addresses, ArmScope, Channel, Drive, Identity, Indicator, StatusReport};
use brushwork_script::language::Grammar;
use brushwork_suprmotr_client::channels::CHANNELS;
use brushwork_suprmotr_client::{COMPUTED_TARGET, COMPUTED_VELOCITY, SUPRMOTR, SuprMotrFacts};
use brushwork_suprmotr_macros::MACROS;
use brushwork_suprmotr_wire::{Effect, Mnemonic, Radix};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::tune::Method;
use brushwork_values::Motor;

use super::{SuprMotrConnection, to_send};
use crate::family::path::{BACK_UP, PathStep, Place, SAVE, ShownBy, Step};
use crate::family::recipe::Recipes;
use crate::family::{Ability, ActiveIndicator, Family, Figure, Figures, Known, Own, SettingsWords, Sliders};
use crate::messages::NameMessage;
use crate::model::{IndicatorInfo, IndicatorState, Screen, Simulated, Tab, state_of};
use crate::suprmotr::messages::LineMessage;
use crate::suprmotr::recipes::SuprMotrRecipes;
use crate::tune::Loop;

#[derive(Debug)]
pub struct SuprMotr;

/// From a board on the bench to an axis that goes to places.
const PATH: &[PathStep] = &[
    PathStep { step: Step::Encoder, shown_by: ShownBy::Counting, place: Place::Screen(Screen::Position) },
    PathStep {
        step: Step::Switches,
        shown_by: ShownBy::IfWanted(&["limits.enabled"]),
        place: Place::Screen(Screen::GeneralSettings),
    },
    PathStep {
        step: Step::Position,
        shown_by: ShownBy::Settings(&["loop.p", "loop.i", "loop.d"]),
        place: Place::Drawer(Screen::Position, Tab::Tune),
    },
    SAVE,
    BACK_UP,
];

impl Family for SuprMotr {
    fn family(&self) -> FamilyRef {
        SUPRMOTR
    }

    fn name(&self) -> &'static str {
        "SuprMotr V9"
    }

    fn own(&self) -> Option<Box<dyn Own>> {
        Some(Box::<SuprMotrConnection>::default())
    }

    fn simulated_axis(&self) -> &'static str {
        "One motor with an encoder on a slide, with limit and reference switches"
    }

    fn screens(&self, _identity: Option<&Identity>, _known: Known<'_>) -> Vec<Screen> {
        vec![
            Screen::DeviceStatus,
            Screen::GeneralSettings,
            Screen::Position,
            Screen::Inputs,
            Screen::MclEditor,
            Screen::Terminal,
        ]
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn title(&self, screen: Screen) -> &'static str {
        match screen {
            Screen::Position => "Motion",
            Screen::MclEditor => "Macros",
            Screen::Terminal => "Terminal",
            Screen::Inputs => "Inputs and Outputs",
            other => other.title(),
        }
    }

    fn recipes(&self) -> Option<&'static dyn Recipes> {
        Some(&SuprMotrRecipes)
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
        _identity: Option<&Identity>,
        _homed: Option<[bool; 2]>,
    ) -> Vec<IndicatorState> {
        let lit = |key: &&str| {
            let set = report.active().find(|bit| bit.key == *key);
            set.map_or(IndicatorState::Ok, |bit| state_of(bit.severity))
        };
        KEYS.iter().map(lit).collect()
    }

    fn active(&self, report: &StatusReport, _identity: Option<&Identity>) -> Vec<ActiveIndicator> {
        let place = |indicator: &Indicator| KEYS.iter().position(|key| *key == indicator.key);
        let placed = report.active().filter(|indicator| place(indicator).is_some());
        let mut active: Vec<_> =
            placed.map(|indicator| ActiveIndicator::new(place(indicator), indicator)).collect();
        active.sort();
        active
    }

    fn words(&self) -> &'static SettingsWords {
        &WORDS
    }

    fn motors(&self, _identity: Option<&Identity>) -> &'static [Motor] {
        &[Motor::M1]
    }

    fn unit_row(&self, identity: &Identity) -> Option<(&'static str, String)> {
        let facts = SuprMotrFacts::of(identity)?;
        let numbers = if facts.radix() == Radix::Decimal { "decimal" } else { "hexadecimal" };
        let echo = if facts.has_echo() { "echo on" } else { "echo off" };
        Some(("Line", LineMessage::Set { echo, numbers }.to_string()))
    }

    fn saves(&self, command: u8, _identity: &Identity) -> Option<bool> {
        let mnemonic = Mnemonic::from_number(command)?;
        let is_change = matches!(mnemonic.row().effect, Effect::Setting | Effect::Lasting);
        is_change.then_some(mnemonic == Mnemonic::UD)
    }

    fn command_title(&self, number: u8) -> &'static str {
        Mnemonic::from_number(number).map_or("", |mnemonic| mnemonic.row().title)
    }

    fn simulated(&self) -> Vec<(&'static str, &'static str)> {
        vec![("suprmotr-v9", "SuprMotr V9")]
    }

    /// Where the simulated one is, is known.
    fn simulated_addresses(&self, _simulated: &Simulated) -> Option<Addresses> {
        Some(Addresses::Factory)
    }

    fn address_label(&self, address: u8) -> String {
        NameMessage::Unit { address: self.family().address_text(address).to_string() }.to_string()
    }

    fn scan_cost(&self) -> &'static str {
        "at three rates where no unit answers, "
    }

    fn to_send(&self, scope: ArmScope, sliders: Sliders) -> Option<Drive> {
        (scope == ArmScope::Position).then(|| to_send(sliders.position.setpoints)).flatten()
    }

    fn grammar(&self) -> Option<&'static Grammar> {
        Some(&MACROS)
    }

    fn shows_registers(&self, screen: Screen) -> bool {
        screen == Screen::Inputs
    }

    fn tabs(&self, screen: Screen) -> &'static [Tab] {
        if screen == Screen::Position { &[Tab::Gains, Tab::Home, Tab::Tune] } else { &[] }
    }

    /// One loop on the position, and none under it.
    fn methods(&self, which: Loop) -> &'static [Method] {
        match which {
            Loop::Velocity => &[],
            Loop::Position => &[Method::Pd, Method::Pid],
        }
    }

    fn path(&self) -> &'static [PathStep] {
        PATH
    }

    fn channels(&self) -> &'static [Channel] {
        CHANNELS
    }

    fn first_channels(&self, _screen: Screen) -> &'static [Channel] {
        &[Channel::M1_POSITION, COMPUTED_TARGET, Channel::M1_POSITION_ERROR, COMPUTED_VELOCITY]
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "the others have remedies that hold for all")]
    fn remedies(&self, cause: Cause) -> Option<&'static [&'static str]> {
        match cause {
            Cause::TravelLimit => Some(&[
                "Move the axis to the middle of its travel.",
                "Widen the travel if the mechanics allow it.",
                "Lower the velocity of its moves (DV), so that it needs less room to stop.",
            ]),
            Cause::ShaftLocked | Cause::Stalled => Some(&[
                "Release brakes and take jams away; turn the shaft by hand.",
                "If the axis stands at an end stop, move it to the middle and tune Within its travel.",
                "If it is only heavy, raise DL, the most that the loop may give.",
            ]),
            _ => None,
        }
    }

    fn lacks(&self, ability: Ability) -> Option<&'static str> {
        Some(match ability {
            Ability::Scripts => "A SuprMotr runs macros of its own language, not scripts.",
            Ability::Qpps => "A SuprMotr has no setting for a top speed: DV is the velocity of its moves.",
            Ability::ClampTest => "A SuprMotr has no voltage clamp.",
            Ability::Generator => {
                "Profiles are played on MCP controllers. A SuprMotr makes its own trajectory."
            }
            Ability::EmergencyStop => "A SuprMotr has no emergency stop that software resets.",
            Ability::SecondMotor => "A SuprMotr drives one motor.",
            Ability::Firmware => "The firmware of a SuprMotr cannot be loaded over its serial line.",
            Ability::BridgeFaults => "The simulated SuprMotr has no faults of its bridge.",
            Ability::Buses => "A SuprMotr has no buses for scripts.",
            Ability::Conflicts => "No two settings of a SuprMotr contradict each other.",
            Ability::Streams => "A SuprMotr has one serial port, and no time-out for it.",
            Ability::LogicBattery => "A SuprMotr makes the supply of its logic out of that of the motor.",
            Ability::AbsoluteEncoders => "A SuprMotr has a quadrature encoder.",
            Ability::ByHand => "A SuprMotr takes no duty, by which gains could be calibrated by hand.",
            Ability::OwnTest => "A SuprMotr has no relay test.",
            Ability::Duty => "A SuprMotr takes no duty.",
        })
    }
}

/// How acts on the settings are told.
static WORDS: SettingsWords = SettingsWords {
    title: "Settings",
    many: "settings",
    save: "Save to EEPROM…",
    save_now: "Save",
    save_text: "Saves all settings that the unit works with now (UD), then reads them. EEPROM itself is read at a restart alone.",
    save_warning: None,
    defaults: "Factory…",
    defaults_now: "Write factory values",
    defaults_text: "Writes the factory values of the manual into RAM, one by one; the address stays. They last only once they are saved.",
    defaults_warning: Some("The gains change under a motor that its loop holds: it may move a little."),
    reload_text: "Load from EEPROM restarts the unit (RT), then reads its settings. Its position is 0 afterwards, and what it works with \
                  now and was not saved is lost. It is refused where a macro 0 would run.",
};

/// The bits of the status that set the indicators, in the order of [`INDICATORS`]: what ends a move comes first.
const KEYS: [&str; 12] = [
    "excessive_error",
    "move_error",
    "command_error",
    "negative_limit",
    "positive_limit",
    "reference",
    "motor_off",
    "trajectory_complete",
    "macro",
    "wait",
    "find_edge",
    "limits_on",
];

const fn indicator(short: &'static str, title: &'static str) -> IndicatorInfo {
    IndicatorInfo { short, title }
}

/// Bits of TS (SuprMotr manual, Tell Status).
const INDICATORS: [IndicatorInfo; KEYS.len()] = [
    indicator("EXC", "Excessive position error"),
    indicator("MOVE", "Move error"),
    indicator("CMD", "Command refused"),
    indicator("NEG", "Negative limit switch"),
    indicator("POS", "Positive limit switch"),
    indicator("REF", "Reference switch"),
    indicator("OFF", "Motor off"),
    indicator("DONE", "Trajectory complete"),
    indicator("MAC", "Macro running"),
    indicator("WAIT", "Waiting"),
    indicator("EDGE", "Looking for an edge"),
    indicator("LIM", "Limit switches act"),
];

const fn figure(channel: Channel, label: &'static str, unit: &'static str) -> Figure {
    Figure { channel, label, unit, motor: Motor::M1 }
}

const FIGURES: [Figures; 2] = [
    Figures::new(
        &[
            figure(Channel::M1_POSITION, "Position", "counts"),
            figure(COMPUTED_TARGET, "Target (computed)", "counts"),
        ],
        112.0,
        (6, 11),
        false,
    ),
    Figures::new(
        &[
            figure(Channel::M1_POSITION_ERROR, "Following error", "counts"),
            figure(COMPUTED_VELOCITY, "Velocity (computed)", "counts/s"),
        ],
        126.0,
        (8, 9),
        false,
    ),
];

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use brushwork_suprmotr_client::indicators;

    use super::*;

    fn report(word: u32) -> StatusReport {
        StatusReport::new(0, Duration::ZERO, word, indicators::INDICATORS)
    }

    #[test]
    fn every_indicator_is_lit_by_its_bit_and_what_ends_a_move_comes_first() {
        for (place, key) in KEYS.iter().enumerate() {
            let bit = indicators::INDICATORS.iter().find(|indicator| indicator.key == *key).unwrap();
            let lit = SuprMotr.lit(&report(bit.mask), None, None);
            let on: Vec<_> = (0..lit.len()).filter(|at| lit[*at] != IndicatorState::Ok).collect();
            assert_eq!(on, [place], "{key}");
        }
        let all = SuprMotr.active(&report(u32::MAX), None);
        assert_eq!((all.len(), all[0].state), (KEYS.len(), IndicatorState::Error));
        assert_eq!(SuprMotr.active(&report(0), None), []);
    }

    #[test]
    fn only_moves_are_sent_and_only_while_the_motion_screen_is_armed() {
        let mut connection = crate::model::Connection::default();
        connection.move_suprmotr(500.0);
        let sliders =
            Sliders { pwm: connection.pwm, velocity: connection.velocity, position: connection.position };
        assert!(SuprMotr.to_send(ArmScope::Position, sliders).is_some());
        assert_eq!(SuprMotr.to_send(ArmScope::Velocity, sliders), None);
    }
}
