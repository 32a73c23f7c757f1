//! Lets a window look at a run while it goes on: an axis that passes everything on and keeps a trace of it.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use brushwork_tuning::axis::{Axis, AxisError, Exchange, Sample, Want};
use brushwork_tuning::law::Law;
use brushwork_tuning::record::Entry;
use brushwork_tuning::setup::LoopAxis;

use super::law::{AnyLaw, AnyWrite, Setup, Trace};

/// The trace of a run, shared between the run and whoever looks on. Each holds it only for a moment.
#[derive(Clone, Debug, Default)]
pub struct Live(Arc<Mutex<Trace>>);

impl Live {
    /// An empty trace.
    pub fn new(trace: Trace) -> Self {
        Self(Arc::new(Mutex::new(trace)))
    }

    /// Starts anew, for whoever looks on too.
    pub fn begin(&self, trace: Trace) {
        *self.look() = trace;
    }

    /// The trace so far.
    pub fn look(&self) -> MutexGuard<'_, Trace> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn take(&self, entry: &Entry<AnyLaw>) {
        self.look().take(entry);
    }
}

/// An axis that is looked at.
pub struct Tap<'a> {
    axis: &'a mut dyn LoopAxis<AnyLaw>,
    live: Live,
}

impl<'a> Tap<'a> {
    /// Passes on to `axis`, and keeps a trace in `live`.
    pub fn new(axis: &'a mut dyn LoopAxis<AnyLaw>, live: Live) -> Self {
        Self { axis, live }
    }
}

impl Axis for Tap<'_> {
    fn now(&mut self) -> Duration {
        let now = self.axis.now();
        self.live.take(&Entry::Now(now));
        now
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        self.axis.wait_until(time)
    }

    fn sample(&mut self, want: Want) -> Result<Sample, AxisError> {
        let answer = self.axis.sample(want);
        self.live.take(&Entry::Sampled(answer.clone()));
        answer
    }

    fn drive_duty(&mut self, duty_raw: i16) -> Result<Exchange, AxisError> {
        let answer = self.axis.drive_duty(duty_raw);
        self.live.take(&Entry::Duty(duty_raw, answer.clone()));
        answer
    }

    fn command_speed(&mut self, counts_per_s: i32) -> Result<Exchange, AxisError> {
        let answer = self.axis.command_speed(counts_per_s);
        self.live.take(&Entry::Speed(counts_per_s, answer.clone()));
        answer
    }

    fn command_position(&mut self, counts: i32, speed: u32) -> Result<Exchange, AxisError> {
        let answer = self.axis.command_position(counts, speed);
        self.live.take(&Entry::Position(counts, speed, answer.clone()));
        answer
    }

    fn write_winding(&mut self, raw: [u32; 2]) -> Result<(), AxisError> {
        self.axis.write_winding(raw)
    }

    fn write_current_limits(&mut self, max_raw: u32, min_raw: i32) -> Result<(), AxisError> {
        self.axis.write_current_limits(max_raw, min_raw)
    }

    fn raw_speed(&mut self) -> Result<i32, AxisError> {
        self.axis.raw_speed()
    }

    fn set_stream_timeout(&mut self, milliseconds: u32) -> Result<(), AxisError> {
        self.axis.set_stream_timeout(milliseconds)
    }

    fn set_travel(&mut self, counts: (i64, i64)) -> Result<(), AxisError> {
        self.axis.set_travel(counts)
    }

    fn progress(&mut self, text: &str) {
        self.axis.progress(text);
    }
}

impl LoopAxis<AnyLaw> for Tap<'_> {
    fn read_setup(&mut self) -> Result<Setup, AxisError> {
        self.axis.read_setup()
    }

    fn write(&mut self, write: AnyWrite) -> Result<(), AxisError> {
        let answer = self.axis.write(write);
        self.live.take(&Entry::Registers(AnyLaw::note(write, answer.clone())));
        answer
    }
}
