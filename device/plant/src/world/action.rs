//! What a person, a panel, a fault script or a test can do to a world.

use super::board_switches::BoardSwitches;
use super::can_peer::CanPeer;
use super::i2c::I2cDevice;
use super::pins::{PinSignal, SwitchKind};
use super::unit_fault::UnitFault;
use super::view::WorldView;
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
    /// The buttons on the board, which choose whether the battery is detected from the next start on (MCP manual 1.4.1).
    SetBatteryDetection {
        /// Detected.
        on: bool,
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
            Self::SetBatteryDetection { .. } => Self::SetBatteryDetection { on: before.detects_battery },
            Self::SetRts { .. } => Self::SetRts { on: before.rts },
            Self::Power { .. } => Self::Power { on: before.powered },
            Self::Unplug { .. } => Self::Unplug { unplugged: !before.plugged },
            Self::SetHidden { .. } => return None,
        })
    }
}
