//! The recipes of MCP and RoboClaw (MCP manual 1.9; RoboClaw manual 2018), and what their pins will do once edits are written.

use brushwork_link::device::PinSignal;
use brushwork_link::settings::{SettingValue, SettingsImage, SettingsTable};
use brushwork_link::{Channel, Message};
use brushwork_mcp_client::messages::FindingMessage;
use brushwork_mcp_client::model_of;
use brushwork_mcp_client::settings::{Behind, PinMode, SignalShape, change_mode};
use brushwork_mcp_wire::packet_serial::status::StatusIndicator;

use crate::family::recipe::{Ask, Goal, Live, Looked, Part, PinUse, Recipe, Recipes, Set, To, Told, Wiring};
use crate::messages::PinMessage;
use crate::model::IndicatorState;

/// Those of an MCP first: a recipe is offered where the controller has all of its settings.
static RECIPES: &[Recipe] = &[
    Recipe {
        job: Goal::Home,
        text: "A contact at a known place of the axis. When it closes, the count becomes the home position. Wired to a pin that measures a voltage, \
               with a resistor of 10 kOhm to the other side.",
        consequence: "The count jumps whenever the contact closes, also in mid-move: home slowly, and from one side.",
        asks: &[Ask::Pin(PinUse::Voltage), Ask::Contact, Ask::Motor],
        sets: &[
            LOW,
            MIDDLE,
            HIGH,
            Set { key: "pin.{pin}.load_home", to: To::Number(0.0) },
            Set { key: "pin.{pin}.{end}_action", to: To::Option("m{n}_load_home") },
        ],
        rows: &["pin.{pin}.type"],
        rows_if_there: &[],
        live: Live::Pin,
        wiring: SWITCH_AT_PIN,
    },
    Recipe {
        job: Goal::Home,
        text: "A contact at a known place of the axis, between S4 (motor 1) or S5 (motor 2) and ground.",
        consequence: "While the contact is closed the motor does not go backward, and its count becomes 0.",
        asks: &[Ask::Motor],
        sets: &[Set { key: "roboclaw.pin.{s}", to: To::Option("home") }],
        rows: &[],
        rows_if_there: &["motor{n}.home.duty", "motor{n}.home.timeout_seconds"],
        live: Live::Indicators(HOMES),
        wiring: SWITCH_AT_S4,
    },
    Recipe {
        job: Goal::Limit,
        text: "A contact at an end of the axis. Wired to a pin that measures a voltage, with a resistor of 10 kOhm to the other side.",
        consequence: "While the contact is closed the motor does not go on that way, and can go back.",
        asks: &[Ask::Pin(PinUse::Voltage), Ask::Contact, Ask::Motor, Ask::One("{way}", WAYS)],
        sets: &[LOW, MIDDLE, HIGH, Set { key: "pin.{pin}.{end}_action", to: To::Option("m{n}_{way}_limit") }],
        rows: &["pin.{pin}.type"],
        rows_if_there: &[],
        live: Live::Pin,
        wiring: SWITCH_AT_PIN,
    },
    Recipe {
        job: Goal::Limit,
        text: "A contact at an end of the axis, between S4 (motor 1) or S5 (motor 2) and ground.",
        consequence: "While the contact is closed the motor does not go on that way, and can go back.",
        asks: &[Ask::Motor, Ask::One("{way}", CLAW_WAYS)],
        sets: &[Set { key: "roboclaw.pin.{s}", to: To::Option("limit_{way}") }],
        rows: &[],
        rows_if_there: &[],
        live: Live::Indicators(HOMES),
        wiring: SWITCH_AT_S4,
    },
    Recipe {
        job: Goal::EStop,
        text: "A contact that stops both motors. Use one that is closed while all is well, so that a broken wire stops too. It is no safety \
               circuit: cut the power for that.",
        consequence: "Both motors stop while the contact is at that end, and stay stopped until the emergency stop is reset as chosen below.",
        asks: &[Ask::Pin(PinUse::Voltage), Ask::Contact],
        sets: &[LOW, MIDDLE, HIGH, Set { key: "pin.{pin}.{end}_action", to: To::Option("e_stop") }],
        rows: &["pin.{pin}.type", "unit.estop_reset"],
        rows_if_there: &[],
        live: Live::Pin,
        wiring: SWITCH_AT_PIN,
    },
    Recipe {
        job: Goal::EStop,
        text: "A contact between S3 and ground that stops both motors. It is no safety circuit: cut the power for that.",
        consequence: "Both motors stop while S3 is at ground; a latching stop stays until it is reset as chosen below.",
        asks: &[Ask::One("{kind}", STOPS)],
        sets: &[Set { key: "roboclaw.pin.s3", to: To::Option("{kind}") }],
        rows: &["unit.estop_reset"],
        rows_if_there: &[],
        live: Live::Indicators(&[StatusIndicator::EStop.abbreviation()]),
        wiring: Wiring { part: Part::Switch, wires: &[("contact", "S3"), ("contact", "GND")] },
    },
    Recipe {
        job: Goal::Stick,
        text: "A channel of an R/C receiver, with pulses of 1 to 2 ms, to a pin that measures pulses.",
        consequence: "The stick drives the motor whenever no input of a higher priority level does: see the levels below. Put it in its middle first.",
        asks: &[Ask::Pin(PinUse::Pulses), Ask::Motor],
        sets: &[
            Set { key: "pin.{pin}.mode", to: To::Option("position") },
            Set { key: "pin.{pin}.min", to: To::Number(1000.0) },
            Set { key: "pin.{pin}.center", to: To::Number(1500.0) },
            Set { key: "pin.{pin}.max", to: To::Number(2000.0) },
            Set { key: "pin.{pin}.deadband", to: To::Number(20.0) },
            Set { key: "pin.{pin}.target", to: To::Option("motor{n}") },
        ],
        rows: &["pin.{pin}.type", "pin.{pin}.timeout", "priority.1", "priority.2", "priority.3"],
        rows_if_there: &[],
        live: Live::Pin,
        wiring: Wiring {
            part: Part::Receiver,
            wires: &[("signal", "{pin}"), ("+5 V", "5V"), ("ground", "GND")],
        },
    },
    Recipe {
        job: Goal::Stick,
        text: "Two channels of an R/C receiver, with pulses of 1 to 2 ms, to S1 (motor 1) and S2 (motor 2).",
        consequence: CLAW_MODE,
        asks: &[],
        sets: &[Set { key: "roboclaw.config.mode", to: To::Option("rc") }],
        rows: &["roboclaw.config.baud", "roboclaw.config.address"],
        rows_if_there: CLAW_INPUTS,
        live: Live::Nothing,
        wiring: Wiring {
            part: Part::Receiver,
            wires: &[("channel 1", "S1"), ("channel 2", "S2"), ("+5 V", "5V"), ("ground", "GND")],
        },
    },
    Recipe {
        job: Goal::Joystick,
        text: "A potentiometer of 5 to 20 kOhm over the controller's 5 V, its wiper to a pin that measures a voltage.",
        consequence: "The joystick drives the motor whenever no input of a higher priority level does: see the levels below. Put it in its middle first.",
        asks: &[Ask::Pin(PinUse::Voltage), Ask::Motor],
        sets: &[
            Set { key: "pin.{pin}.mode", to: To::Option("position") },
            Set { key: "pin.{pin}.min", to: To::Number(0.0) },
            MIDDLE,
            Set { key: "pin.{pin}.max", to: To::Number(4095.0) },
            Set { key: "pin.{pin}.deadband", to: To::Number(80.0) },
            Set { key: "pin.{pin}.target", to: To::Option("motor{n}") },
        ],
        rows: &["pin.{pin}.type", "priority.1", "priority.2", "priority.3"],
        rows_if_there: &[],
        live: Live::Pin,
        wiring: Wiring {
            part: Part::Potentiometer,
            wires: &[("wiper", "{pin}"), ("one end", "5V"), ("other end", "GND")],
        },
    },
    Recipe {
        job: Goal::Joystick,
        text: "Two potentiometers of 5 to 20 kOhm over the controller's 5 V, their wipers to S1 (motor 1) and S2 (motor 2).",
        consequence: CLAW_MODE,
        asks: &[],
        sets: &[Set { key: "roboclaw.config.mode", to: To::Option("analog") }],
        rows: &["roboclaw.config.baud", "roboclaw.config.address"],
        rows_if_there: CLAW_INPUTS,
        live: Live::Nothing,
        wiring: Wiring {
            part: Part::Potentiometer,
            wires: &[("wiper 1", "S1"), ("wiper 2", "S2"), ("one end", "5V"), ("other end", "GND")],
        },
    },
    Recipe {
        job: Goal::Encoder,
        text: "A quadrature encoder at the two pins that are made for it.",
        consequence: "The count starts at 0. Compare the two arrows under PWM Settings, Direction, before a loop is closed.",
        asks: &[Ask::Motor],
        sets: &[
            Set { key: "pin.{a}.type", to: To::Option("encoder") },
            Set { key: "pin.{b}.type", to: To::Option("encoder") },
        ],
        rows: &["motor{n}.encoder.pin"],
        rows_if_there: &[],
        live: Live::Channels(&[Channel::M1_POSITION, Channel::M2_POSITION]),
        wiring: ENCODER,
    },
    Recipe {
        job: Goal::Encoder,
        text: "A quadrature encoder counts lines; an absolute one is a voltage of 0 to 2 V or 5 V at the same terminals.",
        consequence: "An encoder of the wrong kind, or the wrong way round, makes a loop run away: compare the two arrows under PWM Settings, Direction.",
        asks: &[Ask::Motor, Ask::One("{kind}", ENCODERS)],
        sets: &[Set { key: "motor{n}.encoder.kind", to: To::Option("{kind}") }],
        rows: &["motor{n}.encoder.reversed", "motor{n}.encoder.motor_reversed"],
        rows_if_there: &[],
        live: Live::Channels(&[Channel::M1_POSITION, Channel::M2_POSITION]),
        wiring: ENCODER,
    },
    Recipe {
        job: Goal::Brake,
        text: "An output that is on while the motor runs, so that a spring brake is lifted then: by a relay, with a diode across its coil.",
        consequence: "The brake falls as soon as the command is 0, before the load has come to rest. Try it without a load.",
        asks: &[Ask::One("{out}", OUTPUTS), Ask::Motor],
        sets: &[Set { key: "dout.{out}.action", to: To::Option("motor{n}_on") }],
        rows: &["dout.{out}.inverted"],
        rows_if_there: &[],
        live: Live::Nothing,
        wiring: Wiring { part: Part::Brake, wires: &[("coil", "DOUT{out}"), ("coil +", "supply +")] },
    },
    Recipe {
        job: Goal::Brake,
        text: "S4 (motor 1) or S5 (motor 2) as an output that lifts a spring brake: by a relay, with a diode across its coil.",
        consequence: "The pin is no input any more: what was a home or limit switch there has no effect.",
        asks: &[Ask::Motor],
        sets: &[Set { key: "roboclaw.pin.{s}", to: To::Option("brake") }],
        rows: &[],
        rows_if_there: &["roboclaw.pin.{d}", "roboclaw.ctrl{n}.mode"],
        live: Live::Nothing,
        wiring: BRAKE_AT_S4,
    },
    Recipe {
        job: Goal::Brake,
        text: "CTRL1 (motor 1) or CTRL2 (motor 2), on boards that have them, lifts a spring brake: by a relay, with a diode across its coil.",
        consequence: "The output follows the motor at once. Try it without a load.",
        asks: &[Ask::Motor],
        sets: &[Set { key: "roboclaw.ctrl{n}.mode", to: To::Option("brake") }],
        rows: &[],
        rows_if_there: &[],
        live: Live::Nothing,
        wiring: Wiring { part: Part::Brake, wires: &[("coil", "CTRL{n}"), ("coil +", "supply +")] },
    },
    Recipe {
        job: Goal::Battery,
        text: "The least and the greatest voltage at which the motors are driven. The least saves the battery, the greatest the controller while a \
               motor brakes into a supply that takes nothing back.",
        consequence: "Outside of these voltages the motors stop at once: compare with what the battery has now.",
        asks: &[],
        sets: &[],
        rows: &[
            "limits.main_battery.min_volts",
            "limits.main_battery.max_volts",
            "limits.logic_battery.min_volts",
            "limits.logic_battery.max_volts",
        ],
        rows_if_there: &["roboclaw.config.battery", "limits.main_battery.auto_offset_volts"],
        live: Live::Channels(&[Channel::MAIN_BATTERY, Channel::LOGIC_BATTERY]),
        wiring: Wiring { part: Part::Battery, wires: &[("+", "B+"), ("-", "B-")] },
    },
    Recipe {
        job: Goal::TimeOut,
        text: "How long a port may be silent before its commands count no more. It is what stops the motors when the computer dies or the cable \
               is pulled. 0 switches it off, and arming refuses then.",
        consequence: "A program that sends less often than this makes the motors stop between its commands.",
        asks: &[],
        sets: &[],
        rows: &["stream.usb.timeout"],
        rows_if_there: &[
            "stream.rs232.timeout",
            "stream.ttl1.timeout",
            "stream.ttl2.timeout",
            "stream.ttl3.timeout",
        ],
        live: Live::Nothing,
        wiring: COMPUTER,
    },
    Recipe {
        job: Goal::TimeOut,
        text: "How long the line may be silent before the motors are stopped: by a dead computer or a pulled cable. 0 switches it off, and arming \
               refuses then.",
        consequence: "A program that sends less often than this makes the motors stop between its commands.",
        asks: &[],
        sets: &[],
        rows: &["unit.serial_timeout"],
        rows_if_there: &[],
        live: Live::Nothing,
        wiring: COMPUTER,
    },
    Recipe {
        job: Goal::Address,
        text: "Several controllers on one line each need an address of their own. Give it while a controller is alone on the line.",
        consequence: "The new address counts from the next command on. Once it is saved, label the board with it.",
        asks: &[],
        sets: &[],
        rows: &["unit.address"],
        rows_if_there: &[
            "stream.ttl1.multi_unit",
            "stream.ttl2.multi_unit",
            "stream.ttl3.multi_unit",
            "can.node_id",
            "can.rate",
        ],
        live: Live::Nothing,
        wiring: BUS,
    },
    Recipe {
        job: Goal::Address,
        text: "Several controllers on one line each need an address of their own, and their S2 as an open drain output with one pull-up resistor. Give \
               it while a controller is alone on the line.",
        consequence: "In the serial modes the address counts at once. Once it is saved, label the board with it.",
        asks: &[],
        sets: &[],
        rows: &["roboclaw.config.address", "roboclaw.config.open_drain"],
        rows_if_there: &["roboclaw.config.baud"],
        live: Live::Nothing,
        wiring: BUS,
    },
];

/// A contact reads near 0 or near 4095; in between it is neither.
const LOW: Set = Set { key: "pin.{pin}.min", to: To::Number(1000.0) };
const MIDDLE: Set = Set { key: "pin.{pin}.center", to: To::Number(2048.0) };
const HIGH: Set = Set { key: "pin.{pin}.max", to: To::Number(3000.0) };

const HOMES: &[&str] = &[StatusIndicator::M1Home.abbreviation(), StatusIndicator::M2Home.abbreviation()];
const WAYS: &[(&str, &str)] = &[("Forward end", "forward"), ("Backward end", "backward")];
const CLAW_WAYS: &[(&str, &str)] =
    &[("Forward end", "forward"), ("Backward end", "reverse"), ("Both ends", "both")];
const STOPS: &[(&str, &str)] = &[("Latching", "e_stop_latching"), ("While it is closed", "e_stop")];
const ENCODERS: &[(&str, &str)] = &[("Quadrature", "quadrature"), ("Absolute", "absolute")];
const OUTPUTS: &[(&str, &str)] = &[("DOUT1", "1"), ("DOUT2", "2")];
const CLAW_INPUTS: &[&str] = &[
    "roboclaw.deadband.reverse",
    "roboclaw.deadband.forward",
    "roboclaw.s1.reverse_deadband",
    "roboclaw.s1.forward_deadband",
    "roboclaw.s2.reverse_deadband",
    "roboclaw.s2.forward_deadband",
];
const CLAW_MODE: &str = "It counts from the next power-up, and ends a connection by S1 and S2 then; USB goes on. Baud rate and address become \
                         options: look at them below.";

const SWITCH_AT_PIN: Wiring =
    Wiring { part: Part::Switch, wires: &[("contact", "{pin}"), ("contact", "{common}")] };
const SWITCH_AT_S4: Wiring = Wiring { part: Part::Switch, wires: &[("contact", "{s}"), ("contact", "GND")] };
const BRAKE_AT_S4: Wiring = Wiring { part: Part::Brake, wires: &[("coil", "{s}"), ("coil +", "supply +")] };
const ENCODER: Wiring = Wiring {
    part: Part::Encoder,
    wires: &[("A", "ENC{n}A"), ("B", "ENC{n}B"), ("+5 V", "5V"), ("ground", "GND")],
};
const COMPUTER: Wiring =
    Wiring { part: Part::Computer, wires: &[("USB or TX, RX", "port"), ("ground", "GND")] };
const BUS: Wiring = Wiring { part: Part::Computer, wires: &[("TX", "RX"), ("RX", "TX"), ("ground", "GND")] };

/// The recipes of this family.
pub struct McpRecipes;

impl Recipes for McpRecipes {
    fn all(&self) -> &'static [Recipe] {
        RECIPES
    }

    fn motors(&self, table: &SettingsTable) -> usize {
        model_of(table.subject()).map_or(1, |model| model.motors)
    }

    fn able_pins(&self, table: &SettingsTable, wanted: PinUse) -> Vec<usize> {
        let Some(model) = model_of(table.subject()) else { return Vec::new() };
        let is_able = |pin: &usize| {
            let label = model.pins.get(pin - 1);
            label.is_some_and(|label| match wanted {
                PinUse::Voltage => label.is_analog(),
                PinUse::Pulses => label.is_pulse(),
            })
        };
        (1..=table.subject().pins).filter(is_able).collect()
    }

    fn encoder_pin(&self, table: &SettingsTable, motor: usize, phase: char) -> Option<usize> {
        let pins = model_of(table.subject())?.pins;
        let is_it = |label: &brushwork_mcp_wire::models::Pin| {
            label.encoder_channel().is_some_and(|(of, which)| usize::from(of) == motor && which == phase)
        };
        let place = pins.iter().position(is_it)?;
        (place < table.subject().pins).then_some(place + 1)
    }

    fn pin_use(&self, unit: &Looked<'_>, pin: usize, wanted: PinUse) -> SettingsImage {
        let mode = match wanted {
            PinUse::Voltage => PinMode::Analog,
            PinUse::Pulses => PinMode::Pulse,
        };
        if PinMode::of(unit.wanted, pin) == Some(mode) {
            return SettingsImage::default();
        }
        change_mode(unit.table, pin, mode, unit.is_simulated)
    }

    fn pin_state(&self, unit: &Looked<'_>, pin: usize, signal: Option<PinSignal>) -> Option<Message> {
        let name = unit.table.subject().pin_name(pin.checked_sub(1)?);
        let mode = PinMode::of(unit.held, pin)?;
        let Some(reading) = reading(unit, pin, signal) else {
            return Some(PinMessage::Unread { pin: name }.into());
        };
        Some(match mode {
            PinMode::Pulse => PinMessage::Pulses { pin: name, microseconds: reading }.into(),
            PinMode::Digital | PinMode::Analog if reading <= CLOSED_BELOW => {
                PinMessage::AtGround { pin: name }.into()
            }
            PinMode::Digital | PinMode::Analog if reading >= CLOSED_ABOVE => {
                PinMessage::AtSupply { pin: name }.into()
            }
            PinMode::None | PinMode::Digital | PinMode::Analog | PinMode::Encoder | PinMode::PacketSerial => {
                PinMessage::Reads { pin: name, reading }.into()
            }
        })
    }

    /// Small boards have no S4 and no S5, though their settings are there.
    fn lacks(&self, table: &SettingsTable, recipe: &Recipe) -> bool {
        let has_inputs = model_of(table.subject()).is_none_or(|model| model.control_pins.contains(&"S4"));
        !has_inputs && recipe.sets.iter().any(|set| set.key.contains("{s}"))
    }

    fn consequences(&self, unit: &Looked<'_>, told: &Told<'_>) -> Vec<(IndicatorState, Message)> {
        let pins = 1..=unit.table.subject().pins;
        pins.flat_map(|pin| ["min", "max"].map(|end| consequence(unit, pin, end, (told.signal)(pin))))
            .flatten()
            .collect()
    }
}

/// Readings of 0 to 4095 that count as closed to ground, or to the supply.
const CLOSED_BELOW: f64 = 1000.0;
const CLOSED_ABOVE: f64 = 3000.0;

/// The reading behind a signal, as far as it tells.
fn reading(unit: &Looked<'_>, pin: usize, signal: Option<PinSignal>) -> Option<f64> {
    let held = |end: &str| number(unit.held, pin, end);
    PinMode::of(unit.held, pin).filter(|mode| *mode != PinMode::None)?;
    match SignalShape::of(unit.held, pin)?.behind(f64::from(signal?.position)) {
        Behind::Reading(reading) => Some(reading),
        Behind::Deadband => held("center"),
        Behind::LowEnd => held("min"),
        Behind::HighEnd => held("max"),
    }
}

fn number(get: &dyn Fn(&str) -> Option<SettingValue>, pin: usize, field: &str) -> Option<f64> {
    let value = get(&format!("pin.{pin}.{field}"))?;
    value.number().or(value.int().map(|number| number as f64))
}

/// What the action at an end of a pin will do, where it or what triggers it was edited.
fn consequence(
    unit: &Looked<'_>,
    pin: usize,
    end: &'static str,
    signal: Option<PinSignal>,
) -> Option<(IndicatorState, Message)> {
    let key = |field: &str| format!("pin.{pin}.{field}");
    let action =
        (unit.wanted)(&key(&format!("{end}_action")))?.choice().filter(|action| *action != "none")?;
    let is_edited = |field: &str| (unit.wanted)(&key(field)) != (unit.held)(&key(field));
    let action_field = format!("{end}_action");
    let is_new = [action_field.as_str(), "type", "digital", end, "load_home"].into_iter().any(is_edited);
    let mode = PinMode::of(unit.wanted, pin).filter(|mode| *mode != PinMode::None)?;
    let (what, name) = (what(unit, pin, action)?, unit.table.subject().pin_name(pin - 1));
    let end_name = if end == "min" { PinMessage::LowEnd } else { PinMessage::HighEnd }.into();
    if !is_new {
        return None;
    }
    let wanted = number(unit.wanted, pin, end)?;
    let stands_there = match PinMode::of(unit.held, pin) {
        // A pin in another mode reads in other units.
        Some(now) if now == mode => reading(unit, pin, signal).map(|reading| match end {
            "min" => reading <= wanted,
            _ => reading >= wanted,
        }),
        _ => None,
    };
    Some(match stands_there {
        Some(true) => (IndicatorState::Warning, PinMessage::AtOnce { pin: name, end: end_name, what }.into()),
        Some(false) => (IndicatorState::Unknown, PinMessage::Later { pin: name, end: end_name, what }.into()),
        None => (IndicatorState::Warning, PinMessage::Unseen { pin: name, end: end_name, what }.into()),
    })
}

/// What an action does, as a clause.
fn what(unit: &Looked<'_>, pin: usize, action: &str) -> Option<Message> {
    let (which, effect) = match action.split_once('_') {
        Some(("m1", effect)) => (FindingMessage::OneMotor { motor: 1 }.into(), effect),
        Some(("m2", effect)) => (FindingMessage::OneMotor { motor: 2 }.into(), effect),
        Some(("both", effect)) => (FindingMessage::BothMotors.into(), effect),
        _ => (Message::default(), action),
    };
    let home = number(unit.wanted, pin, "load_home").unwrap_or_default();
    Some(match effect {
        "safe_stop" => PinMessage::Stops { which }.into(),
        "off" => PinMessage::Coasts { which }.into(),
        "reverse" => PinMessage::TurnsRound { which }.into(),
        "forward_limit" => PinMessage::NotForward { which }.into(),
        "backward_limit" => PinMessage::NotBackward { which }.into(),
        "load_home" => PinMessage::BecomesHome { which, counts: home }.into(),
        "run_script" => PinMessage::ScriptStarts.into(),
        "stop_script" => PinMessage::ScriptStops.into(),
        "reset_script" => PinMessage::ScriptRestarts.into(),
        "e_stop" => PinMessage::EStops.into(),
        _ => return None,
    })
}
