//! Arguments that several commands have: which controller, on which line, for how long, and what a script finds on its buses.

use std::time::Duration;

use brushwork_link::FamilyChoice;
use brushwork_link::family::addresses_text;
use brushwork_link::unit::parse_number;
use brushwork_plant::world::{CanPeer, I2cDevice, WorldAction};
use clap::{Args, ValueEnum};

use brushwork_values::parse_byte;

use super::examples;

/// Which controller, and how to reach it.
#[derive(Debug, Clone, Args)]
pub struct ConnectArgs {
    /// What to connect to.
    #[arg(long, short = 'c', alias = "to", value_name = "TARGET", default_value = examples::target(), help = examples::connect_help())]
    pub connect: String,
    /// Address of the controller on its line, by default that of a new unit.
    #[arg(long, value_name = "ADDRESS", value_parser = parse_connect_address, help = address_help())]
    pub address: Option<u8>,
    /// Which protocol family to look for; without it each in turn.
    #[arg(long, value_name = examples::names(&["auto"]), default_value_t, hide_default_value = true)]
    pub family: FamilyChoice,
}

/// A line with all its controllers, or some of them.
#[derive(Debug, Args)]
pub struct LineArgs {
    /// What to connect to.
    #[arg(long, short = 'c', alias = "to", value_name = "TARGET", default_value = examples::target(), help = examples::line_help())]
    pub connect: String,
    /// Addresses, or node ids on a CAN bus, with commas between them: 0x80,0x81. Without it all that the line has.
    #[arg(long, value_name = "ADDRESS", value_delimiter = ',', value_parser = parse_line_address)]
    pub address: Vec<u8>,
    /// Which protocol family to look for; without it each in turn.
    #[arg(long, value_name = examples::names(&["auto"]), default_value_t, hide_default_value = true)]
    pub family: FamilyChoice,
}

impl ConnectArgs {
    /// The whole line that the controller is on.
    pub fn line(&self) -> LineArgs {
        LineArgs { connect: self.connect.clone(), address: Vec::new(), family: self.family }
    }
}

/// What a simulated controller's script finds on its I2C bus and its CAN stream.
#[derive(Debug, Default, Args)]
pub struct ScriptBuses {
    /// Put a device on the controller's I2C bus.
    #[arg(long, value_name = "mpu6050", value_parser = parse_i2c)]
    pub i2c: Vec<I2cDevice>,
    /// Who is at the other end of a script's CAN stream.
    #[arg(long, value_enum, value_name = "listen|echo")]
    pub can_peer: Option<CanPeerArg>,
}

impl ScriptBuses {
    /// How they come into the simulated world.
    pub fn actions(&self) -> Vec<WorldAction> {
        let devices = self.i2c.iter().map(|device| WorldAction::AddI2cDevice { device: device.clone() });
        let peer = self.can_peer.map(|peer| WorldAction::SetCanPeer {
            peer: match peer {
                CanPeerArg::Listen => CanPeer::Listening,
                CanPeerArg::Echo => CanPeer::Echoing,
            },
        });
        devices.chain(peer).collect()
    }

    /// Whether there is anything.
    pub fn is_empty(&self) -> bool {
        self.i2c.is_empty() && self.can_peer.is_none()
    }
}

/// What the other end of the CAN stream does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CanPeerArg {
    /// It listens.
    Listen,
    /// It sends back what it hears.
    Echo,
}

fn parse_i2c(text: &str) -> Result<I2cDevice, String> {
    I2cDevice::named(text).ok_or_else(|| format!("\"{text}\" is no device that is known here: use mpu6050"))
}

/// Reads a time in seconds.
pub fn parse_seconds(text: &str) -> Result<Duration, String> {
    let number = text.trim().trim_end_matches('s');
    number
        .parse::<f64>()
        .ok()
        .filter(|seconds| (0.0..=1e7).contains(seconds))
        .map(Duration::from_secs_f64)
        .ok_or_else(|| format!("\"{text}\" is no time in seconds: use for example 2 or 0.5"))
}

fn address_help() -> String {
    format!("Address of the controller on its line, by default that of a new unit: {}", addresses_text())
}

/// Reads an address of any family.
fn parse_connect_address(text: &str) -> Result<u8, String> {
    let number = parse_number(text);
    number.ok_or_else(|| format!("\"{text}\" is no address: use that of {}", addresses_text()))
}

/// Reads an address of any family or a node id.
fn parse_line_address(text: &str) -> Result<u8, String> {
    parse_byte(text).filter(|number| (1..=0x87).contains(number)).ok_or_else(|| {
        format!("\"{text}\" is no address: use that of {}, CANopen node at 1 to 127", addresses_text())
    })
}
