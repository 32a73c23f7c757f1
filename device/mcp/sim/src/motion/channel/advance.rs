//! One tick of each mode: from the setpoint to what the output stage is asked for.

use super::super::buffer::BUFFER_CAPACITY;
use super::super::output::Demand;
use super::super::pid::{PositionBounds, VelocityStep};
use super::super::ramp::{Rates, stopping_speed};
use super::super::relay::{RelayStep, RelayTest};
use super::super::{
    Conditions, DistanceEnd, FULL_DUTY_RAW, MAX_DUTY_ACCELERATION, MotionSettings, PositionForm, RelayOn,
};
use super::mode::{DistanceRun, FASTEST, Mode, PositionRun};
use super::{Channel, HomeOutcome};

impl Channel {
    /// Advances the running command by one tick.
    pub(super) fn advance(&mut self, conditions: &Conditions, settings: &MotionSettings) -> Demand {
        self.errors.clear_deviations();
        self.finish_and_start_moves(settings);
        match self.mode {
            Mode::Coast => Demand::Coast,
            Mode::Stop => {
                self.advance_duty(0, FASTEST, conditions);
                self.voltage_demand(settings)
            }
            Mode::Duty { goal_raw, rates } => {
                let goal_raw = if conditions.reverse { -goal_raw } else { goal_raw };
                self.advance_duty(goal_raw, rates, conditions);
                self.torque_or_voltage_demand(goal_raw, conditions, settings)
            }
            Mode::Home { goal_raw, rates, ticks_left } => {
                self.advance_homing(goal_raw, rates, ticks_left, conditions);
                self.torque_or_voltage_demand(goal_raw, conditions, settings)
            }
            Mode::Relay(test) => self.advance_relay(test, conditions),
            Mode::Speed { goal, acceleration } => {
                let goal = f64::from(goal);
                let goal = if conditions.reverse { -goal } else { goal };
                self.speed.approach(goal, Rates::both(acceleration));
                self.close_velocity_loop(false, conditions, settings)
            }
            Mode::Distance(run) => {
                self.advance_distance(&run);
                self.close_velocity_loop(false, conditions, settings)
            }
            Mode::Position(run) => {
                self.advance_position(run, settings);
                self.close_velocity_loop(settings.simple_position(), conditions, settings)
            }
        }
    }

    /// Ends the buffered move that is through and starts the one behind it, as many as are through at once.
    fn finish_and_start_moves(&mut self, settings: &MotionSettings) {
        for _ in 0..=BUFFER_CAPACITY {
            if !self.buffered || !self.move_is_through() {
                return;
            }
            let through = self.mode;
            match (self.queue.pop(), through) {
                (Some(next), Mode::Distance(run)) if run.direction() != 0 => {
                    // Counted on from the planned end, so that overruns of less than a tick do not add up.
                    self.start_buffered(next, Some(run.end()), settings);
                }
                (Some(next), _) => {
                    self.start_buffered(next, None, settings);
                }
                (None, Mode::Distance(run)) => {
                    self.buffered = false;
                    self.mode = Mode::Speed { goal: 0, acceleration: run.acceleration };
                }
                (None, _) => self.buffered = false,
            }
        }
    }

    /// Whether the move that executes has ended. Assumed: a distance move ends when its counts are covered, one of speed
    /// 0 when its ramp is down, a position move when its profile is at the target, wherever the motor is.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    fn move_is_through(&self) -> bool {
        match &self.mode {
            Mode::Distance(run) if run.direction() == 0 => self.speed.is_zero(),
            Mode::Distance(run) => run.left(self.encoder.raw_counts()) <= 0,
            Mode::Position(run) => run.profile.is_done(),
            _ => true,
        }
    }

    fn advance_duty(&mut self, goal_raw: i32, rates: Rates, conditions: &Conditions) {
        let goal = if conditions.bars(f64::from(goal_raw)) { 0.0 } else { f64::from(goal_raw) };
        if conditions.bars(self.duty.value()) {
            self.duty.approach(0.0, FASTEST);
        } else {
            self.duty.approach(goal, rates);
        }
        self.zero_ticks = if self.duty.is_zero() && goal == 0.0 { self.zero_ticks + 1 } else { 0 };
    }

    fn advance_homing(&mut self, goal_raw: i32, rates: Rates, ticks_left: u64, conditions: &Conditions) {
        if ticks_left == 0 {
            self.home_outcome = Some(HomeOutcome::TimedOut);
            self.stop();
            self.advance_duty(0, FASTEST, conditions);
        } else {
            self.mode = Mode::Home { goal_raw, rates, ticks_left: ticks_left - 1 };
            self.advance_duty(goal_raw, rates, conditions);
        }
    }

    /// What the ramped duty asks for in torque mode: a current, of which full duty is the maximum (assumed). A limit in the
    /// way brakes the motor, since no current would let it run on.
    fn torque_or_voltage_demand(
        &self,
        goal_raw: i32,
        conditions: &Conditions,
        settings: &MotionSettings,
    ) -> Demand {
        let braking = matches!(self.mode, Mode::Stop) || conditions.bars(f64::from(goal_raw));
        match settings.max_current_amps() {
            Some(max_amps) if settings.torque_mode() && !braking => {
                Demand::Current(self.duty.value() / f64::from(FULL_DUTY_RAW) * max_amps)
            }
            _ => self.voltage_demand(settings),
        }
    }

    /// What the ramped duty asks for as a voltage; an open bridge when idle for long enough.
    fn voltage_demand(&self, settings: &MotionSettings) -> Demand {
        if self.is_idle_for_freewheel(settings) {
            return Demand::Coast;
        }
        Demand::Duty(self.duty.value() / f64::from(FULL_DUTY_RAW))
    }

    fn is_idle_for_freewheel(&self, settings: &MotionSettings) -> bool {
        let delay_ticks = u64::from(settings.pwm_idle_raw & 0x7F) * u64::from(self.law.rate_hz) / 10;
        settings.pwm_idle_raw & 0x80 != 0 && self.zero_ticks > delay_ticks
    }

    fn advance_relay(&mut self, mut test: RelayTest, conditions: &Conditions) -> Demand {
        let measured = match test.on {
            RelayOn::Speed => self.encoder.estimate(&self.law),
            RelayOn::Position => f64::from(self.encoder.register.position()),
        };
        match test.step(measured, self.law.tick_s()) {
            RelayStep::Running(duty) => {
                self.mode = Mode::Relay(test);
                let (lowest, highest) = self.duty_bounds(conditions);
                Demand::Duty(duty.clamp(lowest, highest))
            }
            RelayStep::Done(oscillation) => {
                self.relay_result = Some(oscillation);
                self.stop();
                Demand::Duty(self.duty.value() / f64::from(FULL_DUTY_RAW))
            }
            RelayStep::TimedOut => {
                self.stop();
                Demand::Duty(self.duty.value() / f64::from(FULL_DUTY_RAW))
            }
        }
    }

    fn advance_distance(&mut self, run: &DistanceRun) {
        let rates = Rates::both(run.acceleration);
        let speed = f64::from(run.speed);
        let carry_on = self.law.distance_end == DistanceEnd::CarryOn && !self.queue.is_empty();
        if carry_on || run.direction() == 0 {
            self.speed.approach(speed, rates);
            return;
        }
        let stop = run.stopping_speed(self.encoder.raw_counts(), self.law.tick_s());
        self.speed.approach(speed.clamp(-stop, stop), rates);
        if self.speed.value() * speed > 0.0 {
            self.speed.limit_magnitude(stop);
        }
    }

    fn advance_position(&mut self, mut run: PositionRun, settings: &MotionSettings) {
        let tick_s = self.law.tick_s();
        let moving = !run.profile.is_done();
        run.profile.step(tick_s);
        self.mode = Mode::Position(run);
        let position = f64::from(self.encoder.register.position());
        let to_target = run.profile.target() - position;
        let to_profile = run.profile.position() - position;
        self.note_position_error(if run.is_ramped() { to_profile } else { to_target }, &run, settings);

        let bounds = PositionBounds {
            deadzone: f64::from(settings.position_deadzone_counts),
            max_integral: f64::from(settings.position_max_i),
        };
        let gains = settings.position_gains(&self.law);
        let tracking = self.law.position_form == PositionForm::ProfileTracking;
        let error = if tracking { to_profile } else { to_target };
        let wanted = self.position.step(error, position, &gains, bounds, &self.law);
        if tracking {
            self.speed.set(run.profile.speed() + wanted);
            return;
        }
        let stop = match run.limits.deceleration {
            Some(_) if moving => stopping_speed(to_target.abs(), run.limits.deceleration, tick_s),
            _ => f64::INFINITY,
        };
        let limit = run.limits.speed.min(stop);
        let rates = if moving { run.rates } else { Rates::AT_ONCE };
        self.speed.approach(wanted.clamp(-limit, limit), rates);
    }

    fn note_position_error(&mut self, error: f64, run: &PositionRun, settings: &MotionSettings) {
        self.errors.position_counts = error.round() as i32;
        let limit = f64::from(settings.position_error_limit);
        self.errors.position_exceeded |= limit > 0.0 && run.is_ramped() && error.abs() > limit;
    }

    /// Duty from the speed setpoint. `simple` gives the setpoint's share of QPPS and nothing else (MCP manual 2.4.7).
    fn close_velocity_loop(
        &mut self,
        simple: bool,
        conditions: &Conditions,
        settings: &MotionSettings,
    ) -> Demand {
        if conditions.bars(self.speed.value()) {
            self.speed.set(0.0);
            return self.brake_at_limit();
        }
        let setpoint = self.speed.value();
        let measured = self.encoder.estimate(&self.law);
        self.note_speed_error(setpoint - measured, settings);
        let bounds = self.duty_bounds(conditions);
        let duty = if simple {
            self.velocity.reset();
            let qpps = f64::from(settings.qpps);
            if qpps > 0.0 { (setpoint / qpps).clamp(bounds.0, bounds.1) } else { 0.0 }
        } else {
            let gains = settings.velocity_gains();
            self.velocity
                .step(&VelocityStep { setpoint, measured, gains, qpps: settings.qpps, bounds }, &self.law)
        };
        Demand::Duty(duty)
    }

    fn note_speed_error(&mut self, error: f64, settings: &MotionSettings) {
        self.errors.speed_counts_per_s = error.round() as i32;
        let limit = f64::from(settings.speed_error_limit);
        self.errors.speed_exceeded |= limit > 0.0 && self.mode.is_ramped() && error.abs() > limit;
    }

    /// Duty to 0 at the highest rate, and there it stays: a loop that goes on would creep about the limit.
    fn brake_at_limit(&mut self) -> Demand {
        self.velocity.reset();
        let applied = self.stage.output().duty();
        let step = self.fastest_duty_step();
        Demand::Duty(applied - applied.clamp(-step, step))
    }

    fn fastest_duty_step(&self) -> f64 {
        f64::from(MAX_DUTY_ACCELERATION) / f64::from(FULL_DUTY_RAW) * self.law.tick_s()
    }

    /// What the current limit and the travel limits leave, lowest and highest duty. A limit in the way of a running
    /// motor takes its duty to 0 at the highest rate.
    fn duty_bounds(&self, conditions: &Conditions) -> (f64, f64) {
        let (mut lowest, mut highest) = self.stage.bounds();
        let applied = self.stage.output().duty();
        let step = self.fastest_duty_step();
        if conditions.forward_limit {
            highest = highest.min((applied - step).max(0.0));
        }
        if conditions.backward_limit {
            lowest = lowest.max((applied + step).min(0.0));
        }
        lowest = lowest.min(highest);
        (lowest, highest)
    }
}
