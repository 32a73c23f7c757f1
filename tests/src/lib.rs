//! What the end-to-end tests share: the workspace as a test sees it, the built program, foreign clients.
//!
//! The tests themselves are in `tests/tests`. Nothing here knows the window or the protocol; a test that needs
//! a controller brings one up through `brushwork-mcp-sim`.

pub mod foreign;
#[cfg(target_os = "linux")]
pub mod hands;
pub mod imports;
pub mod other_controller;
pub mod rust_source;
pub mod said;
pub mod screen;
#[cfg(unix)]
pub mod served;
pub mod simulated;
pub mod truth;
pub mod virtual_line;
pub mod virtual_link;
pub mod wait;
pub mod workspace;

pub use brushwork_child as program;
