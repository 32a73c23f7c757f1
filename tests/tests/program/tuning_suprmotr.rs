//! Whole tuning runs of a SuprMotr through the device thread with real bytes, in virtual time: moves alone, faults, Stop, and what is left.

use std::sync::Arc;
use std::time::Duration;

use brushwork_core::keep::TrialKeeper;
use brushwork_core::tune::law::{Report, Request as Tuning, Setup, request};
use brushwork_core::tune::live::Live;
use brushwork_core::tune::{Slot, Target, leaves_off, prepare, restore, run, take};
use brushwork_link::Failure;
use brushwork_link::FamilyChoice;
use brushwork_link::device::{ArmScope, DeviceOptions, JobEnding, JobTicket, Request};
use brushwork_link::settings::{Ending, Entry, Keeper};
use brushwork_plant::world::WorldAction;
use brushwork_suprmotr_sim::{Parameters, SuprMotr, SuprMotrBus, SuprMotrConfig};
use brushwork_suprmotr_wire::Address;
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::Method;
use brushwork_values::Motor;

const TARGET: Target = Target { motor: Motor::M1, encoder: None, stream: None };

type Link = VirtualLink<SuprMotrBus>;

fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

fn connected(change: impl FnOnce(&mut Parameters)) -> Link {
    let mut config = SuprMotrConfig::new(Address::FACTORY);
    change(&mut config.eeprom.parameters);
    let bus = SuprMotrBus::new(vec![SuprMotr::new(config).expect("the slide is sound")]);
    let options = DeviceOptions {
        simulated: true,
        family: FamilyChoice::of(brushwork_suprmotr_client::SUPRMOTR),
        ..DeviceOptions::default()
    };
    let mut link = Link::over(bus, options, Vec::new(), 1);
    link.run_for(ms(6_000));
    link
}

fn unit<T>(link: &Link, look: impl FnOnce(&SuprMotr) -> T) -> T {
    link.bus(|bus| look(&bus.suprmotrs()[0]))
}

fn parameters(link: &Link) -> Parameters {
    unit(link, |unit| unit.parameters().clone())
}

struct Forgetful;

impl Keeper for Forgetful {
    fn begin(&mut self, _: Entry) {}

    fn begun(&mut self) -> Option<Result<(), Failure>> {
        Some(Ok(()))
    }

    fn end(&mut self, _: Ending) {}
}

fn tuned(
    link: &mut Link,
    request: Tuning,
    before_run: impl FnOnce(&Link, &Arc<JobTicket<()>>),
) -> Option<Report> {
    let setup: Slot<Setup> = Slot::default();
    let keeper = TrialKeeper::new(Box::new(Forgetful));
    let subject = brushwork_suprmotr_client::subject();
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
    let leaves_off = leaves_off(report.as_ref(), None);
    let restored = link.finish(restore(TARGET, before, report.as_ref(), leaves_off, &keeper), ms(15_000));
    assert!(matches!(restored, Some(JobEnding::Done(_))), "{restored:?}");
    report
}

/// Within 8,000 counts on either side of where the slide stands.
fn within_travel(method: Method) -> Tuning {
    request(method, 50.0, Motor::M1, Some((-8_000, 8_000)), 100.0, None)
}

#[test]
fn a_slide_is_tuned_by_moves_alone_in_less_than_a_minute_and_nothing_is_left_behind() {
    for method in [Method::Pd, Method::Pid] {
        let mut link = connected(|_| {});
        let before = parameters(&link);
        let report = tuned(&mut link, within_travel(method), |_, _| {}).expect("the run left its report");
        let place = format!("{method:?}: {:?} {:?}", report.verdict, report.causes);
        assert_ne!(report.verdict, Verdict::Refused, "{place}");
        let new = report.proposed.second.suprmotr.expect("gains");
        println!("{place}, {:.1} s: {new:?}, {:?}", report.seconds.1, report.fit);
        assert!(report.seconds.1 < 60.0, "{place}: {} s", report.seconds.1);
        assert_eq!(report.request.law.second.suprmotr.map(|law| law.rate_hz), Some(1_000), "{place}");
        assert!(
            new.p > 0 && new != report.before.expect("read").held.second.suprmotr.expect("its").registers
        );
        assert!(report.replay().as_ref() == Some(&report), "{place}: the replay differs");
        assert_eq!(parameters(&link), before, "{place}: gains, DV and DA");
        assert_eq!(unit(&link, SuprMotr::eeprom_writes), 0, "{place}");
        assert!(unit(&link, SuprMotr::is_motor_on) && unit(&link, SuprMotr::is_motion_complete), "{place}");
    }
}

#[test]
fn a_cascade_is_refused_by_what_the_board_has_and_whoever_names_no_method_gets_its_pid() {
    let mut link = connected(|_| {});
    let before = parameters(&link);
    let report = tuned(&mut link, within_travel(Method::Piv), |_, _| {}).expect("a report");
    assert_eq!((report.verdict, report.causes.as_slice()), (Verdict::Refused, &[Cause::NoSuchLoop][..]));
    assert_eq!(unit(&link, SuprMotr::position), 0, "nothing was moved");
    let wanted = Tuning { or_pid: true, ..within_travel(Method::Piv) };
    let report = tuned(&mut link, wanted, |_, _| {}).expect("a report");
    assert_ne!(report.verdict, Verdict::Refused, "{:?}", report.causes);
    assert_eq!(report.request.method, Method::Pid);
    assert_eq!(parameters(&link), before);
}

#[test]
fn gains_that_are_kept_stay_in_ram_and_the_pace_of_moves_is_the_users_again() {
    let mut link = connected(|_| {});
    let before = parameters(&link);
    let wanted = Tuning { keep: true, ..within_travel(Method::Pd) };
    let report = tuned(&mut link, wanted, |_, _| {}).expect("a report");
    let kept = report.proposed.second.suprmotr.expect("gains");
    let now = parameters(&link);
    assert_eq!([now.proportional, now.integral, now.derivative], [kept.p, kept.i, kept.d].map(i32::from));
    assert_eq!((now.velocity, now.acceleration), (before.velocity, before.acceleration));
    assert_eq!(unit(&link, SuprMotr::eeprom_writes), 0);
}

#[test]
fn a_run_never_leaves_its_travel() {
    let mut link = connected(|_| {});
    let (low, high) = (-1_500, 1_500);
    let wanted = request(Method::Pd, 50.0, Motor::M1, Some((low, high)), 100.0, None);
    let seen = Arc::new(std::sync::Mutex::new((0, 0)));
    for n in 0..600 {
        let (line, seen) = (link.line.clone(), Arc::clone(&seen));
        link.at(link.now() + ms(20 * n + 2_000), move |_| {
            line.with(|machine| {
                let position = machine.inner_mut().inner_mut().suprmotrs()[0].position();
                let mut seen = seen.lock().expect("no test panics with it");
                *seen = (seen.0.min(position), seen.1.max(position));
            });
        });
    }
    let report = tuned(&mut link, wanted, |_, _| {}).expect("a report");
    let seen = *seen.lock().expect("no test panics with it");
    println!("{seen:?}: {:?} {:?}", report.verdict, report.causes);
    assert!(seen.1 > 200, "it moved");
    assert!((low..=high).contains(&seen.0) && (low..=high).contains(&seen.1), "{seen:?}");
}

#[test]
fn an_encoder_that_counts_backwards_is_named_at_once_and_the_motor_is_let_go() {
    let mut link = connected(|_| {});
    let before = parameters(&link);
    let action = WorldAction::ReverseEncoder { motor: Motor::M1, on: true };
    let report = tuned(&mut link, within_travel(Method::Pid), |link, _| link.apply(0, &action));
    assert_eq!(report.expect("a report").causes, [Cause::EncoderReversed, Cause::LoopOff]);
    assert_eq!(parameters(&link), before);
    assert!(!unit(&link, SuprMotr::is_motor_on), "with these gains it would run away");
    let position = unit(&link, SuprMotr::position);
    assert!(position.abs() < 8_000, "{position}");
}

#[test]
fn a_shaft_that_does_not_turn_and_an_error_beyond_sm_are_named() {
    let lock = WorldAction::LockShaft { motor: Motor::M1, on: true };
    let mut link = connected(|_| {});
    let report = tuned(&mut link, within_travel(Method::Pid), |link, _| link.apply(0, &lock));
    assert_eq!(report.expect("a report").causes.first(), Some(&Cause::NothingCounted));
    let mut link = connected(|parameters| parameters.most_error = 150);
    let report = tuned(&mut link, within_travel(Method::Pid), |_, _| {}).expect("a report");
    assert_eq!(report.causes.first(), Some(&Cause::FollowingError));
}

#[test]
fn stop_and_cancel_at_any_stage_stand_the_motor_and_the_old_gains_come_back() {
    for (after, cancels) in
        [(700, false), (1_500, true), (3_000, false), (5_000, true), (8_000, false), (11_000, true)]
    {
        let mut link = connected(|_| {});
        let before = parameters(&link);
        let report = tuned(&mut link, within_travel(Method::Pid), |link, ticket| {
            let ticket = Arc::clone(ticket);
            link.at(link.now() + ms(after), move |handle| {
                if cancels {
                    ticket.cancel();
                } else {
                    handle.stop_all();
                }
            });
        });
        let place = format!("after {after} ms, cancel {cancels}");
        let causes = report.expect("the run left its report").causes;
        assert_eq!(causes.first(), Some(&Cause::Stopped), "{place}");
        assert_eq!(parameters(&link), before, "{place}");
        let stood = unit(&link, SuprMotr::position);
        link.run_for(ms(1_000));
        assert!((unit(&link, SuprMotr::position) - stood).abs() <= 4, "{place}: it moved");
        assert!(unit(&link, SuprMotr::is_motion_complete), "{place}");
    }
}
