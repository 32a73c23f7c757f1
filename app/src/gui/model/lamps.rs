//! The states of the thirteen status lamps (MCP manual 1.2.5).

use brushwork_link::device::{Identity, StatusReport};
use brushwork_protocol::packet_serial::status::{Lamp, Severity};

use crate::gui::widgets::LampState;

/// The state of all lamps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lamps([LampState; Lamp::ALL.len()]);

impl Lamps {
    /// The lamps as a unit's status lights them; those for home and limit switches of an MCP as its pins do, where they are
    /// known.
    pub fn of(report: &StatusReport, identity: Option<&Identity>, homed: Option<[bool; 2]>) -> Self {
        let mut lamps = Self::default();
        for lamp in Lamp::ALL {
            let told = identity
                .is_none_or(|identity| lamp.is_reported(identity.generation.layout(), identity.is_mcp()));
            let dark = if told { LampState::Ok } else { LampState::NotApplicable };
            lamps.0[lamp as usize] = report.lamp(lamp).map_or(dark, state_of);
        }
        if identity.is_some_and(Identity::is_mcp) {
            for (lamp, index) in [(Lamp::M1Home, 0), (Lamp::M2Home, 1)] {
                lamps.0[lamp as usize] = match homed {
                    None => LampState::Unknown,
                    Some(homed) if homed[index] => LampState::Active,
                    Some(_) => LampState::Ok,
                };
            }
        }
        lamps
    }

    pub fn get(&self, lamp: Lamp) -> LampState {
        self.0[lamp as usize]
    }

    /// The gravest state of all.
    pub fn worst(&self) -> LampState {
        self.0.iter().copied().max().unwrap_or_default()
    }
}

/// How a condition of this severity is shown.
pub const fn state_of(severity: Severity) -> LampState {
    match severity {
        Severity::Signal => LampState::Active,
        Severity::Warning => LampState::Warning,
        Severity::Error => LampState::Error,
    }
}

/// The lamp's name in full, as the manual has it.
pub const fn title(lamp: Lamp) -> &'static str {
    match lamp {
        Lamp::M1OverCurrent => "Motor 1 over current",
        Lamp::M2OverCurrent => "Motor 2 over current",
        Lamp::MainBatteryHigh => "Main battery over voltage",
        Lamp::MainBatteryLow => "Main battery under voltage",
        Lamp::LogicBatteryHigh => "Logic battery over voltage",
        Lamp::LogicBatteryLow => "Logic battery under voltage",
        Lamp::Temperature1 => "Temperature 1",
        Lamp::Temperature2 => "Temperature 2",
        Lamp::M1DriverFault => "Motor 1 driver fault",
        Lamp::M2DriverFault => "Motor 2 driver fault",
        Lamp::EStop => "Emergency stop",
        Lamp::M1Home => "Motor 1 home or limit switch",
        Lamp::M2Home => "Motor 2 home or limit switch",
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use brushwork_protocol::packet_serial::Generation;
    use brushwork_protocol::packet_serial::status::Condition;

    use super::*;

    fn identity(model: &'static str, generation: Generation) -> Identity {
        Identity {
            address: 0x80,
            family: "packet serial",
            version_text: model.to_owned(),
            model: Some(model),
            firmware: "1.0.0".to_owned(),
            generation: generation.into(),
            motion_mind: None,
            also_answers: Vec::new(),
            simulated: true,
            port: "sim:mcp266".to_owned(),
            notes: Vec::new(),
        }
    }

    fn report(conditions: &[Condition]) -> StatusReport {
        let conditions = conditions.iter().copied().collect();
        StatusReport {
            signs: &[],
            address: 0x80,
            at: Duration::ZERO,
            word: 0,
            conditions,
            unknown_bits: 0,
            running_ticks: None,
        }
    }

    #[test]
    fn of_several_reasons_the_gravest_shows() {
        let conditions = [Condition::Temperature1Error, Condition::Temperature1Warning, Condition::M1Home];
        let lamps = Lamps::of(&report(&conditions), None, None);
        assert_eq!(lamps.get(Lamp::Temperature1), LampState::Error);
        assert_eq!(lamps.get(Lamp::M1Home), LampState::Active);
        assert_eq!(lamps.get(Lamp::Temperature2), LampState::Ok);
        assert_eq!(lamps.worst(), LampState::Error);
    }

    #[test]
    fn a_lamp_the_unit_cannot_light_says_so() {
        let state = |model, generation, lamp| {
            Lamps::of(&report(&[]), Some(&identity(model, generation)), Some([true, false])).get(lamp)
        };
        assert_eq!(state("MCP266", Generation::Gen1, Lamp::M1DriverFault), LampState::NotApplicable);
        assert_eq!(state("RoboClaw 2x7A", Generation::Gen1, Lamp::M1DriverFault), LampState::Ok);
        assert_eq!(state("MCP266", Generation::Gen1, Lamp::EStop), LampState::Ok);
        // Where the status word has a bit, the pins are not asked.
        assert_eq!(state("MCP266", Generation::Gen1, Lamp::M1Home), LampState::Active);
        assert_eq!(state("RoboClaw 2x7A", Generation::Gen1, Lamp::M1Home), LampState::Ok);
    }
}
