//! What people want of a controller, for which recipes are looked up.

/// What a person wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    Mode,
    Host,
    Home,
    Limit,
    SoftLimit,
    EStop,
    Stick,
    Joystick,
    Buttons,
    Follow,
    Encoder,
    Stepper,
    Servo,
    Inputs,
    Outputs,
    Brake,
    Current,
    Lag,
    Battery,
    TimeOut,
    Line,
    Address,
    Start,
}

impl Goal {
    /// What is asked of most controllers.
    pub const USUAL: [Self; 10] = [
        Self::Home,
        Self::Limit,
        Self::EStop,
        Self::Stick,
        Self::Joystick,
        Self::Encoder,
        Self::Brake,
        Self::Battery,
        Self::TimeOut,
        Self::Address,
    ];

    pub const fn title(self) -> &'static str {
        match self {
            Self::Mode => "Operating mode",
            Self::Host => "Host program",
            Self::Home => "Home switch",
            Self::Limit => "Limit switch",
            Self::SoftLimit => "Virtual limits",
            Self::EStop => "Emergency stop",
            Self::Stick => "R/C stick",
            Self::Joystick => "Analog joystick",
            Self::Buttons => "Buttons",
            Self::Follow => "Analog position",
            Self::Encoder => "Encoder",
            Self::Stepper => "Stepper waits",
            Self::Servo => "Servo",
            Self::Inputs => "Input lines",
            Self::Outputs => "Output lines",
            Self::Brake => "Brake",
            Self::Current => "Current limit",
            Self::Lag => "Following error",
            Self::Battery => "Battery protection",
            Self::TimeOut => "Serial time-out",
            Self::Line => "Baud rate and protocol",
            Self::Address => "Bus address",
            Self::Start => "Start macro",
        }
    }
}
