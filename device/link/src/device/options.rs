//! How a link is opened.

use super::poll_rate::PollRate;
use crate::capability::KeepsCapabilities;
use crate::family::FamilyChoice;
use crate::guardian::Guardian;
use crate::loan::KeepsLoans;
use crate::transport::Stream;
use crate::wire::HiddenSettings;
use std::sync::Arc;

/// Which units of a bus to look for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Addresses {
    /// All that the family has.
    #[default]
    Scan,
    /// This one alone.
    Only(u8),
    /// These, and no other is told anything, not even by a stop.
    These(AddressSet),
    /// The factory address alone.
    Factory,
}

/// Numbers of units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AddressSet([u64; 4]);

impl AddressSet {
    /// Whether it holds a number.
    #[must_use]
    pub fn contains(self, address: u8) -> bool {
        self.0[usize::from(address / 64)] >> (address % 64) & 1 == 1
    }

    /// The numbers, the lowest first.
    pub fn iter(self) -> impl Iterator<Item = u8> {
        (0..=u8::MAX).filter(move |address| self.contains(*address))
    }
}

impl FromIterator<u8> for AddressSet {
    fn from_iter<T: IntoIterator<Item = u8>>(addresses: T) -> Self {
        let mut set = Self::default();
        addresses.into_iter().for_each(|address| set.0[usize::from(address / 64)] |= 1 << (address % 64));
        set
    }
}

/// What the device thread is told when it starts.
#[derive(Clone, Debug)]
pub struct DeviceOptions {
    /// Which units to look for.
    pub addresses: Addresses,
    /// Which protocol family the units speak.
    pub family: FamilyChoice,
    /// Which of the controller's streams the port is wired to; `None` when nobody knows yet.
    pub stream: Option<Stream>,
    /// Whether the controller is simulated in this program: guesses about the wire may then be sent.
    pub simulated: bool,
    /// The simulated controller's settings that have no wire form; `None` on everything else.
    pub hidden: Option<Arc<dyn HiddenSettings>>,
    /// Where what firmware answers is kept from one session to the next; `None` keeps it for this one.
    pub capabilities: Option<Arc<dyn KeepsCapabilities>>,
    /// Where it is noted what a stop may change for a while; `None` where the units are simulated in this program and gone with it.
    pub loans: Option<Arc<dyn KeepsLoans>>,
    /// What stops the motors when this program dies; none where the controllers are simulated inside of it, and die with it.
    pub guardian: Option<Arc<dyn Guardian>>,
    /// Whether this program is a page in a browser and the controller is real. No second process outlives a tab, so that nothing is armed whose
    /// controller does not stop its motors by itself.
    pub in_page: bool,
    /// How often the signals are read at first.
    pub poll: PollRate,
    /// Events that the channel to the window holds.
    pub event_capacity: usize,
    /// Requests that may wait.
    pub request_capacity: usize,
}

impl Default for DeviceOptions {
    fn default() -> Self {
        Self {
            addresses: Addresses::Scan,
            family: FamilyChoice::AUTO,
            stream: None,
            simulated: false,
            hidden: None,
            capabilities: None,
            loans: None,
            guardian: None,
            in_page: false,
            poll: PollRate::DEFAULT,
            event_capacity: 1024,
            request_capacity: 64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_holds_what_was_put_in_and_nothing_else() {
        for numbers in [vec![], vec![0], vec![255], vec![1, 63, 64, 127, 128, 135, 191, 192]] {
            let set: AddressSet = numbers.iter().copied().collect();
            assert_eq!(set.iter().collect::<Vec<_>>(), numbers);
        }
    }
}
