//! What the assistants of a Motion Mind ask for: writes of registers, and edits.

use brushwork_link::Message;
use brushwork_link::settings::SettingsImage;

use crate::family_action::{FamilyAction, Host};
use crate::model::{Connection, Screen, Sheet};

/// What the assistants ask for.
#[derive(Debug)]
pub enum MindAction {
    /// Writes these registers and bits to RAM, with a backup, and remembers what was there.
    Turn(SettingsImage),
    /// Writes these back.
    PutBack(SettingsImage),
    /// RCMAX and RCMIN to RAM, for measuring.
    Radio(i64, i64),
    /// Takes over what the R/C calibration found as edits, and shows what will be written.
    UseRadio,
}

impl FamilyAction for MindAction {
    fn act(&self, host: &mut dyn Host) -> Result<(), Message> {
        match self {
            Self::Turn(image) => {
                let held = front(host).step_registers();
                host.write_ram(image.clone())?;
                if let Some(held) = held {
                    front(host).mind_mut().steps.remember(held);
                }
            }
            Self::PutBack(image) => {
                host.write_ram(image.clone())?;
                front(host).mind_mut().steps.is_back();
            }
            Self::Radio(max, min) => {
                let ends = front(host).as_settings(&[("RCMAX", *max), ("RCMIN", *min)]);
                host.write_ram(ends)?;
            }
            Self::UseRadio => use_radio(host),
        }
        Ok(())
    }
}

fn front(host: &mut dyn Host) -> &mut Connection {
    &mut host.model().front
}

/// What the R/C calibration found becomes edits of the registers; the sheet shows what will be written.
fn use_radio(host: &mut dyn Host) {
    let front = front(host);
    let for_position = front.has_bit("FUNCTION", "RCPOS-ENCFDBCK");
    let Some([max, min, band]) = front.mind().radio.result(for_position) else { return };
    let image = front.as_settings(&[("RCMAX", max), ("RCMIN", min), ("RCBAND", band)]);
    if let Some(unit) = front.settings.unit_mut() {
        for (key, value) in image.iter() {
            unit.set(key, value);
        }
    }
    host.show(Screen::GeneralSettings);
    host.model().front.general_view().open_once_read(Sheet::Write);
}
