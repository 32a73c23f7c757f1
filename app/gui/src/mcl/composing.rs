//! What an input method is composing in the text.

/// What an input method is composing, and where it stands in the text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Composing {
    pub start: usize,
    pub length: usize,
}
