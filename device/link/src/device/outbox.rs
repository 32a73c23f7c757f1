//! Events on their way to the window. The thread never waits for it: what it does not take in time is thrown away, the
//! oldest readings first, and everything that matters is kept.

use super::event::Event;
use super::handle::Waker;
use crossbeam_channel::{Sender, TrySendError};
use std::collections::VecDeque;

/// How many events wait behind a full channel.
const BACKLOG: usize = 4096;

/// The thread's end of the event channel.
pub struct Outbox {
    channel: Sender<Event>,
    backlog: VecDeque<Event>,
    waker: Waker,
    fresh: bool,
    dropped_samples: u64,
}

impl Outbox {
    /// Sends into `channel`.
    pub fn new(channel: Sender<Event>, waker: Waker) -> Self {
        Self { channel, backlog: VecDeque::new(), waker, fresh: false, dropped_samples: 0 }
    }

    /// Hands an event over, or puts it behind those that wait.
    pub fn send(&mut self, event: Event) {
        self.fresh = true;
        self.backlog.push_back(event);
        self.flush();
        if self.backlog.len() > BACKLOG {
            self.make_room();
        }
    }

    /// Hands over as many waiting events as the channel takes.
    pub fn flush(&mut self) {
        while let Some(event) = self.backlog.pop_front() {
            match self.channel.try_send(event) {
                Ok(()) => {}
                Err(TrySendError::Full(event)) => {
                    self.backlog.push_front(event);
                    return;
                }
                Err(TrySendError::Disconnected(_)) => {
                    // Nobody will take events any more; the handle closes the link as it goes.
                    self.backlog.clear();
                }
            }
        }
    }

    /// Calls the window if there is anything new for it.
    pub fn wake_window(&mut self) {
        if !std::mem::take(&mut self.fresh) {
            return;
        }
        let waker = self.waker.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(wake) = waker.as_ref() {
            wake();
        }
    }

    /// Whether events wait for room.
    pub fn is_waiting(&self) -> bool {
        !self.backlog.is_empty()
    }

    /// Samples thrown away since the link was opened.
    pub fn dropped_samples(&self) -> u64 {
        self.dropped_samples
    }

    /// Throws away the oldest event that can be missed; if there is none, the oldest of all.
    fn make_room(&mut self) {
        let index = self.backlog.iter().position(can_be_missed).unwrap_or(0);
        if matches!(self.backlog.remove(index), Some(Event::Sample(_))) {
            self.dropped_samples += 1;
        }
    }
}

/// Whether a later event of the same kind makes up for it.
fn can_be_missed(event: &Event) -> bool {
    matches!(
        event,
        Event::Sample(_)
            | Event::Traffic { .. }
            | Event::Link(_)
            | Event::Searching { .. }
            | Event::Status(_)
            | Event::JobProgress { .. }
    )
}

#[cfg(test)]
mod tests {
    use super::super::channel::Sample;
    use super::super::event::DisarmReason;
    use super::*;
    use crossbeam_channel::{Receiver, bounded};
    use std::sync::{Arc, Mutex};

    fn outbox(capacity: usize) -> (Outbox, Receiver<Event>) {
        let (sender, receiver) = bounded(capacity);
        (Outbox::new(sender, Arc::new(Mutex::new(None))), receiver)
    }

    fn sample(sequence: u64) -> Event {
        let mut sample = Sample::new(0x80);
        sample.sequence = sequence;
        Event::Sample(Box::new(sample))
    }

    #[test]
    fn a_window_that_takes_nothing_costs_the_oldest_waiting_samples_and_nothing_else() {
        let (mut outbox, receiver) = outbox(8);
        outbox.send(Event::Disarmed(DisarmReason::DeadMan));
        let sent = BACKLOG as u64 + 1000;
        for sequence in 0..sent {
            outbox.send(sample(sequence));
            if sequence == 50 {
                outbox.send(Event::Disarmed(DisarmReason::Stop));
            }
        }
        let mut sequences = Vec::new();
        let mut disarms = 0;
        loop {
            outbox.flush();
            let Ok(event) = receiver.try_recv() else { break };
            match event {
                Event::Sample(sample) => sequences.push(sample.sequence),
                Event::Disarmed(_) => disarms += 1,
                _ => unreachable!("nothing else was sent"),
            }
        }
        assert_eq!(disarms, 2);
        assert_eq!(sequences.last(), Some(&(sent - 1)), "the newest are kept");
        assert!(sequences.is_sorted());
        assert_eq!(outbox.dropped_samples() + sequences.len() as u64, sent);
        assert!(outbox.dropped_samples() > 900);
    }

    #[test]
    fn nothing_is_kept_for_a_window_that_is_gone() {
        let (mut outbox, receiver) = outbox(1);
        drop(receiver);
        outbox.send(sample(0));
        assert!(!outbox.is_waiting());
    }
}
