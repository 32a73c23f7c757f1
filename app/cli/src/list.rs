//! `brushwork list`: serial ports, and the controllers that are simulated in this program.

use brushwork_link::transport::list_ports;
use brushwork_link::{ConnectTarget, Event, Identity, PollRate, PortInfo, SystemClock};
use serde::Serialize;

use super::args::ListArgs;
use super::client::look_for_event;
use super::family::{SimulatedModel, families};
use super::{Exit, Interrupt, Output, OutputError, say};
use brushwork_core::session::{self, SessionOptions};

#[derive(Debug, Serialize)]
struct Listing {
    ports: Vec<PortRow>,
    simulated: Vec<SimulatedRow>,
}

#[derive(Debug, Serialize)]
struct PortRow {
    connect: String,
    description: String,
    units: Option<Vec<Identity>>,
}

#[derive(Debug, Serialize)]
struct SimulatedRow {
    connect: String,
    model: &'static str,
    rating: &'static str,
    assumed: &'static str,
}

/// Lists and prints.
pub fn run(args: &ListArgs, out: &mut Output, interrupt: &Interrupt) -> Result<Exit, Exit> {
    let mut rows = Vec::new();
    for (connect, description) in lines(&args.connect) {
        let units = args.scan.then(|| scan(&connect, interrupt));
        rows.push(PortRow { connect, description, units });
        if interrupt.is_raised() {
            return Err(Exit::Interrupted);
        }
    }
    let listing = Listing { ports: rows, simulated: simulated() };
    let printed = if args.json { out.json(&listing) } else { print(&listing, out) };
    printed?;
    Ok(Exit::Done)
}

/// The lines that are named, or the ports that there are, each with what is known of it.
fn lines(named: &[String]) -> Vec<(String, String)> {
    if !named.is_empty() {
        return named.iter().map(|line| (line.clone(), "named line".to_owned())).collect();
    }
    let ports = list_ports().unwrap_or_else(|failure| {
        say(failure.to_string());
        Vec::new()
    });
    ports.into_iter().map(|port| (port.name.clone(), describe(&port))).collect()
}

/// What the operating system knows of a port.
fn describe(port: &PortInfo) -> String {
    let words = [port.manufacturer.as_deref(), port.product.as_deref(), port.serial_number.as_deref()];
    let text = words.into_iter().flatten().collect::<Vec<_>>().join(" ");
    if port.is_loader() {
        return format!(
            "{text}: waits in its firmware loader; resume its update with: brushwork firmware update --resume"
        );
    }
    match (text.is_empty(), port.usb_id) {
        (false, _) => text,
        (true, Some((vendor, product))) => format!("USB {vendor:04x}:{product:04x}"),
        (true, None) => "serial port".to_owned(),
    }
}

fn simulated() -> Vec<SimulatedRow> {
    let rows = families().iter().flat_map(|family| {
        family.family().models().iter().map(|model| {
            let SimulatedModel { rating, assumed } = family.simulated(model);
            SimulatedRow { connect: format!("sim:{}", model.key), model: model.name, rating, assumed }
        })
    });
    rows.collect()
}

/// Asks all addresses of a port who is there. Reading moves no motor.
fn scan(path: &str, interrupt: &Interrupt) -> Vec<Identity> {
    let target = match path.parse::<ConnectTarget>() {
        Ok(target) => target,
        Err(error) => {
            say(error.to_string());
            return Vec::new();
        }
    };
    let options = SessionOptions { poll: PollRate::Off, ..SessionOptions::default() };
    let session = match session::open(&target, options, SystemClock::shared(), None) {
        Ok(session) => session,
        Err(error) => {
            say(error.to_string());
            return Vec::new();
        }
    };
    let mut units = Vec::new();
    interrupt.hold_line();
    while let Ok(event) = look_for_event(&session.device, interrupt) {
        match event {
            Ok(Some(Event::Connected(identity))) => units.push(identity),
            Err(failure) => {
                say(failure.to_string());
                session::waiting_at(path).into_iter().for_each(say);
                break;
            }
            Ok(Some(Event::Selected { .. })) => break,
            Ok(_) => {}
        }
    }
    units
}

fn print(listing: &Listing, out: &mut Output) -> Result<(), OutputError> {
    if listing.ports.is_empty() {
        out.line(
            "No serial port was found. A path may be typed all the same, for example --connect /dev/pts/3.",
        )?;
    }
    let mut rows = Vec::new();
    for port in &listing.ports {
        rows.push(vec![port.connect.clone(), port.description.clone()]);
        for unit in port.units.iter().flatten() {
            let text = format!("{} {}", unit.place().to_lowercase(), unit.version());
            rows.push(vec![String::new(), text]);
        }
    }
    for row in &listing.simulated {
        let assumed = if row.assumed.is_empty() { "" } else { " (figures partly assumed)" };
        rows.push(vec![row.connect.clone(), format!("simulated {} {}{assumed}", row.model, row.rating)]);
    }
    out.table(&["CONNECT", "WHAT"], &rows)
}
