//! Settling on the General Settings screen what was cut short.

use brushwork_core::settings::remedy;
use brushwork_link::settings::Act;

use super::view::GeneralView;
use crate::model::{Settle, Sheet};

impl GeneralView<'_> {
    /// Settles what was cut short. The newest alone is finished or undone; those before were overtaken by it.
    pub fn settle(&mut self, how: Settle) {
        if how == Settle::Leave {
            self.settings.close_unfinished();
            self.settings.put_damaged_aside();
            return self.close_sheet();
        }
        let Some(newest) = self.settings.newest_unfinished() else { return };
        let Some(unit) = self.settings.unit_mut() else { return };
        let Some(ram) = unit.ram() else { return };
        let remedy = remedy(&newest, unit.table(), ram, how == Settle::Undo, unit.is_simulated);
        for (key, value) in remedy.iter() {
            unit.take(key, value);
        }
        match (unit.edits().is_empty(), newest.act) {
            (false, _) => self.open(Sheet::Write),
            (true, Act::Save) => self.open(Sheet::Save),
            (true, _) => {
                self.settings.close_unfinished();
                self.close_sheet();
            }
        }
    }
}
