//! The stop keys, taken before any widget sees them.
//!
//! Esc stops from everywhere, whatever has the keyboard, and goes on to whatever it closes. Space stops too, and is taken out of the input
//! altogether, so that it never presses the button that has focus (Enter does that); only a field for words keeps it.

use egui::{Context, Event, InnerResponse, Key, KeyboardShortcut, LayerId, Modifiers, Order};

use super::language::word;
use super::widgets::text_field;

/// What stopped the motors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopKey {
    Space,
    Escape,
}

/// The keys that stop now, in words: where a space is a letter it is not one of them.
pub fn stop_words(ctx: &Context) -> &'static str {
    if text_field::takes_space(ctx) { "Esc" } else { "Space or Esc" }
}

/// The same in the language of the window.
pub fn said_stop_words(ctx: &Context) -> String {
    if text_field::takes_space(ctx) { "Esc".to_owned() } else { word("bar", "Space or Esc") }
}

/// Words with keys in them as this platform writes those: our tables have "Ctrl+T".
pub fn as_written(ctx: &Context, words: &str) -> String {
    let written = ctx.format_shortcut(&KeyboardShortcut::new(Modifiers::COMMAND, Key::A));
    written.strip_suffix('A').map_or_else(|| words.to_owned(), |before| words.replace("Ctrl+", before))
}

/// Whether Esc closes a window: it is on top, with no list, menu or palette unfolded above it.
pub fn escape_closes<R>(ctx: &Context, shown: Option<&InnerResponse<R>>) -> bool {
    let layer = shown.map(|shown| shown.response.layer_id);
    layer.is_some() && ctx.input(|input| input.key_pressed(Key::Escape)) && top_layer(ctx) == layer
}

/// What Esc closes first: the uppermost of the windows, lists, menus and the palette that stand above the screen.
pub fn top_layer(ctx: &Context) -> Option<LayerId> {
    ctx.memory(|memory| {
        let visible = memory.areas().visible_layer_ids();
        let is_above = |layer: &LayerId| matches!(layer.order, Order::Middle | Order::Foreground);
        memory.layer_ids().filter(|layer| is_above(layer) && visible.contains(layer)).last()
    })
}

/// Looks for a stop key and takes Space out of the input. Called before anything is drawn.
pub fn take_stop_key(ctx: &Context) -> Option<StopKey> {
    let typing = text_field::takes_space(ctx);
    ctx.input_mut(|input| {
        let escape = input.key_pressed(Key::Escape);
        let space = !typing && input.key_pressed(Key::Space);
        if !typing {
            input.events.retain(|event| !is_space(event));
        }
        match (space, escape) {
            (true, _) => Some(StopKey::Space),
            (_, true) => Some(StopKey::Escape),
            _ => None,
        }
    })
}

#[allow(clippy::wildcard_enum_match_arm, reason = "the enum is not ours")]
fn is_space(event: &Event) -> bool {
    match event {
        Event::Key { key: Key::Space, .. } => true,
        Event::Text(text) => text == " ",
        _ => false,
    }
}
