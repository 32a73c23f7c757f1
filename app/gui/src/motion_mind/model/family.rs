//! Motion Mind 3: one motor, registers in place of settings, and screens by the mode that its switches select
//! (Motion Mind manual, chapters 4 and 6).

use brushwork_link::FamilyRef;
use brushwork_link::device::{Addresses, ArmScope, Channel, Drive, Identity, Indicator, StatusReport};
use brushwork_motion_mind_client::channels::CHANNELS;
use brushwork_motion_mind_client::{MOTION_MIND, MotionMindFacts};
use brushwork_motion_mind_wire::{Mode, numbers};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::tune::Method;
use brushwork_values::Motor;

use super::connection::{cannot_tune, driven};
use super::drive::to_send;
use super::{MotionMindConnection, words};
use crate::family::path::{BACK_UP, PathStep, Place, SAVE, ShownBy, Step};
use crate::family::recipe::Recipes;
use crate::family::{Ability, ActiveIndicator, Family, Figure, Figures, Known, Own, SettingsWords, Sliders};
use crate::messages::NameMessage;
use crate::model::{HelpPage, IndicatorInfo, IndicatorState, Screen, Simulated, Tab, state_of};
use crate::motion_mind::messages::MindMessage;
use crate::motion_mind::recipes::MindRecipes;
use crate::tune::Loop;

#[derive(Debug)]
pub struct MotionMind;

/// From a board on the bench to an axis that holds a position (mode 4).
const PATH: &[PathStep] = &[
    PathStep {
        step: Step::Limits,
        shown_by: ShownBy::Settings(&["register.ampslimit", "register.pwmlimit"]),
        place: Place::Screen(Screen::GeneralSettings),
    },
    PathStep { step: Step::Direction, shown_by: ShownBy::Turning, place: Place::Screen(Screen::Velocity) },
    PathStep { step: Step::Encoder, shown_by: ShownBy::Counting, place: Place::Screen(Screen::Position) },
    PathStep {
        step: Step::Position,
        shown_by: ShownBy::Settings(&["register.pterm", "register.iterm", "register.dterm"]),
        place: Place::Drawer(Screen::Position, Tab::Tune),
    },
    SAVE,
    BACK_UP,
];

impl Family for MotionMind {
    fn family(&self) -> FamilyRef {
        MOTION_MIND
    }

    fn name(&self) -> &'static str {
        "Motion Mind 3"
    }

    fn own(&self) -> Option<Box<dyn Own>> {
        Some(Box::<MotionMindConnection>::default())
    }

    fn screens(&self, identity: Option<&Identity>, known: Known<'_>) -> Vec<Screen> {
        let mut screens = vec![Screen::DeviceStatus, Screen::GeneralSettings];
        screens.extend_from_slice(driven(identity, known).screens());
        screens.extend([Screen::Inputs, Screen::Terminal]);
        screens
    }

    fn title(&self, screen: Screen) -> &'static str {
        match screen {
            Screen::GeneralSettings => "Registers",
            Screen::Pwm => "Duty",
            Screen::Velocity => "Velocity",
            Screen::Position => "Position",
            Screen::Inputs => "Inputs and R/C",
            Screen::Terminal => "Terminal",
            other @ (Screen::DeviceStatus | Screen::MclEditor | Screen::Motion) => other.title(),
        }
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn tabs(&self, screen: Screen) -> &'static [Tab] {
        match screen {
            Screen::Velocity => &[Tab::Tune],
            Screen::Position => &[Tab::Steps, Tab::Tune],
            _ => &[],
        }
    }

    fn path(&self) -> &'static [PathStep] {
        PATH
    }

    fn recipes(&self) -> Option<&'static dyn Recipes> {
        Some(&MindRecipes)
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
        _homed: Option<[bool; 2]>,
    ) -> Vec<IndicatorState> {
        KEYS.iter().map(|key| lit_by(report, key, identity)).collect()
    }

    fn active(&self, report: &StatusReport, identity: Option<&Identity>) -> Vec<ActiveIndicator> {
        let place = |indicator: &Indicator| KEYS.iter().position(|key| *key == indicator.key);
        let set = report.active().filter(|indicator| means_something(indicator.key, identity));
        let mut active: Vec<_> =
            set.map(|indicator| ActiveIndicator::new(place(indicator), indicator)).collect();
        active.sort();
        active
    }

    fn words(&self) -> &'static SettingsWords {
        &words::WORDS
    }

    fn motors(&self, _identity: Option<&Identity>) -> &'static [Motor] {
        &[Motor::M1]
    }

    fn world_pins(&self) -> &'static [&'static str] {
        &["P4 control", "P3 feedback", "P17 pos. limit", "P16 neg. limit", "P12 brake", "J6 R/C, index"]
    }

    fn unit_row(&self, identity: &Identity) -> Option<(&'static str, String)> {
        let facts = MotionMindFacts::of(identity)?;
        Some((
            "Switches",
            MindMessage::Switches { mode: facts.mode.to_string(), protocol: facts.protocol.to_string() }
                .to_string(),
        ))
    }

    fn saves(&self, command: u8, _identity: &Identity) -> Option<bool> {
        let is_change =
            matches!(command, numbers::WRITE | numbers::WRITE_STORE | numbers::RESTORE | numbers::RESET);
        is_change.then_some(false)
    }

    fn help_pages(&self) -> &'static [HelpPage] {
        &[HELP]
    }

    fn simulated_axis(&self) -> &'static str {
        "One motor with an encoder that turns freely, on a battery"
    }

    fn simulated(&self) -> Vec<(&'static str, &'static str)> {
        vec![("motion-mind-3", "Motion Mind 3")]
    }

    fn simulated_target(&self, simulated: &Simulated) -> String {
        let protocol = if simulated.is_text { "ascii" } else { "binary" };
        let mut text = format!("sim:{},mode={},protocol={protocol}", simulated.model, simulated.mode);
        let last = simulated.address.saturating_add(simulated.units.max(1) - 1).min(98);
        for address in simulated.address..=last {
            text += &format!(",address={address}");
        }
        text
    }

    /// Where the simulated one is, is known; several are looked for as on any bus.
    fn simulated_addresses(&self, simulated: &Simulated) -> Option<Addresses> {
        Some(match simulated.units {
            1 => Addresses::Only(simulated.address),
            _ => Addresses::Scan,
        })
    }

    fn address_label(&self, address: u8) -> String {
        NameMessage::Unit { address: address.to_string() }.to_string()
    }

    fn scan_cost(&self) -> &'static str {
        "which takes a while, "
    }

    fn methods(&self, which: Loop) -> &'static [Method] {
        match which {
            Loop::Velocity => &[Method::Velocity],
            // One set of registers for both kinds of moves: there is no cascade.
            Loop::Position => &[Method::Pd, Method::Pid],
        }
    }

    fn cannot_tune(&self, identity: Option<&Identity>, known: Known<'_>) -> Option<&'static str> {
        cannot_tune(identity, known)
    }

    fn remedies(&self, cause: Cause) -> Option<&'static [&'static str]> {
        words::remedies(cause)
    }

    fn to_send(&self, scope: ArmScope, sliders: Sliders) -> Option<Drive> {
        let setpoints = match scope {
            ArmScope::Pwm => sliders.pwm.setpoints,
            ArmScope::Velocity => sliders.velocity.setpoints,
            ArmScope::Position => sliders.position.setpoints,
            ArmScope::ClampTest | ArmScope::Tuning | ArmScope::Script | ArmScope::CommandLine => return None,
        };
        to_send(scope, setpoints)
    }

    fn shows_registers(&self, screen: Screen) -> bool {
        matches!(screen, Screen::GeneralSettings | Screen::Inputs | Screen::Motion)
    }

    fn channels(&self) -> &'static [Channel] {
        CHANNELS
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn first_channels(&self, screen: Screen) -> &'static [Channel] {
        use Channel as C;
        match screen {
            Screen::Velocity => &[C::M1_SETPOINT, C::M1_VELOCITY, C::M1_PWM],
            Screen::Position => &[C::M1_SETPOINT, C::M1_POSITION, C::M1_PWM],
            _ => &[C::M1_PWM, C::M1_VELOCITY, C::M1_CURRENT],
        }
    }

    fn lacks(&self, ability: Ability) -> Option<&'static str> {
        Some(match ability {
            Ability::Scripts => "A Motion Mind 3 runs no scripts.",
            Ability::Qpps => "A Motion Mind 3 has no register for a top speed.",
            Ability::ClampTest => "A Motion Mind 3 has no voltage clamp.",
            Ability::Generator => {
                "Profiles are played on MCP controllers. Use the step assistant of the Position screen."
            }
            Ability::EmergencyStop => {
                "A Motion Mind 3 has no emergency stop that software resets: its brake input acts while it is low."
            }
            Ability::SecondMotor => "A Motion Mind 3 drives one motor.",
            Ability::Firmware => {
                "The firmware loader of a Motion Mind 3 is not public. Use its maker's program."
            }
            Ability::BridgeFaults => "The simulated Motion Mind 3 has no faults of its bridge.",
            Ability::Buses => "A Motion Mind 3 has no buses for scripts.",
            Ability::Conflicts => "No two registers of a Motion Mind 3 contradict each other.",
            Ability::Streams => "A Motion Mind 3 has one serial port, and no time-out for it.",
            Ability::LogicBattery => {
                "A Motion Mind 3 makes the supply of its logic out of that of the motor."
            }
            Ability::AbsoluteEncoders => "A Motion Mind 3 is tuned with its quadrature encoder.",
            Ability::ByHand => "Use the step assistant of the Position screen.",
            Ability::OwnTest => "A Motion Mind 3 has no relay test of its own.",
            Ability::Duty => return None,
        })
    }
}

/// How to connect, drive and tune it.
pub const HELP: HelpPage = HelpPage { title: "Motion Mind 3", group: 0, is_searched: true };

/// What the bit with that key shows.
fn lit_by(report: &StatusReport, key: &str, identity: Option<&Identity>) -> IndicatorState {
    if !means_something(key, identity) {
        return IndicatorState::NotApplicable;
    }
    let set = report.active().find(|bit| bit.key == key);
    set.map_or(IndicatorState::Ok, |bit| state_of(bit.severity))
}

/// Whether an indicator means anything in the unit's mode: outside of mode 0 nobody misses an R/C pulse.
fn means_something(key: &str, identity: Option<&Identity>) -> bool {
    let facts = identity.and_then(MotionMindFacts::of);
    key != BAD_RC || facts.is_none_or(|facts| facts.mode == Mode::RadioControl)
}

const BAD_RC: &str = "bad_rc";

/// The bits of the status that set the indicators, in the order of [`INDICATORS`]: what takes the drive away comes first.
const KEYS: [&str; 11] = [
    "temp_fault",
    "brake",
    "current_limit",
    BAD_RC,
    "negative_limit",
    "positive_limit",
    "virtual_negative_limit",
    "virtual_positive_limit",
    "pwm_limit",
    "in_position",
    "index",
];

const fn indicator(short: &'static str, title: &'static str) -> IndicatorInfo {
    IndicatorInfo { short, title }
}

/// The bits of STATUS (Motion Mind manual, figure 22).
const INDICATORS: [IndicatorInfo; KEYS.len()] = [
    indicator("TEMP", "Over temperature: bridge off"),
    indicator("BRK", "Brake input low: bridge off"),
    indicator("AMPS", "Current limit: drive reduced"),
    indicator("RC", "Bad R/C signal"),
    indicator("NEG", "Input NEG_LIM at ground"),
    indicator("POS", "Input POS_LIM at ground"),
    indicator("VN", "Negative virtual limit"),
    indicator("VP", "Positive virtual limit"),
    indicator("PWM", "At the PWM limit"),
    indicator("INP", "In position"),
    indicator("IDX", "Index input"),
];

const fn figure(channel: Channel, label: &'static str, unit: &'static str) -> Figure {
    Figure { channel, label, unit, motor: Motor::M1 }
}

const FIGURES: [Figures; 3] = [
    Figures::new(&[figure(Channel::M1_POSITION, "Position", "counts")], 56.0, (6, 11), true),
    Figures::new(
        &[figure(Channel::M1_VELOCITY, "Velocity", "counts/s"), figure(Channel::M1_PWM, "PWM", "%")],
        54.0,
        (8, 8),
        false,
    ),
    Figures::new(
        &[figure(Channel::M1_CURRENT, "Current", "A"), figure(Channel::TEMPERATURE_1, "Board", "°C")],
        50.0,
        (2, 7),
        false,
    ),
];

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use brushwork_motion_mind_client::indicators::INDICATORS;
    use brushwork_motion_mind_wire::{STATUS_BITS, status as bit};

    use super::*;

    fn report(word: u16) -> StatusReport {
        StatusReport::new(1, Duration::ZERO, word.into(), INDICATORS)
    }

    #[test]
    fn every_bit_of_the_status_lights_one_indicator() {
        for row in STATUS_BITS {
            let lit = MotionMind.lit(&report(row.mask()), None, None);
            assert_eq!(lit.iter().filter(|state| **state != IndicatorState::Ok).count(), 1, "{}", row.name);
            assert_eq!(MotionMind.active(&report(row.mask()), None).len(), 1, "{}", row.name);
        }
        assert_eq!(MotionMind.active(&report(0), None), []);
    }

    #[test]
    fn what_takes_the_drive_away_is_an_error_and_comes_first() {
        let active = MotionMind.active(&report(bit::TEMPFAULT | bit::INPOSITION | bit::BRAKE), None);
        let states: Vec<_> = active.iter().map(|indicator| indicator.state).collect();
        assert_eq!(states, [IndicatorState::Error, IndicatorState::Error, IndicatorState::Active]);
    }
}
