//! The pages of running text, and the list of shortcuts.

use egui::{Label, RichText, Ui};

use crate::actions::{self, Keys, Menu};
use crate::keys::as_written;
use crate::messages::NameMessage;
use crate::widgets::label::fixed_label_ui;

/// Numbered, in the order a person does them.
const FIRST_STEPS: [(&str, &str); 9] = [
    (
        "Connect",
        "Choose a device at the left and press Connect. The simulated MCP266 is always there and needs no hardware: \
         everything in Brushwork works with it. A controller on USB appears in the list by itself; for anything else type \
         its path, such as /dev/ttyUSB0 or COM3, or tcp:host:port. Connecting never moves a motor.",
    ),
    (
        "Look",
        "The row at the top shows temperatures, currents, encoders, speeds and batteries. The indicators at the bottom are \
         green when all is well. Device Status says in one sentence why a motor would not run.",
    ),
    (
        "Set the limits first",
        "In General Settings, set the highest current of each motor and the lowest and highest battery voltage. Edits \
         are kept here until Write sends them to the controller's RAM. What is in RAM is lost when the controller is \
         switched off, until Save to EEPROM keeps it. The mark at the bottom right tells the two apart.",
    ),
    (
        "Give the motor room",
        "Before anything moves: lift the wheels, clear the travel, and know how the power is cut. Stop All, Space and \
         Esc stop every motor of every open device at any time.",
    ),
    (
        "Turn it",
        "Go to PWM Settings and arm the screen. Move the slider a little. The motor turns while the screen is armed; \
         leaving the screen, a fault, or closing the window stops it. If the encoder counts down while the duty is \
         positive, swap two motor wires or two encoder wires.",
    ),
    (
        "Close the loop",
        "Velocity Settings holds the speed loop. Set QPPS to the speed at full duty in counts per second first, then P, \
         I and D. The graph shows the setpoint and what the motor makes of it.",
    ),
    (
        "Script it",
        "The MCL Editor holds programs that run in the controller itself. Open an example from the File menu, press Download, \
         arm the screen and press Run; the Terminal shows what the program says, the Debugger where it stands. Simulated \
         controllers run what is compiled here; a real one takes files of its maker's compiler.",
    ),
    (
        "Keep it",
        "Save Settings in the Device menu writes RAM to EEPROM and reads it back. Save Profile in the File menu keeps all \
         settings in a file that can be opened, compared and taken over on another controller.",
    ),
    (
        "Find things",
        "Ctrl+Shift+P searches everything that can be done. Keyboard Shortcuts lists all keys. The simulated world \
         (Ctrl+B) does to the simulated machine what hands would do: loads, switches, batteries, faults.",
    ),
];

pub fn first_steps_ui(ui: &mut Ui) {
    ui.heading("First steps");
    for (index, (title, text)) in FIRST_STEPS.iter().enumerate() {
        ui.add_space(6.0);
        ui.strong(format!("{}. {title}", index + 1));
        ui.label(*text);
    }
}

/// Keys that belong to widgets and not to actions.
const OF_WIDGETS: [(&str, &str, &str); 7] = [
    ("Tab, Shift+Tab", "Next, previous", "Goes to the next or previous thing that can be used."),
    ("Enter", "Press", "Presses the button that has the focus; Space stops the motors instead."),
    ("Arrow keys", "One step", "On a slider. Elsewhere they go to what lies in that direction."),
    ("Shift+Arrows", "Ten steps", "On a slider."),
    ("Page Up, Down", "A tenth of the range", "On a slider."),
    ("Home", "To zero", "On a slider."),
    ("Ctrl+wheel", "Zoom", "On a graph."),
];

pub fn shortcuts_ui(ui: &mut Ui, search: &str) {
    let fits = |text: &str| text.to_lowercase().contains(&search.trim().to_lowercase());
    for menu in Menu::ALL {
        let with_keys = actions::of_menu(menu).filter(|action| action.keys != Keys::None);
        let rows: Vec<_> = with_keys.map(|action| (action.keys_text(ui.ctx()), action)).collect();
        let rows = rows.iter().filter(|(keys, action)| fits(keys) || fits(action.title) || fits(action.help));
        let rows: Vec<_> = rows.map(|(keys, action)| (keys.as_str(), action.title, action.help)).collect();
        table_ui(ui, menu.title(), &rows);
    }
    let rows = OF_WIDGETS.map(|(keys, what, help)| (as_written(ui.ctx(), keys), what, help));
    let rows = rows.iter().filter(|(keys, what, help)| fits(keys) || fits(what) || fits(help));
    let rows: Vec<_> = rows.map(|(keys, what, help)| (keys.as_str(), *what, *help)).collect();
    table_ui(ui, "In widgets", &rows);
}

/// Room for "Ctrl+Shift+S" and for the longest title.
const KEYS_WIDTH: f32 = 112.0;
const WHAT_WIDTH: f32 = 216.0;

fn table_ui(ui: &mut Ui, title: &str, rows: &[(&str, &str, &str)]) {
    if rows.is_empty() {
        return;
    }
    ui.add_space(4.0);
    ui.strong(title);
    for (keys, what, help) in rows {
        ui.horizontal_top(|ui| {
            fixed_label_ui(ui, keys, KEYS_WIDTH);
            fixed_label_ui(ui, what, WHAT_WIDTH);
            ui.add(Label::new(RichText::new(as_written(ui.ctx(), help)).weak()).wrap());
        });
    }
}

pub fn about_ui(ui: &mut Ui) {
    ui.heading(NameMessage::Program { version: env!("CARGO_PKG_VERSION") }.to_string());
    ui.label(
        "Configures, drives and tunes brushed-DC motor controllers over their serial protocols. It carries simulated \
         controllers, so that everything in it can be used and learned with no hardware on the table.",
    );
    ui.add_space(6.0);
    ui.label(
        NameMessage::System {
            licence: env!("CARGO_PKG_LICENSE"),
            system: std::env::consts::OS,
            processor: std::env::consts::ARCH,
        }
        .to_string(),
    );
    ui.label("Speaks packet serial with the MCP and RoboClaw families, firmware generations 1 to 4.");
    ui.add_space(6.0);
    ui.weak("The simulated controllers follow the manuals and what public clients put on the wire. Where the manuals are \
         silent, a behaviour is assumed; the packet serial reference marks each such place.");
    ui.weak("Names of makers and products belong to their owners. This program is not theirs.");
}
