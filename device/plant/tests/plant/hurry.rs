//! A served machine whose time goes faster than the wall clock: its client is answered all the same, and whoever waits for something to
//! look at gets real time back.

use crate::support::{PATIENCE, Parrot, eventually, let_turn};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::server::{ChannelEnds, Endpoint, Pace, Server, ServerOptions, SimHandle};
use brushwork_plant::world::{WorldAction, WorldView};
use std::time::{Duration, Instant};

/// A parrot that wants to be looked at from a time on.
struct Wanting {
    inner: Parrot,
    from: Duration,
}

impl Machine for Wanting {
    fn now(&self) -> Duration {
        self.inner.now()
    }

    fn receive(&mut self, stream: StreamIndex, bytes: &[u8]) {
        self.inner.receive(stream, bytes);
    }

    fn advance(&mut self, to: Duration) {
        self.inner.advance(to);
    }

    fn next_output_at(&self) -> Option<Duration> {
        self.inner.next_output_at()
    }

    fn take_output(&mut self, stream: StreamIndex) -> Option<Vec<u8>> {
        self.inner.take_output(stream)
    }

    fn bits_per_second(&self, stream: StreamIndex) -> u32 {
        self.inner.bits_per_second(stream)
    }

    fn units(&self) -> usize {
        self.inner.units()
    }

    fn apply(&mut self, unit: usize, action: &WorldAction) {
        self.inner.apply(unit, action);
    }

    fn views(&self) -> Vec<WorldView> {
        self.inner.views()
    }

    fn plugged(&self) -> bool {
        self.inner.plugged()
    }

    fn wants_real_time(&self) -> bool {
        self.now() >= self.from
    }
}

fn serve(from: Duration) -> SimHandle<Wanting> {
    let machine = Wanting { inner: Parrot::new(), from };
    Server::spawn(machine, ServerOptions::default(), &Endpoint::Channel).expect("channels need nothing")
}

fn now(handle: &SimHandle<Wanting>) -> Duration {
    handle.inspect(|machine| machine.now()).expect("it runs")
}

fn exchange(client: &ChannelEnds, byte: u8) -> Option<Vec<u8>> {
    client.to_controller.send(vec![0x80, byte]).ok()?;
    client.from_controller.recv_timeout(PATIENCE).ok()
}

#[test]
fn at_ten_times_the_pace_a_machine_is_ahead_of_the_wall_clock_and_answers() {
    let handle = serve(Duration::MAX);
    let client = handle.new_channel().expect("it is plugged in");
    assert_eq!(handle.pace(), Pace::REAL);
    handle.set_pace(Pace::TEN);
    // A thread that has no processor for long skips time, so that not every stretch shows the pace; none is faster.
    let is_ahead = || {
        let (began, begun_at) = (Instant::now(), now(&handle));
        for byte in 1..=20 {
            assert_eq!(exchange(&client, byte), Some(vec![byte; 4]));
            std::thread::sleep(Duration::from_millis(5));
        }
        let (passed, took) = (now(&handle) - begun_at, began.elapsed());
        assert!(passed <= took * 10, "{passed:?} in {took:?}");
        passed > took * 5
    };
    assert!(eventually(is_ahead));
    handle.set_pace(Pace::REAL);
    let_turn(&handle);
    let (began, begun_at) = (Instant::now(), now(&handle));
    std::thread::sleep(Duration::from_millis(100));
    assert!(now(&handle) - begun_at <= began.elapsed());
}

#[test]
fn at_full_speed_a_client_is_answered_and_the_machine_stops_hurrying_where_it_wants_to_be_seen() {
    let from = Duration::from_secs(3600);
    let handle = serve(from);
    let client = handle.new_channel().expect("it is plugged in");
    let began = Instant::now();
    handle.set_pace(Pace::Max);
    assert_eq!(exchange(&client, 5), Some(vec![5; 4]));
    while handle.pace() == Pace::Max {
        assert_eq!(exchange(&client, 9), Some(vec![9; 4]));
        assert!(began.elapsed() < PATIENCE, "{:?} of its time has passed", now(&handle));
    }
    let passed = now(&handle);
    assert!(passed >= from && passed < from + PATIENCE, "{passed:?}");
    assert_eq!(exchange(&client, 7), Some(vec![7; 4]));
}

#[test]
fn what_is_posted_is_done_without_anybody_waiting() {
    let handle = serve(Duration::MAX);
    let (sender, done) = std::sync::mpsc::sync_channel(1);
    handle.post(move |machine| sender.send(machine.now()).expect("somebody waits")).expect("it runs");
    assert!(done.recv_timeout(PATIENCE).is_ok());
}
