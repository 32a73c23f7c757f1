//! Programs, as far as the window's one place for change has to do with them.

use super::App;
use crate::gui::mcl::MclWish;

impl App {
    /// Does what is wished of the MCL editor.
    pub(super) fn edit_mcl(&mut self, wish: MclWish) {
        let ctx = self.ctx.clone();
        self.model.mcl.act(wish, &ctx);
    }
}
