//! The window: its model, screens, widgets and graph.
//!
//! `model` is plain data, `screens` and `shell` draw it and ask for changes by `command`, and `app` makes them. What differs between families of
//! controllers, shared code asks `family` and `screens::face`; each family has a folder of its own. `mcl` is the editor for scripts, `debugger` runs them step by step, `tune` is guided tuning.
#![cfg_attr(not(test), warn(clippy::wildcard_enum_match_arm))]
#![allow(
    missing_docs,
    reason = "the window is no library: only the program and its own tests see these items"
)]

pub mod actions;
pub mod app;
pub mod command;
pub mod debugger;
pub mod ending;
pub mod families;
pub mod family;
pub mod family_action;
pub mod files;
pub mod focus;
pub mod frame;
pub mod graph;
pub mod help;
pub mod keys;
pub mod language;
pub mod links;
pub mod mcl;
pub mod mcp;
pub mod messages;
pub mod model;
pub mod motion_mind;
pub mod motorvator;
pub mod opener;
pub mod page;
pub mod parts;
pub mod remember;
#[cfg(not(target_family = "wasm"))]
pub mod run;
pub mod screens;
pub mod shell;
pub mod suprmotr;
pub mod theme;
pub mod traffic;
pub mod tune;
pub mod widgets;
pub mod world;

pub use app::App;
pub use families::install;

#[cfg(test)]
#[path = "../tests/gui/support/wait.rs"]
#[allow(dead_code, reason = "shared with the tests of the window")]
mod wait;
