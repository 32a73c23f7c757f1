//! The MCL editor by what a person types and presses (MCP manual 1.2.14).

mod support;

use brushwork::gui::mcl::Document;
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use support::bench::Bench;

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
            bench.harness.step();
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
