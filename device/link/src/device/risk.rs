//! That the user has accepted the risk of what this program cannot guard: a firmware update, or a program that begins on a unit.

/// The user has been shown the risks and has accepted them. Made in one place of each user interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RiskAccepted(());

impl RiskAccepted {
    /// Says that the user has read the risks and accepts them.
    #[must_use]
    pub fn by_the_user() -> Self {
        Self(())
    }
}
