//! The states of a controller's status lamps: thirteen of an MCP (MCP manual 1.2.5), others of other families.

use brushwork_link::device::{Identity, StatusReport};

use super::lamp::{LampInfo, LampState};
use crate::family::Family;

/// The states of all lamps of a family; none of them is known before the status was read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Lamps(Vec<(&'static LampInfo, LampState)>);

impl Lamps {
    /// The lamps as a unit's status lights them; those for home and limit switches as its pins do, where they are known.
    pub fn of(
        family: &dyn Family,
        report: &StatusReport,
        identity: Option<&Identity>,
        homed: Option<[bool; 2]>,
    ) -> Self {
        Self(family.lamps().iter().zip(family.lit(report, identity, homed)).collect())
    }

    /// The lamp with this abbreviation.
    pub fn named(&self, short: &str) -> LampState {
        self.0.iter().find(|(info, _)| info.short == short).map_or(LampState::Unknown, |(_, state)| *state)
    }

    /// The gravest state of all.
    pub fn worst(&self) -> LampState {
        self.0.iter().map(|(_, state)| *state).max().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use brushwork_mcp_client::indicators::indicators;
    use brushwork_mcp_wire::packet_serial::Generation;
    use brushwork_mcp_wire::packet_serial::status::{Condition, Lamp, encode};

    use super::*;
    use crate::family;

    fn lamps(report: &StatusReport, identity: Option<&Identity>, homed: Option<[bool; 2]>) -> Lamps {
        Lamps::of(family::first(), report, identity, homed)
    }

    fn identity(model: &'static str, generation: Generation) -> Identity {
        Identity {
            family: brushwork_mcp_client::MCP,
            address: 0x80,
            protocol: "packet serial",
            version_text: model.to_owned(),
            model: Some(model),
            firmware: "1.0.0".to_owned(),
            generation: brushwork_mcp_client::firmware_of(generation),
            facts: brushwork_link::device::Facts::new(brushwork_mcp_client::McpFacts {
                generation,
                is_mcp: model.starts_with("MCP"),
                is_node: false,
            }),
            also_answers: Vec::new(),
            simulated: true,
            port: "sim:mcp266".to_owned(),
            notes: Vec::new(),
        }
    }

    fn report(conditions: &[Condition]) -> StatusReport {
        let word = encode(conditions.iter().copied().collect(), Generation::Gen1);
        StatusReport::new(0x80, Duration::ZERO, word, indicators(Generation::Gen1))
    }

    #[test]
    fn of_several_reasons_the_gravest_shows() {
        let conditions = [Condition::Temperature1Error, Condition::Temperature1Warning, Condition::M1Home];
        let lit = lamps(&report(&conditions), None, None);
        assert_eq!(lit.named(Lamp::Temperature1.abbreviation()), LampState::Error);
        assert_eq!(lit.named(Lamp::M1Home.abbreviation()), LampState::Active);
        assert_eq!(lit.named(Lamp::Temperature2.abbreviation()), LampState::Ok);
        assert_eq!(lit.worst(), LampState::Error);
    }

    #[test]
    fn a_lamp_the_unit_cannot_light_says_so() {
        let state = |model, generation, lamp: Lamp| {
            lamps(&report(&[]), Some(&identity(model, generation)), Some([true, false]))
                .named(lamp.abbreviation())
        };
        assert_eq!(state("MCP266", Generation::Gen1, Lamp::M1DriverFault), LampState::NotApplicable);
        assert_eq!(state("RoboClaw 2x7A", Generation::Gen1, Lamp::M1DriverFault), LampState::Ok);
        assert_eq!(state("MCP266", Generation::Gen1, Lamp::EStop), LampState::Ok);
        // Where the status word has a bit, the pins are not asked.
        assert_eq!(state("MCP266", Generation::Gen1, Lamp::M1Home), LampState::Active);
        assert_eq!(state("RoboClaw 2x7A", Generation::Gen1, Lamp::M1Home), LampState::Ok);
    }
}
