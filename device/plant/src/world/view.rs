//! A snapshot of a world, for a panel and for tests that compare what the controller says with what is so.

use super::board_switches::BoardSwitches;
use super::can_peer::CanPeer;
use super::i2c::I2cDevice;
use super::leds::Leds;
use super::pins::{PinSignal, Wiring};
use super::script::ScriptView;
use super::unit_fault::UnitFaults;
use crate::AxisTruth;
use crate::bridge::BridgeOutput;
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
    /// Whether the battery is to be detected at start-up.
    pub detects_battery: bool,
    /// How the switches of the board stand; none where it has none.
    #[serde(default)]
    pub board_switches: Option<BoardSwitches>,
    /// What the unit's script does; none without power.
    pub script: Option<ScriptView>,
    /// The characters that a board with a display shows; none without one, or without power.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub display: Option<String>,
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
