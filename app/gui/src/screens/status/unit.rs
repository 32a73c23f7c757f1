//! Who the unit is, and how its link does.

use egui::{Button, Grid, Label, Ui};

use crate::command::{Command, Commands};
use crate::family::Ability;
use crate::messages::LinkMessage;
use crate::model::Arming;
use crate::model::connection::Connection;
use crate::screens::messages::StatusMessage;
use crate::widgets::heading::heading_ui;

pub fn unit_ui(ui: &mut Ui, connection: &Connection, commands: &mut Commands) {
    let Some(identity) = connection.link.identity() else { return };
    heading_ui(ui, "Unit and link");
    let addresses = |addresses: &[u8]| {
        let each: Vec<_> = addresses.iter().map(|address| format!("0x{address:02X}")).collect();
        if each.is_empty() {
            String::new()
        } else {
            StatusMessage::AlsoAnswers { addresses: each.join(" ") }.to_string()
        }
    };
    let stream = connection.link.stream.map_or("not known".to_owned(), |stream| stream.to_string());
    let port = match connection.family().lacks(Ability::Streams) {
        Some(_) => identity.port.clone(),
        None => format!("{} ({stream})", identity.port),
    };
    let figures = &connection.link.statistics;
    let rows = [
        ("Says of itself", identity.version_text.trim().to_owned()),
        ("Firmware", format!("{}, {}", or_not_reported(&identity.firmware), identity.generation)),
        ("Address", format!("{}{}", identity.place(), addresses(&identity.also_answers))),
        ("Port", port),
        (
            "Status word",
            connection.link.status.map_or(String::new(), |report| format!("0x{:04X}", report.word)),
        ),
        (
            "Traffic",
            LinkMessage::Traffic {
                kbit_per_s: figures.kbit_per_s,
                requests_per_s: figures.transactions_per_s,
            }
            .to_string(),
        ),
        (
            "Round trip",
            LinkMessage::RoundTrip {
                median: figures.round_trip_median_s * 1000.0,
                most: figures.round_trip_p99_s * 1000.0,
            }
            .to_string(),
        ),
        (
            "Link errors",
            LinkMessage::Errors {
                timeouts: figures.timeouts,
                bad_crc: figures.crc_errors,
                retries: figures.retries,
            }
            .to_string(),
        ),
    ];
    let own = connection.family().unit_row(identity);
    Grid::new("unit").num_columns(2).spacing([14.0, 3.0]).show(ui, |ui| {
        for (label, value) in rows.into_iter().chain(own) {
            ui.weak(label);
            ui.add(Label::new(value).truncate());
            ui.end_row();
        }
    });
    if let Some(lacking) = connection.link.lacking() {
        ui.add_space(4.0);
        ui.add(Label::new(StatusMessage::Lacking { what: lacking }.to_string()).wrap());
    }
    // Also where it is held for complete, which may be as wrong.
    let is_armed = matches!(connection.link.arming, Arming::Armed { .. });
    let button = ui.add_enabled(!is_armed, Button::new("Learn Again"));
    let button = button.on_hover_text(
        "Forgets which commands this firmware has and lacks, here and on this computer, and asks for them again.",
    );
    if button.clicked() {
        commands.push(Command::LearnAnew);
    }
}

fn or_not_reported(text: &str) -> &str {
    if text.is_empty() { "not reported" } else { text }
}
