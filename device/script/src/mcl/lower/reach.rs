//! Where the program cannot get to, runs out, or lets the stack grow: found on the instructions, whose jumps are all known.

use super::super::codes;
use super::Lowering;
use crate::diagnostic::Severity;
use crate::op::Op;
use crate::text::Span;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// Steps after which the search for growing stacks gives up: programs that need more are not written by hand.
const MOST_STEPS: usize = 4_000_000;

impl Lowering<'_> {
    /// Says what is wrong with the way through the program. Programs with errors are left alone: not all of their jumps lead somewhere.
    pub(super) fn warn_of_flow(&mut self) {
        if self.diagnostics.iter().any(|diagnostic| diagnostic.severity() == Severity::Error) {
            return;
        }
        let graph = Graph { ops: &self.ops };
        let all = graph.reached(0, true);
        let main = graph.reached(0, false);
        let mut found = unreachable(&all, &self.spans);
        found.extend(self.missing_ends(&graph, &all, &main));
        found.extend(self.growing(&graph, &main));
        for (code, span, message, hint) in found {
            self.report(code, span, message, hint);
        }
    }

    fn name_of(&self, at: usize) -> String {
        self.scope.label_name(self.text, at).unwrap_or_default()
    }

    /// The end of the text, and subroutines that the program runs into.
    fn missing_ends(&self, graph: &Graph<'_>, all: &[bool], main: &[bool]) -> Vec<Found> {
        let mut found = Vec::new();
        let last = self.ops.len().saturating_sub(1);
        let falls_into = |at: usize| at > 0 && graph.falls_through(at - 1);
        let span_before = |at: usize| self.spans[..at].iter().rev().find_map(|span| *span);
        let entries: BTreeSet<usize> = graph.calls().map(|(_, to)| to).collect();
        let jumped = graph.jump_targets(all);
        for to in entries {
            if falls_into(to)
                && main[to - 1]
                && !jumped.contains(&to)
                && let Some(span) = span_before(to)
            {
                let message = format!("The program runs into the subroutine `{}` here.", self.name_of(to));
                found.push((codes::MISSING_END, span, message, Some("Write END before it.".to_owned())));
            }
        }
        if all.get(last) == Some(&true)
            && let Some(span) = span_before(last)
        {
            let hint = Some("Write END, or GOTO to go on.".to_owned());
            found.push((codes::MISSING_END, span, "The program runs out here and ends.".to_owned(), hint));
        }
        found
    }

    /// Subroutines that can be called again before they return.
    fn growing(&self, graph: &Graph<'_>, main: &[bool]) -> Vec<Found> {
        let bodies = graph.bodies();
        let calls = |from: usize| bodies.get(&from).map_or(&[][..], |body| &body.calls);
        let mut found = Vec::new();
        let mut steps = 0;
        for (entry, body) in &bodies {
            let closing = body.calls.iter().find(|(_, to)| reaches(calls, *to, *entry, &mut steps));
            let Some((at, to)) = closing else { continue };
            let name = self.name_of(*entry);
            let (site, message) = match body.way_out(main).filter(|_| main[*at] && !main[*entry]) {
                Some(jump) => {
                    (jump, format!("The subroutine `{name}` leaves by GOTO and can be called again."))
                }
                None if to == entry => (*at, format!("`{name}` calls itself.")),
                None => (*at, format!("`{name}` calls itself by way of `{}`.", self.name_of(*to))),
            };
            let hint = Some("Each call that does not return takes room on the stack.".to_owned());
            if let Some(span) = self.spans.get(site).copied().flatten() {
                found.push((codes::STACK_GROWTH, span, message, hint));
            }
        }
        found
    }
}

type Found = (&'static str, Span, String, Option<String>);

/// The first statement of each stretch that nothing leads to.
fn unreachable(all: &[bool], spans: &[Option<Span>]) -> Vec<Found> {
    let reached: HashSet<Span> =
        spans.iter().zip(all).filter(|pair| *pair.1).filter_map(|pair| *pair.0).collect();
    let mut found = Vec::new();
    let mut in_stretch = false;
    for (span, is_reached) in spans.iter().zip(all) {
        if *is_reached {
            in_stretch = false;
        } else if let Some(span) = span
            && !in_stretch
            && !reached.contains(span)
        {
            in_stretch = true;
            found.push((codes::UNREACHABLE, *span, "Nothing leads here.".to_owned(), None));
        }
    }
    found
}

/// Whether calls lead from one subroutine to another.
fn reaches<'a>(
    calls: impl Fn(usize) -> &'a [(usize, usize)],
    from: usize,
    to: usize,
    steps: &mut usize,
) -> bool {
    let mut seen = HashSet::from([from]);
    let mut open = vec![from];
    while let Some(at) = open.pop() {
        if at == to {
            return true;
        }
        for (_, next) in calls(at) {
            *steps += 1;
            if *steps > MOST_STEPS {
                return false;
            }
            if seen.insert(*next) {
                open.push(*next);
            }
        }
    }
    false
}

struct Graph<'a> {
    ops: &'a [Op],
}

/// What a subroutine does before it returns; what it calls is left out.
struct Body {
    /// GOSUBs in it: instruction and subroutine.
    calls: Vec<(usize, usize)>,
    /// Jumps in it: instruction and where to.
    jumps: Vec<(usize, usize)>,
}

impl Body {
    /// The first jump out of the subroutine into the main program.
    fn way_out(&self, main: &[bool]) -> Option<usize> {
        self.jumps.iter().find(|(at, to)| !main[*at] && main[*to]).map(|(at, _)| *at)
    }
}

impl Graph<'_> {
    /// Tells where an instruction can go on to, subroutines apart.
    fn next(&self, at: usize, mut tell: impl FnMut(usize)) {
        let to = |to: u32| to as usize;
        match self.ops[at] {
            Op::Jump(target) => tell(to(target)),
            Op::JumpIfZero(target)
            | Op::JumpIfNotZero(target)
            | Op::ForNext(_, _, target)
            | Op::I2cOut(_, _, Some(target))
            | Op::I2cIn(_, Some(target)) => {
                tell(at + 1);
                tell(to(target));
            }
            Op::Branch(count) => (at + 1..=at + 1 + to(count)).for_each(tell),
            Op::Return(_) | Op::End => {}
            _ => tell(at + 1),
        }
    }

    fn falls_through(&self, at: usize) -> bool {
        !matches!(self.ops[at], Op::Jump(_) | Op::Return(_) | Op::End)
    }

    /// Every call: instruction and subroutine.
    fn calls(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.ops.iter().enumerate().filter_map(|(at, op)| match op {
            Op::Gosub(to, _) => Some((at, *to as usize)),
            _ => None,
        })
    }

    /// Where jumps lead that can be reached.
    fn jump_targets(&self, reached: &[bool]) -> HashSet<usize> {
        let mut targets = HashSet::new();
        for at in (0..self.ops.len()).filter(|at| reached[*at]) {
            self.next(at, |to| {
                if to != at + 1 || !self.falls_through(at) {
                    targets.insert(to);
                }
            });
        }
        targets
    }

    /// What can be reached from an instruction, with or without going into subroutines.
    fn reached(&self, from: usize, into_calls: bool) -> Vec<bool> {
        let mut reached = vec![false; self.ops.len()];
        let mut open = vec![from];
        while let Some(at) = open.pop() {
            let Some(seen @ false) = reached.get_mut(at) else { continue };
            *seen = true;
            self.next(at, |next| open.push(next));
            if let (true, Op::Gosub(to, _)) = (into_calls, self.ops[at]) {
                open.push(to as usize);
            }
        }
        reached
    }

    /// Every subroutine that is called somewhere, by its first instruction.
    fn bodies(&self) -> BTreeMap<usize, Body> {
        let mut bodies = BTreeMap::new();
        let mut stamps: HashMap<usize, usize> = HashMap::new();
        let mut steps = 0;
        for (_, entry) in self.calls() {
            if bodies.contains_key(&entry) {
                continue;
            }
            let mut body = Body { calls: Vec::new(), jumps: Vec::new() };
            let mut open = vec![entry];
            while let Some(at) = open.pop().filter(|_| steps < MOST_STEPS) {
                if at >= self.ops.len() || stamps.insert(at, entry) == Some(entry) {
                    continue;
                }
                steps += 1;
                if let Op::Gosub(to, _) = self.ops[at] {
                    body.calls.push((at, to as usize));
                }
                self.next(at, |next| {
                    if next != at + 1 {
                        body.jumps.push((at, next));
                    }
                    open.push(next);
                });
            }
            body.calls.sort_unstable();
            body.jumps.sort_unstable();
            bodies.insert(entry, body);
        }
        bodies
    }
}
