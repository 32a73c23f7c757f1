//! MCP and RoboClaw: Ion Studio's screens, thirteen lamps, two motors (MCP manual 1.2).

use brushwork_link::device::{ArmScope, Channel, Drive, Identity, StatusReport};
use brushwork_mcp_client::channels::CHANNELS;
use brushwork_mcp_client::indicators::{conditions, indicators};
use brushwork_mcp_client::{is_mcp, layout_of};
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_mcp_wire::packet_serial::led::{BlinkCode, blink_code};
use brushwork_mcp_wire::packet_serial::status::{Condition, Conditions, Lamp};
use brushwork_tuning::tune::Method;
use brushwork_values::Motor;

use super::facts::{Ability, ActiveIndicator, Family, Figure, Figures, Sliders};
use super::words::{self, SettingsWords};
use crate::model::drawer::Tab;
use crate::model::lamp::{LampInfo, LampState, state_of};
use crate::model::motion_mind::Driven;
use crate::model::screen::Screen;
use crate::tune::Loop;

#[derive(Debug)]
pub(super) struct Mcp;

impl Family for Mcp {
    fn name(&self) -> &'static str {
        "MCP"
    }

    fn screens(&self, _driven: Driven) -> Vec<Screen> {
        Screen::MCP.to_vec()
    }

    fn tabs(&self, screen: Screen) -> &'static [Tab] {
        match screen {
            Screen::Pwm => &[Tab::Settings, Tab::Generator, Tab::Qpps],
            Screen::Velocity => &[Tab::Settings, Tab::Generator, Tab::ByHand, Tab::Tune],
            Screen::Position => &[Tab::Settings, Tab::VelocityLoop, Tab::Generator, Tab::ByHand, Tab::Tune],
            _ => &[],
        }
    }

    fn figures(&self) -> &'static [Figures] {
        &FIGURES
    }

    fn lamps(&self) -> &'static [LampInfo] {
        &LAMPS
    }

    fn lit(
        &self,
        report: &StatusReport,
        identity: Option<&Identity>,
        homed: Option<[bool; 2]>,
    ) -> Vec<LampState> {
        let conditions = conditions(report);
        Lamp::ALL.into_iter().map(|lamp| lit(lamp, conditions, identity, homed)).collect()
    }

    fn active(&self, report: &StatusReport, _identity: Option<&Identity>) -> Vec<ActiveIndicator> {
        let placed = report.indicators.iter().enumerate();
        let set = placed.filter(|(_, indicator)| report.word & indicator.mask != 0);
        set.map(|(place, indicator)| ActiveIndicator::new(Some(place), indicator)).collect()
    }

    fn home_indicators(&self) -> Option<[ActiveIndicator; 2]> {
        Some([Condition::M1Home, Condition::M2Home].map(|condition| {
            let place = condition as usize;
            ActiveIndicator::new(Some(place), &indicators(Generation::Gen1)[place])
        }))
    }

    fn blink_code(&self, report: &StatusReport, driving: bool) -> Option<BlinkCode> {
        Some(blink_code(conditions(report), driving))
    }

    fn words(&self) -> &'static SettingsWords {
        &words::MCP
    }

    fn motors(&self) -> &'static [Motor] {
        &Motor::BOTH
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
            _ => None,
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

/// A lamp as a unit's status lights it; those for home and limit switches of an MCP as its pins do.
fn lit(
    lamp: Lamp,
    conditions: Conditions,
    identity: Option<&Identity>,
    homed: Option<[bool; 2]>,
) -> LampState {
    let index = match lamp {
        Lamp::M1Home => Some(0),
        Lamp::M2Home => Some(1),
        _ => None,
    };
    let by_pins = identity.map_or(homed.is_some(), is_mcp);
    if let Some(index) = index.filter(|_| by_pins) {
        return match homed {
            None => LampState::Unknown,
            Some(homed) if homed[index] => LampState::Active,
            Some(_) => LampState::Ok,
        };
    }
    let told =
        identity.is_none_or(|identity| lamp.is_reported(layout_of(identity.generation), is_mcp(identity)));
    let dark = if told { LampState::Ok } else { LampState::NotApplicable };
    lamp.lit_by(conditions).map_or(dark, state_of)
}

const fn lamp(lamp: Lamp, title: &'static str) -> LampInfo {
    LampInfo { short: lamp.abbreviation(), title }
}

/// In the order of [`Lamp::ALL`] (MCP manual 1.2.5).
const LAMPS: [LampInfo; Lamp::ALL.len()] = [
    lamp(Lamp::M1OverCurrent, "Motor 1 over current"),
    lamp(Lamp::M2OverCurrent, "Motor 2 over current"),
    lamp(Lamp::MainBatteryHigh, "Main battery over voltage"),
    lamp(Lamp::MainBatteryLow, "Main battery under voltage"),
    lamp(Lamp::LogicBatteryHigh, "Logic battery over voltage"),
    lamp(Lamp::LogicBatteryLow, "Logic battery under voltage"),
    lamp(Lamp::Temperature1, "Temperature 1"),
    lamp(Lamp::Temperature2, "Temperature 2"),
    lamp(Lamp::M1DriverFault, "Motor 1 driver fault"),
    lamp(Lamp::M2DriverFault, "Motor 2 driver fault"),
    lamp(Lamp::EStop, "Emergency stop"),
    lamp(Lamp::M1Home, "Motor 1 home or limit switch"),
    lamp(Lamp::M2Home, "Motor 2 home or limit switch"),
];

const fn m1(channel: Channel, label: &'static str, unit: &'static str) -> Figure {
    Figure { channel, label, unit, motor: Motor::M1 }
}

const fn m2(channel: Channel, label: &'static str, unit: &'static str) -> Figure {
    Figure { channel, label, unit, motor: Motor::M2 }
}

const FIGURES: [Figures; 5] = [
    Figures {
        rows: &[m1(Channel::TEMPERATURE_1, "Temp 1", "°C"), m2(Channel::TEMPERATURE_2, "Temp 2", "°C")],
        label_width: 40.0,
        unit_letters: 2,
        digits: 5,
        zero: false,
    },
    Figures {
        rows: &[m1(Channel::M1_CURRENT, "M1 amps", "A"), m2(Channel::M2_CURRENT, "M2 amps", "A")],
        label_width: 51.0,
        unit_letters: 1,
        digits: 7,
        zero: false,
    },
    Figures {
        rows: &[m1(Channel::M1_POSITION, "M1 encoder", ""), m2(Channel::M2_POSITION, "M2 encoder", "")],
        label_width: 68.0,
        unit_letters: 0,
        digits: 11,
        zero: true,
    },
    Figures {
        rows: &[
            m1(Channel::M1_VELOCITY, "M1 speed", "counts/s"),
            m2(Channel::M2_VELOCITY, "M2 speed", "counts/s"),
        ],
        label_width: 54.0,
        unit_letters: 5,
        digits: 8,
        zero: false,
    },
    Figures {
        rows: &[
            m1(Channel::MAIN_BATTERY, "Main battery", "V"),
            m2(Channel::LOGIC_BATTERY, "Logic battery", "V"),
        ],
        label_width: 74.0,
        unit_letters: 1,
        digits: 5,
        zero: false,
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lamps_stand_in_the_order_of_the_protocols_table() {
        for (lamp, info) in Lamp::ALL.into_iter().zip(&LAMPS) {
            assert_eq!(lamp.abbreviation(), info.short);
        }
    }
}
