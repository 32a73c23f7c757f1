//! What a simulated machine is to whoever drives it, in virtual or in real time: bytes and time in, bytes out.
//!
//! A controller is one, and so are several controllers on one wire. The real-time server, the fault script, the benchmarks and
//! the tests know no more than this.

use crate::world::{WorldAction, WorldView};
use serde::{Deserialize, Serialize};
use std::any::Any;
use std::time::Duration;

/// The silence that ends a command where a controller knows no other: the 10 ms of packet serial (MCP manual 2.2.4).
pub const PACKET_GAP: Duration = Duration::from_millis(10);

brushwork_values::listed! {
    /// A serial stream of a controller, in the order of command 145 (MCP manual 2.3, command 145).
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    pub enum StreamIndex {
        /// The USB port, which answers all eight addresses.
        #[default]
        Usb "usb",
        /// RS-232.
        #[serde(rename = "rs232")]
        Uart0 "rs232",
        /// First TTL serial port.
        #[serde(rename = "ttl1")]
        Uart1 "ttl1",
        /// Second TTL serial port, on pins.
        #[serde(rename = "ttl2")]
        Uart2 "ttl2",
        /// Third TTL serial port, on pins.
        #[serde(rename = "ttl3")]
        Uart3 "ttl3",
    }
    /// Name in command lines and settings: "usb", "rs232", "ttl1", "ttl2", "ttl3".
    fn key;
}

impl StreamIndex {
    /// Index in command 145, 0 to 4.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The stream of that name, whatever its case.
    pub fn from_key(key: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|stream| stream.key().eq_ignore_ascii_case(key))
    }
}

/// A simulated machine: one controller, or several on one wire, with the worlds around them.
///
/// Its time only moves in [`Machine::advance`]; all else happens at [`Machine::now`]. Whoever knows which machine it is finds it through
/// [`Any`].
pub trait Machine: Send + Any {
    /// The machine's own time since its start.
    fn now(&self) -> Duration;

    /// Takes bytes that arrive now on a stream.
    fn receive(&mut self, stream: StreamIndex, bytes: &[u8]);

    /// Moves time on to `to`; does nothing when that is past.
    fn advance(&mut self, to: Duration);

    /// When the next output that is already decided leaves, on whichever stream; none while nothing is to be said.
    fn next_output_at(&self) -> Option<Duration>;

    /// Takes one reply that has left by now on a stream: one call is one write.
    fn take_output(&mut self, stream: StreamIndex) -> Option<Vec<u8>>;

    /// The rate a stream is set to, at which `--pace` lets bytes through.
    fn bits_per_second(&self, stream: StreamIndex) -> u32;

    /// How many units there are.
    fn units(&self) -> usize;

    /// Does something to the world of a unit, counted from 0; a unit that is not there is passed by.
    fn apply(&mut self, unit: usize, action: &WorldAction);

    /// The worlds of all units as they are now.
    fn views(&self) -> Vec<WorldView>;

    /// Whether anything is at the other end of the host's cable: false once every unit is unplugged. A unit unplugged from a wire
    /// that others share hears nothing and says nothing.
    fn plugged(&self) -> bool;

    /// A pause of more than this between two bytes ends a command, whole or not. A server sees to it that a pause of its own making
    /// is not taken for one on the line.
    fn silence(&self) -> Duration {
        PACKET_GAP
    }

    /// Whether there is something that a person wants to look at in peace: a server that hurries goes back to real time.
    fn wants_real_time(&self) -> bool {
        false
    }
}

/// What a wrapper of a machine passes on as it is: all but its bytes and its time.
macro_rules! passed_on {
    () => {
        fn bits_per_second(&self, stream: $crate::machine::StreamIndex) -> u32 {
            self.inner.bits_per_second(stream)
        }

        fn units(&self) -> usize {
            self.inner.units()
        }

        fn apply(&mut self, unit: usize, action: &$crate::world::WorldAction) {
            self.inner.apply(unit, action);
        }

        fn views(&self) -> Vec<$crate::world::WorldView> {
            self.inner.views()
        }

        fn plugged(&self) -> bool {
            self.inner.plugged()
        }

        fn silence(&self) -> ::std::time::Duration {
            self.inner.silence()
        }

        fn wants_real_time(&self) -> bool {
            self.inner.wants_real_time()
        }
    };
}
pub(crate) use passed_on;
