//! The graph against a simulated controller, in virtual time, by what a person reads, presses, drags and types.

use std::path::{Path, PathBuf};

use crate::support::bench::Bench;
use brushwork_gui::graph::runs::Align;
use brushwork_gui::graph::trigger::{TriggerMode, TriggerSource};
use brushwork_gui::graph::{LiveGraph, MarkKind};
use brushwork_plant::world::WorldAction;
use brushwork_values::Motor;
use egui::{Key, Modifiers, MouseWheelUnit, Pos2, TouchPhase, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

/// The column of motor 1's PWM.
const PWM: usize = 1;

/// A window that is connected and shows the PWM screen, after two seconds of samples.
fn bench() -> Bench {
    let mut bench = Bench::sized([1280.0, 1000.0], egui::Theme::Dark);
    bench.connect();
    bench.press("PWM Settings");
    bench.pass_ms(2000);
    bench
}

fn graph(bench: &mut Bench) -> &mut LiveGraph {
    &mut bench.model().front.graph
}

/// The plot's place on the screen.
fn plot(bench: &Bench) -> egui::Rect {
    bench.harness.get_by(|node| node.label().is_some_and(|label| is_plot(&label))).rect()
}

fn is_plot(label: &str) -> bool {
    ["Live graph of the last", "Graph, paused", "Graph of "].iter().any(|start| label.starts_with(start))
}

fn drag(bench: &mut Bench, from: Pos2, to: Pos2) {
    bench.harness.hover_at(from);
    bench.harness.step();
    bench.harness.drag_at(from);
    bench.harness.step();
    for step in 1..=4u8 {
        bench.harness.hover_at(from + (to - from) * (f32::from(step) / 4.0));
        bench.harness.step();
    }
    bench.harness.drop_at(to);
    bench.harness.step();
}

fn wheel(bench: &mut Bench, at: Pos2, turns: f32) {
    bench.harness.hover_at(at);
    bench.harness.step();
    let delta = vec2(0.0, turns);
    let event = egui::Event::MouseWheel {
        unit: MouseWheelUnit::Line,
        delta,
        modifiers: Modifiers::NONE,
        phase: TouchPhase::Move,
        source: egui::MouseWheelSource::Wheel,
    };
    bench.harness.event(event);
    bench.pass_ms(500);
}

/// Puts the keyboard focus on the plot.
fn select_plot(bench: &mut Bench) {
    bench.harness.get_by(|node| node.label().is_some_and(|label| is_plot(&label))).focus();
    bench.pass_ms(100);
}

#[test]
fn the_picture_is_paused_scrolled_and_zoomed_while_sampling_goes_on_and_led_back_to_live() {
    let mut bench = bench();
    let middle = plot(&bench).center();
    drag(&mut bench, middle, middle + vec2(120.0, 0.0));
    assert!(graph(&mut bench).live.is_held(), "dragging holds the picture");
    assert!(bench.sees_part("Graph, paused, of 10 s"));
    let (held, rows) = (graph(&mut bench).live.window(), graph(&mut bench).live.track.history.rows().end);
    assert!(held.1 < graph(&mut bench).live.newest_s() - 0.5, "earlier samples came into view");
    bench.pass_ms(2000);
    assert_eq!(graph(&mut bench).live.window(), held);
    assert!(graph(&mut bench).live.track.history.rows().end >= rows + 18, "sampling went on");
    let about = graph(&mut bench).live.window();
    wheel(&mut bench, middle, 2.0);
    let zoomed = graph(&mut bench).live.window();
    assert!(zoomed.0 > about.0 && zoomed.1 < about.1, "{about:?} became {zoomed:?}");
    bench.press("Back to live");
    assert!(bench.sees_part("Live graph of the last"));
    let live = &graph(&mut bench).live;
    assert_eq!(live.window().1, live.newest_s());
}

#[test]
fn with_the_keyboard_alone_the_picture_is_paused_scrolled_zoomed_and_led_back() {
    let mut bench = bench();
    select_plot(&mut bench);
    bench.key(Key::P);
    assert!(graph(&mut bench).live.is_held());
    let before = graph(&mut bench).live.window();
    bench.key(Key::ArrowLeft);
    let after = graph(&mut bench).live.window();
    assert!((before.0 - after.0 - 1.0).abs() < 1e-6, "a tenth of ten seconds: {before:?} {after:?}");
    bench.key(Key::Minus);
    assert_eq!(graph(&mut bench).live.span_s(), 20.0);
    bench.key(Key::Plus);
    bench.key(Key::Plus);
    assert_eq!(graph(&mut bench).live.span_s(), 5.0);
    let zero = graph(&mut bench).live.channels[PWM].scale;
    graph(&mut bench).live.selected = PWM;
    bench.key(Key::ArrowUp);
    assert!(graph(&mut bench).live.channels[PWM].scale.low < zero.low, "the zero moved up");
    bench.key(Key::End);
    assert!(!graph(&mut bench).live.is_held());
    assert!(bench.both_stand());
    bench.key(Key::Space);
    assert!(
        bench.see("Disconnect").accesskit_node().role() == egui::accesskit::Role::Button,
        "Space pressed nothing"
    );
}

#[test]
fn the_cursors_read_values_and_statistics_as_text_and_are_moved_by_mouse_and_keys() {
    let mut bench = bench();
    bench.pass_ms(9000);
    bench.press("Cursors");
    bench.press("Pause");
    for part in [
        "M1 PWM Mean: 0.00 %",
        "M1 PWM Std dev: 0.00 %",
        "M1 Current Slope /s:",
        "M1 Velocity B − A: 0 counts/s",
    ] {
        assert!(bench.sees_part(part), "{part}");
    }
    let place = plot(&bench);
    let frame = brushwork_gui::graph::picture::frame::Frame::new(place, graph(&mut bench).live.window());
    let at = egui::pos2(frame.x(graph(&mut bench).live.cursor_s(1)), frame.plot.center().y);
    let before_s = graph(&mut bench).live.cursor_s(1);
    drag(&mut bench, at, at - vec2(100.0, 0.0));
    let moved_s = before_s - graph(&mut bench).live.cursor_s(1);
    let wanted_s = 10.0 * 100.0 / f64::from(frame.plot.width());
    assert!((moved_s - wanted_s).abs() < 0.1, "{moved_s} of {wanted_s}");
    select_plot(&mut bench);
    let before_s = graph(&mut bench).live.cursor_s(1);
    bench.key(Key::ArrowRight);
    assert!((graph(&mut bench).live.cursor_s(1) - before_s - 0.05).abs() < 1e-9);
    bench.key(Key::X);
    let before_s = graph(&mut bench).live.cursor_s(0);
    bench.harness.key_press_modifiers(Modifiers::SHIFT, Key::ArrowLeft);
    bench.pass_ms(100);
    assert!((before_s - graph(&mut bench).live.cursor_s(0) - 0.5).abs() < 1e-9);
}

#[test]
fn the_figures_between_the_cursors_are_those_of_the_samples() {
    let mut bench = bench();
    bench.arm();
    bench.set_duty(Motor::M1, "50");
    bench.pass_ms(4000);
    bench.press("Cursors");
    bench.press("Pause");
    let sheet = &graph(&mut bench).live;
    let (a_s, b_s) = (sheet.cursor_s(0), sheet.cursor_s(1));
    let history = &sheet.track.history;
    let between: Vec<f64> = history
        .rows()
        .filter_map(|row| history.reading(PWM, row))
        .filter(|(at_s, _)| (a_s..=b_s).contains(at_s))
        .map(|(_, value)| value)
        .collect();
    let mean = between.iter().sum::<f64>() / between.len() as f64;
    let max = between.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let measure = sheet.measure(PWM);
    assert_eq!((measure.count, measure.max), (between.len() as u64, Some(max)));
    assert!(max > 40.0, "the duty rose to {max}");
    let text = format!("M1 PWM Mean: {mean:.2} %");
    assert!(bench.sees(&text), "{text}");
}

#[test]
fn commands_stops_and_arming_leave_marks() {
    let mut bench = bench();
    bench.arm();
    bench.set_duty(Motor::M1, "40");
    bench.pass_ms(1000);
    bench.key(Key::Escape);
    bench.pass_ms(500);
    let marks: Vec<(MarkKind, String)> =
        graph(&mut bench).live.track.marks.iter().map(|mark| (mark.kind, mark.text.clone())).collect();
    assert!(marks.contains(&(MarkKind::Arm, "Armed for the PWM screen".to_owned())), "{marks:?}");
    assert!(marks.contains(&(MarkKind::Drive, "M1 duty 40.0 %".to_owned())), "{marks:?}");
    assert!(marks.contains(&(MarkKind::Stop, "Stop".to_owned())), "{marks:?}");
    assert!(bench.sees_part("Last mark: "), "the plot says it in words");
}

#[test]
fn a_single_trigger_on_a_command_takes_the_step_and_keeps_it() {
    let mut bench = bench();
    bench.arm();
    bench.press("Trigger: Off");
    bench.press("Single");
    bench.press("A drive command");
    assert!(bench.sees_part("Waiting for the trigger"));
    bench.key(Key::Escape);
    bench.pass_ms(300);
    bench.arm();
    bench.set_duty(Motor::M1, "60");
    bench.pass_ms(1000);
    let sheet = &graph(&mut bench).live;
    assert_eq!(
        (sheet.trigger.mode(), sheet.trigger.settings().source),
        (TriggerMode::Single, TriggerSource::Command)
    );
    let shot_s = sheet.shot_s().expect("it was triggered");
    let mark = sheet.track.marks.iter().rev().find(|mark| mark.kind == MarkKind::Drive).unwrap().at_s;
    assert!((shot_s - mark).abs() < 1.0, "{shot_s} {mark}");
    let window = sheet.window();
    assert!((shot_s - window.0 - 2.0).abs() < 1e-6, "a fifth of ten seconds lies before");
    bench.pass_ms(15_000);
    assert_eq!(graph(&mut bench).live.window(), window);
    assert!(bench.sees_part("Graph of 10 s at the trigger"));
    assert!(bench.sees_part("single shot taken"));
}

#[test]
fn a_level_is_passed_at_the_level() {
    let mut bench = bench();
    graph(&mut bench).live.selected = PWM;
    bench.press("Trigger: Off");
    bench.press("Normal");
    bench.enter("Trigger level", "25");
    bench.key(Key::Escape);
    bench.arm();
    bench.model().front.pwm.accel_percent_per_s = 20.0;
    bench.set_duty(Motor::M1, "50");
    bench.pass_ms(3500);
    let sheet = &graph(&mut bench).live;
    let shot_s = sheet.shot_s().expect("it was triggered");
    let (before, after) =
        (sheet.track.history.value_at(PWM, shot_s - 0.11), sheet.track.history.value_at(PWM, shot_s + 0.11));
    assert!(before.unwrap() < 25.0 && after.unwrap() >= 25.0, "{before:?} {after:?}");
}

#[test]
fn a_zero_mark_is_dragged_and_the_scale_stays_as_it_was_set() {
    let mut bench = bench();
    let place = plot(&bench);
    let frame = brushwork_gui::graph::picture::frame::Frame::new(place, graph(&mut bench).live.window());
    let shown = graph(&mut bench).live.shown();
    let top = *shown.last().unwrap();
    let mark = brushwork_gui::graph::picture::draw::zero_mark(&frame, &graph(&mut bench).live, top);
    let before = graph(&mut bench).live.channels[top].scale;
    let from = mark[0] + vec2(5.0, 5.0);
    drag(&mut bench, from, from + vec2(0.0, frame.plot.height() / 4.0));
    let after = graph(&mut bench).live.channels[top].scale;
    assert!((after.part(0.0) - (before.part(0.0) - 0.25)).abs() < 0.03, "{before:?} became {after:?}");
    assert!(!graph(&mut bench).live.channels[top].grows);
}

#[test]
fn dragging_the_second_button_zooms_into_a_box_and_the_axis_zooms_time() {
    let mut bench = bench();
    bench.pass_ms(9000);
    let place = plot(&bench);
    let frame = brushwork_gui::graph::picture::frame::Frame::new(place, graph(&mut bench).live.window());
    let (start_s, end_s) = graph(&mut bench).live.window();
    let before = graph(&mut bench).live.channels[PWM].scale;
    let (from, to) = (frame.plot.min + frame.plot.size() * 0.25, frame.plot.min + frame.plot.size() * 0.75);
    bench.harness.hover_at(from);
    bench.harness.step();
    let second = |pos: Pos2, pressed: bool| {
        let (button, modifiers) = (egui::PointerButton::Secondary, Modifiers::NONE);
        egui::Event::PointerButton { pos, button, pressed, modifiers }
    };
    bench.harness.event(second(from, true));
    bench.harness.step();
    // The box begins where the first few pixels have told a drag from a click.
    for part in 0..=20u8 {
        bench
            .harness
            .hover_at(from + vec2(8.0, 8.0) + (to - from - vec2(8.0, 8.0)) * (f32::from(part) / 20.0));
        bench.harness.step();
    }
    bench.harness.event(second(to, false));
    bench.pass_ms(200);
    let live = &graph(&mut bench).live;
    assert!(live.is_held(), "a box of time stands");
    let now = live.window();
    let part = (now.1 - now.0) / (end_s - start_s);
    assert!((part - 0.5).abs() < 0.04, "half of {start_s} to {end_s} became {now:?}");
    let after = live.channels[PWM].scale;
    let height = (after.high - after.low) / (before.high - before.low);
    assert!((height - 0.5).abs() < 0.06, "{before:?} became {after:?}");
    bench.press("Back to live");
    let span_s = graph(&mut bench).live.span_s();
    let axis = egui::pos2(frame.plot.center().x, frame.plot.bottom() + 8.0);
    drag(&mut bench, axis, axis + vec2(30.0, 0.0));
    assert!(graph(&mut bench).live.span_s() < span_s * 0.9, "the time axis zooms");
    assert!(!graph(&mut bench).live.is_held(), "and the picture goes on following");
}

#[test]
fn where_the_list_is_folded_away_a_legend_in_the_plot_shows_and_hides_the_channels() {
    let mut bench = bench();
    let wide = plot(&bench).width();
    graph(&mut bench).act(brushwork_gui::graph::GraphAction::ToggleList);
    bench.pass_ms(300);
    assert!(plot(&bench).width() > wide + 200.0, "the plot has the room of the list");
    assert!(!bench.sees("Show M1 PWM"));
    bench.press("M1 PWM");
    bench.pass_ms(200);
    assert!(!graph(&mut bench).live.channels[PWM].shown);
    bench.press("M1 PWM");
    bench.pass_ms(200);
    assert!(graph(&mut bench).live.channels[PWM].shown, "its row stays in the legend");
    graph(&mut bench).act(brushwork_gui::graph::GraphAction::ToggleList);
    bench.pass_ms(200);
    assert!(bench.sees("Show M1 PWM"));
}

#[test]
fn lost_and_late_samples_are_counted_beside_the_rate_that_was_reached() {
    let mut bench = bench();
    assert!(bench.sees_part("10.0 samples/s, 10 asked"), "the rate is told");
    let late = graph(&mut bench).rate.late;
    bench.act(&WorldAction::Power { on: false });
    bench.pass_ms(600);
    bench.act(&WorldAction::Power { on: true });
    bench.pass_ms(1500);
    let now = graph(&mut bench).rate.late;
    assert!(now > late, "a unit without power answers late");
    assert!(bench.sees_part(&format!("{now} late")));
}

fn in_folder(bench: &mut Bench) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder for the test");
    graph(bench).files.folder = folder.path().display().to_string();
    folder
}

/// The files in a folder once there are as many, finished by threads of the real world.
fn files_in(bench: &mut Bench, folder: &Path, count: usize) -> Vec<PathBuf> {
    let mut found = Vec::new();
    bench.until(&format!("{count} files in {}", folder.display()), |_| {
        found = whole_files(folder);
        found.len() >= count
    });
    found
}

/// What is hidden is not finished yet.
fn whole_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("the folder is there");
    let paths = entries.map(|entry| entry.expect("an entry of the folder").path());
    let is_whole =
        |path: &PathBuf| !path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
    let mut found: Vec<PathBuf> = paths.filter(is_whole).collect();
    found.sort();
    found
}

/// Waits until a sentence is said that has these words in it.
fn hear(bench: &mut Bench, words: &str) {
    bench.until(words, |bench| bench.said().iter().any(|text| text.contains(words)));
}

#[test]
fn what_is_recorded_is_opened_again_as_it_was_sampled_and_live_goes_on_elsewhere() {
    let mut bench = bench();
    let folder = in_folder(&mut bench);
    let first_row = graph(&mut bench).live.track.history.rows().end;
    bench.press("Record to CSV");
    assert!(bench.sees_part("Recording brushwork-"));
    bench.arm();
    bench.set_duty(Motor::M1, "30");
    bench.pass_ms(2000);
    bench.press("Stop recording");
    hear(&mut bench, "Recorded ");
    let files = files_in(&mut bench, folder.path(), 1);
    let sampled: Vec<f64> = {
        let history = &graph(&mut bench).live.track.history;
        (first_row..history.rows().end)
            .filter_map(|row| history.reading(PWM, row))
            .map(|(_, value)| value)
            .collect()
    };
    graph(&mut bench).files.open(&files[0]);
    bench.until("the recording is opened", |bench| graph(bench).opened.is_some());
    assert!(bench.sees_part("Graph of the recording brushwork-"));
    let opened = &graph(&mut bench).opened.as_ref().expect("it was opened").sheet.track;
    let recorded: Vec<f64> = opened
        .history
        .rows()
        .filter_map(|row| opened.history.reading(PWM, row))
        .map(|(_, value)| value)
        .collect();
    assert!(recorded.len() >= 18, "{}", recorded.len());
    assert!(sampled.windows(recorded.len()).any(|window| window == recorded), "the very values");
    assert!(opened.marks.iter().any(|mark| mark.text == "M1 duty 30.0 %"));
    let rows = graph(&mut bench).live.track.history.rows().end;
    bench.pass_ms(1000);
    assert!(graph(&mut bench).live.track.history.rows().end > rows, "live goes on");
    bench.press("Back to live");
    assert!(bench.sees_part("Live graph of the last"));
}

#[test]
fn a_cable_that_is_pulled_out_ends_the_recording_with_a_sentence_and_a_whole_file() {
    let mut bench = bench();
    let folder = in_folder(&mut bench);
    graph(&mut bench).act(brushwork_gui::graph::GraphAction::RecordCompact);
    bench.pass_ms(2000);
    bench.act(&WorldAction::Unplug { unplugged: true });
    bench.pass_ms(3000);
    hear(&mut bench, "The recording ended with the link. Recorded ");
    let files = files_in(&mut bench, folder.path(), 1);
    let mut samples = 0;
    let damage = brushwork_core::recording::open::read(
        &files[0],
        |_| (),
        |record| {
            samples += usize::from(matches!(record, brushwork_core::recording::Record::Sample(_)));
            true
        },
    );
    assert_eq!(damage.unwrap(), None);
    assert!(samples >= 18, "{samples}");
}

#[test]
fn a_foreign_file_is_refused_with_the_line_that_is_wrong() {
    let mut bench = bench();
    let folder = in_folder(&mut bench);
    let path = folder.path().join("other.csv");
    std::fs::write(&path, "time_s,speed (rpm)\n0.1,5\n0.2,fast\n").unwrap();
    graph(&mut bench).files.open(&path);
    hear(&mut bench, "other.csv: line 3: in the column speed (rpm)");
    assert!(graph(&mut bench).opened.is_none());
}

#[test]
fn what_is_in_view_is_exported_as_csv_png_and_svg() {
    use brushwork_gui::graph::GraphAction as A;
    let mut bench = bench();
    let folder = in_folder(&mut bench);
    for action in [A::ExportCsv, A::ExportPng, A::ExportSvg] {
        graph(&mut bench).act(action);
    }
    let files = files_in(&mut bench, folder.path(), 3);
    let of = |extension: &str| files.iter().find(|path| path.extension().unwrap() == extension).unwrap();
    let lines = std::fs::read_to_string(of("csv")).unwrap();
    assert!(lines.starts_with(
        "utc,time_s,requested_s,replied_s,mark,note,M1 PWM (%),M1 Velocity (counts/s),M1 Current (A),"
    ));
    assert!(lines.lines().count() >= 19, "{}", lines.lines().count());
    let picture = image::open(of("png")).unwrap();
    assert!(picture.width() >= 1800 && picture.height() > 840, "{}x{}", picture.width(), picture.height());
    let svg = std::fs::read_to_string(of("svg")).unwrap();
    assert!(svg.contains("2 M1 PWM") && svg.contains("<polyline"), "the legend and lines");
}

#[test]
fn exports_that_are_asked_for_at_once_get_in_nobodys_way() {
    use brushwork_gui::graph::GraphAction as A;
    let mut bench = bench();
    let folder = in_folder(&mut bench);
    for action in [A::ExportSvg, A::ExportCsv, A::ExportCsv, A::ExportSvg, A::ExportCsv, A::ExportSvg] {
        graph(&mut bench).act(action);
    }
    let files = files_in(&mut bench, folder.path(), 6);
    assert!(files.iter().all(|path| std::fs::metadata(path).unwrap().len() > 100), "none is empty");
    bench.until("all are told", |bench| {
        bench.said().iter().filter(|text| text.starts_with("Wrote ")).count() == 6
    });
    assert_eq!(whole_files(folder.path()).len(), 6);
}

#[test]
fn an_earlier_run_lies_beneath_the_present_one_aligned_by_its_command() {
    let mut bench = bench();
    bench.arm();
    bench.set_duty(Motor::M1, "50");
    bench.pass_ms(3000);
    bench.press("More");
    bench.press("Keep what is in view");
    assert_eq!(graph(&mut bench).runs.len(), 1);
    bench.press("Command");
    assert_eq!(graph(&mut bench).align, Align::Command);
    bench.key(Key::Escape);
    bench.pass_ms(12_000);
    bench.arm();
    bench.set_duty(Motor::M1, "20");
    bench.pass_ms(2000);
    let graph = graph(&mut bench);
    let drive = |track: &brushwork_gui::graph::Track| {
        let mut drives = track.marks.iter().filter(|mark| mark.kind == MarkKind::Drive).map(|mark| mark.at_s);
        (drives.next().unwrap(), drives.next_back())
    };
    let run = &graph.runs[0];
    let offset_s = run.offset_s(&graph.live, graph.align);
    let live_s = drive(&graph.live.track).1.unwrap();
    assert!((drive(&run.track).0 + offset_s - live_s).abs() < 1e-9, "both commands at the same place");
}

#[test]
fn the_large_graph_takes_the_screen_and_leaves_the_arm_switch() {
    let mut bench = bench();
    let before = plot(&bench).height();
    bench.press("Large graph");
    bench.pass_ms(200);
    assert!(plot(&bench).height() > before + 60.0);
    assert!(bench.sees("Arm"), "the arm switch is there");
}

/// Records two seconds in which motor 1 is told a duty after a while, with a mark at that moment; the file.
fn record_step(bench: &mut Bench, folder: &Path, (wait_ms, duty): (u64, &str), count: usize) -> PathBuf {
    let before = whole_files(folder);
    bench.press("Record to CSV");
    bench.pass_ms(wait_ms);
    bench.arm();
    graph(bench).act(brushwork_gui::graph::GraphAction::AddNote);
    bench.set_duty(Motor::M1, duty);
    bench.pass_ms(1500);
    bench.press("Stop recording");
    let after = files_in(bench, folder, count);
    bench.press("Stop All");
    bench.pass_ms(1500);
    after.into_iter().find(|path| !before.contains(path)).expect("a new file")
}

#[test]
fn several_recordings_lie_over_each_other_by_start_or_mark_and_are_shifted_by_hand() {
    let mut bench = bench();
    let folder = in_folder(&mut bench);
    let steps = [(500, "30"), (900, "50"), (1300, "20")];
    let files: Vec<PathBuf> = steps
        .into_iter()
        .enumerate()
        .map(|(made, step)| record_step(&mut bench, folder.path(), step, made + 1))
        .collect();
    let names: Vec<String> =
        files.iter().map(|path| path.file_name().expect("it has one").display().to_string()).collect();
    let paths: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    crate::files::drop_on(&mut bench, &paths);
    bench
        .until("all of them are read", |bench| graph(bench).opened.is_some() && graph(bench).runs.len() == 2);
    assert!(bench.sees_part(&format!("Graph of the recording {}", names[0])));
    assert!(bench.sees_part(&format!(". Earlier runs: {}, {}", names[1], names[2])));
    assert!(bench.sees(&format!("1 {}: M1 PWM", names[1])), "each line is named by its recording");
    assert!(bench.sees(&format!("2 {}: M1 PWM", names[2])));

    // Where the first sample and where the note of each stands in the picture.
    let places = |bench: &mut Bench| {
        let graph = graph(bench);
        let sheet = graph.sheet();
        let note = |track: &brushwork_gui::graph::Track| {
            track.marks.iter().find(|mark| mark.kind == MarkKind::Note).expect("each has one").at_s
        };
        let began = |track: &brushwork_gui::graph::Track| track.began_s.expect("it has samples");
        let mut all = vec![(began(&sheet.track), note(&sheet.track))];
        all.extend(graph.runs.iter().map(|run| {
            let offset_s = run.offset_s(sheet, graph.align);
            (began(&run.track) + offset_s, note(&run.track) + offset_s)
        }));
        all
    };
    let by_start = places(&mut bench);
    assert!(by_start.iter().all(|(began_s, _)| (began_s - by_start[0].0).abs() < 1e-9), "{by_start:?}");
    assert!(by_start[1].1 - by_start[0].1 > 0.2 && by_start[2].1 - by_start[1].1 > 0.2, "{by_start:?}");
    // Looking elsewhere does not part them.
    graph(&mut bench).sheet_mut().pan(0.4);
    assert_eq!(places(&mut bench), by_start);
    graph(&mut bench).sheet_mut().look_at_all();

    bench.press("More");
    bench.press("Mark");
    assert_eq!(graph(&mut bench).align, Align::Mark);
    bench.key(Key::Escape);
    let by_mark = places(&mut bench);
    assert!(by_mark.iter().all(|(_, note_s)| (note_s - by_mark[0].1).abs() < 1e-9), "{by_mark:?}");

    // The handle of the second run stands above that of the first; a tenth of the width is a tenth of the time.
    let plot_of = |bench: &mut Bench| {
        let window = graph(bench).sheet().window();
        brushwork_gui::graph::picture::frame::Frame::new(plot(bench), window)
    };
    let frame = plot_of(&mut bench);
    let handle = {
        let graph = graph(&mut bench);
        let run = (1, &graph.runs[1]);
        brushwork_gui::graph::picture::draw::run_handle(&frame, graph.sheet(), run, graph.align)
    };
    let by = vec2(frame.plot.width() * 0.1, 0.0);
    drag(&mut bench, handle.center(), handle.center() + by);
    let shifts: Vec<f64> = graph(&mut bench).runs.iter().map(|run| run.shift_s).collect();
    let tenth_s = (frame.end_s - frame.start_s) * 0.1;
    assert!(shifts[0] == 0.0 && (shifts[1] / tenth_s - 1.0).abs() < 0.1, "{shifts:?} of {tenth_s}");
    assert_eq!(plot_of(&mut bench), frame, "the picture itself has not moved");
    bench.press("More");
    bench.enter("Shift of run 1", "0.25");
    bench.pass_ms(200);
    let shifted = places(&mut bench);
    assert!((shifted[1].1 - by_mark[1].1 - 0.25).abs() < 1e-9, "typed: {shifted:?}");
}

#[test]
fn the_last_hour_is_kept_with_its_events_after_a_disconnect_saved_and_opened_again() {
    let ends: [fn(&mut Bench); 2] =
        [|bench| bench.act(&WorldAction::Unplug { unplugged: true }), |bench| bench.press("Disconnect")];
    for end in ends {
        let mut bench = bench();
        let folder = in_folder(&mut bench);
        bench.arm();
        bench.set_duty(Motor::M1, "30");
        bench.pass_ms(2000);
        graph(&mut bench).act(brushwork_gui::graph::GraphAction::AddNote);
        bench.press("Stop All");
        bench.pass_ms(1000);
        end(&mut bench);
        bench.pass_ms(4000);
        assert!(!bench.model().is_connected());
        assert!(graph(&mut bench).live.track.history.rows().end > 30, "nothing is thrown away");
        bench.key_with(Modifiers::COMMAND, Key::Num3);
        bench.pass_ms(300);
        bench.press("More");
        bench.press("Save the whole history");
        let files = files_in(&mut bench, folder.path(), 1);
        graph(&mut bench).files.open(&files[0]);
        bench.until("the history is opened", |bench| graph(bench).opened.is_some());
        let graph = graph(&mut bench);
        let opened = &graph.opened.as_ref().expect("it was opened").sheet.track;
        let all = |track: &brushwork_gui::graph::Track, key: &str| {
            let channel = track.channel_of_key(key).expect("the channel is there");
            let rows = track.history.rows();
            rows.filter_map(|row| track.history.reading(channel, row))
                .map(|(_, value)| value)
                .collect::<Vec<_>>()
        };
        // Channels that were not shown are kept too.
        for key in ["m1_pwm", "m2_current", "main_battery"] {
            assert_eq!(all(opened, key), all(&graph.live.track, key), "{key}");
        }
        let marks = |track: &brushwork_gui::graph::Track| {
            track.marks.iter().map(|mark| (mark.kind, mark.text.clone())).collect::<Vec<_>>()
        };
        assert_eq!(marks(opened), marks(&graph.live.track));
        let kinds: Vec<MarkKind> = marks(opened).into_iter().map(|(kind, _)| kind).collect();
        assert!(
            [MarkKind::Drive, MarkKind::Stop, MarkKind::Arm, MarkKind::Note]
                .iter()
                .all(|kind| kinds.contains(kind)),
            "{kinds:?}"
        );
    }
}
