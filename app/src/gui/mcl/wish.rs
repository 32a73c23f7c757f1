//! What a person can ask of the editor.

use super::document::DocId;

/// One wish.
#[derive(Clone, Debug, PartialEq)]
pub enum MclWish {
    New,
    /// Puts a program in front.
    Front(DocId),
    Close(DocId),
    Undo,
    Redo,
    Cut,
    Copy,
    Paste,
    SelectAll,
    ToggleHidden,
    ToggleCurrentLine,
    ToggleFolding,
    /// Size of the text, percent.
    Zoom(u16),
    ToggleBookmark,
    NextBookmark,
    PreviousBookmark,
    ClearBookmarks,
    /// Sets or takes away a breakpoint at a line, from 0, of the program in front.
    ToggleBreakpoint(usize),
    /// Puts the caret at a byte of the program in front and selects up to another.
    Select(usize, usize),
    ShowPanel(super::panel::Tab),
}
