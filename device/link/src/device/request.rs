//! What a window or a command line asks of the device thread.

use super::drive::{ArmScope, Drive};
use super::job::QueuedJob;
use super::poll_rate::PollRate;
use super::risk::RiskAccepted;
use crate::transport::Stream;
use brushwork_values::{Motor, Value};

/// A request to the device thread. All but [`Request::Select`] speak of the selected unit.
#[derive(Debug)]
pub enum Request {
    /// Makes the unit at this address the one that the other requests speak of. Disarms.
    Select(u8),
    /// Makes the units at these addresses be armed, driven and read together with the selected one, until another selection. Disarms.
    Join(Vec<u8>),
    /// Sets how often the signals are read.
    Poll(PollRate),
    /// Sets whether sweeps read the input pins too, which takes a long reply each time.
    ReadSignals(bool),
    /// Says which of the controller's streams this port is wired to, where the device name does not tell.
    SetStream(Stream),
    /// Forgets what was learned of the unit's firmware, here and where it is kept, and finds it out anew. Not while anything is armed.
    /// Answered by [`Event::Capabilities`](super::Event::Capabilities).
    LearnAnew,
    /// Switches [`Event::Traffic`](super::Event::Traffic) on or off.
    Trace(bool),
    /// Asks for permission to move motors. Answered by [`Event::Armed`](super::Event::Armed) or
    /// [`Event::ArmRefused`](super::Event::ArmRefused).
    Arm(ArmScope),
    /// Stops the motors and takes the permission back. Overtakes what is queued.
    Disarm,
    /// Moves motors; needs arming. A command that waited longer than a motion may live unrenewed is not sent.
    Drive(Drive),
    /// Sets an encoder's count.
    SetEncoder {
        /// Which.
        motor: Motor,
        /// The new count.
        counts: i32,
    },
    /// Sets both encoders' counts to zero.
    ZeroEncoders,
    /// Resets an E-stop, where the controller lets software do that.
    ResetEStop,
    /// Starts the stored script; needs [`ArmScope::Script`] or [`ArmScope::CommandLine`].
    StartScript,
    /// Stops the running script.
    StopScript,
    /// Starts the program in the unit's memory, of which nobody here knows what it does and which nothing here may be able to stop. Answered by
    /// [`Event::ProgramStarted`](super::Event::ProgramStarted), and by the units as they are then.
    StartProgram(RiskAccepted),
    /// Stops the motors and sends the unit into its firmware loader. Answered by
    /// [`Event::LoaderEntered`](super::Event::LoaderEntered), which ends the link: the loader speaks another language.
    EnterLoader(RiskAccepted),
    /// Sends one command of the protocol. Answered by [`Event::Transacted`](super::Event::Transacted).
    Transact {
        /// Comes back with the answer.
        id: u64,
        /// The command byte.
        command: u8,
        /// Raw values in wire order.
        values: Vec<Value>,
    },
    /// Sends bytes as they were typed, one command of the unit's protocol. Answered by [`Event::RawReply`](super::Event::RawReply).
    Raw {
        /// Comes back with the answer.
        id: u64,
        /// The bytes, line end or checksum included.
        bytes: Vec<u8>,
    },
    /// Runs long work. Answered by [`Event::JobStarted`](super::Event::JobStarted) and what follows it; its ticket cancels it.
    Job(QueuedJob),
    /// Stops what this program has set in motion and closes the link. Overtakes what is queued.
    Disconnect,
}

/// Why a request was not even queued.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RequestRefused {
    /// The queue is full: a job runs, or the link is slow.
    #[error(
        "the controller is busy: {waiting} requests are waiting already. Wait for the running job or cancel it."
    )]
    Busy {
        /// Requests in the queue.
        waiting: usize,
    },
    /// The link is closed or lost.
    #[error("the link is closed. Connect again.")]
    Closed,
}
