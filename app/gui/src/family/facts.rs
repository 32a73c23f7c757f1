//! What a family says of its controllers, and the types in which it says it.

use std::fmt;

use brushwork_link::FamilyRef;
use brushwork_link::device::{
    Addresses, ArmScope, Channel, Drive, Identity, Indicator, Job, PinSignal, StatusReport,
};
use brushwork_link::settings::{Group, Row, SettingValue, SettingsImage, SettingsTable, Subject};
use brushwork_script::language::{Grammar, Language};
use brushwork_script::program::Program;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::tune::Method;
use brushwork_values::Motor;

use super::known::Known;
use super::own::Own;
use super::path::PathStep;
use super::recipe::Recipes;
use super::words::{self, SettingsWords};
use crate::model::{
    HelpPage, IndicatorInfo, IndicatorState, Position, Pwm, Screen, Simulated, Tab, Velocity, state_of,
};
use crate::tune::Loop;

/// What the window has to know of a family. What has a default is had by few.
pub trait Family: Sync {
    /// The family itself.
    fn family(&self) -> FamilyRef;

    /// What a person calls its controllers, for sentences.
    fn name(&self) -> &'static str;

    /// What the window keeps of its own for each link.
    fn own(&self) -> Option<Box<dyn Own>> {
        None
    }

    /// The screens, in the order of the list, by what is known of the unit and its settings.
    fn screens(&self, identity: Option<&Identity>, known: Known<'_>) -> Vec<Screen>;

    /// What a screen is called in this family.
    fn title(&self, screen: Screen) -> &'static str {
        screen.title()
    }

    /// The tabs above the graph of a screen that drives.
    fn tabs(&self, _screen: Screen) -> &'static [Tab] {
        &[]
    }

    /// The steps that set a unit up, in their order.
    fn path(&self) -> &'static [PathStep] {
        &[]
    }

    /// Its recipes, if it has any.
    fn recipes(&self) -> Option<&'static dyn Recipes> {
        None
    }

    /// The settings that turn an encoder's and a motor's direction round; `{n}` stands for the number of the motor.
    fn direction_keys(&self) -> Option<[&'static str; 2]> {
        None
    }

    /// The monitored parameters at the top.
    fn figures(&self) -> &'static [Figures] {
        &[]
    }

    /// The status indicators, in order.
    fn indicators(&self) -> &'static [IndicatorInfo];

    /// How each of [`Family::indicators`] stands. `homed` is what the input pins say of home and limit switches, where they are known.
    fn lit(
        &self,
        report: &StatusReport,
        _identity: Option<&Identity>,
        _homed: Option<[bool; 2]>,
    ) -> Vec<IndicatorState> {
        let lit = |indicator: &IndicatorInfo| {
            let set = report.active().find(|bit| bit.short == indicator.short);
            set.map_or(IndicatorState::Ok, |bit| state_of(bit.severity))
        };
        self.indicators().iter().map(lit).collect()
    }

    /// What the status word says, in the order in which it is shown.
    fn active(&self, report: &StatusReport, _identity: Option<&Identity>) -> Vec<ActiveIndicator> {
        let placed = report.indicators.iter().enumerate();
        let set = placed.filter(|(_, indicator)| report.word & indicator.mask != 0);
        set.map(|(place, indicator)| ActiveIndicator::new(Some(place), indicator)).collect()
    }

    /// What is active while a motor is homed or at a limit, where the pins tell that and the status word has no bit for it.
    fn home_indicators(&self) -> Option<[ActiveIndicator; 2]> {
        None
    }

    /// Whether a unit tells by its pins alone that a motor is homed or at a limit.
    fn homes_by_pins(&self, _identity: &Identity) -> bool {
        false
    }

    /// What stands below the indicators, by what the pins say of home and limit switches.
    fn indicators_note(&self, _identity: &Identity, _homed: Option<[bool; 2]>) -> Option<&'static str> {
        None
    }

    /// [`Family::lit`] for the times since which indicators are as they are.
    fn lit_since(
        &self,
        report: &StatusReport,
        identity: Option<&Identity>,
        homed: Option<[bool; 2]>,
    ) -> Vec<IndicatorState> {
        self.lit(report, identity, homed)
    }

    /// The settings that say what keeps the motors from running.
    fn diagnosis_keys(&self, _table: &SettingsTable) -> Vec<String> {
        Vec::new()
    }

    /// Whether a pin can stop a motor, as these settings say.
    fn has_pin_actions(&self, _settings: &SettingsImage) -> bool {
        false
    }

    /// Whether each motor is homed or at a limit by an action of its pins; `None` where the pins are not known.
    fn homed(&self, _settings: &SettingsImage, _pins: Option<&[PinSignal]>) -> Option<[bool; 2]> {
        None
    }

    /// The firmware's number, where its version tells less.
    fn generation_number(&self, _identity: &Identity) -> Option<u8> {
        None
    }

    /// What else a unit tells of itself, with its label.
    fn unit_row(&self, _identity: &Identity) -> Option<(&'static str, String)> {
        None
    }

    /// Whether a unit reports a value for this channel that its board does not measure.
    fn makes_up(&self, _identity: &Identity, _channel: Channel) -> bool {
        false
    }

    /// What a unit's settings table is made for: where nobody knows it by name, for what all models have.
    fn subject(&self, identity: &Identity) -> Subject {
        let any = || Subject::new(&self.family().models()[0], identity.generation);
        identity.subject().unwrap_or_else(any)
    }

    /// What a port, pin or output does by its settings, in a few words.
    fn function(&self, _table: &SettingsTable, _known: Known<'_>, _of: (Group, usize)) -> Option<String> {
        None
    }

    /// The values that a setting is chosen from, where its row cannot list them or other settings say what they mean.
    fn choices(
        &self,
        _row: &Row,
        _subject: &Subject,
        _wanted: Known<'_>,
    ) -> Option<Vec<(SettingValue, String)>> {
        None
    }

    /// The settings of an input whose range is opened wide for a calibration.
    fn opened_input(&self, _known: Known<'_>, _pin: usize) -> Option<SettingsImage> {
        None
    }

    /// Whether a unit starts its script by itself, as far as its settings were read.
    fn autoruns(&self, _known: Known<'_>) -> bool {
        false
    }

    /// The language of its own that its programs are written in, where it brings one along.
    fn grammar(&self) -> Option<&'static Grammar> {
        None
    }

    /// The program through which a simulated unit is driven, where there is one.
    fn library(&self) -> Option<Program> {
        None
    }

    /// The job that downloads a script from a file's bytes, and comes to a clause of what was sent.
    fn download(&self, _bytes: &[u8]) -> Result<Job<String>, String> {
        Err(self.lacks(Ability::Scripts).unwrap_or_default().to_owned())
    }

    /// What a command of the protocol is called.
    fn command_title(&self, _number: u8) -> &'static str {
        ""
    }

    /// Whether a command that changes settings saves them all to EEPROM; `None` for one that changes none.
    fn saves(&self, _command: u8, _identity: &Identity) -> Option<bool> {
        None
    }

    /// The pages of help about it.
    fn help_pages(&self) -> &'static [HelpPage] {
        &[]
    }

    /// The models that this program simulates, by key and name, the one that is offered first at the head.
    fn simulated(&self) -> Vec<(&'static str, &'static str)> {
        Vec::new()
    }

    /// The language of the programs of which one can be named, by `program=FILE`, for the first of them to run.
    fn simulated_program(&self) -> Option<Language> {
        None
    }

    /// What that drives, in a few words under a picture of it.
    fn simulated_axis(&self) -> &'static str {
        ""
    }

    /// What a person would type to connect to what is simulated.
    fn simulated_target(&self, simulated: &Simulated) -> String {
        format!("sim:{}", simulated.model)
    }

    /// Where the simulated units are, where that follows from what is simulated.
    fn simulated_addresses(&self, _simulated: &Simulated) -> Option<Addresses> {
        None
    }

    /// An address in a list to choose from.
    fn address_label(&self, address: u8) -> String {
        self.family().address_text(address)
    }

    /// What asking all addresses takes, as a clause behind a comma.
    fn scan_cost(&self) -> &'static str {
        ""
    }

    /// How acts on its settings are told.
    fn words(&self) -> &'static SettingsWords {
        &words::USUAL
    }

    /// The motors of a controller: of the one that is connected, else of most.
    fn motors(&self, identity: Option<&Identity>) -> &'static [Motor] {
        match identity {
            Some(identity) if identity.capabilities().motors == 1 => &[Motor::M1],
            Some(_) | None => &Motor::BOTH,
        }
    }

    /// Names of the input pins in the simulated world; empty where they are numbered.
    fn world_pins(&self) -> &'static [&'static str] {
        &[]
    }

    /// The ways of guided tuning for a loop, the one that is taken unless another is chosen at the end.
    fn methods(&self, _which: Loop) -> &'static [Method] {
        &[]
    }

    /// Why a unit cannot be tuned as it is set, where it cannot.
    fn cannot_tune(&self, _identity: Option<&Identity>, _known: Known<'_>) -> Option<&'static str> {
        None
    }

    /// What to do about a refused run, in the order in which it is best tried, where it is done in other places than elsewhere.
    fn remedies(&self, _cause: Cause) -> Option<&'static [&'static str]> {
        None
    }

    /// What the motors have to be told for a screen that is armed and whose sliders stand so, if anything.
    fn to_send(&self, scope: ArmScope, sliders: Sliders) -> Option<Drive>;

    /// Whether a screen shows all registers as they are, which have to be read for it over and over.
    fn shows_registers(&self, _screen: Screen) -> bool {
        false
    }

    /// Whether the screens that drive show settings of loops that have to be read for them.
    fn has_loops(&self) -> bool {
        false
    }

    /// What its controllers can tell, in the order of the graph.
    fn channels(&self) -> &'static [Channel];

    /// What the graph of a screen shows at first.
    fn first_channels(&self, screen: Screen) -> &'static [Channel] {
        screen.first_channels()
    }

    /// Why the family lacks something that others have; `None` where it has it.
    fn lacks(&self, ability: Ability) -> Option<&'static str>;
}

/// What was set on the screens that drive.
#[derive(Clone, Copy, Debug)]
pub struct Sliders {
    pub pwm: Pwm,
    pub velocity: Velocity,
    pub position: Position,
}

/// What one family has and another may not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ability {
    /// Programs that run in the controller.
    Scripts,
    /// Settings of loops that name a top speed, and what measures it.
    Qpps,
    /// The voltage clamp test.
    ClampTest,
    /// Setpoint profiles, played.
    Generator,
    /// Emergency stop that software can reset.
    EmergencyStop,
    /// A second motor.
    SecondMotor,
    /// A firmware loader that is known.
    Firmware,
    /// Scripts' buses: I2C, CAN and RTS.
    Buses,
    /// Faults of bridges and start-up that a simulated one can have.
    BridgeFaults,
    /// Settings that can contradict each other.
    Conflicts,
    /// Calibration by hand of loop gains.
    ByHand,
    /// Motion by duty, and so a highest duty and current of a tuning run.
    Duty,
    /// Several serial ports, each with a time-out.
    Streams,
    /// A supply of its own for the logic.
    LogicBattery,
    /// Encoders of more than one kind.
    AbsoluteEncoders,
    /// A relay test of the controller's own.
    OwnTest,
}

/// Two readouts below each other in the top row.
#[derive(Debug)]
pub struct Figures {
    pub rows: &'static [Figure],
    pub label_width: f32,
    /// Room for the units, in letters.
    pub unit_letters: usize,
    pub digits: usize,
    /// Whether a Zero button goes with each.
    pub zero: bool,
}

impl Figures {
    /// Rows, the width of their labels, and the letters and digits of their units and values.
    pub const fn new(
        rows: &'static [Figure],
        label_width: f32,
        (unit_letters, digits): (usize, usize),
        zero: bool,
    ) -> Self {
        Self { rows, label_width, unit_letters, digits, zero }
    }
}

/// One readout.
#[derive(Debug)]
pub struct Figure {
    pub channel: Channel,
    pub label: &'static str,
    pub unit: &'static str,
    /// Which motor it belongs to, for its Zero button.
    pub motor: Motor,
}

/// An indicator of a status word that is set, and how grave it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ActiveIndicator {
    /// Place among the indicators of its family.
    pub order: u8,
    pub title: &'static str,
    pub state: IndicatorState,
}

impl ActiveIndicator {
    /// An indicator that stands in this place among those of its family.
    pub fn new(place: Option<usize>, indicator: &Indicator) -> Self {
        let order = place.and_then(|place| u8::try_from(place).ok()).unwrap_or(u8::MAX);
        Self { order, title: indicator.title, state: state_of(indicator.severity) }
    }
}

impl fmt::Debug for dyn Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
