//! The screens, in Ion Studio's order (MCP manual 1.2.3 to 1.2.14).

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
}

impl Screen {
    pub const ALL: [Self; 6] = [
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
        }
    }

    /// Why the screen cannot be opened, where it does not exist yet.
    pub const fn missing(self) -> Option<&'static str> {
        match self {
            Self::DeviceStatus | Self::GeneralSettings | Self::Pwm => None,
            Self::Velocity | Self::Position => {
                Some("This screen is not built yet. On the command line: brushwork drive")
            }
            Self::MclEditor => Some("This screen is not built yet."),
        }
    }

    /// Whether motors can be driven from this screen, so that leaving it disarms.
    pub const fn drives(self) -> bool {
        matches!(self, Self::Pwm | Self::Velocity | Self::Position)
    }
}
