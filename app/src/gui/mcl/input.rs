//! Keys, typed text, the clipboard and input methods, turned into operations on the program in front.

use egui::{Event, EventFilter, Id, ImeEvent, Key, Modifiers, Ui};

use super::buffer::Kind;
use super::caret::{Caret, Move, moved};
use super::document::{Document, Reveal};

/// The keys that stay with the text instead of moving the focus.
pub const FILTER: EventFilter =
    EventFilter { tab: true, horizontal_arrows: true, vertical_arrows: true, escape: false };

/// What an input method is composing, and where it stands in the text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Composing {
    pub start: usize,
    pub length: usize,
}

/// Does what was typed since the last frame. `page` is how many rows are in view.
pub fn take(ui: &Ui, id: Id, document: &mut Document, page: usize) {
    let owns_ime = ui.memory(|memory| memory.owns_ime_events(id));
    for event in ui.input(|input| input.filtered_events(&FILTER)) {
        match event {
            Event::Text(text) if !text.is_empty() && text != "\n" && text != "\r" => {
                document.type_text(&text);
            }
            Event::Paste(text) if !text.is_empty() => document.paste(&text),
            Event::Copy => ui.ctx().copy_text(document.copied()),
            Event::Cut => ui.ctx().copy_text(document.cut()),
            Event::Ime(event) if owns_ime => compose(document, &event),
            Event::Key { key, pressed: true, modifiers, .. } => press(document, key, modifiers, page),
            _ => {}
        }
    }
}

fn press(document: &mut Document, key: Key, modifiers: Modifiers, page: usize) {
    if let Some(way) = way(key, modifiers, page) {
        return go(document, way, modifiers.shift);
    }
    let erases = |way, words| {
        if modifiers.command || modifiers.alt && cfg!(target_os = "macos") { words } else { way }
    };
    match key {
        Key::Enter if !modifiers.any() || modifiers.shift_only() => document.new_line(),
        Key::Tab if modifiers.shift_only() => document.unindent(),
        Key::Tab if modifiers.is_none() => document.indent(),
        Key::Backspace => document.erase(erases(Move::Left, Move::WordLeft)),
        Key::Delete if !modifiers.shift => document.erase(erases(Move::Right, Move::WordRight)),
        Key::ArrowUp | Key::ArrowDown if modifiers.alt => document.move_lines(key == Key::ArrowDown),
        _ => {}
    }
}

/// Moves the caret; what was typed before is a step of undo.
pub fn go(document: &mut Document, way: Move, extend: bool) {
    let lines = document.text.line_count();
    let folds = &document.folds;
    let caret =
        moved(&document.text, document.caret, way, extend, |line, rows| folds.step(line, rows, lines));
    if caret != document.caret {
        document.text.close_group();
    }
    document.caret = caret;
    document.folds.show(document.text.line_of(caret.head));
    document.view.reveal = Reveal::Nearest;
}

fn way(key: Key, modifiers: Modifiers, page: usize) -> Option<Move> {
    let by_word = if cfg!(target_os = "macos") { modifiers.alt } else { modifiers.command };
    let to_end = cfg!(target_os = "macos") && modifiers.command;
    let plain = !modifiers.alt && !modifiers.command;
    Some(match key {
        Key::ArrowLeft if to_end => Move::LineStart,
        Key::ArrowRight if to_end => Move::LineEnd,
        Key::ArrowLeft if by_word => Move::WordLeft,
        Key::ArrowRight if by_word => Move::WordRight,
        Key::ArrowLeft if plain => Move::Left,
        Key::ArrowRight if plain => Move::Right,
        Key::ArrowUp if to_end => Move::Start,
        Key::ArrowDown if to_end => Move::End,
        Key::ArrowUp if plain => Move::Up,
        Key::ArrowDown if plain => Move::Down,
        Key::PageUp if plain => Move::PageUp(page),
        Key::PageDown if plain => Move::PageDown(page),
        Key::Home if modifiers.command => Move::Start,
        Key::End if modifiers.command => Move::End,
        Key::Home => Move::LineStart,
        Key::End => Move::LineEnd,
        _ => return None,
    })
}

/// What an input method composes stands in the text until it is committed or given up.
fn compose(document: &mut Document, event: &ImeEvent) {
    let (text, is_done) = match event {
        ImeEvent::Preedit { text, .. } => (text, false),
        ImeEvent::Commit(text) => (text, true),
        ImeEvent::DeleteSurrounding { before_chars, after_chars } => {
            return delete_around(document, *before_chars, *after_chars);
        }
        #[expect(deprecated, reason = "other integrations still send them")]
        ImeEvent::Enabled | ImeEvent::Disabled => return,
    };
    if text == "\n" || text == "\r" || text.is_empty() && document.composing.is_none() {
        return;
    }
    let range = match document.composing.take() {
        Some(old) => old.start..old.start + old.length,
        None => document.caret.range(),
    };
    let (start, end) = (range.start, range.start + text.len());
    document.edit(Kind::Typing, [(range, text.clone())], |_| Caret::at(end));
    if !is_done && !text.is_empty() {
        document.composing = Some(Composing { start, length: text.len() });
    }
}

fn delete_around(document: &mut Document, before: usize, after: usize) {
    let text = document.text.snapshot();
    let at = text.byte_to_char(document.caret.head);
    let from = text.char_to_byte(at.saturating_sub(before));
    let to = text.char_to_byte((at + after).min(text.len_chars()));
    document.edit(Kind::Other, [(from..to, String::new())], |_| Caret::at(from));
}
