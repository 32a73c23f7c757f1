//! What the loop of the device thread holds: the link, its units, what is armed, and what is due.

use super::stop_again::StopAgain;
use super::sweep::{Plan, Sweep};
use crate::clock::Clock;
use crate::device::controller::{Controller, Search};
use crate::device::drive::ArmScope;
use crate::device::event::DisarmReason;
use crate::device::handle::Envelope;
use crate::device::options::DeviceOptions;
use crate::device::outbox::Outbox;
use crate::device::poll_rate::PollRate;
use crate::device::signals::{Guard, Signals};
use crate::exchange::Exchange;
use crate::transport::Stream;
use crossbeam_channel::Receiver;
use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Duration;

/// What a step leaves to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// More is due now.
    Again,
    /// Nothing is due before this time, unless a request or a signal comes.
    IdleUntil(Duration),
    /// The link is closed or lost.
    Ended,
}

/// A link and all that is done over it.
pub struct DeviceLoop {
    pub(super) exchange: Exchange,
    pub(super) clock: Arc<dyn Clock>,
    pub(super) signals: Arc<Signals>,
    pub(super) guard: Guard,
    pub(super) inbox: Receiver<Envelope>,
    pub(super) waiting: VecDeque<Envelope>,
    pub(super) outbox: Outbox,
    pub(super) family: Box<dyn Search>,
    pub(super) options: DeviceOptions,
    pub(super) stream: Option<Stream>,
    pub(super) units: Vec<Unit>,
    pub(super) selected: usize,
    /// Units that are armed, driven and read together with the selected one.
    pub(super) joined: Vec<usize>,
    pub(super) armed: Option<Armed>,
    /// What disarmed last, until something is armed again.
    pub(super) disarmed_by: Option<DisarmReason>,
    /// What the guard was told last: whether something is armed, and of each unit whether it moved and its script was started.
    pub(super) held: Vec<(bool, bool)>,
    pub(super) poll: PollRate,
    /// Whether sweeps read the input pins too.
    pub(super) reads_signals: bool,
    pub(super) sweep: Sweep,
    pub(super) statistics_at: Duration,
    pub(super) phase: Phase,
    /// Whether Stop came while units were looked for: it is served in full, scripts included, once they are known.
    pub(super) stopped_while_connecting: bool,
    /// The last bytes sent, to read their answer by when traffic is shown, and what has come of it.
    pub(super) last_sent: Vec<u8>,
    pub(super) last_received: Vec<u8>,
}

/// One unit of the link.
pub(super) struct Unit {
    pub(super) controller: Box<dyn Controller>,
    pub(super) plan: Plan,
    /// What each motor was last told, in the unit of the command.
    pub(super) setpoints: [Option<f64>; 2],
    /// Whether a motion command may be in effect that came from this program.
    pub(super) moved: bool,
    /// Whether this program has started the unit's script.
    pub(super) script_started: bool,
    /// Set while a stop of what this program moved is not confirmed.
    pub(super) stop_again: Option<StopAgain>,
}

/// What is armed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Armed {
    pub(super) scope: ArmScope,
    pub(super) controller_timeout: Option<Duration>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    Connecting,
    Running,
    Ended,
}

impl Unit {
    pub(super) fn new(controller: Box<dyn Controller>) -> Self {
        let plan = Plan::new(controller.poll_list());
        Self { controller, plan, setpoints: [None; 2], moved: false, script_started: false, stop_again: None }
    }
}
