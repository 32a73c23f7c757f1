//! Where the program cannot get to, runs out, or lets the stack grow: found on the instructions, whose jumps are all known.

use super::super::codes;
use super::Lowering;
use crate::diagnostic::excerpt;
use crate::op::Op;
use crate::text::Span;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// Steps after which the way by which a stack grows is not looked for any more: programs that need more are not written by hand.
const MOST_STEPS: usize = 4_000_000;

impl Lowering<'_> {
    /// Says what is wrong with the way through the program. Programs with errors are left alone: not all of their jumps lead somewhere.
    pub(super) fn warn_of_flow(&mut self) {
        if self.diagnostics.has_errors() {
            return;
        }
        let graph = Graph { ops: &self.ops };
        let names = self.scope.label_names(self.text);
        let all = graph.reached(0, true);
        let main = graph.reached(0, false);
        let mut found = unreachable(&all, &self.spans);
        found.extend(self.missing_ends(&graph, &names, &all, &main));
        found.extend(self.growing(&graph, &names, &main));
        for (code, span, message, hint) in found {
            self.report(code, span, message, hint);
        }
    }

    /// The end of the text, and subroutines that the program runs into.
    fn missing_ends(&self, graph: &Graph<'_>, names: &Names<'_>, all: &[bool], main: &[bool]) -> Vec<Found> {
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
                let message = format!("The program runs into the subroutine `{}` here.", name_of(names, to));
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

    /// Subroutines that can be called again before they return: those that a call leads to from where they lead themselves.
    fn growing(&self, graph: &Graph<'_>, names: &Names<'_>, main: &[bool]) -> Vec<Found> {
        let group = graph.groups();
        let mut entries: BTreeMap<usize, usize> = BTreeMap::new();
        for (at, to) in graph.calls().filter(|(at, to)| group[*at] == group[*to]) {
            entries.entry(to).or_insert(at);
        }
        let mut found = Vec::new();
        let mut search = Search::new(graph);
        for (entry, site) in entries {
            let name = name_of(names, entry);
            let (site, message) = match search.body(entry, &group, main) {
                None => (site, format!("`{name}` can be called again before it returns.")),
                Some(Body { call: (at, _), way_out: Some(jump) }) if main[at] && !main[entry] => {
                    (jump, format!("The subroutine `{name}` leaves by GOTO and can be called again."))
                }
                Some(Body { call: (at, to), .. }) if to == entry => (at, format!("`{name}` calls itself.")),
                Some(Body { call: (at, to), .. }) => {
                    (at, format!("`{name}` calls itself by way of `{}`.", name_of(names, to)))
                }
            };
            let hint = Some("Each call that does not return takes room on the stack.".to_owned());
            if let Some(span) = self.spans.get(site).copied().flatten() {
                found.push((codes::STACK_GROWTH, span, message, hint));
            }
        }
        found
    }
}

/// Labels by their instructions.
type Names<'t> = HashMap<usize, &'t str>;

fn name_of<'t>(names: &Names<'t>, at: usize) -> Cow<'t, str> {
    names.get(&at).map_or(Cow::Borrowed(""), |name| excerpt(name))
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

struct Graph<'a> {
    ops: &'a [Op],
}

/// How a subroutine comes to be called again. What it calls is left out.
struct Body {
    /// The first call in it that leads back to it: instruction and subroutine.
    call: (usize, usize),
    /// The first jump out of it into the main program.
    way_out: Option<usize>,
}

/// Looks through subroutines, a bounded number of steps in all.
struct Search<'a> {
    graph: &'a Graph<'a>,
    /// The subroutine that saw an instruction last.
    seen: Vec<usize>,
    steps: usize,
}

impl<'a> Search<'a> {
    fn new(graph: &'a Graph<'a>) -> Self {
        Self { graph, seen: vec![usize::MAX; graph.ops.len()], steps: 0 }
    }

    /// `None` when there are no steps left.
    fn body(&mut self, entry: usize, group: &[u32], main: &[bool]) -> Option<Body> {
        let (mut call, mut way_out) = (None, None);
        let mut open = vec![entry];
        while let Some(at) = open.pop() {
            if at >= self.graph.ops.len() || std::mem::replace(&mut self.seen[at], entry) == entry {
                continue;
            }
            self.steps += 1;
            if self.steps > MOST_STEPS {
                return None;
            }
            if let Op::Gosub(to, _) = self.graph.ops[at]
                && group[to as usize] == group[entry]
            {
                let here = (at, to as usize);
                call = Some(call.map_or(here, |first: (usize, usize)| first.min(here)));
            }
            self.graph.next(at, |next| {
                if next != at + 1 && !main[at] && main[next] {
                    way_out = Some(way_out.map_or(at, |first: usize| first.min(at)));
                }
                open.push(next);
            });
        }
        call.map(|call| Body { call, way_out })
    }
}

impl Graph<'_> {
    /// Tells where an instruction can go on to, subroutines apart.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
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
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
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

    /// For each instruction the number of its group: those that lead to each other, by calls too (Tarjan's strongly connected components).
    fn groups(&self) -> Vec<u32> {
        const NONE: u32 = u32::MAX;
        let count = self.ops.len();
        let mut starts = Vec::with_capacity(count + 1);
        let mut edges: Vec<u32> = Vec::with_capacity(count);
        for at in 0..count {
            starts.push(edges.len());
            let mut tell = |to: usize| edges.extend((to < count).then_some(to as u32));
            self.next(at, &mut tell);
            if let Op::Gosub(to, _) = self.ops[at] {
                tell(to as usize);
            }
        }
        starts.push(edges.len());
        let (mut group, mut order, mut low) = (vec![NONE; count], vec![NONE; count], vec![NONE; count]);
        let (mut stack, mut path) = (Vec::new(), Vec::new());
        let mut seen = 0;
        for root in 0..count {
            if order[root] == NONE {
                path.push((root, starts[root]));
            }
            while let Some((at, edge)) = path.pop() {
                if order[at] == NONE {
                    (order[at], low[at]) = (seen, seen);
                    seen += 1;
                    stack.push(at);
                }
                if edge < starts[at + 1] {
                    let to = edges[edge] as usize;
                    path.push((at, edge + 1));
                    if order[to] == NONE {
                        path.push((to, starts[to]));
                    } else if group[to] == NONE {
                        low[at] = low[at].min(order[to]);
                    }
                    continue;
                }
                if low[at] == order[at] {
                    while let Some(member) = stack.pop() {
                        group[member] = at as u32;
                        if member == at {
                            break;
                        }
                    }
                }
                if let Some((parent, _)) = path.last() {
                    low[*parent] = low[*parent].min(low[at]);
                }
            }
        }
        group
    }
}
