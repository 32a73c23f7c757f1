//! What the window takes from outside: the time, the list of ports, and how a link is opened.
//!
//! A test brings its own, so that the window runs in virtual time against a controller that is stepped by hand.

use std::sync::Arc;

use brushwork_canopen::bus::Monitor;
use brushwork_link::{Addresses, ConnectTarget, DeviceHandle, Failure, Message, PortInfo};
use brushwork_plant::server::Pace;
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_script::debug::{Request, View, Wanted};
use brushwork_script::language::Language;
use brushwork_script::program::Program;
use crossbeam_channel::Receiver;

use brushwork_core::keep::Keeping;
use brushwork_core::session::SessionError;
use brushwork_core::session::firmware::LoaderPlace;

/// Everything the window needs and does not make itself.
pub struct Parts {
    pub ports: Box<dyn PortSource>,
    pub opener: Box<dyn Opener>,
    /// Where backups and journals go.
    pub keeping: Keeping,
}

/// Where the list of serial ports comes from. Looking never waits.
pub trait PortSource {
    /// A new list, if there is one since the last call.
    fn newest(&mut self) -> Option<Result<Vec<PortInfo>, Failure>>;

    /// Whether ports have to be chosen before they are listed, as a browser has it.
    fn can_choose(&self) -> bool {
        false
    }

    /// Lets the user choose one.
    fn choose(&mut self) {}

    /// Why none was chosen, once.
    fn take_refusal(&mut self) -> Option<Message> {
        None
    }
}

/// Opens links without keeping the window waiting.
pub trait Opener {
    /// Begins to open `target`. The answer comes later, once; dropping the receiver gives up.
    fn open(
        &mut self,
        target: ConnectTarget,
        addresses: Addresses,
    ) -> Receiver<Result<OpenLink, SessionError>>;

    /// Where a unit at `target` will be found once it is in its firmware loader. Does not wait.
    fn loader_place(&mut self, target: &ConnectTarget, ports: &[PortInfo]) -> LoaderPlace {
        LoaderPlace::among(target, None, ports)
    }
}

/// An open link.
pub struct OpenLink {
    pub device: DeviceHandle,
    /// What is heard of the nodes, on a CAN bus.
    pub bus: Option<Monitor>,
    /// The world of the controllers that are simulated in this program. It lives on when the link ends, so that a
    /// cable that was pulled out can be put back.
    pub world: Option<Arc<dyn SimulatedWorld>>,
}

/// What a person can see of a simulated world, and do to it. Nothing here waits.
pub trait SimulatedWorld: Send + Sync {
    /// Does something to the world of a unit, counted from 0.
    fn apply(&self, unit: usize, action: WorldAction) -> Result<(), Failure>;

    /// The worlds of all units; none when the simulation has ended.
    fn views(&self) -> Option<Arc<Vec<WorldView>>>;

    /// Which unit answers to an address.
    fn unit_at(&self, address: u8) -> Option<usize>;

    /// Asks the debugger of a unit's script for something, and for a look at it; [`SimulatedWorld::script`] has it a moment later.
    fn debug(&self, unit: usize, requests: Vec<Request>, wanted: Wanted) -> Result<(), Failure>;

    /// Whether its units run programs of a language that are put into their memory past the wire.
    fn runs(&self, _language: Language) -> bool {
        false
    }

    /// Puts such a program into a unit's memory and starts it.
    fn run_program(&self, _unit: usize, _program: Arc<Program>) -> Result<(), Failure> {
        Ok(())
    }

    /// The newest look at the script that was asked for, once.
    fn script(&self) -> Option<View>;

    /// How fast the machine's time goes, where that can be chosen.
    fn pace(&self) -> Option<Pace>;

    /// Lets the machine's time go faster, or as the clock again.
    fn set_pace(&self, pace: Pace);
}
