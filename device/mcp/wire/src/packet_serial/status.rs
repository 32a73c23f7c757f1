//! The status word of commands 90 and 73: which bit means what.
//!
//! Generations 1 and 2 send two bytes, 3 and 4 send four, and the bits mean different things, not only more of them
//! (MCP manual command 90; public clients and the RoboClaw manual of 2018). Everything that knows a condition uses
//! [`Condition`], whatever the generation; one table says where each lies. The script register SYSSTATUS of the manual
//! has yet another order and is not this word.

use std::fmt;

use brushwork_values::Severity;
use serde::{Deserialize, Serialize};

use super::identity::Generation;

brushwork_values::listed! {
    /// The thirteen indicators of the vendor's program (MCP manual 1.2.2), in its order.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
    #[serde(rename_all = "snake_case")]
    pub enum StatusIndicator {
        /// Current of motor 1.
        M1OverCurrent "M1 over-current",
        /// Current of motor 2.
        M2OverCurrent "M2 over-current",
        /// Main battery over its limit.
        MainBatteryHigh "Main battery high",
        /// Main battery under its limit.
        MainBatteryLow "Main battery low",
        /// Logic battery over its limit.
        LogicBatteryHigh "Logic battery high",
        /// Logic battery under its limit.
        LogicBatteryLow "Logic battery low",
        /// Board temperature.
        Temperature1 "Temperature 1",
        /// Second temperature.
        Temperature2 "Temperature 2",
        /// Bridge of motor 1.
        M1DriverFault "M1 driver fault",
        /// Bridge of motor 2.
        M2DriverFault "M2 driver fault",
        /// Emergency stop.
        EStop "E-Stop",
        /// Home input of motor 1.
        M1Home "M1 home",
        /// Home input of motor 2.
        M2Home "M2 home",
    }
    /// In full.
    fn title;
}

/// A row of the table of conditions.
#[derive(Debug, Clone, Copy)]
pub struct ConditionRow {
    /// The condition.
    pub condition: Condition,
    /// Name in programs: snake_case.
    pub key: &'static str,
    /// What people call it.
    pub title: &'static str,
    /// How grave it is.
    pub severity: Severity,
    /// The indicator that shows it, if one does.
    pub indicator: Option<StatusIndicator>,
    /// Its bit in generations 1 to 4, as a mask; 0 where the generation has none.
    pub masks: [u32; 4],
}

/// A set of conditions.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct Conditions(u64);

/// The conditions of a status word. Bits that mean nothing in `generation` are left out; see [`unknown_bits`].
pub fn decode(word: u32, generation: Generation) -> Conditions {
    let rows = CONDITIONS.iter().filter(|row| word & row.mask(generation) != 0);
    rows.map(|row| row.condition).collect()
}

/// The status word that says these conditions. Those that have no bit in `generation` are left out.
pub fn encode(conditions: Conditions, generation: Generation) -> u32 {
    conditions.iter().fold(0, |word, condition| word | condition.row().mask(generation))
}

/// The bits of a status word that mean nothing in `generation`.
pub fn unknown_bits(word: u32, generation: Generation) -> u32 {
    let known = CONDITIONS.iter().fold(0, |known, row| known | row.mask(generation));
    word & !known
}

impl ConditionRow {
    /// Its bit in `generation`, as a mask; 0 if it has none.
    pub const fn mask(&self, generation: Generation) -> u32 {
        self.masks[generation.number() as usize - 1]
    }
}

impl Condition {
    /// Its row in the table.
    pub const fn row(self) -> &'static ConditionRow {
        &CONDITIONS[self as usize]
    }

    /// What people call it.
    pub const fn title(self) -> &'static str {
        self.row().title
    }

    /// How grave it is.
    pub const fn severity(self) -> Severity {
        self.row().severity
    }

    /// The indicator that shows it, if one does.
    pub const fn indicator(self) -> Option<StatusIndicator> {
        self.row().indicator
    }
}

impl fmt::Display for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.title())
    }
}

impl StatusIndicator {
    /// The four letters of the vendor's program.
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
            Self::EStop => "ESTP",
            Self::M1Home => "M1HM",
            Self::M2Home => "M2HM",
        }
    }

    /// Whether a status word can light it. An MCP has no driver faults, and its home indicators follow the actions of its pins
    /// instead (MCP manual 1.2.5 and command 90, whose table ends before them).
    pub fn is_reported(self, generation: Generation, mcp: bool) -> bool {
        let roboclaw_only =
            matches!(self, Self::M1DriverFault | Self::M2DriverFault | Self::M1Home | Self::M2Home);
        let has_bit = CONDITIONS.iter().any(|row| row.indicator == Some(self) && row.mask(generation) != 0);
        has_bit && !(mcp && roboclaw_only)
    }

    /// The gravest of the conditions that light it; `None` if it is dark.
    pub fn lit_by(self, conditions: Conditions) -> Option<Severity> {
        conditions
            .iter()
            .filter(|condition| condition.indicator() == Some(self))
            .map(Condition::severity)
            .max()
    }
}

impl Conditions {
    /// None at all.
    pub const NONE: Self = Self(0);

    /// Whether there is none.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether it is among them.
    pub const fn contains(self, condition: Condition) -> bool {
        self.0 & Self::bit(condition) != 0
    }

    /// Adds it.
    pub const fn insert(&mut self, condition: Condition) {
        self.0 |= Self::bit(condition);
    }

    /// Takes it out.
    pub const fn remove(&mut self, condition: Condition) {
        self.0 &= !Self::bit(condition);
    }

    /// Adds or takes it out.
    pub const fn set(&mut self, condition: Condition, present: bool) {
        if present {
            self.insert(condition);
        } else {
            self.remove(condition);
        }
    }

    /// Those that a status word of `generation` can say.
    #[must_use]
    pub fn known_to(self, generation: Generation) -> Self {
        self.iter().filter(|condition| condition.row().mask(generation) != 0).collect()
    }

    /// Each, in the order of the table.
    pub fn iter(self) -> impl Iterator<Item = Condition> {
        CONDITIONS.iter().map(|row| row.condition).filter(move |&condition| self.contains(condition))
    }

    /// The gravest; `None` if there is none.
    pub fn severity(self) -> Option<Severity> {
        self.iter().map(Condition::severity).max()
    }

    const fn bit(condition: Condition) -> u64 {
        1 << condition as u32
    }
}

impl FromIterator<Condition> for Conditions {
    fn from_iter<I: IntoIterator<Item = Condition>>(conditions: I) -> Self {
        let mut all = Self::NONE;
        for condition in conditions {
            all.insert(condition);
        }
        all
    }
}

impl fmt::Display for Conditions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_empty() {
            return f.write_str("normal");
        }
        for (index, condition) in self.iter().enumerate() {
            f.write_str(if index == 0 { "" } else { ", " })?;
            f.write_str(condition.title())?;
        }
        Ok(())
    }
}

/// The indicator of a row of [`conditions`].
macro_rules! indicator {
    () => {
        None
    };
    ($indicator:ident) => {
        Some(StatusIndicator::$indicator)
    };
}

/// The conditions and their table: what each means, its name in programs, what people call it, how grave it is, the
/// indicator that shows it and its masks.
macro_rules! conditions {
    ($($(#[$meaning:meta])+ $condition:ident $key:literal $title:literal $severity:ident [$($indicator:ident)?] $masks:expr;)*) => {
        /// What a status word can say about a unit.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case")]
        pub enum Condition {
            $($(#[$meaning])+ $condition),*
        }

        /// Every condition in the order of [`Condition`]. Bits of generations 1 and 2: MCP manual command 90, with those of
        /// the RoboClaw in the gaps. Of 3 and 4: public clients and the RoboClaw manual of 2018, with those of 2025 in the
        /// gaps.
        pub static CONDITIONS: [ConditionRow; 36] = [$(ConditionRow {
            condition: Condition::$condition,
            key: $key,
            title: $title,
            severity: Severity::$severity,
            indicator: indicator!($($indicator)?),
            masks: $masks,
        }),*];
    };
}

conditions! {
    /// The emergency stop is pressed or not yet reset.
    EStop "e_stop" "E-Stop" Error [EStop] [0x0004, 0x0004, 0x0001, 0x0001];
    /// The board is too hot; the motors are stopped.
    Temperature1Error "temperature1_error" "Temperature error" Error [Temperature1] [0x0008, 0x0008, 0x0002, 0x0002];
    /// The second sensor is too hot; the motors are stopped.
    Temperature2Error "temperature2_error" "Temperature 2 error" Error [Temperature2] [0x0010, 0x0010, 0x0004, 0x0004];
    /// The main battery is over its limit.
    MainBatteryHighError "main_battery_high_error" "Main battery high error" Error [MainBatteryHigh] [0x0020, 0x0020, 0x0008, 0x0008];
    /// The main battery is under its limit (generation 4).
    MainBatteryLowError "main_battery_low_error" "Main battery low error" Error [MainBatteryLow] [0, 0, 0, 0x4000];
    /// The main battery was over its limit and is not yet far enough below (generation 4).
    MainBatteryHighHysteresis "main_battery_high_hysteresis" "Main battery high hysteresis" Error [MainBatteryHigh] [0, 0, 0, 0x8000];
    /// The logic battery is over its limit.
    LogicBatteryHighError "logic_battery_high_error" "Logic battery high error" Error [LogicBatteryHigh] [0x0040, 0x0040, 0x0010, 0x0010];
    /// The logic battery is under its limit.
    LogicBatteryLowError "logic_battery_low_error" "Logic battery low error" Error [LogicBatteryLow] [0x0080, 0x0080, 0x0020, 0x0020];
    /// The bridge of motor 1 reports a fault.
    M1DriverFault "m1_driver_fault" "M1 driver fault" Error [M1DriverFault] [0x0100, 0x0100, 0x0040, 0x0040];
    /// The bridge of motor 2 reports a fault.
    M2DriverFault "m2_driver_fault" "M2 driver fault" Error [M2DriverFault] [0x0200, 0x0200, 0x0080, 0x0080];
    /// Motor 1 was stopped by its speed error limit.
    M1SpeedError "m1_speed_error" "M1 speed error" Error [] [0, 0, 0x0100, 0x0100];
    /// Motor 2 was stopped by its speed error limit.
    M2SpeedError "m2_speed_error" "M2 speed error" Error [] [0, 0, 0x0200, 0x0200];
    /// Motor 1 was stopped by its position error limit.
    M1PositionError "m1_position_error" "M1 position error" Error [] [0, 0, 0x0400, 0x0400];
    /// Motor 2 was stopped by its position error limit.
    M2PositionError "m2_position_error" "M2 position error" Error [] [0, 0, 0x0800, 0x0800];
    /// Motor 1 was stopped by its current.
    M1CurrentError "m1_current_error" "M1 current error" Error [M1OverCurrent] [0, 0, 0x1000, 0x1000];
    /// Motor 2 was stopped by its current.
    M2CurrentError "m2_current_error" "M2 current error" Error [M2OverCurrent] [0, 0, 0x2000, 0x2000];
    /// Motor 1 is at its current limit.
    M1OverCurrentWarning "m1_over_current_warning" "M1 over-current warning" Warning [M1OverCurrent] [0x0001, 0x0001, 0x0001_0000, 0x0001_0000];
    /// Motor 2 is at its current limit.
    M2OverCurrentWarning "m2_over_current_warning" "M2 over-current warning" Warning [M2OverCurrent] [0x0002, 0x0002, 0x0002_0000, 0x0002_0000];
    /// The main battery is near its upper limit.
    MainBatteryHighWarning "main_battery_high_warning" "Main battery high warning" Warning [MainBatteryHigh] [0x0400, 0x0400, 0x0004_0000, 0x0004_0000];
    /// The main battery is near its lower limit.
    MainBatteryLowWarning "main_battery_low_warning" "Main battery low warning" Warning [MainBatteryLow] [0x0800, 0x0800, 0x0008_0000, 0x0008_0000];
    /// The board is hot; output is reduced.
    Temperature1Warning "temperature1_warning" "Temperature warning" Warning [Temperature1] [0x1000, 0x1000, 0x0010_0000, 0x0010_0000];
    /// The second sensor is hot; output is reduced.
    Temperature2Warning "temperature2_warning" "Temperature 2 warning" Warning [Temperature2] [0x2000, 0x2000, 0x0020_0000, 0x0020_0000];
    /// A speed error is near its limit (generation 3).
    SpeedLimitWarning "speed_limit_warning" "Speed limit warning" Warning [] [0, 0, 0x0100_0000, 0];
    /// A position error is near its limit (generation 3).
    PositionLimitWarning "position_limit_warning" "Position limit warning" Warning [] [0, 0, 0x0200_0000, 0];
    /// Motor 1's speed error is near its limit (generation 4).
    M1SpeedWarning "m1_speed_warning" "M1 speed warning" Warning [] [0, 0, 0, 0x0100_0000];
    /// Motor 2's speed error is near its limit (generation 4).
    M2SpeedWarning "m2_speed_warning" "M2 speed warning" Warning [] [0, 0, 0, 0x0200_0000];
    /// Motor 1's position error is near its limit (generation 4).
    M1PositionWarning "m1_position_warning" "M1 position warning" Warning [] [0, 0, 0, 0x0400_0000];
    /// Motor 2's position error is near its limit (generation 4).
    M2PositionWarning "m2_position_warning" "M2 position warning" Warning [] [0, 0, 0, 0x0800_0000];
    /// Something is wrong on the CAN bus (generation 4).
    CanWarning "can_warning" "CAN warning" Warning [] [0, 0, 0, 0x1000_0000];
    /// Something was wrong at start-up (generation 4).
    BootWarning "boot_warning" "Boot warning" Warning [] [0, 0, 0, 0x2000_0000];
    /// Motor 1 gives back more current than its limit (generation 4).
    M1OverRegenerationWarning "m1_over_regeneration_warning" "M1 over-regeneration warning" Warning [] [0, 0, 0, 0x4000_0000];
    /// Motor 2 gives back more current than its limit (generation 4).
    M2OverRegenerationWarning "m2_over_regeneration_warning" "M2 over-regeneration warning" Warning [] [0, 0, 0, 0x8000_0000];
    /// Motor 1's home input is active (generations 1 and 2, RoboClaw).
    M1Home "m1_home" "M1 home" Signal [M1Home] [0x4000, 0x4000, 0, 0];
    /// Motor 2's home input is active (generations 1 and 2, RoboClaw).
    M2Home "m2_home" "M2 home" Signal [M2Home] [0x8000, 0x8000, 0, 0];
    /// Pin S4 is active: home, limit or stop (generations 3 and 4).
    S4Signal "s4_signal" "S4 signal" Signal [M1Home] [0, 0, 0x0040_0000, 0x0040_0000];
    /// Pin S5 is active: home, limit or stop (generations 3 and 4).
    S5Signal "s5_signal" "S5 signal" Signal [M2Home] [0, 0, 0x0080_0000, 0x0080_0000];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_in_the_order_of_the_conditions() {
        for (index, row) in CONDITIONS.iter().enumerate() {
            assert_eq!(row.condition as usize, index);
            assert_eq!(row.condition.title(), row.title);
            let mut key = String::new();
            for letter in format!("{:?}", row.condition).chars() {
                if letter.is_uppercase() && !key.is_empty() {
                    key.push('_');
                }
                key.push(letter.to_ascii_lowercase());
            }
            assert_eq!(row.key, key);
        }
    }

    #[test]
    fn no_two_conditions_share_a_bit_and_each_has_one() {
        for generation in Generation::ALL {
            let mut seen = 0;
            for row in &CONDITIONS {
                let mask = row.mask(generation);
                assert!(mask.count_ones() <= 1 && mask & seen == 0, "{}", row.title);
                seen |= mask;
            }
            assert!(generation > Generation::Gen2 || seen <= 0xFFFF);
        }
        assert!(CONDITIONS.iter().all(|row| row.masks.iter().any(|&mask| mask != 0)));
    }

    #[test]
    fn words_of_the_manual_read_as_the_manual_says() {
        let words = [
            (0x0000, ""),
            (0x0001, "M1 over-current warning"),
            (0x0002, "M2 over-current warning"),
            (0x0004, "E-Stop"),
            (0x0008, "Temperature error"),
            (0x0010, "Temperature 2 error"),
            (0x0020, "Main battery high error"),
            (0x0040, "Logic battery high error"),
            (0x0080, "Logic battery low error"),
            (0x0400, "Main battery high warning"),
            (0x0800, "Main battery low warning"),
            (0x1000, "Temperature warning"),
            (0x2000, "Temperature 2 warning"),
        ];
        for (word, title) in words {
            let titles: Vec<&str> = decode(word, Generation::Gen1).iter().map(Condition::title).collect();
            assert_eq!(titles.join(", "), title);
        }
    }

    #[test]
    fn the_same_bit_means_another_thing_in_a_later_generation() {
        let at = |word, generation| decode(word, generation).to_string();
        assert_eq!(at(0x0001, Generation::Gen2), "M1 over-current warning");
        assert_eq!(at(0x0001, Generation::Gen3), "E-Stop");
        assert_eq!(at(0x0008, Generation::Gen4), "Main battery high error");
        assert_eq!(at(0x4000, Generation::Gen1), "M1 home");
        assert_eq!(at(0x4000, Generation::Gen3), "normal");
        assert_eq!(at(0x4000, Generation::Gen4), "Main battery low error");
        assert_eq!(at(0x0100_0000, Generation::Gen3), "Speed limit warning");
        assert_eq!(at(0x0100_0000, Generation::Gen4), "M1 speed warning");
        assert_eq!(unknown_bits(0x4001, Generation::Gen3), 0x4000);
        assert_eq!(unknown_bits(0xFFFF_FFFF, Generation::Gen4), 0);
    }

    #[test]
    fn a_word_survives_decoding_and_encoding_in_every_generation() {
        for generation in Generation::ALL {
            for bit in 0..32 {
                let word = 1 << bit;
                let back = encode(decode(word, generation), generation);
                assert_eq!(back, word & !unknown_bits(word, generation));
            }
            let all: Conditions = CONDITIONS.iter().map(|row| row.condition).collect();
            let known = all.known_to(generation);
            assert_eq!(decode(encode(all, generation), generation), known);
        }
    }

    #[test]
    fn indicators_show_the_gravest_of_their_conditions() {
        let conditions: Conditions =
            [Condition::Temperature1Warning, Condition::Temperature1Error].into_iter().collect();
        assert_eq!(StatusIndicator::Temperature1.lit_by(conditions), Some(Severity::Error));
        assert_eq!(StatusIndicator::Temperature2.lit_by(conditions), None);
        assert_eq!(conditions.severity(), Some(Severity::Error));
        for indicator in StatusIndicator::ALL {
            assert_eq!(indicator.abbreviation().len(), 4);
            assert!(CONDITIONS.iter().any(|row| row.indicator == Some(indicator)), "{}", indicator.title());
        }
    }
}
