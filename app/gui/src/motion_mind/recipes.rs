//! The recipes of the Motion Mind 3 (Motion Mind manual, chapters 3 to 6), and what edits of its registers do as soon as they are written.

use brushwork_link::settings::SettingValue;
use brushwork_link::{Channel, Message};
use brushwork_motion_mind_client::MotionMindFacts;
use brushwork_motion_mind_client::channels::{ANALOG_CONTROL, RC_PULSE};
use brushwork_motion_mind_wire::Mode;

use crate::family::path::Place;
use crate::family::recipe::{Ask, Goal, Live, Looked, Part, Recipe, Recipes, Set, To, Told, Wiring};
use crate::model::{IndicatorState, Screen};
use crate::motion_mind::messages::EditMessage;

static RECIPES: &[Recipe] = &[
    Recipe {
        job: Goal::Mode,
        text: "Switches 2, 3 and 4 of SW1 say at power-up what moves the motor. For the mode that is chosen here they stand: {stand}. With all three off, the same can be \
               wired to J4 instead.",
        consequence: "It counts from the next power-up. With off, off, on (mode 6) and both limit inputs at ground, the factory's values are restored.",
        asks: &[Ask::One("{stand}", MODES)],
        sets: &[],
        rows: &[],
        rows_if_there: &[],
        live: Live::Board,
        wiring: Wiring {
            part: Part::Switch,
            wires: &[("2", "P5 MODE2"), ("3", "P6 MODE1"), ("4", "P8 MODE0"), ("common", "P7 GROUND")],
        },
    },
    Recipe {
        job: Goal::Limit,
        text: "A contact at each end of the axis, between POS_LIM or NEG_LIM and ground; the board has pull-up resistors. They act in modes 4 and 5, and in \
               mode 0 with RCPOS; in modes 1 and 2 the same pins have other uses. TIMER says how long a contact must be steady.",
        consequence: "While POS_LIM is at ground the motor does not move in the positive direction, while NEG_LIM is, not in the negative one. No register switches \
                      that off.",
        asks: &[],
        sets: &[],
        rows: &["register.timer"],
        rows_if_there: &[],
        live: Live::All(&[Live::Board, ENDS]),
        wiring: Wiring {
            part: Part::Switch,
            wires: &[("+ end", "P17 POS_LIM"), ("- end", "P16 NEG_LIM"), ("common", "P11 GROUND")],
        },
    },
    Recipe {
        job: Goal::SoftLimit,
        text: "Two positions that the motor does not pass, without any switch. They go by POSITION, which is 0 after power-up unless POSPWRUP is set: move to a \
               known place first. Modes 4 and 5, and mode 0 with RCPOS.",
        consequence: "VIRTLIMIT switches both limits on together: look at both before it is written.",
        asks: &[],
        sets: &[Set { key: "function.virtlimit", to: To::Flag(true) }],
        rows: &["register.vnlimit", "register.vplimit"],
        rows_if_there: &["function.pospwrup"],
        live: Live::All(&[Live::Channels(&[Channel::M1_POSITION]), Live::Indicators(&["VN", "VP"])]),
        wiring: ENCODER,
    },
    Recipe {
        job: Goal::EStop,
        text: "A contact between _BRAKE and ground switches the bridge off in every mode; the board has a pull-up resistor. It acts when it closes, so that \
               a broken wire does not stop. It is no safety circuit: cut the power for that.",
        consequence: "While the input is at ground nothing drives the motor, which runs down. Once it opens, the motor may go on with what it was told last.",
        asks: &[],
        sets: &[],
        rows: &[],
        rows_if_there: &[],
        live: Live::Indicators(&["BRK"]),
        wiring: Wiring { part: Part::Switch, wires: &[("contact", "P12 _BRAKE"), ("contact", "P11 GROUND")] },
    },
    Recipe {
        job: Goal::Stick,
        text: "A channel of an R/C receiver, with pulses of 1 to 2 ms, in mode 0: switches 2, 3 and 4 of SW1 on. Speed needs no feedback. Position compares the \
               stick with a potentiometer at ANA_FBCK (J4 P3), whose voltage has to rise as the motor drives forward.",
        consequence: "In mode 0 the stick drives the motor, and no serial command of motion acts: put it in its middle first. Without LASTRC a bad pulse \
                      stops the motor.",
        asks: &[Ask::One("{kind}", &[("Speed", "speed"), ("Position", "position")])],
        sets: &[Set { key: "function.rcpos_encfdbck", to: To::Chosen("{kind}", "position") }],
        rows: &[
            "register.rcmin",
            "register.rcmax",
            "register.rcband",
            "function.lastrc",
            "function.adstep",
            "register.velocitylimit",
        ],
        rows_if_there: &[],
        live: Live::All(&[Live::Board, Live::Channels(&[RC_PULSE]), Live::Indicators(&["RC"])]),
        wiring: Wiring {
            part: Part::Receiver,
            wires: &[("+5 V", "J6 P1 5V"), ("signal", "J6 P2 RC"), ("ground", "J6 P5 GND")],
        },
    },
    Recipe {
        job: Goal::Joystick,
        text: "A potentiometer of at most 2.5 kOhm gives the speed, in mode 1: switches 2 and 3 of SW1 on, 4 off. With ANA_MODE at ground, 2.5 V stops and the \
               ends are full speed either way; left open, 0 V stops and ANA_DIR (J4 P17) at ground is reverse. With ADSTEP set, VELOCITYLIMIT says how quickly \
               the speed changes, and not the voltage at J4 P3.",
        consequence: "In mode 1 the voltage drives the motor from power-up on, and no serial command of motion acts: put the joystick where it stops first.",
        asks: &[],
        sets: &[Set { key: "function.adstep", to: To::Flag(true) }],
        rows: &["register.velocitylimit", "register.timer", "register.deadband", "register.pwmlimit"],
        rows_if_there: &[],
        live: Live::All(&[Live::Board, Live::Channels(&[ANALOG_CONTROL])]),
        wiring: Wiring {
            part: Part::Potentiometer,
            wires: &[
                ("one end", "P9 5VOUT"),
                ("wiper", "P4 ANA_SPEED"),
                ("other end", "P11 GROUND"),
                ("both ways", "P16 ANA_MODE"),
            ],
        },
    },
    Recipe {
        job: Goal::Buttons,
        text: "Two buttons make the motor faster and slower, in mode 2: switches 2 and 4 of SW1 on, 3 off. BTN_MODE at 5 V is both directions, at ground one, \
               which switch 5 chooses. With ADSTEP set, VELOCITYLIMIT is what one press changes, and not the voltage at J4 P3.",
        consequence: "A button that is held goes on changing the speed, by one step each TIMER. No serial command of motion acts in mode 2.",
        asks: &[],
        sets: &[Set { key: "function.adstep", to: To::Flag(true) }],
        rows: &["register.velocitylimit", "register.timer", "register.pwmlimit"],
        rows_if_there: &[],
        live: Live::All(&[Live::Board, ENDS]),
        wiring: Wiring {
            part: Part::Switch,
            wires: &[
                ("up", "P17 BTN_UP"),
                ("down", "P16 BTN_DN"),
                ("common", "P11 GROUND"),
                ("5 V", "P4 BTN_MODE"),
            ],
        },
    },
    Recipe {
        job: Goal::Follow,
        text: "The motor goes where a voltage of 0 to 5 V asks for, in mode 5: switches 2 and 4 of SW1 off, 3 on. A potentiometer of at most 2.5 kOhm at ANA_FBCK \
               tells where it is; its voltage has to rise as the motor drives forward. These are the gains that the manual starts from.",
        consequence: "A feedback that is the wrong way round makes the motor run to its end at full power: try it where that does no harm.",
        asks: &[Ask::One("{from}", &[("By ANA_CON", "voltage"), ("By serial line", "serial")])],
        sets: &[
            Set { key: "function.adserial", to: To::Chosen("{from}", "serial") },
            Set { key: "function.rcpos_encfdbck", to: To::Flag(false) },
            Set { key: "register.velocitylimit", to: To::Number(1023.0) },
            Set { key: "register.velocityff", to: To::Number(0.0) },
            Set { key: "register.pterm", to: To::Number(10_000.0) },
            Set { key: "register.iterm", to: To::Number(10.0) },
            Set { key: "register.dterm", to: To::Number(6000.0) },
            Set { key: "register.pidscalar", to: To::Number(12.0) },
            Set { key: "function.satprot", to: To::Flag(true) },
            Set { key: "function.vellimit", to: To::Flag(false) },
        ],
        rows: &["register.deadband", "function.enabledb"],
        rows_if_there: &[],
        live: Live::All(&[Live::Board, Live::Channels(&[ANALOG_CONTROL, Channel::M1_POSITION])]),
        wiring: Wiring {
            part: Part::Potentiometer,
            wires: &[
                ("one end", "P9 5VOUT"),
                ("feedback", "P3 ANA_FBCK"),
                ("command", "P4 ANA_CON"),
                ("other end", "P11 GROUND"),
            ],
        },
    },
    Recipe {
        job: Goal::Encoder,
        text: "A quadrature encoder for mode 4, or for mode 5 with its encoder bit; switch 7 of SW1 off counts four edges of a line, on one. Or an absolute encoder \
               whose pulse of 0 to 4.096 ms is fed in at J6 P2, for mode 4 alone.",
        consequence: "A count that runs against the motor makes a loop run away: turn the shaft by hand first. With a pulse the ends of its turn do the same: mechanical \
                      stops have to keep the shaft off them.",
        asks: &[Ask::One("{kind}", &[("Quadrature", "quadrature"), ("Pulse", "pulse")])],
        sets: &[Set { key: "function2.pulsefb", to: To::Chosen("{kind}", "pulse") }],
        rows: &["function.rcpos_encfdbck"],
        rows_if_there: &[],
        live: Live::All(&[
            Live::Board,
            Live::Channels(&[Channel::M1_POSITION, Channel::M1_VELOCITY]),
            Live::Indicators(&["IDX"]),
        ]),
        wiring: ENCODER,
    },
    Recipe {
        job: Goal::Brake,
        text: "The unit has no output that lifts a spring brake. With ACTIVESTOP it ties both ends of the motor to ground while the duty is 0, which brakes a turning motor \
               and holds it a little; without it the motor runs free.",
        consequence: "A motor that still turns is braked hard whenever the duty becomes 0, and its current is not limited then.",
        asks: &[],
        sets: &[Set { key: "function.activestop", to: To::Flag(true) }],
        rows: &[],
        rows_if_there: &[],
        live: Live::Channels(&[Channel::M1_PWM]),
        wiring: Wiring { part: Part::Motor, wires: &[("+", "J3 3 M+"), ("-", "J3 2 M-")] },
    },
    Recipe {
        job: Goal::Current,
        text: "What the motor draws at most, and the most of the supply that it gets. Above AMPSLIMIT the drive is reduced by the difference.",
        consequence: "A limit below what the load needs lets the motor stand still under power. 0 A is no limit: only the fuse is left then.",
        asks: &[],
        sets: &[],
        rows: &["register.ampslimit", "register.pwmlimit"],
        rows_if_there: &[],
        live: Live::All(&[
            Live::Channels(&[Channel::M1_CURRENT]),
            Live::Indicators(&["AMPS", "PWM", "TEMP"]),
        ]),
        wiring: Wiring {
            part: Part::Motor,
            wires: &[("supply +", "J3 1 VM"), ("-", "J3 2 M-"), ("+", "J3 3 M+"), ("supply -", "J3 4 GND")],
        },
    },
    Recipe {
        job: Goal::Line,
        text: "Switch 5 of SW1 on is 9600 baud, off 19,200. Switch 6 on is the binary protocol, off text. 38,400 and 115,200 baud are bits of FUNCTION2 that \
               only some firmware has. RS-232 is at J4 P18 and P19, 5 V levels are at P13 and P14.",
        consequence: "A rate by FUNCTION2 counts once it is stored and the power was off and on: connect with it then.",
        asks: &[Ask::One("{rate}", &[("Switch 5", "switch"), ("38,400", "38400"), ("115,200", "115200")])],
        sets: &[
            Set { key: "function2.baud38400", to: To::Chosen("{rate}", "38400") },
            Set { key: "function2.baud115200", to: To::Chosen("{rate}", "115200") },
        ],
        rows: &[],
        rows_if_there: &[],
        live: Live::Board,
        wiring: Wiring {
            part: Part::Computer,
            wires: &[("RX", "P18 RS232_TX"), ("TX", "P19 RS232_RX"), ("ground", "P20 GROUND")],
        },
    },
    Recipe {
        job: Goal::Address,
        text: "Several units on one line each need an address of their own: give it while a unit is alone on the line. Short lines of up to 4 units share RX and TX with \
               5 V levels; more of them, or some metres, want RS-485 drivers, which TXEN (J4 P15) switches.",
        consequence: "The new address counts from the next command on, and the window goes on with it. Once it is stored, label the board with it.",
        asks: &[],
        sets: &[],
        rows: &["register.address"],
        rows_if_there: &[],
        live: Live::Nothing,
        wiring: Wiring {
            part: Part::Computer,
            wires: &[
                ("TX, 5 V", "P13 RX"),
                ("RX, 5 V", "P14 TX"),
                ("direction", "P15 TXEN"),
                ("ground", "P20 GROUND"),
            ],
        },
    },
];

/// What moves the motor, and how switches 2, 3 and 4 stand for it (Motion Mind manual 3.5; off counts 1).
const MODES: &[(&str, &str)] = &[
    ("R/C (0)", "on, on, on"),
    ("Voltage (1)", "on, on, off"),
    ("Buttons (2)", "on, off, on"),
    ("Serial (3)", "on, off, off"),
    ("Serial PID (4)", "off, on, on"),
    ("Analog PID (5)", "off, on, off"),
];
const ENDS: Live = Live::Indicators(&["POS", "NEG"]);
const ENCODER: Wiring = Wiring {
    part: Part::Encoder,
    wires: &[
        ("+5 V", "J6 P1 5V"),
        ("index", "J6 P2 IND"),
        ("A", "J6 P3 CHA"),
        ("B", "J6 P4 CHB"),
        ("ground", "J6 P5 GND"),
    ],
};

const GOALS: &[Goal] = &[
    Goal::Mode,
    Goal::Home,
    Goal::Limit,
    Goal::SoftLimit,
    Goal::EStop,
    Goal::Stick,
    Goal::Joystick,
    Goal::Buttons,
    Goal::Follow,
    Goal::Encoder,
    Goal::Brake,
    Goal::Current,
    Goal::Battery,
    Goal::TimeOut,
    Goal::Line,
    Goal::Address,
];

/// What it has no recipe for.
const REASONS: &[(Goal, &str)] = &[
    (
        Goal::Home,
        "A Motion Mind 3 has no home input. Its limit inputs stop the motor and set no position; the place of an encoder's index pulse is \
                 read as INDEXPOS, and POSITION can be written.",
    ),
    (
        Goal::TimeOut,
        "A Motion Mind 3 has no serial time-out: a motor goes on with what it was told last when the cable or the computer dies. Have a switch for its \
                 power at hand, set virtual limits, or wire a contact to _BRAKE.",
    ),
    (Goal::Battery, "A Motion Mind 3 does not measure its supply, and has no limit for it."),
];

/// The screens on which recipes go on.
const PLACES: &[(Goal, Place)] = &[
    (Goal::Stick, Place::Screen(Screen::Inputs)),
    (Goal::Limit, Place::Screen(Screen::Inputs)),
    (Goal::Buttons, Place::Screen(Screen::Inputs)),
    (Goal::EStop, Place::Screen(Screen::Inputs)),
    (Goal::Joystick, Place::Screen(Screen::Inputs)),
];

/// The recipes of this family.
pub struct MindRecipes;

impl Recipes for MindRecipes {
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
        let edits = Edits { unit, told };
        [
            edits.virtual_limits(),
            edits.current(),
            edits.no_current_limit(),
            edits.other_feedback(),
            edits.asked_by_voltage(),
            edits.gains(),
            edits.at_reset(),
            edits.rate(),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}

/// What is wanted of a unit and not written yet, beside what it tells.
struct Edits<'e, 'l, 't> {
    unit: &'e Looked<'l>,
    told: &'e Told<'t>,
}

impl Edits<'_, '_, '_> {
    fn is_edited(&self, key: &str) -> bool {
        let wanted = (self.unit.wanted)(key);
        wanted.is_some() && wanted != (self.unit.held)(key)
    }

    fn is_wanted(&self, key: &str) -> bool {
        (self.unit.wanted)(key) == Some(SettingValue::Bool(true))
    }

    fn number(&self, key: &str) -> Option<f64> {
        let value = (self.unit.wanted)(key)?;
        value.number().or(value.int().map(|whole| whole as f64))
    }

    fn mode(&self) -> Option<Mode> {
        Some(self.told.identity.and_then(MotionMindFacts::of)?.mode)
    }

    /// Motion Mind manual 6.2, registers 23 and 24.
    fn virtual_limits(&self) -> Option<(IndicatorState, Message)> {
        let keys = ["function.virtlimit", "register.vnlimit", "register.vplimit"];
        if !self.is_wanted(keys[0]) || !keys.iter().any(|key| self.is_edited(key)) {
            return None;
        }
        let (low, high) = (self.number(keys[1])?, self.number(keys[2])?);
        let Some(counts) = (self.told.reading)(Channel::M1_POSITION) else {
            return Some((IndicatorState::Warning, EditMessage::Nowhere { low, high }.into()));
        };
        Some(match () {
            () if counts > high => {
                (IndicatorState::Warning, EditMessage::Above { counts, limit: high }.into())
            }
            () if counts < low => (IndicatorState::Warning, EditMessage::Below { counts, limit: low }.into()),
            () => (IndicatorState::Unknown, EditMessage::Within { counts, low, high }.into()),
        })
    }

    /// Motion Mind manual 3.10.
    fn current(&self) -> Option<(IndicatorState, Message)> {
        let limit = self.number("register.ampslimit").filter(|limit| *limit > 0.0)?;
        let amps = (self.told.reading)(Channel::M1_CURRENT)?;
        let is_over = self.is_edited("register.ampslimit") && amps.abs() > limit;
        is_over.then(|| (IndicatorState::Warning, EditMessage::Reduced { amps: amps.abs(), limit }.into()))
    }

    fn no_current_limit(&self) -> Option<(IndicatorState, Message)> {
        let is_off = self.is_edited("register.ampslimit") && self.number("register.ampslimit") == Some(0.0);
        is_off.then(|| (IndicatorState::Warning, EditMessage::NoCurrentLimit.into()))
    }

    /// Another feedback is another position, at once.
    fn other_feedback(&self) -> Option<(IndicatorState, Message)> {
        let is_other = match self.mode()? {
            Mode::RadioControl | Mode::AnalogPid => self.is_edited("function.rcpos_encfdbck"),
            Mode::SerialPid => self.is_edited("function2.pulsefb"),
            Mode::Analog | Mode::Buttons | Mode::Serial | Mode::FactoryRestore | Mode::FactoryTest => false,
        };
        is_other.then(|| (IndicatorState::Warning, EditMessage::OtherFeedback.into()))
    }

    /// Mode 5 goes by the voltage once ADSERIAL is cleared (Motion Mind manual, Mode 5).
    fn asked_by_voltage(&self) -> Option<(IndicatorState, Message)> {
        let key = "function.adserial";
        let is_new = self.mode()? == Mode::AnalogPid && self.is_edited(key) && !self.is_wanted(key);
        is_new.then(|| {
            let text = match (self.told.reading)(ANALOG_CONTROL) {
                Some(volts) => EditMessage::AskedBy { volts }.into(),
                None => EditMessage::AskedByUnread.into(),
            };
            (IndicatorState::Warning, text)
        })
    }

    fn gains(&self) -> Option<(IndicatorState, Message)> {
        let keys = ["register.pterm", "register.iterm", "register.dterm", "register.pidscalar"];
        let has_loop = matches!(self.mode()?, Mode::SerialPid | Mode::AnalogPid);
        let is_new = has_loop && keys.iter().any(|key| self.is_edited(key));
        is_new.then(|| (IndicatorState::Warning, EditMessage::Gains.into()))
    }

    fn at_reset(&self) -> Option<(IndicatorState, Message)> {
        let is_edited = self.is_edited("function.adstep");
        is_edited.then(|| (IndicatorState::Unknown, EditMessage::AtReset.into()))
    }

    fn rate(&self) -> Option<(IndicatorState, Message)> {
        let is_edited = ["function2.baud38400", "function2.baud115200"].iter().any(|key| self.is_edited(key));
        is_edited.then(|| (IndicatorState::Unknown, EditMessage::Rate.into()))
    }
}
