//! Does to a world what an action says.

use super::World;
use super::action::WorldAction;

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
            WorldAction::SetBatteryDetection { on } => self.detects_battery = on,
            WorldAction::SetRts { on } => self.rts = on,
            WorldAction::Power { on } => self.powered = on,
            WorldAction::Unplug { unplugged } => self.plugged = !unplugged,
            // These need to know the time, or the controller.
            WorldAction::SendCan { .. } | WorldAction::SetHidden { .. } => {}
        }
    }
}

/// A figure as given, unless it is none or beyond all machines.
fn sane(figure: f64) -> f64 {
    const BEYOND_ALL_MACHINES: f64 = 1e9;
    if figure.is_finite() { figure.clamp(-BEYOND_ALL_MACHINES, BEYOND_ALL_MACHINES) } else { 0.0 }
}
