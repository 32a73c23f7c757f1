//! What a family of controllers adds to the commands that all families share, and the commands that it alone has.
//!
//! Shared commands ask the object behind a [`FamilyRef`] and never which family it is. The program names these objects once, by [`install`].

use std::sync::OnceLock;

use brushwork_core::session::line::SimulatedLine;
use brushwork_core::settings::Act;
use brushwork_link::device::Described;
use brushwork_link::family::Model;
use brushwork_link::{DeviceHandle, FamilyChoice, FamilyRef, Identity, SettingsImage, SettingsTable, Wire};
use brushwork_values::Motor;
use clap::{Arg, ArgMatches};
use serde::Serialize;
use serde_json::Value;

use super::monitor::follower::Follower;
use super::tool::Tool;
use super::{Exit, Interrupt, Output, OutputError, Readings};

/// A family as commands see it. What has a default here need not be thought of where it does not apply.
pub trait Family: Send + Sync {
    /// Its names, addresses and models.
    fn family(&self) -> FamilyRef;

    /// Commands that it alone has.
    fn commands(&self) -> Vec<Tool> {
        Vec::new()
    }

    /// What the help pages say of it.
    fn examples(&self) -> Examples;

    /// What a list of simulated controllers says of a model of its own.
    fn simulated(&self, model: &Model) -> SimulatedModel;

    /// Its own arguments of `brushwork sim`.
    fn sim_arguments(&self) -> Vec<Arg> {
        Vec::new()
    }

    /// What is wrong when its own arguments are given and simulated units are another family's.
    fn misplaced(&self, _sim: &ArgMatches) -> Option<String> {
        None
    }

    /// The units that the arguments of `brushwork sim` ask for.
    ///
    /// # Errors
    /// Says on standard error what does not fit together, and gives the exit code.
    fn simulate(&self, sim: &ArgMatches) -> Result<Simulated, Exit>;

    /// The address of the first unit that the text behind `sim:` asks for; `None` where that is not of this family, or there is no
    /// need to look at one address alone.
    fn first_simulated(&self, _text: &str) -> Option<u8> {
        None
    }

    /// The reference of its protocol, or of what is named.
    ///
    /// # Errors
    /// A sentence: there is nothing of that name.
    fn protocol(&self, names: &[String]) -> Result<Page, String>;

    /// The reference of its settings, where it has one.
    fn settings_reference(&self) -> Option<Page> {
        None
    }

    /// Contradictions among the settings.
    fn conflicts(&self, _table: &SettingsTable, _image: &SettingsImage) -> Vec<Said> {
        Vec::new()
    }

    /// Whoever puts traffic into words, of a firmware generation that is fixed or followed.
    fn follower(&self, generation: Option<u8>) -> Box<dyn Follower>;

    /// The speed of a move for which none is given; of several motors the slowest one's. A family whose moves take their speed from a
    /// setting has none to tell.
    ///
    /// # Errors
    /// Says on standard error why there is none, and gives the exit code.
    fn full_speed(
        &self,
        _motors: &[Motor],
        _device: &DeviceHandle,
        _interrupt: &Interrupt,
    ) -> Result<u32, Exit> {
        Ok(0)
    }

    /// How a unit takes commands as a person types them; `None` where it takes none.
    fn terminal(&self, _identity: &Identity) -> Option<Box<dyn Terminal>> {
        None
    }

    /// What an act on the settings does to a motor, where that is to be known before.
    fn note_of(&self, _act: &Act) -> Option<&'static str> {
        None
    }

    /// How a unit is set up, as a line of `status`.
    fn set_up(&self, _identity: &Identity) -> Option<String> {
        None
    }

    /// Where the input pins stand, raw as the wire carries it; `None` where the unit does not tell.
    fn read_inputs(&self, _wire: &mut dyn Wire) -> Option<Vec<i64>> {
        None
    }

    /// What the readings come to.
    fn judge(&self, _identity: &Identity, _readings: &Readings) -> Judged {
        Judged::default()
    }

    /// The addresses to which a stop of a whole line is written, whoever is there. None where a broadcast reaches more units than are
    /// searched for on a line that is not known to have them.
    fn stopped_addresses(&self) -> Vec<u8>;
}

/// How a unit takes commands as a person types them.
pub trait Terminal {
    /// How the unit is set up, in a few words.
    fn set_up(&self) -> String;

    /// The bytes of a typed command.
    ///
    /// # Errors
    /// A sentence: it is none.
    fn bytes_of(&self, line: &str) -> Result<Vec<u8>, String>;

    /// Whether bytes stop the motor besides what they are for.
    fn stops_the_motor(&self, _bytes: &[u8]) -> bool {
        false
    }

    /// Bytes as a person reads them.
    fn shown(&self, bytes: &[u8]) -> String;

    /// Bytes that are sent, in words.
    fn describe_sent(&self, bytes: &[u8]) -> Described;

    /// What came back, in words.
    fn describe_received(&self, sent: &[u8], reply: &[u8]) -> Described;
}

/// What a family gives to the help pages.
#[derive(Clone, Copy, Debug)]
pub struct Examples {
    /// The model that stands in examples, and is simulated where none is named.
    pub model: &'static str,
    /// What can be said behind it: "[,generation=4,preset=NAME]".
    pub options: &'static str,
    /// Lines for the examples of a command, without the program's name: "protocol --family NAME COMMAND".
    pub lines: &'static [&'static str],
    /// What its terminal takes, as a sentence; empty where it has none.
    pub typed: &'static str,
}

/// What a list says of a simulated model.
#[derive(Clone, Copy, Debug)]
pub struct SimulatedModel {
    /// Its rating, at greater length than [`Model::rating`] where there is more to say.
    pub rating: &'static str,
    /// What is guessed about it; empty where nothing is.
    pub assumed: &'static str,
}

/// Simulated units that are to be served.
pub struct Simulated {
    /// The units on their wire.
    pub line: SimulatedLine,
    /// What they are, in one line.
    pub what: String,
    /// Whether the window finds them where nothing but the place is named.
    pub is_found: bool,
}

/// A reference, in both forms.
pub struct Page {
    text: String,
    json: String,
}

impl Page {
    /// The text for people, and the data behind it.
    pub fn new(text: &str, data: &impl Serialize) -> Self {
        Self {
            text: text.trim_end().to_owned(),
            json: serde_json::to_string_pretty(data).unwrap_or_default(),
        }
    }

    /// Prints it in the form that is asked for.
    pub fn print(&self, as_json: bool, out: &mut Output) -> Result<(), OutputError> {
        out.line(if as_json { &self.json } else { &self.text })
    }
}

/// A sentence, and the same for programs.
pub struct Said {
    /// For people.
    pub sentence: String,
    /// For programs.
    pub data: Value,
}

/// What readings come to.
#[derive(Default)]
pub struct Judged {
    /// Why the motors do not run, as far as anything is known.
    pub diagnosis: Option<Said>,
    /// Which motors an input holds at home or at a limit, where that is known.
    pub homed: Option<[bool; 2]>,
}

static FAMILIES: OnceLock<Vec<&'static dyn Family>> = OnceLock::new();

/// Names the families that this program has, in the order of their drivers.
pub fn install(families: &[&'static dyn Family]) {
    // A second list is that of another test.
    let _ = FAMILIES.set(families.to_vec());
}

/// The families that this program has.
pub fn families() -> &'static [&'static dyn Family] {
    FAMILIES.get().map_or(&[], Vec::as_slice)
}

/// A family as commands see it.
///
/// # Panics
/// If the family was never installed.
pub fn of(family: FamilyRef) -> &'static dyn Family {
    let found = families().iter().find(|known| known.family() == family).copied();
    found.unwrap_or_else(|| panic!("the family {} was never installed", family.key()))
}

/// The family that is chosen, or the first one.
///
/// # Panics
/// If no family was ever installed.
pub fn chosen(choice: FamilyChoice) -> &'static dyn Family {
    choice.family().map_or_else(|| *families().first().expect("a family was installed"), of)
}
