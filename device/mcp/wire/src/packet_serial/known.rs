//! What is known about firmware: which habits a generation or a version has. One table for the window, the command line and
//! everybody else who tells the user what is installed.

use super::Generation;
use crate::models::Family;
use serde::Serialize;

/// One habit of some firmware.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Quirk {
    /// What it is about, in a word or two.
    pub topic: &'static str,
    /// The habit, as a sentence.
    pub text: &'static str,
    /// Where it is known from.
    pub source: &'static str,
    #[serde(skip)]
    families: &'static [Family],
    #[serde(skip)]
    generations: (Generation, Generation),
    #[serde(skip)]
    since: &'static [u32],
}

impl Quirk {
    /// Whether a unit has it. `family` is `None` for a unit that is not known; `version` is as the unit reports it,
    /// without "v".
    #[must_use]
    pub fn concerns(&self, family: Option<Family>, generation: Generation, version: &str) -> bool {
        let (first, last) = self.generations;
        family.is_none_or(|family| self.families.contains(&family))
            && (first..=last).contains(&generation)
            && (self.since.is_empty() || parts(version).is_some_and(|parts| *parts >= *self.since))
    }
}

/// What is known about the firmware of a unit.
pub fn quirks(
    family: Option<Family>,
    generation: Generation,
    version: &str,
) -> impl Iterator<Item = &'static Quirk> {
    QUIRKS.iter().filter(move |quirk| quirk.concerns(family, generation, version))
}

/// What a generation is, as a sentence.
#[must_use]
pub const fn generation_text(generation: Generation) -> &'static str {
    match generation {
        Gen1 => "The packets are those of the manual of 2014-2015.",
        Gen2 => "The packets are those of Ion Studio's libraries of 2016-2017, of which least is known.",
        Gen3 => "The packets are those of Motion Studio's libraries of 2018-2020.",
        Gen4 => "The packets are those of the vendor's libraries of 2025.",
    }
}

use Generation::{Gen1, Gen2, Gen3, Gen4};

const MANUAL: &str = "MCP manual";
const CLIENTS: &str = "public clients, 2015-2025";
const BOTH: &[Family] = &[Family::Mcp, Family::RoboClaw];
const ROBOCLAW: &[Family] = &[Family::RoboClaw];
const MCP: &[Family] = &[Family::Mcp];

/// The rows of the table of habits: of which families, about what, in which generations, from which source, and the
/// version it came with unless every version has it.
macro_rules! quirks {
    ($($families:ident $topic:literal ($first:ident $last:ident) $source:expr $(, since [$($since:literal)*])?; $text:literal;)*) => {
        &[$(Quirk {
            topic: $topic,
            text: $text,
            source: $source,
            families: $families,
            generations: ($first, $last),
            since: &[$($($since),*)?],
        }),*]
    };
}

/// All of them, in the order in which they are told.
pub const QUIRKS: &[Quirk] = quirks! {
    BOTH "status" (Gen1 Gen2) MANUAL;
        "The status word has 16 bits and cannot report speed, position or current errors.";
    BOTH "status" (Gen3 Gen4) CLIENTS;
        "The status word has 32 bits, whose meanings are not those of the manual.";
    BOTH "saving" (Gen1 Gen1) "MCP manual against public clients, 2015-2025";
        "The manual saves settings without a key, the library of that time with one; a save that does nothing is found out by \
         reading back.";
    BOTH "saving" (Gen2 Gen4) CLIENTS;
        "Settings are saved only with a key; software that leaves it out saves nothing and is told nothing.";
    BOTH "acceleration" (Gen1 Gen1) MANUAL; "The default acceleration also serves for braking.";
    BOTH "acceleration" (Gen2 Gen4) CLIENTS; "Default acceleration and deceleration are set apart.";
    BOTH "pins" (Gen1 Gen1) MANUAL; "Pin settings have no low-pass filter, and each action one byte.";
    BOTH "loop errors" (Gen3 Gen4) CLIENTS;
        "Speed and position errors have limits of their own (commands 109 to 114).";
    BOTH "PWM mode" (Gen3 Gen4) CLIENTS; "Each motor has a PWM mode of its own.";
    BOTH "restart" (Gen4 Gen4) CLIENTS; "It tells its running time, so that a restart is noticed at once.";
    BOTH "voltage limits" (Gen4 Gen4) CLIENTS; "Battery limits carry an automatic offset, counted in 0.1 V.";
    ROBOCLAW "compatibility" (Gen1 Gen4) CLIENTS, since [4 3 6];
        "From version 4.3.6 on commands 0 to 13 drive the motors and are not acknowledged.";
    ROBOCLAW "velocity loop" (Gen1 Gen4) CLIENTS, since [4 1 27];
        "From version 4.1.27 on the integral is held back by back-calculation instead of leaking away.";
    MCP "position gains" (Gen1 Gen4) "MCP manual 3.3 against public clients, 2015-2025";
        "Whether position gains are counted in 1/1024 or 1/2048 is not settled; this program uses 1/1024.";
    BOTH "images" (Gen1 Gen4) CLIENTS;
        "No firmware image is published, nor what a controller checks of one before it runs it.";
};

/// "4.3.6" as its numbers; none if it is something else.
fn parts(version: &str) -> Option<Vec<u32>> {
    version.split('.').map(|part| part.parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn topics(family: Family, generation: Generation, version: &str) -> Vec<&'static str> {
        quirks(Some(family), generation, version).map(|quirk| quirk.topic).collect()
    }

    #[test]
    fn a_version_that_is_known_for_a_habit_has_it_and_an_older_one_has_not() {
        assert!(topics(Family::RoboClaw, Gen4, "4.3.6").contains(&"compatibility"));
        assert!(topics(Family::RoboClaw, Gen4, "4.10.0").contains(&"compatibility"));
        assert!(!topics(Family::RoboClaw, Gen4, "4.2.8").contains(&"compatibility"));
        assert!(!topics(Family::RoboClaw, Gen4, "").contains(&"compatibility"));
        assert!(!topics(Family::Mcp, Gen4, "4.3.6").contains(&"compatibility"));
    }

    #[test]
    fn every_generation_has_one_row_about_status_and_one_about_saving() {
        for generation in Generation::ALL {
            let topics = topics(Family::Mcp, generation, "1.0.0");
            for topic in ["status", "saving", "acceleration"] {
                assert_eq!(topics.iter().filter(|other| **other == topic).count(), 1, "{generation} {topic}");
            }
        }
    }

    #[test]
    fn an_unknown_unit_is_told_what_concerns_either_family() {
        assert!(quirks(None, Gen1, "1.0").any(|quirk| quirk.topic == "position gains"));
    }

    #[test]
    fn every_habit_is_a_sentence() {
        for quirk in QUIRKS {
            assert!(
                quirk.text.ends_with('.') && quirk.text.starts_with(char::is_uppercase),
                "{}",
                quirk.text
            );
        }
    }
}
