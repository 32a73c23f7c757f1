//! Eleven jobs of somebody's first days with a controller, each done by the mouse alone through real pointer events on a simulated MCP266.
//!
//! Clicks, keys and virtual time are counted and compared with `tests/ion_studio/jobs.md`, whose last column holds what a job may take.
#![expect(clippy::print_stdout, reason = "what a job takes is a row of the table")]

use std::time::Duration;

use crate::support::bench::Bench;
use crate::support::hand::Hand;
use brushwork_gui::model::Sheet;
use brushwork_gui::model::screen::Screen;
use brushwork_link::Channel;
use brushwork_link::settings::SettingValue;
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_mcp_sim::settings::Settings;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_plant::presets;
use brushwork_plant::world::{PinSignal, WorldAction};
use brushwork_values::Motor;

const TABLE: &str = include_str!("../../../../tests/ion_studio/jobs.md");

/// Software resets the emergency stop (MCP manual 2.1.5).
const BY_SOFTWARE: u8 = 0xAA;
/// No signal type, as after an input was given up.
const NO_KIND: u8 = 0;

/// One row of the table.
#[derive(Debug)]
struct Row {
    job: &'static str,
    clicks: usize,
    keys: usize,
    seconds: f64,
    most_clicks: usize,
}

fn rows() -> Vec<Row> {
    let lines = TABLE
        .lines()
        .filter(|line| line.starts_with("| ") && !line.starts_with("| Job ") && !line.starts_with("| -"));
    let row = |line: &'static str| {
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
        let [job, _, _, clicks, keys, seconds, most_clicks] = cells[..] else {
            panic!("seven columns: {line}")
        };
        let number = |text: &str| text.parse().unwrap_or_else(|why| panic!("{text}: {why}: {line}"));
        let seconds = seconds.parse().expect("a number of seconds");
        Row { job, clicks: number(clicks), keys: number(keys), seconds, most_clicks: number(most_clicks) }
    };
    lines.map(row).collect()
}

/// Compares what a job took with its row.
#[track_caller]
fn compare(job: &str, hand: &Hand) {
    let took = hand.took().as_secs_f64();
    println!("{job}: {} clicks, {} keys, {} turns, {took:.0} s", hand.clicks, hand.keys, hand.turns);
    let rows = rows();
    let row = rows.iter().find(|row| row.job == job).unwrap_or_else(|| panic!("no row {job}"));
    assert_eq!((hand.clicks, hand.keys), (row.clicks, row.keys), "clicks and keys of {job}");
    assert!(hand.clicks <= row.most_clicks, "{row:?}");
    // A run of the tuner takes what it takes; the rest is what a hand takes.
    let room = (0.3 * row.seconds).max(3.0);
    assert!((took - row.seconds).abs() <= room, "{took:.1} s, {row:?}");
}

#[test]
fn the_table_has_eleven_jobs_each_within_what_it_may_take() {
    let rows = rows();
    assert_eq!(rows.len(), 11);
    for row in rows {
        assert!(row.clicks <= row.most_clicks && row.most_clicks <= 8, "{row:?}");
    }
}

/// A controller with the motor of the examples on both sides, and these settings of the factory's changed.
fn unit(generation: Generation, change: impl FnOnce(&mut Settings)) -> Controller {
    let axis = presets::lookup("small-gearmotor").expect("a preset");
    let default = ControllerConfig::default();
    let world = presets::world_of(axis, axis, default.model.pins.len());
    let mut settings = Settings::factory(default.model, default.address.get());
    // A factory's time-out of none would keep every screen from being armed where it is not simulated.
    settings.unit.serial_timeout_tenths = 10;
    change(&mut settings);
    let config = ControllerConfig { generation, world, settings: Some(settings), ..default };
    Controller::new(config).expect("the preset is sound")
}

fn usual() -> Controller {
    unit(Generation::Gen1, |_| {})
}

/// A hand in front of the status of a controller that has been connected and read.
fn connected_to(unit: Controller) -> Hand {
    let mut bench = Bench::of(unit);
    bench.connect();
    bench.pass_ms(4000);
    assert_eq!(bench.model().screen, Screen::DeviceStatus);
    Hand::on(bench)
}

fn truth(hand: &Hand) -> Settings {
    hand.bench.line.with(|bus| bus.controllers()[0].settings())
}

fn stored(hand: &Hand) -> Settings {
    hand.bench.line.with(|bus| bus.controllers()[0].stored_settings())
}

/// Writes the edits to the controller.
fn write(hand: &mut Hand) {
    hand.click("Write settings");
    hand.click("Write to controller");
    hand.bench.pass_ms(3000);
}

#[test]
fn to_connect() {
    let mut bench = Bench::of(usual());
    bench.pass_ms(300);
    let mut hand = Hand::on(bench);
    hand.click("Open MCP266");
    hand.bench.pass_ms(4000);
    assert!(hand.bench.model().is_connected());
    assert!(hand.bench.sees("Model: MCP266 (simulated)") && hand.bench.sees("What to do next"));
    compare("Connect", &hand);
}

#[test]
fn to_see_which_way_a_motor_and_its_encoder_turn() {
    let mut hand = connected_to(usual());
    hand.click("Step Which way it turns: to do");
    hand.click("Go to PWM Settings: Direction");
    hand.click("Arm");
    hand.bench.pass_ms(500);
    hand.hold("M1 jog forward", Duration::from_secs(2));
    assert!(hand.bench.sees("M1: They agree."), "{:?}", hand.bench.said());
    assert!(hand.bench.both_stand());
    compare("Direction", &hand);
}

#[test]
fn to_limit_a_motors_current_and_save_it() {
    let mut hand = connected_to(usual());
    hand.click("Go to Current limits");
    hand.figure("Motor 1: maximum current", "12.5");
    write(&mut hand);
    hand.click("Save to EEPROM");
    hand.click("Save");
    hand.bench.pass_ms(10_000);
    let limit = |settings: &Settings| settings.motors[0].motion.max_current_raw;
    assert_eq!((limit(&truth(&hand)), limit(&stored(&hand))), (1250, 1250), "{:?}", hand.bench.said());
    compare("Current limit and save", &hand);
}

#[test]
fn to_set_up_an_encoder() {
    let bare = unit(Generation::Gen1, |settings| {
        for signal in &mut settings.signals {
            signal.kind = NO_KIND;
        }
    });
    let mut hand = connected_to(bare);
    let counts = |hand: &Hand| truth(hand).signals.iter().filter(|signal| signal.kind != NO_KIND).count();
    assert_eq!(counts(&hand), 0);
    hand.click("Step Encoder: to do");
    hand.click("Go to Recipes: Encoder");
    hand.click("Make these the wanted settings");
    write(&mut hand);
    assert_eq!(counts(&hand), 2, "{:?}", hand.bench.said());
    assert!(hand.bench.sees("It is set so"));
    compare("Encoder", &hand);
}

#[test]
fn to_set_up_a_home_switch() {
    let mut hand = connected_to(usual());
    hand.click("Step Switches and homing: not needed");
    hand.click("Go to Recipes: Home switch");
    hand.bench.pass_ms(1000);
    let pin = hand.bench.model().front.general.recipes.answers.pin;
    hand.bench.act(&WorldAction::SetPin { pin: pin - 1, signal: PinSignal::Volts { volts: 2.5 } });
    hand.click("Make these the wanted settings");
    write(&mut hand);
    assert!(hand.bench.sees("It is set so"), "{:?}", hand.bench.said());
    compare("Home switch", &hand);
    // It does what it was set up for.
    let count = |hand: &mut Hand| hand.bench.model().front.link.readings.get(Channel::M1_POSITION);
    hand.bench.arm();
    hand.bench.set_duty(Motor::M1, "30");
    hand.bench.pass_ms(1000);
    hand.bench.set_duty(Motor::M1, "0");
    hand.bench.pass_ms(3000);
    assert!(count(&mut hand).is_some_and(|counts| counts > 100.0), "{:?}", count(&mut hand));
    hand.bench.act(&WorldAction::SetPin { pin: pin - 1, signal: PinSignal::Volts { volts: 0.0 } });
    hand.bench.pass_ms(1000);
    assert_eq!(count(&mut hand), Some(0.0));
}

/// From the button of the path to gains that the controller works with.
fn tune(hand: &mut Hand, go: &str, says_travel: bool) {
    hand.click(go);
    hand.click("Arm");
    hand.bench.pass_ms(500);
    if says_travel {
        hand.click("Turns freely");
    }
    hand.click("Tune M1");
    hand.wait_for_run();
    hand.click("Apply (RAM)");
    hand.bench.pass_ms(3000);
}

#[test]
fn to_tune_a_velocity_loop() {
    let mut hand = connected_to(usual());
    let before = truth(&hand).motors[0].motion.velocity_p_raw;
    hand.click("Step Velocity loop: to do");
    tune(&mut hand, "Go to Velocity Settings: Tune", false);
    assert_ne!(truth(&hand).motors[0].motion.velocity_p_raw, before, "{:?}", hand.bench.said());
    compare("Velocity loop", &hand);
}

#[test]
fn to_tune_a_position_loop() {
    let mut hand = connected_to(usual());
    assert_eq!(truth(&hand).motors[0].motion.position_p_raw, 0);
    hand.click("Step Position loop: to do");
    tune(&mut hand, "Go to Position Settings: Tune", true);
    assert_ne!(truth(&hand).motors[0].motion.position_p_raw, 0, "{:?}", hand.bench.said());
    compare("Position loop", &hand);
}

#[test]
fn to_find_out_why_it_does_not_run_and_run_it() {
    let mut bench = Bench::of(unit(Generation::Gen1, |settings| settings.unit.estop_lock = BY_SOFTWARE));
    bench.connect();
    bench.pass_ms(4000);
    bench.press("PWM Settings");
    bench.act(&WorldAction::EStop { pressed: true });
    bench.pass_ms(2000);
    let mut hand = Hand::on(bench);
    hand.click("Device Status");
    assert!(hand.bench.sees_part("Diagnosis: The motors do not run: "));
    assert!(hand.bench.sees_part("mergency stop"));
    hand.bench.act(&WorldAction::EStop { pressed: false });
    hand.bench.pass_ms(1000);
    hand.click("Reset emergency stop");
    hand.bench.pass_ms(1500);
    hand.click("PWM Settings");
    hand.click("Arm");
    hand.bench.pass_ms(500);
    hand.bench.hold("M1 jog forward");
    hand.bench.pass_ms(1000);
    assert!(hand.bench.real_duty(Motor::M1) > 0.0, "{:?}", hand.bench.said());
    hand.bench.let_go("M1 jog forward");
    hand.clicks += 1;
    compare("Why does it not run", &hand);
}

#[test]
fn to_bring_a_backup_to_another_firmware() {
    let mut bench = Bench::of(unit(Generation::Gen1, |settings| {
        settings.motors[0].motion.max_current_raw = 1250;
        settings.motors[1].motion.velocity_p_raw = 0x2_3456;
    }));
    bench.connect();
    bench.pass_ms(4000);
    bench.model().front.settings.back_up().expect("it was read");
    // The same unit, as it comes back from an update of its firmware.
    let mut bench = bench.after_an_exchange(unit(Generation::Gen4, |_| {}));
    bench.connect();
    bench.pass_ms(4000);
    let id = brushwork_core::keep::UnitId::new(bench.model().front.link.identity().expect("connected"), &[]);
    let backups = bench.store().backups(Some(&id));
    assert_eq!(backups.len(), 1);
    let title = backups[0].title();
    let mut hand = Hand::on(bench);
    hand.click("General Settings");
    hand.bench.pass_ms(1000);
    hand.click("Backups");
    hand.click(&format!("Restore backup {title}"));
    let sheet = hand.bench.model().front.general.sheet.clone();
    assert_eq!(sheet, Some(Sheet::Write), "what changes is shown first");
    hand.click("Write to controller");
    hand.bench.pass_ms(3000);
    let settings = truth(&hand);
    assert_eq!(settings.motors[0].motion.max_current_raw, 1250, "{:?}", hand.bench.said());
    assert_eq!(settings.motors[1].motion.velocity_p_raw, 0x2_3456);
    compare("Backup to another firmware", &hand);
}

#[test]
fn to_record_and_export() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let mut hand = connected_to(usual());
    hand.bench.model().front.graph.files.folder = folder.path().display().to_string();
    hand.click("PWM Settings");
    hand.click("Record to CSV");
    hand.bench.pass_ms(5000);
    hand.click("Stop recording");
    hand.click("More");
    hand.click("PNG");
    let count = |end: &str| {
        let entries = std::fs::read_dir(folder.path()).expect("it is there");
        let names = entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
        names.filter(|name| !name.starts_with('.') && name.ends_with(end)).count()
    };
    hand.bench.until("a recording and a picture", |_| count(".csv") == 1 && count(".png") == 1);
    compare("Record and export", &hand);
}

#[test]
fn to_run_a_script() {
    let mut hand = connected_to(usual());
    hand.click("MCL Editor");
    hand.click("File");
    hand.click("Example: Ramp");
    hand.click("Toolbar Download MCL");
    hand.bench.pass_ms(3000);
    hand.click("Arm");
    hand.bench.pass_ms(500);
    hand.click("Toolbar Start Script");
    hand.bench.pass_ms(1000);
    assert!(hand.bench.real_duty(Motor::M1) > 0.0, "{:?}", hand.bench.said());
    compare("Script", &hand);
}

/// What is edited alone is neither written nor kept.
#[test]
fn no_job_leaves_edits_behind() {
    let mut hand = connected_to(usual());
    hand.click("Go to Current limits");
    hand.figure("Motor 1: maximum current", "12.5");
    hand.bench.press("Revert all");
    let edits = hand.bench.model().front.settings.unit().expect("it is there").edits().clone();
    assert_eq!(edits.get("motor1.current.max_amps"), None::<SettingValue>);
    assert_ne!(truth(&hand).motors[0].motion.max_current_raw, 1250);
}
