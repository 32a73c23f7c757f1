//! The guided path: from an empty start to a simulated axis that is tuned, saved and backed up, counted in clicks and in keys; and what
//! each step goes by.

use std::time::Duration;

use crate::support::bench::Bench;
use crate::support::hand::Hand;
use brushwork_gui::family::path::{PathStep, Place, ShownBy, Step};
use brushwork_gui::family::{self, Family};
use brushwork_gui::mcp::Mcp;
use brushwork_gui::model::path::Standing;
use brushwork_gui::motion_mind::MotionMind;
use brushwork_link::Clock as _;
use brushwork_link::settings::{Row, SettingsTable};
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::models::{MODELS, lookup};
use brushwork_mcp_wire::packet_serial::{Address, Generation};
use brushwork_motion_mind_sim::{Mode, MotionMindConfig};
use brushwork_plant::presets;
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use egui::accesskit::Role;
use egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

/// What the first hour may take at most.
const MOST_CLICKS: usize = 25;
const MOST_TIME: Duration = Duration::from_secs(180);

/// How each step stands.
fn standings(bench: &mut Bench) -> Vec<(Step, Standing)> {
    bench.model().front.path_steps().iter().map(|judged| (judged.step.step, judged.standing)).collect()
}

fn standing(bench: &mut Bench, step: Step) -> Standing {
    let all = standings(bench);
    all.iter().find(|(of, _)| *of == step).unwrap_or_else(|| panic!("no {step:?} in {all:?}")).1
}

/// What stands in the controller's EEPROM of a motor's loops: P of velocity and of position.
fn stored(bench: &Bench, motor: Motor) -> (u32, u32) {
    bench.line.with(|bus| {
        let motion = bus.controllers()[0].settings().motors[motor.index()].motion;
        (motion.velocity_p_raw, motion.position_p_raw)
    })
}

/// A controller with the motor of the examples on both sides.
fn empty_start() -> Bench {
    holding(None)
}

/// The same with these settings in its EEPROM.
fn holding(settings: Option<Settings>) -> Bench {
    let axis = presets::lookup("small-gearmotor").expect("a preset");
    let default = ControllerConfig::default();
    let world = presets::world_of(axis, axis, default.model.pins.len());
    let config = ControllerConfig { world, settings, ..default };
    Bench::of(Controller::new(config).expect("the preset is sound"))
}

#[test]
fn from_an_empty_start_to_a_tuned_and_saved_axis_by_mouse_alone() {
    let mut hand = Hand::on(empty_start());
    hand.bench.pass_ms(300);
    hand.click("Open MCP266");
    hand.bench.pass_ms(4000);
    assert!(hand.bench.sees("What to do next"));
    assert_eq!(standing(&mut hand.bench, Step::Limits), Standing::ToDo);
    assert_eq!(standing(&mut hand.bench, Step::Velocity), Standing::ToDo);
    hand.click("Leave it out");
    hand.click("Go to PWM Settings: Direction");
    hand.click("Arm");
    hand.bench.pass_ms(500);
    hand.hold("M1 jog forward", Duration::from_secs(2));
    assert!(hand.bench.sees("M1: They agree."));
    hand.click("Device Status");
    assert_eq!(standing(&mut hand.bench, Step::Direction), Standing::Done);
    assert_eq!(standing(&mut hand.bench, Step::Encoder), Standing::Done);
    for (go, step) in
        [("Go to Velocity Settings: Tune", Step::Velocity), ("Go to Position Settings: Tune", Step::Position)]
    {
        hand.click(go);
        hand.click("Arm");
        hand.bench.pass_ms(500);
        if step == Step::Position {
            hand.click("Turns freely");
        }
        hand.click("Tune M1");
        hand.wait_for_run();
        hand.click("Apply (RAM)");
        hand.bench.pass_ms(3000);
        hand.click("Device Status");
        hand.bench.pass_ms(2000);
        assert_eq!(standing(&mut hand.bench, step), Standing::Done, "{:?}", hand.bench.said());
    }
    assert_eq!(standing(&mut hand.bench, Step::Save), Standing::ToDo);
    hand.click("Save…");
    hand.bench.pass_ms(500);
    hand.click("Save");
    hand.bench.pass_ms(10_000);
    hand.click("Device Status");
    hand.bench.pass_ms(1000);
    assert_eq!(standing(&mut hand.bench, Step::Save), Standing::Done);
    if standing(&mut hand.bench, Step::BackUp) != Standing::Done {
        hand.click("Back up now");
        hand.bench.pass_ms(1000);
    }
    let left: Vec<_> =
        standings(&mut hand.bench).into_iter().filter(|(_, standing)| standing.is_open()).collect();
    assert!(left.is_empty(), "{left:?}");
    let took = hand.took();
    println!("by mouse: {} clicks, {:.0} s", hand.clicks, took.as_secs_f64());
    assert!(hand.clicks < MOST_CLICKS, "{} clicks", hand.clicks);
    assert!(took < MOST_TIME, "{took:?}");
    let (velocity, position) = stored(&hand.bench, Motor::M1);
    assert!(velocity != stored(&hand.bench, Motor::M2).0 && position != 0, "{velocity} {position}");
}

/// Fingers that count their keys.
struct Fingers {
    bench: Bench,
    keys: usize,
}

impl Fingers {
    fn focused(&self) -> Option<String> {
        let mut nodes = self.bench.harness.root().children_recursive();
        nodes.find(|node| node.accesskit_node().is_focused())?.accesskit_node().label()
    }

    fn key(&mut self, key: Key) {
        self.bench.key(key);
        self.keys += 1;
    }

    fn with_ctrl(&mut self, key: Key) {
        self.bench.key_with(Modifiers::COMMAND, key);
        self.bench.pass_ms(300);
        self.keys += 1;
    }

    /// Goes on to a button by so many regions and then from one thing to the next.
    #[track_caller]
    fn go_to(&mut self, regions: usize, name: &str) {
        for _ in 0..regions {
            self.key(Key::F6);
        }
        for _ in 0..60 {
            if self.focused().is_some_and(|label| label == name) {
                return;
            }
            self.key(Key::Tab);
        }
        panic!("{name:?} is not reached, only {:?}", self.focused());
    }

    #[track_caller]
    fn press(&mut self, regions: usize, name: &str) {
        self.go_to(regions, name);
        self.key(Key::Enter);
        self.bench.pass_ms(500);
    }

    /// Arms the open screen.
    fn arm(&mut self) {
        self.bench.key_with(Modifiers::COMMAND.plus(Modifiers::SHIFT), Key::A);
        self.bench.pass_ms(600);
        self.keys += 1;
    }

    /// Holds Enter down.
    fn hold(&mut self, time: Duration) {
        self.bench.harness.key_down(Key::Enter);
        self.bench.pass(time);
        self.bench.harness.key_up(Key::Enter);
        self.bench.pass_ms(1500);
        self.keys += 1;
    }
}

/// What the first hour may take in keys: by mouse it is one click for each of these acts, by keys the way to each comes first.
const MOST_KEYS: usize = 40;

#[test]
fn from_an_empty_start_to_a_tuned_and_saved_axis_by_keys_alone() {
    let mut hand = Fingers { bench: empty_start(), keys: 0 };
    let began = hand.bench.line.clock.now();
    hand.bench.pass_ms(300);
    hand.press(3, "Open MCP266");
    hand.bench.pass_ms(4000);
    hand.press(1, "Leave it out");
    assert_eq!(standing(&mut hand.bench, Step::Limits), Standing::NotNeeded);
    hand.press(0, "Go to PWM Settings: Direction");
    hand.arm();
    hand.go_to(1, "M1 jog forward");
    hand.hold(Duration::from_secs(2));
    hand.with_ctrl(Key::Num1);
    assert_eq!(standing(&mut hand.bench, Step::Direction), Standing::Done, "{:?}", hand.bench.said());
    for (go, step) in
        [("Go to Velocity Settings: Tune", Step::Velocity), ("Go to Position Settings: Tune", Step::Position)]
    {
        hand.press(1, go);
        hand.arm();
        if step == Step::Position {
            hand.press(1, "Turns freely");
            hand.press(0, "Tune M1");
        } else {
            hand.press(1, "Tune M1");
        }
        for _ in 0..120 {
            hand.bench.pass_ms(500);
            if !hand.bench.model().front.tune.is_running() {
                break;
            }
        }
        hand.bench.pass_ms(1500);
        hand.press(0, "Apply (RAM)");
        hand.bench.pass_ms(3000);
        hand.with_ctrl(Key::Num1);
        hand.bench.pass_ms(2000);
        assert_eq!(standing(&mut hand.bench, step), Standing::Done, "{:?}", hand.bench.said());
    }
    hand.key(Key::F10);
    hand.bench.pass_ms(500);
    hand.key(Key::Enter);
    hand.bench.pass_ms(10_000);
    hand.with_ctrl(Key::Num1);
    hand.bench.pass_ms(1000);
    assert_eq!(standing(&mut hand.bench, Step::Save), Standing::Done, "{:?}", hand.bench.said());
    if standing(&mut hand.bench, Step::BackUp) != Standing::Done {
        hand.press(1, "Back up now");
        hand.bench.pass_ms(1000);
    }
    let left: Vec<_> =
        standings(&mut hand.bench).into_iter().filter(|(_, standing)| standing.is_open()).collect();
    assert!(left.is_empty(), "{left:?}");
    let took = hand.bench.line.clock.now() - began;
    println!("by keys: {} keys, {:.0} s", hand.keys, took.as_secs_f64());
    assert!(hand.keys < MOST_KEYS, "{} keys", hand.keys);
    assert!(took < MOST_TIME, "{took:?}");
}

#[test]
fn a_controller_that_was_set_up_elsewhere_has_its_steps_done_by_its_own_values() {
    let config = ControllerConfig::default();
    let mut settings = Settings::factory(config.model, config.address.get());
    settings.motors[0].motion.velocity_p_raw = 0x2_3456;
    settings.motors[0].motion.position_p_raw = 0x1234;
    let mut bench = holding(Some(settings));
    bench.connect();
    bench.pass_ms(4000);
    for step in [Step::Direction, Step::Encoder, Step::Velocity, Step::Position] {
        assert_eq!(standing(&mut bench, step), Standing::Done, "{step:?}");
    }
    assert_eq!(standing(&mut bench, Step::Limits), Standing::ToDo);
    assert_eq!(standing(&mut bench, Step::Switches), Standing::NotNeeded);
    assert!(bench.sees("Step Velocity loop: done") && bench.sees("Step Power and limits: to do"));
}

#[test]
fn a_reversed_encoder_is_told_by_two_arrows_and_turned_round_there() {
    let axis = presets::lookup("small-gearmotor").expect("a preset");
    let model = lookup("roboclaw-2x30a").expect("it is listed");
    let world = presets::world_of(axis, axis, model.pins.len());
    let mut settings = Settings::factory(model, Address::DEFAULT.get());
    settings.unit.serial_timeout_tenths = 10;
    let (generation, settings) = (Generation::Gen4, Some(settings));
    let config = ControllerConfig { model, generation, world, settings, ..ControllerConfig::default() };
    let mut bench = Bench::of(Controller::new(config).expect("the preset is sound"));
    bench.connect();
    bench.act(&WorldAction::ReverseEncoder { motor: Motor::M1, on: true });
    bench.pass_ms(3000);
    bench.press("PWM Settings");
    bench.open_tab("Direction");
    bench.press("Arm");
    bench.pass_ms(500);
    bench.hold("M1 jog forward");
    bench.pass_ms(2000);
    assert!(bench.sees_part("M1 duty: forward"));
    assert!(bench.sees_part("M1 encoder: backward"));
    bench.let_go("M1 jog forward");
    bench.pass_ms(1500);
    assert!(bench.sees_part("M1: They disagree"));
    assert_eq!(standing(&mut bench, Step::Direction), Standing::Wrong);
    bench.press("Arm");
    bench.pass_ms(500);
    bench.press("Reverse encoder of M1");
    bench.pass_ms(3000);
    assert!(bench.sees("M1: Not seen yet."), "what was seen before is no longer so");
    bench.press("Arm");
    bench.pass_ms(500);
    bench.hold("M1 jog forward");
    bench.pass_ms(2000);
    bench.let_go("M1 jog forward");
    assert!(bench.sees("M1: They agree."));
}

#[test]
fn a_step_is_left_out_and_taken_up_again() {
    let mut bench = empty_start();
    bench.connect();
    bench.pass_ms(4000);
    bench.press("Leave it out");
    assert_eq!(standing(&mut bench, Step::Limits), Standing::NotNeeded);
    assert!(bench.sees("Go to PWM Settings: Direction"), "the next one is shown");
    bench.press("Step Power and limits: not needed");
    bench.press("Take it up again");
    assert_eq!(standing(&mut bench, Step::Limits), Standing::ToDo);
    assert!(bench.both_stand(), "nothing of this moves a motor");
}

#[test]
fn a_motion_mind_has_the_steps_that_it_can_do_in_its_mode() {
    for (mode, has_loop) in [(Mode::SerialPid, true), (Mode::Serial, false)] {
        let mut bench = Bench::with_minds(vec![MotionMindConfig::new(mode)]);
        bench.pass_ms(200);
        bench.choose("Simulated model", "Motion Mind 3");
        bench.connect();
        bench.pass_ms(4000);
        let steps: Vec<Step> = standings(&mut bench).into_iter().map(|(step, _)| step).collect();
        assert_eq!(steps.contains(&Step::Position), has_loop, "{mode:?}: {steps:?}");
        assert!(!steps.contains(&Step::Velocity) && steps.contains(&Step::Save), "{mode:?}: {steps:?}");
    }
}

/// The settings that a step goes by.
const fn keys(step: &PathStep) -> &'static [&'static str] {
    match step.shown_by {
        ShownBy::Settings(keys) | ShownBy::IfWanted(keys) => keys,
        ShownBy::Turning | ShownBy::Counting | ShownBy::Switches | ShownBy::Saved | ShownBy::BackedUp => &[],
    }
}

#[test]
fn every_setting_and_page_that_a_step_names_exists_for_each_model_and_firmware() {
    crate::support::install_families();
    let mut tables: Vec<(&dyn Family, String, SettingsTable)> = Vec::new();
    for model in MODELS {
        for generation in Generation::ALL {
            let table = SettingsTable::new(brushwork_mcp_client::subject(model, generation));
            tables.push((&Mcp, format!("{} {generation:?}", model.key), table));
        }
    }
    let (mut named, mut reversible) = (0, 0);
    for (family, name, table) in &tables {
        for step in family.path() {
            let number = |key: &str, motor: usize| key.replace("{n}", &motor.to_string());
            for key in keys(step) {
                assert!(table.row(&number(key, 1)).is_some(), "{name}: {key} of {:?}", step.step);
                named += 1;
            }
            match step.place {
                Place::Settings(groups) => {
                    let is_there = |row: &Row| groups.contains(&row.group.label());
                    assert!(table.rows().iter().any(is_there), "{name}: {groups:?}");
                }
                Place::Drawer(screen, tab) => assert!(family.tabs(screen).contains(&tab), "{name}: {tab:?}"),
                Place::Recipe(job) => {
                    let known = family.recipes().expect("a family with such a step has recipes");
                    assert!(known.all().iter().any(|recipe| recipe.job == job), "{name}: {job:?}");
                }
                Place::Screen(screen) => assert!(brushwork_gui::model::Screen::ALL.contains(&screen)),
                Place::Save | Place::BackUp => {}
            }
        }
        let reversed = family.direction_keys().unwrap_or_default();
        let is_there = |key: &&str| table.row(&key.replace("{n}", "1")).is_some();
        reversible += usize::from(reversed.iter().all(is_there));
    }
    assert!(reversible > 10, "RoboClaws turn a direction round by a setting: {reversible}");
    assert!(named > 100, "{named}");
    let mut bench = Bench::with_minds(vec![MotionMindConfig::new(Mode::SerialPid)]);
    bench.pass_ms(200);
    bench.choose("Simulated model", "Motion Mind 3");
    bench.connect();
    bench.pass_ms(2000);
    let unit = bench.model().front.settings.unit().expect("it answered");
    for step in MotionMind.path() {
        for key in keys(step) {
            assert!(unit.table().row(key).is_some(), "{key} of {:?}", step.step);
        }
    }
    assert!(family::all().iter().all(|family| !family.path().is_empty()));
}

#[test]
fn the_status_begins_with_what_to_do_and_with_a_fault_before_that() {
    let mut bench = empty_start();
    bench.connect();
    bench.pass_ms(4000);
    let top = |bench: &Bench, part: &str| {
        let mut found = bench.harness.query_all_by_label_contains(part);
        found.next().map_or_else(|| panic!("no {part}"), |node| node.rect().top())
    };
    assert!(top(&bench, "What to do next") < top(&bench, "Diagnosis:"));
    bench.act(&WorldAction::EStop { pressed: true });
    bench.pass_ms(3000);
    assert!(top(&bench, "Diagnosis:") < top(&bench, "What to do next"));
    let chips = bench.harness.query_all_by_role(Role::Button);
    let steps = chips.filter(|node| node.accesskit_node().label().is_some_and(|l| l.starts_with("Step ")));
    assert_eq!(steps.count(), Mcp.path().len());
}
