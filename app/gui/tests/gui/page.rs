//! The window as a page has it: no thread for any link, the simulated machine in the program, time by the frame. The page's own opener is what
//! is tested; the browser around it is not.

use std::sync::Arc;
use std::time::Duration;

use brushwork_core::keep::{Keeping, Store};
use brushwork_core::session::browser::BrowserPort;
use brushwork_gui::App;
use brushwork_gui::model::Screen;
use brushwork_gui::model::link::Arming;
use brushwork_gui::page::{Browser, Granted, Links, PageOpener, Ports};
use brushwork_gui::parts::{Parts, SimulatedWorld};
use brushwork_gui::tune::Loop;
use brushwork_link::{Clock as _, VirtualClock};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_script::debug::Wanted;
use brushwork_tuning::report::Verdict;
use egui::Key;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, HarnessBuilder, Node};

use crate::support::alone::{LIMIT, alone};
use crate::support::cpu::Cpu;
use crate::support::install_families;

const FRAME: Duration = Duration::from_millis(20);

pub struct Page {
    pub harness: Harness<'static, Option<App>>,
    pub links: Links,
    folder: tempfile::TempDir,
    /// The time of the browser, where that is one of its own.
    clock: VirtualClock,
}

/// A browser without serial ports.
struct Portless;

impl Browser for Portless {
    fn reaches_ports(&self) -> bool {
        false
    }

    fn granted(&self) -> Option<Vec<Granted>> {
        None
    }

    fn choose(&self) {}

    fn take_refusal(&self) -> Option<String> {
        None
    }

    fn open(&self, number: u32, _baud: u32) -> Arc<dyn BrowserPort> {
        panic!("there is no port {number}")
    }
}

impl Page {
    /// A page that was opened with a target in its address.
    fn open(target: &str) -> Self {
        install_families();
        let mut page = Self::in_browser(Box::new(Portless), VirtualClock::new());
        page.app().open(target);
        page.pass_ms(5000);
        page
    }

    /// A page in a browser whose time is `clock`.
    pub fn in_browser(browser: Box<dyn Browser>, clock: VirtualClock) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let links = Links::default();
        let keeping = Keeping::new(Store::at(folder.path()));
        let ports = Ports::new(browser);
        let opener = Box::new(PageOpener { links: links.clone(), ports: ports.clone() });
        let mut parts = Some(Parts { ports: Box::new(ports), opener, keeping });
        let harness = HarnessBuilder::default()
            .with_size([1280.0, 800.0])
            .with_step_dt(FRAME.as_secs_f32())
            .with_context_setup(brushwork_gui::theme::install)
            .renderer(Cpu::default())
            .build_ui_state(
                move |ui, slot: &mut Option<App>| {
                    slot.get_or_insert_with(|| {
                        App::new(ui.ctx(), parts.take().expect("the window is made once"))
                    })
                    .contents(ui);
                },
                None,
            );
        Self { harness, links, folder, clock }
    }

    /// One that is connected.
    fn connected(target: &str) -> Self {
        let mut page = Self::open(target);
        assert!(page.app().model.front.is_connected(), "{target}: {:?}", page.said());
        page
    }

    pub fn app(&mut self) -> &mut App {
        self.harness.state_mut().as_mut().expect("the first frame made it")
    }

    pub fn said(&mut self) -> Vec<String> {
        self.app().model.messages.past().map(|message| message.text.to_string()).collect()
    }

    pub fn pass_ms(&mut self, milliseconds: u64) {
        for _ in 0..milliseconds.div_ceil(20) {
            let until = self.clock.now() + FRAME;
            self.links.turn(FRAME);
            self.clock.advance_to(until);
            self.harness.step();
        }
    }

    pub fn press(&mut self, label: &str) {
        let is_meant = |node: &Node<'_>| !matches!(node.accesskit_node().role(), Role::Label | Role::Heading);
        let node = self.harness.query_all_by_label(label).find(is_meant);
        node.unwrap_or_else(|| panic!("there is no {label} to be pressed")).click();
        self.harness.step();
        self.pass_ms(200);
    }

    pub fn enter(&mut self, field: &str, number: &str) {
        self.harness.get_by_label(field).focus();
        self.pass_ms(100);
        self.harness.get_by_label(field).type_text(number);
        self.pass_ms(100);
        self.harness.key_press(Key::Enter);
        self.pass_ms(200);
    }

    pub fn arm_on(&mut self, screen: &str) {
        self.press(screen);
        self.press("Arm");
        self.pass_ms(500);
        let arming = self.app().model.front.link.arming;
        assert!(matches!(arming, Arming::Armed { .. }), "{arming:?}: {:?}", self.said());
    }

    fn truth(&mut self) -> WorldView {
        self.app().world().and_then(SimulatedWorld::views).expect("there is a world")[0].clone()
    }

    fn duty(&mut self) -> f64 {
        match self.truth().axes[0].output {
            BridgeOutput::Duty(duty) => duty,
            BridgeOutput::Brake | BridgeOutput::Coast => 0.0,
        }
    }
}

#[test]
fn a_page_drives_a_motor_and_stops_it_when_it_is_no_longer_drawn() {
    let mut page = Page::connected("sim:mcp266");
    page.arm_on("PWM Settings");
    page.enter("M1 duty exact", "40");
    page.pass_ms(1000);
    assert!((page.duty() - 0.4).abs() < 0.02, "{}", page.duty());
    let before = page.truth().axes[0].encoder_counts;
    page.pass_ms(500);
    assert_ne!(page.truth().axes[0].encoder_counts, before, "it turns");
    // A tab in the background: the loop is turned, and nothing is drawn.
    (0..25).for_each(|_| page.links.turn(FRAME));
    assert_eq!(page.duty(), 0.0, "the dead-man has stopped it");
    page.pass_ms(300);
    page.arm_on("PWM Settings");
    page.enter("M1 duty exact", "40");
    page.pass_ms(500);
    assert!(page.duty() > 0.3);
    page.harness.key_press(Key::Escape);
    page.pass_ms(300);
    assert_eq!(page.duty(), 0.0);
    let ahead = page.links.take_ahead();
    assert!(ahead < Duration::from_millis(100), "none of it took the link for long: {ahead:?}");
}

#[test]
fn a_page_tunes_a_loop_with_its_time_ahead_afterwards_and_writes_with_a_backup() {
    let mut page = Page::connected("sim:mcp266");
    page.arm_on("Velocity Settings");
    page.press("Tune");
    page.press("Tune M1");
    for _ in 0..90 {
        if !page.app().model.front.tune.is_running() {
            break;
        }
        page.pass_ms(1000);
    }
    let said = page.said();
    let run = page.app().model.front.tune.front(Loop::Velocity).run().cloned();
    let run = run.unwrap_or_else(|| panic!("no run: {said:?}"));
    assert_ne!(run.report.verdict, Verdict::Refused, "{:?}", run.report.causes);
    assert!(page.links.take_ahead() > Duration::from_secs(1), "the run went on in its own time");
    page.pass_ms(1500);
    assert_eq!(page.duty(), 0.0);
    page.press("Apply (RAM)");
    page.pass_ms(4000);
    let backups = std::fs::read_dir(page.folder.path().join("backups")).expect("there are backups");
    assert!(backups.count() > 0, "{:?}", page.said());
}

#[test]
fn a_page_has_every_family_with_the_world_around_it() {
    alone("page::a_page_has_every_family_with_the_world_around_it", LIMIT, every_family);
}

/// Names all families of the program, where this process has no others yet.
pub fn install_all_families() {
    brushwork_link::install(&[
        &brushwork_mcp_client::McpDriver,
        &brushwork_motion_mind_client::MotionMindDriver,
        &brushwork_suprmotr_client::SuprMotrDriver,
        &brushwork_motorvator_client::MotorvatorDriver,
    ]);
    brushwork_family::simulator::install(&[
        &brushwork_mcp::McpSimulator,
        &brushwork_motion_mind::MotionMindSimulator,
        &brushwork_suprmotr::SuprMotrSimulator,
        &brushwork_motorvator::MotorvatorSimulator,
    ]);
    brushwork_gui::install(&[
        &brushwork_gui::mcp::Mcp,
        &brushwork_gui::motion_mind::MotionMind,
        &brushwork_gui::suprmotr::SuprMotr,
        &brushwork_gui::motorvator::Motorvator,
    ]);
}

fn every_family() {
    install_all_families();
    for target in ["sim:mcp266,can", "sim:motion-mind-3", "sim:suprmotr-v9", "sim:motorvator-3"] {
        let mut page = Page::connected(target);
        let axes = page.truth().axes.len();
        assert!(axes > 0, "{target}");
        let pace = page.app().world().and_then(SimulatedWorld::pace);
        assert!(pace.is_some(), "{target}");
    }
    // A controller that lacks the screen in front is seen by its status.
    let mut page = Page::connected("sim:mcp266");
    page.press("Velocity Settings");
    page.app().open("sim:suprmotr-v9");
    page.pass_ms(5000);
    let model = &page.app().model;
    assert!(model.front.is_connected() && model.front.screens().len() > 3);
    assert_eq!(model.screen, Screen::DeviceStatus);
}

#[test]
fn a_cable_is_pulled_and_plugged_in_again_by_the_worlds_panel() {
    let mut page = Page::connected("sim:mcp266");
    let unplug = |page: &mut Page, unplugged| {
        let world = page.app().world().expect("it lives on");
        world.apply(0, WorldAction::Unplug { unplugged }).expect("nothing is in its way");
    };
    unplug(&mut page, true);
    page.pass_ms(1000);
    assert!(!page.app().model.front.is_connected(), "{:?}", page.said());
    unplug(&mut page, false);
    page.app().open("sim:mcp266");
    page.pass_ms(3000);
    assert!(page.app().model.front.is_connected(), "{:?}", page.said());
    let world = page.app().world().expect("it is simulated");
    world.debug(0, Vec::new(), Wanted::default()).expect("it has a debugger");
    assert!(world.script().is_some());
}

#[test]
fn a_port_is_refused_in_a_sentence_that_says_what_reaches_it() {
    let mut page = Page::open("/dev/ttyACM0");
    assert!(!page.app().model.front.is_connected());
    let said = page.said();
    assert!(said.iter().any(|text| text.contains("install Brushwork on this computer")), "{said:?}");
    let listing = page.app().model.devices.listing_failure.clone().expect("this browser has no ports");
    assert!(listing.to_string().contains("open the page in Chrome, Edge or another Chromium"), "{listing}");
}
