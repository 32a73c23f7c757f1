//! What a person, a panel, a fault script or a test can do to a world.

use super::UnitFault;
use super::board_switches::BoardSwitches;
use super::can_peer::CanPeer;
use super::i2c::I2cDevice;
use super::pins::{PinSignal, SwitchKind};
use super::{World, WorldView};
use brushwork_values::Motor;
use serde::{Deserialize, Serialize};

/// One thing done to the world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "action", rename_all = "snake_case", deny_unknown_fields)]
pub enum WorldAction {
    /// Torque that pulls an output shaft towards lower positions.
    SetLoadTorque {
        /// Whose shaft.
        motor: Motor,
        /// Torque; negative pulls upwards.
        newton_metres: f64,
    },
    /// Main voltage without load.
    SetBatteryVolts {
        /// Voltage, 0 or more.
        volts: f64,
    },
    /// Resistance of battery and leads; a high one makes the voltage sag under load.
    SetBatteryOhms {
        /// Resistance, 0 or more.
        ohms: f64,
    },
    /// Whether the main supply takes regenerated current: a battery does, most power supplies do not.
    SetBatterySinks {
        /// Takes it.
        can_sink: bool,
    },
    /// The main battery's contactor. The logic stays alive where a logic battery is connected.
    ConnectBattery {
        /// Closed.
        connected: bool,
    },
    /// Logic voltage; 0 means none connected.
    SetLogicVolts {
        /// Voltage, 0 or more.
        volts: f64,
    },
    /// What is connected to an input pin.
    SetPin {
        /// The pin, counted from 0.
        pin: usize,
        /// What is on it.
        signal: PinSignal,
    },
    /// Holds a limit or home switch closed, or lets it follow the axis again.
    HoldSwitch {
        /// Whose switch.
        motor: Motor,
        /// Which switch.
        switch: SwitchKind,
        /// Held closed.
        closed: bool,
    },
    /// Wires a limit or home switch to a pin, closing to ground, or takes it away.
    WireSwitch {
        /// Whose switch.
        motor: Motor,
        /// Which switch.
        switch: SwitchKind,
        /// The pin, counted from 0; none takes the switch away.
        pin: Option<usize>,
        /// Where the output shaft closes it, as in [`super::SwitchWiring`].
        trips_at_radians: Option<f64>,
    },
    /// The E-stop button.
    EStop {
        /// Pressed.
        pressed: bool,
    },
    /// A fault of the unit's own electronics.
    SetUnitFault {
        /// Which.
        fault: UnitFault,
        /// There.
        on: bool,
    },
    /// Encoder leads A and B changed round.
    ReverseEncoder {
        /// Whose encoder.
        motor: Motor,
        /// Changed round.
        on: bool,
    },
    /// Encoder plug out.
    LoseEncoder {
        /// Whose encoder.
        motor: Motor,
        /// Out.
        on: bool,
    },
    /// Noise on an encoder.
    SetEncoderNoise {
        /// Whose encoder.
        motor: Motor,
        /// Standard deviation of each reading; 0 for none.
        counts: f64,
    },
    /// The two encoder plugs changed round.
    SwapEncoders {
        /// Changed round.
        on: bool,
    },
    /// The motor shaft held fast.
    LockShaft {
        /// Whose shaft.
        motor: Motor,
        /// Held.
        on: bool,
    },
    /// A motor lead off.
    OpenLead {
        /// Whose lead.
        motor: Motor,
        /// Off.
        on: bool,
    },
    /// Motor leads changed round.
    ReverseLeads {
        /// Whose leads.
        motor: Motor,
        /// Changed round.
        on: bool,
    },
    /// Holds the board at a temperature.
    SetBoardCelsius {
        /// The temperature; `None` lets the board follow its losses again.
        celsius: Option<f64>,
    },
    /// Puts a device on the I2C bus, in place of the one at its address.
    AddI2cDevice {
        /// The device.
        device: I2cDevice,
    },
    /// Takes a device off the I2C bus.
    RemoveI2cDevice {
        /// Its address of seven bits.
        address: u8,
    },
    /// Sets registers of a device on the I2C bus.
    SetI2cRegisters {
        /// Its address of seven bits.
        address: u8,
        /// The first register.
        first: u8,
        /// The values of this and the following ones.
        values: Vec<u8>,
    },
    /// Sets the switches of the board, where it has any. They are read at power-up.
    SetBoardSwitches {
        /// How they stand then.
        switches: BoardSwitches,
    },
    /// Who is at the other end of a script's CAN stream.
    SetCanPeer {
        /// What it does.
        peer: CanPeer,
    },
    /// The other end of the CAN stream sends bytes.
    SendCan {
        /// The bytes.
        bytes: Vec<u8>,
    },
    /// The host's RTS line of the USB port, which forces packet serial on a port that belongs to scripts.
    SetRts {
        /// Held.
        on: bool,
    },
    /// Power of the whole unit, main and logic.
    Power {
        /// On.
        on: bool,
    },
    /// The cable between unit and host.
    Unplug {
        /// Out.
        unplugged: bool,
    },
    /// A setting of the controller that has no public wire form. The world passes it by; the controller takes it.
    SetHidden {
        /// The setting's key, as in the settings table.
        key: String,
        /// Its raw value.
        value: i64,
    },
}

impl World {
    /// Does one thing to the world. Figures that make no sense (negative resistance, not a number) are taken as 0.
    pub fn apply(&mut self, action: &WorldAction) {
        match *action {
            WorldAction::SetLoadTorque { motor, newton_metres } => {
                self.axes[motor.index()].set_load_torque(sane(newton_metres));
            }
            WorldAction::SetBatteryVolts { volts } => {
                self.supply.params.open_circuit_volts = sane(volts).max(0.0);
            }
            WorldAction::SetBatteryOhms { ohms } => self.supply.params.internal_ohms = sane(ohms).max(0.0),
            WorldAction::SetBatterySinks { can_sink } => self.supply.params.can_sink = can_sink,
            WorldAction::ConnectBattery { connected } => self.supply.connected = connected,
            WorldAction::SetLogicVolts { volts } => {
                self.supply.params.logic_volts = sane(volts).max(0.0);
            }
            WorldAction::SetPin { pin, signal } => self.pins.set(pin, signal),
            WorldAction::HoldSwitch { motor, switch, closed } => self.pins.hold(motor, switch, closed),
            WorldAction::WireSwitch { motor, switch, pin, trips_at_radians } => {
                self.pins.wire(motor, switch, pin, trips_at_radians.map(sane));
            }
            WorldAction::EStop { pressed } => self.estop_pressed = pressed,
            WorldAction::SetUnitFault { fault, on } => self.unit_faults.set(fault, on),
            WorldAction::ReverseEncoder { motor, on } => self.axes[motor.index()].reverse_encoder(on),
            WorldAction::LoseEncoder { motor, on } => self.axes[motor.index()].lose_encoder(on),
            WorldAction::SetEncoderNoise { motor, counts } => {
                self.axes[motor.index()].set_encoder_noise(sane(counts).max(0.0));
            }
            WorldAction::SwapEncoders { on } => self.encoders_swapped = on,
            WorldAction::LockShaft { motor, on } => self.axes[motor.index()].lock_shaft(on),
            WorldAction::OpenLead { motor, on } => self.axes[motor.index()].open_lead(on),
            WorldAction::ReverseLeads { motor, on } => self.axes[motor.index()].reverse_leads(on),
            WorldAction::SetBoardCelsius { celsius } => self.board.force_celsius(celsius.map(sane)),
            WorldAction::AddI2cDevice { ref device } => {
                self.i2c.retain(|known| known.address != device.address);
                self.i2c.push(device.clone());
            }
            WorldAction::RemoveI2cDevice { address } => self.i2c.retain(|known| known.address != address),
            WorldAction::SetI2cRegisters { address, first, ref values } => {
                if let Some(device) = self.i2c_device(address) {
                    device.set(first, values);
                }
            }
            WorldAction::SetBoardSwitches { switches } => {
                self.board_switches = self.board_switches.map(|_| switches);
            }
            WorldAction::SetCanPeer { peer } => self.can_line.set_peer(peer),
            WorldAction::SetRts { on } => self.rts = on,
            WorldAction::Power { on } => self.powered = on,
            WorldAction::Unplug { unplugged } => self.plugged = !unplugged,
            // These need to know the time, or the controller.
            WorldAction::SendCan { .. } | WorldAction::SetHidden { .. } => {}
        }
    }
}

impl WorldAction {
    /// The action that takes this one back in a world that looked like `before`; none where there is nothing to take back.
    pub fn undo(&self, before: &WorldView) -> Option<Self> {
        let truth = |motor: Motor| before.axes[motor.index()].truth;
        Some(match *self {
            Self::SetLoadTorque { motor, .. } => {
                Self::SetLoadTorque { motor, newton_metres: truth(motor).load_newton_metres }
            }
            Self::SetBatteryVolts { .. } => Self::SetBatteryVolts { volts: before.battery_volts },
            Self::SetBatteryOhms { .. } => Self::SetBatteryOhms { ohms: before.battery_ohms },
            Self::SetBatterySinks { .. } => Self::SetBatterySinks { can_sink: before.battery_sinks },
            Self::ConnectBattery { .. } => Self::ConnectBattery { connected: before.battery_connected },
            Self::SetLogicVolts { .. } => Self::SetLogicVolts { volts: before.logic_volts },
            Self::SetPin { pin, .. } => Self::SetPin { pin, signal: PinSignal::Open },
            Self::HoldSwitch { motor, switch, .. } => Self::HoldSwitch { motor, switch, closed: false },
            Self::WireSwitch { motor, switch, .. } => {
                let wired = before.wiring.switch(motor, switch);
                Self::WireSwitch {
                    motor,
                    switch,
                    pin: wired.map(|wired| wired.pin),
                    trips_at_radians: wired.and_then(|wired| wired.trips_at_radians),
                }
            }
            Self::EStop { .. } => Self::EStop { pressed: before.estop_pressed },
            Self::SetUnitFault { fault, .. } => {
                Self::SetUnitFault { fault, on: before.unit_faults.has(fault) }
            }
            Self::ReverseEncoder { motor, .. } => {
                Self::ReverseEncoder { motor, on: truth(motor).encoder_reversed }
            }
            Self::LoseEncoder { motor, .. } => Self::LoseEncoder { motor, on: truth(motor).encoder_lost },
            Self::SetEncoderNoise { motor, .. } => {
                Self::SetEncoderNoise { motor, counts: truth(motor).encoder_noise_counts }
            }
            Self::SwapEncoders { .. } => Self::SwapEncoders { on: before.encoders_swapped },
            Self::LockShaft { motor, .. } => Self::LockShaft { motor, on: truth(motor).shaft_locked },
            Self::OpenLead { motor, .. } => Self::OpenLead { motor, on: truth(motor).lead_open },
            Self::ReverseLeads { motor, .. } => Self::ReverseLeads { motor, on: truth(motor).leads_reversed },
            Self::SetBoardCelsius { .. } => Self::SetBoardCelsius { celsius: None },
            Self::AddI2cDevice { ref device } => {
                match before.i2c.iter().find(|known| known.address == device.address) {
                    Some(known) => Self::AddI2cDevice { device: known.clone() },
                    None => Self::RemoveI2cDevice { address: device.address },
                }
            }
            Self::RemoveI2cDevice { address } | Self::SetI2cRegisters { address, .. } => {
                let known = before.i2c.iter().find(|known| known.address == address)?;
                Self::AddI2cDevice { device: known.clone() }
            }
            Self::SetBoardSwitches { .. } => Self::SetBoardSwitches { switches: before.board_switches? },
            Self::SetCanPeer { .. } => Self::SetCanPeer { peer: before.can_peer },
            Self::SendCan { .. } => return None,
            Self::SetRts { .. } => Self::SetRts { on: before.rts },
            Self::Power { .. } => Self::Power { on: before.powered },
            Self::Unplug { .. } => Self::Unplug { unplugged: !before.plugged },
            Self::SetHidden { .. } => return None,
        })
    }
}

/// A figure as given, unless it is none or beyond all machines.
fn sane(figure: f64) -> f64 {
    const BEYOND_ALL_MACHINES: f64 = 1e9;
    if figure.is_finite() { figure.clamp(-BEYOND_ALL_MACHINES, BEYOND_ALL_MACHINES) } else { 0.0 }
}
