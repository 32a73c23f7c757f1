//! The window's one place for change: events come in, commands are applied, motion is renewed.
//!
//! [`App::contents`] draws one frame and is all that eframe, the tests and the benchmarks need. It takes its time from
//! the link's own clock and its links from outside ([`Parts`]), and never waits for a byte.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use brushwork_link::Failure;
use brushwork_link::device::{ArmScope, DeviceHandle, Event, PollRate, Request};
use brushwork_sim::world::WorldAction;
use crossbeam_channel::TryRecvError;
use egui::{Context, Key, Modifiers, Ui};

use super::command::{Command, Commands};
use super::keys;
use super::links::{self, Links};
use super::model::general::SettingsWish;
use super::model::link::{Arming, Effect, LinkView};
use super::model::loop_settings::Column;
use super::model::message::Gravity;
use super::model::screen::Screen;
use super::model::{Appearance, DeskId, Model, Phase};
use super::parts::{OpenLink, Parts};
use super::{shell, theme};

/// Time between two frames while nobody touches anything: ten a second show what ten samples a second bring.
pub const FRAME_INTERVAL: Duration = Duration::from_millis(100);

/// Time between two looks at a link that is being opened.
const OPENING_INTERVAL: Duration = Duration::from_millis(50);

/// Events taken in one frame. More wait for the next, so that a flood cannot freeze the window.
const EVENTS_PER_FRAME: usize = 4096;

/// The window.
pub struct App {
    pub model: Model,
    parts: Parts,
    links: Links,
    shown: Option<Appearance>,
    last_frame: Arc<FrameTime>,
}

impl App {
    /// A window that has not been drawn yet. Fonts and colours are installed in `ctx`.
    pub fn new(ctx: &Context, parts: Parts) -> Self {
        theme::install(ctx);
        Self {
            model: Model::default(),
            parts,
            links: Links::default(),
            shown: None,
            last_frame: Arc::new(FrameTime::new()),
        }
    }

    /// Connects to what a person would have typed into the device list.
    pub fn open(&mut self, target: &str) {
        self.model.devices.choose(target);
        self.connect();
    }

    /// The open link in front, for those who measure it.
    pub fn device(&self) -> Option<&DeviceHandle> {
        self.links.device(self.model.front.id())
    }

    /// Draws one frame.
    pub fn contents(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        self.last_frame.drawn();
        if keys::take_stop_key(&ctx).is_some() {
            self.stop();
        }
        self.update(&ctx);
        let mut commands = self.shortcuts(&ctx);
        shell::shell_ui(ui, &mut self.model, &mut commands);
        for command in commands {
            self.apply(command);
        }
        self.read_loops();
        self.end_calibrations();
        self.drive(&ctx);
        self.show_appearance(&ctx);
    }

    /// Takes in what happened since the last frame.
    fn update(&mut self, ctx: &Context) {
        if let Some(listed) = self.parts.ports.newest() {
            self.model.devices.set_ports(listed);
        }
        for desk in self.links.ids() {
            self.finish_opening(desk, ctx);
            self.drain(desk);
            self.watch(desk);
            self.look_at_world(desk);
            self.look_after_graph(desk, ctx);
        }
    }

    /// Recordings, exports and files being opened.
    fn look_after_graph(&mut self, id: DeskId, ctx: &Context) {
        let now = self.links.device(id).map(DeviceHandle::now);
        let Some(desk) = self.model.desk_mut(id) else { return };
        let dark = ctx.global_style().visuals.dark_mode;
        let said = desk.graph.poll_files(now, dark);
        if desk.graph.files.is_busy() {
            ctx.request_repaint_after(FRAME_INTERVAL);
        }
        for (gravity, text) in said {
            self.say(id, gravity, text);
        }
    }

    /// Has read what a diagnosis needs. Nothing is said when it cannot be: it is tried again.
    fn watch(&mut self, id: DeskId) {
        let shows_settings = self.shows_settings_of(id);
        let (Some(device), Some(desk)) = (self.links.device(id), self.model.desk_mut(id)) else { return };
        let is_quiet = desk.link.arming == Arming::Disarmed && desk.is_connected();
        if let Some(identity) = desk.link.identity().cloned().filter(|_| is_quiet)
            && let Some(request) = desk.watch.read(&identity)
            && device.request(request).is_err()
        {
            desk.watch.not_begun();
        }
        let wanted = desk.watch.wants_signals() || desk.shows_signals(shows_settings);
        let traced = desk.traffic.open;
        let link = self.links.entry(id);
        if link.reads_signals != wanted
            && let Some(device) = &link.device
            && device.request(Request::ReadSignals(wanted)).is_ok()
        {
            link.reads_signals = wanted;
            if !wanted {
                desk.link.readings.forget_signals();
            }
        }
        if link.traced != traced
            && let Some(device) = &link.device
            && device.request(Request::Trace(traced)).is_ok()
        {
            link.traced = traced;
        }
    }

    /// Takes in a link's events, in front or not.
    fn drain(&mut self, desk: DeskId) {
        if let (Some(device), Some(desk)) = (self.links.device(desk), self.model.desk_mut(desk)) {
            desk.history.tick(device.now());
        }
        for _ in 0..EVENTS_PER_FRAME {
            let Some(device) = self.links.device(desk) else { break };
            match device.events().try_recv() {
                Ok(event) => self.take(desk, event),
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => {
                    self.say(desk, Gravity::Error, "The link ended without a reason. Connect again.");
                    self.ended(desk);
                }
            }
        }
    }

    /// Sees the worlds of simulated units as they are now.
    fn look_at_world(&mut self, id: DeskId) {
        let Some(desk) = self.model.desk_mut(id) else { return };
        let world = self.links.get(id).and_then(|link| link.world.as_ref());
        desk.worlds = world.and_then(|world| world.views());
        let Some(world) = world else { return };
        let unit = desk.link.selected.and_then(|address| world.unit_at(address));
        // Without a link the unit looked at last stays in view.
        if let Some(unit) = unit
            && unit != desk.world_unit
        {
            desk.world_unit = unit;
            desk.world.forget();
        }
    }

    fn finish_opening(&mut self, id: DeskId, ctx: &Context) {
        let Some(opening) = self.links.get(id).and_then(|link| link.opening.as_ref()) else { return };
        let why = match opening.try_recv() {
            Ok(Ok(link)) => return self.opened(id, link, ctx),
            Ok(Err(error)) => error.to_string(),
            Err(TryRecvError::Empty) => return ctx.request_repaint_after(OPENING_INTERVAL),
            Err(TryRecvError::Disconnected) => {
                "Could not open the link: the system gave no thread. Try again.".to_owned()
            }
        };
        self.links.entry(id).opening = None;
        if let Some(desk) = self.model.desk_mut(id) {
            desk.phase = Phase::Closed;
        }
        self.say(id, Gravity::Error, why);
    }

    fn opened(&mut self, id: DeskId, opened: OpenLink, ctx: &Context) {
        let link = self.links.entry(id);
        link.opening = None;
        // A desk that was given up meanwhile: the link is closed again by being dropped.
        let Some(desk) = self.model.desk_mut(id) else { return };
        let target = desk.phase.target().unwrap_or_default().to_owned();
        desk.phase = Phase::Open { target };
        desk.link = LinkView::default();
        desk.world.forget();
        link.world = opened.world;
        opened.device.set_waker(waker(ctx.clone(), self.last_frame.clone()));
        let poll = desk.poll;
        link.device = Some(opened.device);
        link.reads_signals = false;
        link.traced = false;
        if poll != PollRate::default() {
            self.request_of(id, Request::Poll(poll));
        }
    }

    fn take(&mut self, id: DeskId, event: Event) {
        let now_s = self.links.device(id).map_or(0.0, |device| device.now().as_secs_f64());
        let Some(desk) = self.model.desk_mut(id) else { return };
        desk.graph.note(&event, now_s);
        for effect in desk.take(event) {
            match effect {
                Effect::Say(gravity, text) => self.say(id, gravity, text),
                Effect::Ended => self.ended(id),
                // The desk has done the rest.
                Effect::AtRest | Effect::Sample(_) | Effect::OtherUnit => {}
            }
        }
    }

    /// Says something about a link; one in the background is named.
    fn say(&mut self, id: DeskId, gravity: Gravity, text: impl Into<String>) {
        let text = text.into();
        let behind = self.model.others.iter().find(|desk| desk.id() == id);
        let text = match behind.and_then(|desk| desk.phase.target()) {
            Some(target) => format!("{target}: {text}"),
            None => text,
        };
        self.model.messages.say(gravity, text);
    }

    /// A link is gone, by wish or not. A simulated world lives on.
    fn ended(&mut self, id: DeskId) {
        if let Some(device) = self.links.entry(id).device.take() {
            links::close(device);
        }
        if let Some(desk) = self.model.desk_mut(id) {
            desk.link_ended();
        }
    }

    fn apply(&mut self, command: Command) {
        match command {
            Command::Connect => self.connect(),
            Command::Disconnect => self.disconnect(),
            Command::Show(screen) => self.show(screen),
            Command::Stop => self.stop(),
            Command::Arm(scope) => {
                self.model.front.link.refusals.clear();
                if self.request(Request::Arm(scope)) {
                    self.model.front.link.arming = Arming::Asked(scope);
                }
            }
            Command::Disarm => self.disarm(),
            Command::SelectUnit(address) => {
                self.disarm();
                self.request(Request::Select(address));
            }
            Command::SetStream(stream) => {
                if self.request(Request::SetStream(stream)) {
                    self.model.front.link.stream = Some(stream);
                }
            }
            Command::ZeroEncoder(motor) => {
                self.request(Request::SetEncoder { motor, counts: 0 });
            }
            Command::ResetEmergencyStop => {
                self.request(Request::ResetEStop);
            }
            Command::Poll(rate) => self.poll(rate),
            Command::ReadLoops => self.model.front.loops.want_reading(),
            Command::ApplyLoops(columns) => self.apply_loops(columns),
            Command::World(action) => self.act_on_world(action),
            Command::Settings(wish) => self.settings(wish),
            Command::Transact { id, command, values } => {
                if !self.request(Request::Transact { id, command, values }) {
                    self.model.front.traffic.composer.forget_waiting();
                }
            }
            Command::DismissMessage => self.model.messages.dismiss(),
        }
    }

    fn connect(&mut self) {
        if self.model.front.phase != Phase::Closed {
            return;
        }
        match self.model.devices.target() {
            Ok(target) => {
                self.model.messages.dismiss();
                self.model.front.phase = Phase::Opening { target: target.to_string() };
                let opening = self.parts.opener.open(target, self.model.devices.addresses);
                self.links.entry(self.model.front.id()).opening = Some(opening);
            }
            Err(error) => {
                let typed = self.model.devices.typed.trim();
                let mend = "Type a path such as /dev/ttyUSB0 or COM3, or tcp:host:port";
                self.model.messages.fail(Failure::new("connect", typed, error, mend).to_string());
            }
        }
    }

    fn disconnect(&mut self) {
        match &self.model.front.phase {
            Phase::Opening { .. } => {
                self.links.entry(self.model.front.id()).opening = None;
                self.model.front.phase = Phase::Closed;
                self.model.messages.note("Gave up connecting.");
            }
            Phase::Open { target } => {
                self.model.front.phase = Phase::Closing { target: target.clone() };
                self.request(Request::Disconnect);
            }
            Phase::Closed | Phase::Closing { .. } => {}
        }
    }

    fn show(&mut self, screen: Screen) {
        if screen == self.model.screen || screen.missing().is_some() {
            return;
        }
        if self.model.screen.arm_scope().is_some() {
            self.disarm();
        }
        self.model.turn_to(screen);
        if screen == Screen::DeviceStatus {
            self.model.front.watch.want_reading();
        }
        self.model.front.loops.want_reading();
    }

    /// Reads the settings of the control loops when a screen that shows them wants them.
    fn read_loops(&mut self) {
        if !self.model.screen.has_loops() || !self.model.front.loops.wants_reading() {
            return;
        }
        let Some(identity) = self.model.front.link.identity().cloned() else { return };
        if let Some(request) = self.model.front.loops.read(&identity)
            && !self.request(request)
        {
            self.model.front.loops.not_begun();
        }
    }

    /// Puts an input back whose calibration has ended or was left.
    fn end_calibrations(&mut self) {
        for id in self.links.ids() {
            let is_shown = self.shows_settings_of(id);
            let Some(desk) = self.model.desk_mut(id) else { continue };
            if !is_shown {
                desk.general.cancel_calibration();
            }
            if let Some(wish) = desk.general.next_wish() {
                self.settings_of(id, wish);
            }
        }
    }

    fn shows_settings_of(&self, id: DeskId) -> bool {
        self.model.screen == Screen::GeneralSettings && id == self.model.front.id()
    }

    fn apply_loops(&mut self, columns: &[Column]) {
        let Some(identity) = self.model.front.link.identity().cloned() else { return };
        let stream = self.model.front.link.stream;
        if let Some(request) = self.model.front.loops.apply(columns, &identity, stream) {
            if self.request(request) {
                self.model.front.general.ram_changes();
            } else {
                self.model.front.loops.not_begun();
            }
        }
    }

    /// Stops all motors of every link, at once and without asking anything first.
    fn stop(&mut self) {
        self.links.stop_all();
        for desk in self.model.desks_mut() {
            desk.link.arming = Arming::Disarmed;
            desk.rest();
        }
    }

    fn disarm(&mut self) {
        if self.model.front.link.arming != Arming::Disarmed {
            self.request(Request::Disarm);
        }
        self.at_rest();
    }

    /// The screen is disarmed and its sliders are at zero; the device thread stops the motors.
    fn at_rest(&mut self) {
        self.model.front.link.arming = Arming::Disarmed;
        self.model.front.rest();
    }

    fn poll(&mut self, rate: PollRate) {
        self.model.front.poll = rate;
        let interval = match rate {
            PollRate::Every(time) => time,
            PollRate::Fastest | PollRate::Off => FRAME_INTERVAL,
        };
        self.model.front.graph.set_interval(interval.as_secs_f64());
        if self.device().is_some() {
            self.request(Request::Poll(rate));
        }
    }

    /// Starts or ends work with the settings, on the device thread.
    fn settings(&mut self, wish: SettingsWish) {
        self.settings_of(self.model.front.id(), wish);
    }

    fn settings_of(&mut self, id: DeskId, wish: SettingsWish) {
        let Some(desk) = self.model.desk_mut(id) else { return };
        let stream = desk.link.stream;
        if let Some(request) = desk.general.begin(wish, stream)
            && !self.request_of(id, request)
            && let Some(desk) = self.model.desk_mut(id)
        {
            desk.general.not_begun();
        }
    }

    fn act_on_world(&mut self, action: WorldAction) {
        let unit = self.model.front.world_unit;
        let world = self.links.get(self.model.front.id()).and_then(|link| link.world.as_ref());
        if let Some(Err(failure)) = world.map(|world| world.apply(unit, action)) {
            self.model.messages.fail(failure.to_string());
        }
    }

    /// While armed: sends what the sliders ask for and lets the motion live on.
    fn drive(&mut self, ctx: &Context) {
        let armed_for = |scope| self.model.front.link.arming.is_armed_for(scope);
        let Some(scope) = self.model.screen.arm_scope().filter(|scope| armed_for(*scope)) else { return };
        let Some(device) = self.links.device(self.model.front.id()) else { return };
        device.renew();
        let model = &mut self.model;
        let (drive, setpoints) = match scope {
            ArmScope::Pwm => (model.front.pwm.to_send(), &mut model.front.pwm.setpoints),
            ArmScope::Velocity => (model.front.velocity.to_send(), &mut model.front.velocity.setpoints),
            _ => return,
        };
        // A full queue takes it in the next frame.
        if let Some(drive) = drive
            && device.request(Request::Drive(drive)).is_ok()
        {
            setpoints.sent();
        }
        ctx.request_repaint_after(FRAME_INTERVAL);
    }

    /// Ctrl and a digit shows a screen, Ctrl+B the panel of the simulated world, Ctrl+T the traffic.
    fn shortcuts(&mut self, ctx: &Context) -> Commands {
        let keys = [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6];
        let pressed = |key| ctx.input_mut(|input| input.consume_key(Modifiers::COMMAND, key));
        if pressed(Key::B) {
            self.model.front.world.open = !self.model.front.world.open;
        }
        if pressed(Key::T) {
            self.model.front.traffic.open = !self.model.front.traffic.open;
        }
        let screens = keys.into_iter().zip(Screen::ALL).filter(|(key, _)| pressed(*key));
        screens.map(|(_, screen)| Command::Show(screen)).collect()
    }

    /// Queues a request to the link in front; a refusal is told.
    fn request(&mut self, request: Request) -> bool {
        self.request_of(self.model.front.id(), request)
    }

    fn request_of(&mut self, desk: DeskId, request: Request) -> bool {
        let Some(device) = self.links.device(desk) else { return false };
        match device.request(request) {
            Ok(()) => true,
            Err(refused) => {
                self.say(desk, Gravity::Error, refused.to_string());
                false
            }
        }
    }

    fn show_appearance(&mut self, ctx: &Context) {
        let wanted = self.model.appearance;
        if self.shown != Some(wanted) {
            ctx.set_theme(wanted.theme);
            theme::draw_plainly(ctx, wanted.plain);
            self.shown = Some(wanted);
        }
    }
}

/// When the last frame was drawn, for the device thread to read.
struct FrameTime {
    epoch: Instant,
    drawn_at_ns: AtomicU64,
}

impl FrameTime {
    fn new() -> Self {
        Self { epoch: Instant::now(), drawn_at_ns: AtomicU64::new(0) }
    }

    fn drawn(&self) {
        let since_epoch = u64::try_from(self.epoch.elapsed().as_nanos()).unwrap_or(u64::MAX);
        self.drawn_at_ns.store(since_epoch, Ordering::Relaxed);
    }

    /// How long the next frame has to wait, so that there are no more than one in each [`FRAME_INTERVAL`].
    fn until_next(&self) -> Duration {
        let drawn_at = Duration::from_nanos(self.drawn_at_ns.load(Ordering::Relaxed));
        FRAME_INTERVAL.saturating_sub(self.epoch.elapsed().saturating_sub(drawn_at))
    }
}

/// Asks for a frame when there is news. Called on the device thread.
fn waker(ctx: Context, last_frame: Arc<FrameTime>) -> Box<dyn Fn() + Send> {
    // Without any wait egui draws two frames.
    Box::new(move || ctx.request_repaint_after(last_frame.until_next().max(Duration::from_millis(1))))
}
