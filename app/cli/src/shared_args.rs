//! Arguments that several commands have: which controller, on which line, for how long, and what a script finds on its buses.

use brushwork_core::addresses::{self, AddressList};
use std::time::Duration;

use brushwork_link::FamilyChoice;
use brushwork_link::family::addresses_text;
use brushwork_plant::world::{CanPeer, I2cDevice, WorldAction};
use clap::{Args, ValueEnum};

use super::addresses::Line;
use super::examples;

/// Which controllers, and how to reach them.
#[derive(Debug, Clone, Args)]
pub struct ConnectArgs {
    /// What to connect to; several where a command takes several lines.
    #[arg(long, short = 'c', alias = "to", value_name = "TARGET", default_value = examples::target(), help = examples::connect_help())]
    pub connect: Vec<String>,
    /// Address of the controller on its line, by default that of a new unit.
    #[arg(long, value_name = "ADDRESS", value_parser = addresses::parse, help = address_help())]
    pub address: Option<AddressList>,
    /// Which protocol family to look for; without it each in turn.
    #[arg(long, value_name = examples::names(&["auto"]), default_value_t, hide_default_value = true)]
    pub family: FamilyChoice,
}

/// A line with all its controllers, or some of them.
#[derive(Debug, Args)]
pub struct LineArgs {
    /// What to connect to; may be given again for another line.
    #[arg(long, short = 'c', alias = "to", value_name = "TARGET", default_value = examples::target(), help = examples::line_help())]
    pub connect: Vec<String>,
    /// Addresses, or node ids on a CAN bus: 0x80,0x81, 0x80-0x84 or all. Without it all that the line has.
    #[arg(long, value_name = "ADDRESS", value_parser = addresses::parse_on_line)]
    pub address: Option<AddressList>,
    /// Which protocol family to look for; without it each in turn.
    #[arg(long, value_name = examples::names(&["auto"]), default_value_t, hide_default_value = true)]
    pub family: FamilyChoice,
}

impl ConnectArgs {
    /// Where the controller is, or the first of several.
    pub fn place(&self) -> &str {
        self.connect.first().map_or("", String::as_str)
    }

    /// Whether several controllers are asked for, by a list of addresses or by several lines.
    pub fn is_several(&self) -> bool {
        let is_list = matches!(self.address, Some(AddressList::These(_) | AddressList::All));
        is_list || self.connect.len() > 1
    }

    /// The whole line that the controller is on.
    pub fn line(&self) -> Line<'_> {
        Line { connect: self.place(), address: None, family: self.family }
    }
}

impl LineArgs {
    /// Each line with what is meant of it.
    pub fn lines(&self) -> impl Iterator<Item = Line<'_>> {
        let line = |connect| Line { connect, address: self.address.as_ref(), family: self.family };
        self.connect.iter().map(move |connect| line(connect.as_str()))
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

/// Seconds, or a time with its unit: 5, 2.5, 90s, 2m, 500ms.
pub fn parse_time(text: &str) -> Result<Duration, String> {
    parse_seconds(text).or_else(|_| {
        humantime::parse_duration(text)
            .map_err(|_| "give a time such as 5 (seconds), 500ms, 90s or 2m".to_owned())
    })
}

fn address_help() -> String {
    format!(
        "Address of the controller on its line, by default that of a new unit: {}. Several as 0x80,0x82 or 0x80-0x84, or all that are \
         found: all",
        addresses_text()
    )
}
