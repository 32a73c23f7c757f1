//! `brushwork status`: what the controller measures and reports.

use std::time::{Duration, Instant};

use brushwork_link::device::motion_mind::taken;
use brushwork_link::device::{
    Channel, Event, FnJob, Identity, JobEnding, PollRate, Request, Sign, StatusReport,
};
use brushwork_link::diagnosis::{Diagnosis, Evidence, Measured, PinEnd, diagnose, homed, pin_ends};
use brushwork_link::settings::{SettingsImage, Subject, read_all};
use brushwork_link::{Stream, TypedWire as _};
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::commands;
use brushwork_mcp_wire::packet_serial::status::{Condition, Lamp, Severity};
use serde::Serialize;
use serde_json::{Map, Value, json};

use super::args::StatusArgs;
use super::client::Client;
use super::exit::Exit;
use super::interrupt::Interrupt;
use super::output::{Output, OutputError, say};

/// How long the slow signals may take to come round.
const FIRST_READING_LIMIT: Duration = Duration::from_secs(20);
/// How long reading the settings may take.
const SETTINGS_LIMIT: Duration = Duration::from_secs(120);

/// The newest of everything that has been read.
pub struct Readings {
    values: [Option<f64>; Channel::COUNT],
    status: Option<StatusReport>,
    stream: Option<Stream>,
}

/// What a diagnosis needs beyond the readings.
#[derive(Default)]
struct Setup {
    settings: Option<SettingsImage>,
    /// Where the input pins stand, where the unit tells.
    pins: Option<Vec<PinEnd>>,
}

impl Default for Readings {
    fn default() -> Self {
        Self { values: [None; Channel::COUNT], status: None, stream: None }
    }
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
            Event::Sample(sample) => {
                for channel in Channel::ALL {
                    if let Some(value) = sample.get(channel) {
                        self.values[channel.index()] = Some(value);
                    }
                }
            }
            Event::Status(status) => self.status = Some(status),
            Event::Selected { stream, .. } => self.stream = stream,
            Event::Failure(failure) => say(failure.to_string()),
            _ => {}
        }
    }

    /// A channel's newest value.
    pub fn get(&self, channel: Channel) -> Option<f64> {
        self.values[channel.index()]
    }

    fn is_complete(&self, identity: &Identity) -> bool {
        if identity.is_motion_mind() {
            let wanted = [Channel::M1Position, Channel::M1Velocity, Channel::Temperature1];
            return self.status.is_some() && wanted.into_iter().all(|channel| self.get(channel).is_some());
        }
        let wanted = [
            Channel::M1Position,
            Channel::M1Velocity,
            Channel::M1Current,
            Channel::MainBattery,
            Channel::LogicBattery,
            Channel::Temperature1,
        ];
        self.status.is_some() && wanted.into_iter().all(|channel| self.get(channel).is_some())
    }

    /// The channels of a unit but the input pins as JSON, by their keys; what was not read is null.
    pub fn to_json(&self, identity: &Identity) -> Map<String, Value> {
        let polled = identity.channels().iter().copied().filter(|channel| !channel.is_signal());
        polled.map(|channel| (channel.key(), json!(self.get(channel)))).collect()
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
    let Some(model) = models::identify(&client.identity.version_text) else { return Ok(Setup::default()) };
    let subject = Subject::new(model, client.identity.generation);
    let job = FnJob::boxed("read the settings", SETTINGS_LIMIT, move |context| {
        let settings = Some(read_all(context, subject)?.image);
        // A RoboClaw does not know the command; its status word has bits of its own.
        let values = if subject.model.family.speaks_packets() {
            context.ask(commands::READ_SIGNAL_VALUES, &[]).ok()
        } else {
            None
        };
        Ok(Box::new(Setup { settings, pins: values.map(|values| pin_ends(&values)) }))
    });
    if let Err(refused) = client.device().request(Request::Job(job)) {
        say(refused.to_string());
        return Ok(Setup::default());
    }
    loop {
        match client.next_event(interrupt)? {
            Some(Event::JobEnded(report)) => return Ok(setup_of(report.ending)),
            Some(event) => readings.take(event),
            None => {}
        }
    }
}

fn setup_of(ending: JobEnding) -> Setup {
    match ending {
        JobEnding::Done(output) => {
            output.downcast::<Setup>().map_or_else(|_| Setup::default(), |setup| *setup)
        }
        JobEnding::Failed(failure) => {
            say(failure.to_string());
            Setup::default()
        }
        JobEnding::Interrupted(_) | JobEnding::Panicked(_) => Setup::default(),
    }
}

/// Why the motors do not run, as far as anything is known.
fn judge(client: &Client, readings: &Readings, setup: &Setup) -> Option<Diagnosis> {
    let status = readings.status.filter(|_| !client.identity.is_motion_mind())?;
    Some(diagnose(&Evidence {
        settings: setup.settings.as_ref(),
        pins: setup.pins.as_deref(),
        stream: readings.stream,
        measured: Measured::of(|channel| readings.get(channel)),
        ..Evidence::of(&status, &client.identity)
    }))
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
    if let Some(facts) = identity.motion_mind {
        out.line(format!(
            "{}, {} protocol. Over the serial line it takes {}.",
            capital(&facts.mode.to_string()),
            facts.protocol,
            taken(facts.mode)
        ))?;
    }
    for note in &identity.notes {
        out.line(format!("Note: {note}"))?;
    }
    if let Some(diagnosis) = &diagnosis {
        out.line(diagnosis.sentence())?;
    }
    out.line("")?;
    let rows: Vec<Vec<String>> = Channel::ALL
        .into_iter()
        .filter_map(|channel| {
            let value = readings.get(channel)?;
            let digits = decimals(channel);
            Some(vec![channel.label().to_owned(), format!("{value:>12.digits$}"), channel.unit().to_owned()])
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
    match channel.unit() {
        "A" => 2,
        "V" | "°C" | "%" => 1,
        _ => 0,
    }
}

fn lamps(readings: &Readings, client: &Client, setup: &Setup) -> Vec<LampState> {
    if client.identity.is_motion_mind() {
        return signs(readings, &client.identity);
    }
    let homed =
        setup.settings.as_ref().zip(setup.pins.as_deref()).map(|(settings, ends)| homed(settings, ends));
    let state = |lamp: Lamp| match readings.status.map(|status| status.lamp(lamp)) {
        None => "unknown",
        Some(None) => dark(lamp, client, homed),
        Some(Some(Severity::Signal)) => "active",
        Some(Some(Severity::Warning)) => "warning",
        Some(Some(Severity::Error)) => "ERROR",
    };
    Lamp::ALL
        .into_iter()
        .map(|lamp| LampState { lamp: lamp.abbreviation(), title: lamp.title(), state: state(lamp) })
        .collect()
}

/// The signs of a family with a status of its own.
fn signs(readings: &Readings, identity: &Identity) -> Vec<LampState> {
    let state = |sign: &Sign| match (readings.status, sign.severity) {
        (None, _) => "unknown",
        (Some(status), _) if status.word & sign.mask == 0 => "OK",
        (_, Severity::Signal) => "active",
        (_, Severity::Warning) => "warning",
        (_, Severity::Error) => "ERROR",
    };
    let row = |sign: &'static Sign| LampState { lamp: sign.short, title: sign.title, state: state(sign) };
    identity.signs().iter().map(row).collect()
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters
        .next()
        .map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + letters.as_str())
}

/// A lamp that the status word does not light: a home lamp is lit by the actions of the pins where the word has no bit.
fn dark(lamp: Lamp, client: &Client, homed: Option<[bool; 2]>) -> &'static str {
    let by_pins = match lamp {
        Lamp::M1Home => homed.map(|homed| homed[0]),
        Lamp::M2Home => homed.map(|homed| homed[1]),
        _ => None,
    };
    match by_pins {
        Some(true) => "active",
        Some(false) => "OK",
        None if lamp.is_reported(client.identity.generation.layout(), client.identity.is_mcp()) => "OK",
        None => "not reported",
    }
}

fn to_json(
    client: &Client,
    readings: &Readings,
    lamps: &[LampState],
    diagnosis: Option<&Diagnosis>,
) -> Value {
    json!({
        "diagnosis": diagnosis.map(Diagnosis::sentence),
        "findings": diagnosis.map(|diagnosis| &diagnosis.findings),
        "identity": client.identity,
        "readings": readings.to_json(&client.identity),
        "status_word": readings.status.map(|status| status.word),
        "conditions": readings.status
            .map(|status| {
                let conditions = status.conditions.iter().map(Condition::title);
                conditions.chain(status.lit().map(|sign| sign.title)).collect::<Vec<_>>()
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
    let first = [Channel::M1Pwm, Channel::M1Velocity, Channel::M1Position, Channel::M1Current];
    if identity.capabilities().motors == 1 {
        return format!("{} | {} °C", motor("M1", first), value(Channel::Temperature1, 5));
    }
    let second = [Channel::M2Pwm, Channel::M2Velocity, Channel::M2Position, Channel::M2Current];
    format!("{} | {} | {} V", motor("M1", first), motor("M2", second), value(Channel::MainBattery, 5))
}
