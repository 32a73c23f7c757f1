//! What is heard and found out of the nodes of a bus: states, heartbeats, emergencies, and who each node is.
//!
//! Whoever reads the bus hands the frames over with their time; whoever looks gets a view of each node. Clones of a [`Monitor`] are
//! the same, so that one thread can listen and another one look.

use crate::nmt::{Command, State};
use crate::{Emergency, Frame, NodeId};
use serde::Serialize;
use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// A node whose heartbeat stays away for this many of its intervals is lost.
const MISSED_BEATS: u32 = 3;
/// Emergencies that are kept, of all nodes together.
const EMERGENCIES: usize = 64;

/// What has been heard of the nodes. Clones are the same.
#[derive(Clone, Debug, Default)]
pub struct Monitor(Arc<Mutex<Heard>>);

#[derive(Debug, Default)]
struct Heard {
    nodes: BTreeMap<NodeId, Sight>,
    /// Those that nobody has taken yet.
    untaken: Vec<Emergency>,
    log: VecDeque<LoggedEmergency>,
    /// Commands of this program that are to go out.
    commands: Vec<Frame>,
    /// Until when the bus was listened to.
    heard_until: Duration,
    /// Whether this program's heartbeat is to be sent.
    beats: bool,
    beaten_at: Option<Duration>,
}

#[derive(Clone, Debug, Default)]
struct Sight {
    who: Who,
    state: Option<State>,
    last_beat_at: Option<Duration>,
    interval: Option<Duration>,
    boots: u32,
    booted_at: Option<Duration>,
}

/// Who a node is, as far as it was asked.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(tag = "kind", content = "text", rename_all = "snake_case")]
pub enum Who {
    /// It was heard and has told nothing of itself.
    #[default]
    Unknown,
    /// A controller that this program knows, with the text of its version.
    Controller(String),
    /// Another device, with what it tells of itself. It is never written to.
    Foreign(String),
    /// More than one device answers as this node. None of them is ever written to.
    Several,
}

/// A node at one moment.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct NodeView {
    /// Its number.
    pub node: NodeId,
    /// Who it is.
    pub who: Who,
    /// The state that it last told.
    pub state: Option<State>,
    /// Time since its last heartbeat, in ms.
    pub heartbeat_age_ms: Option<u64>,
    /// How often it was heard to start.
    pub boots: u32,
}

/// An emergency and when it was heard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoggedEmergency {
    /// When.
    pub at: Duration,
    /// What.
    pub emergency: Emergency,
}

impl Monitor {
    /// Sends this program's heartbeat from now on, or no more.
    pub fn beat(&self, on: bool) {
        let mut heard = self.lock();
        heard.beats = on;
        heard.beaten_at = None;
    }

    /// Whether this program's heartbeat is being sent.
    #[must_use]
    pub fn is_beating(&self) -> bool {
        self.lock().beats
    }

    /// Whether the heartbeat, sent every `interval`, is due; takes note that it goes out.
    #[must_use]
    pub fn is_beat_due(&self, now: Duration, interval: Duration) -> bool {
        let mut heard = self.lock();
        let due = heard.beats && heard.beaten_at.is_none_or(|at| now >= at + interval);
        if due {
            heard.beaten_at = Some(now);
        }
        due
    }

    /// Has a command go out to one node. That is a person's act: nothing here ever does it by itself.
    pub fn command(&self, command: Command, node: NodeId) {
        self.lock().commands.push(command.frame(Some(node)));
    }

    /// The commands that are to go out now.
    #[must_use]
    pub fn take_commands(&self) -> Vec<Frame> {
        std::mem::take(&mut self.lock().commands)
    }

    /// The nodes whose boot-up or heartbeat was heard, or that were asked.
    #[must_use]
    pub fn nodes(&self) -> Vec<NodeId> {
        self.lock().nodes.keys().copied().collect()
    }

    /// The state that a node last told.
    #[must_use]
    pub fn state(&self, node: NodeId) -> Option<State> {
        self.lock().nodes.get(&node)?.state
    }

    /// Takes note of who a node is.
    pub fn know(&self, node: NodeId, who: Who) {
        self.lock().nodes.entry(node).or_default().who = who;
    }

    /// The nodes that are known as controllers of this program: no other node may be written to.
    #[must_use]
    pub fn controllers(&self) -> Vec<NodeId> {
        let heard = self.lock();
        let known = heard.nodes.iter().filter(|(_, sight)| matches!(sight.who, Who::Controller(_)));
        known.map(|(node, _)| *node).collect()
    }

    /// Every node, at the moment until which the bus was listened to.
    #[must_use]
    pub fn views(&self) -> Vec<NodeView> {
        let heard = self.lock();
        let view = |(node, sight): (&NodeId, &Sight)| NodeView {
            node: *node,
            who: sight.who.clone(),
            state: sight.state,
            heartbeat_age_ms: sight.last_beat_at.map(|at| {
                u64::try_from(heard.heard_until.saturating_sub(at).as_millis()).unwrap_or(u64::MAX)
            }),
            boots: sight.boots,
        };
        heard.nodes.iter().map(view).collect()
    }

    /// The emergencies that were heard last, oldest first.
    #[must_use]
    pub fn emergencies(&self) -> Vec<LoggedEmergency> {
        self.lock().log.iter().copied().collect()
    }

    /// How often a node was heard to start, and when it last did.
    #[must_use]
    pub fn boots(&self, node: NodeId) -> (u32, Option<Duration>) {
        self.lock().nodes.get(&node).map_or((0, None), |sight| (sight.boots, sight.booted_at))
    }

    /// How long a node's heartbeat has been away, if that is too long: it has told its interval before, and the line was read up
    /// to `now`.
    #[must_use]
    pub fn lost_for(&self, node: NodeId, now: Duration) -> Option<Duration> {
        let heard = self.lock();
        let sight = heard.nodes.get(&node)?;
        let away = now.saturating_sub(sight.last_beat_at?);
        (away > sight.interval? * MISSED_BEATS).then_some(away)
    }

    /// The emergencies that a node has told since the last call.
    #[must_use]
    pub fn take_emergencies(&self, node: NodeId) -> Vec<Emergency> {
        let mut heard = self.lock();
        let (mine, others) = heard.untaken.drain(..).partition(|emergency| emergency.node == node);
        heard.untaken = others;
        mine
    }

    /// Takes note that the bus was listened to until now.
    pub fn listened(&self, now: Duration) {
        self.lock().heard_until = now;
    }

    /// Takes a frame that was heard.
    pub fn hear(&self, frame: &Frame, now: Duration) {
        let mut heard = self.lock();
        heard.heard_until = now;
        if let Some(emergency) = Emergency::read(frame) {
            if heard.untaken.len() < EMERGENCIES {
                heard.untaken.push(emergency);
            }
            heard.log.push_back(LoggedEmergency { at: now, emergency });
            if heard.log.len() > EMERGENCIES {
                heard.log.pop_front();
            }
        } else if let Some((node, state)) = State::read(frame) {
            heard.nodes.entry(node).or_default().hear(state, now);
        }
    }

    fn lock(&self) -> MutexGuard<'_, Heard> {
        // Whoever panicked with the lock left whole entries behind.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Sight {
    fn hear(&mut self, state: State, now: Duration) {
        self.state = Some(state);
        if state == State::BootUp {
            let who = std::mem::take(&mut self.who);
            *self = Self {
                who,
                boots: self.boots + 1,
                booted_at: Some(now),
                state: Some(state),
                ..Self::default()
            };
            return;
        }
        if let Some(last) = self.last_beat_at {
            let between = now.saturating_sub(last);
            // Bytes that waited in a buffer come close together and tell nothing of the interval.
            self.interval = Some(self.interval.unwrap_or_default().max(between));
        }
        self.last_beat_at = Some(now);
    }
}

impl NodeView {
    /// The state in words, with what it means for whoever wants to talk to the node.
    #[must_use]
    pub fn state_text(&self) -> String {
        match self.state {
            Some(State::Stopped) => "stopped: it answers nothing until it is started".to_owned(),
            Some(state) => state.to_string(),
            None => "not told".to_owned(),
        }
    }

    /// Who it is, in words.
    #[must_use]
    pub fn who_text(&self) -> String {
        match &self.who {
            Who::Unknown => "has told nothing of itself".to_owned(),
            Who::Controller(version) => version.clone(),
            Who::Foreign(told) => format!("another device ({told}): never written to"),
            Who::Several => {
                "several devices answer as this node: give each a number of its own; none is written to"
                    .to_owned()
            }
        }
    }

    /// The age of its heartbeat: "0.4 s ago".
    #[must_use]
    pub fn heartbeat_text(&self) -> String {
        self.heartbeat_age_ms
            .map_or_else(|| "none heard".to_owned(), |ms| format!("{:.1} s ago", ms as f64 / 1e3))
    }

    /// Whether starting it by an NMT command makes sense.
    #[must_use]
    pub fn can_be_started(&self) -> bool {
        matches!(self.state, Some(State::Stopped | State::PreOperational | State::BootUp))
            && self.who != Who::Several
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(milliseconds: u64) -> Duration {
        Duration::from_millis(milliseconds)
    }

    const THREE: NodeId = NodeId::new(3).unwrap();

    #[test]
    fn a_heartbeat_that_stays_away_for_three_intervals_is_lost() {
        let monitor = Monitor::default();
        let beat = State::Operational.heartbeat(THREE);
        monitor.hear(&beat, ms(0));
        assert_eq!(monitor.lost_for(THREE, ms(60_000)), None, "one beat tells no interval");
        monitor.hear(&beat, ms(1000));
        assert_eq!(monitor.lost_for(THREE, ms(4000)), None);
        assert_eq!(monitor.lost_for(THREE, ms(4001)), Some(ms(3001)));
    }

    #[test]
    fn a_boot_up_is_counted_and_begins_anew() {
        let monitor = Monitor::default();
        monitor.hear(&State::Operational.heartbeat(THREE), ms(0));
        monitor.hear(&State::Operational.heartbeat(THREE), ms(100));
        monitor.hear(&State::BootUp.heartbeat(THREE), ms(200));
        assert_eq!(monitor.boots(THREE), (1, Some(ms(200))));
        assert_eq!(
            monitor.lost_for(THREE, ms(9000)),
            None,
            "a node that starts has not told its interval yet"
        );
        assert_eq!((monitor.nodes(), monitor.state(THREE)), (vec![THREE], Some(State::BootUp)));
    }

    #[test]
    fn a_view_tells_state_and_age_and_a_stopped_node_can_be_started() {
        let monitor = Monitor::default();
        monitor.hear(&State::Stopped.heartbeat(THREE), ms(100));
        monitor.listened(ms(500));
        let view = &monitor.views()[0];
        assert_eq!(
            (view.state, view.heartbeat_age_ms, view.who.clone()),
            (Some(State::Stopped), Some(400), Who::Unknown)
        );
        assert_eq!(view.heartbeat_text(), "0.4 s ago");
        assert!(view.can_be_started());
        monitor.command(Command::Start, THREE);
        assert_eq!(monitor.take_commands(), [Command::Start.frame(Some(THREE))]);
        assert_eq!(monitor.take_commands(), []);
        monitor.know(THREE, Who::Several);
        assert!(!monitor.views()[0].can_be_started());
    }

    #[test]
    fn only_controllers_that_are_known_may_be_written_to() {
        let monitor = Monitor::default();
        let four = NodeId::new(4).unwrap();
        monitor.know(THREE, Who::Controller("MCP266 v1.0.0".to_owned()));
        monitor.know(four, Who::Foreign("device type 0x00020192".to_owned()));
        monitor.hear(&State::Operational.heartbeat(NodeId::new(5).unwrap()), ms(0));
        assert_eq!(monitor.controllers(), [THREE]);
        monitor.hear(&State::BootUp.heartbeat(THREE), ms(5));
        assert_eq!(monitor.controllers(), [THREE], "a restart does not make it another one");
    }

    #[test]
    fn emergencies_are_kept_for_whoever_takes_them_and_for_the_log() {
        let monitor = Monitor::default();
        let emergency = Emergency { node: THREE, code: 0x8130, register: 0x11, data: [0; 5] };
        monitor.hear(&emergency.frame(), ms(7));
        assert_eq!(monitor.take_emergencies(THREE), [emergency]);
        assert!(monitor.take_emergencies(THREE).is_empty());
        assert_eq!(monitor.emergencies(), [LoggedEmergency { at: ms(7), emergency }]);
        (0..200).for_each(|_| monitor.hear(&emergency.frame(), ms(8)));
        assert_eq!(monitor.emergencies().len(), EMERGENCIES);
    }
}
