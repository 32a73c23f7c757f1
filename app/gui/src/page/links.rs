//! The links of a page: each is opened at once, to a machine in this program, and turned by the page.

use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::{Arc, Weak};
use std::time::Duration;

use brushwork_core::session::SessionError;
use brushwork_core::session::turned::{Opened, Pause, Turned, TurnedLink};
use brushwork_link::transport::{ConnectTarget, PortInfo};
use brushwork_link::{Addresses, Failure};
use crossbeam_channel::{Receiver, bounded};

use crate::messages::{WindowActMessage, WindowCauseMessage, WindowRemedyMessage};
use crate::parts::{OpenLink, Opener, PortSource};

/// What is turned. Clones are the same.
#[derive(Clone, Default)]
pub struct Links(Rc<State>);

#[derive(Default)]
struct State {
    open: RefCell<Vec<TurnedLink>>,
    /// Machines that the window may still hold.
    machines: RefCell<Vec<Weak<Turned>>>,
    /// What the page has handed out, so that a new link's time goes on where the others' is.
    now: Cell<Duration>,
    /// How far jobs that could not give way have gone beyond that, since it was last asked for.
    ahead: Cell<Duration>,
    pause: Cell<Option<Pause>>,
}

impl Links {
    /// Links whose jobs give way by `pause`.
    #[must_use]
    pub fn with_pause(pause: Option<Pause>) -> Self {
        let links = Self::default();
        links.0.pause.set(pause);
        links
    }

    /// Lets so much time pass for every machine. In the middle of it a pause may draw the window, which may open links.
    pub fn turn(&self, by: Duration) {
        let state = &*self.0;
        state.now.set(state.now.get() + by);
        let turned = std::mem::take(&mut *state.open.borrow_mut());
        let mut left = Vec::with_capacity(turned.len());
        for mut link in turned {
            state.ahead.set(state.ahead.get() + link.turn(by));
            if !link.is_over() {
                left.push(link);
            }
        }
        state.open.borrow_mut().splice(0..0, left);
        let machines: Vec<_> = {
            let mut machines = state.machines.borrow_mut();
            machines.retain(|machine| machine.strong_count() > 0);
            machines.iter().filter_map(Weak::upgrade).collect()
        };
        machines.iter().for_each(|machine| machine.pass(by));
    }

    /// How far jobs have gone beyond the time that was handed out, since the last look.
    #[must_use]
    pub fn take_ahead(&self) -> Duration {
        self.0.ahead.take()
    }

    fn machine(&self, text: &str) -> Result<Arc<Turned>, SessionError> {
        let mut machines = self.0.machines.borrow_mut();
        let running = machines.iter().filter_map(Weak::upgrade).find(|machine| machine.is(text));
        if let Some(running) = running {
            return Ok(running);
        }
        let machine = Arc::new(Turned::start(text, self.0.now.get(), self.0.pause.get())?);
        machines.push(Arc::downgrade(&machine));
        Ok(machine)
    }

    fn open(&self, target: &ConnectTarget, addresses: Addresses) -> Result<OpenLink, SessionError> {
        let text = match target {
            ConnectTarget::Sim(text) => text,
            ConnectTarget::Serial { .. } | ConnectTarget::Tcp { .. } | ConnectTarget::Can { .. } => {
                return Err(SessionError::OnlySimulated { target: target.to_string() });
            }
        };
        let machine = self.machine(text)?;
        let Opened { link, device, bus } = machine.open(addresses)?;
        self.0.open.borrow_mut().push(link);
        Ok(OpenLink { device, bus, world: Some(machine) })
    }
}

/// Opens links of a page.
pub struct PageOpener(pub Links);

impl Opener for PageOpener {
    fn open(
        &mut self,
        target: ConnectTarget,
        addresses: Addresses,
    ) -> Receiver<Result<OpenLink, SessionError>> {
        let (sender, receiver) = bounded(1);
        // The channel has room for one.
        let _ = sender.send(self.0.open(&target, addresses));
        receiver
    }
}

/// A page has no serial ports, which it says once.
#[derive(Default)]
pub struct NoPorts {
    is_told: bool,
}

impl PortSource for NoPorts {
    fn newest(&mut self) -> Option<Result<Vec<PortInfo>, Failure>> {
        let is_told = std::mem::replace(&mut self.is_told, true);
        let (act, cause) = (WindowActMessage::WatchPorts, WindowCauseMessage::PageHasNoPorts);
        (!is_told).then(|| Err(Failure::new(act, "", cause, WindowRemedyMessage::InstallProgram)))
    }
}
