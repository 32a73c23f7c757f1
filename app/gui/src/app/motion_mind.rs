//! What the screens of a Motion Mind ask for: reads of all registers, and writes by its assistants.

use brushwork_link::device::{DeviceHandle, Request};

use super::App;
use crate::command::MindWish;
use crate::model::general::Sheet;
use crate::model::screen::Screen;

impl App {
    /// Has read what the open screen of the device in front needs besides the signals.
    pub(super) fn read_for_screen(&mut self) {
        let Some(now) = self.device().map(DeviceHandle::now) else { return };
        let (screen, front) = (self.model.screen, &mut self.model.front);
        let is_free = front.is_connected() && !front.is_guided() && front.settings.running().is_none();
        let wants_read = is_free && front.family().shows_registers(screen);
        let Some(request) = wants_read.then(|| front.motion_mind.live.read(now)).flatten() else { return };
        // A link that is busy is asked again later; nobody has to be told.
        if self.device().is_none_or(|device| device.request(request).is_err()) {
            self.model.front.motion_mind.live.not_begun();
        }
    }

    /// Sends bytes of the terminal. Between the moves of a tuning run they would be in the way.
    pub(super) fn send_raw(&mut self, id: u64, bytes: Vec<u8>) {
        let is_free = !self.model.front.is_guided();
        if !(is_free && self.request(Request::Raw { id, bytes })) {
            self.model.front.motion_mind.terminal.not_sent(id);
        }
    }

    pub(super) fn mind(&mut self, wish: MindWish) {
        let told = match wish {
            MindWish::Turn(image) => {
                let held = self.model.front.step_registers();
                let told = self.write_ram(image);
                if let (Ok(()), Some(held)) = (&told, held) {
                    self.model.front.motion_mind.steps.remember(held);
                }
                told
            }
            MindWish::PutBack(image) => {
                let told = self.write_ram(image);
                if told.is_ok() {
                    self.model.front.motion_mind.steps.is_back();
                }
                told
            }
            MindWish::Radio(max, min) => {
                let ends = self.model.front.as_settings(&[("RCMAX", max), ("RCMIN", min)]);
                self.write_ram(ends)
            }
            MindWish::UseRadio => {
                self.use_radio();
                Ok(())
            }
        };
        if let Err(why) = told {
            self.model.messages.fail(why);
        }
    }

    /// What the R/C calibration found becomes edits of the registers; the sheet shows what will be written.
    fn use_radio(&mut self) {
        let front = &mut self.model.front;
        let for_position = front.has_bit("FUNCTION", "RCPOS-ENCFDBCK");
        let Some([max, min, band]) = front.motion_mind.radio.result(for_position) else { return };
        let image = front.as_settings(&[("RCMAX", max), ("RCMIN", min), ("RCBAND", band)]);
        if let Some(unit) = front.settings.unit_mut() {
            for (key, value) in image.iter() {
                unit.set(key, value);
            }
        }
        self.show(Screen::GeneralSettings);
        self.model.front.general_view().open_once_read(Sheet::Write);
    }
}
