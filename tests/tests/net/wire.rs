//! Every byte that the device thread sends while it connects, polls, reads, writes, saves, drives, stops and tunes, in virtual time.

use brushwork_link::Message;
use brushwork_tests::said::Said;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::time::Duration;

use brushwork_canopen::adapter::Form;
use brushwork_core::keep::TrialKeeper;
use brushwork_core::tune::law::{Report, Request as Tuning, Setup};
use brushwork_core::tune::live::Live;
use brushwork_core::tune::{Slot, Target, leaves_off, prepare, restore, run, take};
use brushwork_link::FamilyChoice;
use brushwork_link::device::{ArmScope, DeviceOptions, Event, Job, JobContext, JobEnding, Request};
use brushwork_link::settings::{
    Ending, Entry, Keeper, SettingValue, SettingsImage, SettingsTable, Subject, WriteOptions, read_all,
    reload, save_eeprom, write,
};
use brushwork_link::{Failure, Stream};
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_motion_mind_sim::{MotionMind, MotionMindBus, MotionMindConfig};
use brushwork_motion_mind_wire::{Mode, Protocol};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_tuning::axis::EncoderClass;
use brushwork_tuning::tune::{Excitation, Method};
use brushwork_values::Motor;

use crate::assert_kept;

fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

/// What was sent, by acts.
#[derive(Default)]
struct Transcript(String);

impl Transcript {
    /// Every write of an act, a line each.
    fn act<M: Machine + 'static>(&mut self, name: &str, link: &VirtualLink<M>) {
        writeln!(self.0, "# {name}").expect("a string takes everything");
        for bytes in link.take_written() {
            let hex: Vec<String> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
            writeln!(self.0, "{}", hex.join(" ")).expect("a string takes everything");
        }
    }

    /// An act of thousands of writes: how many of each kind, and a checksum over all.
    fn long_act<M: Machine + 'static>(&mut self, name: &str, link: &VirtualLink<M>) {
        let written = link.take_written();
        let mut kinds: BTreeMap<String, usize> = BTreeMap::new();
        for bytes in &written {
            let kind: Vec<String> = bytes.iter().take(3).map(|byte| format!("{byte:02X}")).collect();
            *kinds.entry(kind.join(" ")).or_default() += 1;
        }
        let sum = crc32fast::hash(&written.concat());
        writeln!(self.0, "# {name}: {} writes, CRC-32 {sum:08X}", written.len())
            .expect("a string takes everything");
        for (kind, count) in kinds {
            writeln!(self.0, "{kind} ... x {count}").expect("a string takes everything");
        }
    }
}

fn job<M: Machine + 'static, T: Send + 'static>(
    link: &mut VirtualLink<M>,
    work: impl FnMut(&mut JobContext<'_>) -> Result<T, Failure> + Send + 'static,
) {
    let ending = link.finish(Job::new(Said::Work, LIMIT, work), LIMIT);
    assert!(matches!(ending, Some(JobEnding::Done(_))), "{ending:?}: {:?}", link.events);
}

/// What any job may take.
const LIMIT: Duration = Duration::from_secs(120);

const OPTIONS: WriteOptions = WriteOptions { own_stream: None, simulated: true, as_read: false };

/// Connects, reads and writes settings, arms, drives and stops.
fn worked<M: Machine + 'static>(
    link: &mut VirtualLink<M>,
    subject: Subject,
    changes: &[(&str, SettingValue)],
) -> Transcript {
    let mut transcript = Transcript::default();
    link.run_for(ms(3_000));
    let found = link.events.iter().filter(|(_, event)| matches!(event, Event::Connected(_))).count();
    assert_eq!(found, 1, "{:?}", link.events);
    transcript.act("connect, and poll for the rest of 3 s", link);
    job(link, move |wire| read_all(wire, subject));
    transcript.act("read all settings", link);
    let wanted: SettingsImage = changes.iter().map(|(key, value)| ((*key).to_owned(), *value)).collect();
    job(link, move |wire| {
        let report = write(wire, &SettingsTable::new(subject), &wanted, OPTIONS)
            .map_err(|error| Failure::new(Said::Write, "it", Message::error(error), Said::Look))?;
        assert!(report.is_complete(), "{report:?}");
        Ok(())
    });
    transcript.act("write some", link);
    job(link, move |wire| save_eeprom(wire, &SettingsTable::new(subject), OPTIONS));
    transcript.act("save them", link);
    job(link, move |wire| reload(wire, &SettingsTable::new(subject)));
    transcript.act("load what was saved", link);
    if link.arm(ArmScope::Pwm) {
        transcript.act("arm, for 0.3 s", link);
        link.drive(0.25);
        link.run_for(ms(300));
        transcript.act("drive at a quarter of full duty, for 0.3 s", link);
    } else {
        // Some RoboClaws do not tell their time-out.
        transcript.act("arm, which is refused, for 0.3 s", link);
    }
    link.handle.stop_all();
    link.run_for(ms(300));
    transcript.act("stop, and 0.3 s", link);
    link.ask(Request::Disarm);
    link.run_for(ms(100));
    link.ask(Request::Disconnect);
    link.run_for(ms(500));
    transcript.act("disarm and disconnect", link);
    assert!(link.ended);
    transcript
}

fn mcp_subject(model: &str, generation: Generation) -> Subject {
    brushwork_mcp_client::subject(models::lookup(model).expect("it is listed"), generation)
}

fn mcp(model: &str, generation: Generation) -> Controller {
    let model = models::lookup(model).expect("it is listed");
    let config = ControllerConfig { model, generation, ..ControllerConfig::default() };
    Controller::new(config).expect("the default world is sound")
}

fn usb() -> DeviceOptions {
    DeviceOptions { stream: Some(Stream::Usb), simulated: true, ..DeviceOptions::default() }
}

const MCP_CHANGES: [(&str, SettingValue); 4] = [
    ("motor1.velocity.qpps", SettingValue::Int(12_345)),
    ("motor1.velocity.p", SettingValue::Number(0.5)),
    ("motor2.current.max_amps", SettingValue::Number(7.5)),
    ("limits.main_battery.min_volts", SettingValue::Number(11.0)),
];

#[test]
fn an_mcp_and_a_roboclaw_of_every_generation_are_sent_what_they_were() {
    for (model, generations) in [
        ("mcp266", Generation::ALL.to_vec()),
        ("roboclaw-2x7a", Generation::ALL.to_vec()),
        ("mcp2163", vec![Generation::Gen1]),
    ] {
        for generation in generations {
            let bus = Bus::single(mcp(model, generation), StreamIndex::Usb);
            let mut link = VirtualLink::new(bus, StreamIndex::Usb, usb(), Vec::new(), 1);
            let transcript = worked(&mut link, mcp_subject(model, generation), &MCP_CHANGES);
            assert_kept(&format!("wire/{model} {generation}.txt"), &transcript.0);
        }
    }
}

#[test]
fn a_node_of_a_can_bus_is_sent_what_it_was() {
    let bus = Bus::on_can(vec![mcp("mcp266", Generation::Gen1)], Form::Ascii).expect("there is a unit");
    let options = DeviceOptions { simulated: true, ..DeviceOptions::default() };
    let mut link = VirtualLink::on_can(bus, Form::Ascii, options, Vec::new(), 1);
    let transcript = worked(&mut link, mcp_subject("mcp266", Generation::Gen1), &MCP_CHANGES);
    assert_kept("wire/mcp266 can.txt", &transcript.0);
}

fn motion_mind(mode: Mode, protocol: Protocol) -> (VirtualLink<MotionMindBus>, Subject) {
    let config = MotionMindConfig { protocol, ..MotionMindConfig::new(mode) };
    let bus = MotionMindBus::new(vec![MotionMind::new(config).expect("the default motor is sound")]);
    let options = DeviceOptions {
        simulated: true,
        family: FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND),
        ..DeviceOptions::default()
    };
    let revision = u8::try_from(bus.motion_minds()[0].read_one(17)).expect("a revision is small");
    let subject = brushwork_motion_mind_client::subject(revision);
    (VirtualLink::over(bus, options, Vec::new(), 1), subject)
}

#[test]
fn a_motion_mind_is_sent_what_it_was_in_both_protocols() {
    let changes = [
        ("register.pterm", SettingValue::Int(1_234)),
        ("register.ampslimit", SettingValue::Number(5.0)),
        ("function.satprot", SettingValue::Bool(true)),
        ("register.vnlimit", SettingValue::Int(-123_456)),
    ];
    for protocol in Protocol::ALL {
        let (mut link, subject) = motion_mind(Mode::Serial, protocol);
        let transcript = worked(&mut link, subject, &changes);
        assert_kept(&format!("wire/motion mind {protocol}.txt"), &transcript.0);
    }
}

struct Forgetful;

impl Keeper for Forgetful {
    fn begin(&mut self, _: Entry) {}

    fn begun(&mut self) -> Option<Result<(), Failure>> {
        Some(Ok(()))
    }

    fn end(&mut self, _: Ending) {}
}

/// Prepares, tunes and gives back, as the program does.
fn tuned<M: Machine + 'static>(
    link: &mut VirtualLink<M>,
    subject: Subject,
    target: Target,
    request: Tuning,
) -> Transcript {
    let mut transcript = Transcript::default();
    link.run_for(ms(6_000));
    link.take_written();
    let setup: Slot<Setup> = Slot::default();
    let keeper = TrialKeeper::new(Box::new(Forgetful));
    link.finish(prepare(target, subject, &setup, &keeper), LIMIT);
    transcript.act("prepare", link);
    let before = take(&setup).expect("it was read");
    assert!(link.arm(ArmScope::CommandLine), "{:?}", link.events);
    transcript.act("arm", link);
    let found: Slot<Report> = Slot::default();
    link.finish(run(target, request, &found, &Live::default()), LIMIT);
    transcript.long_act("run", link);
    let report = take(&found);
    let left_off = leaves_off(report.as_ref(), None);
    link.finish(restore(target, before, report.as_ref(), left_off, &keeper), LIMIT);
    transcript.act("give back", link);
    transcript
}

#[test]
fn a_tuning_run_sends_what_it_did() {
    for (name, method, excitation) in [
        ("velocity", Method::Velocity, Tuning::default().excitation),
        ("piv", Method::Piv, Excitation::Window(3_000.0)),
    ] {
        let bus = Bus::single(mcp("mcp266", Generation::Gen1), StreamIndex::Usb);
        let mut link = VirtualLink::new(bus, StreamIndex::Usb, usb(), Vec::new(), 1);
        let encoder = Some(EncoderClass::Quadrature);
        let target = Target { motor: Motor::M1, encoder, stream: Some(Stream::Usb) };
        let request = Tuning { method, excitation, ..Tuning::default() };
        let transcript = tuned(&mut link, mcp_subject("mcp266", Generation::Gen1), target, request);
        assert_kept(&format!("wire/tune mcp266 {name}.txt"), &transcript.0);
    }
    for (protocol, method) in [(Protocol::Binary, Method::Velocity), (Protocol::Text, Method::Pd)] {
        let (mut link, subject) = motion_mind(Mode::SerialPid, protocol);
        let target = Target { motor: Motor::M1, encoder: Some(EncoderClass::Quadrature), stream: None };
        let transcript = tuned(&mut link, subject, target, Tuning { method, ..Tuning::default() });
        assert_kept(&format!("wire/tune motion mind {protocol}.txt"), &transcript.0);
    }
}
