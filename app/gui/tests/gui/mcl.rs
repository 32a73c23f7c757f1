//! The MCL editor by what a person types and presses (MCP manual 1.2.14).

use crate::support::bench::Bench;
use brushwork_gui::mcl::Document;
use brushwork_link::device::ArmScope;
use brushwork_link::files::replace_file;
use brushwork_plant::world::ScriptRun;
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

const SHIFT: Modifiers = Modifiers::SHIFT;
const CTRL: Modifiers = Modifiers::COMMAND;

/// A window on the editor.
fn editor() -> Bench {
    let mut bench = Bench::new();
    bench.press("MCL Editor");
    bench.pass_ms(200);
    bench
}

fn front(bench: &mut Bench) -> &mut Document {
    bench.model().mcl.front_mut()
}

fn text(bench: &mut Bench) -> String {
    front(bench).text.text()
}

/// Types as a keyboard does: letters, and Enter for line ends.
fn type_in(bench: &mut Bench, text: &str) {
    for piece in text.split_inclusive('\n') {
        let letters = piece.trim_end_matches('\n');
        if !letters.is_empty() {
            bench.harness.event(Event::Text(letters.to_owned()));
            bench.pass_ms(200);
        }
        if piece.ends_with('\n') {
            bench.key(Key::Enter);
        }
    }
}

#[test]
fn the_editor_has_the_keyboard_at_once_and_takes_what_is_typed() {
    let mut bench = editor();
    type_in(&mut bench, "x var byte\nwhile 1\nx = x + 1\n");
    type_in(&mut bench, "wend");
    assert_eq!(text(&mut bench), "x var byte\nwhile 1\n    x = x + 1\nwend");
    let field = bench.harness.get_by_role_and_label(Role::MultilineTextInput, "Program Untitled 1");
    assert_eq!(field.accesskit_node().value().as_deref(), Some("wend"));
    assert!(bench.sees_part("Line 4, column 5"));
}

#[test]
fn space_is_a_letter_while_the_text_has_the_keyboard() {
    let mut bench = editor();
    type_in(&mut bench, "a b");
    assert_eq!(text(&mut bench), "a b");
}

#[test]
fn keys_select_and_what_is_typed_takes_the_place_of_it() {
    let mut bench = editor();
    type_in(&mut bench, "one two");
    bench.key_with(CTRL | SHIFT, Key::ArrowLeft);
    type_in(&mut bench, "2");
    assert_eq!(text(&mut bench), "one 2");
    bench.key_with(SHIFT, Key::Home);
    bench.harness.event(Event::Cut);
    bench.harness.step();
    assert_eq!(text(&mut bench), "");
    bench.harness.event(Event::Paste("a\r\nb".to_owned()));
    bench.harness.step();
    assert_eq!(text(&mut bench), "a\nb");
}

#[test]
fn a_text_from_the_clipboard_that_is_too_long_is_refused_and_said() {
    let mut bench = editor();
    let paste = |bench: &mut Bench, text: &str| {
        bench.harness.event(Event::Paste(text.to_owned()));
        bench.pass_ms(100);
    };
    let program = "x=1\n".repeat(5_000);
    paste(&mut bench, &program);
    assert!(text(&mut bench) == program && !bench.sees_part("Nothing was pasted"));
    paste(&mut bench, &"x=1\n".repeat(300_000));
    assert!(text(&mut bench) == program && bench.sees_part("Nothing was pasted"));
    bench.model().messages.dismiss();
    bench.key_with(CTRL, Key::F);
    bench.pass_ms(100);
    paste(&mut bench, "x");
    paste(&mut bench, &program);
    assert_eq!(bench.model().mcl.find.query.text, "x");
    assert!(bench.sees_part("20000 bytes of text, and this place takes at most 16384"));
}

fn open_file(bench: &mut Bench, name: &str, bytes: &[u8]) -> std::path::PathBuf {
    let path = bench.store().root().expect("a test has a folder").join(name);
    std::fs::write(&path, bytes).expect("the folder can be written");
    bench.model().mcl.open_path(path.clone());
    let wanted = path.clone();
    bench.until_in_time("opened", move |bench| front(bench).path.as_ref() == Some(&wanted));
    path
}

#[test]
fn errors_are_listed_while_typing_and_a_row_leads_to_its_place() {
    let mut bench = editor();
    type_in(&mut bench, "pause 10\ngoto nowhere\nend\n");
    bench.until_in_time("checked", |bench| bench.sees_part("in line 2"));
    let errors = front(&mut bench).findings.counts().0;
    assert_eq!(errors, 1);
    let row = bench.harness.get_by_label_contains("in line 2");
    row.click();
    bench.pass_ms(200);
    assert_eq!(front(&mut bench).caret_line(), 1);
    assert_eq!(front(&mut bench).copied(), "nowhere");
    type_in(&mut bench, "main");
    bench.until_in_time("checked again", |bench| bench.sees_part("main"));
}

#[test]
fn f7_says_how_many_errors_there_are_and_goes_to_the_first() {
    let mut bench = editor();
    type_in(&mut bench, "pause 10\ngoto nowhere\n");
    bench.key(Key::F7);
    assert!(bench.sees_part("has 1 error"), "{:?}", bench.model().messages.past().collect::<Vec<_>>());
    assert_eq!(front(&mut bench).caret_line(), 1);
}

#[test]
fn words_are_completed_by_keys_and_the_syntax_line_goes_along() {
    let mut bench = editor();
    type_in(&mut bench, "pa");
    assert!(bench.sees("Word pause"), "the list is open");
    bench.key(Key::Tab);
    assert_eq!(text(&mut bench), "pause");
    type_in(&mut bench, " ");
    assert!(bench.sees("Syntax: pause time"));
    type_in(&mut bench, "10\nMOTORENC");
    assert!(bench.sees("Word MOTORENCPOS") && bench.sees("Word MOTORENCSPEED"));
    bench.key(Key::ArrowDown);
    bench.key(Key::Enter);
    assert_eq!(text(&mut bench), "pause 10\nMOTORENCSPEED");
    assert!(!bench.sees_part("Word "), "the list is closed");
}

#[test]
fn names_of_the_program_are_offered_once_they_were_checked() {
    let mut bench = editor();
    type_in(&mut bench, "total_counts VAR Long\n");
    bench.until_in_time("checked", |bench| {
        let known = front(bench).findings.checked.clone();
        known.is_some_and(|known| !known.index.symbols.is_empty())
    });
    type_in(&mut bench, "tot");
    assert!(bench.sees("Word total_counts"));
    bench.key(Key::Escape);
    assert!(!bench.sees("Word total_counts"));
    type_in(&mut bench, "al");
    assert!(text(&mut bench).ends_with("total"), "the text has kept the keyboard");
}

#[test]
fn a_word_under_the_pointer_is_explained_with_its_unit() {
    let mut bench = editor();
    type_in(&mut bench, "x VAR Word\nx = SYSMBAT\n");
    bench.until_in_time("the last letter is checked", |bench| {
        let document = front(bench);
        document.findings.checked.as_ref().is_some_and(|known| known.revision == document.text.revision())
    });
    let at = front(&mut bench).text.text().find("SYSMBAT").unwrap_or_default();
    let hover = front(&mut bench).hover(at + 2).expect("a register is explained");
    let help = hover.help.expect("a register is explained");
    assert_eq!(help.title, "SYSMBAT");
    assert!(help.facts.iter().any(|fact| fact.contains("0.1 V")), "{help:?}");
    let own = front(&mut bench).hover(0).and_then(|hover| hover.help).expect("a name is explained");
    assert!(own.text.contains("Variable"), "{own:?}");
}

#[test]
fn find_counts_goes_round_and_replaces_all_in_one_step() {
    let mut bench = editor();
    type_in(&mut bench, "goto a\ngoto b\ngoto c\n");
    bench.key_with(CTRL, Key::H);
    bench.pass_ms(100);
    type_in(&mut bench, "goto");
    bench.pass_ms(100);
    assert!(bench.sees("3 found"));
    bench.key(Key::Enter);
    assert!(bench.sees("1 of 3"));
    bench.harness.get_by_role_and_label(Role::TextInput, "Replace with").focus();
    bench.pass_ms(100);
    type_in(&mut bench, "gosub");
    bench.press("Replace all matches");
    assert_eq!(text(&mut bench), "gosub a\ngosub b\ngosub c\n");
    assert!(bench.sees_part("Replaced 3 places"));
    bench.press("Close the find bar");
    bench.key_with(CTRL, Key::Z);
    assert_eq!(text(&mut bench), "goto a\ngoto b\ngoto c\n");
}

#[test]
fn a_line_is_gone_to_and_a_name_changed_by_the_keyboard_alone() {
    let mut bench = editor();
    type_in(&mut bench, "val VAR Long\nval = 1\nend\n");
    bench.key_with(CTRL, Key::G);
    bench.pass_ms(200);
    type_in(&mut bench, "2\n");
    bench.pass_ms(200);
    assert_eq!(front(&mut bench).caret_line(), 1);
    bench.key_with(CTRL | SHIFT, Key::R);
    bench.pass_ms(200);
    bench.key_with(CTRL, Key::A);
    type_in(&mut bench, "sum\n");
    bench.pass_ms(200);
    assert_eq!(text(&mut bench), "sum VAR Long\nsum = 1\nend\n");
}

#[test]
fn unsaved_text_is_asked_for_before_its_tab_goes_and_before_the_window_goes() {
    let mut bench = editor();
    type_in(&mut bench, "end");
    bench.key_with(CTRL, Key::W);
    bench.pass_ms(200);
    assert!(bench.sees_part("There is unsaved text in Untitled 1"));
    bench.press("Cancel");
    assert_eq!(text(&mut bench), "end");
    bench.key_with(CTRL, Key::Q);
    bench.pass_ms(200);
    assert!(bench.sees_part("There is unsaved text in Untitled 1"));
    bench.press("Close without saving");
    bench.pass_ms(200);
    assert_eq!(text(&mut bench), "");
}

#[test]
fn several_programs_are_saved_one_after_the_other_before_the_window_goes() {
    let mut bench = editor();
    type_in(&mut bench, "one");
    bench.key_with(CTRL, Key::N);
    bench.pass_ms(200);
    type_in(&mut bench, "two");
    bench.key_with(CTRL, Key::Q);
    bench.pass_ms(200);
    bench.press("Save and close");
    let folder = bench.store().root().expect("a test has a folder").to_owned();
    for (name, held) in [("first.mcl", "one"), ("second.mcl", "two")] {
        bench.until_in_time("asked for a path", |bench| {
            bench.harness.query_by_role_and_label(Role::TextInput, "Path").is_some()
        });
        bench.harness.get_by_role_and_label(Role::TextInput, "Path").focus();
        bench.pass_ms(100);
        bench.key_with(CTRL, Key::A);
        let path = folder.join(name);
        type_in(&mut bench, &format!("{}\n", path.display()));
        bench.until_in_time("saved", move |_| std::fs::read_to_string(&path).is_ok_and(|text| text == held));
    }
    bench.until_in_time("may go", |bench| bench.model().mcl.may_exit());
}

#[test]
fn encodings_and_line_ends_of_a_file_are_kept() {
    let mut bench = editor();
    let path = open_file(&mut bench, "old.mcl", b"; \xFCber\r\nend\r\n");
    assert_eq!(text(&mut bench), "; \u{FC}ber\nend\n");
    bench.key_with(CTRL, Key::End);
    type_in(&mut bench, "; \u{E4}\n");
    assert!(front(&mut bench).text.is_modified());
    bench.key_with(CTRL, Key::S);
    bench.until_in_time("saved", |bench| !front(bench).text.is_modified());
    assert_eq!(std::fs::read(&path).expect("it is there"), b"; \xFCber\r\nend\r\n; \xE4\r\n");
    type_in(&mut bench, "; \u{20AC}");
    bench.key_with(CTRL, Key::S);
    bench.pass_ms(300);
    assert!(bench.sees_part("which Latin-1 does not have"));
    assert!(front(&mut bench).text.is_modified());
}

#[test]
fn a_file_that_another_program_writes_is_noticed() {
    let mut bench = editor();
    let path = open_file(&mut bench, "shared.mcl", b"one\n");
    replace_file(&path, b"longer\n").expect("it can be written");
    bench.until_in_time("loaded again", |bench| text(bench) == "longer\n");
    bench.key_with(CTRL, Key::End);
    type_in(&mut bench, "mine");
    replace_file(&path, b"much longer\n").expect("it can be written");
    bench.until_in_time("noticed", |bench| bench.sees_part("was changed by another program, and"));
    assert_eq!(text(&mut bench), "longer\nmine", "what is not saved stays");
    bench.press("Keep this text");
    bench.key_with(CTRL, Key::S);
    let written = path.clone();
    bench.until_in_time("saved", move |_| {
        std::fs::read_to_string(&written).is_ok_and(|held| held == "longer\nmine")
    });
}

#[test]
fn unsaved_text_outlives_a_crash_and_is_offered_back() {
    let mut bench = editor();
    type_in(&mut bench, "precious");
    let folder = bench.store().root().expect("a test has a folder").to_owned();
    let kept = folder.join("unsaved-mcl");
    bench.until_in_time("kept", move |_| {
        let folders = std::fs::read_dir(&kept).into_iter().flatten().flatten();
        folders.flat_map(|folder| std::fs::read_dir(folder.path()).into_iter().flatten().flatten()).count()
            == 2
    });
    // The window goes without a word, as in a crash; another comes.
    let mut restored = bench.after_a_crash();
    let bench = &mut restored;
    bench.press("MCL Editor");
    bench.until_in_time("offered", |bench| {
        bench.sees_part("Unsaved text from an earlier time was found: Untitled 1")
    });
    bench.press("Restore");
    assert_eq!(text(bench), "precious");
    assert!(front(bench).text.is_modified());
    assert!(!bench.sees("Restore"));
}

#[test]
fn starting_a_script_needs_the_screen_armed() {
    let mut bench = editor();
    bench.connect();
    bench.press("MCL Editor");
    let start = bench.harness.get_by_label("Toolbar Start Script");
    assert!(start.accesskit_node().is_disabled());
    bench.press("Arm");
    bench.pass_ms(500);
    let start = bench.harness.get_by_label("Toolbar Start Script");
    assert!(!start.accesskit_node().is_disabled());
    bench.press("Device Status");
    assert_eq!(bench.model().front.link.arming, brushwork_gui::model::link::Arming::Disarmed);
}

#[test]
fn the_screen_reader_has_the_lines_in_view() {
    let mut bench = editor();
    type_in(&mut bench, "one\ntwo\n");
    bench.pass_ms(200);
    let field = bench.harness.get_by_role_and_label(Role::MultilineTextInput, "Program Untitled 1");
    let lines: Vec<String> = field
        .children()
        .filter_map(|run| run.accesskit_node().value())
        .map(|line| line.trim().to_owned())
        .collect();
    assert!(lines.contains(&"one".to_owned()) && lines.contains(&"two".to_owned()), "{lines:?}");
    assert_eq!(field.accesskit_node().description().as_deref(), Some("Line 3 of 3"));
}

#[test]
fn every_example_runs_on_the_simulated_controller() {
    let examples: Vec<_> =
        brushwork_gui::actions::all().filter(|action| action.id.starts_with("file.example")).collect();
    assert_eq!(examples.len(), brushwork_gui::mcl::examples::EXAMPLES.len());
    let mut bench = editor();
    bench.connect();
    // Those in the other language run on another board, past the wire.
    for example in examples.into_iter().filter(|action| !action.title.ends_with("(MeccCode)")) {
        bench.press("File");
        bench.press(example.title);
        bench.press("Toolbar Download MCL");
        bench.pass_ms(2500);
        let held = bench.model().front.script.on_board.as_ref().map(|source| source.title.clone());
        let opened = front(&mut bench).title();
        assert_eq!(held.as_ref(), Some(&opened), "{:?}", bench.model().messages.past().collect::<Vec<_>>());
        if !bench.model().front.link.arming.is_armed_for(ArmScope::Script) {
            bench.press("Arm");
            bench.pass_ms(500);
        }
        bench.press("Toolbar Start Script");
        let mut moved = false;
        for _ in 0..30 {
            bench.pass_ms(100);
            moved |= !bench.both_stand();
        }
        let run = bench.truth().script.expect("the unit has power").run;
        let went = matches!(run, ScriptRun::Running { .. } | ScriptRun::Ended { .. });
        assert!(went, "{opened}: {run:?}");
        let drives = ["ramp.mcl", "there-and-back.mcl", "melody.mcl"].contains(&opened.as_str());
        assert_eq!(moved, drives, "{opened}");
        bench.press("Toolbar Stop Script");
        bench.pass_ms(1000);
    }
}

#[test]
fn a_download_of_a_program_with_errors_shows_them_and_sends_nothing() {
    let mut bench = editor();
    bench.connect();
    bench.press("MCL Editor");
    bench.pass_ms(200);
    type_in(&mut bench, "goto nowhere\n");
    bench.key(Key::F5);
    bench.pass_ms(1500);
    assert!(bench.sees_part("has 1 error"));
    assert!(bench.model().front.script.on_board.is_none() && !bench.model().front.script.job.is_running());
}

#[test]
fn leaving_the_screen_or_stop_ends_a_script_that_was_started() {
    let mut bench = editor();
    bench.connect();
    for how in ["leave", "escape", "stop"] {
        bench.press("MCL Editor");
        bench.pass_ms(200);
        let forever = "main\n    power 0, 10000, 0\n    pause 10\ngoto main\n";
        bench.model().mcl.open_named("forever.mcl", forever);
        bench.pass_ms(200);
        bench.press("Toolbar Download MCL");
        bench.pass_ms(2500);
        bench.press("Arm");
        bench.pass_ms(500);
        bench.press("Toolbar Start Script");
        bench.pass_ms(1000);
        assert!(!bench.both_stand(), "{how}");
        match how {
            "leave" => bench.press("Device Status"),
            "escape" => bench.key(Key::Escape),
            _ => bench.press("Toolbar Stop Script"),
        }
        bench.pass_ms(1000);
        let run = bench.truth().script.expect("the unit has power").run;
        assert!(!run.is_running(), "{how}: {run:?}");
        if how != "stop" {
            assert!(bench.both_stand(), "{how}");
        }
    }
}

#[cfg(unix)]
#[test]
fn a_program_goes_to_the_printer_and_without_a_print_command_the_sheet_says_so() {
    use brushwork_gui::mcl::printer::Spooler;
    use std::os::unix::fs::PermissionsExt as _;

    let folder = tempfile::tempdir().unwrap();
    let (lp, seen) = (folder.path().join("lp"), folder.path().join("seen"));
    std::fs::write(&lp, format!("#!/bin/sh\ncat >{}\n", seen.display())).unwrap();
    std::fs::set_permissions(&lp, std::fs::Permissions::from_mode(0o755)).unwrap();
    let mut bench = editor();
    bench.model().mcl.spooler = Spooler::find_in(folder.path().as_os_str());
    type_in(&mut bench, "end");
    bench.key_with(CTRL, Key::P);
    bench.pass_ms(200);
    bench.press("Send to the printer");
    bench.until_in_time("the printer has it", |bench| bench.sees_part("Untitled 1 is with the printer"));
    assert!(std::fs::read(&seen).unwrap().starts_with(b"%PDF-"));
    bench.model().mcl.spooler = None;
    bench.key_with(CTRL, Key::P);
    bench.pass_ms(200);
    assert!(bench.sees_part("This system has no print command (lp or lpr)"));
    assert!(!bench.sees("Send to the printer") && bench.sees("Print to the file"));
}
