//! One link and all that belongs to it: what is known of its controllers, their settings, what its screens hold, and
//! what its graph has recorded.
//!
//! Several connections are open at once; one is in front. Switching swaps whole connections, so nothing of one controller can
//! end up in another.

use brushwork_canopen::bus::Monitor;
use std::any::Any;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use brushwork_core::messages::EndedMessage;
use brushwork_link::{
    ArmScope, ConnectTarget, Event, Identity, Message, PollRate, SettingValue, SettingsImage,
};
use brushwork_plant::world::{ScriptRun, WorldView};
use brushwork_values::Motor;

use super::afterwards::Afterwards;
use super::drawer::Drawers;
use super::errand::Errand;
use super::examination::ExaminationPanel;
use super::generator::Generator;
use super::jobs::Jobs;
use super::loop_settings::LoopView;
use super::path::Path;
use super::qpps::QppsPanel;
use super::raw::RawPage;
use super::script::ScriptWork;
use super::traffic::Traffic;
use super::watch::Watch;
use super::watched::said;
use super::world::WorldPanel;
use super::{
    Arming, Effect, General, GeneralView, History, LinkView, Owner, Position, Pwm, Screen, Settings, Tab,
    Velocity, graph_channels,
};
use crate::debugger::Debugging;
use crate::family::{self, Family, Own, Sliders};
use crate::graph::LiveGraph;
use crate::messages::JobMessage;
use crate::model::messages::ScriptStateMessage;
use crate::tune::Tuning;

/// Which connection, for as long as the window is open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ConnectionId(u32);

impl ConnectionId {
    pub fn next(self) -> Self {
        Self(self.0 + 1)
    }
}

/// One link and all that belongs to it.
#[derive(Debug)]
pub struct Connection {
    id: ConnectionId,
    /// What the link goes to, or went to last.
    pub target: Option<String>,
    /// The family of the unit that was looked at last, or that the target names.
    family: &'static dyn Family,
    pub phase: Phase,
    /// What is known of the open link; empty while there is none.
    pub link: LinkView,
    pub poll: PollRate,
    pub graph: LiveGraph,
    pub pwm: Pwm,
    /// Whose the jobs on the device thread are.
    pub jobs: Jobs,
    /// The settings of the units met so far, and what is being done with them: every screen shows these.
    pub settings: Settings,
    pub general: General,
    pub velocity: Velocity,
    /// The download of a script, and which one the controller holds.
    pub script: ScriptWork,
    pub position: Position,
    pub generator: Generator,
    pub qpps: QppsPanel,
    /// Guided tuning.
    pub tune: Tuning,
    /// What waits until a run or an examination has put back what it changed.
    pub afterwards: Option<Afterwards>,
    /// The examination of the unit that is looked at.
    pub examination: ExaminationPanel,
    /// What an assistant has done on this link.
    pub errand: Errand,
    /// Whether an assistant goes from one of its units to the next.
    pub is_assisted: bool,
    /// The unit that was asked for and is not shown yet: what is read meanwhile would be taken for the other one's.
    pub turning_to: Option<u8>,
    /// The page for numbers that are written raw.
    pub raw: RawPage,
    /// How far the unit is on the guided path.
    pub path: Path,
    /// What the screens that drive have open above their graphs.
    pub drawers: Drawers,
    pub loops: LoopView,
    /// What happened since the connection.
    pub history: History,
    /// What a diagnosis needs besides the status word.
    pub watch: Watch,
    /// What each family has of its own.
    pub own: Vec<Box<dyn Own>>,
    /// The MCL debugger of a simulated controller.
    pub debug: Debugging,
    /// The traffic panel of this link.
    pub traffic: Traffic,
    /// The screen whose channels the graph shows.
    pub(super) graph_of: Screen,
    /// Which channels the graph showed when another screen that drives was left.
    pub(super) graph_choices: BTreeMap<&'static str, Vec<bool>>,
    /// The unit that is looked at as it was before, by its name.
    pub viewed_as: Option<String>,
    pub world: WorldPanel,
    /// What is heard of the nodes of a CAN bus; kept when the link has ended.
    pub bus: Option<Monitor>,
    /// Why the last link is gone, if not by request.
    pub lost: Option<Lost>,
    /// The last try to open the link came to nothing.
    pub could_not_open: bool,
    /// The start page is asked for, though there is something left of the last link.
    pub shows_start: bool,
    /// The worlds of the simulated units, while they run.
    pub worlds: Option<Arc<Vec<WorldView>>>,
    /// Which of them is looked at.
    pub world_unit: usize,
}

/// The place that a target names: two links cannot go to the same one.
pub fn place_of(target: &str) -> String {
    match target.parse() {
        Ok(ConnectTarget::Serial { path, .. }) => path,
        Ok(other) => other.to_string(),
        Err(_) => target.to_owned(),
    }
}

/// Where a link is between closed and open.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Phase {
    #[default]
    Closed,
    Opening {
        target: String,
    },
    Open {
        target: String,
    },
    /// Asked to close; the motors are being stopped.
    Closing {
        target: String,
    },
}

impl Phase {
    pub fn is_open(&self) -> bool {
        matches!(self, Self::Open { .. })
    }

    /// What the link goes to.
    pub fn target(&self) -> Option<&str> {
        match self {
            Self::Closed => None,
            Self::Opening { target } | Self::Open { target } | Self::Closing { target } => Some(target),
        }
    }
}

/// A link that was lost.
#[derive(Clone, Debug)]
pub struct Lost {
    /// What was lost, why, and what the controller does without it.
    pub text: Message,
    /// When that was first shown, by the window's clock.
    pub noticed_s: Option<f64>,
}

impl Default for Connection {
    fn default() -> Self {
        Self::new(ConnectionId::default())
    }
}

impl Connection {
    /// A connection without a link.
    pub fn new(id: ConnectionId) -> Self {
        Self {
            id,
            target: None,
            family: family::first(),
            phase: Phase::default(),
            link: LinkView::default(),
            poll: PollRate::default(),
            graph: LiveGraph::new(graph_channels(family::first().channels()), 0.1),
            pwm: Pwm::default(),
            jobs: Jobs::default(),
            settings: Settings::default(),
            general: General::default(),
            velocity: Velocity::default(),
            script: ScriptWork::default(),
            position: Position::default(),
            generator: Generator::default(),
            qpps: QppsPanel::default(),
            tune: Tuning::default(),
            afterwards: None,
            examination: ExaminationPanel::default(),
            errand: Errand::default(),
            is_assisted: false,
            turning_to: None,
            raw: RawPage::default(),
            path: Path::default(),
            drawers: Drawers::default(),
            loops: LoopView::default(),
            history: History::default(),
            watch: Watch::default(),
            own: family::all().iter().filter_map(|family| family.own()).collect(),
            debug: Debugging::default(),
            traffic: Traffic::default(),
            graph_of: Screen::default(),
            graph_choices: BTreeMap::new(),
            viewed_as: None,
            world: WorldPanel::default(),
            bus: None,
            lost: None,
            could_not_open: false,
            shows_start: false,
            worlds: None,
            world_unit: 0,
        }
    }

    pub fn id(&self) -> ConnectionId {
        self.id
    }

    /// What is so with the family of the controller that is, or was, connected.
    pub fn family(&self) -> &'static dyn Family {
        self.family
    }

    /// The screens of that controller, in the order of the list.
    pub fn screens(&self) -> Vec<Screen> {
        self.family().screens(self.link.identity(), &|key| self.known(key))
    }

    /// The motors of that controller.
    pub fn motors(&self) -> &'static [Motor] {
        self.family().motors(self.link.identity())
    }

    /// A setting as the controller has it, as far as known.
    fn known(&self, key: &str) -> Option<SettingValue> {
        self.settings.unit()?.on_controller(key)
    }

    /// Why the controller cannot be tuned as it is set, where it cannot.
    pub fn cannot_tune(&self) -> Option<&'static str> {
        self.family().cannot_tune(self.link.identity(), &|key| self.known(key))
    }

    /// Where the unit keeps its motor by itself, where it does.
    pub fn virtual_travel(&self) -> Option<(f64, f64)> {
        let confirmed = |key: &str| self.settings.unit()?.confirmed(key);
        self.own.iter().find_map(|own| own.travel(&confirmed, &|key| self.known(key)))
    }

    /// What a family keeps of its own here.
    ///
    /// # Panics
    /// If the family was never installed.
    pub fn own<T: Own>(&self) -> &T {
        let found = self.own.iter().find_map(|own| (&**own as &dyn Any).downcast_ref());
        found.unwrap_or_else(|| panic!("a family was never installed"))
    }

    /// The same, to be changed.
    ///
    /// # Panics
    /// If the family was never installed.
    pub fn own_mut<T: Own>(&mut self) -> &mut T {
        let found = self.own.iter_mut().find_map(|own| (&mut **own as &mut dyn Any).downcast_mut());
        found.unwrap_or_else(|| panic!("a family was never installed"))
    }

    /// The tab that is open above the graph of a screen that drives.
    pub fn open_tab(&self, screen: Screen) -> Option<Tab> {
        self.drawers.open(screen).filter(|tab| self.family().tabs(screen).contains(tab))
    }

    /// Whether the link goes, or went, to that place: a port, whatever its rate, or another target's text.
    pub fn is_at(&self, place: &str) -> bool {
        self.target.as_deref().is_some_and(|target| place_of(target) == place)
    }

    /// Whether there is nothing here that anybody would miss: no link, no record, no edits.
    pub fn is_blank(&self) -> bool {
        self.phase == Phase::Closed
            && self.graph.sheet().track.history.is_empty()
            && !self.settings.has_edits()
    }

    /// Whether a unit has answered on the open link.
    pub fn is_connected(&self) -> bool {
        self.phase.is_open() && self.link.identity().is_some()
    }

    /// Whether nothing is armed, asked for or at work.
    pub fn is_idle(&self) -> bool {
        self.link.arming == Arming::Disarmed
            && self.is_connected()
            && !self.settings.is_at_work()
            && !self.general.holds_settings()
            && self.diagnosis_keys().is_empty()
            && !self.is_guided()
            && !self.is_turned_elsewhere()
            && self.tune.running().is_none()
            && !self.own.iter().any(|own| own.is_busy())
    }

    /// Whether what is read now may come from another unit than the one that is shown.
    pub fn is_turned_elsewhere(&self) -> bool {
        self.turning_to.is_some() || self.is_assisted || self.errand.is_running()
    }

    /// The sliders of every screen go back to rest, with nothing left to send.
    pub fn rest(&mut self) {
        self.pwm.setpoints.stop();
        self.velocity.setpoints.stop();
        self.position.setpoints.stop();
        self.own.iter_mut().for_each(|own| own.rest());
    }

    /// The device thread has taken what the family's sliders asked for.
    pub fn sent(&mut self, scope: ArmScope) {
        match scope {
            ArmScope::Pwm => self.pwm.setpoints.sent(),
            ArmScope::Velocity => self.velocity.setpoints.sent(),
            ArmScope::Position => self.position.setpoints.sent(),
            ArmScope::ClampTest | ArmScope::Tuning | ArmScope::Script | ArmScope::CommandLine => {}
        }
    }

    /// What is set on the screens that drive.
    pub fn sliders(&self) -> Sliders {
        Sliders { pwm: self.pwm, velocity: self.velocity, position: self.position }
    }

    /// Takes over an event of this link. What it means beyond this connection is handed back: something to say, or the
    /// end of the link.
    pub fn take(&mut self, event: Event) -> Vec<Effect> {
        let changes_ram = self.changes_ram(&event);
        if matches!(&event, Event::Stopped(report) if report.from_outside) {
            self.tune.abort(EndedMessage::Stopped);
        }
        if matches!(&event, Event::Selected { address, .. } if self.turning_to == Some(*address)) {
            self.turning_to = None;
        }
        self.history.note(&event);
        self.traffic.note(&event);
        if changes_ram {
            self.settings.doubt();
        }
        // Each has to see it.
        let is_own = self.own.iter_mut().map(|own| own.take(&event)).max() == Some(true);
        if is_own {
            return Vec::new();
        }
        self.watch.note(&event);
        let effects = match self.jobs.owner(&event) {
            Some(owner) => self.take_of(owner, event),
            None => self.link.take(event),
        };
        let effects = effects.into_iter().filter_map(|effect| self.settle(effect)).collect();
        self.look_at_unit();
        self.follow_settings();
        effects
    }

    /// Whether the event is about something that may have changed the controller's settings past [`Settings`].
    fn changes_ram(&self, event: &Event) -> bool {
        let is_sent = |id| self.traffic.kept.is_sent(id);
        // A stop may have switched a loop off by a register.
        let is_stop = matches!(event, Event::Stopped(_)) && !self.family().has_loops();
        is_stop || matches!(event, Event::Transacted { id, .. } if is_sent(*id))
    }

    /// The settings with the screen that shows all of them.
    pub fn general_view(&mut self) -> GeneralView<'_> {
        GeneralView::new(&mut self.settings, &mut self.general)
    }

    /// Turns to the settings of the unit that is looked at.
    fn look_at_unit(&mut self) {
        if let Some(identity) = self.link.identity()
            && self.settings.look_at(identity)
        {
            self.general.forget_unit();
        }
    }

    /// Lights what follows from the settings anew where they have changed.
    fn follow_settings(&mut self) {
        if self.watch.see(self.family, self.settings.unit()) {
            self.update_homed();
        }
    }

    /// What a diagnosis has to ask the controller for.
    pub fn diagnosis_keys(&self) -> Vec<String> {
        self.settings.unit().map(|unit| unit.unasked(self.watch.keys())).unwrap_or_default()
    }

    /// Whoever looks why the motors do not run is to see the controller as it is now.
    pub fn doubt_diagnosis(&mut self) {
        if let Some(unit) = self.settings.unit_mut() {
            unit.doubt_keys(self.watch.keys());
        }
    }

    /// The settings that a diagnosis goes by, once they were read.
    pub fn diagnosed(&self) -> Option<&SettingsImage> {
        let keys = Some(self.watch.keys()).filter(|keys| !keys.is_empty())?;
        self.settings.unit()?.ram_with(keys)
    }

    /// Whether a pin that can stop a motor has to be read for the diagnosis.
    pub fn diagnosis_wants_signals(&self) -> bool {
        self.diagnosed().is_some_and(|settings| self.family().has_pin_actions(settings))
    }

    /// Whether each motor is homed or at a limit by an action of its pins; `None` where that is not known.
    pub fn homed(&self) -> Option<[bool; 2]> {
        self.family().homed(self.diagnosed()?, self.watch.pins())
    }

    /// Hands an event of a job to whoever asked for the job.
    fn take_of(&mut self, owner: Owner, event: Event) -> Vec<Effect> {
        match owner {
            Owner::Settings => {
                let ended = self.settings.take(event);
                ended.map(|ended| self.general_view().take(ended)).unwrap_or_default()
            }
            Owner::ClampTest => self.general.clamp.take(event),
            Owner::Generator => said(self.generator.take(event), JobMessage::Played),
            Owner::Qpps => said(self.qpps.take(event), JobMessage::QppsMeasured),
            Owner::Script => {
                if matches!(event, Event::JobEnded(_)) {
                    // It may have set autorun.
                    self.settings.doubt();
                }
                self.script.take(event)
            }
            Owner::Errand => {
                if matches!(event, Event::JobEnded(_)) {
                    // It may have written settings.
                    self.settings.doubt();
                }
                self.errand.take(event);
                Vec::new()
            }
            Owner::Tune => self.take_tuning(event),
            Owner::Examination => {
                if matches!(event, Event::JobEnded(_)) {
                    // It writes settings and puts them back.
                    self.settings.doubt();
                }
                self.examination.take(event);
                Vec::new()
            }
        }
    }

    fn take_tuning(&mut self, event: Event) -> Vec<Effect> {
        let effects = self.tune.take(event);
        if !self.tune.is_running() {
            // A run has written gains and put others back.
            self.settings.doubt();
        }
        effects
    }

    /// Whether the unit's script runs, as far as known. A simulated controller in this program tells; of others nothing is known but what went over
    /// this link, since no command asks for it.
    pub fn script_runs(&self) -> Option<bool> {
        self.script_line().map_or(self.watch.script_runs, |line| Some(line.is_some()))
    }

    /// The line of the script that runs on a simulated unit; the outer `None` where nobody can tell.
    fn script_line(&self) -> Option<Option<u32>> {
        let view = self.worlds.as_ref()?.get(self.world_unit)?;
        Some(match view.script.as_ref()?.run {
            ScriptRun::Running { line } => Some(line),
            ScriptRun::Idle
            | ScriptRun::Ended { .. }
            | ScriptRun::Stopped { .. }
            | ScriptRun::Faulted { .. } => None,
        })
    }

    /// Whether the debugger holds the script of a simulated unit.
    pub fn script_is_paused(&self) -> bool {
        let view = self.worlds.as_ref().and_then(|worlds| worlds.get(self.world_unit)?.script.as_ref());
        view.is_some_and(|script| script.is_paused)
    }

    /// What is said on every screen of a script that runs, or may run.
    pub fn script_notice(&self) -> Option<String> {
        // A board that always runs one tells it on the screen of its programs.
        if !self.is_connected() || self.debug.takes_mecc && !self.script_is_paused() {
            return None;
        }
        match (self.script_runs(), self.script_line()) {
            (Some(true), Some(Some(line))) if self.script_is_paused() => {
                Some(ScriptStateMessage::LinePaused { line }.to_string())
            }
            (Some(true), Some(Some(line))) => Some(ScriptStateMessage::LineRunning { line }.to_string()),
            (Some(true), _) => Some("Script running".to_owned()),
            (None, _) if self.family().autoruns(&|key| self.known(key)) => {
                Some("Script may run (autorun)".to_owned())
            }
            _ => None,
        }
    }

    /// Since when an indicator of the unit that is looked at is as it is, as time since the connection.
    pub fn indicator_since(&self, short: &str) -> Option<Duration> {
        self.history.indicator_since(self.link.selected?, short)
    }

    /// Brings home indicators up to date with the pins, where these alone tell.
    fn update_homed(&mut self) {
        let by_pins = |identity: &&Identity| self.family().homes_by_pins(identity);
        let Some(identity) = self.link.identity().filter(by_pins) else { return };
        let (address, homed) = (identity.address, self.homed());
        self.link.set_homed(homed);
        if let Some(homed) = homed {
            self.history.note_homed(address, homed);
        }
    }

    /// Whether the live signals of the input pins are in view: on the settings screen, or in the graph.
    pub fn shows_signals(&self, settings_are_shown: bool) -> bool {
        let in_graph = self.graph.live.channels.iter().any(|channel| channel.info.is_pin && channel.shown);
        self.is_connected() && (in_graph || settings_are_shown && self.general.wants_signals())
    }

    /// Does what an effect means for this connection.
    fn settle(&mut self, effect: Effect) -> Option<Effect> {
        match effect {
            Effect::Say(..) | Effect::Ended => return Some(effect),
            Effect::AtRest => self.rest(),
            Effect::Sample(sample) => {
                self.watch.note_sample(&sample);
                self.update_homed();
                self.general.take_signals(&sample.signals);
                self.tune.note_sample(&sample, self.graph_of);
                self.path.turning.note_sample(&sample);
                self.own.iter_mut().for_each(|own| own.note_sample(&sample));
                self.graph.take(&sample);
            }
            Effect::OtherUnit => {
                self.turn_to_family();
                self.graph.push_gap();
                self.forget_unit();
                // Whatever happened to it while another one was looked at.
                self.look_at_unit();
                self.settings.doubt();
                self.watch.forget();
                self.debug.forget();
            }
        }
        None
    }

    /// The link is gone, on request or not. A simulated world lives on. What there is to say of it is handed back.
    pub fn link_ended(&mut self) -> Vec<Effect> {
        let mut effects = self.tune.link_ended();
        effects.extend(self.examination.link_ended());
        self.errand.link_ended();
        self.turning_to = None;
        self.phase = Phase::Closed;
        self.jobs = Jobs::default();
        self.lost = std::mem::take(&mut self.link).lost_because.map(|text| Lost { text, noticed_s: None });
        self.watch = Watch::default();
        self.traffic.link_ended();
        self.debug.forget();
        self.own.iter_mut().for_each(|own| own.link_ended());
        self.general_view().link_ended();
        self.forget_unit();
        self.rest();
        self.graph.link_ended();
        effects
    }

    /// The unit that is looked at may be of another family than the one before.
    fn turn_to_family(&mut self) {
        if let Some(identity) = self.link.identity() {
            self.set_family(family::of(identity.family));
        }
    }

    /// The family whose screens and channels are shown.
    pub fn set_family(&mut self, family: &'static dyn Family) {
        if family.family() != self.family.family() {
            self.family = family;
            self.graph.set_channels(graph_channels(self.family().channels()));
            self.graph_choices.clear();
            self.show_channels(self.graph_of);
        }
    }

    /// What is known of one unit's motors says nothing of another's.
    fn forget_unit(&mut self) {
        self.path = Path::default();
        self.own.iter_mut().for_each(|own| own.forget_unit());
        self.generator.forget();
        self.script.forget();
        self.qpps.forget();
    }

    /// The graph shows the channels of a screen that has one; for other screens it stays as it is.
    pub(super) fn graph_for(&mut self, screen: Screen) {
        if !screen.has_graph() || screen == self.graph_of {
            return;
        }
        let left = std::mem::replace(&mut self.graph_of, screen);
        let channels = &mut self.graph.live.channels;
        self.graph_choices.insert(left.title(), channels.iter().map(|channel| channel.shown).collect());
        self.show_channels(screen);
    }

    /// Shows the channels that were chosen for a screen, or those that its graph shows at first.
    pub(super) fn show_channels(&mut self, screen: Screen) {
        let at_start = self.family().first_channels(screen);
        let chosen = self.graph_choices.get(screen.title());
        for (index, channel) in self.graph.live.channels.iter_mut().enumerate() {
            let at_first = || at_start.iter().any(|first| first.key == channel.info.key);
            channel.shown = chosen.and_then(|chosen| chosen.get(index)).copied().unwrap_or_else(at_first);
        }
        let is_first_time = chosen.is_none();
        // The axis at the side is of a line that is there.
        let sheet = &mut self.graph.live;
        let first = at_start
            .first()
            .and_then(|first| sheet.channels.iter().position(|channel| channel.info.key == first.key));
        if let Some(first) = first.filter(|_| is_first_time) {
            sheet.selected = first;
        }
        if !sheet.channels.get(sheet.selected).is_some_and(|channel| channel.shown) {
            sheet.selected = sheet.channels.iter().position(|channel| channel.shown).unwrap_or_default();
        }
        if is_first_time {
            sheet.watch_selected();
        }
    }
}
