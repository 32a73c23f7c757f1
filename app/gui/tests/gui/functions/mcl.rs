//! What is done with the functions of the MCL editor (MCP manual 1.2.6 to 1.2.8 and 1.2.14).

use std::path::PathBuf;

use brushwork_gui::mcl::Document;
use brushwork_gui::mcl::panel::Tab;
use brushwork_link::device::ArmScope;
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, OutputCommand, ViewportCommand, ViewportId};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::Row;
use crate::support::bench::Bench;

const PROGRAM: &str = "main\n    puts 0, [\"hi\", 13, 10]\n    pause 10\ngoto main\n";
const WRONG: &str = "goto nowhere\n";

/// Brings the editor to the front with a program in it, as the rows want it.
pub fn prepare(bench: &mut Bench, scene: &str) {
    if !scene.starts_with("mcl_") {
        return;
    }
    bench.press("MCL Editor");
    bench.pass_ms(200);
    let text = if scene == "mcl_check" { WRONG } else { PROGRAM };
    let editor = &mut bench.model().mcl;
    editor.open_new("");
    editor.wants_focus = true;
    bench.pass_ms(200);
    bench.harness.event(Event::Paste(text.to_owned()));
    bench.pass_ms(200);
    assert_eq!(front(bench).text.text(), text);
    match scene {
        "mcl_redo" => front(bench).undo(),
        "mcl_next_bookmark" | "mcl_previous_bookmark" => {
            front(bench).bookmarks.set([1, 3]);
        }
        "mcl_cut" | "mcl_copy" => front(bench).caret = brushwork_gui::mcl::caret::Caret::selecting(0, 4),
        "mcl_start" => {
            download(bench);
            arm(bench);
        }
        "mcl_stop" => {
            download(bench);
            arm(bench);
            bench.press("Toolbar Start Script");
            bench.pass_ms(500);
            assert!(runs(bench));
        }
        _ => {}
    }
}

fn front(bench: &mut Bench) -> &mut Document {
    bench.model().mcl.front_mut()
}

/// Presses what the row names and looks what came of it.
pub fn play(bench: &mut Bench, row: &Row, scene: &str) {
    let text = front(bench).text.text();
    let programs = bench.model().mcl.documents().len();
    bench.button(row.label).click();
    bench.harness.step();
    let (copied, asked_for_paste) = outcome(bench);
    bench.pass_ms(200);
    match scene {
        "mcl_new" => assert_eq!(bench.model().mcl.documents().len(), programs + 1),
        "mcl_open" => opened(bench),
        "mcl_save" | "mcl_save_as" => saved(bench, &text),
        "mcl_print" => printed(bench),
        "mcl_cut" => {
            assert_eq!(copied.as_deref(), Some("main"));
            assert_eq!(front(bench).text.text(), text[4..]);
        }
        "mcl_copy" => assert_eq!(copied.as_deref(), Some("main")),
        "mcl_paste" => {
            assert!(asked_for_paste, "the window system is asked for the clipboard");
            bench.harness.event(Event::Paste("; pasted".to_owned()));
            bench.pass_ms(200);
            assert_eq!(front(bench).text.text(), format!("{text}; pasted"));
        }
        "mcl_undo" => assert_eq!(front(bench).text.text(), ""),
        "mcl_redo" => assert_eq!(front(bench).text.text(), PROGRAM),
        "mcl_hidden" => assert!(bench.model().mcl.options.hidden),
        "mcl_line" => assert!(!bench.model().mcl.options.current_line),
        "mcl_folding" => assert!(!bench.model().mcl.options.folding),
        "mcl_bookmark" => {
            assert!(front(bench).bookmarks.contains(4));
            bench.press(row.label);
            assert!(front(bench).bookmarks.is_empty(), "pressed again it is removed");
        }
        "mcl_next_bookmark" => assert_eq!(front(bench).caret_line(), 1, "round at the end"),
        "mcl_previous_bookmark" => assert_eq!(front(bench).caret_line(), 3),
        "mcl_check" => {
            assert!(bench.sees_part("Error E"), "the list of problems names the error");
            assert_eq!(bench.model().mcl.panel.tab, Tab::Problems);
        }
        "mcl_zoom" => assert_eq!(bench.model().mcl.options.zoom_percent, 110),
        "mcl_find" => found(bench),
        "mcl_terminal" => assert_eq!(bench.model().mcl.panel.tab, Tab::Terminal),
        "mcl_download" => {
            bench.pass_ms(3000);
            assert!(
                bench.model().front.script.on_board.is_some(),
                "{:?}",
                bench.model().messages.past().collect::<Vec<_>>()
            );
        }
        "mcl_start" => {
            bench.pass_ms(500);
            assert!(runs(bench));
        }
        "mcl_stop" => {
            bench.pass_ms(500);
            assert!(!runs(bench));
        }
        other => panic!("{other}: {row:?}"),
    }
    if bench.model().is_connected() {
        bench.key(Key::Escape);
    }
    bench.model().mcl.documents_mut().iter_mut().for_each(|document| document.text.set_saved());
    bench.model().mcl.dismiss_sheet();
    bench.model().mcl.panel.tab = Tab::Problems;
}

fn download(bench: &mut Bench) {
    bench.press("Toolbar Download MCL");
    bench.pass_ms(3000);
}

fn arm(bench: &mut Bench) {
    if !bench.model().front.link.arming.is_armed_for(ArmScope::Script) {
        bench.press("Arm");
        bench.pass_ms(500);
    }
}

/// Whether the simulated controller really runs a script.
fn runs(bench: &Bench) -> bool {
    bench.truth().script.is_some_and(|script| script.run.is_running())
}

/// What the last frame handed to the window system: a copied text, and whether the clipboard is wanted.
fn outcome(bench: &Bench) -> (Option<String>, bool) {
    let output = bench.harness.output();
    let copied = output.platform_output.commands.iter().find_map(|command| match command {
        OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    let viewport = output.viewport_output.get(&ViewportId::ROOT);
    let pastes = viewport.is_some_and(|viewport| viewport.commands.contains(&ViewportCommand::RequestPaste));
    (copied, pastes)
}

/// A file of this name in the folder of the window under test.
fn path(bench: &Bench, name: &str) -> PathBuf {
    bench.store().root().expect("a test has a folder").join(name)
}

/// Answers the question for a path.
fn give_path(bench: &mut Bench, path: &std::path::Path) {
    let field = bench.harness.get_by_role_and_label(Role::TextInput, "Path");
    field.focus();
    bench.pass_ms(100);
    bench.key_with(Modifiers::COMMAND, Key::A);
    bench.harness.event(Event::Text(path.display().to_string()));
    bench.pass_ms(100);
    bench.key(Key::Enter);
    bench.until_in_time(&path.display().to_string(), |bench| {
        let is_printed = path.extension().is_some_and(|is| is == "pdf") && path.exists();
        bench.model().mcl.front().path.as_deref() == Some(path) || is_printed
    });
    // What came in at the end of a frame is drawn in the next one.
    bench.pass_ms(100);
}

fn opened(bench: &mut Bench) {
    let path = path(bench, "opened.mcl");
    std::fs::write(&path, "end\r\n").expect("the folder can be written");
    give_path(bench, &path);
    assert_eq!(front(bench).text.text(), "end\n");
    assert!(bench.sees("Tab opened.mcl"));
}

fn saved(bench: &mut Bench, text: &str) {
    let path = path(bench, "saved.mcl");
    let _ = std::fs::remove_file(&path);
    give_path(bench, &path);
    let held = std::fs::read_to_string(&path).expect("the file was written").replace("\r\n", "\n");
    assert_eq!(held, text);
    assert!(!front(bench).text.is_modified());
}

fn printed(bench: &mut Bench) {
    let path = path(bench, "printed.pdf");
    give_path(bench, &path);
    assert!(std::fs::read(&path).expect("the file was written").starts_with(b"%PDF"));
}

fn found(bench: &mut Bench) {
    let field = bench.harness.get_by_role_and_label(Role::TextInput, "Find");
    assert!(field.accesskit_node().is_focused());
    bench.harness.event(Event::Text("main".to_owned()));
    bench.pass_ms(100);
    bench.key(Key::Enter);
    assert!(bench.sees_part("of 2"), "two places");
    assert_eq!(front(bench).caret.range().len(), 4);
}
