//! How quickly Stop reaches the wire and how full the wire is, in real time over a pseudo-terminal.
//!
//! The figures are printed always. Those that other work on the machine can spoil are judged only where it has a core to spare.
#![cfg(unix)]
#![expect(clippy::print_stdout, reason = "measured times belong into the record of a test run")]

use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use brushwork_link::device::{
    Addresses, DeviceHandle, DeviceOptions, DeviceThread, Event, PollRate, Request,
};
use brushwork_link::transport::SerialTransport;
use brushwork_link::{Clock, LinkStatistics, Stream, SystemClock, Transport, TransportError};
use brushwork_protocol::packet_serial::number;
use brushwork_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_sim::machine::StreamIndex;
use brushwork_sim::server::{Endpoint, Server, ServerOptions, SimHandle};
use tempfile::TempDir;

const STOPS: usize = 100;
/// What the project promises for the 99th percentile.
const STOP_LIMIT: Duration = Duration::from_millis(10);
const BITS_PER_BYTE: f64 = 10.0;
const RATE_BPS: f64 = 115_200.0;

type Times = Arc<Mutex<Vec<Duration>>>;

/// A transport that notes when a stop left the program.
struct Spy {
    inner: SerialTransport,
    clock: Arc<dyn Clock>,
    stops: Times,
}

impl Transport for Spy {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        self.inner.write(bytes)?;
        // The first write of a Stop begins with the end of scripts.
        if bytes.get(1) == Some(&number::STOP_SCRIPT) && bytes.len() > 4 {
            self.stops.lock().expect("nothing panics with it").push(self.clock.now());
        }
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        self.inner.read(buffer, timeout)
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        self.inner.discard_input()
    }

    fn describe(&self) -> String {
        self.inner.describe()
    }

    fn byte_time(&self) -> Option<Duration> {
        self.inner.byte_time()
    }
}

/// A device thread on a simulated controller on a pseudo-terminal.
struct Bench {
    handle: DeviceHandle,
    stops: Times,
    clock: Arc<dyn Clock>,
    turnaround: Duration,
    _simulator: SimHandle<Bus>,
    _folder: TempDir,
}

impl Bench {
    /// On RS-232 bytes take their time at 115200 baud; on USB they take none.
    fn start(index: StreamIndex, stream: Stream) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let link = folder.path().join("controller");
        let controller = Controller::new(ControllerConfig::default()).expect("the presets make a controller");
        let turnaround = controller.turnaround(index);
        let options =
            ServerOptions { stream: index, pace: index != StreamIndex::Usb, ..ServerOptions::default() };
        let endpoint = Endpoint::Pty { link: link.clone() };
        let simulator = Server::spawn(Bus::single(controller, index), options, &endpoint)
            .expect("the system has a pseudo-terminal to give");
        let clock = SystemClock::shared();
        let inner =
            SerialTransport::open(&link.to_string_lossy(), RATE_BPS as u32).expect("the terminal is there");
        let stops = Times::default();
        let spy = Spy { inner, clock: Arc::clone(&clock), stops: Arc::clone(&stops) };
        let options = DeviceOptions {
            addresses: Addresses::Only(0x80),
            stream: Some(stream),
            poll: PollRate::Fastest,
            ..DeviceOptions::default()
        };
        let handle = DeviceThread::spawn(Box::new(spy), Arc::clone(&clock), options)
            .expect("the system gives a thread");
        let bench = Self { handle, stops, clock, turnaround, _simulator: simulator, _folder: folder };
        bench.wait_for(|event| matches!(event, Event::Selected { .. }));
        bench
    }

    fn wait_for(&self, is_it: impl Fn(&Event) -> bool) -> Event {
        let end = Instant::now() + Duration::from_secs(10);
        while Instant::now() < end {
            match self.handle.events().recv_timeout(Duration::from_millis(100)) {
                Ok(event) if is_it(&event) => return event,
                _ => {}
            }
        }
        panic!("it was not told within ten seconds")
    }

    /// Presses Stop again and again, each time after `prepare` and a wait that differs; the times until the bytes had left.
    fn stop_latencies(&self, prepare: impl Fn(&DeviceHandle)) -> Vec<Duration> {
        let mut latencies = Vec::new();
        for press in 0..STOPS {
            prepare(&self.handle);
            std::thread::sleep(Duration::from_micros(2_000 + 731 * (press as u64 % 17)));
            let pressed_at = self.clock.now();
            self.handle.stop_all();
            let Event::Stopped(report) = self.wait_for(|event| matches!(event, Event::Stopped(_))) else {
                unreachable!("it was waited for")
            };
            assert!(report.confirmed(), "{report:?}");
            let left_at = self.stops.lock().expect("nothing panics with it").pop();
            latencies.push(left_at.expect("a stop was written") - pressed_at);
        }
        latencies.sort();
        latencies
    }

    /// The figures of the last seconds while only signals are read.
    fn figures(&self) -> LinkStatistics {
        let end = Instant::now() + Duration::from_secs(5);
        let mut figures = LinkStatistics::default();
        while Instant::now() < end {
            if let Ok(Event::Link(statistics)) = self.handle.events().recv_timeout(Duration::from_millis(100))
            {
                figures = statistics;
            }
        }
        figures
    }
}

/// Whether this machine has a core to spare, so that times can be judged.
fn is_quiet() -> bool {
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    let load: f64 = load.split(' ').next().and_then(|load| load.parse().ok()).unwrap_or(0.0);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    load / (cores as f64) < 1.0
}

fn judge(what: &str, latencies: &[Duration]) {
    let (median, worst) = (latencies[latencies.len() / 2], latencies[latencies.len() - 1]);
    let p99 = latencies[latencies.len() * 99 / 100 - 1];
    println!("{what}: stop bytes left after {median:?} (median), {p99:?} (99 %), {worst:?} (longest)");
    assert!(median < STOP_LIMIT, "{what}: median {median:?}");
    assert!(!is_quiet() || p99 < STOP_LIMIT, "{what}: 99th percentile {p99:?}");
}

#[test]
fn stop_leaves_within_ten_milliseconds_while_everything_is_read_at_full_speed() {
    let usb = Bench::start(StreamIndex::Usb, Stream::Usb);
    judge("USB, full speed", &usb.stop_latencies(|_| ()));
    let rs232 = Bench::start(StreamIndex::Uart0, Stream::Rs232);
    judge("115200 baud, full speed", &rs232.stop_latencies(|_| ()));
}

#[test]
fn stop_leaves_within_ten_milliseconds_in_the_middle_of_the_longest_reply() {
    let bench = Bench::start(StreamIndex::Uart0, Stream::Rs232);
    let latencies = bench.stop_latencies(|handle| {
        let read = Request::Transact { id: 1, command: number::READ_SIGNALS, values: Vec::new() };
        handle.request(read).expect("the queue has room");
    });
    judge("115200 baud, long reply", &latencies);
}

#[test]
fn at_115200_baud_the_wire_is_in_use_nine_tenths_of_the_time() {
    let bench = Bench::start(StreamIndex::Uart0, Stream::Rs232);
    let figures = bench.figures();
    let bytes_share = figures.kbit_per_s * 1_000.0 / (RATE_BPS * BITS_PER_BYTE / 10.0);
    let waiting_share = figures.transactions_per_s * bench.turnaround.as_secs_f64();
    let share = bytes_share + waiting_share;
    println!(
        "115200 baud: {:.1} kbit/s, {:.0} transactions/s, bytes {bytes_share:.3} + turnaround {waiting_share:.3} = {share:.3} \
         of the time; round trip {:.2} ms median, {:.2} ms 99 %",
        figures.kbit_per_s,
        figures.transactions_per_s,
        figures.round_trip_median_s * 1e3,
        figures.round_trip_p99_s * 1e3,
    );
    assert!(share < 1.02, "more than the wire can carry: {share}");
    assert!(!is_quiet() || share > 0.9, "{share}");
    assert_eq!((figures.timeouts, figures.crc_errors), (0, 0));
}
