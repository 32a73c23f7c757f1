//! The stop keys, taken before any widget sees them.
//!
//! Esc stops from everywhere, whatever has the keyboard, and goes on to whatever it closes. Space stops too, and is taken out of the input
//! altogether, so that it never presses the button that has focus (Enter does that); only a field for words keeps it.

use egui::{Context, Event, Key};

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
