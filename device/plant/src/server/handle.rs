//! What the rest of the program holds of a running simulated machine.

use super::channel_ends::ChannelEnds;
use super::error::ServerError;
use super::pace::{Pace, SharedPace};
use crate::machine::Machine;
use crate::world::{WorldAction, WorldView};
use crossbeam_channel::{Sender, TrySendError, bounded};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;

/// The latest snapshot of all units' worlds.
pub type Views = Arc<Mutex<Arc<Vec<WorldView>>>>;

/// What the server's thread can be asked.
pub enum Command<M> {
    /// Do something to the world of a unit.
    Apply(usize, WorldAction),
    /// Let somebody look at the machine between two steps.
    Inspect(Box<dyn FnOnce(&mut M) + Send>),
    /// Connect a client inside the program.
    NewChannel(Sender<Option<ChannelEnds>>),
}

/// A running simulated machine. Dropping it ends the server, removes a pseudo-terminal's link and waits for the thread.
#[derive(Debug)]
pub struct SimHandle<M> {
    commands: Option<Sender<Command<M>>>,
    views: Views,
    pace: SharedPace,
    address: String,
    thread: Option<JoinHandle<()>>,
}

impl<M: Machine + 'static> SimHandle<M> {
    /// Where the machine is reached: the path of the link, "tcp:127.0.0.1:5000", or "in-process".
    pub fn address(&self) -> &str {
        &self.address
    }

    /// Does something to the world of a unit, counted from 0. Never waits.
    ///
    /// # Errors
    /// The server has ended, or is so busy that its queue is full.
    pub fn apply(&self, unit: usize, action: WorldAction) -> Result<(), ServerError> {
        self.ask(Command::Apply(unit, action))
    }

    /// The worlds of all units, at most a few hundredths of a second old. Never waits for the machine.
    pub fn views(&self) -> Arc<Vec<WorldView>> {
        self.views.lock().unwrap_or_else(std::sync::PoisonError::into_inner).clone()
    }

    /// Lets `look` see the machine between two steps, on the server's thread, and waits for what it says.
    ///
    /// # Errors
    /// The server has ended, or is so busy that its queue is full.
    pub fn inspect<T: Send + 'static>(
        &self,
        look: impl FnOnce(&mut M) -> T + Send + 'static,
    ) -> Result<T, ServerError> {
        let (sender, answer) = bounded(1);
        self.ask(Command::Inspect(Box::new(move |machine| {
            // Whoever asked may have gone.
            let _ = sender.send(look(machine));
        })))?;
        answer.recv().map_err(|_| ServerError::Ended)
    }

    /// Lets `work` act on the machine between two steps, on the server's thread. Never waits.
    ///
    /// # Errors
    /// The server has ended, or is so busy that its queue is full.
    pub fn post(&self, work: impl FnOnce(&mut M) + Send + 'static) -> Result<(), ServerError> {
        self.ask(Command::Inspect(Box::new(work)))
    }

    /// How fast the machine's time goes. A machine that wanted real time has it again.
    pub fn pace(&self) -> Pace {
        self.pace.get()
    }

    /// Lets the machine's time go faster, or as the wall clock again. Never waits.
    pub fn set_pace(&self, pace: Pace) {
        self.pace.set(pace);
    }

    /// Connects a client inside the program; the one before is disconnected.
    ///
    /// # Errors
    /// The machine is unplugged or served elsewhere, or the server has ended.
    pub fn new_channel(&self) -> Result<ChannelEnds, ServerError> {
        let (sender, answer) = bounded(1);
        self.ask(Command::NewChannel(sender))?;
        match answer.recv() {
            Ok(Some(ends)) => Ok(ends),
            Ok(None) if self.address == "in-process" => Err(ServerError::Unplugged),
            Ok(None) => Err(ServerError::NotInProcess { address: self.address.clone() }),
            Err(_) => Err(ServerError::Ended),
        }
    }

    /// Whether the server still runs.
    pub fn is_running(&self) -> bool {
        self.thread.as_ref().is_some_and(|thread| !thread.is_finished())
    }

    /// Ends the server and waits for its thread; the same as dropping the handle.
    pub fn stop(self) {
        drop(self);
    }

    fn ask(&self, command: Command<M>) -> Result<(), ServerError> {
        let commands = self.commands.as_ref().ok_or(ServerError::Ended)?;
        commands.try_send(command).map_err(|error| match error {
            TrySendError::Full(_) => ServerError::Busy,
            TrySendError::Disconnected(_) => ServerError::Ended,
        })
    }
}

impl<M> SimHandle<M> {
    pub(super) fn new(
        commands: Sender<Command<M>>,
        views: Views,
        pace: SharedPace,
        address: String,
        thread: JoinHandle<()>,
    ) -> Self {
        Self { commands: Some(commands), views, pace, address, thread: Some(thread) }
    }
}

impl<M> Drop for SimHandle<M> {
    fn drop(&mut self) {
        self.commands = None;
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has ended too; its message is already out.
            let _ = thread.join();
        }
    }
}
