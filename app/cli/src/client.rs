//! A controller as a command sees it: connected and identified, or a sentence and an exit code.

use crate::messages::{CliLinkMessage, CliUnitsMessage};
use brushwork_link::work::receive_within;
use std::fmt::Display;
use std::sync::Arc;
use std::time::{Duration, Instant};

use brushwork_link::device::DisarmReason;
use brushwork_link::{
    Addresses, ArmScope, ConnectTarget, DeviceHandle, Event, Failure, FamilyChoice, Identity, Job, JobTicket,
    PollRate, Request, Stream, SystemClock,
};
use crossbeam_channel::RecvTimeoutError;

use super::addresses::Line;
use super::examples;
use super::family;
use super::settings::cut_short;
use super::{ConnectArgs, Exit, Family, Interrupt, say};
use brushwork_core::keep::{Store, UnitId};
use brushwork_core::messages::CoreStatusMessage;
use brushwork_core::session::{self, LIKE, Session, SessionOptions, Simulation};
use brushwork_link::family::addresses_text;
use brushwork_link::transport::list_ports;

/// How long a controller may take to be found and identified.
pub const CONNECT_LIMIT: Duration = Duration::from_secs(60);
/// How long a controller may take to answer one request.
pub const ANSWER_LIMIT: Duration = Duration::from_secs(30);
/// How long one look at the event queue waits, so that signals are noticed.
const EVENT_SLICE: Duration = Duration::from_millis(20);

/// A connected controller.
pub struct Client {
    session: Session,
    /// Who answered.
    pub identity: Identity,
    /// Which of its streams the port is wired to, where that is known.
    pub stream: Option<Stream>,
}

impl Client {
    /// Opens the target and waits until the unit at the address has said who it is.
    ///
    /// # Errors
    /// Says on standard error what went wrong and gives the exit code.
    pub fn connect(args: &ConnectArgs, poll: PollRate, interrupt: &Interrupt) -> Result<Self, Exit> {
        Self::connect_to(args, poll, None, interrupt)
    }

    /// The same, to a simulation that runs already where the target names it.
    ///
    /// # Errors
    /// As for [`Self::connect`].
    pub fn connect_to(
        args: &ConnectArgs,
        poll: PollRate,
        running: Option<Arc<Simulation>>,
        interrupt: &Interrupt,
    ) -> Result<Self, Exit> {
        let client = Self::connect_untold(args, poll, running, interrupt)?;
        let unit = UnitId::new(&client.identity, &list_ports().unwrap_or_default());
        cut_short::announce(&unit, args.place());
        Ok(client)
    }

    /// The same, without a word of what was cut short on the unit: for those who read its settings and tell more.
    ///
    /// # Errors
    /// As for [`Self::connect`].
    pub fn connect_untold(
        args: &ConnectArgs,
        poll: PollRate,
        running: Option<Arc<Simulation>>,
        interrupt: &Interrupt,
    ) -> Result<Self, Exit> {
        alone(args)?;
        let mut session = open(args, poll, running)?;
        interrupt.hold_line();
        if let Some(simulation) = &session.simulation {
            simulation.unlike().iter().for_each(say);
        }
        let place = args.place();
        let no_link = |failure: Failure| with_loader(Exit::NoLink.saying(failure), place);
        let (identity, stream) = match wait_for_identity(&session.device, interrupt)? {
            Ok(found) => found,
            Err(failure) => {
                // The line is exclusive: it is given back before it is searched.
                drop(session);
                let Some(unit) = elsewhere(args, interrupt)? else { return Err(no_link(failure)) };
                let options = SessionOptions {
                    addresses: Addresses::Only(unit.address),
                    family: FamilyChoice::of(unit.family),
                    poll,
                };
                session = session::open(&target(args)?, options, SystemClock::shared(), None)
                    .map_err(|error| Exit::NoLink.saying(error))?;
                wait_for_identity(&session.device, interrupt)?.map_err(no_link)?
            }
        };
        Store::of_user().close_update(place);
        Ok(Self { session, identity, stream })
    }

    /// Opens a line with all the units that are meant of it. The first one is selected, and the one that speaks for the client.
    ///
    /// # Errors
    /// Says on standard error what went wrong and gives the exit code.
    pub fn connect_all(
        args: &ConnectArgs,
        poll: PollRate,
        interrupt: &Interrupt,
    ) -> Result<(Self, Vec<Identity>), Exit> {
        let line = Line { address: args.address.as_ref(), ..args.line() };
        let target = line_target(&line)?;
        let options = SessionOptions { addresses: line.sought(), family: family(&target, args), poll };
        let session = session::open(&target, options, SystemClock::shared(), None)
            .map_err(|error| Exit::NoLink.saying(error))?;
        interrupt.hold_line();
        let (units, failures) = look_on(&session, interrupt)?;
        failures.iter().for_each(say);
        let Some(identity) = units.first().cloned() else {
            let place = args.place().to_owned();
            return Err(with_loader(Exit::NoLink.saying(CliUnitsMessage::NoneAt { place }), args.place()));
        };
        let ports = list_ports().unwrap_or_default();
        units.iter().for_each(|unit| cut_short::announce(&UnitId::new(unit, &ports), args.place()));
        Store::of_user().close_update(args.place());
        ask(&session.device, Request::Select(identity.address))?;
        Ok((Self { session, identity, stream: None }, units))
    }

    /// The device thread.
    pub fn device(&self) -> &DeviceHandle {
        &self.session.device
    }

    /// The simulated machine behind it, if it runs in this program.
    pub fn simulation(&self) -> Option<Arc<Simulation>> {
        self.session.simulation.clone()
    }

    /// The next event, or `None` when there was none for a moment.
    ///
    /// # Errors
    /// The link is lost (said on standard error) or the program was asked to end.
    pub fn next_event(&self, interrupt: &Interrupt) -> Result<Option<Event>, Exit> {
        next_event(&self.session.device, interrupt)
    }
}

/// Opens the one line and looks at what is meant of it; what becomes of that comes as events.
///
/// # Errors
/// Says on standard error what went wrong and gives the exit code.
pub fn open(args: &ConnectArgs, poll: PollRate, running: Option<Arc<Simulation>>) -> Result<Session, Exit> {
    let target = match args.connect.len() {
        1 => line_target(&Line { address: args.address.as_ref(), ..args.line() })?,
        _ => target(args)?,
    };
    session::open(&target, options(&target, args, poll), SystemClock::shared(), running)
        .map_err(|error| Exit::NoLink.saying(error))
}

/// How the target is looked at.
pub fn options(target: &ConnectTarget, args: &ConnectArgs, poll: PollRate) -> SessionOptions {
    SessionOptions { addresses: addresses(target, args), poll, family: args.family }
}

/// What `--connect` and `--address` name, where that is to be one controller.
///
/// # Errors
/// Says on standard error what cannot be understood.
pub fn target(args: &ConnectArgs) -> Result<ConnectTarget, Exit> {
    alone(args)?;
    line_target(&Line { address: args.address.as_ref(), ..args.line() })
}

/// Nothing where one controller is named; what a command does to one at a time is not begun for several.
fn alone(args: &ConnectArgs) -> Result<(), Exit> {
    if args.is_several() { Err(Exit::Usage.saying(CliLinkMessage::OneAtATime)) } else { Ok(()) }
}

/// What `--connect` and `--address` of a whole line name.
///
/// # Errors
/// Says on standard error what cannot be understood.
pub fn line_target(line: &Line<'_>) -> Result<ConnectTarget, Exit> {
    let target = parse(line.connect)?;
    let on_can = matches!(target, ConnectTarget::Can { .. });
    if !on_can && line.address.is_some_and(|list| !list.is_of_one_family()) {
        return Err(Exit::Usage.saying(CliLinkMessage::OneFamily { addresses: addresses_text() }));
    }
    Ok(at_addresses(target, line.numbers()))
}

fn parse(target: &str) -> Result<ConnectTarget, Exit> {
    target
        .parse()
        .map_err(|error| Exit::Usage.saying(CliLinkMessage::NoTarget { target: target.to_string(), error }))
}

/// The family that is meant: as the target or `--family` says.
pub fn family(target: &ConnectTarget, args: &ConnectArgs) -> FamilyChoice {
    let simulated = family::families().iter().find(|family| first_of(target, **family).is_some());
    match simulated {
        Some(family) => FamilyChoice::of(family.family()),
        None if target.family() != FamilyChoice::AUTO => target.family(),
        None => args.family,
    }
}

/// What is meant: as given, or the first one of units that are simulated, or the factory's of the family.
fn addresses(target: &ConnectTarget, args: &ConnectArgs) -> Addresses {
    match (&args.address, family(target, args).family()) {
        (Some(list), _) => list.sought(),
        (None, Some(family)) => {
            let first = first_of(target, family::of(family));
            Addresses::Only(first.unwrap_or_else(|| family.factory_address()))
        }
        (None, None) => Addresses::Factory,
    }
}

/// The first of simulated units, if they are the family's.
fn first_of(target: &ConnectTarget, family: &dyn Family) -> Option<u8> {
    let ConnectTarget::Sim(text) = target else { return None };
    family.first_simulated(text)
}

/// Simulated controllers are made at the addresses that are asked for, unless the target names some itself.
fn at_addresses(target: ConnectTarget, addresses: &[u8]) -> ConnectTarget {
    match target {
        ConnectTarget::Sim(text)
            if !text.starts_with(LIKE) && !text.contains("address=") && !addresses.is_empty() =>
        {
            let model = if text.is_empty() { examples::model() } else { &text };
            let options = addresses.iter().map(|address| format!(",address={address}"));
            ConnectTarget::Sim(format!("{model}{}", options.collect::<String>()))
        }
        other @ (ConnectTarget::Serial { .. }
        | ConnectTarget::Tcp { .. }
        | ConnectTarget::Can { .. }
        | ConnectTarget::Sim(_)) => other,
    }
}

/// Those who answer on a line; none where nobody does, which is said.
///
/// # Errors
/// The program was asked to end.
pub fn found(target: &ConnectTarget, line: &Line<'_>, interrupt: &Interrupt) -> Result<Vec<Identity>, Exit> {
    let options = SessionOptions { addresses: line.sought(), family: line.family, poll: PollRate::Off };
    let session = match session::open(target, options, SystemClock::shared(), None) {
        Ok(session) => session,
        Err(error) => {
            say(error);
            return Ok(Vec::new());
        }
    };
    interrupt.hold_line();
    let (found, failures) = look_on(&session, interrupt)?;
    failures.iter().for_each(say);
    Ok(found)
}

/// Those who answer on an open line, and what failed in finding them.
fn look_on(session: &Session, interrupt: &Interrupt) -> Result<(Vec<Identity>, Vec<Failure>), Exit> {
    let (mut found, mut failures) = (Vec::new(), Vec::new());
    let deadline = Instant::now() + CONNECT_LIMIT;
    while Instant::now() < deadline {
        match look_for_event(&session.device, interrupt)? {
            Ok(Some(Event::Connected(identity))) => found.push(identity),
            Ok(Some(Event::Selected { .. })) => break,
            Ok(Some(Event::Failure(failure))) => failures.push(failure),
            Ok(_) => {}
            Err(failure) => {
                failures.push(failure);
                break;
            }
        }
    }
    Ok((found, failures))
}

/// The one unit of a line of a named family that answers at another address than that of a new one, where the user has named none. A line
/// of which nothing is known is not searched: its families have more than 120 addresses, and the failure says which family to name.
///
/// # Errors
/// Several answer, which is said; or the program was asked to end.
fn elsewhere(args: &ConnectArgs, interrupt: &Interrupt) -> Result<Option<Identity>, Exit> {
    let target = target(args)?;
    let is_line = matches!(target, ConnectTarget::Serial { .. } | ConnectTarget::Tcp { .. });
    let named = family(&target, args);
    if args.address.is_some() || !is_line || named == FamilyChoice::AUTO {
        return Ok(None);
    }
    say(CliLinkMessage::LooksElsewhere);
    let options = SessionOptions { addresses: Addresses::Scan, family: named, poll: PollRate::Off };
    // A line that cannot be opened any more has failed for a reason that is told already.
    let Ok(session) = session::open(&target, options, SystemClock::shared(), None) else { return Ok(None) };
    let (found, _) = look_on(&session, interrupt)?;
    match found.as_slice() {
        [] => Ok(None),
        [unit] => {
            let (title, place) = (unit.title().to_owned(), unit.named_place());
            say(CliLinkMessage::FoundElsewhere { unit: title, place });
            Ok(Some(unit.clone()))
        }
        several => {
            let places: Vec<_> = several.iter().map(Identity::place).collect();
            Err(Exit::Usage.saying(CliLinkMessage::SeveralElsewhere { places: places.join(", ") }))
        }
    }
}

/// Says what is known of a place at which nobody answers.
pub fn with_loader(exit: Exit, place: &str) -> Exit {
    let waiting = (exit == Exit::NoLink).then(|| session::waiting_at(place)).flatten();
    waiting.into_iter().for_each(say);
    exit
}

/// The unit that is selected, or why the link is gone.
fn wait_for_identity(
    device: &DeviceHandle,
    interrupt: &Interrupt,
) -> Result<Result<(Identity, Option<Stream>), Failure>, Exit> {
    let deadline = Instant::now() + CONNECT_LIMIT;
    let mut found: Vec<Identity> = Vec::new();
    while Instant::now() < deadline {
        let event = match look_for_event(device, interrupt)? {
            Ok(event) => event,
            Err(failure) => return Ok(Err(failure)),
        };
        match event {
            Some(Event::Connected(identity)) => found.push(identity),
            Some(Event::Selected { address, stream }) => {
                let selected = found.iter().find(|identity| identity.address == address).cloned();
                if let Some(identity) = selected {
                    return Ok(Ok((identity, stream)));
                }
            }
            Some(Event::Failure(failure)) => say(failure.to_string()),
            _ => {}
        }
    }
    Err(Exit::NoLink.saying(CliLinkMessage::NoneIdentified { seconds: CONNECT_LIMIT.as_secs() }))
}

/// The next event, or `None` when there was none for a moment.
///
/// # Errors
/// The link is lost (said on standard error) or the program was asked to end.
pub fn next_event(device: &DeviceHandle, interrupt: &Interrupt) -> Result<Option<Event>, Exit> {
    event_within(device, EVENT_SLICE, interrupt)
}

/// The same for one of several links, each of which is looked at for its part of that moment.
///
/// # Errors
/// As for [`next_event`].
pub fn event_of(device: &DeviceHandle, several: usize, interrupt: &Interrupt) -> Result<Option<Event>, Exit> {
    let part = u32::try_from(several.max(1)).unwrap_or(u32::MAX);
    event_within(device, EVENT_SLICE / part, interrupt)
}

fn event_within(
    device: &DeviceHandle,
    slice: Duration,
    interrupt: &Interrupt,
) -> Result<Option<Event>, Exit> {
    look_within(device, slice, interrupt)?.map_err(|failure| Exit::NoLink.saying(failure))
}

/// The same, with the loss of the link as the failure that it is.
///
/// # Errors
/// The link was closed (said on standard error) or the program was asked to end.
pub fn look_for_event(
    device: &DeviceHandle,
    interrupt: &Interrupt,
) -> Result<Result<Option<Event>, Failure>, Exit> {
    look_within(device, EVENT_SLICE, interrupt)
}

fn look_within(
    device: &DeviceHandle,
    slice: Duration,
    interrupt: &Interrupt,
) -> Result<Result<Option<Event>, Failure>, Exit> {
    if interrupt.is_raised() {
        return Err(Exit::Interrupted);
    }
    match receive_within(device.events(), slice) {
        Ok(Event::Lost(failure)) => Ok(Err(failure)),
        Ok(Event::Stopped(report)) if report.from_outside => {
            say(CoreStatusMessage::Stopped { reason: DisarmReason::StopFromOutside });
            Ok(Ok(Some(Event::Stopped(report))))
        }
        Ok(event) => Ok(Ok(Some(event))),
        Err(RecvTimeoutError::Timeout) => Ok(Ok(None)),
        Err(RecvTimeoutError::Disconnected) => Err(Exit::NoLink.saying(CliLinkMessage::Closed)),
    }
}

/// Hands a request to the device thread.
///
/// # Errors
/// It takes none now (said on standard error).
pub fn ask(device: &DeviceHandle, request: Request) -> Result<(), Exit> {
    device.request(request).map_err(not_asked)
}

/// Queues a job.
///
/// # Errors
/// It was not taken, which is said on standard error.
pub fn start<T: Send + 'static>(device: &DeviceHandle, job: Job<T>) -> Result<JobTicket<T>, Exit> {
    device.start(job).map_err(not_asked)
}

fn not_asked(refused: impl Display) -> Exit {
    Exit::Refused.saying(CliLinkMessage::NotAsked { refused: refused.to_string() })
}

/// Arms, and says what the device thread warns of.
///
/// # Errors
/// It is refused, or nobody answers; the reasons are said on standard error.
pub fn arm(device: &DeviceHandle, scope: ArmScope, interrupt: &Interrupt) -> Result<(), Exit> {
    arm_all(&[device], scope, interrupt)
}

/// Arms several links at a time. Those that are armed already are renewed until the last one is.
///
/// # Errors
/// One is refused, or nobody answers; the reasons are said on standard error.
#[allow(clippy::wildcard_enum_match_arm, reason = "one answer for all the rest, new members too")]
pub fn arm_all(devices: &[&DeviceHandle], scope: ArmScope, interrupt: &Interrupt) -> Result<(), Exit> {
    for device in devices {
        device.renew();
        ask(device, Request::Arm(scope))?;
    }
    let mut waiting = devices.to_vec();
    let deadline = Instant::now() + ANSWER_LIMIT;
    while !waiting.is_empty() && Instant::now() < deadline {
        let mut still = Vec::new();
        for device in &waiting {
            devices.iter().for_each(|device| device.renew());
            match event_of(device, waiting.len(), interrupt)? {
                Some(Event::Armed { warnings, .. }) => {
                    warnings.iter().for_each(say);
                    continue;
                }
                Some(Event::ArmRefused { reasons, .. }) => {
                    reasons.iter().for_each(|reason| say(reason.to_string()));
                    return Err(Exit::Refused);
                }
                Some(Event::Failure(failure)) => say(failure.to_string()),
                _ => {}
            }
            still.push(*device);
        }
        waiting = still;
    }
    if waiting.is_empty() {
        return Ok(());
    }
    Err(Exit::NoLink.saying(CliLinkMessage::NoAnswerWithin { seconds: ANSWER_LIMIT.as_secs() }))
}

/// Takes events until one gives an answer, renewing the dead-man meanwhile.
///
/// # Errors
/// None does in [`ANSWER_LIMIT`], the link is lost, or the program was asked to end.
pub fn wait<T>(
    device: &DeviceHandle,
    interrupt: &Interrupt,
    mut answer: impl FnMut(Event) -> Option<T>,
) -> Result<T, Exit> {
    let deadline = Instant::now() + ANSWER_LIMIT;
    while Instant::now() < deadline {
        device.renew();
        match next_event(device, interrupt)? {
            Some(Event::Failure(failure)) => say(failure.to_string()),
            Some(event) => {
                if let Some(answer) = answer(event) {
                    return Ok(answer);
                }
            }
            None => {}
        }
    }
    Err(Exit::NoLink.saying(CliLinkMessage::NoAnswerWithin { seconds: ANSWER_LIMIT.as_secs() }))
}
