//! The world around one controller: two axes, the supply, the board's heat, switches, pins and plugs, and what a person may do
//! to them while it runs.
//!
//! The controller asks it for readings and tells it what the bridges do; a panel, a fault script or a test acts on it with
//! [`WorldAction`]s and looks at it through [`WorldView`]s. It knows nothing of bytes and settings.

mod acting;
mod action;
mod board_switches;
mod can_peer;
mod i2c;
mod leds;
mod pins;
mod script;
mod snapshot;
mod unit_fault;
mod view;

pub use action::WorldAction;
pub use board_switches::BoardSwitches;
pub use can_peer::{CanLine, CanPeer};
pub use i2c::I2cDevice;
pub use leds::Leds;
pub use pins::{PinSignal, PinState, SWITCH_OPEN_VOLTS, SwitchKind, SwitchWiring, Wiring};
pub use script::{Content, ScriptRun, ScriptView};
pub use unit_fault::{UnitFault, UnitFaults};
pub use view::{AxisView, WorldView};

use crate::bridge::{BridgeOutput, PwmMode};
use crate::step::substeps;
use crate::{
    Axis, AxisParams, AxisTruth, Board, BoardParams, ClampDrive, EncoderReading, ParamsError, Supply,
    SupplyParams,
};
use brushwork_values::Motor;
use pins::Pins;
use serde::{Deserialize, Serialize};

/// Everything a world is built from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WorldParams {
    /// What motor 1 and motor 2 drive.
    pub axes: [AxisParams; 2],
    /// Main and logic supply.
    #[serde(default)]
    pub supply: SupplyParams,
    /// The board's heat.
    #[serde(default)]
    pub board: BoardParams,
    /// What is wired to the pins.
    #[serde(default)]
    pub wiring: Wiring,
    /// What is on the I2C bus.
    #[serde(default)]
    pub i2c: Vec<I2cDevice>,
    /// Who is at the other end of a script's CAN stream.
    #[serde(default)]
    pub can_peer: CanPeer,
    /// How many input pins the controller has.
    pub pins: usize,
}

/// What a bridge knows in the midst of a control tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BridgeSense {
    /// Current through the bridge, positive from M+ to M-.
    pub amps: f64,
    /// Link voltage.
    pub bus_volts: f64,
    /// Length of the step that follows.
    pub step_s: f64,
}

/// The world around one controller.
#[derive(Clone, Debug)]
pub struct World {
    axes: [Axis; 2],
    supply: Supply,
    board: Board,
    pins: Pins,
    outputs: [BridgeOutput; 2],
    encoders_swapped: bool,
    estop_pressed: bool,
    unit_faults: UnitFaults,
    i2c: Vec<I2cDevice>,
    /// The other end of a script's CAN stream.
    pub can_line: CanLine,
    /// Whether the host holds the USB port's RTS line.
    rts: bool,
    /// What the buttons on the board say of detecting the battery.
    detects_battery: bool,
    /// Those of a board that has them.
    board_switches: Option<BoardSwitches>,
    powered: bool,
    plugged: bool,
}

impl World {
    /// A world at rest, powered and plugged in. Seed 0 makes one without noise.
    ///
    /// # Errors
    /// A figure that is out of its range, by name.
    pub fn new(params: &WorldParams, seed: u64) -> Result<Self, ParamsError> {
        params.supply.validate()?;
        params.board.validate()?;
        let [first, second] = &params.axes;
        let mut can_line = CanLine::default();
        can_line.set_peer(params.can_peer);
        // The axes must not share their noise, and a noisy world has no silent axis.
        let second_seed = if seed == 0 { 0 } else { (seed ^ 0x9E37_79B9_7F4A_7C15).max(1) };
        Ok(Self {
            axes: [Axis::new(first, seed)?, Axis::new(second, second_seed)?],
            supply: Supply::new(params.supply),
            board: Board::new(params.board),
            pins: Pins::new(params.pins, params.wiring.clone()),
            outputs: [BridgeOutput::Coast; 2],
            encoders_swapped: false,
            estop_pressed: false,
            unit_faults: UnitFaults::default(),
            i2c: params.i2c.clone(),
            can_line,
            rts: false,
            detects_battery: false,
            board_switches: None,
            powered: true,
            plugged: true,
        })
    }

    /// Advances by `dt_s` with both bridges held as they are told.
    pub fn advance(&mut self, outputs: [BridgeOutput; 2], dt_s: f64) {
        self.advance_with(dt_s, |motor, _| outputs[motor.index()]);
    }

    /// Advances by `dt_s`, asking for each bridge's output before each step of at most [`crate::MAX_STEP_S`]. Without
    /// power both bridges are open, whatever is answered.
    pub fn advance_with(&mut self, dt_s: f64, mut output: impl FnMut(Motor, BridgeSense) -> BridgeOutput) {
        let (steps, step_s) = substeps(dt_s);
        for _ in 0..steps {
            for motor in Motor::BOTH {
                let amps = self.axes[motor.index()].bridge_amps();
                let sense = BridgeSense { amps, bus_volts: self.supply.bus_volts(), step_s };
                let wanted = output(motor, sense);
                self.outputs[motor.index()] = if self.powered { wanted } else { BridgeOutput::Coast };
            }
            self.step(step_s);
        }
        if steps > 0 {
            let heat = self.axes.each_mut().map(Axis::take_heat);
            self.board.advance(heat.map(|amps_squared_seconds| amps_squared_seconds / dt_s), dt_s);
        }
    }

    /// What the controller's encoder input of this motor reads.
    pub fn encoder(&mut self, motor: Motor) -> EncoderReading {
        let axis = self.encoder_axis(motor);
        self.axes[axis].encoder()
    }

    /// What the controller's current sensor of this motor reads: the mean since the last reading, without the wire's 10 mA
    /// steps; positive from M+ to M-.
    pub fn measured_amps(&mut self, motor: Motor) -> f64 {
        self.axes[motor.index()].measured_amps()
    }

    /// Sets how the bridges make their mean voltages.
    pub fn set_pwm_modes(&mut self, modes: [PwmMode; 2]) {
        for (axis, mode) in self.axes.iter_mut().zip(modes) {
            axis.set_pwm_mode(mode);
        }
    }

    /// Voltage across the main terminals.
    pub fn bus_volts(&self) -> f64 {
        self.supply.bus_volts()
    }

    /// Voltage at the logic terminals; 0 where nothing is connected.
    pub fn logic_volts(&self) -> f64 {
        self.supply.params.logic_volts
    }

    /// Temperature at the two sensors in degrees Celsius.
    pub fn board_celsius(&self) -> [f64; 2] {
        self.board.celsius()
    }

    /// What is on an input pin, counted from 0. A pin that the controller does not have is open.
    pub fn pin(&mut self, pin: usize) -> PinState {
        let positions = self.axes.each_ref().map(|axis| axis.state().load_radians);
        match self.pins.signal(pin, positions, self.estop_pressed) {
            PinSignal::Open => PinState::Open,
            PinSignal::Volts { volts } => PinState::Volts(volts),
            PinSignal::Pulse { microseconds } => PinState::Pulse { microseconds },
            PinSignal::Encoder { motor } => PinState::of_encoder(self.encoder(motor)),
        }
    }

    /// Whether a limit or home switch is closed, by its position or because somebody holds it.
    pub fn switch_closed(&self, motor: Motor, kind: SwitchKind) -> bool {
        self.pins.switch_closed(motor, kind, self.axes[motor.index()].state().load_radians)
    }

    /// Whether the E-stop is pressed.
    pub fn estop_pressed(&self) -> bool {
        self.estop_pressed
    }

    /// What is wrong inside the unit.
    pub fn unit_faults(&self) -> UnitFaults {
        self.unit_faults
    }

    /// The device at an address of the I2C bus.
    pub fn i2c_device(&mut self, address: u8) -> Option<&mut I2cDevice> {
        self.i2c.iter_mut().find(|device| device.address == address)
    }

    /// Whether the host holds the USB port's RTS line, which forces packet serial on it (MCP manual 1.9.3).
    pub fn rts(&self) -> bool {
        self.rts
    }

    /// Whether the buttons on the board ask for the battery to be detected at start-up (MCP manual 1.4.1).
    pub fn detects_battery(&self) -> bool {
        self.detects_battery
    }

    /// How the switches of the board stand, where it has any.
    pub fn board_switches(&self) -> Option<BoardSwitches> {
        self.board_switches
    }

    /// Builds a board that has switches.
    pub fn with_board_switches(self, switches: BoardSwitches) -> Self {
        Self { board_switches: Some(switches), ..self }
    }

    /// Whether the unit has power.
    pub fn powered(&self) -> bool {
        self.powered
    }

    /// Whether the unit's cable to the host is in.
    pub fn plugged(&self) -> bool {
        self.plugged
    }

    /// The digital output that switches a brake resistor, counted from 0, where there is one.
    pub fn brake_resistor_dout(&self) -> Option<usize> {
        self.supply.params.brake_resistor.map(|resistor| resistor.dout)
    }

    /// Tells what the digital output with the brake resistor does.
    pub fn set_clamp(&mut self, drive: ClampDrive) {
        self.supply.clamp = drive;
    }

    /// Whether the brake resistor is across the link now.
    pub fn clamp_closed(&self) -> bool {
        self.supply.clamp_closed()
    }

    /// An axis as it really is.
    pub fn truth(&self, motor: Motor) -> AxisTruth {
        self.axes[motor.index()].state()
    }

    /// What this motor's axis was built from.
    pub fn axis_params(&self, motor: Motor) -> &AxisParams {
        self.axes[motor.index()].params()
    }

    fn encoder_axis(&self, motor: Motor) -> usize {
        if self.encoders_swapped { 1 - motor.index() } else { motor.index() }
    }

    /// One step of both axes and the link. The link voltage is predicted together with both currents, so that neither runs
    /// ahead of the other.
    fn step(&mut self, step_s: f64) {
        let mut at_no_volts = 0.0;
        let mut per_volt = 0.0;
        for (axis, output) in self.axes.iter_mut().zip(self.outputs) {
            let (amps, amps_per_volt) = axis.foretell(output, step_s);
            at_no_volts += amps;
            per_volt += amps_per_volt;
        }
        let bus_volts = self.supply.foretell(at_no_volts, per_volt, step_s);
        let mut coulombs = 0.0;
        for (axis, output) in self.axes.iter_mut().zip(self.outputs) {
            coulombs += axis.step(output, bus_volts, step_s);
        }
        self.supply.step(coulombs / step_s, step_s);
    }
}
