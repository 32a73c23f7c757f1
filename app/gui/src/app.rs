//! The window's one place for change: events come in, commands are applied, motion is renewed.
//!
//! [`App::contents`] draws one frame and is all that eframe, the tests and the benchmarks need. It takes its time from
//! the link's own clock and its links from outside ([`Parts`]), and never waits for a byte.

use crate::messages::{CompareMessage, GraphMessage, WindowStatusMessage};
use brushwork_core::messages::EndedMessage;
use brushwork_link::Message;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use brushwork_link::clock::Instant;
use brushwork_link::device::{ArmScope, DeviceHandle, Event, PollRate, QueuedJob, Request};
use brushwork_plant::world::WorldAction;
use crossbeam_channel::TryRecvError;
use egui::{Context, Ui, Vec2, ViewportCommand, vec2};

use super::command::{Command, GuidedAction};
use super::ending::EndBySignal;
use super::focus::{self, Region};
use super::frame::FRAME_INTERVAL;
use super::links::Links;
use super::model::palette::Palette;
use super::model::traffic::Transact;
use super::model::{Appearance, ConnectionId, Model};
use super::parts::{Parts, SimulatedWorld};
use super::remember::Memory;
use super::screens::face;
use super::widgets::text_field;
use super::{actions, keys, shell, theme};
use crate::model::Afterwards;
use crate::model::{Arming, Effect, Gravity, Owner, Screen, Section, Sheet, Side, Tab};

mod assistants;
mod debugging;
mod examining;
mod files;
mod leaving;
mod linking;
mod own;
mod scripting;
mod settings;
mod tuning;

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
    /// The window was asked to close.
    closing: bool,
    leaving: leaving::Leaving,
    memory: Option<Memory>,
    end: EndBySignal,
    last_frame: Arc<FrameTime>,
    ctx: Context,
}

impl App {
    /// A window that has not been drawn yet. Fonts and colours are installed in `ctx`.
    pub fn new(ctx: &Context, parts: Parts) -> Self {
        theme::install(ctx);
        let mut model = Model::default();
        model.mcl.start(ctx, parts.keeping.store().root());
        Self {
            model,
            parts,
            links: Links::default(),
            shown: None,
            closing: false,
            leaving: leaving::Leaving::default(),
            memory: None,
            end: EndBySignal::default(),
            last_frame: Arc::new(FrameTime::new()),
            ctx: ctx.clone(),
        }
    }

    /// Makes the window like it was, and keeps from now on what it is like.
    pub fn remember(&mut self, memory: Memory) {
        memory.current.recall(&mut self.model);
        self.memory = Some(memory);
    }

    /// Closes, with all motors stopped, when a signal asks the program to end.
    pub fn end_by(&mut self, end: EndBySignal, ctx: &Context) {
        end.set_window(ctx.clone());
        self.end = end;
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

    /// The simulated world behind the link in front, if there is one.
    pub fn world(&self) -> Option<&dyn SimulatedWorld> {
        self.links.get(self.model.front.id())?.world.as_deref()
    }

    /// Draws one frame.
    pub fn contents(&mut self, ui: &mut Ui) {
        let ctx = ui.ctx().clone();
        self.last_frame.drawn();
        if keys::take_stop_key(&ctx).is_some() {
            self.stop();
        }
        // On a busy computer a frame may take most of a motion's life: it lives on from its begin and from its end.
        self.renew();
        if let Some((bytes, most)) = text_field::refuse_long_paste(&ctx) {
            self.model.messages.fail(WindowStatusMessage::PasteTooLong { bytes, most });
        }
        focus::note_input(&ctx);
        self.update(&ctx);
        self.look_as_before();
        self.leave_missing_screen();
        self.take_files(&ctx);
        let mut commands = actions::shortcuts(&ctx, &mut self.model);
        self.model.appearance.language.begin();
        shell::shell_ui(ui, &mut self.model, &mut commands);
        for command in commands {
            self.apply(command);
        }
        if let Some(unit) = self.model.front.settings.unit_mut() {
            unit.note_step();
        }
        self.ask_debugger(&ctx);
        self.go_on_tuning();
        self.go_on_examining();
        self.go_on_assisting();
        self.read_loops();
        self.read_for_screen();
        self.end_calibrations();
        self.look_for_settings();
        self.disarm_when_left();
        self.drive(&ctx);
        self.show_appearance(&ctx);
        if let Some(failure) = self.memory.as_mut().and_then(|memory| memory.look(&ctx, &self.model)) {
            self.model.messages.warn(failure.message());
        }
        self.look_after_programs(&ctx);
        self.hold_unsaved(&ctx);
        self.hold_open(&ctx);
        self.hold_for_run(&ctx);
        if self.end.is_asked() {
            self.model.mcl.keep_all();
        }
        if (self.closing || self.end.is_asked()) && !self.is_held() {
            self.links.stop_all();
            ctx.send_viewport_cmd(ViewportCommand::Close);
        }
    }

    /// A unit that is met is looked at as it was the last time; its screen is gone to once, when its link was opened.
    fn look_as_before(&mut self) {
        let Some(unit) = self.model.front.unit_name() else { return };
        if self.model.front.viewed_as.as_ref() == Some(&unit) {
            return;
        }
        let view = self.memory.as_ref().and_then(|memory| memory.current.view_of(&unit)).cloned();
        let was_met = self.model.front.viewed_as.replace(unit).is_some();
        let Some(view) = view else { return };
        self.model.front.look_as(&view);
        let screen = self.model.front.screens().into_iter().find(|screen| screen.title() == view.screen);
        if let Some(screen) = screen.filter(|_| !was_met) {
            self.show(screen);
        }
    }

    /// Takes in what happened since the last frame.
    fn update(&mut self, ctx: &Context) {
        self.model.devices.can_choose = self.parts.ports.can_choose();
        if let Some(listed) = self.parts.ports.newest() {
            self.model.devices.set_ports(listed);
        }
        if let Some(why) = self.parts.ports.take_refusal() {
            self.model.messages.warn(why);
        }
        self.take_started(ctx);
        for connection in self.links.ids() {
            self.finish_opening(connection, ctx);
            self.drain(connection);
            self.watch(connection);
            self.look_at_world(connection);
            self.look_at_script(connection, ctx);
            self.look_after_graph(connection, ctx);
            face::all().for_each(|face| face.go_on(self, connection, ctx));
            self.send_kept_command(connection);
        }
    }

    /// Recordings, exports and files being opened.
    fn look_after_graph(&mut self, id: ConnectionId, ctx: &Context) {
        let now = self.links.device(id).map(DeviceHandle::now);
        let Some(connection) = self.model.connection_mut(id) else { return };
        let dark = ctx.global_style().visuals.dark_mode;
        let said = connection.graph.poll_files(now, dark);
        if let Some(image) = connection.graph.files.take_copied() {
            ctx.copy_image(image);
            self.model.messages.note(GraphMessage::CopiedPicture);
        }
        let Some(connection) = self.model.connection_mut(id) else { return };
        if connection.graph.files.is_busy() {
            ctx.request_repaint_after(FRAME_INTERVAL);
        }
        for (gravity, text) in said {
            self.say(id, gravity, text);
        }
    }

    /// Has read what a diagnosis needs. Nothing is said when it cannot be: it is tried again.
    fn watch(&mut self, id: ConnectionId) {
        let shows_settings = self.shows_settings_of(id);
        let screen = (self.model.front.id() == id).then_some(self.model.screen);
        let (Some(device), Some(connection)) = (self.links.device(id), self.model.connection_mut(id)) else {
            return;
        };
        let is_quiet = connection.link.arming == Arming::Disarmed
            && connection.is_connected()
            && !connection.is_turned_elsewhere();
        let keys = if is_quiet { connection.diagnosis_keys() } else { Vec::new() };
        if let Some(job) = connection.settings.read(&keys, true) {
            let job_id = job.id();
            match device.request(Request::Job(job)) {
                Ok(()) => connection.jobs.begun(job_id, Owner::Settings),
                Err(_) => connection.settings.not_begun(),
            }
        }
        let wanted = connection.diagnosis_wants_signals()
            || connection.shows_signals(shows_settings)
            || connection.graph.wants_pins();
        let unit = connection.link.identity();
        let is_heard = unit
            .zip(screen)
            .is_some_and(|(unit, screen)| connection.own.iter().any(|own| own.shows_unasked(unit, screen)));
        let traced = connection.traffic.open || is_heard;
        let link = self.links.entry(id);
        if link.reads_signals != wanted
            && let Some(device) = &link.device
            && device.request(Request::ReadSignals(wanted)).is_ok()
        {
            link.reads_signals = wanted;
            if !wanted {
                connection.link.readings.forget_signals();
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
    fn drain(&mut self, connection: ConnectionId) {
        if let (Some(device), Some(connection)) =
            (self.links.device(connection), self.model.connection_mut(connection))
        {
            connection.history.tick(device.now());
        }
        for _ in 0..EVENTS_PER_FRAME {
            let Some(device) = self.links.device(connection) else { break };
            match device.events().try_recv() {
                Ok(event) => self.take(connection, event),
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => {
                    self.say(connection, Gravity::Error, WindowStatusMessage::LinkEnded.into());
                    self.ended(connection);
                }
            }
        }
    }

    /// Sees the worlds of simulated units as they are now.
    fn look_at_world(&mut self, id: ConnectionId) {
        let Some(connection) = self.model.connection_mut(id) else { return };
        let world = self.links.get(id).and_then(|link| link.world.as_ref());
        connection.worlds = world.and_then(|world| world.views());
        let Some(world) = world else { return };
        let unit = connection.link.selected.and_then(|address| world.unit_at(address));
        // Without a link the unit looked at last stays in view.
        if let Some(unit) = unit
            && unit != connection.world_unit
        {
            connection.world_unit = unit;
            connection.world.forget();
        }
    }

    fn take(&mut self, id: ConnectionId, event: Event) {
        let now_s = self.links.device(id).map_or(0.0, |device| device.now().as_secs_f64());
        let Some(connection) = self.model.connection_mut(id) else { return };
        connection.graph.note(&event, now_s);
        for effect in connection.take(event) {
            match effect {
                Effect::Say(gravity, text) => self.say(id, gravity, text),
                Effect::Ended => self.ended(id),
                // The connection has done the rest.
                Effect::AtRest | Effect::Sample(_) | Effect::OtherUnit => {}
            }
        }
    }

    /// Says something about a link; one in the background is named.
    fn say(&mut self, id: ConnectionId, gravity: Gravity, text: Message) {
        let behind = self.model.others.iter().find(|connection| connection.id() == id);
        let text = match behind.and_then(|connection| connection.phase.target()) {
            Some(target) => WindowStatusMessage::Of { target: target.to_owned(), text }.into(),
            None => text,
        };
        self.model.messages.say(gravity, text);
    }

    fn apply(&mut self, command: Command) {
        let model = &mut self.model;
        match command {
            Command::Connect => self.connect(),
            Command::Disconnect(connection) => self.disconnect(connection),
            Command::Front(connection) => self.bring_to_front(connection),
            Command::Forget(connection) => self.forget(connection),
            Command::ConnectTo(target) => self.connect_to(&target, target.parse()),
            Command::ForgetRecent(target) => model.devices.forget_recent(&target),
            Command::Show(screen) => self.show(screen),
            Command::Stop => self.stop(),
            Command::Arm(scope) => self.arm(scope),
            Command::Disarm => self.disarm(),
            Command::SelectUnit(address) => self.select_unit(address),
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
            Command::RunLibrary => self.run_library(),
            Command::LearnAnew => {
                self.request(Request::LearnAnew);
            }
            Command::Poll(rate) => self.poll(rate),
            Command::Reverse(image) => self.reverse(image),
            Command::BackUp => match model.front.settings.back_up() {
                Ok(said) => model.messages.note(said),
                Err(why) => model.messages.fail(why),
            },
            Command::ReadLoops => self.read_loops_again(),
            Command::ApplyLoops(columns) => self.apply_loops(columns),
            Command::World(action) => self.act_on_world(action),
            Command::ToggleWorld => model.front.world.open = !model.front.world.open,
            Command::Settings(action) => self.settings(action),
            Command::Raw { id, bytes } => self.send_raw(id, bytes),
            Command::Transact { id, command, values } => self.transact(Transact { id, command, values }),
            Command::Guided(action) => self.guided(action),
            Command::Tune(action) => self.tune(action),
            Command::OpenExamination => model.front.examination.open = true,
            Command::Examination(action) => self.examine(action),
            Command::OpenAddressing => self.open_addressing(),
            Command::Addressing(action) => self.address(action),
            Command::OpenToAll => self.open_to_all(),
            Command::ToAll(action) => self.act_for_all(action),
            Command::OpenRaw => self.open_raw(),
            Command::WriteRaw(action) => self.raw(action),
            Command::ChoosePort => self.choose_port(),
            Command::OpenFirmware => {
                if let Err(why) = self.open_firmware(None) {
                    self.model.messages.fail(why);
                }
            }
            Command::OpenFile(path) => self.open_file(&path),
            Command::ChooseFile => model.files.browse(),
            Command::ListBackups => self.list_backups(),
            Command::ShowStart => model.show_start(),
            Command::OpenSheet(sheet) => self.open_sheet(sheet),
            Command::CopyUnit => self.copy_unit(),
            Command::ShowSettings(section) => {
                self.show(Screen::GeneralSettings);
                self.model.front.general.turn_to(section);
            }
            Command::ShowRecipe(job) => {
                self.show(Screen::GeneralSettings);
                self.model.front.general.recipes.job = Some(job);
                self.model.front.general.turn_to(Section::Recipes);
            }
            Command::OpenDrawer(screen, tab) => self.open_drawer(screen, tab),
            Command::FindSetting => {
                self.show(Screen::GeneralSettings);
                self.model.front.general.find();
            }
            Command::RevertSettings => {
                if let Some(unit) = model.front.settings.unit_mut() {
                    unit.revert_all();
                }
            }
            Command::StepSettings { again } => {
                if let Some(unit) = model.front.settings.unit_mut() {
                    unit.step_back(again);
                }
            }
            Command::ClampTest => self.clamp_test(),
            Command::Own(action) => {
                if let Err(why) = action.act(self) {
                    self.model.messages.fail(why);
                }
            }
            Command::Debug(action) => self.debug(action),
            Command::Mcl(action) => self.edit_mcl(action),
            Command::DownloadMcl => self.download_mcl(),
            Command::CancelDownload => model.front.script.job.cancel(),
            Command::StartScript => self.start_script(),
            Command::StopScript => self.stop_script(),
            Command::Theme(theme) => model.appearance.theme = theme,
            Command::Language(language) => model.appearance.language = language,
            Command::PlainEdges(plain) => model.appearance.plain = plain,
            Command::Scale(percent) => model.appearance.set_scale(percent),
            Command::StartNode(node) => self.start_node(node),
            Command::OpenCanOpen => model.canopen.show(&model.devices.ports),
            Command::Graph(action) => model.front.graph.act(action),
            Command::PauseTraffic(paused) => model.front.traffic.log.set_paused(paused),
            Command::ClearHistory => model.front.history.clear(),
            Command::ToggleTraffic => model.front.traffic.open = !model.front.traffic.open,
            Command::OpenPalette => {
                model.palette = if model.palette.is_some() { None } else { Some(Palette::opened()) };
            }
            Command::NextRegion { forward } => focus::go_on(&self.ctx, forward),
            Command::OpenHelp(page) => model.help.open(page),
            Command::Exit => self.closing = true,
            Command::DismissMessage => model.messages.dismiss(),
        }
    }

    fn arm(&mut self, scope: ArmScope) {
        // The switch and its key in the middle of a run ask for its end, wherever it is between two jobs.
        if self.model.front.tune.is_running() {
            return self.disarm();
        }
        // The unit that would be armed may be another one than is shown.
        if self.model.front.is_turned_elsewhere() {
            return self.model.messages.fail(WindowStatusMessage::AssistantWorks);
        }
        self.model.front.link.refusals.clear();
        if self.request(Request::Arm(scope)) {
            self.model.front.link.arming = Arming::Asked(scope);
        }
    }

    fn select_unit(&mut self, address: u8) {
        if !self.waits_for_run(self.model.front.id(), Afterwards::Select(address)) {
            self.disarm();
            self.turn_to_unit(self.model.front.id(), address);
        }
    }

    fn open_sheet(&mut self, sheet: Sheet) {
        self.show(Screen::GeneralSettings);
        if sheet == Sheet::Compare {
            let others = self.model.other_units();
            self.model.front.general_view().set_others(others);
        }
        self.model.front.general_view().open_once_read(sheet);
    }

    fn copy_unit(&mut self) {
        let Some(first) = self.model.other_units().into_keys().next() else {
            return self.model.messages.warn(CompareMessage::NoOtherUnit);
        };
        self.open_sheet(Sheet::Compare);
        self.model.front.general_view().compare_with(Side::Ram, Side::Unit(first));
    }

    fn open_drawer(&mut self, screen: Screen, tab: Tab) {
        self.show(screen);
        if self.model.front.open_tab(screen) != Some(tab) {
            self.model.front.drawers.press(screen, tab);
        }
    }

    fn show(&mut self, screen: Screen) {
        // Whoever goes there wants to write.
        self.model.mcl.wants_focus |= screen == Screen::MclEditor;
        self.model.front.shows_start = false;
        if screen == self.model.screen {
            return;
        }
        if self.model.arm_scope().is_some() {
            self.disarm();
        }
        self.model.front.tune.want_winding_back();
        self.model.turn_to(screen);
        if screen != Screen::MclEditor {
            focus::want(&self.ctx, Region::Screen);
        }
        if screen == Screen::DeviceStatus {
            self.model.front.doubt_diagnosis();
        }
    }

    /// Who turns to a controller that lacks the screen sees its status instead of nothing.
    fn leave_missing_screen(&mut self) {
        let front = &self.model.front;
        if front.is_connected() && !front.screens().contains(&self.model.screen) {
            self.show(Screen::DeviceStatus);
        }
    }

    /// Leaving the page of the clamp test disarms as leaving a screen does.
    fn disarm_when_left(&mut self) {
        let arming = self.model.front.link.arming;
        let is_tested =
            arming == Arming::Asked(ArmScope::ClampTest) || arming.is_armed_for(ArmScope::ClampTest);
        if is_tested && self.model.arm_scope() != Some(ArmScope::ClampTest) {
            self.disarm();
        }
    }

    /// Stops all motors of every link, at once and without asking anything first.
    fn stop(&mut self) {
        self.links.stop_all();
        self.model.to_all.cancel();
        for connection in self.model.connections_mut() {
            connection.tune.abort(EndedMessage::StopPressed);
            connection.examination.cancel(Gravity::Warning, EndedMessage::StopPressed);
            connection.link.arming = Arming::Disarmed;
            connection.rest();
        }
    }

    fn disarm(&mut self) {
        self.model.front.tune.abort(EndedMessage::ScreenLeft);
        if self.model.front.examination.arm_scope().is_some() {
            self.model.front.examination.cancel(Gravity::Warning, EndedMessage::ScreenLeft);
        }
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
        self.model.front.graph.rate.ask(interval.as_secs_f64());
        if self.device().is_some() {
            self.request(Request::Poll(rate));
        }
    }

    /// Starts or ends a job that moves motors.
    fn guided(&mut self, action: GuidedAction) {
        match self.model.front.begin_guided(action, self.model.screen) {
            Ok(Some((owner, job))) => {
                if !self.start_for(self.model.front.id(), owner, job) {
                    self.model.front.guided_not_begun();
                }
            }
            Ok(None) => {}
            Err(sentence) => self.model.messages.fail(sentence),
        }
    }

    fn act_on_world(&mut self, action: WorldAction) {
        let unit = self.model.front.world_unit;
        let world = self.links.get(self.model.front.id()).and_then(|link| link.world.as_ref());
        if let Some(Err(failure)) = world.map(|world| world.apply(unit, action)) {
            self.model.messages.fail(failure.message());
        }
    }

    /// Lets the motion of the screen that is shown live on, if that is armed: for what.
    fn renew(&self) -> Option<ArmScope> {
        let armed_for = |scope: &ArmScope| self.model.front.link.arming.is_armed_for(*scope);
        let scope = self.model.arm_scope().filter(armed_for)?;
        self.device()?.renew();
        Some(scope)
    }

    /// While armed: sends what the sliders ask for and lets the motion live on.
    fn drive(&mut self, ctx: &Context) {
        let Some(scope) = self.renew() else { return };
        let Some(device) = self.links.device(self.model.front.id()) else { return };
        let front = &mut self.model.front;
        // A full queue takes it in the next frame.
        if let Some(drive) = front.family().to_send(scope, front.sliders())
            && device.request(Request::Drive(drive)).is_ok()
        {
            front.sent(scope);
        }
        ctx.request_repaint_after(FRAME_INTERVAL);
    }

    /// Queues a job, whose events go to its owner.
    fn start_for(&mut self, id: ConnectionId, owner: Owner, job: QueuedJob) -> bool {
        let job_id = job.id();
        let is_taken = self.request_of(id, Request::Job(job));
        if let Some(connection) = self.model.connection_mut(id).filter(|_| is_taken) {
            connection.jobs.begun(job_id, owner);
        }
        is_taken
    }

    /// Queues a request to the link in front; a refusal is told.
    fn request(&mut self, request: Request) -> bool {
        self.request_of(self.model.front.id(), request)
    }

    fn request_of(&mut self, connection: ConnectionId, request: Request) -> bool {
        if let Some(connection) = self.model.connection_mut(connection) {
            connection.settings.give_way();
        }
        let Some(device) = self.links.device(connection) else { return false };
        match device.request(request) {
            Ok(()) => true,
            Err(refused) => {
                self.say(connection, Gravity::Error, Message::error(refused));
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
        let zoom = fitting_zoom(ctx.content_rect().size() * ctx.zoom_factor(), wanted.scale_percent);
        if (zoom - ctx.zoom_factor()).abs() > LEAST_CHANGE_OF_ZOOM {
            ctx.set_zoom_factor(zoom);
        }
    }
}

/// The room that every screen needs, in points.
const LEAST_SIZE: Vec2 = vec2(1024.0, 700.0);
/// Below that text cannot be read, whatever room is missing.
const LEAST_ZOOM: f32 = 0.5;
/// Less is a matter of rounding, and would have the window drawn again and again.
const LEAST_CHANGE_OF_ZOOM: f32 = 0.004;

/// As large as is wanted, and no larger than every screen has room for in a window of so many points at 100 %.
fn fitting_zoom(native: Vec2, scale_percent: u16) -> f32 {
    let fits = (native.x / LEAST_SIZE.x).min(native.y / LEAST_SIZE.y).max(LEAST_ZOOM);
    (f32::from(scale_percent) / 100.0).min(fits)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_shown_is_as_large_as_wanted_as_far_as_every_screen_has_room() {
        for (pixels, scale_of_display, wanted, shown) in [
            (vec2(1280.0, 800.0), 1.0, 100, 1.0),
            (vec2(1920.0, 1080.0), 1.0, 150, 1.5),
            // Room for no more than this.
            (vec2(1280.0, 800.0), 1.0, 200, 1.142),
            // 150 % on the smallest display, and 200 % on a usual one.
            (vec2(1024.0, 700.0), 1.5, 100, 0.667),
            (vec2(1920.0, 1080.0), 2.0, 100, 0.771),
            (vec2(100.0, 100.0), 1.0, 100, LEAST_ZOOM),
        ] {
            let zoom = fitting_zoom(pixels / scale_of_display, wanted);
            assert!((zoom - shown).abs() < 0.001, "{pixels} at {scale_of_display}: {zoom}");
            let points = pixels / scale_of_display / zoom;
            assert!(zoom == LEAST_ZOOM || (points.x >= 1023.9 && points.y >= 699.9), "{points}");
        }
    }
}
