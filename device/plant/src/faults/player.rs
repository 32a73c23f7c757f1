//! Plays a fault script on a machine.

use super::fault::{Direction, Fault, FaultEffect};
use crate::machine::{Machine, StreamIndex, passed_on};
use crate::world::WorldAction;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::collections::VecDeque;
use std::time::Duration;

/// A machine with faults.
#[derive(Debug)]
pub struct Faulty<M> {
    inner: M,
    wire: Wire,
    /// Things to do to the worlds, in order of time.
    deeds: VecDeque<Deed>,
    to_controller: [Lane; StreamIndex::ALL.len()],
    to_host: [Lane; StreamIndex::ALL.len()],
}

/// The faults of the wire and the dice they are thrown with.
#[derive(Debug)]
struct Wire {
    faults: Vec<Fault>,
    dice: ChaCha8Rng,
}

/// Pieces of traffic on their way, each with the time it arrives.
type Lane = VecDeque<(Duration, Vec<u8>)>;

#[derive(Debug)]
struct Deed {
    at: Duration,
    unit: usize,
    act: Act,
}

#[derive(Debug)]
enum Act {
    Begin { actions: Vec<WorldAction>, until: Option<Duration> },
    End { undo: Vec<WorldAction> },
}

impl<M: Machine> Faulty<M> {
    /// The machine with these faults; the seed decides which bytes they meet.
    pub fn new(inner: M, faults: Vec<Fault>, seed: u64) -> Self {
        let (worlds, wire): (Vec<_>, Vec<_>) =
            faults.into_iter().partition(|fault| matches!(fault.effect, FaultEffect::World(_)));
        let mut deeds: Vec<Deed> = worlds.into_iter().filter_map(Deed::of).collect();
        deeds.sort_by_key(|deed| deed.at);
        let mut faulty = Self {
            inner,
            wire: Wire { faults: wire, dice: ChaCha8Rng::seed_from_u64(seed) },
            deeds: deeds.into(),
            to_controller: Default::default(),
            to_host: Default::default(),
        };
        faulty.exchange();
        faulty
    }

    /// The machine without its faults.
    pub fn inner_mut(&mut self) -> &mut M {
        &mut self.inner
    }

    fn next_event(&self) -> Option<Duration> {
        let now = self.inner.now();
        let requests = self.to_controller.iter().filter_map(|lane| lane.front().map(|(at, _)| *at));
        let deeds = self.deeds.front().map(|deed| deed.at);
        let outputs = self.inner.next_output_at().filter(|at| *at > now);
        requests.chain(deeds).chain(outputs).min()
    }

    /// Does what is due now: deeds, arrivals, and the way of what the machine says.
    fn exchange(&mut self) {
        let now = self.inner.now();
        while let Some(deed) = self.deeds.pop_front_if(|deed| deed.at <= now) {
            self.act(deed);
        }
        for stream in StreamIndex::ALL {
            let lane = &mut self.to_controller[stream.index()];
            while let Some((_, bytes)) = lane.pop_front_if(|(at, _)| *at <= now) {
                self.inner.receive(stream, &bytes);
            }
            while let Some(reply) = self.inner.take_output(stream) {
                if self.inner.plugged() {
                    let lane = &mut self.to_host[stream.index()];
                    self.wire.send(lane, &reply, Direction::ToHost, now);
                }
            }
        }
    }

    fn act(&mut self, deed: Deed) {
        match deed.act {
            Act::Begin { actions, until } => {
                let mut undo = Vec::new();
                for action in actions {
                    undo.extend(self.inner.views().get(deed.unit).and_then(|view| action.undo(view)));
                    self.inner.apply(deed.unit, &action);
                }
                undo.reverse();
                if let Some(at) = until {
                    let place = self.deeds.partition_point(|later| later.at <= at);
                    self.deeds.insert(place, Deed { at, unit: deed.unit, act: Act::End { undo } });
                }
            }
            Act::End { undo } => undo.iter().for_each(|action| self.inner.apply(deed.unit, action)),
        }
    }
}

impl<M: Machine> Machine for Faulty<M> {
    fn now(&self) -> Duration {
        self.inner.now()
    }

    fn receive(&mut self, stream: StreamIndex, bytes: &[u8]) {
        if !self.inner.plugged() {
            return;
        }
        let now = self.inner.now();
        let lane = &mut self.to_controller[stream.index()];
        self.wire.send(lane, bytes, Direction::ToController, now);
        self.exchange();
    }

    fn advance(&mut self, to: Duration) {
        self.exchange();
        while let Some(at) = self.next_event().filter(|at| *at <= to) {
            self.inner.advance(at);
            self.exchange();
        }
        self.inner.advance(to);
        self.exchange();
    }

    fn next_output_at(&self) -> Option<Duration> {
        let replies = self.to_host.iter().filter_map(|lane| lane.front().map(|(at, _)| *at));
        // What the machine says at this very moment is taken up by the next `advance`.
        replies.chain(self.next_event()).chain(self.inner.next_output_at()).min()
    }

    fn take_output(&mut self, stream: StreamIndex) -> Option<Vec<u8>> {
        self.exchange();
        let now = self.inner.now();
        self.to_host[stream.index()].pop_front_if(|(at, _)| *at <= now).map(|(_, bytes)| bytes)
    }

    passed_on!();
}

impl Wire {
    /// Puts `bytes` on a lane, less what the faults take and plus what they add. Bytes that arrive together stay together.
    fn send(&mut self, lane: &mut Lane, bytes: &[u8], to: Direction, now: Duration) {
        let mut latest = lane.back().map_or(now, |(at, _)| now.max(*at));
        let mut piece = Vec::with_capacity(bytes.len());
        for &sent in bytes {
            let Some(hit) = self.hit(sent, to, now) else { continue };
            let arrives = latest.max(now + hit.late_by);
            if arrives > latest && !piece.is_empty() {
                lane.push_back((latest, std::mem::take(&mut piece)));
            }
            latest = arrives;
            piece.push(hit.byte);
            if hit.twice {
                piece.push(hit.byte);
            }
        }
        if !piece.is_empty() {
            lane.push_back((latest, piece));
        }
    }

    /// What becomes of one byte; none when it is lost.
    fn hit(&mut self, sent: u8, to: Direction, now: Duration) -> Option<Hit> {
        let Self { faults, dice } = self;
        let mut hit = Hit { byte: sent, twice: false, late_by: Duration::ZERO };
        let mut lost = false;
        for fault in faults.iter().filter(|fault| fault.acts_at(now) && fault.direction.meets(to)) {
            match fault.effect {
                FaultEffect::Drop { share } => lost |= falls(dice, share),
                FaultEffect::Corrupt { share } if falls(dice, share) => {
                    hit.byte ^= 1 << (dice.next_u32() % 8);
                }
                FaultEffect::Duplicate { share } => hit.twice |= falls(dice, share),
                FaultEffect::Delay { by, share } if falls(dice, share) => hit.late_by += by,
                FaultEffect::Mute => lost = true,
                FaultEffect::Corrupt { .. } | FaultEffect::Delay { .. } | FaultEffect::World(_) => {}
            }
        }
        (!lost).then_some(hit)
    }
}

/// A byte that got through.
struct Hit {
    byte: u8,
    twice: bool,
    late_by: Duration,
}

impl Deed {
    fn of(fault: Fault) -> Option<Self> {
        let FaultEffect::World(actions) = fault.effect else { return None };
        Some(Self { at: fault.from, unit: fault.unit, act: Act::Begin { actions, until: fault.until } })
    }
}

/// Throws the dice once: true for this share of the throws.
fn falls(dice: &mut ChaCha8Rng, share: f64) -> bool {
    f64::from(dice.next_u32()) < share * 4_294_967_296.0
}
