//! Every rate, firmware and lateness of a line: the unit is found, its status and settings are read, its motor is driven and stopped, in
//! virtual time. What cannot be is refused with a sentence that names the lateness.

use brushwork_tests::said::Said;
use std::fmt::Debug;
use std::time::Duration;

use brushwork_core::keep::TrialKeeper;
use brushwork_core::messages::EndedMessage;
use brushwork_core::session::line::SimulatedLine;
use brushwork_core::tune::law::{Report, Request as Tuning, Setup};
use brushwork_core::tune::live::Live;
use brushwork_core::tune::{Slot, Target, leaves_off, prepare, restore, run, take};
use brushwork_family::simulator;
use brushwork_link::device::{
    ArmScope, DeviceOptions, Drive, DriveCommand, Event, Identity, Job, JobEnding, Request,
};
use brushwork_link::settings::{Ending, Entry, Keeper, read_all};
use brushwork_link::{Failure, FamilyChoice, Stream};
use brushwork_mcp_client::MCP;
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_motion_mind_client::MOTION_MIND;
use brushwork_plant::faults::{Direction, Fault, FaultEffect};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::pacing::byte_time;
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_tuning::axis::EncoderClass;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::Method;
use brushwork_values::Motor;

const RATES: [u32; 7] = [2_400, 9_600, 19_200, 38_400, 57_600, 115_200, 460_800];
const LATENCIES_MS: [u64; 4] = [0, 20, 150, 400];
/// A byte by itself as a UART gives them, and what a USB adapter hands over every 16 ms.
const TIMERS_MS: [u64; 2] = [0, 16];

/// One line.
#[derive(Clone, Copy, Debug)]
struct Case {
    rate_bps: u32,
    generation: Generation,
    latency_ms: u64,
    timer_ms: u64,
}

/// What became of it.
struct Outcome {
    connected_s: f64,
    settings_s: f64,
    stop_ms: f64,
    refused_first: Option<String>,
}

impl Case {
    /// A link to a unit whose motor stops after `timeout_ms` of silence.
    fn link(self, timeout_ms: u32) -> VirtualLink {
        let mut config = ControllerConfig { generation: self.generation, ..ControllerConfig::default() };
        let mut settings = Settings::factory(config.model, config.address.get());
        let stream = &mut settings.streams[StreamIndex::Uart0.index()];
        (stream.rate_bps, stream.timeout_ms) = (self.rate_bps, timeout_ms);
        config.settings = Some(settings);
        let bus =
            Bus::single(Controller::new(config).expect("the presets make a controller"), StreamIndex::Uart0);
        let options = DeviceOptions {
            family: FamilyChoice::of(MCP),
            stream: Some(Stream::Rs232),
            simulated: true,
            ..DeviceOptions::default()
        };
        let link = VirtualLink::new(bus, StreamIndex::Uart0, options, vec![late(self.latency_ms)], 1);
        link.set_timer(Duration::from_millis(self.timer_ms));
        link
    }

    /// The time of so many bytes.
    fn on_the_wire(self, bytes: u32) -> Duration {
        byte_time(self.rate_bps) * bytes
    }

    fn run(self) -> Outcome {
        let mut link = self.link(1000);
        let unit = self.connect(&mut link);
        let connected_s = link.now().as_secs_f64();
        let is_status = |event: &Event| matches!(event, Event::Status(_));
        assert!(run_until(&mut link, 30, is_status), "{self:?}: no status");

        let begun = link.now();
        let subject = unit.subject().expect("the model is known");
        let read = Job::new(Said::Settings, Duration::from_secs(600), move |wire| read_all(wire, subject));
        let report = match link.finish(read, Duration::from_secs(600)) {
            Some(JobEnding::Done(report)) => report,
            other => panic!("{self:?}: settings: {:?}", other.map(|ending| format!("{ending:?}"))),
        };
        assert!(report.failures.is_empty(), "{self:?}: {:?}", report.failures);
        let settings_s = (link.now() - begun).as_secs_f64();

        let refused_first = arm(&mut link).err();
        if let Some(why) = &refused_first {
            assert!(
                self.latency_ms >= 150 && why.contains("replies on this line take up to"),
                "{self:?}: {why}"
            );
            link = self.link(5000);
            self.connect(&mut link);
            arm(&mut link).unwrap_or_else(|why| panic!("{self:?}: {why}"));
        }
        // A request may be half out, the stop's own bytes follow, then half of the latency, and the bridge's ramp from 30 % to 0.
        let latest = Duration::from_millis(self.latency_ms / 2 + 30) + self.on_the_wire(60);
        drive_and_stop(&mut link, &self, latest);
        let stop_ms = latest.as_secs_f64() * 1e3;
        Outcome { connected_s, settings_s, stop_ms, refused_first }
    }

    fn connect(self, link: &mut VirtualLink) -> Identity {
        assert!(
            run_until(link, 60, |event| matches!(event, Event::Selected { .. })),
            "{self:?}: {:?}",
            link.events
        );
        let found = link.events.iter().find_map(|(_, event)| match event {
            Event::Connected(unit) => Some(unit.clone()),
            _ => None,
        });
        let unit = found.expect("it is told before it is selected");
        assert_eq!(unit.generation.number(), self.generation.number(), "{self:?}");
        assert_eq!(unit.notes, [""; 0], "{self:?}");
        unit
    }
}

/// Replies that come so much late, half of it each way.
fn late(latency_ms: u64) -> Fault {
    Fault {
        effect: FaultEffect::Delay { by: Duration::from_millis(latency_ms) / 2, share: 1.0 },
        direction: Direction::Both,
        unit: 0,
        from: Duration::ZERO,
        until: None,
    }
}

/// Drives motor 1 with a duty of 30 % for 3 s, stops it, and sees that it was off in time and that this was confirmed.
fn drive_and_stop<M: Machine + 'static>(link: &mut VirtualLink<M>, case: &dyn Debug, latest_after: Duration) {
    let drive = Drive::one(Motor::M1, DriveCommand::duty(0.3));
    link.events.clear();
    link.ask(Request::Drive(drive));
    assert!(run_until(link, 5, |event| matches!(event, Event::Driven { .. })), "{case:?}: {:?}", link.events);
    link.run_for(Duration::from_secs(3));
    assert!(link.duties(0)[0] > 0.29, "{case:?}: the motor did not go on: {:?}", link.events);

    link.handle.stop_all();
    let latest = link.now() + latest_after;
    let seen = link.duties_at(latest, 0);
    link.run_for(latest_after + Duration::from_millis(1));
    assert_eq!(*seen.lock().expect("nobody panicked"), Some([0.0; 2]), "{case:?}: Stop");
    assert!(run_until(link, 20, |event| matches!(event, Event::Stopped(_))), "{case:?}: no report");
    let stop = link.stops().last().map(|stop| stop.confirmed());
    assert_eq!(stop, Some(true), "{case:?}: {:?}", link.stops());
}

/// Runs until something is told, for so many seconds at most.
fn run_until<M: Machine + 'static>(
    link: &mut VirtualLink<M>,
    seconds: u64,
    is_it: impl Fn(&Event) -> bool,
) -> bool {
    let end = link.now() + Duration::from_secs(seconds);
    while link.now() < end && !link.ended {
        if link.events.iter().any(|(_, event)| is_it(event)) {
            return true;
        }
        link.run_for(Duration::from_millis(20));
    }
    false
}

/// Arms, or says why not.
fn arm<M: Machine + 'static>(link: &mut VirtualLink<M>) -> Result<(), String> {
    link.events.clear();
    link.ask(Request::Arm(ArmScope::CommandLine));
    run_until(link, 20, |event| matches!(event, Event::Armed { .. } | Event::ArmRefused { .. }));
    let refused = link.events.iter().find_map(|(_, event)| match event {
        Event::Armed { .. } => Some(Ok(())),
        Event::ArmRefused { reasons, .. } => Some(Err(reasons.iter().map(ToString::to_string).collect())),
        _ => None,
    });
    refused.unwrap_or_else(|| Err(format!("no answer: {:?}", link.events)))
}

#[test]
fn every_line_is_found_read_driven_and_stopped_or_refused_for_its_lateness() {
    let cases: Vec<Case> = RATES
        .into_iter()
        .flat_map(|rate_bps| Generation::ALL.map(|generation| (rate_bps, generation)))
        .flat_map(|(rate_bps, generation)| LATENCIES_MS.map(|latency_ms| (rate_bps, generation, latency_ms)))
        .flat_map(|(rate_bps, generation, latency_ms)| {
            TIMERS_MS.map(|timer_ms| Case { rate_bps, generation, latency_ms, timer_ms })
        })
        .collect();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| {
        for part in 0..threads {
            let mine = cases.iter().skip(part).step_by(threads);
            scope.spawn(move || {
                for case in mine {
                    let Outcome { connected_s, settings_s, stop_ms, refused_first } = case.run();
                    println!(
                        "{:6} bit/s, {:?}, {:3} ms late, timer {:2} ms: found in {connected_s:.1} s, settings in {settings_s:.1} s, \
                         stopped within {stop_ms:.0} ms{}",
                        case.rate_bps,
                        case.generation,
                        case.latency_ms,
                        case.timer_ms,
                        if refused_first.is_some() { ", first refused for its lateness" } else { "" }
                    );
                }
            });
        }
    });
}

/// A simulated Motion Mind on a late line, found and selected.
fn motion_mind(text: &str, latency_ms: u64) -> (VirtualLink<SimulatedLine>, Identity) {
    let simulator = simulator::asked_for(text).expect("it is one");
    let bus = SimulatedLine::new(simulator.start(text).expect("the presets make a motor").machine);
    let options = DeviceOptions { family: FamilyChoice::of(MOTION_MIND), ..DeviceOptions::default() };
    let mut link = VirtualLink::over(bus, options, vec![late(latency_ms)], 1);
    let is_selected = |event: &Event| matches!(event, Event::Selected { .. });
    assert!(run_until(&mut link, 120, is_selected), "{text}, {latency_ms} ms: {:?}", link.events);
    let unit = link.events.iter().find_map(|(_, event)| match event {
        Event::Connected(unit) => Some(unit.clone()),
        _ => None,
    });
    (link, unit.expect("it was selected"))
}

/// A Motion Mind has no time-out of its own: no lateness keeps it from being driven, it is only told.
#[test]
fn a_motion_mind_is_found_read_driven_and_stopped_on_every_line() {
    brushwork::install();
    for (protocol, baud) in [("binary", 9_600), ("binary", 19_200), ("ascii", 9_600), ("ascii", 19_200)] {
        for latency_ms in LATENCIES_MS {
            let case = (protocol, baud, latency_ms);
            let text = format!("motion-mind-3,mode=3,protocol={protocol},baud={baud}");
            let (mut link, unit) = motion_mind(&text, latency_ms);
            let found_s = link.now().as_secs_f64();
            let subject = unit.subject().expect("the model is known");
            let is_status = |event: &Event| matches!(event, Event::Status(_));
            assert!(run_until(&mut link, 30, is_status), "{case:?}: no status");
            let read =
                Job::new(Said::Settings, Duration::from_secs(600), move |wire| read_all(wire, subject));
            let begun = link.now();
            match link.finish(read, Duration::from_secs(600)) {
                Some(JobEnding::Done(report)) if report.failures.is_empty() => {}
                other => panic!("{case:?}: settings: {other:?}"),
            }
            let settings_s = (link.now() - begun).as_secs_f64();
            arm(&mut link).unwrap_or_else(|why| panic!("{case:?}: {why}"));
            // As for the other family; in text a command is a line of up to 40 bytes.
            let latest = Duration::from_millis(latency_ms / 2 + 60) + byte_time(baud) * 120;
            drive_and_stop(&mut link, &case, latest);
            println!("{case:?}: found in {found_s:.1} s, settings in {settings_s:.1} s");
        }
    }
}

/// Both ends of rate, firmware and lateness, and between them the lines where tuning becomes a refusal.
fn corners() -> impl Iterator<Item = (Case, bool)> {
    let ends = [(2_400, 0, false), (2_400, 400, false), (460_800, 0, true), (460_800, 400, false)];
    let ends = ends.map(|(rate_bps, latency_ms, is_tuned)| (rate_bps, latency_ms, 16, is_tuned));
    let between = [
        (4_800, 0, 0, true),
        (19_200, 0, 0, true),
        (38_400, 0, 0, true),
        (38_400, 20, 0, false),
        (115_200, 0, 16, true),
        (115_200, 20, 0, true),
        (115_200, 30, 0, false),
        (115_200, 150, 0, false),
    ];
    ends.into_iter().chain(between).flat_map(|(rate_bps, latency_ms, timer_ms, is_tuned)| {
        [Generation::Gen1, Generation::Gen4]
            .map(|generation| (Case { rate_bps, generation, latency_ms, timer_ms }, is_tuned))
    })
}

/// Prepares a run, carries it out and puts everything back; the report, or why there is none.
fn tune<M: Machine + 'static>(
    link: &mut VirtualLink<M>,
    unit: &Identity,
    target: Target,
    method: Method,
) -> Result<Report, String> {
    let minutes = |minutes: u64| Duration::from_secs(60 * minutes);
    let subject = unit.subject().expect("the model is known");
    let keeper = TrialKeeper::new(Box::new(Forgetful));
    let setup: Slot<Setup> = Slot::default();
    match link.finish(prepare(target, subject, &setup, &keeper), minutes(10)) {
        Some(JobEnding::Done(())) => {}
        Some(JobEnding::Failed(failure)) => return Err(failure.to_string()),
        other => panic!("{other:?}"),
    }
    let before = take(&setup).expect("it was read");
    let target = Target { encoder: Some(before.encoder), ..target };
    let found: Slot<Report> = Slot::default();
    let armed = arm(link);
    if armed.is_ok() {
        let request = Tuning { method, ..Tuning::default() };
        link.finish(run(target, request, &found, &Live::default()), minutes(10));
    }
    let report = take(&found);
    let leaves_off = leaves_off(report.as_ref(), None);
    link.finish(restore(target, before, report.as_ref(), leaves_off, &keeper), minutes(5));
    armed
        .map(|()| report.expect("a run leaves its report"))
        .map_err(|why| format!("{why} {}", EndedMessage::NotArmed))
}

/// What a run keeps on this computer is not looked at here.
struct Forgetful;

impl Keeper for Forgetful {
    fn begin(&mut self, _entry: Entry) {}

    fn begun(&mut self) -> Option<Result<(), Failure>> {
        Some(Ok(()))
    }

    fn end(&mut self, _ending: Ending) {}
}

/// Whether a refusal says what the line takes, and what would do.
fn names_the_line(why: &str) -> bool {
    ["this line", " ms", "USB"].iter().all(|word| why.contains(word)) && !why.contains("computer")
}

#[test]
fn a_motor_is_tuned_over_a_line_or_the_line_is_refused_for_what_it_takes() {
    let mut wrong = Vec::new();
    for (case, is_tuned) in corners() {
        let mut link = case.link(1000);
        let unit = case.connect(&mut link);
        let encoder = Some(EncoderClass::Quadrature);
        let target = Target { motor: Motor::M1, encoder, stream: Some(Stream::Rs232) };
        let begun = link.now();
        let came = tune(&mut link, &unit, target, Method::Velocity);
        let took_s = (link.now() - begun).as_secs_f64();
        let timeout_ms =
            link.bus(|bus| bus.controllers()[0].settings().streams[StreamIndex::Uart0.index()].timeout_ms);
        let is_right = match &came {
            Ok(report) => report.verdict != Verdict::Refused,
            Err(why) => names_the_line(why),
        };
        let came = came.map(|report| (report.verdict, report.causes));
        println!("{case:?}: {came:?} in {took_s:.1} s");
        if !is_right || came.is_ok() != is_tuned || timeout_ms != 1000 {
            wrong.push(format!("{case:?}: {came:?}, time-out {timeout_ms} ms"));
        }
    }
    assert_eq!(wrong, [""; 0]);
}

#[test]
fn a_motion_mind_is_tuned_over_a_line_or_the_line_is_refused_for_what_it_takes() {
    brushwork::install();
    let mut wrong = Vec::new();
    for (protocol, baud) in [("binary", 19_200), ("binary", 9_600), ("ascii", 9_600)] {
        for latency_ms in [0, 400] {
            let case = (protocol, baud, latency_ms);
            let text = format!("motion-mind-3,mode=4,protocol={protocol},baud={baud}");
            let (mut link, unit) = motion_mind(&text, latency_ms);
            let target = Target { motor: Motor::M1, encoder: None, stream: None };
            let came = tune(&mut link, &unit, target, Method::Pid);
            let is_right = match &came {
                Ok(report) => report.verdict != Verdict::Refused && latency_ms == 0,
                Err(why) => names_the_line(why),
            };
            let came = came.map(|report| (report.verdict, report.causes));
            println!("{case:?}: {came:?}");
            wrong.extend((!is_right).then(|| format!("{case:?}: {came:?}")));
        }
    }
    assert_eq!(wrong, [""; 0]);
}
