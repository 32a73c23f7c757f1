//! The links of a page: to machines in this program, each opened at once, or one to a real controller behind a port of the browser. The page
//! turns them.

use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::{Arc, Weak};
use std::time::Duration;

use brushwork_core::session::SessionError;
use brushwork_core::session::browser::{BrowserLink, BrowserPort, Connected, PortState};
use brushwork_core::session::turned::{Opened, Pause, Turned, TurnedLink};
use brushwork_link::Addresses;
use brushwork_link::device::Stopper;
use brushwork_link::transport::{ConnectTarget, OpenError};
use crossbeam_channel::{Receiver, Sender, bounded};

use super::Ports;
use crate::parts::{OpenLink, Opener};

/// What is turned. Clones are the same.
#[derive(Clone, Default)]
pub struct Links(Rc<State>);

#[derive(Default)]
struct State {
    open: RefCell<Vec<Link>>,
    /// A port that the browser is opening.
    opening: RefCell<Option<Opening>>,
    /// What stops the real controller's link, while there is one.
    stopper: RefCell<Option<Stopper>>,
    /// Whether motors were stopped since the page was hidden, until it was told.
    was_hidden: Cell<bool>,
    /// Machines that the window may still hold.
    machines: RefCell<Vec<Weak<Turned>>>,
    /// What the page has handed out, so that a new link's time goes on where the others' is.
    now: Cell<Duration>,
    /// How far jobs that could not give way have gone beyond that, since it was last asked for.
    ahead: Cell<Duration>,
    pause: Cell<Option<Pause>>,
}

enum Link {
    Simulated(TurnedLink),
    Real(BrowserLink),
}

impl Link {
    fn is_over(&self) -> bool {
        match self {
            Self::Simulated(link) => link.is_over(),
            Self::Real(link) => link.is_over(),
        }
    }

    fn has_ended(&self) -> bool {
        match self {
            Self::Simulated(link) => link.has_ended(),
            Self::Real(link) => link.has_ended(),
        }
    }
}

type Answer = Result<OpenLink, SessionError>;

struct Opening {
    port: Arc<dyn BrowserPort>,
    maker: Option<u16>,
    target: ConnectTarget,
    addresses: Addresses,
    answer: Sender<Answer>,
}

impl Links {
    /// Links whose jobs give way by `pause`.
    #[must_use]
    pub fn with_pause(pause: Option<Pause>) -> Self {
        let links = Self::default();
        links.0.pause.set(pause);
        links
    }

    /// Lets so much time pass for every machine, and has a real controller's link do what is due. In the middle of it a pause may draw the
    /// window, which may open links.
    pub fn turn(&self, by: Duration) {
        let state = &*self.0;
        state.now.set(state.now.get() + by);
        self.look_at_opening();
        let turned = std::mem::take(&mut *state.open.borrow_mut());
        let mut left = Vec::with_capacity(turned.len());
        for mut link in turned {
            match &mut link {
                Link::Simulated(link) => state.ahead.set(state.ahead.get() + link.turn(by)),
                Link::Real(link) => {
                    link.turn(by);
                    state.now.set(state.now.get().max(link.now()));
                }
            }
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

    /// The page is hidden while something is armed: from now on its browser lets it work once a second or less, so that it stops and disarms.
    pub fn hidden(&self) {
        if let Some(stopper) = &*self.0.stopper.borrow() {
            stopper.stop_all();
            self.0.was_hidden.set(true);
        }
    }

    /// Whether motors were stopped since the page was hidden, once.
    #[must_use]
    pub fn take_hidden(&self) -> bool {
        self.0.was_hidden.take()
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

    fn open_simulated(&self, text: &str, addresses: Addresses) -> Answer {
        let machine = self.machine(text)?;
        let Opened { link, device, bus } = machine.open(addresses)?;
        self.0.open.borrow_mut().push(Link::Simulated(link));
        Ok(OpenLink { device, bus, world: Some(machine) })
    }

    /// Whether a link would keep another waiting that is opened now; `to_real` where that one is to a real controller.
    fn is_in_the_way(&self, to_real: bool) -> bool {
        let open = self.0.open.borrow();
        let hinders = |link: &Link| !link.has_ended() && (to_real || matches!(link, Link::Real(_)));
        self.0.opening.borrow().is_some() || open.iter().any(hinders)
    }

    /// Goes on with a port that the browser was opening.
    fn look_at_opening(&self) {
        let Some(opening) = self.0.opening.take() else { return };
        let answer = match opening.port.state() {
            PortState::Opening => {
                self.0.opening.replace(Some(opening));
                return;
            }
            PortState::Gone(said) => Err(not_opened(&opening.target, said)),
            PortState::Open => self.opened(&opening),
        };
        // Whoever gave up waiting has dropped the receiver; the link is closed again by being dropped.
        let _ = opening.answer.send(answer);
    }

    fn opened(&self, opening: &Opening) -> Answer {
        let port = opening.port.clone();
        let Connected { link, device, bus } =
            BrowserLink::open(port, &opening.target, opening.addresses, opening.maker)?;
        self.0.stopper.replace(Some(link.stopper()));
        self.0.open.borrow_mut().push(Link::Real(link));
        Ok(OpenLink { device, bus, world: None })
    }
}

fn not_opened(target: &ConnectTarget, said: String) -> SessionError {
    let (path, baud) = place_of(target).unwrap_or_default();
    OpenError::Browser { path: path.to_owned(), baud, said }.into()
}

/// The name and rate of the port that a target means.
fn place_of(target: &ConnectTarget) -> Option<(&str, u32)> {
    match target {
        ConnectTarget::Serial { path, baud, .. } => Some((path, *baud)),
        ConnectTarget::Can { adapter, .. } => place_of(adapter),
        ConnectTarget::Tcp { .. } | ConnectTarget::Sim(_) => None,
    }
}

/// Opens links of a page.
pub struct PageOpener {
    pub links: Links,
    pub ports: Ports,
}

impl PageOpener {
    fn begin(
        &self,
        target: &ConnectTarget,
        addresses: Addresses,
        answer: &Sender<Answer>,
    ) -> Result<(), SessionError> {
        let (links, text) = (&self.links, target.to_string());
        let is_real = !matches!(target, ConnectTarget::Sim(_));
        if links.is_in_the_way(is_real) {
            return Err(SessionError::OneAtATime { target: text });
        }
        if let ConnectTarget::Sim(text) = target {
            // The channel has room for one.
            let _ = answer.send(links.open_simulated(text, addresses));
            return Ok(());
        }
        let port = place_of(target).and_then(|(name, baud)| self.ports.open(name, baud));
        let (port, maker) = port.ok_or(SessionError::NotFromPage { target: text })?;
        let opening = Opening { port, maker, target: target.clone(), addresses, answer: answer.clone() };
        links.0.opening.replace(Some(opening));
        Ok(())
    }
}

impl Opener for PageOpener {
    fn open(&mut self, target: ConnectTarget, addresses: Addresses) -> Receiver<Answer> {
        let (answer, receiver) = bounded(1);
        if let Err(error) = self.begin(&target, addresses, &answer) {
            // The channel has room for one.
            let _ = answer.send(Err(error));
        }
        receiver
    }
}
