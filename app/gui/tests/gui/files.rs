//! Files that are opened from the start page or dropped on the window: each is known for what it is and goes to where it belongs, with a
//! controller and without one.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use brushwork_gui::model::{Screen, Sheet};
use brushwork_link::bounded::MOST_BYTES;
use brushwork_link::settings::{Profile, SettingValue};
use egui::{DroppedFile, HoveredFile};
use egui_kittest::kittest::Queryable as _;

use crate::support::bench::Bench;

const TUNED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/reports/tuned.json");

#[derive(Debug)]
struct Dropped(PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        Err("the window reads files by their paths".to_owned())
    }
}

/// Drops files on the window.
pub fn drop_on(bench: &mut Bench, paths: &[&Path]) {
    let files = paths.iter().map(|path| Arc::new(Dropped((*path).to_owned())) as _);
    bench.harness.input_mut().dropped_files = files.collect();
    bench.harness.step();
    bench.pass_ms(300);
}

fn last_said(bench: &mut Bench) -> String {
    bench.said().first().cloned().unwrap_or_default()
}

/// The settings of the simulated MCP266, with one that differs from the factory's; the window is without a link again.
fn profile_of_a_unit(bench: &mut Bench, path: &Path) -> Profile {
    bench.connect();
    bench.pass_ms(4000);
    let unit = bench.model().front.settings.unit().expect("it answered");
    let mut profile = unit.profile(false).expect("it was read");
    profile.settings.set("motor1.current.max_amps", SettingValue::Number(12.5));
    profile.save(path).expect("the folder can be written");
    bench.press("Disconnect");
    bench.pass_ms(1000);
    profile
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder can be made")
}

fn put(folder: &tempfile::TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, text).expect("the folder can be written");
    path
}

#[test]
fn a_profile_is_looked_at_without_a_controller_with_units_and_what_differs() {
    let (mut bench, folder) = (Bench::new(), folder());
    let path = folder.path().join("axis.json");
    profile_of_a_unit(&mut bench, &path);
    bench.press("Device Status");
    if bench.sees("Start page") {
        bench.press("Start page");
    }
    bench.harness.get_by_label("File to open").focus();
    bench.pass_ms(200);
    bench.harness.get_by_label("File to open").type_text(path.to_str().expect("it is text"));
    bench.pass_ms(200);
    bench.press("Open");
    let said = bench.said();
    assert_eq!(bench.model().screen, Screen::GeneralSettings, "{said:?}");
    assert!(bench.sees("Profile axis.json"));
    assert!(bench.sees_part("Of MCP266"));
    bench.press("Only what differs from the factory (1)");
    assert!(bench.sees_part("Motor 1: maximum current: 12.50 A, the factory has") || bench.sees_part("12.5"));
    let shown = bench.model().files.settings.as_ref().map(|file| file.shown().len());
    assert_eq!(shown, Some(1));
    assert!(!bench.sees("Write settings") && !bench.sees_part("Take over"), "nothing here can be changed");
    bench.press("Start page");
    assert!(bench.sees("axis.json"), "it was opened before");
    bench.press("axis.json");
    assert!(bench.sees("Profile axis.json"));
    bench.press("Device Status");
    bench.press("General Settings");
    assert!(bench.sees("Profile axis.json"), "it stays open until it is closed");
}

#[test]
fn the_backups_of_every_controller_are_looked_at_without_one() {
    let mut bench = Bench::new();
    bench.connect();
    bench.pass_ms(4000);
    bench.model().front.settings.back_up().expect("it was read");
    bench.press("Disconnect");
    bench.pass_ms(1000);
    bench.press("Device Status");
    if bench.sees("Start page") {
        bench.press("Start page");
    }
    bench.press("Backups…");
    assert!(bench.sees("Backups"), "{:?}", bench.said());
    let backup = bench.store().backups(None).remove(0);
    bench.press(&format!("Open backup {}", backup.title()));
    assert!(bench.sees(&format!("Backup {}", backup.title())));
    bench.press("All backups");
    assert!(bench.sees(&format!("Open backup {}", backup.title())));
    bench.press("Start page");
    assert!(bench.sees("Open MCP266"), "the start page");
}

#[test]
fn a_tuning_report_shows_its_plots_without_a_controller() {
    let mut bench = Bench::new();
    bench.pass_ms(300);
    drop_on(&mut bench, &[Path::new(TUNED)]);
    let screen = bench.model().screen;
    assert!(matches!(screen, Screen::Velocity | Screen::Position), "{screen:?}: {:?}", bench.said());
    assert!(bench.sees_part("Tuned · run 1") || bench.sees_part("Tuned with warnings"), "{:?}", bench.said());
    assert!(bench.sees("Bode") && bench.sees("Sensitivity"), "its pictures");
    assert!(bench.sees_part("No controller is connected."));
    bench.press("Start page");
    assert!(bench.sees("Open MCP266"), "the start page");
}

#[test]
fn what_is_dropped_goes_to_where_it_belongs_without_a_controller() {
    let (mut bench, folder) = (Bench::new(), folder());
    let profile = folder.path().join("axis.json");
    profile_of_a_unit(&mut bench, &profile);
    let script = put(&folder, "wave.mcl", "PRINT 1\nEND\n");
    let recording = put(&folder, "run.csv", "time_s,M1 PWM (%)\n0.0,0\n0.1,5\n0.2,7\n");
    let image = put(&folder, "image.bin", "no real image");
    drop_on(&mut bench, &[&profile]);
    assert!(bench.sees("Profile axis.json"));
    drop_on(&mut bench, &[&script]);
    assert_eq!(bench.model().screen, Screen::MclEditor);
    bench.until("the script", |bench| bench.sees_part("wave.mcl"));
    drop_on(&mut bench, &[&recording]);
    assert_eq!(bench.model().screen, Screen::Pwm);
    bench.until("the recording", |bench| bench.model().front.graph.opened.is_some());
    drop_on(&mut bench, &[&image]);
    let firmware = &bench.model().front.mcp().firmware;
    assert!(firmware.open && firmware.path.ends_with("image.bin") && !firmware.accepted);
    assert_eq!(bench.model().files.recent.len(), 4);
}

#[test]
fn with_a_controller_a_dropped_profile_stands_beside_it_and_nothing_is_written() {
    let (mut bench, folder) = (Bench::new(), folder());
    let path = folder.path().join("axis.json");
    profile_of_a_unit(&mut bench, &path);
    bench.connect();
    bench.pass_ms(4000);
    bench.arm_on("PWM Settings");
    drop_on(&mut bench, &[&path]);
    let said = bench.said();
    assert_eq!(bench.model().front.general.sheet, Some(Sheet::Compare), "{said:?}");
    assert!(bench.sees("1 setting differs."));
    bench.pass_ms(500);
    assert!(bench.model().arm_scope().is_none() && bench.both_stand(), "leaving a screen disarms");
    assert!(bench.model().front.settings.unit().expect("it is there").edits().is_empty());
}

#[test]
fn what_is_refused_is_a_sentence_and_so_are_too_many() {
    let (mut bench, folder) = (Bench::new(), folder());
    bench.pass_ms(300);
    let picture = put(&folder, "axis.png", "a picture");
    let other = put(&folder, "other.json", "{}");
    let long = folder.path().join("long.mcl");
    std::fs::File::create(&long).and_then(|file| file.set_len(MOST_BYTES + 1)).expect("it can be made");
    for (path, said) in [
        (picture.as_path(), "it is no profile"),
        (other.as_path(), "it holds neither"),
        (long.as_path(), "it has more than 16 MiB"),
        (folder.path(), "it is a folder"),
    ] {
        drop_on(&mut bench, &[path]);
        let sentence = last_said(&mut bench);
        assert!(sentence.contains(said) && sentence.ends_with('.'), "{sentence}");
    }
    assert!(bench.model().files.recent.is_empty(), "what was refused was not opened");
    let many = [other.as_path(); 10];
    drop_on(&mut bench, &many);
    assert!(last_said(&mut bench).starts_with("10 files at once"), "{:?}", bench.said());
}

#[test]
fn while_a_file_is_held_over_the_window_it_says_what_can_be_dropped() {
    let mut bench = Bench::new();
    bench.pass_ms(300);
    bench.harness.input_mut().hovered_files = vec![HoveredFile::default()];
    bench.harness.step();
    bench.harness.step();
    assert!(bench.sees("Drop to open the file"));
    bench.harness.input_mut().hovered_files.clear();
    bench.pass_ms(300);
    assert!(!bench.sees("Drop to open the file"));
}
