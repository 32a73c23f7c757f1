//! Firmware updates of an MCP: what the firmware window asks for, and how an update goes on.

use brushwork_core::keep::UnitId;
use brushwork_link::Message;
use brushwork_link::device::{Request, RiskAccepted};
use brushwork_link::transport::ConnectTarget;
use brushwork_link::work::HAS_THREADS;
use egui::Context;

use super::model::firmware::{FirmwareAction, Next};
use crate::family_action::{FamilyAction, Host};
use crate::frame::FRAME_INTERVAL;
use crate::messages::FirmwareMessage;
use crate::model::{Arming, ConnectionId, Phase};

impl FamilyAction for FirmwareAction {
    fn act(&self, host: &mut dyn Host) -> Result<(), Message> {
        let firmware = &mut host.model().front.mcp_mut().firmware;
        match *self {
            Self::Browse => firmware.browse(),
            Self::Update => return begin_update(host),
            Self::Cancel => firmware.cancel(),
            Self::Dismiss => firmware.dismiss(),
        }
        Ok(())
    }
}

/// Takes in what became of an update, in front or not.
pub fn look_after_firmware(host: &mut dyn Host, id: ConnectionId, ctx: &Context) {
    let store = host.store();
    let Some(connection) = host.model().connection_mut(id) else { return };
    let is_closed = connection.phase == Phase::Closed;
    let mut next = connection.mcp_mut().firmware.update(&store, is_closed);
    if connection.mcp().firmware.stage.is_running() || connection.mcp().firmware.is_awaited() {
        ctx.request_repaint_after(FRAME_INTERVAL);
    }
    let quiet = connection.is_connected() && connection.link.arming == Arming::Disarmed;
    if let (Next::Nothing, Some(identity)) = (&next, connection.link.identity().cloned().filter(|_| quiet)) {
        next = connection.mcp_mut().firmware.compare(&identity, &store);
    }
    match next {
        Next::Nothing => {}
        Next::Ask(job) => {
            if !host.request_of(id, Request::Job(job))
                && let Some(connection) = host.model().connection_mut(id)
            {
                connection.mcp_mut().firmware.not_compared();
            }
        }
        Next::EnterLoader => enter_loader(host, id),
        Next::Reconnect(target) => host.connect_to(&target),
    }
}

fn begin_update(host: &mut dyn Host) -> Result<(), Message> {
    let model = host.model();
    let firmware = &model.front.mcp().firmware;
    if !firmware.accepted || firmware.stage.is_running() {
        return Ok(());
    }
    // What sends it has a thread of its own. Without one the controller would be left in its loader.
    if !HAS_THREADS {
        return Err(FirmwareMessage::NotFromPage.into());
    }
    if firmware.resumed_model.is_some() {
        let target = match model.front.target.as_ref().filter(|_| model.front.phase == Phase::Closed) {
            Some(target) => target.parse(),
            None => model.devices.target(),
        };
        let target = target.map_err(Message::error)?;
        let place = host.loader_place(&target);
        let simulated = matches!(target, ConnectTarget::Sim(_));
        let store = host.store();
        return host.model().front.mcp_mut().firmware.resume(&target.to_string(), place, simulated, &store);
    }
    host.disarm();
    let store = host.store();
    let model = host.model();
    let front = &mut model.front;
    let identity = front.link.identity().cloned().ok_or(FirmwareMessage::ConnectFirst)?;
    let unit = UnitId::new(&identity, &model.devices.ports);
    let (id, stream) = (front.id(), front.link.stream);
    let place = front.target.clone().unwrap_or_default();
    let job = front.mcp_mut().firmware.begin(&identity, stream, unit, place, store)?;
    if !host.request_of(id, Request::Job(job)) {
        host.model().front.mcp_mut().firmware.not_entered(FirmwareMessage::Busy);
    }
    Ok(())
}

/// The backup is made. Where the loader will be is asked while the controller is still there.
fn enter_loader(host: &mut dyn Host, id: ConnectionId) {
    let target = host.model().connection(id).and_then(|connection| connection.phase.target()?.parse().ok());
    let place = target.map(|target| host.loader_place(&target));
    let is_known = place.is_some();
    if let Some(connection) = host.model().connection_mut(id) {
        let firmware = &mut connection.mcp_mut().firmware;
        match place {
            Some(place) => firmware.entering(place),
            None => firmware.not_entered(FirmwareMessage::LinkLost),
        }
    }
    if is_known
        && !host.request_of(id, Request::EnterLoader(RiskAccepted::by_the_user()))
        && let Some(connection) = host.model().connection_mut(id)
    {
        connection.mcp_mut().firmware.not_entered(FirmwareMessage::Busy);
    }
}
