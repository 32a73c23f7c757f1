//! A snapshot of a world, for a panel and for tests that compare what the controller says with what is so.

use super::UnitFaults;
use super::World;
use super::board_switches::BoardSwitches;
use super::can_peer::CanPeer;
use super::i2c::I2cDevice;
use super::leds::Leds;
use super::pins::{PinSignal, SwitchKind, Wiring};
use super::script::ScriptView;
use crate::AxisTruth;
use crate::bridge::BridgeOutput;
use brushwork_values::Motor;
use serde::Serialize;
use std::time::Duration;

/// A world at one moment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WorldView {
    /// The machine's time.
    pub now: Duration,
    /// Whether the unit has power.
    pub powered: bool,
    /// Whether the cable to the host is in.
    pub plugged: bool,
    /// Whether the E-stop is pressed.
    pub estop_pressed: bool,
    /// What is wrong inside the unit.
    pub unit_faults: UnitFaults,
    /// The unit's LEDs; none without power.
    pub leds: Option<Leds>,
    /// Both axes.
    pub axes: [AxisView; 2],
    /// Whether the encoder plugs are changed round.
    pub encoders_swapped: bool,
    /// Voltage across the main terminals.
    pub bus_volts: f64,
    /// Main voltage without load.
    pub battery_volts: f64,
    /// Resistance of battery and leads.
    pub battery_ohms: f64,
    /// Current out of the battery; negative while it is charged.
    pub battery_amps: f64,
    /// Whether the battery takes current back.
    pub battery_sinks: bool,
    /// Whether the main battery is connected.
    pub battery_connected: bool,
    /// Logic voltage; 0 where none is connected.
    pub logic_volts: f64,
    /// Energy the motors have given back to the link so far.
    pub regenerated_joules: f64,
    /// Whether there is a brake resistor.
    pub has_brake_resistor: bool,
    /// Whether the brake resistor is across the link.
    pub clamp_closed: bool,
    /// Temperature at the two sensors.
    pub board_celsius: [f64; 2],
    /// What is on each input pin, switches included.
    pub pins: Vec<PinSignal>,
    /// Which switches and buttons are wired to which pins.
    pub wiring: Wiring,
    /// What is on the I2C bus.
    pub i2c: Vec<I2cDevice>,
    /// Who is at the other end of a script's CAN stream.
    pub can_peer: CanPeer,
    /// What that one heard last.
    pub can_heard: Vec<u8>,
    /// Whether the host holds the USB port's RTS line.
    pub rts: bool,
    /// How the switches of the board stand; none where it has none.
    #[serde(default)]
    pub board_switches: Option<BoardSwitches>,
    /// What the unit's script does; none without power.
    pub script: Option<ScriptView>,
}

/// One axis at one moment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AxisView {
    /// Motion, current and faults.
    pub truth: AxisTruth,
    /// What the bridge does.
    pub output: BridgeOutput,
    /// What the axis' own encoder would read without noise, wherever it is plugged in.
    pub encoder_counts: i64,
    /// Which switches are closed: forward, backward, home.
    pub switches_closed: [bool; 3],
}

impl World {
    /// A snapshot; `now` is the time it is said to be from. LEDs and script are the controller's to add. Looking changes nothing, not even the noise.
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
            board_switches: self.board_switches,
            script: None,
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
