//! Every way out of a tuning run at each of its stages: the motors stand, the old gains and the user's time-out are in force, and the
//! window says so. The device loop runs in lockstep with the frames.

use crate::support::bench::Bench;
use brushwork_gui::model::link::Arming;
use brushwork_gui::tune::Loop;
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_sim::motion::MotionSettings;
use brushwork_plant::machine::StreamIndex;
use brushwork_plant::presets;
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use egui::{Key, Modifiers, ViewportCommand, ViewportEvent, ViewportId};
use std::sync::LazyLock;
use std::time::Duration;

/// The user's time-out of the port and what the run makes of it, ms.
const USERS_MS: u32 = 700;

fn config() -> ControllerConfig {
    let axis = presets::lookup("small-gearmotor").expect("a preset");
    let default = ControllerConfig::default();
    let world = presets::world_of(axis, axis, default.model.pins.len());
    let config = ControllerConfig { world, ..default };
    let mut settings = Controller::new(config.clone()).expect("the preset is sound").stored_settings();
    for stream in &mut settings.streams {
        stream.timeout_ms = USERS_MS;
    }
    ControllerConfig { settings: Some(settings), ..config }
}

fn opened(screen: &str) -> Bench {
    let mut bench = Bench::of(Controller::new(config()).expect("the configuration is sound"));
    bench.connect();
    bench.arm_on(screen);
    bench.press("Tune");
    bench
}

/// What the controller holds for a motor, and the time-out of its port.
fn held(bench: &Bench) -> (MotionSettings, u32) {
    bench.line.with(|bus| {
        let settings = bus.controllers()[0].settings();
        (settings.motors[0].motion, settings.streams[0].timeout_ms)
    })
}

fn is_running(bench: &mut Bench) -> bool {
    bench.model().front.tune.is_running()
}

/// What the run says it does.
fn text(bench: &mut Bench) -> Option<String> {
    bench.model().front.tune.running().map(|sequence| sequence.text().to_owned())
}

/// Something that goes through stages: how it is begun on a screen.
struct Work {
    name: &'static str,
    begin: fn() -> Bench,
}

fn tune_velocity() -> Bench {
    let mut bench = opened("Velocity Settings");
    bench.press("Tune M1");
    bench
}

fn tune_position_in_travel() -> Bench {
    let mut bench = opened("Position Settings");
    bench.press("PID");
    bench.press("Within");
    bench.press("Tune M1");
    bench
}

/// Verification of gains that another run has proposed, which are not in force.
fn verify() -> Bench {
    let mut bench = tune_velocity();
    finish(&mut bench);
    bench.press("Arm");
    bench.pass_ms(500);
    bench.press("Verify");
    bench
}

const WORKS: [Work; 3] = [
    Work { name: "velocity", begin: tune_velocity },
    Work { name: "position within a travel", begin: tune_position_in_travel },
    Work { name: "verify", begin: verify },
];

#[track_caller]
fn finish(bench: &mut Bench) {
    for _ in 0..120 {
        if !is_running(bench) {
            break;
        }
        bench.pass_ms(500);
    }
    assert!(!is_running(bench), "it ends by itself: {:?}", bench.said());
    bench.pass_ms(1500);
}

/// The stages of each work, which are the same in every test.
static STAGES: LazyLock<[Vec<(String, u64)>; 3]> = LazyLock::new(|| WORKS.each_ref().map(stages_of));

fn stages() -> impl Iterator<Item = (&'static Work, &'static [(String, u64)])> {
    WORKS.iter().zip(STAGES.iter().map(Vec::as_slice))
}

/// The stages of a run, with how long after its begin the middle of each is, in frames of 100 ms.
fn stages_of(work: &Work) -> Vec<(String, u64)> {
    let mut bench = (work.begin)();
    let mut seen: Vec<(String, u64, u64)> = Vec::new();
    let mut frame = 0;
    while let Some(now) = text(&mut bench) {
        match seen.last_mut().filter(|(last, ..)| *last == now) {
            Some((_, _, last)) => *last = frame,
            None => seen.push((now, frame, frame)),
        }
        bench.pass_ms(100);
        frame += 1;
        assert!(frame < 600, "it ends by itself: {seen:?}");
    }
    seen.into_iter().map(|(text, first, last)| (text, (first + last) / 2)).collect()
}

/// Ends each work in the middle of each of its stages.
#[track_caller]
fn at_each_stage(how: &str, end: impl Fn(&mut Bench), after: impl Fn(&mut Bench)) {
    for (work, stages) in stages() {
        assert!(stages.len() >= 3, "{}: {stages:?}", work.name);
        let just_begun = ("just begun".to_owned(), 0);
        for (stage, frames) in [just_begun].iter().chain(stages) {
            let mut bench = (work.begin)();
            let before = fresh();
            bench.pass_ms(100 * frames);
            assert!(is_running(&mut bench), "{how}, {} at {stage:?} comes too late", work.name);
            end(&mut bench);
            bench.pass_ms(700);
            let place = format!("{how}, {} at {stage:?}", work.name);
            assert!(bench.both_stand(), "{place}: {}", bench.real_duty(Motor::M1));
            after(&mut bench);
            finish(&mut bench);
            assert!(bench.both_stand(), "{place}");
            assert_eq!(bench.model().front.link.arming, Arming::Disarmed, "{place}");
            assert_eq!(held(&bench), before, "{place}");
            let said = bench.said();
            let is_reported = |text: &String| {
                text.contains("was not tuned")
                    || text.contains("are back")
                    || text.contains("is tuned")
                    || text.contains("behaves")
                    || text.contains("M1: ")
            };
            assert!(said.iter().take(8).any(is_reported), "{place}: {said:?}");
        }
    }
}

/// What a controller of this configuration holds before anybody touches it.
fn fresh() -> (MotionSettings, u32) {
    let unit = Controller::new(config()).expect("the configuration is sound");
    (unit.settings().motors[0].motion, unit.settings().streams[0].timeout_ms)
}

#[test]
fn space_stops_at_each_stage() {
    at_each_stage("Space", |bench| bench.key(Key::Space), |_| {});
}

#[test]
fn escape_stops_at_each_stage() {
    at_each_stage("Esc", |bench| bench.key(Key::Escape), |_| {});
}

#[test]
fn the_button_of_the_run_ends_it_at_each_stage() {
    at_each_stage("Stop the run", |bench| bench.press("Stop the run"), |_| {});
}

#[test]
fn stop_all_ends_it_at_each_stage() {
    at_each_stage("Stop All", |bench| bench.press("Stop All"), |_| {});
}

#[test]
fn leaving_the_screen_ends_it_at_each_stage() {
    at_each_stage("leaving", |bench| bench.press("Device Status"), |_| {});
}

#[test]
fn disarming_ends_it_at_each_stage() {
    let disarm = |bench: &mut Bench| bench.key_with(Modifiers::COMMAND | Modifiers::SHIFT, Key::A);
    at_each_stage("disarming", disarm, |_| {});
}

#[test]
fn a_cable_pulled_at_each_stage_is_made_good_when_it_is_in_again() {
    let unplug = |bench: &mut Bench| bench.act(&WorldAction::Unplug { unplugged: true });
    at_each_stage("unplugging", unplug, |bench| {
        bench.pass_ms(1000);
        let said = bench.said();
        let lost = ["lost", "Gone", "gone", "pulled", "stopped answering", "unplugged"];
        assert!(said.iter().take(8).any(|text| lost.iter().any(|word| text.contains(word))), "{said:?}");
        bench.act(&WorldAction::Unplug { unplugged: false });
        bench.press("Connect");
        bench.pass_ms(5000);
    });
}

#[test]
fn a_frozen_window_stops_the_motor_and_the_old_gains_are_put_back_when_it_lives_again() {
    let mut bench = tune_velocity();
    for _ in 0..60 {
        if bench.real_duty(Motor::M1) > 0.9 {
            break;
        }
        bench.pass_ms(100);
    }
    assert!(bench.real_duty(Motor::M1) > 0.9);
    // 250 ms, and 50 ms that full duty takes to go to 0 at the highest deceleration.
    bench.freeze(Duration::from_millis(320));
    assert!(bench.both_stand(), "{}", bench.real_duty(Motor::M1));
    bench.pass_ms(2500);
    assert!(bench.both_stand() && !is_running(&mut bench));
    assert_eq!(bench.model().front.link.arming, Arming::Disarmed);
    assert_eq!(held(&bench), fresh());
    assert!(bench.sees_part("The run was stopped: this computer answered late"));
}

#[test]
fn the_link_is_closed_by_hand_once_everything_is_put_back() {
    let disconnect = |bench: &mut Bench| {
        bench.press("Disconnect");
        assert!(bench.sees_part("The link closes") || !is_running(bench), "{:?}", bench.said());
    };
    at_each_stage("Disconnect", disconnect, |bench| {
        finish(bench);
        bench.pass_ms(1500);
        assert!(!bench.model().is_connected(), "it does close: {:?}", bench.said());
    });
}

/// Asks the window to close as its title bar does.
fn close(bench: &mut Bench) {
    let viewports = &mut bench.harness.input_mut().viewports;
    viewports.entry(ViewportId::ROOT).or_default().events.push(ViewportEvent::Close);
    bench.harness.step();
    let viewports = &mut bench.harness.input_mut().viewports;
    viewports.entry(ViewportId::ROOT).or_default().events.clear();
}

fn asked_for(bench: &Bench, wanted: &ViewportCommand) -> bool {
    let viewports = &bench.harness.output().viewport_output;
    viewports.values().flat_map(|viewport| &viewport.commands).any(|command| command == wanted)
}

#[test]
fn the_window_closes_once_everything_is_put_back() {
    for (work, stages) in stages() {
        for (stage, frames) in stages {
            let mut bench = (work.begin)();
            bench.pass_ms(100 * frames);
            let place = format!("{} at {stage:?}", work.name);
            close(&mut bench);
            assert!(asked_for(&bench, &ViewportCommand::CancelClose), "{place}: it waits");
            assert!(!asked_for(&bench, &ViewportCommand::Close), "{place}");
            bench.pass_ms(100);
            let said = bench.said();
            assert!(
                said.iter().any(|text| text.contains("The window closes as soon as")),
                "{place}: {said:?}"
            );
            bench.pass_ms(200);
            assert!(bench.both_stand(), "{place}");
            let mut frames = 0;
            while !asked_for(&bench, &ViewportCommand::Close) {
                bench.pass_ms(100);
                frames += 1;
                assert!(frames < 100, "{place}: {:?}", bench.said());
            }
            assert_eq!(held(&bench), fresh(), "{place}");
            assert!(bench.both_stand(), "{place}");
        }
    }
}

#[test]
fn a_window_that_is_closed_twice_closes_at_once() {
    let mut bench = tune_velocity();
    bench.pass_ms(2600);
    close(&mut bench);
    assert!(!asked_for(&bench, &ViewportCommand::Close));
    close(&mut bench);
    assert!(asked_for(&bench, &ViewportCommand::Close));
    bench.pass_ms(300);
    assert!(bench.both_stand());
}

#[test]
fn a_window_with_nothing_to_put_back_closes_at_once() {
    let mut bench = opened("Velocity Settings");
    close(&mut bench);
    assert!(!asked_for(&bench, &ViewportCommand::CancelClose), "nothing holds it");
}

#[test]
fn another_unit_that_is_chosen_in_a_run_is_not_given_the_gains_of_this_one() {
    let unit = |address| {
        let address = brushwork_mcp_wire::packet_serial::Address::new(address).expect("an address");
        let config = ControllerConfig { address, settings: None, ..config() };
        Controller::new(config).expect("the configuration is sound")
    };
    let bus = Bus::new(vec![unit(0x80), unit(0x81)], StreamIndex::Uart1).expect("TTL lines can be shared");
    let mut bench = Bench::of_bus(bus);
    bench.connect();
    bench.arm_on("Velocity Settings");
    bench.press("Tune");
    let of = |bench: &Bench, unit: usize| bench.line.with(|bus| bus.controllers()[unit].settings().clone());
    let before = [of(&bench, 0), of(&bench, 1)];
    bench.press("Tune M1");
    bench.pass_ms(4500);
    assert!(is_running(&mut bench));
    bench.press("0x81  MCP266");
    bench.pass_ms(300);
    assert!(bench.both_stand());
    finish(&mut bench);
    bench.pass_ms(2000);
    let said = bench.said();
    assert_eq!(bench.model().front.link.selected, Some(0x81), "{said:?}");
    assert_eq!([of(&bench, 0), of(&bench, 1)], before);
}

#[test]
fn the_run_that_was_ended_is_kept_with_its_reason() {
    let mut bench = tune_velocity();
    bench.pass_ms(2600);
    bench.key(Key::Escape);
    finish(&mut bench);
    let run = bench.model().front.tune.front(Loop::Velocity).run().cloned();
    let run = run.expect("the run is there");
    assert!(run.is_refused());
    assert!(bench.sees_part("M1 was not tuned") && bench.sees("The run was stopped: Stop was pressed."));
}

#[test]
fn an_apply_that_is_stopped_or_cut_off_moves_nothing_is_told_and_can_be_undone() {
    for after_ms in [0, 300, 700, 1200, 1800] {
        for unplugs in [false, true] {
            let mut bench = tune_velocity();
            finish(&mut bench);
            bench.press("Apply (RAM)");
            bench.pass_ms(after_ms);
            let place = format!("after {after_ms} ms, unplugged: {unplugs}");
            if unplugs {
                bench.act(&WorldAction::Unplug { unplugged: true });
                bench.pass_ms(1500);
                bench.act(&WorldAction::Unplug { unplugged: false });
                bench.press("Connect");
                bench.pass_ms(5000);
                bench.press("Velocity Settings");
            } else {
                bench.key(Key::Escape);
            }
            bench.pass_ms(4000);
            assert!(bench.both_stand(), "{place}");
            assert_eq!(bench.model().front.link.arming, Arming::Disarmed, "{place}");
            let (now, timeout_ms) = held(&bench);
            assert_eq!(timeout_ms, USERS_MS, "{place}");
            if now != fresh().0 {
                bench.press("Undo");
                bench.pass_ms(4000);
            }
            assert_eq!(held(&bench), fresh(), "{place}: {:?}", bench.said());
        }
    }
}
