//! What scripts talk to: the port's RTS line, the I2C bus, the other end of the CAN stream.

use brushwork_plant::world::{CanPeer, I2cDevice, WorldAction, WorldView};
use egui::{ComboBox, Ui};

use super::{Actions, LABEL_WIDTH, figures_ui, toggle_ui};
use crate::widgets::{choice_ui, fixed_label_ui, heading_ui};
use crate::world::messages::WorldMessage;

/// Registers of a device that are shown.
const SHOWN: usize = 8;

pub fn buses_ui(ui: &mut Ui, view: &WorldView, actions: &mut Actions) {
    ui.separator();
    heading_ui(ui, "Ports of scripts");
    let rts = toggle_ui(ui, "Hold RTS of the USB port", view.rts);
    if rts {
        actions.push(WorldAction::SetRts { on: !view.rts });
    }
    let sensor = I2cDevice::mpu6050();
    let is_there = view.i2c.iter().any(|device| device.address == sensor.address);
    if toggle_ui(ui, "Motion sensor MPU-6050 on I2C", is_there) {
        actions.push(if is_there {
            WorldAction::RemoveI2cDevice { address: sensor.address }
        } else {
            WorldAction::AddI2cDevice { device: sensor }
        });
    }
    for device in &view.i2c {
        device_ui(ui, device, actions);
    }
    peer_ui(ui, view, actions);
}

/// A device with the registers of acceleration, which a person would change by turning the sensor.
fn device_ui(ui: &mut Ui, device: &I2cDevice, actions: &mut Actions) {
    const FIRST: u8 = 0x3B;
    let shown = device.registers.iter().skip(FIRST.into()).take(SHOWN);
    let registers: String = shown.map(|value| format!(" {value:02X}")).collect();
    figures_ui(
        ui,
        &WorldMessage::Device { address: device.address, name: device.name.clone(), first: FIRST, registers }
            .to_string(),
    );
    ui.horizontal(|ui| {
        // 16384 is 1 g, as a 16 bit number with its high byte first.
        for (axis, name) in ["Lay x up", "Lay y up", "Lay z up"].into_iter().enumerate() {
            if ui.small_button(name).clicked() {
                let mut values = vec![0; 6];
                values[2 * axis] = 0x40;
                actions.push(WorldAction::SetI2cRegisters { address: device.address, first: FIRST, values });
            }
        }
    });
}

fn peer_ui(ui: &mut Ui, view: &WorldView, actions: &mut Actions) {
    ui.horizontal(|ui| {
        fixed_label_ui(ui, "CAN peer", LABEL_WIDTH);
        let (list, mut peer) = (ComboBox::from_id_salt("can peer"), view.can_peer);
        let peers = [CanPeer::Absent, CanPeer::Listening, CanPeer::Echoing];
        choice_ui(ui, list, "CAN peer", &mut peer, peers, title);
        if peer != view.can_peer {
            actions.push(WorldAction::SetCanPeer { peer });
        }
        if ui.add_enabled(view.can_peer != CanPeer::Absent, egui::Button::new("Send \"hello\"")).clicked() {
            actions.push(WorldAction::SendCan { bytes: b"hello".to_vec() });
        }
    });
    if view.can_peer != CanPeer::Absent {
        let heard: String =
            view.can_heard.iter().rev().take(SHOWN).rev().map(|byte| format!(" {byte:02X}")).collect();
        figures_ui(ui, &WorldMessage::Heard { heard }.to_string());
    }
}

fn title(peer: CanPeer) -> &'static str {
    match peer {
        CanPeer::Absent => "no node",
        CanPeer::Listening => "listens",
        CanPeer::Echoing => "sends back what it hears",
    }
}
