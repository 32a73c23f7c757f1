//! What the axis is commanded, and the registers that are written.

use super::{ExperimentGuard, cause_of, retried};
use crate::axis::{AxisError, FULL_DUTY_RAW, TestedLoop, Want};
use crate::cause::Cause;
use crate::gains::Gains;
use crate::law::Law;
use crate::poll::{Drive, Input};
use crate::setup::LoopAxis;

impl<L: Law> ExperimentGuard<'_, L> {
    /// A controller whose registers are written at rest first has all of them written where it is given another kind of command, or has
    /// had no duty.
    fn pause_for(&mut self, input: Input) {
        let kind = |input: &Input| std::mem::discriminant(input);
        let is_another = self
            .drives
            .last()
            .is_none_or(|last| last.input == Input::Duty(0.0) || kind(&last.input) != kind(&input));
        // A move of an axis without duty is several commands: its pace, whether it may, and where to.
        if (self.facts.writes_at_rest && is_another) || !self.facts.has_duty {
            self.pause();
        }
    }

    /// Drives at a duty, cut to the highest allowed.
    pub fn duty(&mut self, duty: f64) -> Result<(), Cause> {
        let duty = duty.clamp(-self.options.max_duty, self.options.max_duty);
        let raw = (duty * f64::from(FULL_DUTY_RAW)).round() as i16;
        self.pause_for(Input::Duty(duty));
        let exchange = self.acknowledged(|axis| axis.drive_duty(raw))?;
        self.pace.answered(&exchange);
        let t = exchange.middle_s() - self.epoch_s;
        self.drives.push(Drive { t, input: Input::Duty(f64::from(raw) / f64::from(FULL_DUTY_RAW)) });
        let took_s = exchange.received.saturating_sub(exchange.sent).as_secs_f64();
        self.monitor.doubt_s = 0.5 * self.usual_exchange_s().map_or(0.0, |usual| (took_s - usual).max(0.0));
        self.monitor.drive(t, duty);
        Ok(())
    }

    /// Commands a speed in counts/s.
    pub fn speed(&mut self, counts_per_s: f64) -> Result<(), Cause> {
        let whole = self.whole_speed(counts_per_s) as i32;
        self.pause_for(Input::Speed(counts_per_s));
        let first_s = self.now_s();
        let exchange = self.acknowledged(|axis| axis.command_speed(whole))?;
        self.pace.answered(&exchange);
        let t = exchange.middle_s() - self.epoch_s;
        self.drives.push(Drive { t, input: Input::Speed(f64::from(whole)) });
        self.monitor.release((first_s, t), self.law.tick_s());
        Ok(())
    }

    /// The nearest speed that can be commanded, counts/s.
    #[must_use]
    pub fn whole_speed(&self, counts_per_s: f64) -> f64 {
        let step = self.speed_step();
        (counts_per_s / step).round() * step
    }

    /// The step of a speed command, counts/s.
    #[must_use]
    pub fn speed_step(&self) -> f64 {
        self.facts.speed_step
    }

    /// Commands a position in counts from the start of the run.
    pub fn position(&mut self, counts: f64, speed: u32) -> Result<(), Cause> {
        let origin = self.first_counts.unwrap_or(0);
        let whole = (origin + counts.round() as i64) as i32;
        self.pause_for(Input::Position(counts, f64::from(speed)));
        let first_s = self.now_s();
        let exchange = self.acknowledged(|axis| axis.command_position(whole, speed))?;
        self.pace.answered(&exchange);
        let t = exchange.middle_s() - self.epoch_s;
        self.drives.push(Drive { t, input: Input::Position(counts.round(), f64::from(speed)) });
        self.monitor.release((first_s, t), self.law.tick_s());
        Ok(())
    }

    /// Has the controller's own relay test of a loop begin about the speed or the position and the duty of now, and gives its hysteresis, counts/s or counts; `None`
    /// where nothing says whether it has begun. It is not tried again by itself: it would begin about the duty that it has just given.
    pub fn start_own_test(
        &mut self,
        tested: TestedLoop,
        height: f64,
        hysteresis: f64,
        about: Input,
    ) -> Result<Option<f64>, Cause> {
        let raw = (height * f64::from(FULL_DUTY_RAW)).round() as u32;
        self.pause_for(about);
        let first_s = self.now_s();
        let answer = self.axis.start_own_test(tested, raw, hysteresis.round() as u32);
        self.note_stolen();
        let (exchange, taken) = match answer {
            Ok(answer) => answer,
            Err(AxisError::NoReply | AxisError::Late) => return Ok(None),
            Err(AxisError::Refused(_)) => return Err(Cause::NoOwnTest),
            Err(error) => return Err(cause_of(&error)),
        };
        self.pace.answered(&exchange);
        let t = exchange.middle_s() - self.epoch_s;
        self.drives.push(Drive { t, input: about });
        self.monitor.release((first_s, t), self.law.tick_s());
        // Between two polls its relay may have given either duty.
        self.monitor.hold(4.0 * height);
        Ok(Some(f64::from(taken)))
    }

    /// What that test found, amplitude in counts/s or counts and period in s; `None` where it has found nothing yet, or did not answer.
    pub fn own_test(&mut self) -> Result<Option<(f64, f64)>, Cause> {
        match self.axis.read_own_test() {
            Ok([0, _] | [_, 0]) | Err(AxisError::NoReply | AxisError::Late) => Ok(None),
            Ok([amplitude, period_us]) => Ok(Some((f64::from(amplitude), 1e-6 * f64::from(period_us)))),
            Err(AxisError::Refused(_)) => Err(Cause::NoOwnTest),
            Err(error) => Err(cause_of(&error)),
        }
    }

    /// Up to four tries. A controller that goes on reporting its counts has not lost the link: it does not take this command.
    fn acknowledged<T>(
        &mut self,
        mut call: impl FnMut(&mut dyn LoopAxis<L>) -> Result<T, AxisError>,
    ) -> Result<T, Cause> {
        let result = retried(|| call(self.axis));
        self.note_stolen();
        if !matches!(result, Err(Cause::LinkLost)) || self.axis.sample(Want::default()).is_err() {
            return result;
        }
        // The line may have been silent until now, and no longer.
        let result = retried(|| call(self.axis));
        self.note_stolen();
        if matches!(result, Err(Cause::LinkLost)) && self.axis.sample(Want::default()).is_ok() {
            return Err(Cause::Refused);
        }
        result
    }

    /// Writes registers to RAM; they are put back unless the run keeps its own.
    pub fn write(&mut self, write: L::Write) -> Result<(), Cause> {
        self.gains_touched = true;
        L::take(&mut self.registers, &write);
        self.monitor.hold(self.rate_doubt * self.law.step_duty(&self.registers));
        if self.facts.writes_at_rest {
            self.pause();
            return retried(|| self.axis.write(write));
        }
        self.acknowledged(|axis| axis.write(write))
    }

    /// Writes the registers that speed moves need, or position moves.
    pub fn write_all(&mut self, registers: &L::Registers, is_position: bool) -> Result<(), Cause> {
        L::writes(registers, is_position).into_iter().try_for_each(|write| self.write(write))
    }

    /// Writes the gains of a velocity loop, and gives them as registers.
    pub(crate) fn write_gains(&mut self, law: &L, gains: &Gains, qpps: f64) -> Result<L::Registers, Cause> {
        let registers = law.registers(&self.setup.held, gains, qpps, None);
        self.write_all(&registers, false).map(|()| registers)
    }

    /// What the controller is to hold at the end of the run.
    pub fn keep(&mut self, registers: L::Registers) -> Result<(), Cause> {
        self.kept = Some(registers);
        L::keeping(&registers).into_iter().try_for_each(|write| self.write(write))
    }

    /// Leaves a loop that goes on after the run off where something is wrong with the machine: it would hold the motor by a signal
    /// that is not there, or drive it away. Whether there is such a loop, and it was on.
    pub(crate) fn leave_off(&mut self, cause: Cause) -> bool {
        self.stays_off = L::goes_on(&self.setup.held) && cause.is_of_machine();
        self.stays_off
    }
}
