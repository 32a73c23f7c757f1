//! What was seen of a program while it was lowered, for what is warned of at the end.

use crate::mecc::ast::Name;
use crate::text::Span;
use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

/// Ticks of a second of the older clock (manual, GetClock(), Wait).
pub const OLD_TICKS_PER_SECOND: u32 = 111;

/// What was seen of a program.
#[derive(Debug, Default)]
pub struct Facts {
    /// Constants of Wait.
    pub waits: Vec<(Span, u32)>,
    /// Constant timers of SetTimer.
    pub timers: Vec<(Span, u32)>,
    /// Constant motors of SetMotor.
    pub motors: Vec<(Span, u32)>,
    /// Steppers that are configured or moved, a bit each, stepper 1 in bit 0.
    pub steppers: u32,
    /// Constants of SetTimer that are seconds of the older clock.
    pub old: Vec<(Span, u32)>,
    /// Constants that are compared, or given to functions: seconds of GetClock perhaps.
    pub compared_with: Vec<(Span, u16)>,
    /// Whether GetClock is read.
    pub uses_clock: bool,
    /// Events with a handler, a bit each, and where the first is set.
    pub handled: u32,
    pub first_handler: Option<Span>,
    /// Whether Enable Events stands anywhere.
    pub lets_events_in: bool,
    /// Whether SetPointer stands anywhere.
    pub has_pointers: bool,
    /// Pointers that frames are sent from or received into.
    pub frames: HashSet<Arc<str>>,
    /// Pointers that were set to a table of less than a frame: pointer, table, its place and length.
    pub short: Vec<(Arc<str>, Name, u32, u32)>,
    /// Whether the function that is lowered gives itself a value.
    pub sets_value: bool,
    /// Forms that are a guess, where they stand first.
    pub assumed: BTreeMap<&'static str, Span>,
}

impl Facts {
    /// Notes a form that is a guess.
    pub fn assume(&mut self, form: &'static str, span: Span) {
        self.assumed.entry(form).or_insert(span);
    }

    /// Notes ticks that are whole seconds of the older clock.
    pub fn old_ticks(&mut self, span: Span, ticks: u32) {
        if is_old(ticks) {
            self.old.push((span, ticks));
        }
    }
}

pub fn is_old(ticks: u32) -> bool {
    ticks > 0 && ticks.is_multiple_of(OLD_TICKS_PER_SECOND)
}
