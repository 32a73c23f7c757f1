//! The states of a controller's status indicators: thirteen of an MCP (MCP manual 1.2.5), others of other families.

use brushwork_link::device::{Identity, StatusReport};

use super::indicator::{IndicatorInfo, IndicatorState};
use crate::family::Family;

/// The states of all indicators of a family; none of them is known before the status was read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Indicators(Vec<(&'static IndicatorInfo, IndicatorState)>);

impl Indicators {
    /// The indicators as a unit's status lights them; those for home and limit switches as its pins do, where they are known.
    pub fn of(
        family: &dyn Family,
        report: &StatusReport,
        identity: Option<&Identity>,
        homed: Option<[bool; 2]>,
    ) -> Self {
        Self(family.indicators().iter().zip(family.lit(report, identity, homed)).collect())
    }

    /// The indicator with this abbreviation.
    pub fn named(&self, short: &str) -> IndicatorState {
        self.0
            .iter()
            .find(|(info, _)| info.short == short)
            .map_or(IndicatorState::Unknown, |(_, state)| *state)
    }

    /// The gravest state of all.
    pub fn worst(&self) -> IndicatorState {
        self.0.iter().map(|(_, state)| *state).max().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use brushwork_mcp_client::indicators::indicators;
    use brushwork_mcp_wire::packet_serial::Generation;
    use brushwork_mcp_wire::packet_serial::status::{Condition, StatusIndicator, encode};

    use super::*;
    use crate::family;

    fn row(report: &StatusReport, identity: Option<&Identity>, homed: Option<[bool; 2]>) -> Indicators {
        Indicators::of(family::first(), report, identity, homed)
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
                motors: 2,
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
        let lit = row(&report(&conditions), None, None);
        assert_eq!(lit.named(StatusIndicator::Temperature1.abbreviation()), IndicatorState::Error);
        assert_eq!(lit.named(StatusIndicator::M1Home.abbreviation()), IndicatorState::Active);
        assert_eq!(lit.named(StatusIndicator::Temperature2.abbreviation()), IndicatorState::Ok);
        assert_eq!(lit.worst(), IndicatorState::Error);
    }

    #[test]
    fn an_indicator_the_unit_cannot_light_says_so() {
        let state = |model, generation, indicator: StatusIndicator| {
            row(&report(&[]), Some(&identity(model, generation)), Some([true, false]))
                .named(indicator.abbreviation())
        };
        assert_eq!(
            state("MCP266", Generation::Gen1, StatusIndicator::M1DriverFault),
            IndicatorState::NotApplicable
        );
        assert_eq!(
            state("RoboClaw 2x7A", Generation::Gen1, StatusIndicator::M1DriverFault),
            IndicatorState::Ok
        );
        assert_eq!(state("MCP266", Generation::Gen1, StatusIndicator::EStop), IndicatorState::Ok);
        // Where the status word has a bit, the pins are not asked.
        assert_eq!(state("MCP266", Generation::Gen1, StatusIndicator::M1Home), IndicatorState::Active);
        assert_eq!(state("RoboClaw 2x7A", Generation::Gen1, StatusIndicator::M1Home), IndicatorState::Ok);
    }
}
