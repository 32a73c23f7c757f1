//! Examining units and imitating them, in virtual time: a unit made like a report gives the same report, what it says is the truth of the
//! simulator, and what a step has changed is put back however it ends.

use std::time::Duration;

use brushwork_core::examine::{Examination, Examining, Need, State, Step, Way};
use brushwork_core::keep::TrialKeeper;
use brushwork_core::session::line::SimulatedLine;
use brushwork_family::{Simulator, Started};
use brushwork_link::device::{Addresses, ArmScope, DeviceHandle, DeviceOptions, Event, Identity, JobEnding};
use brushwork_link::settings::{Ending, Entry, Keeper};
use brushwork_link::{Failure, Stream, WriteOptions};
use brushwork_mcp::McpSimulator;
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig, FirmwareOptions, Quirks};
use brushwork_mcp_sim::motion::{ControlLaw, GainTiming};
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::{Generation, number};
use brushwork_motion_mind::{MotionMindSimulator, MotionMindSpec};
use brushwork_motion_mind_wire::{Mode, Protocol, register_number};
use brushwork_plant::machine::StreamIndex;
use brushwork_tests::program::{Ending as Ended, Program};
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_tests::wait::LIMIT;
use brushwork_values::Motor;
use serde_json::{Value, json};

const LONGEST: Duration = Duration::from_secs(600);
const MOTOR: Motor = Motor::M1;

/// Keeps nothing.
struct Forgetful;

impl Keeper for Forgetful {
    fn begin(&mut self, _: Entry) {}

    fn begun(&mut self) -> Option<Result<(), Failure>> {
        Some(Ok(()))
    }

    fn end(&mut self, _: Ending) {}
}

fn options() -> DeviceOptions {
    // As a unit at a port: guesses need the owner's word.
    DeviceOptions { addresses: Addresses::Factory, stream: Some(Stream::Usb), ..DeviceOptions::default() }
}

fn started(config: ControllerConfig) -> Started {
    let address = config.address;
    let bus = Bus::new(vec![Controller::new(config).expect("its figures make sense")], StreamIndex::Usb)
        .expect("one unit hangs on USB");
    Started {
        machine: Box::new(bus),
        addresses: vec![brushwork_mcp_client::unit_address(address)],
        nodes: Vec::new(),
        can_form: None,
        index: StreamIndex::Usb,
        stream: Stream::Usb,
        seed: 1,
    }
}

fn connected(started: Started) -> (VirtualLink<SimulatedLine>, Identity) {
    let mut link = VirtualLink::to_simulated(started, options());
    link.run_for(Duration::from_secs(10));
    let found = link.events.iter().find_map(|(_, event)| match event {
        Event::Connected(identity) => Some(identity.clone()),
        _ => None,
    });
    let identity = found.unwrap_or_else(|| panic!("{:?}", link.events));
    (link, identity)
}

fn way() -> Way {
    Way {
        motor: MOTOR,
        options: WriteOptions { own_stream: Some(Stream::Usb), simulated: false, as_read: true },
    }
}

/// Takes one step to its end, and puts back.
fn take(link: &mut VirtualLink<SimulatedLine>, examining: &Examining, step: &'static Step) {
    let taking = examining.take(step, way(), TrialKeeper::new(Box::new(Forgetful)));
    if let Some(job) = taking.prepare() {
        let ending = link.finish(job, LONGEST);
        assert!(matches!(ending, Some(JobEnding::Done(()))), "{}: {ending:?}", step.key);
    }
    if taking.moves() {
        assert!(link.arm(ArmScope::CommandLine), "{:?}", link.events);
    }
    let ending = link.finish(taking.work(), LONGEST);
    assert!(matches!(ending, Some(JobEnding::Done(()))), "{}: {ending:?}", step.key);
    if let Some(job) = taking.put_back() {
        let ending = link.finish(job, LONGEST);
        assert!(matches!(ending, Some(JobEnding::Done(_))), "{}: {ending:?}", step.key);
    }
}

/// All that a unit is asked, up to what may be agreed to.
fn examined(started: Started, most: Need) -> Examination {
    let (mut link, identity) = connected(started);
    let examining = Examining::begin(&identity).expect("the family has questions");
    for step in examining.steps().iter().filter(|step| step.need <= most) {
        take(&mut link, &examining, step);
    }
    examining.found()
}

/// A unit made like a report gives the same report.
fn reproduces(found: &Examination, most: Need) -> Vec<String> {
    reproduces_by(&McpSimulator, found, most)
}

fn reproduces_by(simulator: &dyn Simulator, found: &Examination, most: Need) -> Vec<String> {
    // As a file carries it.
    let read = Examination::parse(&found.json()).expect("it is a report");
    assert_eq!(&read, found);
    let (started, unlike) = simulator.like(&read).expect("it is a report of the family");
    let again = examined(started, most);
    let (first, second) = (found.behaviour(), again.behaviour());
    for (one, other) in first.answers.iter().zip(&second.answers) {
        assert_eq!(one, other, "{}", found.text());
    }
    for (one, other) in first.commands.iter().zip(&second.commands) {
        assert_eq!(one, other, "{}", found.text());
    }
    assert_eq!(first, second);
    unlike
}

fn config(model: &str, generation: Generation) -> ControllerConfig {
    let model = models::lookup(model).expect("the model is in the table");
    ControllerConfig { generation, seed: 1, ..ControllerConfig::of(model) }
}

#[test]
fn units_of_each_generation_and_both_product_lines_reproduce_themselves() {
    for (model, generation) in [
        ("mcp266", Generation::Gen1),
        ("mcp233", Generation::Gen2),
        ("mcp2166", Generation::Gen3),
        ("mcp236", Generation::Gen4),
        ("roboclaw-2x7a", Generation::Gen3),
        ("roboclaw-2x7a", Generation::Gen4),
    ] {
        // From the factory a RoboClaw has no serial time-out, so that it cannot be armed.
        let moves = model.starts_with("mcp");
        let most = if moves { Need::Move } else { Need::Write };
        let found = examined(started(config(model, generation)), most);
        let place = format!("{model} {generation}");
        let value =
            |key: &str| found.value(key).unwrap_or_else(|| panic!("{place} {key}: {}", found.text())).clone();
        assert_eq!(
            value("generation"),
            json!({ "generation": generation.number(), "otherwise": [] }),
            "{place}"
        );
        assert_eq!(value("commands"), json!({ "lacks": [], "has_too": [] }), "{place}: {}", found.text());
        assert_eq!(value("appended_crc"), json!(true), "{place}");
        assert_eq!(value("acknowledgement"), json!("FF"), "{place}");
        assert_eq!(
            value("doubled_address"),
            json!({ "answer": "acknowledged", "changed": false }),
            "{place}"
        );
        assert_eq!(value("longer_payload"), json!({ "answer": "silent", "changed": false }), "{place}");
        assert_eq!(
            found.answer("save_restarts").unwrap().state,
            State::NotAsked,
            "nobody has agreed to that"
        );
        if moves {
            assert_eq!(value("loop_rate"), json!({ "per_tick": true, "rate_hz": 300 }), "{place}");
            assert_eq!(value("position_scale"), json!(1024.0), "{place}");
            assert_eq!((value("feed_forward"), value("speed_step")), (json!(true), json!(300.0)), "{place}");
        }
        let unlike = reproduces(&found, most);
        assert_eq!(unlike.len(), if moves { 0 } else { 5 }, "{place}: {unlike:?}");
    }
}

#[test]
fn the_law_that_is_found_is_the_law_that_the_unit_has_and_is_imitated() {
    let other = ControlLaw { position_gain_scale: 2048.0, ..ControlLaw::at_625_hz() };
    let laws = [
        other,
        ControlLaw { gain_timing: GainTiming::PerSecond, feed_forward: false, ..other },
        ControlLaw { gain_timing: GainTiming::PerSecond, ..ControlLaw::default() },
        ControlLaw { feed_forward: false, raw_speed_ticks: 2, ..ControlLaw::default() },
        ControlLaw { derivative_timing: Some(GainTiming::PerSecond), ..ControlLaw::default() },
        ControlLaw {
            gain_timing: GainTiming::PerSecond,
            derivative_timing: Some(GainTiming::PerTick),
            ..ControlLaw::at_625_hz()
        },
    ];
    for law in laws {
        let found =
            examined(started(ControllerConfig { law, ..config("mcp266", Generation::Gen1) }), Need::Move);
        let value = |key: &str| found.value(key).unwrap_or_else(|| panic!("{key}: {}", found.text()));
        let per_tick = law.gain_timing == GainTiming::PerTick;
        assert_eq!(value("loop_rate")["per_tick"], json!(per_tick), "{law:?}");
        // Over seconds the rate shows in the unfiltered speed, if it is one that is known.
        assert_eq!(
            value("loop_rate")["rate_hz"].as_f64(),
            Some(f64::from(law.rate_hz)),
            "{law:?} {}",
            found.text()
        );
        assert_eq!(*value("position_scale"), json!(law.position_gain_scale));
        let derivative = law.derivative_timing.unwrap_or(law.gain_timing) == GainTiming::PerTick;
        assert_eq!(value("derivative")["per_tick"], json!(derivative), "{law:?} {}", found.text());
        assert_eq!(*value("feed_forward"), json!(law.feed_forward));
        assert_eq!(*value("speed_step"), json!(f64::from(law.rate_hz) / f64::from(law.raw_speed_ticks)));
        assert_eq!(reproduces(&found, Need::Move), Vec::<String>::new(), "{law:?}");
    }
}

#[test]
fn a_firmware_that_lacks_commands_is_slow_late_and_partly_of_another_generation_is_told_and_imitated() {
    let quirks = Quirks {
        silent: [number::READ_STATUS, number::READ_PWM_MODE, number::READ_DEFAULT_ACCELS].into(),
        layouts: [(number::READ_MAIN_VOLTAGES, Generation::Gen4)].into(),
        slow: [(number::READ_SIGNALS, Duration::from_millis(35))].into(),
        late: Duration::from_millis(6),
    };
    let options = FirmwareOptions {
        text: Some("MCP266 2x60A v9.9.9 beta".to_owned()),
        acknowledges_legacy: false,
        version: None,
    };
    let unit = ControllerConfig { quirks, options, ..config("mcp266", Generation::Gen1) };
    let found = examined(started(unit), Need::Write);
    let value = |key: &str| found.value(key).unwrap_or_else(|| panic!("{key}: {}", found.text()));
    assert_eq!(found.unit.version_text, "MCP266 2x60A v9.9.9 beta");
    assert_eq!(*value("generation"), json!({ "generation": 1, "otherwise": [number::READ_MAIN_VOLTAGES] }));
    let lacks = json!([number::READ_DEFAULT_ACCELS, number::READ_STATUS, number::READ_PWM_MODE]);
    assert_eq!(value("commands")["lacks"], lacks);
    assert_eq!(*value("legacy_acknowledgement"), json!(false));
    let signals = found.command(number::READ_SIGNALS).unwrap();
    assert_eq!(signals.presence.label(), "slow");
    let late = found.line.lateness.unwrap();
    assert!((6.0..8.0).contains(&late.shortest_ms) && late.longest_ms >= 41.0, "{late:?}");
    let unlike = reproduces(&found, Need::Write);
    assert!(unlike.iter().all(|sentence| sentence.starts_with("The examination does not say")), "{unlike:?}");
    assert_eq!(unlike.len(), 5, "the motor was not moved: {unlike:?}");
}

#[test]
fn a_motion_mind_is_asked_in_both_protocols_and_imitated() {
    for protocol in Protocol::ALL {
        let lacks = 1 << register_number::THERMISTOR | 1 << register_number::DEADBAND;
        let spec =
            MotionMindSpec { protocol, mode: Mode::Serial, revision: 7, lacks, ..MotionMindSpec::default() };
        let address = brushwork_motion_mind_client::unit_address(1).expect("it is one of the family");
        let bus = spec.bus().expect("its figures make sense");
        let found = examined(Started::on_a_line(Box::new(bus), vec![address], 1), Need::Save);
        let value = |key: &str| found.value(key).unwrap_or_else(|| panic!("{key}: {}", found.text())).clone();
        let is_text = protocol == Protocol::Text;
        let named = if is_text { "ascii" } else { "binary" };
        assert_eq!(value("switches"), json!({ "mode": 3, "protocol": named }));
        assert_eq!(value("lacking"), json!([register_number::DEADBAND, register_number::THERMISTOR]));
        assert_eq!((value("back_to_back"), value("tick")), (json!(true), json!(true)), "{}", found.text());
        assert_eq!(value("read_only"), json!({ "acknowledged": true, "changes": false }));
        assert!(
            value("store_time").as_f64().is_some_and(|ms| (40.0..70.0).contains(&ms)),
            "{}",
            found.text()
        );
        let expected = if is_text { State::Answered } else { State::Unclear };
        assert_eq!(found.answer("small_letters").expect("it is a question").state, expected);
        assert_eq!((found.unit.firmware.as_str(), found.commands.len()), ("7", 32));
        assert_eq!(reproduces_by(&MotionMindSimulator, &found, Need::Save), Vec::<String>::new());
    }
}

/// The registers of motor 1's loops, and the time-out of the served stream.
fn registers(link: &VirtualLink<SimulatedLine>) -> String {
    link.bus(|line| {
        let settings = line.get::<Bus>().expect("it is a bus").controllers()[0].settings();
        format!("{:?} {:?}", settings.motors[0], settings.streams[0])
    })
}

#[test]
fn whatever_ends_a_step_the_unit_holds_what_it_held_before_and_the_motor_stands() {
    for (key, times) in [("layout", [40, 130, 400]), ("motor", [300, 900, 1_500])] {
        for (generation, after_ms) in
            [Generation::Gen1, Generation::Gen3, Generation::Gen4].into_iter().zip(times)
        {
            let (mut link, identity) = connected(started(config("mcp266", generation)));
            let before = registers(&link);
            let examining = Examining::begin(&identity).unwrap();
            let step = examining.steps().iter().find(|step| step.key == key).unwrap();
            let taking = examining.take(step, way(), TrialKeeper::new(Box::new(Forgetful)));
            let prepared = link.finish(taking.prepare().unwrap(), LONGEST);
            assert!(matches!(prepared, Some(JobEnding::Done(()))), "{prepared:?}");
            assert!(!taking.moves() || link.arm(ArmScope::CommandLine), "{:?}", link.events);
            link.at(link.now() + Duration::from_millis(after_ms), DeviceHandle::stop_all);
            let ending = link.finish(taking.work(), LONGEST);
            let place = format!("{key} {generation} {after_ms} ms");
            assert!(matches!(ending, Some(JobEnding::Interrupted(_))), "{place}: {ending:?}");
            let back = link.finish(taking.put_back().unwrap(), LONGEST);
            assert!(matches!(back, Some(JobEnding::Done(_))), "{place}: {back:?}");
            assert_eq!(registers(&link), before, "{place}");
            assert_eq!(link.duties(0), [0.0; 2], "{place}");
        }
    }
}

#[test]
fn nothing_is_written_before_it_is_agreed_to_and_the_motor_does_not_turn() {
    for generation in Generation::ALL {
        let (mut link, identity) = connected(started(config("mcp266", generation)));
        let examining = Examining::begin(&identity).unwrap();
        link.take_written();
        take(&mut link, &examining, &examining.steps()[0]);
        for bytes in link.take_written() {
            let row = brushwork_mcp_wire::packet_serial::lookup(bytes[1]).unwrap();
            let is_read = |form: &brushwork_mcp_wire::packet_serial::Form| {
                form.direction == brushwork_mcp_wire::packet_serial::Direction::Read
                    && !form.effect.may_move()
                    && form.assumed.is_none()
            };
            assert!(row.forms.iter().all(is_read), "{generation}: {bytes:02X?}");
        }
        let found = examining.found();
        for answer in found.answers.iter().filter(|answer| answer.need > Need::Read) {
            assert_eq!((answer.state, &answer.value), (State::NotAsked, &Value::Null), "{}", answer.key);
        }
    }
}

#[test]
fn a_report_is_text_that_says_what_was_not_asked_and_names_nothing_of_the_computer() {
    let found = examined(started(config("mcp266", Generation::Gen4)), Need::Read);
    let text = found.text();
    for part in [
        "Calls itself  MCP266 2x60A v1.0.0",
        "Answered\n",
        "Not asked\n",
        "Assumed, and not asked",
        "Commands\n",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    for told in [text, found.json()] {
        for own in ["/dev", "/tmp", "/home", "/root", "virtual", "sim:", "\"port\""] {
            assert!(!told.contains(own), "{own}: {told}");
        }
    }
}

#[test]
fn what_is_no_report_is_refused_with_the_reason() {
    let found = examined(started(config("mcp266", Generation::Gen1)), Need::Read);
    let newer = found.json().replacen("\"version\": 1", "\"version\": 2", 1);
    for (text, said) in [
        ("", "it is no report of an examination"),
        ("{}", "its schema is \"\""),
        ("{\"schema\": \"brushwork-profile\"}", "its schema is \"brushwork-profile\""),
        (newer.as_str(), "of version 2"),
    ] {
        let error = Examination::parse(text).unwrap_err().to_string();
        assert!(error.contains(said), "{text:?}: {error}");
    }
    let mut unknown = found;
    unknown.unit.version_text = "Some other device".to_owned();
    let (_, unlike) = McpSimulator.like(&unknown).unwrap();
    assert!(unlike[0].contains("no model that is known here"), "{unlike:?}");
    unknown.unit.generation = 9;
    assert!(McpSimulator.like(&unknown).is_err());
}

const BRUSHWORK: &str = env!("CARGO_BIN_EXE_brushwork-for-tests");

fn run(arguments: &[&str]) -> Ended {
    Program::start(BRUSHWORK, arguments).finish(LIMIT)
}

#[test]
fn the_command_reads_where_nobody_can_be_asked_and_the_served_imitation_calls_itself_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (json, text) = (path("unit.json"), path("unit.txt"));
    let target = "sim:mcp233,generation=2";
    let first = run(&["examine", "--connect", target, "--yes", "guesses", "--json", &json, "-o", &text]);
    assert_eq!(first.status.code(), Some(0), "{first:?}");
    let found =
        Examination::parse(&std::fs::read_to_string(&json).expect("it was written")).expect("a report");
    let sentence = |key: &str| found.answer(key).expect("a question").worded.clone();
    assert_eq!(found.answer("guessed_reads").map(|answer| answer.state), Some(State::Answered));
    for key in ["longer_payload", "loop_rate", "save_restarts"] {
        assert!(
            sentence(key).contains("there was no terminal to ask at") && sentence(key).contains("--yes"),
            "{key}"
        );
    }
    assert!(std::fs::read_to_string(&text).expect("it was written").contains("Calls itself  MCP233 2x30A"));
    let kept = run(&["examine", "--connect", target, "--json", &json]);
    assert_eq!(kept.status.code(), Some(1), "no report is replaced unasked: {kept:?}");
    let unknown = run(&["examine", "--connect", target, "--yes", "everything"]);
    assert_eq!(unknown.status.code(), Some(2), "{unknown:?}");
    assert!(unknown.stderr.join("\n").contains("guesses, layout, motor, saving"), "{unknown:?}");

    let mut sim = Program::start(BRUSHWORK, &["sim", "--like", &json, "--tcp", "127.0.0.1:0"]);
    let greeting = sim.wait_for("Connect with", LIMIT);
    let served = format!("tcp:{},stream=usb", greeting.rsplit("tcp:").next().unwrap_or_default().trim());
    let like = format!("sim:like={json}");
    for target in [served.as_str(), like.as_str()] {
        let status = run(&["status", "--json", "--connect", target]);
        assert_eq!(status.status.code(), Some(0), "{target}: {status:?}");
        let status: Value = serde_json::from_str(&status.stdout.join("\n")).expect("JSON");
        assert_eq!(status["identity"]["version_text"], json!(found.unit.version_text));
        assert_eq!(status["identity"]["generation"], json!(2));
    }
    let none = run(&["sim", "--like", &text, "--tcp", "127.0.0.1:0"]);
    assert_eq!(none.status.code(), Some(2), "{none:?}");
    assert!(none.stderr.join("\n").contains("no report of an examination"), "{none:?}");
}
