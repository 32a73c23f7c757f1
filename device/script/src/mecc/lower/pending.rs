//! Where a Transmit may come while the one before it is under way.

use crate::mecc::ast::{ExprKind, Statement, StatementKind};
use crate::text::Span;

/// Ticks of a Wait in which a frame of 27 digits and a carriage return, 29.2 ms at 9600 baud, is out wherever between two ticks it began.
const FRAME_TICKS: u16 = 5;

/// What has been sent and not waited for.
#[derive(Default)]
struct Scan {
    /// Where the statements stand that may come too early, and whether it is by a loop.
    early: Vec<(Span, bool)>,
    /// Whether statements of a loop are looked at a second time.
    again: bool,
}

/// The Transmit statements of a routine that may come too early: another one before them, or the same in the turn before of their loop, with
/// nothing between them that takes time. A loop with a condition, and a function, are taken to wait.
pub fn early(body: &[Statement]) -> Vec<(Span, bool)> {
    let mut scan = Scan::default();
    scan.block(body, false);
    scan.early
}

impl Scan {
    fn block(&mut self, statements: &[Statement], mut pending: bool) -> bool {
        for statement in statements {
            pending = self.statement(statement, pending);
        }
        pending
    }

    /// A loop whose turns follow one another.
    fn turns(&mut self, body: &[Statement], pending: bool) -> bool {
        let after = self.block(body, pending);
        // Of loops within loops the second turn of the outermost is enough, so that the time does not double with the depth.
        if !after || self.again {
            return after;
        }
        self.again = true;
        let after = self.block(body, after);
        self.again = false;
        after
    }

    fn statement(&mut self, statement: &Statement, pending: bool) -> bool {
        match &statement.kind {
            StatementKind::Transmit(_) => {
                let is_known = self.early.iter().rev().any(|(span, _)| *span == statement.span);
                if pending && !is_known && self.early.len() < crate::diagnostic::MOST_TOLD {
                    self.early.push((statement.span, self.again));
                }
                true
            }
            StatementKind::Wait(ticks) => {
                matches!(ticks.kind, ExprKind::Number(count) if count < FRAME_TICKS) && pending
            }
            StatementKind::Call { .. } => false,
            StatementKind::Loop(body) => self.turns(body, pending),
            StatementKind::Until { body, .. } | StatementKind::While { body, .. } => {
                let sends = self.turns(body, pending);
                sends && contains_transmit(body)
            }
            StatementKind::If { then, otherwise, .. } => {
                let then = self.block(then, pending);
                self.block(otherwise, pending) || then
            }
            StatementKind::Select { cases, otherwise, .. } => {
                let mut after = self.block(otherwise, pending);
                for case in cases {
                    after |= self.block(&case.body, pending);
                }
                after
            }
            StatementKind::Declare(_)
            | StatementKind::Assign { .. }
            | StatementKind::Increment(_)
            | StatementKind::SetEvent { .. }
            | StatementKind::Events(_)
            | StatementKind::Receive(_)
            | StatementKind::Return(_)
            | StatementKind::Board { .. } => pending,
        }
    }
}

fn contains_transmit(body: &[Statement]) -> bool {
    body.iter().any(|statement| matches!(statement.kind, StatementKind::Transmit(_)))
}
