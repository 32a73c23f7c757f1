//! What switches a digital output (MCP manual 1.9.9, command 137).

use crate::settings::OutputSettings;
use brushwork_plant::world::Leds;

/// What the output actions look at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OutputInputs {
    /// The motor's bridge drives.
    pub motor_on: [bool; 2],
    /// The motor's bridge drives backward.
    pub motor_reversed: [bool; 2],
    /// The main battery is above its maximum.
    pub over_voltage: bool,
    /// The board is above its warning temperature.
    pub over_temperature: bool,
    /// The LEDs.
    pub leds: Leds,
}

/// Whether the pin sinks current.
pub fn output_is_on(settings: &OutputSettings, inputs: &OutputInputs) -> bool {
    is_triggered(settings.action, inputs) != settings.inverted
}

fn is_triggered(action: u8, inputs: &OutputInputs) -> bool {
    let [on_1, on_2] = inputs.motor_on;
    let [reversed_1, reversed_2] = inputs.motor_reversed;
    match action {
        1 => on_1,
        2 => on_2,
        3 => on_1 || on_2,
        4 => reversed_1,
        5 => reversed_2,
        6 => reversed_1 || reversed_2,
        7 => inputs.over_voltage,
        8 => inputs.over_temperature,
        9 => inputs.leds.stat1,
        10 => inputs.leds.stat2,
        11 => inputs.leds.err,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use brushwork_mcp_wire::codes::DOUT_ACTIONS;

    fn plain(action: u8) -> OutputSettings {
        OutputSettings { action, inverted: false }
    }

    #[test]
    fn every_action_of_the_list_follows_its_own_inputs() {
        let m1 = OutputInputs {
            motor_on: [true, false],
            motor_reversed: [true, false],
            ..OutputInputs::default()
        };
        let m2 = OutputInputs {
            motor_on: [false, true],
            motor_reversed: [false, true],
            ..OutputInputs::default()
        };
        let hot = OutputInputs { over_temperature: true, ..OutputInputs::default() };
        let high = OutputInputs { over_voltage: true, ..OutputInputs::default() };
        let lit =
            |stat1, stat2, err| OutputInputs { leds: Leds { stat1, stat2, err }, ..OutputInputs::default() };
        let cases =
            [m1, m2, high, hot, lit(true, false, false), lit(false, true, false), lit(false, false, true)];
        let expected: [[bool; 7]; 12] = [
            [false; 7],                                       // none
            [true, false, false, false, false, false, false], // motor 1 on
            [false, true, false, false, false, false, false], // motor 2 on
            [true, true, false, false, false, false, false],  // motors on
            [true, false, false, false, false, false, false], // motor 1 reverse
            [false, true, false, false, false, false, false], // motor 2 reverse
            [true, true, false, false, false, false, false],  // motors reverse
            [false, false, true, false, false, false, false], // over voltage
            [false, false, false, true, false, false, false], // over temperature
            [false, false, false, false, true, false, false], // status 1 LED
            [false, false, false, false, false, true, false], // status 2 LED
            [false, false, false, false, false, false, true], // error LED
        ];
        for (code, row) in DOUT_ACTIONS.iter().zip(expected) {
            let got = cases.map(|inputs| output_is_on(&plain(code.raw as u8), &inputs));
            assert_eq!(got, row, "{}", code.label);
        }
    }

    #[test]
    fn an_inverted_output_is_on_until_its_action_comes() {
        let inverted = OutputSettings { action: 7, inverted: true };
        assert!(output_is_on(&inverted, &OutputInputs::default()));
        assert!(!output_is_on(&inverted, &OutputInputs { over_voltage: true, ..OutputInputs::default() }));
        assert!(output_is_on(&OutputSettings { action: 0, inverted: true }, &OutputInputs::default()));
    }
}
