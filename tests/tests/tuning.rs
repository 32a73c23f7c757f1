//! Whole tuning runs through the device thread with real bytes, in virtual time: faults, Stop and a lost cable at every stage.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use brushwork::keep::TrialKeeper;
use brushwork::tune::{Slot, Target, prepare, restore, run, take};
use brushwork_link::device::{ArmScope, DeviceOptions, Event, Job, JobEnding, Request};
use brushwork_link::settings::{Act, Ending, Entry, Keeper, Subject};
use brushwork_link::{Failure, Stream};
use brushwork_protocol::models;
use brushwork_protocol::packet_serial::{Address, Generation, Motor, Request as Packet, number};
use brushwork_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_sim::machine::{Machine, StreamIndex};
use brushwork_sim::motion::MotionSettings;
use brushwork_sim::world::WorldAction;
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_tuning::axis::{EncoderClass, Setup};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::report::{Report, Verdict};
use brushwork_tuning::tune::{Excitation, Method, Request as Tuning};

const TARGET: Target =
    Target { motor: Motor::M1, encoder: EncoderClass::Quadrature, stream: Some(Stream::Usb) };

fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

fn connected() -> VirtualLink {
    let unit = Controller::new(ControllerConfig::default()).expect("the default world is sound");
    let options = DeviceOptions { stream: Some(Stream::Usb), simulated: true, ..DeviceOptions::default() };
    let bus = Bus::single(unit, StreamIndex::Usb);
    let mut link = VirtualLink::new(bus, StreamIndex::Usb, options, Vec::new(), 1);
    link.run_for(ms(2_000));
    link
}

/// What the controller's loop, time-out and limits are set to.
fn settings(link: &VirtualLink) -> (MotionSettings, u32) {
    link.bus(|bus| {
        let settings = bus.controllers()[0].settings();
        (settings.motors[0].motion, settings.streams[0].timeout_ms)
    })
}

/// Runs a job to its end and gives it.
fn finish(link: &mut VirtualLink, job: Box<dyn Job>, longest: Duration) -> Option<JobEnding> {
    link.events.clear();
    link.ask(Request::Job(job));
    let end = link.now() + longest;
    while link.now() < end && !link.ended {
        link.run_for(ms(20));
        let found = link.events.iter().position(|(_, event)| matches!(event, Event::JobEnded(_)));
        if let Some((_, Event::JobEnded(report))) = found.map(|at| link.events.remove(at)) {
            return Some(report.ending);
        }
    }
    None
}

/// Something that happens to the machine at a time after the run began.
fn strike(link: &VirtualLink, after: Duration, action: WorldAction) {
    let line = link.line.clone();
    link.at(link.now() + after, move |_| {
        line.with(|machine| Machine::apply(machine.inner_mut().inner_mut(), 0, &action));
    });
}

/// The three jobs, as the program runs them.
fn tuned(link: &mut VirtualLink, request: Tuning, before_run: impl FnOnce(&VirtualLink)) -> Option<Report> {
    let setup: Slot<Setup> = Slot::default();
    let (keeper, journal) = keeper();
    let prepared = finish(link, prepare(TARGET, subject(), &setup, &keeper), ms(5_000));
    assert!(matches!(prepared, Some(JobEnding::Done(_))), "{prepared:?}");
    let before = take(&setup).expect("it was read");
    assert_backed_up(link, &journal);
    assert!(link.arm(ArmScope::CommandLine), "{:?}", link.events);
    before_run(link);
    let found: Slot<Report> = Slot::default();
    finish(link, run(TARGET, request, &found), ms(60_000));
    let report = take(&found);
    // From full duty to none at the highest acceleration takes 50 ms.
    link.line.pass(ms(60));
    assert!(link.duties(0)[0].abs() < 1e-6, "a run ends with the motor off");
    if !link.ended {
        finish(link, restore(TARGET, before, report.as_ref(), &keeper), ms(5_000));
    }
    let ending = journal.lock().expect("no test panics with it").1.clone();
    assert_eq!(ending, (!link.ended).then_some(Ending::Known), "a cut run leaves its journal open");
    report
}

/// What a run began with on this computer, and how it ended.
type Journal = Arc<Mutex<(Option<Entry>, Option<Ending>)>>;

struct Noting(Journal);

impl Keeper for Noting {
    fn begin(&mut self, entry: Entry) {
        self.0.lock().expect("no test panics with it").0 = Some(entry);
    }

    fn begun(&mut self) -> Option<Result<(), Failure>> {
        Some(Ok(()))
    }

    fn end(&mut self, ending: Ending) {
        self.0.lock().expect("no test panics with it").1 = Some(ending);
    }
}

fn keeper() -> (TrialKeeper, Journal) {
    let journal = Journal::default();
    (TrialKeeper::new(Box::new(Noting(journal.clone()))), journal)
}

fn subject() -> Subject {
    Subject::new(models::lookup("mcp266").expect("it is listed"), Generation::Gen1)
}

/// Everything was kept before the run changed anything, and the journal says what is to be as it was.
fn assert_backed_up(link: &VirtualLink, journal: &Journal) {
    let journal = journal.lock().expect("no test panics with it");
    let entry = journal.0.as_ref().expect("a run begins with a backup");
    assert_eq!((entry.act, journal.1.as_ref()), (Act::Trial, None));
    let (_, timeout_ms) = settings(link);
    let kept_timeout = entry.wanted.get("stream.usb.timeout");
    assert_ne!(kept_timeout, None);
    assert_eq!(entry.ram.get("stream.usb.timeout"), kept_timeout);
    assert_eq!(timeout_ms, 250, "shortened after the backup: {kept_timeout:?}");
    for key in ["motor1.velocity.p", "motor1.velocity.qpps", "motor1.position.p", "motor1.position.max"] {
        assert_eq!(entry.wanted.get(key), entry.ram.get(key), "{key}");
        assert!(entry.wanted.get(key).is_some(), "{key}");
    }
    assert_eq!(entry.wanted.get("motor2.velocity.p"), None, "another motor's are not its business");
}

fn velocity() -> Tuning {
    Tuning::default()
}

#[test]
fn a_run_over_the_device_thread_finds_gains_and_leaves_the_old_ones_in_force() {
    let mut link = connected();
    let before = settings(&link);
    let report = tuned(&mut link, velocity(), |_| {}).expect("a report");
    assert_ne!(report.verdict, Verdict::Refused, "{:?}", report.causes);
    let axis = link.bus(|bus| bus.controllers()[0].config().world.axes[0].clone());
    let full = axis.steady_counts_per_second(24.0);
    let qpps = report.qpps.expect("it was measured");
    assert!((qpps / full - 1.0).abs() < 0.03, "QPPS {qpps} of {full} without the battery's sag");
    assert_eq!(settings(&link), before, "gains and time-out are as they were");
    assert!(report.replay().is_some_and(|again| again == report), "the replay differs");
}

#[test]
fn a_run_that_keeps_its_gains_leaves_them_in_ram_and_the_users_time_out_in_force() {
    let mut link = connected();
    let (before, timeout_ms) = settings(&link);
    let request = Tuning { keep: true, ..velocity() };
    let report = tuned(&mut link, request, |_| {}).expect("a report");
    let new = report.velocity.expect("gains");
    let (after, timeout_after_ms) = settings(&link);
    assert_eq!((after.velocity_p_raw, after.velocity_i_raw, after.qpps), (new.p, new.i, new.qpps));
    assert_ne!(after.qpps, before.qpps);
    assert_eq!(timeout_after_ms, timeout_ms);
}

#[test]
fn a_position_run_stays_inside_its_travel() {
    let mut link = connected();
    let request = Tuning { method: Method::Piv, excitation: Excitation::Window(3_000.0), ..velocity() };
    let report = tuned(&mut link, request, |_| {}).expect("a report");
    assert_ne!(report.verdict, Verdict::Refused, "{:?}", report.causes);
    let reach = report.window.expect("it ran in the window").reach_counts;
    assert!(reach <= 1_500.0, "{reach} counts from the middle");
}

#[test]
fn faults_of_the_wiring_are_named_before_any_loop_is_closed() {
    let motor = Motor::M1;
    let faults = [
        (WorldAction::ReverseEncoder { motor, on: true }, Cause::EncoderReversed),
        (WorldAction::ReverseLeads { motor, on: true }, Cause::EncoderReversed),
        (WorldAction::LoseEncoder { motor, on: true }, Cause::EncoderDead),
        (WorldAction::OpenLead { motor, on: true }, Cause::MotorOpen),
        (WorldAction::LockShaft { motor, on: true }, Cause::ShaftLocked),
    ];
    for (action, cause) in faults {
        let mut link = connected();
        let before = settings(&link);
        let report = tuned(&mut link, velocity(), |link| link.apply(0, &action)).expect("a report");
        assert_eq!(report.causes.first(), Some(&cause), "{action:?}");
        assert!(report.seconds.1 < 1.7, "{action:?}: {} s", report.seconds.1);
        assert_eq!(settings(&link), before, "{action:?}");
    }
}

#[test]
fn faults_in_mid_run_stop_the_motor_and_are_named() {
    let motor = Motor::M1;
    let faults = [
        (WorldAction::LoseEncoder { motor, on: true }, Cause::EncoderLost),
        (WorldAction::LockShaft { motor, on: true }, Cause::Stalled),
        (WorldAction::OpenLead { motor, on: true }, Cause::MotorOpened),
        (WorldAction::ReverseEncoder { motor, on: true }, Cause::EncoderFlipped),
        (WorldAction::SetBatteryVolts { volts: 5.5 }, Cause::BatteryLow),
    ];
    for (action, cause) in faults {
        let mut link = connected();
        let before = settings(&link);
        let report =
            tuned(&mut link, velocity(), |link| strike(link, ms(800), action.clone())).expect("a report");
        assert_eq!(report.causes.first(), Some(&cause), "{action:?}: {:?}", report.causes);
        assert!(report.seconds.1 < 1.6, "{action:?}: the run went on for {} s", report.seconds.1);
        assert_eq!(settings(&link), before, "{action:?}");
    }
}

#[test]
fn stop_at_every_stage_stands_the_motor_and_puts_the_old_gains_back() {
    for after in (50..7_000).step_by(450) {
        let mut link = connected();
        let before = settings(&link);
        tuned(&mut link, velocity(), |link| {
            link.at(link.now() + ms(after), |handle| {
                handle.stop_all();
            });
        });
        assert_eq!(settings(&link), before, "stopped after {after} ms");
        link.run_for(ms(1_000));
        assert!(link.speeds(0)[0].abs() < 0.01, "stopped after {after} ms: it still turns");
    }
}

#[test]
fn a_cable_pulled_at_every_stage_leaves_the_motor_to_the_controllers_time_out() {
    for after in (50..7_000).step_by(450) {
        let mut link = connected();
        let setup: Slot<Setup> = Slot::default();
        finish(&mut link, prepare(TARGET, subject(), &setup, &keeper().0), ms(5_000));
        assert!(link.arm(ArmScope::CommandLine), "{:?}", link.events);
        strike(&link, ms(after), WorldAction::Unplug { unplugged: true });
        let found: Slot<Report> = Slot::default();
        finish(&mut link, run(TARGET, velocity(), &found), ms(20_000));
        link.machine_alone_for(ms(400));
        let duty = link.bus(|bus| bus.controllers()[0].view().axes[0].output.duty());
        assert_eq!(duty, 0.0, "pulled after {after} ms");
    }
}

/// What the unit's current limit and its inductance and resistance are set to.
fn held(link: &VirtualLink) -> (u32, i32, [u32; 2]) {
    let motion = settings(link).0;
    (motion.max_current_raw, motion.min_current_raw, [motion.inductance_raw, motion.resistance_raw])
}

fn set(link: &VirtualLink, command: u8, values: &[(&str, i64)]) {
    link.bus(|bus| {
        let generation = bus.controllers()[0].config().generation;
        let packet = Packet::named(Address::DEFAULT, command, generation, values).expect("the values fit");
        let bytes = packet.encode(generation).expect("it encodes");
        bus.receive(StreamIndex::Usb, &bytes);
    });
}

#[test]
fn torque_mode_is_refused_and_left_only_with_the_users_word_and_put_back() {
    let mut link = connected();
    // L 1 mH (16777 of 2^24), R 0.5 ohm (8388608 of 2^24): duty is a current (MCP manual 1.2.11).
    set(&link, number::SET_INDUCTANCE_RESISTANCE_M1, &[("inductance", 16_777), ("resistance", 8_388_608)]);
    link.run_for(ms(100));
    let before = held(&link);
    assert_eq!(before.2, [16_777, 8_388_608]);
    let refused = tuned(&mut link, velocity(), |_| {}).expect("a report");
    assert_eq!((refused.verdict, refused.causes.first()), (Verdict::Refused, Some(&Cause::TorqueMode)));
    assert_eq!(held(&link), before);
    let mut request = velocity();
    request.guard.clear_winding = true;
    let report = tuned(&mut link, request, |_| {}).expect("a report");
    assert_ne!(report.verdict, Verdict::Refused, "{:?}", report.causes);
    assert_eq!(held(&link), before, "L and R are back");
}

#[test]
fn the_highest_current_is_the_controllers_limit_during_a_run_and_the_users_after_it() {
    for stopped in [false, true] {
        let mut link = connected();
        let before = held(&link);
        let mut request = velocity();
        request.guard.max_amps = Some(0.8);
        tuned(&mut link, request, |link| {
            let line = link.line.clone();
            link.at(link.now() + ms(900), move |handle| {
                let during = line.with(|machine| {
                    let unit = &machine.inner_mut().inner_mut().controllers()[0];
                    unit.settings().motors[0].motion.max_current_raw
                });
                assert_eq!(during, 80, "10 mA units");
                if stopped {
                    handle.stop_all();
                }
            });
        });
        assert_eq!(held(&link), before, "stopped: {stopped}");
    }
}
