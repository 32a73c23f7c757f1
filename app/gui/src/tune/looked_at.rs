//! Which picture of a result is looked at.

/// Which picture of a result is looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    #[default]
    Measured,
    Step,
    Load,
    Bode,
    Nyquist,
    Sensitivity,
}

impl Kind {
    pub const ALL: [Self; 6] =
        [Self::Measured, Self::Step, Self::Load, Self::Bode, Self::Nyquist, Self::Sensitivity];

    pub const fn title(self) -> &'static str {
        match self {
            Self::Measured => "Measured",
            Self::Step => "Step",
            Self::Load => "Load",
            Self::Bode => "Bode",
            Self::Nyquist => "Nyquist",
            Self::Sensitivity => "Sensitivity",
        }
    }

    pub const fn hint(self) -> &'static str {
        match self {
            Self::Measured => {
                "What the machine did with the gains that were tried, over what the model predicts"
            }
            Self::Step => "What the gains do to a step of the setpoint, on the model",
            Self::Load => "What a load of 15 % of the stall torque does, on the model",
            Self::Bode => "Gain and phase of the open loop over frequency",
            Self::Nyquist => "The open loop in the complex plane; it keeps out of the Ms circle",
            Self::Sensitivity => "How much the loop enlarges what disturbs it; its peak is Ms",
        }
    }
}

/// What is looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct View {
    pub kind: Kind,
}
