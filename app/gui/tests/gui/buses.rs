//! The firmware window and the window for CANopen buses, with real links to simulated controllers in this program, in real time.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use brushwork_core::keep::{Keeping, Store};
use brushwork_gui::App;
use brushwork_gui::opener::session_opener;
use brushwork_gui::parts::{Parts, PortSource};
use brushwork_link::Failure;
use brushwork_link::device::{Drive, DriveCommand, Request};
use brushwork_link::transport::PortInfo;
use brushwork_mcp_wire::loader::SimulatedImage;
use brushwork_mcp_wire::models;
use brushwork_mcp_wire::packet_serial::Generation;
use brushwork_plant::world::WorldAction;
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, HarnessBuilder};
use tempfile::TempDir;

use crate::support::cpu::Cpu;
use crate::support::wait::{PATIENCE, Wait};

/// A unit with a small image, so that a transfer takes seconds.
const UNIT: &str = "sim:roboclaw-2x7a";

struct NoPorts;

impl PortSource for NoPorts {
    fn newest(&mut self) -> Option<Result<Vec<PortInfo>, Failure>> {
        None
    }
}

/// A window that opens real links.
struct Window {
    harness: Harness<'static, Rc<RefCell<Option<App>>>>,
    app: Rc<RefCell<Option<App>>>,
    folder: TempDir,
}

impl Window {
    fn new() -> Self {
        crate::support::install_families();
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let keeping = Keeping::new(Store::at(folder.path().join("kept")));
        let mut parts = Some(Parts { ports: Box::new(NoPorts), opener: session_opener(), keeping });
        let app = Rc::new(RefCell::new(None));
        let harness = HarnessBuilder::default()
            .with_size([1280.0, 800.0])
            .with_context_setup(brushwork_gui::theme::install)
            .renderer(Cpu::default())
            .build_ui_state(
                move |ui, slot: &mut Rc<RefCell<Option<App>>>| {
                    let mut slot = slot.borrow_mut();
                    let app = slot.get_or_insert_with(|| {
                        App::new(ui.ctx(), parts.take().expect("the window is made once"))
                    });
                    app.contents(ui);
                },
                Rc::clone(&app),
            );
        Self { harness, app, folder }
    }

    fn open(&mut self, target: &str) {
        self.harness.step();
        self.app.borrow_mut().as_mut().expect("it was drawn").open(target);
        self.until("it is connected", |app| app.model.front.is_connected());
    }

    /// Draws frames until something holds.
    fn until(&mut self, what: &str, holds: impl Fn(&App) -> bool) {
        self.wait_until(what, |window| holds(window.app.borrow().as_ref().expect("it was drawn")));
        self.harness.step();
    }

    fn until_text(&mut self, text: &str) {
        self.wait_until(text, |window| window.harness.query_all_by_label_contains(text).next().is_some());
    }

    /// Draws frames until a widget is there.
    fn wait_for(&mut self, role: Role, label: &str) {
        let is_there = |window: &Self| window.harness.query_by_role_and_label(role, label).is_some();
        self.wait_until(&format!("{role:?} {label:?}"), is_there);
    }

    fn wait_until(&mut self, what: &str, holds: impl Fn(&Self) -> bool) {
        let mut wait = Wait::with_frames();
        while !holds(self) {
            assert!(wait.goes_on(), "waited {PATIENCE:?} for {what}, but: {:?}", self.texts());
            self.harness.step();
        }
    }

    fn click(&mut self, role: Role, label: &str) {
        self.wait_for(role, label);
        let node = self.harness.get_by_role_and_label(role, label);
        node.scroll_to_me();
        self.harness.step();
        self.harness.get_by_role_and_label(role, label).click();
        self.harness.step();
        self.harness.step();
    }

    fn choose(&mut self, menu: &str, item: &str) {
        self.click(Role::Button, menu);
        self.click(Role::MenuItem, item);
    }

    fn is_enabled(&self, label: &str) -> bool {
        !self.harness.get_by_role_and_label(Role::Button, label).accesskit_node().is_disabled()
    }

    fn texts(&self) -> Vec<String> {
        let labels = self.harness.query_all_by_role(Role::Label);
        labels.filter_map(|node| node.accesskit_node().value()).collect()
    }

    /// An image that makes the unit report version 9.8.7.
    fn image(&self) -> PathBuf {
        let model = models::lookup("roboclaw-2x7a").expect("it is listed");
        let image = SimulatedImage { model, version: "9.8.7".to_owned(), generation: Generation::Gen1 };
        let path = self.folder.path().join("new.bin");
        std::fs::write(&path, image.bytes().expect("a version")).expect("it can be written");
        path
    }

    fn type_path(&mut self, path: &Path) {
        self.wait_for(Role::TextInput, "Firmware file");
        let field = self.harness.get_by_role_and_label(Role::TextInput, "Firmware file");
        field.focus();
        field.type_text(&path.display().to_string());
        self.harness.step();
        self.harness.step();
    }
}

const ACCEPT: &str = "I have read this and accept that the controller can become useless";

#[test]
fn firmware_is_updated_after_the_risks_were_accepted_and_the_settings_are_compared_with_the_backup() {
    let mut window = Window::new();
    window.open(UNIT);
    window.choose("Device", "Firmware…");
    window.until_text("INSTALLED");
    assert!(
        window.harness.query_by_label_contains("16 bits").is_some(),
        "what is known: {:?}",
        window.texts()
    );
    assert!(window.harness.query_by_label_contains("dead for good").is_some(), "the risk is told");
    assert!(!window.is_enabled("Update the firmware"), "neither a file nor the risks");
    let path = window.image();
    window.type_path(&path);
    assert!(!window.is_enabled("Update the firmware"), "the risks are not accepted");
    window.click(Role::CheckBox, ACCEPT);
    window.click(Role::Button, "Update the firmware");
    window.until_text("Erasing. Do not switch anything off");
    assert!(!window.is_enabled("Cancel the update"), "there is no safe way back now");
    window.choose("File", "Exit");
    window.until_text("The window stays open: a firmware update runs");
    window.until_text("Waiting for the controller");
    assert!(!window.texts().iter().any(|text| text.contains("is updated")), "nothing is known yet");
    let store = Store::at(window.folder.path().join("kept"));
    assert_eq!(store.backups(None).len(), 1, "the settings were backed up");
    window.until_text(
        "The firmware is updated: USB Roboclaw 2x7a v4.2.8 before, USB Roboclaw 2x7a v9.8.7 now.",
    );
    window.until_text("The settings are as they are in the backup.");
    window.until_text("USB Roboclaw 2x7a v9.8.7");
}

#[test]
fn settings_that_differ_after_an_update_are_listed_and_can_be_restored() {
    let mut window = Window::new();
    window.open(UNIT);
    // A change in RAM that was never saved: the restart after the update forgets it.
    window.app.borrow_mut().as_mut().unwrap().model.front.mcp_mut().firmware.open = true;
    let request = Request::Transact {
        id: 1,
        command: brushwork_mcp_wire::packet_serial::number::SET_VELOCITY_PID_M1,
        values: [0x4000, 0x10000, 0x8000, 12_345].map(brushwork_values::Value::Int).to_vec(),
    };
    window.app.borrow().as_ref().unwrap().device().unwrap().request(request).unwrap();
    let path = window.image();
    window.harness.step();
    window.type_path(&path);
    window.click(Role::CheckBox, ACCEPT);
    window.click(Role::Button, "Update the firmware");
    window.until_text("The firmware is updated");
    window.until_text("1 setting differs from the backup");
    window.until_text("12345 counts/s in the backup, 44000 counts/s now");
    window.click(Role::Button, "Restore from the backup…");
    window.until_text("before firmware");
}

#[test]
fn a_power_failure_is_told_with_what_to_do_and_the_update_is_resumed() {
    let mut window = Window::new();
    window.open(UNIT);
    window.choose("Device", "Firmware…");
    let path = window.image();
    window.type_path(&path);
    window.click(Role::CheckBox, ACCEPT);
    window.click(Role::Button, "Update the firmware");
    window.until_text("Writing page");
    let power = |window: &mut Window, on| {
        let app = window.app.borrow();
        app.as_ref().unwrap().world().unwrap().apply(0, WorldAction::Power { on }).unwrap();
    };
    power(&mut window, false);
    window.until_text("resume the update with the same file");
    power(&mut window, true);
    window.click(Role::Button, "Back");
    assert!(!window.is_enabled("Resume the update"), "neither accepted nor a model chosen");
    let models = window.harness.get_by_role_and_label(Role::ComboBox, "Model in its loader");
    models.click_accesskit();
    window.harness.step();
    window.harness.step();
    window.wait_for(Role::Button, "RoboClaw 2x7A");
    window.harness.get_by_role_and_label(Role::Button, "RoboClaw 2x7A").click_accesskit();
    window.harness.step();
    window.harness.step();
    // A screen reader's click leaves the list open, over the risks. Esc folds it, and it alone.
    window.harness.key_press(Key::Escape);
    window.harness.step();
    window.harness.step();
    window.click(Role::CheckBox, ACCEPT);
    window.click(Role::Button, "Resume the update");
    window.until_text("The controller runs USB Roboclaw 2x7a v9.8.7.");
}

#[test]
fn an_image_that_leaves_the_old_version_is_no_update() {
    let mut window = Window::new();
    window.open(UNIT);
    window.choose("Device", "Firmware…");
    let path = window.folder.path().join("noise.bin");
    let noise: Vec<u8> = (0..0x8000_u32).map(|at| (at.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    std::fs::write(&path, noise).unwrap();
    window.type_path(&path);
    window.click(Role::CheckBox, ACCEPT);
    window.click(Role::Button, "Update the firmware");
    window.until_text(
        "The version did not change: the controller still calls itself USB Roboclaw 2x7a v4.2.8.",
    );
}

#[test]
fn a_canopen_bus_is_connected_from_the_device_menu() {
    let mut window = Window::new();
    window.harness.step();
    window.choose("Device", "Connect CANopen Bus…");
    window.click(Role::CheckBox, "All that answer");
    window.click(Role::RadioButton, "Binary");
    window.click(Role::Button, "Connect to the bus");
    window.until("a node answers", |app| app.model.front.is_connected());
    let app = window.app.borrow();
    let identity = app.as_ref().unwrap().model.front.link.identity().unwrap();
    assert_eq!((identity.place(), identity.model), ("node 1".to_owned(), Some("MCP266")));
    assert_eq!(app.as_ref().unwrap().model.front.phase.target(), Some("sim:mcp266,can=binary,node=1"));
}

#[test]
fn settings_are_read_and_a_simulated_node_is_armed_driven_and_stopped_over_can() {
    let mut window = Window::new();
    window.open("sim:mcp266,can,node=3");
    window.click(Role::Button, "General Settings");
    window.until("the settings are read", |app| {
        app.model.front.settings.unit().is_some_and(brushwork_gui::model::settings::UnitSettings::is_read)
    });
    window.click(Role::Button, "PWM Settings");
    window.click(Role::Button, "Device");
    window.click(Role::MenuItemCheckBox, "Arm This Screen");
    window.until_text("Armed for");
    let duty = || {
        let drive = Drive::both(DriveCommand::duty(0.3));
        Request::Drive(drive)
    };
    window.app.borrow().as_ref().unwrap().device().unwrap().request(duty()).unwrap();
    let driven = |app: &App, drives: bool| {
        let views =
            app.world().and_then(brushwork_gui::parts::SimulatedWorld::views).expect("it is simulated");
        (views[0].axes[0].output.duty() > 0.2) == drives
    };
    window.until("the motor is driven", |app| driven(app, true));
    window.harness.key_press(Key::Space);
    window.until("Space stops it", |app| driven(app, false));
}

/// MCPs behind an adapter on a pseudo-terminal: two of them with one number, one that is stopped, and a node of another maker.
#[cfg(unix)]
#[test]
fn the_bus_view_tells_states_strangers_and_doubles_and_starts_a_node_that_is_stopped() {
    use brushwork_canopen::NodeId;
    use brushwork_canopen::adapter::Form;
    use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
    use brushwork_plant::machine::{Machine as _, StreamIndex};
    use brushwork_plant::server::{Endpoint, Server, ServerOptions};
    let node = |id| NodeId::new(id).unwrap();
    let units = [3, 4, 4, 5].map(|id| {
        let mut config = ControllerConfig::default();
        config.set_node(node(id));
        Controller::new(config).unwrap()
    });
    let mut bus = Bus::on_can(units.to_vec(), Form::Ascii).unwrap();
    bus.add_other_node(node(9));
    bus.receive(StreamIndex::Usb, b":S000N0205;"); // NMT: stop, node 5
    let folder = tempfile::tempdir().unwrap();
    let adapter = folder.path().join("adapter");
    let endpoint = Endpoint::Pty { link: adapter.clone() };
    let server = Server::spawn(bus, ServerOptions::default(), &endpoint).unwrap();
    let mut window = Window::new();
    window.open(&format!("can:{}", adapter.display()));
    window.choose("Device", "Connect CANopen Bus…");
    window.until_text("NODES ON THE BUS");
    for text in [
        "MCP266 2x60A v1.0.0",
        "several devices answer as this node",
        "another device (Another drive): never written to",
        "stopped: it answers nothing until it is started",
    ] {
        window.until_text(text);
    }
    window.click(Role::Button, "Start node 5");
    window.until("node 5 is operational", move |app| {
        let views = app.model.front.bus.as_ref().unwrap().views();
        views.iter().any(|view| {
            view.node == node(5) && view.state == Some(brushwork_canopen::nmt::State::Operational)
        })
    });
    assert!(server.inspect(|bus| bus.other_nodes()[0].written().is_empty()).unwrap());
}
