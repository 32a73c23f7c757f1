//! The device list: the simulated controller, the serial ports as they come and go, and a field for any other path.

use brushwork_link::{Addresses, FamilyChoice, Identity};
use egui::{
    Align2, ComboBox, Key, Label, Rect, Response, RichText, Role, Sense, Stroke, StrokeKind, TextStyle, Ui,
    WidgetInfo, pos2, vec2,
};

use egui::containers::menu::MenuButton;

use crate::command::{Command, Commands};
use crate::family::{self, Family};
use crate::language::{said, word};
use crate::model::devices::{BAUD_RATES, Choice, Devices, described};
use crate::model::{Arming, Connection, ConnectionId, IndicatorState, Model, Phase, Simulated, place_of};
use crate::screens::face;
use crate::shell::messages::{DeviceRowMessage, DeviceStateMessage as Stands, ShellMessage};
use crate::theme::Palette;
use crate::widgets::{choice_ui, elided, heading_ui, text_field_ui};

const ROW_HEIGHT: f32 = 54.0;
const RECENT_WIDTH: f32 = 70.0;
/// Room of the small button in the corner of a row.
const END_WIDTH: f32 = 22.0;

pub fn devices_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    heading_ui(ui, &word("bar", "Attached devices"));
    ui.spacing_mut().item_spacing.y = 4.0;
    for row in rows(model) {
        row_ui(ui, &row, model, commands);
    }
    if model.devices.can_choose {
        if ui.button(word("bar", "Choose a serial port…")).clicked() {
            commands.push(Command::ChoosePort);
        }
    } else if model.devices.ports.is_empty() {
        hint_ui(ui, &model.devices);
    }
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let room = vec2(ui.available_width() - RECENT_WIDTH - 4.0, ui.spacing().interact_size.y);
        let entered = ui.allocate_ui(room, |ui| path_ui(ui, &mut model.devices)).inner;
        recent_ui(ui, &model.devices, commands);
        if entered {
            commands.push(Command::Connect);
        }
    });
    options_ui(ui, &mut model.devices);
    connect_ui(ui, model, commands);
    units_ui(ui, model, commands);
}

/// One line of the list: something that can be connected to, or is.
struct Row {
    choice: Choice,
    title: String,
    /// What it is, or who answered there.
    detail: String,
    state: State,
    simulated: bool,
    connection: Option<ConnectionId>,
    is_open: bool,
    /// It is there only because of its connection, and can be taken off the list.
    can_be_forgotten: bool,
}

/// The simulated controller, the ports, then links to anything else.
fn rows(model: &Model) -> Vec<Row> {
    let devices = &model.devices;
    let simulated = &devices.simulated;
    let (place, title) = (
        devices.simulated_target(),
        said(&ShellMessage::Simulated { name: name_of(&simulated.model).to_owned() }),
    );
    let mut rows = vec![row(model, Choice::Simulated, &place, &title, &word("bar", "in this program"))];
    for port in &devices.ports {
        rows.push(row(model, Choice::Port(port.name.clone()), &port.name, &port.name, &described(port)));
    }
    if let (Choice::Port(name), true) = (&devices.choice, devices.choice_is_gone()) {
        let mut gone = row(model, devices.choice.clone(), name, name, &word("bar", "unplugged"));
        gone.state = State(Stands::Gone, IndicatorState::Warning);
        rows.push(gone);
    }
    let mut connections: Vec<&Connection> =
        model.connections().filter(|connection| connection.target.is_some()).collect();
    connections.sort_by_key(|connection| connection.id());
    for connection in connections {
        let target = connection.target.as_deref().unwrap_or_default();
        if !rows.iter().any(|row| row.connection == Some(connection.id())) {
            let detail = word("bar", "named below");
            let mut other =
                row(model, Choice::Connection(connection.id()), &place_of(target), target, &detail);
            other.can_be_forgotten = !other.is_open;
            // Nobody looks whether it is there.
            if other.state.0 == Stands::Available {
                other.state.0 = Stands::Closed;
            }
            rows.push(other);
        }
    }
    rows
}

fn row(model: &Model, choice: Choice, place: &str, title: &str, detail: &str) -> Row {
    let connection = model.connection_at(place);
    let identity = connection.and_then(|connection| connection.link.identity());
    Row {
        choice,
        title: title.to_owned(),
        detail: identity.map_or_else(|| detail.to_owned(), answered),
        state: connection.map_or_else(State::available, State::of),
        simulated: place.starts_with("sim:"),
        connection: connection.map(Connection::id),
        is_open: connection.is_some_and(|connection| connection.phase != Phase::Closed),
        can_be_forgotten: false,
    }
}

/// Model, address and firmware of who answered.
fn answered(identity: &Identity) -> String {
    let firmware = match identity.firmware.as_str() {
        "" => "firmware?".to_owned(),
        version => format!("v{version}"),
    };
    format!("{} · {} · {firmware}", identity.title(), identity.place())
}

/// What is so with a device: a word, and an indicator that says the same by colour and shape.
struct State(Stands, IndicatorState);

impl State {
    const fn available() -> Self {
        Self(Stands::Available, IndicatorState::Unknown)
    }

    fn of(connection: &Connection) -> Self {
        match &connection.phase {
            Phase::Closed if connection.lost.is_some() => Self(Stands::LinkLost, IndicatorState::Error),
            Phase::Closed if connection.could_not_open => Self(Stands::NotOpened, IndicatorState::Warning),
            Phase::Closed => Self::available(),
            Phase::Opening { .. } => Self(Stands::Connecting, IndicatorState::Active),
            Phase::Closing { .. } => Self(Stands::Disconnecting, IndicatorState::Active),
            Phase::Open { .. } if connection.link.identity().is_none() => {
                Self(Stands::Looking, IndicatorState::Active)
            }
            Phase::Open { .. } => Self::of_unit(connection),
        }
    }

    fn of_unit(connection: &Connection) -> Self {
        match (connection.link.indicators.worst(), connection.link.arming) {
            (IndicatorState::Error, _) => Self(Stands::WithError, IndicatorState::Error),
            (_, Arming::Armed { .. }) => Self(Stands::Armed, IndicatorState::Active),
            (IndicatorState::Warning, _) => Self(Stands::WithWarning, IndicatorState::Warning),
            _ => Self(Stands::Connected, IndicatorState::Ok),
        }
    }
}

fn row_ui(ui: &mut Ui, row: &Row, model: &mut Model, commands: &mut Commands) {
    let chosen = model.devices.choice == row.choice;
    let in_front = row.is_open && row.connection == Some(model.front.id());
    let several = model.connections().filter(|connection| connection.phase != Phase::Closed).count() > 1;
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), ROW_HEIGHT), Sense::click());
    let (title, detail, state) = (row.title.clone(), row.detail.clone(), said(&row.state.0));
    let with_front = |text: String| match in_front && several {
        true => said(&DeviceRowMessage::InFront { row: text }),
        false => text,
    };
    let row_text =
        DeviceRowMessage::Row { title: title.clone(), detail: detail.clone(), state: state.clone() };
    let spoken = with_front(said(&row_text));
    response.widget_info(|| WidgetInfo::selected(Role::Button, true, chosen, &spoken));
    paint_row(ui, rect, row, (chosen, in_front && several), &response);
    end_ui(ui, rect, row, commands);
    if response.clicked() {
        model.devices.choice = row.choice.clone();
        commands.extend(row.connection.filter(|_| row.is_open).map(Command::Front));
    }
    if response.double_clicked() && !row.is_open {
        commands.push(Command::Connect);
    }
    response.on_hover_text(with_front(said(&DeviceRowMessage::Hint { title, detail, state })));
}

/// The small button in the row's corner: ends the link, or takes a closed one off the list.
fn end_ui(ui: &mut Ui, rect: Rect, row: &Row, commands: &mut Commands) {
    let Some(connection) = row.connection.filter(|_| row.is_open || row.can_be_forgotten) else { return };
    let title = row.title.clone();
    let (name, command) = match row.is_open {
        true => (DeviceRowMessage::DisconnectFrom { title }, Command::Disconnect(connection)),
        false => (DeviceRowMessage::Forget { title }, Command::Forget(connection)),
    };
    let name = said(&name);
    let at = Rect::from_center_size(pos2(rect.right() - 13.0, rect.bottom() - 11.0), vec2(20.0, 16.0));
    let response = ui.interact(at, ui.scope_id().with((&row.title, "end")), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
    let palette = Palette::of(ui);
    let ring =
        if response.has_focus() { Stroke::new(2.0, palette.accent) } else { Stroke::new(1.0, palette.line) };
    let fill = if response.hovered() { palette.line } else { palette.raised };
    ui.painter().rect(at, 3.0, fill, ring, StrokeKind::Inside);
    let font = TextStyle::Button.resolve(ui.style());
    ui.painter().text(at.center(), Align2::CENTER_CENTER, "×", font, palette.text);
    if response.on_hover_text(&name).clicked() {
        commands.push(command);
    }
}

fn paint_row(ui: &Ui, rect: Rect, row: &Row, (chosen, in_front): (bool, bool), response: &Response) {
    let palette = Palette::of(ui);
    let outline = match (chosen || response.has_focus(), response.hovered()) {
        (true, _) => Stroke::new(if response.has_focus() { 2.0 } else { 1.5 }, palette.accent),
        (false, true) => Stroke::new(1.0, palette.weak_text),
        (false, false) => Stroke::new(1.0, palette.line),
    };
    let fill = if chosen { palette.raised } else { palette.panel };
    let painter = ui.painter().with_clip_rect(rect);
    painter.rect(rect, 4.0, fill, outline, StrokeKind::Inside);
    if in_front {
        let bar = Rect::from_min_max(
            rect.left_top() + vec2(2.0, 4.0),
            pos2(rect.left() + 5.0, rect.bottom() - 4.0),
        );
        painter.rect_filled(bar, 1.0, palette.accent);
    }
    row.state.1.paint(ui, pos2(rect.left() + 16.0, rect.top() + 14.0), 5.0);
    let (body, small) = (TextStyle::Body.resolve(ui.style()), TextStyle::Small.resolve(ui.style()));
    let left = rect.left() + 28.0;
    let mut room = rect.shrink(4.0);
    if row.simulated {
        let at = pos2(rect.right() - 8.0, rect.top() + 7.0);
        let tag = painter.text(at, Align2::RIGHT_TOP, "SIM", small.clone(), palette.accent);
        let frame = tag.expand2(vec2(3.0, 1.0));
        painter.rect_stroke(frame, 3.0, Stroke::new(1.0, palette.accent), StrokeKind::Outside);
        room.max.x = frame.left() - 4.0;
    }
    let title_at = (pos2(left, rect.top() + 5.0), Align2::LEFT_TOP);
    elided(&painter, title_at, (&row.title, body, palette.text), room.right() - left);
    let (below, width) = ((pos2(left, rect.top() + 23.0), Align2::LEFT_TOP), rect.right() - 4.0 - left);
    elided(&painter, below, (&row.detail, small.clone(), palette.weak_text), width);
    let at_the_end = (pos2(left, rect.bottom() - 5.0), Align2::LEFT_BOTTOM);
    let end_width = if row.connection.is_some() { END_WIDTH } else { 0.0 };
    elided(&painter, at_the_end, (&said(&row.state.0), small, palette.text), width - end_width);
}

fn hint_ui(ui: &mut Ui, devices: &Devices) {
    let text = match &devices.listing_failure {
        Some(failure) => failure.to_string(),
        None => word("bar", "No serial port found. Plug in a controller, or type a path below."),
    };
    ui.label(RichText::new(text).small().weak());
}

/// The field for a path; true when Enter was pressed in it.
fn path_ui(ui: &mut Ui, devices: &mut Devices) -> bool {
    let response =
        text_field_ui(ui, &mut devices.typed, &word("bar", "Other device"), &word("bar", "Path, tcp:, sim:"));
    if response.changed() {
        devices.choice = if devices.typed.trim().is_empty() { Choice::Simulated } else { Choice::Typed };
    }
    if response.gained_focus() && !devices.typed.trim().is_empty() {
        devices.choice = Choice::Typed;
    }
    let entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    let response = response.on_hover_text(word(
        "bar",
        "/dev/ttyUSB0, /dev/pts/4, COM3, tcp:127.0.0.1:5000, sim:mcp266,generation=4. Enter connects.",
    ));
    let _ = response;
    entered && devices.choice == Choice::Typed
}

/// Address, and the rate where it matters.
fn options_ui(ui: &mut Ui, devices: &mut Devices) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        if devices.choice == Choice::Simulated {
            model_ui(ui, &mut devices.simulated);
        }
        if devices.simulated_addresses().is_none() {
            let shown = devices.addresses();
            devices.addresses = address_ui(ui, shown, devices.wanted_family());
        }
        if devices.baud_matters() {
            baud_ui(ui, &mut devices.baud);
        }
    });
    if devices.choice == Choice::Simulated {
        face::of(devices.wanted_family()).simulated_ui(ui, &mut devices.simulated);
    }
    if devices.family_matters() {
        let mut family = devices.family;
        family_ui(ui, &mut family);
        if family != devices.family {
            devices.look_for(family);
        }
    }
}

/// The model's name.
fn name_of(model: &str) -> &str {
    family::simulated_models().find(|(key, _)| *key == model).map_or(model, |(_, name)| name)
}

/// Which model is simulated.
fn model_ui(ui: &mut Ui, simulated: &mut Simulated) {
    let models = family::simulated_models().map(|(key, _)| key);
    let (list, mut chosen) =
        (ComboBox::from_id_salt("simulated model").width(104.0), simulated.model.as_str());
    choice_ui(ui, list, &word("bar", "Simulated model"), &mut chosen, models, name_of)
        .on_hover_text(word("bar", "Which controller is simulated in this program"));
    if chosen != simulated.model {
        simulated.model = chosen.to_owned();
    }
}

/// Which family the controllers at a port are of.
fn family_ui(ui: &mut Ui, chosen: &mut FamilyChoice) {
    let list = ComboBox::from_id_salt("family").width(168.0);
    let name = word("bar", "Controller family");
    let response = choice_ui(ui, list, &name, chosen, FamilyChoice::all(), FamilyChoice::label);
    let help = word(
        "bar",
        "Find out asks for MCP and RoboClaw first, then for Motion Minds, at one bit rate. Choosing the family is quicker, and \
                brings its usual bit rate.",
    );
    response.on_hover_text(help);
}

fn address_ui(ui: &mut Ui, shown: Addresses, family: &dyn Family) -> Addresses {
    let text = |addresses: Addresses| match addresses {
        Addresses::Scan => word("bar", "Scan all"),
        Addresses::These(_) => word("bar", "Several"),
        Addresses::Factory => word("bar", "Factory"),
        Addresses::Only(address) => family.address_label(address),
    };
    let mut chosen = shown;
    let each = (0..=u8::MAX).filter(|number| family.family().has_address(*number));
    let list = ComboBox::from_id_salt("address").width(72.0).truncate();
    let each = std::iter::once(Addresses::Scan).chain(each.map(Addresses::Only));
    let (all, cost) = (family.family().addresses(), family.scan_cost());
    let help = said(&ShellMessage::WhichAddresses { all, cost });
    choice_ui(ui, list, &word("bar", "Address"), &mut chosen, each, text).on_hover_text(help);
    chosen
}

fn baud_ui(ui: &mut Ui, chosen: &mut u32) {
    let list = ComboBox::from_id_salt("baud").width(64.0);
    choice_ui(ui, list, &word("bar", "Baud rate"), chosen, BAUD_RATES, |baud| baud.to_string())
        .on_hover_text(word("bar", "The rate the controller's serial port is set to"));
}

fn recent_ui(ui: &mut Ui, devices: &Devices, commands: &mut Commands) {
    let recent = &devices.recent;
    let menu = ui.add_enabled_ui(!recent.is_empty(), |ui| {
        let button = egui::Button::new(word("bar", "Recent")).min_size(vec2(RECENT_WIDTH, 0.0));
        MenuButton::from_button(button).ui(ui, |ui| {
            ui.set_min_width(200.0);
            for target in recent {
                if ui.button(target).clicked() {
                    commands.push(Command::ConnectTo(target.clone()));
                    ui.close();
                }
            }
            ui.separator();
            if ui.button(word("bar", "Forget all")).clicked() {
                commands.extend(recent.iter().cloned().map(Command::ForgetRecent));
                ui.close();
            }
        })
    });
    menu.inner.0.on_hover_text(word("bar", "Earlier connections"));
}

/// Connects to what is chosen, or ends the link to it.
fn connect_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    let chosen = rows(model).into_iter().find(|row| row.choice == model.devices.choice);
    let connection = chosen.and_then(|row| row.connection).and_then(|id| model.connection(id));
    let end = connection.map(|connection| Command::Disconnect(connection.id()));
    let searching = connection.and_then(|connection| connection.link.searching.as_ref());
    let (text, command) = match connection.map(|connection| &connection.phase) {
        None | Some(Phase::Closed) => (word("bar", "Connect"), Some(Command::Connect)),
        Some(Phase::Opening { .. }) => (word("bar", "Cancel"), end),
        Some(Phase::Open { .. }) if searching.is_some() => (word("bar", "Cancel"), end),
        Some(Phase::Open { .. }) => (word("bar", "Disconnect"), end),
        Some(Phase::Closing { .. }) => (word("bar", "Disconnecting"), None),
    };
    ui.add_enabled_ui(command.is_some(), |ui| {
        if ui.add_sized(vec2(ui.available_width(), 30.0), egui::Button::new(text)).clicked() {
            commands.extend(command);
        }
    });
    if let Some(search) = searching {
        let bar = egui::ProgressBar::new(search.done as f32 / search.of.max(1) as f32);
        let text =
            said(&ShellMessage::Searched { what: search.what.clone(), done: search.done, of: search.of });
        let response = ui.add(bar.desired_width(ui.available_width()).text(&text));
        let spoken = said(&ShellMessage::Searching { text: text.clone() });
        response.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, &spoken));
    }
}

/// Every unit that is connected, when there are several: those of the link in front, then those of the others.
fn units_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    let front = &model.front;
    let mut others: Vec<&Connection> =
        model.others.iter().filter(|connection| connection.is_connected()).collect();
    others.sort_by_key(|connection| connection.id());
    let has_own = front.is_connected() && (front.link.units.len() > 1 || !others.is_empty());
    if !has_own && others.is_empty() {
        return;
    }
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 1.0;
        if has_own {
            heading_ui(ui, &word("bar", "Units on this link"));
            for unit in &front.link.units {
                board_ui(ui, front, unit, true, commands);
            }
        }
        for connection in others {
            let target = connection.phase.target().unwrap_or_default();
            ui.add_space(4.0);
            ui.add(Label::new(RichText::new(target).small().weak()).truncate()).on_hover_text(target);
            for unit in &connection.link.units {
                board_ui(ui, connection, unit, false, commands);
            }
        }
    });
}

/// One unit of several, in two lines, so that five of them leave room for the screens: who it is, then how it is.
fn board_ui(ui: &mut Ui, connection: &Connection, unit: &Identity, in_front: bool, commands: &mut Commands) {
    let link = &connection.link;
    let (state, standing) = link.boards.state(unit.address);
    ui.horizontal(|ui| {
        let (rect, _) = ui.allocate_exact_size(vec2(12.0, 12.0), Sense::hover());
        state.paint(ui, rect.center(), 4.0);
        let selected = link.selected == Some(unit.address);
        let label = ui.selectable_label(in_front && selected, unit_text(unit));
        if !in_front {
            // Boards of two links may have one address.
            let name = said(&ShellMessage::UnitOn { unit: unit_text(unit), port: unit.port.clone() });
            label.widget_info(|| WidgetInfo::selected(Role::Button, true, false, &name));
        }
        if label.clicked() {
            commands.extend((!in_front).then(|| Command::Front(connection.id())));
            commands.extend((!selected).then_some(Command::SelectUnit(unit.address)));
        }
    });
    let figures = link.boards.figures(unit.address);
    ui.scope(|ui| {
        ui.spacing_mut().interact_size.y = 12.0;
        ui.horizontal(|ui| {
            let small = |text: &str| RichText::new(text).small();
            ui.add(Label::new(small(&standing)).truncate()).on_hover_text(&standing);
            if !figures.is_empty() {
                ui.add(Label::new(small(&figures).weak()).truncate()).on_hover_text(&figures);
            }
        });
    });
}

fn unit_text(unit: &Identity) -> String {
    format!("{}  {}", unit.place(), unit.title())
}
