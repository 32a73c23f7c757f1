//! Real controllers on a page, through the serial ports of its browser. A stand-in in virtual time takes the browser's place: behind each of its
//! ports is a simulated controller, which is told nothing but bytes.

use std::sync::atomic::{AtomicBool, AtomicU32, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::Duration;

use brushwork_core::session::browser::{BrowserPort, PortState, family_behind};
use brushwork_family::simulator::asked_for;
use brushwork_gui::model::Screen;
use brushwork_gui::model::devices::Choice;
use brushwork_gui::model::link::Arming;
use brushwork_gui::page::{Browser, Granted};
use brushwork_link::{ArmScope, Clock as _, FamilyChoice, VirtualClock};
use brushwork_plant::bridge::BridgeOutput;
use brushwork_plant::machine::{Machine, StreamIndex};
use egui::Key;

use crate::page::{Page, install_all_families};
use crate::support::alone::{LIMIT, alone};
use crate::support::install_families;

/// A chip that turns USB into a serial line.
const ADAPTER: Option<(u16, u16)> = Some((0x0403, 0x6001));
/// The least that time goes on.
const INSTANT: Duration = Duration::from_micros(1);

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().expect("nobody panics while it is locked")
}

/// A port of the stand-in, and the controller behind it.
struct Wire {
    clock: VirtualClock,
    usb_id: Option<(u16, u16)>,
    machine: Mutex<Box<dyn Machine>>,
    index: StreamIndex,
    state: Mutex<PortState>,
    opens_as: Mutex<PortState>,
    baud: AtomicU32,
    unwritten: AtomicUsize,
    is_stuck: AtomicBool,
    closed: AtomicUsize,
    held: Mutex<Vec<Vec<u8>>>,
}

impl std::fmt::Debug for Wire {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Wire")
    }
}

impl Wire {
    fn with<T>(&self, act: impl FnOnce(&mut dyn Machine) -> T) -> T {
        let mut machine = locked(&self.machine);
        machine.advance(self.clock.now());
        act(&mut **machine)
    }

    fn duty(&self) -> f64 {
        match self.with(|machine| machine.views()[0].axes[0].output) {
            BridgeOutput::Duty(duty) => duty,
            BridgeOutput::Brake | BridgeOutput::Coast => 0.0,
        }
    }

    fn holds(&self) -> bool {
        !locked(&self.held).is_empty()
    }

    fn pull(&self) {
        *locked(&self.state) = PortState::Gone("The device has been lost.".to_owned());
    }
}

impl BrowserPort for Wire {
    fn state(&self) -> PortState {
        locked(&self.state).clone()
    }

    fn now(&self) -> Duration {
        self.clock.now()
    }

    fn wait(&self, time: Duration) {
        let now = self.clock.now();
        let next = self.with(|machine| machine.next_output_at());
        self.clock.advance_to(next.map_or(now + time, |next| next.max(now + INSTANT).min(now + time)));
    }

    fn take(&self) -> Vec<u8> {
        let index = self.index;
        self.with(|machine| std::iter::from_fn(|| machine.take_output(index)).flatten().collect())
    }

    fn write(&self, bytes: &[u8]) {
        if self.is_stuck.load(Ordering::SeqCst) {
            self.unwritten.fetch_add(bytes.len(), Ordering::SeqCst);
        } else {
            self.with(|machine| machine.receive(self.index, bytes));
        }
    }

    fn unwritten(&self) -> usize {
        self.unwritten.load(Ordering::SeqCst)
    }

    fn hold(&self, writes: &[Vec<u8>], _gap: Duration) {
        *locked(&self.held) = writes.to_vec();
    }

    fn moving(&self, _is_moving: bool) {}

    fn lives(&self) {}

    fn stop(&self) {
        let held = locked(&self.held).clone();
        held.iter().for_each(|bytes| self.write(bytes));
    }

    fn close(&self) {
        self.closed.fetch_add(1, Ordering::SeqCst);
    }
}

/// A port by the number that the browser's side gave it.
type Numbered = (u32, Arc<Wire>);

/// A browser, the ports that it has granted, and what its user chooses next.
#[derive(Clone)]
struct StandIn {
    clock: VirtualClock,
    granted: Arc<Mutex<Vec<Numbered>>>,
    is_changed: Arc<AtomicBool>,
    chosen: Arc<Mutex<Vec<Arc<Wire>>>>,
    newest: Arc<AtomicU32>,
}

impl StandIn {
    fn new() -> Self {
        Self {
            clock: VirtualClock::new(),
            granted: Arc::default(),
            is_changed: Arc::new(AtomicBool::new(true)),
            chosen: Arc::default(),
            newest: Arc::default(),
        }
    }

    /// A device with a simulated controller behind it.
    fn device(&self, simulated: &str, usb_id: Option<(u16, u16)>) -> Arc<Wire> {
        let started = asked_for(simulated).expect("a family has it").start(simulated).expect("it is one");
        Arc::new(Wire {
            clock: self.clock.clone(),
            usb_id,
            machine: Mutex::new(started.machine),
            index: started.index,
            state: Mutex::new(PortState::Opening),
            opens_as: Mutex::new(PortState::Open),
            baud: AtomicU32::new(0),
            unwritten: AtomicUsize::new(0),
            is_stuck: AtomicBool::new(false),
            closed: AtomicUsize::new(0),
            held: Mutex::default(),
        })
    }

    fn grant(&self, device: &Arc<Wire>) {
        let number = self.newest.fetch_add(1, Ordering::SeqCst) + 1;
        locked(&self.granted).push((number, device.clone()));
        self.is_changed.store(true, Ordering::SeqCst);
    }

    fn unplug(&self, device: &Arc<Wire>) {
        locked(&self.granted).retain(|(_, other)| !Arc::ptr_eq(other, device));
        self.is_changed.store(true, Ordering::SeqCst);
    }

    fn page(&self) -> Page {
        Page::in_browser(Box::new(self.clone()), self.clock.clone())
    }

    /// A page whose user has chosen the port of a simulated controller and connected to it.
    fn connected(simulated: &str, family: FamilyChoice) -> (Page, Arc<Wire>) {
        let browser = Self::new();
        let device = browser.device(simulated, ADAPTER);
        locked(&browser.chosen).push(device.clone());
        let mut page = browser.page();
        page.pass_ms(100);
        page.press("Choose a serial port…");
        page.app().model.devices.look_for(family);
        page.pass_ms(100);
        page.press("Connect");
        page.pass_ms(3000);
        assert!(page.app().model.front.is_connected(), "{simulated}: {:?}", page.said());
        (page, device)
    }
}

impl Browser for StandIn {
    fn reaches_ports(&self) -> bool {
        true
    }

    fn granted(&self) -> Option<Vec<Granted>> {
        let granted = locked(&self.granted);
        let listed = granted.iter().map(|(number, wire)| Granted { number: *number, usb_id: wire.usb_id });
        self.is_changed.swap(false, Ordering::SeqCst).then(|| listed.collect())
    }

    fn choose(&self) {
        if let Some(device) = locked(&self.chosen).pop() {
            self.grant(&device);
        }
    }

    fn take_refusal(&self) -> Option<String> {
        None
    }

    fn open(&self, number: u32, baud: u32) -> Arc<dyn BrowserPort> {
        let granted = locked(&self.granted);
        let (_, wire) = granted.iter().find(|(known, _)| *known == number).expect("it was granted");
        *locked(&wire.state) = locked(&wire.opens_as).clone();
        wire.baud.store(baud, Ordering::SeqCst);
        wire.clone()
    }
}

fn names(page: &mut Page) -> Vec<String> {
    page.pass_ms(40);
    page.app().model.devices.ports.iter().map(|port| port.name.clone()).collect()
}

fn is_armed(page: &mut Page) -> bool {
    matches!(page.app().model.front.link.arming, Arming::Armed { .. })
}

fn drive(page: &mut Page, device: &Wire) {
    page.arm_on("PWM Settings");
    page.enter("M1 duty exact", "40");
    page.pass_ms(500);
    assert!((device.duty() - 0.4).abs() < 0.02, "{}: {:?}", device.duty(), page.said());
}

#[test]
fn a_chosen_port_is_named_by_its_device_and_chosen_in_the_list_and_keeps_its_name() {
    install_families();
    let browser = StandIn::new();
    let [first, second] = [(); 2].map(|()| browser.device("mcp266", ADAPTER));
    let plain = browser.device("mcp266", None);
    let mut page = browser.page();
    assert!(names(&mut page).is_empty());
    locked(&browser.chosen).push(first.clone());
    page.press("Choose a serial port…");
    assert_eq!(names(&mut page), ["usb-0403-6001"]);
    assert_eq!(page.app().model.devices.choice, Choice::Port("usb-0403-6001".to_owned()));
    browser.grant(&second);
    browser.grant(&plain);
    assert_eq!(names(&mut page), ["usb-0403-6001", "usb-0403-6001-2", "serial"]);
    browser.unplug(&first);
    assert_eq!(names(&mut page), ["usb-0403-6001-2", "serial"]);
    browser.grant(&first);
    assert_eq!(names(&mut page), ["usb-0403-6001-2", "serial", "usb-0403-6001"]);
    assert_eq!(page.app().model.devices.choice, Choice::Port("usb-0403-6001".to_owned()));
}

#[test]
fn a_page_drives_a_real_controller_and_says_what_a_closed_tab_cannot() {
    install_families();
    let (mut page, device) = StandIn::connected("mcp266", FamilyChoice::AUTO);
    assert_eq!(device.baud.load(Ordering::SeqCst), FamilyChoice::AUTO.default_baud());
    assert!(!device.holds(), "nothing can move");
    drive(&mut page, &device);
    let warned: Vec<_> = page.app().model.front.link.warnings.iter().map(ToString::to_string).collect();
    assert!(warned.iter().any(|text| text.contains("A closed tab cannot stop a motor.")), "{warned:?}");
    assert!(device.holds());
    page.harness.key_press(Key::Escape);
    page.pass_ms(300);
    assert_eq!(device.duty(), 0.0);
    assert!(!is_armed(&mut page) && !device.holds());
    page.press("Disconnect");
    page.pass_ms(100);
    assert_eq!(device.closed.load(Ordering::SeqCst), 1, "the port is given back");
    page.press("Connect");
    page.pass_ms(5000);
    assert!(page.app().model.front.is_connected(), "{:?}", page.said());
    assert_eq!(
        device.closed.load(Ordering::SeqCst),
        1,
        "the link that has ended does not take it from the next one"
    );
}

#[test]
fn what_the_browser_holds_stops_the_motor_without_the_page_and_a_hidden_page_disarms() {
    install_families();
    let (mut page, device) = StandIn::connected("mcp266", FamilyChoice::AUTO);
    drive(&mut page, &device);
    // What the page's script does when the page is hidden: the page itself has not been turned yet.
    device.stop();
    device.clock.advance(Duration::from_millis(50));
    assert_eq!(device.duty(), 0.0);
    page.links.hidden();
    assert!(page.links.take_hidden() && !page.links.take_hidden(), "it is told once");
    page.pass_ms(300);
    assert!(!is_armed(&mut page) && !device.holds(), "{:?}", page.said());
    drive(&mut page, &device);
}

#[test]
fn a_page_that_is_not_drawn_stops_the_motor_and_one_that_is_gone_leaves_it_to_the_controller() {
    install_families();
    let (mut page, device) = StandIn::connected("mcp266", FamilyChoice::AUTO);
    drive(&mut page, &device);
    for _ in 0..20 {
        let until = device.clock.now() + Duration::from_millis(20);
        page.links.turn(Duration::from_millis(20));
        device.clock.advance_to(until);
    }
    assert_eq!(device.duty(), 0.0, "the dead-man of 250 ms has stopped it");
    page.pass_ms(300);
    drive(&mut page, &device);
    let Arming::Armed { controller_timeout: Some(timeout), .. } = page.app().model.front.link.arming else {
        panic!("it is armed with the time-out of the controller");
    };
    // Neither turned nor drawn any more: the tab is closed, and nothing got out.
    device.clock.advance(timeout + Duration::from_millis(20));
    assert_eq!(device.duty(), 0.0, "the controller has stopped it by itself after {timeout:?}");
}

#[test]
fn a_pulled_plug_is_a_lost_link_with_its_sentence() {
    install_families();
    let (mut page, device) = StandIn::connected("mcp266", FamilyChoice::AUTO);
    drive(&mut page, &device);
    device.pull();
    page.pass_ms(500);
    assert!(!page.app().model.front.is_connected() && !is_armed(&mut page));
    let said = page.said();
    let wanted = "the far end is gone (The device has been lost.). Make sure that the motors stand still";
    assert!(said.iter().any(|text| text.contains(wanted)), "{said:?}");
}

#[test]
fn a_port_that_takes_no_bytes_is_a_lost_link_and_no_more_than_some_wait_for_it() {
    install_families();
    let (mut page, device) = StandIn::connected("mcp266", FamilyChoice::AUTO);
    device.is_stuck.store(true, Ordering::SeqCst);
    for _ in 0..600 {
        page.pass_ms(100);
        if !page.app().model.front.is_connected() {
            break;
        }
    }
    assert!(!page.app().model.front.is_connected(), "{:?}", page.said());
    assert!(device.unwritten.load(Ordering::SeqCst) <= 4096);
}

#[test]
fn a_port_that_does_not_open_is_told_with_what_the_browser_says() {
    install_families();
    let browser = StandIn::new();
    let device = browser.device("mcp266", ADAPTER);
    *locked(&device.opens_as) = PortState::Gone("Failed to open serial port.".to_owned());
    browser.grant(&device);
    let mut page = browser.page();
    page.pass_ms(100);
    page.app().open("usb-0403-6001,baud=9600");
    page.pass_ms(300);
    let said = page.said();
    let wanted = "Could not open usb-0403-6001 at 9600 baud: the browser says \"Failed to open serial port.\" Another program";
    assert!(said.iter().any(|text| text.contains(wanted)), "{said:?}");
    page.app().open("usb-0403-6001-2");
    page.pass_ms(300);
    assert!(
        page.said().iter().any(|text| text.contains("usb-0403-6001-2 cannot be reached from a web page"))
    );
}

#[test]
fn beside_a_real_controller_a_page_opens_no_other_link() {
    install_families();
    let (mut page, device) = StandIn::connected("mcp266", FamilyChoice::AUTO);
    page.app().open("sim:mcp266");
    page.pass_ms(500);
    let refused = |page: &mut Page, target: &str| {
        let wanted = format!("{target} was not opened: a web page that reaches a real controller");
        assert!(page.said().iter().any(|text| text.contains(&wanted)), "{:?}", page.said());
    };
    refused(&mut page, "sim:mcp266");
    drop(page);
    let browser = StandIn { clock: device.clock.clone(), ..StandIn::new() };
    browser.grant(&device);
    let mut page = browser.page();
    page.app().open("sim:mcp266");
    page.pass_ms(3000);
    page.app().open("usb-0403-6001");
    page.pass_ms(500);
    refused(&mut page, "usb-0403-6001");
}

#[test]
fn a_controller_without_a_time_out_of_its_own_is_not_armed_from_a_page() {
    alone(
        "browser_ports::a_controller_without_a_time_out_of_its_own_is_not_armed_from_a_page",
        LIMIT,
        without_time_out,
    );
}

fn without_time_out() {
    install_all_families();
    for (simulated, family) in [
        ("motion-mind-3", brushwork_motion_mind_client::MOTION_MIND),
        ("suprmotr-v9", brushwork_suprmotr_client::SUPRMOTR),
    ] {
        let (mut page, device) = StandIn::connected(simulated, FamilyChoice::of(family));
        let front = &page.app().model.front;
        let can_arm = |screen: &Screen| screen.arm_scope().is_some_and(|scope| scope != ArmScope::Script);
        let screen = front.screens().into_iter().find(can_arm).expect("a screen drives");
        let title = front.family().title(screen);
        page.press(title);
        let before = device.with(|machine| machine.views()[0].axes[0].output);
        page.press("Arm");
        page.pass_ms(1000);
        assert!(!is_armed(&mut page), "{simulated}: {:?}", page.said());
        let refused: Vec<_> = page.app().model.front.link.refusals.iter().map(ToString::to_string).collect();
        assert!(refused.len() == 1 && refused[0].contains("it has no time-out of its own"), "{refused:?}");
        assert_eq!(device.with(|machine| machine.views()[0].axes[0].output), before, "{simulated}");
    }
}

#[test]
fn on_a_device_that_is_no_adapter_only_the_first_family_is_looked_for_unless_another_is_chosen() {
    install_families();
    let motion_mind = FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND);
    let mcp = FamilyChoice::of(brushwork_mcp_client::MCP);
    for (maker, chosen, looked_for) in [
        (Some(0x0403), FamilyChoice::AUTO, FamilyChoice::AUTO),
        (None, FamilyChoice::AUTO, FamilyChoice::AUTO),
        (Some(0x03EB), FamilyChoice::AUTO, mcp),
        (Some(0x03EB), motion_mind, motion_mind),
    ] {
        assert_eq!(family_behind(chosen, maker), looked_for, "{maker:?}, {chosen:?}");
    }
}
