//! The recipes of the SuprMotr V9 (SuprMotr manual, connectors J1 to J4 and the command reference), and what edits of its settings do at once.

use brushwork_link::settings::SettingValue;
use brushwork_link::{Channel, Message};
use brushwork_suprmotr_client::status_of_word;
use brushwork_suprmotr_wire::inputs;

use crate::family::path::Place;
use crate::family::recipe::{Ask, Goal, Live, Looked, Part, Recipe, Recipes, Set, To, Told, Wiring};
use crate::model::{IndicatorState, Screen, Tab};
use crate::suprmotr::messages::EditMessage;

static RECIPES: &[Recipe] = &[
    Recipe {
        job: Goal::Limit,
        text: "A switch at each end of the axis, at J4. Each acts on its own direction alone: the negative one ends motion in the negative direction, the positive one in the \
               positive. LL has them on while their input is low, as the factory has it; LH while it is high.",
        consequence: "A switch that is on stops the motor on that way, also in the middle of a macro. With LF nothing stops it at an end.",
        asks: &[Ask::One("{level}", &[("On while low (LL)", "low"), ("On while high (LH)", "high")])],
        sets: &[
            Set { key: "limits.active_high", to: To::Chosen("{level}", "high") },
            Set { key: "limits.enabled", to: To::Flag(true) },
        ],
        rows: &[],
        rows_if_there: &[],
        live: SWITCHES,
        wiring: Wiring {
            part: Part::Switch,
            wires: &[("- end", "J4 7 neg."), ("+ end", "J4 9 pos."), ("common", "J4 10 ground")],
        },
    },
    Recipe {
        job: Goal::Home,
        text: "Home is the place just off the negative limit switch: FE1 goes to it, FE4 slowly off it again, and DH makes that place 0. The home guide on the Motion \
               screen does that. The reference input at J4 is told, and no command looks for it.",
        consequence: "From DH on all positions mean something else, those in macros too.",
        asks: &[],
        sets: &[Set { key: "limits.enabled", to: To::Flag(true) }],
        rows: &["limits.active_high", "motion.velocity"],
        rows_if_there: &[],
        live: Live::All(&[Live::Channels(&[Channel::M1_POSITION]), Live::Indicators(&["NEG", "REF"])]),
        wiring: Wiring {
            part: Part::Switch,
            wires: &[("- end", "J4 7 neg."), ("reference", "J4 8 index"), ("common", "J4 10 ground")],
        },
    },
    Recipe {
        job: Goal::Encoder,
        text: "A quadrature encoder at J4, with the motor. Its count is read whether the motor is on or off, so that a shaft turned by hand shows which way it counts.",
        consequence: "An encoder that counts against its motor makes the loop run away until the following error ends it: change A and B, with the power off.",
        asks: &[],
        sets: &[],
        rows: &["limits.following_error"],
        rows_if_there: &[],
        live: Live::All(&[Live::Channels(&[Channel::M1_POSITION]), Live::Indicators(&["OFF"])]),
        wiring: Wiring {
            part: Part::Encoder,
            wires: &[
                ("+5 V", "J4 2 5V"),
                ("A", "J4 3 enc. A"),
                ("B", "J4 4 enc. B"),
                ("ground", "J4 5 ground"),
                ("index", "J4 8 index"),
            ],
        },
    },
    Recipe {
        job: Goal::Lag,
        text: "How far the position may lag behind the trajectory (SM). It is what lets go of a motor that is blocked, or whose encoder has come off.",
        consequence: "Too small a limit ends moves that only accelerate; too large a one drives a blocked motor for long.",
        asks: &[],
        sets: &[],
        rows: &["limits.following_error", "motion.acceleration"],
        rows_if_there: &[],
        live: Live::All(&[Live::Channels(&[Channel::M1_POSITION_ERROR]), Live::Indicators(&["EXC"])]),
        wiring: Wiring { part: Part::Motor, wires: &[("M+", "J4 1 M+"), ("M-", "J4 6 M-")] },
    },
    Recipe {
        job: Goal::Inputs,
        text: "Sixteen channels at J3, each an input or an output, and two analog inputs of 0 to 5 V at J1 and J2; J2 has a pull-up resistor of 10 kOhm. Macros wait for a channel \
               (WN, WF) or go on by it (XN, XF).",
        consequence: "No setting stores which channels are outputs: a macro that needs one begins with CT.",
        asks: &[],
        sets: &[],
        rows: &[],
        rows_if_there: &[],
        live: Live::Nothing,
        wiring: Wiring {
            part: Part::Switch,
            wires: &[("channel 1", "J3 12"), ("channel 2", "J3 9"), ("5 V", "J3 20"), ("ground", "J3 19")],
        },
    },
    Recipe {
        job: Goal::Outputs,
        text: "CT makes an output of a channel, CN and CF switch it on and off. The analog output (SO) gives 0 to 5 V with at most 2 mA at J3 pin 17, which is channel 10 \
               otherwise. Outputs drive logic: a relay or a light wants a transistor, a coil also a diode.",
        consequence: "Two drivers on one line may damage both: see that nothing else drives a channel before it becomes an output.",
        asks: &[],
        sets: &[],
        rows: &[],
        rows_if_there: &[],
        live: Live::Nothing,
        wiring: Wiring { part: Part::Load, wires: &[("input", "J3 12 ch. 1"), ("ground", "J3 19")] },
    },
    Recipe {
        job: Goal::Brake,
        text: "Brake out (J3 pin 4), which the manual only names. Assumed: it releases a spring brake while the motor is on (MN) and lets it fall while it is off (MF). Drive the \
               brake by a transistor and a relay, with a diode across its coil.",
        consequence: "A motor that is let go for its following error lets the brake fall too: try it with no load that can drop.",
        asks: &[],
        sets: &[],
        rows: &[],
        rows_if_there: &["limits.following_error"],
        live: Live::Indicators(&["OFF"]),
        wiring: Wiring { part: Part::Brake, wires: &[("input", "J3 4 brake"), ("ground", "J3 19")] },
    },
    Recipe {
        job: Goal::Start,
        text: "Macro 0 runs at power-up and after RT, with no computer at the line. It is stored from the macro file by MD0; RM0 takes it off the board.",
        consequence: "It can move the motor as soon as the power is on: keep clear, and begin it with a wait for an input where that matters.",
        asks: &[],
        sets: &[],
        rows: &[],
        rows_if_there: &[],
        live: Live::Indicators(&["MAC", "WAIT"]),
        wiring: Wiring { part: Part::Computer, wires: LINE },
    },
    Recipe {
        job: Goal::Line,
        text: "The line runs at 9600 baud, as the factory has it, 19,200 or 38,400 (BR), with 8 bits, no parity and no handshake. RS-232 is at J1; what is sent comes back while the echo is on.",
        consequence: "The link finds out by itself whether the unit echoes. BR can be sent from the terminal, and ends the link: connect with the other rate then.",
        asks: &[],
        sets: &[],
        rows: &["line.echo"],
        rows_if_there: &[],
        live: Live::Board,
        wiring: Wiring { part: Part::Computer, wires: LINE },
    },
    Recipe {
        job: Goal::Address,
        text: "Up to 16 units share a line, each with an address of its own, 0 to F. Give it while a unit is alone on the line: every unit that is selected takes it.",
        consequence: "The address is kept in EEPROM at once, with no command to store it. Label the board with it.",
        asks: &[],
        sets: &[],
        rows: &["unit.address"],
        rows_if_there: &[],
        live: Live::Nothing,
        wiring: Wiring { part: Part::Computer, wires: LINE },
    },
];

const SWITCHES: Live = Live::Indicators(&["NEG", "POS", "LIM"]);
const LINE: &[(&str, &str)] = &[("TX", "J1 4 Rx"), ("RX", "J1 5 Tx"), ("ground", "J1 2 GND")];

const GOALS: &[Goal] = &[
    Goal::Limit,
    Goal::Home,
    Goal::EStop,
    Goal::Encoder,
    Goal::Lag,
    Goal::Current,
    Goal::Inputs,
    Goal::Outputs,
    Goal::Brake,
    Goal::Start,
    Goal::Battery,
    Goal::TimeOut,
    Goal::Line,
    Goal::Address,
];

/// What it has no recipe for.
const REASONS: &[(Goal, &str)] = &[
    (
        Goal::EStop,
        "A SuprMotr has no input for an emergency stop: its limit switches stop one direction each, and the character ! stops all units on the line. Cut the power of \
                 the motor for an emergency.",
    ),
    (
        Goal::Current,
        "A SuprMotr has no setting for the current. Its driver gives 1 A continuously; the following error limit lets go of a motor that is blocked.",
    ),
    (
        Goal::Battery,
        "A SuprMotr does not measure its supply. It takes 9 to 12 V: more of it, or the wrong polarity, damages the controller.",
    ),
    (
        Goal::TimeOut,
        "A SuprMotr has no serial time-out: a move or a macro goes on when the cable or the computer dies. Limit switches end it at the ends of the axis.",
    ),
];

/// The screens on which recipes go on.
const PLACES: &[(Goal, Place)] = &[
    (Goal::Home, Place::Drawer(Screen::Position, Tab::Home)),
    (Goal::Limit, Place::Screen(Screen::Inputs)),
    (Goal::Inputs, Place::Screen(Screen::Inputs)),
    (Goal::Outputs, Place::Screen(Screen::Inputs)),
    (Goal::Brake, Place::Screen(Screen::Inputs)),
    (Goal::Start, Place::Screen(Screen::MclEditor)),
    (Goal::Line, Place::Screen(Screen::Terminal)),
];

/// The recipes of this family.
pub struct SuprMotrRecipes;

impl Recipes for SuprMotrRecipes {
    fn all(&self) -> &'static [Recipe] {
        RECIPES
    }

    fn goals(&self) -> &'static [Goal] {
        GOALS
    }

    fn reasons(&self) -> &'static [(Goal, &'static str)] {
        REASONS
    }

    fn places(&self) -> &'static [(Goal, Place)] {
        PLACES
    }

    fn consequences(&self, unit: &Looked<'_>, told: &Told<'_>) -> Vec<(IndicatorState, Message)> {
        let switches = limit_switches(unit, told);
        let lag = following_error(unit, told).map(|text| (IndicatorState::Warning, text));
        let address = is_edited(unit, "unit.address")
            .then(|| (IndicatorState::Warning, EditMessage::AddressKept.into()));
        switches.into_iter().chain(lag).chain(address).collect()
    }
}

fn is_edited(unit: &Looked<'_>, key: &str) -> bool {
    let wanted = (unit.wanted)(key);
    wanted.is_some() && wanted != (unit.held)(key)
}

fn is_on(value: Option<SettingValue>) -> Option<bool> {
    value.map(|value| value == SettingValue::Bool(true))
}

/// What the limit switches do once they act, or once they act at the other level (SuprMotr manual, LN, LF, LH, LL).
fn limit_switches(unit: &Looked<'_>, told: &Told<'_>) -> Vec<(IndicatorState, Message)> {
    let (act, level) = ("limits.enabled", "limits.active_high");
    if !is_edited(unit, act) && !is_edited(unit, level) {
        return Vec::new();
    }
    if is_on((unit.wanted)(act)) == Some(false) {
        return vec![(IndicatorState::Warning, EditMessage::NoLimits.into())];
    }
    let Some(status) = told.status.map(status_of_word) else {
        return vec![(IndicatorState::Warning, EditMessage::SwitchesUnread.into())];
    };
    // The status tells on and off as they are at the level that counts now.
    let turns = is_edited(unit, level);
    let stops = |bit: u8| (status.inputs & bit != 0) != turns;
    let all =
        [(inputs::NEGATIVE, EditMessage::StopsNegative), (inputs::POSITIVE, EditMessage::StopsPositive)];
    let found: Vec<(IndicatorState, Message)> = all
        .into_iter()
        .filter(|(bit, _)| stops(*bit))
        .map(|(_, text)| (IndicatorState::Warning, text.into()))
        .collect();
    match found.is_empty() {
        true => vec![(IndicatorState::Unknown, EditMessage::SwitchesOff.into())],
        false => found,
    }
}

/// A limit below the lag of now lets the motor go.
fn following_error(unit: &Looked<'_>, told: &Told<'_>) -> Option<Message> {
    let key = "limits.following_error";
    let limit = (unit.wanted)(key)?.int().filter(|_| is_edited(unit, key))? as f64;
    let lag = (told.reading)(Channel::M1_POSITION_ERROR)?.abs();
    (lag > limit).then(|| EditMessage::LetGo { lag, limit }.into())
}
