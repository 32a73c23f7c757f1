//! The start page: what can be connected to and how, what can be tried without hardware, and what can be opened without a controller.

use std::path::Path;

use brushwork_link::PortInfo;
use brushwork_script::language::Language;
use egui::{
    Align, Button, Frame, Key, Layout, Margin, RichText, ScrollArea, Stroke, TextStyle, Ui, WidgetText, vec2,
};

use crate::command::{Command, Commands};
use crate::family::{self, Family};
use crate::focus::{self, Region, region_ui};
use crate::language::{said, word};
use crate::mcl::Editor;
use crate::messages::ButtonMessage;
use crate::model::devices::{Choice, described};
use crate::model::{Model, Screen};
use crate::theme::Palette;
use crate::tune::sketches::{Sketch, sketch_ui};
use crate::widgets::heading_ui;
use crate::widgets::text_field::text_field_ui;

/// Width from which two columns fit.
const TWO_COLUMNS_FROM: f32 = 640.0;
/// Room for the button beside a path, at least.
const OPEN_WIDTH: f32 = 60.0;
/// Recent connections and files that are offered here; the rest of the connections stand in the list at the left.
const RECENT_SHOWN: usize = 4;

pub fn start_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    focus::heading_ui(ui, &word("start", "Start"));
    ui.add_space(4.0);
    region_ui(ui, Region::Controls);
    let columns = if ui.available_width() < TWO_COLUMNS_FROM { 1 } else { 2 };
    ScrollArea::vertical().show(ui, |ui| {
        ui.columns(columns, |ui| {
            // Columns stretch their text from edge to edge, which no paragraph is read by.
            let left = Layout::top_down(Align::Min);
            ui[0].with_layout(left, |ui| {
                ports_ui(ui, model, commands);
                recent_ui(ui, model, commands);
                ui.add_space(10.0);
                files_ui(ui, model, commands);
            });
            ui[columns - 1].with_layout(left, |ui| {
                region_ui(ui, Region::World);
                simulated_ui(ui, &model.mcl, commands);
            });
        });
    });
}

/// The ports as they come and go, and what may be in the way.
fn ports_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    heading_ui(ui, &word("start", "Your controller"));
    let ports = model.devices.ports.clone();
    for port in &ports {
        ui.horizontal(|ui| {
            if ui.button(said(&ButtonMessage::ConnectTo { target: port.name.clone() })).clicked() {
                model.devices.choice = Choice::Port(port.name.clone());
                commands.push(Command::Connect);
            }
            ui.weak(described(port));
        });
    }
    match (&model.devices.listing_failure, ports.is_empty()) {
        (Some(failure), _) => {
            ui.label(failure.to_string());
        }
        (None, true) if model.devices.can_choose => {
            ui.label(word(
                "start",
                "A page reaches a serial port once you have chosen it. The next time it is here by itself.",
            ));
        }
        (None, true) => {
            ui.label(word(
                "start",
                "No serial port is there. Plug the controller in: its port appears here by itself.",
            ));
        }
        (None, false) => {}
    }
    if model.devices.can_choose {
        let hint = word("start", "The browser lists the ports of this computer");
        if ui.button(word("start", "Choose a serial port…")).on_hover_text(hint).clicked() {
            commands.push(Command::ChoosePort);
        }
        ui.weak(word("start", "Family, baud rate and address are chosen at the left. Motors are driven only where the controller stops them by itself when the page is gone."));
    }
    if model.devices.can_choose || cfg!(target_family = "wasm") {
        return;
    }
    ui.weak(word("start", "Family, baud rate and address are chosen at the left, where a path, tcp:HOST:PORT or a CAN adapter can be typed too."));
    ui.collapsing(word("start", "It does not appear, or cannot be opened"), |ui| in_the_way_ui(ui, &ports));
}

/// What keeps a port from appearing or opening on a system, each with what to type where there is something.
fn in_the_way(system: &str, group: &str) -> Vec<(&'static str, Option<String>)> {
    let cable = (
        "Use a cable that carries data, and switch the controller's own supply on: USB alone does not power every board.",
        None,
    );
    let mut advice = vec![cable];
    match system {
        "linux" => {
            advice.extend([
                (
                    "Your user needs the right to open serial ports. Run this, then log out and in again:",
                    Some(format!("sudo usermod -aG {group} $USER")),
                ),
                (
                    "ModemManager opens new ports and writes to them. If the first connection fails, keep it away:",
                    Some("sudo systemctl disable --now ModemManager".to_owned()),
                ),
                (
                    "Where the port never appears, see what the system says when the cable is plugged in:",
                    Some("sudo dmesg --follow".to_owned()),
                ),
            ]);
        }
        "windows" => advice.extend([
            ("The Device Manager lists the port under Ports (COM & LPT), with its number.", Some("devmgmt.msc".to_owned())),
            (
                "Windows 10 and newer have the driver for a controller's own USB. An adapter needs its maker's: FTDI, Prolific, CH340 or CP210x.",
                None,
            ),
            ("A port that another program holds cannot be opened: close Ion Studio, Motion Studio and serial monitors.", None),
        ]),
        "macos" => advice.extend([
            ("Use the name that begins with cu., not tty.:", Some("ls /dev/cu.*".to_owned())),
            ("An adapter may need its maker's driver, which System Settings, Privacy & Security, asks to allow.", None),
        ]),
        _ => {}
    }
    advice.push((
        "On a serial adapter, its ground must be joined to the controller's, RX goes to TX, and the baud rate must be the one that is set there.",
        None,
    ));
    advice
}

fn in_the_way_ui(ui: &mut Ui, ports: &[PortInfo]) {
    // The system is asked once for each list of ports, and not in every frame.
    let key = ui.scope_id().with(ports.iter().map(|port| port.name.as_str()).collect::<Vec<_>>());
    let group = ui.data(|data| data.get_temp::<String>(key)).unwrap_or_else(|| {
        let owning = ports.iter().find_map(|port| brushwork_link::transport::owning_group(&port.name));
        let group = owning.unwrap_or_else(|| "dialout".to_owned());
        ui.data_mut(|data| data.insert_temp(key, group.clone()));
        group
    });
    for (text, typed) in in_the_way(std::env::consts::OS, &group) {
        ui.label(text);
        let Some(typed) = typed else { continue };
        ui.horizontal(|ui| {
            ui.code(&typed);
            if ui
                .button("Copy")
                .on_hover_text(ButtonMessage::Copies { text: typed.clone() }.to_string())
                .clicked()
            {
                ui.ctx().copy_text(typed);
            }
        });
    }
}

fn recent_ui(ui: &mut Ui, model: &Model, commands: &mut Commands) {
    if model.devices.recent.is_empty() {
        return;
    }
    ui.add_space(10.0);
    heading_ui(ui, &word("start", "Connected to before"));
    for target in model.devices.recent.iter().take(RECENT_SHOWN) {
        if ui.button(target).clicked() {
            commands.push(Command::ConnectTo(target.clone()));
        }
    }
}

/// What needs no controller.
fn files_ui(ui: &mut Ui, model: &mut Model, commands: &mut Commands) {
    heading_ui(ui, &word("start", "Without a controller"));
    ui.horizontal_wrapped(|ui| {
        let what = word("start", "A profile, backup, recording, tuning report, script or firmware image");
        if ui.button(word("start", "Open a file…")).on_hover_text(what).clicked() {
            commands.push(Command::ChooseFile);
        }
        if ui
            .button(word("start", "Backups…"))
            .on_hover_text(word("start", "What this computer keeps of each controller"))
            .clicked()
        {
            commands.push(Command::ListBackups);
        }
        if ui
            .button(word("start", "Write a script"))
            .on_hover_text(word("start", "The MCL editor, which checks what is written"))
            .clicked()
        {
            commands.push(Command::Show(Screen::MclEditor));
        }
        if ui
            .button(word("start", "CAN bus…"))
            .on_hover_text(word("start", "Adapters, nodes and what they say"))
            .clicked()
        {
            commands.push(Command::OpenCanOpen);
        }
    });
    ui.horizontal(|ui| {
        let open = word("start", "Open");
        let room =
            WidgetText::from(open.as_str()).into_galley(ui, None, f32::INFINITY, TextStyle::Button).size().x
                + 2.0 * ui.spacing().button_padding.x
                + ui.spacing().item_spacing.x;
        let width = (ui.available_width() - OPEN_WIDTH.max(room)).max(120.0);
        let response = ui
            .allocate_ui(vec2(width, ui.spacing().interact_size.y), |ui| {
                text_field_ui(
                    ui,
                    &mut model.files.path,
                    &word("start", "File to open"),
                    &word("start", "Path of a file, or drop one on this window"),
                )
            })
            .inner;
        let is_entered = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let path = model.files.path.trim().to_owned();
        let is_clicked = ui.add_enabled(!path.is_empty(), Button::new(open)).clicked();
        if (is_entered || is_clicked) && !path.is_empty() {
            commands.push(Command::OpenFile(path.into()));
        }
    });
    ui.weak(word("start", "A profile, backup, recording, tuning report, script or firmware image; its content tells which it is."));
    if let Some(text) = model.front.graph.files.loading_text() {
        ui.weak(text);
    }
    if model.files.recent.is_empty() {
        return;
    }
    ui.add_space(10.0);
    heading_ui(ui, &word("start", "Opened before"));
    for path in model.files.recent.iter().take(RECENT_SHOWN) {
        let name =
            Path::new(path).file_name().map_or_else(|| path.clone(), |name| name.display().to_string());
        if ui.button(name).on_hover_text(path).clicked() {
            commands.push(Command::OpenFile(path.into()));
        }
    }
}

/// One controller of each family, with a picture of the axis that it drives.
fn simulated_ui(ui: &mut Ui, editor: &Editor, commands: &mut Commands) {
    heading_ui(ui, &word("start", "A simulated controller, in this program"));
    ui.weak(word(
        "start",
        "It answers like the real one, with motors, supply and faults of its own. Nothing can break.",
    ));
    for family in family::all() {
        card_ui(ui, *family, editor, commands);
    }
    ui.weak(word("start", "Other models are chosen at the left, beside Simulated."));
}

fn card_ui(ui: &mut Ui, family: &dyn Family, editor: &Editor, commands: &mut Commands) {
    let Some((key, name)) = family.simulated().first().copied() else { return };
    ui.add_space(6.0);
    let outline = Stroke::new(1.0, Palette::of(ui).line);
    Frame::new().stroke(outline).corner_radius(4.0).inner_margin(Margin::same(8)).show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.horizontal(|ui| {
            ui.label(RichText::new(name).strong());
            ui.weak(family.family().label());
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if ui.add(Button::new(said(&ButtonMessage::Open { name: name.to_string() }))).clicked() {
                    commands.push(Command::ConnectTo(format!("sim:{key}")));
                }
            });
        });
        if let Some(language) = family.simulated_program() {
            programs_ui(ui, key, &programs(editor, language), commands);
        }
        sketch_ui(ui, &Sketch::sound(family.simulated_axis()));
    });
}

/// Programs that are offered for a simulated unit to run.
const PROGRAMS_SHOWN: usize = 3;

/// The open programs of a language, title and path, as far as they are in files that a target can name.
fn programs(editor: &Editor, language: Language) -> Vec<(String, String)> {
    let of_language = editor.documents().iter().filter(|document| document.language() == language);
    let paths = of_language
        .filter_map(|document| Some((document.title(), document.path.as_ref()?.to_str()?.to_owned())));
    paths.filter(|(_, path)| !path.contains([',', '?', '&'])).take(PROGRAMS_SHOWN).collect()
}

/// A simulated unit may begin with a program of the user's.
fn programs_ui(ui: &mut Ui, key: &str, programs: &[(String, String)], commands: &mut Commands) {
    if programs.is_empty() {
        ui.weak(word("start", "It runs the program through which this window drives it. A program of yours that is open here, from a file, can be run in its place."));
        return;
    }
    ui.horizontal_wrapped(|ui| {
        for (title, path) in programs {
            let button = ui.button(said(&ButtonMessage::Run { program: title.clone() }));
            let hint = word("start", "Opens a simulated board that runs this file, as it was saved");
            if button.on_hover_text(hint).clicked() {
                commands.push(Command::ConnectTo(format!("sim:{key},program={path}")));
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_system_has_its_own_advice_and_linux_the_very_commands() {
        let typed = |system| -> Vec<String> {
            in_the_way(system, "dialout").into_iter().filter_map(|(_, typed)| typed).collect()
        };
        assert_eq!(typed("linux")[0], "sudo usermod -aG dialout $USER");
        assert!(typed("linux").iter().any(|typed| typed.contains("ModemManager")));
        assert_eq!(typed("windows"), ["devmgmt.msc"]);
        assert_eq!(typed("macos"), ["ls /dev/cu.*"]);
        assert_eq!(in_the_way("plan9", "").len(), 2, "what is true everywhere");
    }
}
