//! What D of the position loop multiplies, read off the duty that it takes from P's while the motor creeps.
//!
//! At a standstill D gives nothing, so the motor has to turn. A target far away makes P a duty that is nearly constant; what is missing from it
//! over the speed of the counts is D, whether it is counted per tick or per second. Weak registers are tried first, so that D never throws the motor.

use crate::probed::{Probed, QPPS, RATES_HZ, gains};
use crate::registers::{McpLaw, McpWrite, PositionRegisters};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::experiment_guard::Point;
use brushwork_tuning::law::Law;
use brushwork_tuning::model::DerivativeFilter;
use brushwork_tuning::oscillation::deviation;
use brushwork_tuning::settle::slope;

/// Duty above the starting one at which the motor creeps.
const CREEP_DUTY: f64 = 0.04;
/// Counts in one tick each that readings must be expected to meet, since D makes a pulse of a tick of each, and the most duty above the starting one for that: the coarse
/// encoder of a slow motor gives one count in twenty ticks at the usual creep, of which twenty readings may see none. Of seed 1017 of another make one D was read forty
/// times too small so, and its loop called tuned at a true Ms of 3.4.
const ENOUGH_PULSES: f64 = 12.0;
const MOST_CREEP_DUTY: f64 = 0.3;
/// How long it creeps, at the most where few counts came, how long where it does not move at all, and from when on readings count, s: the motor has to have gathered its speed.
const CREEP_S: f64 = 0.4;
const LONGEST_CREEP_S: f64 = 1.5;
const UNMOVED_S: f64 = 0.25;
const SETTLED_S: f64 = 0.1;
/// The target lies so many times as far away as the motor creeps, and how far that is on an axis that turns freely, counts.
const FAR: f64 = 8.0;
const FREE_COUNTS: f64 = 100_000.0;
/// Position limits of an axis that has none, counts.
const UNLIMITED: i32 = 1 << 30;
/// How far the motor has to have come while readings counted, counts, and how many of them there have to be.
const LEAST_COUNTS: f64 = 12.0;
const LEAST_READINGS: usize = 6;
/// How long the motor may coast, s, what of its speed is slow, and what of a travel it may take for that.
const COAST_S: f64 = 1.0;
const SLOW: f64 = 0.02;
const MOST_OF_ROOM: f64 = 0.1;
/// The duty that D is to take away, the most that one count in one tick may make, and the smallest share of the former that is read well.
const TAKEN_DUTY: f64 = 0.012;
const MOST_KICK: f64 = 0.05;
const LEAST_SHARE: f64 = 0.25;
/// Least speed that D's register is chosen for, as a share of what the creep's duty gives a motor whose friction is that of its start. Cogs may keep it to a tenth of that,
/// where D would take the duty away ten times over, of all that the speed can be, and swing.
const OF_CREEP: f64 = 0.3;
/// How many registers are tried: for a D counted per second, per tick, and per what the second one told where that is so many times more than it was meant for.
const TRIES: u32 = 3;
const TOO_STRONG: f64 = 4.0;
/// The scale of P has to hold while the motor turns, too: how far off the duty may be without D.
const P_TOLERANCE: f64 = 0.06;
/// The shortest tick that is believed to be a second's part and no second, s. Differences of whole counts have to make so much, counts squared, and be read so often.
const MOST_TICK_S: f64 = 0.02;
const LEAST_ROUGH: f64 = 0.06;
const ENOUGH_FOR_ROUGHNESS: usize = 12;
/// The speed at a reading is that of so many readings before and after it: of few, or of more, whose late stamps matter less.
const AROUND: [usize; 3] = [1, 3, 6];
/// By how much more duty the motor creeps again where whole counts told nothing or the duty was smooth, as shares of that above the starting one: polls that keep in
/// step with the counts see the same of them each time, at one speed and not at another.
const AGAIN: [f64; 2] = [0.35, 0.7];
/// The cogs of a quick motor make the duty of a slow creep rough where many counts in a tick make it smooth: with time constants up to so many seconds and from so many
/// counts in a tick on, a rough duty is read again with more duty, by which the cogs pass more quickly, and the smoothest counts. Of coreless motors of another make with
/// such a filter every second PD and PID was taken to see whole counts.
const COGGED_TAU_S: f64 = 0.05;
const MANY_PER_TICK: f64 = 8.0;
const FASTER: [f64; 2] = [0.1, 0.2];
/// D's duty is that of a filtered speed below such a share of what differences of whole counts make: a filter of one tick leaves three tenths of it, twenty readings
/// spread by a third.
const FILTERED: f64 = 0.4;
/// From such a share on it is that of whole counts. Of 365 motors of another make (seeds 1002, 1003, 1009 and 1011) 5 % of those whose D sees whole counts are between the two, and 6 of 93 whose D
/// sees a filtered speed, which cogs made rough: one was called tuned at a true Ms of 2.2.
const WHOLE: f64 = 0.6;
/// Harmonics of the rounding that are summed, of which the last are a thousandth, and how a filter is searched for: the least that it lets through in a tick, as a share.
const HARMONICS: u32 = 60;
const LEAST_SHARE_OF_TICK: f64 = 0.01;
const HALVINGS: u32 = 30;
/// A finding within such a factor of one tick or of one second is taken to be that. D may make a pulse of each count, of which polls see few.
const KNOWN_WITHIN: f64 = 1.7;

/// What was found of D.
pub(crate) struct DerivativeFound {
    /// Seconds that a D register of the position's scale multiplies the speed with.
    pub seconds: f64,
    /// How rough its duty is over what differences of whole counts make it.
    pub roughness: Option<f64>,
    /// The filter on the speed that it sees; `None` where it sees the counts of each tick, and none that is known where nothing told.
    pub filter: Option<DerivativeFilter>,
}

/// What D multiplies, and whether it sees a filtered speed; `None` where there is no room to creep, or it was not read well.
pub(crate) fn derivative_under<L: Law>(
    guard: &mut Probed<'_, '_, L>,
    start_duty: f64,
    scale: f64,
    limits: (i32, i32),
    rate_hz: f64,
) -> Result<Option<DerivativeFound>, Cause> {
    guard.set(gains(0.0, 0.0))?;
    guard.poll(false)?;
    let here = guard.points.last().map_or(0.0, |point| point.counts);
    let Some(creep) = Creep::from(here, guard.origin_counts() as f64, guard.room_counts(), limits) else {
        return Ok(None);
    };
    guard.progress("Reading what D takes from the duty while the motor creeps");
    let no_load_speed = guard.monitor.no_load_speed();
    let enough = ENOUGH_PULSES * guard.options.poll_s * rate_hz;
    let telling_speed = (enough / (CREEP_S - SETTLED_S)).min(rate_hz);
    let telling_duty = if no_load_speed > 0.0 { telling_speed / no_load_speed } else { CREEP_DUTY };
    let creep_duty = telling_duty.clamp(CREEP_DUTY, MOST_CREEP_DUTY);
    let duty = start_duty + creep_duty;
    let is_cogged = guard.monitor.tau_bounds_s.is_some_and(|tau| (tau.0 * tau.1).sqrt() < COGGED_TAU_S);
    let mut creeps = |direction: f64, duty: f64, d: f64| {
        let turned = creep.run(guard, (direction, duty), scale, d, enough);
        coast(guard)?;
        turned
    };
    let Some(plain) = creeps(creep.direction, duty, 0.0)? else { return Ok(None) };
    if (plain.missing_duty / duty).abs() > P_TOLERANCE {
        return Ok(None);
    }
    // Registers, were D counted per second; a register that takes nothing away then is tried as one counted per tick.
    let gain = (TAKEN_DUTY / plain.speed.max(OF_CREEP * creep_duty * no_load_speed)).min(MOST_KICK / rate_hz);
    let mut direction = -creep.direction;
    let mut seconds = 1.0;
    for n in 0..TRIES {
        let d = (gain * QPPS * scale / seconds).round().clamp(1.0, f64::from(i32::MAX));
        let Some(turned) = creeps(direction, duty, d)? else { return Ok(None) };
        // P may itself be a little off.
        let taken = turned.missing_duty - plain.missing_duty;
        let found = taken * QPPS * scale / (d * turned.speed);
        // Pulses that are so high are cut, and few of them are read.
        let is_too_strong = found > TOO_STRONG * seconds;
        if !is_too_strong && taken > LEAST_SHARE * gain * plain.speed {
            // A D per tick tells the rate of the loop itself.
            let rate_hz = if found < MOST_TICK_S { 1.0 / found } else { rate_hz };
            let mut told = turned.told(rate_hz);
            let mut again = &AGAIN[..];
            if is_cogged && turned.has_many_counts(rate_hz) && told.is_some_and(|told| told.is_rough()) {
                told = None;
                for more in FASTER {
                    direction = -direction;
                    let faster = creeps(direction, duty + more, d)?;
                    told = Told::smoother(told, faster.and_then(|turned| turned.told(rate_hz)));
                }
                again = &[];
            }
            for more in again {
                if told.is_some_and(|told| told.times > 1 || told.is_rough()) {
                    break;
                }
                direction = -direction;
                let other = creeps(direction, duty + more * creep_duty, d)?;
                told = Told::of_both(told, other.and_then(|turned| turned.told(rate_hz)));
            }
            let is_open = told.is_none_or(|told| told.filter.is_none() && told.roughness < WHOLE);
            let filter =
                if is_open { Some(DerivativeFilter::UNKNOWN) } else { told.and_then(|told| told.filter) };
            let roughness = told.map(|told| told.roughness);
            return Ok(Some(DerivativeFound { seconds: found, roughness, filter }));
        }
        seconds = match n {
            _ if is_too_strong => found,
            0 => 1.0 / rate_hz,
            _ => break,
        };
        direction = -direction;
    }
    Ok(None)
}

/// Lets the motor come to rest by itself: braking shakes a springy joint. Where that takes too much of a travel it is braked.
fn coast<L: Law>(guard: &mut Probed<'_, '_, L>) -> Result<(), Cause> {
    let speed = guard.recent_speed(2).unwrap_or(0.0).abs();
    let longest_s = guard.monitor.tau_bounds_s.map_or(f64::INFINITY, |tau| tau.1);
    if guard.room_counts().is_some_and(|room| speed * longest_s > MOST_OF_ROOM * room) {
        return guard.come_to_rest();
    }
    guard.duty(0.0)?;
    let until_s = guard.now_s() + COAST_S;
    while guard.now_s() < until_s {
        guard.poll(false)?;
        if guard.recent_speed(6).is_some_and(|now| now.abs() <= SLOW * speed) {
            break;
        }
    }
    Ok(())
}

/// What is found as what it is taken to be: one tick of the loop, one second, one of the usual ticks, since a step of the speed over two ticks tells half the rate of the
/// loop, or itself.
pub(crate) fn known_derivative_s(found: f64, law: &McpLaw) -> f64 {
    let off = |known: f64| (found / known).ln().abs();
    let is_near = |known: &f64| off(*known) < KNOWN_WITHIN.ln();
    let tick_s = |rate_hz: u32| 1.0 / f64::from(rate_hz);
    let usual = RATES_HZ.map(tick_s).into_iter().min_by(|a, b| off(*a).total_cmp(&off(*b)));
    [tick_s(law.rate_hz), 1.0].into_iter().chain(usual).find(is_near).unwrap_or(found)
}

/// Where the motor may creep.
struct Creep {
    /// The side with more room.
    direction: f64,
    /// How far it may go.
    counts: f64,
    /// Counts from the start of the run that the target has to stay within.
    limits: (f64, f64),
    registers: PositionRegisters,
}

/// What a creep has shown.
struct Turned {
    /// Counts/s, positive.
    speed: f64,
    /// By how much the duty is less than P makes it.
    missing_duty: f64,
    /// By how much that scatters about what the speed takes, as variance, and the speeds that it was read at, counts/s.
    scatter: f64,
    speeds: Vec<f64>,
    /// By how much it scatters about its own slow trend, as variance.
    about_trend: f64,
}

/// By how much the duty that is missing scatters about what the speed takes, as variance, and the speeds, counts/s: by that number of readings on either side of which
/// it scatters less, since late stamps make a speed of few readings wrong, and a speed that changes one of many. `taken` is the duty over the speed in a direction.
fn scatter(readings: &[Point], missing: impl Fn(&Point) -> Option<f64>, taken: f64) -> (f64, Vec<f64>) {
    let by = |around: usize| {
        let windows = readings.windows(2 * around + 1);
        let (rests, speeds): (Vec<f64>, Vec<f64>) = windows
            .filter_map(|window| {
                let speed = slope(window)?;
                missing(&window[around]).map(|missing| ((missing - taken * speed).powi(2), speed))
            })
            .unzip();
        (rests.iter().sum::<f64>() / rests.len().max(1) as f64, speeds)
    };
    let [first, rest @ ..] = AROUND.map(by);
    rest.into_iter()
        .filter(|more| more.1.len() >= ENOUGH_FOR_ROUGHNESS)
        .fold(first, |least, more| if more.0 < least.0 { more } else { least })
}

/// What creeps have told of the speed that D sees.
#[derive(Clone, Copy, Debug)]
struct Told {
    /// How rough its duty is over what differences of whole counts make it.
    roughness: f64,
    filter: Option<DerivativeFilter>,
    /// How many creeps told it.
    times: u32,
}

impl Told {
    /// Whether D sees differences of whole counts.
    fn is_rough(&self) -> bool {
        self.roughness >= FILTERED
    }

    /// The smoother of two creeps, each of which something beside the counts may have made rough.
    fn smoother(one: Option<Self>, other: Option<Self>) -> Option<Self> {
        let (Some(first), Some(second)) = (one, other) else { return one.or(other) };
        let smoother = if first.roughness <= second.roughness { first } else { second };
        Some(Self { times: first.times + second.times, ..smoother })
    }

    /// The mean of two that both tell of a filter, since each reads its length off few readings; else the rougher: polls in step with the counts make a duty smooth.
    fn of_both(one: Option<Self>, other: Option<Self>) -> Option<Self> {
        let (Some(first), Some(second)) = (one, other) else { return one.or(other) };
        let times = first.times + second.times;
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        if let (Some(a), Some(b)) = (first.filter, second.filter) {
            let (likely_s, least_s) = (mean(a.likely_s, b.likely_s), mean(a.least_s, b.least_s));
            let filter = Some(DerivativeFilter { likely_s, least_s });
            return Some(Self { roughness: mean(first.roughness, second.roughness), filter, times });
        }
        let rougher = if first.roughness >= second.roughness { first } else { second };
        Some(Self { times, ..rougher })
    }
}

impl Turned {
    /// The variance that counts. At many counts in a tick the speed of some readings is no better known than D's duty, whose own slow trend takes its place.
    fn variance(&self, rate_hz: f64) -> f64 {
        if self.has_many_counts(rate_hz) { self.scatter.min(self.about_trend) } else { self.scatter }
    }

    fn has_many_counts(&self, rate_hz: f64) -> bool {
        self.speed > MANY_PER_TICK * rate_hz
    }

    /// What it tells; `None` where whole counts make nearly no difference.
    fn told(&self, rate_hz: f64) -> Option<Told> {
        let roughness = self.roughness(rate_hz)?;
        Some(Told { roughness, filter: self.filter(rate_hz), times: 1 })
    }

    /// How rough D's duty is over what differences of whole counts make it: 1 where D sees the counts of a tick, much less where it sees a filtered speed. `None` where whole
    /// counts make nearly no difference.
    fn roughness(&self, rate_hz: f64) -> Option<f64> {
        let per_tick = |speed: &f64| (speed.abs() / rate_hz).rem_euclid(1.0);
        let shares = self.speeds.iter().map(|speed| per_tick(speed) * (1.0 - per_tick(speed)));
        let expected = shares.sum::<f64>() / self.speeds.len().max(1) as f64;
        let of_a_count = self.missing_duty * rate_hz / self.speed;
        let is_told = expected > LEAST_ROUGH && self.speeds.len() >= ENOUGH_FOR_ROUGHNESS;
        is_told.then(|| self.variance(rate_hz) / (expected * of_a_count.powi(2)))
    }

    /// The filter of the speed that D sees: as smooth as it makes D's duty, and the least with which twice the scatter of so many readings may hide.
    fn filter(&self, rate_hz: f64) -> Option<DerivativeFilter> {
        self.roughness(rate_hz).filter(|rough| *rough < FILTERED)?;
        let of_a_count = self.missing_duty * rate_hz / self.speed;
        let counts = self.variance(rate_hz) / of_a_count.powi(2);
        let n = self.speeds.len() as f64;
        let delay_s = |counts: f64| {
            let rough = |share: f64| {
                self.speeds.iter().map(|speed| filtered(share, speed / rate_hz)).sum::<f64>() / n
            };
            let (mut low, mut high) = (LEAST_SHARE_OF_TICK, 1.0);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if rough(middle) < counts { low = middle } else { high = middle }
            }
            (1.0 - high) / high / rate_hz
        };
        Some(DerivativeFilter {
            likely_s: delay_s(counts),
            least_s: delay_s(counts * (1.0 + 2.0 * (2.0 / n).sqrt())),
        })
    }
}

/// Variance, in counts squared, of the whole counts of a tick behind a filter that lets so much of a change through in a tick, at a steady speed of so many counts in a
/// tick: rounding is a sawtooth over the counts, of which the filter passes each harmonic by itself.
fn filtered(share: f64, per_tick: f64) -> f64 {
    let kept = 1.0 - share;
    let harmonic = |k: u32| {
        let turn = std::f64::consts::TAU * f64::from(k) * per_tick;
        let differences = 2.0 * (1.0 - turn.cos());
        let passed = share.powi(2) / (1.0 - 2.0 * kept * turn.cos() + kept.powi(2));
        differences * passed / (2.0 * (std::f64::consts::PI * f64::from(k)).powi(2))
    };
    (1..=HARMONICS).map(harmonic).sum()
}

impl Creep {
    fn from(here: f64, origin: f64, room: Option<f64>, (min, max): (i32, i32)) -> Option<Self> {
        let (min, max) = if min < max { (min, max) } else { (-UNLIMITED, UNLIMITED) };
        let limits = (f64::from(min) - origin, f64::from(max) - origin);
        let (below, above) = (here - limits.0, limits.1 - here);
        let counts = room.map_or(FREE_COUNTS, |room| room / FAR).min(below.max(above) / FAR);
        let direction = if above >= below { 1.0 } else { -1.0 };
        let registers = PositionRegisters { min, max, ..PositionRegisters::default() };
        (counts >= 2.0 * LEAST_COUNTS).then_some(Self { direction, counts, limits, registers })
    }

    fn run<L: Law>(
        &self,
        guard: &mut Probed<'_, '_, L>,
        (direction, duty): (f64, f64),
        scale: f64,
        d: f64,
        enough: f64,
    ) -> Result<Option<Turned>, Cause> {
        let from = guard.points.last().map_or(0.0, |point| point.counts);
        let target = (from + direction * FAR * self.counts).clamp(self.limits.0, self.limits.1).round();
        let error = direction * (target - from);
        if error < self.counts {
            return Ok(None);
        }
        let p = (duty * QPPS * scale / error).round();
        let registers = PositionRegisters { p: p as u32, d: d as u32, ..self.registers };
        guard.set(McpWrite::PositionLoop(registers))?;
        guard.position(target, QPPS as u32)?;
        let (start_s, first) = (guard.now_s(), guard.points.len());
        let (mut here, mut settled_at, mut readings) = (from, None, 0);
        loop {
            let point = guard.poll(true)?;
            let crept_s = guard.now_s() - start_s;
            // A lost reply says nothing of where it is.
            here = point.map_or(here, |point| point.counts);
            if let Some(point) = point.filter(|_| crept_s > SETTLED_S) {
                settled_at.get_or_insert(point.counts);
                readings += usize::from(point.duty.is_some());
            }
            let came = (here - from).abs();
            let is_told = readings >= LEAST_READINGS
                && settled_at.is_some_and(|settled_at: f64| (here - settled_at).abs() > enough);
            let most_s = match came {
                none if none < 1.0 => UNMOVED_S,
                // One that has hardly moved will tell no more.
                few if few <= LEAST_COUNTS || is_told => CREEP_S,
                _ => LONGEST_CREEP_S,
            };
            if came > self.counts || crept_s > most_s {
                break;
            }
        }
        let seen = guard.points.get(first..).unwrap_or_default().iter();
        let readings: Vec<Point> = seen.filter(|point| point.t > start_s + SETTLED_S).copied().collect();
        let (Some(begin), Some(end)) = (readings.first(), readings.last()) else { return Ok(None) };
        let came = direction * (end.counts - begin.counts);
        let missing = |point: &Point| {
            let by_p = p * direction * (target - point.counts) / (scale * QPPS);
            point.duty.map(|(_, read)| by_p - direction * read)
        };
        let all: Vec<(f64, f64)> =
            readings.iter().filter_map(|point| Some((point.t, missing(point)?))).collect();
        if all.len() < LEAST_READINGS || came < LEAST_COUNTS || end.t <= begin.t {
            return Ok(None);
        }
        let missing_duty = all.iter().map(|reading| reading.1).sum::<f64>() / all.len() as f64;
        let speed = came / (end.t - begin.t);
        let (scatter, speeds) = scatter(&readings, missing, direction * missing_duty / speed);
        let about_trend = deviation(&all).powi(2);
        Ok(Some(Turned { speed, missing_duty, scatter, speeds, about_trend }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finding_near_a_tick_or_a_second_is_that() {
        let law = McpLaw { rate_hz: 625, ..McpLaw::default() };
        assert_eq!(known_derivative_s(0.0014, &law), 0.0016);
        assert_eq!(known_derivative_s(0.0035, &law), 1.0 / 300.0);
        assert_eq!(known_derivative_s(0.0017, &McpLaw { rate_hz: 312, ..law }), 0.0016);
        // Read off the few counts of a coarse encoder; nearer to the tick of another loop.
        assert_eq!(known_derivative_s(0.00232, &law), 0.0016);
        assert_eq!(known_derivative_s(1.3, &law), 1.0);
        assert_eq!(known_derivative_s(0.05, &law), 0.05);
    }

    #[test]
    fn a_filtered_derivative_is_told_by_its_smooth_duty() {
        // 450 counts/s at 300 Hz are one count in a tick or two: the duty of D jumps by one count's.
        let of = |scatter| Turned {
            speed: 450.0,
            missing_duty: 0.015,
            scatter,
            speeds: vec![450.0; 20],
            about_trend: scatter,
        };
        let of_a_count = 0.015 * 300.0 / 450.0_f64;
        let rough = of(0.25 * of_a_count.powi(2)).roughness(300.0).unwrap();
        assert!((rough - 1.0).abs() < 1e-9, "{rough}");
        assert!(of(0.02 * of_a_count.powi(2)).roughness(300.0).unwrap() < FILTERED);
        assert!(of(0.25 * of_a_count.powi(2)).filter(300.0).is_none());
        let whole = Turned { speeds: vec![600.0; 20], ..of(0.0) };
        assert_eq!(whole.roughness(300.0), None, "two counts in every tick tell nothing");
    }

    /// A filter of a tick or some, fed with whole counts: its delay is read off what it leaves of them.
    #[test]
    fn the_filter_of_a_derivative_is_read_off_the_scatter_of_its_duty() {
        for (filter_s, rate_hz, speed) in [
            (0.0032, 625.0, 331.0),
            (0.0108, 625.0, 571.0),
            (0.0026, 300.0, 6_061.0),
            (0.0032, 625.0, 13_421.0),
        ] {
            let share = 1.0 / (1.0 + filter_s * rate_hz);
            let (mut seen, mut last, mut sum, mut squares) = (speed / rate_hz, 0.0, 0.0, 0.0);
            let ticks = 50_000;
            for n in 1..=ticks {
                let count = (f64::from(n) * speed / rate_hz).floor();
                seen += share * (count - last - seen);
                last = count;
                sum += seen;
                squares += seen * seen;
            }
            let mean = sum / f64::from(ticks);
            let counts = squares / f64::from(ticks) - mean * mean;
            let missing_duty = 0.01;
            let of_a_count = missing_duty * rate_hz / speed;
            let scatter = counts * of_a_count.powi(2);
            let turned =
                Turned { speed, missing_duty, scatter, speeds: vec![speed; 28], about_trend: scatter };
            let found = turned.filter(rate_hz).expect("a filter");
            assert!((found.likely_s / filter_s - 1.0).abs() < 0.05, "{filter_s} at {rate_hz} Hz: {found:?}");
            assert!(
                (0.6..0.95).contains(&(found.least_s / filter_s)),
                "{filter_s} at {rate_hz} Hz: {found:?}"
            );
        }
    }

    #[test]
    fn of_two_smooth_duties_the_mean_counts_and_of_others_the_rougher_one() {
        let told = |roughness: f64, likely_s: f64| {
            let filter = DerivativeFilter { likely_s, least_s: 0.5 * likely_s };
            Some(Told { roughness, filter: (roughness < FILTERED).then_some(filter), times: 1 })
        };
        let both = Told::of_both(told(0.02, 0.01), told(1.1, 0.0)).expect("both told");
        assert!(both.filter.is_none() && both.times == 2, "polls in step with the counts: {both:?}");
        let both = Told::of_both(told(0.04, 0.010), told(0.08, 0.006)).expect("both told");
        let filter = both.filter.expect("a filter");
        assert!(
            (filter.likely_s - 0.008).abs() < 1e-12 && (filter.least_s - 0.004).abs() < 1e-12,
            "{both:?}"
        );
        assert!((both.roughness - 0.06).abs() < 1e-12 && both.times == 2, "{both:?}");
        assert_eq!(Told::of_both(told(0.1, 0.01), None).map(|told| told.times), Some(1));
        assert!(Told::of_both(None, None).is_none());
    }

    #[test]
    fn stamps_of_a_busy_computer_do_not_make_a_filtered_derivative_rough() {
        // 13,300 counts/s at 625 Hz, each seventh stamp 1.8 ms late, as a run on a busy computer had one; D sees a smooth speed, or the difference of two ticks.
        let (speed, rate_hz, taken) = (13_300.0, 625.0, 0.012 / 13_300.0);
        let readings = |sees_ticks: bool| -> Vec<Point> {
            let reading = |n: usize| {
                let at = 0.0101 * n as f64;
                let late = if n % 7 == 3 { 0.0018 } else { 0.0003 * (0.618 * n as f64).fract() };
                let tick = (at * rate_hz).floor();
                let ticked = (tick / rate_hz * speed).floor() - ((tick - 1.0) / rate_hz * speed).floor();
                let seen = if sees_ticks { ticked * rate_hz } else { speed };
                // Such a duty as if P gave nothing.
                Point {
                    t: at + late,
                    counts: (at * speed).floor(),
                    duty: Some((at, -taken * seen)),
                    amps: None,
                    volts: None,
                    limited: false,
                }
            };
            (0..30).map(reading).collect()
        };
        let rough = |sees_ticks: bool| {
            let missing = |point: &Point| point.duty.map(|(_, read)| -read);
            let (scatter, speeds) = scatter(&readings(sees_ticks), missing, taken);
            Turned { speed, missing_duty: 0.012, scatter, speeds, about_trend: scatter }
                .roughness(rate_hz)
                .unwrap()
        };
        assert!(rough(true) > 1.5 * FILTERED, "{}", rough(true));
        assert!(rough(false) < FILTERED, "{}", rough(false));
    }

    #[test]
    fn a_creep_keeps_to_limits_and_travel_and_needs_room() {
        let free = Creep::from(0.0, 0.0, None, (0, 0)).unwrap();
        assert_eq!((free.counts, free.direction), (FREE_COUNTS, 1.0));
        let limited = Creep::from(900.0, 100.0, None, (0, 1_100)).unwrap();
        assert_eq!((limited.counts, limited.direction), (1_000.0 / FAR, -1.0));
        let travel = Creep::from(0.0, 0.0, Some(400.0), (0, 0)).unwrap();
        assert_eq!(travel.counts, 50.0);
        assert!(Creep::from(0.0, 0.0, Some(100.0), (0, 0)).is_none());
    }
}
