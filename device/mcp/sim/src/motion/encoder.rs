//! The encoder register of a channel and the speeds derived from its counts.

use super::{ControlLaw, EncoderInput, VelocityEstimate};

/// Status bit of commands 16 and 17: the register fell below 0 since the last reading.
pub const ENCODER_UNDERFLOW: u8 = 0x01;
/// Status bit of commands 16 and 17: the last movement was backwards.
pub const ENCODER_BACKWARDS: u8 = 0x02;
/// Status bit of commands 16 and 17: the register passed 2^32 - 1 since the last reading.
pub const ENCODER_OVERFLOW: u8 = 0x04;

/// The 32-bit encoder register (MCP manual, commands 16 to 23).
#[derive(Clone, Debug)]
pub struct EncoderRegister {
    input: EncoderInput,
    /// Raw count at which a quadrature register reads 0.
    zero: i64,
    wraps: i64,
    status: u8,
}

impl EncoderRegister {
    /// A register that reads 0 at a quadrature count of 0.
    #[must_use]
    pub fn new() -> Self {
        EncoderRegister { input: EncoderInput::Quadrature(0), zero: 0, wraps: 0, status: 0 }
    }

    /// The register as commands 16, 17 and 78 return it; an absolute encoder's value as it is.
    #[must_use]
    pub fn count(&self) -> u32 {
        // Truncation is the wrap of the 32-bit register.
        self.unwrapped() as u32
    }

    /// The register as a signed position, counts.
    #[must_use]
    pub fn position(&self) -> i32 {
        self.count() as i32
    }

    /// Status bits as they stand.
    #[must_use]
    pub fn status(&self) -> u8 {
        self.status
    }

    /// Status bits as commands 16 and 17 return them; underflow and overflow are cleared by the reading.
    pub fn take_status(&mut self) -> u8 {
        let status = self.status;
        self.status &= ENCODER_BACKWARDS;
        status
    }

    /// Sets the register (commands 20, 22, 23, load home). Absolute encoders take no notice.
    pub fn set(&mut self, count: u32) {
        if let EncoderInput::Quadrature(raw) = self.input {
            self.zero = raw - i64::from(count);
            self.wraps = 0;
        }
    }

    /// Takes a new reading. Returns the raw count for the speed measurement and whether the kind of encoder changed, so that the step
    /// is no movement.
    fn observe(&mut self, input: EncoderInput) -> (i64, bool) {
        let changed = std::mem::discriminant(&self.input) != std::mem::discriminant(&input);
        let moved = raw_count(input) - raw_count(self.input);
        self.input = input;
        if changed {
            self.wraps = self.unwrapped() >> 32;
        } else {
            self.note_movement(moved);
        }
        (raw_count(input), changed)
    }

    fn note_movement(&mut self, moved: i64) {
        match moved.signum() {
            1 => self.status &= !ENCODER_BACKWARDS,
            -1 => self.status |= ENCODER_BACKWARDS,
            _ => return,
        }
        let wraps = self.unwrapped() >> 32;
        if matches!(self.input, EncoderInput::Quadrature(_)) && wraps != self.wraps {
            self.status |= if wraps > self.wraps { ENCODER_OVERFLOW } else { ENCODER_UNDERFLOW };
        }
        self.wraps = wraps;
    }

    fn unwrapped(&self) -> i64 {
        match self.input {
            EncoderInput::Quadrature(raw) => raw - self.zero,
            EncoderInput::Absolute(value) => i64::from(value),
        }
    }
}

impl Default for EncoderRegister {
    fn default() -> Self {
        EncoderRegister::new()
    }
}

fn raw_count(input: EncoderInput) -> i64 {
    match input {
        EncoderInput::Quadrature(raw) => raw,
        EncoderInput::Absolute(value) => i64::from(value),
    }
}

/// Speeds as the commands read them, all in counts per second, forward positive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Speeds {
    /// Commands 18 and 19.
    pub filtered: i32,
    /// Commands 30, 31 and 79.
    pub raw: i32,
    /// Command 108: mean of the last second.
    pub average: i32,
}

/// One channel's encoder: register, count history and velocity estimate.
#[derive(Clone, Debug)]
pub(crate) struct EncoderChannel {
    pub register: EncoderRegister,
    history: CountHistory,
    low_pass: f64,
    started: bool,
}

impl EncoderChannel {
    pub fn new(law: &ControlLaw) -> Self {
        EncoderChannel {
            register: EncoderRegister::new(),
            history: CountHistory::new(law.rate_hz),
            low_pass: 0.0,
            started: false,
        }
    }

    /// Takes the reading of this tick. The first one is a starting point and no movement.
    pub fn observe(&mut self, input: EncoderInput, law: &ControlLaw) {
        if !self.started {
            self.register.input = input;
            self.register.wraps = self.register.unwrapped() >> 32;
        }
        let (raw, changed) = self.register.observe(input);
        if changed || !self.started {
            self.history.fill(raw);
            self.low_pass = 0.0;
            self.started = true;
        } else {
            self.history.push(raw);
        }
        if let VelocityEstimate::LowPass { time_constant_s } = law.velocity_estimate {
            let share = law.tick_s() / (time_constant_s + law.tick_s());
            self.low_pass += share * (self.history.speed(1) - self.low_pass);
        }
    }

    /// Raw counts, unaffected by setting the register.
    pub fn raw_counts(&self) -> i64 {
        self.history.newest()
    }

    /// The speed the velocity loop acts on, counts/s.
    pub fn estimate(&self, law: &ControlLaw) -> f64 {
        match law.velocity_estimate {
            VelocityEstimate::LastTick => self.history.speed(1),
            VelocityEstimate::MovingAverage { ticks } => self.history.speed(usize::from(ticks)),
            VelocityEstimate::LowPass { .. } => self.low_pass,
        }
    }

    pub fn speeds(&self, law: &ControlLaw) -> Speeds {
        let over = |ticks: usize| self.history.speed(ticks).round() as i32;
        Speeds {
            filtered: over(usize::from(law.filtered_speed_ticks)),
            raw: over(usize::from(law.raw_speed_ticks)),
            average: over(self.history.ticks_per_second()),
        }
    }
}

/// Counts at each tick of the last second.
#[derive(Clone, Debug)]
struct CountHistory {
    counts: Box<[i64]>,
    newest: usize,
}

impl CountHistory {
    fn new(rate_hz: u32) -> Self {
        let ticks = usize::try_from(rate_hz).unwrap_or(1).max(1);
        CountHistory { counts: vec![0; ticks + 1].into_boxed_slice(), newest: 0 }
    }

    fn fill(&mut self, count: i64) {
        self.counts.fill(count);
    }

    fn push(&mut self, count: i64) {
        self.newest = (self.newest + 1) % self.counts.len();
        self.counts[self.newest] = count;
    }

    fn newest(&self) -> i64 {
        self.counts[self.newest]
    }

    fn ticks_per_second(&self) -> usize {
        self.counts.len() - 1
    }

    /// Mean speed over the last `ticks` ticks, counts/s; `ticks` beyond a second counts as a second.
    fn speed(&self, ticks: usize) -> f64 {
        let ticks = ticks.clamp(1, self.ticks_per_second());
        let oldest = (self.newest + self.counts.len() - ticks) % self.counts.len();
        let moved = self.newest() - self.counts[oldest];
        moved as f64 * self.ticks_per_second() as f64 / ticks as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(encoder: &mut EncoderChannel, law: &ControlLaw, counts: impl IntoIterator<Item = i64>) {
        for count in counts {
            encoder.observe(EncoderInput::Quadrature(count), law);
        }
    }

    #[test]
    fn going_below_zero_wraps_and_flags_an_underflow_until_it_is_read() {
        let law = ControlLaw::default();
        let mut encoder = EncoderChannel::new(&law);
        run(&mut encoder, &law, [0, 3, 1, -2]);
        assert_eq!(encoder.register.count(), 0xFFFF_FFFE);
        assert_eq!(encoder.register.position(), -2);
        assert_eq!(encoder.register.take_status(), ENCODER_UNDERFLOW | ENCODER_BACKWARDS);
        assert_eq!(encoder.register.take_status(), ENCODER_BACKWARDS);
        run(&mut encoder, &law, [5]);
        assert_eq!(encoder.register.take_status(), ENCODER_OVERFLOW);
        assert_eq!(encoder.register.take_status(), 0);
    }

    #[test]
    fn a_register_set_near_its_end_overflows() {
        let law = ControlLaw::default();
        let mut encoder = EncoderChannel::new(&law);
        run(&mut encoder, &law, [1_000]);
        encoder.register.set(0xFFFF_FFFF);
        run(&mut encoder, &law, [1_001]);
        assert_eq!(encoder.register.count(), 0);
        assert_eq!(encoder.register.take_status(), ENCODER_OVERFLOW);
    }

    #[test]
    fn setting_the_register_is_no_movement() {
        let law = ControlLaw::default();
        let mut encoder = EncoderChannel::new(&law);
        run(&mut encoder, &law, [0, 10]);
        encoder.register.set(1_000_000);
        assert_eq!(encoder.register.count(), 1_000_000);
        run(&mut encoder, &law, [10]);
        assert_eq!(encoder.speeds(&law).raw, 0);
        assert_eq!(encoder.register.status(), 0);
    }

    #[test]
    fn an_absolute_encoder_reads_as_it_is_and_cannot_be_set() {
        let law = ControlLaw::default();
        let mut encoder = EncoderChannel::new(&law);
        encoder.observe(EncoderInput::Absolute(4_000), &law);
        encoder.register.set(0);
        assert_eq!(encoder.register.count(), 4_000);
        assert_eq!(encoder.speeds(&law), Speeds::default());
        encoder.observe(EncoderInput::Absolute(3_990), &law);
        assert_eq!(encoder.speeds(&law).raw, -3_000);
        assert_eq!(encoder.register.status(), ENCODER_BACKWARDS);
    }

    #[test]
    fn raw_speed_is_one_tick_filtered_a_tenth_and_average_a_whole_second() {
        let law = ControlLaw::default();
        let mut encoder = EncoderChannel::new(&law);
        run(&mut encoder, &law, [0]);
        run(&mut encoder, &law, (1..=15).map(|tick| tick * 2));
        let speeds = encoder.speeds(&law);
        assert_eq!(speeds.raw, 600);
        assert_eq!(speeds.filtered, 300);
        assert_eq!(speeds.average, 30);
    }

    #[test]
    fn raw_speeds_are_multiples_of_the_loop_rate() {
        for law in [ControlLaw::default(), ControlLaw { raw_speed_ticks: 1, ..ControlLaw::at_625_hz() }] {
            let mut encoder = EncoderChannel::new(&law);
            for count in [0, 7, 8, 20, 19] {
                encoder.observe(EncoderInput::Quadrature(count), &law);
                assert_eq!(encoder.speeds(&law).raw % law.rate_hz as i32, 0);
            }
        }
    }

    #[test]
    fn velocity_estimates_differ_as_the_law_says() {
        let estimate = |velocity_estimate| {
            let law = ControlLaw { velocity_estimate, ..ControlLaw::default() };
            let mut encoder = EncoderChannel::new(&law);
            run(&mut encoder, &law, [0, 0, 0, 0, 4]);
            encoder.estimate(&law)
        };
        assert_eq!(estimate(VelocityEstimate::LastTick), 1_200.0);
        assert_eq!(estimate(VelocityEstimate::MovingAverage { ticks: 4 }), 300.0);
        let one_tick = 1.0 / 300.0;
        assert!(
            (estimate(VelocityEstimate::LowPass { time_constant_s: 3.0 * one_tick }) - 300.0).abs() < 1e-9
        );
    }
}
