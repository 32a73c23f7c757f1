//! A window on a test bench: the real window and the real device loop against a simulated controller, all in virtual
//! time, spoken to in the words of a person.

use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use brushwork_core::keep::{Keeping, Store};
use brushwork_core::session::SessionError;
use brushwork_gui::App;
use brushwork_gui::model::Model;
use brushwork_gui::parts::{OpenLink, Opener, Parts, PortSource, SimulatedWorld};
use brushwork_link::FamilyChoice;
use brushwork_link::device::{Addresses, DeviceLoop, DeviceOptions};
use brushwork_link::transport::{ConnectTarget, OpenError, PortInfo, Stream};
use brushwork_link::{Clock as _, Failure, HiddenSettings};
use brushwork_mcp_sim::controller::{Bus, Controller, ControllerConfig};
use brushwork_mcp_wire::packet_serial::Address;
use brushwork_motion_mind_sim::{Mode, MotionMind, MotionMindBus, MotionMindConfig};
use brushwork_plant::machine::{Machine, StreamIndex};
use brushwork_plant::server::Pace;
use brushwork_plant::world::{WorldAction, WorldView};
use brushwork_script::debug::{Request as DebugRequest, View, Wanted};
use brushwork_values::Motor;
use crossbeam_channel::{Receiver, bounded};
use egui::Theme;
use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, HarnessBuilder, Node};

use super::cpu::Cpu;
use super::line::Line;
use super::lockstep::{Gate, Lockstep};
use super::wait::{PATIENCE, Wait};

/// Time between two frames, as in the real window.
pub const FRAME: Duration = Duration::from_millis(100);

/// How far the link's time may run ahead of the real one while something real is waited for.
const AHEAD: Duration = Duration::from_secs(2);

/// What connects to the second machine.
pub const SECOND: &str = "sim:mcp236";

/// What connects to the Motion Minds.
pub const MIND: &str = "sim:motion-mind-3";

/// The loop of a line that is open.
type Slot = Rc<RefCell<Option<Lockstep>>>;

/// A window, the loop it speaks to, and the controller at the far end.
pub struct Bench {
    pub harness: Harness<'static, Option<App>>,
    pub line: Line,
    /// A second machine on a line of its own, at [`SECOND`].
    pub second: Line,
    /// Motion Minds on a line of their own, at [`MIND`] and whatever follows it.
    pub minds: Line<MotionMindBus>,
    loops: [Slot; 3],
    ports: Rc<RefCell<Option<Vec<PortInfo>>>>,
    /// Whether the next device that is opened may be known to be simulated.
    claims: Rc<Cell<bool>>,
    /// The folder of what the window keeps on the computer; gone with the bench.
    kept: Rc<tempfile::TempDir>,
}

impl Bench {
    /// A window of 1280 by 800 with an MCP266 in the simulator.
    pub fn new() -> Self {
        Self::sized([1280.0, 800.0], Theme::Dark)
    }

    pub fn sized(size: [f32; 2], theme: Theme) -> Self {
        let unit = Controller::new(ControllerConfig::default()).expect("the default configuration is sound");
        Self::with_bus(Bus::single(unit, StreamIndex::Usb), size, theme)
    }

    /// A window of 1280 by 800 with any one controller behind it, on its USB port.
    pub fn of(unit: Controller) -> Self {
        Self::with_bus(Bus::single(unit, StreamIndex::Usb), [1280.0, 800.0], Theme::Dark)
    }

    /// A window of 1280 by 800 with any controllers on one line behind it.
    pub fn of_bus(bus: Bus) -> Self {
        Self::with_bus(bus, [1280.0, 800.0], Theme::Dark)
    }

    /// A window of any size with any one controller behind it.
    pub fn of_sized(unit: Controller, size: [f32; 2], theme: Theme) -> Self {
        Self::with_bus(Bus::single(unit, StreamIndex::Usb), size, theme)
    }

    /// Two units at 0x80 and 0x81 that share a TTL line.
    pub fn with_two_units() -> Self {
        let unit = |address| {
            let address = Address::new(address).expect("an address of the family");
            let config = ControllerConfig { address, ..ControllerConfig::default() };
            Controller::new(config).expect("the default configuration is sound")
        };
        let bus =
            Bus::new(vec![unit(0x80), unit(0x81)], StreamIndex::Uart1).expect("TTL lines can be shared");
        Self::with_bus(bus, [1280.0, 800.0], Theme::Dark)
    }

    /// The window goes without a word, as in a crash, and another one comes that finds what was kept.
    pub fn after_a_crash(self) -> Self {
        let kept = self.kept.clone();
        drop(self);
        let unit = Controller::new(ControllerConfig::default()).expect("the default configuration is sound");
        Self::keeping_in(kept, Bus::single(unit, StreamIndex::Usb), [1280.0, 800.0], Theme::Dark)
    }

    /// The window is closed, and another one finds what was kept, and this controller at the port.
    pub fn after_an_exchange(self, unit: Controller) -> Self {
        let kept = self.kept.clone();
        drop(self);
        Self::keeping_in(kept, Bus::single(unit, StreamIndex::Usb), [1280.0, 800.0], Theme::Dark)
    }

    /// A window of 1280 by 800 with Motion Minds at [`MIND`], beside the MCP266.
    pub fn with_minds(minds: Vec<MotionMindConfig>) -> Self {
        Self::with_minds_sized(minds, [1280.0, 800.0], Theme::Dark)
    }

    /// A window of any size with Motion Minds at [`MIND`].
    pub fn with_minds_sized(minds: Vec<MotionMindConfig>, size: [f32; 2], theme: Theme) -> Self {
        let kept = Rc::new(tempfile::tempdir().expect("a temporary folder can be made"));
        let unit = Controller::new(ControllerConfig::default()).expect("the default configuration is sound");
        Self::made(kept, Bus::single(unit, StreamIndex::Usb), minds, size, theme)
    }

    fn with_bus(bus: Bus, size: [f32; 2], theme: Theme) -> Self {
        let kept = Rc::new(tempfile::tempdir().expect("a temporary folder can be made"));
        Self::keeping_in(kept, bus, size, theme)
    }

    fn keeping_in(kept: Rc<tempfile::TempDir>, bus: Bus, size: [f32; 2], theme: Theme) -> Self {
        Self::made(kept, bus, vec![MotionMindConfig::new(Mode::SerialPid)], size, theme)
    }

    fn made(
        kept: Rc<tempfile::TempDir>,
        bus: Bus,
        minds: Vec<MotionMindConfig>,
        size: [f32; 2],
        theme: Theme,
    ) -> Self {
        super::install_families();
        let minds =
            minds.into_iter().map(|config| MotionMind::new(config).expect("the configuration is sound"));
        let minds = Line::of(MotionMindBus::new(minds.collect()), StreamIndex::Usb, MIND);
        let line = Line::new(bus);
        let unit = Controller::new(ControllerConfig::default()).expect("the default configuration is sound");
        let second = Line::new(Bus::single(unit, StreamIndex::Usb));
        let loops = [Slot::default(), Slot::default(), Slot::default()];
        let ports = Rc::new(RefCell::new(Some(Vec::new())));
        let claims = Rc::new(Cell::new(true));
        let lines = [line.clone(), second.clone()];
        let opener =
            BenchOpener { lines, minds: minds.clone(), loops: loops.clone(), claims: claims.clone() };
        let keeping = Keeping::new(Store::at(kept.path()));
        let mut parts =
            Some(Parts { ports: Box::new(BenchPorts(ports.clone())), opener: Box::new(opener), keeping });
        let harness = HarnessBuilder::default()
            .with_size(size)
            .with_theme(theme)
            .with_step_dt(FRAME.as_secs_f32())
            .with_context_setup(brushwork_gui::theme::install)
            .renderer(Cpu::default())
            .build_ui_state(
                move |ui, slot: &mut Option<App>| {
                    let app = slot.get_or_insert_with(|| {
                        let mut app = App::new(ui.ctx(), parts.take().expect("the window is made once"));
                        app.model.appearance.theme = theme.into();
                        app
                    });
                    app.contents(ui);
                },
                None,
            );
        Self { harness, line, second, minds, loops, ports, claims, kept }
    }

    /// What is opened from now on passes for a real controller: nothing tells the window that it is simulated.
    pub fn pass_for_real(&self) {
        self.claims.set(false);
    }

    /// What the window keeps on the computer.
    pub fn store(&self) -> Store {
        Store::at(self.kept.path())
    }

    /// Lets time pass as it does with the program: the device loop works and the window draws each 100 ms. In the midst of a long time it draws each 200 ms, as on a busy
    /// computer, which still keeps a motion alive.
    pub fn pass(&mut self, time: Duration) {
        let begin = self.line.clock.now();
        let end = begin + time;
        while self.line.clock.now() < end {
            let now = self.line.clock.now();
            let in_midst = now >= begin + FRAME * 2 && now + FRAME * 4 <= end;
            let frame = if in_midst { FRAME * 2 } else { FRAME };
            self.turn_loop((now + frame).min(end));
            self.harness.step();
        }
    }

    /// One frame that comes so much after the last one.
    pub fn pass_frame(&mut self, after: Duration) {
        self.turn_loop(self.line.clock.now() + after);
        self.harness.step();
    }

    pub fn pass_ms(&mut self, milliseconds: u64) {
        self.pass(Duration::from_millis(milliseconds));
    }

    /// Lets time pass with the window frozen: no frame is drawn.
    pub fn freeze(&mut self, time: Duration) {
        self.turn_loop(self.line.clock.now() + time);
    }

    /// Draws frames until threads of the real world have brought something about. No time of the link passes meanwhile.
    pub fn until(&mut self, what: &str, mut holds: impl FnMut(&mut Self) -> bool) {
        let mut wait = Wait::new();
        self.harness.step();
        while !holds(self) {
            assert!(wait.goes_on(), "waited {PATIENCE:?} for {what}, but: {:?}", self.said());
            self.harness.step();
        }
    }

    /// The same where the link has its part in it: its time passes too, but after the first seconds no faster than the
    /// real one, so that it does not run away from a slow thread.
    pub fn until_in_time(&mut self, what: &str, mut holds: impl FnMut(&mut Self) -> bool) {
        let (mut wait, began) = (Wait::new(), self.line.clock.now());
        while !holds(self) {
            if self.line.clock.now() - began < AHEAD + wait.passed() {
                self.pass(FRAME);
            } else {
                self.harness.step();
            }
            assert!(wait.goes_on(), "waited {PATIENCE:?} for {what}, but: {:?}", self.said());
        }
    }

    /// Everything the window has said.
    pub fn said(&mut self) -> Vec<String> {
        self.model().messages.past().map(|message| message.text.to_string()).collect()
    }

    fn turn_loop(&self, until: Duration) {
        turn_one(&self.line, &self.loops[0], until);
        turn_one(&self.second, &self.loops[1], until);
        turn_one(&self.minds, &self.loops[2], until);
    }

    pub fn model(&mut self) -> &mut Model {
        &mut self.harness.state_mut().as_mut().expect("the first frame made it").model
    }

    /// What the machine is really doing.
    pub fn truth(&self) -> WorldView {
        self.line.with(|bus| bus.views().remove(0))
    }

    /// The duty of a motor of any unit of the bus.
    pub fn real_duty_of(&self, unit: usize, motor: Motor) -> f64 {
        match self.line.with(|bus| bus.views().remove(unit)).axes[motor.index()].output {
            brushwork_plant::bridge::BridgeOutput::Duty(duty) => duty,
            _ => 0.0,
        }
    }

    /// The duty a motor's bridge really gets, -1 to 1; 0 for brake and coast.
    pub fn real_duty(&self, motor: Motor) -> f64 {
        match self.truth().axes[motor.index()].output {
            brushwork_plant::bridge::BridgeOutput::Duty(duty) => duty,
            _ => 0.0,
        }
    }

    pub fn both_stand(&self) -> bool {
        Motor::BOTH.into_iter().all(|motor| self.real_duty(motor) == 0.0)
    }

    /// Does something to the world behind the window's back.
    pub fn act(&self, action: &WorldAction) {
        self.act_on(0, action);
    }

    /// The same to the world of any unit of the bus.
    pub fn act_on(&self, unit: usize, action: &WorldAction) {
        self.line.with(|bus| bus.apply(unit, action));
    }

    pub fn plug_in_port(&self, name: &str) {
        let port = PortInfo { name: name.to_owned(), is_usb: true, ..PortInfo::default() };
        *self.ports.borrow_mut() = Some(vec![port]);
    }

    pub fn unplug_ports(&self) {
        *self.ports.borrow_mut() = Some(Vec::new());
    }

    /// Takes the device loop away, to turn it without the window.
    pub fn take_loop(&mut self) -> DeviceLoop {
        self.loops[0].borrow_mut().take().expect("a link is open").into_loop()
    }

    // ---- in the words of a person ----

    /// Presses a button by its label. The window draws at once, as it does for a hand, then two frames pass.
    pub fn press(&mut self, label: &str) {
        self.button(label).click();
        self.harness.step();
        self.pass(FRAME * 2);
    }

    /// Puts the pointer on a button and holds it down until [`Bench::let_go`].
    pub fn hold(&mut self, label: &str) {
        let at = self.button(label).rect().center();
        self.harness.hover_at(at);
        self.harness.step();
        self.pointer_button(at, true);
        self.pass(FRAME);
    }

    /// Lets go of what is held, wherever the pointer is.
    pub fn let_go(&mut self, label: &str) {
        let at = self.button(label).rect().center();
        self.pointer_button(at, false);
        self.pass(FRAME);
    }

    fn pointer_button(&mut self, pos: egui::Pos2, pressed: bool) {
        let button = egui::PointerButton::Primary;
        let modifiers = egui::Modifiers::NONE;
        self.harness.event(egui::Event::PointerButton { pos, button, pressed, modifiers });
        self.harness.step();
    }

    /// Chooses from a list.
    pub fn choose(&mut self, list: &str, entry: &str) {
        self.press(list);
        self.press(entry);
    }

    /// Puts the keyboard focus on a button.
    pub fn focus(&mut self, label: &str) {
        self.button(label).focus();
        self.harness.step();
        self.pass(FRAME);
    }

    pub fn key(&mut self, key: egui::Key) {
        self.harness.key_press(key);
        self.harness.step();
        self.pass(FRAME);
    }

    pub fn key_with(&mut self, modifiers: egui::Modifiers, key: egui::Key) {
        self.harness.key_press_modifiers(modifiers, key);
        self.harness.step();
        self.pass(FRAME);
    }

    /// What can be pressed under that label; a heading may read the same.
    pub fn button<'a>(&'a self, label: &'a str) -> Node<'a> {
        let labelled = self.harness.get_all_by_label(label);
        let is_text = |role| matches!(role, Role::Label | Role::Heading);
        let mut pressable = labelled.filter(|node| !is_text(node.accesskit_node().role()));
        let found = pressable.next().unwrap_or_else(|| panic!("nothing to press reads {label:?}"));
        assert!(pressable.next().is_none(), "several things to press read {label:?}");
        found
    }

    pub fn see<'a>(&'a self, label: &'a str) -> Node<'a> {
        self.harness.get_by_label(label)
    }

    pub fn sees(&self, label: &str) -> bool {
        self.harness.query_by_label(label).is_some()
    }

    pub fn sees_part(&self, part: &str) -> bool {
        self.harness.query_all_by_label_contains(part).next().is_some()
    }

    /// Opens a tab of the drawer, unless it is open.
    pub fn open_tab(&mut self, title: &str) {
        let screen = self.model().screen;
        if self.model().front.open_tab(screen).is_some_and(|tab| tab.title(screen) == title) {
            return;
        }
        // A star tells of edits behind it.
        let starred = format!("{title} *");
        let label = if self.sees(&starred) { starred.as_str() } else { title };
        self.press(label);
    }

    /// Connects to the simulated controller and waits until it has answered.
    pub fn connect(&mut self) {
        self.press("Connect");
        self.pass_ms(1500);
        assert!(self.model().is_connected(), "{:?}", self.model().messages.past().collect::<Vec<_>>());
    }

    /// Goes to the PWM screen and arms it.
    pub fn arm(&mut self) {
        self.arm_on("PWM Settings");
    }

    /// Goes to a screen and arms it.
    pub fn arm_on(&mut self, screen: &str) {
        self.press(screen);
        self.press("Arm");
        self.pass_ms(500);
        let arming = self.model().front.link.arming;
        assert!(
            matches!(arming, brushwork_gui::model::link::Arming::Armed { .. }),
            "{arming:?}: {:?}",
            self.model().front.link.refusals
        );
    }

    /// Sets a duty in the field for exact numbers, as a keyboard does.
    pub fn set_duty(&mut self, motor: Motor, percent: &str) {
        self.enter(&format!("{motor} duty exact"), percent);
    }

    /// Puts the keyboard focus on whatever has this label.
    pub fn focus_label(&mut self, label: &str) {
        self.harness.get_by_label(label).focus();
        self.pass(FRAME * 2);
    }

    /// Types a number into a field and presses Enter.
    pub fn enter(&mut self, field: &str, number: &str) {
        self.harness.get_by_label(field).focus();
        self.pass(FRAME);
        self.harness.get_by_label(field).type_text(number);
        self.pass(FRAME);
        self.key(egui::Key::Enter);
        self.pass(FRAME);
    }
}

struct BenchPorts(Rc<RefCell<Option<Vec<PortInfo>>>>);

impl PortSource for BenchPorts {
    fn newest(&mut self) -> Option<Result<Vec<PortInfo>, Failure>> {
        self.0.borrow_mut().take().map(Ok)
    }
}

struct BenchOpener {
    lines: [Line; 2],
    minds: Line<MotionMindBus>,
    loops: [Slot; 3],
    claims: Rc<Cell<bool>>,
}

fn turn_one<M: Machine>(line: &Line<M>, device_loop: &Slot, until: Duration) {
    match device_loop.borrow().as_ref() {
        Some(device_loop) => device_loop.run_until(until),
        None => line.clock.advance_to(until),
    }
    line.with(|_| ());
}

impl Opener for BenchOpener {
    fn open(
        &mut self,
        target: ConnectTarget,
        addresses: Addresses,
    ) -> Receiver<Result<OpenLink, SessionError>> {
        let (sender, receiver) = bounded(1);
        let opened = match target {
            ConnectTarget::Sim(text) if text.starts_with("motion-mind") => Ok(self.open_minds(addresses)),
            ConnectTarget::Sim(_) => {
                let which = usize::from(target.to_string() == SECOND);
                let line = &self.lines[which];
                let index = line.with(|bus| bus.stream().index());
                let simulated = self.claims.get();
                let options = DeviceOptions {
                    addresses,
                    stream: Some(Stream::ALL[index]),
                    simulated,
                    hidden: simulated.then(|| Arc::new(BenchHidden(line.clone())) as _),
                    ..DeviceOptions::default()
                };
                let gate = Gate::new(line.clock.clone());
                let transport = Box::new(line.through(gate.clone()));
                let (device_loop, device) = DeviceLoop::new(transport, Arc::new(gate.clone()), options);
                *self.loops[which].borrow_mut() = Some(Lockstep::new(gate, device_loop));
                let world = simulated.then(|| Arc::new(BenchWorld::new(line.clone())) as _);
                Ok(OpenLink { device, bus: None, world })
            }
            other => Err(SessionError::from(OpenError::NotFound { path: other.to_string() })),
        };
        sender.send(opened).expect("the receiver is here");
        receiver
    }
}

impl BenchOpener {
    /// A loop on the line with the Motion Minds.
    fn open_minds(&self, addresses: Addresses) -> OpenLink {
        let options = DeviceOptions {
            addresses,
            family: FamilyChoice::of(brushwork_motion_mind_client::MOTION_MIND),
            simulated: true,
            ..DeviceOptions::default()
        };
        let gate = Gate::new(self.minds.clock.clone());
        let transport = Box::new(self.minds.through(gate.clone()));
        let (device_loop, device) = DeviceLoop::new(transport, Arc::new(gate.clone()), options);
        *self.loops[2].borrow_mut() = Some(Lockstep::new(gate, device_loop));
        OpenLink { device, bus: None, world: Some(Arc::new(MindWorld(self.minds.clone()))) }
    }
}

/// The worlds around the Motion Minds.
struct MindWorld(Line<MotionMindBus>);

impl SimulatedWorld for MindWorld {
    fn apply(&self, unit: usize, action: WorldAction) -> Result<(), Failure> {
        self.0.with(|bus| bus.apply(unit, &action));
        Ok(())
    }

    fn views(&self) -> Option<Arc<Vec<WorldView>>> {
        Some(Arc::new(self.0.with(|bus| bus.views())))
    }

    fn unit_at(&self, address: u8) -> Option<usize> {
        let number = brushwork_motion_mind_wire::register_named("ADDRESS").map_or(0, |row| row.number);
        self.0.with(|bus| {
            bus.motion_minds().iter().position(|unit| unit.read_one(number) == i64::from(address))
        })
    }

    fn debug(&self, _: usize, _: Vec<DebugRequest>, _: Wanted) -> Result<(), Failure> {
        Ok(())
    }

    fn script(&self) -> Option<View> {
        None
    }

    fn pace(&self) -> Option<Pace> {
        None
    }

    fn set_pace(&self, _: Pace) {}
}

/// The settings that packet serial does not carry.
struct BenchHidden(Line);

impl std::fmt::Debug for BenchHidden {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("BenchHidden")
    }
}

impl HiddenSettings for BenchHidden {
    fn get(&self, _address: brushwork_link::UnitAddress, key: &str) -> Option<i64> {
        self.0.with(|bus| bus.controllers()[0].settings().hidden(key).ok())
    }

    fn set(&self, _address: brushwork_link::UnitAddress, key: &str, raw: i64) -> Result<(), String> {
        let action = WorldAction::SetHidden { key: key.to_owned(), value: raw };
        self.0.with(|bus| bus.controllers_mut()[0].apply(&action)).map_err(|error| format!("{error}."))
    }
}

struct BenchWorld {
    line: Line,
    script: Mutex<Option<View>>,
    pace: Mutex<Pace>,
}

impl BenchWorld {
    fn new(line: Line) -> Self {
        Self { line, script: Mutex::default(), pace: Mutex::default() }
    }
}

impl SimulatedWorld for BenchWorld {
    fn apply(&self, unit: usize, action: WorldAction) -> Result<(), Failure> {
        self.line.with(|bus| bus.apply(unit, &action));
        Ok(())
    }

    fn views(&self) -> Option<Arc<Vec<WorldView>>> {
        Some(Arc::new(self.line.with(|bus| bus.views())))
    }

    fn unit_at(&self, address: u8) -> Option<usize> {
        let is_at = |unit: &Controller| unit.config().address.get() == address;
        self.line.with(|bus| bus.controllers().iter().position(is_at))
    }

    fn debug(&self, unit: usize, requests: Vec<DebugRequest>, wanted: Wanted) -> Result<(), Failure> {
        let view = self.line.with(|bus| bus.controllers_mut()[unit].debug(requests, &wanted));
        *self.script.lock().expect("no test panics with it") = Some(view);
        Ok(())
    }

    fn script(&self) -> Option<View> {
        self.script.lock().expect("no test panics with it").take()
    }

    /// Only noted: the bench turns the time by hand.
    fn pace(&self) -> Option<Pace> {
        Some(*self.pace.lock().expect("no test panics with it"))
    }

    fn set_pace(&self, pace: Pace) {
        *self.pace.lock().expect("no test panics with it") = pace;
    }
}
