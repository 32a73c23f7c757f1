//! Jobs: progress, cancel, time limit, and the motors stopped on every way out.

use crate::TypedWire;
use crate::tests::link::harness::{DUTY_ZERO, Link};
use crate::tests::testing::ms;
use brushwork_link::clock::Clock;
use brushwork_link::device::Channel;
use brushwork_link::device::PollRate;
use brushwork_link::device::job::{Job, JobContext, JobEnding, JobTicket};
use brushwork_link::device::{ArmScope, Drive, DriveCommand};
use brushwork_link::device::{DisarmReason, Event};
use brushwork_link::device::{Request, RequestRefused};
use brushwork_link::exchange::{ExchangeError, Interruption};
use brushwork_link::failure::Failure;
use brushwork_mcp_wire::packet_serial::{commands, name, number};
use brushwork_values::Motor;
use std::time::Duration;

type Outcome = Result<(), Failure>;

brushwork_values::messages! {
    /// What the jobs of these tests are called and say.
    enum JobSaid {
        TryMotor "try the motor",
        Read "read three values",
        Sneak "sneak",
        Wait "wait",
        Write "write a gain",
        Count "count",
        DoJob "do the job",
        FindStop "find the end stop",
        ShaftStands "the shaft did not turn",
        FreeIt "Free it",
    }
}

/// The report of the one job that ended.
fn ending(link: &Link) -> (&JobEnding, Option<bool>) {
    let reports: Vec<_> = link
        .events
        .iter()
        .filter_map(|(_, event)| match event {
            Event::JobEnded(report) => Some((&report.ending, report.motors_stopped)),
            _ => None,
        })
        .collect();
    assert_eq!(reports.len(), 1, "{:?}", link.events);
    reports[0]
}

#[expect(clippy::needless_pass_by_value, reason = "for map_err")]
fn fail(error: ExchangeError) -> Failure {
    error.failure(JobSaid::DoJob, "the bench")
}

/// Drives motor 1 at a quarter and watches it until something happens.
fn drive_for_ever(context: &mut JobContext<'_>) -> Outcome {
    context.transact(number::DUTY_M1, &[8_192]).map_err(fail)?;
    loop {
        context.transact(number::READ_ENCODERS, &[]).map_err(fail)?;
    }
}

fn start(link: &mut Link, run: impl FnMut(&mut JobContext<'_>) -> Outcome + Send + 'static) -> JobTicket<()> {
    link.handle.start(Job::moving(JobSaid::TryMotor, Duration::from_secs(10), run)).unwrap()
}

/// The last drive command that the unit took.
fn last_drive(link: &Link) -> (u8, Vec<i64>) {
    let drives = [number::DUTY_M1, number::DUTY_BOTH, number::DUTY_ACCEL_BOTH];
    let bus = link.bus();
    let last = bus.taken.iter().rev().find(|taken| drives.contains(&taken.command)).unwrap();
    (last.command, last.values.clone())
}

fn assert_stopped(link: &Link) {
    assert_eq!(last_drive(link), (number::DUTY_ACCEL_BOTH, DUTY_ZERO.to_vec()));
    assert_eq!(ending(link).1, Some(true));
}

#[test]
fn a_job_tells_its_progress_and_hands_back_its_result() {
    let mut link = Link::connected();
    let job = Job::new(JobSaid::Read, ms(5_000), |context| {
        let mut values = Vec::new();
        for step in 0..3_u8 {
            context.progress(Some(f32::from(step) / 3.0), "reading");
            let reply = context.ask(commands::READ_MAIN_BATTERY, &[]).map_err(fail)?;
            values.push(reply.int(name::MAIN_BATTERY));
        }
        Ok(values)
    });
    link.bus().set(number::READ_MAIN_BATTERY, &[240]);
    let ticket = link.handle.start(job).unwrap();
    let is_of_it = |event: &Event| event.job() == Some(ticket.id());
    link.run_for(ms(500));
    let progress = link.events.iter().filter(|(_, event)| matches!(event, Event::JobProgress { .. }));
    assert_eq!(progress.filter(|(_, event)| is_of_it(event)).count(), 3);
    assert!(link.has(|event| matches!(event, Event::JobStarted { .. }) && is_of_it(event)));
    let (JobEnding::Done(()), stopped) = ending(&link) else { panic!("{:?}", ending(&link)) };
    assert_eq!(ticket.take(), Some(vec![240; 3]));
    assert_eq!(stopped, None, "it had nothing to do with motors");
    assert_eq!(link.bus().count(number::DUTY_ACCEL_BOTH), 0);
}

#[test]
fn a_job_that_moves_motors_needs_arming() {
    let mut link = Link::connected();
    start(&mut link, drive_for_ever);
    link.run_for(ms(500));
    let JobEnding::Failed(failure) = ending(&link).0 else { panic!("{:?}", ending(&link)) };
    assert!(failure.to_string().contains("the motors are not armed"), "{failure}");
    assert_eq!(link.bus().count(number::DUTY_M1), 0);
}

#[test]
fn a_job_that_comes_after_something_disarmed_says_what_it_was() {
    let mut link = Link::armed();
    link.bus().mute.insert(number::READ_STATUS);
    link.run_for(ms(1_000));
    assert_eq!(link.disarm_reasons(), [DisarmReason::NoAnswer]);
    start(&mut link, drive_for_ever);
    link.run_for(ms(500));
    let JobEnding::Failed(failure) = ending(&link).0 else { panic!("{:?}", ending(&link)) };
    assert_eq!(
        failure.to_string(),
        "Could not try the motor on 0x80 at /dev/test: the motors are armed no longer: no answer came in time: check the controller's \
         power, its cable and the line, and whether this computer is too busy. Arm again when you are ready."
    );
    assert_eq!(link.bus().count(number::DUTY_M1), 0);
}

#[test]
fn a_job_that_claims_to_move_nothing_cannot_move_anything_unarmed() {
    let mut link = Link::connected();
    link.handle.start(Job::new(JobSaid::Sneak, ms(1_000), drive_for_ever)).unwrap();
    link.run_for(ms(500));
    assert!(matches!(ending(&link).0, JobEnding::Failed(_)));
    assert_eq!(link.bus().count(number::DUTY_M1), 0);
}

#[test]
fn a_job_drives_in_the_words_of_the_window_and_its_setpoint_is_in_the_sample() {
    let mut link = Link::armed();
    start(&mut link, |context| {
        context.drive(&Drive::one(Motor::M1, DriveCommand::duty(0.25))).map_err(fail)?;
        context.sleep(ms(110)).map_err(fail)?;
        for _ in 0..30 {
            context.transact(number::READ_ENCODERS, &[]).map_err(fail)?;
        }
        Ok(())
    });
    link.run_for(ms(500));
    assert_eq!(link.taken(number::DUTY_M1)[0].values, [8_192]);
    assert!(link.has(
        |event| matches!(event, Event::Sample(sample) if sample.get(Channel::M1_SETPOINT) == Some(25.0))
    ));
    assert_stopped(&link);
}

#[test]
fn a_job_cannot_drive_unarmed() {
    let mut link = Link::connected();
    let job = Job::new(JobSaid::Sneak, ms(1_000), |context| {
        context.drive(&Drive::both(DriveCommand::duty(0.25))).map_err(fail)?;
        Ok(())
    });
    link.handle.start(job).unwrap();
    link.run_for(ms(500));
    assert!(matches!(ending(&link).0, JobEnding::Failed(_)));
    assert_eq!(link.bus().count(number::DUTY_BOTH), 0);
}

#[test]
fn a_job_that_did_its_work_ends_with_the_motors_stopped_and_disarmed() {
    let mut link = Link::armed();
    start(&mut link, |context| {
        context.transact(number::DUTY_M1, &[8_192]).map_err(fail)?;
        Ok(())
    });
    link.run_for(ms(500));
    assert!(matches!(ending(&link).0, JobEnding::Done(())));
    assert_stopped(&link);
    assert_eq!(link.disarm_reasons(), [DisarmReason::JobEnded]);
}

#[test]
fn a_job_that_gives_up_ends_with_the_motors_stopped() {
    let mut link = Link::armed();
    start(&mut link, |context| {
        context.transact(number::DUTY_M1, &[8_192]).map_err(fail)?;
        Err(Failure::new(JobSaid::FindStop, "", JobSaid::ShaftStands, JobSaid::FreeIt))
    });
    link.run_for(ms(500));
    assert!(matches!(ending(&link).0, JobEnding::Failed(_)));
    assert_stopped(&link);
}

#[test]
fn a_job_that_panics_ends_with_the_motors_stopped_and_the_link_lives_on() {
    let mut link = Link::armed();
    start(&mut link, |context| {
        context.transact(number::DUTY_M1, &[8_192]).map_err(fail)?;
        let nothing: [u8; 0] = [];
        let index = usize::from(context.address().get());
        assert_eq!(nothing[index], 0);
        Ok(())
    });
    link.run_for(ms(500));
    let JobEnding::Panicked(word) = ending(&link).0 else { panic!("{:?}", ending(&link)) };
    assert!(word.contains("out of bounds"), "{word}");
    assert_stopped(&link);
    link.forget();
    link.run_for(ms(500));
    assert!(link.has(|event| matches!(event, Event::Sample(_))));
}

#[test]
fn cancel_ends_a_job_with_the_motors_stopped() {
    let mut link = Link::armed();
    let ticket = start(&mut link, drive_for_ever);
    let cancel_at = link.clock.now() + ms(100);
    link.tap.at(cancel_at, move || ticket.cancel());
    renew_until(&link, ms(5_000));
    link.run_for(ms(1_000));
    assert!(matches!(ending(&link).0, JobEnding::Interrupted(Interruption::Cancelled)));
    assert_stopped(&link);
    let stop = &link.taken(number::DUTY_ACCEL_BOTH)[0];
    assert!(stop.at >= cancel_at && stop.at <= cancel_at + ms(2), "{:?}", stop.at - cancel_at);
}

/// A window that renews every 16 ms while a job runs, which is when the harness cannot.
fn renew_until(link: &Link, time: Duration) {
    let mut at = link.clock.now();
    let end = at + time;
    while at < end {
        let handle = link.handle.clone();
        link.tap.at(at, move || handle.renew());
        at += ms(16);
    }
}

#[test]
fn a_job_is_ended_at_its_time_limit() {
    let mut link = Link::armed();
    renew_until(&link, ms(12_000));
    start(&mut link, drive_for_ever);
    let begun_at = link.clock.now();
    link.run_for(ms(12_000));
    assert!(matches!(ending(&link).0, JobEnding::Interrupted(Interruption::TimeLimit)));
    assert_stopped(&link);
    let stop = &link.taken(number::DUTY_ACCEL_BOTH)[0];
    assert_eq!(stop.at - begun_at, Duration::from_secs(10));
}

#[test]
fn a_frozen_window_stops_a_job_after_250_ms() {
    let mut link = Link::armed();
    link.window_alive = false;
    link.handle.renew();
    let renewed_at = link.clock.now();
    start(&mut link, drive_for_ever);
    link.run_for(ms(1_000));
    assert!(matches!(ending(&link).0, JobEnding::Interrupted(Interruption::DeadMan)));
    let stop = &link.taken(number::DUTY_ACCEL_BOTH)[0];
    assert_eq!(stop.at - renewed_at, ms(250));
    assert_eq!(link.disarm_reasons(), [DisarmReason::DeadMan]);
    assert_stopped(&link);
}

#[test]
fn a_job_that_sleeps_is_woken_by_its_time_limit() {
    let mut link = Link::connected();
    let job = Job::new(JobSaid::Wait, ms(700), |context| {
        context.sleep(ms(60_000)).map_err(fail)?;
        Ok(())
    });
    link.handle.start(job).unwrap();
    let begun_at = link.clock.now();
    link.run_for(ms(1_000));
    assert!(matches!(ending(&link).0, JobEnding::Interrupted(Interruption::TimeLimit)));
    assert_eq!(link.when(|event| matches!(event, Event::JobEnded(_))), Some(begun_at + ms(700)));
}

#[test]
fn stop_reaches_the_motors_before_a_job_has_even_returned() {
    let mut link = Link::armed();
    renew_until(&link, ms(5_000));
    start(&mut link, |context| {
        let failure = drive_for_ever(context).err();
        // A stubborn job: it goes on for a while, and nothing it sends gets out.
        for _ in 0..100 {
            assert!(context.transact(number::DUTY_M1, &[8_192]).is_err());
        }
        Err(failure.unwrap())
    });
    let handle = link.handle.clone();
    let stop_at = link.clock.now() + ms(100);
    link.tap.at(stop_at, move || handle.stop_all());
    link.run_for(ms(1_000));
    assert!(matches!(ending(&link).0, JobEnding::Interrupted(Interruption::Stop)));
    assert_eq!(link.taken(number::DUTY_ACCEL_BOTH)[0].at, stop_at);
    assert_eq!(link.bus().count(number::DUTY_M1), 1);
    assert_stopped(&link);
    assert_eq!(link.stops()[0].latency(), ms(0));
}

#[test]
fn unplugging_during_a_job_ends_both_with_a_reason() {
    let mut link = Link::armed();
    renew_until(&link, ms(2_000));
    start(&mut link, drive_for_ever);
    let tap = link.tap.clone();
    link.tap.at(link.clock.now() + ms(100), move || tap.unplug());
    link.run_for(ms(1_000));
    assert!(matches!(ending(&link), (JobEnding::Failed(_), Some(false))), "{:?}", ending(&link));
    assert!(link.has(|event| matches!(event, Event::Lost(_))));
    assert_eq!(link.disarm_reasons(), [DisarmReason::LinkLost]);
    assert!(link.ended);
}

#[test]
fn a_fault_seen_between_the_exchanges_of_a_job_ends_it() {
    let mut link = Link::armed();
    renew_until(&link, ms(3_000));
    let bus = link.bus.clone();
    // Bit 2 in generation 1: E-stop.
    link.tap.at(link.clock.now() + ms(150), move || bus.lock().unwrap().set(number::READ_STATUS, &[0x0004]));
    start(&mut link, drive_for_ever);
    link.run_for(ms(1_500));
    assert!(matches!(ending(&link).0, JobEnding::Interrupted(Interruption::Disarm)));
    let reasons = link.disarm_reasons();
    assert!(matches!(reasons.as_slice(), [DisarmReason::Fault(_)]), "{reasons:?}");
    assert_stopped(&link);
}

#[test]
fn signals_are_read_while_a_job_runs_unless_it_wants_the_line_for_itself() {
    for (polling, least, most) in [(true, 8, 12), (false, 0, 1)] {
        let mut link = Link::connected();
        let job = Job::new(JobSaid::Read, ms(5_000), move |context| {
            context.set_polling(polling);
            let end = context.now() + ms(1_000);
            while context.now() < end {
                context.transact(number::READ_MAIN_VOLTAGES, &[]).map_err(fail)?;
            }
            Ok(())
        });
        link.handle.start(job).unwrap();
        while !link.has(|event| matches!(event, Event::JobEnded(_))) {
            let _ = link.step();
        }
        let samples = link.events.iter().filter(|(_, event)| matches!(event, Event::Sample(_))).count();
        assert!((least..=most).contains(&samples), "{samples} samples");
    }
}

#[test]
fn a_stop_before_a_moving_job_begins_keeps_it_from_beginning() {
    let mut link = Link::armed();
    start(&mut link, drive_for_ever);
    link.handle.stop_all();
    link.run_for(ms(300));
    assert!(matches!(ending(&link).0, JobEnding::Failed(_)));
    assert_eq!(link.bus().count(number::DUTY_M1), 0);
}

#[test]
fn a_panic_of_a_job_that_moves_nothing_still_stops_what_was_armed() {
    let mut link = Link::armed();
    link.drive(0.5);
    link.run_for(ms(30));
    link.handle.start(Job::<()>::new(JobSaid::Count, ms(1_000), |_| panic!("a bug"))).unwrap();
    link.run_for(ms(300));
    assert!(matches!(ending(&link).0, JobEnding::Panicked(word) if word == "a bug"));
    assert_stopped(&link);
}

#[test]
fn a_settings_job_leaves_an_armed_screen_armed() {
    let mut link = Link::armed();
    link.drive(0.5);
    link.run_for(ms(30));
    let job = Job::new(JobSaid::Write, ms(1_000), |context| {
        context.transact(number::SET_VELOCITY_PID_M1, &[0, 0, 0, 0]).map_err(fail)?;
        Ok(())
    });
    link.handle.start(job).unwrap();
    link.run_for(ms(200));
    assert_eq!(ending(&link).1, None);
    assert!(link.disarm_reasons().is_empty());
    assert_eq!(last_drive(&link).0, number::DUTY_BOTH);
}

#[test]
fn a_full_queue_refuses_in_a_sentence_and_stop_still_gets_through() {
    let mut link = Link::connected();
    link.ask(Request::Poll(PollRate::Off));
    link.settle();
    let mut refused = None;
    for _ in 0..200 {
        if let Err(error) = link.handle.request(Request::Arm(ArmScope::Pwm)) {
            refused = Some(error);
            break;
        }
    }
    assert_eq!(refused, Some(RequestRefused::Busy { waiting: 64 }));
    link.handle.stop_all();
    link.settle();
    assert_eq!(link.stops().len(), 1);
}

#[test]
fn a_cancel_ends_its_own_job_and_no_other() {
    let mut link = Link::connected();
    let wait = |context: &mut JobContext<'_>| context.sleep(ms(100)).map_err(fail);
    let [first, second] =
        [(); 2].map(|()| link.handle.start(Job::new(JobSaid::Wait, ms(1_000), wait)).unwrap());
    second.cancel();
    link.run_for(ms(500));
    let ended = link.events.iter().filter_map(|(_, event)| match event {
        Event::JobEnded(report) => Some((report.id, format!("{:?}", report.ending))),
        _ => None,
    });
    let expected = [(first.id(), "Done".to_owned()), (second.id(), "Interrupted(Cancelled)".to_owned())];
    assert!(ended.eq(expected), "{:?}", link.events);
    assert_eq!((first.take(), second.take()), (Some(()), None));
}
