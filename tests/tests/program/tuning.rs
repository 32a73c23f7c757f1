//! Whole tuning runs through the device thread with real bytes, in virtual time: faults, Stop and a lost cable at every stage.

use brushwork_tests::said::Said;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use brushwork_core::keep::{Keeping, Store, TrialKeeper, UnitId};
use brushwork_core::tune::law::{Report, Request as Tuning, Setup};
use brushwork_core::tune::live::Live;
use brushwork_core::tune::{Slot, Target, leaves_off, prepare, restore, run, take};
use brushwork_link::device::{
    ArmScope, DeviceOptions, Event, Job, JobContext, JobEnding, JobTicket, Request,
};
use brushwork_link::files::SimulatedDisk;
use brushwork_link::settings::{
    Act, Ending, Entry, Keeper, SettingsTable, Subject, WriteOptions, read_all, save_kept, write,
};
use brushwork_link::{Failure, Stream};
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_sim::motion::MotionSettings;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::{
    Address, Generation, Given, Request as Packet, Typed, commands, give, name,
};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::presets;
use brushwork_plant::world::WorldAction;
use brushwork_plant::{EncoderKind, StopKind, TravelParams};
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_tuning::axis::EncoderClass;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::{Excitation, Method};
use brushwork_values::Motor;

const TARGET: Target =
    Target { motor: Motor::M1, encoder: Some(EncoderClass::Quadrature), stream: Some(Stream::Usb) };

fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

fn connected() -> VirtualLink {
    connected_to(ControllerConfig::default())
}

fn connected_to(config: ControllerConfig) -> VirtualLink {
    let unit = Controller::new(config).expect("the world is sound");
    let bus = Bus::single(unit, StreamIndex::Usb);
    let mut link = VirtualLink::new(bus, StreamIndex::Usb, options(), Vec::new(), 1);
    link.run_for(ms(2_000));
    link
}

fn options() -> DeviceOptions {
    DeviceOptions { stream: Some(Stream::Usb), simulated: true, ..DeviceOptions::default() }
}

/// What the controller's loop, time-out and limits are set to.
fn settings(link: &VirtualLink) -> (MotionSettings, u32) {
    link.bus(|bus| {
        let settings = bus.controllers()[0].settings();
        (settings.motors[0].motion, settings.streams[0].timeout_ms)
    })
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
    tuned_as(link, TARGET, request, |link, _| before_run(link))
}

fn tuned_as(
    link: &mut VirtualLink,
    target: Target,
    request: Tuning,
    before_run: impl FnOnce(&VirtualLink, &Arc<JobTicket<()>>),
) -> Option<Report> {
    let setup: Slot<Setup> = Slot::default();
    let (keeper, journal) = keeper();
    let prepared = link.finish(prepare(target, subject(), &setup, &keeper), ms(5_000));
    assert!(matches!(prepared, Some(JobEnding::Done(_))), "{prepared:?}");
    let before = take(&setup).expect("it was read");
    let target = Target { encoder: Some(before.encoder), ..target };
    assert_backed_up(link, &journal);
    assert!(link.arm(ArmScope::CommandLine), "{:?}", link.events);
    let found: Slot<Report> = Slot::default();
    let (job, ticket) = run(target, request, &found, &Live::default()).queued();
    let ticket = Arc::new(ticket);
    before_run(link, &ticket);
    link.events.clear();
    link.ask(Request::Job(job));
    link.finish_begun(&ticket, ms(60_000));
    let report = take(&found);
    // From full duty to none at the highest acceleration takes 50 ms.
    link.line.pass(ms(60));
    assert!(link.duties(0)[0].abs() < 1e-6, "a run ends with the motor off");
    if !link.ended {
        link.finish(
            restore(target, before, report.as_ref(), leaves_off(report.as_ref(), None), &keeper),
            ms(5_000),
        );
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
    brushwork_mcp_client::subject(models::lookup("mcp266").expect("it is listed"), Generation::Gen1)
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
    assert_eq!(timeout_ms, 200, "shortened after the backup: {kept_timeout:?}");
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
    let new = report.proposed.first.first.velocity.expect("gains");
    let (after, timeout_after_ms) = settings(&link);
    assert_eq!((after.velocity_p_raw, after.velocity_i_raw, after.qpps), (new.p, new.i, new.qpps));
    assert_ne!(after.qpps, before.qpps);
    assert_eq!(timeout_after_ms, timeout_ms);
}

/// Limits of 0 to 0 hold a motor where it is. Those of an axis that turns freely stay near it: within 2 billion no slider can be set.
#[test]
fn an_axis_that_turns_freely_gets_position_limits_of_a_minute_at_full_speed() {
    let mut link = connected();
    let held = settings(&link).0;
    assert_eq!((held.position_min_counts, held.position_max_counts), (0, 0));
    let report = tuned(&mut link, Tuning { method: Method::Piv, keep: true, ..velocity() }, |_| {});
    let report = report.expect("a report");
    let position = report.proposed.first.first.position.expect("gains");
    let minute = 60.0 * report.qpps.expect("it was measured");
    for limit in [-f64::from(position.min), f64::from(position.max)] {
        assert!(limit >= minute && limit <= minute + 1_000.0, "{limit} of {minute}");
    }
    let held = settings(&link).0;
    assert_eq!((held.position_min_counts, held.position_max_counts), (position.min, position.max));
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

/// What can break while a motor is driven, and how it is to be named.
fn faults_in_motion() -> [(WorldAction, Cause); 5] {
    let motor = Motor::M1;
    [
        (WorldAction::LoseEncoder { motor, on: true }, Cause::EncoderLost),
        (WorldAction::LockShaft { motor, on: true }, Cause::Stalled),
        (WorldAction::OpenLead { motor, on: true }, Cause::MotorOpened),
        (WorldAction::ReverseEncoder { motor, on: true }, Cause::EncoderFlipped),
        (WorldAction::SetBatteryVolts { volts: 5.5 }, Cause::BatteryLow),
    ]
}

#[test]
fn faults_in_mid_run_stop_the_motor_and_are_named() {
    for (action, cause) in faults_in_motion() {
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
fn faults_while_a_loop_has_the_motor_stop_it_and_are_named() {
    let in_loops = |stage: &str| stage.contains("lag of the loop") || stage.contains("Trying the gains");
    for method in [Method::Velocity, Method::Piv] {
        let request = Tuning { method, ..velocity() };
        let stages: Vec<_> = stages(request).into_iter().filter(|stage| in_loops(&stage.0)).collect();
        assert_eq!(stages.len(), 2, "{stages:?}");
        for (stage, at) in stages {
            for (action, cause) in faults_in_motion() {
                let mut link = connected();
                let before = settings(&link);
                let report =
                    tuned(&mut link, request, |link| strike(link, at, action.clone())).expect("a report");
                let said = format!("{method:?}, {stage} at {at:?}, {action:?}");
                assert_eq!(report.causes.first(), Some(&cause), "{said}: {:?}", report.causes);
                // A loop that holds a place shows some faults with its next move.
                let went_on_s = report.seconds.1 - at.as_secs_f64();
                assert!(went_on_s < 1.5, "{said}: the run went on for {went_on_s} s");
                assert_eq!(settings(&link), before, "{said}");
            }
        }
    }
}

/// The stages of a run, by what it says it does, each with the middle of its time after the run was asked for.
fn stages(request: Tuning) -> Vec<(String, Duration)> {
    let mut link = connected();
    let setup: Slot<Setup> = Slot::default();
    link.finish(prepare(TARGET, subject(), &setup, &keeper().0), ms(5_000));
    assert!(link.arm(ArmScope::CommandLine), "{:?}", link.events);
    let begun = link.now();
    let reported: Arc<Mutex<Vec<(Event, Duration)>>> = Arc::default();
    // A job is one step of the loop: what it tells is taken in between, as a window does.
    for look in 1..3_000 {
        let (at, reported) = (begun + 10 * ms(look), Arc::clone(&reported));
        link.at(at, move |handle| {
            let mut reported = reported.lock().expect("no test panics with it");
            reported.extend(handle.events().try_iter().map(|event| (event, at)));
        });
    }
    link.start(run(TARGET, request, &Slot::default(), &Live::default()));
    link.run_for(ms(29_000));
    let mut starts: Vec<(String, Duration)> = Vec::new();
    let mut end = begun;
    for (event, at) in reported.lock().expect("no test panics with it").iter() {
        match event {
            Event::JobProgress { text, .. } if starts.last().is_none_or(|(last, _)| last != text) => {
                starts.push((text.clone(), *at));
            }
            Event::JobEnded(_) => end = *at,
            _ => {}
        }
    }
    let ends = starts.iter().skip(1).map(|start| start.1).chain([end]);
    let middles =
        starts.iter().zip(ends).map(|((text, start), end)| (text.clone(), (*start + end) / 2 - begun));
    middles.collect()
}

fn in_travel() -> Tuning {
    let mut request = Tuning { method: Method::Pid, excitation: Excitation::Window(3_000.0), ..velocity() };
    request.guard.travel = Some((-1_500, 1_500));
    request
}

#[test]
fn stop_and_cancel_at_every_stage_stand_the_motor_and_put_the_old_gains_back() {
    for request in [velocity(), Tuning { method: Method::Piv, ..velocity() }, in_travel()] {
        let stages = stages(request);
        assert!(stages.len() >= 4, "{stages:?}");
        for (text, after) in stages {
            for cancels in [false, true] {
                let place = format!("{:?}, \"{text}\", after {after:?}, cancels: {cancels}", request.method);
                let mut link = connected();
                let before = settings(&link);
                let report = tuned_as(&mut link, TARGET, request, |link, ticket| {
                    let ticket = Arc::clone(ticket);
                    link.at(link.now() + after, move |handle| {
                        if cancels {
                            ticket.cancel();
                        } else {
                            handle.stop_all();
                        }
                    });
                });
                assert_eq!(
                    report.map(|report| report.verdict),
                    Some(Verdict::Refused),
                    "{place}: it was stopped"
                );
                assert_eq!(settings(&link), before, "{place}");
                link.run_for(ms(1_000));
                assert!(link.speeds(0)[0].abs() < 0.01, "{place}: it still turns");
            }
        }
    }
}

#[test]
fn a_cable_pulled_at_every_stage_leaves_the_motor_to_the_controllers_time_out() {
    for request in [velocity(), Tuning { method: Method::Piv, ..velocity() }, in_travel()] {
        for (text, after) in stages(request) {
            let mut link = connected();
            let setup: Slot<Setup> = Slot::default();
            link.finish(prepare(TARGET, subject(), &setup, &keeper().0), ms(5_000));
            assert!(link.arm(ArmScope::CommandLine), "{:?}", link.events);
            strike(&link, after, WorldAction::Unplug { unplugged: true });
            let found: Slot<Report> = Slot::default();
            link.finish(run(TARGET, request, &found, &Live::default()), ms(20_000));
            link.machine_alone_for(ms(400));
            let duty = link.bus(|bus| bus.controllers()[0].view().axes[0].output.duty());
            assert_eq!(duty, 0.0, "{:?}, pulled at \"{text}\"", request.method);
            let report = take(&found).expect("a run that was cut leaves its report");
            assert_eq!(
                report.causes.first(),
                Some(&Cause::LinkLost),
                "{:?}, pulled at \"{text}\"",
                request.method
            );
        }
    }
}

/// A program dies in the midst of a run, and another one connects.
#[test]
fn a_program_killed_at_any_moment_of_a_run_leaves_a_journal_by_which_all_is_given_back_bit_for_bit() {
    let mut left_changed = 0;
    for killed_after in (0..900).step_by(30).chain((1_900..9_000).step_by(700)).map(ms) {
        let store = Store::on(Arc::new(SimulatedDisk::default()), "/keep");
        let mut link = connected();
        let before = settings(&link);
        let identity = link.events.iter().find_map(|(_, event)| match event {
            Event::Connected(identity) => Some(identity.clone()),
            _ => None,
        });
        let unit = UnitId::new(&identity.expect("it was found"), &[]);
        let keeping = Keeping::new(store.clone());
        let keeper = TrialKeeper::new(keeping.keeper(unit.clone(), ""));
        let setup: Slot<Setup> = Slot::default();
        let found: Slot<Report> = Slot::default();
        // The cable goes in the midst of it, and the program is killed then.
        strike(&link, killed_after, WorldAction::Unplug { unplugged: true });
        link.finish(prepare(TARGET, subject(), &setup, &keeper), ms(5_000));
        if !link.ended && link.arm(ArmScope::CommandLine) {
            link.finish(run(TARGET, velocity(), &found, &Live::default()), ms(20_000));
        }
        link.run_for(ms(10_000));
        assert!(link.ended, "{killed_after:?}");
        link.apply(0, &WorldAction::Unplug { unplugged: false });
        let mut link = link.killed_and_opened_again(options());
        link.run_for(ms(2_000));
        let is_changed = settings(&link) != before;
        left_changed += usize::from(is_changed);
        let (journals, faults) = store.open_journals(&unit);
        assert!(faults.is_empty(), "{faults:?}");
        assert!(journals.len() == 1 || !is_changed, "killed after {killed_after:?}: nothing is offered");
        for open in journals {
            let work = move |wire: &mut JobContext<'_>| {
                let ram = read_all(wire, subject())?;
                let back = open.journal.remedy(&ram.image, true);
                let options = WriteOptions { own_stream: Some(Stream::Usb), simulated: true, as_read: true };
                write(wire, &ram.table, &back, options).map_err(|error| panic!("{error}"))
            };
            let ended = link.finish(Job::new(Said::Work, ms(30_000), work), ms(30_000));
            assert!(matches!(ended, Some(JobEnding::Done(_))), "{ended:?}");
        }
        assert_eq!(settings(&link), before, "killed after {killed_after:?}");
    }
    assert!(left_changed > 10, "{left_changed}, so the test tests little");
}

#[test]
fn a_slow_default_acceleration_does_not_slow_the_experiments() {
    let model = |slow: bool| {
        let mut link = connected();
        if slow {
            // 10 % of the duty range a second (commands 68 and 69, MCP manual): 3277 of 32767.
            set(&link, commands::SET_DEFAULT_ACCEL_M1, &[give(name::ACCEL, 3_277)]);
            link.run_for(ms(100));
        }
        let report = tuned(&mut link, velocity(), |_| {}).expect("a report");
        assert_ne!(report.verdict, Verdict::Refused, "slow: {slow}: {:?}", report.causes);
        (report.qpps.expect("measured"), report.fit.expect("fitted").model.tau_s)
    };
    let ((qpps, tau_s), (slow_qpps, slow_tau_s)) = (model(false), model(true));
    assert!((slow_qpps / qpps - 1.0).abs() < 0.01, "{qpps} {slow_qpps}");
    assert!((slow_tau_s / tau_s - 1.0).abs() < 0.05, "{tau_s} {slow_tau_s}");
}

#[test]
fn gains_that_were_kept_and_saved_are_there_after_a_power_cycle_and_so_is_the_users_time_out() {
    let mut link = connected();
    let (_, timeout_ms) = settings(&link);
    let report = tuned(&mut link, Tuning { keep: true, ..velocity() }, |_| {}).expect("a report");
    let new = report.proposed.first.first.velocity.expect("gains");
    let table = SettingsTable::new(subject());
    let options = WriteOptions { own_stream: Some(Stream::Usb), simulated: true, as_read: false };
    let saving = Job::new(Said::Save, ms(60_000), move |wire| {
        save_kept(wire, &table, options, &mut Noting(Journal::default()))
    });
    let saved = link.finish(saving, ms(60_000));
    assert!(matches!(saved, Some(JobEnding::Done(_))), "{saved:?}");
    for powered in [false, true] {
        link.apply(0, &WorldAction::Power { on: powered });
        link.machine_alone_for(ms(1_500));
    }
    let (after, timeout_after_ms) = settings(&link);
    assert_eq!((after.velocity_p_raw, after.velocity_i_raw, after.qpps), (new.p, new.i, new.qpps));
    assert_eq!(timeout_after_ms, timeout_ms);
}

/// An axis with hard end stops so many counts on either side.
fn between_end_stops(counts: f64) -> ControllerConfig {
    let mut config = ControllerConfig::default();
    let axis = &mut config.world.axes[0];
    let radians = counts / axis.counts_per_motor_radian() / axis.gear.ratio;
    axis.load.travel =
        Some(TravelParams { lower_radians: -radians, upper_radians: radians, stop: StopKind::default() });
    config
}

#[test]
fn an_end_stop_that_nobody_told_of_stops_the_run_and_is_named() {
    let mut link = connected_to(between_end_stops(2_500.0));
    let before = settings(&link);
    let report = tuned(&mut link, velocity(), |_| {}).expect("a report");
    assert_eq!(report.causes.first(), Some(&Cause::Stalled), "{:?}", report.causes);
    assert!(report.seconds.1 < 3.0, "{} s", report.seconds.1);
    assert_eq!(settings(&link), before);
}

#[test]
fn a_travel_is_never_left_and_a_motor_that_stands_outside_is_not_moved() {
    let counts = |link: &VirtualLink| link.bus(|bus| bus.controllers()[0].view().axes[0].encoder_counts);
    let mut link = connected();
    let mut narrow = in_travel();
    narrow.guard.travel = Some((-40, 40));
    narrow.excitation = Excitation::Window(80.0);
    let report = tuned(&mut link, narrow, |_| {}).expect("a report");
    assert!(counts(&link).abs() <= 40, "{:?} at {}", report.causes, counts(&link));
    let mut elsewhere = in_travel();
    elsewhere.guard.travel = Some((5_000, 9_000));
    let mut link = connected();
    let (before, start) = (settings(&link), counts(&link));
    let report = tuned(&mut link, elsewhere, |_| {}).expect("a report");
    assert_eq!((report.verdict, report.causes.first()), (Verdict::Refused, Some(&Cause::OutsideTravel)));
    assert_eq!(counts(&link), start, "it was not moved");
    assert_eq!(settings(&link), before);
}

/// The actuator with a potentiometer of the presets, or a turntable whose encoder goes on from 4095 to 0.
fn absolute(wraps: bool) -> ControllerConfig {
    let preset = presets::lookup("linear-actuator").expect("a preset");
    let default = ControllerConfig::default();
    let mut world = presets::world_of(preset, preset, default.model.pins.len());
    if wraps {
        let axis = &mut world.axes[0];
        axis.load.travel = None;
        axis.encoder.kind = EncoderKind::Pulse;
        axis.encoder.wraps = true;
        axis.encoder.counts_per_turn = 1_365.0;
    }
    ControllerConfig { world, ..default }
}

#[test]
fn the_kind_of_encoder_is_read_from_the_controller_and_an_absolute_one_is_tuned_in_position() {
    for method in [Method::Pd, Method::Pid, Method::Piv] {
        let mut link = connected_to(absolute(false));
        let before = settings(&link);
        let asked = Target { encoder: None, ..TARGET };
        let report =
            tuned_as(&mut link, asked, Tuning { method, ..velocity() }, |_, _| {}).expect("a report");
        assert_eq!(report.before.map(|setup| setup.encoder), Some(EncoderClass::Absolute));
        assert_ne!(report.verdict, Verdict::Refused, "{method:?}: {:?}", report.causes);
        assert!(report.window.is_some() && report.free.is_none(), "it never runs freely against its ends");
        assert_eq!(settings(&link), before, "{method:?}");
        assert!(report.replay().is_some_and(|again| again == report), "{method:?}: the replay differs");
    }
}

#[test]
fn the_speed_of_an_absolute_encoder_that_wraps_is_refused_before_anything_moves() {
    let mut link = connected_to(absolute(true));
    let before = settings(&link);
    let turns = |link: &VirtualLink| link.bus(|bus| bus.controllers()[0].view().axes[0].truth.motor_radians);
    let start = turns(&link);
    let asked = Target { encoder: Some(EncoderClass::AbsoluteWrapping), ..TARGET };
    let report = tuned_as(&mut link, asked, velocity(), |_, _| {}).expect("a report");
    assert_eq!((report.verdict, report.causes.first()), (Verdict::Refused, Some(&Cause::WrappingEncoder)));
    assert_eq!(turns(&link), start);
    let report =
        tuned_as(&mut link, asked, Tuning { method: Method::Pd, ..velocity() }, |_, _| {}).expect("a report");
    assert_ne!(report.verdict, Verdict::Refused, "{:?}", report.causes);
    assert_eq!(settings(&link), before);
}

/// What the unit's current limit and its inductance and resistance are set to.
fn held(link: &VirtualLink) -> (u32, i32, [u32; 2]) {
    let motion = settings(link).0;
    (motion.max_current_raw, motion.min_current_raw, [motion.inductance_raw, motion.resistance_raw])
}

fn set<const L: u8>(link: &VirtualLink, command: Typed<L>, given: &[Given<L>]) {
    link.bus(|bus| {
        let generation = bus.controllers()[0].config().generation;
        let packet = Packet::typed(Address::DEFAULT, command, generation, given).expect("the values fit");
        let bytes = packet.encode(generation).expect("it encodes");
        bus.receive(StreamIndex::Usb, &bytes);
    });
}

#[test]
fn torque_mode_is_refused_and_left_only_with_the_users_word_and_put_back() {
    let mut link = connected();
    // L 1 mH (16777 of 2^24), R 0.5 ohm (8388608 of 2^24): duty is a current (MCP manual 1.2.11).
    set(
        &link,
        commands::SET_INDUCTANCE_RESISTANCE_M1,
        &[give(name::INDUCTANCE, 16_777), give(name::RESISTANCE, 8_388_608)],
    );
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
