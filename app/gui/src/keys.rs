//! The stop keys, taken before any widget sees them.
//!
//! Space and Esc stop from every screen. Space is taken out of the input altogether, so that it never presses the
//! button that has focus (Enter does that); only a field for words keeps it. Esc also goes on to whatever it closes.

use egui::{Context, Event, Key};

use super::widgets::text_field;

/// What stopped the motors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StopKey {
    Space,
    Escape,
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
