//! Files that are opened, from the start page, the menu, or dropped on the window: each goes to where it belongs.

use std::path::{Path, PathBuf};

use brushwork_core::known_file::{KnownFile, recognise};
use brushwork_link::Message;
use brushwork_link::settings::{Profile, Strictness};
use egui::Context;

use super::App;
use crate::family::Ability;
use crate::files::take_missing;
use crate::frame::FRAME_INTERVAL;
use crate::graph::files::{MOST_AT_ONCE, OpenAs};
use crate::messages::{NameMessage, OpenFileMessage};
use crate::model::open_files::SettingsFile;
use crate::model::{Screen, Sheet, Tab};
use crate::tune::Loop;
use crate::tune::files::loop_of;

impl App {
    /// Opens what was dropped on the window or chosen in the desktop's dialog.
    pub(super) fn take_files(&mut self, ctx: &Context) {
        let dropped = ctx.input(|input| input.raw.dropped_files.clone());
        let dropped: Vec<PathBuf> = dropped.iter().map(|file| file.path().to_owned()).collect();
        self.open_files(&dropped);
        let chosen = self.model.files.chosen();
        self.open_files(&chosen);
        if self.model.files.is_browsing() {
            ctx.request_repaint_after(FRAME_INTERVAL);
        }
        if take_missing() {
            self.model.messages.warn(OpenFileMessage::NoDialog);
        }
    }

    /// Opens files that were named together. Of several recordings the first is looked at, and the others lie over it.
    pub fn open_files(&mut self, paths: &[PathBuf]) {
        let mut recordings = 0;
        for path in paths.iter().take(MOST_AT_ONCE) {
            let is_recording = matches!(recognise(path), Ok(KnownFile::Recording));
            recordings += usize::from(is_recording);
            if is_recording && recordings > 1 {
                self.model.front.graph.files.lay_beneath(path);
                self.model.files.remember(path);
            } else {
                self.open_file(path);
            }
        }
        if paths.len() > MOST_AT_ONCE {
            self.model.messages.warn(OpenFileMessage::TooMany { count: paths.len(), most: MOST_AT_ONCE });
        }
    }

    /// Opens a file as what it is; what is none of ours is told.
    pub(super) fn open_file(&mut self, path: &Path) {
        let opened = recognise(path).map_err(Message::from).and_then(|kind| match kind {
            KnownFile::Profile => self.open_settings(path),
            KnownFile::Report => self.open_report_at(path),
            KnownFile::Recording => {
                self.open_recording(path);
                Ok(())
            }
            KnownFile::Script => {
                self.show(Screen::MclEditor);
                self.model.mcl.open_path(path.to_owned());
                Ok(())
            }
            KnownFile::Firmware => self.open_firmware(Some(path)),
        });
        match opened {
            Ok(()) => self.model.files.remember(path),
            Err(why) => self.model.messages.fail(why),
        }
    }

    /// A profile stands beside the controller; without one its settings stand alone.
    fn open_settings(&mut self, path: &Path) -> Result<(), Message> {
        if self.model.is_connected() {
            self.show(Screen::GeneralSettings);
            let general = &mut self.model.front.general_view();
            general.open(Sheet::OpenProfile);
            general.profiles.path = path.display().to_string();
            general.open_profile(false);
            return Ok(());
        }
        let read = Profile::open(path, Strictness::Repair).map_err(Message::error)?;
        let backups = self.parts.keeping.store().backups(None);
        let name = || path.file_name().map_or_else(String::new, |name| name.display().to_string());
        let backup = backups.iter().find(|backup| backup.path == path);
        let title = backup.map_or_else(
            || NameMessage::Profile { name: name() }.to_string(),
            |backup| NameMessage::Backup { title: backup.title() }.to_string(),
        );
        self.show(Screen::GeneralSettings);
        self.model.files.settings = Some(SettingsFile::new(title, PathBuf::from(path), read));
        Ok(())
    }

    /// A report is shown where its loop is tuned.
    fn open_report_at(&mut self, path: &Path) -> Result<(), Message> {
        let which: Loop = loop_of(&brushwork_core::tune::file::read(path)?);
        let screen = which.screen();
        if self.model.is_connected() && !self.model.front.screens().contains(&screen) {
            return Err(OpenFileMessage::NoSuchLoop { screen: screen.title() }.into());
        }
        self.open_drawer(screen, Tab::Tune);
        self.open_report(path)
    }

    fn open_recording(&mut self, path: &Path) {
        let drives = |screen: Screen| screen.arm_scope().is_some_and(brushwork_link::ArmScope::allows_motion);
        if !drives(self.model.screen) {
            let screens = self.model.front.screens();
            self.show(screens.into_iter().find(|screen| drives(*screen)).unwrap_or(Screen::Pwm));
        }
        let files = &mut self.model.front.graph.files;
        files.open_as = OpenAs::Recording;
        files.open(path);
    }

    /// Shows the window for firmware updates, with a file if one was named.
    pub(super) fn open_firmware(&mut self, path: Option<&Path>) -> Result<(), Message> {
        if let Some(why) = self.model.front.family().lacks(Ability::Firmware) {
            return Err(OpenFileMessage::NoFirmware { why }.into());
        }
        self.model.front.own.iter_mut().for_each(|own| own.open_firmware(path));
        Ok(())
    }

    /// Shows the backups of every controller, without one.
    pub(super) fn list_backups(&mut self) {
        match self.parts.keeping.store().listed_backups(None) {
            Ok(backups) => {
                self.show(Screen::GeneralSettings);
                // Notes that cannot be read are told where their unit is connected.
                let notes = |unit: String| {
                    let text = self.parts.keeping.store().notes_in(&unit).unwrap_or_default();
                    (unit, text)
                };
                self.model.files.noted = backups.iter().map(|backup| notes(backup.unit())).collect();
                self.model.files.settings = None;
                self.model.files.backups = Some(backups);
            }
            Err(error) => self.model.messages.fail(Message::error(error)),
        }
    }
}
