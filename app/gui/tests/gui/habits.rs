//! What people are used to: pictures on the clipboard, files opened together, units looked at as the last time, settings copied from unit to
//! unit, everything in the palette, keys as the platform writes them, and how long work takes yet.

use std::path::{Path, PathBuf};

use brushwork_gui::App;
use brushwork_gui::model::{Screen, Sheet, Side, Take};
use brushwork_gui::remember::Memory;
use brushwork_mcp_sim::controller::{Controller, ControllerConfig};
use brushwork_values::Motor;
use egui::accesskit::Role;
use egui::os::OperatingSystem;
use egui::{ColorImage, Key, Modifiers, OutputCommand};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use crate::support::bench::Bench;

fn app(bench: &mut Bench) -> &mut App {
    bench.harness.state_mut().as_mut().expect("the window is drawn")
}

fn palette(bench: &mut Bench, letters: &str) {
    bench.key_with(Modifiers { shift: true, ..Modifiers::COMMAND }, Key::P);
    bench.pass_ms(200);
    bench.harness.get_by_role_and_label(Role::TextInput, "Command").type_text(letters);
    bench.pass_ms(200);
    bench.key(Key::Enter);
    bench.pass_ms(300);
}

/// What was put on the clipboard since now, once it is there.
fn copied_picture(bench: &mut Bench) -> ColorImage {
    let mut found = None;
    bench.until("the picture is on the clipboard", |bench| {
        let commands = bench.harness.output().platform_output.commands.clone();
        let image = |command| match command {
            OutputCommand::CopyImage(image) => Some(image),
            OutputCommand::CopyText(_)
            | OutputCommand::TextSelectionSettled(_)
            | OutputCommand::OpenUrl(_) => None,
        };
        found = commands.into_iter().find_map(image).or(found.take());
        found.is_some()
    });
    found.expect("it was found")
}

#[test]
fn a_plot_is_copied_as_a_picture_from_its_menu_by_its_key_and_by_the_palette() {
    let mut bench = Bench::new();
    bench.connect();
    bench.press("PWM Settings");
    bench.pass_ms(2000);
    bench.press("More");
    bench.press("Copy picture");
    let by_menu = copied_picture(&mut bench);
    bench.key(Key::Escape);
    bench.pass_ms(300);
    assert!(bench.said().contains(&"The picture is on the clipboard.".to_owned()), "{:?}", bench.said());
    let is_plot = |label: &str| label.starts_with("Live graph of the last");
    bench.harness.get_by(|node| node.label().is_some_and(|label| is_plot(&label))).focus();
    bench.pass_ms(100);
    bench.harness.event(egui::Event::Copy);
    let by_key = copied_picture(&mut bench);
    palette(&mut bench, "copy the picture");
    let by_palette = copied_picture(&mut bench);
    for image in [&by_menu, &by_key, &by_palette] {
        assert!(image.size[0] >= 1800 && image.size[1] >= 840, "{:?}", image.size);
        let first = image.pixels[0];
        let other = image.pixels.iter().filter(|pixel| **pixel != first).count();
        assert!(other > 10_000, "{other} pixels are lines and words");
    }
}

/// Records a second of what comes in.
fn recording(bench: &mut Bench) -> PathBuf {
    bench.press("Record to CSV");
    bench.pass_ms(1500);
    bench.press("Stop recording");
    bench.pass_ms(1000);
    let folder = bench.model().front.graph.files.folder.clone();
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .expect("the folder of recordings")
        .map(|entry| entry.expect("a file").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "csv"))
        .collect();
    files.sort();
    files.pop().expect("it was recorded")
}

#[test]
fn several_recordings_that_are_chosen_together_lie_over_each_other() {
    let mut bench = Bench::new();
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    bench.connect();
    bench.press("PWM Settings");
    bench.pass_ms(1000);
    bench.model().front.graph.files.folder = folder.path().display().to_string();
    let files: Vec<PathBuf> = (0..3).map(|_| recording(&mut bench)).collect();
    // What the file dialog of the graph gives, and that of the start page and the menu.
    bench.model().front.graph.files.open_together(&files);
    let all = |bench: &mut Bench| {
        let graph = &bench.model().front.graph;
        graph.opened.is_some() && graph.runs.len() == 2
    };
    bench.until("all of them are read", all);
    assert!(bench.sees_part(". Earlier runs: "));
    bench.model().front.graph.close_recording();
    bench.model().front.graph.runs.clear();
    app(&mut bench).open_files(&files);
    bench.until("all of them are read again", all);
    let many: Vec<PathBuf> = (0..9).map(|number| folder.path().join(format!("{number}.txt"))).collect();
    app(&mut bench).open_files(&many);
    bench.pass_ms(300);
    assert!(bench.said().iter().any(|said| said.starts_with("9 files at once; the first 8")));
}

fn shown(bench: &mut Bench) -> Vec<String> {
    let channels = &bench.model().front.graph.live.channels;
    channels.iter().filter(|channel| channel.shown).map(|channel| channel.info.key.clone()).collect()
}

fn remembering(bench: &mut Bench, path: &Path) {
    let (memory, failure) = Memory::at(Some(path.to_owned()));
    assert!(failure.is_none(), "{failure:?}");
    app(bench).remember(memory);
}

#[test]
fn a_unit_is_looked_at_as_the_last_time_on_its_screen_with_its_channels_and_scales() {
    let folder = tempfile::tempdir().expect("a temporary folder can be made");
    let path = folder.path().join("window.json");
    let mut bench = Bench::new();
    bench.pass_ms(200);
    remembering(&mut bench, &path);
    bench.connect();
    bench.press("Velocity Settings");
    bench.pass_ms(500);
    let (seen, scale) = {
        let sheet = &mut bench.model().front.graph.live;
        let battery = sheet.track.channel_of_key("main_battery").expect("an MCP has it");
        sheet.channels[battery].shown = true;
        sheet.set_scale(battery, brushwork_gui::graph::Scale { low: 5.0, high: 45.0 });
        sheet.set_span_s(60.0);
        (battery, sheet.channels[battery].scale)
    };
    let channels = shown(&mut bench);
    bench.pass_ms(500);
    bench.press("Disconnect");
    bench.pass_ms(500);
    // Another unit was looked at otherwise meanwhile: what it left behind is not taken for this one's.
    bench.press("Device Status");
    bench.pass_ms(2000);

    let unit = Controller::new(ControllerConfig::default()).expect("the default configuration is sound");
    let mut bench = bench.after_an_exchange(unit);
    bench.pass_ms(200);
    remembering(&mut bench, &path);
    assert_eq!(bench.model().screen, Screen::DeviceStatus);
    bench.connect();
    bench.pass_ms(500);
    assert_eq!(bench.model().screen, Screen::Velocity, "where it was left");
    assert_eq!(shown(&mut bench), channels);
    let sheet = &bench.model().front.graph.live;
    assert_eq!((sheet.span_s(), sheet.channels[seen].scale), (60.0, scale));
    assert!(bench.both_stand() && bench.model().arm_scope().is_some());
    assert_eq!(bench.model().front.link.arming, brushwork_gui::model::Arming::Disarmed);
}

#[test]
fn settings_are_copied_from_another_unit_and_each_keeps_its_address() {
    const MAX: &str = "limits.main_battery.max_volts";
    let mut bench = Bench::with_two_units();
    bench.connect();
    bench.pass_ms(4000);
    let unit = |bench: &mut Bench, address: u8| {
        bench.model().front.link.units.iter().any(|unit| unit.address == address)
    };
    assert!(unit(&mut bench, 0x80) && unit(&mut bench, 0x81));
    bench.press("General Settings");
    bench.pass_ms(3000);
    bench.model().front.settings.unit_mut().expect("it was read").set_number(MAX, 30.0);
    bench.key(Key::F9);
    bench.pass_ms(300);
    bench.press("Write to controller");
    bench.pass_ms(3000);
    let of = |bench: &Bench, place: usize| {
        bench.line.with(|bus| bus.controllers()[place].settings().battery.main_max_tenths)
    };
    assert_eq!(of(&bench, 0), 300);
    let before = of(&bench, 1);
    assert_ne!(before, 300);
    bench.press("0x81  MCP266");
    bench.pass_ms(6000);
    assert_eq!(bench.model().front.link.selected, Some(0x81));
    palette(&mut bench, "copy settings from another");
    bench.pass_ms(1000);
    let sheet = bench.model().front.general.sheet.clone();
    assert_eq!(sheet, Some(Sheet::Compare), "{:?}", bench.said());
    let right = bench.model().front.general.comparing.right.clone();
    assert!(matches!(&right, Side::Unit(name) if name.contains("0x80")), "{right:?}");
    bench.model().front.general_view().take_over(&Take::All);
    bench.pass_ms(300);
    let edits: Vec<String> = {
        let unit = bench.model().front.settings.unit().expect("it was read");
        unit.edits().iter().map(|(key, _)| key.to_owned()).collect()
    };
    assert!(edits.contains(&MAX.to_owned()), "{edits:?}");
    assert!(!edits.iter().any(|key| key.contains("address")), "{edits:?}");
    bench.key(Key::F9);
    bench.pass_ms(300);
    bench.press("Write to controller");
    bench.pass_ms(4000);
    assert_eq!((of(&bench, 0), of(&bench, 1)), (300, 300));
}

/// Everything that can be read in the window.
fn labels(bench: &Bench) -> Vec<String> {
    let nodes = bench.harness.root().children_recursive();
    nodes.filter_map(|node| node.accesskit_node().label().or(node.accesskit_node().value())).collect()
}

#[test]
fn keys_are_shown_as_the_platform_writes_them() {
    let mut bench = Bench::new();
    bench.connect();
    bench.pass_ms(3000);
    palette(&mut bench, "keyboard shortcuts");
    let with_ctrl = |bench: &Bench| labels(bench).iter().filter(|text| text.contains("Ctrl")).count();
    assert!(with_ctrl(&bench) > 30, "{}", with_ctrl(&bench));
    bench.harness.ctx.set_os(OperatingSystem::Mac);
    bench.pass_ms(300);
    assert_eq!(with_ctrl(&bench), 0, "{:?}", labels(&bench));
    bench.key(Key::Escape);
    for screen in bench.model().front.screens() {
        bench.model().turn_to(screen);
        bench.pass_ms(500);
        assert_eq!(with_ctrl(&bench), 0, "{screen:?}");
    }
}

#[test]
fn what_has_a_button_on_its_screen_is_in_the_palette_too() {
    let mut bench = Bench::new();
    bench.connect();
    bench.pass_ms(3000);
    palette(&mut bench, "back up now");
    assert_eq!(bench.store().backups(None).len(), 1, "{:?}", bench.said());
    palette(&mut bench, "read settings");
    bench.press("Read");
    bench.pass_ms(100);
    palette(&mut bench, "cancel what runs");
    bench.pass_ms(2000);
    assert!(bench.said().iter().any(|said| said.contains("cancelled")), "{:?}", bench.said());

    let report = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/reports/tuned.json");
    let report = brushwork_core::tune::file::read(Path::new(report)).expect("a report");
    let which = brushwork_gui::tune::files::loop_of(&report);
    bench.model().front.tune.panel_mut(which, Motor::M1).add(report);
    palette(&mut bench, "apply gains");
    let why = "Device: Apply Gains: Tuning is on the Velocity and Position screens.";
    assert!(bench.said().contains(&why.to_owned()), "{:?}", bench.said());
    bench.press(which.screen().title());
    bench.pass_ms(3000);
    palette(&mut bench, "apply gains");
    bench.pass_ms(3000);
    assert!(bench.model().front.tune.front(which).undo.is_some(), "{:?}", bench.said());
    palette(&mut bench, "undo applied gains");
    bench.pass_ms(3000);
    assert!(bench.model().front.tune.front(which).undo.is_none(), "{:?}", bench.said());
    palette(&mut bench, "verify gains");
    assert!(bench.said().iter().any(|said| said.ends_with("Arm this screen first.")), "{:?}", bench.said());

    bench.press("Disconnect");
    bench.pass_ms(1000);
    palette(&mut bench, "reconnect");
    bench.pass_ms(2000);
    assert!(bench.model().is_connected());
}

#[test]
fn the_buttons_of_a_sheet_stand_below_its_text_and_not_at_the_bottom_of_the_screen() {
    let mut bench = Bench::new();
    bench.connect();
    bench.pass_ms(3000);
    for (act, button, text) in [
        ("read settings", "Read", "Read settings"),
        ("save settings", "Back", "Save to EEPROM"),
        ("open profile", "Open", "Open profile"),
    ] {
        palette(&mut bench, act);
        bench.pass_ms(500);
        let title =
            bench.harness.get_all_by_label(text).map(|node| node.rect()).next_back().expect("its title");
        let button = bench.button(button).rect();
        let between = button.top() - title.bottom();
        println!("{act}: {between:.0} points");
        assert!((0.0..200.0).contains(&between), "{act}: {between}");
        bench.key(Key::Escape);
        bench.pass_ms(300);
    }
}

#[test]
fn work_of_more_than_a_second_says_how_long_the_rest_takes() {
    let mut bench = Bench::new();
    bench.connect();
    bench.pass_ms(4000);
    palette(&mut bench, "setpoint generator");
    bench.arm();
    bench.choose("Shape", "Square wave");
    bench.enter("Profile dwell", "1");
    bench.press("Run profile");
    let mut seen: Vec<String> = Vec::new();
    while bench.model().front.generator.job.is_running() {
        bench.pass_ms(100);
        seen.extend(labels(&bench).into_iter().filter(|text| text.ends_with(" left")));
    }
    let left_s = |text: &String| text.rsplit_once(" · ")?.1.strip_suffix(" s left")?.parse::<f64>().ok();
    let left_s: Vec<f64> = seen.iter().filter_map(left_s).collect();
    println!("{left_s:?} {:?}", seen.last());
    assert!(left_s.len() > 10 && left_s.first() > left_s.last(), "it becomes less: {seen:?}");
}

#[test]
fn escape_closes_the_window_on_top_alone_and_stops_as_well() {
    let mut bench = Bench::new();
    bench.connect();
    bench.pass_ms(3000);
    let sees = |bench: &Bench, title: &str| {
        bench.harness.query_all_by_label(title).any(|node| node.accesskit_node().role() == Role::Window)
    };
    for (act, title) in [
        ("firmware", "Firmware"),
        ("examine this", "Examine this controller"),
        ("give boards", "Give boards their addresses"),
        ("raw settings", "Raw settings, at your own risk"),
        ("connect canopen", "CANopen bus"),
    ] {
        palette(&mut bench, act);
        bench.pass_ms(300);
        assert!(sees(&bench, title), "{act}: {:?}", bench.said());
        // The palette and the help above it are closed before it.
        bench.key_with(Modifiers { shift: true, ..Modifiers::COMMAND }, Key::P);
        bench.pass_ms(300);
        bench.key(Key::Escape);
        bench.pass_ms(300);
        assert!(bench.model().palette.is_none() && sees(&bench, title), "{act}");
        bench.key(Key::F1);
        bench.pass_ms(300);
        assert!(sees(&bench, "Brushwork help"));
        bench.key(Key::Escape);
        bench.pass_ms(300);
        assert!(!sees(&bench, "Brushwork help") && sees(&bench, title), "{act}");
        bench.key(Key::Escape);
        bench.pass_ms(500);
        assert!(!sees(&bench, title), "{act}");
    }
    // It stops whatever it closes.
    bench.arm();
    bench.set_duty(Motor::M1, "20");
    bench.pass_ms(500);
    assert!(bench.real_duty(Motor::M1) > 0.1);
    bench.key(Key::F1);
    bench.pass_ms(200);
    bench.key(Key::Escape);
    bench.pass_ms(1000);
    assert!(bench.both_stand() && !sees(&bench, "Brushwork help"));
}
