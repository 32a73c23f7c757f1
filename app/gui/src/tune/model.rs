//! Tuning as the window keeps it: what is set, what runs, and the runs so far, for each loop of each motor.

use crate::messages::{TuningMessage, WindowCauseMessage, WindowStatusMessage};
use brushwork_core::messages::{CoreStatusMessage, EndedMessage, TuneMessage};
use brushwork_core::tune::law::{AnyRegisters, Report, Request as TuneRequest, Setup, Trial, request};
use brushwork_link::{Event, Identity, Message, Sample, SettingValue, Stream};
use brushwork_tuning::axis::EncoderClass;
use brushwork_tuning::report::Verdict;
use brushwork_tuning::tune::{Identification, MIDDLE_DUTY, Method};
use brushwork_values::Motor;

use super::calibration::Calibration;
use super::{Asked, Loop, Next, Origin, Run, Sequence, View, Work};
use crate::family::Family;
use crate::model::watched::interruption;
use crate::model::{Arming, Effect, Gravity, Screen, SettingsAction};
use brushwork_core::tune::Target;
use brushwork_core::tune::sequence::{Armed, Ended, Why};

/// How often L and R are written back before that is given up.
const MOST_WRITES: u8 = 4;

/// Position limits farther apart are none.
const ENDLESS_COUNTS: f64 = 1e8;

/// What is asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum TuneAction {
    Start(Motor),
    Verify,
    Cancel,
    /// The considered gains into the controller's RAM.
    Apply,
    /// What RAM held before they were applied.
    Undo,
    /// L and R to 0 for a run; they are put back when it has ended.
    ClearWinding,
    /// What was cleared is put back now.
    PutWindingBack,
    /// Gains turned by hand, into the controller's RAM.
    Adjust(Motor, AnyRegisters),
    SaveReport {
        path: std::path::PathBuf,
        /// A file of that name, which the desktop's own dialog has asked about.
        replaces: bool,
    },
    OpenReport(std::path::PathBuf),
}

/// How an axis is tuned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// 0 (soft) to 100 (stiff).
    pub level: f64,
    pub method: Method,
    /// How the motor is identified, and whose gains are proposed.
    pub identification: Identification,
    /// Duty about which a step or a relay works.
    pub about_percent: f64,
    /// Whether it may turn without end; otherwise it stays within the travel.
    pub turns_freely: bool,
    /// Lowest and highest count.
    pub travel: (f64, f64),
    /// Whether a person has said which; until then the controller's own limits count.
    pub is_travel_chosen: bool,
    pub max_duty_percent: f64,
    /// The run ends above this current; 0 leaves it to the controller's own limit.
    pub max_amps: f64,
    pub encoder: EncoderClass,
    /// Whether a person has said which; until then what was read from the controller counts.
    pub is_encoder_chosen: bool,
    /// Whether the gains are tried on the machine at the end of the run.
    pub tries: bool,
}

impl Setting {
    fn new(which: Loop) -> Self {
        Self {
            level: 50.0,
            method: if which == Loop::Velocity { Method::Velocity } else { Method::Piv },
            identification: Identification::Fit,
            about_percent: 100.0 * MIDDLE_DUTY,
            turns_freely: true,
            travel: (-2000.0, 2000.0),
            is_travel_chosen: false,
            max_duty_percent: 100.0,
            max_amps: 0.0,
            encoder: EncoderClass::Quadrature,
            is_encoder_chosen: false,
            tries: true,
        }
    }

    fn request(&self, motor: Motor) -> TuneRequest {
        let (low, high) = self.travel;
        let travel = (!self.turns_freely).then_some((low.round() as i64, high.round() as i64));
        let max_amps = (self.max_amps > 0.0).then_some(self.max_amps);
        let request = request(self.method, self.level, motor, travel, self.max_duty_percent, max_amps);
        TuneRequest {
            verify: self.tries,
            identification: self.identification,
            about_duty: self.about_percent / 100.0,
            ..request
        }
    }

    /// Whether it is still to be said how far the axis may go: a position loop is driven at full duty both ways where it turns freely. An absolute
    /// encoder has its range.
    pub fn lacks_travel(&self) -> bool {
        self.method != Method::Velocity
            && self.turns_freely
            && !self.is_travel_chosen
            && self.encoder == EncoderClass::Quadrature
    }
}

/// One loop of one motor.
#[derive(Clone, Debug)]
pub struct Panel {
    pub setting: Setting,
    pub runs: Vec<Run>,
    /// Which of them is looked at.
    pub chosen: usize,
    /// What RAM held before gains were applied, to go back to.
    pub undo: Option<brushwork_link::settings::SettingsImage>,
}

impl Panel {
    fn new(which: Loop) -> Self {
        Self { setting: Setting::new(which), runs: Vec::new(), chosen: 0, undo: None }
    }

    pub fn run(&self) -> Option<&Run> {
        self.runs.get(self.chosen)
    }

    pub fn run_mut(&mut self) -> Option<&mut Run> {
        self.runs.get_mut(self.chosen)
    }

    /// Where the slider stands: at the level of the gains that are considered, else at that of the next run.
    pub fn level(&self) -> f64 {
        self.run().filter(|run| run.first.is_some()).map_or(self.setting.level, |run| run.level)
    }

    pub fn add(&mut self, report: Report) {
        let number = self.runs.last().map_or(1, |run| run.number + 1);
        self.runs.iter_mut().for_each(Run::settle);
        self.runs.push(Run::new(number, report));
        self.chosen = self.runs.len() - 1;
    }
}

/// Gains that a lost link left in a controller.
#[derive(Clone, Debug)]
struct Owed {
    target: Target,
    which: Loop,
    unit: (u8, String),
    before: (Setup, Origin),
}

/// Inductance and resistance that were cleared for a run.
#[derive(Clone, Debug)]
struct Winding {
    motor: Motor,
    before: brushwork_link::settings::SettingsImage,
    /// The run that they were cleared for has ended.
    is_due: bool,
    /// How often they were written back.
    writes: u8,
}

/// Tuning on one link.
#[derive(Debug)]
pub struct Tuning {
    panels: [[Panel; 2]; 2],
    /// The motor that is looked at, by loop.
    motors: [Motor; 2],
    running: Option<(Loop, Sequence)>,
    owed: Option<Owed>,
    /// L and R that were cleared for a run, with the user's word.
    winding: Option<Winding>,
    unit: Option<(u8, String)>,
    calibrations: [Calibration; 2],
    pub view: View,
    /// Work with the settings that was asked for during a run: it waits until what the run changed is put back.
    pub waiting: Option<SettingsAction>,
    /// A path for a report, as it is typed.
    pub path: String,
    pub dialog: Option<Asked>,
    /// The keyboard goes to the button that starts a run: what it lacked was said.
    pub wants_start: bool,
}

impl Default for Tuning {
    fn default() -> Self {
        let pair = |which| [Panel::new(which), Panel::new(which)];
        Self {
            panels: [pair(Loop::Velocity), pair(Loop::Position)],
            motors: [Motor::M1; 2],
            running: None,
            owed: None,
            winding: None,
            unit: None,
            calibrations: <[Calibration; 2]>::default(),
            view: View::default(),
            waiting: None,
            path: String::new(),
            dialog: None,
            wants_start: false,
        }
    }
}

impl Tuning {
    pub fn motor(&self, which: Loop) -> Motor {
        self.motors[which as usize]
    }

    pub fn look_at(&mut self, which: Loop, motor: Motor) {
        self.motors[which as usize] = motor;
    }

    pub fn panel(&self, which: Loop, motor: Motor) -> &Panel {
        &self.panels[which as usize][motor.index()]
    }

    pub fn panel_mut(&mut self, which: Loop, motor: Motor) -> &mut Panel {
        &mut self.panels[which as usize][motor.index()]
    }

    /// Takes the controller's position limits as the travel, until a person says otherwise: an axis that has some has end stops. A
    /// velocity loop has no use for limits, which may be left over.
    pub fn adopt_travel(&mut self, motor: Motor, held: Option<(f64, f64)>) {
        let setting = &mut self.panel_mut(Loop::Position, motor).setting;
        if let Some(travel) =
            held.filter(|(low, high)| high - low < ENDLESS_COUNTS && !setting.is_travel_chosen)
        {
            (setting.turns_freely, setting.travel) = (false, travel);
        }
    }

    /// Takes the kind of encoder that the controller's settings tell, until a person says otherwise.
    pub fn adopt_encoder(&mut self, motor: Motor, read: Option<EncoderClass>) {
        let Some(read) = read else { return };
        for which in [Loop::Velocity, Loop::Position] {
            let setting = &mut self.panel_mut(which, motor).setting;
            if !setting.is_encoder_chosen {
                setting.encoder = read;
            }
        }
    }

    /// Leaves methods that a family does not have.
    pub fn adopt_methods(&mut self, family: &dyn Family) {
        for which in [Loop::Velocity, Loop::Position] {
            let methods = family.methods(which);
            for motor in Motor::BOTH {
                let setting = &mut self.panel_mut(which, motor).setting;
                if let Some(usual) = methods.last().filter(|_| !methods.contains(&setting.method)) {
                    setting.method = *usual;
                }
            }
        }
    }

    /// The assistant for calibration by hand.
    pub fn calibration(&self, which: Loop) -> &Calibration {
        &self.calibrations[which as usize]
    }

    pub fn calibration_mut(&mut self, which: Loop) -> &mut Calibration {
        &mut self.calibrations[which as usize]
    }

    /// Lets the assistant of a screen see a sample; that of another screen has nothing to go by.
    pub fn note_sample(&mut self, sample: &Sample, screen: Screen) {
        for which in [Loop::Velocity, Loop::Position] {
            let calibration = &mut self.calibrations[which as usize];
            if Loop::of(screen) != Some(which) {
                calibration.forget();
                continue;
            }
            for motor in Motor::BOTH {
                calibration.observer_mut(motor).note(sample, which, motor);
            }
        }
    }

    /// The panel that is looked at.
    pub fn front(&self, which: Loop) -> &Panel {
        self.panel(which, self.motor(which))
    }

    pub fn front_mut(&mut self, which: Loop) -> &mut Panel {
        self.panel_mut(which, self.motor(which))
    }

    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// What was asked for in the meantime, once nothing runs any more.
    pub fn take_waiting(&mut self) -> Option<SettingsAction> {
        if self.running.is_none() { self.waiting.take() } else { None }
    }

    pub fn running(&self) -> Option<&Sequence> {
        self.running.as_ref().map(|(_, sequence)| sequence)
    }

    /// Begins a run. It goes on by [`Tuning::next`] in every frame.
    pub fn start(&mut self, which: Loop, motor: Motor, stream: Option<Stream>) -> Result<(), TuningMessage> {
        self.begin(which, motor, stream, |panel, motor| {
            let setting = Setting { level: panel.level(), ..panel.setting };
            Ok(Work::Tune(Box::new(setting.request(motor))))
        })
    }

    /// Begins to try the considered gains on the machine.
    pub fn verify(&mut self, which: Loop, stream: Option<Stream>) -> Result<(), TuningMessage> {
        let motor = self.motor(which);
        self.begin(which, motor, stream, |panel, _| {
            let trial = panel.run().and_then(Run::trial);
            trial.map(|trial| Work::Try(Box::new(trial))).ok_or(TuningMessage::NothingToTry)
        })
    }

    fn begin(
        &mut self,
        which: Loop,
        motor: Motor,
        stream: Option<Stream>,
        work: impl FnOnce(&Panel, Motor) -> Result<Work, TuningMessage>,
    ) -> Result<(), TuningMessage> {
        if self.running.is_some() {
            return Err(TuningMessage::RunGoesOn);
        }
        let panel = self.panel(which, motor);
        if !panel.setting.turns_freely && panel.setting.travel.1 - panel.setting.travel.0 < 40.0 {
            return Err(TuningMessage::NoTravel);
        }
        let Setting { encoder, is_encoder_chosen, .. } = panel.setting;
        let target = Target { motor, encoder: is_encoder_chosen.then_some(encoder), stream };
        let work = work(panel, motor)?;
        self.look_at(which, motor);
        self.running = Some((which, Sequence::new(work, target, which.scope())));
        Ok(())
    }

    /// Ends a run before its end; the old gains are put back.
    pub fn abort(&mut self, why: EndedMessage) {
        if let Some((_, sequence)) = &mut self.running {
            sequence.abort(why);
        }
    }

    /// As [`Tuning::abort`]; a job that runs ends at its next exchange.
    pub fn cancel(&mut self, why: EndedMessage) {
        if let Some((_, sequence)) = &mut self.running {
            sequence.cancel(why);
        }
    }

    /// What to ask of the device thread now; asked in every frame.
    pub fn next(
        &mut self,
        arming: Arming,
        refused: bool,
        origin: impl FnOnce() -> Option<Origin>,
    ) -> Option<Next> {
        let (which, sequence) = self.running.as_mut()?;
        let armed = match arming {
            arming if arming.is_armed_for(which.scope()) => Armed::Yes,
            Arming::Disarmed if refused => Armed::Refused,
            Arming::Disarmed | Arming::Asked(_) | Arming::Armed { .. } => Armed::Open,
        };
        sequence.next(armed, origin)
    }

    /// The device thread did not take it.
    pub fn not_begun(&mut self) {
        if let Some((_, sequence)) = &mut self.running {
            sequence.not_begun();
        }
    }

    /// Takes in an event of a job of the run.
    pub fn take(&mut self, event: Event) -> Vec<Effect> {
        let Some((which, sequence)) = &mut self.running else { return Vec::new() };
        let which = *which;
        let target = sequence.target;
        let Some(ended) = sequence.take(event) else { return Vec::new() };
        self.running = None;
        self.ended(which, target, ended)
    }

    fn ended(&mut self, which: Loop, target: Target, ended: Ended) -> Vec<Effect> {
        let mut effects = Vec::new();
        let is_owed = ended.owed.is_some();
        let why = ended.why.as_ref().map(clause);
        if let Some(before) = ended.owed {
            let unit = self.unit.clone().unwrap_or_default();
            self.owed = Some(Owed { target, which, unit, before });
        }
        effects.push(match (&ended.work, ended.report, &ended.trial) {
            (Work::Tune(_), Some(report), _) => {
                if let Some(winding) = &mut self.winding {
                    winding.is_due = true;
                }
                let panel = self.panel_mut(which, target.motor);
                let said = said_of(target.motor, &report, why.clone(), is_owed);
                panel.add(report);
                if let Some(run) = panel.run_mut() {
                    run.interrupted = ended.interrupted;
                }
                said
            }
            (Work::Try(_), _, Some(trial)) => {
                let said = said_of_trial(target.motor, trial);
                if let Some(run) = self.panel_mut(which, target.motor).run_mut() {
                    run.was_tried(trial);
                }
                said
            }
            (Work::PutBack, ..) if is_owed => owed_effect(),
            (Work::PutBack, ..) => {
                Effect::say(Gravity::Note, WindowStatusMessage::GainsBack { motor: target.motor })
            }
            _ => Effect::say(
                Gravity::Warning,
                WindowStatusMessage::NotTunedFor {
                    motor: target.motor,
                    why: why.unwrap_or_else(|| TuningMessage::NothingCame.into()),
                },
            ),
        });
        // What matters most is said last, which is what stays in view.
        if is_owed && !matches!(ended.work, Work::PutBack) {
            effects.push(owed_effect());
        }
        if ended.restored.is_some_and(|restored| restored.loop_left_off) {
            effects.push(Effect::say(Gravity::Warning, TuneMessage::LeftOff));
        }
        effects
    }

    /// The link is gone; what was not put back is, when the same unit answers again.
    pub fn link_ended(&mut self) -> Vec<Effect> {
        self.want_winding_back();
        let Some((which, sequence)) = self.running.take() else { return Vec::new() };
        let target = sequence.target;
        let ended = sequence.link_ended();
        self.ended(which, target, ended)
    }

    /// Another unit is looked at: its runs are not those of the last one.
    pub fn meet(&mut self, identity: &Identity) -> bool {
        let unit = (identity.address, identity.version_text.clone());
        if self.unit.as_ref() == Some(&unit) {
            return false;
        }
        let is_other = self.unit.replace(unit).is_some();
        if is_other && self.running.is_none() {
            let (owed, unit) = (self.owed.take(), self.unit.take());
            *self = Self { owed, unit, ..Self::default() };
        }
        is_other
    }

    /// L and R are cleared: what they were is put back after the run.
    pub fn winding_cleared(&mut self, motor: Motor, before: brushwork_link::settings::SettingsImage) {
        self.winding = Some(Winding { motor, before, is_due: false, writes: 0 });
    }

    /// Whose L and R are cleared at the moment.
    pub fn cleared_winding(&self) -> Option<Motor> {
        self.winding.as_ref().map(|winding| winding.motor)
    }

    /// They are to be put back without waiting for a run.
    pub fn want_winding_back(&mut self) {
        if let Some(winding) = &mut self.winding {
            winding.is_due = true;
        }
    }

    /// What is to be written to put them back, once nothing runs any more.
    pub fn winding_due(&self) -> Option<&brushwork_link::settings::SettingsImage> {
        let winding = self.winding.as_ref().filter(|winding| winding.is_due && self.running.is_none())?;
        Some(&winding.before)
    }

    /// They are being written back. It is tried a few times; what becomes of it is seen by [`Tuning::is_winding_back`].
    pub fn winding_is_written(&mut self) {
        if let Some(winding) = &mut self.winding {
            winding.writes += 1;
        }
    }

    /// Whether they are what they were, by what the controller was read to hold; `None` while that is not to be known. They are forgotten
    /// then, and also when writing them was in vain.
    pub fn is_winding_back(&mut self, held: impl Fn(&str) -> Option<SettingValue>) -> Option<bool> {
        let winding = self.winding.as_ref().filter(|winding| winding.writes > 0)?;
        let is_back = winding.before.iter().all(|(key, value)| held(key) == Some(value));
        if !is_back && winding.writes < MOST_WRITES {
            return None;
        }
        self.winding = None;
        Some(is_back)
    }

    /// Whether a run has left something that is not put back.
    pub fn is_owing(&self) -> bool {
        self.owed.is_some()
    }

    /// Begins to put back what a lost link has left, if this is the unit.
    pub fn settle_debts(&mut self) {
        if self.running.is_some() || self.owed.as_ref().map(|owed| &owed.unit) != self.unit.as_ref() {
            return;
        }
        if let Some(owed) = self.owed.take() {
            let sequence = Sequence::put_back(owed.target, owed.which.scope(), owed.before);
            self.running = Some((owed.which, sequence));
        }
    }
}

/// Why a run came to less than was asked for, in the window's words.
fn clause(why: &Why) -> Message {
    match why {
        Why::Interrupted(cause) => interruption(*cause).into(),
        Why::Failed(failure) => failure.message(),
        Why::Ended(why) => why.clone(),
        Why::Panicked(word) => TuningMessage::Panicked { word: word.clone() }.into(),
    }
}

fn owed_effect() -> Effect {
    Effect::say(Gravity::Error, TuningMessage::Owed)
}

fn said_of(motor: Motor, report: &Report, why: Option<Message>, is_owed: bool) -> Effect {
    match (report.verdict, report.causes.first()) {
        (Verdict::Refused, Some(cause)) => {
            let why = match why {
                Some(why) => CoreStatusMessage::Because { why }.into(),
                None => WindowCauseMessage::Said { text: cause.sentence().into_owned() }.into(),
            };
            let said: Message = match is_owed {
                true => WindowStatusMessage::NotTuned { motor, why }.into(),
                false => WindowStatusMessage::NotTunedAndStopped { motor, why }.into(),
            };
            Effect::say(Gravity::Warning, said)
        }
        (Verdict::TunedWithWarnings, Some(cause)) => Effect::say(
            Gravity::Warning,
            WindowStatusMessage::TunedWithWarning { motor, cause: cause.sentence().to_string() },
        ),
        _ => Effect::say(Gravity::Note, WindowStatusMessage::TunedNotApplied { motor }),
    }
}

fn said_of_trial(motor: Motor, trial: &Trial) -> Effect {
    match trial.cause {
        None => Effect::say(Gravity::Note, WindowStatusMessage::AsPredicted { motor }),
        Some(cause) => Effect::say(
            Gravity::Warning,
            WindowStatusMessage::Tuned { motor, cause: cause.sentence().to_string() },
        ),
    }
}
