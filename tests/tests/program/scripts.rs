//! Scripts over the device thread and the wire, against the simulated controller in virtual time: downloads, starts, and every way
//! in which a script could go on driving a motor that should stand.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use brushwork_link::device::{ArmScope, DeviceOptions, DisarmReason, Event, Job, JobEnding, Request};
use brushwork_link::{Failure, Interruption, Stream};
use brushwork_mcp_client::script::{
    Autorun, Downloaded, Origin, ScriptImage, Verified, autorun_job, download_job,
};
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_wire::packet_serial::{Generation, number};
use brushwork_plant::faults::Fault;
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::world::WorldAction;
use brushwork_plant::world::{Content, ScriptRun};
use brushwork_script::{image, mcl};
use brushwork_tests::virtual_link::VirtualLink;
use brushwork_values::Value;

/// Drives both motors at 30 % and says so again each millisecond.
const DRIVES: &str = "main\npower2 9830,655359,9830,655359\npause 1\ngoto main\n";
/// From 30 % duty to none at the highest acceleration, and the ticks around it.
const RAMP_DOWN: Duration = Duration::from_millis(30);

fn ms(milliseconds: u64) -> Duration {
    Duration::from_millis(milliseconds)
}

fn compiled(text: &str) -> ScriptImage {
    let program = mcl::compile(text).program.expect("the test's programs are in order");
    ScriptImage::from_file(&image::to_file(&image::encode(&program))).expect("it is an image")
}

fn with_faults(simulated: bool, faults: Vec<Fault>, seed: u64) -> VirtualLink {
    let config = ControllerConfig { generation: Generation::Gen2, ..ControllerConfig::default() };
    let unit = Controller::new(config).expect("the default world is sound");
    let bus = Bus::single(unit, StreamIndex::Usb);
    let options = DeviceOptions { stream: Some(Stream::Usb), simulated, ..DeviceOptions::default() };
    let mut link = VirtualLink::new(bus, StreamIndex::Usb, options, faults, seed);
    link.run_for(ms(3_000));
    link
}

fn connected() -> VirtualLink {
    with_faults(true, Vec::new(), 1)
}

/// Stores a script past the wire.
fn install(link: &VirtualLink, text: &str) {
    let program = mcl::compile(text).program.expect("the test's programs are in order");
    let image = image::encode(&program);
    link.bus(|bus| bus.controllers_mut()[0].install_script(&image));
}

fn script(link: &VirtualLink) -> ScriptRun {
    link.unit(0, |unit| unit.script_view().run)
}

fn holds(link: &VirtualLink) -> Content {
    link.unit(0, |unit| unit.script_view().holds)
}

/// A script that drives, started from its armed screen.
fn driving() -> VirtualLink {
    let mut link = connected();
    install(&link, DRIVES);
    started(&mut link);
    link
}

fn started(link: &mut VirtualLink) {
    assert!(link.arm(ArmScope::Script), "{:?}", link.events);
    link.ask(Request::StartScript);
    link.run_for(ms(400));
    assert!(script(link).is_running());
    assert!(link.duties(0).iter().all(|duty| *duty > 0.29), "{:?}", link.duties(0));
    link.events.clear();
}

fn assert_over(link: &mut VirtualLink, when: &str) {
    assert!(!script(link).is_running(), "{when}: the script runs on");
    let until = link.now() + ms(500);
    while link.now() < until && !link.ended {
        link.run_for(ms(5));
        assert_eq!(link.duties(0), [0.0, 0.0], "{when}, at {:?}", link.now());
    }
}

fn failures(link: &VirtualLink) -> Vec<String> {
    let failures = link.events.iter().filter_map(|(_, event)| match event {
        Event::Failure(failure) => Some(failure.to_string()),
        _ => None,
    });
    failures.collect()
}

fn reasons(link: &VirtualLink) -> Vec<DisarmReason> {
    let reasons = link.events.iter().filter_map(|(_, event)| match event {
        Event::Disarmed(reason) => Some(reason.clone()),
        _ => None,
    });
    reasons.collect()
}

/// Runs a job to its end.
fn ended<T: Send + 'static>(link: &mut VirtualLink, job: Job<T>) -> JobEnding<T> {
    link.finish(job, Duration::from_secs(60)).expect("the job ends within a minute")
}

fn downloaded(ending: JobEnding<Downloaded>) -> Downloaded {
    match ending {
        JobEnding::Done(downloaded) => downloaded,
        other => panic!("{other:?}"),
    }
}

fn refused<T>(ending: JobEnding<T>) -> Failure {
    match ending {
        JobEnding::Failed(failure) => failure,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_script_is_downloaded_with_progress_and_then_runs() {
    let mut link = connected();
    let program = compiled(DRIVES);
    let ending = ended(&mut link, download_job(program.clone(), false));
    assert!(link.stops().is_empty(), "nothing was moved");
    let done = downloaded(ending);
    assert_eq!((done.bytes, done.blocks, done.is_foreign), (program.len(), program.blocks().len(), false));
    assert_eq!((done.verified, done.autorun), (Verified::Status, None));
    assert!(done.took > Duration::from_millis(1_500), "an erase takes its time: {:?}", done.took);
    let reported = link.events.iter().filter_map(|(_, event)| match event {
        Event::JobProgress { fraction, text, .. } => Some((*fraction, text.as_str())),
        _ => None,
    });
    let reported: Vec<_> = reported.collect();
    assert!(reported.contains(&(None, "erasing the script memory")), "{reported:?}");
    assert_eq!(reported.last(), Some(&(Some(1.0), "verifying")));
    assert_eq!(holds(&link), Content::Own);
    assert_eq!(script(&link), ScriptRun::Idle, "a download starts nothing");
    started(&mut link);
}

#[test]
fn a_real_controller_is_not_sent_what_this_program_compiles_and_is_offered_what_can_be_done() {
    let mut link = with_faults(false, Vec::new(), 1);
    let failure = refused(ended(&mut link, download_job(compiled(DRIVES), false)));
    assert_eq!(
        failure.to_string(),
        "Could not download the script on 0x80 at the simulated controller: the byte code of real controllers is not public, so what this \
         program compiles runs on simulated ones alone. Compile the script with the maker's Ion Studio and download that file: it is \
         sent as it is, and can be started, stopped and set to autorun from here. Or run the script on a simulated controller."
    );
    assert_eq!(holds(&link), Content::Nothing, "nothing was sent");
    // What the maker's tool compiled goes over as it is: the header is left out, the rest arrives byte by byte.
    let maker: Vec<u8> = (0..0x100 + 1_000).map(|at| (at % 251) as u8).collect();
    let file = ScriptImage::from_file(&maker).unwrap();
    assert_eq!(file.origin(), Origin::Foreign);
    let done = downloaded(ended(&mut link, download_job(file, false)));
    assert_eq!((done.blocks, done.verified, done.is_foreign), (63, Verified::Alike(0xFF), true));
    link.bus(|bus| assert_eq!(&bus.controllers()[0].script_image()[..1_000], &maker[0x100..]));
}

#[test]
fn a_simulated_controller_takes_a_foreign_image_and_refuses_to_run_it() {
    let mut link = connected();
    let file = ScriptImage::from_file(&[0x5A; 0x300]).unwrap();
    assert!(downloaded(ended(&mut link, download_job(file, false))).is_foreign);
    assert_eq!(holds(&link), Content::Foreign);
    assert!(link.arm(ArmScope::Script));
    link.ask(Request::StartScript);
    link.run_for(ms(300));
    assert_eq!(script(&link), ScriptRun::Idle);
    let reported = failures(&link);
    assert!(reported[0].starts_with("Could not start the script on 0x80 at"), "{reported:?}");
    assert!(
        reported[0].contains("it answered 00 instead of FF: it holds no script that it can run. Download"),
        "{reported:?}"
    );
}

#[test]
fn an_image_that_does_not_fit_is_told_with_its_place() {
    let mut link = connected();
    let file = ScriptImage::from_file(&vec![0x5A; 0x100 + 0x1_0010]).unwrap();
    let failure = refused(ended(&mut link, download_job(file, false)));
    assert!(
        failure.came_back.to_string().starts_with("the block at 0x010000 was answered with status 00"),
        "{failure}"
    );
    assert!(failure.remedy.to_string().contains("holds a part of the image"), "{failure}");
}

#[test]
fn a_download_under_byte_loss_arrives_whole_or_says_what_it_left() {
    let program = compiled(DRIVES);
    for seed in 1..=6 {
        let fault = "drop=0.002".parse().expect("a fault as on the command line");
        let mut link = with_faults(true, vec![fault], seed);
        match ended(&mut link, download_job(program.clone(), false)) {
            JobEnding::Done(_) => {
                let held = link.bus(|bus| bus.controllers()[0].script_image().to_vec());
                let sent: Vec<u8> = program.blocks().flat_map(|block| block.bytes).collect();
                assert_eq!(held, sent, "seed {seed}");
            }
            JobEnding::Failed(failure) => assert!(!failure.remedy.is_empty(), "seed {seed}: {failure}"),
            other => panic!("seed {seed}: {other:?}"),
        }
    }
}

#[test]
fn cancelling_a_download_leaves_an_image_that_is_not_run() {
    let mut link = connected();
    // Long enough to be cancelled in the middle of its blocks.
    let text: String = (0..400).map(|line| format!("puts 0,[\"line {line}\"]\n")).collect();
    link.events.clear();
    let ticket = Arc::new(link.start(download_job(compiled(&format!("{text}end\n")), false)));
    let cancelled = Arc::clone(&ticket);
    link.at(link.now() + ms(2_000), move |_| cancelled.cancel());
    let ending = link.finish_begun(&ticket, ms(5_000));
    assert!(matches!(ending, Some(JobEnding::Interrupted(Interruption::Cancelled))), "{ending:?}");
    assert_eq!(holds(&link), Content::Own, "its beginning is there");
    assert!(link.arm(ArmScope::Script));
    link.ask(Request::StartScript);
    link.run_for(ms(300));
    assert!(!script(&link).is_running(), "half an image is not run");
}

#[test]
fn a_download_ends_the_script_that_runs() {
    let mut link = driving();
    downloaded(ended(&mut link, download_job(compiled("main\ngoto main\n"), false)));
    assert!(!script(&link).is_running());
}

#[test]
fn autorun_is_set_read_back_and_takes_effect_once_it_is_saved() {
    let mut link = connected();
    install(&link, DRIVES);
    let set = |link: &mut VirtualLink, autorun: Autorun| {
        let ending = ended(link, autorun_job(autorun));
        assert!(matches!(ending, JobEnding::Done(())), "{ending:?}");
    };
    set(&mut link, Some(ms(500)));
    power_cycle(&mut link);
    assert_eq!(script(&link), ScriptRun::Idle, "it was not saved");
    set(&mut link, Some(ms(500)));
    link.ask(Request::Transact { id: 1, command: number::SAVE_SETTINGS, values: Vec::new() });
    link.run_for(ms(2_000));
    power_cycle(&mut link);
    assert!(script(&link).is_running());
    set(&mut link, None);
    link.unit(0, |unit| assert!(unit.script_view().run.is_running(), "it goes on until it is stopped"));
}

fn power_cycle(link: &mut VirtualLink) {
    link.apply(0, &WorldAction::Power { on: false });
    link.apply(0, &WorldAction::Power { on: true });
    link.run_for(ms(1_000));
}

#[test]
fn a_script_is_not_started_unless_its_own_screen_is_armed() {
    let mut link = connected();
    install(&link, DRIVES);
    let asks = |link: &mut VirtualLink| {
        link.ask(Request::StartScript);
        link.ask(Request::Transact { id: 1, command: number::START_SCRIPT, values: Vec::new() });
        link.run_for(ms(300));
        assert_eq!(script(link), ScriptRun::Idle);
        assert_eq!(link.duties(0), [0.0, 0.0]);
    };
    asks(&mut link);
    for scope in
        [ArmScope::Pwm, ArmScope::Velocity, ArmScope::Position, ArmScope::ClampTest, ArmScope::Tuning]
    {
        assert!(link.arm(scope), "{scope}");
        asks(&mut link);
    }
    // A start that was asked for before arming does not act after it.
    link.ask(Request::Disarm);
    link.run_for(ms(300));
    link.ask(Request::StartScript);
    assert!(link.arm(ArmScope::Script));
    assert_eq!(script(&link), ScriptRun::Idle);
}

#[test]
fn disarming_another_screen_and_closing_end_the_script_and_stand_the_motors() {
    let mut link = driving();
    link.ask(Request::Disarm);
    link.run_for(RAMP_DOWN + ms(50));
    assert_over(&mut link, "disarmed");
    let mut link = driving();
    assert!(link.arm(ArmScope::Pwm));
    assert_over(&mut link, "another screen");
    let mut link = driving();
    link.ask(Request::Disconnect);
    link.run_for(RAMP_DOWN + ms(100));
    assert!(link.ended && !script(&link).is_running());
    assert_eq!(link.duties(0), [0.0, 0.0]);
}

#[test]
fn stop_all_ends_a_script_whoever_started_it() {
    let mut link = driving();
    link.handle.stop_all();
    link.run_for(RAMP_DOWN + ms(50));
    assert_over(&mut link, "started from here");
    assert_eq!(reasons(&link), [DisarmReason::Stop]);
    // One that runs since power-up, of which this program knows nothing.
    let mut link = connected();
    install(&link, DRIVES);
    link.ask(Request::Transact { id: 1, command: number::SET_SCRIPT_AUTORUN, values: vec![Value::Int(200)] });
    link.ask(Request::Transact { id: 2, command: number::SAVE_SETTINGS, values: Vec::new() });
    link.run_for(ms(2_000));
    power_cycle(&mut link);
    assert!(link.duties(0).iter().all(|duty| *duty > 0.29));
    link.handle.stop_all();
    link.run_for(RAMP_DOWN + ms(50));
    assert_over(&mut link, "started by itself");
}

#[test]
fn stop_at_any_moment_of_a_start_leaves_nothing_running() {
    let first = connected().now();
    for microseconds in (0..4_000).step_by(50) {
        let mut link = connected();
        assert_eq!(link.now(), first);
        install(&link, DRIVES);
        assert!(link.arm(ArmScope::Script));
        let at = link.now() + Duration::from_micros(microseconds);
        link.at(at, brushwork_link::device::DeviceHandle::stop_all);
        link.ask(Request::StartScript);
        link.run_for(ms(200));
        assert!(!script(&link).is_running(), "Stop {microseconds} us after the start");
        assert_eq!(link.duties(0), [0.0, 0.0], "Stop {microseconds} us after the start");
    }
}

#[test]
fn a_stop_of_which_bytes_are_lost_is_repeated_until_script_and_motors_confirm() {
    // All bytes to the controller are lost for a while, the first Stop with them.
    for dead_ms in [5, 40, 200, 700] {
        let mut link = connected();
        install(&link, DRIVES);
        started(&mut link);
        let seen = Arc::new(Mutex::new(0));
        link.apply(0, &WorldAction::Unplug { unplugged: true });
        let count = Arc::clone(&seen);
        let back_at = link.now() + ms(dead_ms);
        link.at(link.now(), move |handle| {
            handle.stop_all();
            *count.lock().unwrap() += 1;
        });
        link.run_for(back_at - link.now());
        link.apply(0, &WorldAction::Unplug { unplugged: false });
        link.run_for(ms(2_000));
        assert_eq!(*seen.lock().unwrap(), 1);
        assert!(
            link.ended || !script(&link).is_running(),
            "silent for {dead_ms} ms: {:?}",
            link.events.last()
        );
        if !link.ended {
            assert_over(&mut link, "after the line came back");
        }
    }
}

#[test]
fn a_window_that_hangs_ends_the_script_after_a_quarter_second() {
    let mut link = driving();
    link.freeze_window();
    link.run_for(ms(200));
    assert!(script(&link).is_running());
    link.run_for(ms(100) + RAMP_DOWN);
    link.thaw_window();
    link.run_for(ms(50));
    assert_eq!(reasons(&link), [DisarmReason::DeadMan]);
    assert_over(&mut link, "the window hung");
}

#[test]
fn a_fault_of_the_controller_ends_the_script() {
    let mut link = driving();
    link.apply(0, &WorldAction::EStop { pressed: true });
    link.run_for(ms(1_500));
    assert!(!script(&link).is_running());
    assert!(matches!(reasons(&link)[..], [DisarmReason::Fault(_)]), "{:?}", reasons(&link));
    link.apply(0, &WorldAction::EStop { pressed: false });
    assert_over(&mut link, "the emergency stop was released");
}

#[test]
fn a_script_that_gives_its_port_away_is_found_out_by_the_silence() {
    // It takes the USB port from packet serial: nothing that is sent there reaches the firmware any more, Stop included.
    let mut link = connected();
    install(&link, &format!("STREAMTYPE(0) = 0\n{DRIVES}"));
    assert!(link.arm(ArmScope::Script));
    link.ask(Request::StartScript);
    link.run_for(ms(4_000));
    let lost = link.events.iter().find_map(|(_, event)| match event {
        Event::Lost(failure) => Some(failure.to_string()),
        _ => None,
    });
    assert!(link.ended && lost.is_some_and(|lost| lost.contains("Make sure that the motors stand still")));
    // With RTS held, as a real USB port has it while it is open, packet serial is never lost (MCP manual 1.9.3).
    let mut link = connected();
    link.apply(0, &WorldAction::SetRts { on: true });
    install(&link, &format!("STREAMTYPE(0) = 0\n{DRIVES}"));
    started(&mut link);
    link.handle.stop_all();
    link.run_for(RAMP_DOWN + ms(50));
    assert_over(&mut link, "with RTS held");
}
