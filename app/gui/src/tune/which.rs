//! Which loop of a motor is tuned.

use brushwork_link::device::ArmScope;

use crate::model::screen::Screen;

/// Which loop is tuned: each has its screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loop {
    Velocity,
    Position,
}

impl Loop {
    pub fn of(screen: Screen) -> Option<Self> {
        [Self::Velocity, Self::Position].into_iter().find(|which| which.screen() == screen)
    }

    pub const fn screen(self) -> Screen {
        match self {
            Self::Velocity => Screen::Velocity,
            Self::Position => Screen::Position,
        }
    }

    pub const fn scope(self) -> ArmScope {
        match self {
            Self::Velocity => ArmScope::Velocity,
            Self::Position => ArmScope::Position,
        }
    }

    /// Unit of what it holds.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Velocity => "counts/s",
            Self::Position => "counts",
        }
    }
}
