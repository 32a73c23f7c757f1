//! Moves of an axis whose loop always has the motor: from hardly any drive on until it moves, then strokes to and fro under known gains.
//!
//! What a move can ask of the motor at once is its length times the gain. That product goes up from almost nothing; the gain alone is what holds the
//! axis, so that it is raised where the axis does not stay.

use super::fit::{OF_DUTY, Stretch};
use crate::cause::Cause;
use crate::experiment_guard::{ExperimentGuard, Input};
use crate::gains::{Gains, Pid};
use crate::law::Law;
use crate::request::Excitation;
use crate::thresholds::thresholds;

thresholds! {
    /// The strokes of a motor that takes no duty: their lengths, and what counts as motion.
    MOVES_EXPERIMENT: Thresholds {
        /// Drive that the first rung of the ladder asks for, as a share of full.
        first_push: f64 = 0.008,
        /// Factor of the drive from rung to rung.
        more_push: f64 = 1.5,
        /// Length of the move on the first rung, in counts.
        first_counts: f64 = 100.0,
        /// Factor of the length from rung to rung.
        longer: f64 = 1.35,
        /// How long a motor may take to start, in seconds.
        start_s: f64 = 0.16,
        /// Counts from which on it moves.
        moved_counts: f64 = 4.0,
        /// Counts against the move from which on it has turned the other way.
        reversed_counts: f64 = 6.0,
        /// How long a new gain is watched before the axis is moved with it, in seconds.
        hold_s: f64 = 0.1,
        /// Counts by which the axis may settle in that time.
        held_counts: f64 = 6.0,
        /// Share of the room on the farther side, or of the width of a window, that a stroke may use.
        room_share: f64 = 0.4,
        /// How many polls in a row tell a standstill.
        still_polls: usize = 4,
        /// Counts within which these polls lie of each other.
        still_counts: f64 = 1.0,
        /// How long after a command the first poll comes, in seconds: on a line without jitter all polls would else see the same places of every move.
        phases_s: [f64; 5] = [0.0, 0.012, 0.004, 0.016, 0.008],
        /// A command that takes so much longer than the quickest, in seconds, was sent again.
        retried_s: f64 = 0.035,
        /// A piece of a record has more polls than this, or it is left out.
        least_points: usize = 8,
        /// A stroke that goes beyond its end by more than this share of its length is a loop that swings.
        swings: f64 = 0.5,
    }
}

/// Where the axis may be moved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ground {
    /// Where it stands, counts from the start of the run.
    pub start: f64,
    /// Which way there is more room.
    pub side: f64,
    /// How far it may go that way, counts.
    pub most: f64,
}

/// Gain and length of the first move that was one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Started {
    /// Duty per count.
    pub gain: f64,
    /// Duty at which it moved.
    pub push: f64,
}

/// Strokes as they were made.
pub(super) struct Strokes<L: Law> {
    /// In pieces where it is not known when a command took effect: a reply was lost and the command sent again.
    pub stretches: Vec<Stretch<L>>,
    /// Whether one swung.
    pub swings: bool,
}

/// A command of a stroke.
struct Given {
    /// When it was asked for and how long that took, s.
    asked_s: f64,
    took_s: f64,
    target: f64,
}

impl Ground {
    /// What there is around where the axis stands.
    pub(super) fn of<L: Law>(
        guard: &mut ExperimentGuard<'_, L>,
        excitation: Excitation,
    ) -> Result<Self, Cause> {
        guard.poll(false)?;
        let longest = guard.facts.longest_move_counts;
        let widest = match excitation {
            Excitation::Free => longest,
            Excitation::Window(width) => (MOVES_EXPERIMENT.room_share * width).min(longest),
        };
        let start = guard.points.last().map_or(0.0, |point| point.counts);
        let Some((low, high)) = guard.travel_counts() else {
            return Ok(Self { start, side: 1.0, most: widest });
        };
        let (side, room) =
            if high - start >= start - low { (1.0, high - start) } else { (-1.0, start - low) };
        let most = (MOVES_EXPERIMENT.room_share * room).min(widest);
        if most < 2.0 * MOVES_EXPERIMENT.reversed_counts {
            Err(Cause::NarrowTravel)
        } else {
            Ok(Self { start, side, most })
        }
    }
}

/// A loop of P and D, as duties per count and per counts/s.
pub(super) fn of_duty(p: f64, d: f64) -> Gains {
    Gains { position: Some(Pid { p, i: 0.0, d }), ..Gains::default() }
}

/// Gives the motor to a loop where it stands, with more gain where it does not stay there. Gives what is in force.
pub(super) fn hold<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    law: &L,
    gains: Gains,
) -> Result<L::Registers, Cause> {
    let mut wanted = law.rounded(&gains, OF_DUTY);
    loop {
        let held = guard.setup.held;
        let registers = law.registers(&held, &wanted, OF_DUTY, None);
        guard.write_all(&registers, true)?;
        guard.pause();
        let from = guard.points.len();
        guard.poll_for(MOVES_EXPERIMENT.hold_s, false)?;
        let seen = &guard.points[from.min(guard.points.len())..];
        let moved = seen.first().zip(seen.last()).map_or(0.0, |(a, b)| b.counts - a.counts);
        let Some(position) = wanted.position.filter(|_| moved.abs() > MOVES_EXPERIMENT.held_counts) else {
            return Ok(registers);
        };
        let stiffer = law.rounded(&of_duty(2.0 * position.p, 2.0 * position.d), OF_DUTY);
        if stiffer == wanted {
            return Err(Cause::HeavyLoad);
        }
        wanted = stiffer;
    }
}

/// Goes up the ladder until the motor moves. It holds where it is when this returns.
pub(super) fn start<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    law: &L,
    ground: &Ground,
) -> Result<Started, Cause> {
    let (mut push, mut counts) = (MOVES_EXPERIMENT.first_push, MOVES_EXPERIMENT.first_counts);
    loop {
        let length = counts.min(ground.most).round();
        let registers = hold(guard, law, of_duty(push / length, 0.0))?;
        let gain = law.gains(&registers, OF_DUTY, true).position.map_or(0.0, |position| position.p);
        guard.poll(false)?;
        let from = guard.points.last().map_or(ground.start, |point| point.counts);
        // To and fro about the start, towards the side with more room first.
        let way = if (from - ground.start) * ground.side > 0.0 { -ground.side } else { ground.side };
        guard.position(from + way * length, u32::MAX)?;
        let until_s = guard.now_s() + MOVES_EXPERIMENT.start_s;
        while guard.now_s() < until_s {
            let Some(point) = guard.poll(false)? else { continue };
            let moved = (point.counts - from) * way;
            if moved <= -MOVES_EXPERIMENT.reversed_counts {
                // The loop drives it away: it gets no drive before anything else.
                let held = guard.setup.held;
                let none = law.registers(&held, &Gains::default(), OF_DUTY, None);
                guard.write_all(&none, true)?;
                return Err(Cause::EncoderReversed);
            }
            if moved >= MOVES_EXPERIMENT.moved_counts {
                guard.duty(0.0)?;
                return Ok(Started { gain, push: (gain * length).min(1.0) });
            }
        }
        guard.duty(0.0)?;
        if gain * length >= guard.options.max_duty || push >= guard.options.max_duty {
            return Err(Cause::NothingCounted);
        }
        (push, counts) = (push * MOVES_EXPERIMENT.more_push, counts * MOVES_EXPERIMENT.longer);
    }
}

/// Strokes from the start of the ground to shares of a length, each until the axis stands or its time is over.
pub(super) fn strokes<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    ground: &Ground,
    registers: L::Registers,
    (length, shares, longest_s): (f64, &[f64], f64),
) -> Result<Strokes<L>, Cause> {
    guard.poll(false)?;
    let mut at = guard.points.last().map_or(ground.start, |point| point.counts);
    let mut swings = false;
    // Its pace is set by a move to where it is, so that those that count are one command each.
    guard.position(at, u32::MAX)?;
    let mut given = vec![Given { asked_s: guard.now_s(), took_s: 0.0, target: at }];
    for (n, share) in shares.iter().enumerate() {
        let target = (ground.start + ground.side * share * length).round();
        let asked_s = guard.now_s();
        guard.position(target, u32::MAX)?;
        given.push(Given { asked_s, took_s: guard.now_s() - asked_s, target });
        guard.defer(MOVES_EXPERIMENT.phases_s[n % MOVES_EXPERIMENT.phases_s.len()]);
        let until_s = guard.now_s() + longest_s;
        // Stays of uneven length: polls come at all phases of the moves.
        let least_s = guard.now_s() + 0.12 + 0.007 * (n % 4) as f64;
        while guard.now_s() < until_s {
            let Some(point) = guard.poll(false)? else { continue };
            let beyond = (point.counts - target) * (target - at).signum();
            if beyond > MOVES_EXPERIMENT.swings * (target - at).abs() + MOVES_EXPERIMENT.reversed_counts {
                swings = true;
                break;
            }
            if guard.now_s() > least_s && is_still(guard) {
                break;
            }
        }
        if swings {
            guard.duty(0.0)?;
            break;
        }
        at = target;
    }
    Ok(Strokes { stretches: pieces(guard, &given, registers), swings })
}

/// The stretches between commands that were sent again: when those took effect is not known.
fn pieces<L: Law>(
    guard: &ExperimentGuard<'_, L>,
    given: &[Given],
    registers: L::Registers,
) -> Vec<Stretch<L>> {
    let quickest_s = given.iter().skip(1).map(|given| given.took_s).fold(f64::INFINITY, f64::min);
    let mut all = Vec::new();
    let mut begin: Option<&Given> = given.first();
    for (n, one) in given.iter().enumerate().skip(1) {
        if one.took_s > quickest_s + MOVES_EXPERIMENT.retried_s {
            all.extend(begin.and_then(|from| piece(guard, from, one.asked_s, registers)));
            begin = None;
        } else if begin.is_none() {
            begin = given.get(n - 1);
        }
    }
    all.extend(begin.and_then(|from| piece(guard, from, f64::INFINITY, registers)));
    all
}

/// What was polled and commanded from shortly before the command after one, until a time; `None` where that is hardly anything.
fn piece<L: Law>(
    guard: &ExperimentGuard<'_, L>,
    from: &Given,
    to_s: f64,
    registers: L::Registers,
) -> Option<Stretch<L>> {
    let next = guard.drives.iter().find(|drive| drive.t > from.asked_s + from.took_s && drive.t < to_s)?;
    let first = guard.points.iter().rposition(|point| point.t < next.t)?;
    let is_inside = |t: f64| t >= guard.points[first].t && t <= to_s;
    let points = guard.points[first..].iter().filter(|point| is_inside(point.t));
    let points: Vec<(f64, f64)> = points.map(|point| (point.t, point.counts)).collect();
    let given =
        guard.drives.iter().filter(|drive| is_inside(drive.t)).filter_map(|drive| match drive.input {
            Input::Position(target, speed) => Some((drive.t, target, speed)),
            Input::Duty(_) | Input::Speed(_) => None,
        });
    let moves: Vec<_> = std::iter::once((f64::NEG_INFINITY, from.target, 0.0)).chain(given).collect();
    (moves.len() > 1 && points.len() > MOVES_EXPERIMENT.least_points).then_some(Stretch {
        points,
        moves,
        registers,
    })
}

fn is_still<L: Law>(guard: &ExperimentGuard<'_, L>) -> bool {
    let Some(last) =
        guard.points.len().checked_sub(MOVES_EXPERIMENT.still_polls).map(|from| &guard.points[from..])
    else {
        return false;
    };
    last.iter().all(|point| (point.counts - last[0].counts).abs() <= MOVES_EXPERIMENT.still_counts)
}
