//! Tuning somebody else's controller: no currents, silence on optional commands, old widths, another tick, slow replies. A run ends with
//! gains or with an honest refusal, never in a hang, and the motor stands then with the old gains in force.

use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;

use brushwork_core::keep::TrialKeeper;
use brushwork_core::tune::law::{Report, Request as Tuning, Setup};
use brushwork_core::tune::live::Live;
use brushwork_core::tune::{Slot, Target, leaves_off, prepare, restore, run, take};
use brushwork_link::device::{
    Addresses, ArmScope, DeviceHandle, DeviceLoop, DeviceOptions, Event, Identity, Job, JobEnding, Request,
    Step,
};
use brushwork_link::settings::Keeper;
use brushwork_link::{Clock, Transport, TransportError, VirtualClock};
use brushwork_mcp_wire::models;
use brushwork_tests::other_controller::{Manner, Motor, OtherController};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::{Excitation, Method};
use brushwork_values::Motor as Channel;

const TARGET: Target = Target { motor: Channel::M1, encoder: None, stream: None };

fn s(seconds: u64) -> Duration {
    Duration::from_secs(seconds)
}

/// The cable to the controller, in virtual time; a living window renews motion with every read.
#[derive(Clone)]
struct Cable {
    unit: Arc<Mutex<OtherController>>,
    clock: VirtualClock,
    handle: Arc<Mutex<Option<Arc<DeviceHandle>>>>,
}

impl Cable {
    fn unit(&self) -> MutexGuard<'_, OtherController> {
        let mut unit = self.unit.lock().expect("no test panics with it");
        unit.advance(self.clock.now());
        unit
    }
}

impl Transport for Cable {
    fn write(&mut self, bytes: &[u8]) -> Result<(), TransportError> {
        self.unit().receive(bytes);
        Ok(())
    }

    fn read(&mut self, buffer: &mut [u8], timeout: Duration) -> Result<usize, TransportError> {
        if let Some(handle) = self.handle.lock().expect("no test panics with it").as_ref() {
            handle.renew();
        }
        let until = self.clock.now() + timeout;
        loop {
            let mut unit = self.unit();
            if let Some(bytes) = unit.take_output() {
                let count = bytes.len().min(buffer.len());
                buffer[..count].copy_from_slice(&bytes[..count]);
                return Ok(count);
            }
            let next = unit.next_output_at().map_or(until, |at| at.min(until));
            drop(unit);
            if self.clock.now() >= until {
                return Ok(0);
            }
            self.clock.advance_to(next);
        }
    }

    fn discard_input(&mut self) -> Result<usize, TransportError> {
        let mut unit = self.unit();
        Ok(std::iter::from_fn(|| unit.take_output()).map(|bytes| bytes.len()).sum())
    }

    fn describe(&self) -> String {
        "the other controller".to_owned()
    }

    fn byte_time(&self) -> Option<Duration> {
        None
    }
}

/// The device thread's loop on that cable.
struct Link {
    cable: Cable,
    handle: Arc<DeviceHandle>,
    device_loop: DeviceLoop,
    events: Vec<Event>,
}

impl Link {
    fn new(manner: Manner, motor: Motor) -> Self {
        brushwork::install();
        let cable = Cable {
            unit: Arc::new(Mutex::new(OtherController::new(manner, motor))),
            clock: VirtualClock::new(),
            handle: Arc::default(),
        };
        let options = DeviceOptions { addresses: Addresses::Only(0x80), ..DeviceOptions::default() };
        let clock: Arc<dyn Clock> = Arc::new(cable.clock.clone());
        let (device_loop, handle) = DeviceLoop::new(Box::new(cable.clone()), clock, options);
        let handle = Arc::new(handle);
        *cable.handle.lock().expect("no test panics with it") = Some(Arc::clone(&handle));
        Self { cable, handle, device_loop, events: Vec::new() }
    }

    /// Turns the loop until an event comes of which `pick` makes something, for so long at most.
    fn until<T>(&mut self, longest: Duration, mut pick: impl FnMut(&Event) -> Option<T>) -> Option<T> {
        let end = self.cable.clock.now() + longest;
        while self.cable.clock.now() < end {
            self.handle.renew();
            let step = self.device_loop.step();
            for event in self.handle.events().try_iter().collect::<Vec<_>>() {
                let picked = pick(&event);
                self.events.push(event);
                if picked.is_some() {
                    return picked;
                }
            }
            match step {
                Step::Again => {}
                Step::IdleUntil(at) => {
                    self.cable.clock.advance_to(at.min(self.cable.clock.now() + s(1) / 50));
                }
                Step::Ended => return None,
            }
        }
        None
    }

    fn connect(&mut self) -> Option<Identity> {
        self.until(s(20), |event| match event {
            Event::Connected(identity) => Some(identity.clone()),
            _ => None,
        })
    }

    fn job<T: Send + 'static>(&mut self, job: Job<T>) -> Option<JobEnding<T>> {
        let ticket = self.handle.start(job).expect("the queue has room");
        let events = self.events.len();
        let ended = self.until(s(400), |event| matches!(event, Event::JobEnded(_)).then_some(()));
        ended?;
        let at = self.events[events..].iter().position(|event| matches!(event, Event::JobEnded(_)))?;
        match self.events.remove(events + at) {
            Event::JobEnded(report) => Some(ticket.ending(report.ending)),
            _ => None,
        }
    }

    fn arm(&mut self) -> bool {
        self.handle.request(Request::Arm(ArmScope::CommandLine)).expect("the queue has room");
        self.until(s(10), |event| match event {
            Event::Armed { .. } => Some(true),
            Event::ArmRefused { .. } => Some(false),
            _ => None,
        })
        .unwrap_or(false)
    }
}

/// Keeps nothing.
struct Forgetful;

impl Keeper for Forgetful {
    fn begin(&mut self, _entry: brushwork_link::settings::Entry) {}

    fn begun(&mut self) -> Option<Result<(), brushwork_link::Failure>> {
        Some(Ok(()))
    }

    fn end(&mut self, _ending: brushwork_link::settings::Ending) {}
}

/// Connects, tunes as the program does, and checks what must hold at the end of any run.
fn tuned(manner: Manner, motor: Motor, request: Tuning) -> Report {
    let place = format!("{manner:?} {:?}", request.method);
    let mut link = Link::new(manner, motor);
    let identity = link.connect().unwrap_or_else(|| panic!("{place}: {:?}", link.events));
    let generation = identity.generation;
    let subject = brushwork_mcp_client::subject(
        models::identify(&identity.version_text).expect("it is a RoboClaw"),
        brushwork_mcp_client::layout_of(generation),
    );
    let held = |link: &Link| {
        let unit = link.cable.unit();
        (unit.velocity, unit.position, unit.timeout_raw)
    };
    let before = held(&link);
    let keeper = TrialKeeper::new(Box::new(Forgetful));
    let setup: Slot<Setup> = Slot::default();
    let prepared = link.job(prepare(TARGET, subject, &setup, &keeper));
    assert!(matches!(prepared, Some(JobEnding::Done(_))), "{place}: {prepared:?}");
    let old = take(&setup).expect("it was read");
    assert!(link.arm(), "{place}: {:?}", link.events);
    let found: Slot<Report> = Slot::default();
    let ending =
        link.job(run(Target { encoder: Some(old.encoder), ..TARGET }, request, &found, &Live::default()));
    assert!(ending.is_some(), "{place}: the run hangs");
    let report = take(&found).unwrap_or_else(|| panic!("{place}: {ending:?}"));
    // From full duty to none at the highest acceleration takes 50 ms.
    link.cable.clock.advance_to(link.cable.clock.now() + s(6) / 100);
    assert_eq!(link.cable.unit().duty, 0.0, "{place}: the motor is off at the end");
    let restored = link.job(restore(TARGET, old, Some(&report), leaves_off(Some(&report), None), &keeper));
    assert!(matches!(restored, Some(JobEnding::Done(_))), "{place}: {restored:?}");
    assert_eq!(held(&link), before, "{place}: the old gains are in force");
    assert!(report.replay().is_some_and(|again| again == report), "{place}: the replay differs");
    report
}

fn manners() -> Vec<(&'static str, Manner)> {
    // L and R, current limits, battery limits, duty, time-out of streams, encoder modes, scripts.
    let optional = vec![130, 131, 132, 135, 136, 59, 60, 99, 91, 144, 146, 139, 249, 47];
    let usual = Manner::default();
    vec![
        ("as the tuner likes it", usual.clone()),
        ("currents of 0", Manner { tells_current: false, ..usual.clone() }),
        ("no currents", Manner { silent: vec![49], ..usual.clone() }),
        ("no optional command", Manner { silent: optional.clone(), ..usual.clone() }),
        ("no status", Manner { tells_status: false, silent: vec![90], ..usual.clone() }),
        ("no duty, no battery", Manner { silent: vec![48, 24], ..usual.clone() }),
        ("each encoder by itself", Manner { silent: vec![78, 79], ..usual.clone() }),
        ("generation 2", Manner { generation: 2, ..usual.clone() }),
        ("generation 3", Manner { generation: 3, ..usual.clone() }),
        ("generation 4", Manner { generation: 4, ..usual.clone() }),
        ("sums by seconds", Manner { sums_ticks: false, ..usual.clone() }),
        ("625 ticks a second", Manner { tick_hz: 625.0, ..usual.clone() }),
        ("450 ticks a second", Manner { tick_hz: 450.0, ..usual.clone() }),
        ("no feed-forward", Manner { feed_forward: 0.0, ..usual.clone() }),
        ("no ramp of the duty", Manner { is_abrupt: true, ..usual.clone() }),
        ("clipped speeds", Manner { speed_clip: Some(900), ..usual.clone() }),
        ("slow replies", Manner { delay: Duration::from_millis(18), ..usual.clone() }),
        ("replies get lost", Manner { loses_one_in: 37, ..usual.clone() }),
        (
            "nothing but the least",
            Manner {
                tells_status: false,
                silent: [optional, vec![24, 48, 49, 78, 79, 90]].concat(),
                delay: Duration::from_millis(6),
                loses_one_in: 61,
                ..usual
            },
        ),
    ]
}

/// What a run in each manner must come to: gains, or this cause.
fn refusal_of(name: &str, method: Method) -> Option<Cause> {
    match (name, method) {
        // Without it, and without velocity gains, its position loop gives no duty at all.
        ("no feed-forward", Method::Pd) => Some(Cause::NoDirectLoop),
        _ => None,
    }
}

#[test]
fn every_manner_of_controller_ends_in_gains_or_in_an_honest_refusal() {
    for (n, (name, manner)) in manners().into_iter().enumerate() {
        let position = if n % 2 == 0 { Method::Pd } else { Method::Piv };
        for method in [Method::Velocity, position] {
            let report = tuned(manner.clone(), Motor::default(), Tuning { method, ..Tuning::default() });
            println!(
                "{name}, {method:?}: {:?} {:?} {:.1} s",
                report.verdict, report.causes, report.seconds.1
            );
            match refusal_of(name, method) {
                Some(cause) => assert_eq!(report.causes.first(), Some(&cause), "{name}, {method:?}"),
                None => {
                    assert_ne!(report.verdict, Verdict::Refused, "{name}, {method:?}: {:?}", report.causes);
                    let is_assumed = report.causes.contains(&Cause::LawAssumed);
                    // The law is read off the duties that it gives (command 48).
                    let tells_no_duty = manner.silent.contains(&48);
                    assert_eq!(is_assumed, tells_no_duty, "{name}, {method:?}: {:?}", report.causes);
                }
            }
        }
    }
}

/// What I sums over says nothing of what D takes differences of, nor how much of a setpoint is fed forward.
#[test]
fn the_position_loop_of_another_controller_is_measured_and_not_guessed() {
    let usual = Manner::default();
    let cases = [
        (Method::Pd, Manner { sums_ticks: false, ..usual.clone() }),
        (Method::Pd, Manner { derives_ticks: false, ..usual.clone() }),
        (Method::Pd, Manner { sums_ticks: false, derives_ticks: false, tick_hz: 625.0, ..usual.clone() }),
        (Method::Pid, Manner { derivative_filter_s: 0.010, ..usual.clone() }),
        (Method::Piv, Manner { feed_forward: 0.0, ..usual.clone() }),
        (Method::Piv, Manner { feed_forward: 0.5, ..usual.clone() }),
    ];
    for (method, manner) in cases {
        let report = tuned(manner.clone(), Motor::default(), Tuning { method, ..Tuning::default() });
        let case = format!("{method:?} {manner:?}: {:?} {:?}", report.verdict, report.causes);
        println!("{case}");
        assert_ne!(report.verdict, Verdict::Refused, "{case}");
        let law = report.request.law.first.first;
        assert!((law.position_scale / 1024.0 - 1.0).abs() < 0.04, "{law:?} {case}");
        assert!((law.feed_forward - manner.feed_forward).abs() < 0.04, "{law:?} {case}");
        let of_d_s = if manner.derives_ticks { 1.0 / manner.tick_hz } else { 1.0 };
        let is_asked = method != Method::Piv;
        assert_eq!(law.derivative_filter.is_some(), manner.derivative_filter_s > 0.0, "{law:?} {case}");
        if let Some(filter) = law.derivative_filter {
            let of_it = manner.derivative_filter_s;
            assert!(filter.least_s > 0.3 * of_it && filter.least_s < of_it, "{filter:?} {case}");
            assert!(filter.likely_s > 0.5 * of_it && filter.likely_s < 1.5 * of_it, "{filter:?} {case}");
        }
        assert!(!is_asked || (law.derivative_s() / of_d_s - 1.0).abs() < 0.04, "{law:?} {case}");
    }
}

#[test]
fn the_motor_of_another_controller_is_measured_as_it_is() {
    for motor in [
        Motor::default(),
        Motor { gain: 900.0, tau_s: 0.03, friction: 0.08, ..Motor::default() },
        Motor { gain: 48_000.0, tau_s: 0.35, friction: 0.02, ..Motor::default() },
    ] {
        let report = tuned(Manner::default(), motor, Tuning::default());
        let place = format!("{motor:?}: {:?}", report.causes);
        let (qpps, fit) = (report.qpps.expect(&place), report.fit.expect(&place));
        let full = motor.gain * (1.0 - motor.friction);
        assert!((qpps / full - 1.0).abs() < 0.015, "{place}: QPPS {qpps} of {full}");
        assert!((fit.model.tau_s / motor.tau_s).ln().abs() < 0.15, "{place}: {} s", fit.model.tau_s);
    }
}

#[test]
fn what_is_wrong_is_refused_also_where_no_current_is_told() {
    let silent = Manner { silent: vec![49], ..Manner::default() };
    let zero = Manner { tells_current: false, ..Manner::default() };
    for (name, manner, motor, cause) in [
        ("reversed", silent.clone(), Motor { reversed: true, ..Motor::default() }, Cause::EncoderReversed),
        (
            "reversed, currents of 0",
            zero.clone(),
            Motor { reversed: true, ..Motor::default() },
            Cause::EncoderReversed,
        ),
        ("held, no currents", silent, Motor { held: true, ..Motor::default() }, Cause::NothingCounted),
        ("held, currents of 0", zero, Motor { held: true, ..Motor::default() }, Cause::MotorOpen),
        ("held", Manner::default(), Motor { held: true, ..Motor::default() }, Cause::ShaftLocked),
        ("end stops", Manner::default(), Motor { end_stop: 700.0, ..Motor::default() }, Cause::Stalled),
    ] {
        let report = tuned(manner, motor, Tuning::default());
        assert_eq!(report.causes.first(), Some(&cause), "{name}: {:?}", report.causes);
        assert!(report.seconds.1 < 3.0, "{name}: {} s", report.seconds.1);
    }
}

#[test]
fn a_command_that_is_not_known_ends_in_a_refusal_and_not_in_a_lost_link() {
    for (command, method) in
        [(35, Method::Velocity), (65, Method::Pd), (28, Method::Velocity), (61, Method::Piv)]
    {
        let manner = Manner { silent: vec![command], ..Manner::default() };
        let report = tuned(manner, Motor::default(), Tuning { method, ..Tuning::default() });
        assert_eq!(report.causes.first(), Some(&Cause::Refused), "command {command}: {:?}", report.causes);
    }
}

#[test]
fn a_run_inside_a_travel_stays_there_on_another_controller_too() {
    let mut request =
        Tuning { method: Method::Piv, excitation: Excitation::Window(1_600.0), ..Tuning::default() };
    request.guard.travel = Some((-800, 800));
    let report = tuned(Manner::default(), Motor { end_stop: 800.0, ..Motor::default() }, request);
    assert_ne!(report.verdict, Verdict::Refused, "{:?}", report.causes);
}

#[test]
fn the_total_time_of_a_run_is_limited() {
    let mut request = Tuning::default();
    request.guard.time_limit_s = 2.0;
    let report = tuned(Manner::default(), Motor::default(), request);
    assert_eq!(report.causes.first(), Some(&Cause::TimeLimit));
    assert!(report.seconds.1 < 2.5, "{} s", report.seconds.1);
}

#[test]
fn without_a_time_out_of_the_controller_nothing_is_armed_and_nothing_moves() {
    let manner = Manner { silent: vec![15, 146], ..Manner::default() };
    let mut link = Link::new(manner, Motor::default());
    assert!(link.connect().is_some(), "{:?}", link.events);
    assert!(!link.arm(), "its time-out is not known");
    assert_eq!(link.cable.unit().place, 0.0);
}
