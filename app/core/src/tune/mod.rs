//! Tuning over the device thread: the tuner's axis as a job on the thread that owns the link, and what brackets it.
//!
//! A run is three jobs. The first moves nothing: it keeps a backup and a journal on this computer, reads what the controller holds
//! and shortens the stream's time-out. The second
//! is the run, which needs arming. The third moves nothing either and puts back what must be put back, on every way out on which
//! there is still a link. What an interruption leaves of the run's own report is kept past the job.

pub mod encoder;
pub mod file;
pub mod law;
mod mind;
pub mod tap;
mod told;

use brushwork_mcp_client::packet::typed_reply;
use brushwork_mcp_client::{layout_of, packet_address, packet_generation};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use brushwork_link::Stream;
use brushwork_link::device::{Job, JobContext};
use brushwork_link::failure::Failure;
use brushwork_link::settings::{Ending, Subject, begin_trial, end_act};
use brushwork_link::wire::Wire;
use brushwork_mcp_axis::{Carrier, McpHeld, McpWrite, PacketAxis, Timed};
use brushwork_mcp_wire::packet_serial::{Generation, Given, Request as Packet, Typed, number};
use brushwork_motion_mind_axis::{LoopAfter, MindAxis};
use brushwork_tuning::axis::{Axis, AxisError, EncoderClass, Exchange};
use brushwork_tuning::cause::Cause;
use brushwork_tuning::experiment_guard::{RUN_STREAM_TIMEOUT_MS, wait_for_rest};
use brushwork_tuning::report::Verdict;
use brushwork_tuning::setup::LoopAxis;
use brushwork_tuning::trial::run_trial;
use brushwork_tuning::tune::tune;
use brushwork_values::{Motor, Value};

use crate::keep::TrialKeeper;
use law::{AnyLaw, Report, Request, Setup, Trial, TrialRequest};
use mind::MindJobCarrier;
use tap::{Live, Tap};
use told::told;

/// Verb phrase of the job before a run.
const PREPARE: &str = "get ready to tune";
/// Verb phrase of a run.
const RUN: &str = "tune the motor";
/// Verb phrase of a trial.
const TRIAL: &str = "try the gains";
/// Verb phrase of the job after either.
const RESTORE: &str = "put back what the tuning changed";

/// What a trial of gains may take.
const TRIAL_LIMIT: Duration = Duration::from_secs(120);
/// An exchange that took so much longer than the quickest had a retry in it, or waited for this computer, so that its middle says
/// nothing.
const LATE: Duration = Duration::from_millis(35);
/// How long the job before a run may take: it reads every setting for the backup.
const PREPARE_LIMIT: Duration = Duration::from_secs(130);
/// How long the job after a run may take.
const RESTORE_LIMIT: Duration = Duration::from_secs(60);
/// What a run may take beyond its own limit.
const GRACE: Duration = Duration::from_secs(10);

/// Registers of a Motion Mind that a run writes, by their names in keys.
const MIND_REGISTERS: [&str; 9] =
    ["velocityff", "pterm", "iterm", "dterm", "pidscalar", "vnlimit", "vplimit", "deadband", "ampslimit"];

/// What a job leaves for whoever started it, whatever became of the job.
pub type Slot<T> = Arc<Mutex<Option<T>>>;

/// Takes what a job left.
pub fn take<T>(slot: &Slot<T>) -> Option<T> {
    slot.lock().unwrap_or_else(PoisonError::into_inner).take()
}

fn put<T>(slot: &Slot<T>, value: T) {
    *slot.lock().unwrap_or_else(PoisonError::into_inner) = Some(value);
}

/// The wire of a job as the tuner's carrier.
struct JobCarrier<'a, 'b> {
    context: &'a mut JobContext<'b>,
    stream: Option<Stream>,
    /// The quickest exchange so far.
    quickest: Option<Duration>,
}

impl JobCarrier<'_, '_> {
    /// Whether the middle of an exchange is no time at which anything was read.
    fn is_vague(&mut self, exchange: &Exchange) -> bool {
        let took = exchange.received.saturating_sub(exchange.sent);
        let quickest = self.quickest.map_or(took, |quickest| quickest.min(took));
        self.quickest = Some(quickest);
        took > quickest + LATE
    }
}

/// Whether a command reads what is of use only with the time of its reading.
fn needs_its_time(command: u8) -> bool {
    matches!(
        command,
        number::READ_ENCODERS | number::READ_ENCODER_M1 | number::READ_ENCODER_M2 | number::READ_PWMS
    )
}

impl Carrier for JobCarrier<'_, '_> {
    fn transact<const L: u8>(&mut self, command: Typed<L>, given: &[Given<L>]) -> Timed<L> {
        let address = packet_address(self.context.address()).unwrap_or_default();
        let packet = Packet::typed(address, command, self.generation(), given)
            .map_err(|error| AxisError::Refused(error.to_string()))?;
        let values: Vec<i64> = packet.values.iter().filter_map(Value::as_int).collect();
        let reply = self
            .context
            .transact_timed(command.number(), &values)
            .and_then(|reply| typed_reply(reply, command));
        let reply = reply.map_err(|error| told(&error))?;
        let exchange = Exchange { sent: reply.span.requested_at, received: reply.span.replied_at };
        let is_vague = self.is_vague(&exchange);
        if is_vague && needs_its_time(command.number()) {
            Err(AxisError::Late)
        } else {
            Ok((exchange, reply.values))
        }
    }

    fn now(&mut self) -> Duration {
        self.context.now()
    }

    fn wait_until(&mut self, time: Duration) -> Result<(), AxisError> {
        let left = time.saturating_sub(self.context.now());
        self.context.sleep(left).map_err(|error| told(&error))
    }

    fn generation(&self) -> Generation {
        layout_of(self.context.generation())
    }

    fn stream(&self) -> Option<usize> {
        self.stream.and_then(|stream| Stream::ALL.iter().position(|other| *other == stream))
    }

    fn progress(&mut self, text: &str) {
        self.context.progress(None, text);
    }
}

/// Whose axis a job tunes.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// The motor.
    pub motor: Motor,
    /// What its encoder is, as the user says; `None` for what the controller's settings say.
    pub encoder: Option<EncoderClass>,
    /// The stream that the port is wired to, where that is known: only then can its time-out be set.
    pub stream: Option<Stream>,
}

fn axis<'a>(
    context: &'a mut JobContext<'_>,
    target: Target,
    own_timeout: bool,
) -> Box<dyn LoopAxis<AnyLaw> + 'a> {
    if packet_generation(context.generation()).is_none() {
        return Box::new(MindAxis::new(MindJobCarrier::new(context)));
    }
    let stream = target.stream.filter(|_| own_timeout);
    let carrier = JobCarrier { context, stream, quickest: None };
    Box::new(PacketAxis::new(carrier, target.motor, target.encoder.unwrap_or_default()))
}

/// The job before: keeps backup and journal, reads what is put back afterwards, and shortens the time-out. It moves nothing.
pub fn prepare(target: Target, subject: Subject, found: &Slot<Setup>, keeper: &TrialKeeper) -> Job<()> {
    let (found, keeper) = (Arc::clone(found), keeper.clone());
    Job::new(PREPARE, PREPARE_LIMIT, move |context| {
        let place = context.describe();
        let is_tried = |key: &str| is_tried(target.motor, key);
        let held = begin_trial(context, subject, &is_tried, &mut **keeper.lock())?;
        let encoder = target.encoder.or_else(|| encoder::class(&|key| held.image.get(key), target.motor));
        let target = Target { encoder, ..target };
        let mut axis = axis(context, target, true);
        let setup = thrice(|| axis.read_setup()).map_err(|error| failed("read the loops", &place, &error))?;
        put(&found, setup);
        if setup.stream_timeout_ms.is_some() {
            thrice(|| axis.set_stream_timeout(RUN_STREAM_TIMEOUT_MS))
                .map_err(|error| failed("set the time-out of the port", &place, &error))?;
        }
        Ok(())
    })
}

/// The run. It moves the motor, so it must be armed. The report is in its slot also after an interruption.
pub fn run(target: Target, request: Request, found: &Slot<Report>) -> Job<()> {
    run_watched(target, request, found, &Live::default())
}

/// The run, with a trace in `live` for whoever looks on.
pub fn run_watched(target: Target, request: Request, found: &Slot<Report>, live: &Live) -> Job<()> {
    let (found, live) = (Arc::clone(found), live.clone());
    let limit = Duration::from_secs_f64(request.guard.time_limit_s) + GRACE;
    Job::moving(RUN, limit, move |context| {
        context.set_polling(false);
        // The time-out was set before: changing it now would undermine the arming.
        let mut axis = axis(context, target, false);
        let report = tune(&mut Tap::new(&mut *axis, live.clone()), &request);
        put(&found, report);
        Ok(())
    })
}

/// Gains tried by themselves. It moves the motor, so it must be armed; what it found is in its slot also after an interruption.
pub fn trial(target: Target, wanted: TrialRequest, found: &Slot<Trial>, live: &Live) -> Job<()> {
    let (found, live) = (Arc::clone(found), live.clone());
    Job::moving(TRIAL, TRIAL_LIMIT, move |context| {
        context.set_polling(false);
        let mut axis = axis(context, target, false);
        let trial = run_trial(&mut Tap::new(&mut *axis, live.clone()), &wanted);
        put(&found, trial);
        Ok(())
    })
}

/// Whether a run changes a setting, if only for a while.
fn is_tried(motor: Motor, key: &str) -> bool {
    let of_motor = key.strip_prefix(&format!("motor{}.", motor.index() + 1));
    of_motor.is_some_and(|key| key.starts_with("velocity.") || key.starts_with("position."))
        || key.starts_with("stream.") && key.ends_with(".timeout")
        || key.strip_prefix("register.").is_some_and(|name| MIND_REGISTERS.contains(&name))
        || key.starts_with("function.")
        || key.starts_with("function2.")
}

/// What the job after a run tells its owner.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Restored {
    /// The loop of a Motion Mind did not hold the motor still and was left without output: [`LEFT_OFF`] says so.
    pub loop_left_off: bool,
}

/// What is said of a loop that was left off.
pub const LEFT_OFF: &str = "The controller's loop did not hold the motor still with the old gains, so its output is left switched off \
                            (DISABLEPID in FUNCTION, in RAM): the motor stands, but nothing holds it. The next Arm or `drive` switches \
                            the loop on again, and so does a reset of the unit.";

/// Whether a run has left the loop of a Motion Mind off, since it found the machine to be such that a loop could drive the motor away.
pub fn leaves_off(report: Option<&Report>, trial: Option<&Trial>) -> bool {
    report.is_some_and(|report| report.causes.contains(&Cause::LoopOff))
        || trial.and_then(|trial| trial.cause).is_some_and(Cause::is_of_machine)
}

/// The job after: the old gains, unless the run's own stay, and the old time-out, proven by reading them; the journal is closed. It
/// moves nothing, and leaves a loop off where the run has for a reason.
pub fn restore(
    target: Target,
    before: Setup,
    report: Option<&Report>,
    leaves_off: bool,
    keeper: &TrialKeeper,
) -> Job<Restored> {
    let keeper = keeper.clone();
    let keeps = report.filter(|report| report.request.keep && report.verdict != Verdict::Refused);
    let held = before.held;
    let kept = keeps.map(|report| report.proposed).unwrap_or_default();
    let loops = McpHeld {
        velocity: kept.mcp.velocity.unwrap_or(held.mcp.velocity),
        position: kept.mcp.position.unwrap_or(held.mcp.position),
    };
    let mind = held.mind.motion_mind.map(|unit| kept.mind.motion_mind.unwrap_or(unit.registers));
    Job::new(RESTORE, RESTORE_LIMIT, move |context| {
        let place = context.describe();
        if let Some(registers) = mind {
            let mut axis = MindAxis::new(MindJobCarrier::new(context));
            let put_back = thrice(|| axis.write_current_limits(before.max_current_raw, 0))
                .and_then(|()| thrice(|| axis.put_back(registers, leaves_off)))
                .map_err(|error| failed("write the registers back", &place, &error))?;
            end_act(context, &mut **keeper.lock(), Ending::Known);
            return Ok(Restored { loop_left_off: put_back == LoopAfter::LeftOff });
        }
        let mut axis = axis(context, target, true);
        let now =
            thrice(|| axis.read_setup()).map_err(|error| failed("read the loops back", &place, &error))?;
        put_loops_back(&mut *axis, &now.held.mcp, &loops)
            .map_err(|error| failed("write the loops back", &place, &error))?;
        if (now.max_current_raw, now.min_current_raw) != (before.max_current_raw, before.min_current_raw) {
            thrice(|| axis.write_current_limits(before.max_current_raw, before.min_current_raw))
                .map_err(|error| failed("put the current limit back", &place, &error))?;
        }
        if now.inductance_resistance_raw != before.inductance_resistance_raw {
            wait_for_rest(&mut *axis);
            thrice(|| axis.write_winding(before.inductance_resistance_raw))
                .map_err(|error| failed("put inductance and resistance back", &place, &error))?;
        }
        if let Some(timeout_ms) = before.stream_timeout_ms {
            thrice(|| axis.set_stream_timeout(timeout_ms))
                .map_err(|error| failed("set the time-out of the port back", &place, &error))?;
        }
        let held =
            thrice(|| axis.read_setup()).map_err(|error| failed("read the loops back", &place, &error))?;
        if held.held.mcp != loops
            || held.max_current_raw != before.max_current_raw
            || held.inductance_resistance_raw != before.inductance_resistance_raw
            || (before.stream_timeout_ms.is_some() && held.stream_timeout_ms != before.stream_timeout_ms)
        {
            let error = AxisError::Refused("settings that read otherwise than they were written".into());
            return Err(failed("put the loops back", &place, &error));
        }
        drop(axis);
        end_act(context, &mut **keeper.lock(), Ending::Known);
        Ok(Restored { loop_left_off: false })
    })
}

/// Writes the loops that are not as they were; a controller may not take what need not be written.
fn put_loops_back(axis: &mut dyn LoopAxis<AnyLaw>, now: &McpHeld, wanted: &McpHeld) -> Result<(), AxisError> {
    if now.velocity != wanted.velocity {
        thrice(|| axis.write(McpWrite::Velocity(wanted.velocity).into()))?;
    }
    if now.position != wanted.position {
        thrice(|| axis.write(McpWrite::PositionLoop(wanted.position).into()))?;
    }
    Ok(())
}

fn thrice<T>(mut call: impl FnMut() -> Result<T, AxisError>) -> Result<T, AxisError> {
    for _ in 0..2 {
        match call() {
            Err(AxisError::NoReply | AxisError::Late) => {}
            other => return other,
        }
    }
    call()
}

fn failed(tried: &str, place: &str, error: &AxisError) -> Failure {
    Failure::new(
        tried,
        place,
        error.to_string(),
        "Check the link and try again; `brushwork settings read` shows the loops",
    )
}
