//! What a person can ask of the editor.

use super::disk::{Encoding, LineEnds};
use super::{DocId, Tab};

/// One action. What is done to a program is done to the one in front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MclAction {
    New,
    /// Opens an example that comes with Brushwork.
    Example(usize),
    /// Asks for a file to open.
    Open,
    Save,
    SaveAs,
    Print,
    /// Hands the pages of the sheet to the system's printer.
    SendToPrinter,
    /// Puts a program in front.
    Front(DocId),
    Close(DocId),
    Undo,
    Redo,
    Cut,
    Copy,
    Paste,
    SelectAll,
    ToggleComment,
    DuplicateLines,
    DeleteLines,
    MoveLines {
        down: bool,
    },
    Indent {
        further: bool,
    },
    /// Writes the program anew in the usual form.
    Tidy,
    ToggleHidden,
    ToggleCurrentLine,
    ToggleFolding,
    /// Size of the text, percent.
    Zoom(u16),
    /// Folds the block that begins at a line, from 0, or opens it.
    ToggleFold(usize),
    ToggleFoldHere,
    FoldAll,
    UnfoldAll,
    ToggleBookmark,
    NextBookmark,
    PreviousBookmark,
    ClearBookmarks,
    /// Sets or takes away a breakpoint at a line, from 0.
    ToggleBreakpoint(usize),
    /// Selects from one byte to another.
    Select(usize, usize),
    Find,
    Replace,
    FindNext,
    FindPrevious,
    ReplaceOne,
    ReplaceAll,
    CloseFind,
    GoToLine,
    Definition,
    Rename,
    Matching,
    Complete,
    NextProblem,
    PreviousProblem,
    /// Checks and shows what was found.
    Check,
    SetEncoding(Encoding),
    SetLineEnds(LineEnds),
    /// Shows a part of the panel, or hides the panel if it is shown.
    ShowPanel(Tab),
    AcceptSheet,
    DismissSheet,
    CloseUnsaved,
    /// Loads the file that another program has written, or keeps what stands here.
    SettleChange {
        id: DocId,
        load: bool,
    },
    /// Opens what earlier windows left unsaved, or throws it away.
    SettleLeft {
        restore: bool,
    },
    /// Asks for the maker's image file.
    ChooseImage,
}
