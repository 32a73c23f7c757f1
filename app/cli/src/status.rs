//! `brushwork status`: what the controller measures and reports.

use brushwork_link::messages::ActMessage;
use std::time::{Duration, Instant};

use brushwork_link::capability::{Learned, Presence};
use brushwork_link::device::{
    Channel, Event, Identity, Job, JobEnding, PlaceState, PollRate, Request, StatusPlace,
};
use brushwork_link::settings::read_all;
use brushwork_values::Severity;
use serde::Serialize;
use serde_json::{Value, json};

use super::args::StatusArgs;
use super::client::{ask, event_of};
use super::family::{self, Judged, Said};
use super::joined;
use super::messages::CliUnitsMessage;
use super::{Client, Exit, Interrupt, Output, OutputError, Readings, say};

/// How long the slow signals may take to come round.
const FIRST_READING_LIMIT: Duration = Duration::from_secs(20);
/// How long reading the settings may take.
const SETTINGS_LIMIT: Duration = Duration::from_secs(120);

#[derive(Serialize)]
struct IndicatorState {
    #[serde(rename = "lamp")]
    indicator: &'static str,
    title: &'static str,
    state: &'static str,
}

/// Connects, reads and prints, once or until interrupted.
pub fn run(args: &StatusArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    if args.watch && args.connect.is_several() {
        return watch_several(args, out, interrupt);
    }
    let client = Client::connect(&args.connect, PollRate::DEFAULT, interrupt)?;
    if args.learn_anew {
        ask(client.device(), Request::LearnAnew)?;
    }
    let mut readings = Readings::default();
    let first_deadline = Instant::now() + FIRST_READING_LIMIT;
    while !readings.is_complete(&client.identity) && Instant::now() < first_deadline {
        if let Some(event) = client.next_event(interrupt)? {
            take(&mut readings, &event);
        }
    }
    if !args.together {
        read_setup(&client, &mut readings, interrupt)?;
    }
    print(args, &client.identity, &readings, out)?;
    if !args.watch {
        return Ok(Exit::Done);
    }
    let mut next = Instant::now() + args.interval;
    loop {
        if let Some(event) = client.next_event(interrupt)? {
            take(&mut readings, &event);
        }
        if Instant::now() >= next {
            next += args.interval;
            print(args, &client.identity, &readings, out)?;
        }
    }
}

/// Prints a line for each of several controllers, again and again until interrupted. Each line's units are read in one sweep.
fn watch_several(args: &StatusArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let lines = joined::open(&args.connect, PollRate::DEFAULT, interrupt)?;
    let mut units = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        if let Some(addresses) = line.silent() {
            say(CliUnitsMessage::Silent { addresses, place: line.place.clone() });
        }
        line.join()?;
        units.extend(line.units.iter().map(|identity| (index, identity, Readings::default())));
    }
    let mut next = Instant::now() + args.interval;
    loop {
        for (index, line) in lines.iter().enumerate() {
            let Some(event) = event_of(line.client.device(), lines.len(), interrupt)? else { continue };
            if let Event::Failure(failure) = &event {
                say(failure.to_string());
            }
            let of_unit = event.address();
            let own = units.iter_mut().filter(|(line, unit, _)| {
                *line == index && of_unit.is_none_or(|address| address == unit.address)
            });
            own.for_each(|(_, _, readings)| readings.take(&event));
        }
        if Instant::now() < next {
            continue;
        }
        next += args.interval;
        for (index, identity, readings) in &units {
            let line = &lines[*index];
            if args.json {
                let mut object = json!({ "readings": readings.to_json(identity) });
                object["connect"] = json!(line.place);
                object["address"] = json!(identity.address);
                object["status_word"] = json!(readings.status.map(|status| status.word));
                out.json_line(&object)?;
            } else {
                out.line(format!("{}  {}", line.name_of(identity), line_of(readings, identity)))?;
            }
        }
    }
}

/// Takes over what an event tells; a failure is said.
fn take(readings: &mut Readings, event: &Event) {
    if let Event::Failure(failure) = event {
        say(failure.to_string());
    }
    readings.take(event);
}

/// The settings in RAM and the inputs, for the diagnosis; what cannot be read is told.
fn read_setup(client: &Client, readings: &mut Readings, interrupt: &Interrupt) -> Result<(), Exit> {
    let Some(subject) = client.identity.subject() else { return Ok(()) };
    let job = Job::new(ActMessage::ReadSettings, SETTINGS_LIMIT, move |context| {
        let settings = read_all(context, subject)?.image;
        Ok((settings, family::of(subject.family()).read_inputs(context)))
    });
    let ticket = match client.device().start(job) {
        Ok(ticket) => ticket,
        Err(refused) => {
            say(refused.to_string());
            return Ok(());
        }
    };
    loop {
        match client.next_event(interrupt)? {
            Some(Event::JobEnded(report)) if report.id == ticket.id() => {
                match ticket.ending(report.ending) {
                    JobEnding::Done((settings, inputs)) => {
                        (readings.settings, readings.inputs) = (Some(settings), inputs);
                    }
                    JobEnding::Failed(failure) => say(failure.to_string()),
                    JobEnding::Interrupted(_) | JobEnding::Panicked(_) => {}
                }
                return Ok(());
            }
            Some(event) => take(readings, &event),
            None => {}
        }
    }
}

fn print(
    args: &StatusArgs,
    identity: &Identity,
    readings: &Readings,
    out: &mut Output,
) -> Result<(), OutputError> {
    let family = family::of(identity.family);
    let Judged { diagnosis, homed } = family.judge(identity, readings);
    let indicators = indicators(readings, identity, homed);
    if args.json {
        let mut object = to_json(identity, readings, &indicators, diagnosis.as_ref());
        if args.commands {
            object["commands"] = json!(learned(identity, readings));
        }
        return if args.watch { out.json_line(&object) } else { out.json(&object) };
    }
    if args.watch {
        return out.line(line_of(readings, identity));
    }
    let simulated = if identity.simulated { ", simulated" } else { "" };
    out.line(format!(
        "{} at {} on {} ({}{simulated})",
        identity.title(),
        identity.place(),
        identity.port,
        identity.version(),
    ))?;
    if let Some(line) = family.set_up(identity) {
        out.line(line)?;
    }
    out.lines(identity.notes.iter().map(|note| format!("Note: {note}")))?;
    let settings = identity.family.settings();
    let absent = readings.capabilities.absent().map(|command| settings.learned_phrase(command));
    out.lines(absent.map(|command| format!("Note: This firmware does not have: {command}.")))?;
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
    let indicators: Vec<Vec<String>> = indicators
        .into_iter()
        .map(|indicator| {
            vec![indicator.indicator.to_owned(), indicator.state.to_owned(), indicator.title.to_owned()]
        })
        .collect();
    out.line("")?;
    out.table(&["INDICATOR", "STATE", "MEANING"], &indicators)?;
    if args.commands {
        let row = |known: LearnedCommand| {
            let quickest = known.quickest_ms.map_or_else(|| "-".to_owned(), |ms| format!("{ms:.1}"));
            vec![
                format!("{:>7}", known.command),
                known.title.to_owned(),
                known.presence.label().to_owned(),
                format!("{quickest:>12}"),
            ]
        };
        let rows: Vec<_> = learned(identity, readings).into_iter().map(row).collect();
        out.line("")?;
        out.table(&["COMMAND", "WHAT IT DOES", "ANSWER", "QUICKEST, ms"], &rows)?;
    }
    Ok(())
}

/// One command of this firmware, for people and for JSON.
#[derive(Serialize)]
struct LearnedCommand {
    command: u8,
    title: &'static str,
    presence: Presence,
    quickest_ms: Option<f64>,
}

fn learned(identity: &Identity, readings: &Readings) -> Vec<LearnedCommand> {
    let settings = identity.family.settings();
    let entry = |(command, presence, learned): (u8, Presence, Learned)| LearnedCommand {
        command,
        title: settings.learned_title(command),
        presence,
        quickest_ms: learned.quickest_ms,
    };
    readings.capabilities.entries().map(entry).collect()
}

fn decimals(channel: Channel) -> usize {
    match channel.unit {
        "A" => 2,
        "V" | "°C" | "%" => 1,
        _ => 0,
    }
}

/// The status row. Home and limit switches go by the actions of the pins where the status word has no bits for them.
fn indicators(readings: &Readings, identity: &Identity, homed: Option<[bool; 2]>) -> Vec<IndicatorState> {
    let state = |state| match state {
        PlaceState::Unknown => "unknown",
        PlaceState::NotReported => "not reported",
        PlaceState::Clear => "OK",
        PlaceState::Active(Severity::Signal) => "active",
        PlaceState::Active(Severity::Warning) => "warning",
        PlaceState::Active(Severity::Error) => "ERROR",
    };
    let indicator = |place: StatusPlace| IndicatorState {
        indicator: place.short,
        title: place.title,
        state: state(place.state),
    };
    identity.status_row(readings.status.as_ref(), homed).into_iter().map(indicator).collect()
}

fn to_json(
    identity: &Identity,
    readings: &Readings,
    indicators: &[IndicatorState],
    diagnosis: Option<&Said>,
) -> Value {
    json!({
        "diagnosis": diagnosis.map(|diagnosis| &diagnosis.sentence),
        "findings": diagnosis.map(|diagnosis| &diagnosis.data),
        "identity": identity,
        "readings": readings.to_json(identity),
        "status_word": readings.status.map(|status| status.word),
        "conditions": readings.status
            .map(|status| {
                status.active().map(|indicator| indicator.title).collect::<Vec<_>>()
            }),
        "lamps": indicators,
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
