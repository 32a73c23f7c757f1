//! Takes a snapshot of a world.

use super::World;
use super::pins::SwitchKind;
use super::view::{AxisView, WorldView};
use brushwork_values::Motor;
use std::time::Duration;

impl World {
    /// A snapshot; `now` is the time it is said to be from. LEDs, script and display are the controller's to add. Looking changes nothing, not even the noise.
    pub fn view(&self, now: Duration) -> WorldView {
        let positions = self.axes.each_ref().map(|axis| axis.state().load_radians);
        let pins = (0..self.pins.signals().len())
            .map(|pin| self.pins.signal(pin, positions, self.estop_pressed))
            .collect();
        WorldView {
            now,
            powered: self.powered,
            plugged: self.plugged,
            estop_pressed: self.estop_pressed,
            unit_faults: self.unit_faults,
            leds: None,
            axes: Motor::BOTH.map(|motor| self.axis_view(motor)),
            encoders_swapped: self.encoders_swapped,
            bus_volts: self.supply.bus_volts(),
            battery_volts: self.supply.params.open_circuit_volts,
            battery_ohms: self.supply.params.internal_ohms,
            battery_amps: self.supply.battery_amps(),
            battery_sinks: self.supply.params.can_sink,
            battery_connected: self.supply.connected,
            logic_volts: self.supply.params.logic_volts,
            regenerated_joules: self.supply.regenerated_joules(),
            has_brake_resistor: self.supply.params.brake_resistor.is_some(),
            clamp_closed: self.supply.clamp_closed(),
            board_celsius: self.board.celsius(),
            pins,
            wiring: self.pins.wiring().clone(),
            i2c: self.i2c.clone(),
            can_peer: self.can_line.peer(),
            can_heard: self.can_line.heard(),
            rts: self.rts,
            detects_battery: self.detects_battery,
            board_switches: self.board_switches,
            script: None,
            display: None,
        }
    }

    fn axis_view(&self, motor: Motor) -> AxisView {
        let axis = &self.axes[motor.index()];
        AxisView {
            truth: axis.state(),
            output: self.outputs[motor.index()],
            encoder_counts: axis.quiet_encoder().counts,
            switches_closed: SwitchKind::ALL.map(|kind| self.switch_closed(motor, kind)),
        }
    }
}
