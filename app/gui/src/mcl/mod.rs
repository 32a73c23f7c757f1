//! The MCL editor (MCP manual 1.2.14): programs in tabs, checked as they are typed, downloaded, started and stopped.
//!
//! The text and what is done to it (`buffer`, `caret`, `moves`, `typing`, `find`, `fold`, `marks`, `disk`, `journal`) know nothing of egui;
//! `view` draws a program, `screen` puts everything together, `services` speaks to the threads that check, read and write.

mod access;
mod act;
pub mod action;
mod ask;
pub mod buffer;
pub mod caret;
pub mod check;
pub mod complete;
mod composing;
pub mod disk;
pub mod doc_id;
pub mod document;
pub mod editor;
pub mod examples;
pub mod files;
pub mod find;
mod findbar;
pub mod fold;
mod gutter;
mod input;
pub mod journal;
pub mod language;
mod list;
pub mod marks;
pub mod messages;
pub mod moves;
mod notices;
mod paint;
pub mod panel;
mod popup;
pub mod print;
pub mod printer;
pub mod problems;
mod runbar;
mod saving;
mod screen;
mod services;
pub mod sheet;
mod squiggle;
mod strip;
mod tabs;
mod threads;
mod toolbar;
mod typeface;
mod typing;
mod view;

pub use action::MclAction;
pub use doc_id::DocId;
pub use document::Document;
pub use editor::Editor;
pub use screen::screen_ui;
pub use view::has_keyboard;

pub use buffer::{Buffer, Edit, Kind};
pub use caret::Caret;
pub use complete::Completion;
pub use paint::Metrics;
pub use panel::Tab;
pub use sheet::Sheet;

#[cfg(test)]
mod tests;
