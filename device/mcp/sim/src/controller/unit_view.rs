//! What the firmware of a unit knows, for panels and for tests that compare it with what a client reads.

use super::firmware::Firmware;
use super::readings::Readings;
use crate::motion::Channel;
use crate::signals::SignalValues;
use brushwork_mcp_wire::packet_serial::status::Conditions;
use brushwork_plant::world::Leds;
use brushwork_plant::world::ScriptView;
use brushwork_script::debug::Debugger;
use brushwork_script::vm::Machine;
use brushwork_values::Motor;
use std::time::Duration;

/// What the firmware of a unit has found and decided: the truth that a client's readings are compared with.
#[derive(Clone, Copy, Debug)]
pub struct UnitView<'a> {
    firmware: &'a Firmware,
    debugger: &'a Debugger,
}

impl<'a> UnitView<'a> {
    pub(super) fn new(firmware: &'a Firmware, debugger: &'a Debugger) -> Self {
        Self { firmware, debugger }
    }

    /// The text of command 21, without its end mark.
    pub fn version_text(&self) -> String {
        self.firmware.options.version_text(self.firmware.model)
    }

    /// The control side of a motor: encoder register, speeds, duty, buffer, errors.
    pub fn channel(&self, motor: Motor) -> &Channel {
        &self.firmware.channels[motor.index()]
    }

    /// The measurements of the last tick.
    pub fn readings(&self) -> &Readings {
        &self.firmware.readings
    }

    /// Conditions, whether or not the generation can report them.
    pub fn conditions(&self) -> Conditions {
        self.firmware.conditions()
    }

    /// The status word of command 90.
    pub fn status_word(&self) -> u32 {
        self.firmware.status_word()
    }

    /// The LEDs.
    pub fn leds(&self) -> Leds {
        self.firmware.leds
    }

    /// Which digital outputs are on.
    pub fn outputs(&self) -> &[bool] {
        &self.firmware.outputs
    }

    /// The priority level in force, 1 to 3, if any.
    pub fn priority_level(&self) -> Option<usize> {
        self.firmware.source.map(|(level, _)| level + 1)
    }

    /// Whether a stored script runs.
    pub fn script_is_running(&self) -> bool {
        self.firmware.script.is_running()
    }

    /// The script that runs or ran last.
    pub fn script(&self) -> Option<&'a Machine> {
        self.firmware.script.machine()
    }

    /// Bytes of a stream, as scripts number them, that wait for GETS.
    pub fn script_waiting(&self, stream: usize) -> usize {
        self.firmware.script.streams.count(stream)
    }

    /// What the script does.
    pub fn script_view(&self) -> ScriptView {
        self.firmware.script.view(&self.firmware.memory.script, self.debugger)
    }

    /// Whether the unit waits for new firmware.
    pub fn is_in_loader(&self) -> bool {
        self.firmware.loader.is_some()
    }

    /// Time since power up.
    pub fn up_for(&self) -> Duration {
        self.firmware.up_for()
    }

    /// How long no byte has come on any port; none if there never was one.
    pub fn silence(&self) -> Option<Duration> {
        let last = self.firmware.ports.last_bytes.iter().flatten().max();
        last.map(|last| self.firmware.now.saturating_sub(*last))
    }

    /// When it was last powered up, in the machine's time.
    pub fn booted_at(&self) -> Duration {
        self.firmware.booted_at
    }

    /// Main battery, logic battery (0.1 V), temperatures 1 and 2 (0.1 degrees) as the wire carries them.
    pub fn supply_raw(&self) -> [i64; 4] {
        [
            self.firmware.main_battery_raw(),
            self.firmware.logic_battery_raw(),
            self.firmware.temperature_raw(0),
            self.firmware.temperature_raw(1),
        ]
    }

    /// The five values of command 147 of each pin.
    pub fn signal_values(&self) -> Vec<SignalValues> {
        let signals = self.firmware.signals.iter().zip(&self.firmware.settings.signals);
        signals.map(|(signal, settings)| signal.values(settings)).collect()
    }

    /// Whether the emergency stop holds the motors.
    pub fn estop_is_tripped(&self) -> bool {
        self.firmware.estop.is_tripped()
    }

    /// Duties of commands 102 and 104 in generation 4.
    pub fn auxiliary_duties(&self) -> [u16; 5] {
        self.firmware.auxiliary_duties
    }

    /// The error register of the CAN port (command 180).
    pub fn can_error_state(&self) -> u32 {
        self.firmware.can.error_state()
    }

    /// Motor current in 10 mA as the wire carries it.
    pub fn current_raw(&self, motor: Motor) -> i64 {
        self.firmware.current_raw(motor)
    }
}
