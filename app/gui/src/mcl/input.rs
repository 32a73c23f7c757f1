//! Keys, typed text, the clipboard and input methods, turned into operations on the program in front.

use egui::{Event, EventFilter, Id, ImeEvent, Key, Modifiers, Ui};

use super::composing::Composing;
use super::document::Reveal;
use super::moves::{Move, moved};
use super::{Caret, Completion, Document, Kind};

/// The keys that stay with the text instead of moving the focus. Esc leaves the text, unless it has a list of words to close.
pub const fn filter(list_is_open: bool) -> EventFilter {
    EventFilter { tab: true, horizontal_arrows: true, vertical_arrows: true, escape: list_is_open }
}

/// Does what was typed since the last frame. `page` is how many rows are in view. The list of words goes along with what is typed.
#[allow(clippy::wildcard_enum_match_arm, reason = "the enum is not ours")]
pub fn take(ui: &Ui, id: Id, document: &mut Document, list: &mut Option<Completion>, page: usize) {
    let owns_ime = ui.memory(|memory| memory.owns_ime_events(id));
    for event in ui.input(|input| input.filtered_events(&filter(true))) {
        let before = (document.text.revision(), document.caret);
        let typed = matches!(&event, Event::Text(_) | Event::Ime(_));
        match event {
            // Ctrl+Space comes as a key and as a letter.
            Event::Text(text) if text == " " && ui.input(|input| input.modifiers.command) => {}
            Event::Text(text) if !text.is_empty() && text != "\n" && text != "\r" => {
                document.type_text(&text);
            }
            Event::Paste(text) if !text.is_empty() => document.paste(&text),
            Event::Copy => ui.ctx().copy_text(document.copied()),
            Event::Cut => ui.ctx().copy_text(document.cut()),
            Event::Ime(event) if owns_ime => compose(document, &event),
            Event::Key { key, pressed: true, modifiers, .. } => {
                if in_list(document, list, key, modifiers) {
                    continue;
                }
                press(document, key, modifiers, page);
            }
            _ => {}
        }
        follow(document, list, before, typed);
    }
}

/// The list opens and narrows while a word is typed, narrows while one is erased, and closes when the caret goes elsewhere.
fn follow(document: &Document, list: &mut Option<Completion>, before: (u64, Caret), typed: bool) {
    let edited = document.text.revision() != before.0;
    if edited && (typed || list.is_some()) && document.composing.is_none() {
        *list = Completion::of(document, false);
    } else if document.caret != before.1 || edited {
        *list = None;
    }
}

/// Keys that belong to the list of words while it is open. True if the key was one.
#[allow(clippy::wildcard_enum_match_arm, reason = "the enum is not ours")]
fn in_list(document: &mut Document, list: &mut Option<Completion>, key: Key, modifiers: Modifiers) -> bool {
    if key == Key::Space && modifiers.command {
        *list = Completion::of(document, true);
        return true;
    }
    let Some(open) = list.as_mut().filter(|_| !modifiers.any()) else { return false };
    match key {
        Key::ArrowDown => open.step(1),
        Key::ArrowUp => open.step(-1),
        Key::PageDown => open.step(8),
        Key::PageUp => open.step(-8),
        Key::Escape => *list = None,
        Key::Enter | Key::Tab => {
            if let Some(list) = list.take() {
                let chosen = list.chosen;
                list.accept(document, chosen);
            }
        }
        _ => return false,
    }
    true
}

#[allow(clippy::wildcard_enum_match_arm, reason = "the enum is not ours")]
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
        Key::Z if modifiers.command && modifiers.shift => document.redo(),
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

#[allow(clippy::wildcard_enum_match_arm, reason = "the enum is not ours")]
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
