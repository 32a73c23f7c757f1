//! The real sources of links and ports: each waits on a thread of its own, never on the window's.

use crate::messages::{WindowActMessage, WindowCauseMessage, WindowRemedyMessage};
use brushwork_link::Message;
use brushwork_link::messages::RemedyMessage;
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::time::Duration;

use brushwork_link::transport::list_ports;
use brushwork_link::{Addresses, Clock, ConnectTarget, Failure, PortInfo, SystemClock};
use brushwork_plant::server::Pace;
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_script::debug::{Request, View, Wanted};
use brushwork_script::language::Language;
use brushwork_script::program::Program;
use crossbeam_channel::{Receiver, Sender, TrySendError, bounded};
use egui::Context;

use super::parts::{OpenLink, Opener, Parts, PortSource, SimulatedWorld};
use brushwork_core::keep::{Keeping, Store};
use brushwork_core::session::firmware::LoaderPlace;
use brushwork_core::session::{self, SessionError, SessionOptions, Simulation};

/// How often the list of ports is made.
const LISTING_INTERVAL: Duration = Duration::from_secs(1);

/// The parts of the real program.
pub fn real_parts(ctx: &Context) -> Parts {
    Parts {
        ports: Box::new(ListedPorts::start(ctx.clone())),
        opener: Box::new(SessionOpener::new()),
        keeping: Keeping::new(Store::of_user()),
    }
}

type Listed = Result<Vec<PortInfo>, Failure>;

/// Lists the serial ports once a second and tells when the list changes.
struct ListedPorts(Receiver<Listed>);

impl ListedPorts {
    fn start(ctx: Context) -> Self {
        let (sender, receiver) = bounded(1);
        let watch = std::thread::Builder::new().name("ports".to_owned()).spawn(move || watch(&sender, &ctx));
        if let Err(error) = watch {
            let (error, remedy) = (Message::error(error), RemedyMessage::TypePath);
            let (sender, receiver) = bounded(1);
            let failure = Failure::new(WindowActMessage::WatchPorts, "", error, remedy);
            sender.send(Err(failure)).expect("the channel is empty and its receiver is here");
            return Self(receiver);
        }
        Self(receiver)
    }
}

impl PortSource for ListedPorts {
    fn newest(&mut self) -> Option<Listed> {
        self.0.try_recv().ok()
    }
}

/// Ends when the window is gone.
fn watch(sender: &Sender<Listed>, ctx: &Context) {
    let mut reported: Option<Listed> = None;
    loop {
        let listed = list_ports();
        if reported.as_ref() != Some(&listed) {
            match sender.try_send(listed.clone()) {
                Ok(()) => {
                    reported = Some(listed);
                    ctx.request_repaint();
                }
                // The window has not taken the list before; the next turn tries again.
                Err(TrySendError::Full(_)) => {}
                Err(TrySendError::Disconnected(_)) => return,
            }
        }
        std::thread::sleep(LISTING_INTERVAL);
    }
}

/// An opener as the real program has it, for those who bring their own ports.
pub fn session_opener() -> Box<dyn Opener> {
    Box::new(SessionOpener::new())
}

/// Simulated machines that the window still holds.
type Running = Arc<Mutex<Vec<Weak<Simulation>>>>;

/// Opens sessions. A simulated machine that is still there is connected to again.
struct SessionOpener {
    /// One clock for all links, so that the graph's time runs on from one to the next.
    clock: Arc<dyn Clock>,
    running: Running,
}

impl SessionOpener {
    fn new() -> Self {
        Self { clock: SystemClock::shared(), running: Running::default() }
    }
}

impl Opener for SessionOpener {
    fn open(
        &mut self,
        target: ConnectTarget,
        addresses: Addresses,
    ) -> Receiver<Result<OpenLink, SessionError>> {
        let (sender, receiver) = bounded(1);
        let (running, clock) = (self.running.clone(), self.clock.clone());
        let open = move || {
            let options = SessionOptions { addresses, ..SessionOptions::default() };
            let opened = session::open(&target, options, clock, find(&running, &target)).map(|session| {
                if let Some(simulation) = &session.simulation {
                    let mut running = running.lock().unwrap_or_else(PoisonError::into_inner);
                    running.retain(|known| known.strong_count() > 0);
                    running.push(Arc::downgrade(simulation));
                }
                let world = session.simulation.map(|simulation| simulation as Arc<dyn SimulatedWorld>);
                OpenLink { device: session.device, bus: session.bus, world }
            });
            // Whoever gave up waiting has dropped the receiver; the link is closed again by being dropped.
            let _ = sender.send(opened);
        };
        // Without a thread the receiver is disconnected, which the window reports.
        let _ = std::thread::Builder::new().name("open link".to_owned()).spawn(open);
        receiver
    }

    fn loader_place(&mut self, target: &ConnectTarget, ports: &[PortInfo]) -> LoaderPlace {
        LoaderPlace::among(target, find(&self.running, target), ports)
    }
}

/// The simulated machine that a target names, if it runs.
fn find(running: &Running, target: &ConnectTarget) -> Option<Arc<Simulation>> {
    let ConnectTarget::Sim(text) = target else { return None };
    let running = running.lock().unwrap_or_else(PoisonError::into_inner);
    running.iter().filter_map(Weak::upgrade).find(|simulation| simulation.is(text))
}

impl SimulatedWorld for Simulation {
    fn apply(&self, unit: usize, action: WorldAction) -> Result<(), Failure> {
        Self::apply(self, unit, action).map_err(|error| {
            let error = WindowCauseMessage::Said { text: error.to_string() };
            Failure::new(WindowActMessage::ChangeWorld, "", error, WindowRemedyMessage::ConnectAgain)
        })
    }

    fn views(&self) -> Option<Arc<Vec<WorldView>>> {
        Some(Self::views(self))
    }

    fn unit_at(&self, address: u8) -> Option<usize> {
        self.unit_of(address)
    }

    fn debug(&self, unit: usize, requests: Vec<Request>, wanted: Wanted) -> Result<(), Failure> {
        Self::debug(self, unit, requests, wanted).map_err(|error| {
            let error = WindowCauseMessage::Said { text: error.to_string() };
            Failure::new(WindowActMessage::DebugScript, "", error, WindowRemedyMessage::ConnectAgain)
        })
    }

    fn runs(&self, language: Language) -> bool {
        Self::runs(self, language)
    }

    fn run_program(&self, unit: usize, program: Arc<Program>) -> Result<(), Failure> {
        Self::run_program(self, unit, program).map_err(|error| {
            let error = WindowCauseMessage::Said { text: error.to_string() };
            Failure::new(WindowActMessage::RunProgram, "", error, WindowRemedyMessage::ConnectAgain)
        })
    }

    fn script(&self) -> Option<View> {
        Self::script(self)
    }

    fn pace(&self) -> Option<Pace> {
        Some(self.server().pace())
    }

    fn set_pace(&self, pace: Pace) {
        self.server().set_pace(pace);
    }
}
