//! Every rate, firmware and lateness of a line: the unit is found, its status and settings are read, its motor is driven and stopped, in
//! virtual time. What cannot be is refused with a sentence that names the lateness.

use brushwork_tests::said::Said;
use std::fmt::Debug;
use std::time::Duration;

use brushwork_core::session::line::SimulatedLine;
use brushwork_family::simulator;
use brushwork_link::device::{
    ArmScope, DeviceOptions, Drive, DriveCommand, Event, Identity, Job, JobEnding, Request,
};
use brushwork_link::settings::read_all;
use brushwork_link::{FamilyChoice, Stream};
use brushwork_mcp_client::MCP;
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_motion_mind_client::MOTION_MIND;
use brushwork_plant::faults::{Direction, Fault, FaultEffect};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::pacing::byte_time;
use brushwork_tests::virtual_link::VirtualLink;
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

/// A Motion Mind has no time-out of its own: no lateness keeps it from being driven, it is only told.
#[test]
fn a_motion_mind_is_found_read_driven_and_stopped_on_every_line() {
    brushwork::install();
    for (protocol, baud) in [("binary", 9_600), ("binary", 19_200), ("ascii", 9_600), ("ascii", 19_200)] {
        for latency_ms in LATENCIES_MS {
            let case = (protocol, baud, latency_ms);
            let text = format!("motion-mind-3,mode=3,protocol={protocol},baud={baud}");
            let simulator = simulator::asked_for(&text).expect("it is one");
            let bus = SimulatedLine::new(simulator.start(&text).expect("the presets make a motor").machine);
            let options = DeviceOptions { family: FamilyChoice::of(MOTION_MIND), ..DeviceOptions::default() };
            let mut link = VirtualLink::over(bus, options, vec![late(latency_ms)], 1);
            let is_selected = |event: &Event| matches!(event, Event::Selected { .. });
            assert!(run_until(&mut link, 120, is_selected), "{case:?}: {:?}", link.events);
            let found_s = link.now().as_secs_f64();
            let unit = link.events.iter().find_map(|(_, event)| match event {
                Event::Connected(unit) => Some(unit.clone()),
                _ => None,
            });
            let subject = unit.and_then(|unit| unit.subject()).expect("the model is known");
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
