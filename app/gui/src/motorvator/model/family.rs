//! MotorVator V3: half a board, two motors by duty or one stepper (MotorVator manual).

use brushwork_link::FamilyRef;
use brushwork_link::device::{Addresses, ArmScope, Channel, Drive, DriveCommand, Identity};
use brushwork_motorvator_client::channels::CHANNELS;
use brushwork_motorvator_client::{Half, MOTORVATOR, MotorvatorFacts};
use brushwork_motorvator_wire::host::LIBRARY;
use brushwork_script::language::Language;
use brushwork_script::mecc::compile;
use brushwork_script::program::Program;
use brushwork_values::Motor;

use super::MotorvatorConnection;
use crate::family::recipe::Recipes;
use crate::family::{Ability, Family, Figure, Figures, Known, Own, SettingsWords, Sliders};
use crate::model::{IndicatorInfo, Screen, Simulated};
use crate::motorvator::messages::BoardMessage;
use crate::motorvator::recipes::MotorvatorRecipes;

#[derive(Debug)]
pub struct Motorvator;

impl Family for Motorvator {
    fn family(&self) -> FamilyRef {
        MOTORVATOR
    }

    fn name(&self) -> &'static str {
        "MotorVator V3"
    }

    fn own(&self) -> Option<Box<dyn Own>> {
        Some(Box::<MotorvatorConnection>::default())
    }

    fn simulated_axis(&self) -> &'static str {
        "Four motors on a battery; the board reads no encoder"
    }

    fn screens(&self, _identity: Option<&Identity>, _known: Known<'_>) -> Vec<Screen> {
        vec![
            Screen::DeviceStatus,
            Screen::GeneralSettings,
            Screen::Pwm,
            Screen::Position,
            Screen::Inputs,
            Screen::MclEditor,
            Screen::Terminal,
        ]
    }

    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn title(&self, screen: Screen) -> &'static str {
        match screen {
            Screen::GeneralSettings => "Stepper Settings",
            Screen::Pwm => "Motors",
            Screen::Position => "Stepper",
            Screen::MclEditor => "Program",
            Screen::Terminal => "Terminal",
            other => other.title(),
        }
    }

    fn library(&self) -> Option<Program> {
        compile(LIBRARY).program
    }

    fn recipes(&self) -> Option<&'static dyn Recipes> {
        Some(&MotorvatorRecipes)
    }

    fn figures(&self) -> &'static [Figures] {
        &FIGURES
    }

    fn indicators(&self) -> &'static [IndicatorInfo] {
        &INDICATORS
    }

    fn words(&self) -> &'static SettingsWords {
        &WORDS
    }

    fn unit_row(&self, identity: &Identity) -> Option<(&'static str, String)> {
        // Whether it answers now its indicator tells.
        let version = MotorvatorFacts::of(identity)?.library?;
        Some(("Host library", BoardMessage::Version { version: version.to_string() }.to_string()))
    }

    fn simulated(&self) -> Vec<(&'static str, &'static str)> {
        vec![("motorvator-3", "MotorVator V3")]
    }

    fn simulated_program(&self) -> Option<Language> {
        Some(Language::Mecc)
    }

    /// Both halves of the board.
    fn simulated_addresses(&self, _simulated: &Simulated) -> Option<Addresses> {
        Some(Addresses::Scan)
    }

    fn address_label(&self, address: u8) -> String {
        Half::of(address).map_or_else(
            || address.to_string(),
            |half| BoardMessage::Motors { letters: half.letters() }.to_string(),
        )
    }

    fn to_send(&self, scope: ArmScope, sliders: Sliders) -> Option<Drive> {
        // The board takes whole percents, and changes at once.
        let command = |_, percent: f64| Some(DriveCommand::duty(percent / 100.0));
        (scope == ArmScope::Pwm).then(|| sliders.pwm.setpoints.to_send(command)).flatten()
    }

    fn channels(&self) -> &'static [Channel] {
        CHANNELS
    }

    fn world_pins(&self) -> &'static [&'static str] {
        &[
            "On/off 1", "On/off 2", "On/off 3", "On/off 4", "Analog 1", "Analog 2", "Analog 3", "Analog 4",
            "Analog 5", "Analog 6",
        ]
    }

    fn first_channels(&self, _screen: Screen) -> &'static [Channel] {
        &[Channel::M1_PWM, Channel::M2_PWM]
    }

    fn lacks(&self, ability: Ability) -> Option<&'static str> {
        Some(match ability {
            Ability::Scripts => "A MotorVator takes no program over its serial line.",
            Ability::Qpps => "A MotorVator measures no speed.",
            Ability::ClampTest => "A MotorVator has no voltage clamp.",
            Ability::Generator => "Profiles are played on MCP controllers.",
            Ability::EmergencyStop => "A MotorVator has no emergency stop that software resets.",
            Ability::SecondMotor => return None,
            Ability::Firmware => "The firmware of a MotorVator cannot be loaded over its serial line.",
            Ability::BridgeFaults => "The simulated MotorVator has no faults of its bridges.",
            Ability::Buses => "A MotorVator has no buses.",
            Ability::Conflicts => "No two settings of a MotorVator contradict each other.",
            Ability::Streams => "A MotorVator has one serial port; the host library keeps its time-out.",
            Ability::LogicBattery => "A MotorVator does not tell its supply.",
            Ability::AbsoluteEncoders => "A MotorVator has no encoders.",
            Ability::ByHand => "A MotorVator has no loops whose gains could be calibrated.",
            Ability::OwnTest => "A MotorVator has no relay test.",
            Ability::Duty => return None,
        })
    }
}

/// How acts on the settings are told.
static WORDS: SettingsWords = SettingsWords {
    title: "Stepper Settings",
    many: "values",
    save: "Keep…",
    save_now: "Keep",
    save_text: "Nothing on the board is kept over a restart but its program: put the ConfigStepper line into it.",
    save_warning: None,
    defaults: "Default…",
    defaults_now: "Write them",
    defaults_text: "Writes the values that the host library begins with.",
    defaults_warning: None,
    reload_text: "Nothing on the board is kept over a restart but its program.",
};

const fn indicator(short: &'static str, title: &'static str) -> IndicatorInfo {
    IndicatorInfo { short, title }
}

/// In the order and with the letters of the client's table, by which they are lit.
const INDICATORS: [IndicatorInfo; 8] = [
    indicator("HOST", "Host library silent"),
    indicator("DEAD", "Dead-man stopped"),
    indicator("STEP1", "Stepper 1 moves"),
    indicator("STEP2", "Stepper 2 moves"),
    indicator("IN1", "Input 1 changed"),
    indicator("IN2", "Input 2 changed"),
    indicator("IN3", "Input 3 changed"),
    indicator("IN4", "Input 4 changed"),
];

const FIGURES: [Figures; 1] = [Figures::new(
    &[
        Figure { channel: Channel::M1_PWM, label: "Motor 1", unit: "%", motor: Motor::M1 },
        Figure { channel: Channel::M2_PWM, label: "Motor 2", unit: "%", motor: Motor::M2 },
    ],
    62.0,
    (1, 6),
    false,
)];

#[cfg(test)]
mod tests {
    use brushwork_motorvator_client::indicators;

    use super::*;

    #[test]
    fn the_indicators_are_those_of_the_client_in_its_order() {
        let known: Vec<_> = indicators::INDICATORS.iter().map(|indicator| indicator.short).collect();
        assert_eq!(INDICATORS.map(|indicator| indicator.short).as_slice(), known);
    }
}
