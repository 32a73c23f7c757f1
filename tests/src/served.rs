//! A simulated controller of either family that is served to programs in real time, with a test looking at its bridges.

use std::time::Duration;

use brushwork_child::ahead;
use brushwork_core::session::line::SimulatedLine;
use brushwork_mcp_sim::controller::{Bus, Controller};
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_motion_mind_sim::{Mode, MotionMind, MotionMindBus, MotionMindConfig};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::server::{Endpoint, Server, ServerOptions, SimHandle};
use tempfile::TempDir;

use crate::simulated::{LATE_PTY, patient};

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
        let target = format!("{}{options}{LATE_PTY}", link.display());
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
        let handle = ahead(|| Server::spawn(machine, ServerOptions::default(), endpoint));
        let handle = handle.expect("it can be served");
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

    /// Where the encoders stand, and the machine's time.
    ///
    /// # Panics
    /// When the server has ended.
    #[must_use]
    pub fn counts(&self) -> (Vec<i64>, Duration) {
        let look = |machine: &mut M| {
            let view = machine.views().remove(0);
            (view.axes.iter().map(|axis| axis.encoder_counts).collect(), view.now)
        };
        self.handle.inspect(look).expect("the server runs as long as this does")
    }

    /// When the motor was off for good after `attack`. None where it was still driven after `limit`.
    pub fn off_after(&self, attack: impl FnOnce(), limit: Duration) -> Option<Off> {
        const FOR_GOOD: Duration = Duration::from_millis(300);
        let (_, before) = self.look();
        attack();
        let (mut driven_until, mut off_at) = (before, None);
        loop {
            let (is_driven, now) = self.look();
            if is_driven {
                (driven_until, off_at) = (now, None);
                if now >= before + limit {
                    return None;
                }
                continue;
            }
            let first_off = *off_at.get_or_insert(now);
            if now >= first_off + FOR_GOOD {
                return Some(Off {
                    off_after: first_off.saturating_sub(before),
                    driven_for: driven_until.saturating_sub(before),
                });
            }
        }
    }
}

/// When a motor was off, in the machine's time from the last look before the attack. Far apart, the two say that this computer was too late to
/// tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Off {
    /// The first look at which nothing was driven, and nothing was for a while after.
    pub off_after: Duration,
    /// The last look before it.
    pub driven_for: Duration,
}

/// The guardians of a process, as the list of processes names them.
#[must_use]
pub fn guardians_of(program: u32) -> Vec<u32> {
    let words = format!("guardian\0{program}\0");
    let processes = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let of_this = processes.filter(|process| {
        let line = std::fs::read(process.path().join("cmdline")).unwrap_or_default();
        String::from_utf8_lossy(&line).contains(&words)
    });
    of_this.filter_map(|process| process.file_name().to_str()?.parse().ok()).collect()
}

/// A simulated controller as the program itself starts it, by its family and what follows `sim:`.
///
/// # Panics
/// When there is no such one.
#[must_use]
pub fn simulated(family: &str, text: &str) -> SimulatedLine {
    brushwork::install();
    let is_meant = |found: &&brushwork::Family| found.driver.family().key() == family;
    let family = brushwork::FAMILIES.iter().find(is_meant).expect("it is listed");
    SimulatedLine::new(family.simulator.start(text).expect("it can be simulated").machine)
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
