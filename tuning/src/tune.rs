//! A whole tuning run: probe, experiment, fit, design, verification on the machine, and the way back when anything is wrong.

use crate::alternatives::{proposed, seen};
use crate::axis::EncoderClass;
use crate::backlash::with_backlash;
use crate::cause::Cause;
use crate::closed_loop_record::Stretch;
use crate::design::{Goal, Task, design_velocity};
use crate::experiment::{
    Probe, WINDOW, go_to, rest, run_free, run_own_position_test, run_own_test, run_position_relay, run_probe,
    run_relay, run_step, run_window,
};
use crate::experiment_guard::{ExperimentGuard, GuardOptions};
use crate::fit::{Fit, fit};
use crate::lag::{Asked, LagFit};
use crate::law::Law;
use crate::law_probe::LawProbe;
use crate::linear::{DiscretePlant, LoopPlant};
use crate::model::{DerivativeFilter, Gains, Lag, Pid, PlantModel};
use crate::moves::by_moves;
use crate::open_loop_record::OpenLoopRecord;
pub use crate::proposal::{design_for, propose};
use crate::record::{Entry, Recorder};
use crate::report::{FORMAT, Report, Verdict};
pub use crate::request::{Excitation, Identification, MIDDLE_DUTY, Method, Request};
use crate::rules::Classic;
use crate::score::POSITION_OVERSHOOT;
use crate::setup::{LoopAxis, Setup};
use crate::thresholds::thresholds;
use crate::verify::{check_moves, measure_lag, stays_put};
use crate::winding::winding_of;
use crate::windup::windup_of;

thresholds! {
    /// When a fit is doubted, repeated or refused, and how a run goes on then.
    TUNE: Thresholds {
        /// Highest reduced chi-square of a fit that is believed.
        worst_chi_square: f64 = 12.0,
        /// Loosest time constant of a fit that is believed, as the standard deviation of its logarithm, of a motor slower than four polls.
        loosest_tau: f64 = 0.5,
        /// How often in a second a loop of unknown rate may compute, in Hz: a count in a shorter tick makes more duty.
        highest_rate_hz: f64 = 1_000.0,
        /// Duty by which a load is above the friction before it is called heavy, as a share of full.
        surely_heavy: f64 = 0.005,
        /// Misfit of the closed loop (reduced chi-square) beyond which the model is taken as incomplete.
        odd_chi_square: f64 = 1.5,
        /// What is then left of the excess of the goal's sensitivity over 1, as a share: how far such a loop goes is heard by raising its gains. With 0.6 PIV loops of four springy arms of a
        /// foreign controller had a J of 2.8 to 10 where it is 2.1 to 8.8, and 2,000 own loops of both families are as good with either.
        odd_share: f64 = 0.8,
        /// Overshoot that is then designed for, as a share of the step.
        short_overshoot: f64 = 0.15,
        /// Misfit of the closed loop (reduced chi-square) that speaks of backlash.
        loose_chi_square: f64 = 1.6,
        /// Shortest integral time of such a machine, in time constants of the motor. Springy arms of another make's population, whose encoder is on the motor, are among them too: with 1.2
        /// their integral was a third of the best, with 0.7 the cost of fourteen is 1.6 in the median where it was 1.9.
        loose_integral: f64 = 0.7,
        /// Share of the travel window that has to be free around the axis.
        enough_room: f64 = 0.8,
        /// Narrowest travel window, in counts.
        least_width_counts: f64 = 24.0,
        /// Lowest and highest reading of an absolute encoder that is used, in counts: 0 to 4095 but for a little at both ends (MCP manual 2.4.3).
        absolute_range: (i64, i64) = (40, 4_055),
        /// Standard deviation of a count that is rounded and nothing else, in counts.
        rounded_counts: f64 = 0.289,
        /// Maximum sensitivity (Ms) of the loop by which the lag is measured, on the lag that is usual.
        careful_ms: f64 = 1.4,
        /// Cost of the loop on the position that keeps its distance from the longest likely lag, as a multiple of that of the one that trusts the likeliest, above which the lag is measured again with
        /// firmer gains: a quarter of 400 runs of PD and of PIV (seeds 7 and 11). Measured again always, they are no better for the two seconds that the others take longer.
        worth_more: f64 = 1.15,
        /// Width of a lag's interval beyond which the lag counts as unknown, in seconds.
        widest_lag_s: f64 = 0.012,
    }
}

/// Runs it. The motor stands and the old gains are in force when it returns, unless the request keeps the new ones.
pub fn tune<L: LawProbe>(axis: &mut dyn LoopAxis<L>, request: &Request<L>) -> Report<L> {
    tune_watched(axis, request, &mut |_| {})
}

/// The same, showing `look` what passes between tuner and axis while it goes on.
pub fn tune_watched<L: LawProbe>(
    axis: &mut dyn LoopAxis<L>,
    request: &Request<L>,
    look: &mut dyn FnMut(&Entry<L>),
) -> Report<L> {
    let mut recorder = Recorder::new(axis, look);
    let mut report = blank(request);
    let outcome = match ExperimentGuard::new(&mut recorder, request.guard) {
        Err(cause) => Err(cause),
        Ok(mut guard) => {
            report.before = Some(guard.setup);
            let request = &confined(request, &guard.setup);
            report.request = *request;
            guard.options = request.guard;
            let outcome = run(&mut guard, request, &mut report).map_err(|cause| guard.concluded(cause));
            let keep = outcome.is_ok() && request.keep;
            if keep && let Err(cause) = guard.keep(report.proposed) {
                report.causes.push(cause);
            }
            if outcome.is_err_and(|cause| guard.leave_off(cause)) {
                report.causes.push(Cause::LoopOff);
            }
            report.seconds.1 = guard.now_s();
            guard.finish(keep);
            outcome
        }
    };
    if let Err(cause) = outcome {
        report.causes.insert(0, cause);
        report.verdict = Verdict::Refused;
        report.proposed = L::Registers::default();
    } else if !report.causes.is_empty() {
        report.verdict = Verdict::TunedWithWarnings;
    }
    report.record = recorder.into_entries();
    report
}

/// An absolute encoder has a range, and what lies beyond its ends is not known: the axis stays within it, whatever was asked for. One
/// that wraps stays off its seam, where the controller's own speed jumps.
fn confined<L: Law>(request: &Request<L>, setup: &Setup<L>) -> Request<L> {
    if setup.encoder == EncoderClass::Quadrature {
        return *request;
    }
    let held = L::position_limits(&setup.held).filter(|held| held.0 < held.1).unwrap_or(TUNE.absolute_range);
    let (low, high) = request.guard.travel.unwrap_or(held);
    let (low, high) = (low.max(TUNE.absolute_range.0), high.min(TUNE.absolute_range.1));
    let width = ((high - low) as f64).max(0.0);
    let width = match request.excitation {
        Excitation::Free => width,
        Excitation::Window(wanted) => width.min(wanted),
    };
    let guard = GuardOptions { travel: Some((low, high)), ..request.guard };
    Request { excitation: Excitation::Window(width), guard, ..*request }
}

fn blank<L: Law>(request: &Request<L>) -> Report<L> {
    Report {
        format: FORMAT,
        request: *request,
        verdict: Verdict::Tuned,
        causes: Vec::new(),
        before: None,
        probe: None,
        free: None,
        window: None,
        step: None,
        relay: None,
        position_relay: None,
        own_test: None,
        own_position_test: None,
        classic: None,
        fit: None,
        qpps: None,
        law: None,
        winding: None,
        winding_unknown: None,
        free_limits: None,
        backlash: None,
        lag: None,
        task: None,
        design: None,
        measured: None,
        proposed: L::Registers::default(),
        seconds: (0.0, 0.0),
        record: Vec::new(),
    }
}

fn run<L: LawProbe>(
    guard: &mut ExperimentGuard<'_, L>,
    request: &Request<L>,
    report: &mut Report<L>,
) -> Result<(), Cause> {
    let request = &of_unit(guard, request, report)?;
    if request.identification == Identification::Controller {
        // A controller that has no such test, or may not be asked for it, says so before anything moves.
        guard.own_test()?;
    }
    if !guard.facts.has_duty {
        // Its loop has the motor all the time and each place comes with its time, so that a late answer says no less.
        return by_moves(guard, request, report);
    }
    if request.method == Method::Velocity && guard.setup.encoder == EncoderClass::AbsoluteWrapping {
        return Err(Cause::WrappingEncoder);
    }
    let is_tested = match request.method {
        Method::Velocity => request.excitation == Excitation::Free,
        Method::Pd | Method::Pid => true,
        Method::Piv => false,
    };
    if request.identification == Identification::Controller && !is_tested {
        return Err(Cause::OnlyFree);
    }
    let mark = |report: &mut Report<L>, cause| report.causes.push(cause);
    let (probe, found) =
        guard.stretch(true, report, mark, |guard, report| identify(guard, request, report))?;
    guard.stretch(false, report, mark, |guard, report| design(guard, request, &probe, &found, report))
}

/// The motor, from a little duty on.
fn identify<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    request: &Request<L>,
    report: &mut Report<L>,
) -> Result<(Probe, Found), Cause> {
    guard.progress("Checking the wiring with a little duty");
    let probe = run_probe(guard, 1.0)?;
    guard.progress("Measuring the motor");
    report.probe = Some(probe);
    let found = match request.excitation {
        Excitation::Free => match request.identification {
            Identification::Fit | Identification::Controller => identify_free(guard, &probe, report)?,
            Identification::Step => {
                let run = run_step(guard, &probe, request.about_duty, request.method != Method::Velocity)?;
                report.step = Some(run);
                let tau_s = 0.5 * (run.taus_s.0 + run.taus_s.1);
                identify_part(guard, &probe, run.from_s, (run.gain_counts_per_s.0, tau_s))?
            }
            Identification::Relay if request.method != Method::Velocity => {
                identify_about(guard, &probe, None, report)?
            }
            Identification::Relay => {
                let run = run_relay(guard, &probe, request.about_duty)?;
                report.relay = Some(run);
                identify_part(guard, &probe, run.from_s, (run.static_gain.0, run.period_s.0))?
            }
        },
        Excitation::Window(width) => {
            let width = usable_width(guard, &probe, width)?;
            match request.identification {
                Identification::Fit | Identification::Controller => {
                    identify_window(guard, &probe, (width, None), report)?
                }
                Identification::Step => {
                    identify_window(guard, &probe, (width, Some(request.about_duty)), report)?
                }
                Identification::Relay => identify_about(guard, &probe, Some(width), report)?,
            }
        }
    };
    let model = found.fit.model;
    guard.monitor.know(&model);
    guard.monitor.ramp = Some(found.fit.ramp);
    // A relay switches long before the motor has the speed of its duty.
    guard.monitor.full_speed = guard.monitor.full_speed.max(found.qpps);
    report.fit = Some(found.fit);
    report.qpps = Some(found.qpps);
    if model.load_duty.abs() > model.coulomb_duty + TUNE.surely_heavy {
        report.causes.push(Cause::HeavyLoad);
    }
    report.seconds.0 = guard.now_s();
    match winding_of(&guard.points, &guard.drives) {
        Ok(winding) => report.winding = Some(winding),
        Err(why) => report.winding_unknown = Some(why),
    }
    if request.identification == Identification::Controller {
        guard.progress("The controller tests its loop itself");
        if request.method == Method::Velocity {
            report.own_test = Some(run_own_test(guard, &probe, request.about_duty)?);
        } else {
            if let Excitation::Window(width) = request.excitation {
                usable_width(guard, &probe, width)?;
            }
            report.own_position_test = Some(run_own_position_test(guard, &probe)?);
        }
    }
    Ok((probe, found))
}

/// The loop, from its law to gains that were tried.
fn design<L: LawProbe>(
    guard: &mut ExperimentGuard<'_, L>,
    request: &Request<L>,
    probe: &Probe,
    found: &Found,
    report: &mut Report<L>,
) -> Result<(), Cause> {
    let request = &with_law(guard, request, probe, found, report)?;
    let task = Task {
        worst_lag: if request.excitation == Excitation::Free {
            guard.facts.usual_lag
        } else {
            guard.facts.longest_lag
        },
        goal: Goal::of_level(request.level),
        sd_coulomb_duty: found.fit.sd_coulomb,
        noise_factor: (probe.noise_counts / TUNE.rounded_counts).max(1.0),
        ..Task::new(found.fit.model, request.law, guard.facts.usual_lag, found.qpps)
    };
    guard.progress("Measuring the lag of the loop");
    let task = settle_lag(guard, request, task, report)?;
    let request = &Request { law: task.law, ..*request };
    let task = with_known_filter(request, report, task);
    let task = if request.method == Method::Pid {
        with_backlash(guard, request, task, probe, report)?
    } else {
        task
    };
    report.task = Some(task);
    let design = match request.identification {
        Identification::Fit => design_for(request.method, &task).ok_or(Cause::TooCoarse)?,
        Identification::Step | Identification::Relay | Identification::Controller => {
            report.classic = Some(seen(report, &task));
            let (design, is_lowered) = proposed(report, &task).ok_or(Cause::RuleUnstable)?;
            report.causes.extend(is_lowered.then_some(Cause::RuleLowered));
            design
        }
    };
    propose(report, request, &task, design, guard.proposed_travel(task.qpps));
    if request.verify {
        guard.progress("Trying the gains on the machine");
        check_moves(guard, request, &task, report)?;
    }
    Ok(())
}

/// The request with the law of this controller.
fn of_unit<L: Law>(
    guard: &ExperimentGuard<'_, L>,
    request: &Request<L>,
    report: &mut Report<L>,
) -> Result<Request<L>, Cause> {
    let method = match request.method {
        Method::Piv if guard.facts.has_cascade => Method::Piv,
        // An integral is what a cascade would have been asked for.
        Method::Piv if request.or_pid => Method::Pid,
        Method::Piv => return Err(Cause::NoSuchLoop),
        Method::Velocity | Method::Pd | Method::Pid => request.method,
    };
    let law = request.law.of_unit(&guard.setup.held);
    (report.request.law, report.request.method) = (law, method);
    Ok(Request { law, method, ..*request })
}

/// The width that fits into the travel window around where the axis stands; from near an end it goes to the middle first.
fn usable_width<L: Law>(guard: &mut ExperimentGuard<'_, L>, probe: &Probe, width: f64) -> Result<f64, Cause> {
    let Some((low, high)) = guard.travel_counts() else { return Ok(width) };
    if guard.room_counts().is_some_and(|room| room < TUNE.enough_room * (high - low)) {
        guard.progress("Going to the middle of the travel");
        go_to(guard, probe, 0.5 * (low + high))?;
    }
    let room = guard.room_counts().unwrap_or(0.0).min(width);
    if room < TUNE.least_width_counts { Err(Cause::NarrowTravel) } else { Ok(room) }
}

/// The request with the law that the controller follows. A run that may not move by loops keeps the law that it was given.
fn with_law<L: LawProbe>(
    guard: &mut ExperimentGuard<'_, L>,
    request: &Request<L>,
    probe: &Probe,
    found: &Found,
    report: &mut Report<L>,
) -> Result<Request<L>, Cause> {
    if !guard.facts.can_be_probed {
        // The manual says this law; what depends on the motor is what it adds to the gains.
        let law = request.law.of_motor(found.qpps, guard.max_current_raw());
        report.request.law = law;
        return Ok(Request { law, ..*request });
    }
    if !request.probe_law || !request.verify {
        return Ok(*request);
    }
    guard.progress("Finding out the law of the loop");
    rest(guard, found.fit.model.tau_s, found.qpps)?;
    let position = request.method != Method::Velocity;
    let held = guard.setup.held;
    let found = L::probe(guard, &held, &|write| write, probe.start_duty, request.method)?;
    let Some(findings) = found else {
        report.causes.push(Cause::LawAssumed);
        return Ok(*request);
    };
    report.law = Some(findings);
    let law = request.law.found(&findings, position).ok_or_else(|| L::why_not_found(&findings))?;
    if !L::is_rate_known(&findings) {
        report.causes.push(Cause::RateUnknown);
        guard.rate_doubt = (TUNE.highest_rate_hz / f64::from(law.rate_hz())).max(1.0);
    }
    if matches!(request.method, Method::Pd | Method::Pid) && !L::is_derivative_known(&findings) {
        report.causes.push(Cause::DerivativeUnknown);
    }
    report.request.law = law;
    guard.law = law;
    Ok(Request { law, ..*request })
}

/// What identification gives.
struct Found {
    fit: Fit,
    qpps: f64,
}

fn identify_free<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    probe: &Probe,
    report: &mut Report<L>,
) -> Result<Found, Cause> {
    let run = run_free(guard, probe)?;
    report.free = Some(run);
    report.classic = Classic::of(&guard.points, &guard.drives, &run);
    let full = 0.5 * (run.full_speeds.0 + run.full_speeds.1);
    if (run.full_speeds.0 - run.full_speeds.1).abs() > 0.05 * full {
        report.causes.push(Cause::Asymmetric);
    }
    let found = fitted(guard, probe, run.from_s, (full / run.full_duty, run.tau_s))?;
    // With less than full duty the model says what full duty would give.
    let qpps = if run.full_duty > 0.999 {
        full
    } else {
        full + found.model.gain_counts_per_s * (1.0 - run.full_duty)
    };
    Ok(Found { fit: found, qpps })
}

/// The model of a step or a relay, by which its gains are tried; full duty was not given, so that the model says its speed.
fn identify_part<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    probe: &Probe,
    from_s: f64,
    start: (f64, f64),
) -> Result<Found, Cause> {
    let found = fitted(guard, probe, from_s, start)?;
    let qpps = found.model.gain_counts_per_s * (1.0 - found.model.coulomb_duty);
    Ok(Found { fit: found, qpps })
}

fn identify_window<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    probe: &Probe,
    (width, about_duty): (f64, Option<f64>),
    report: &mut Report<L>,
) -> Result<Found, Cause> {
    let middle = guard.points.last().map_or(0.0, |point| point.counts);
    let mut oscillate = |guard: &mut ExperimentGuard<'_, L>, share: f64| {
        let run = run_window(guard, probe, width, (about_duty, share))?;
        report.window = Some(run);
        identify_to_and_fro(guard, probe, run.from_s, run.top_speed / (probe.start_duty + 0.4 * share))
    };
    match oscillate(guard, 1.0) {
        // A flywheel that hardly gathers speed in a narrow travel, for one: less duty asks for less current.
        Err(Cause::CurrentLimited) if about_duty.is_none() => {
            go_to(guard, probe, middle)?;
            oscillate(guard, WINDOW.gentler)
        }
        found => found,
    }
}

/// A relay about where the axis stands, inside `width` counts where there is one.
fn identify_about<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    probe: &Probe,
    width: Option<f64>,
    report: &mut Report<L>,
) -> Result<Found, Cause> {
    let run = run_position_relay(guard, probe, width)?;
    report.position_relay = Some(run);
    // A relay switches before the motor has gathered the speed of its duty.
    identify_to_and_fro(guard, probe, run.from_s, 2.0 * run.top_speed / run.duties.1)
}

/// The model of what went to and fro.
fn identify_to_and_fro<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    probe: &Probe,
    from_s: f64,
    start: f64,
) -> Result<Found, Cause> {
    let found = fitted(guard, probe, from_s, (start, 0.06))?;
    let qpps = found.model.gain_counts_per_s * (1.0 - found.model.coulomb_duty);
    Ok(Found { fit: found, qpps })
}

/// The fit, from start values of gain and time constant, of all that was polled since a time.
fn fitted<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    probe: &Probe,
    from_s: f64,
    (gain, tau_s): (f64, f64),
) -> Result<Fit, Cause> {
    let now_s = guard.now_s();
    let record = OpenLoopRecord::new(&guard.points, &guard.drives, from_s, now_s, probe.volts);
    let record = OpenLoopRecord { actuation: guard.actuation(), ..record };
    let limit = guard.drive_limit(probe.stall_amps);
    let found = fit(&record, gain, tau_s, limit, brake_share(guard)).ok_or(Cause::TooCoarse)?;
    believe(&found, guard.options.poll_s, &record)?;
    Ok(found)
}

/// The current limit for braking over that for driving.
fn brake_share<L: Law>(guard: &ExperimentGuard<'_, L>) -> f64 {
    let (drive, brake) =
        (f64::from(guard.setup.max_current_raw), f64::from(guard.setup.min_current_raw).abs());
    if drive > 0.0 && brake > 0.0 { brake / drive } else { 1.0 }
}

fn believe(fit: &Fit, poll_s: f64, record: &OpenLoopRecord) -> Result<(), Cause> {
    if record.limited_share() > 0.5 {
        return Err(Cause::CurrentLimited);
    }
    if fit.chi_square > TUNE.worst_chi_square {
        return Err(Cause::PoorFit);
    }
    if fit.sd_ln_tau > TUNE.loosest_tau && fit.model.tau_s > 4.0 * poll_s {
        return Err(Cause::TooCoarse);
    }
    Ok(())
}

/// Measures the lag with a careful velocity loop where the axis may turn freely.
fn settle_lag<L: Law>(
    guard: &mut ExperimentGuard<'_, L>,
    request: &Request<L>,
    mut task: Task<L>,
    report: &mut Report<L>,
) -> Result<Task<L>, Cause> {
    if !request.verify || !stays_put(&task, request.excitation) {
        return Ok(task);
    }
    let careful = unfiltered(Task { goal: Goal { ms: TUNE.careful_ms, ..task.goal }, ..task });
    let Some(design) = design_velocity(&careful) else { return Ok(task) };
    let registers = guard.write_gains(&task.law, &design.gains, task.qpps)?;
    let gains = task.law.gains(&registers, task.qpps, false);
    let sd_ln_tau = report.fit.map_or(0.1, |fit| fit.sd_ln_tau);
    let asked = Asked {
        filter: request.method != Method::Velocity,
        law: request.probe_law && guard.facts.can_be_probed,
        integral: matches!(request.method, Method::Velocity | Method::Piv),
    };
    let mut stretches = Vec::new();
    let by = (request.excitation, asked);
    let measured = match measure_lag(guard, &careful, &gains, sd_ln_tau, by, &mut stretches) {
        // Too little room for strokes.
        Err(Cause::TravelLimit) if request.excitation != Excitation::Free => {
            guard.come_to_rest()?;
            None
        }
        measured => measured?,
    };
    let Some(mut found) = measured else {
        report.causes.push(Cause::LagUnknown);
        return Ok(task);
    };
    task.law = with_sum(task.law, &found, &mut stretches);
    report.lag = Some(found);
    guard.law = task.law;
    if let Some(firmer) = worth_more(request, report, &task, &found) {
        guard.progress("Measuring the lag again with firmer gains");
        rest(guard, task.plant.tau_s, task.qpps)?;
        let registers = guard.write_gains(&task.law, &firmer, task.qpps)?;
        let gains = task.law.gains(&registers, task.qpps, false);
        let knowing = Task { lag: found.lag, worst_lag: found.worst, ..task };
        if let Some(closer) = measure_lag(guard, &knowing, &gains, sd_ln_tau, by, &mut stretches)? {
            task.law = with_sum(task.law, &closer, &mut stretches);
            found = LagFit {
                has_other_sum: found.has_other_sum != closer.has_other_sum,
                // What the model did not explain is not explained by more of what it does.
                chi_square: found.chi_square.max(closer.chi_square),
                ..closer
            };
        }
    }
    if asked.law {
        let may_start = asked.integral && request.excitation == Excitation::Free;
        found.windup = windup_of(guard, &task, &found, (&stretches, may_start))?;
        task.law = task.law.with_windup(found.windup).unwrap_or(task.law);
    }
    report.lag = Some(found);
    guard.law = task.law;
    report.request.law = task.law;
    Ok(with_lag(task, &found))
}

/// The law with the sum that was found, under which the gains of what was polled are others.
fn with_sum<L: Law>(law: L, found: &LagFit, stretches: &mut [Stretch]) -> L {
    if !found.has_other_sum {
        return law;
    }
    let mut other = law;
    for stretch in stretches {
        if let Some((with_it, gains)) = law.with_other_sum(&stretch.gains) {
            (other, stretch.gains) = (with_it, gains);
        }
    }
    other
}

/// Gains of a velocity loop that show the lag better than careful ones, where a loop on the position that kept its distance from a longer lag alone would be so much slower that
/// this is worth the time.
fn worth_more<L: Law>(
    request: &Request<L>,
    report: &Report<L>,
    task: &Task<L>,
    found: &LagFit,
) -> Option<Gains> {
    // What a rule gives does not go by the longest lag.
    let is_designed = request.identification == Identification::Fit && request.method != Method::Velocity;
    if !is_designed || request.excitation != Excitation::Free {
        return None;
    }
    let task = with_lag(*task, found);
    let whole = with_known_filter(request, report, task);
    let cost = |task: &Task<L>| Some(design_for(request.method, task)?.score.cost(POSITION_OVERSHOOT));
    let likely = cost(&Task { worst_lag: whole.lag, ..whole })?;
    if cost(&whole).is_some_and(|cost| cost <= TUNE.worth_more * likely) {
        return None;
    }
    design_velocity(&task).map(|design| design.gains)
}

/// The task of a loop that stays quiet where the controller filters nothing: one count must not throw its duty to and fro, which would tell nothing of the lag.
fn unfiltered<L: Law>(task: Task<L>) -> Task<L> {
    let of = |lag: Lag| LoopPlant::new(DiscretePlant::of(&task.plant, task.law.tick_s()), &task.law, lag);
    let proportional = Gains { velocity: Pid { p: 1.0, i: 0.0, d: 0.0 }, ..Gains::default() };
    let noise = |lag| of(lag).margins(&proportional, task.qpps).noise_duty;
    let louder = noise(Lag { filter_s: 0.0, ..task.lag }) / noise(task.lag).max(f64::MIN_POSITIVE);
    Task { noise_factor: task.noise_factor * louder.max(1.0), ..task }
}

/// The task of a loop on the position: its speed alone meets a filter, all of it meets a delay. As far as the record does not tell them apart, it is a delay at the
/// worst. How smooth the duty of a derivative is tells its filter by itself.
fn with_known_filter<L: Law>(request: &Request<L>, report: &Report<L>, task: Task<L>) -> Task<L> {
    let tick_s = task.law.tick_s();
    let has_derivative = matches!(request.method, Method::Pd | Method::Pid);
    // The velocity loop's duty tells how loud it is beside a filter that was fitted, a derivative's own duty tells it by itself.
    let own_noise = report.law.as_ref().filter(|_| has_derivative).and_then(L::derivative_noise);
    let task = Task { noise_factor: own_noise.unwrap_or(task.noise_factor), ..task };
    if let Some(seen) = task.law.derivative_filter().filter(|_| has_derivative) {
        // Longer than all that the loop loses it is none: polls in step with the counts make a duty smooth.
        let is_longer = report.lag.is_some_and(|lag| seen.least_s > lag.interval_s.1);
        let seen = if is_longer { DerivativeFilter::UNKNOWN } else { seen };
        // A lag that was not measured is no shorter than the filter that was.
        let least_s = if report.lag.is_some() { 0.0 } else { seen.likely_s };
        let split = |lag: Lag, filter_s: f64| {
            Lag { filter_s: lag.filter_s.max(least_s), ..lag }.with_filter(filter_s, tick_s)
        };
        let (lag, worst_lag) = (split(task.lag, seen.likely_s), split(task.worst_lag, seen.least_s));
        return Task { lag, worst_lag, ..task };
    }
    match report.lag.and_then(|lag| lag.least_filter_s) {
        Some(least_s) => Task { worst_lag: task.worst_lag.with_filter(least_s, tick_s), ..task },
        None => task,
    }
}

fn with_lag<L: Law>(task: Task<L>, found: &LagFit) -> Task<L> {
    let task = Task { noise_factor: found.loudness, ..task };
    let plant = PlantModel { tau_s: task.plant.tau_s * found.tau_scale, ..task.plant };
    let facts = task.law.facts();
    // The winding is measured with the rest. A springy shaft is found by raising the gains on the machine; where they cannot be raised, there has to be
    // room for it.
    let tick_s = task.law.tick_s();
    let unmodelled_s = if facts.has_duty { 0.0 } else { facts.unmodelled_s };
    let worst_lag = Lag { delay_ticks: found.worst.delay_ticks + unmodelled_s / tick_s, ..found.worst };
    // A record that says little leaves what such a controller may have.
    let longest = facts.longest_lag;
    let is_wide = found.interval_s.1 - found.interval_s.0 > TUNE.widest_lag_s;
    let is_within = found.lag.total_s(tick_s) < longest.total_s(tick_s);
    let worst_lag = if is_wide && is_within && worst_lag.total_s(tick_s) > longest.total_s(tick_s) {
        longest
    } else {
        worst_lag
    };
    let (mut goal, mut least_integral_s, mut most_overshoot) = (task.goal, 0.0, task.most_overshoot);
    if found.chi_square > TUNE.odd_chi_square {
        // Something oscillates or has backlash that the model knows nothing of: keep more distance.
        goal.ms = 1.0 + TUNE.odd_share * (goal.ms - 1.0);
        most_overshoot = TUNE.short_overshoot;
    }
    if found.chi_square > TUNE.loose_chi_square {
        least_integral_s = TUNE.loose_integral * plant.tau_s;
    }
    Task { plant, lag: found.lag, worst_lag, goal, least_integral_s, most_overshoot, ..task }
}
