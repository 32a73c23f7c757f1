//! The device list: what can be connected to, and what was chosen.

use super::connection::{Connection, ConnectionId, place_of};
use super::simulated::Simulated;
use crate::family::{self, Family};
use crate::language::word;
use crate::messages::FirmwareMessage;
use brushwork_link::transport::TargetError;
use brushwork_link::transport::target::LineOptions;
use brushwork_link::{Addresses, ConnectTarget, Failure, FamilyChoice, PortInfo};

/// The simulated controller that is always there.
pub const SIMULATED: &str = "sim:mcp266";

/// Rates a controller's serial ports can have (MCP manual 1.9.3), and those USB adapters are often set to.
pub const BAUD_RATES: [u32; 8] = [2_400, 9_600, 19_200, 38_400, 57_600, 115_200, 230_400, 460_800];

/// Connections that are remembered.
const RECENT_KEPT: usize = 8;

/// What the user chose to connect to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Choice {
    #[default]
    Simulated,
    /// A port of the list, by its name.
    Port(String),
    /// What stands in the field below the list.
    Typed,
    /// A link that is open, or was, to something else.
    Connection(ConnectionId),
}

/// The device list.
#[derive(Clone, Debug)]
pub struct Devices {
    pub ports: Vec<PortInfo>,
    /// Whether ports have to be chosen before they are listed, as a browser has it.
    pub can_choose: bool,
    /// Whether the next port that comes is the one that was asked for.
    pub is_choosing: bool,
    pub listing_failure: Option<Failure>,
    pub choice: Choice,
    pub typed: String,
    /// For serial ports that are not a controller's own USB.
    pub baud: u32,
    /// Which addresses to look for when connecting.
    pub addresses: Addresses,
    /// Which family a port's controllers are of, as far as the user knows.
    pub family: FamilyChoice,
    /// What the first row of the list simulates.
    pub simulated: Simulated,
    /// What was connected to before, newest first.
    pub recent: Vec<String>,
}

impl Default for Devices {
    fn default() -> Self {
        Self {
            ports: Vec::new(),
            can_choose: false,
            is_choosing: false,
            listing_failure: None,
            choice: Choice::default(),
            typed: String::new(),
            baud: FamilyChoice::AUTO.default_baud(),
            addresses: Addresses::default(),
            family: FamilyChoice::default(),
            simulated: Simulated::default(),
            recent: Vec::new(),
        }
    }
}

impl Devices {
    /// Takes over a new list of ports.
    pub fn set_ports(&mut self, listed: Result<Vec<PortInfo>, Failure>) {
        match listed {
            Ok(ports) => {
                let newcomer = ports.iter().find(|port| !self.ports.contains(port));
                if let Some(chosen) = newcomer.filter(|_| self.is_choosing) {
                    self.choice = Choice::Port(chosen.name.clone());
                    self.is_choosing = false;
                }
                self.ports = ports;
                self.listing_failure = None;
            }
            Err(failure) => {
                self.ports.clear();
                self.listing_failure = Some(failure);
            }
        }
    }

    /// Chooses what a person would have typed.
    pub fn choose(&mut self, typed: &str) {
        if typed == SIMULATED {
            self.simulated.model = Simulated::default().model;
        }
        self.choice = if typed == SIMULATED { Choice::Simulated } else { Choice::Typed };
        if self.choice == Choice::Typed {
            typed.clone_into(&mut self.typed);
        }
    }

    /// Chooses the row that shows a connection.
    pub fn choose_connection(&mut self, connection: &Connection) {
        if connection.target.is_none() {
            return;
        }
        self.choice = match self.ports.iter().find(|port| connection.is_at(&port.name)) {
            Some(port) => Choice::Port(port.name.clone()),
            None if connection.is_at(&self.simulated_target()) => Choice::Simulated,
            None => Choice::Connection(connection.id()),
        };
    }

    pub fn set_recent(&mut self, recent: Vec<String>) {
        self.recent = recent;
        self.recent.truncate(RECENT_KEPT);
    }

    /// A connection was made: it is now the newest.
    pub fn remember(&mut self, target: &str) {
        self.recent.retain(|known| known != target);
        self.recent.insert(0, target.to_owned());
        self.recent.truncate(RECENT_KEPT);
    }

    /// What was typed has been opened, and has a row of its own now.
    pub fn opened(&mut self, target: &str) {
        if self
            .typed
            .parse::<ConnectTarget>()
            .is_ok_and(|typed| place_of(&typed.to_string()) == place_of(target))
        {
            self.typed.clear();
        }
    }

    pub fn forget_recent(&mut self, target: &str) {
        self.recent.retain(|known| known != target);
    }

    /// The chosen port, while it is listed.
    pub fn chosen_port(&self) -> Option<&PortInfo> {
        let Choice::Port(name) = &self.choice else { return None };
        self.ports.iter().find(|port| port.name == *name)
    }

    /// Whether a port was chosen that is no longer there.
    pub fn choice_is_gone(&self) -> bool {
        matches!(self.choice, Choice::Port(_)) && self.chosen_port().is_none()
    }

    /// Whether the rate matters: not over a controller's own USB, TCP or in this program.
    pub fn baud_matters(&self) -> bool {
        match &self.choice {
            Choice::Simulated | Choice::Connection(_) => false,
            Choice::Port(_) => self.chosen_port().is_some_and(|port| !port.names_a_controller()),
            Choice::Typed => {
                let typed = self.typed.trim();
                let serial = matches!(typed.parse(), Ok(ConnectTarget::Serial { .. }));
                serial && !typed.contains("baud=")
            }
        }
    }

    /// Whether it matters which family is looked for: a simulated controller's is known.
    pub fn family_matters(&self) -> bool {
        match &self.choice {
            Choice::Simulated | Choice::Connection(_) => false,
            Choice::Port(_) => true,
            Choice::Typed => !self.typed.trim().is_empty() && !self.typed.trim().starts_with("sim:"),
        }
    }

    /// Looks for units of a family from now on. A rate that nobody has changed becomes that of the family.
    pub fn look_for(&mut self, family: FamilyChoice) {
        if self.baud == self.family.default_baud() {
            self.baud = family.default_baud();
        }
        self.family = family;
    }

    /// The family of the units that are looked for, as far as known.
    pub fn wanted_family(&self) -> &'static dyn Family {
        match (&self.choice, self.family.family()) {
            (Choice::Simulated, _) => family::of_model(&self.simulated.model),
            (Choice::Port(_) | Choice::Typed | Choice::Connection(_), Some(chosen))
                if self.family_matters() =>
            {
                family::of(chosen)
            }
            (Choice::Port(_) | Choice::Typed | Choice::Connection(_), _) => family::first(),
        }
    }

    /// What a person would type to connect to what is simulated.
    pub fn simulated_target(&self) -> String {
        family::of_model(&self.simulated.model).simulated_target(&self.simulated)
    }

    /// Where the simulated units are, where that is what is chosen and follows from it.
    pub fn simulated_addresses(&self) -> Option<Addresses> {
        let is_chosen = self.choice == Choice::Simulated;
        self.wanted_family().simulated_addresses(&self.simulated).filter(|_| is_chosen)
    }

    /// The addresses to look for. An address of the other family than the one that is wanted is none.
    pub fn addresses(&self) -> Addresses {
        let has = |address| self.wanted_family().family().has_address(address);
        match (self.simulated_addresses(), self.addresses) {
            (Some(simulated), _) => simulated,
            (None, Addresses::Only(address)) if !has(address) => Addresses::Scan,
            (None, addresses) => addresses,
        }
    }

    /// Where to connect to. A connection's own target is known to the connection.
    pub fn target(&self) -> Result<ConnectTarget, TargetError> {
        match &self.choice {
            Choice::Simulated => self.simulated_target().parse(),
            Choice::Port(name) => {
                let stream = self.chosen_port().and_then(|port| port.stream);
                let line = LineOptions { stream, family: self.family, ..LineOptions::default() };
                Ok(ConnectTarget::Serial { path: name.clone(), baud: self.baud, line })
            }
            Choice::Connection(_) | Choice::Typed => {
                let mut target = self.typed.parse()?;
                if let ConnectTarget::Serial { baud, .. } = &mut target
                    && self.baud_matters()
                    // The rate of a family that was typed behind the path is that of the family, unless another is chosen.
                    && (self.baud != FamilyChoice::AUTO.default_baud() || !self.typed.contains("family="))
                {
                    *baud = self.baud;
                }
                // What was typed behind the path goes before what is chosen below it.
                if let ConnectTarget::Serial { line, .. } | ConnectTarget::Tcp { line, .. } = &mut target
                    && line.family == FamilyChoice::AUTO
                {
                    line.family = self.family;
                }
                Ok(target)
            }
        }
    }
}

/// What a port is, as far as its USB names tell.
pub fn described(port: &PortInfo) -> String {
    match (&port.product, port.is_usb) {
        (Some(product), _) if port.is_loader() => {
            FirmwareMessage::PortWaits { product: product.clone() }.to_string()
        }
        (Some(product), _) => product.clone(),
        (None, true) => "USB".to_owned(),
        (None, false) => word("bar", "serial port"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn devices(typed: &str) -> Devices {
        brushwork_link::install(&[
            &brushwork_mcp_client::McpDriver,
            &brushwork_motion_mind_client::MotionMindDriver,
        ]);
        Devices { choice: Choice::Typed, typed: typed.to_owned(), baud: 115_200, ..Devices::default() }
    }

    #[test]
    fn the_simulated_controller_is_chosen_at_first() {
        assert_eq!(Devices::default().target().unwrap(), ConnectTarget::Sim("mcp266".to_owned()));
    }

    #[test]
    fn a_typed_path_gets_the_rate_of_the_list_unless_it_brings_its_own() {
        let baud_of = |typed: &str| match devices(typed).target() {
            Ok(ConnectTarget::Serial { baud, .. }) => baud,
            other => panic!("{other:?}"),
        };
        assert_eq!(baud_of("/dev/ttyUSB7"), 115_200);
        assert_eq!(baud_of("/dev/ttyUSB7,baud=9600"), 9_600);
        let motion_mind =
            Devices { baud: FamilyChoice::AUTO.default_baud(), ..devices("COM3,family=motion-mind") };
        assert!(matches!(motion_mind.target(), Ok(ConnectTarget::Serial { baud: 19_200, .. })));
        assert!(!devices("tcp:127.0.0.1:4000").baud_matters());
        assert!(devices("  ").target().is_err());
    }

    #[test]
    fn the_rate_follows_the_family_until_somebody_says_otherwise() {
        brushwork_link::install(&[
            &brushwork_mcp_client::McpDriver,
            &brushwork_motion_mind_client::MotionMindDriver,
        ]);
        let mut devices = Devices::default();
        devices.look_for(FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND));
        assert_eq!(devices.baud, 19_200);
        devices.look_for(FamilyChoice::AUTO);
        assert_eq!(devices.baud, FamilyChoice::AUTO.default_baud());
        devices.baud = 9_600;
        devices.look_for(FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND));
        assert_eq!(devices.baud, 9_600, "switch 5 is on");
    }

    #[test]
    fn what_the_command_line_names_is_chosen_as_if_it_had_been_typed() {
        let mut devices = Devices::default();
        devices.choose("tcp:127.0.0.1:4000");
        assert_eq!(devices.target().unwrap().to_string(), "tcp:127.0.0.1:4000");
        devices.choose(SIMULATED);
        assert_eq!(devices.choice, Choice::Simulated);
    }

    #[test]
    fn a_port_that_went_away_stays_chosen_and_is_known_to_be_gone() {
        let mut devices = Devices { choice: Choice::Port("COM3".to_owned()), ..Devices::default() };
        devices.set_ports(Ok(vec![PortInfo { name: "COM3".to_owned(), ..PortInfo::default() }]));
        assert!(!devices.choice_is_gone());
        devices.set_ports(Ok(Vec::new()));
        assert!(devices.choice_is_gone());
    }

    #[test]
    fn what_is_chosen_is_a_target_as_a_person_would_type_it() {
        let mut devices = Devices::default();
        assert_eq!(devices.simulated_target(), "sim:mcp266");
        devices.simulated.model = "motion-mind-3".to_owned();
        assert_eq!(devices.simulated_target(), "sim:motion-mind-3,mode=4,protocol=binary,address=1");
        let simulated = &mut devices.simulated;
        (simulated.is_text, simulated.units, simulated.address) = (true, 2, 7);
        assert_eq!(devices.simulated_target(), "sim:motion-mind-3,mode=4,protocol=ascii,address=7,address=8");
    }
}
