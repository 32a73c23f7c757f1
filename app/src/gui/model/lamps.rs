//! The thirteen status lamps (MCP manual 1.2.5).

use crate::gui::widgets::LampState;

/// One lamp.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lamp {
    M1OverCurrent,
    M2OverCurrent,
    MainBatteryHigh,
    MainBatteryLow,
    LogicBatteryHigh,
    LogicBatteryLow,
    Temperature1,
    Temperature2,
    M1DriverFault,
    M2DriverFault,
    EmergencyStop,
    M1Home,
    M2Home,
}

impl Lamp {
    /// All of them, in the manual's order.
    pub const ALL: [Self; 13] = [
        Self::M1OverCurrent,
        Self::M2OverCurrent,
        Self::MainBatteryHigh,
        Self::MainBatteryLow,
        Self::LogicBatteryHigh,
        Self::LogicBatteryLow,
        Self::Temperature1,
        Self::Temperature2,
        Self::M1DriverFault,
        Self::M2DriverFault,
        Self::EmergencyStop,
        Self::M1Home,
        Self::M2Home,
    ];

    pub const fn abbreviation(self) -> &'static str {
        match self {
            Self::M1OverCurrent => "M1OC",
            Self::M2OverCurrent => "M2OC",
            Self::MainBatteryHigh => "MBHI",
            Self::MainBatteryLow => "MBLO",
            Self::LogicBatteryHigh => "LBHI",
            Self::LogicBatteryLow => "LBLO",
            Self::Temperature1 => "TMP1",
            Self::Temperature2 => "TMP2",
            Self::M1DriverFault => "M1DF",
            Self::M2DriverFault => "M2DF",
            Self::EmergencyStop => "ESTP",
            Self::M1Home => "M1HM",
            Self::M2Home => "M2HM",
        }
    }

    pub const fn title(self) -> &'static str {
        match self {
            Self::M1OverCurrent => "Motor 1 over current",
            Self::M2OverCurrent => "Motor 2 over current",
            Self::MainBatteryHigh => "Main battery over voltage",
            Self::MainBatteryLow => "Main battery under voltage",
            Self::LogicBatteryHigh => "Logic battery over voltage",
            Self::LogicBatteryLow => "Logic battery under voltage",
            Self::Temperature1 => "Temperature 1",
            Self::Temperature2 => "Temperature 2",
            Self::M1DriverFault => "Motor 1 driver fault",
            Self::M2DriverFault => "Motor 2 driver fault",
            Self::EmergencyStop => "Emergency stop",
            Self::M1Home => "Motor 1 home or limit switch",
            Self::M2Home => "Motor 2 home or limit switch",
        }
    }

    const fn index(self) -> usize {
        self as usize
    }
}

/// The state of all lamps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Lamps([LampState; Lamp::ALL.len()]);

impl Lamps {
    /// All of them the same.
    pub const fn all(state: LampState) -> Self {
        Self([state; Lamp::ALL.len()])
    }

    pub const fn get(&self, lamp: Lamp) -> LampState {
        self.0[lamp.index()]
    }

    /// Lights a lamp; of several reasons the gravest shows.
    pub fn raise(&mut self, lamp: Lamp, state: LampState) {
        let now = &mut self.0[lamp.index()];
        *now = (*now).max(state);
    }

    /// The gravest state of all.
    pub fn worst(&self) -> LampState {
        self.0.iter().copied().max().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_lamp_has_its_own_place_abbreviation_and_title() {
        for (index, lamp) in Lamp::ALL.into_iter().enumerate() {
            assert_eq!(lamp.index(), index);
            assert_eq!(lamp.abbreviation().len(), 4);
            let same =
                |other: &&Lamp| other.abbreviation() == lamp.abbreviation() || other.title() == lamp.title();
            assert_eq!(Lamp::ALL.iter().filter(same).count(), 1);
        }
    }

    #[test]
    fn the_gravest_reason_shows() {
        let mut lamps = Lamps::all(LampState::Ok);
        lamps.raise(Lamp::Temperature1, LampState::Error);
        lamps.raise(Lamp::Temperature1, LampState::Warning);
        assert_eq!(lamps.get(Lamp::Temperature1), LampState::Error);
        assert_eq!(lamps.worst(), LampState::Error);
        assert_eq!(lamps.get(Lamp::Temperature2), LampState::Ok);
    }
}
