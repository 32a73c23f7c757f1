//! Recipes: what people want of a controller, each with the settings that do it, its wiring and what comes of it, as a family has them.
//!
//! A recipe names settings by their keys and options by theirs; `{pin}`, `{n}`, `{end}` and the like stand for what a person chooses. Which keys and
//! options there are say the tables: a recipe is offered where all it sets is there, and a test walks every recipe over every model and
//! firmware.

use brushwork_link::device::{Identity, PinSignal};
use brushwork_link::settings::{Kind, SettingValue, SettingsImage, SettingsTable};
use brushwork_link::{Channel, Message};

pub use super::goal::Goal;
use super::known::Known;
use super::path::Place;
use crate::model::indicator::IndicatorState;

/// One recipe.
#[derive(Debug)]
pub struct Recipe {
    pub job: Goal,
    /// What it does and how it is wired, in a sentence or two.
    pub text: &'static str,
    /// What comes of it once it is written.
    pub consequence: &'static str,
    pub asks: &'static [Ask],
    /// What it sets, in order; none where its rows are set by hand.
    pub sets: &'static [Set],
    /// Further settings that belong to it and are set by hand.
    pub rows: &'static [&'static str],
    /// The same, on controllers that have them.
    pub rows_if_there: &'static [&'static str],
    pub live: Live,
    pub wiring: Wiring,
}

/// One setting and what it becomes.
#[derive(Clone, Copy, Debug)]
pub struct Set {
    pub key: &'static str,
    pub to: To,
}

/// A value, as a recipe names it.
#[derive(Clone, Copy, Debug)]
pub enum To {
    /// One of a row's named options.
    Option(&'static str),
    Number(f64),
    Flag(bool),
    /// On where what was chosen for a placeholder is this.
    Chosen(&'static str, &'static str),
}

/// What a person chooses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ask {
    /// `{n}`: 1 or 2.
    Motor,
    /// `{pin}`: an input that the controller lets be used so.
    Pin(PinUse),
    /// `{end}`, `min` or `max`: where the input stands while the contact is closed.
    Contact,
    /// One of these texts, which stands for itself where the other text stands: the placeholder and what can be chosen.
    One(&'static str, &'static [(&'static str, &'static str)]),
}

/// What a pin is to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PinUse {
    Voltage,
    Pulses,
}

/// What the controller tells while the recipe is looked at.
#[derive(Clone, Copy, Debug)]
pub enum Live {
    Nothing,
    /// Where the chosen pin stands.
    Pin,
    /// The newest of these.
    Channels(&'static [Channel]),
    /// Whether these indicators are lit, by their short names.
    Indicators(&'static [&'static str]),
    /// What a board has told of itself, as the list of units has it.
    Board,
    All(&'static [Live]),
}

/// How it is wired: a part outside, and the wires from its terminals to those of the controller.
#[derive(Clone, Copy, Debug)]
pub struct Wiring {
    pub part: Part,
    /// Terminal of the part, terminal of the controller.
    pub wires: &'static [(&'static str, &'static str)],
}

/// A part outside the controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    Switch,
    Receiver,
    Potentiometer,
    Encoder,
    Brake,
    Motor,
    Load,
    Battery,
    Computer,
}

impl Part {
    pub const fn name(self) -> &'static str {
        match self {
            Self::Switch => "Switch",
            Self::Receiver => "R/C receiver",
            Self::Potentiometer => "Potentiometer",
            Self::Encoder => "Encoder",
            Self::Brake => "Brake, by a relay",
            Self::Motor => "Motor",
            Self::Load => "Load, by a transistor",
            Self::Battery => "Battery",
            Self::Computer => "Computer",
        }
    }
}

/// The settings of a unit, as a recipe looks at them.
pub struct Looked<'u> {
    pub table: &'u SettingsTable,
    /// What the controller works with.
    pub held: Known<'u>,
    /// What is wanted of it.
    pub wanted: Known<'u>,
    pub is_simulated: bool,
}

/// What a controller tells while the edits of its settings are looked at.
pub struct Told<'t> {
    pub identity: Option<&'t Identity>,
    /// Where a pin stands, from 1.
    pub signal: &'t dyn Fn(usize) -> Option<PinSignal>,
    /// The newest of a channel.
    pub reading: &'t dyn Fn(Channel) -> Option<f64>,
    /// The bits of its status.
    pub status: Option<u32>,
}

/// What a family knows of its recipes.
pub trait Recipes: Sync {
    fn all(&self) -> &'static [Recipe];

    /// What its people ask for, in order, with what it cannot do.
    fn goals(&self) -> &'static [Goal] {
        &Goal::USUAL
    }

    /// Why it has no recipe for some of them, and what to do instead.
    fn reasons(&self) -> &'static [(Goal, &'static str)] {
        &[]
    }

    /// The screens on which recipes go on.
    fn places(&self) -> &'static [(Goal, Place)] {
        &[]
    }

    /// Why it has no recipe for one of its goals.
    fn without(&self, goal: Goal) -> Option<&'static str> {
        self.reasons().iter().find(|(of, _)| *of == goal).map(|(_, reason)| *reason)
    }

    /// The screen on which a recipe goes on.
    fn goes_on(&self, goal: Goal) -> Option<Place> {
        self.places().iter().find(|(of, _)| *of == goal).map(|(_, place)| *place)
    }

    /// How many motors a controller has.
    fn motors(&self, _table: &SettingsTable) -> usize {
        1
    }

    /// The pins, from 1, that can measure so.
    fn able_pins(&self, _table: &SettingsTable, _wanted: PinUse) -> Vec<usize> {
        Vec::new()
    }

    /// The pin, from 1, that takes a line of a motor's encoder: the motor from 1, and A or B.
    fn encoder_pin(&self, _table: &SettingsTable, _motor: usize, _phase: char) -> Option<usize> {
        None
    }

    /// What makes a pin measure so, with all else of it as the factory has it; nothing where it is wanted so already.
    fn pin_use(&self, _unit: &Looked<'_>, _pin: usize, _wanted: PinUse) -> SettingsImage {
        SettingsImage::default()
    }

    /// How a pin stands now, in a sentence.
    fn pin_state(&self, _unit: &Looked<'_>, _pin: usize, _signal: Option<PinSignal>) -> Option<Message> {
        None
    }

    /// Whether a board lacks the terminals of a recipe.
    fn lacks(&self, _table: &SettingsTable, _recipe: &Recipe) -> bool {
        false
    }

    /// What the edits of a unit will do as soon as they are written, with how much it matters.
    fn consequences(&self, _unit: &Looked<'_>, _told: &Told<'_>) -> Vec<(IndicatorState, Message)> {
        Vec::new()
    }

    /// The recipes that a controller can do, in the order of [`Recipes::goals`]; none for a job that it has no setting for.
    fn of(&self, table: &SettingsTable) -> Vec<(Goal, Option<&'static Recipe>)> {
        let encoder_pin = |motor, phase| self.encoder_pin(table, motor, phase);
        let is_for = |recipe: &&Recipe| {
            let able = recipe.pin_use().map(|wanted| self.able_pins(table, wanted)).unwrap_or_default();
            !self.lacks(table, recipe) && recipe.is_for(table, (self.motors(table), &able), &encoder_pin)
        };
        let found = |job| self.all().iter().filter(|recipe| recipe.job == job).find(is_for);
        self.goals().iter().map(|job| (*job, found(*job))).collect()
    }
}

/// What was chosen of each thing that a recipe asks for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Answers {
    /// The motor, from 1; 0 is not chosen yet and counts as 1.
    pub motor: usize,
    /// The pin, from 1; 0 is not chosen yet.
    pub pin: usize,
    /// The contact pulls the input up to the supply instead of down to ground.
    pub pulls_up: bool,
    /// The place of the choice among those of [`Ask::One`].
    pub one: usize,
}

impl Answers {
    pub fn motor(&self) -> usize {
        self.motor.max(1)
    }
}

impl Recipe {
    /// A text with what was chosen in the places that stand for it.
    pub fn fill(&self, text: &str, answers: &Answers, pins: &dyn Fn(usize, char) -> Option<usize>) -> String {
        let motor = answers.motor();
        let mut filled = text
            .replace("{n}", &motor.to_string())
            .replace("{pin}", &answers.pin.to_string())
            .replace("{end}", if answers.pulls_up { "max" } else { "min" })
            .replace("{s}", if motor == 2 { "s5" } else { "s4" })
            .replace("{d}", if motor == 2 { "d2" } else { "d1" });
        for (place, phase) in [("{a}", 'A'), ("{b}", 'B')] {
            // A pin that is not there gives a key that is not there.
            let pin = pins(motor, phase).map_or_else(|| "none".to_owned(), |pin| pin.to_string());
            filled = filled.replace(place, &pin);
        }
        for ask in self.asks {
            if let Ask::One(place, choices) = ask {
                let chosen = choices.get(answers.one).or(choices.first()).map_or("", |(_, word)| word);
                filled = filled.replace(place, chosen);
            }
        }
        filled
    }

    /// What it sets, with what was chosen; none where the controller lacks one of the settings or options.
    pub fn settings(
        &self,
        table: &SettingsTable,
        answers: &Answers,
        pins: &dyn Fn(usize, char) -> Option<usize>,
    ) -> Option<Vec<(String, SettingValue)>> {
        self.sets
            .iter()
            .map(|set| {
                let row = table.row(&self.fill(set.key, answers, pins))?;
                let value = match (set.to, row.kind) {
                    (To::Option(option), Kind::Choice(codes)) => {
                        let option = self.fill(option, answers, pins);
                        SettingValue::Choice(codes.iter().find(|code| code.key == option)?.key)
                    }
                    (To::Number(number), Kind::Int) => SettingValue::Int(number as i64),
                    (To::Number(number), Kind::Fixed { .. }) => SettingValue::Number(number),
                    (To::Flag(flag), Kind::Bool) => SettingValue::Bool(flag),
                    (To::Chosen(place, chosen), Kind::Bool) => {
                        SettingValue::Bool(self.fill(place, answers, pins) == chosen)
                    }
                    (To::Option(_) | To::Number(_) | To::Flag(_) | To::Chosen(..), _) => return None,
                };
                Some((row.key.clone(), value))
            })
            .collect()
    }

    /// The keys of all settings that it shows, each once.
    pub fn keys(
        &self,
        table: &SettingsTable,
        answers: &Answers,
        pins: &dyn Fn(usize, char) -> Option<usize>,
    ) -> Vec<String> {
        let own = self.sets.iter().map(|set| set.key).chain(self.rows.iter().copied());
        let mut keys: Vec<String> = Vec::new();
        for key in own.chain(self.rows_if_there.iter().copied()) {
            let key = self.fill(key, answers, pins);
            if table.row(&key).is_some() && !keys.contains(&key) {
                keys.push(key);
            }
        }
        keys
    }

    /// Whether a controller has all that it needs, whatever is chosen.
    pub fn is_for(
        &self,
        table: &SettingsTable,
        able: (usize, &[usize]),
        pins: &dyn Fn(usize, char) -> Option<usize>,
    ) -> bool {
        let all = self.every_answer(able);
        let has = |key: &&str, answers: &Answers| table.row(&self.fill(key, answers, pins)).is_some();
        !all.is_empty()
            && all.iter().all(|answers| {
                self.settings(table, answers, pins).is_some() && self.rows.iter().all(|key| has(key, answers))
            })
    }

    /// Everything that can be chosen, by the number of motors and the pins that can be used so.
    pub fn every_answer(&self, (motors, able): (usize, &[usize])) -> Vec<Answers> {
        let mut all = vec![Answers { motor: 1, ..Answers::default() }];
        for ask in self.asks {
            let each = |of: &dyn Fn(&Answers) -> Vec<Answers>| all.iter().flat_map(of).collect::<Vec<_>>();
            all = match ask {
                Ask::Motor => {
                    each(&|one| (1..=motors).map(|motor| Answers { motor, ..one.clone() }).collect())
                }
                Ask::Pin(_) => {
                    each(&|one| able.iter().map(|pin| Answers { pin: *pin, ..one.clone() }).collect())
                }
                Ask::Contact => each(&|one| {
                    [false, true].into_iter().map(|pulls_up| Answers { pulls_up, ..one.clone() }).collect()
                }),
                Ask::One(_, choices) => {
                    each(&|before| (0..choices.len()).map(|one| Answers { one, ..before.clone() }).collect())
                }
            };
        }
        all
    }

    /// What a pin has to measure, where one is asked for.
    pub fn pin_use(&self) -> Option<PinUse> {
        self.asks.iter().find_map(|ask| if let Ask::Pin(wanted) = ask { Some(*wanted) } else { None })
    }
}
