//! What a family says of its controllers, and the types in which it says it.

use std::fmt;

use brushwork_link::device::{ArmScope, Channel, Drive, Identity, Indicator, StatusReport};
use brushwork_mcp_wire::packet_serial::led::BlinkCode;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::tune::Method;
use brushwork_values::Motor;

use super::words::SettingsWords;
use crate::model::drawer::Tab;
use crate::model::lamp::{LampInfo, LampState, state_of};
use crate::model::motion_mind::Driven;
use crate::model::position::Position;
use crate::model::pwm::Pwm;
use crate::model::screen::Screen;
use crate::model::velocity::Velocity;
use crate::tune::Loop;

/// What the window has to know of a family.
pub trait Family: Sync {
    /// What a person calls its controllers, for sentences.
    fn name(&self) -> &'static str;

    /// The screens, in the order of the list; those that drive where `driven` says what a Motion Mind takes.
    fn screens(&self, driven: Driven) -> Vec<Screen>;

    /// What a screen is called in this family.
    fn title(&self, screen: Screen) -> &'static str {
        screen.title()
    }

    /// The tabs above the graph of a screen that drives.
    fn tabs(&self, screen: Screen) -> &'static [Tab];

    /// The monitored parameters at the top.
    fn figures(&self) -> &'static [Figures];

    /// The status lamps, in order.
    fn lamps(&self) -> &'static [LampInfo];

    /// How each of [`Family::lamps`] stands. `homed` is what the input pins say of home and limit switches, where they are known.
    fn lit(
        &self,
        report: &StatusReport,
        identity: Option<&Identity>,
        homed: Option<[bool; 2]>,
    ) -> Vec<LampState>;

    /// What the status word says, in the order in which it is shown.
    fn active(&self, report: &StatusReport, identity: Option<&Identity>) -> Vec<ActiveIndicator>;

    /// What is active while a motor is homed or at a limit, where the pins tell that and the status word has no bit for it.
    fn home_indicators(&self) -> Option<[ActiveIndicator; 2]> {
        None
    }

    /// How the LEDs on the board blink by a status, and by whether a bridge drives.
    fn blink_code(&self, _report: &StatusReport, _driving: bool) -> Option<BlinkCode> {
        None
    }

    /// How acts on its settings are told.
    fn words(&self) -> &'static SettingsWords;

    /// The motors a controller has.
    fn motors(&self) -> &'static [Motor];

    /// Names of the input pins in the simulated world; empty where they are numbered.
    fn world_pins(&self) -> &'static [&'static str] {
        &[]
    }

    /// The ways of guided tuning for a loop, the one that is taken unless another is chosen at the end.
    fn methods(&self, which: Loop) -> &'static [Method];

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
    fn has_loops(&self) -> bool;

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
    /// A report of what keeps the motors from running, which needs settings.
    Diagnosis,
    /// LEDs on the board whose blink codes are known.
    Leds,
    /// Raw commands out of a table.
    Composer,
    /// Settings that can contradict each other.
    Conflicts,
    /// Calibration by hand of loop gains.
    ByHand,
    /// Several serial ports, each with a time-out.
    Streams,
    /// A supply of its own for the logic.
    LogicBattery,
    /// Encoders of more than one kind.
    AbsoluteEncoders,
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
    pub state: LampState,
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
