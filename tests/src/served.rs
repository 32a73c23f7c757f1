//! A simulated controller of either family that is served to programs in real time, with a test looking at its bridges.

use std::time::Duration;

use brushwork_mcp_sim::controller::{Bus, Controller};
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_motion_mind_sim::{Mode, MotionMind, MotionMindBus, MotionMindConfig};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::server::{Endpoint, Server, ServerOptions, SimHandle};
use tempfile::TempDir;

use crate::simulated::patient;

/// A controller that is served, and how it is reached.
pub struct Served<M: Machine> {
    handle: SimHandle<M>,
    /// What a program connects to.
    pub target: String,
    _folder: TempDir,
}

impl<M: Machine + 'static> Served<M> {
    /// On a pseudo-terminal; `options` follow its path in the target.
    ///
    /// # Panics
    /// When the system gives no pseudo-terminal.
    #[must_use]
    pub fn on_pty(machine: M, options: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let link = folder.path().join("port");
        let target = format!("{}{options}", link.display());
        Self::at(machine, &Endpoint::Pty { link }, folder, |_| target)
    }

    /// On a TCP port.
    ///
    /// # Panics
    /// When the system gives no port.
    #[must_use]
    pub fn on_tcp(machine: M, options: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let endpoint = Endpoint::Tcp("127.0.0.1:0".parse().expect("it is an address"));
        Self::at(machine, &endpoint, folder, |address| {
            format!("tcp:{}{options}", address.trim_start_matches("tcp:"))
        })
    }

    fn at(machine: M, endpoint: &Endpoint, folder: TempDir, target: impl FnOnce(&str) -> String) -> Self {
        let handle = Server::spawn(machine, ServerOptions::default(), endpoint).expect("it can be served");
        let target = target(handle.address());
        Self { handle, target, _folder: folder }
    }

    /// Whether a bridge is driven, and the machine's time.
    ///
    /// # Panics
    /// When the server has ended.
    #[must_use]
    pub fn look(&self) -> (bool, Duration) {
        let look = |machine: &mut M| {
            let view = machine.views().remove(0);
            let is_driven =
                |output: &BridgeOutput| matches!(output, BridgeOutput::Duty(duty) if *duty != 0.0);
            (view.axes.iter().any(|axis| is_driven(&axis.output)), view.now)
        };
        self.handle.inspect(look).expect("the server runs as long as this does")
    }

    /// How long after `attack` the motor was off for good, in the machine's time and as late as it can have been: from the last look before
    /// to the first look at which nothing was driven, and nothing was for a while after. None where it was still driven after `limit`.
    pub fn off_after(&self, attack: impl FnOnce(), limit: Duration) -> Option<Duration> {
        const FOR_GOOD: Duration = Duration::from_millis(300);
        let (_, before) = self.look();
        attack();
        let mut off_at = None;
        loop {
            let (is_driven, now) = self.look();
            off_at = if is_driven { None } else { off_at.or(Some(now)) };
            match off_at {
                Some(off_at) if now >= off_at + FOR_GOOD => return Some(off_at.saturating_sub(before)),
                None if now >= before + limit => return None,
                Some(_) | None => {}
            }
        }
    }
}

/// A Motion Mind that drives by duty, and has no time-out.
///
/// # Panics
/// When the default motor is unsound.
#[must_use]
pub fn motion_mind() -> MotionMindBus {
    let unit = MotionMind::new(MotionMindConfig::new(Mode::Serial)).expect("the default motor is sound");
    MotionMindBus::new(vec![unit])
}

/// An MCP266 with a time-out of a minute.
///
/// # Panics
/// When the preset is unsound.
#[must_use]
pub fn mcp() -> Bus {
    let unit = Controller::new(patient(Generation::Gen1)).expect("the preset is valid");
    Bus::single(unit, StreamIndex::Usb)
}
