//! What differs between families of controllers in the window, in ONE place that the shell and the shared screens ask.
//!
//! A family says which screens there are, which figures stand in the top row, which lamps at the bottom, how many motors a
//! controller has and which channels its graph. A screen that is shared asks its desk's family and never which one it is. To
//! add a family, implement [`Family`] and name it in [`of`].

use std::fmt;
use std::time::Duration;

use brushwork_link::device::{ArmScope, Channel, Drive, Identity, Request, StatusReport};
use brushwork_protocol::packet_serial::Motor;
use brushwork_tuning::cause::Cause;
use brushwork_tuning::tune::Method;
use egui::Ui;

use super::command::Commands;
use super::model::Model;
use super::model::desk::Desk;
use super::model::drawer::Tab;
use super::model::lamp::{LampInfo, LampState};
use super::model::screen::Screen;
use super::model::setpoints::Setpoints;
use super::tune::Loop;

mod mcp;
mod motion_mind;
mod words;

pub use mcp::sign_of as mcp_sign;
pub use words::SettingsWords;

/// Which family a controller is of, as far as the window tells them apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FamilyKind {
    /// MCP and RoboClaw, over packet serial or CANopen. Shown before anything was ever connected.
    #[default]
    Mcp,
    MotionMind,
}

impl FamilyKind {
    /// The family of a unit that answered.
    pub fn of_unit(identity: &Identity) -> Self {
        if identity.is_motion_mind() { Self::MotionMind } else { Self::Mcp }
    }

    /// The family that a target names before anything has answered there, if it names one.
    pub fn of_target(target: &str) -> Option<Self> {
        let simulated = target.strip_prefix("sim:")?;
        Some(if simulated.starts_with("motion-mind") { Self::MotionMind } else { Self::Mcp })
    }
}

/// What the window has to know of a family.
pub trait Family: Sync {
    /// What a person calls its controllers, for sentences.
    fn name(&self) -> &'static str;

    /// The screens, in the order of the list.
    fn screens(&self, desk: &Desk) -> Vec<Screen>;

    /// What a screen is called in this family.
    fn title(&self, screen: Screen) -> &'static str {
        screen.title()
    }

    /// Draws a screen of [`Family::screens`].
    fn screen_ui(&self, ui: &mut Ui, model: &mut Model, commands: &mut Commands);

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

    /// What the status word says, the gravest lamp first in order.
    fn signs(&self, report: &StatusReport, identity: Option<&Identity>) -> Vec<Sign>;

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

    /// Why a controller cannot be tuned as it is set, where it cannot.
    fn cannot_tune(&self, _desk: &Desk) -> Option<&'static str> {
        None
    }

    /// What to do about a refused run, in the order in which it is best tried, where it is done in other places than elsewhere.
    fn remedies(&self, _cause: Cause) -> Option<&'static [&'static str]> {
        None
    }

    /// What the motors have to be told for a screen that is armed and whose sliders stand so, if anything.
    fn to_send(&self, desk: &Desk, scope: ArmScope, setpoints: Setpoints) -> Option<Drive>;

    /// What the open screen needs to have read besides the signals, when it is time for it.
    fn wants_read(&self, _desk: &mut Desk, _screen: Screen, _now: Duration) -> Option<Request> {
        None
    }

    /// Whether the screens that drive show settings of loops that have to be read for them.
    fn has_loops(&self) -> bool;

    /// Whether the graph can show a channel.
    fn has_channel(&self, channel: Channel) -> bool;

    /// What the graph of a screen shows at first.
    fn first_channels(&self, screen: Screen) -> &'static [Channel] {
        screen.first_channels()
    }

    /// Why the family lacks something that others have; `None` where it has it.
    fn lacks(&self, ability: Ability) -> Option<&'static str>;
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

/// Something that a status word says, and how grave it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Sign {
    /// Place among the signs of its family.
    pub order: u8,
    pub title: &'static str,
    pub state: LampState,
}

/// The family behind a kind.
pub fn of(kind: FamilyKind) -> &'static dyn Family {
    match kind {
        FamilyKind::Mcp => &mcp::Mcp,
        FamilyKind::MotionMind => &motion_mind::MotionMind,
    }
}

impl fmt::Debug for dyn Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn in_each_family_lamps_and_screens_have_names_of_their_own() {
        for family in [FamilyKind::Mcp, FamilyKind::MotionMind].map(of) {
            let shorts: BTreeSet<_> = family.lamps().iter().map(|lamp| lamp.short).collect();
            assert_eq!(shorts.len(), family.lamps().len(), "{family:?}");
            let screens = family.screens(&Desk::default());
            let titles: BTreeSet<_> = screens.iter().map(|screen| family.title(*screen)).collect();
            assert_eq!(titles.len(), screens.len(), "{family:?}");
        }
    }
}
