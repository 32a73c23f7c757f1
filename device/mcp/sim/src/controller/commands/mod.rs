//! What each command does, by theme: one small function per command, and a table that names it.
//!
//! Handlers know values by the names of the command table; widths, order and CRCs are not their business.

mod autotune;
mod can;
mod drive;
mod encoders;
mod gains;
mod legacy;
mod limits;
mod pins;
mod report;
mod roboclaw;
mod script;
mod travel;
mod unit;

use super::answer::Handlers;

/// All handlers.
pub(super) const THEMES: [Handlers; 13] = [
    legacy::HANDLERS,
    drive::HANDLERS,
    travel::HANDLERS,
    encoders::HANDLERS,
    report::HANDLERS,
    gains::HANDLERS,
    limits::HANDLERS,
    pins::HANDLERS,
    unit::HANDLERS,
    roboclaw::HANDLERS,
    autotune::HANDLERS,
    can::HANDLERS,
    script::HANDLERS,
];
