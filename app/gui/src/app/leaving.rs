//! What must wait until a tuning run or an examination has put back what it changed: closing the window, closing the link, turning to another unit.
//!
//! The motors do not wait: they are stopped at once. Asked for a second time it happens at once too.

use super::App;
use crate::messages::WindowStatusMessage;
use crate::model::Afterwards;
use crate::model::{ConnectionId, Gravity};
use brushwork_core::messages::EndedMessage;
use brushwork_link::device::Request;
use egui::{Context, ViewportCommand};

/// Whether the window waits for a run before it closes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Leaving {
    #[default]
    No,
    /// The motors were stopped; the old gains are being put back.
    WhenPutBack,
    /// It waits no longer.
    AtOnce,
}

impl App {
    /// Keeps the window open while a run has something to put back, and closes it then.
    pub(super) fn hold_for_run(&mut self, ctx: &Context) {
        let is_asked = self.closing || ctx.input(|input| input.viewport().close_requested());
        let by_signal = self.end.is_asked();
        match self.leaving {
            Leaving::AtOnce => {}
            _ if !self.has_to_put_back() => {
                self.closing |= self.leaving == Leaving::WhenPutBack;
            }
            Leaving::No if is_asked || by_signal => {
                self.leaving = Leaving::WhenPutBack;
                self.closing = false;
                ctx.send_viewport_cmd(ViewportCommand::CancelClose);
                self.links.stop_all();
                for connection in self.model.connections_mut() {
                    connection.tune.abort(EndedMessage::WindowCloses);
                    connection.examination.cancel(Gravity::Warning, EndedMessage::WindowCloses);
                    connection.tune.want_winding_back();
                    connection.rest();
                }
                self.model.messages.warn(WindowStatusMessage::ClosesWhenPutBack);
            }
            Leaving::WhenPutBack if is_asked => self.leaving = Leaving::AtOnce,
            Leaving::No | Leaving::WhenPutBack => {}
        }
        if self.leaving == Leaving::AtOnce {
            self.closing = true;
        }
        if self.leaving == Leaving::WhenPutBack {
            ctx.request_repaint_after(crate::frame::FRAME_INTERVAL);
        }
    }

    /// Whether closing waits.
    pub(super) fn is_held(&self) -> bool {
        self.leaving == Leaving::WhenPutBack && self.has_to_put_back()
    }

    fn has_to_put_back(&self) -> bool {
        let is_leaving = self.leaving == Leaving::WhenPutBack;
        self.model.connections().any(|connection| {
            let owes_winding =
                connection.tune.cleared_winding().is_some() || is_leaving && connection.settings.is_busy();
            connection.may_owe() || connection.is_connected() && owes_winding
        })
    }

    /// Whether an act that would cut a run off from its controller is put off until the run has put back what it changed. The run is
    /// ended.
    pub(super) fn waits_for_run(&mut self, id: ConnectionId, afterwards: Afterwards) -> bool {
        let Some(connection) = self.model.connection_mut(id).filter(|connection| connection.may_owe()) else {
            return false;
        };
        let again = connection.afterwards.replace(afterwards) == Some(afterwards);
        // Another unit in mid-act would be given the gains of this one.
        if again && afterwards == Afterwards::Disconnect {
            connection.afterwards = None;
            return false;
        }
        connection.tune.cancel(afterwards.why());
        connection.examination.cancel(Gravity::Warning, afterwards.why());
        connection.rest();
        self.request_of(id, Request::Disarm);
        self.model.messages.note(WindowStatusMessage::FollowsWhenPutBack { what: afterwards.what() });
        true
    }

    /// Does what was put off, once nothing runs any more.
    pub(super) fn follow_run(&mut self, id: ConnectionId) {
        let Some(connection) = self.model.connection_mut(id).filter(|connection| !connection.may_owe())
        else {
            return;
        };
        match connection.afterwards.take() {
            Some(Afterwards::Disconnect) => self.disconnect(id),
            Some(Afterwards::Select(address)) => {
                self.request_of(id, Request::Select(address));
            }
            None => {}
        }
    }

    /// Writes L and R back when the run that they were cleared for has ended.
    pub(super) fn put_winding_back(&mut self, id: ConnectionId) {
        let Some(connection) = self.model.connection_mut(id) else { return };
        if connection.settings.is_busy() || !connection.is_connected() {
            return;
        }
        let (tune, unit) = (&mut connection.tune, connection.settings.unit());
        match tune.is_winding_back(|key| unit?.on_controller(key)) {
            Some(true) => {
                return self.model.messages.note(WindowStatusMessage::WindingPutBack);
            }
            Some(false) => {
                return self.model.messages.fail(WindowStatusMessage::WindingNotPutBack);
            }
            None => {}
        }
        let Some(image) = connection.tune.winding_due().cloned() else { return };
        // A write that is not taken is tried again in the next frame.
        if self.write_ram_of(id, image).is_ok()
            && let Some(connection) = self.model.connection_mut(id)
        {
            connection.tune.winding_is_written();
        }
    }
}
