//! A connected controller whose settings are to be read or written: work runs as jobs on its device thread.

use crate::messages::CliSettingsMessage;
use brushwork_link::Message;
use brushwork_link::messages::ActMessage;
use std::sync::Arc;
use std::time::Duration;

use brushwork_link::device::JobContext;
use brushwork_link::transport::list_ports;
use brushwork_link::{
    DeviceHandle, Event, Failure, Identity, Keeper, PollRate, Profile, ReadReport, SettingsTable, Subject,
    UnitAddress, WriteOptions,
};

use super::cut_short;
use crate::work::{self, Finished};
use crate::{Client, ConnectArgs, Exit, Interrupt, say};
use brushwork_core::examine::RawWrite;
use brushwork_core::keep::{Keeping, RawKeeper, Store, UnitId, profile_of};
use brushwork_core::session::Simulation;
use brushwork_core::settings::{Act, Done};

/// A connected controller of a known model.
pub struct Controller<'i> {
    pub client: Client,
    interrupt: &'i Interrupt,
    pub subject: Subject,
    keeping: Keeping,
    pub unit: UnitId,
}

impl<'i> Controller<'i> {
    /// Connects and finds out which settings the controller has.
    ///
    /// # Errors
    /// Says on standard error what went wrong and gives the exit code.
    pub fn connect(args: &ConnectArgs, interrupt: &'i Interrupt) -> Result<Self, Exit> {
        Self::connect_to(args, None, interrupt)
    }

    /// The same, to a simulation that runs already where the target names it.
    ///
    /// # Errors
    /// As for [`Self::connect`].
    pub fn connect_to(
        args: &ConnectArgs,
        running: Option<Arc<Simulation>>,
        interrupt: &'i Interrupt,
    ) -> Result<Self, Exit> {
        let client = Client::connect_untold(args, PollRate::Off, running, interrupt)?;
        let version = &client.identity.version_text;
        let Some(subject) = client.identity.subject() else {
            return Err(Exit::Refused.saying(CliSettingsMessage::UnknownModel {
                unit: client.identity.place(),
                port: client.identity.port.clone(),
                version: version.to_string(),
            }));
        };
        // Without a list of ports a unit is told by the name of its port.
        let unit = UnitId::new(&client.identity, &list_ports().unwrap_or_default());
        Ok(Self { client, interrupt, subject, keeping: Keeping::new(Store::of_user()), unit })
    }

    /// Says what was begun on the controller and did not end, for commands that do not read its settings.
    pub fn announce(&self) {
        cut_short::announce(&self.unit, &self.identity().port);
    }

    /// Who it is.
    pub fn identity(&self) -> &Identity {
        &self.client.identity
    }

    /// "0x80 at /dev/ttyACM0".
    pub fn describe(&self) -> String {
        format!("{} at {}", self.identity().place(), self.identity().port)
    }

    /// Its address when it was connected.
    pub fn address(&self) -> UnitAddress {
        self.identity().unit_address()
    }

    /// The device thread.
    pub fn device(&self) -> &DeviceHandle {
        self.client.device()
    }

    /// What writing has to know of the way to this controller.
    pub fn write_options(&self) -> WriteOptions {
        WriteOptions { own_stream: self.client.stream, simulated: self.identity().simulated, as_read: false }
    }

    /// What keeps backup and journal of an act on it.
    pub fn keeper(&self) -> Box<dyn Keeper> {
        self.keeping.keeper(self.unit.clone(), &self.identity().version_text)
    }

    /// What was read as a profile of this controller.
    pub fn profile_of(&self, report: &ReadReport) -> Profile {
        let (subject, version) = (*report.table.subject(), &self.identity().version_text);
        profile_of(subject, self.address(), version, &self.unit.place, report.image.clone())
    }

    /// Reads every setting; says what could not be read, and what an act that was cut short has left of them.
    pub fn read(&self) -> Result<ReadReport, Exit> {
        let report = self.read_quietly()?;
        cut_short::tell(&self.unit, &report);
        Ok(report)
    }

    /// Reads every setting; says what could not be read.
    pub fn read_quietly(&self) -> Result<ReadReport, Exit> {
        let table = SettingsTable::new(self.subject);
        let finished = self.act(ActMessage::ReadSettings, Act::Read, &table, self.write_options())?;
        if let Some(exit) = finished.broken {
            return Err(exit);
        }
        let report = match finished.value {
            Ok(Done::Read(report)) => *report,
            Ok(_) => return Err(Exit::Failed),
            Err(failure) => return Err(Exit::NoLink.saying(failure)),
        };
        for unread in &report.failures {
            say(CliSettingsMessage::NotRead {
                keys: unread.keys.join(", "),
                failure: unread.failure.clone(),
            });
        }
        Ok(report)
    }

    /// Has an act on the settings done, with what it keeps on this computer, and waits for its end.
    pub fn act(
        &self,
        name: impl Into<Message>,
        act: Act,
        table: &SettingsTable,
        options: WriteOptions,
    ) -> Result<Finished<Result<Done, Failure>>, Exit> {
        self.run(name, act.limit(), act.work(table.clone(), options, self.keeper()))
    }

    /// The same for one number that is written raw, which is noted before it goes out.
    pub fn act_raw(
        &self,
        name: impl Into<Message>,
        act: Act,
        table: &SettingsTable,
        options: WriteOptions,
        raw: RawWrite,
    ) -> Result<Finished<Result<Done, Failure>>, Exit> {
        let keeper = RawKeeper::boxed(self.keeper(), self.keeping.store().clone(), self.unit.clone(), raw);
        self.run(name, act.limit(), act.work(table.clone(), options, keeper))
    }

    /// Runs work on the device thread and waits for its end. Ctrl-C cancels it; what it had to say by then
    /// comes back all the same.
    pub fn run<T: Send + 'static>(
        &self,
        name: impl Into<Message>,
        limit: Duration,
        work: impl FnMut(&mut JobContext<'_>) -> T + Send + 'static,
    ) -> Result<Finished<T>, Exit> {
        let finished = work::run(&self.client, name, limit, self.interrupt, work);
        self.keeping.take_faults().iter().for_each(|fault| say(fault.to_string()));
        finished
    }

    /// Lets events pass for a moment.
    ///
    /// # Errors
    /// The link is lost or the program was asked to end.
    pub fn breathe(&self) -> Result<(), Exit> {
        self.client.next_event(self.interrupt).map(|_| ())
    }

    /// The next event, or `None` when there was none for a moment.
    ///
    /// # Errors
    /// The link is lost or the program was asked to end.
    pub fn next_event(&self) -> Result<Option<Event>, Exit> {
        self.client.next_event(self.interrupt)
    }
}
