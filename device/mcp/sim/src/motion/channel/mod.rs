//! One motor channel: takes commands, runs loops and ramps, gives bridge outputs.
//!
//! [`Channel::tick`] runs at the law's rate. Between ticks [`Channel::refine`] may follow the motor current as often as
//! the plant is advanced. Nothing here allocates after [`Channel::new`].

mod advance;
mod mode;
mod state;

pub use state::ChannelState;

use super::buffer::{BUFFER_EMPTY, BufferedMove, CommandQueue};
use super::encoder::EncoderChannel;
use super::output::{Demand, OutputStage, StageSettings};
use super::pid::{PositionPid, VelocityPid};
use super::ramp::Ramp;
use super::relay::{Oscillation, RelayTest};
use super::{
    BridgeOverride, Buffering, Conditions, ControlLaw, EncoderRegister, FULL_DUTY_RAW, Measured,
    MotionCommand, MotionSettings, Outcome, Refusal, RelayCommand, RelayOn, Speeds,
};
use brushwork_plant::bridge::BridgeOutput;
use mode::{DistanceRun, Mode, PositionRun};

/// The control side of one motor.
#[derive(Clone, Debug)]
pub struct Channel {
    law: ControlLaw,
    encoder: EncoderChannel,
    mode: Mode,
    queue: CommandQueue,
    /// A buffered command is executing.
    buffered: bool,
    /// An input holds the motor, so that commands are refused.
    held: bool,
    /// Raw duty of the open-loop modes.
    duty: Ramp,
    /// Speed setpoint of the closed-loop modes, counts/s.
    speed: Ramp,
    velocity: VelocityPid,
    position: PositionPid,
    stage: OutputStage,
    delay: DelayLine,
    /// Time of the present tick that `refine` has covered, s.
    refined_s: f64,
    zero_ticks: u64,
    errors: LoopErrors,
    relay_result: Option<Oscillation>,
    home_outcome: Option<HomeOutcome>,
}

/// Deviations of the loops from their setpoints; 0 while a loop does not run. That a limit was exceeded stays noted until the
/// channel is told to move again (assumed).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LoopErrors {
    /// Speed setpoint less measured speed, counts/s (command 111).
    pub speed_counts_per_s: i32,
    /// Position setpoint less measured position, counts (command 114). In a move with acceleration and deceleration the
    /// setpoint is the point of its profile, otherwise the target.
    pub position_counts: i32,
    /// The speed error went beyond its limit. Assumed: looked at only in commands with an acceleration, as the position
    /// limit is.
    pub speed_exceeded: bool,
    /// The position error went beyond its limit, in a move with acceleration and deceleration (vendor forum).
    pub position_exceeded: bool,
}

impl LoopErrors {
    fn clear_deviations(&mut self) {
        self.speed_counts_per_s = 0;
        self.position_counts = 0;
    }
}

/// How homing ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HomeOutcome {
    /// [`Channel::reach_home`] was called in time.
    Reached,
    /// The time-out passed.
    TimedOut,
}

impl Channel {
    /// A channel at rest. The law is repaired first ([`ControlLaw::repaired`]).
    #[must_use]
    pub fn new(law: &ControlLaw) -> Self {
        let law = law.repaired();
        let stage_settings = StageSettings::new(&MotionSettings::default(), 1.0, &law);
        Channel {
            law,
            encoder: EncoderChannel::new(&law),
            mode: Mode::Stop,
            queue: CommandQueue::new(),
            buffered: false,
            held: false,
            duty: Ramp::new(law.rate_hz),
            speed: Ramp::new(law.rate_hz),
            velocity: VelocityPid::default(),
            position: PositionPid::default(),
            stage: OutputStage::new(stage_settings),
            delay: DelayLine::new(),
            refined_s: 0.0,
            zero_ticks: 0,
            errors: LoopErrors::default(),
            relay_result: None,
            home_outcome: None,
        }
    }

    /// The law the channel runs.
    #[must_use]
    pub fn law(&self) -> &ControlLaw {
        &self.law
    }

    /// Takes a command. It acts from the next tick on.
    #[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
    pub fn command(&mut self, command: MotionCommand, settings: &MotionSettings) -> Outcome {
        if self.held && !matches!(command, MotionCommand::SafeStop | MotionCommand::Coast) {
            return Outcome::Refused(Refusal::Held);
        }
        if !matches!(command, MotionCommand::SafeStop | MotionCommand::Coast) {
            self.errors = LoopErrors::default();
        }
        match command {
            MotionCommand::Distance(distance, buffering) => {
                self.take_buffered(BufferedMove::Distance(distance), buffering, settings)
            }
            MotionCommand::Position(position, buffering) => {
                self.take_buffered(BufferedMove::Position(position), buffering, settings)
            }
            unbuffered => {
                self.drop_buffer();
                self.start_unbuffered(unbuffered, settings);
                Outcome::Started
            }
        }
    }

    /// Runs one tick of the law's rate: measures, advances ramps and loops, and gives what the bridge holds from now on.
    pub fn tick(
        &mut self,
        measured: &Measured,
        conditions: &Conditions,
        settings: &MotionSettings,
    ) -> BridgeOutput {
        self.encoder.observe(measured.encoder, &self.law);
        self.apply_inputs(conditions);
        let demand = if conditions.bridge == BridgeOverride::None {
            let demand = self.advance(conditions, settings);
            self.delay.pass(demand, self.law.output_delay_ticks)
        } else {
            self.wait_out_override()
        };
        let stage_settings = StageSettings::new(settings, conditions.current_limit_share, &self.law);
        self.stage.set(demand, conditions.bridge, stage_settings);
        let left_s = (self.law.tick_s() - self.refined_s).max(0.0);
        self.refined_s = 0.0;
        self.stage.step(measured.current_amps, measured.bus_volts, left_s)
    }

    /// Follows the motor current `dt_s` after the last call of this or of [`Channel::tick`]. Optional: without it the
    /// current limit and the torque loop run at the law's rate.
    pub fn refine(&mut self, current_amps: f64, bus_volts: f64, dt_s: f64) -> BridgeOutput {
        self.refined_s += dt_s;
        self.stage.step(current_amps, bus_volts, dt_s)
    }

    /// The home switch closed: ends homing, if that is what the channel does, with the motor stopped.
    pub fn reach_home(&mut self) -> bool {
        let homing = matches!(self.mode, Mode::Home { .. });
        if homing {
            self.home_outcome = Some(HomeOutcome::Reached);
            self.stop();
        }
        homing
    }

    /// The bridge output as last given.
    #[must_use]
    pub fn output(&self) -> BridgeOutput {
        self.stage.output()
    }

    /// Duty as command 48 returns it, -32767 to 32767.
    #[must_use]
    pub fn duty_raw(&self) -> i16 {
        (self.stage.output().duty() * f64::from(FULL_DUTY_RAW)).round() as i16
    }

    /// Reading of command 47: commands waiting, 0 while the last one executes, 0x80 when none is left.
    #[must_use]
    pub fn buffer_length(&self) -> u8 {
        match (self.buffered, u8::try_from(self.queue.len())) {
            (true, Ok(waiting)) => waiting,
            _ => BUFFER_EMPTY,
        }
    }

    /// The encoder register.
    #[must_use]
    pub fn encoder(&self) -> &EncoderRegister {
        &self.encoder.register
    }

    /// The encoder register, to set it or to take its status.
    pub fn encoder_mut(&mut self) -> &mut EncoderRegister {
        &mut self.encoder.register
    }

    /// Speeds as the commands read them.
    #[must_use]
    pub fn speeds(&self) -> Speeds {
        self.encoder.speeds(&self.law)
    }

    /// Deviations of the loops as of the last tick.
    #[must_use]
    pub fn errors(&self) -> LoopErrors {
        self.errors
    }

    /// Whether the current limit holds the output back.
    #[must_use]
    pub fn is_current_limited(&self) -> bool {
        self.stage.is_limiting()
    }

    /// Whether a relay test runs.
    #[must_use]
    pub fn is_relay_running(&self) -> bool {
        matches!(self.mode, Mode::Relay(_))
    }

    /// Amplitude and period of the last relay test as commands 88 and 89 return them: counts/s or counts, and
    /// [`ControlLaw::relay_period_units_per_s`]. Both 0 before the first, while one runs and after one that timed out.
    #[must_use]
    pub fn relay_result_raw(&self) -> [u32; 2] {
        self.relay_result.map_or([0, 0], |result| {
            let period = result.period_s * f64::from(self.law.relay_period_units_per_s);
            [result.amplitude.round() as u32, period.round() as u32]
        })
    }

    /// What the last relay test measured.
    #[must_use]
    pub fn relay_result(&self) -> Option<Oscillation> {
        self.relay_result
    }

    /// Whether homing runs.
    #[must_use]
    pub fn is_homing(&self) -> bool {
        matches!(self.mode, Mode::Home { .. })
    }

    /// How the last homing ended; `None` before the first and while one runs.
    #[must_use]
    pub fn home_outcome(&self) -> Option<HomeOutcome> {
        self.home_outcome
    }

    /// What the channel is doing.
    #[must_use]
    pub fn state(&self) -> ChannelState {
        let mut state = ChannelState {
            velocity_loop: self.mode.is_closed(),
            active: !matches!(
                self.stage.output(),
                BridgeOutput::Duty(0.0) | BridgeOutput::Coast | BridgeOutput::Brake
            ),
            ..ChannelState::default()
        };
        if self.mode.is_closed() {
            state.speed_setpoint_counts_per_s = self.speed.value().round() as i32;
        }
        let raw_counts = self.encoder.raw_counts();
        self.mode.describe(raw_counts, &mut state);
        state
    }

    fn take_buffered(
        &mut self,
        buffered: BufferedMove,
        buffering: Buffering,
        settings: &MotionSettings,
    ) -> Outcome {
        if buffering == Buffering::Queue && self.buffered {
            return if self.queue.push(buffered) {
                Outcome::Queued
            } else {
                Outcome::Refused(Refusal::BufferFull)
            };
        }
        self.drop_buffer();
        if self.start_buffered(buffered, None, settings) {
            Outcome::Started
        } else {
            Outcome::Refused(Refusal::NoPositionRange)
        }
    }

    /// Starts a buffered move; `from` is the raw count it measures its distance from, otherwise the present one.
    /// False, with the motor stopped, for a position move without a range.
    fn start_buffered(
        &mut self,
        buffered: BufferedMove,
        from: Option<i64>,
        settings: &MotionSettings,
    ) -> bool {
        let mode = match buffered {
            BufferedMove::Distance(distance) => {
                let start = from.unwrap_or_else(|| self.encoder.raw_counts());
                Mode::Distance(DistanceRun::new(&distance, start))
            }
            BufferedMove::Position(_) if !settings.allows_position() => {
                self.stop();
                return false;
            }
            BufferedMove::Position(position) => {
                self.position.restart_derivative();
                let speed =
                    if self.mode.is_closed() { self.speed.value() } else { self.encoder.estimate(&self.law) };
                let position_counts = f64::from(self.encoder.register.position());
                Mode::Position(PositionRun::new(&position, settings, position_counts, speed))
            }
        };
        self.begin(mode);
        self.buffered = true;
        true
    }

    fn start_unbuffered(&mut self, command: MotionCommand, settings: &MotionSettings) {
        let mode = match command {
            MotionCommand::Duty { duty_raw, acceleration_raw } => Mode::Duty {
                goal_raw: i32::from(duty_raw).max(-FULL_DUTY_RAW),
                rates: mode::duty_rates(acceleration_raw, settings, &self.law),
            },
            MotionCommand::Speed { speed_counts_per_s, acceleration } => {
                Mode::Speed { goal: speed_counts_per_s, acceleration: mode::ramp_rate(acceleration) }
            }
            MotionCommand::Relay(relay) => {
                self.relay_result = None;
                Mode::Relay(self.relay_test(&relay))
            }
            MotionCommand::Home { duty_raw, timeout_300ths } => {
                self.home_outcome = None;
                Mode::Home {
                    goal_raw: i32::from(duty_raw).max(-FULL_DUTY_RAW),
                    rates: mode::duty_rates(None, settings, &self.law),
                    ticks_left: u64::from(timeout_300ths) * u64::from(self.law.rate_hz) / 300,
                }
            }
            MotionCommand::Coast => Mode::Coast,
            MotionCommand::SafeStop | MotionCommand::Distance(..) | MotionCommand::Position(..) => Mode::Stop,
        };
        self.begin(mode);
    }

    fn relay_test(&self, relay: &RelayCommand) -> RelayTest {
        let reference = match relay.on {
            RelayOn::Speed => f64::from(self.speeds().filtered),
            RelayOn::Position => f64::from(self.encoder.register.position()),
        };
        let limit = u32::from(self.law.relay_time_limit_s) * self.law.rate_hz;
        RelayTest::new(relay, self.stage.output().duty(), reference, limit)
    }

    /// Duty 0 at the highest rate, nothing buffered.
    fn stop(&mut self) {
        self.drop_buffer();
        self.begin(Mode::Stop);
    }

    fn drop_buffer(&mut self) {
        self.queue.clear();
        self.buffered = false;
    }

    /// Changes the mode without a jump: loops start from the measured speed, open-loop ramps from the duty applied.
    fn begin(&mut self, mode: Mode) {
        if mode.is_closed() && !self.mode.is_closed() {
            self.speed.set(self.encoder.estimate(&self.law));
            self.velocity.reset();
            self.position.reset();
        }
        // The ramp of a torque stands for a current, and a stop ramps the voltage.
        let from_torque = matches!(mode, Mode::Stop) && self.stage.drives_current();
        let has_ramp = matches!(self.mode, Mode::Stop | Mode::Duty { .. } | Mode::Home { .. });
        if !mode.is_closed() && (!has_ramp || from_torque) {
            self.duty.set(self.stage.output().duty() * f64::from(FULL_DUTY_RAW));
        }
        if !matches!(mode, Mode::Position(_)) {
            self.position.reset();
        }
        self.zero_ticks = 0;
        self.mode = mode;
    }

    fn apply_inputs(&mut self, conditions: &Conditions) {
        self.held = conditions.safe_stop || conditions.off;
        if conditions.off {
            self.drop_buffer();
            self.begin(Mode::Coast);
        } else if conditions.safe_stop && !matches!(self.mode, Mode::Stop) {
            self.stop();
        }
    }

    /// Nothing runs while protection holds the bridge; what was running goes on afterwards from zero output.
    fn wait_out_override(&mut self) -> Demand {
        if matches!(self.mode, Mode::Relay(_)) {
            self.stop();
        }
        self.duty.set(0.0);
        self.speed.set(self.encoder.estimate(&self.law));
        self.velocity.reset();
        self.position.reset();
        self.errors.clear_deviations();
        self.delay = DelayLine::new();
        Demand::Duty(0.0)
    }
}

/// The extra ticks between computing a demand and the bridge taking it.
#[derive(Clone, Copy, Debug)]
struct DelayLine {
    demands: [Demand; ControlLaw::MAX_DELAY_TICKS as usize + 1],
    newest: usize,
}

impl DelayLine {
    fn new() -> Self {
        DelayLine { demands: [Demand::Duty(0.0); ControlLaw::MAX_DELAY_TICKS as usize + 1], newest: 0 }
    }

    fn pass(&mut self, demand: Demand, ticks: u8) -> Demand {
        let length = self.demands.len();
        self.newest = (self.newest + 1) % length;
        self.demands[self.newest] = demand;
        self.demands[(self.newest + length - usize::from(ticks).min(length - 1)) % length]
    }
}
