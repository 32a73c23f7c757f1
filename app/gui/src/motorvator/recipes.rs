//! The recipes of the MotorVator V3 (MotorVator manual, and the host library). The board keeps no settings: a program says what its pins do.

use crate::family::path::Place;
use crate::family::recipe::{Goal, Live, Part, Recipe, Recipes, Wiring};
use crate::model::Screen;
use brushwork_motorvator_client::channels::ANALOG;

static RECIPES: &[Recipe] = &[
    Recipe {
        job: Goal::Host,
        text: "The board answers nothing by itself: a program on it has to. The host library is such a program, assets/mecc/host.mecc: put it on the board with the maker's \
               compiler, and start it with G on the Terminal screen.",
        consequence: "While it runs, no other program does: what the board shall do by itself has to stand in the same program. Arming is refused until it has answered.",
        asks: &[],
        sets: &[],
        rows: &[],
        rows_if_there: &[],
        live: Live::All(&[Live::Board, Live::Indicators(&["HOST"])]),
        wiring: SERIAL,
    },
    Recipe {
        job: Goal::Inputs,
        text: "Four on/off inputs and six analog ones. A program is told by SetEvent, with OnOff1Event to OnOff4Event, that an on/off input has changed; the host library counts the changes.",
        consequence: "An event does not run during a Wait: a switch that has to stop something wants a program without long waits.",
        asks: &[],
        sets: &[],
        rows: &[],
        rows_if_there: &[],
        live: Live::All(&[
            Live::Indicators(&["IN1", "IN2", "IN3", "IN4"]),
            Live::Channels(&[ANALOG[0], ANALOG[1], ANALOG[2], ANALOG[3], ANALOG[4], ANALOG[5]]),
        ]),
        wiring: Wiring { part: Part::Switch, wires: &[("contact", "OnOff 3"), ("contact", "ground")] },
    },
    Recipe {
        job: Goal::Servo,
        text: "Two servos turn to an angle on either side of their middle when they are told to, and stay there. They stand below the motors.",
        consequence: "A servo moves at once and at its own speed. A stop leaves it where it is.",
        asks: &[],
        sets: &[],
        rows: &[],
        rows_if_there: &[],
        live: Live::Indicators(&["HOST"]),
        wiring: Wiring { part: Part::Motor, wires: &[("signal", "servo 1"), ("signal", "servo 2")] },
    },
    Recipe {
        job: Goal::Stepper,
        text: "Stepper 1 takes motors A and B, stepper 2 motors C and D. MinWait and MaxWait are the smallest that lose no steps, HoldCurrent is what holds the shaft while it stands; the \
               guided search on the Stepper screen finds the waits.",
        consequence: "A change counts at once and until the next restart: the line ConfigStepper belongs into the program.",
        asks: &[],
        sets: &[],
        rows: &["stepper.min_wait", "stepper.max_wait", "stepper.hold_current"],
        rows_if_there: &[],
        live: Live::Indicators(&["STEP1", "STEP2"]),
        wiring: Wiring {
            part: Part::Motor,
            wires: &[("one coil", "motor A, C"), ("other coil", "motor B, D")],
        },
    },
    Recipe {
        job: Goal::TimeOut,
        text: "The host library stops all motors and both steppers when no order has come for a quarter of a second: its dead-man, by a timer of the board. A program without it has no such stop.",
        consequence: "The window asks often enough by itself. A program of yours that uses the same orders has to ask four times a second or more.",
        asks: &[],
        sets: &[],
        rows: &[],
        rows_if_there: &[],
        live: Live::Indicators(&["HOST", "DEAD"]),
        wiring: SERIAL,
    },
];

const SERIAL: Wiring =
    Wiring { part: Part::Computer, wires: &[("TX, RX", "serial port"), ("ground", "ground")] };

const GOALS: &[Goal] = &[
    Goal::Host,
    Goal::Inputs,
    Goal::Servo,
    Goal::Stepper,
    Goal::EStop,
    Goal::Encoder,
    Goal::Current,
    Goal::Battery,
    Goal::TimeOut,
];

/// What it has no recipe for.
const REASONS: &[(Goal, &str)] = &[
    (
        Goal::EStop,
        "A MotorVator has no input of its own for an emergency stop: a program makes one of an on/off input, by an event whose handler says StopMotors and which no Wait keeps \
                 away. It is no safety circuit: cut the power for that.",
    ),
    (Goal::Encoder, "A MotorVator has no encoder: it measures neither position nor speed."),
    (Goal::Current, "A MotorVator measures no current and has no limit for it: choose a fuse for the motor."),
    (Goal::Battery, "A MotorVator does not tell its supply."),
];

/// The screens on which recipes go on.
const PLACES: &[(Goal, Place)] = &[
    (Goal::Host, Place::Screen(Screen::Terminal)),
    (Goal::Inputs, Place::Screen(Screen::Inputs)),
    (Goal::Servo, Place::Screen(Screen::Pwm)),
    (Goal::Stepper, Place::Screen(Screen::Position)),
];

/// The recipes of this family.
pub struct MotorvatorRecipes;

impl Recipes for MotorvatorRecipes {
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
}
