//! What bytes on the wire mean, as the traffic view shows it.

/// What bytes on the wire mean.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Described {
    /// In words; the bytes themselves where they mean nothing.
    pub text: String,
    /// Whether they are a request as it should be, or the whole and undamaged reply to one.
    pub sound: bool,
}
