//! What is warned of once the whole program is known.

use super::facts::{Facts, OLD_TICKS_PER_SECOND, is_old};
use super::scope::Meaning;
use super::{Lowering, pending};
use crate::mecc::ast::{Item, Kind};
use crate::mecc::board::{FRAME_BYTES, TICKS_PER_SECOND};
use crate::mecc::{codes, events};
use crate::text::Span;

/// A wait of so many ticks is long: a second.
const LONG_TICKS: u32 = TICKS_PER_SECOND;

impl Lowering<'_> {
    pub fn warn(&mut self, items: &[Item]) {
        let facts = std::mem::take(&mut self.facts);
        self.warn_of_waits(&facts);
        self.warn_of_wrapped_waits(&facts);
        self.warn_of_old_clocks(&facts);
        self.warn_of_events(&facts);
        self.warn_of_short_tables(&facts);
        self.warn_of_shared_motors(&facts);
        for (form, span) in &facts.assumed {
            let message = format!("{form}: how it is written, or what it does, is assumed.");
            let hint =
                "The maker's pages name it without showing it: another compiler may want another form."
                    .to_owned();
            self.report(codes::ASSUMED_FORM, *span, message, Some(hint));
        }
        for item in items {
            if let Item::Routine(routine) = item {
                for (span, by_loop) in pending::early(&routine.body) {
                    let which = if by_loop { "the one of the turn before" } else { "the one before it" };
                    let message = format!(
                        "{which} may still be under way: a frame takes 29 ms, and this one would be lost."
                    );
                    let hint = "Send again from the handler of TransmitEvent, or wait 5 ticks.".to_owned();
                    let message = message[..1].to_uppercase() + &message[1..];
                    self.report(codes::TRANSMIT_PENDING, span, message, Some(hint));
                }
            }
        }
        // A line that is wrong may be the one that reads it.
        if !self.diagnostics.has_errors() {
            self.warn_of_unused_globals(facts.has_pointers);
        }
    }

    fn warn_of_waits(&mut self, facts: &Facts) {
        if facts.handled == 0 || !facts.lets_events_in {
            return;
        }
        for (span, ticks) in facts.waits.iter().filter(|(_, ticks)| *ticks >= LONG_TICKS) {
            let seconds = f64::from(*ticks) / f64::from(LONG_TICKS);
            let message = format!("Nothing else runs in this wait of {seconds:.2} s, no handler either.");
            let hint = "Set a timer with SetTimer, or wait in a loop over GetClock().".to_owned();
            self.report(codes::LONG_WAIT, *span, message, Some(hint));
        }
    }

    /// A wait that is written as less than 0 is one of minutes, since a Word has no sign.
    fn warn_of_wrapped_waits(&mut self, facts: &Facts) {
        for (span, ticks) in &facts.waits {
            let typed = span.of(self.text);
            if !typed.trim_start().starts_with('-') || *ticks == 0 {
                continue;
            }
            let seconds = f64::from(*ticks) / f64::from(TICKS_PER_SECOND);
            let message = format!(
                "`{}` is {ticks} as a Word: this waits for {seconds:.0} s.",
                crate::diagnostic::excerpt(typed)
            );
            let hint = "A wait is 0 to 65535 ticks of 1/128 s; 128 is a second.".to_owned();
            self.report(codes::DOES_NOT_FIT, *span, message, Some(hint));
        }
    }

    /// Stepper 1 uses motors A and B, stepper 2 motors C and D (manual, ConfigStepper).
    fn warn_of_shared_motors(&mut self, facts: &Facts) {
        for (span, motor) in facts.motors.iter().filter(|(_, motor)| (1..=4).contains(motor)) {
            let stepper = motor.div_ceil(2);
            if facts.steppers & 1 << (stepper - 1) != 0 {
                let message =
                    format!("Motor {motor} is a coil of stepper {stepper}, which this program moves.");
                let hint = Some("Use another motor, or the other stepper.".to_owned());
                self.report(codes::MOTOR_OF_STEPPER, *span, message, hint);
            }
        }
    }

    fn warn_of_old_clocks(&mut self, facts: &Facts) {
        let waits = facts.waits.iter().filter(|(_, ticks)| is_old(*ticks));
        for (span, ticks) in waits.chain(&facts.old) {
            let was = ticks / OLD_TICKS_PER_SECOND;
            let message = format!(
                "{ticks} ticks were {was} s by the older clock of 111 Hz; they are {:.3} s by this one of 128 Hz.",
                f64::from(*ticks) / f64::from(LONG_TICKS)
            );
            self.report(
                codes::OLD_CLOCK,
                *span,
                message,
                Some(format!("Write {} for {was} s.", was * LONG_TICKS)),
            );
        }
        for (span, value) in facts.compared_with.iter().filter(|_| facts.uses_clock) {
            let value = u32::from(*value);
            if is_old(value) {
                let was = value / OLD_TICKS_PER_SECOND;
                let message =
                    format!("{value} was {was} s of GetClock() at 111 Hz; it counts at 1024 Hz now.");
                self.report(
                    codes::OLD_CLOCK,
                    *span,
                    message,
                    Some(format!("Write {} for {was} s.", was * 1024)),
                );
            }
        }
    }

    fn warn_of_events(&mut self, facts: &Facts) {
        if let (Some(span), false) = (facts.first_handler, facts.lets_events_in) {
            let message =
                "No handler ever runs: events are let in by Enable Events, which stands nowhere.".to_owned();
            self.report(
                codes::EVENTS_OFF,
                span,
                message,
                Some("Write Enable Events behind the SetEvents.".to_owned()),
            );
        }
        for (span, timer) in &facts.timers {
            let event = events::TIMER + timer.wrapping_sub(1);
            if (1..=events::TIMERS).contains(timer) && facts.handled & 1 << event == 0 {
                let message = format!("Timer {timer} runs nothing: UserTimer{timer}Event has no handler.");
                let hint = Some(format!("Write SetEvent UserTimer{timer}Event, handler"));
                self.report(codes::NO_HANDLER, *span, message, hint);
            }
        }
    }

    fn warn_of_short_tables(&mut self, facts: &Facts) {
        let mut layout: Vec<(u32, u32, Span)> = self
            .globals
            .values()
            .filter_map(|symbol| match symbol.meaning {
                Meaning::Variable(kind, at) => Some((at, kind.bytes(), symbol.declared)),
                Meaning::Table(at, length) => Some((at, length, symbol.declared)),
                Meaning::Function(_) | Meaning::Handler(_) => None,
            })
            .collect();
        layout.retain(|(_, length, _)| *length > 0);
        layout.sort_unstable();
        for (_, table, at, length) in
            facts.short.iter().filter(|(pointer, ..)| facts.frames.contains(pointer))
        {
            let from = layout.partition_point(|(begin, ..)| *begin < at + length);
            let follow: Vec<String> = layout[from..]
                .iter()
                .take_while(|(begin, ..)| *begin < at + FRAME_BYTES)
                .take(FRAME_BYTES as usize)
                .map(|(_, _, name)| format!("`{}`", crate::diagnostic::excerpt(name.of(self.text))))
                .collect();
            let behind = match &follow[..] {
                [] => "nothing is declared".to_owned(),
                [one] => format!("there is {one}"),
                more => format!("there are {}", more.join(", ")),
            };
            let name = table.span.of(self.text);
            let message = format!(
                "`{}` has {}, and a frame has {FRAME_BYTES}: behind it {behind}.",
                crate::diagnostic::excerpt(name),
                if *length == 1 { "1 byte".to_owned() } else { format!("{length} bytes") }
            );
            let hint = format!(
                "Where that is not meant, give the table {} bytes more with Reserve.",
                FRAME_BYTES - length
            );
            self.report(codes::SHORT_BUFFER, table.span, message, Some(hint));
        }
    }

    /// What nobody reads is warned of, unless a pointer may read it.
    fn warn_of_unused_globals(&mut self, has_pointers: bool) {
        let mut unused: Vec<(Span, Meaning)> = self
            .globals
            .values()
            .filter(|symbol| !symbol.is_used)
            .map(|symbol| (symbol.declared, symbol.meaning.clone()))
            .collect();
        unused.sort_by_key(|(declared, _)| declared.start);
        for (declared, meaning) in unused {
            let name = crate::diagnostic::excerpt(declared.of(self.text)).into_owned();
            let (code, message) = match meaning {
                Meaning::Variable(Kind::Byte | Kind::Word, _) | Meaning::Table(..) if has_pointers => {
                    continue;
                }
                Meaning::Function(_) => (codes::UNUSED_ROUTINE, format!("Nothing calls `{name}`.")),
                Meaning::Handler(_) => (codes::UNUSED_ROUTINE, format!("No event runs `{name}`.")),
                Meaning::Variable(..) | Meaning::Table(..) => {
                    (codes::UNUSED_VARIABLE, format!("Nothing reads `{name}`."))
                }
            };
            self.report(code, declared, message, Some("Take it out, or use it.".to_owned()));
        }
    }

    pub fn warn_of_unused_locals(&mut self) {
        let mut unused: Vec<Span> =
            self.locals.values().filter(|symbol| !symbol.is_used).map(|symbol| symbol.declared).collect();
        unused.sort_unstable();
        for declared in unused {
            let name = crate::diagnostic::excerpt(declared.of(self.text)).into_owned();
            let hint = Some("Take it out, or use it.".to_owned());
            self.report(codes::UNUSED_VARIABLE, declared, format!("Nothing reads `{name}`."), hint);
        }
    }
}
