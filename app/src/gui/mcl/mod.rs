//! The MCL editor (MCP manual 1.2.14): programs in tabs, checked as they are typed, downloaded, started and stopped.
//!
//! `buffer` to `disk` know nothing of egui and are plain operations on text; `view` draws a document, `screen` puts everything together.

mod access;
mod act;
pub mod buffer;
pub mod caret;
pub mod document;
pub mod editor;
pub mod fold;
mod gutter;
mod input;
pub mod marks;
mod paint;
pub mod panel;
mod screen;
mod strip;
mod tabs;
mod toolbar;
mod typing;
mod view;
pub mod wish;

pub use document::{DocId, Document};
pub use editor::Editor;
pub use screen::screen_ui;
pub use wish::MclWish;
