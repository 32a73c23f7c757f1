//! The device list: the simulated controller, the serial ports as they come and go, and a field for any other path.

use brushwork_link::device::{Addresses, Identity};
use brushwork_link::transport::PortInfo;
use brushwork_protocol::packet_serial::Address;
use egui::{
    Align2, ComboBox, Key, Response, RichText, Role, Sense, Stroke, StrokeKind, TextStyle, Ui, WidgetInfo,
    pos2, vec2,
};

use super::heading_ui;
use crate::gui::command::{Command, Commands};
use crate::gui::model::devices::{BAUD_RATES, Choice, Devices, SIMULATED};
use crate::gui::model::{Model, Phase};
use crate::gui::theme::Palette;
use crate::gui::widgets::LampState;
use crate::gui::widgets::text_field::text_field_ui;

const ROW_HEIGHT: f32 = 40.0;

pub fn devices_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    heading_ui(ui, "Attached devices");
    let locked = model.front.phase != Phase::Closed;
    ui.spacing_mut().item_spacing.y = 4.0;
    entries_ui(ui, model, locked);
    if model.devices.ports().is_empty() {
        hint_ui(ui, &model.devices);
    }
    ui.add_enabled_ui(!locked, |ui| {
        if path_ui(ui, &mut model.devices) {
            commands.push(Command::Connect);
        }
        options_ui(ui, model);
    });
    connect_ui(ui, &model.front.phase, commands);
    units_ui(ui, model, commands);
}

fn entries_ui(ui: &mut Ui, model: &mut Model, locked: bool) {
    let state = |target: &str| state_of(&model.front.phase, target);
    let mut rows = vec![(
        Choice::Simulated,
        "Simulated MCP266".to_owned(),
        "in this program".to_owned(),
        state(SIMULATED),
    )];
    for port in model.devices.ports() {
        rows.push((Choice::Port(port.name.clone()), port.name.clone(), described(port), state(&port.name)));
    }
    if let (Choice::Port(name), true) = (&model.devices.choice, model.devices.choice_is_gone()) {
        rows.push((model.devices.choice.clone(), name.clone(), "unplugged".to_owned(), Entry::Gone));
    }
    if let (Choice::Typed, Some(target)) = (&model.devices.choice, model.front.phase.target()) {
        rows.push((Choice::Typed, target.to_owned(), "typed below".to_owned(), state(target)));
    }
    for (choice, title, detail, entry) in rows {
        let chosen = model.devices.choice == choice;
        let simulated = choice == Choice::Simulated;
        let clicked = entry_ui(ui, &title, &detail, entry, chosen, simulated).clicked();
        if clicked && !locked {
            model.devices.choice = choice;
        }
    }
}

/// What is so with a device of the list.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Entry {
    Available,
    Connecting,
    Connected,
    Gone,
}

impl Entry {
    const fn word(self) -> &'static str {
        match self {
            Self::Available => "available",
            Self::Connecting => "connecting",
            Self::Connected => "connected",
            Self::Gone => "gone",
        }
    }

    const fn lamp(self) -> LampState {
        match self {
            Self::Available => LampState::Unknown,
            Self::Connecting => LampState::Active,
            Self::Connected => LampState::Ok,
            Self::Gone => LampState::Warning,
        }
    }
}

fn state_of(phase: &Phase, target: &str) -> Entry {
    // A target can carry options behind a comma.
    if phase.target().is_none_or(|open| open != target && !open.starts_with(&format!("{target},"))) {
        return Entry::Available;
    }
    match phase {
        Phase::Open { .. } => Entry::Connected,
        Phase::Closed => Entry::Available,
        Phase::Opening { .. } | Phase::Closing { .. } => Entry::Connecting,
    }
}

/// What a port is, as far as its USB names tell.
fn described(port: &PortInfo) -> String {
    match (&port.product, port.is_usb) {
        (Some(product), _) => product.clone(),
        (None, true) => "USB".to_owned(),
        (None, false) => "serial port".to_owned(),
    }
}

fn entry_ui(ui: &mut Ui, title: &str, detail: &str, entry: Entry, chosen: bool, simulated: bool) -> Response {
    let palette = Palette::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW_HEIGHT), Sense::click());
    let spoken = format!("{title}: {detail}, {}", entry.word());
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, &spoken));
    let outline = match (chosen, response.has_focus() || response.hovered()) {
        (true, _) => Stroke::new(1.5, palette.accent),
        (false, true) => Stroke::new(1.0, palette.weak_text),
        (false, false) => Stroke::new(1.0, palette.line),
    };
    let fill = if chosen { palette.raised } else { palette.panel };
    ui.painter().rect(rect, 4.0, fill, outline, StrokeKind::Inside);
    entry.lamp().paint(ui, pos2(rect.left() + 14.0, rect.center().y), 5.0);
    let (body, small) = (TextStyle::Body.resolve(ui.style()), TextStyle::Small.resolve(ui.style()));
    let painter = ui.painter().with_clip_rect(rect.shrink(4.0));
    let left = rect.left() + 28.0;
    painter.text(pos2(left, rect.top() + 5.0), Align2::LEFT_TOP, title, body, palette.text);
    let below = format!("{detail} · {}", entry.word());
    painter.text(
        pos2(left, rect.bottom() - 5.0),
        Align2::LEFT_BOTTOM,
        below,
        small.clone(),
        palette.weak_text,
    );
    if simulated {
        let at = pos2(rect.right() - 8.0, rect.top() + 7.0);
        let text = painter.text(at, Align2::RIGHT_TOP, "SIM", small, palette.accent);
        painter.rect_stroke(
            text.expand2(vec2(3.0, 1.0)),
            3.0,
            Stroke::new(1.0, palette.accent),
            StrokeKind::Outside,
        );
    }
    response.on_hover_text(format!("{title}\n{detail}"))
}

fn hint_ui(ui: &mut Ui, devices: &Devices) {
    let text = match &devices.listing_failure {
        Some(failure) => failure.to_string(),
        None => "No serial port found. Plug in a controller, or type a path below.".to_owned(),
    };
    let color = Palette::of(ui).weak_text;
    ui.label(RichText::new(text).small().color(color));
}

/// The field for a path; true when Enter was pressed in it.
fn path_ui(ui: &mut Ui, devices: &mut Devices) -> bool {
    let response = text_field_ui(ui, &mut devices.typed, "Other device", "Other: path, tcp:host:port, sim:…");
    if response.changed() {
        devices.choice = if devices.typed.trim().is_empty() { Choice::Simulated } else { Choice::Typed };
    }
    if response.gained_focus() && !devices.typed.trim().is_empty() {
        devices.choice = Choice::Typed;
    }
    let entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    let response = response.on_hover_text(
        "/dev/ttyUSB0, /dev/pts/4, COM3, tcp:127.0.0.1:5000, sim:mcp266,generation=4. Enter connects.",
    );
    let _ = response;
    entered && devices.choice == Choice::Typed
}

/// Address, and the rate where it matters.
fn options_ui(ui: &mut Ui, model: &mut Model) {
    ui.horizontal(|ui| {
        let text = |addresses: Addresses| match addresses {
            Addresses::Scan => "All units".to_owned(),
            Addresses::Only(address) => format!("0x{address:02X}"),
        };
        let combo =
            ComboBox::from_id_salt("address").width(84.0).selected_text(text(model.devices.addresses));
        let response = combo.show_ui(ui, |ui| {
            let each = Address::ALL.into_iter().map(|address| Addresses::Only(address.get()));
            for addresses in std::iter::once(Addresses::Scan).chain(each) {
                ui.selectable_value(&mut model.devices.addresses, addresses, text(addresses));
            }
        });
        name_combo(
            ui,
            &response.response,
            "Address",
            "Which addresses to ask when connecting: all from 0x80 to 0x87, or one",
        );
        if model.devices.baud_matters() {
            let combo =
                ComboBox::from_id_salt("baud").width(70.0).selected_text(model.devices.baud.to_string());
            let response = combo.show_ui(ui, |ui| {
                for baud in BAUD_RATES {
                    ui.selectable_value(&mut model.devices.baud, baud, baud.to_string());
                }
            });
            name_combo(
                ui,
                &response.response,
                "Baud rate",
                "The rate the controller's serial port is set to",
            );
        }
    });
}

fn name_combo(ui: &Ui, response: &Response, name: &str, help: &str) {
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name));
    response.clone().on_hover_text(help);
}

fn connect_ui(ui: &mut Ui, phase: &Phase, commands: &mut Commands) {
    let (text, command) = match phase {
        Phase::Closed => ("Connect", Some(Command::Connect)),
        Phase::Opening { .. } => ("Cancel", Some(Command::Disconnect)),
        Phase::Open { .. } => ("Disconnect", Some(Command::Disconnect)),
        Phase::Closing { .. } => ("Disconnecting", None),
    };
    ui.add_enabled_ui(command.is_some(), |ui| {
        if ui.add_sized(vec2(ui.available_width(), 30.0), egui::Button::new(text)).clicked() {
            commands.extend(command);
        }
    });
}

/// The units of a bus, when there are several.
fn units_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    if model.front.link.units.len() < 2 {
        return;
    }
    heading_ui(ui, "Units on this link");
    for unit in &model.front.link.units {
        let selected = model.front.link.selected == Some(unit.address);
        if ui.selectable_label(selected, unit_text(unit)).clicked() && !selected {
            commands.push(Command::SelectUnit(unit.address));
        }
    }
}

fn unit_text(unit: &Identity) -> String {
    format!("0x{:02X}  {}", unit.address, unit.title())
}
