//! The control side of the simulated firmware: what turns motion commands and measurements into bridge outputs.
//!
//! Pure and free of wire, plant and clock: time is the number of ticks, and a [`Channel`] is told what it measures. Commands
//! arrive decoded, settings raw; protection decides elsewhere and reaches a channel as [`Conditions`].
//!
//! What the real firmware computes is not public. Every guess about its loops is a field of [`ControlLaw`]; a guess about
//! a command stands in the doc of the item that holds it, marked "Assumed".

mod buffer;
mod channel;
mod command;
mod encoder;
mod law;
mod mixing;
mod output;
mod pid;
mod profile;
mod ramp;
mod relay;
mod settings;

pub use buffer::{BUFFER_CAPACITY, BUFFER_EMPTY};
pub use channel::{Channel, ChannelState, HomeOutcome, LoopErrors};
pub use command::{
    BridgeOverride, Buffering, Conditions, DistanceMove, EncoderInput, Measured, MotionCommand, Outcome,
    PositionMove, PositionTarget, Refusal, RelayCommand, RelayOn,
};
pub use encoder::{ENCODER_BACKWARDS, ENCODER_OVERFLOW, ENCODER_UNDERFLOW, EncoderRegister, Speeds};
pub use law::{
    AntiWindup, ControlLaw, DerivativeOf, DistanceEnd, GainTiming, PositionForm, VelocityEstimate,
    ZeroDutyAcceleration,
};
pub use mixing::{Mixer, mixed_duties, seven_bit_backward, seven_bit_centered, seven_bit_forward};
pub use relay::Oscillation;
pub use settings::{FULL_DUTY_RAW, Gains, MAX_DUTY_ACCELERATION, MotionSettings};
