//! Firmware updates and the CAN bus, as far as the window's one place for change has to do with them.

use brushwork_link::device::Request;
use brushwork_link::device::RiskAccepted;
use brushwork_link::transport::ConnectTarget;
use egui::{Context, ViewportCommand};

use super::App;
use crate::frame::FRAME_INTERVAL;
use crate::model::firmware::{FirmwareWish, Next, Stage};
use crate::model::link::Arming;
use crate::model::{DeskId, Phase};
use brushwork_core::keep::UnitId;
use brushwork_core::session::firmware::LoaderPlace;

impl App {
    /// Does what the firmware window asks for.
    pub(super) fn firmware(&mut self, wish: FirmwareWish) {
        match wish {
            FirmwareWish::Open => self.model.front.firmware.open = true,
            FirmwareWish::Browse => self.model.front.firmware.browse(),
            FirmwareWish::Update => {
                if let Err(sentence) = self.begin_update() {
                    self.model.messages.fail(sentence);
                }
            }
            FirmwareWish::Cancel => self.model.front.firmware.cancel(),
            FirmwareWish::Dismiss => self.model.front.firmware.dismiss(),
        }
    }

    /// Takes in what became of updates, in front or not.
    pub(super) fn look_after_firmware(&mut self, id: DeskId, ctx: &Context) {
        let Some(desk) = self.model.desk_mut(id) else { return };
        let mut next = desk.firmware.update();
        if desk.firmware.stage.is_running() {
            ctx.request_repaint_after(FRAME_INTERVAL);
        }
        let quiet = desk.is_connected() && desk.link.arming == Arming::Disarmed;
        if let (Next::Nothing, Some(identity)) = (&next, desk.link.identity().cloned().filter(|_| quiet)) {
            next = desk.firmware.compare(&identity);
        }
        match next {
            Next::Nothing => {}
            Next::Ask(job) => {
                if !self.request_of(id, Request::Job(job))
                    && let Some(desk) = self.model.desk_mut(id)
                {
                    desk.firmware.not_compared();
                }
            }
            Next::EnterLoader => self.enter_loader(id),
        }
    }

    /// Keeps the window open while firmware goes over: ending the program then would leave a controller without any.
    pub(super) fn hold_open(&mut self, ctx: &Context) {
        let asked = self.closing || ctx.input(|input| input.viewport().close_requested());
        let must_go_on = |stage: &Stage| matches!(stage, Stage::Sending { .. }) && !stage.can_be_cancelled();
        if !asked || !self.model.desks().any(|desk| must_go_on(&desk.firmware.stage)) {
            return;
        }
        self.closing = false;
        ctx.send_viewport_cmd(ViewportCommand::CancelClose);
        self.model.messages.fail(
            "The window stays open: a firmware update runs, and ending it now would leave the controller without firmware.",
        );
    }

    fn begin_update(&mut self) -> Result<(), String> {
        let firmware = &self.model.front.firmware;
        if !firmware.accepted || firmware.stage.is_running() {
            return Ok(());
        }
        if firmware.resumed_model.is_some() {
            let target =
                match self.model.front.target.as_ref().filter(|_| self.model.front.phase == Phase::Closed) {
                    Some(target) => target.parse(),
                    None => self.model.devices.target(),
                };
            let target = target.map_err(|error| error.to_string())?;
            let place = self.loader_place(&target);
            let simulated = matches!(target, ConnectTarget::Sim(_));
            return self.model.front.firmware.resume(place, simulated);
        }
        self.disarm();
        let ports = self.model.devices.ports().to_vec();
        let store = self.parts.keeping.store().clone();
        let front = &mut self.model.front;
        let identity = front.link.identity().cloned().ok_or("Connect the controller first.")?;
        let unit = UnitId::new(&identity, &ports);
        let job = front.firmware.begin(&identity, front.link.stream, unit, store)?;
        if !self.request(Request::Job(job)) {
            self.model.front.firmware.not_entered("the controller is busy.");
        }
        Ok(())
    }

    /// The backup is made. Where the loader will be is asked while the controller is still there.
    fn enter_loader(&mut self, id: DeskId) {
        let target = self.model.desk(id).and_then(|desk| desk.phase.target()?.parse().ok());
        let Some(target) = target else {
            if let Some(desk) = self.model.desk_mut(id) {
                desk.firmware.not_entered("the link was lost.");
            }
            return;
        };
        let place = self.loader_place(&target);
        if let Some(desk) = self.model.desk_mut(id) {
            desk.firmware.entering(place);
        }
        if !self.request_of(id, Request::EnterLoader(RiskAccepted::by_the_user()))
            && let Some(desk) = self.model.desk_mut(id)
        {
            desk.firmware.not_entered("the controller is busy.");
        }
    }

    fn loader_place(&mut self, target: &ConnectTarget) -> LoaderPlace {
        self.parts.opener.loader_place(target, self.model.devices.ports())
    }
}
