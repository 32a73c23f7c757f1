//! `brushwork status`: what the controller measures and reports.

use std::time::{Duration, Instant};

use brushwork_link::Stream;
use brushwork_link::device::{
    Channel, Event, Identity, Job, JobEnding, Newest, PlaceState, PollRate, StatusPlace, StatusReport,
};
use brushwork_link::settings::{SettingsImage, read_all};
use brushwork_values::Severity;
use serde::Serialize;
use serde_json::{Map, Value, json};

use super::args::StatusArgs;
use super::client::Client;
use super::exit::Exit;
use super::family::{self, Known, Said};
use super::interrupt::Interrupt;
use super::output::{Output, OutputError, say};

/// How long the slow signals may take to come round.
const FIRST_READING_LIMIT: Duration = Duration::from_secs(20);
/// How long reading the settings may take.
const SETTINGS_LIMIT: Duration = Duration::from_secs(120);

/// The newest of everything that has been read.
#[derive(Default)]
pub struct Readings {
    newest: Newest,
    status: Option<StatusReport>,
    stream: Option<Stream>,
}

/// What a diagnosis needs beyond the readings.
#[derive(Default)]
struct Setup {
    settings: Option<SettingsImage>,
    /// Where the input pins stand, where the unit tells.
    inputs: Option<Vec<i64>>,
}

#[derive(Serialize)]
struct LampState {
    lamp: &'static str,
    title: &'static str,
    state: &'static str,
}

impl Readings {
    /// Takes over what an event tells.
    pub fn take(&mut self, event: Event) {
        match event {
            Event::Sample(sample) => self.newest.update(&sample),
            Event::Status(status) => self.status = Some(status),
            Event::Selected { stream, .. } => self.stream = stream,
            Event::Failure(failure) => say(failure.to_string()),
            _ => {}
        }
    }

    /// A channel's newest value.
    pub fn get(&self, channel: Channel) -> Option<f64> {
        self.newest.get(channel)
    }

    fn is_complete(&self, identity: &Identity) -> bool {
        let wanted = [
            Channel::M1_POSITION,
            Channel::M1_VELOCITY,
            Channel::M1_CURRENT,
            Channel::MAIN_BATTERY,
            Channel::LOGIC_BATTERY,
            Channel::TEMPERATURE_1,
        ];
        let is_there = |channel| !identity.channels().contains(&channel) || self.get(channel).is_some();
        self.status.is_some() && wanted.into_iter().all(is_there)
    }

    /// The channels of a unit but the input pins as JSON, by their keys; what was not read is null.
    pub fn to_json(&self, identity: &Identity) -> Map<String, Value> {
        let polled = identity.channels().iter().copied().filter(|channel| !channel.is_pin());
        polled.map(|channel| (channel.key.to_owned(), json!(self.get(channel)))).collect()
    }
}

/// Connects, reads and prints, once or until interrupted.
pub fn run(args: &StatusArgs, out: &mut Output, interrupt: &Interrupt) -> Exit {
    watch(args, out, interrupt).unwrap_or_else(|exit| exit)
}

fn watch(args: &StatusArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let client = Client::connect(&args.connect, PollRate::DEFAULT, interrupt)?;
    let mut readings = Readings::default();
    let first_deadline = Instant::now() + FIRST_READING_LIMIT;
    while !readings.is_complete(&client.identity) && Instant::now() < first_deadline {
        if let Some(event) = client.next_event(interrupt)? {
            readings.take(event);
        }
    }
    let setup = read_setup(&client, &mut readings, interrupt)?;
    print(args, &client, &readings, &setup, out)?;
    if !args.watch {
        return Ok(Exit::Done);
    }
    let mut next = Instant::now() + args.interval;
    loop {
        if let Some(event) = client.next_event(interrupt)? {
            readings.take(event);
        }
        if Instant::now() >= next {
            next += args.interval;
            print(args, &client, &readings, &setup, out)?;
        }
    }
}

/// The settings in RAM and the inputs, for the diagnosis; what cannot be read is told.
fn read_setup(client: &Client, readings: &mut Readings, interrupt: &Interrupt) -> Result<Setup, Exit> {
    let Some(subject) = client.identity.subject() else { return Ok(Setup::default()) };
    let job = Job::new("read the settings", SETTINGS_LIMIT, move |context| {
        let settings = Some(read_all(context, subject)?.image);
        Ok(Setup { settings, inputs: family::of(subject.family()).read_inputs(context) })
    });
    let ticket = match client.device().start(job) {
        Ok(ticket) => ticket,
        Err(refused) => {
            say(refused.to_string());
            return Ok(Setup::default());
        }
    };
    loop {
        match client.next_event(interrupt)? {
            Some(Event::JobEnded(report)) if report.id == ticket.id() => {
                return Ok(setup_of(ticket.ending(report.ending)));
            }
            Some(event) => readings.take(event),
            None => {}
        }
    }
}

fn setup_of(ending: JobEnding<Setup>) -> Setup {
    match ending {
        JobEnding::Done(setup) => setup,
        JobEnding::Failed(failure) => {
            say(failure.to_string());
            Setup::default()
        }
        JobEnding::Interrupted(_) | JobEnding::Panicked(_) => Setup::default(),
    }
}

/// Why the motors do not run, as far as anything is known.
fn judge(client: &Client, readings: &Readings, setup: &Setup) -> Option<Said> {
    family::of(client.identity.family).diagnose(&Known {
        identity: &client.identity,
        status: readings.status.as_ref(),
        newest: &readings.newest,
        stream: readings.stream,
        settings: setup.settings.as_ref(),
        inputs: setup.inputs.as_deref(),
    })
}

fn print(
    args: &StatusArgs,
    client: &Client,
    readings: &Readings,
    setup: &Setup,
    out: &mut Output,
) -> Result<(), OutputError> {
    let diagnosis = judge(client, readings, setup);
    let lamps = lamps(readings, client, setup);
    if args.json {
        let object = to_json(client, readings, &lamps, diagnosis.as_ref());
        return if args.watch { out.json_line(&object) } else { out.json(&object) };
    }
    if args.watch {
        return out.line(line_of(readings, &client.identity));
    }
    let identity = &client.identity;
    let simulated = if identity.simulated { ", simulated" } else { "" };
    out.line(format!(
        "{} at {} on {} ({}{simulated})",
        identity.title(),
        identity.place(),
        identity.port,
        identity.version(),
    ))?;
    if let Some(line) = family::of(identity.family).set_up(identity) {
        out.line(line)?;
    }
    for note in &identity.notes {
        out.line(format!("Note: {note}"))?;
    }
    if let Some(diagnosis) = &diagnosis {
        out.line(&diagnosis.sentence)?;
    }
    out.line("")?;
    let rows: Vec<Vec<String>> = identity
        .channels()
        .iter()
        .filter_map(|&channel| {
            let value = readings.get(channel)?;
            let digits = decimals(channel);
            Some(vec![channel.label.to_owned(), format!("{value:>12.digits$}"), channel.unit.to_owned()])
        })
        .collect();
    out.table(&["SIGNAL", "       VALUE", "UNIT"], &rows)?;
    let lamps: Vec<Vec<String>> = lamps
        .into_iter()
        .map(|lamp| vec![lamp.lamp.to_owned(), lamp.state.to_owned(), lamp.title.to_owned()])
        .collect();
    out.line("")?;
    out.table(&["LAMP", "STATE", "MEANING"], &lamps)
}

fn decimals(channel: Channel) -> usize {
    match channel.unit {
        "A" => 2,
        "V" | "°C" | "%" => 1,
        _ => 0,
    }
}

/// The status row. Home and limit switches go by the actions of the pins where the status word has no bits for them.
fn lamps(readings: &Readings, client: &Client, setup: &Setup) -> Vec<LampState> {
    let family = family::of(client.identity.family);
    let known = setup.settings.as_ref().zip(setup.inputs.as_deref());
    let homed = known.and_then(|(settings, inputs)| family.homed(settings, inputs));
    let state = |state| match state {
        PlaceState::Unknown => "unknown",
        PlaceState::NotReported => "not reported",
        PlaceState::Clear => "OK",
        PlaceState::Active(Severity::Signal) => "active",
        PlaceState::Active(Severity::Warning) => "warning",
        PlaceState::Active(Severity::Error) => "ERROR",
    };
    let lamp =
        |place: StatusPlace| LampState { lamp: place.short, title: place.title, state: state(place.state) };
    client.identity.status_row(readings.status.as_ref(), homed).into_iter().map(lamp).collect()
}

fn to_json(client: &Client, readings: &Readings, lamps: &[LampState], diagnosis: Option<&Said>) -> Value {
    json!({
        "diagnosis": diagnosis.map(|diagnosis| &diagnosis.sentence),
        "findings": diagnosis.map(|diagnosis| &diagnosis.data),
        "identity": client.identity,
        "readings": readings.to_json(&client.identity),
        "status_word": readings.status.map(|status| status.word),
        "conditions": readings.status
            .map(|status| {
                status.active().map(|indicator| indicator.title).collect::<Vec<_>>()
            }),
        "lamps": lamps,
    })
}

/// One line of `--watch` and of `drive`.
pub fn line_of(readings: &Readings, identity: &Identity) -> String {
    let value = |channel: Channel, width: usize| {
        let digits = decimals(channel);
        readings
            .get(channel)
            .map_or_else(|| format!("{:>width$}", "-"), |value| format!("{value:>width$.digits$}"))
    };
    let motor = |name: &str, channels: [Channel; 4]| {
        let [pwm, velocity, position, current] = channels;
        format!(
            "{name} {} % {} counts/s {} counts {} A",
            value(pwm, 6),
            value(velocity, 8),
            value(position, 11),
            value(current, 7)
        )
    };
    let first = [Channel::M1_PWM, Channel::M1_VELOCITY, Channel::M1_POSITION, Channel::M1_CURRENT];
    if identity.capabilities().motors == 1 {
        return format!("{} | {} °C", motor("M1", first), value(Channel::TEMPERATURE_1, 5));
    }
    let second = [Channel::M2_PWM, Channel::M2_VELOCITY, Channel::M2_POSITION, Channel::M2_CURRENT];
    format!("{} | {} | {} V", motor("M1", first), motor("M2", second), value(Channel::MAIN_BATTERY, 5))
}
