//! What links and settings ask of a family: how its units are found, and what their settings are.
//!
//! A [`FamilyRef`] is a name, so that addresses and settings rows can carry it; the driver behind it is found here by its key. Nothing here or
//! elsewhere in this crate knows which families there are. The program names them once, by [`install`].

use crate::clock::Clock;
use crate::device::controller::Search;
use crate::device::{NoReadings, Readings};
use crate::family::{self, FamilyRef};
use crate::settings::FamilySettings;
use crate::transport::Transport;
use brushwork_canopen::adapter::Form;
use brushwork_canopen::bus::Monitor;
use std::sync::{Arc, PoisonError, RwLock};

/// A family of controllers as it is spoken with.
pub trait Driver: Send + Sync {
    /// Its names, addresses and models.
    fn family(&self) -> FamilyRef;

    /// What finds the units of a link.
    fn search(&self) -> Box<dyn Search>;

    /// Its settings.
    fn settings(&self) -> &'static dyn FamilySettings;

    /// What its units tell a job.
    fn readings(&self) -> &'static dyn Readings {
        &NoReadings
    }

    /// The line to its nodes on a CAN bus, made of that to the adapter, and what finds them; the transport is given back where it has none.
    fn on_can(
        &self,
        adapter: Box<dyn Transport>,
        _clock: Arc<dyn Clock>,
        _form: Form,
    ) -> Result<CanLine, Box<dyn Transport>> {
        Err(adapter)
    }
}

/// A line to the nodes of a bus.
pub struct CanLine {
    /// The line.
    pub transport: Box<dyn Transport>,
    /// What finds them.
    pub search: Box<dyn Search>,
    /// What is heard of them.
    pub monitor: Monitor,
}

/// The line to the nodes of a CAN bus, for the first family that has some.
#[must_use]
pub fn can_line(mut adapter: Box<dyn Transport>, clock: &Arc<dyn Clock>, form: Form) -> Option<CanLine> {
    let drivers = DRIVERS.read().unwrap_or_else(PoisonError::into_inner).clone();
    for driver in drivers {
        match driver.on_can(adapter, Arc::clone(clock), form) {
            Ok(line) => return Some(line),
            Err(back) => adapter = back,
        }
    }
    None
}

static DRIVERS: RwLock<Vec<&'static dyn Driver>> = RwLock::new(Vec::new());

/// Names the families that this program has, the one that is looked for first at the head. Only the first list counts as the program's,
/// so that tests of one process can all name theirs.
pub fn install(drivers: &[&'static dyn Driver]) {
    drivers.iter().for_each(|driver| register(*driver));
    family::list(drivers.iter().map(|driver| driver.family()).collect());
}

/// Makes a family known that is not looked for unless it is asked for.
pub fn register(driver: &'static dyn Driver) {
    let mut drivers = DRIVERS.write().unwrap_or_else(PoisonError::into_inner);
    if !drivers.iter().any(|known| known.family() == driver.family()) {
        drivers.push(driver);
    }
}

impl FamilyRef {
    /// What finds the units of a link.
    ///
    /// # Panics
    /// If the family was never installed.
    #[must_use]
    pub fn search(self) -> Box<dyn Search> {
        self.driver().search()
    }

    /// Its settings.
    ///
    /// # Panics
    /// If the family was never installed.
    #[must_use]
    pub fn settings(self) -> &'static dyn FamilySettings {
        self.driver().settings()
    }

    /// What its units tell a job.
    ///
    /// # Panics
    /// If the family was never installed.
    #[must_use]
    pub fn readings(self) -> &'static dyn Readings {
        self.driver().readings()
    }

    fn driver(self) -> &'static dyn Driver {
        let drivers = DRIVERS.read().unwrap_or_else(PoisonError::into_inner);
        let found = drivers.iter().find(|driver| driver.family() == self).copied();
        found.unwrap_or_else(|| panic!("the family {} was never installed", self.key()))
    }
}
