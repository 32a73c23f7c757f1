//! The rows for MCL programs in the File, Edit and View menus (MCP manual 1.2.6, 1.2.7, 1.2.14).

use egui::{Key, Modifiers};

use super::{Action, Keys, Ready, always, ctrl, ctrl_shift, in_text_key, on_mcl, on_mcl_key, only};
use crate::command::Command;
use crate::mcl::{Editor, MclAction, Tab};
use crate::model::Model;

const CTRL: Modifiers = Modifiers::COMMAND;
const SHIFT: Modifiers = Modifiers::SHIFT;
const ALT: Modifiers = Modifiers::ALT;
const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);
const NONE: Modifiers = Modifiers::NONE;

/// One row whose command is an action that depends on nothing.
macro_rules! row {
    ($menu:ident $group:literal, $id:literal, $title:literal, $keys:expr, $ready:expr, $action:expr, $help:literal) => {
        entry!($menu $group $id, $title, $help,
            $keys, $ready, |_| Command::Mcl($action))
    };
}

/// One row for something that is on or off.
macro_rules! switch {
    ($option:ident $id:literal, $title:literal, $action:ident, $help:literal) => {
        entry!(View 4 $id, $title, $help,
            Keys::None, on_mcl, |_| Command::Mcl(MclAction::$action), on |model| model.mcl.options.$option)
    };
}

macro_rules! example {
    ($index:literal $id:literal, $title:literal, $help:literal) => {
        row!(File 1, $id, $title, Keys::None, always, MclAction::Example($index), $help)
    };
}

pub(super) const FILE: &[Action] = &[
    row!(File 0, "file.new", "New MCL Program", ctrl(Key::N), always, MclAction::New, "Begins an empty MCL program."),
    row!(File 0, "file.open", "Open MCL Program…", ctrl(Key::O), always, MclAction::Open, "Opens an MCL program from a file."),
    row!(File 0, "file.save", "Save MCL Program", ctrl(Key::S), always, MclAction::Save, "Saves the open MCL program to its file."),
    row!(File 0, "file.save-as", "Save MCL Program As…", ctrl_shift(Key::S), always, MclAction::SaveAs, "Saves the open MCL program under another name."),
    row!(File 0, "file.print", "Print MCL Program…", on_mcl_key(CTRL, Key::P), on_mcl, MclAction::Print, "Prints the open MCL program with colours and line numbers: on the system's printer or to a PDF file."),
    entry!(File 0 "file.close", "Close MCL Program", "Closes the tab in front; unsaved text is asked for first.",
        on_mcl_key(CTRL, Key::W), on_mcl, |model| Command::Mcl(MclAction::Close(model.mcl.front().id()))),
    entry!(File 0 "file.next-program", "Next MCL Program", "Puts the next tab in front.",
        on_mcl_key(CTRL, Key::Tab), on_mcl, |model| Command::Mcl(MclAction::Front(model.mcl.neighbour(true)))),
    entry!(File 0 "file.previous-program", "Previous MCL Program", "Puts the previous tab in front.",
        on_mcl_key(CTRL_SHIFT, Key::Tab), on_mcl, |model| Command::Mcl(MclAction::Front(model.mcl.neighbour(false)))),
    example!(0 "file.example-hello", "Example: Hello", "Says time, battery and temperature on the USB stream."),
    example!(1 "file.example-blink", "Example: Blink", "Switches an output on and off."),
    example!(2 "file.example-ramp", "Example: Ramp", "Ramps motor 1 up and down."),
    example!(3 "file.example-there-and-back", "Example: There and Back", "Turns motor 1 by counts of its encoder."),
    example!(4 "file.example-keys", "Example: Drive by Keys", "Drives both motors by letters from the terminal."),
    example!(5 "file.example-melody", "Example: Table of Steps", "Plays a table of duties and times on motor 1."),
    example!(6 "file.example-eeprom", "Example: Starts in EEPROM", "Counts its own starts in the user EEPROM."),
    example!(7 "file.example-flash", "Example: Flash (MeccCode)", "Shows OO and XX in turn on the board's display."),
    example!(8 "file.example-motors", "Example: Motors (MeccCode)", "Drives the motors of the board."),
];

pub(super) const EDIT: &[Action] = &[
    row!(Edit 0, "edit.undo", "Undo", in_text_key(CTRL, Key::Z), can_undo, MclAction::Undo, "Takes back the last edit of the MCL program."),
    row!(Edit 0, "edit.redo", "Redo", in_text_key(CTRL, Key::Y), can_redo, MclAction::Redo, "Does the last edit that was taken back again."),
    row!(Edit 0, "edit.cut", "Cut", Keys::Elsewhere("Ctrl+X"), on_mcl, MclAction::Cut, "Cuts the selected text, or the line, out of the MCL program."),
    row!(Edit 0, "edit.copy", "Copy", Keys::Elsewhere("Ctrl+C"), on_mcl, MclAction::Copy, "Copies the selected text, or the line, of the MCL program."),
    row!(Edit 0, "edit.paste", "Paste", Keys::Elsewhere("Ctrl+V"), on_mcl, MclAction::Paste, "Pastes text into the MCL program."),
    row!(Edit 0, "edit.select-all", "Select All", in_text_key(CTRL, Key::A), on_mcl, MclAction::SelectAll, "Selects the whole MCL program."),
    row!(Edit 1, "edit.find", "Find…", on_mcl_key(CTRL, Key::F), on_mcl, MclAction::Find, "Looks for text in the MCL program: case, whole words, regular expressions."),
    row!(Edit 1, "edit.find-next", "Find Next", on_mcl_key(NONE, Key::F3), on_mcl, MclAction::FindNext, "Goes to the next match."),
    row!(Edit 1, "edit.find-previous", "Find Previous", on_mcl_key(SHIFT, Key::F3), on_mcl, MclAction::FindPrevious, "Goes to the match before."),
    row!(Edit 1, "edit.replace", "Replace…", on_mcl_key(CTRL, Key::H), on_mcl, MclAction::Replace, "Looks for text and puts other text in its place."),
    row!(Edit 1, "edit.go-to-line", "Go to Line…", on_mcl_key(CTRL, Key::G), on_mcl, MclAction::GoToLine, "Goes to a line by its number."),
    row!(Edit 2, "edit.bookmark", "Toggle Bookmark", on_mcl_key(CTRL, Key::F2), on_mcl, MclAction::ToggleBookmark, "Adds a bookmark to the line of the caret, or removes it."),
    row!(Edit 2, "edit.next-bookmark", "Next Bookmark", on_mcl_key(NONE, Key::F2), has_bookmarks, MclAction::NextBookmark, "Goes to the next bookmark."),
    row!(Edit 2, "edit.previous-bookmark", "Previous Bookmark", on_mcl_key(SHIFT, Key::F2), has_bookmarks, MclAction::PreviousBookmark, "Goes to the bookmark before."),
    row!(Edit 2, "edit.clear-bookmarks", "Remove All Bookmarks", Keys::None, has_bookmarks, MclAction::ClearBookmarks, "Removes every bookmark of the program."),
    row!(Edit 3, "edit.complete", "Complete Word", Keys::Elsewhere("Ctrl+Space"), on_mcl, MclAction::Complete, "Lists the words that could be typed."),
    row!(Edit 3, "edit.definition", "Go to Definition", on_mcl_key(CTRL, Key::J), on_mcl, MclAction::Definition, "Goes to where the name at the caret is defined; Ctrl+click does the same."),
    row!(Edit 3, "edit.rename", "Rename…", on_mcl_key(CTRL_SHIFT, Key::R), on_mcl, MclAction::Rename, "Gives the name at the caret another, in all its places."),
    row!(Edit 3, "edit.match", "Go to Matching Word", on_mcl_key(CTRL, Key::M), on_mcl, MclAction::Matching, "Goes from IF over ELSE to ENDIF, from FOR to NEXT, and round."),
    row!(Edit 3, "edit.next-problem", "Next Problem", on_mcl_key(NONE, Key::F4), has_problems, MclAction::NextProblem, "Goes to the next error or warning."),
    row!(Edit 3, "edit.previous-problem", "Previous Problem", on_mcl_key(SHIFT, Key::F4), has_problems, MclAction::PreviousProblem, "Goes to the error or warning before."),
    row!(Edit 4, "edit.comment", "Toggle Comment", in_text_key(CTRL, Key::Slash), on_mcl, MclAction::ToggleComment, "Makes comments of the selected lines, or code again."),
    row!(Edit 4, "edit.tidy", "Format Program", on_mcl_key(CTRL_SHIFT, Key::F), on_mcl, MclAction::Tidy, "Writes the program in the usual form: indents, blanks, one way to write each word."),
    row!(Edit 4, "edit.indent", "Indent Lines", Keys::Elsewhere("Tab"), on_mcl, MclAction::Indent { further: true }, "Moves the selected lines to the right."),
    row!(Edit 4, "edit.unindent", "Unindent Lines", Keys::Elsewhere("Shift+Tab"), on_mcl, MclAction::Indent { further: false }, "Moves the selected lines to the left."),
    row!(Edit 4, "edit.duplicate", "Duplicate Lines", in_text_key(CTRL, Key::D), on_mcl, MclAction::DuplicateLines, "Puts a copy of the selected lines below them."),
    row!(Edit 4, "edit.delete-lines", "Delete Lines", in_text_key(CTRL_SHIFT, Key::K), on_mcl, MclAction::DeleteLines, "Takes the selected lines away."),
    row!(Edit 4, "edit.lines-up", "Move Lines Up", in_text_key(ALT, Key::ArrowUp), on_mcl, MclAction::MoveLines { down: false }, "Moves the selected lines over the line above."),
    row!(Edit 4, "edit.lines-down", "Move Lines Down", in_text_key(ALT, Key::ArrowDown), on_mcl, MclAction::MoveLines { down: true }, "Moves the selected lines over the line below."),
];

pub(super) const VIEW: &[Action] = &[
    switch!(hidden "view.hidden", "Hidden Characters", ToggleHidden, "Shows spaces, tabs, line ends and invisible characters in the MCL program."),
    switch!(current_line "view.current-line", "Highlight Current Line", ToggleCurrentLine, "Highlights the line of the caret."),
    switch!(folding "view.folding", "Folding Lines", ToggleFolding, "Shows beside the text what can be folded away."),
    row!(View 4, "view.fold", "Fold or Unfold Block", in_text_key(CTRL, Key::OpenBracket), on_mcl, MclAction::ToggleFoldHere, "Folds the block of the caret away, or brings it back."),
    row!(View 4, "view.fold-all", "Fold All", Keys::None, on_mcl, MclAction::FoldAll, "Folds every block away."),
    row!(View 4, "view.unfold-all", "Unfold All", Keys::None, on_mcl, MclAction::UnfoldAll, "Brings every block back."),
    entry!(View 5 "view.zoom-in", "Text Larger", "Makes the text of MCL programs larger; Ctrl+wheel does the same.",
        on_mcl_key(ALT, Key::Plus), on_mcl, |model| Command::Mcl(MclAction::Zoom(zoom(&model.mcl).saturating_add(10)))),
    entry!(View 5 "view.zoom-out", "Text Smaller", "Makes the text of MCL programs smaller.",
        on_mcl_key(ALT, Key::Minus), on_mcl, |model| Command::Mcl(MclAction::Zoom(zoom(&model.mcl).saturating_sub(10)))),
    row!(View 5, "view.zoom-normal", "Text Zoom 100 %", on_mcl_key(ALT, Key::Num0), on_mcl, MclAction::Zoom(100), "Makes the text of MCL programs as large as at first."),
    entry!(View 6 "view.problems", "Problems", "Shows and hides the list of errors and warnings.",
        Keys::None, on_mcl, |_| Command::Mcl(MclAction::ShowPanel(Tab::Problems)), on |model| shows(&model.mcl, Tab::Problems)),
    entry!(View 6 "view.terminal", "Terminal", "Shows and hides the terminal for what a script sends and gets.",
        on_mcl_key(CTRL, Key::Backtick), on_mcl, |_| Command::Mcl(MclAction::ShowPanel(Tab::Terminal)), on |model| shows(&model.mcl, Tab::Terminal)),
];

fn zoom(editor: &Editor) -> u16 {
    editor.options.zoom_percent
}

fn shows(editor: &Editor, tab: Tab) -> bool {
    editor.panel.open && editor.panel.tab == tab
}

fn can_undo(model: &Model) -> Ready {
    on_mcl(model)?;
    only(model.mcl.front().text.can_undo(), "There is nothing to undo.")
}

fn can_redo(model: &Model) -> Ready {
    on_mcl(model)?;
    only(model.mcl.front().text.can_redo(), "There is nothing to redo.")
}

fn has_bookmarks(model: &Model) -> Ready {
    on_mcl(model)?;
    only(!model.mcl.front().bookmarks.is_empty(), "The program has no bookmarks. Toggle Bookmark sets one.")
}

fn has_problems(model: &Model) -> Ready {
    on_mcl(model)?;
    only(!model.mcl.front().findings.problems.is_empty(), "The program has no errors and no warnings.")
}
