//! Whole tuning runs of a Motion Mind through the device thread with real bytes, in virtual time: both protocols, faults, Stop and a
//! lost cable.

use std::sync::Arc;
use std::time::Duration;

use brushwork_core::keep::TrialKeeper;
use brushwork_core::tune::law::{Report, Request as Tuning, Setup};
use brushwork_core::tune::live::Live;
use brushwork_core::tune::{Slot, Target, leaves_off, prepare, restore, run, take};
use brushwork_link::Failure;
use brushwork_link::FamilyChoice;
use brushwork_link::device::{ArmScope, DeviceOptions, JobEnding, JobTicket, Request};
use brushwork_link::settings::{Ending, Entry, Keeper, Subject};
use brushwork_motion_mind_sim::{Mode, MotionMind, MotionMindBus, MotionMindConfig, Protocol};
use brushwork_plant::machine::Machine;
use brushwork_plant::world::WorldAction;
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_tuning::axis::EncoderClass;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::Method;
use brushwork_values::Motor;

const TARGET: Target = Target { motor: Motor::M1, encoder: Some(EncoderClass::Quadrature), stream: None };
/// The registers that a run touches.
const TOUCHED: [u8; 11] = [2, 3, 4, 5, 6, 8, 23, 24, 26, 28, 30];

type Link = VirtualLink<MotionMindBus>;

fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

fn connected(protocol: Protocol) -> Link {
    let config = MotionMindConfig { protocol, ..MotionMindConfig::new(Mode::SerialPid) };
    let bus = MotionMindBus::new(vec![MotionMind::new(config).expect("the default motor is sound")]);
    let options = DeviceOptions {
        simulated: true,
        family: FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND),
        ..DeviceOptions::default()
    };
    let mut link = Link::over(bus, options, Vec::new(), 1);
    link.run_for(ms(6_000));
    link
}

fn registers(link: &Link) -> Vec<i64> {
    link.bus(|bus| TOUCHED.map(|number| bus.motion_minds()[0].read_one(number)).to_vec())
}

fn registers_of(link: &Link, number: u8) -> i64 {
    link.bus(|bus| bus.motion_minds()[0].read_one(number))
}

fn eeprom_writes(link: &Link) -> u64 {
    link.bus(|bus| bus.motion_minds()[0].eeprom_writes())
}

struct Forgetful;

impl Keeper for Forgetful {
    fn begin(&mut self, _: Entry) {}

    fn begun(&mut self) -> Option<Result<(), Failure>> {
        Some(Ok(()))
    }

    fn end(&mut self, _: Ending) {}
}

fn subject(link: &Link) -> Subject {
    let revision = link.bus(|bus| bus.motion_minds()[0].read_one(17)) as u8;
    brushwork_motion_mind_client::subject(revision)
}

fn tuned(link: &mut Link, request: Tuning, before_run: impl FnOnce(&Link)) -> Option<Report> {
    tuned_by(link, request, |link, _| before_run(link))
}

fn tuned_by(
    link: &mut Link,
    request: Tuning,
    before_run: impl FnOnce(&Link, &Arc<JobTicket<()>>),
) -> Option<Report> {
    let setup: Slot<Setup> = Slot::default();
    let keeper = TrialKeeper::new(Box::new(Forgetful));
    let subject = subject(link);
    let prepared = link.finish(prepare(TARGET, subject, &setup, &keeper), ms(30_000));
    assert!(matches!(prepared, Some(JobEnding::Done(_))), "{prepared:?}");
    let before = take(&setup).expect("it was read");
    assert!(link.arm(ArmScope::CommandLine), "{:?}", link.events);
    let found: Slot<Report> = Slot::default();
    let (job, ticket) = run(TARGET, request, &found, &Live::default()).queued();
    let ticket = Arc::new(ticket);
    before_run(link, &ticket);
    link.events.clear();
    link.ask(Request::Job(job));
    link.finish_begun(&ticket, ms(120_000));
    let report = take(&found);
    if !link.ended {
        // After a Stop in a loop the unit holds the motor where it is.
        assert!(link.duties(0)[0].abs() < 0.05, "a run ends with the motor at rest");
        let restored = link.finish(
            restore(TARGET, before, report.as_ref(), leaves_off(report.as_ref(), None), &keeper),
            ms(10_000),
        );
        assert!(matches!(restored, Some(JobEnding::Done(_))), "{restored:?}");
    }
    report
}

fn of(method: Method) -> Tuning {
    Tuning { method, ..Tuning::default() }
}

#[test]
fn each_loop_is_tuned_through_the_device_thread_replayed_to_the_bit_and_nothing_is_left_behind() {
    // At the 9600 baud that the switches set at first.
    for (protocol, method) in [
        (Protocol::Binary, Method::Velocity),
        (Protocol::Binary, Method::Pd),
        (Protocol::Binary, Method::Pid),
        (Protocol::Text, Method::Velocity),
        (Protocol::Text, Method::Pd),
    ] {
        let mut link = connected(protocol);
        let before = registers(&link);
        let report = tuned(&mut link, of(method), |_| {}).expect("the run left its report");
        let place = format!("{protocol:?} {method:?}: {:?} {:?}", report.verdict, report.causes);
        assert_ne!(report.verdict, Verdict::Refused, "{place}");
        assert!(report.proposed.first.second.motion_mind.is_some(), "{place}");
        assert!(report.replay().as_ref() == Some(&report), "{place}: the replay differs");
        assert_eq!(registers(&link), before, "{place}");
        assert_eq!(eeprom_writes(&link), 0, "{place}");
    }
}

#[test]
fn gains_that_are_kept_stay_in_ram_and_the_limits_are_the_users_again() {
    let mut link = connected(Protocol::Binary);
    let before = registers(&link);
    let report = tuned(&mut link, Tuning { keep: true, ..of(Method::Pd) }, |_| {}).expect("a report");
    let kept = report.proposed.first.second.motion_mind.expect("gains");
    let now = registers(&link);
    let proposed = [kept.pterm, kept.iterm, kept.dterm, u16::from(kept.pidscalar)].map(i64::from);
    assert_eq!(now[2..6], proposed);
    assert_eq!(now[1], i64::from(kept.function));
    assert_eq!(now[6..8], before[6..8], "the virtual limits");
    assert_eq!(eeprom_writes(&link), 0);
}

#[test]
fn a_dead_encoder_and_a_locked_shaft_are_named_and_all_is_put_back_but_the_loop_stays_off() {
    let motor = Motor::M1;
    let cases = [
        (Protocol::Binary, WorldAction::LoseEncoder { motor, on: true }, Cause::EncoderDead),
        (Protocol::Binary, WorldAction::ReverseEncoder { motor, on: true }, Cause::EncoderReversed),
        (Protocol::Binary, WorldAction::LockShaft { motor, on: true }, Cause::ShaftLocked),
        (Protocol::Binary, WorldAction::OpenLead { motor, on: true }, Cause::MotorOpen),
        (Protocol::Text, WorldAction::ReverseEncoder { motor, on: true }, Cause::EncoderReversed),
        (Protocol::Text, WorldAction::LoseEncoder { motor, on: true }, Cause::EncoderDead),
    ];
    for (protocol, action, cause) in cases {
        let mut link = connected(protocol);
        let before = registers(&link);
        let report = tuned(&mut link, of(Method::Velocity), |link| link.apply(0, &action)).expect("a report");
        assert_eq!(report.causes, [cause, Cause::LoopOff], "{protocol:?}");
        assert_off(&mut link, &before, &format!("{protocol:?} {cause:?}"));
    }
}

#[test]
fn what_breaks_in_mid_run_is_named_and_the_loop_stays_off() {
    let motor = Motor::M1;
    let cases = [
        (WorldAction::LoseEncoder { motor, on: true }, Cause::EncoderLost),
        (WorldAction::LockShaft { motor, on: true }, Cause::Stalled),
        (WorldAction::OpenLead { motor, on: true }, Cause::MotorOpened),
    ];
    for (action, cause) in cases {
        let mut link = connected(Protocol::Binary);
        let before = registers(&link);
        let report = tuned(&mut link, of(Method::Velocity), |link| strike(link, ms(2_600), &action));
        let causes = report.expect("a report").causes;
        assert_eq!(causes, [cause, Cause::LoopOff]);
        assert_off(&mut link, &before, &format!("{cause:?}"));
    }
}

/// All is as before but for the output of the loop, which is off: with a fault the old gains would drive the motor away, or hold it by
/// a signal that is not there.
fn assert_off(link: &mut Link, before: &[i64], place: &str) {
    let mut off = before.to_vec();
    off[1] |= 1 << 14;
    assert_eq!(registers(link), off, "{place}");
    link.run_for(ms(1_000));
    assert_eq!(link.duties(0)[0], 0.0, "{place}");
}

fn strike(link: &Link, after: Duration, action: &WorldAction) {
    let (line, action) = (link.line.clone(), action.clone());
    link.at(link.now() + after, move |_| {
        line.with(|machine| Machine::apply(machine.inner_mut().inner_mut(), 0, &action));
    });
}

#[test]
fn stop_and_cancel_at_any_stage_stand_the_motor_and_the_old_registers_come_back() {
    let moments = [250, 900, 1_500, 2_200, 3_000, 3_700, 4_500, 5_200, 6_000];
    let plan = moments
        .into_iter()
        .flat_map(|after| [(Protocol::Binary, after, false), (Protocol::Binary, after, true)]);
    let in_text = [900, 3_000, 6_000].into_iter().map(|after| (Protocol::Text, after, false));
    for (protocol, after, cancels) in plan.chain(in_text) {
        let mut link = connected(protocol);
        let before = registers(&link);
        let report = tuned_by(&mut link, of(Method::Velocity), |link, ticket| {
            let ticket = Arc::clone(ticket);
            link.at(link.now() + ms(after), move |handle| {
                if cancels {
                    ticket.cancel();
                } else {
                    handle.stop_all();
                }
            });
        });
        let place = format!("{protocol:?} after {after} ms, cancel {cancels}");
        let causes = report.expect("the run left its report").causes;
        assert_eq!(causes.first(), Some(&Cause::Stopped), "{place}");
        // All of them, DISABLEPID too: the loop holds the motor where it stands, and drives it nowhere.
        assert_eq!(registers(&link), before, "{place}");
        let stood = registers_of(&link, 0);
        link.run_for(ms(1_000));
        assert!((registers_of(&link, 0) - stood).abs() <= 4, "{place}: it moved");
        assert!(link.duties(0)[0].abs() < 0.05, "{place}");
        assert_eq!(eeprom_writes(&link), 0, "{place}");
    }
}

#[test]
fn when_the_cable_is_pulled_out_the_motor_runs_up_to_the_fence_and_stops() {
    let moments = [1_000, 1_500, 1_800, 2_500, 3_500, 4_200, 5_000, 6_000];
    let plan = moments.into_iter().map(|after| (Protocol::Binary, after));
    for (protocol, after) in plan.chain([(Protocol::Text, 2_000), (Protocol::Text, 6_000)]) {
        let mut link = connected(protocol);
        let (keeper, setup) = (TrialKeeper::new(Box::new(Forgetful)), Slot::<Setup>::default());
        let subject = subject(&link);
        link.finish(prepare(TARGET, subject, &setup, &keeper), ms(30_000));
        assert!(link.arm(ArmScope::CommandLine), "{:?}", link.events);
        strike(&link, ms(after), &WorldAction::Unplug { unplugged: true });
        link.finish(
            run(TARGET, of(Method::Velocity), &Slot::<Report>::default(), &Live::default()),
            ms(after + 3_000),
        );
        link.line.pass(ms(2_000));
        let place = registers_of(&link, 0);
        link.line.pass(ms(1_000));
        // A loop that was told to stand goes on holding the motor where it is.
        assert!(link.duties(0)[0].abs() < 0.05, "{protocol:?} after {after} ms: {:?}", link.duties(0));
        assert!((registers_of(&link, 0) - place).abs() < 20, "{protocol:?} after {after} ms: it goes on");
    }
}
