//! What the editor shows, in words.

use brushwork_values::messages;

messages! {
    /// What the panels of the editor say.
    pub enum PanelMessage {
        Program { title: String } "Program {title}",
        LineOf { line: usize, lines: usize } "Line {line} of {lines}",
        Unsaved { titles: String } "There is unsaved text in {titles}.",
        Untitled { number: usize } "Untitled {number}",
        NoExpression { why: String } "This is no regular expression: {why}.",
        Problem { word: &'static str, code: String, line: usize, message: String } "{word} {code} in line {line}: {message}",
        UnsavedFound { programs: String } "Unsaved text from an earlier time was found: {programs}.",
        ChangedAndUnsaved { title: String } "{title} was changed by another program, and there is unsaved text here.",
        Gone { title: String } "The file of {title} is gone. Save writes it again.",
        Word { word: String } "Word {word}",
        ValueNow { value: String } "Now: {value}",
        Caret { line: usize, column: usize } "Line {line}, column {column}",
        Selected { count: usize, line: usize } "{count} selected, line {line}",
        Syntax { syntax: String } "Syntax: {syntax}",
        Tab { title: String, state: &'static str } "Tab {title}{state}",
        Toolbar { action: String } "Toolbar {action}",
    }
}

messages! {
    /// What a printed program says, and why it is not printed.
    pub enum PrintMessage {
        Page { date: String, page: usize, pages: usize } "{date}   page {page} of {pages}",
        FontUnread { error: String } "the window's fixed font cannot be read ({error})",
        FontNotEmbedded { error: String } "the window's fixed font cannot be embedded ({error})",
    }
}
