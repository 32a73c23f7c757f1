//! The screens of all families: Ion Studio's, in its order (MCP manual 1.2.3 to 1.2.14), then those of other families. Which
//! of them a controller has, and what it calls them, its family says.

use brushwork_link::device::{ArmScope, Channel};

/// One screen of the window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Screen {
    #[default]
    DeviceStatus,
    GeneralSettings,
    Pwm,
    Velocity,
    Position,
    MclEditor,
    /// What stands in for the screens that drive while the controller is not to be driven from here.
    Motion,
    /// Analog inputs, radio control and switches.
    Inputs,
    /// Commands by hand.
    Terminal,
}

impl Screen {
    pub const ALL: [Self; 9] = [
        Self::DeviceStatus,
        Self::GeneralSettings,
        Self::Pwm,
        Self::Velocity,
        Self::Position,
        Self::MclEditor,
        Self::Motion,
        Self::Inputs,
        Self::Terminal,
    ];

    /// Those of an MCP.
    pub const USUAL: [Self; 6] = [
        Self::DeviceStatus,
        Self::GeneralSettings,
        Self::Pwm,
        Self::Velocity,
        Self::Position,
        Self::MclEditor,
    ];

    pub const fn title(self) -> &'static str {
        match self {
            Self::DeviceStatus => "Device Status",
            Self::GeneralSettings => "General Settings",
            Self::Pwm => "PWM Settings",
            Self::Velocity => "Velocity Settings",
            Self::Position => "Position Settings",
            Self::MclEditor => "MCL Editor",
            Self::Motion => "Motion",
            Self::Inputs => "Inputs",
            Self::Terminal => "Command Terminal",
        }
    }

    /// What arming this screen allows; leaving such a screen disarms.
    pub const fn arm_scope(self) -> Option<ArmScope> {
        match self {
            Self::Pwm => Some(ArmScope::Pwm),
            Self::Velocity => Some(ArmScope::Velocity),
            Self::Position => Some(ArmScope::Position),
            Self::MclEditor => Some(ArmScope::Script),
            Self::DeviceStatus | Self::GeneralSettings | Self::Motion | Self::Inputs | Self::Terminal => None,
        }
    }

    /// Whether the screen shows the graph, with channels of its own.
    pub const fn has_graph(self) -> bool {
        self.arm_scope().is_some() || matches!(self, Self::DeviceStatus)
    }

    /// Whether the screen shows settings of the control loops.
    pub const fn has_loops(self) -> bool {
        matches!(self, Self::Pwm | Self::Velocity | Self::Position)
    }

    /// What its graph shows at first.
    pub const fn first_channels(self) -> &'static [Channel] {
        use Channel as C;
        match self {
            Self::Velocity => {
                &[C::M1_SETPOINT, C::M1_VELOCITY, C::M1_PWM, C::M2_SETPOINT, C::M2_VELOCITY, C::M2_PWM]
            }
            Self::Position => &[
                C::M1_SETPOINT,
                C::M1_POSITION,
                C::M1_VELOCITY,
                C::M2_SETPOINT,
                C::M2_POSITION,
                C::M2_VELOCITY,
            ],
            Self::DeviceStatus => &[C::MAIN_BATTERY, C::M1_CURRENT, C::M2_CURRENT, C::TEMPERATURE_1],
            Self::Pwm
            | Self::MclEditor
            | Self::GeneralSettings
            | Self::Motion
            | Self::Inputs
            | Self::Terminal => &[C::M1_PWM, C::M1_VELOCITY, C::M1_CURRENT],
        }
    }
}
